use std::collections::BTreeMap;
use std::sync::Arc;

use overhear_engine::kit_spec::KitSpec;

use std::path::PathBuf;

use super::*;
use crate::midi::assignments::Assignment;
use crate::parameters::{COUNT, default_value, is_live, parameters, slot_index};
use crate::parameters::{SlotParameter, find};
use overhear_engine::slot::Slot;

/// The standard kit.
fn standard() -> KitSpec {
    KitSpec::standard()
}

/// Place of a parameter of the standard kit.
fn at(name: &str) -> usize {
    find(name, &standard()).unwrap()
}

/// A preset that carries a kit with a second crash in the place of the ride.
const WITH_A_KIT: &str = "format = 2
about = \"Two crashes.\"

[parameters]
crash_2_level = -3
snare_tune = 210

[kit]
format = 1
remove = [\"ride\"]

[kit.pieces.crash-2]
like = \"crash\"
place.centre_m = [0.6, 1.2, 0.0]

[kit.pieces.snare.resonant]
pitch_ratio = 1.4
";

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
        assert_eq!(preset.kit(), None);
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
            let parameter = &parameters()[index];
            parameter.snap(parameter.min + 0.377 * (parameter.max - parameter.min))
        },
        &Arc::default(),
        "\"quoted\" \\ and\nof two lines",
    );
    odd.values.insert(at("kick_level"), -60.0);
    odd.notes = Some(BTreeMap::from([(3, Assignment::Plays(38)), (4, Assignment::Silent)]));
    assert_eq!(Preset::parse("odd", &odd.to_text()).unwrap(), odd);
}

#[test]
fn every_tuning_is_written_so_that_it_is_read_back_the_same() {
    let snare = at("snare_tune");
    for step in (-12_288..=12_288).step_by(7) {
        let values = BTreeMap::from([(snare, step as f32 / 1024.0)]);
        let preset = Preset { values, ..Preset::default() };
        assert_eq!(Preset::parse("p", &preset.to_text()).unwrap(), preset, "{}", preset.to_text());
    }
    let preset = Preset { values: BTreeMap::from([(snare, 2.0)]), ..Preset::default() };
    // Two semitones over its own 170 Hz.
    assert!(preset.to_text().contains("\nsnare_tune = 190.82\n"), "in Hz: {}", preset.to_text());
}

#[test]
fn what_is_not_named_is_at_its_default_but_the_player_s_set_up_stays() {
    let preset = Preset::parse("p", "format = 2\n[parameters]\nkick_tune = 60\n").unwrap();
    let value = |name: &str| preset.value(at(name), &standard());
    let hertz = crate::parameters::text(at("kick_tune"), value("kick_tune").unwrap(), &standard());
    assert_eq!(hertz, "60.00 Hz");
    assert_eq!((value("snare_tune"), value("snare_level")), (Some(0.0), Some(0.0)));
    for name in ["note_map", "midi_channel", "chokes", "quality", "offline_quality", "velocity_curve"] {
        assert_eq!(value(name), None, "{name}");
    }
    let named = Preset::parse("p", "format = 2\n[parameters]\nnote_map = \"roland\"\n").unwrap();
    assert_eq!(named.value(at("note_map"), &standard()), Some(1.0));
    assert_eq!(preset.value(COUNT, &standard()), None);
}

