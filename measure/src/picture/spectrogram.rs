//! Levels over time and frequency.

use crate::spectra::Frames;

/// Samples transformed at once: 43 ms at 48 kHz, which parts a kick from a tom and keeps strokes
/// apart.
const WINDOW: usize = 2048;

/// Levels this far below the loudest are dark, dB.
const RANGE_DB: f64 = 90.0;

/// `[column][bin]` levels from 0 to 1.
pub struct Spectrogram {
    levels: Vec<Vec<f32>>,
    bins_per_hz: f64,
}

impl Spectrogram {
    /// Levels in dB of a sound at a rate in Hz in so many columns.
    pub fn new(samples: &[f32], rate: f64, columns: usize) -> Spectrogram {
        let mut frames = Frames::new(WINDOW);
        let mut levels: Vec<Vec<f32>> = (0..columns)
            .map(|column| {
                let middle = samples.len() as f64 * (column as f64 + 0.5) / columns as f64;
                let start = middle as isize - (WINDOW / 2) as isize;
                frames.powers(samples, start).map(|power| power.max(1e-30) as f32).collect()
            })
            .collect();
        let loudest = levels.iter().flatten().fold(1e-20f32, |loudest, &power| loudest.max(power));
        for power in levels.iter_mut().flatten() {
            *power = 1.0 + (10.0 * f64::from(*power / loudest).log10() / RANGE_DB) as f32;
        }
        Spectrogram { levels, bins_per_hz: WINDOW as f64 / rate }
    }

    /// Level from 0 to 1 (and below) at a column and a frequency (Hz).
    pub fn level(&self, column: usize, frequency: f64) -> f64 {
        let Some(bins) = self.levels.get(column) else {
            return 0.0;
        };
        let place = frequency * self.bins_per_hz;
        let at = |bin: usize| bins.get(bin).copied().map_or(0.0, f64::from);
        let (bin, share) = (place as usize, place.fract());
        at(bin) * (1.0 - share) + at(bin + 1) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_that_falls_silent_is_bright_at_its_frequency_until_then() {
        let size = |n: u32| if n < 24_000 { 0.5 } else { 0.0 };
        let sound: Vec<f32> =
            (0..48_000).map(|n| size(n) * (std::f32::consts::TAU * n as f32 / 48.0).sin()).collect();
        let spectrogram = Spectrogram::new(&sound, 48_000.0, 10);
        assert!((spectrogram.level(2, 1000.0) - 1.0).abs() < 0.03, "{}", spectrogram.level(2, 1000.0));
        assert!(spectrogram.level(2, 4000.0) < 0.4 && spectrogram.level(7, 1000.0) < 0.0);
    }
}
