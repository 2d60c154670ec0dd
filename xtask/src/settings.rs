//! `--set name=value` and `--preset`: the parameters a command moves.

use std::path::Path;

use anyhow::Result;
use overhear::midi::maps::NoteMap;
use overhear::midi_map::Stroke;
use overhear::parameters::{Drives, Manner, PARAMETERS, Parameter, parse_assignment};
use overhear::presets::{self, Library, Preset};
use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::kit::Control;
use overhear_engine::piece::{BuildOptions, Piece, PieceId};

use crate::bad_input;

/// A parameter moved: its index in [`PARAMETERS`] and its value in its unit.
pub type Setting = (usize, f32);

/// Reads the values of `--set`.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn parse(assignments: &[String]) -> Result<Vec<Setting>> {
    assignments.iter().map(|text| parse_assignment(text).map_err(|error| bad_input!("{error}"))).collect()
}

/// The stroke of a note under the settings' note map, if it sounds.
pub fn stroke(settings: &[Setting], note: u8) -> Option<&'static Stroke> {
    let moved = |&&(index, _): &&Setting| PARAMETERS[index].drives == Drives::Playing(Manner::Map);
    let map = settings.iter().rfind(moved).map_or(0, |&(_, value)| value as usize);
    NoteMap::ALL.get(map).copied().unwrap_or_default().stroke(note)
}

/// The values of `--preset`, a name or a file, and of `--set` after it.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets, or the line of the file that is wrong.
pub fn preset_and_set(preset: &str, assignments: &[String]) -> Result<Vec<Setting>> {
    let mut settings: Vec<Setting> = load_preset(preset)?.values.into_iter().collect();
    settings.extend(parse(assignments)?);
    Ok(settings)
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

/// The piece of that name.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming every piece.
pub fn piece(name: &str) -> Result<PieceId> {
    PieceId::from_name(name).ok_or_else(|| {
        let names = PieceId::ALL.map(PieceId::name).join(", ");
        bad_input!("no piece is called `{name}`, accepted: {names}")
    })
}

/// Checks that what is asked of the build is something the piece has.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the option: a cymbal has no heads, a drum no bell.
pub fn check_options(id: PieceId, options: &BuildOptions) -> Result<()> {
    let of_drums = [
        ("--open", options.open),
        ("--resonant-ratio", options.resonant_ratio.is_some()),
        ("--uneven", options.unevenness.is_some()),
        ("--muffler", options.muffler.is_some()),
        ("--no-high-band", !options.high_band),
        ("--wrap", options.wraps),
    ];
    if options.shaped && id.is_drum() {
        return Err(bad_input!("--bell is of cymbals, the {} is a drum", id.name()));
    }
    match of_drums.into_iter().find(|&(_, asked)| asked && !id.is_drum()) {
        Some((option, _)) => Err(bad_input!("{option} is of drums, the {} is a cymbal", id.name())),
        None => Ok(()),
    }
}

/// A setting of a piece on its own: a control of the kit, in the engine's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceSetting {
    /// Which.
    pub control: Control,
    /// In the control's own unit.
    pub value: f64,
}

impl PieceSetting {
    /// Moves it on a piece.
    pub fn apply(self, piece: &mut Piece) {
        match self.control {
            Control::Tuning(_) => piece.set_tuning(self.value),
            Control::Muffling(_) => piece.set_muffling(self.value),
            Control::SnarePreload => piece.set_preload(self.value),
            Control::SnareWires => piece.throw_wires(self.value >= 0.5),
            Control::Pedal => piece.press_pedal(self.value, SPEED.1),
            // A piece by itself has no mix.
            _ => {}
        }
    }
}

