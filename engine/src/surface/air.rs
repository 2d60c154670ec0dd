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

use crate::air::DENSITY;
use crate::modal::{EARS, Heard, ModalBody, Pickup, Port};

use super::Surface;

/// Pressure over the samples of a run, Pa.
pub type Incident<'a> = &'a [f32];

/// Pressure above which sound is heard by what sleeps, Pa.
pub const AUDIBLE: f32 = 0.02;

/// What the air presses on, and what follows from it.
pub(super) struct Listener {
    port: Port,
    /// Share of each mode's sound that goes all around.
    shares: Vec<f32>,
    /// Pressure heard at once per unit of pressure felt.
    direct: Heard,
}

impl Listener {
    /// Follows the modes.
    pub(super) fn connect(&mut self, body: &ModalBody, pickup: &Pickup) {
        body.connect(&mut self.port);
        self.direct = pickup.direct_at(body, &self.port);
    }

    /// Where the air presses.
    pub(super) fn port(&self) -> &Port {
        &self.port
    }

    /// The port with its pressures, if there is any from sample `from` of the run on.
    pub(super) fn drive<'a>(&'a self, incident: Incident<'a>, from: usize) -> Option<(&'a Port, &'a [f32])> {
        let pressures = &incident[from..];
        pressures.iter().any(|&p| p != 0.0).then_some((&self.port, pressures))
    }

    /// What is heard at once of a pressure.
    pub(super) fn echo(&self, pressure: f32) -> Heard {
        self.direct.map(|direct| direct * pressure)
    }
}

impl Surface {
    /// Lets the air press on the drum, and be pressed by it. Allocates.
    pub fn set_listener(&mut self) {
        self.listener = Some(Listener {
            port: Port::new(self.body.len()),
            shares: vec![0.0; self.body.len()],
            direct: [0.0; EARS],
        });
        self.pickup.attend(self.body.len());
    }

    /// Volume by which each mode makes the drum smaller, per modal displacement, m2, and the share of its sound that goes
    /// all around by that, `[mode]`; what is left goes as it goes far away. [`set_transfers`](Self::set_transfers)
    /// must be called after.
    pub fn set_volumes(&mut self, volumes: impl Iterator<Item = (f64, f64)>) {
        let Some(listener) = &mut self.listener else {
            return;
        };
        let rows = listener.port.shape_mut().iter_mut().zip(&mut listener.shares);
        for ((shape, share), (volume, all_around)) in rows.zip(volumes) {
            (*shape, *share) = (volume as f32, all_around as f32);
        }
    }

    /// Works out what other pieces hear.
    pub(super) fn follow_volumes(&mut self) {
        let Some(listener) = &mut self.listener else {
            return;
        };
        for k in 0..self.body.len() {
            let far = self.pickup.transfer_mut(1)[k];
            let (volume, left) = (f64::from(listener.port.shape()[k]), 1.0 - f64::from(listener.shares[k]));
            self.pickup.transfer_mut(EARS - 1)[k] =
                [left * far[0] - DENSITY * volume / (4.0 * PI), left * far[1]];
        }
    }

    /// Whether the air presses on it at all.
    pub fn listens(&self) -> bool {
        self.listener.is_some()
    }

    /// Whether wires lie still that could be moved.
    pub fn has_parked_wires(&self) -> bool {
        self.wires.as_ref().is_some_and(|wires| wires.on && wires.parked)
    }

    /// Lets wires that lie still move again.
    pub fn hear(&mut self) {
        self.wake_wires();
    }

    /// Adds the pressure of a sample to the body, just stepped; returns what is heard of it at once.
    pub(super) fn press(&mut self, incident: Option<Incident<'_>>, sample: usize) -> Heard {
        let pressure = incident.map_or(0.0, |incident| incident[sample]);
        match &self.listener {
            Some(listener) if pressure != 0.0 => {
                self.body.push(&listener.port, pressure);
                listener.echo(pressure)
            }
            _ => Heard::default(),
        }
    }
}
