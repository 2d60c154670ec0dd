//! Overhear as a plugin: the shell around the [player](overhear_player).
//!
//! [`plugin`] is the instance a host holds, [`outputs`] what it plays into; [`host_parameters`] are the player's parameters as
//! the framework wants them, and [`view`] and [`state`] what a project stores besides; [`scale`] is what a screen's pixels are to
//! a window; [`monitor`] is what the [`editor`] may
//! know, [`sound`] what it may hear. [`guard`] keeps panics from
//! the host. The entry points that hosts look for are private.
#![deny(unsafe_code)]

pub mod bypass;
pub mod editor;
pub mod guard;
pub mod host_parameters;
mod incoming;
pub mod monitor;
pub mod outputs;
pub mod plugin;
pub mod scale;
pub mod sound;
pub mod state;
pub mod view;

mod entry;
