//! Bessel functions of integer order: `J_m` and the modified `I_m`, their derivatives, zeros and
//! tables.
//!
//! Model: `J_m` below its turning point (`x < m`) and single orders come from `libm`; the ascending
//! recurrence is stable from there on. All orders at once, and every `I_m`, come from Miller's
//! descending recurrence, normalized by `J_0 + 2 sum J_2k = 1` and `I_0 + 2 sum I_k = e^x`.
//! `I_m` is always scaled by `e^-x`, so that ratios such as `I_m(lambda r) / I_m(lambda)` can be
//! formed at any argument.
//!
//! Source: Abramowitz & Stegun, ch. 9; Gautschi, Computational aspects of three-term recurrence
//! relations, 1967.
//!
//! Limits: `x >= 0`. Absolute error about 1e-15 for `J_m`; relative error about 1e-14 for `I_m`.

pub(crate) mod lanes;
mod table;
mod zeros;

pub use table::{ITable, JTable};
pub use zeros::{zero, zero_prime, zeros, zeros_prime};

/// Values above this are scaled down during Miller's recurrence, long before they overflow.
const MILLER_LARGE: f64 = 1e200;

/// Bessel function of the first kind `J_m(x)`.
pub fn j(m: u32, x: f64) -> f64 {
    match m {
        0 => libm::j0(x),
        1 => libm::j1(x),
        _ => j_pair(m, x).0,
    }
}

/// Derivative `J_m'(x)`.
pub fn j_prime(m: u32, x: f64) -> f64 {
    j_pair(m, x).1
}

/// `J_m(x)` and `J_m'(x)` at the cost of one.
pub fn j_pair(m: u32, x: f64) -> (f64, f64) {
    if m == 0 {
        return (libm::j0(x), -libm::j1(x));
    }
    if x == 0.0 {
        return (0.0, if m == 1 { 0.5 } else { 0.0 });
    }
    let (below, value) = if x < f64::from(m) {
        // Upward recurrence would amplify the second solution here.
        (libm::jn(m as i32 - 1, x), libm::jn(m as i32, x))
    } else {
        (1..m).fold((libm::j0(x), libm::j1(x)), |(below, value), k| {
            (value, f64::from(2 * k) / x * value - below)
        })
    };
    (value, below - f64::from(m) / x * value)
}

/// Scaled modified Bessel function `e^-x I_m(x)`.
pub fn i_scaled(m: u32, x: f64) -> f64 {
    i_scaled_pair(m, x).0
}

/// Scaled derivative `e^-x I_m'(x)` (the derivative scaled, not the derivative of the scaled).
pub fn i_prime_scaled(m: u32, x: f64) -> f64 {
    i_scaled_pair(m, x).1
}

/// `e^-x I_m(x)` and `e^-x I_m'(x)` at the cost of one.
pub fn i_scaled_pair(m: u32, x: f64) -> (f64, f64) {
    let mut kept = [0.0; 2];
    i_miller(m as usize, x, &mut kept);
    let [value, above] = kept;
    let slope = if x == 0.0 { if m == 1 { 0.5 } else { 0.0 } } else { above + f64::from(m) / x * value };
    (value, slope)
}

/// Fills `out` with `e^-x I_m(x)` for `m = first, first + 1, ...`.
fn i_miller(first: usize, x: f64, out: &mut [f64]) {
    out.fill(0.0);
    if x == 0.0 {
        if let (0, Some(value)) = (first, out.first_mut()) {
            *value = 1.0;
        }
        return;
    }
    // I_k falls as exp(-k^2 / 2x) at first and as (x / 2k)^k later.
    let top = (first + out.len()) as f64;
    let start = 20 + (top * top + 90.0 * x).sqrt() as usize;
    let (mut above, mut value) = (0.0, 1e-30);
    let mut norm = 0.0;
    for k in (0..=start).rev() {
        if (first..first + out.len()).contains(&k) {
            out[k - first] = value;
        }
        norm += if k == 0 { value } else { 2.0 * value };
        if k == 0 {
            break;
        }
        let below = 2.0 * k as f64 / x * value + above;
        (above, value) = (value, below);
        if value > MILLER_LARGE {
            for scaled in [&mut above, &mut value, &mut norm] {
                *scaled /= MILLER_LARGE;
            }
            for stored in out.iter_mut() {
                *stored /= MILLER_LARGE;
            }
        }
    }
    for stored in out {
        *stored /= norm;
    }
}

