//! `--kit`, `--preset` and `--set name=value`: the kit that a command plays and the parameters that it sets.

use std::path::Path;

use anyhow::Result;
use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear::library;
use overhear::midi::maps::NoteMap;
use overhear::midi_map::{Meaning, NoteTable};
use overhear::parameters::{self, Drives, Manner, SlotParameter, parameters};
use overhear::presets::{self, Library, Preset};
use overhear_engine::kit::Control;
use overhear_engine::kit_spec::KitSpec;
use overhear_measure::hear::ALONE;

use crate::bad_input;

pub use overhear_measure::settings::{PieceSetting, Setting, piece};

/// What of a slot acts on a piece by itself; the others place it in a mix or say how it is struck.
const ACTS_ALONE: [SlotParameter; 5] = [
    SlotParameter::Tune,
    SlotParameter::Muffle,
    SlotParameter::Preload,
    SlotParameter::Wires,
    SlotParameter::Pedal,
];

/// A kit and the parameters moved on it before the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// The kit.
    pub kit: KitDocument,
    /// The parameters.
    pub settings: Vec<Setting>,
}

/// The kit of `--kit`: that of a file or, where there is no such file, the one of that name in the library; the standard one if
/// nothing is named.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the file, the line, the field and what is accepted.
pub fn kit(what: Option<&Path>) -> Result<KitDocument> {
    let Some(file) = what else { return Ok(KitDocument::standard()) };
    let name = file.to_str().filter(|name| !name.contains(['.', '/', '\\']) && !file.exists());
    let Some(name) = name else { return kit_file::load(file).map_err(|error| bad_input!("{error}")) };
    let Some(kit) = library::whole_kit(name) else {
        let names: Vec<&str> = library::kits().map(|kit| kit.name).collect();
        return Err(bad_input!("`{name}` is no kit, accepted: a kit file, {}", names.join(", ")));
    };
    kit.document().map_err(|error| bad_input!("{error}"))
}

/// Reads the values of `--set` for a kit.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn parse(assignments: &[String], kit: &KitSpec) -> Result<Vec<Setting>> {
    let read = |text: &String| parameters::parse_assignment(text, kit);
    assignments.iter().map(|text| read(text).map_err(|error| bad_input!("{error}"))).collect()
}

/// Whether a note plays something of a kit under the settings' note map: by a stroke or by foot.
pub fn plays(settings: &[Setting], notes: &NoteTable, note: u8) -> bool {
    let map = told(settings, Manner::Map).map_or(0, |value| value as usize);
    let played = NoteMap::ALL.get(map).copied().unwrap_or_default().plays(note);
    played.and_then(|note| notes.row(note)).is_some_and(|row| row.meaning != Meaning::Silent)
}

/// The kit and the values of `--preset` (a name or a file), `--kit` in place of the preset's kit, `--set` after both. What they ask for
/// is not for a song to take back: if they move anything that presets set, program changes are off unless they are asked for.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets, or the line of the file that is wrong.
pub fn choose(preset: &str, file: Option<&Path>, assignments: &[String]) -> Result<Chosen> {
    let preset = load_preset(preset)?;
    let kit = if file.is_some() { kit(file)? } else { kit_of(&preset) };
    let mut settings = moved(&preset, &kit.kit);
    settings.extend(parse(assignments, &kit.kit)?);
    let moves_sound = settings.iter().any(|&(index, _)| !presets::is_set_up(&parameters()[index]));
    if moves_sound && told(&settings, Manner::FollowsPrograms).is_none() {
        let programs = (0..parameters().len()).find(|&index| is(index, Manner::FollowsPrograms));
        settings.splice(0..0, programs.map(|index| (index, 0.0)));
    }
    Ok(Chosen { kit, settings })
}

/// Whether a parameter, by its place in the table, is that one of playing.
fn is(index: usize, manner: Manner) -> bool {
    parameters()[index].drives == Drives::Playing(manner)
}

