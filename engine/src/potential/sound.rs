//! Sound of a nonlinear force itself.

use crate::modal::{InputVector, ModalBody, Pressure, ReceiverWeights};

/// Time over which the rate of change of a force is taken, s: up to 1.6 kHz. *Judgement*: the modes that a stretching plate is heard
/// by at other frequencies than their own are its lowest ones, from 250 Hz to 1 kHz; far above, the held force's steps would be
/// heard.
const RATE_TIME: f64 = 1e-4;

/// Pressures at the receivers.
#[derive(Default)]
pub(super) struct Sound {
    /// Pressure proportional to `psibar`, per unit of it, Pa.
    direct: Pressure,
    /// Pressure per unit rate of change of `psibar`, Pa s, and the low-passed force times it, Pa s.
    rate: Pressure,
    lag: Pressure,
    /// The latest `psibar`.
    force: f32,
    /// Pressure of the latest exchange with the velocities, Pa, for one sample.
    rescale_velocity: Pressure,
}

impl Sound {
    /// Follows a new gradient.
    pub(super) fn follow(&mut self, body: &ModalBody, weights: &ReceiverWeights, input: &InputVector) {
        self.direct = weights.direct_at(body, input);
        self.rate = weights.rate_at(body, input);
    }

    /// Follows receiver weights that have moved, so that the pressures per unit of `psibar` (Pa) and of its rate (Pa s) have changed
    /// at a receiver. What the force has done is not heard again: only its own changes are.
    pub(super) fn sway(&mut self, receiver: usize, direct: f32, rate: f32) {
        self.direct[receiver] += direct;
        self.rate[receiver] += rate;
        self.lag[receiver] += self.force * rate;
    }

    /// Adds the pressure of scaled velocities, Pa.
    pub(super) fn rescale_velocity(&mut self, heard: Pressure) {
        self.rescale_velocity
            .iter_mut()
            .zip(heard)
            .for_each(|(sum, rescale_velocity)| *sum += rescale_velocity);
    }

    /// Pressure of a force held over a sample of `dt` s, Pa.
    pub(super) fn heard(&mut self, force: f32, dt: f64) -> Pressure {
        self.force = force;
        std::array::from_fn(|receiver| {
            let rate = (force * self.rate[receiver] - self.lag[receiver]) * (1.0 / RATE_TIME) as f32;
            self.lag[receiver] += rate * dt as f32;
            force * self.direct[receiver] + rate + std::mem::take(&mut self.rescale_velocity[receiver])
        })
    }

    /// Forgets the past force.
    pub(super) fn reset(&mut self) {
        (self.lag, self.force, self.rescale_velocity) = (Pressure::default(), 0.0, Pressure::default());
    }
}
