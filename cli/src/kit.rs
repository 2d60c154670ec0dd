//! `kit`: shows, creates and checks kit files; lists the fitted constants.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use overhear::kit_document::KitDocument;
use overhear::presets::Library;
use overhear::{kit_file, library};
use overhear_engine::fitted;
use serde::Serialize;

use crate::error::BadFiles;
use crate::{bad_input, output, settings};

/// The complete file of a kit: the standard one, that of a kit file, or the one that a preset of that name plays.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets, or the line of the file that is wrong.
pub fn show(library: &Library, what: Option<&str>) -> Result<String> {
    let document = match what {
        None => KitDocument::standard(),
        Some(name) if is_file(library, name) => settings::kit(Some(Path::new(name)))?,
        Some(name) => settings::kit_of(&library.load(name).map_err(|error| bad_input!("{error}"))?),
    };
    Ok(kit_file::write(&document))
}

/// Whether a file is meant rather than a preset.
fn is_file(library: &Library, name: &str) -> bool {
    let path = Path::new(name);
    let is_toml = path.extension().is_some_and(|extension| extension == "toml");
    is_toml || (path.is_file() && library.list().iter().all(|entry| entry.name != name))
}

/// Begins a kit file: that of a kit of the library, or one that changes nothing yet and says how to.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if there is such a file, or none can be made, or the library has no kit of that name.
pub fn new(file: &Path, from: Option<&str>) -> Result<()> {
    let kit = from.map(|name| {
        let names = || library::kits().map(|kit| kit.name).collect::<Vec<_>>().join(", ");
        library::whole_kit(name).ok_or_else(|| bad_input!("no kit is called `{name}`, accepted: {}", names()))
    });
    let kit = kit.transpose()?;
    if file.symlink_metadata().is_ok() {
        return Err(bad_input!("`{}` exists, accepted: the name of a new file", file.display()));
    }
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let text = kit.map_or_else(|| kit_file::fresh(&name), |kit| kit.text.to_owned());
    output::write(file, text.as_bytes())
}

/// The instruments and kits of the library whose names, families or descriptions have all of some words in them.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if there are none.
pub fn library(words: &[String]) -> Result<String> {
    let words: Vec<String> = words.iter().map(|word| word.to_lowercase()).collect();
    let is_meant = |texts: [&str; 3]| {
        let text = texts.join(" ").to_lowercase();
        words.iter().all(|word| text.contains(word))
    };
    let mut text = String::new();
    let mut family = String::new();
    for instrument in library::instruments() {
        if !is_meant([instrument.name, &instrument.family, &instrument.about]) {
            continue;
        }
        if instrument.family != family {
            let _ = writeln!(text, "{}{}", if text.is_empty() { "" } else { "\n" }, instrument.family);
            family.clone_from(&instrument.family);
        }
        let _ = writeln!(text, "    {:<24} {}", instrument.name, instrument.about);
    }
    let kits: Vec<_> = library::kits().filter(|kit| is_meant([kit.name, "kit", &kit.about])).collect();
    if !kits.is_empty() {
        let _ = writeln!(text, "{}whole kits", if text.is_empty() { "" } else { "\n" });
    }
    for kit in kits {
        let _ = writeln!(text, "    {:<24} {}", kit.name, kit.about);
    }
    if text.is_empty() {
        return Err(bad_input!(
            "the library has nothing about `{}`, accepted: words of names, families and descriptions",
            words.join(" ")
        ));
    }
    Ok(text)
}

/// A line for every file that is a kit, and what is wrong with the others.
///
/// # Errors
/// [`BadFiles`] with a line for every file that is none.
pub fn check(files: &[PathBuf]) -> (String, Result<()>) {
    let (mut sound, mut wrong) = (String::new(), Vec::new());
    for file in files {
        match kit_file::load(file) {
            Ok(KitDocument { kit, .. }) => {
                let count = kit.pieces.len();
                let pieces = if count == 1 { "piece" } else { "pieces" };
                let _ = writeln!(sound, "{}: ok, {count} {pieces}", file.display());
            }
            Err(error) => wrong.push(error.to_string()),
        }
    }
    (sound, if wrong.is_empty() { Ok(()) } else { Err(BadFiles(wrong).into()) })
}

/// A fitted constant. The fields are the keys of the JSON and stay.
#[derive(Debug, Clone, Copy, Serialize)]
struct Constant {
    name: &'static str,
    value: f64,
    unit: &'static str,
    fitted_to: &'static str,
    tried: &'static str,
    moves: &'static str,
}

fn constants() -> Vec<Constant> {
    let constant = |it: &fitted::Fitted| {
        let fitted::Fitted { name, value, unit, to: fitted_to, tried, moves } = *it;
        Constant { name, value, unit, fitted_to, tried, moves }
    };
    fitted::ALL.iter().map(constant).collect()
}

