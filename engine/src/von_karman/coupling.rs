//! What the bracket of two displacements is made of, mode by mode, along the radius.
//!
//! In polar coordinates, with
//!
//! ```text
//! A = w_rr,   B = w_r / r + w_tt / r^2,   D = d/dr (w_t / r)
//! L(w, w) = 2 (A B - D^2)
//! ```
//!
//! A shell mode `R(r) cos(m t)` has `A = R'' cos`, `B = (R'/r - m^2 R/r^2) cos` and
//! `D = -m (R'/r - R/r^2) sin`; `D` of its twin `R sin(m t)` is `+m (...) cos`.

use crate::plate::{PlateModes, PlateTables, ShellMode};

/// Radial parts of `A`, `B` and `D` of one shell mode on a grid, for the unit radius.
pub struct Curvatures {
    /// `R''`, `r` being a share of the radius.
    pub radial: Vec<f64>,
    /// `R'/r - m^2 R / r^2`.
    pub around: Vec<f64>,
    /// `m (R'/r - R / r^2)`.
    pub twist: Vec<f64>,
}

impl Curvatures {
    /// Of a shell mode at `radii` (shares of the radius), all above 0.
    ///
    /// # Panics
    /// If the tables do not reach the order.
    pub fn new(plate: &PlateModes, tables: &PlateTables, shell: &ShellMode, radii: &[f64]) -> Curvatures {
        let (j, i) = (&tables.j[shell.m as usize], &tables.i[shell.m as usize]);
        let m = f64::from(shell.m);
        let (mut radial, mut around, mut twist) = (Vec::new(), Vec::new(), Vec::new());
        for &r in radii {
            let (mut value, mut slope, mut laplacian) = (0.0, 0.0, 0.0);
            for (flat, share) in plate.flat_of(shell).iter().zip(&shell.expansion) {
                let (k, x) = (flat.root, flat.root * r);
                let (j_value, j_slope) = j.pair(x);
                let (i_value, i_slope) = i.pair(x);
                let inner = share * flat.modified.value / i.value(k) * (x - k).exp();
                let outer = share * flat.gain;
                value += outer * j_value + inner * i_value;
                slope += k * (outer * j_slope + inner * i_slope);
                laplacian += k * k * (inner * i_value - outer * j_value);
            }
            let bent_around = slope / r - m * m * value / (r * r);
            around.push(bent_around);
            radial.push(laplacian - bent_around);
            twist.push(m * (slope / r - value / (r * r)));
        }
        Curvatures { radial, around, twist }
    }
}
