//! The instrument: a physically modelled drum kit.
//!
//! A [`Kit`](kit::Kit) renders [`Piece`](piece::Piece)s; a piece is a drum or a cymbal; drums are made of a membrane,
//! cymbals of a plate; both vibrate as a [`ModalBody`](modal::ModalBody) and are set going through the one law in
//! [`contact`].
//!
//! The modules stand here from top to bottom: each imports from those below it only. `tests/tests/tidy/direction.rs` reads
//! the imports.
//!
//! The crate knows no host, no MIDI, no parameters, no window, no file and no clock. After
//! construction nothing in it allocates, locks, blocks or fails.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

// The kit: who plays when, how sound gets about, the mix.
pub mod kit;

// A piece of it: struck, heard, put to sleep. What it is, is described first.
pub mod piece;
pub mod kit_spec;

// The instruments.
pub mod hi_hat;
pub mod cymbal;
pub mod drum;

// What all instruments can be asked.
pub mod instrument;

// The struck body: modes, contacts, and what is attached.
pub mod surface;
pub mod high_band;
pub mod rim;
pub mod shell;

// Heads, plates, cavities: from descriptions to modes, shapes, losses.
pub mod shapes;
pub mod von_karman;
pub mod membrane;
pub mod damping;
pub mod plate;
pub mod cavity;
pub mod random_field;
pub mod split;
pub mod mode_mixture;
pub mod patch_factors;

// What they are made of: a body of modes, forces, contacts, strikers, the air about.
pub mod potential;
pub mod transport;
pub mod strike;
pub mod stick;
pub mod contact;
pub mod modal;
pub mod radiation;
pub mod air_load;
pub mod diffraction;
pub mod grip;
pub mod glide;

// Where everything stands and how it is built.
pub mod build_context;
pub mod microphones;
pub mod contour;
pub mod layout;
pub mod receiver;

// Small things that all share.
pub mod snapshot;
pub mod slot;
pub mod mode;
pub mod block;
pub mod level;
pub mod numbers;
pub mod error;
pub mod fitted;
pub mod schema;

// Functions and numerical methods.
pub mod math;

// Results of long calculations, shared.
pub mod cache;

#[cfg(test)]
mod reference;

pub use schema::SCHEMA;
