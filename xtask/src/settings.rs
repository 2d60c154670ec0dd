//! `--set name=value` and `--preset`: the parameters a command moves.

use anyhow::Result;
use overhear::parameters::{PARAMETERS, Parameter, parse_assignment};
use overhear_engine::piece::{Piece, PieceId};

use crate::bad_input;

/// A parameter moved: its index in [`PARAMETERS`] and its plain value.
pub type Setting = (usize, f32);

/// The presets there are.
const PRESETS: [&str; 1] = ["default"];

/// Reads the values of `--set`.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn parse(assignments: &[String]) -> Result<Vec<Setting>> {
    assignments.iter().map(|text| parse_assignment(text).map_err(|error| bad_input!("{error}"))).collect()
}

/// Checks the value of `--preset`.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the presets.
pub fn check_preset(name: &str) -> Result<()> {
    if PRESETS.contains(&name) {
        Ok(())
    } else {
        Err(bad_input!("no preset is called `{name}`, accepted: {}", PRESETS.join(", ")))
    }
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

/// A setting of a piece on its own, in the engine's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PieceSetting {
    /// For [`Piece::set_tuning`].
    Tuning(f64),
    /// For [`Piece::set_muffling`].
    Muffling(f64),
}

impl PieceSetting {
    /// Moves it on a piece.
    pub fn apply(self, piece: &mut Piece) {
        match self {
            PieceSetting::Tuning(tuning) => piece.set_tuning(tuning),
            PieceSetting::Muffling(amount) => piece.set_muffling(amount),
        }
    }
}

/// Reads the values of `--set` for one piece on its own, which knows tuning and muffling only.
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
            let [tune, muffle] = &accepted;
            let name = name.trim();
            let parameter = accepted.iter().find(|parameter| parameter.name == name);
            let Some(parameter) = parameter else {
                return Err(bad_input!(
                    "`{name}` does not act on the {} alone, accepted: {}, {}",
                    id.name(),
                    tune.name,
                    muffle.name,
                ));
            };
            let value = parameter.parse(value).map_err(|error| bad_input!("{error}"))?;
            let value = f64::from(value);
            Ok(if parameter.name == muffle.name {
                PieceSetting::Muffling(value)
            } else if id.is_drum() {
                PieceSetting::Tuning(value)
            } else {
                // Semitones to a ratio, as the performer has it.
                PieceSetting::Tuning((value / 12.0).exp2())
            })
        })
        .collect()
}

/// Muffling that a piece has in the kit unless it is moved, 0 to 1.
pub fn default_muffling(id: PieceId) -> f64 {
    let [_, muffle] = piece_parameters(id);
    f64::from(muffle.default)
}

/// Tuning and muffling of a piece.
fn piece_parameters(id: PieceId) -> [Parameter; 2] {
    let find = |name: &str| PARAMETERS.iter().copied().find(|parameter| parameter.name == name);
    let prefix = id.name().replace('-', "_");
    let named = |what: &str| find(&format!("{prefix}_{what}"));
    match (named("tune"), named("muffle")) {
        (Some(tune), Some(muffle)) => [tune, muffle],
        // The timpani can be built and struck but is not in the kit: it has the kick's controls
        // under its own name and with its own range.
        _ => timpani_parameters(),
    }
}

fn timpani_parameters() -> [Parameter; 2] {
    let [tune, muffle] = piece_parameters(PieceId::Kick);
    let (min, default, max) = Piece::tuning_range(PieceId::Timpani);
    let (min, default, max) = (min as f32, default as f32, max as f32);
    [
        Parameter { name: "timpani_tune", min, default, max, centre: default, ..tune },
        Parameter { name: "timpani_muffle", ..muffle },
    ]
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
            let PieceSetting::Tuning(tuning) = settings[0] else { panic!("{settings:?}") };
            assert!((tuning / Piece::tuning_range(id).1 - 1.0).abs() < 1e-4, "{id:?}: {tuning}");
            assert_eq!(settings[1], PieceSetting::Muffling(0.25));
        }
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
    fn only_the_default_preset_is_known() {
        assert!(check_preset("default").is_ok());
        assert!(check_preset("jazz").unwrap_err().to_string().contains("accepted: default"));
    }
}