/// The value that settings end with for a parameter of playing, in its unit, if they set it.
fn told(settings: &[Setting], manner: Manner) -> Option<f32> {
    settings.iter().rfind(|&&(index, _)| is(index, manner)).map(|&(_, value)| value)
}

/// Whether program changes act under such settings.
pub fn follows_programs(settings: &[Setting]) -> bool {
    told(settings, Manner::FollowsPrograms).is_none_or(|value| value >= 0.5)
}

/// Parameters of a kit that a preset changes from their defaults.
pub fn moved(preset: &Preset, kit: &KitSpec) -> Vec<Setting> {
    let mut values = preset.values_at(kit);
    values.retain(|&(index, value)| value != parameters::default_value(index, kit));
    values
}

/// The kit that a preset plays, the standard one if it carries none.
pub fn kit_of(preset: &Preset) -> KitDocument {
    preset.kit().map_or_else(KitDocument::standard, |kit| KitDocument::clone(kit))
}

/// A preset by its name in the user's library, or by the path of a file.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets, or the line of the file that is wrong.
pub fn load_preset(preset: &str) -> Result<Preset> {
    let path = Path::new(preset);
    let is_file = path.extension().is_some_and(|extension| extension == "toml");
    let loaded = if is_file { presets::load_file(path) } else { Library::default().load(preset) };
    loaded.map_err(|error| bad_input!("{error}"))
}

/// Reads the values of `--set` for a kit of one piece.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn parse_for_piece(kit: &KitSpec, assignments: &[String]) -> Result<Vec<PieceSetting>> {
    assignments.iter().map(|text| parse_one_for_piece(kit, text)).collect()
}

