//! Radial function of a circular plate's mode, `W(r) = N [J_m(k r) + C I_m(k r)]`, `0 <= r <= 1`.
//!
//! Model: an eigenfunction of the biharmonic operator on the unit disc, `grad^4 W = k^4 W`,
//! whatever the condition at its rim (see `edges`). Times `cos(m theta)` or `sin(m theta)` its mean
//! square over the disc is one, so `int W^2 r dr` is 1/2 for `m = 0`, else 1.
//!
//! Everything is held as values and slopes at the rim, where both parts are of the order of one:
//! the modified part inside is its rim value times `I_m(k r) / I_m(k)`, which cannot overflow.
//! Norms and overlaps follow from Green's identity at the rim; nothing is
//! integrated numerically.
//!
//! Source: Leissa, Vibration of Plates (NASA SP-160), ch. 2; Abramowitz & Stegun, 11.3.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::math::bessel::{self, ITable, JTable};

/// Value and slope at the rim of one part of a radial function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rim {
    /// Value at `r = 1`, dimensionless.
    pub value: f64,
    /// Derivative with respect to `r` at `r = 1`, dimensionless.
    pub slope: f64,
}

/// Radial function of unit mean square.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RadialMode {
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles inside the rim.
    pub n: u32,
    /// Wave number times radius, `k`.
    pub root: f64,
    /// The factor `N` of the Bessel part.
    pub gain: f64,
    /// The Bessel part, `N J_m(k r)`.
    pub bessel: Rim,
    /// The modified part, `N C I_m(k r)`.
    pub modified: Rim,
}

/// Integral of the angular part squared over the circle: 2 pi for `m = 0`, else pi.
pub fn angular_norm(m: u32) -> f64 {
    if m == 0 { 2.0 * PI } else { PI }
}

impl RadialMode {
    /// The function with `N C I_m(k) = balance * N`, `balance` being the modified part at the rim
    /// for `N = 1`; scaled to unit mean square.
    pub fn new(m: u32, n: u32, root: f64, balance: f64) -> RadialMode {
        let (value, slope) = bessel::j_pair(m, root);
        let log_derivative = bessel::i_log_derivative(m, root);
        let raw = RadialMode {
            m,
            n,
            root,
            gain: 1.0,
            bessel: Rim { value, slope: root * slope },
            modified: Rim { value: balance, slope: balance * log_derivative },
        };
        let norm = (angular_norm(m) / PI * raw.radial_square()).sqrt().recip();
        let scale = |rim: Rim| Rim { value: norm * rim.value, slope: norm * rim.slope };
        RadialMode { gain: norm, bessel: scale(raw.bessel), modified: scale(raw.modified), ..raw }
    }

    /// `int_0^1 W^2 r dr`, closed.
    fn radial_square(&self) -> f64 {
        let RadialMode { bessel: j, modified: i, .. } = *self;
        let (k2, m2) = (self.root * self.root, f64::from(self.m * self.m));
        let both_bessel = j.slope * j.slope + (k2 - m2) * j.value * j.value;
        let both_modified = (k2 + m2) * i.value * i.value - i.slope * i.slope;
        let mixed = 2.0 * (j.value * i.slope - j.slope * i.value);
        (both_bessel + both_modified + mixed) / (2.0 * k2)
    }

    /// `W(r)`, to rounding.
    pub fn value(&self, r: f64) -> f64 {
        let (bessel, modified) = self.parts(r);
        bessel + modified
    }

    /// Laplacian of `W(r) cos(m theta)` over `cos(m theta)`, for the unit radius.
    pub fn laplacian(&self, r: f64) -> f64 {
        let (bessel, modified) = self.parts(r);
        self.root * self.root * (modified - bessel)
    }

    /// The Bessel and the modified part at `r`.
    fn parts(&self, r: f64) -> (f64, f64) {
        let RadialMode { m, root, .. } = *self;
        let inside = bessel::i_scaled(m, root * r) / bessel::i_scaled(m, root);
        let decay = (root * (r - 1.0)).exp();
        (self.gain * bessel::j(m, root * r), self.modified.value * inside * decay)
    }

