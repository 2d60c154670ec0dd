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
//! Limits: a mode's radiation loss is that at its own frequency at rest. A head that is stretched far, or driven above its resonance, sends
//! out more than it loses by.
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

/// By how much a mode compresses its drum, and how much of its sound goes all around.
///
/// What goes all around reaches other pieces as that of a point of this volume, the rest as it reaches the first far point.
#[derive(Debug, Clone, Copy)]
pub struct Volume {
    /// Volume per modal displacement, m2.
    pub volume: f64,
    /// Share of the mode's sound that goes all around, 0 to 1.
    pub share: f64,
    /// What goes all around beside that share, as pressure at the first far point, Pa s2/m.
    pub all_around: f64,
}

/// Load of the air on a drum.
pub(super) struct AirLoad {
    port: InputVector,
    /// `[mode]`: the share of its sound that goes all around, and what does beside it, Pa s2/m.
    all_around: Vec<[f32; 2]>,
    /// Pressure at each receiver proportional to the incident pressure, per unit of it.
    direct: Pressure,
}

impl AirLoad {
    /// A load of zero on so many modes. Allocates.
    pub(super) fn new(modes: usize) -> AirLoad {
        AirLoad { port: InputVector::new(modes), all_around: vec![[0.0; 2]; modes], direct: [0.0; RECEIVERS] }
    }

    /// By how much each mode compresses the drum, `[mode]`.
    pub(super) fn set_volumes(&mut self, volumes: impl Iterator<Item = Volume>) {
        let rows = self.port.shape_mut().iter_mut().zip(&mut self.all_around);
        for ((shape, around), Volume { volume, share, all_around }) in rows.zip(volumes) {
            *shape = volume as f32;
            *around = [share as f32, all_around as f32];
        }
    }

    /// Updates the transfers to other pieces.
    pub(super) fn send(&self, receiver: &mut ReceiverWeights) {
        for (k, &around) in self.all_around.iter().enumerate() {
            let [real, imaginary] = receiver.transfer_mut(1)[k];
            let [share, all_around] = around.map(f64::from);
            let (volume, left) = (f64::from(self.port.shape()[k]), 1.0 - share);
            receiver.transfer_mut(RECEIVERS - 1)[k] =
                [left * real - all_around - DENSITY * volume / (4.0 * PI), left * imaginary];
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
