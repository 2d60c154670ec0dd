//! Places on a body where forces act.

use super::row::{Row, zero_row};

/// A place on the body where a force may act: mode shapes there, and what follows from them.
pub struct InputVector {
    /// Mode shapes at the place, `[mode]`.
    pub(super) shape: Row,
    /// `b` times the shape.
    pub(super) gain_re: Row,
    pub(super) gain_im: Row,
}

impl InputVector {
    /// A port with all shapes zero. Allocates.
    pub fn new(modes: usize) -> InputVector {
        InputVector { shape: zero_row(modes), gain_re: zero_row(modes), gain_im: zero_row(modes) }
    }

    /// Mode shapes at the place, `[mode]`, relative to the modal displacement; call [`ModalBody::connect`](super::ModalBody::connect) after a
    /// change.
    pub fn shape_mut(&mut self) -> &mut [f32] {
        &mut self.shape
    }

    /// Mode shapes at the place, `[mode]`, relative to the modal displacement, padded.
    pub fn shape(&self) -> &[f32] {
        &self.shape
    }
}
