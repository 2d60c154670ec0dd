//! Bracketed root finding.
//!
//! Inverse quadratic interpolation where it can be trusted, bisection elsewhere: as quick as
//! Brent's method, and shorter.
//!
//! Source: Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a
//! nonlinear function without using derivatives, Adv. Eng. Software 28, 1997.

/// Most evaluations spent on one root; bisection alone would need 64 for a full `f64` interval.
const MAX_ITERATIONS: u32 = 128;

/// A root of `f` between `a` and `b`, to a relative `tolerance`; `None` without a change of sign.
pub fn find(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Option<f64> {
    // a is the latest point, b the end of the bracket across the root, c the end it replaced.
    let (mut b, mut at_b) = (b, f(b));
    let (mut a, mut at_a) = (a, f(a));
    if at_a == 0.0 {
        return Some(a);
    }
    if at_b == 0.0 {
        return Some(b);
    }
    if at_a.is_nan() || at_b.is_nan() || at_a.signum() == at_b.signum() {
        return None;
    }
    let mut share = 0.5;
    for _ in 0..MAX_ITERATIONS {
        let x = a + share * (b - a);
        let at_x = f(x);
        let (c, at_c) = if (at_x > 0.0) == (at_a > 0.0) {
            (a, at_a)
        } else {
            let old = (b, at_b);
            (b, at_b) = (a, at_a);
            old
        };
        (a, at_a) = (x, at_x);
        let best = if at_a.abs() < at_b.abs() { a } else { b };
        let limit = (2.0 * f64::EPSILON * best.abs()).max(tolerance * best.abs()) / (b - a).abs();
        if limit > 0.5 || at_a == 0.0 || at_b == 0.0 {
            return Some(best);
        }
        share = next_share([a, b, c], [at_a, at_b, at_c]).clamp(limit, 1.0 - limit);
    }
    Some(a)
}

/// Where between `a` (0) and `b` (1) to look next.
fn next_share([a, b, c]: [f64; 3], [at_a, at_b, at_c]: [f64; 3]) -> f64 {
    let position = (a - b) / (c - b);
    let height = (at_a - at_b) / (at_c - at_b);
    // Chandrupatla's condition that the inverse parabola is monotone over the bracket.
    if height * height < position && (1.0 - height).powi(2) < 1.0 - position {
        at_a / (at_b - at_a) * at_c / (at_b - at_c)
            + (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
    } else {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_rounding_in_few_evaluations() {
        let mut evaluations = 0;
        let mut f = |x: f64| {
            evaluations += 1;
            x.cos() - x
        };
        let root = find(&mut f, 0.0, 1.0, 1e-15).unwrap();
        assert!((root - 0.739_085_133_215_160_6).abs() < 1e-15);
        assert!(evaluations < 12, "{evaluations}");
    }

    #[test]
    fn a_flat_root_is_still_found_in_bounded_time() {
        let root = find(|x: f64| (x - 0.3).powi(9), 0.0, 1.0, 1e-15).unwrap();
        assert!((root - 0.3).abs() < 1e-3);
    }

    #[test]
    fn no_change_of_sign_is_no_root() {
        assert_eq!(find(|x| x * x + 1.0, -1.0, 1.0, 1e-15), None);
        assert_eq!(find(|_| f64::NAN, -1.0, 1.0, 1e-15), None);
    }

    #[test]
    fn a_root_at_an_end_is_a_root() {
        assert_eq!(find(|x| x, 0.0, 1.0, 1e-15), Some(0.0));
        assert_eq!(find(|x| x - 1.0, 0.0, 1.0, 1e-15), Some(1.0));
    }
}
