//! Presets: named sets of values, in files that people can read and write.
//!
//! ```toml
//! format = 2
//! about = "What it is for."
//!
//! [parameters]               # what is not named is at its default
//! kick_tune = 43             # in the parameter's unit
//! ride_stick = "nylon"
//!
//! [notes]                    # optional
//! 40 = 37                    # note 40 plays what the kit has for note 37
//! 41 = "silent"
//!
//! [kit]                      # optional: a kit file, complete or partial
//! format = 1
//! pieces.snare.diameter_in = 13
//! ```
//!
//! Parameters are named as in the preset's kit, or in the standard kit if it has none. A preset without a kit acts on any: its
//! values find their pieces by name, and those of pieces that a kit does not have are left out.
//!
//! How one's instrument is wired up (map, channel, curve, chokes, quality) belongs to the player and not to the
//! sound: it stays as it is unless a preset names it. The presets of the instrument are built in; the user's own
//! are files in a [`Library`]'s folder.

mod error;
mod file;
mod library;
mod preset;
mod programs;

pub use error::PresetError;
pub use library::{Entry, Library, Origin, load_file};
pub use preset::{DEFAULT, FACTORY, FORMAT, Preset, is_set_up};
pub use programs::{Program, Programs};

#[cfg(test)]
mod tests;
