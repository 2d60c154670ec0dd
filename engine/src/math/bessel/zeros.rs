//! Positive zeros of `J_m` and of `J_m'`, counted without a gap.
//!
//! Zeros of `J_m` lie more than three apart (they approach pi, from above for `m > 0`, from 3.115
//! for `m = 0`) and none below `sqrt(m (m + 2))`, so a scan in steps of one meets each in an
//! interval of its own. Zeros of `J_m'` interlace with them.
//!
//! Source: Watson, A Treatise on the Theory of Bessel Functions, 15.3 and 15.8.

use super::single::{j, j_prime};
use crate::math::roots;

/// Relative accuracy asked of a zero.
const TOLERANCE: f64 = 1e-15;

/// The `n`-th positive zero `j_{m,n}` of `J_m`, `n` from 1.
pub fn zero(m: u32, n: u32) -> f64 {
    zeros(m, n).last().copied().unwrap_or(0.0)
}

/// The `n`-th positive zero `j'_{m,n}` of `J_m'`, `n` from 1; `x = 0` is not counted for `m = 0`.
pub fn zero_prime(m: u32, n: u32) -> f64 {
    zeros_prime(m, n).last().copied().unwrap_or(0.0)
}

/// The first `count` positive zeros of `J_m`, ascending.
pub fn zeros(m: u32, count: u32) -> Vec<f64> {
    let order = f64::from(m);
    let mut left = (order * (order + 2.0)).sqrt().max(1.0);
    let mut found = Vec::with_capacity(count as usize);
    while found.len() < count as usize {
        let right = left + 1.0;
        let Some(zero) = roots::find(|x| j(m, x), left, right, TOLERANCE) else {
            left = right;
            continue;
        };
        found.push(zero);
        left = zero + 3.0;
    }
    found
}

/// The first `count` positive zeros of `J_m'`, ascending; `x = 0` is not counted for `m = 0`.
pub fn zeros_prime(m: u32, count: u32) -> Vec<f64> {
    if m == 0 {
        // J_0' = -J_1.
        return zeros(1, count);
    }
    // J_m rises from 0 to its first extremum, which lies beyond x = m (Watson, 15.3).
    let mut left = 0.5 * f64::from(m);
    let slope = |x| j_prime(m, x);
    let extremum = |right| {
        let found = roots::find(slope, left, right, TOLERANCE).unwrap_or(right);
        left = right;
        found
    };
    zeros(m, count).into_iter().map(extremum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_agree_with_a_trusted_source_to_1e_12() {
        let cases = [
            (0, 1, 2.404_825_557_695_773),
            (0, 10, 30.634_606_468_431_976),
            (1, 1, 3.831_705_970_207_512_5),
            (5, 3, 15.700_174_079_711_67),
            (150, 1, 160.054_579_592_430_37),
            (150, 60, 394.449_642_046_536_04),
            (70, 20, 156.019_356_705_203_3),
        ];
        for (m, n, value) in cases {
            assert!((zero(m, n) - value).abs() < 1e-12, "j_{m},{n} = {}", zero(m, n));
        }
    }

    #[test]
    fn zeros_of_the_derivative_agree_with_a_trusted_source_to_1e_12() {
        let cases = [
            (0, 1, 3.831_705_970_207_512_5),
            (1, 1, 1.841_183_781_340_659_3),
            (2, 1, 3.054_236_928_227_140_4),
            (5, 3, 13.987_188_630_140_3),
            (150, 1, 154.309_721_991_912_43),
            (150, 60, 392.748_887_294_912_15),
        ];
        for (m, n, value) in cases {
            let found = zero_prime(m, n);
            assert!((found - value).abs() < 1e-12, "j'_{m},{n} = {found}");
        }
    }

    #[test]
    fn zeros_of_neighbouring_orders_interlace_so_none_is_missed() {
        for m in 0..150 {
            let (here, next) = (zeros(m, 60), zeros(m + 1, 60));
            for n in 0..59 {
                assert!(here[n] < next[n] && next[n] < here[n + 1], "order {m}, zero {n}");
            }
        }
    }
}