/// Reads the values of `--set` for one piece on its own.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn parse_for_piece(id: PieceId, assignments: &[String]) -> Result<Vec<PieceSetting>> {
    let accepted = piece_parameters(id);
    assignments
        .iter()
        .map(|text| {
            let Some((name, value)) = text.split_once('=') else {
                return Err(bad_input!("`{text}` is not of the form name=value, as in kick_tune=60"));
            };
            let name = name.trim();
            let Some(parameter) = accepted.iter().find(|parameter| parameter.name == name) else {
                let names: Vec<_> = accepted.iter().map(|parameter| parameter.name).collect();
                let (piece, names) = (id.name(), names.join(", "));
                return Err(bad_input!("`{name}` does not act on the {piece} alone, accepted: {names}"));
            };
            let value = f64::from(parameter.parse(value).map_err(|error| bad_input!("{error}"))?);
            Ok(match parameter.drives {
                // Semitones to a ratio, as the performer has it.
                Drives::Semitones(id) => {
                    PieceSetting { control: Control::Tuning(id), value: (value / 12.0).exp2() }
                }
                Drives::Control(control) => PieceSetting { control, value },
                // Not among those accepted.
                Drives::Percent(_) | Drives::Stand(..) | Drives::Playing(_) | Drives::Building(_) => {
                    PieceSetting { control: Control::Master, value }
                }
            })
        })
        .collect()
}

/// Muffling that a piece has in the kit unless it is moved, 0 to 1.
pub fn default_muffling(id: PieceId) -> f64 {
    let muffle = piece_parameters(id).into_iter().find(|parameter| parameter.name.ends_with("_muffle"));
    muffle.map_or(0.0, |muffle| f64::from(muffle.default))
}

/// What can be set of a piece by itself: all that acts on it but its place in the mix.
fn piece_parameters(id: PieceId) -> Vec<Parameter> {
    let acts = |parameter: &&Parameter| match parameter.drives {
        Drives::Control(Control::Tuning(piece) | Control::Muffling(piece)) | Drives::Semitones(piece) => {
            piece == id
        }
        Drives::Control(Control::SnarePreload | Control::SnareWires) => id == PieceId::Snare,
        Drives::Control(Control::Pedal) => id == PieceId::HiHat,
        _ => false,
    };
    PARAMETERS.iter().filter(acts).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(id: PieceId, text: &str) -> String {
        parse_for_piece(id, &[text.to_owned()]).unwrap_err().to_string()
    }

    #[test]
    fn every_piece_takes_its_tuning_and_muffling() {
        for id in PieceId::ALL {
            let prefix = id.name().replace('-', "_");
            let default = if id.is_drum() { Piece::tuning_range(id).1 } else { 0.0 };
            let assignments = [format!("{prefix}_tune={default}"), format!("{prefix}_muffle=.25")];
            let settings = parse_for_piece(id, &assignments).unwrap();
            let tuning = settings[0].value;
            assert!((tuning / Piece::tuning_range(id).1 - 1.0).abs() < 1e-4, "{id:?}: {tuning}");
            assert_eq!(settings[1].value, 0.25);
        }
    }

    #[test]
    fn the_snare_takes_its_wires_too() {
        let settings = parse_for_piece(PieceId::Snare, &["snare_preload=.05".into(), "snare_wires=0".into()]);
        let controls: Vec<Control> = settings.unwrap().iter().map(|setting| setting.control).collect();
        assert_eq!(controls, [Control::SnarePreload, Control::SnareWires]);
        assert!(error(PieceId::Snare, "snare_preload=2").contains("accepted: 0.03 to 1.5 N"));
        assert!(error(PieceId::Kick, "snare_wires=1").contains("kick_muffle"));
    }

    #[test]
    fn what_does_not_act_on_the_piece_is_refused() {
        assert!(error(PieceId::Kick, "master_level=0").ends_with("accepted: kick_tune, kick_muffle"));
        assert!(error(PieceId::Timpani, "kick_tune=60").contains("timpani_tune"));
        assert_eq!(
            error(PieceId::Timpani, "timpani_tune=20"),
            "timpani_tune is 20, accepted: 87.3 to 196 Hz"
        );
        assert!(error(PieceId::Ride, "ride_tune").contains("name=value"));
    }

    #[test]
    fn settings_come_after_the_preset() {
        assert_eq!(preset_and_set("default", &[]).unwrap(), []);
        let jazz = preset_and_set("jazz", &["kick_tune=50".to_owned()]).unwrap();
        assert!(jazz.len() > 5);
        assert_eq!(jazz.last(), Some(&(0, 50.0)));
        assert!(load_preset("polka").unwrap_err().to_string().contains("accepted: default, studio, jazz"));
        assert!(load_preset("no/such.toml").unwrap_err().to_string().contains("no/such.toml"));
    }
}
