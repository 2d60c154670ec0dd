//! The measuring library: pieces built, struck, rendered and measured, for the tests, the pages of the report and the
//! command-line program.
//!
//! In reading order: [`spectra`] transform a sound and [`analysis`] says what can be measured on any, held against sounds
//! made for the purpose. [`standard()`] is the kit that is played, [`reference`](mod@reference) names bodies that nobody plays, [`random`] draws
//! pieces; [`render`] makes them sound. [`hear`] strikes one piece and measures it, [`realism`] sets every piece beside
//! recordings, [`report`] makes pages of figures with a [`picture`] here and there.
//!
//! It knows the engine and the part of the plugin that needs no framework, reads and writes no file, and prints nothing.

pub mod analysis;
mod chance;
pub mod error;
pub mod hear;
pub mod picture;
pub mod random;
pub mod realism;
pub mod reference;
mod rendering;
pub mod report;
pub mod settings;
pub mod spectra;
mod standard;

use overhear_engine::piece::Piece;
use overhear_engine::strike::{Strike, Striker};

pub use chance::Chance;
pub use rendering::{render, render_everywhere, render_into, render_surface};
pub use standard::{
    alone, altered, build, context, drum, kit, kit_of, lossless_piece, member, names, piece, plate,
    round_piece, slot, spec, standard,
};

/// Sample rates that hosts use, Hz.
pub const RATES: [f64; 4] = [44_100.0, 48_000.0, 96_000.0, 192_000.0];

/// A stroke at a speed (m/s), a place (share of the radius) and an angle (rad).
pub fn stroke(striker: Striker, speed: f64, radius: f64, angle: f64) -> Strike {
    Strike { speed, radius, angle, striker }
}

/// Energy of a piece, of the strikers about it and of those that have left, J.
pub fn total_energy(piece: &Piece) -> f64 {
    piece.energy() + piece.striker_energy() + piece.departed_energy() + piece.scattered_energy()
}

/// How far `a` is above `b`, cents.
pub fn cents(a: f64, b: f64) -> f64 {
    1200.0 * (a / b).log2()
}

/// How much larger an amplitude `a` is than `b`, dB.
pub fn decibels(a: f64, b: f64) -> f64 {
    20.0 * (a / b).log10()
}
