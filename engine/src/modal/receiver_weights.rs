//! Points from which a body is heard.

use super::row::{Row, zero_row};
use super::simd::{self, RECEIVERS};

/// What is heard of a body at each of its ears, Pa.
pub type Pressure = [f32; RECEIVERS];

/// Where the body is heard: weighted sums over the modes' states, plus a part that follows the force at once. The last
/// ear hears the first modes alone: see [`attend`](ReceiverWeights::attend).
pub struct ReceiverWeights {
    pub(super) ears: [Receiver; RECEIVERS],
}

/// One point where the body is heard.
pub(super) struct Receiver {
    /// Transfer from each mode's acceleration to the pressure: real part, imaginary part, `[mode]`.
    pub(super) transfer: Vec<[f64; 2]>,
    pub(super) weight_re: Row,
    pub(super) weight_im: Row,
    pub(super) direct: Row,
    pub(super) slow: Row,
}

impl ReceiverWeights {
    /// A pickup from the complex transfer `[mode]`, pressure over modal acceleration (Pa s2/m) at
    /// the mode's frequency, for time going as `e^(i omega t)`. The other ears hear nothing, until
    /// [told](Self::transfer_mut). Allocates.
    pub fn new(transfer: Vec<[f64; 2]>) -> ReceiverWeights {
        let far = vec![[0.0; 2]; transfer.len()];
        ReceiverWeights { ears: [Receiver::new(transfer), Receiver::new(far), Receiver::new(Vec::new())] }
    }

    /// Lets the last ear hear so many modes. Allocates.
    pub fn attend(&mut self, modes: usize) {
        self.ears[RECEIVERS - 1] = Receiver::new(vec![[0.0; 2]; modes]);
    }

    /// The transfer from each mode's acceleration to an ear, Pa s2/m, `[mode]`; call [`ModalBody::tune`](super::ModalBody::tune) after a
    /// change.
    pub fn transfer_mut(&mut self, ear: usize) -> &mut [[f64; 2]] {
        &mut self.ears[ear].transfer
    }
}

impl Receiver {
    fn new(transfer: Vec<[f64; 2]>) -> Receiver {
        let row = || zero_row(transfer.len() + simd::REST);
        Receiver { weight_re: row(), weight_im: row(), direct: row(), slow: row(), transfer }
    }

    /// For [`ModalBody::ring`](super::ModalBody::ring), from mode `first` on.
    pub(super) fn from<'a>(&'a self, first: usize, out: &'a mut [f32]) -> simd::ring::PressureSum<'a> {
        let from = |row: &'a [f32]| row.get(first..).unwrap_or_default();
        simd::ring::PressureSum { weight_re: from(&self.weight_re), weight_im: from(&self.weight_im), out }
    }
}
