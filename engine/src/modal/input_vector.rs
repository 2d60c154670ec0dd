//! Input vectors: the weights with which a force acts on the modes.

use super::row::{Row, zero_row};
use super::simd::ring::Drive;

/// Weights with which a force acts on the modes: the mode shapes at a point, or over a patch.
pub struct InputVector {
    /// Mode shapes at the point, `[mode]`.
    pub(super) shape: Row,
    /// `b` times the shape.
    pub(super) gain_re: Row,
    pub(super) gain_im: Row,
}

impl InputVector {
    /// A vector of zeros. Allocates.
    pub fn new(modes: usize) -> InputVector {
        InputVector { shape: zero_row(modes), gain_re: zero_row(modes), gain_im: zero_row(modes) }
    }

    /// Mode shapes at the point, `[mode]`, relative to the modal displacement; call [`ModalBody::connect`](super::ModalBody::connect) after a
    /// change.
    pub fn shape_mut(&mut self) -> &mut [f32] {
        &mut self.shape
    }

    /// Mode shapes at the point, `[mode]`, relative to the modal displacement, padded.
    pub fn shape(&self) -> &[f32] {
        &self.shape
    }

    /// The modes from `first` on as forces (N) in turns drive them.
    pub(super) fn drive<'a>(&'a self, first: usize, forces: &'a [f32], turns: usize) -> Drive<'a> {
        Drive { gain_re: &self.gain_re[first..], gain_im: &self.gain_im[first..], forces, turns }
    }
}
