//! What is heard of a force at once, and of one that changes slowly.

use super::{InputVector, ModalBody, Pressure, ReceiverWeights};

impl ReceiverWeights {
    /// Pressure at once per unit force at a port, Pa/N.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn direct_at(&self, body: &ModalBody, port: &InputVector) -> Pressure {
        self.ears.each_ref().map(|ear| body.kernels.dot(&ear.direct, &port.shape))
    }

    /// Pressure per unit rate of change of a force at a port, Pa s/N.
    ///
    /// The imaginary part of a transfer is heard through the velocity, a quarter of a period off. Of a
    /// body that a slow force bends, that is a first power of the frequency too many: this much times
    /// the force's rate takes it out, and only the acceleration is left.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn slow_at(&self, body: &ModalBody, port: &InputVector) -> Pressure {
        self.ears.each_ref().map(|ear| body.kernels.dot(&ear.slow, &port.shape))
    }
}
