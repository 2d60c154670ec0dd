//! Time features of a struck sound: attack, click, crest, temporal centroid, bloom.
//!
//! The envelope is the root of the power averaged over a raised cosine of 2 ms, which follows a
//! stroke's rise and leaves the swing of low notes in: what a bass drum's attack is, is then the
//! rise of its first swing, as it is heard.

use super::one_shot::OneShot;
use crate::spectra::{Transform, slope};

/// Length of the window the power is averaged over, s.
const WINDOW: f64 = 0.002;

/// The attack is sought in this much of the sound, s.
const ATTACK_WITHIN: f64 = 1.0;

/// The click is what lies above this, Hz.
const CLICK_HZ: f64 = 2000.0;

/// Length of the click, and of the sound it is compared with, s.
const CLICK: [f64; 2] = [0.006, 0.05];

/// The crest is that of so much of the sound, s.
const CREST: f64 = 0.25;

/// The bloom is that of what lies above this, Hz.
const BLOOM_HZ: f64 = 3000.0;

/// Length of the frames in which the bloom's energy is compared and the step between them, s.
const BLOOM_FRAME: [f64; 2] = [0.008, 0.001];

/// The bloom is sought in this much of the sound, s.
const BLOOM_WITHIN: f64 = 1.0;

/// From the first time the envelope is at a tenth of its greatest to the first time it is at nine
/// tenths, ms.
pub fn attack_ms(shot: &OneShot) -> Option<f64> {
    let power: Vec<f64> = shot.samples[..shot.onset + shot.first(ATTACK_WITHIN).len()]
        .iter()
        .map(|&sample| f64::from(sample).powi(2))
        .collect();
    let envelope = averaged(&power, (WINDOW * shot.rate) as usize);
    let greatest = envelope.iter().copied().fold(0.0, f64::max).sqrt();
    let reaches = |share: f64| {
        let level = (share * greatest).powi(2);
        let after = envelope.iter().position(|&power| power >= level)?;
        let before = after.checked_sub(1).map_or(0.0, |n| envelope[n]);
        // Interpolated between samples, by the power.
        Some(after as f64 - (envelope[after] - level) / (envelope[after] - before).max(f64::MIN_POSITIVE))
    };
    Some((reaches(0.9)? - reaches(0.1)?) / shot.rate * 1000.0)
}

/// Energy above 2 kHz in the first 6 ms against all energy in the first 50 ms, dB.
pub fn click_db(shot: &OneShot) -> Option<f64> {
    let [click, whole] = CLICK.map(|seconds| shot.onset + (seconds * shot.rate) as usize);
    // A quarter of an octave of slope on either side.
    let above = Transform::new(&shot.samples, shot.rate)?.filtered(highpass(CLICK_HZ))?;
    let end = |n: usize| n.min(shot.samples.len());
    let click: f64 = above[..end(click)].iter().map(|sample| sample * sample).sum();
    let whole: f64 = shot.samples[..end(whole)].iter().map(|&sample| f64::from(sample).powi(2)).sum();
    decibels(click / whole)
}

/// Peak of the first 250 ms over their root mean square, dB.
pub fn crest_db(shot: &OneShot) -> Option<f64> {
    let sound = shot.first(CREST);
    decibels((super::level::peak(sound) / super::level::rms(sound)?).powi(2))
}

/// Mean time after the beginning, weighted by energy, ms.
pub fn temporal_centroid_ms(shot: &OneShot) -> Option<f64> {
    let (mut moment, mut sum) = (0.0, 0.0);
    for (n, &sample) in shot.sound().iter().enumerate() {
        let energy = f64::from(sample).powi(2);
        moment += n as f64 * energy;
        sum += energy;
    }
    (sum > 0.0).then(|| moment / sum / shot.rate * 1000.0)
}

/// When the energy above 3 kHz is greatest, ms: the middle of the frame of 8 ms, a raised cosine,
/// that holds most of it. Frames begin with the sound or later, so that a click's is 4 ms. Nothing
/// if less than a millionth of the sound lies there.
pub fn bloom_ms(shot: &OneShot) -> Option<f64> {
    let above = Transform::new(&shot.samples, shot.rate)?.filtered(highpass(BLOOM_HZ))?;
    let last = shot.samples.len().min(shot.onset + (BLOOM_WITHIN * shot.rate) as usize);
    let power: Vec<f64> = above[shot.onset..last].iter().map(|sample| sample * sample).collect();
    let whole: f64 = shot.sound().iter().map(|&sample| f64::from(sample).powi(2)).sum();
    if power.iter().sum::<f64>() < 1e-6 * whole {
        return None;
    }
    let [length, step] = BLOOM_FRAME.map(|seconds| (seconds * shot.rate) as usize);
    let smooth = averaged(&power, length);
    let frames = (length / 2..power.len().saturating_sub(length / 2)).step_by(step);
    let greatest = frames.max_by(|&a, &b| smooth[a].total_cmp(&smooth[b]))?;
    Some(greatest as f64 / shot.rate * 1000.0)
}

