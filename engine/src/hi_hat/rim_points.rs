//! Points around a rim, and the classes of waves that they distinguish.

use std::f64::consts::TAU;

use crate::modal::rim_harmonics::ClassCompliances;
use crate::modal::simd::rim_harmonics::{Amplitudes, MAX_CLASSES};

/// Points around the rims where they may touch. *Derived*: 35 mm apart, as far as a bending
/// wave of 1 mm of bronze is long at 6 kHz.
pub const POINTS: usize = 32;

const _: () = assert!(CLASSES <= MAX_CLASSES);

/// Direction of a point, rad.
pub fn angle(place: usize) -> f64 {
    TAU * place as f64 / POINTS as f64
}

/// Classes of waves.
const CLASSES: usize = POINTS / 2 + 1;

/// Cosine and sine of every class's wave, `[class][cosine, sine][point]`.
static WAVES: [[[f64; POINTS]; 2]; CLASSES] = {
    // Cosines of the multiples of pi / 16 up to a quarter of a turn; all others by symmetry.
    const QUARTER: [f64; POINTS / 4 + 1] = [
        1.0,
        0.980_785_280_403_230_4,
        0.923_879_532_511_286_7,
        0.831_469_612_302_545_2,
        std::f64::consts::FRAC_1_SQRT_2,
        0.555_570_233_019_602_3,
        0.382_683_432_365_089_84,
        0.195_090_322_016_128_33,
        0.0,
    ];
    const fn cosine(turn: usize) -> f64 {
        let turn = turn % POINTS;
        let turn = if turn > POINTS / 2 { POINTS - turn } else { turn };
        if turn > POINTS / 4 { -QUARTER[POINTS / 2 - turn] } else { QUARTER[turn] }
    }
    let mut waves = [[[0.0; POINTS]; 2]; CLASSES];
    let mut class = 0;
    while class < CLASSES {
        let mut place = 0;
        while place < POINTS {
            waves[class][0][place] = cosine(class * place);
            // A sine is the cosine a quarter of a turn before.
            waves[class][1][place] = cosine(class * place + 3 * POINTS / 4);
            place += 1;
        }
        class += 1;
    }
    waves
};

/// Values at each point from the amplitudes, in the same unit.
#[inline(always)]
pub fn at_points(amplitudes: &Amplitudes) -> [f64; POINTS] {
    let mut out = [0.0; POINTS];
    for (amplitude, waves) in amplitudes.iter().flatten().zip(WAVES.as_flattened()) {
        let amplitude = f64::from(*amplitude);
        for (out, wave) in out.iter_mut().zip(waves) {
            *out += amplitude * wave;
        }
    }
    out
}

/// Forces on each amplitude from forces at the points, N.
#[inline(always)]
pub fn amplitudes(forces: &[f64; POINTS]) -> Amplitudes {
    let mut out = Amplitudes::default();
    for (out, waves) in out.as_flattened_mut().iter_mut().zip(WAVES.as_flattened()) {
        // Sums side by side, so that the compiler may use all lanes.
        let mut sums = [0.0; 4];
        for (force, wave) in forces.as_chunks::<4>().0.iter().zip(waves.as_chunks::<4>().0) {
            for i in 0..4 {
                sums[i] += force[i] * wave[i];
            }
        }
        *out = (sums[0] + sums[1] + sums[2] + sums[3]) as f32;
    }
    out
}

/// Compliance between each two points, m/N.
pub fn between_points(classes: &ClassCompliances) -> [[f64; POINTS]; POINTS] {
    let mut out = [[0.0; POINTS]; POINTS];
    for (compliance, waves) in classes.iter().zip(&WAVES) {
        for (i, row) in out.iter_mut().enumerate() {
            for (j, out) in row.iter_mut().enumerate() {
                let to = |k: usize| compliance[k][0] * waves[0][j] + compliance[k][1] * waves[1][j];
                *out += waves[0][i] * to(0) + waves[1][i] * to(1);
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
        for (class, [cosines, sines]) in WAVES.iter().enumerate() {
            for (place, (cos, sin)) in cosines.iter().zip(sines).enumerate() {
                let (want_sin, want_cos) = (class as f64 * angle(place)).sin_cos();
                assert!((cos - want_cos).abs() < 1e-13 && (sin - want_sin).abs() < 1e-13);
            }
        }
    }
}
