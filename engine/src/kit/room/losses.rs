//! What sound loses on its way through the tail, octave by octave.
//!
//! Model: a gain, two shelves and a low pass, all of first order. Their gains and the corner of the low pass are those with the
//! least square error, dB, in the octaves below the sample rate's end (Levenberg-Marquardt). The low pass loses as the square of
//! the frequency at first, as air does; the shelves are for walls.
//!
//! Limits: reverberation times that jump from one octave to the next are smoothed.

use std::f64::consts::TAU;

use nalgebra::{SMatrix, SVector};

use crate::kit_spec::room::{OCTAVE_HZ, OCTAVES};

/// Where the shelves are halfway, Hz. *Converged*: with three, or others within an octave of these, the standard room's losses
/// are no nearer.
const CORNERS_HZ: [f64; SHELVES] = [110.0, 4_000.0];
pub(super) const SHELVES: usize = 2;

/// Gain (dB), shelves (dB), low pass (octaves of its corner over 10 kHz).
const NUMBERS: usize = SHELVES + 2;
type Vector = SVector<f64, NUMBERS>;

/// Steps of the fit. *Converged*: after 30 the error of any room of the tests stays.
const STEPS: usize = 60;
/// Most that is left at any frequency, so that nothing ever grows.
const MOST: f64 = 0.9999;
/// Share of the sample rate up to which octaves are met.
const HIGHEST: f64 = 0.42;

/// Coefficients of the sections.
#[derive(Debug, Clone, Copy)]
pub(super) struct Losses {
    /// What is left of everything.
    pub(super) gain: f64,
    /// What the shelves add of all above their corners, in the order of those.
    pub(super) shelves: [f64; SHELVES],
    /// How far the low pass goes toward its input in a sample, 0 to 1.
    pub(super) low_pass: f64,
    sample_rate: f64,
}

impl Losses {
    /// Sections with the least error from these gains by octave, dB.
    pub(super) fn nearest(decibels: &[f64; OCTAVES], sample_rate: f64) -> Losses {
        let error = |at: &Vector| {
            let losses = Losses::at(at, sample_rate);
            OCTAVE_HZ.iter().zip(decibels).map(move |(&hz, wanted)| {
                let counts = f64::from(u8::from(hz < HIGHEST * sample_rate));
                counts * (20.0 * losses.left(hz).log10() - wanted)
            })
        };
        let sum = |at: &Vector| error(at).map(|x| x * x).sum::<f64>();
        let mut at = Vector::zeros();
        (at[0], at[NUMBERS - 1]) = (decibels.iter().fold(f64::MIN, |most, &x| most.max(x)), 1.5);
        let mut damping = 1.0;
        for _ in 0..STEPS {
            let mut jacobian = SMatrix::<f64, OCTAVES, NUMBERS>::zeros();
            let here = SVector::<f64, OCTAVES>::from_iterator(error(&at));
            for k in 0..NUMBERS {
                let mut beside = at;
                beside[k] += 1e-4;
                jacobian.set_column(k, &((SVector::from_iterator(error(&beside)) - here) / 1e-4));
            }
            let normal = jacobian.transpose() * jacobian + SMatrix::identity() * damping;
            let step = normal.lu().solve(&(jacobian.transpose() * here)).unwrap_or_default();
            let mut next = at - step;
            // Beyond these a shelf or the low pass does nothing more.
            (1..=SHELVES).for_each(|k| next[k] = next[k].clamp(-60.0, 30.0));
            next[NUMBERS - 1] = next[NUMBERS - 1].clamp(-6.0, 3.0);
            if sum(&next) < sum(&at) {
                (at, damping) = (next, damping / 3.0);
            } else {
                damping *= 4.0;
            }
        }
        Losses::at(&at, sample_rate).passive()
    }

    fn at(numbers: &Vector, sample_rate: f64) -> Losses {
        let corner = 10_000.0 * numbers[NUMBERS - 1].exp2();
        Losses {
            gain: 10.0_f64.powf(numbers[0] / 20.0),
            shelves: std::array::from_fn(|k| 10.0_f64.powf(numbers[1 + k] / 20.0) - 1.0),
            low_pass: 1.0 - (-TAU * corner / sample_rate).exp(),
            sample_rate,
        }
    }

    /// How far each shelf's low pass goes toward its input in a sample.
    pub(super) fn shelf_steps(sample_rate: f64) -> [f64; SHELVES] {
        CORNERS_HZ.map(|hz| 1.0 - (-TAU * hz / sample_rate).exp())
    }

    /// What is left of a frequency, 1 for all.
    pub(super) fn left(&self, hz: f64) -> f64 {
        let angle = TAU * hz / self.sample_rate;
        // A one-pole low pass `y += a (x - y)`, real and imaginary part.
        let low = |a: f64| {
            let (re, im) = (1.0 - (1.0 - a) * angle.cos(), (1.0 - a) * angle.sin());
            let square = re * re + im * im;
            (a * re / square, -a * im / square)
        };
        let lift = |(share, step): (&f64, f64)| {
            let (re, im) = low(step);
            (1.0 + share * (1.0 - re)).hypot(share * im)
        };
        let shelves: f64 = self.shelves.iter().zip(Losses::shelf_steps(self.sample_rate)).map(lift).product();
        let (re, im) = low(self.low_pass);
        self.gain * shelves * re.hypot(im)
    }

    /// The same, but turned down where any frequency would grow.
    fn passive(self) -> Losses {
        const LOOKED_AT: u32 = 256;
        let most = (0..=LOOKED_AT)
            .map(|k| self.left(0.5 * self.sample_rate * (f64::from(k) / f64::from(LOOKED_AT)).powi(3)))
            .fold(MOST, f64::max);
        Losses { gain: self.gain * MOST / most, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit_spec::room::RoomSpec;

    #[test]
    fn every_octave_loses_what_the_room_says() {
        for rate in [44_100.0, 48_000.0, 96_000.0, 192_000.0] {
            for seconds in (2..16).map(|k| 0.005 * f64::from(k)) {
                let wanted = RoomSpec::STANDARD.times().map(|time| -60.0 * seconds / time);
                let losses = Losses::nearest(&wanted, rate);
                for (hz, wanted) in OCTAVE_HZ.into_iter().zip(wanted) {
                    let off = 20.0 * losses.left(hz).log10() / wanted - 1.0;
                    assert!(off.abs() < 0.12, "{rate} {seconds} {hz}: {off}");
                }
            }
        }
    }

    #[test]
    fn nothing_grows_whatever_is_asked_for() {
        for wanted in
            [[-0.001; OCTAVES], [3.0; OCTAVES], [-60.0, 0.0, -60.0, 0.0, -60.0, 0.0, -60.0, 0.0, -60.0]]
        {
            for rate in [8_000.0, 44_100.0, 192_000.0] {
                let losses = Losses::nearest(&wanted, rate);
                let most = (0..2_000).map(|k| losses.left(rate * f64::from(k) / 4_000.0)).fold(0.0, f64::max);
                assert!(most < 1.0 && losses.left(1_000.0).is_finite(), "{rate}: {most}");
            }
        }
    }
}
