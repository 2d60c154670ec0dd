//! Sound of a nonlinear force itself.

use crate::modal::{InputVector, ModalBody, Pressure, ReceiverWeights};

/// Time over which the rate of change of a force is taken, s: up to 1.6 kHz. *Judgement*: the modes that a stretching plate is heard
/// by at other frequencies than their own are its lowest ones, from 250 Hz to 1 kHz; far above, the held force's steps would be
/// heard.
const RATE_TIME: f64 = 1e-4;

/// What a gradient sounds like at each receiver.
#[derive(Debug, Clone, Copy, Default)]
struct PressurePerForce {
    /// Pressure proportional to `psibar`, per unit of it, Pa.
    direct: Pressure,
    /// Pressure per unit rate of change of `psibar`, Pa s.
    rate: Pressure,
}

/// Pressures at the receivers.
///
/// The force is held between evaluations. Heard as it is, its steps sound about the rate of evaluation: of a hard crash evaluated at 14.7 kHz they
/// are 10 dB above all else there. The gradient that is heard therefore goes on as it did between the last two evaluations. *Measured*: a parabola
/// through three is no better.
#[derive(Default)]
pub(super) struct Sound {
    /// The latest evaluation and the one before, if there was one since the force woke.
    latest: PressurePerForce,
    before: Option<PressurePerForce>,
    /// Samples from the latest to the next one, from the middle of the interval before to that of this one, and since the latest.
    stride: f32,
    apart: f32,
    since: f32,
    /// The low-passed force times its pressure per rate, Pa s.
    lag: Pressure,
    /// The latest `psibar`.
    force: f32,
    /// Pressure of the latest exchange with the velocities, Pa, for one sample.
    rescale_velocity: Pressure,
}

impl Sound {
    /// Follows a new gradient, held for so many samples.
    pub(super) fn follow(
        &mut self,
        body: &ModalBody,
        weights: &ReceiverWeights,
        input: &InputVector,
        stride: u32,
    ) {
        let stride = stride as f32;
        self.before = (self.stride > 0.0).then_some(self.latest);
        self.latest =
            PressurePerForce { direct: weights.direct_at(body, input), rate: weights.rate_at(body, input) };
        self.apart = 0.5 * (self.stride + stride);
        (self.stride, self.since) = (stride, 0.0);
    }

    /// `psi` has been scaled by this factor, while the force is the same: the gradient per `psi` is less by as much.
    pub(super) fn rescale(&mut self, factor: f32) {
        for part in [&mut self.latest.direct, &mut self.latest.rate] {
            part.iter_mut().for_each(|pressure| *pressure /= factor);
        }
    }

    /// Follows receiver weights that have moved, so that the pressures per unit of `psibar` (Pa) and of its rate (Pa s) have changed
    /// at a receiver. What the force has done is not heard again: only its own changes are.
    pub(super) fn sway(&mut self, receiver: usize, direct: f32, rate: f32) {
        for heard in self.before.iter_mut().chain([&mut self.latest]) {
            heard.direct[receiver] += direct;
            heard.rate[receiver] += rate;
        }
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
        // An evaluation is made for the middle of the interval it is held in.
        let middle = 0.5 * self.stride;
        let (before, ahead) = match &self.before {
            Some(before) => (before, (self.since + 0.5 - middle) / self.apart),
            None => (&self.latest, 0.0),
        };
        self.since += 1.0;
        let latest = &self.latest;
        let now = |latest: f32, before: f32| latest + ahead * (latest - before);
        std::array::from_fn(|receiver| {
            let direct = now(latest.direct[receiver], before.direct[receiver]);
            let rate = now(latest.rate[receiver], before.rate[receiver]);
            let rate = (force * rate - self.lag[receiver]) * (1.0 / RATE_TIME) as f32;
            self.lag[receiver] += rate * dt as f32;
            force * direct + rate + std::mem::take(&mut self.rescale_velocity[receiver])
        })
    }

    /// Forgets the past force.
    pub(super) fn reset(&mut self) {
        (self.lag, self.force, self.rescale_velocity) = (Pressure::default(), 0.0, Pressure::default());
        (self.stride, self.before) = (0.0, None);
    }
}
