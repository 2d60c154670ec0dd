//! Overhear as a plugin.
//!
//! In reading order: a [`kit_document`] is a kit with the notes that play it, and a [`kit_file`] its text; a host's note goes
//! through the [`midi_map`] to the [`performer`], which owns the engine's kit; [`parameters`] is the table of everything a host
//! may automate. These know no framework, and the commands share them with the plugin.
//!
//! With the feature `framework`, around them: [`plugin`] is the instance a host holds,
//! [`builder`] the thread that makes its pieces, [`shelf`] what outlives it, [`host_parameters`], [`view`] and [`state`] what a project
//! stores, [`monitor`] what the [`editor`] may know, [`sound`] what it may hear, [`strokes`] what is struck there.
#![deny(unsafe_code)]

#[cfg(feature = "framework")]
pub mod builder;
pub mod building;
pub mod bypass;
pub mod deadline;
#[cfg(feature = "framework")]
pub mod editor;
#[cfg(feature = "framework")]
pub mod host_parameters;
pub mod kit_document;
pub mod kit_file;
pub mod midi;
pub mod midi_map;
#[cfg(feature = "framework")]
pub mod monitor;
#[cfg(feature = "framework")]
pub mod outputs;
pub mod parameters;
pub mod performer;
pub mod placing;
#[cfg(feature = "framework")]
pub mod plugin;
pub mod presets;
pub mod shelf;
#[cfg(feature = "framework")]
pub mod sound;
#[cfg(feature = "framework")]
pub mod state;
pub mod strokes;
#[cfg(feature = "framework")]
pub mod view;

/// The instrument's name in hosts.
pub const NAME: &str = "Overhear";

/// The plugin's id in CLAP hosts. Frozen: projects find it by this.
pub const CLAP_ID: &str = "org.overhear.overhear";

/// Name in hosts of the instrument with an output for every slot.
pub const MULTI_NAME: &str = "Overhear Multi";

/// Id in CLAP hosts of the instrument with an output for every slot. Frozen.
pub const MULTI_CLAP_ID: &str = "org.overhear.overhear-multi";

#[cfg(feature = "framework")]
mod entry;