    /// Fills `out` with `W` at `radii` from tables of this order; within about 1e-7.
    pub fn sample(&self, j: &JTable, i: &ITable, radii: &[f64], out: &mut [f64]) {
        let inner = self.modified.value / i.value(self.root);
        for (out, &r) in out.iter_mut().zip(radii) {
            let x = self.root * r;
            *out = self.gain * j.value(x) + inner * i.value(x) * (x - self.root).exp();
        }
    }

    /// Laplacian at the rim and its slope.
    pub fn rim_laplacian(&self) -> Rim {
        let RadialMode { bessel: j, modified: i, .. } = *self;
        let k2 = self.root * self.root;
        Rim { value: k2 * (i.value - j.value), slope: k2 * (i.slope - j.slope) }
    }

    /// Inner product with the harmonic function `r^m cos(m theta)` of unit mean square.
    ///
    /// Zero for a free plate's `m` 0 and 1, where that function is a rigid motion.
    pub fn harmonic_overlap(&self) -> f64 {
        let m = f64::from(self.m);
        let rim = self.rim_laplacian();
        // k^4 int r^m W r dr, by Green's second identity.
        let integral = (rim.slope - m * rim.value) / self.root.powi(4);
        ((2.0 * m + 2.0) * angular_norm(self.m) / PI).sqrt() * integral
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;
    use crate::plate::edges::{clamped_modes, free_modes};

    /// Free and clamped modes over the whole range of orders and wave numbers.
    fn modes() -> impl Iterator<Item = RadialMode> {
        [0, 1, 2, 5, 17, 40, 66]
            .into_iter()
            .flat_map(|m| [free_modes(m, 0.34, 80.0), clamped_modes(m, 80.0)].concat())
    }

    #[test]
    fn modes_of_an_order_are_orthonormal_over_the_disc() {
        let rule = GaussLegendre::unit(160);
        for m in [0, 1, 2, 5, 17, 40, 66] {
            for modes in [free_modes(m, 0.34, 80.0), clamped_modes(m, 80.0)] {
                let sampled: Vec<Vec<f64>> =
                    modes.iter().map(|mode| rule.nodes.iter().map(|&r| mode.value(r)).collect()).collect();
                for (p, a) in sampled.iter().enumerate() {
                    for (q, b) in sampled.iter().enumerate() {
                        let terms = a.iter().zip(b).zip(&rule.nodes).zip(&rule.weights);
                        let sum: f64 = terms.map(|(((a, b), r), w)| a * b * r * w).sum();
                        let mean = angular_norm(m) / PI * sum;
                        let want = if p == q { 1.0 } else { 0.0 };
                        assert!((mean - want).abs() < 1e-10, "m {m}, {p} and {q}: {mean}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_harmonic_overlap_is_the_integral() {
        let rule = GaussLegendre::unit(200);
        for mode in modes().step_by(3) {
            let m = mode.m as i32;
            let scale = angular_norm(mode.m) / PI;
            let unit = ((2.0 * f64::from(m) + 2.0) / scale).sqrt();
            let want = scale * unit * rule.integrate(|r| mode.value(r) * r.powi(m + 1));
            let got = mode.harmonic_overlap();
            assert!((got - want).abs() < 1e-10, "{mode:?}: {got} for {want}");
        }
    }

    #[test]
    fn sampling_from_tables_is_within_1e_7() {
        let (j, i) = (JTable::orders(66, 80.0), ITable::orders(66, 80.0));
        let radii: Vec<f64> = (0..=40).map(|i| f64::from(i) / 40.0).collect();
        let mut got = vec![0.0; radii.len()];
        for mode in modes() {
            let m = mode.m as usize;
            mode.sample(&j[m], &i[m], &radii, &mut got);
            for (&r, got) in radii.iter().zip(&got) {
                let want = mode.value(r);
                assert!((got - want).abs() < 1e-7, "{mode:?} at {r}: {got} for {want}");
            }
        }
    }
}
