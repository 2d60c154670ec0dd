//! What muffles a high band: all of it alike, or what moves under a pad.

use super::slices::Slice;

/// What muffles a high band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighMuffling {
    /// Decay rate added to every slice, 1/s.
    pub even: f64,
    /// Decay rate that a pad adds to a mode of unit square under it, 1/s, and its distance from the centre,
    /// share of the radius.
    pub pad: (f64, f64),
}

impl HighMuffling {
    /// Nothing.
    pub const NONE: HighMuffling = HighMuffling { even: 0.0, pad: (0.0, 0.0) };

    /// With a decay rate added to every slice, 1/s.
    pub fn and_even(self, sigma: f64) -> HighMuffling {
        HighMuffling { even: self.even + sigma, ..self }
    }

    /// Decay rate that it adds to a slice of some square under its pad, 1/s.
    pub(super) fn sigma(&self, under: f64) -> f64 {
        self.even + self.pad.0 * under
    }
}

/// Squares of the slices under a pad.
pub(super) struct UnderPad {
    /// Distance of the pad from the centre, share of the radius.
    at: f64,
    /// `[slice]`.
    squares: Vec<f64>,
}

impl UnderPad {
    /// Of so many slices, under no pad. Allocates.
    pub(super) fn new(slices: usize) -> UnderPad {
        UnderPad { at: f64::NAN, squares: vec![0.0; slices] }
    }

    /// The squares under the pad of a muffling, if it has one; it stays where it is while its amount changes.
    pub(super) fn of(&mut self, muffling: &HighMuffling, slices: &[Slice]) -> &[f64] {
        let (pad, at) = muffling.pad;
        if pad != 0.0 && self.at != at {
            self.at = at;
            for (square, slice) in self.squares.iter_mut().zip(slices) {
                *square = 1.0 - libm::j0(2.0 * slice.zero * (1.0 - at));
            }
        }
        &self.squares
    }
}
