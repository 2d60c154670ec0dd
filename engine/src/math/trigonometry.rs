//! Sines and cosines side by side.

use std::f64::consts::TAU;

/// Sine and cosine of `x` (rad) within 1e-8, without branches or divisions, so that a loop of them goes side by side.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    /// Adding it rounds to whole numbers.
    const ROUND: f64 = 1.5 * (1_u64 << 52) as f64;
    const TURNS: f64 = 1.0 / TAU;
    /// Taylor's coefficients, from the last.
    const SIN: [f64; 5] = [-1.0 / 39_916_800.0, 1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0];
    const COS: [f64; 5] = [-1.0 / 3_628_800.0, 1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5];
    // A quarter of the angle, within an eighth of a turn; then doubled twice.
    let quarter = 0.25 * (x - TAU * ((x * TURNS + ROUND) - ROUND));
    let y = quarter * quarter;
    let (mut sin, mut cos) = (SIN[0], COS[0]);
    for i in 1..5 {
        sin = sin * y + SIN[i];
        cos = cos * y + COS[i];
    }
    let (sin, cos) = (quarter * (1.0 + y * sin), 1.0 + y * cos);
    let (sin, cos) = (2.0 * sin * cos, 1.0 - 2.0 * sin * sin);
    (2.0 * sin * cos, 1.0 - 2.0 * sin * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_sine_and_cosine_are_right_to_1e_8() {
        for i in -4000..4000 {
            let x = 0.0123 * f64::from(i);
            let (sin, cos) = sin_cos(x);
            assert!((sin - x.sin()).abs() < 1e-8 && (cos - x.cos()).abs() < 1e-8, "{x}: {sin} {cos}");
        }
    }
}
