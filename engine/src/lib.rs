//! The instrument: a physically modelled drum kit.
//!
//! In reading order: a [`Kit`](kit::Kit) renders [`Piece`](piece::Piece)s; a piece is a drum or a
//! cymbal; drums are made of a membrane, cymbals of a plate; both vibrate as a
//! [`ModalBody`](modal::ModalBody) and are set going through the one law in [`contact`].
//!
//! The crate knows no host, no MIDI, no parameters, no window, no file and no clock. After
//! construction nothing in it allocates, locks, blocks or fails.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod air;
pub mod cavity;
pub mod contact;
pub mod cymbal;
pub mod damping;
pub mod drum;
pub mod error;
pub mod fitted;
pub mod glide;
pub mod hi_hat;
pub mod high_band;
pub mod kit;
pub mod kit_spec;
pub mod layout;
pub mod listening;
pub mod math;
pub mod membrane;
pub mod microphones;
pub mod modal;
pub mod numbers;
pub mod piece;
pub mod plate;
pub mod potential;
#[cfg(test)]
mod reference;
pub mod rim;
pub mod shapes;
pub mod slot;
pub mod snapshot;
pub mod split;
pub mod stick;
pub mod strike;
pub mod surface;
pub mod von_karman;

/// Stands for the version of the equations, the libraries that calculate and the kind of processor: results that another
/// one has cached are not this one's. The number before the dash counts up whenever the same description comes to other
/// modes, masses, losses or pressures; `tests/tests/kept.rs` fails when it was forgotten.
pub const MARK: &str = concat!("2-", env!("OVERHEAR_LIBRARIES_MARK"));
