//! The stretching energy by direct quadrature in `f64`, for tests: slow and plain.

use std::f64::consts::TAU;

use super::airy::AiryOrder;
use crate::math::quadrature::GaussLegendre;
use crate::plate::bent::Bent;
use crate::plate::{PlateModes, PlateTables};

/// Shell modes and Airy functions on a polar grid.
pub struct Oracle {
    /// Order of each shell mode.
    pub orders: Vec<u32>,
    curvatures: Vec<Bent>,
    airy: Vec<AiryOrder>,
    /// `[order][airy][r]`.
    airy_shapes: Vec<Vec<Vec<f64>>>,
    /// `[shell][airy of its order]`.
    bends: Vec<Vec<f64>>,
    radii: Vec<f64>,
    weights: Vec<f64>,
    angles: usize,
    scale: f64,
}

/// Parts of an energy.
pub struct Parts {
    /// `sum c (P^2 + 2 P l)`, J.
    pub energy: f64,
    /// `sum c l^2`, J.
    pub linear: f64,
    /// Gradient by the cosine and sine amplitude of each shell mode, N.
    pub gradient: Vec<[f64; 2]>,
}

impl Oracle {
    /// With `count` shell modes, Airy functions to `limit`, and a grid.
    pub fn new(
        plate: &PlateModes,
        tables: &PlateTables,
        count: usize,
        limit: f64,
        (rings, angles): (usize, usize),
    ) -> Oracle {
        let rule = GaussLegendre::unit(rings);
        let shells = &plate.shells[..count];
        let highest = shells.iter().map(|shell| shell.m).max().unwrap();
        // Products of two orders reach twice as far.
        let airy = AiryOrder::all(plate, tables, highest, limit);
        Oracle {
            orders: shells.iter().map(|shell| shell.m).collect(),
            curvatures: shells.iter().map(|s| plate.bent(tables, s, &rule.nodes)).collect(),
            airy_shapes: airy.iter().map(|order| order.shapes(tables, &rule.nodes)).collect(),
            bends: shells.iter().map(|s| airy[s.m as usize].curvature(plate, s)).collect(),
            airy,
            weights: rule.nodes.iter().zip(&rule.weights).map(|(r, w)| r * w * TAU / angles as f64).collect(),
            radii: rule.nodes,
            angles,
            scale: plate.spec.radius().powi(-2),
        }
    }

    /// `c_k`, `P_k` and `l_k` of every Airy function and member, in units whose `c P^2` is in J; displacements `q` in m.
    pub fn projections(&self, q: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let (mut stiffness, mut quadratic, mut linear) = (vec![], vec![], vec![]);
        let (n_r, n_t) = (self.radii.len(), self.angles);
        let fields = self.fields(q);
        for (m, order) in self.airy.iter().enumerate() {
            for (k, &c) in order.stiffness.iter().enumerate() {
                for member in 0..if m == 0 { 1 } else { 2 } {
                    let mut product = 0.0;
                    for t in 0..n_t {
                        let (sin, cos) = (m as f64 * TAU * (t as f64 + 0.5) / n_t as f64).sin_cos();
                        let around = if member == 0 { cos } else { sin };
                        for r in 0..n_r {
                            let [a, b, d] = fields[t * n_r + r];
                            product +=
                                self.weights[r] * self.airy_shapes[m][k][r] * around * 2.0 * (a * b - d * d);
                        }
                    }
                    let bent = |i: usize| if self.orders[i] as usize == m { self.bends[i][k] } else { 0.0 };
                    stiffness.push(c);
                    quadratic.push(product * self.scale);
                    linear.push((0..q.len()).map(|i| bent(i) * q[i][member]).sum());
                }
            }
        }
        (stiffness, quadratic, linear)
    }

