//! Receivers of a body's sound.

use super::row::{Row, zero_row};
use super::simd::{self, RECEIVERS};

/// Pressure of a body at each of its receivers, Pa.
pub type Pressure = [f32; RECEIVERS];

/// Weights of each receiver: its pressure is a weighted sum over the modes' states plus a part proportional to the force.
/// The last receiver takes the first modes only: see [`attend`](ReceiverWeights::attend).
pub struct ReceiverWeights {
    pub(super) receivers: [Receiver; RECEIVERS],
}

/// One receiver.
pub(super) struct Receiver {
    /// Transfer from each mode's acceleration to the pressure: real part, imaginary part, `[mode]`.
    pub(super) transfer: Vec<[f64; 2]>,
    pub(super) weight_re: Row,
    pub(super) weight_im: Row,
    pub(super) direct: Row,
    pub(super) slow: Row,
}

impl ReceiverWeights {
    /// Weights of the first receiver from the complex transfer `[mode]`, pressure over modal acceleration (Pa s2/m) at
    /// the mode's frequency, for time going as `e^(i omega t)`. The transfers of the other receivers are zero until they are
    /// [set](Self::transfer_mut). Allocates.
    pub fn new(transfer: Vec<[f64; 2]>) -> ReceiverWeights {
        let far = vec![[0.0; 2]; transfer.len()];
        ReceiverWeights {
            receivers: [Receiver::new(transfer), Receiver::new(far), Receiver::new(Vec::new())],
        }
    }

    /// Lets the last receiver take the first `modes`. Allocates.
    pub fn attend(&mut self, modes: usize) {
        self.receivers[RECEIVERS - 1] = Receiver::new(vec![[0.0; 2]; modes]);
    }

    /// The transfer from each mode's acceleration to a receiver, Pa s2/m, `[mode]`. After a change call
    /// [`ModalBody::tune`](super::ModalBody::tune).
    pub fn transfer_mut(&mut self, receiver: usize) -> &mut [[f64; 2]] {
        &mut self.receivers[receiver].transfer
    }
}

impl Receiver {
    fn new(transfer: Vec<[f64; 2]>) -> Receiver {
        let row = || zero_row(transfer.len() + simd::REST);
        Receiver { weight_re: row(), weight_im: row(), direct: row(), slow: row(), transfer }
    }

    /// The weights from mode `first` on, for [`ModalBody::ring`](super::ModalBody::ring).
    pub(super) fn from<'a>(&'a self, first: usize, out: &'a mut [f32]) -> simd::ring::PressureSum<'a> {
        let from = |row: &'a [f32]| row.get(first..).unwrap_or_default();
        simd::ring::PressureSum { weight_re: from(&self.weight_re), weight_im: from(&self.weight_im), out }
    }
}
