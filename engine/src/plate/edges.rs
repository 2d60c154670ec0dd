//! Modes of circular plates by the condition at the rim: free, as a cymbal's, and clamped, as the
//! Airy functions of its stretching.
//!
//! Model: with `w = W(r) cos(m theta)` on the unit disc, a free rim has no bending moment and no
//! Kirchhoff shear,
//!
//! ```text
//! W'' + nu (W' - m^2 W) = 0
//! (lap W)' - (1 - nu) m^2 (W' - W) = 0
//! ```
//!
//! and a clamped one `W = W' = 0`. Each pair leaves one equation for the wave number, written with
//! the logarithmic derivative of `I_m` so that it stays of the size of `J_m` at any argument.
//!
//! Source: Leissa, Vibration of Plates (NASA SP-160), 2.1; von Karman's Airy functions as clamped
//! modes: Touze, Thomas, Chaigne, J. Sound Vib. 258, 2002.
//!
//! Limits: rigid motions (`m` 0 and 1, no circle) are not modes of the plate and are left out, so
//! circles of a free plate count from 1 there.

use super::radial::RadialMode;
use crate::math::{bessel, roots};

/// Relative accuracy of a wave number.
const TOLERANCE: f64 = 1e-15;

/// Neighbouring wave numbers of one order are further apart than this. *Converged*: the closest are
/// 3.06 apart (clamped, `m = 0`); they approach pi.
const LEAST_SPACING: f64 = 2.0;

/// Modes of one order of a free plate with wave numbers (dimensionless: times the radius) up to `limit`, ascending.
pub fn free_modes(m: u32, poisson_ratio: f64, limit: f64) -> Vec<RadialMode> {
    let edge = FreeEdge { m, poisson_ratio };
    let first_circle = if m < 2 { 1 } else { 0 };
    let found = scan(m, limit, |k| edge.condition(k));
    let mode = |(n, k)| RadialMode::new(m, n, k, edge.balance(k));
    (first_circle..).zip(found).map(mode).collect()
}

/// Modes of one order of a clamped plate with wave numbers (dimensionless: times the radius) up to `limit`, ascending.
pub fn clamped_modes(m: u32, limit: f64) -> Vec<RadialMode> {
    let condition = |k| {
        let (value, slope) = bessel::j_pair(m, k);
        k * slope - bessel::i_log_derivative(m, k) * value
    };
    let mode = |(n, k)| RadialMode::new(m, n, k, -bessel::j(m, k));
    (0..).zip(scan(m, limit, condition)).map(mode).collect()
}

/// Roots of an edge condition of order `m` up to `limit`.
///
/// The lowest free mode of a high order is a wave along the edge, a little slower than one in the
/// plate: its wave number may fall just below `m`, to `0.9985 m` for bronze (Konenkov, 1960).
fn scan(m: u32, limit: f64, condition: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut left = (0.8 * f64::from(m)).max(1.5);
    while left < limit {
        let right = left + 1.0;
        match roots::find(&condition, left, right, TOLERANCE) {
            Some(root) => {
                found.push(root);
                left = root + LEAST_SPACING;
            }
            None => left = right,
        }
    }
    found.retain(|&root| root <= limit);
    found
}

/// A free rim and what it asks of the two parts of order `m`.
struct FreeEdge {
    m: u32,
    poisson_ratio: f64,
}

impl FreeEdge {
    /// Moment and shear of a part with the rim value and slope given; `sign` is that of its
    /// laplacian, -1 for `J_m(k r)` and +1 for `I_m(k r)`.
    fn moment_and_shear(&self, k: f64, sign: f64, value: f64, slope: f64) -> (f64, f64) {
        let m2 = f64::from(self.m * self.m);
        let rest = 1.0 - self.poisson_ratio;
        let laplacian = sign * k * k;
        let moment = laplacian * value - rest * (slope - m2 * value);
        let shear = laplacian * slope - rest * m2 * (slope - value);
        (moment, shear)
    }

    /// Determinant of the two conditions over `I_m(k)`.
    fn condition(&self, k: f64) -> f64 {
        let (value, slope) = bessel::j_pair(self.m, k);
        let log_derivative = bessel::i_log_derivative(self.m, k);
        let (bessel_moment, bessel_shear) = self.moment_and_shear(k, -1.0, value, k * slope);
        let (moment, shear) = self.moment_and_shear(k, 1.0, 1.0, log_derivative);
        bessel_moment * shear - moment * bessel_shear
    }

