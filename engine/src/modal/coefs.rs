//! Coefficients of the loop, from the constants of the modes.
//!
//! They are computed again for all modes whenever a knob or a hand moves, while the sound plays. So there is no call of a
//! library's function in them: sine, cosine and exponential are polynomials, and the modes are computed [`TOGETHER`], which
//! the compiler turns into vectors. Every operation is rounded as written, so that one mode alone, many together and all
//! instruction sets give the same bits.

use super::row::{Row, zero_row};

/// Modes computed together: some vectors of `f64`, and whole lanes of the rows.
pub(super) const TOGETHER: usize = super::simd::LANES;

/// Constants of a mode in its equation of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Undamped angular frequency, rad/s, above 0.
    pub omega: f64,
    /// Amplitude decay rate, 1/s, 0 to below `omega`.
    pub sigma: f64,
    /// Modal mass, kg, above 0.
    pub mass: f64,
}

impl Mode {
    /// Damped angular frequency, rad/s.
    #[inline(always)]
    pub fn omega_d(&self) -> f64 {
        // A mode damped past critical is kept oscillating, barely; no body here comes near.
        (self.omega * self.omega - self.sigma * self.sigma).max(1e-6 * self.omega * self.omega).sqrt()
    }
}

/// Coefficients of the loop, `[mode]` in every row.
pub(super) struct ModalCoefs {
    /// `e^(lambda dt) - 1`.
    pub(super) turn_re: Row,
    pub(super) turn_im: Row,
    /// `b`, the effect of a unit modal force held for one sample.
    pub(super) hold_re: Row,
    pub(super) hold_im: Row,
}

/// Rotations of modes that are detuned for a while, beside their own.
pub(super) struct DetunedTurns {
    /// Rotations less one, `[mode]`.
    pub(super) turn_re: Row,
    pub(super) turn_im: Row,
    /// Whether they are in use.
    pub(super) is_active: bool,
}

impl DetunedTurns {
    /// Of so many modes, not in use. Allocates.
    pub(super) fn new(modes: usize) -> DetunedTurns {
        DetunedTurns { turn_re: zero_row(modes), turn_im: zero_row(modes), is_active: false }
    }
}

impl ModalCoefs {
    /// Of modes at a time step of `dt`, s. Allocates.
    pub(super) fn new(modes: &[Mode], dt: f64) -> ModalCoefs {
        let row = || zero_row(modes.len());
        let mut coefs = ModalCoefs { turn_re: row(), turn_im: row(), hold_re: row(), hold_im: row() };
        modes.chunks(1).enumerate().for_each(|(k, mode)| coefs.update(k, 1, &Constants::<1>::of(mode), dt));
        coefs
    }

    /// Computes those of some modes, from `first` on, anew.
    #[inline(always)]
    pub(super) fn update<const N: usize>(&mut self, first: usize, modes: usize, new: &Constants<N>, dt: f64) {
        let rows = [&mut self.turn_re, &mut self.turn_im, &mut self.hold_re, &mut self.hold_im];
        for (row, new) in rows.into_iter().zip(&new.columns(dt)) {
            row[first..first + modes].copy_from_slice(&new[..modes]);
        }
    }
}

/// The constants of some modes, each in a row of its own.
#[derive(Clone, Copy)]
pub(super) struct Constants<const N: usize> {
    pub(super) omega: [f64; N],
    pub(super) sigma: [f64; N],
    pub(super) mass: [f64; N],
}

impl<const N: usize> Constants<N> {
    /// Of up to `N` modes; those that are missing have no losses, and no meaning.
    #[inline(always)]
    pub(super) fn of(modes: &[Mode]) -> Constants<N> {
        let mut all = Constants { omega: [1.0; N], sigma: [0.0; N], mass: [1.0; N] };
        for (i, mode) in modes.iter().take(N).enumerate() {
            (all.omega[i], all.sigma[i], all.mass[i]) = (mode.omega, mode.sigma, mode.mass);
        }
        all
    }

    /// Mode `i`.
    #[inline(always)]
    pub(super) fn mode(&self, i: usize) -> Mode {
        Mode { omega: self.omega[i], sigma: self.sigma[i], mass: self.mass[i] }
    }

    /// Their coefficients, in the order of the rows of [`ModalCoefs`].
    #[inline(always)]
    fn columns(&self, dt: f64) -> [[f32; N]; 4] {
        let mut all = [[0.0; N]; 4];
        for i in 0..N {
            let coefs = coefs(&self.mode(i), dt);
            for (row, new) in all.iter_mut().zip(coefs) {
                row[i] = new;
            }
        }
        all
    }
}

/// `e^(lambda dt) - 1` and `b` of a mode: real and imaginary part of each.
#[inline(always)]
fn coefs(mode: &Mode, dt: f64) -> [f32; 4] {
    let (omega_d, sigma) = (mode.omega_d(), mode.sigma);
    let turned = omega_d * dt;
    // e^(lambda dt) - 1 without cancellation: expm1 and the half angle.
    let gone = expm1(-sigma * dt);
    let decay = 1.0 + gone;
    let (half, cos_half) = half_angle(turned);
    let re = gone - 2.0 * decay * half * half;
    let im = decay * 2.0 * half * cos_half;
    // b = (re + i im) / (lambda M omega_d)
    let scale = 1.0 / (mode.mass * omega_d * (sigma * sigma + omega_d * omega_d));
    let (turn_re, turn_im) = round_turn(re, im, decay);
    let hold_re = ((-sigma * re + omega_d * im) * scale) as f32;
    let hold_im = ((-sigma * im - omega_d * re) * scale) as f32;
    // Silent: z goes to zero and no force moves it.
    let silent = turned >= std::f64::consts::PI;
    if silent { [-1.0, 0.0, 0.0, 0.0] } else { [turn_re, turn_im, hold_re, hold_im] }
}

