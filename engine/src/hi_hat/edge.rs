//! Places around a rim, and the classes of waves that they can tell apart.

use std::f64::consts::TAU;

use crate::modal::folded::ClassCompliances;
use crate::modal::simd::folded::{Amplitudes, MAX_CLASSES};

use super::POINTS;

const _: () = assert!(POINTS / 2 < MAX_CLASSES);

/// Direction of a place, rad.
pub fn angle(place: usize) -> f64 {
    TAU * place as f64 / POINTS as f64
}

/// `cos(2 pi i / POINTS)`; a sine is a quarter of the way back.
const COSINES: [f64; POINTS] = {
    // Of pi / 8 and its double; all others by symmetry.
    const A: f64 = 0.923_879_532_511_286_8;
    const B: f64 = std::f64::consts::FRAC_1_SQRT_2;
    const C: f64 = 0.382_683_432_365_089_8;
    [1.0, A, B, C, 0.0, -C, -B, -A, -1.0, -A, -B, -C, 0.0, C, B, A]
};

/// Cosine and sine of a class's wave at a place.
fn wave(class: usize, place: usize) -> [f64; 2] {
    let turn = class * place % POINTS;
    [COSINES[turn], COSINES[(turn + 3 * POINTS / 4) % POINTS]]
}

/// What amplitudes amount to at each place.
pub fn at_points(amplitudes: &Amplitudes) -> [f64; POINTS] {
    let mut out = [0.0; POINTS];
    for (class, [c, s]) in amplitudes.iter().enumerate().take(POINTS / 2 + 1) {
        let (c, s) = (f64::from(*c), f64::from(*s));
        for (place, out) in out.iter_mut().enumerate() {
            let [cos, sin] = wave(class, place);
            *out += c * cos + s * sin;
        }
    }
    out
}

/// What forces at the places (N) amount to on each amplitude.
pub fn amplitudes(forces: &[f64; POINTS]) -> Amplitudes {
    let mut out = Amplitudes::default();
    for (class, out) in out.iter_mut().enumerate().take(POINTS / 2 + 1) {
        let mut sums = [0.0; 2];
        for (place, force) in forces.iter().enumerate() {
            let [cos, sin] = wave(class, place);
            sums[0] += force * cos;
            sums[1] += force * sin;
        }
        *out = sums.map(|sum| sum as f32);
    }
    out
}

/// Compliance between each two places, m/N.
pub fn between_points(classes: &ClassCompliances) -> [[f64; POINTS]; POINTS] {
    let mut out = [[0.0; POINTS]; POINTS];
    for (class, yields) in classes.iter().enumerate().take(POINTS / 2 + 1) {
        for (i, row) in out.iter_mut().enumerate() {
            let a = wave(class, i);
            for (j, out) in row.iter_mut().enumerate() {
                let b = wave(class, j);
                *out += (0..2).map(|k| a[k] * (yields[k][0] * b[0] + yields[k][1] * b[1])).sum::<f64>();
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_cosines_and_sines() {
        for class in 0..=POINTS / 2 {
            for place in 0..POINTS {
                let [cos, sin] = wave(class, place);
                let (want_sin, want_cos) = (class as f64 * angle(place)).sin_cos();
                assert!((cos - want_cos).abs() < 1e-14 && (sin - want_sin).abs() < 1e-14);
            }
        }
    }
}
