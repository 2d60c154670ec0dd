//! How a nonlinear force is heard: what follows it at once.

use crate::modal::{InputVector, ModalBody, Pressure, ReceiverWeights};

/// Time constant below which a force is slow, s: 100 Hz, under all that is heard of a cymbal's
/// stretching and far over the sway of its mean. *Derived*.
const SLOW_TIME: f64 = 1.6e-3;

/// Pressures at the receivers.
#[derive(Default)]
pub(super) struct Sound {
    /// Pressure at once per unit of `psibar`, Pa.
    direct: Pressure,
    /// Pressure per unit rate of change of `psibar`, Pa s, and the force's slow part heard by it, Pa s.
    slow: Pressure,
    lag: Pressure,
    /// Pressure of the latest exchange with the velocities, Pa, for one sample.
    rescale_velocity: Pressure,
}

impl Sound {
    /// Follows a new gradient.
    pub(super) fn follow(&mut self, body: &ModalBody, pickup: &ReceiverWeights, port: &InputVector) {
        self.direct = pickup.direct_at(body, port);
        self.slow = pickup.slow_at(body, port);
    }

    /// The velocities were scaled: that is heard, Pa.
    pub(super) fn rescale_velocity(&mut self, heard: Pressure) {
        self.rescale_velocity
            .iter_mut()
            .zip(heard)
            .for_each(|(sum, rescale_velocity)| *sum += rescale_velocity);
    }

    /// What is heard at once of a force held over a sample of `dt` s, Pa.
    pub(super) fn heard(&mut self, force: f32, dt: f64) -> Pressure {
        std::array::from_fn(|ear| {
            // The rate of the slow part: of what changes faster the velocity is right.
            let rate = (force * self.slow[ear] - self.lag[ear]) * (1.0 / SLOW_TIME) as f32;
            self.lag[ear] += rate * dt as f32;
            force * self.direct[ear] + rate + std::mem::take(&mut self.rescale_velocity[ear])
        })
    }

    /// Nothing is heard any more of what was.
    pub(super) fn reset(&mut self) {
        (self.lag, self.rescale_velocity) = (Pressure::default(), Pressure::default());
    }
}
