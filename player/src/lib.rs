//! The player of the kit: everything between a note and the engine that needs no host and no window.
//!
//! In reading order: a [`kit_document`] is a kit with the notes that play it, and a [`kit_file`] its text, which [`kit_edits`] change by hand; a host's note goes
//! through the [`midi_map`] to the [`performer`], which owns the engine's kit; [`parameters`] is the table of everything a host
//! may automate, [`presets`] are values of it, and [`state`] is what a project stores. [`building`] says which pieces are wanted,
//! [`builder`] makes them on threads of its own, and [`cache`] holds tables that outlive the process. [`workers`] render pieces
//! beside the audio thread. [`strokes`] carries strokes of a hand to the audio thread, [`deadline`] counts buffers that are
//! late, and [`decimation`] serves hosts whose sample rate is too low for the engine.
#![deny(unsafe_code)]

pub mod builder;
pub mod building;
pub mod cache;
pub mod deadline;
pub mod decimation;
mod denormals;
pub mod kit_document;
pub mod kit_edits;
pub mod kit_file;
pub mod library;
pub mod midi;
pub mod midi_map;
pub mod parameters;
pub mod performer;
pub mod placing;
pub mod presets;
pub mod state;
pub mod strokes;
pub mod workers;

/// The instrument's name in hosts.
pub const NAME: &str = "Overhear";

/// The plugin's id in CLAP hosts. Frozen: projects find it by this.
pub const CLAP_ID: &str = "org.overhear.overhear";

/// Name in hosts of the instrument with an output for every slot.
pub const MULTI_NAME: &str = "Overhear Multi";

/// Id in CLAP hosts of the instrument with an output for every slot. Frozen.
pub const MULTI_CLAP_ID: &str = "org.overhear.overhear-multi";
