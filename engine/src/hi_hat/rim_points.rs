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

/// Points on one side: a wave of even order is the same half a turn on, one of odd order its opposite.
const SIDE: usize = POINTS / 2;

/// The nine even classes and three more, so that rows of them are whole registers.
const EVEN: usize = 12;

/// Values on one side of the waves of every second class from one on: `[place][cosines, sines]`.
const fn on_one_side<const N: usize>(first: usize) -> [[[f64; N]; 2]; SIDE] {
    let mut waves = [[[0.0; N]; 2]; SIDE];
    let mut place = 0;
    while place < SIDE {
        let mut class = first;
        while class < CLASSES {
            waves[place][0][class / 2] = WAVES[class][0][place];
            waves[place][1][class / 2] = WAVES[class][1][place];
            class += 2;
        }
        place += 1;
    }
    waves
}

/// Of even and of odd order.
static EVEN_WAVES: [[[f64; EVEN]; 2]; SIDE] = on_one_side(0);
static ODD_WAVES: [[[f64; SIDE / 2]; 2]; SIDE] = on_one_side(1);

/// Amplitude of the cosine and of the sine, `[class]`, in double precision, in any unit.
pub type FineAmplitudes = [[f64; 2]; CLASSES];

/// In double precision.
#[inline(always)]
pub fn fine(amplitudes: &Amplitudes) -> FineAmplitudes {
    let mut out = [[0.0; 2]; CLASSES];
    for (out, amplitude) in out.as_flattened_mut().iter_mut().zip(amplitudes.as_flattened()) {
        *out = f64::from(*amplitude);
    }
    out
}

/// In single precision.
#[inline(always)]
pub fn rounded(amplitudes: &FineAmplitudes) -> Amplitudes {
    let mut out = Amplitudes::default();
    for (out, amplitude) in out.as_flattened_mut().iter_mut().zip(amplitudes.as_flattened()) {
        *out = *amplitude as f32;
    }
    out
}

/// Values at each point from the amplitudes, in the same unit.
#[inline(always)]
pub fn at_points(amplitudes: &FineAmplitudes) -> [f64; POINTS] {
    let (mut even, mut odd) = ([0.0; SIDE], [0.0; SIDE]);
    let (pairs, last) = amplitudes.as_chunks::<2>();
    let (waves, last_wave) = WAVES.as_chunks::<2>();
    for (pair, waves) in pairs.iter().zip(waves) {
        add_wave(&mut even, &pair[0], &waves[0]);
        add_wave(&mut odd, &pair[1], &waves[1]);
    }
    for (last, waves) in last.iter().zip(last_wave) {
        add_wave(&mut even, last, waves);
    }
    let mut out = [0.0; POINTS];
    for i in 0..SIDE {
        (out[i], out[i + SIDE]) = (even[i] + odd[i], even[i] - odd[i]);
    }
    out
}

/// Adds the wave of a class on one side.
#[inline(always)]
fn add_wave(out: &mut [f64; SIDE], [cos, sin]: &[f64; 2], waves: &[[f64; POINTS]; 2]) {
    for i in 0..SIDE {
        out[i] += cos * waves[0][i] + sin * waves[1][i];
    }
}

/// Forces on each amplitude from forces at the points, N.
#[inline(always)]
pub fn amplitudes(forces: &[f64; POINTS]) -> FineAmplitudes {
    let (mut even, mut odd) = ([[0.0; EVEN]; 2], [[0.0; SIDE / 2]; 2]);
    for place in 0..SIDE {
        let (same, opposite) = (forces[place] + forces[place + SIDE], forces[place] - forces[place + SIDE]);
        for part in 0..2 {
            for i in 0..EVEN {
                even[part][i] += same * EVEN_WAVES[place][part][i];
            }
            for i in 0..SIDE / 2 {
                odd[part][i] += opposite * ODD_WAVES[place][part][i];
            }
        }
    }
    let mut out = [[0.0; 2]; CLASSES];
    for (class, out) in out.iter_mut().enumerate() {
        for part in 0..2 {
            out[part] = if class % 2 == 0 { even[part][class / 2] } else { odd[part][class / 2] };
        }
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
    fn values_and_forces_are_sums_over_all_waves() {
        let amplitude = |class: usize, part: usize| ((class * 7 + part * 3) as f64 * 0.71).sin();
        let given: FineAmplitudes =
            std::array::from_fn(|class| std::array::from_fn(|part| amplitude(class, part)));
        let forces: [f64; POINTS] = std::array::from_fn(|place| (place as f64 * 1.7).cos());
        let (values, felt) = (at_points(&given), amplitudes(&forces));
        for place in 0..POINTS {
            let waves =
                given.iter().zip(&WAVES).map(|(a, wave)| a[0] * wave[0][place] + a[1] * wave[1][place]);
            assert!((values[place] - waves.sum::<f64>()).abs() < 1e-12, "place {place}");
        }
        for (class, felt) in felt.iter().enumerate() {
            for (part, felt) in felt.iter().enumerate() {
                let sum: f64 = forces.iter().zip(&WAVES[class][part]).map(|(force, wave)| force * wave).sum();
                assert!((felt - sum).abs() < 1e-12, "class {class}, part {part}");
            }
        }
    }

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
