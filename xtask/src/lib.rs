//! The commands of Overhear: what `cargo xtask` does, and what its tests build on.
//!
//! In reading order: [`cli`] says which commands there are and what they take. `render`
//! ([`render`]) turns a MIDI file ([`song`]) into sound through a [`player`], which is either the
//! engine itself or the built plugin in an embedded [`host`]; [`wav`] and [`output`] put it on
//! disk. `hear` ([`hear`]) strikes one piece and measures it ([`analysis`]); `realism`
//! ([`realism`]) sets every piece beside recordings; [`report`] writes pages of figures, measured with [`overhear_lab`];
//! [`manual`] those of the manual that come from the code; [`presets`] keeps presets, [`kit`] kit files; `modes` ([`modes`]) lists what vibrates.
//! [`demo`] plays the [`groove`] and draws a [`picture`] of it; [`shots`] takes pictures of the editor. [`bundle`] and [`suite`] build and test.
#![deny(unsafe_op_in_unsafe_fn)]

pub mod analysis;
pub mod bench;
pub mod bundle;
pub mod cli;
pub mod demo;
pub mod error;
pub mod groove;
pub mod hear;
pub mod host;
pub mod kit;
mod levels;
pub mod manual;
pub mod modes;
pub mod output;
pub mod picture;
pub mod player;
pub mod presets;
pub mod progress;
pub mod realism;
pub mod render;
pub mod report;
pub mod settings;
pub mod shots;
pub mod song;
pub mod stage;
pub mod suite;
pub mod system;
pub mod wav;
pub mod workspace;
