//! Overhear on the command line, for users: what the program `overhear` does, and what the repository's own automation
//! and its tests build on. It needs no checkout of the sources.
//!
//! In reading order: [`commands`] says which commands there are and what they take. `render` ([`render`]) turns a MIDI file
//! ([`song`], of [`message`]s) into sound through a [`player`], which is either the engine itself or the built plugin in an embedded
//! [`host`], found in the [`plugin_folders`]; [`wav`] and [`output`] put it on disk. `hear` ([`hear`]) strikes one piece and
//! measures it; `modes` ([`modes`]) lists what vibrates; [`kit`] and [`presets`] keep files of kits and presets; [`bench`](mod@bench)
//! measures what all that costs. [`settings`] and [`stage`] read what a command moves, [`error`] says what was wrong.
#![deny(unsafe_op_in_unsafe_fn)]

pub mod bench;
pub mod commands;
pub mod error;
pub mod hear;
pub mod host;
pub mod kit;
pub mod message;
pub mod modes;
pub mod output;
pub mod player;
pub mod plugin_folders;
pub mod presets;
pub mod progress;
pub mod render;
pub mod settings;
pub mod song;
pub mod stage;
pub mod wav;

pub use overhear_measure::bad_input;
