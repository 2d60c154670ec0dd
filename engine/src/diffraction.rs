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
//! and the amplitude at an angle from the source, far away, over that of a free source
//!
//! ```text
//! | sum_n (2 n + 1) (-i)^n P_n(cos) / ((ka)^2 h_n'(ka)) |
//! ```
//!
//! Source: Morse & Ingard, Theoretical Acoustics, sec. 7.2 (point source on a sphere).

/// What surrounds the drum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outside {
    /// The struck head lies in a baffle: a kettle, or a head on its own.
    Baffle,
    /// The drum stands free.
    Free {
        /// Length of the shell, m.
        length: f64,
    },
}

/// Power of a source on the body over that of the same source in free air, 1 to 2, at `ka`.
pub fn baffling(ka: f64) -> f64 {
    let slopes = Slopes::new(ka);
    let terms = slopes.h.iter().enumerate();
    terms.map(|(n, [j, y])| (2 * n + 1) as f64 / (slopes.x.powi(4) * (j * j + y * y))).sum()
}

/// Amplitude of a source at a point near the body, over that of the same source in a baffle; `fills` is how much
/// of the half-space the body's face fills, seen from there.
pub fn near_gain(ka: f64, fills: f64) -> f64 {
    let space = 0.5 * baffling(ka);
    space + (1.0 - space) * fills
}

/// Amplitude far away, seen from the body's centre at an angle of that cosine from the source, at `ka`: its ratio to
/// that of the same source in free air.
pub fn toward(ka: f64, cos: f64) -> f64 {
    let slopes = Slopes::new(ka);
    let (mut re, mut im) = (0.0, 0.0);
    let (mut before, mut legendre) = (0.0, 1.0);
    for (n, [j, y]) in slopes.h.iter().enumerate() {
        let size = (2 * n + 1) as f64 * legendre / (slopes.x.powi(2) * (j * j + y * y));
        // (-i)^n (j - i y)
        let (a, b) = match n % 4 {
            0 => (*j, -y),
            1 => (-y, -j),
            2 => (-j, *y),
            _ => (*y, *j),
        };
        (re, im) = (re + size * a, im + size * b);
        let n = n as f64;
        (before, legendre) = (legendre, ((2.0 * n + 1.0) * cos * legendre - n * before) / (n + 1.0));
    }
    re.hypot(im)
}

/// Slopes of the spherical Bessel functions at one argument.
struct Slopes {
    x: f64,
    /// `j_n'`, `y_n'`, as many as count.
    h: Vec<[f64; 2]>,
}

impl Slopes {
    fn new(ka: f64) -> Slopes {
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
        // The sum (2 n + 1) j_n^2 is 1; j_0 or j_1 has a known sign.
        let norm =
            j.iter().enumerate().map(|(n, value)| (2 * n + 1) as f64 * value * value).sum::<f64>().sqrt();
        let j_1 = x.sin() / (x * x) - x.cos() / x;
        let sign = if (x.sin() / x).abs() > j_1.abs() { x.sin() * j[0] } else { j_1 * j[1] }.signum();
        let slope = |f: &[f64], n: usize| if n == 0 { -f[1] } else { f[n - 1] - (n + 1) as f64 / x * f[n] };
        Slopes { x, h: (0..terms).map(|n| [sign * slope(&j, n) / norm, slope(&y, n)]).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_in_all_directions_is_the_power() {
        for ka in [0.3, 2.0, 9.0] {
            let steps = 2000;
            let mean = (0..steps)
                .map(|i| toward(ka, -1.0 + (2 * i + 1) as f64 / f64::from(steps)).powi(2) / f64::from(steps))
                .sum::<f64>();
            assert!((mean / baffling(ka) - 1.0).abs() < 1e-3, "{ka}: {mean} {}", baffling(ka));
        }
        // A large body doubles the pressure before it and keeps it from behind.
        assert!((toward(30.0, 0.9) - 2.0).abs() < 0.1);
        assert!(toward(30.0, -0.8) < 0.3);
    }

    #[test]
    fn a_small_body_is_not_there_and_a_large_one_is_a_baffle() {
        assert!((baffling(0.01) - 1.0).abs() < 1e-3);
        assert!((baffling(40.0) - 2.0).abs() < 0.05, "{}", baffling(40.0));
        // In between it rises.
        let values: Vec<f64> = [0.5, 1.0, 2.0, 4.0].map(baffling).to_vec();
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{values:?}");
    }
}
