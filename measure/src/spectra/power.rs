//! Power of a sound against frequency.
//!
//! Power is the squared transform over the squared sample rate: a sound has the same at every rate, and a stretch of `T`
//! seconds bins of `1 / T` Hz.

use std::f64::consts::TAU;

use super::forward::{forward, vertex};

/// Power of a sound against frequency.
pub struct PowerSpectrum {
    power: Vec<f64>,
    bin_hz: f64,
}

impl PowerSpectrum {
    /// Of the sound as it is; the sample rate is in Hz.
    pub fn new(sound: &[f32], sample_rate: f64) -> PowerSpectrum {
        PowerSpectrum::windowed(sound, sample_rate, |_| 1.0)
    }

    /// Of the sound under a Hann window, the sample rate in Hz: lines stand apart and can be measured.
    pub fn hann(sound: &[f32], sample_rate: f64) -> PowerSpectrum {
        PowerSpectrum::windowed(sound, sample_rate, |t| 0.5 - 0.5 * (TAU * t).cos())
    }

    fn windowed(sound: &[f32], sample_rate: f64, window: impl Fn(f64) -> f64) -> PowerSpectrum {
        let n = sound.len();
        let weighted = |(i, &x): (usize, &f32)| f64::from(x) * window(i as f64 / n as f64);
        let bins = forward(sound.iter().enumerate().map(weighted).collect());
        // Over the rate squared: the same sound has the same spectrum at every rate.
        let scale = 1.0 / (sample_rate * sample_rate);
        PowerSpectrum {
            power: bins.iter().map(|x| scale * x.norm_sqr()).collect(),
            bin_hz: sample_rate / n as f64,
        }
    }

    /// Frequency of the strongest line within `reach` (Hz) of `near` (Hz), between bins too (a
    /// parabola through the logarithms), Hz.
    pub fn line(&self, near: f64, reach: f64) -> f64 {
        let bin = |hz: f64| (hz / self.bin_hz).round().max(1.0) as usize;
        let range = bin(near - reach)..=bin(near + reach).min(self.power.len() - 2);
        let top = range.max_by(|&a, &b| self.power[a].total_cmp(&self.power[b])).unwrap_or(1);
        let offset = vertex([top - 1, top, top + 1].map(|bin| self.power[bin].max(f64::MIN_POSITIVE).ln()));
        (top as f64 + offset) * self.bin_hz
    }

    /// Mean of the frequencies between two (Hz) weighted by their power, Hz; nothing of silence.
    pub fn centroid(&self, low: f64, high: f64) -> Option<f64> {
        let bins = (low / self.bin_hz).ceil() as usize..(high / self.bin_hz).ceil() as usize;
        let moment: f64 = bins.clone().map(|bin| bin as f64 * self.bin_hz * self.power[bin]).sum();
        let whole: f64 = self.power[bins].iter().sum();
        (whole > 0.0).then(|| moment / whole)
    }

    /// Power between two frequencies, Hz.
    pub fn band(&self, low: f64, high: f64) -> f64 {
        let bins = (low / self.bin_hz).ceil() as usize..(high / self.bin_hz).ceil() as usize;
        self.power[bins].iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Chance;

    const RATE: f64 = 48_000.0;

    fn sine(frequency: f64, sigma: f64) -> Vec<f32> {
        let at = |n: u32| f64::from(n) / RATE;
        (0..48_000).map(|n| ((-sigma * at(n)).exp() * (TAU * frequency * at(n)).sin()) as f32).collect()
    }

    #[test]
    fn a_line_is_found_between_bins_whether_it_decays_or_not() {
        for (frequency, sigma) in [(82.37, 0.0), (441.5, 2.0), (9876.54, 0.0)] {
            let line = PowerSpectrum::hann(&sine(frequency, sigma), RATE).line(frequency + 3.0, 8.0);
            assert!((line - frequency).abs() < 0.03, "{frequency}: {line}");
        }
    }

    #[test]
    fn the_stronger_line_within_reach_is_taken() {
        let both: Vec<f32> =
            sine(500.0, 0.0).iter().zip(&sine(520.0, 0.0)).map(|(a, b)| a + 0.2 * b).collect();
        let spectrum = PowerSpectrum::hann(&both, RATE);
        assert!((spectrum.line(510.0, 30.0) - 500.0).abs() < 0.01);
        assert!((spectrum.line(525.0, 10.0) - 520.0).abs() < 0.05);
    }

    #[test]
    fn a_band_holds_the_power_of_the_sines_in_it_at_every_rate() {
        for rate in [44_100.0, 96_000.0] {
            let both = |n: u32| {
                let t = f64::from(n) / rate;
                ((TAU * 300.0 * t).sin() + 0.1 * (TAU * 5000.0 * t).sin()) as f32
            };
            let sound: Vec<f32> = (0..rate as u32).map(both).collect();
            let spectrum = PowerSpectrum::new(&sound, rate);
            // A second of a sine of size 1 has a bin of (1 / 2)^2.
            assert!((spectrum.band(200.0, 400.0) - 0.25).abs() < 1e-6);
            assert!((spectrum.band(4000.0, 6000.0) - 0.0025).abs() < 1e-6);
            assert!(spectrum.band(400.0, 4000.0) < 1e-9);
        }
    }

    #[test]
    fn noise_of_a_known_level_is_as_strong_in_bands_as_they_are_wide() {
        let mut chance = Chance::new(5);
        let noise: Vec<f32> = (0..480_000).map(|_| chance.between(-0.3, 0.3) as f32).collect();
        let spectrum = PowerSpectrum::new(&noise, RATE);
        // Ten seconds of a variance of .3^2 / 3, spread evenly up to half the rate; one side of the spectrum is half of it.
        let density = 0.03 * 480_000.0 * 480_000.0 / 2.0 / (RATE * RATE) / (RATE / 2.0);
        for (low, high) in [(100.0, 1100.0), (5000.0, 15_000.0)] {
            let ratio = spectrum.band(low, high) / (density * (high - low));
            assert!((ratio - 1.0).abs() < 0.05, "{low} Hz: {ratio}");
        }
    }
}
