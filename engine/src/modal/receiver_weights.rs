//! Receivers of a body's sound.

use super::coefs::{Constants, TOGETHER};
use super::row::{Row, zero_row};
use super::simd::{self, RECEIVERS};
use crate::receiver::POINTS;

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
    pub(super) rate: Row,
}

impl ReceiverWeights {
    /// Weights of the first receiver from the complex transfer `[mode]`, pressure over modal acceleration (Pa s2/m) at
    /// the mode's frequency, for time going as `e^(i omega t)`. The transfers of the other receivers are zero until they are
    /// [set](Self::transfer_mut). Allocates.
    pub fn new(transfer: Vec<[f64; 2]>) -> ReceiverWeights {
        let modes = transfer.len();
        let mut receivers = std::array::from_fn(|receiver| {
            Receiver::new(vec![[0.0; 2]; if receiver < POINTS { modes } else { 0 }])
        });
        receivers[0] = Receiver::new(transfer);
        ReceiverWeights { receivers }
    }

    /// Lets the last receiver take the first `modes`. Allocates.
    pub fn attend(&mut self, modes: usize) {
        self.receivers[RECEIVERS - 1] = Receiver::new(vec![[0.0; 2]; modes]);
    }

    /// Weights of the state at each receiver, real and imaginary part, `[mode]`.
    pub(super) fn rows(&self) -> [[&[f32]; 2]; RECEIVERS] {
        self.receivers.each_ref().map(|receiver| [&receiver.weight_re[..], &receiver.weight_im[..]])
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
        Receiver { weight_re: row(), weight_im: row(), direct: row(), rate: row(), transfer }
    }

    /// Updates the weights of the modes from `first` on, `modes` at a time step of `dt` (s).
    #[inline(always)]
    pub(super) fn tune(&mut self, first: usize, modes: &Constants<TOGETHER>, dt: f64) {
        let Receiver { transfer, weight_re, weight_im, direct, rate } = self;
        let new = weights_of(&transfer[first..], modes, dt);
        for (row, new) in [weight_re, weight_im, direct, rate].into_iter().zip(&new) {
            row[first..first + TOGETHER].copy_from_slice(new);
        }
    }

    /// All weights: of the real and the imaginary part of the state, of the force, and of its rate of change.
    pub(super) fn rows_mut(&mut self) -> [&mut Row; 4] {
        [&mut self.weight_re, &mut self.weight_im, &mut self.direct, &mut self.rate]
    }

    /// The weights from mode `first` on, for [`ModalBody::ring`](super::ModalBody::ring).
    pub(super) fn from<'a>(&'a self, first: usize, out: &'a mut [f32]) -> simd::ring::PressureSum<'a> {
        let from = |row: &'a [f32]| row.get(first..).unwrap_or_default();
        simd::ring::PressureSum { weight_re: from(&self.weight_re), weight_im: from(&self.weight_im), out }
    }
}

/// Weights of the modes' transfers at a time step of `dt` (s): of the real and the imaginary part of the state, of the force, and
/// of its rate of change.
#[inline(always)]
pub(super) fn weights_of(
    transfer: &[[f64; 2]],
    modes: &Constants<TOGETHER>,
    dt: f64,
) -> [[f32; TOGETHER]; 4] {
    let mut transfers = [[0.0; 2]; TOGETHER];
    transfers.iter_mut().zip(transfer).for_each(|(to, from)| *to = *from);
    let mut new = [[0.0_f32; TOGETHER]; 4];
    for i in 0..TOGETHER {
        let (mode, [h_re, h_im]) = (modes.mode(i), transfers[i]);
        let (omega_d, sigma) = (mode.omega_d(), mode.sigma);
        // The imaginary part reads the real part of the state, `(q' + sigma q) / omega_d`, which near critical damping is far
        // larger than the motion: scaled by `omega_d / omega`, it is heard as loud as the motion is. With a hundredth of critical
        // damping this changes it by 5e-5. A judgement: no equation for a phase near critical damping is at hand.
        let h_im = h_im * omega_d / (omega_d * omega_d + sigma * sigma).sqrt();
        let heard = omega_d * dt < std::f64::consts::PI;
        let (l2_re, l2_im) = (sigma * sigma - omega_d * omega_d, -2.0 * sigma * omega_d);
        let all = [
            h_re * l2_im + h_im * l2_re,
            h_re * l2_re - h_im * l2_im,
            (h_re * omega_d - h_im * sigma) / (mode.mass * omega_d),
            h_im / (mode.mass * omega_d),
        ];
        for (row, x) in new.iter_mut().zip(all) {
            row[i] = if heard { x as f32 } else { 0.0 };
        }
    }
    new
}
