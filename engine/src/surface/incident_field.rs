//! Incident field: the sound of other pieces that acts on a drum.
//!
//! Model: the wavelength is larger than the drum, so the pressure is the same all around it. The force on a mode is the pressure
//! times the volume by which the mode compresses the drum. It is held over the sample like every force, so the work is exact.
//!
//! The volume is that of the point source in free air with the radiation loss of the mode: a mode receives as it radiates
//! (reciprocity). Other pieces receive the pressure of that volume's acceleration `a` at a metre, `rho a / (4 pi)`, over the same
//! path. Coupled drums therefore only lose energy. Modes with nodal diameters, or with waves shorter than the drum, receive
//! nothing. Others receive the far field of the first direction.
//!
//! Neglected: scattering by the drum (up to 6 dB where it is large against the wavelength), modes that change no volume, and the
//! delay between both heads.

use std::f64::consts::PI;

use crate::air_load::DENSITY;
use crate::modal::{InputVector, ModalBody, Pressure, RECEIVERS, ReceiverWeights};

/// Pressure over the samples of a run, Pa.
pub type IncidentPressure<'a> = &'a [f32];

/// Incident pressure above which a sleeping piece wakes, Pa.
pub const AUDIBLE: f32 = 0.02;

/// Load of the air on a drum.
pub(super) struct AirLoad {
    port: InputVector,
    /// Omnidirectional share of each mode's sound.
    shares: Vec<f32>,
    /// Pressure at each receiver proportional to the incident pressure, per unit of it.
    direct: Pressure,
}

impl AirLoad {
    /// A load of zero on so many modes. Allocates.
    pub(super) fn new(modes: usize) -> AirLoad {
        AirLoad { port: InputVector::new(modes), shares: vec![0.0; modes], direct: [0.0; RECEIVERS] }
    }

    /// Volume by which each mode compresses the drum, per modal displacement, m2, and the omnidirectional share of its sound,
    /// `[mode]`.
    pub(super) fn set_volumes(&mut self, volumes: impl Iterator<Item = (f64, f64)>) {
        let rows = self.port.shape_mut().iter_mut().zip(&mut self.shares);
        for ((shape, share), (volume, all_around)) in rows.zip(volumes) {
            (*shape, *share) = (volume as f32, all_around as f32);
        }
    }

    /// Updates the transfers to other pieces.
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

    /// The input vector of the incident pressure.
    pub(super) fn port(&self) -> &InputVector {
        &self.port
    }

    /// The input vector with the pressures from sample `from` of the run on, unless all are zero.
    pub(super) fn drive<'a>(
        &'a self,
        incident: IncidentPressure<'a>,
        from: usize,
    ) -> Option<(&'a InputVector, &'a [f32])> {
        let pressures = &incident[from..];
        pressures.iter().any(|&p| p != 0.0).then_some((&self.port, pressures))
    }

    /// Pressure at each receiver proportional to an incident pressure, Pa.
    pub(super) fn echo(&self, pressure: f32) -> Pressure {
        self.direct.map(|direct| direct * pressure)
    }
}
