//! Receiver weights that move: of a body that turns while it rings.
//!
//! The weights of the receivers at all points go to new ones in even steps, those of the state for all modes and those of the
//! force for the coupled ones: the quasi-static sound of a nonlinear force is the small difference of the two.
//!
//! Limits: what strikers and the incident sound press at once is heard as before the step. It lasts a contact, or is small.

use std::ops::Range;

use super::coefs::{Constants, TOGETHER};
use super::receiver_weights::weights_of;
use super::row::{Row, zero_row};
use super::{InputVector, ModalBody, ReceiverWeights};
use crate::receiver::POINTS;

/// Weights of a mode at a receiver: of the real and the imaginary part of its state, of the force, and of its rate of change.
const WEIGHTS: usize = 4;

/// Where the weights go, and their steps on the way.
pub struct Sway {
    /// `[receiver][mode]`: the transfers, Pa s2/m.
    transfers: [Vec<[f64; 2]>; POINTS],
    /// `[receiver][weight][mode]`.
    goal: [[Row; WEIGHTS]; POINTS],
    step: [[Row; WEIGHTS]; POINTS],
    /// Steps left.
    left: usize,
}

impl Sway {
    /// Nothing moves yet, of so many modes, of which the first are `coupled`. Allocates.
    pub fn new(modes: usize, coupled: usize) -> Sway {
        let lengths = [modes, modes, coupled.min(modes), coupled.min(modes)];
        let rows = || std::array::from_fn(|_| lengths.map(zero_row));
        let transfers = std::array::from_fn(|_| vec![[0.0; 2]; modes]);
        Sway { transfers, goal: rows(), step: rows(), left: 0 }
    }

    /// The next transfers to the receivers at all points, Pa s2/m, `[mode]`, to be [aimed](ModalBody::aim) at.
    pub fn transfers_mut(&mut self) -> [&mut [[f64; 2]]; POINTS] {
        self.transfers.each_mut().map(|transfers| &mut transfers[..])
    }

    /// How the pressures per unit force along an input vector of coupled modes change in a step, at once (Pa/N) and by its rate
    /// (Pa s/N), `[receiver]`.
    pub fn step_along(&self, body: &ModalBody, input: &InputVector) -> [[f32; 2]; POINTS] {
        self.step.each_ref().map(|[.., direct, rate]| {
            [direct, rate].map(|row| {
                let n = row.len().min(input.shape().len());
                body.kernels.dot(&row[..n], &input.shape()[..n])
            })
        })
    }

    /// Whether weights move.
    pub fn moves(&self) -> bool {
        self.left > 0
    }

    /// Leaves the weights where they are.
    pub fn stop(&mut self) {
        self.left = 0;
    }
}

impl ModalBody {
    /// Works out the weights that the next transfers of some modes ask for.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn aim(&self, sway: &mut Sway, modes: Range<usize>) {
        let Sway { transfers, goal, .. } = sway;
        let first = modes.start / TOGETHER * TOGETHER;
        for first in (first..modes.end.min(self.modes.len())).step_by(TOGETHER) {
            let constants = Constants::of(&self.modes[first..]);
            for (transfers, goal) in transfers.iter().zip(&mut *goal) {
                self.kernels.vectorized(
                    #[inline(always)]
                    || {
                        let weights = weights_of(&transfers[first..], &constants, self.dt);
                        for (goal, weights) in goal.iter_mut().zip(&weights) {
                            let goal = goal.iter_mut().skip(first).zip(weights);
                            goal.for_each(|(goal, weight)| *goal = *weight);
                        }
                    },
                );
            }
        }
    }

    /// Sets out for the weights aimed at, in so many steps.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn set_out(&self, sway: &mut Sway, weights: &mut ReceiverWeights, steps: usize) {
        let Sway { transfers, goal, step, left } = sway;
        for (i, receiver) in weights.receivers.iter_mut().enumerate().take(POINTS) {
            receiver.transfer.copy_from_slice(&transfers[i]);
            let share = 1.0 / steps as f32;
            let rows = receiver.rows_mut();
            for ((step, goal), row) in step[i].iter_mut().zip(&goal[i]).zip(rows) {
                let ways = goal.iter().zip(row.iter());
                step.iter_mut().zip(ways).for_each(|(step, (goal, at))| *step = share * (goal - at));
            }
        }
        *left = steps;
    }

    /// Moves the weights by a step. False if none is left.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn sway(&self, sway: &mut Sway, weights: &mut ReceiverWeights) -> bool {
        if sway.left == 0 {
            return false;
        }
        sway.left -= 1;
        for (receiver, steps) in weights.receivers.iter_mut().zip(&sway.step) {
            for (row, step) in receiver.rows_mut().into_iter().zip(steps) {
                self.kernels.axpy(&mut row[..step.len()], step, 1.0);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::modal::Mode;

    #[test]
    fn weights_arrive_at_those_of_the_new_transfers() {
        let modes: Vec<Mode> =
            (1..=37).map(|k| Mode { omega: TAU * 100.0 * f64::from(k), sigma: 3.0, mass: 0.1 }).collect();
        let body = ModalBody::new(modes, 44_100.0);
        let transfer =
            |k: usize, shift: f64| [(0.3 * k as f64 + shift).sin(), (0.7 * k as f64 + shift).cos()];
        let with = |shift: f64| {
            let mut weights = ReceiverWeights::new((0..37).map(|k| transfer(k, shift)).collect());
            body.tune(&mut weights);
            weights
        };
        let (mut weights, mut goal, mut sway) = (with(0.0), with(0.4), Sway::new(37, 37));
        (0..37).for_each(|k| sway.transfers_mut()[0][k] = transfer(k, 0.4));
        body.aim(&mut sway, 0..20);
        body.aim(&mut sway, 20..37);
        body.set_out(&mut sway, &mut weights, 16);
        assert!((0..16).all(|_| body.sway(&mut sway, &mut weights)) && !body.sway(&mut sway, &mut weights));
        assert!(!sway.moves());
        let [near, want] = [&mut weights, &mut goal].map(|weights| &mut weights.receivers[0]);
        assert_eq!(near.transfer, want.transfer);
        for (weight, (near, want)) in near.rows_mut().into_iter().zip(want.rows_mut()).enumerate() {
            let largest = want.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
            for k in 0..37 {
                assert!((near[k] - want[k]).abs() < 1e-5 * largest, "weight {weight} of mode {k}");
            }
        }
    }
}
