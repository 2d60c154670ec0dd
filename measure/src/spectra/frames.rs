//! Powers of short frames of a sound.

use std::f64::consts::TAU;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

/// Transforms frames of one length under a Hann window, whose ends lie half a sample outside.
pub struct Frames {
    fft: Arc<dyn RealToComplex<f64>>,
    /// `[sample]`.
    window: Vec<f64>,
    /// `[sample]`.
    input: Vec<f64>,
    /// `[bin]`.
    bins: Vec<Complex<f64>>,
}

impl Frames {
    /// For frames of so many samples, at least 1.
    pub fn new(length: usize) -> Frames {
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let phase = |n: usize| TAU * (n as f64 + 0.5) / length as f64;
        let window = (0..length).map(|n| 0.5 - 0.5 * phase(n).cos()).collect();
        let (input, bins) = (fft.make_input_vec(), fft.make_output_vec());
        Frames { fft, window, input, bins }
    }

    /// Powers of the frame that begins at a sample of a sound, `[bin]`; outside the sound there is silence.
    pub fn powers(&mut self, sound: &[f32], start: isize) -> impl Iterator<Item = f64> {
        for (n, (place, weight)) in self.input.iter_mut().zip(&self.window).enumerate() {
            let sample = start.checked_add_unsigned(n).and_then(|at| usize::try_from(at).ok());
            let sample = sample.and_then(|at| sound.get(at)).copied().unwrap_or(0.0);
            *place = f64::from(sample) * weight;
        }
        // The buffers are the plan's own: their lengths fit.
        let transformed = self.fft.process(&mut self.input, &mut self.bins);
        debug_assert!(transformed.is_ok());
        self.bins.iter().map(|bin| bin.norm_sqr())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_fills_its_bin_and_half_as_much_either_neighbour() {
        let sine: Vec<f32> = (0..4096).map(|n| (TAU * 20.0 * f64::from(n) / 512.0).sin() as f32).collect();
        let powers: Vec<f64> = Frames::new(512).powers(&sine, 1000).collect();
        // The window's mean is a half, a sine's amplitude in its bin half the length.
        assert!((powers[20] / 128.0_f64.powi(2) - 1.0).abs() < 1e-5, "{}", powers[20]);
        for near in [19, 21] {
            assert!((powers[near] / powers[20] - 0.25).abs() < 1e-5);
        }
        assert!(powers[30] < 1e-6 * powers[20] && powers.len() == 257);
    }

    #[test]
    fn beside_the_sound_there_is_silence() {
        let mut frames = Frames::new(64);
        let energy = |frames: &mut Frames, start| frames.powers(&[1.0; 64], start).sum::<f64>();
        assert_eq!(energy(&mut frames, -64), 0.0);
        assert_eq!(energy(&mut frames, 64), 0.0);
        assert!(energy(&mut frames, -32) < energy(&mut frames, 0));
    }
}