    /// Rim value of the modified part, for a Bessel part of `J_m(k r)`, that cancels the moment.
    fn balance(&self, k: f64) -> f64 {
        let (value, slope) = bessel::j_pair(self.m, k);
        let log_derivative = bessel::i_log_derivative(self.m, k);
        let (bessel_moment, _) = self.moment_and_shear(k, -1.0, value, k * slope);
        let (moment, _) = self.moment_and_shear(k, 1.0, 1.0, log_derivative);
        -bessel_moment / moment
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free(m: u32, n: u32) -> f64 {
        let modes = free_modes(m, 0.33, 30.0);
        let mode = modes.iter().find(|mode| mode.n == n).unwrap();
        mode.root * mode.root
    }

    #[test]
    fn free_plate_wave_numbers_are_those_of_the_literature() {
        let cases = [
            (2, 0, 5.2620),
            (0, 1, 9.0689),
            (3, 0, 12.2439),
            (1, 1, 20.5131),
            (4, 0, 21.5272),
            (5, 0, 33.0618),
            (2, 1, 35.2425),
            (0, 2, 38.5070),
            (6, 0, 46.8087),
            (3, 1, 52.9210),
            (1, 2, 59.8591),
            (10, 0, 123.4428),
            (10, 4, 699.7988),
        ];
        for (m, n, want) in cases {
            let got = free(m, n);
            assert!((got / want - 1.0).abs() < 1e-5, "({m}, {n}): {got} for {want}");
        }
    }

    #[test]
    fn clamped_plate_wave_numbers_are_those_of_the_literature() {
        // Leissa, table 2.1.
        let cases = [(0, 0, 10.2158), (1, 0, 21.26), (2, 0, 34.88), (0, 1, 39.771), (3, 2, 190.30)];
        for (m, n, want) in cases {
            let got = clamped_modes(m, 30.0)[n].root.powi(2);
            assert!((got / want - 1.0).abs() < 5e-4, "({m}, {n}): {got} for {want}");
        }
    }

    #[test]
    fn no_root_is_missed_however_finely_one_looks() {
        let limit = 80.0;
        for m in (0..82).step_by(3) {
            let edge = FreeEdge { m, poisson_ratio: 0.34 };
            let steps = 1.0 / 64.0;
            let start = 0.5 * f64::from(m) + 0.5;
            let signs = |condition: &dyn Fn(f64) -> f64| {
                let places = (0..).map(|i| start + steps * f64::from(i));
                let places: Vec<f64> = places.take_while(|&k| k < limit).collect();
                let change = |pair: &&[f64]| condition(pair[0]) * condition(pair[1]) < 0.0;
                places.windows(2).filter(change).count()
            };
            let free = free_modes(m, 0.34, limit - steps);
            assert_eq!(free.len(), signs(&|k| edge.condition(k)), "free, m {m}");
            let clamped = clamped_modes(m, limit - steps);
            let condition = |k| {
                let (value, slope) = bessel::j_pair(m, k);
                k * slope - bessel::i_log_derivative(m, k) * value
            };
            assert_eq!(clamped.len(), signs(&condition), "clamped, m {m}");
        }
    }

    #[test]
    fn neighbouring_roots_keep_the_spacing_the_scan_relies_on() {
        for m in 0..100 {
            for modes in [free_modes(m, 0.34, 110.0), clamped_modes(m, 110.0)] {
                for pair in modes.windows(2) {
                    assert!(pair[1].root - pair[0].root > LEAST_SPACING + 1.0, "{pair:?}");
                }
            }
        }
    }

    #[test]
    fn the_count_of_modes_follows_weyls_law_within_a_few() {
        // N(k) = k^2 / 4 + BETA k / 2 on the unit disc, rigid motions counted. *Derived* from the
        // phase a free edge reflects with, nu = 0.34, as in Bogomolny & Hugues, Phys. Rev. E 57,
        // 1998, who have 1.7126 for nu = 0.33.
        const BETA: f64 = 1.7208;
        const RIGID: f64 = 3.0;
        for limit in [30.0, 40.0, 50.0, 60.0, 70.0, 80.0] {
            let members = |m| if m == 0 { 1.0 } else { 2.0 };
            let count = |m| members(m) * free_modes(m, 0.34, limit).len() as f64;
            let total: f64 = RIGID + (0..=85).map(count).sum::<f64>();
            let weyl = 0.25 * limit * limit + 0.5 * BETA * limit;
            assert!((total - weyl).abs() < 6.0, "k {limit}: {total} modes, {weyl} by Weyl");
        }
    }

    #[test]
    fn the_rim_of_a_free_plate_has_no_moment_and_no_shear() {
        for m in [0, 1, 2, 10, 60] {
            let edge = FreeEdge { m, poisson_ratio: 0.34 };
            for mode in free_modes(m, 0.34, 80.0) {
                let RadialMode { root: k, bessel: j, modified: i, .. } = mode;
                let (moment, shear) = edge.moment_and_shear(k, -1.0, j.value, j.slope);
                let (other_moment, other_shear) = edge.moment_and_shear(k, 1.0, i.value, i.slope);
                assert!((moment + other_moment).abs() < 1e-10 * k * k, "{mode:?}");
                assert!((shear + other_shear).abs() < 1e-10 * k * k * k, "{mode:?}");
            }
        }
    }
}
