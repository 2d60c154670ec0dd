//! How much a drum's body gets in the way of its own sound.
//!
//! Model: the body as a rigid sphere of the head's radius, a source on it. Far below `ka = 1` a small source
//! radiates into all of space, as if the body were not there: half of what it would in a baffle.
//! Far above, the body is the baffle. Between, the power over that of a free source is
//!
//! ```text
//! B = sum_n (2 n + 1) / ((ka)^4 |h_n'(ka)|^2)
//! ```
//!
//! Source: Morse & Ingard, Theoretical Acoustics, sec. 7.2 (point source on a sphere).

/// Power of a source on the body over that of the same source in free air, 1 to 2, at `ka`.
pub fn baffling(ka: f64) -> f64 {
    let x = ka.clamp(1e-3, 60.0);
    let terms = x as usize + 12;
    // Spherical Bessel functions: y upward, j downward (Miller), each in its stable direction.
    let mut y = vec![-x.cos() / x, -x.cos() / (x * x) - x.sin() / x];
    for n in 1..=terms {
        y.push((2 * n + 1) as f64 / x * y[n] - y[n - 1]);
    }
    let mut j = vec![0.0; terms + 22];
    let last = j.len() - 1;
    j[last - 1] = 1e-30;
    for n in (1..last).rev() {
        j[n - 1] = (2 * n + 1) as f64 / x * j[n] - j[n + 1];
        if j[n - 1].abs() > 1e100 {
            j.iter_mut().for_each(|value| *value *= 1e-100);
        }
    }
    // The sum (2 n + 1) j_n^2 is 1.
    let norm = j.iter().enumerate().map(|(n, value)| (2 * n + 1) as f64 * value * value).sum::<f64>().sqrt();
    let slope = |f: &[f64], n: usize| if n == 0 { -f[1] } else { f[n - 1] - (n + 1) as f64 / x * f[n] };
    (0..terms)
        .map(|n| {
            let size = (slope(&j, n) / norm).powi(2) + slope(&y, n).powi(2);
            (2 * n + 1) as f64 / (x.powi(4) * size)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_body_is_not_there_and_a_large_one_is_a_baffle() {
        assert!((baffling(0.01) - 1.0).abs() < 1e-3);
        assert!((baffling(40.0) - 2.0).abs() < 0.05, "{}", baffling(40.0));
        // In between it rises.
        let values: Vec<f64> = [0.5, 1.0, 2.0, 4.0].map(baffling).to_vec();
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{values:?}");
    }
}