/// A high pass with a quarter of an octave of slope on either side of a frequency (Hz).
fn highpass(edge: f64) -> impl Fn(f64) -> f64 {
    move |hz| if hz > 0.0 { slope((hz / edge).log2() * 4.0) } else { 0.0 }
}

/// Running mean under a raised cosine of so many samples, centred.
fn averaged(power: &[f64], length: usize) -> Vec<f64> {
    let length = length.max(1);
    let bell: Vec<f64> =
        (0..length).map(|n| 1.0 - (std::f64::consts::TAU * (n as f64 + 0.5) / length as f64).cos()).collect();
    let sum: f64 = bell.iter().sum();
    (0..power.len())
        .map(|middle| {
            let at = |n: usize| (middle + n).checked_sub(length / 2).and_then(|place| power.get(place));
            bell.iter().enumerate().map(|(n, weight)| weight * at(n).copied().unwrap_or(0.0)).sum::<f64>()
                / sum
        })
        .collect()
}

/// A ratio of energies in dB; nothing for none.
pub(super) fn decibels(ratio: f64) -> Option<f64> {
    (ratio > 0.0 && ratio.is_finite()).then(|| 10.0 * ratio.log10())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn shot(seconds: f64, sound: impl Fn(f64) -> f64) -> OneShot {
        let samples: Vec<f32> =
            (0..(seconds * RATE) as usize).map(|n| sound(n as f64 / RATE) as f32).collect();
        OneShot::new(&samples, RATE).unwrap()
    }

    fn sine(frequency: f64, t: f64) -> f64 {
        (std::f64::consts::TAU * frequency * t).sin()
    }

    #[test]
    fn a_straight_rise_takes_eight_tenths_of_its_time() {
        let shot = shot(0.5, |t| sine(3000.0, t) * (t / 0.02).min(1.0) * (-t).exp());
        let attack = attack_ms(&shot).unwrap();
        assert!((attack - 16.0).abs() < 0.6, "{attack}");
    }

    #[test]
    fn a_click_rises_as_fast_as_the_window() {
        let shot = shot(0.2, |t| if t == 0.0 { 1.0 } else { 0.0 });
        assert!(attack_ms(&shot).unwrap() < 1.0);
    }

    #[test]
    fn the_click_is_the_share_of_what_is_high_and_early() {
        // A low sine of energy 1/2 x 50 ms; a high burst of 4 ms a tenth as strong, and one too late.
        let sound = |t: f64| {
            let burst = if t < 0.004 || (0.02..0.03).contains(&t) { 0.1 } else { 0.0 };
            sine(100.0, t) + burst * sine(6000.0, t)
        };
        let click = click_db(&shot(0.5, sound)).unwrap();
        let want = 10.0 * (0.01 * 0.004 / 0.05_f64).log10();
        assert!((click - want).abs() < 0.5, "{click} {want}");
    }

    #[test]
    fn a_sine_has_a_crest_of_3_db_and_a_short_burst_a_great_one() {
        assert!((crest_db(&shot(1.0, |t| sine(440.0, t))).unwrap() - 3.01).abs() < 0.05);
        // A hundredth of the quarter second: 20 dB more.
        let burst = |t: f64| if t < 0.0025 { sine(4000.0, t) } else { 0.0 };
        assert!((crest_db(&shot(1.0, burst)).unwrap() - 23.01).abs() < 0.1);
    }

    #[test]
    fn a_decay_has_its_centre_a_13_8th_of_its_t60_after_the_stroke() {
        let shot = shot(4.0, |t| (-6.9078 * t / 1.2).exp() * sine(300.0, t));
        let centre = temporal_centroid_ms(&shot).unwrap();
        assert!((centre - 1200.0 / 13.8155).abs() < 1.0, "{centre}");
    }

    #[test]
    fn the_bloom_is_where_the_high_band_peaks() {
        let swell = |at: f64| {
            move |t: f64| {
                sine(300.0, t) * (-3.0 * t).exp() + 0.2 * sine(5000.0, t) * (-((t - at) / 0.03).powi(2)).exp()
            }
        };
        let bloom = bloom_ms(&shot(1.0, swell(0.1))).unwrap();
        assert!((bloom - 100.0).abs() < 2.0, "{bloom}");
        let click = bloom_ms(&shot(1.0, |t| sine(5000.0, t) * (-t / 0.002).exp())).unwrap();
        assert!((3.9..4.2).contains(&click), "{click}");
        let mute = shot(1.0, |t| sine(300.0, t) * (std::f64::consts::PI * t).sin().powi(2));
        assert_eq!(bloom_ms(&mute), None);
    }
}
