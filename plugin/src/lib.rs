//! Overhear as a plugin.
//!
//! In reading order: a host's note goes through the [`midi_map`] to the [`performer`], which owns
//! the engine's kit; [`parameters`] is the table of everything a host may automate. These three
//! know no framework, and the commands share them with the plugin.
#![deny(unsafe_code)]

pub mod midi_map;
pub mod parameters;
pub mod performer;
