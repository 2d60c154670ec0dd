//! Presets: named sets of values, in files that people can read and write.
//!
//! ```toml
//! format = 1
//! about = "What it is for."
//!
//! [parameters]               # what is not named is at its default
//! kick_tune = 43             # in the parameter's unit
//! ride_striker = "nylon"
//!
//! [notes]                    # optional
//! 40 = 37                    # note 40 plays the reference note 37
//! 41 = "silent"
//! ```
//!
//! How one's instrument is wired up (map, channel, curve, chokes, quality) belongs to the player and not to the
//! sound: it stays as it is unless a preset names it. The presets of the instrument are built in; the user's own
//! are files in a [`Library`]'s folder.

mod error;
mod file;
mod library;
mod programs;

use std::collections::BTreeMap;

use crate::midi::assignments::Assignment;
use crate::parameters::{Drives, Manner, PARAMETERS, Parameter};

pub use error::PresetError;
pub use library::{Entry, Library, Origin, load_file};
pub use programs::{Program, Programs};

/// Number of the format that is written and read.
pub const FORMAT: i64 = 1;

/// Name of the preset that has everything at its default.
pub const DEFAULT: &str = "default";

/// The built-in presets: name and file.
pub const FACTORY: [(&str, &str); 8] = [
    (DEFAULT, "format = 1\nabout = \"Everything as it comes.\"\n"),
    ("studio", include_str!("../presets/studio.toml")),
    ("jazz", include_str!("../presets/jazz.toml")),
    ("rock", include_str!("../presets/rock.toml")),
    ("funk", include_str!("../presets/funk.toml")),
    ("mallets", include_str!("../presets/mallets.toml")),
    ("orchestra", include_str!("../presets/orchestra.toml")),
    ("lo-fi", include_str!("../presets/lo-fi.toml")),
];

/// A preset.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Preset {
    /// What it is for, in a line.
    pub about: String,
    /// Values in the parameters' units by place in [`PARAMETERS`]; others are at their default or stay.
    pub values: BTreeMap<usize, f32>,
    /// Assignments of notes, if it says anything about them.
    pub notes: Option<BTreeMap<u8, Assignment>>,
}

impl Preset {
    /// A preset of the present values, in the parameters' units, without what belongs to the player.
    pub fn of(values: impl Fn(usize) -> f32, about: &str) -> Preset {
        let differs = |(index, parameter): (usize, &Parameter)| {
            let value = parameter.snap(values(index));
            (value != parameter.default && !is_set_up(parameter)).then_some((index, value))
        };
        let values = PARAMETERS.iter().enumerate().filter_map(differs).collect();
        Preset { about: about.to_owned(), values, notes: None }
    }

    /// The value, in the parameter's unit, that it takes when the preset is loaded; `None` if it stays as it is.
    pub fn value(&self, index: usize) -> Option<f32> {
        let parameter = PARAMETERS.get(index)?;
        let default = (!is_set_up(parameter)).then_some(parameter.default);
        self.values.get(&index).copied().or(default)
    }
}

/// Whether a parameter belongs to the player's set-up rather than to the sound.
fn is_set_up(parameter: &Parameter) -> bool {
    use Manner::{Channel, Chokes, Curve, FollowsPosition, FollowsPrograms, Map};
    match parameter.drives {
        Drives::Playing(Map | Channel | Chokes | FollowsPosition | FollowsPrograms | Curve) => true,
        Drives::Building(construction) => construction.is_effort(),
        _ => false,
    }
}

#[cfg(test)]
mod tests;
