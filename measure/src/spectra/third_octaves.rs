//! Third octaves: how loud a sound is in each, and how far two sounds are apart.

use std::f64::consts::TAU;

/// Centre of a third octave, Hz; that of the first, 0, is 25 Hz.
pub fn centre(band: i32) -> f64 {
    25.0 * 2.0_f64.powf(f64::from(band) / 3.0)
}

/// Power in third octaves from 25 Hz to 16 kHz of a sound at a sample rate (Hz), dB, by a filter each (two resonators in
/// a row).
pub fn third_octaves(sound: &[f32], rate: f64) -> Vec<f64> {
    let level = |band: i32| {
        let omega = TAU * centre(band) / rate;
        // Band-pass of quality 4.3, as wide as a third of an octave.
        let alpha = omega.sin() / (2.0 * 4.32);
        let (b, a1, a2) =
            (alpha / (1.0 + alpha), -2.0 * omega.cos() / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha));
        let mut filtered: Vec<f64> = sound.iter().map(|&x| f64::from(x)).collect();
        for _ in 0..2 {
            let (mut x1, mut x2, mut y1, mut y2) = (0.0, 0.0, 0.0, 0.0);
            for x in &mut filtered {
                let y = b * (*x - x2) - a1 * y1 - a2 * y2;
                (x2, x1, y2, y1) = (x1, *x, y1, y);
                *x = y;
            }
        }
        10.0 * (filtered.iter().map(|y| y * y).sum::<f64>() / sound.len() as f64 + 1e-30).log10()
    };
    (0..29).map(level).collect()
}

/// Mean difference of third octaves, dB.
pub fn mean_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64
}

/// Largest difference of third octaves, dB.
pub fn worst_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Chance;

    const RATE: f64 = 48_000.0;

    fn sine(frequency: f64, size: f64) -> Vec<f32> {
        (0..48_000).map(|n| (size * (TAU * frequency * f64::from(n) / RATE).sin()) as f32).collect()
    }

    #[test]
    fn a_sine_is_as_loud_as_it_is_in_its_third_and_far_below_two_octaves_away() {
        for band in [6, 16, 25] {
            let levels = third_octaves(&sine(centre(band), 0.1), RATE);
            let at = levels[band as usize];
            // A size of .1 has a mean square of .005.
            assert!((at + 23.01).abs() < 0.2, "{band}: {at} dB");
            assert!(levels[band as usize - 6] < at - 40.0, "{levels:?}");
        }
    }

    #[test]
    fn noise_rises_by_a_decibel_a_third_and_two_sounds_are_as_far_apart_as_they_are_loud() {
        let mut chance = Chance::new(3);
        let noise: Vec<f32> = (0..480_000).map(|_| chance.between(-0.1, 0.1) as f32).collect();
        let louder: Vec<f32> = noise.iter().map(|x| 2.0 * x).collect();
        let [quiet, loud] = [noise, louder].map(|sound| third_octaves(&sound, RATE));
        let rise = (quiet[20] - quiet[8]) / 12.0;
        assert!((rise - 1.0).abs() < 0.1, "{rise} dB");
        for difference in [mean_difference(&quiet, &loud), worst_difference(&quiet, &loud)] {
            assert!((difference - 6.02).abs() < 0.01, "{difference} dB");
        }
    }
}