/// Sine and cosine of `x / 2` (rad), `x` from 0 to pi; beyond, those of pi.
#[inline(always)]
fn half_angle(x: f64) -> (f64, f64) {
    let quarter = 0.25 * if x < std::f64::consts::PI { x } else { std::f64::consts::PI };
    let square = quarter * quarter;
    // Taylor's series: the next term is below the last bit up to pi / 4.
    const SIN: [f64; 8] = [
        1.0,
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5_040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
    ];
    const COS: [f64; 9] = [
        1.0,
        -1.0 / 2.0,
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
        1.0 / 20_922_789_888_000.0,
    ];
    let (sin, cos) = (quarter * series(&SIN, square), series(&COS, square));
    (2.0 * sin * cos, 1.0 - 2.0 * sin * sin)
}

/// `e^x - 1` for `x` up to 0; below -30, that of -30.
#[inline(always)]
fn expm1(x: f64) -> f64 {
    const TAYLOR: [f64; 11] = [
        1.0,
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
    ];
    // Of a sixteenth, squared four times: (1 + p)^2 = 1 + p (2 + p).
    let part = if x > -30.0 { x } else { -30.0 } / 16.0;
    let mut p = part * series(&TAYLOR, part);
    for _ in 0..4 {
        p *= 2.0 + p;
    }
    p
}

/// A polynomial, its coefficients from the lowest power up.
#[inline(always)]
fn series<const TERMS: usize>(coefficients: &[f64; TERMS], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// Rounds `e^(lambda dt) - 1` to `f32` so that the size of `e^(lambda dt)` stays `decay`.
///
/// Of a slow rotation both parts are small and their rounding is too. Of a fast one it would
/// change a decay of 1 s by some thousandths: of the nine neighbours in `f32` the one of the
/// truest size is taken, at the price of an angle wrong by 1e-7 rad.
#[inline(always)]
fn round_turn(re: f64, im: f64, decay: f64) -> (f32, f32) {
    const SLOW: f64 = 0.05;
    let nearest = (re as f32, im as f32);
    // Its neighbours by their bits. That of zero toward zero is not a number, and never the truest.
    let around = |x: f32| [x, f32::from_bits(x.to_bits().wrapping_sub(1)), f32::from_bits(x.to_bits() + 1)];
    let size = decay * decay;
    let error = |re: f32, im: f32| {
        let (re, im) = (1.0 + f64::from(re), f64::from(im));
        (re * re + im * im - size).abs()
    };
    let (mut best, mut least) = (nearest, error(nearest.0, nearest.1));
    for re in around(nearest.0) {
        for im in around(nearest.1) {
            let error = error(re, im);
            let better = error < least;
            best = (if better { re } else { best.0 }, if better { im } else { best.1 });
            least = if better { error } else { least };
        }
    }
    if im.abs() + re.abs() < SLOW { nearest } else { best }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients as the library's functions give them, the nearest in size found by the root.
    fn oracle(mode: &Mode, dt: f64) -> [f32; 4] {
        let (omega_d, sigma) = (mode.omega_d(), mode.sigma);
        let decay = (-sigma * dt).exp();
        let half = (0.5 * omega_d * dt).sin();
        let re = (-sigma * dt).exp_m1() - 2.0 * decay * half * half;
        let im = decay * (omega_d * dt).sin();
        let scale = 1.0 / (mode.mass * omega_d * (sigma * sigma + omega_d * omega_d));
        let around = |x: f32| [x, x.next_down(), x.next_up()];
        let error = |re: f32, im: f32| ((1.0 + f64::from(re)).hypot(f64::from(im)) - decay).abs();
        let mut best = (re as f32, im as f32);
        if im.abs() + re.abs() >= 0.05 {
            for re in around(re as f32) {
                for im in around(im as f32) {
                    if error(re, im) < error(best.0, best.1) {
                        best = (re, im);
                    }
                }
            }
        }
        let hold = [-sigma * re + omega_d * im, -sigma * im - omega_d * re];
        [best.0, best.1, (hold[0] * scale) as f32, (hold[1] * scale) as f32]
    }

    #[test]
    fn the_coefficients_are_those_of_the_library_s_functions() {
        let (mut differ, mut all) = (0, 0);
        for dt in [1.0 / 44_100.0, 1.0 / 192_000.0] {
            for step in 0..4000 {
                let omega = 3.0 * (0.999 * std::f64::consts::PI / dt / 3.0).powf(f64::from(step) / 3999.0);
                for sigma in [0.0, 0.3, 7.0, 300.0, 10_000.0] {
                    let mode = Mode { omega, sigma, mass: 0.3 };
                    let (got, want) = (coefs(&mode, dt), oracle(&mode, dt));
                    for (got, want) in got.into_iter().zip(want) {
                        // A place in the last bit, near half the rate some of a number that vanishes.
                        let close = (got - want).abs() <= 2.5e-7 * want.abs() + 1e-14 * want.abs().max(1e-3);
                        assert!(close, "{mode:?}: {got} for {want}");
                        // Slow and heavily damped ones cancel in both forms alike.
                        if sigma < 0.1 * omega {
                            differ += u32::from(got != want);
                            all += 1;
                        }
                    }
                }
            }
        }
        assert!(differ * 10_000 < all, "{differ} of {all}");
    }
}