#[test]
fn a_broken_file_is_named_with_its_line() {
    for (text, line, says) in [
        ("format = 2\n\n[parameters]\nkick_tune = 600\n", 4, "kick_tune is 600, accepted: 35 to 90 Hz"),
        ("format = 2\n[parameters]\ntriangle = 1\n", 3, "no parameter is called `triangle`"),
        ("format = 2\n[parameters]\nkick_tune = [1]\n", 3, "kick_tune is a array"),
        ("format = 2\n[parameters]\nride_stick = \"broom\"\n", 3, "ride_stick"),
        (
            "format = 2\n[parameters]\nride_preload = 0.1\n",
            3,
            "ride_preload does nothing: `ride` has no such control",
        ),
        ("format = 2\n[parameters]\nslot_12_tune = 1\n", 3, "slot_12_tune does nothing: the slot is empty"),
        ("format = 2\nkit = 3\n", 2, "kit is a integer"),
        (
            "format = 2\n[kit]\nformat = 1\n[kit.pieces.snare]\ndiameter_in = 90\n",
            5,
            "pieces.snare.diameter_in",
        ),
        ("format = 2\n[kit]\nformat = 9\n", 3, "format is `9`, accepted: 1"),
        ("format = 2\n[notes]\n5 = 126\n", 3, "note 5 plays nothing known"),
        ("format = 2\n[parameters]\nkick_tune = \n", 3, ""),
        ("format = 2\n[notes]\n200 = 38\n", 3, "`200` is not a note"),
        ("format = 2\n[notes]\n38 = 127\n", 3, "note 38 plays nothing known"),
        ("format = 1\n", 1, "format is 1, accepted: 2"),
        ("about = \"x\"\n", 1, "there is no format"),
        ("format = 2\nparameters = 3\n", 2, "parameters is a integer"),
        ("format = 2\nsounds = 3\n", 2, "`sounds` is not known"),
        ("format = 2\n[parameters]\nkick_tune = 50\nkick_tune = 51\n", 4, ""),
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
    let value = |index: usize| if index == 0 { 2.5 } else { parameters()[index].default };
    let preset = Preset::of(value, &Arc::default(), "Mine.");
    assert_eq!(library.list().len(), FACTORY.len(), "there is no folder yet");
    library.save("My kit", &preset).unwrap();
    assert_eq!(library.load("My kit").unwrap(), preset);
    assert_eq!(library.list().last().unwrap(), &Entry { name: "My kit".into(), origin: Origin::User });
    library.save("Other", &preset).unwrap();
    assert!(
        library.rename("My kit", "Other").unwrap_err().to_string().contains("a preset of this name exists")
    );
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
    std::fs::write(folder.0.join("bytes.toml"), b"format = 2\n\xFF\xFE\n").unwrap();
    std::fs::write(folder.0.join("notes.txt"), "not one").unwrap();
    let names: Vec<_> = library.list().into_iter().skip(FACTORY.len()).map(|entry| entry.name).collect();
    assert_eq!(names, ["bytes", "good"]);
    let error = library.load("bytes").unwrap_err().to_string();
    assert!(error.contains("bytes.toml, line 2: this is not text"), "{error}");
}

#[test]
fn a_preset_carries_a_kit_and_names_its_parameters_by_it() {
    let preset = Preset::parse("two", WITH_A_KIT).unwrap();
    let document = preset.kit().unwrap();
    assert_eq!(document.check(), Ok(()));
    assert_eq!(document.kit.find("ride"), None);
    let (crash, _) = document.kit.find("crash-2").unwrap();
    let level = slot_index(crash, SlotParameter::Level);
    assert_eq!(preset.value(level, &document.kit), Some(-3.0));
    let drum = document.kit.find("snare").unwrap().1.drum().unwrap();
    assert_eq!(drum.resonant.as_ref().map(|head| head.pitch_ratio), Some(1.4));
    let again = Preset::parse("again", &preset.to_text()).unwrap();
    assert_eq!(again.kit(), preset.kit());
    assert_eq!(again, preset);
}

#[test]
fn a_preset_of_another_kit_than_the_standard_one_has_it_whole() {
    let document = Preset::parse("two", WITH_A_KIT).unwrap().kit().unwrap().clone();
    let (crash, _) = document.kit.find("crash-2").unwrap();
    let moved = slot_index(crash, SlotParameter::Pan);
    let value = |index| if index == moved { 12.0 } else { default_value(index, &document.kit) };
    let preset = Preset::of(value, &document, "Mine.");
    assert_eq!(preset.values, BTreeMap::from([(moved, 12.0)]));
    let again = Preset::parse("mine", &preset.to_text()).unwrap();
    assert_eq!((again.kit(), &again.values), (Some(&document), &preset.values));
}

#[test]
fn values_find_their_pieces_by_name_in_any_kit() {
    let preset =
        Preset::parse("p", "format = 2\n[parameters]\nride_level = -7\nhi_hat_pedal = 0.5\n").unwrap();
    let mut kit = standard();
    kit.pieces.retain(|piece| piece.name != "hi-hat");
    kit.pieces.reverse();
    let (ride, _) = kit.find("ride").unwrap();
    let values: BTreeMap<usize, f32> = preset.values_at(&kit).into_iter().collect();
    assert_eq!(values[&slot_index(ride, SlotParameter::Level)], -7.0);
    for (index, value) in values {
        assert!(is_live(index, &kit), "{index}");
        let level = slot_index(ride, SlotParameter::Level);
        assert!(index == level || value == default_value(index, &kit), "{index}");
    }
    let program = Program::of(&preset, &kit);
    assert!(program.values.iter().all(|(index, _)| *index != slot_index(Slot::ALL[8], SlotParameter::Pedal)));
}

#[test]
fn programs_follow_the_kit() {
    let mut kit = standard();
    kit.pieces.swap(0, 1);
    let folder = Folder::new("programs");
    let programs = Programs::of(&folder.library(), &standard());
    let moved = programs.at(&kit);
    let rock = FACTORY.iter().position(|(name, _)| *name == "rock").unwrap() as u8;
    let stick = |programs: &Programs, slot: usize| {
        let index = slot_index(Slot::ALL[slot], SlotParameter::Stick);
        programs.get(rock).unwrap().values.iter().find(|(of, _)| *of == index).map(|(_, value)| *value)
    };
    assert_eq!(stick(&programs, 0), stick(&moved, 1));
    assert_ne!(stick(&programs, 0), stick(&moved, 0));
}
