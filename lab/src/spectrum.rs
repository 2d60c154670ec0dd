//! The power spectrum of a sound.

use std::f64::consts::TAU;

use realfft::RealFftPlanner;

/// Power of a sound against frequency.
pub struct Spectrum {
    power: Vec<f64>,
    bin_hz: f64,
}

impl Spectrum {
    /// Of the sound as it is; the sample rate is in Hz.
    pub fn new(sound: &[f32], sample_rate: f64) -> Spectrum {
        Spectrum::windowed(sound, sample_rate, |_| 1.0)
    }

    /// Of the sound under a Hann window, the sample rate in Hz: lines stand apart and can be measured.
    pub fn hann(sound: &[f32], sample_rate: f64) -> Spectrum {
        Spectrum::windowed(sound, sample_rate, |t| 0.5 - 0.5 * (TAU * t).cos())
    }

    fn windowed(sound: &[f32], sample_rate: f64, window: impl Fn(f64) -> f64) -> Spectrum {
        let n = sound.len();
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        let mut input: Vec<f64> =
            sound.iter().enumerate().map(|(i, &x)| f64::from(x) * window(i as f64 / n as f64)).collect();
        let mut output = fft.make_output_vec();
        fft.process(&mut input, &mut output).expect("lengths that fit");
        // Over the rate squared: the same sound has the same spectrum at every rate.
        let scale = 1.0 / (sample_rate * sample_rate);
        Spectrum {
            power: output.iter().map(|x| scale * x.norm_sqr()).collect(),
            bin_hz: sample_rate / n as f64,
        }
    }

    /// Frequency of the strongest line within `reach` (Hz) of `near` (Hz), between bins too (a
    /// parabola through the logarithms), Hz.
    pub fn line(&self, near: f64, reach: f64) -> f64 {
        let bin = |hz: f64| (hz / self.bin_hz).round().max(1.0) as usize;
        let range = bin(near - reach)..=bin(near + reach).min(self.power.len() - 2);
        let top = range.max_by(|&a, &b| self.power[a].total_cmp(&self.power[b])).unwrap_or(1);
        let [low, middle, high] = [top - 1, top, top + 1].map(|i| self.power[i].max(1e-300).ln());
        let offset = 0.5 * (low - high) / (low - 2.0 * middle + high);
        (top as f64 + offset) * self.bin_hz
    }

    /// Power between two frequencies, Hz.
    pub fn band(&self, low: f64, high: f64) -> f64 {
        let bins = (low / self.bin_hz).ceil() as usize..(high / self.bin_hz).ceil() as usize;
        self.power[bins].iter().sum()
    }
}
