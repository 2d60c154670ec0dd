//! The laboratory: pieces built, struck, rendered and measured, for the pages of `cargo xtask report` and for the
//! integration tests. Knows the engine and nothing of the plugin, so that tests with an allocator of their own can use it.
//!
//! What is measured is the played instrument, the [standard kit](standard()), unless a body of [`reference`](mod@reference) is named.

mod chance;
pub mod random;
pub mod reference;
mod rendering;
mod spectrum;
mod standard;

use overhear_engine::piece::Piece;
use overhear_engine::strike::{Strike, Striker};

pub use chance::Chance;
pub use rendering::{render, render_into, render_surface};
pub use spectrum::Spectrum;
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
    piece.energy() + piece.striker_energy() + piece.departed_energy()
}

/// How far `a` is above `b`, cents.
pub fn cents(a: f64, b: f64) -> f64 {
    1200.0 * (a / b).log2()
}

/// How much larger an amplitude `a` is than `b`, dB.
pub fn decibels(a: f64, b: f64) -> f64 {
    20.0 * (a / b).log10()
}
