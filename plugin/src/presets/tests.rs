use std::path::PathBuf;

use super::*;
use crate::parameters::find;

fn at(name: &str) -> usize {
    find(name).unwrap().0
}

/// A folder of its own, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        Folder(std::env::temp_dir().join(format!("overhear-presets-{name}-{}", std::process::id())))
    }

    fn library(&self) -> Library {
        Library::at(&self.0)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn every_built_in_preset_is_sound_and_different() {
    let presets: Vec<Preset> = FACTORY
        .iter()
        .map(|(name, text)| Preset::parse(name, text).unwrap_or_else(|e| panic!("{e}")))
        .collect();
    for (index, preset) in presets.iter().enumerate() {
        assert!(preset.about.ends_with('.'), "{}", FACTORY[index].0);
        assert!(presets[..index].iter().all(|other| other.values != preset.values));
    }
    assert!(presets[0].values.is_empty(), "the default moves nothing");
}

#[test]
fn a_preset_written_is_read_back_the_same() {
    for (name, text) in FACTORY {
        let preset = Preset::parse(name, text).unwrap();
        assert_eq!(Preset::parse(name, &preset.to_text()).unwrap(), preset, "{name}");
    }
    let mut odd = Preset::of(
        |index| {
            PARAMETERS[index]
                .snap(PARAMETERS[index].min + 0.377 * (PARAMETERS[index].max - PARAMETERS[index].min))
        },
        "\"quoted\" \\ and\nof two lines",
    );
    odd.values.insert(at("kick_level"), -60.0);
    odd.notes = Some(BTreeMap::from([(3, Assignment::Plays(38)), (4, Assignment::Silent)]));
    assert_eq!(Preset::parse("odd", &odd.to_text()).unwrap(), odd);
}

#[test]
fn what_is_not_named_is_at_its_default_but_the_player_s_set_up_stays() {
    let preset = Preset::parse("p", "format = 1\n[parameters]\nkick_tune = 60\n").unwrap();
    assert_eq!(preset.value(at("kick_tune")), Some(60.0));
    assert_eq!(preset.value(at("snare_tune")), Some(195.0));
    for name in ["note_map", "midi_channel", "chokes", "quality", "offline_quality", "velocity_curve"] {
        assert_eq!(preset.value(at(name)), None, "{name}");
    }
    let named = Preset::parse("p", "format = 1\n[parameters]\nnote_map = \"roland\"\n").unwrap();
    assert_eq!(named.value(at("note_map")), Some(1.0));
    assert_eq!(preset.value(PARAMETERS.len()), None);
}

#[test]
fn a_broken_file_is_named_with_its_line() {
    for (text, line, says) in [
        ("format = 1\n\n[parameters]\nkick_tune = 600\n", 4, "kick_tune is 600, accepted: 35 to 90 Hz"),
        ("format = 1\n[parameters]\ntriangle = 1\n", 3, "no parameter is called `triangle`"),
        ("format = 1\n[parameters]\nkick_tune = [1]\n", 3, "kick_tune is a array"),
        ("format = 1\n[parameters]\nride_striker = \"broom\"\n", 3, "ride_striker"),
        ("format = 1\n[parameters]\nkick_tune = \n", 3, ""),
        ("format = 1\n[notes]\n200 = 38\n", 3, "`200` is not a note"),
        ("format = 1\n[notes]\n38 = 127\n", 3, "note 38 plays nothing known"),
        ("format = 2\n", 1, "format is 2, accepted: 1"),
        ("about = \"x\"\n", 1, "there is no format"),
        ("format = 1\nparameters = 3\n", 2, "parameters is a integer"),
        ("format = 1\nsounds = 3\n", 2, "`sounds` is not known"),
        ("format = 1\n[parameters]\nkick_tune = 50\nkick_tune = 51\n", 4, ""),
    ] {
        let error = Preset::parse("mine.toml", text).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("mine.toml, line {line}: ")) && error.contains(says),
            "{text}: {error}"
        );
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn presets_are_saved_renamed_and_deleted() {
    let folder = Folder::new("files");
    let library = folder.library();
    let preset = Preset::of(|index| if index == 0 { 61.0 } else { PARAMETERS[index].default }, "Mine.");
    assert_eq!(library.list().len(), FACTORY.len(), "there is no folder yet");
    library.save("My kit", &preset).unwrap();
    assert_eq!(library.load("My kit").unwrap(), preset);
    assert_eq!(library.list().last().unwrap(), &Entry { name: "My kit".into(), origin: Origin::User });
    library.save("Other", &preset).unwrap();
    assert!(library.rename("My kit", "Other").unwrap_err().to_string().contains("there is one already"));
    library.rename("My kit", "Ünser").unwrap();
    assert!(library.load("My kit").unwrap_err().to_string().contains("accepted: default, studio"));
    library.delete("Ünser").unwrap();
    library.delete("Other").unwrap();
    assert!(library.delete("Other").is_err());
    assert_eq!(library.list().len(), FACTORY.len());
}

#[test]
fn names_that_are_no_file_s_and_built_in_ones_are_refused() {
    let folder = Folder::new("names");
    let library = folder.library();
    for name in ["", " x", "a/b", "..", ".hidden", "a\0b", "C:x", &"x".repeat(61)] {
        assert!(matches!(library.save(name, &Preset::default()), Err(PresetError::Name { .. })), "{name:?}");
    }
    for name in ["jazz", DEFAULT] {
        assert!(matches!(library.save(name, &Preset::default()), Err(PresetError::BuiltIn { .. })));
        assert!(matches!(library.delete(name), Err(PresetError::BuiltIn { .. })));
    }
    assert!(!folder.0.exists(), "nothing was written");
}

#[test]
fn files_that_are_no_presets_are_refused_and_the_others_still_listed() {
    let folder = Folder::new("broken");
    let library = folder.library();
    library.save("good", &Preset::default()).unwrap();
    std::fs::write(folder.0.join("bytes.toml"), b"format = 1\n\xFF\xFE\n").unwrap();
    std::fs::write(folder.0.join("notes.txt"), "not one").unwrap();
    let names: Vec<_> = library.list().into_iter().skip(FACTORY.len()).map(|entry| entry.name).collect();
    assert_eq!(names, ["bytes", "good"]);
    let error = library.load("bytes").unwrap_err().to_string();
    assert!(error.contains("bytes.toml, line 2: this is not text"), "{error}");
}
