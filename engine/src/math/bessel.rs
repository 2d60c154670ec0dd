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
mod single;
mod table;
mod zeros;

pub use single::{i_log_derivative, i_prime_scaled, i_scaled, i_scaled_pair, j, j_pair, j_prime};
pub use table::{ITable, JTable};
pub use zeros::{zero, zero_prime, zeros, zeros_prime};

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
