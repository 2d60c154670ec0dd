//! Sound of a force itself, and of its rate of change.

use super::simd::REST;
use super::{InputVector, ModalBody, Pressure, ReceiverWeights};
use crate::receiver::POINTS;

impl ReceiverWeights {
    /// Pressure proportional to the force, per unit force at an input vector, Pa/N.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn direct_at(&self, body: &ModalBody, input: &InputVector) -> Pressure {
        self.receivers.each_ref().map(|receiver| body.kernels.dot(&receiver.direct, &input.shape))
    }

    /// [`direct_at`](Self::direct_at) of forces that modes take [in turns](ModalBody::ring_in_turns), `[turn][point]`, Pa/N.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn direct_in_turns<const TURNS: usize>(
        &self,
        body: &ModalBody,
        input: &InputVector,
    ) -> [[f32; POINTS]; TURNS] {
        let mut sums = [[0.0; POINTS]; TURNS];
        for (point, receiver) in self.receivers.iter().enumerate().take(POINTS) {
            let groups = input.shape.chunks(REST).zip(receiver.direct.chunks(REST));
            for (group, (shape, direct)) in groups.enumerate() {
                sums[group % TURNS][point] += body.kernels.dot(direct, shape);
            }
        }
        sums
    }

    /// Pressure per unit rate of change of a force at an input vector, Pa s/N.
    ///
    /// The imaginary part of a transfer acts on the velocity, which at the mode's own frequency goes as the rate of change of the
    /// acceleration does. Of a mode that is forced at another frequency the rate is what sounds: a plate in free air is a
    /// dipole. Below its own frequency the velocity sounds by two powers of the frequency too much, above it by two too little. The
    /// returned pressure times the rate of the force makes one of the other.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn rate_at(&self, body: &ModalBody, input: &InputVector) -> Pressure {
        self.receivers.each_ref().map(|receiver| body.kernels.dot(&receiver.rate, &input.shape))
    }
}
