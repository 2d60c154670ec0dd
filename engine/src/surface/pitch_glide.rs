//! Frequencies of modes that follow the tension a stretched head has for the moment.
//!
//! Model: tension `dT` that is added to a head stiffens every mode by `s dT`, with `s` from the mode's slopes on that head
//! ([`StretchModel::above`](crate::drum::stretch::StretchModel::above)), so that its angular frequency rises by `s dT / (2 M omega)`, to first order.
//! Modes that stretch the head themselves get this from the [nonlinear force](crate::potential). The others hold next to no energy:
//! they turn faster by a rotation ([`ModalBody::shift_frequencies`]), which costs none. `dT` is the mean over the block before,
//! as a rule two thirds of a millisecond.
//!
//! Limits: while a contact lasts, modes turn by their equation, as a force does no work on a rotation.

use crate::modal::{ModalBody, Row, zero_row};
use crate::potential::HEADS;

/// Added tension (N/m) below which nothing is shifted: a thousandth of a cent on the slackest head.
const NOTHING: f64 = 1e-3;

/// The modes of a body that follow.
pub struct PitchGlide {
    first: usize,
    /// Stiffness per tension, dimensionless, `[mode - first][head]`.
    stiffness: Vec<[f64; HEADS]>,
    /// Shift per tension, rad/s over N/m, `[head][mode - first]`.
    rates: [Row; HEADS],
    /// rad/s, `[mode - first]`.
    shifts: Row,
}

impl PitchGlide {
    /// Of a body's modes from `first` on, with their stiffness per tension, dimensionless, `[mode - first][head]`. Allocates.
    pub fn new(first: usize, stiffness: Vec<[f64; HEADS]>, body: &mut ModalBody) -> PitchGlide {
        let row = || zero_row(stiffness.len());
        body.allow_detuning();
        let mut glide = PitchGlide { first, rates: [row(), row()], shifts: row(), stiffness };
        glide.follow(body);
        glide
    }

    /// Follows a change of the modes.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn follow(&mut self, body: &ModalBody) {
        let [near, far] = &mut self.rates;
        let modes = body.modes()[self.first..].iter().zip(&self.stiffness);
        for ((near, far), (mode, stiffness)) in near.iter_mut().zip(&mut **far).zip(modes) {
            let rate = 0.5 / (mode.mass * mode.omega);
            (*near, *far) = ((rate * stiffness[0]) as f32, (rate * stiffness[1]) as f32);
        }
    }

    /// Shifts the modes for the next block by the tension added to each head, N/m.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn shift(&mut self, tensions: [f64; HEADS], body: &mut ModalBody) {
        if tensions.iter().all(|&tension| tension < NOTHING) {
            return body.end_detuning();
        }
        let [near, far] = tensions.map(|tension| tension as f32);
        let [near_rates, far_rates] = &self.rates;
        body.kernels().vectorized(
            #[inline(always)]
            || {
                let rates = near_rates.iter().zip(&**far_rates);
                for (shift, (a, b)) in self.shifts.iter_mut().zip(rates) {
                    *shift = a * near + b * far;
                }
            },
        );
        body.shift_frequencies(self.first, &self.shifts[..self.stiffness.len()]);
    }
}
