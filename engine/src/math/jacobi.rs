//! Jacobi's polynomials.
//!
//! Source: Abramowitz & Stegun 22.7.1 (the recurrence).

/// Fills `out` with `P_i^(a, b)(t)`, `i` from 0, `t` in -1 to 1; dimensionless.
pub fn fill(a: f64, b: f64, t: f64, out: &mut [f64]) {
    let (mut before, mut now) = (0.0, 1.0);
    for (i, value) in out.iter_mut().enumerate() {
        *value = now;
        let n = i as f64;
        let s = 2.0 * n + a + b;
        let next = if i == 0 {
            0.5 * (a - b + (a + b + 2.0) * t)
        } else {
            let lead = 2.0 * (n + 1.0) * (n + a + b + 1.0) * s;
            let middle = (s + 1.0) * (a * a - b * b + s * (s + 2.0) * t);
            (middle * now - 2.0 * (n + a) * (n + b) * (s + 2.0) * before) / lead
        };
        (before, now) = (now, next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;

    #[test]
    fn with_both_parameters_zero_they_are_legendres() {
        let mut got = [0.0; 4];
        for t in [-1.0, -0.3, 0.0, 0.8] {
            fill(0.0, 0.0, t, &mut got);
            let want = [1.0, t, 0.5 * (3.0 * t * t - 1.0), 0.5 * t * (5.0 * t * t - 3.0)];
            assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-14), "{got:?}");
        }
    }

    #[test]
    fn they_are_orthogonal_by_their_weight() {
        let (a, b) = (4.0, 7.0);
        let rule = GaussLegendre::new(40, -1.0, 1.0);
        let mut at = [0.0; 12];
        for i in 0..12 {
            for j in 0..i {
                let product = |t: f64| {
                    fill(a, b, t, &mut at);
                    (1.0 - t).powf(a) * (1.0 + t).powf(b) * at[i] * at[j]
                };
                assert!(rule.integrate(product).abs() < 1e-9, "{i} and {j}");
            }
        }
    }
}
