//! Pitch glide: how much higher a struck head starts than it ends.
//!
//! The frequency of the strongest partial's own motion in a window of 80 ms that begins 5 ms after
//! the stroke, or when the striker is gone if that is later, against the same in a window late in
//! its decay, when the head hardly moves.
//!
//! The motion is the displacement of one mode, not the sound: within 80 ms a spectrum cannot part
//! a drum's lowest partials, and what one adds to another reads as a glide of tens of cents where
//! there is none. A mode by itself obeys `x[n+1] = a x[n] + b x[n-1]` exactly, whatever its decay;
//! `a` and `b` are fitted by least squares (Prony), and `cos(omega) = a / (2 sqrt(-b))`.

/// Start of the early window, s.
const EARLY: f64 = 0.005;

/// Start of the late window, s.
const LATE: f64 = 0.4;

/// Length of both windows, s.
const LENGTH: f64 = 0.08;

/// Ratio of late to early motion below which rounding rules.
const LEAST_MOTION: f64 = 1e-5;

/// How far a mode may lie from the strongest partial of the sound to be it, cents: more than any
/// glide, less than the distance to the next partial.
const NEAR_CENTS: f64 = 150.0;

/// Motion of the lowest modes of a body over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// `[mode][time]`: displacements, m.
    pub modes: Vec<Vec<f32>>,
    /// Samples of each per second.
    pub rate: f64,
}

/// Glide of the partial that is strongest in the sound (Hz), cents, positive if it falls.
///
/// `free_from` is when the striker is gone, s. Nothing if no mode moves at that frequency, or its
/// motion is too short or dies too soon.
pub fn glide_cents(motion: &Motion, strongest: f64, free_from: f64) -> Option<f64> {
    let near = |mode: &&Vec<f32>| {
        let late = frequency(window(mode, motion.rate, LATE)?, motion.rate)?;
        ((1200.0 * (late / strongest).log2()).abs() < NEAR_CENTS).then_some(late)
    };
    let early = |mode| window(mode, motion.rate, EARLY.max(free_from));
    let moving = |mode| early(mode).and_then(super::level::rms).unwrap_or(0.0);
    // The mode of the pair that moves.
    let mode = motion
        .modes
        .iter()
        .filter(|mode| near(mode).is_some())
        .max_by(|a, b| moving(a).total_cmp(&moving(b)))?;
    let late = window(mode, motion.rate, LATE)?;
    if super::level::rms(late)? <= LEAST_MOTION * moving(mode) {
        return None;
    }
    let (early, late) = (frequency(early(mode)?, motion.rate)?, frequency(late, motion.rate)?);
    Some(1200.0 * (early / late).log2())
}

/// The motion (m) of the mode that moves most, over the whole.
pub fn strongest_mode(motion: &Motion) -> Option<&[f32]> {
    let size = |mode: &[f32]| super::level::rms(mode).unwrap_or(0.0);
    motion.modes.iter().map(Vec::as_slice).max_by(|a, b| size(a).total_cmp(&size(b)))
}

fn window(mode: &[f32], rate: f64, start: f64) -> Option<&[f32]> {
    let first = (start * rate).ceil() as usize;
    mode.get(first..first + (LENGTH * rate) as usize)
}

/// Frequency of a decaying sine at a sample rate (Hz), Hz; nothing for anything that does not oscillate.
pub fn frequency(samples: &[f32], rate: f64) -> Option<f64> {
    let (mut xx, mut xy, mut yy, mut zx, mut zy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for triple in samples.windows(3) {
        let [y, x, z] = [triple[0], triple[1], triple[2]].map(f64::from);
        xx += x * x;
        xy += x * y;
        yy += y * y;
        zx += z * x;
        zy += z * y;
    }
    let determinant = xx * yy - xy * xy;
    let (a, b) = ((zx * yy - zy * xy) / determinant, (zy * xx - zx * xy) / determinant);
    let cosine = a / (2.0 * (-b).sqrt());
    (cosine.abs() < 1.0).then(|| cosine.acos() * rate / std::f64::consts::TAU)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 1500.0;

    /// A decaying motion whose pitch starts `cents` above 55 Hz and falls with a time constant.
    fn gliding(cents: f64, constant: f64, sigma: f64, seconds: f64) -> Vec<f32> {
        let mut phase = 0.0;
        (0..(seconds * RATE) as usize)
            .map(|n| {
                let t = n as f64 / RATE;
                let frequency = 55.0 * (cents / 1200.0 * (-t / constant).exp()).exp2();
                phase += std::f64::consts::TAU * frequency / RATE;
                ((-sigma * t).exp() * phase.sin()) as f32
            })
            .collect()
    }

    fn glide(mode: Vec<f32>) -> Option<f64> {
        let still = vec![0.0; mode.len()];
        glide_cents(&Motion { modes: vec![still, mode], rate: RATE }, 55.0, 0.0)
    }

    #[test]
    fn a_steady_partial_does_not_glide_however_it_decays() {
        for sigma in [1.0, 8.0, 20.0] {
            let glide = glide(gliding(0.0, 1.0, sigma, 1.0)).unwrap();
            assert!(glide.abs() < 0.05, "{sigma}: {glide}");
        }
    }

    #[test]
    fn a_falling_partial_glides_by_its_mean_in_the_early_window() {
        let glide = glide(gliding(100.0, 0.1, 2.0, 1.0)).unwrap();
        // The mean of exp(-t / 0.1 s) over 5 to 85 ms is 0.65, and less weight lies on its end.
        assert!((glide - 66.0).abs() < 4.0, "{glide}");
    }

    #[test]
    fn too_little_motion_gives_no_figure() {
        assert_eq!(glide(vec![0.0; 1500]), None);
        assert_eq!(glide(gliding(0.0, 1.0, 8.0, 0.3)), None);
        assert_eq!(glide(gliding(0.0, 1.0, 60.0, 1.0)), None);
        let other = Motion { modes: vec![gliding(0.0, 1.0, 8.0, 1.0)], rate: RATE };
        assert_eq!(glide_cents(&other, 80.0, 0.0), None);
    }
}
