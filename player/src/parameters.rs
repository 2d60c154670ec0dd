//! The parameters: one table that the host, the editor, presets and `--set` all read.
//!
//! First come those of the 16 slots of a kit, as many for each slot, whatever stands there; then those of the whole kit. What
//! needs building (sizes, heads, metals) is no parameter but in the kit.
//!
//! Ids are stored in projects and presets and hashed by hosts: once released, an id, its meaning
//! and the order of the table never change. New parameters are appended.
//!
//! Values are single precision multiples of [`Parameter::step`]. Hosts carry a value as a share
//! of the range and lose its last bits; rounding to a step finds them again, so that a project, a
//! preset and a command line that ask for the same value get the same samples.

mod document;
mod error;
mod in_kit;
mod list;
mod parameter;
mod slot;
mod table;

pub use document::{about, document};
pub use error::ParameterError;
pub use in_kit::{default_value, find, from_text, is_live, name, parse_assignment, parse_value, range, text};
pub use list::{COUNT, SLOT_COUNT, host_id, parameters, slot_index, slot_parameter, stepped};
pub use parameter::{Construction, Drives, Manner, Parameter, SlotParameter, Stand};
pub use slot::number;

/// Id of the host's bypass. Frozen. No parameter of the table: presets and command lines have nothing to bypass.
pub const BYPASS_ID: &str = "bypass";

/// Group in which hosts list the bypass.
pub const BYPASS_GROUP: &str = "Kit";

#[cfg(test)]
mod tests;