    /// `A`, `B`, `D` on the grid, `[angle][r]`.
    fn fields(&self, q: &[[f64; 2]]) -> Vec<[f64; 3]> {
        let (n_r, n_t) = (self.radii.len(), self.angles);
        let mut fields = vec![[0.0_f64; 3]; n_r * n_t];
        for t in 0..n_t {
            let theta = TAU * (t as f64 + 0.5) / n_t as f64;
            for ((&[c, s], &m), shape) in q.iter().zip(&self.orders).zip(&self.curvatures) {
                let (sin, cos) = (f64::from(m) * theta).sin_cos();
                let (even, odd) = (c * cos + s * sin, s * cos - c * sin);
                for r in 0..n_r {
                    let field = &mut fields[t * n_r + r];
                    field[0] += even * shape.radial[r];
                    field[1] += even * shape.around[r];
                    field[2] += odd * shape.twist[r];
                }
            }
        }
        fields
    }

    /// Energy and gradient at the cosine and sine amplitudes `q` (m), about a common axis.
    pub fn evaluate(&self, q: &[[f64; 2]]) -> Parts {
        let (n_r, n_t) = (self.radii.len(), self.angles);
        let fields = self.fields(q);
        let (mut energy, mut linear) = (0.0, 0.0);
        let mut stress = vec![0.0; n_r * n_t];
        let mut gradient = vec![[0.0; 2]; q.len()];
        for (m, order) in self.airy.iter().enumerate() {
            for (k, &c) in order.stiffness.iter().enumerate() {
                for member in 0..if m == 0 { 1 } else { 2 } {
                    let around = |t: usize| {
                        let (sin, cos) = (m as f64 * TAU * (t as f64 + 0.5) / n_t as f64).sin_cos();
                        if member == 0 { cos } else { sin }
                    };
                    let shape = &self.airy_shapes[m][k];
                    let mut product = 0.0;
                    for t in 0..n_t {
                        for r in 0..n_r {
                            let [a, b, d] = fields[t * n_r + r];
                            product += self.weights[r] * shape[r] * around(t) * 2.0 * (a * b - d * d);
                        }
                    }
                    let p = product * self.scale;
                    let bent = |i: usize| if self.orders[i] as usize == m { self.bends[i][k] } else { 0.0 };
                    let l: f64 = (0..q.len()).map(|i| bent(i) * q[i][member]).sum();
                    energy += c * (p * p + 2.0 * p * l);
                    linear += c * l * l;
                    for (i, out) in gradient.iter_mut().enumerate() {
                        out[member] += 2.0 * c * p * bent(i);
                    }
                    let force = 2.0 * c * (p + l) * self.scale;
                    for t in 0..n_t {
                        for r in 0..n_r {
                            stress[t * n_r + r] += force * around(t) * shape[r] * self.weights[r];
                        }
                    }
                }
            }
        }
        for t in 0..n_t {
            let theta = TAU * (t as f64 + 0.5) / n_t as f64;
            for ((out, &m), shape) in gradient.iter_mut().zip(&self.orders).zip(&self.curvatures) {
                let (sin, cos) = (f64::from(m) * theta).sin_cos();
                for r in 0..n_r {
                    let [a, b, d] = fields[t * n_r + r];
                    let f = 2.0 * stress[t * n_r + r];
                    let even = f * (shape.radial[r] * b + a * shape.around[r]);
                    let odd = f * -2.0 * d * shape.twist[r];
                    out[0] += even * cos - odd * sin;
                    out[1] += even * sin + odd * cos;
                }
            }
        }
        for (out, &m) in gradient.iter_mut().zip(&self.orders) {
            if m == 0 {
                out[1] = 0.0;
            }
        }
        Parts { energy, linear, gradient }
    }
}

/// A state that looks like a wash: every mode with about the same energy, `size` m at `omega` 1000.
pub fn wash(omegas: &[f64], size: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut draw = move || rng.f64() - 0.5;
    omegas.iter().map(|omega| [draw(), draw()].map(|d| d * size * 1000.0 / omega)).collect()
}
