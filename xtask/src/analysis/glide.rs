//! Pitch glide: how much higher a struck head starts than it ends.
//!
//! The strongest partial's frequency in a window of 80 ms that begins 5 ms after the stroke,
//! against the same in a window of 80 ms late in its decay, when the head hardly moves. A window
//! that short cannot part partials closer than about 40 Hz; what another partial nearby adds to
//! the figure is the same for a soft stroke as for a hard one.

use super::Spectrum;

/// Start of the early window, s.
const EARLY: f64 = 0.005;

/// Start of the late window, s.
const LATE: f64 = 0.4;

/// Length of both windows, s.
const LENGTH: f64 = 0.08;

/// The late window must not have fallen further below the early one, dB: beyond, rounding rules.
const DEEPEST_DB: f64 = -100.0;

/// Glide of the partial near a frequency (Hz), cents, positive if it falls; nothing if the sound is
/// too short or too quiet, or the frequency too low for the windows.
pub fn glide_cents(samples: &[f32], rate: f64, near: f64) -> Option<f64> {
    // Two periods at least.
    if near * LENGTH < 2.0 {
        return None;
    }
    let window = |start: f64| {
        let first = (start * rate) as usize;
        samples.get(first..first + (LENGTH * rate) as usize)
    };
    let (early, late) = (window(EARLY)?, window(LATE)?);
    let fall = super::rms(late)? / super::rms(early)?;
    if fall.is_nan() || fall <= 10f64.powf(DEEPEST_DB / 20.0) {
        return None;
    }
    // A semitone and a half below to three above: heads glide down to their pitch.
    let (from, to) = (near * 0.917, near * 1.19);
    let early = Spectrum::of_stretch(early, rate).strongest_between(from, to)?;
    let late = Spectrum::of_stretch(late, rate).strongest_between(from, to)?;
    Some(1200.0 * (early / late).log2())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    /// A decaying tone whose pitch starts `cents` above 100 Hz and falls with a time constant.
    fn gliding(cents: f64, constant: f64, sigma: f64) -> Vec<f32> {
        let mut phase = 0.0;
        (0..48_000)
            .map(|n| {
                let t = n as f64 / RATE;
                let frequency = 100.0 * (cents / 1200.0 * (-t / constant).exp()).exp2();
                phase += std::f64::consts::TAU * frequency / RATE;
                ((-sigma * t).exp() * phase.sin()) as f32
            })
            .collect()
    }

    #[test]
    fn a_steady_tone_does_not_glide() {
        let glide = glide_cents(&gliding(0.0, 1.0, 8.0), RATE, 100.0).unwrap();
        assert!(glide.abs() < 0.5, "{glide}");
    }

    #[test]
    fn a_falling_tone_glides_by_its_mean_in_the_early_window() {
        let glide = glide_cents(&gliding(100.0, 0.1, 8.0), RATE, 100.0).unwrap();
        // The mean of exp(-t / 0.1 s) over 5 to 85 ms is 0.65; under the bell about the same.
        assert!((glide - 63.0).abs() < 6.0, "{glide}");
    }

    #[test]
    fn too_little_sound_gives_no_figure() {
        assert_eq!(glide_cents(&[0.0; 48_000], RATE, 100.0), None);
        assert_eq!(glide_cents(&gliding(0.0, 1.0, 8.0)[..9600], RATE, 100.0), None);
        assert_eq!(glide_cents(&gliding(0.0, 1.0, 60.0), RATE, 100.0), None);
        assert_eq!(glide_cents(&gliding(0.0, 1.0, 8.0), RATE, 20.0), None);
    }
}
