//! The energy of a body.

use std::f64::consts::TAU;

use crate::snapshot::{OCTAVES, octave_of};

use super::ModalBody;

impl ModalBody {
    /// Vibration energy, J.
    pub fn energy(&self) -> f64 {
        (0..self.modes.len()).map(|k| self.mode_energy(k)).sum()
    }

    /// Vibration energy of the modes of each octave, J.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn energy_by_octave(&self) -> [f32; OCTAVES] {
        let mut octaves = [0.0; OCTAVES];
        for k in 0..self.modes.len() {
            octaves[octave_of(self.modes[k].omega / TAU)] += self.mode_energy(k) as f32;
        }
        octaves
    }

    /// Energy of its motion alone, J: nothing of a body that something holds bent.
    pub fn motion(&self) -> f64 {
        (0..self.modes.len()).map(|k| 0.5 * self.modes[k].mass * self.velocity(k).powi(2)).sum()
    }

    /// Sum over the modes of a weight (`[mode]`, padded) times the square of the amplitude, in the unit of the weights times m2.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn weighted_square(&self, weights: &[f32]) -> f64 {
        let sum = |state| f64::from(self.kernels.dot_square(weights, state));
        sum(&self.state.re) + sum(&self.state.im)
    }

    fn mode_energy(&self, k: usize) -> f64 {
        let (mode, q) = (&self.modes[k], f64::from(self.state.im[k]));
        0.5 * mode.mass * (self.velocity(k).powi(2) + (mode.omega * q).powi(2))
    }
}
