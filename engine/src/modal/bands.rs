//! Energy of bands of modes, and its change by impulses that leave every displacement as it is.
//!
//! Model: an impulse changes the velocities of a band's modes, each by a share of what it has and by a kick of random sign that
//! is the same energy for all. Displacements stay, and with them whatever depends on them: contacts and nonlinear forces. The
//! energy given is the change of the kinetic energy. Terms of the order of `sigma / omega` are left out of both energies.

use std::ops::Range;

use fastrand::Rng;

use super::simd::LANES as WHOLE_LANES;
use super::{ModalBody, Pressure, RECEIVERS, ReceiverWeights, Row, zero_row};

/// Sums taken at once.
const LANES: usize = 8;

/// Signs drawn at once.
const SIGNS: usize = 32;

/// Motion of a mode from which on its share of a band's energy is told apart, m; squares of less may be denormal numbers.
const LEAST: f32 = 1e-15;

/// Energy of a band.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BandEnergy {
    /// J.
    pub kinetic: f64,
    /// Kinetic and potential, J.
    pub whole: f64,
}

/// What the energies of a body's modes and the sound of impulses need.
pub struct BandWeights {
    /// `M omega_d^2 / 2`: energy over the square of the state, J/m2, `[mode]`.
    weight: Row,
    /// State that has a unit energy, the root of m2/J, `[mode]`.
    unit: Row,
    /// Pressure of an impulse, times a sample, over the change of the real part, Pa s/m, `[receiver][mode]`.
    impulse: [Row; RECEIVERS],
}

impl BandWeights {
    /// Of a body and its receivers. Allocates.
    pub fn new(body: &ModalBody, receivers: &ReceiverWeights) -> BandWeights {
        let row = || zero_row(body.len());
        let heard = receivers.receivers.each_ref().map(|receiver| !receiver.transfer.is_empty());
        let impulse = heard.map(|heard| if heard { row() } else { zero_row(0) });
        let mut weights = BandWeights { weight: row(), unit: row(), impulse };
        body.weigh(&mut weights, receivers);
        weights
    }

    /// Of a body whose impulses nobody hears. Allocates.
    pub fn unheard(body: &ModalBody) -> BandWeights {
        let row = || zero_row(body.len());
        let impulse = std::array::from_fn(|_| zero_row(0));
        let mut weights = BandWeights { weight: row(), unit: row(), impulse };
        body.weigh_energies(&mut weights);
        weights
    }
}

