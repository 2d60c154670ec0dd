//! The magnitude spectrum of the beginning of a sound.
//!
//! A struck sound begins at its loudest, so the window is one at the start and falls, as half a
//! cosine, over the second half only: an ordinary bell would hide the attack. A decaying sine
//! looks the same in it up to its width.

use super::forward::{forward, vertex};

/// Magnitudes of a sound's frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct OnsetSpectrum {
    /// `[bin]`: magnitude, in no particular unit.
    magnitudes: Vec<f64>,
    /// Hz from bin to bin.
    spacing: f64,
}

/// Lower limit of hearing, Hz.
const LOWEST_HZ: f64 = 20.0;

/// Upper limit of hearing, Hz.
const HIGHEST_HZ: f64 = 20_000.0;

impl OnsetSpectrum {
    /// OnsetSpectrum of the first `seconds` of a sound at a sample rate (Hz).
    pub fn of_onset(samples: &[f32], rate: f64, seconds: f64) -> OnsetSpectrum {
        let length = samples.len().min((seconds * rate) as usize);
        let half = length as f64 / 2.0;
        let fade = |n: usize| match n as f64 / half {
            place if place <= 1.0 => 1.0,
            place => 0.5 - 0.5 * (std::f64::consts::PI * place).cos(),
        };
        OnsetSpectrum::windowed(&samples[..length], rate, fade)
    }

    fn windowed(samples: &[f32], rate: f64, window: impl Fn(usize) -> f64) -> OnsetSpectrum {
        // Four times padded, so that a peak is seen at three bins or more.
        let size = (4 * samples.len()).max(16).next_power_of_two();
        let mut input = vec![0.0; size];
        for (n, (place, &sample)) in input.iter_mut().zip(samples).enumerate() {
            *place = f64::from(sample) * window(n);
        }
        let magnitudes = forward(input).iter().map(|bin| bin.norm()).collect();
        OnsetSpectrum { magnitudes, spacing: rate / size as f64 }
    }

    fn bins(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let first = (from / self.spacing).ceil().max(1.0) as usize;
        let last = ((to / self.spacing) as usize + 1).min(self.magnitudes.len().saturating_sub(1));
        first..last.max(first)
    }

    /// Frequency of the strongest peak between two frequencies, Hz, to a fraction of a bin;
    /// nothing in silence.
    pub fn strongest_between(&self, from: f64, to: f64) -> Option<f64> {
        let range = self.bins(from, to);
        let bin = range.max_by(|&a, &b| self.magnitudes[a].total_cmp(&self.magnitudes[b]))?;
        if self.magnitudes[bin] <= 0.0 || !self.magnitudes[bin].is_finite() {
            return None;
        }
        Some((bin as f64 + self.peak_offset(bin)) * self.spacing)
    }

    /// Place of the vertex of the parabola through three log magnitudes, in bins from the middle.
    fn peak_offset(&self, bin: usize) -> f64 {
        let log = |bin: usize| self.magnitudes[bin].max(f64::MIN_POSITIVE).ln();
        vertex([bin - 1, bin, bin + 1].map(log))
    }

    /// Level at a frequency (Hz), dB, in no particular unit; nothing in silence.
    pub fn level_db(&self, hz: f64) -> Option<f64> {
        let magnitude = *self.magnitudes.get((hz / self.spacing).round() as usize)?;
        (magnitude > 0.0).then(|| 20.0 * magnitude.log10())
    }

    /// Peaks between two frequencies (Hz) that stand out by `prominence_db` from the deepest bin on
    /// either side of them up to the next higher peak: frequency (Hz) and level (dB).
    pub fn peaks(&self, [from, to]: [f64; 2], prominence_db: f64) -> Vec<(f64, f64)> {
        let step = 10f64.powf(prominence_db / 20.0);
        let (mut peaks, mut valley, mut top) = (Vec::new(), f64::INFINITY, None);
        for bin in self.bins(from, to) {
            let magnitude = self.magnitudes[bin];
            match top {
                None => {
                    valley = magnitude.min(valley);
                    top = (magnitude > step * valley).then_some(bin);
                }
                Some(peak) if magnitude > self.magnitudes[peak] => top = Some(bin),
                Some(peak) if magnitude * step < self.magnitudes[peak] => {
                    let hz = (peak as f64 + self.peak_offset(peak)) * self.spacing;
                    peaks.push((hz, 20.0 * self.magnitudes[peak].log10()));
                    (top, valley) = (None, magnitude);
                }
                Some(_) => {}
            }
        }
        peaks
    }

    /// Frequency of the strongest audible peak, Hz.
    pub fn strongest(&self) -> Option<f64> {
        self.strongest_between(LOWEST_HZ, HIGHEST_HZ)
    }

    /// Mean of the audible frequencies weighted by their magnitudes, Hz.
    pub fn centroid(&self) -> Option<f64> {
        let (mut moment, mut sum) = (0.0, 0.0);
        for bin in self.bins(LOWEST_HZ, HIGHEST_HZ) {
            moment += bin as f64 * self.spacing * self.magnitudes[bin];
            sum += self.magnitudes[bin];
        }
        (sum > 0.0 && sum.is_finite()).then(|| moment / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn decaying(frequency: f64, sigma: f64, seconds: f64) -> Vec<f32> {
        (0..(seconds * RATE) as usize)
            .map(|n| {
                let t = n as f64 / RATE;
                ((-sigma * t).exp() * (std::f64::consts::TAU * frequency * t).sin()) as f32
            })
            .collect()
    }

    #[test]
    fn the_strongest_of_a_decaying_sine_is_its_frequency() {
        for (frequency, sigma) in [(55.3, 3.0), (220.7, 10.0), (1234.5, 1.0), (15_000.2, 5.0)] {
            let spectrum = OnsetSpectrum::of_onset(&decaying(frequency, sigma, 2.0), RATE, 1.0);
            let found = spectrum.strongest().unwrap();
            assert!((found - frequency).abs() < 0.05, "{frequency}: {found}");
        }
    }

    #[test]
    fn the_centroid_of_two_equal_sines_lies_between_them() {
        let (low, high) = (decaying(1000.0, 2.0, 1.0), decaying(3000.0, 2.0, 1.0));
        let both: Vec<f32> = std::iter::zip(&low, &high).map(|(low, high)| low + high).collect();
        let centroid = |sound: &[f32]| OnsetSpectrum::of_onset(sound, RATE, 1.0).centroid().unwrap();
        // The skirts of a struck sine reach far: it lies above its frequency.
        assert!(1000.0 < centroid(&low) && centroid(&low) < centroid(&both));
        assert!(centroid(&both) < centroid(&high) && centroid(&high) < 4000.0);
    }

    #[test]
    fn silence_and_nothing_have_no_frequency() {
        for samples in [&[][..], &[0.0; 4800]] {
            let spectrum = OnsetSpectrum::of_onset(samples, RATE, 1.0);
            assert_eq!((spectrum.strongest(), spectrum.centroid()), (None, None));
        }
    }
}
