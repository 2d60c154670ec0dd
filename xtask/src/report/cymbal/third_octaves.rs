//! Third octaves: how loud a sound is in each, and how far two sounds are apart.

use std::f64::consts::TAU;

use super::RATE;

/// Centre of a third octave, Hz; that of the first, 0, is 25 Hz.
pub fn centre(band: i32) -> f64 {
    25.0 * 2.0_f64.powf(f64::from(band) / 3.0)
}

/// Power in third octaves from 25 Hz to 16 kHz, dB, by a filter each (two resonators in a row).
pub fn third_octaves(sound: &[f32]) -> Vec<f64> {
    let level = |band: i32| {
        let omega = TAU * centre(band) / RATE;
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
