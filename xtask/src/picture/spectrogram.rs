//! Levels over time and frequency.

use realfft::RealFftPlanner;

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
        let fft = RealFftPlanner::<f32>::new().plan_fft_forward(WINDOW);
        let (mut input, mut output) = (fft.make_input_vec(), fft.make_output_vec());
        let bell = |n: usize| 0.5 - 0.5 * (std::f32::consts::TAU * (n as f32 + 0.5) / WINDOW as f32).cos();
        let mut levels: Vec<Vec<f32>> = (0..columns)
            .map(|column| {
                let middle = samples.len() as f64 * (column as f64 + 0.5) / columns as f64;
                let start = middle as isize - (WINDOW / 2) as isize;
                for (n, place) in input.iter_mut().enumerate() {
                    let sample = start.checked_add_unsigned(n).and_then(|at| usize::try_from(at).ok());
                    let sample = sample.and_then(|at| samples.get(at)).copied().unwrap_or(0.0);
                    *place = sample * bell(n);
                }
                // The buffers are the plan's own: their lengths fit.
                let transformed = fft.process(&mut input, &mut output);
                debug_assert!(transformed.is_ok());
                output.iter().map(|bin| bin.norm_sqr().max(1e-30)).collect()
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