/// Every constant that was fitted, for people.
pub fn fitted_table() -> String {
    let constants = constants();
    let mut text = format!("{} constants were fitted\n", constants.len());
    for Constant { name, value, unit, fitted_to, tried, moves } in constants {
        let amount = if unit == "1" { value.to_string() } else { format!("{value} {unit}") };
        let _ = writeln!(text, "\n{name} = {}", amount.trim_end());
        for (what, told) in [("fitted to", fitted_to), ("tried", tried), ("moves", moves)] {
            let _ = writeln!(text, "    {what:<10} {told}");
        }
    }
    text
}

/// The same as a JSON list.
///
/// # Errors
/// If a value is no number.
pub fn fitted_json() -> Result<String> {
    Ok(serde_json::to_string(&constants())? + "\n")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::error::{exit_code, lines};

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("overhear-kit-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_kit_that_is_shown_reads_back_as_it_was() {
        let folder = folder("show");
        let library = Library::at(&folder);
        let text = show(&library, None).unwrap();
        assert_eq!(kit_file::read("standard.toml", &text).unwrap(), KitDocument::standard());
        assert_eq!(show(&library, Some("default")).unwrap(), text);
        let file = folder.join("kit.toml");
        fs::write(&file, &text).unwrap();
        assert_eq!(show(&library, file.to_str()).unwrap(), text);
        let error = show(&library, Some("polka")).unwrap_err();
        assert!(exit_code(&error) == 2 && error.to_string().contains("accepted: default"), "{error}");
        assert_eq!(exit_code(&show(&library, Some("no/such.toml")).unwrap_err()), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_new_file_is_the_standard_kit_and_replaces_none() {
        let folder = folder("new");
        let file = folder.join("mine.toml");
        new(&file, None).unwrap();
        assert_eq!(kit_file::load(&file).unwrap(), KitDocument::standard());
        fs::write(&file, "mine").unwrap();
        let error = new(&file, None).unwrap_err();
        assert!(exit_code(&error) == 2 && error.to_string().contains("mine.toml"), "{error}");
        assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
        assert_eq!(exit_code(&new(&folder.join("no/such/kit.toml"), None).unwrap_err()), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_library_is_listed_by_words_and_a_kit_of_it_begins_a_file() {
        let folder = folder("library");
        let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let all = library(&[]).unwrap();
        assert!(all.lines().count() > 75, "{all}");
        let some = library(&words("snare brass")).unwrap();
        assert!(some.contains("snare-14x5-brass") && !some.contains("kick-"), "{some}");
        assert!(library(&words("kit jazz")).unwrap().contains("jazz-18"));
        assert_eq!(exit_code(&library(&words("accordion")).unwrap_err()), 2);
        let file = folder.join("mine.toml");
        let error = new(&file, Some("polka")).unwrap_err();
        assert!(exit_code(&error) == 2 && error.to_string().contains("jazz-18"), "{error}");
        new(&file, Some("jazz-18")).unwrap();
        let jazz = library::whole_kit("jazz-18").unwrap().document().unwrap();
        assert_eq!(kit_file::load(&file).unwrap(), jazz);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn every_file_that_is_checked_has_a_line() {
        let folder = folder("check");
        let [sound, broken, missing] =
            ["sound.toml", "broken.toml", "missing.toml"].map(|file| folder.join(file));
        fs::write(&sound, show(&Library::at(&folder), None).unwrap()).unwrap();
        fs::write(&broken, "format = 1\n[pieces.snare]\ndiameter_in = 99\n").unwrap();
        let (text, outcome) = check(std::slice::from_ref(&sound));
        let count = KitDocument::standard().kit.pieces.len();
        assert_eq!(text, format!("{}: ok, {count} pieces\n", sound.display()));
        assert!(outcome.is_ok());
        let (text, outcome) = check(&[broken, sound, missing]);
        assert_eq!(text.lines().count(), 1);
        let error = outcome.unwrap_err();
        let lines = lines(&error);
        assert_eq!((exit_code(&error), lines.len()), (2, 2));
        assert!(lines[0].contains("broken.toml") && lines[0].contains("99"), "{lines:?}");
        assert!(lines[1].contains("missing.toml"), "{lines:?}");
        assert!(lines.iter().all(|line| line.lines().count() == 1), "{lines:?}");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn every_fitted_constant_is_listed_with_what_it_was_fitted_to() {
        let list: serde_json::Value = serde_json::from_str(&fitted_json().unwrap()).unwrap();
        let list = list.as_array().unwrap();
        assert_eq!(list.len(), fitted::ALL.len());
        let table = fitted_table();
        for constant in list {
            for key in ["name", "unit", "fitted_to", "tried", "moves"] {
                assert!(table.contains(constant[key].as_str().unwrap()), "{constant}");
            }
            assert!(constant["value"].is_number());
        }
    }
}
