//! How a nonlinear force is heard: what follows it at once.

use crate::modal::{Heard, ModalBody, Pickup, Port};

/// Time constant below which a force is slow, s: 100 Hz, under all that is heard of a cymbal's
/// stretching and far over the sway of its mean. *Derived*.
const SLOW_TIME: f64 = 1.6e-3;

/// Pressures at the receivers.
#[derive(Default)]
pub(super) struct Sound {
    /// Pressure at once per unit of `psibar`, Pa.
    direct: Heard,
    /// Pressure per unit rate of change of `psibar`, Pa s, and the force's slow part heard by it, Pa s.
    slow: Heard,
    lag: Heard,
    /// Pressure of the latest exchange with the velocities, Pa, for one sample.
    jolt: Heard,
}

impl Sound {
    /// Follows a new gradient.
    pub(super) fn follow(&mut self, body: &ModalBody, pickup: &Pickup, port: &Port) {
        self.direct = pickup.direct_at(body, port);
        self.slow = pickup.slow_at(body, port);
    }

    /// The velocities were scaled: that is heard, Pa.
    pub(super) fn jolt(&mut self, heard: Heard) {
        self.jolt.iter_mut().zip(heard).for_each(|(sum, jolt)| *sum += jolt);
    }

    /// What is heard at once of a force held over a sample of `dt` s, Pa.
    pub(super) fn heard(&mut self, force: f32, dt: f64) -> Heard {
        std::array::from_fn(|ear| {
            // The rate of the slow part: of what changes faster the velocity is right.
            let rate = (force * self.slow[ear] - self.lag[ear]) * (1.0 / SLOW_TIME) as f32;
            self.lag[ear] += rate * dt as f32;
            force * self.direct[ear] + rate + std::mem::take(&mut self.jolt[ear])
        })
    }

    /// Nothing is heard any more of what was.
    pub(super) fn reset(&mut self) {
        self.lag = Heard::default();
    }
}
