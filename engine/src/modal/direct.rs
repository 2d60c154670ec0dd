//! Sound of a force itself, and of one that changes slowly.

use super::{InputVector, ModalBody, Pressure, ReceiverWeights};

impl ReceiverWeights {
    /// Pressure proportional to the force, per unit force at an input vector, Pa/N.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn direct_at(&self, body: &ModalBody, input: &InputVector) -> Pressure {
        self.receivers.each_ref().map(|receiver| body.kernels.dot(&receiver.direct, &input.shape))
    }

    /// Pressure per unit rate of change of a force at an input vector, Pa s/N.
    ///
    /// The imaginary part of a transfer acts on the velocity, a quarter of a period off. Where a slow force bends a body, this
    /// sounds by one power of the frequency too much. The returned pressure times the rate of the force cancels it, so that
    /// only the acceleration sounds.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn slow_at(&self, body: &ModalBody, input: &InputVector) -> Pressure {
        self.receivers.each_ref().map(|receiver| body.kernels.dot(&receiver.slow, &input.shape))
    }
}