impl ModalBody {
    /// Updates the weights after a change of modes or receiver weights.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn weigh(&self, weights: &mut BandWeights, receivers: &ReceiverWeights) {
        for (row, receiver) in weights.impulse.iter_mut().zip(&receivers.receivers) {
            for ((impulse, &direct), mode) in row.iter_mut().zip(receiver.direct.iter()).zip(&self.modes) {
                *impulse = (f64::from(direct) * mode.mass * mode.omega_d()) as f32;
            }
        }
        self.weigh_energies(weights);
    }

    /// Updates what the energies need after a change of modes.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn weigh_energies(&self, weights: &mut BandWeights) {
        let rows = weights.weight.iter_mut().zip(weights.unit.iter_mut());
        for (mode, (weight, unit)) in self.modes.iter().zip(rows) {
            let omega_d = mode.omega_d();
            let new = 0.5 * mode.mass * omega_d * omega_d;
            (*weight, *unit) = (new as f32, new.sqrt().recip() as f32);
        }
    }

    /// Energy of some modes.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn band_energy(&self, band: Range<usize>, weights: &BandWeights) -> BandEnergy {
        let (re, im) = (&self.state.re[band.clone()], &self.state.im[band.clone()]);
        let weight = &weights.weight[band];
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let square = |row| weighted_square(row, weight);
                let kinetic = square(re);
                BandEnergy { kinetic, whole: kinetic + square(im) }
            },
        )
    }

    /// Pressure at each receiver, Pa, of the accelerations that would bring the modes from `first` on from rest to their velocities
    /// within a second. The difference before and after an impulse, over its duration (s), is what the impulse sounds like.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn momentum(&self, first: usize, weights: &BandWeights) -> Pressure {
        let first = first / WHOLE_LANES * WHOLE_LANES;
        let re = &self.state.re[first..];
        weights.impulse.each_ref().map(|row| row.get(first..).map_or(0.0, |row| self.kernels.dot(re, row)))
    }

    /// Scales the velocities of some modes by a factor.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn scale_band(&mut self, band: Range<usize>, factor: f32) {
        let re = &mut self.state.re[band];
        self.kernels.vectorized(
            #[inline(always)]
            || re.iter_mut().for_each(|re| *re *= factor),
        );
    }

    /// Moves the energy of every mode toward what is left of it, a share `kept` of 1, plus `added` (J), by scaling its velocity.
    /// Over the phases of many modes that is what their energies become; a mode's velocity changes by the root of two at most.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn equalize_band(&mut self, band: Range<usize>, kept: f32, added: f32, weights: &BandWeights) {
        let (re, im) = (&mut self.state.re[band.clone()], &self.state.im[band.clone()]);
        let weight = &weights.weight[band];
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let squared = |x: f32| x.abs().max(LEAST).powi(2);
                for ((re, im), weight) in re.iter_mut().zip(im).zip(weight) {
                    let energy = weight * (squared(*re) + squared(*im));
                    // The velocity has half of the energy, so that it changes by twice the share.
                    let square = 2.0 * (kept + added / energy.max(f32::MIN_POSITIVE)) - 1.0;
                    *re *= square.clamp(0.5, 2.0).sqrt();
                }
            },
        );
    }

    /// Kicks every mode of a band by an impulse of random sign, which would give it `energy` (J) at rest.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn kick_band(&mut self, band: Range<usize>, energy: f64, weights: &BandWeights, signs: &mut Rng) {
        let size = energy.sqrt() as f32;
        let unit = &weights.unit[band.clone()];
        let re = &mut self.state.re[band];
        self.kernels.vectorized(
            #[inline(always)]
            || kick(re, unit, |_| [size; SIGNS], signs),
        );
    }

    /// Kicks every mode by an impulse of random sign, which would give it the square of its size (the root of J, `[mode]`) at rest.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn kick_each(&mut self, sizes: &[f32], weights: &BandWeights, signs: &mut Rng) {
        let re = &mut self.state.re[..sizes.len()];
        let some = |chunk: usize| {
            let mut some = [0.0; SIGNS];
            some.iter_mut().zip(&sizes[chunk * SIGNS..]).for_each(|(some, size)| *some = *size);
            some
        };
        self.kernels.vectorized(
            #[inline(always)]
            || kick(re, &weights.unit, some, signs),
        );
    }
}

/// Adds to each state what has its size (the root of J), of random sign; `sizes(chunk)` are those of some modes.
#[inline(always)]
fn kick(re: &mut [f32], unit: &[f32], sizes: impl Fn(usize) -> [f32; SIGNS], signs: &mut Rng) {
    for (chunk, (re, unit)) in re.chunks_mut(SIGNS).zip(unit.chunks(SIGNS)).enumerate() {
        let (bits, sizes) = (signs.u32(..), sizes(chunk));
        for (i, (re, (unit, size))) in re.iter_mut().zip(unit.iter().zip(&sizes)).enumerate() {
            // The bit is the sign of the kick.
            *re += f32::from_bits((size * unit).to_bits() ^ (bits >> i << 31));
        }
    }
}

/// `sum weight x^2`.
#[inline(always)]
fn weighted_square(x: &[f32], weight: &[f32]) -> f64 {
    let mut sums = [0.0_f64; LANES];
    let (chunks, rest) = x.as_chunks::<LANES>();
    let (weights, last) = weight.as_chunks::<LANES>();
    for (x, weight) in chunks.iter().zip(weights) {
        for i in 0..LANES {
            let x = f64::from(x[i]);
            sums[i] += f64::from(weight[i]) * x * x;
        }
    }
    let rest: f64 =
        rest.iter().zip(last).map(|(&x, &weight)| f64::from(weight) * f64::from(x) * f64::from(x)).sum();
    sums.iter().sum::<f64>() + rest
}
