//! The offline scheme to test against: modes to rounding, the stretching by an iterated discrete
//! gradient, all in `f64`, at four times the rate.
//!
//! `U` is a polynomial of degree four, so the mean of its gradient along the straight way from one
//! state to the next, by Gauss's rule of two points, is a discrete gradient: its work is the
//! change of `U` to rounding.

use super::oracle::Oracle;

/// `P_k = q H_k q` and `l_k = B_k q` as dense tables over all amplitudes, and `c_k`.
pub struct Dense {
    quadratic: Vec<Vec<Vec<f64>>>,
    linear: Vec<Vec<f64>>,
    stiffness: Vec<f64>,
}

impl Dense {
    /// Read off a direct evaluation; for few modes.
    pub fn new(oracle: &Oracle) -> Dense {
        let count = oracle.orders.len();
        let unit = |i: usize, size: f64| {
            let mut q = vec![[0.0; 2]; count];
            q[i / 2][i % 2] += size;
            q
        };
        let n = 2 * count;
        let (stiffness, _, _) = oracle.projections(&unit(0, 0.0));
        let airys = stiffness.len();
        let mut quadratic = vec![vec![vec![0.0; n]; n]; airys];
        let mut linear = vec![vec![0.0; n]; airys];
        let single: Vec<Vec<f64>> = (0..n).map(|i| oracle.projections(&unit(i, 1.0)).1).collect();
        for i in 0..n {
            let bent = oracle.projections(&unit(i, 1.0)).2;
            for k in 0..airys {
                linear[k][i] = bent[k];
                quadratic[k][i][i] = single[i][k];
            }
            for j in 0..i {
                let mut q = unit(i, 1.0);
                q[j / 2][j % 2] += 1.0;
                let both = oracle.projections(&q).1;
                for k in 0..airys {
                    let half = 0.5 * (both[k] - single[i][k] - single[j][k]);
                    quadratic[k][i][j] = half;
                    quadratic[k][j][i] = half;
                }
            }
        }
        Dense { quadratic, linear, stiffness }
    }

    /// `U` (J) and its gradient (N) at displacements `q`, m.
    pub fn evaluate(&self, q: &[f64]) -> (f64, Vec<f64>) {
        let (mut energy, mut gradient) = (0.0, vec![0.0; q.len()]);
        let dot = |row: &[f64]| row.iter().zip(q).map(|(a, b)| a * b).sum::<f64>();
        for ((table, row), c) in self.quadratic.iter().zip(&self.linear).zip(&self.stiffness) {
            let half: Vec<f64> = table.iter().map(|row| dot(row)).collect();
            let (p, l) = (dot(&half), dot(row));
            energy += c * p * (p + 2.0 * l);
            for ((g, half), b) in gradient.iter_mut().zip(half).zip(row) {
                *g += 4.0 * c * (p + l) * half + 2.0 * c * p * b;
            }
        }
        (energy, gradient)
    }
}

/// Undamped modes of one mass, their displacements and velocities.
pub struct Modes {
    /// rad/s; a mode of 0 does not move.
    pub omega: Vec<f64>,
    /// kg.
    pub mass: f64,
    /// m.
    pub q: Vec<f64>,
    /// m/s.
    pub v: Vec<f64>,
}

impl Modes {
    /// Energy of the modes and the stretching, J.
    pub fn energy(&self, dense: &Dense) -> f64 {
        let modes = self.omega.iter().zip(&self.q).zip(&self.v);
        let own: f64 = modes.map(|((w, q), v)| 0.5 * self.mass * (v * v + w * w * q * q)).sum();
        own + dense.evaluate(&self.q).0
    }

    /// One sample of `dt` s.
    pub fn step(&mut self, dense: &Dense, dt: f64) {
        let n = self.q.len();
        let mut next = self.q.clone();
        let mut force = vec![0.0; n];
        for _ in 0..50 {
            let at = |share: f64| -> Vec<f64> {
                self.q.iter().zip(&next).map(|(a, b)| a + share * (b - a)).collect()
            };
            let apart = 0.5 / 3.0_f64.sqrt();
            let (_, one) = dense.evaluate(&at(0.5 - apart));
            let (_, two) = dense.evaluate(&at(0.5 + apart));
            let mut moved = 0.0_f64;
            for k in 0..n {
                let w = self.omega[k];
                if w == 0.0 {
                    continue;
                }
                force[k] = -0.5 * (one[k] + two[k]);
                let (sin, cos) = (w * dt).sin_cos();
                let held = force[k] / (self.mass * w * w);
                let q = held + (self.q[k] - held) * cos + self.v[k] / w * sin;
                moved = moved.max((q - next[k]).abs());
                next[k] = q;
            }
            if moved < 1e-17 {
                break;
            }
        }
        for (k, force) in force.into_iter().enumerate() {
            let w = self.omega[k];
            if w > 0.0 {
                let (sin, cos) = (w * dt).sin_cos();
                let held = force / (self.mass * w * w);
                self.v[k] = self.v[k] * cos - w * (self.q[k] - held) * sin;
            }
        }
        self.q = next;
    }
}
