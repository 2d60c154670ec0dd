//! The energy of a body.

use std::f64::consts::TAU;

use crate::snapshot::{OCTAVES, octave_of};

use super::simd::LANES;
use super::{ModalBody, Row};

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

    /// Sum over the modes of the square of the velocity times a weight, in the unit of the weights squared times m2/s2. Given are
    /// the weights times the damped angular frequency (rad/s) and times the decay rate (1/s), `[mode]`, padded.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn weighted_speeds(&self, by_omega: &Row, by_sigma: &Row) -> f64 {
        let [omegas, sigmas, re, im] = [&by_omega[..], &by_sigma[..], &self.state.re, &self.state.im]
            .map(|row| row.as_chunks::<LANES>().0);
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let mut sums = [0.0_f32; LANES];
                for (((omega, sigma), re), im) in omegas.iter().zip(sigmas).zip(re).zip(im) {
                    for i in 0..LANES {
                        let speed = omega[i] * re[i] - sigma[i] * im[i];
                        sums[i] += speed * speed;
                    }
                }
                sums.iter().map(|&sum| f64::from(sum)).sum()
            },
        )
    }

    fn mode_energy(&self, k: usize) -> f64 {
        let (mode, q) = (&self.modes[k], f64::from(self.state.im[k]));
        0.5 * mode.mass * (self.velocity(k).powi(2) + (mode.omega * q).powi(2))
    }
}
