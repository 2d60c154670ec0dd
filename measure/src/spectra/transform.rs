//! The spectrum of a whole sound: what lies in a band, and the band by itself.
//!
//! The sound is transformed at once, padded with as much silence, so that a band cut out by
//! multiplication does not reach around its ends. The cut shifts nothing in time.

use std::ops::Range;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner};

use super::forward::forward;

/// A sound by its frequencies.
pub struct Transform {
    /// `[bin]`.
    spectrum: Vec<Complex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Samples of the sound.
    length: usize,
    /// Hz from bin to bin.
    spacing: f64,
}

impl Transform {
    /// Transforms a sound at a sample rate (Hz); nothing for silence and what is not finite.
    pub fn new(samples: &[f32], rate: f64) -> Option<Transform> {
        let samples: Vec<f64> = samples.iter().map(|&sample| f64::from(sample)).collect();
        Transform::of(&samples, rate)
    }

    /// The same in double precision; the rate is in Hz.
    pub fn of(samples: &[f64], rate: f64) -> Option<Transform> {
        let size = (2 * samples.len()).max(16).next_power_of_two();
        let mut input = vec![0.0; size];
        input[..samples.len()].copy_from_slice(samples);
        let total: f64 = input.iter().map(|sample| sample * sample).sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(size);
        Some(Transform {
            spectrum: forward(input),
            inverse,
            length: samples.len(),
            spacing: rate / size as f64,
        })
    }

    /// The sound after a filter that multiplies each frequency (Hz) with a number.
    pub fn filtered(&self, gain: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
        let mut band = self.spectrum.clone();
        for (bin, value) in band.iter_mut().enumerate() {
            *value *= gain(bin as f64 * self.spacing);
        }
        let mut output = self.inverse.make_output_vec();
        self.inverse.process(&mut band, &mut output).ok()?;
        let scale = 1.0 / output.len() as f64;
        output.truncate(self.length);
        output.iter_mut().for_each(|sample| *sample *= scale);
        Some(output)
    }

    fn powers(&self, range: Range<f64>) -> impl Iterator<Item = (f64, f64)> {
        let first = (range.start / self.spacing).ceil() as usize;
        let last = (range.end / self.spacing).ceil() as usize;
        let last = last.min(self.spectrum.len());
        (first.min(last)..last).map(|bin| (bin as f64 * self.spacing, self.spectrum[bin].norm_sqr()))
    }

    /// Energy between two frequencies (Hz), in no particular unit.
    pub fn energy(&self, range: Range<f64>) -> f64 {
        self.powers(range).map(|(_, power)| power).sum()
    }

    /// Mean frequency between two, weighted by energy, Hz.
    pub fn centroid(&self, range: Range<f64>) -> Option<f64> {
        let (moment, sum) = self
            .powers(range)
            .fold((0.0, 0.0), |(moment, sum), (frequency, power)| (moment + frequency * power, sum + power));
        (sum > 0.0).then(|| moment / sum)
    }
}

/// Gain (a factor) of a raised-cosine slope that is a half at its middle: 0 at `-1`, 1 at `1`.
pub fn slope(place: f64) -> f64 {
    0.5 + 0.5 * (std::f64::consts::FRAC_PI_2 * place.clamp(-1.0, 1.0)).sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn sine(frequency: f64, size: f64) -> impl Iterator<Item = f64> {
        (0..24_000).map(move |n| size * (std::f64::consts::TAU * frequency * f64::from(n) / RATE).sin())
    }

    #[test]
    fn two_sines_are_parted_by_energy_centroid_and_filter() {
        let both: Vec<f64> = sine(500.0, 1.0).zip(sine(4000.0, 0.5)).map(|(a, b)| a + b).collect();
        let transform = Transform::of(&both, RATE).unwrap();
        let (low, high) = (transform.energy(0.0..2000.0), transform.energy(2000.0..24_000.0));
        assert!((low / high / 4.0 - 1.0).abs() < 0.01, "{}", low / high);
        let centroid = transform.centroid(20.0..20_000.0).unwrap();
        assert!((centroid - 1200.0).abs() < 5.0, "{centroid}");
        let above = transform.filtered(|hz| slope((hz / 2000.0).log2() * 4.0)).unwrap();
        let apart = |range: Range<usize>| {
            let far: Vec<f64> = sine(4000.0, 0.5).collect();
            range.map(|n| (above[n] - far[n]).abs()).fold(0.0, f64::max)
        };
        assert!(apart(2000..22_000) < 1e-3);
    }

    #[test]
    fn silence_has_no_transform() {
        assert!(Transform::new(&[0.0; 100], RATE).is_none());
        assert!(Transform::new(&[], RATE).is_none());
        assert!(Transform::new(&[f32::NAN; 100], RATE).is_none());
    }
}