fn parse_one_for_piece(kit: &KitSpec, text: &str) -> Result<PieceSetting> {
    let Some((name, value)) = text.split_once('=') else {
        return Err(bad_input!("`{text}` is not of the form name=value, as in kick_tune=60"));
    };
    let name = name.trim();
    let index = |what| parameters::slot_index(ALONE, what);
    let found = parameters::find(name, kit).ok();
    let acting = ACTS_ALONE.into_iter().filter(|&what| parameters::is_live(index(what), kit));
    let Some(what) = acting.clone().find(|&what| Some(index(what)) == found) else {
        let names: Vec<_> = acting.map(|what| parameters::name(index(what), kit)).collect();
        let piece = kit.pieces.first().map_or("", |piece| &piece.name);
        return Err(bad_input!("`{name}` does not act on the {piece} alone, accepted: {}", names.join(", ")));
    };
    let value = parameters::parse_value(index(what), value, kit).map_err(|error| bad_input!("{error}"))?;
    let own = kit.pieces.first().map_or(1.0, |piece| piece.instrument.tunings()[1]);
    let value = f64::from(value);
    let (control, value) = match what {
        SlotParameter::Tune => (Control::Tuning(ALONE), own * (value / 12.0).exp2()),
        SlotParameter::Preload => (Control::Preload(ALONE), value),
        SlotParameter::Wires => (Control::Wires(ALONE), value),
        SlotParameter::Pedal => (Control::Pedal(ALONE), value),
        _ => (Control::Muffling(ALONE), value),
    };
    Ok(PieceSetting { control, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alone(name: &str) -> KitSpec {
        let kit = KitSpec::standard();
        kit.alone(piece(&kit, name).unwrap().0).unwrap()
    }

    fn error(name: &str, text: &str) -> String {
        parse_for_piece(&alone(name), &[text.to_owned()]).unwrap_err().to_string()
    }

    #[test]
    fn every_piece_takes_its_tuning_and_muffling() {
        for spec in KitSpec::standard().pieces {
            let prefix = spec.name.replace('-', "_");
            let own = spec.instrument.tunings()[1];
            let asked = if spec.drum().is_some() { format!("{own} Hz") } else { "0 st".to_owned() };
            let assignments = [format!("{prefix}_tune={asked}"), format!("{prefix}_muffle=.25")];
            let settings = parse_for_piece(&alone(&spec.name), &assignments).unwrap();
            assert_eq!(settings[0], PieceSetting { control: Control::Tuning(ALONE), value: own });
            assert_eq!(settings[1], PieceSetting { control: Control::Muffling(ALONE), value: 0.25 });
        }
    }

    #[test]
    fn a_drum_is_tuned_in_hertz_within_a_thousandth_of_a_semitone() {
        let settings = parse_for_piece(&alone("kick"), &["kick_tune=60".to_owned()]).unwrap();
        assert!((settings[0].value / 60.0 - 1.0).abs() < 0.0005 * std::f64::consts::LN_2 / 12.0 + 1e-7);
    }

    #[test]
    fn the_snare_takes_its_wires_too_and_the_hi_hat_its_pedal() {
        let controls = |name: &str, texts: &[&str]| -> Vec<Control> {
            let texts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
            let settings = parse_for_piece(&alone(name), &texts).unwrap();
            settings.iter().map(|setting| setting.control).collect()
        };
        let wires = controls("snare", &["snare_preload=.05", "snare_wires=0"]);
        assert_eq!(wires, [Control::Preload(ALONE), Control::Wires(ALONE)]);
        assert_eq!(controls("hi-hat", &["hi_hat_pedal=1"]), [Control::Pedal(ALONE)]);
        assert!(error("snare", "snare_preload=2").contains("accepted: 0.03 to 1.5 N"));
        assert!(error("kick", "snare_wires=1").contains("kick_muffle"));
    }

    #[test]
    fn what_does_not_act_on_the_piece_is_refused() {
        assert!(error("kick", "master_level=0").ends_with("accepted: kick_tune, kick_muffle"));
        assert!(error("kick", "kick_level=0").ends_with("accepted: kick_tune, kick_muffle"));
        assert!(error("timpani", "kick_tune=60").contains("timpani_tune"));
        assert!(error("timpani", "timpani_tune=20").contains("87.3 to 196 Hz"));
        assert!(error("ride", "ride_tune").contains("name=value"));
    }

    #[test]
    fn settings_come_after_the_preset() {
        let standard = Chosen { kit: KitDocument::standard(), settings: Vec::new() };
        assert_eq!(choose("default", None, &[]).unwrap(), standard);
        let jazz = choose("jazz", None, &["kick_muffle=.5".to_owned()]).unwrap();
        assert!(jazz.settings.len() > 5);
        let kick = parameters::find("kick_muffle", &jazz.kit.kit).unwrap();
        assert_eq!(jazz.settings.last(), Some(&(kick, 0.5)));
        assert!(load_preset("polka").unwrap_err().to_string().contains("accepted: default, studio, jazz"));
        assert!(load_preset("no/such.toml").unwrap_err().to_string().contains("no/such.toml"));
    }

    #[test]
    fn a_song_takes_back_nothing_that_was_asked_for() {
        let off = |assignments: &[&str]| {
            let texts: Vec<String> = assignments.iter().map(|&text| text.to_owned()).collect();
            !follows_programs(&choose("default", None, &texts).unwrap().settings)
        };
        assert!(off(&["kick_muffle=.5"]) && off(&["offline_quality=high", "crash_level=-3"]));
        assert!(!off(&[]) && !off(&["offline_quality=high"]));
        assert!(!off(&["kick_muffle=.5", "program_changes=on"]));
    }

    #[test]
    fn a_kit_of_the_library_is_called_by_its_name() {
        let jazz = kit(Some(Path::new("jazz-18"))).unwrap();
        assert_eq!(jazz, library::whole_kit("jazz-18").unwrap().document().unwrap());
        assert_ne!(jazz, KitDocument::standard());
        let error = kit(Some(Path::new("polka"))).unwrap_err().to_string();
        assert!(error.contains("polka") && error.contains("jazz-18"), "{error}");
    }

    #[test]
    fn a_kit_file_that_is_not_there_is_named() {
        let error = kit(Some(Path::new("no/such.toml"))).unwrap_err();
        assert!(
            error.is::<crate::error::BadInput>() && error.to_string().contains("no/such.toml"),
            "{error}"
        );
    }
}
