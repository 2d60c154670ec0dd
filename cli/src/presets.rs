//! `presets`: lists presets and edits their files.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use overhear::presets::{Library, Origin, PresetError, load_file};

use crate::{bad_input, settings};

/// Every preset with what it is for; a broken one with what is wrong.
pub fn list(library: &Library) -> String {
    let mut text = String::new();
    for entry in library.list() {
        let about = match library.load(&entry.name) {
            Ok(preset) => preset.about,
            Err(error) => format!("broken: {error}"),
        };
        let mark = if entry.origin == Origin::User { "*" } else { " " };
        let _ = writeln!(text, "{mark} {:<16} {about}", entry.name);
    }
    if let Ok(folder) = library.folder() {
        let _ = writeln!(text, "\n* yours, in {}", folder.display());
    }
    text
}

/// The text of a preset's file.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets, or the line that is wrong.
pub fn show(library: &Library, name: &str) -> Result<String> {
    Ok(library.load(name).map_err(refused)?.to_text())
}

/// Saves a preset made of another one and of `name=value`s; tells where.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if anything named is not known.
pub fn save(library: &Library, name: &str, from: &str, set: &[String], about: String) -> Result<String> {
    let mut preset = library.load(from).map_err(refused)?;
    let kit = settings::kit_of(&preset).kit;
    preset.values.extend(settings::parse(set, &kit)?);
    if !about.is_empty() {
        preset.about = about;
    }
    let path = library.save(name, &preset).map_err(refused)?;
    Ok(format!("{}\n", path.display()))
}

/// Gives one of the user's presets another name.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if there is none or the name cannot be used.
pub fn rename(library: &Library, from: &str, to: &str) -> Result<()> {
    library.rename(from, to).map_err(refused)
}

/// Deletes one of the user's presets.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if there is none.
pub fn delete(library: &Library, name: &str) -> Result<()> {
    library.delete(name).map_err(refused)
}

/// Checks files, or every preset if none is named; tells how many are sound.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the line of everything that is wrong.
pub fn check(library: &Library, files: &[PathBuf]) -> Result<String> {
    let results: Vec<_> = if files.is_empty() {
        library.list().iter().map(|entry| library.load(&entry.name)).collect()
    } else {
        files.iter().map(|file| load_file(file)).collect()
    };
    let count = results.len();
    let wrong: Vec<_> = results.into_iter().filter_map(|result| Some(result.err()?.to_string())).collect();
    if wrong.is_empty() {
        Ok(format!("{count} presets are valid\n"))
    } else {
        Err(bad_input!("{}", wrong.join("; ")))
    }
}

fn refused(error: PresetError) -> anyhow::Error {
    bad_input!("{error}")
}