/// Logarithmic derivative `x I_m'(x) / I_m(x)`; `m` at `x = 0`.
///
/// By the continued fraction of `I_{m+1} / I_m`, run upward from where the bound of Amos (1974)
/// is close enough to start from.
pub fn i_log_derivative(m: u32, x: f64) -> f64 {
    let order = f64::from(m);
    let steps = 8 + ((order * order + 36.0 * x).sqrt() - order) as u32;
    let above = f64::from(m + steps + 1);
    let mut ratio = x / (above + (above * above + x * x).sqrt());
    for k in (m + 1..=m + steps).rev() {
        ratio = x / (f64::from(2 * k) + x * ratio);
    }
    order + x * ratio
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(m, x, J_m(x), J_m'(x))` to twenty digits by arbitrary-precision arithmetic.
    const J: [(u32, f64, f64, f64); 11] = [
        (0, 1.0, 0.765_197_686_557_966_6, -0.440_050_585_744_933_5),
        (1, 1.0, 0.440_050_585_744_933_5, 0.325_147_100_813_033_05),
        (0, 10.0, -0.245_935_764_451_348_35, -0.043_472_746_168_861_44),
        (2, 5.0, 0.046_565_116_277_752_214, -0.346_205_184_102_566_1),
        (5, 10.0, -0.234_061_528_186_793_63, -0.102_571_922_008_611_72),
        (40, 60.0, -0.077_646_197_404_715_07, 0.068_687_649_820_770_65),
        (90, 100.0, -0.069_802_413_874_095_68, -0.041_299_933_226_415_05),
        (90, 60.0, 1.590_777_288_412_096_6e-10, 1.788_847_393_851_914e-10),
        (150, 390.0, 0.034_683_406_586_234_53, -0.022_002_174_627_615_525),
        (7, 0.01, 1.550_094_362_295_914_7e-20, 1.085_065_084_797_827_4e-17),
        (70, 70.0, 0.108_530_843_082_414_6, 0.023_878_946_747_574_556),
    ];

    /// `(m, x, e^-x I_m(x), e^-x I_m'(x))`, likewise.
    const I: [(u32, f64, f64, f64); 7] = [
        (0, 1.0, 0.465_759_607_593_640_43, 0.207_910_415_349_708_44),
        (3, 0.5, 0.001_604_341_507_565_460_8, 0.009_726_008_664_270_515),
        (0, 75.0, 0.046_143_247_062_816_965, 0.045_834_586_045_150_394),
        (70, 75.0, 1.742_680_206_478_729e-15, 2.377_598_433_939_792e-15),
        (70, 60.0, 2.337_553_954_251_106_8e-18, 3.583_655_910_446_617_6e-18),
        (150, 100.0, 3.199_884_962_577_762e-45, 5.763_768_562_710_697e-45),
        (20, 1.0, 1.459_317_405_681_868_6e-25, 2.922_107_498_383_278_5e-24),
    ];

    #[test]
    fn j_and_its_derivative_agree_with_a_trusted_source_to_1e_14() {
        for (m, x, value, slope) in J {
            assert!((j(m, x) - value).abs() < 1e-14, "J_{m}({x}) = {}", j(m, x));
            assert!((j_prime(m, x) - slope).abs() < 1e-14, "J_{m}'({x})");
        }
    }

    #[test]
    fn all_orders_at_once_agree_with_single_orders() {
        let mut all = [[0.0; lanes::LANES]; 120];
        for x in [[0.02, 0.03, 0.5, 0.7, 1.0, 5.0, 59.9, 112.0], [112.5; 8], [0.02; 8], [300.0; 8]] {
            lanes::j_orders(&x, &mut all);
            for (m, row) in (0..).zip(&all) {
                for (&x, &value) in x.iter().zip(row) {
                    assert!((value - j(m, x)).abs() < 1e-14, "J_{m}({x})");
                }
            }
            lanes::i_scaled_orders(&x, &mut all);
            for (m, row) in (0..).zip(&all) {
                for (&x, &value) in x.iter().zip(row) {
                    let single = i_scaled(m, x);
                    assert!((value - single).abs() <= 1e-13 * single + 1e-300, "I_{m}({x})");
                }
            }
        }
    }

    #[test]
    fn spherical_functions_are_theirs() {
        use std::f64::consts::PI;
        let mut all = [[0.0; lanes::LANES]; 30];
        let x = [1e-3, 0.4, 3.0, PI, 17.0, 44.0, 90.0, 91.0];
        lanes::spherical_orders(&x, &mut all);
        for (lane, x) in x.into_iter().enumerate() {
            let out = all.map(|row| row[lane]);
            let (sin, cos) = x.sin_cos();
            let j1 = sin / (x * x) - cos / x;
            assert!((out[0] - sin / x).abs() < 1e-12 / x.max(1.0));
            assert!((out[1] - j1).abs() < 1e-10 * (1.0 / x).clamp(1e-2, 1.0), "{x}: {} {j1}", out[1]);
            // The recurrence holds throughout.
            let want = 13.0 / x * out[6] - out[5];
            assert!((out[7] - want).abs() < 1e-9 * (out[5].abs() + 13.0 / x * out[6].abs()).max(1e-300));
        }
    }

    #[test]
    fn scaled_i_agrees_with_a_trusted_source_to_1e_13() {
        for (m, x, value, slope) in I {
            assert!((i_scaled(m, x) / value - 1.0).abs() < 1e-13, "I_{m}({x})");
            assert!((i_prime_scaled(m, x) / slope - 1.0).abs() < 1e-13, "I_{m}'({x})");
            let log_derivative = x * slope / value;
            assert!((i_log_derivative(m, x) / log_derivative - 1.0).abs() < 1e-13, "I_{m}({x})");
        }
    }

    #[test]
    fn neighbouring_orders_obey_their_recurrence_across_the_turning_point() {
        for m in 1..120 {
            for x in [0.5, 3.0, 20.0, 75.0, 112.0] {
                let left = j(m - 1, x) + j(m + 1, x);
                assert!((left - 2.0 * f64::from(m) / x * j(m, x)).abs() < 1e-14, "{m} {x}");
            }
        }
    }
}
