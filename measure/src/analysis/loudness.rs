//! How loud a piece of music is.

use ebur128::{EbuR128, Mode};

/// Integrated loudness of a stereo sound of full scale 1 at a sample rate (Hz), LUFS: ITU-R BS.1770, gated as EBU R 128 asks. Nothing of
/// silence.
pub fn loudness_lufs([left, right]: [&[f32]; 2], rate: u32) -> Option<f64> {
    let mut meter = EbuR128::new(2, rate, Mode::I).ok()?;
    meter.add_frames_planar_f32(&[left, right]).ok()?;
    meter.loudness_global().ok().filter(|loudness| loudness.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tech 3341 of the EBU, test 1: a sine of 1 kHz at -23 dBFS on both sides is -23 LUFS loud.
    #[test]
    fn a_sine_of_1_khz_is_as_loud_as_the_standard_says() {
        let amplitude = 10f32.powf(-23.0 / 20.0);
        let sine: Vec<f32> =
            (0..480_000).map(|n| amplitude * (std::f32::consts::TAU * n as f32 / 48.0).sin()).collect();
        let loudness = loudness_lufs([&sine, &sine], 48_000).expect("a loudness");
        assert!((loudness + 23.0).abs() < 0.1, "{loudness}");
        assert_eq!(loudness_lufs([&[0.0; 48_000], &[0.0; 48_000]], 48_000), None);
    }
}
