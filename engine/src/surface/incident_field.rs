//! Sound from elsewhere that presses on a drum.
//!
//! Model: the wave is longer than the drum, so that the pressure is the same all around it; a mode feels it times the
//! volume by which it makes the drum smaller, held over the sample like every force, so that the work done is exact.
//!
//! The volume is that of the point in free air that loses as much by radiation as the mode does: what a
//! mode feels of sound from all around is what it sends out all around (reciprocity). Of such a mode other pieces hear
//! the pressure of that volume's acceleration `a` at a metre, `rho a / (4 pi)`, over the same way as it hears
//! them. So drums that hear each other only lose energy. Of modes that do not feel (they have nodal
//! diameters, or waves shorter than the drum) others hear what goes far away; nothing comes back to those.
//!
//! Neglected: what the drum's own body adds to the pressure on it (up to 6 dB where it is large against the
//! wave), modes that change no volume, and that the wave reaches one head before the other.

use std::f64::consts::PI;

use crate::air_load::DENSITY;
use crate::modal::{InputVector, ModalBody, Pressure, RECEIVERS, ReceiverWeights};

/// Pressure over the samples of a run, Pa.
pub type IncidentPressure<'a> = &'a [f32];

/// Pressure above which sound is heard by what sleeps, Pa.
pub const AUDIBLE: f32 = 0.02;

/// What the air presses on, and what follows from it.
pub(super) struct AirLoad {
    port: InputVector,
    /// Share of each mode's sound that goes all around.
    shares: Vec<f32>,
    /// Pressure heard at once per unit of pressure felt.
    direct: Pressure,
}

impl AirLoad {
    /// For so many modes, none of which the air presses on yet. Allocates.
    pub(super) fn new(modes: usize) -> AirLoad {
        AirLoad { port: InputVector::new(modes), shares: vec![0.0; modes], direct: [0.0; RECEIVERS] }
    }

    /// Volume by which each mode makes the drum smaller, per modal displacement, m2, and the share of its sound that goes
    /// all around by that, `[mode]`.
    pub(super) fn set_volumes(&mut self, volumes: impl Iterator<Item = (f64, f64)>) {
        let rows = self.port.shape_mut().iter_mut().zip(&mut self.shares);
        for ((shape, share), (volume, all_around)) in rows.zip(volumes) {
            (*shape, *share) = (volume as f32, all_around as f32);
        }
    }

    /// Works out what other pieces hear.
    pub(super) fn send(&self, receiver: &mut ReceiverWeights) {
        for (k, share) in self.shares.iter().enumerate() {
            let far = receiver.transfer_mut(1)[k];
            let (volume, left) = (f64::from(self.port.shape()[k]), 1.0 - f64::from(*share));
            receiver.transfer_mut(RECEIVERS - 1)[k] =
                [left * far[0] - DENSITY * volume / (4.0 * PI), left * far[1]];
        }
    }

    /// Follows the modes.
    pub(super) fn follow(&mut self, body: &ModalBody, receiver: &ReceiverWeights) {
        body.connect(&mut self.port);
        self.direct = receiver.direct_at(body, &self.port);
    }

    /// Where the air presses.
    pub(super) fn port(&self) -> &InputVector {
        &self.port
    }

    /// The port with its pressures, if there is any from sample `from` of the run on.
    pub(super) fn drive<'a>(
        &'a self,
        incident: IncidentPressure<'a>,
        from: usize,
    ) -> Option<(&'a InputVector, &'a [f32])> {
        let pressures = &incident[from..];
        pressures.iter().any(|&p| p != 0.0).then_some((&self.port, pressures))
    }

    /// What is heard at once of a pressure.
    pub(super) fn echo(&self, pressure: f32) -> Pressure {
        self.direct.map(|direct| direct * pressure)
    }
}
