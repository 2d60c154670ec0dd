//! A displacement and its curvatures along the radius.
//!
//! In polar coordinates, with
//!
//! ```text
//! A = w_rr,   B = w_r / r + w_tt / r^2,   D = d/dr (w_t / r)
//! L(w, w) = 2 (A B - D^2)
//! ```
//!
//! `R(r) cos(m t)` has `A = R'' cos`, `B = (R'/r - m^2 R/r^2) cos` and `D = -m (R'/r - R/r^2) sin`;
//! `D` of its twin `R sin(m t)` is `+m (...) cos`.

use super::radial::RadialMode;
use crate::math::bessel::{ITable, JTable};

/// Radial parts of a displacement and of its `A`, `B` and `D` on a grid, for the unit radius.
#[derive(Debug, Clone, PartialEq)]
pub struct Bent {
    /// `R`.
    pub value: Vec<f64>,
    /// `R''`, `r` being a share of the radius.
    pub radial: Vec<f64>,
    /// `R'/r - m^2 R / r^2`.
    pub around: Vec<f64>,
    /// `m (R'/r - R / r^2)`.
    pub twist: Vec<f64>,
}

impl Bent {
    /// Nothing, at so many radii.
    pub fn zero(radii: usize) -> Bent {
        let zero = || vec![0.0; radii];
        Bent { value: zero(), radial: zero(), around: zero(), twist: zero() }
    }

    /// Of a plate's mode at `radii` (shares of the radius), all above 0, from tables of its order.
    pub fn of(mode: &RadialMode, (j, i): (&JTable, &ITable), radii: &[f64]) -> Bent {
        let (k, m) = (mode.root, f64::from(mode.m));
        let rim = mode.modified.value / i.value(k);
        let mut bent = Bent::zero(0);
        for &r in radii {
            let x = k * r;
            let ((j_value, j_slope), (i_value, i_slope)) = (j.pair(x), i.pair(x));
            let inner = rim * (x - k).exp();
            let value = mode.gain * j_value + inner * i_value;
            let slope = k * (mode.gain * j_slope + inner * i_slope);
            let laplacian = k * k * (inner * i_value - mode.gain * j_value);
            let around = slope / r - m * m * value / (r * r);
            bent.value.push(value);
            bent.around.push(around);
            bent.radial.push(laplacian - around);
            bent.twist.push(m * (slope / r - value / (r * r)));
        }
        bent
    }

    /// Adds a share of another.
    pub fn add(&mut self, share: f64, other: &Bent) {
        let parts = [
            (&mut self.value, &other.value),
            (&mut self.radial, &other.radial),
            (&mut self.around, &other.around),
            (&mut self.twist, &other.twist),
        ];
        for (sum, part) in parts {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += share * part);
        }
    }

    /// Laplacian at a place of the grid, for the unit radius, dimensionless per displacement.
    pub fn laplacian(&self, at: usize) -> f64 {
        self.radial[at] + self.around[at]
    }

    /// The bracket `L` with another of the same order and member at a place of the grid, in the mean around the circle over
    /// that of the angular part's square; for the unit radius, dimensionless per displacement squared.
    pub fn bracket(&self, other: &Bent, at: usize) -> f64 {
        self.radial[at] * other.around[at] + self.around[at] * other.radial[at]
            - 2.0 * self.twist[at] * other.twist[at]
    }
}
