//! Plates with a bell or a taper: shell modes of any profile.
//!
//! Model: a shallow shell (Marguerre) that rises as `w0(r)` and is as thick as `h(r) = h t(r)`. With the bracket `L`
//! (see [`bent`](super::bent)), per order, over the free flat plate's modes `w_p`:
//!
//! ```text
//! M_pq = int t w_p w_q                                                  inertia
//! D_pq = int t^3 [lap w_p lap w_q - (1 - nu) L(w_p, w_q)]               bending
//! G_kl = int (1/t) [lap X_k lap X_l - (1 + nu) L(X_k, X_l)]             what stress functions X give
//! B_kp = 2 int X_k L(w0, w_p),   L(w0, w) = w0'' B(w) + w0'/r A(w)      how bending stretches the rise
//! ```
//!
//! The stress of small motion is what the plate's compliance makes of it, so that the stiffness is
//! `D + B^T G^-1 B` in their units. A uniform plate has `M = 1`, `D = diag(k^4)`, `G = diag(zeta^4)` in its clamped modes,
//! and a uniform cap is what [`dome`](super::dome) has in closed form; tests hold the two together.
//!
//! Stress functions are polynomials that vanish at the rim with their slopes,
//! `X_j = r^m (1 - r^2)^2 P_j^(4, m)(2 r^2 - 1)`: as many as the modes are fine.
//! What is not uniform is not orthogonal to the rigid motions by itself; a rigid part sees to it.
//!
//! Sources: Marguerre 1938; Thomas, Touze, Chaigne, Int. J. Solids Struct. 42, 2005 (the uniform cap).
//!
//! Limits: shallow, also the bell, whose slopes a cymbal maker would not call so: it is as stiff as it should be and light,
//! and what it does to the bow hardly depends on more.

use std::f64::consts::PI;

use nalgebra::{Cholesky, DMatrix};
use serde::{Deserialize, Serialize};

use super::bent::Bent;
use super::dome::Shell;
use super::radial::{RadialMode, angular_norm};
use super::spec::PlateSpec;
use crate::cache::Shared;
use crate::math::bessel::{ITable, JTable};
use crate::math::quadrature::{self, GaussLegendre};
use crate::math::{eigen, jacobi};

/// Degrees of stress functions over the largest wave number of the modes: so much relatively, and so many. *Converged*: half as
/// many functions again of both kinds move a crash's (0,1) by 0.1 % and no other of its frequencies by 0.03 %.
const STRESS_DEGREE: (f64, f64) = (1.2, 16.0);

/// A plate along its radius.
pub struct Section {
    rule: Shared<GaussLegendre>,
    /// Over the mean, `[r]`.
    thickness: Vec<f64>,
    /// `w0''` and `w0'/r`, 1/m, `[r]`.
    curvature: Vec<[f64; 2]>,
    poisson_ratio: f64,
    /// Of stress functions.
    degree: f64,
}

impl Section {
    /// For modes whose wave numbers reach up to `reach` (dimensionless: times the radius).
    pub fn new(spec: &PlateSpec, reach: f64) -> Section {
        let degree = STRESS_DEGREE.0 * reach + STRESS_DEGREE.1;
        // Products of two functions each, and what the profile adds to them.
        let rule = quadrature::shared_unit((degree + 40.0) as usize);
        let thickness = rule.nodes.iter().map(|&r| spec.relative_thickness(r)).collect();
        let curvature = rule.nodes.iter().map(|&r| spec.curvatures(r)).collect();
        Section { rule, thickness, curvature, poisson_ratio: spec.poisson_ratio, degree }
    }

    /// Radii of the grid, shares of the plate's.
    pub fn radii(&self) -> &[f64] {
        &self.rule.nodes
    }

    /// Integral over the disc of what is given at each place of the grid for the square of the angular part, over the
    /// disc's area.
    fn mean(&self, m: u32, of: impl Fn(usize) -> f64) -> f64 {
        let nodes = self.rule.nodes.iter().zip(&self.rule.weights).enumerate();
        angular_norm(m) / PI * nodes.map(|(at, (r, weight))| r * weight * of(at)).sum::<f64>()
    }

    /// A symmetric matrix of means.
    fn means(&self, m: u32, count: usize, of: impl Fn(usize, usize, usize) -> f64) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(count, count);
        for p in 0..count {
            for q in 0..=p {
                out[(p, q)] = self.mean(m, |at| of(p, q, at));
                out[(q, p)] = out[(p, q)];
            }
        }
        out
    }

    /// `M_pq`, with the part that the rigid motions carry: `[p]` of unit rigid motion, and its share of `r^m`.
    fn inertia(&self, m: u32, flat: &[Bent]) -> (DMatrix<f64>, Vec<f64>) {
        let t = &self.thickness;
        let mut inertia = self.means(m, flat.len(), |p, q, at| t[at] * flat[p].value[at] * flat[q].value[at]);
        let mut rigid = vec![0.0; flat.len()];
        if m < 2 {
            let motion = |at: usize| self.rule.nodes[at].powi(m as i32);
            let own = self.mean(m, |at| t[at] * motion(at).powi(2));
            for (rigid, flat) in rigid.iter_mut().zip(flat) {
                *rigid = self.mean(m, |at| t[at] * motion(at) * flat.value[at]) / own;
            }
            for p in 0..flat.len() {
                for q in 0..flat.len() {
                    inertia[(p, q)] -= own * rigid[p] * rigid[q];
                }
            }
        }
        (inertia, rigid)
    }

    /// `D_pq`.
    fn bending(&self, m: u32, flat: &[Bent]) -> DMatrix<f64> {
        let rest = 1.0 - self.poisson_ratio;
        self.means(m, flat.len(), |p, q, at| {
            let bent = flat[p].laplacian(at) * flat[q].laplacian(at) - rest * flat[p].bracket(&flat[q], at);
            self.thickness[at].powi(3) * bent
        })
    }

    /// `G_kl`.
    fn compliance(&self, m: u32, stress: &[Bent]) -> DMatrix<f64> {
        let more = 1.0 + self.poisson_ratio;
        self.means(m, stress.len(), |k, l, at| {
            let (k, l) = (&stress[k], &stress[l]);
            (k.laplacian(at) * l.laplacian(at) - more * k.bracket(l, at)) / self.thickness[at]
        })
    }

    /// `B_kp`, 1/m.
    fn doming(&self, m: u32, stress: &[Bent], flat: &[Bent]) -> DMatrix<f64> {
        DMatrix::from_fn(stress.len(), flat.len(), |k, p| {
            let (stress, flat) = (&stress[k], &flat[p]);
            2.0 * PI
                * self.mean(m, |at| {
                    let [radial, around] = self.curvature[at];
                    stress.value[at] * (radial * flat.around[at] + around * flat.radial[at])
                })
        })
    }

    /// Flat modes of one order on the grid, from tables of it.
    fn flat(&self, flat: &[RadialMode], tables: (&JTable, &ITable)) -> Vec<Bent> {
        flat.iter().map(|mode| Bent::of(mode, tables, self.radii())).collect()
    }

    /// Stress functions of order `m` on the grid, of about unit curvature.
    fn stress(&self, m: u32) -> Vec<Bent> {
        let count = (0.5 * (self.degree - f64::from(m))).max(8.0) as usize;
        stress_functions(m, count, self.radii())
    }
}

/// The first `count` stress functions of order `m` at `radii` (shares of the radius), all above 0.
pub fn stress_functions(m: u32, count: usize, radii: &[f64]) -> Vec<Bent> {
    let order = f64::from(m);
    let mut out = vec![Bent::zero(0); count];
    // A polynomial and its first two derivatives by r^2.
    let mut polynomials = [(); 3].map(|()| vec![0.0; count]);
    for &r in radii {
        let s = r * r;
        for (up, values) in polynomials.iter_mut().enumerate() {
            jacobi::fill(4.0 + up as f64, order + up as f64, 2.0 * s - 1.0, values);
        }
        let edge = 1.0 - s;
        for (j, bent) in out.iter_mut().enumerate() {
            let n = j as f64;
            let p = polynomials[0][j];
            let p1 = if j > 0 { (n + order + 5.0) * polynomials[1][j - 1] } else { 0.0 };
            let p2 = if j > 1 { (n + order + 5.0) * (n + order + 6.0) * polynomials[2][j - 2] } else { 0.0 };
            // q = (1 - s)^2 P, and its derivatives by s; X = r^m q.
            let q = edge * edge * p;
            let q1 = edge * (edge * p1 - 2.0 * p);
            let q2 = 2.0 * p - 4.0 * edge * p1 + edge * edge * p2;
            // A curvature goes as the fourth power of the degree at the rim.
            let scale = r.powi(m as i32) / (n + 1.0 + 0.5 * order).powi(2);
            bent.value.push(scale * q);
            let steep = order * (order - 1.0) * q / s;
            bent.radial.push(scale * (steep + (4.0 * order + 2.0) * q1 + 4.0 * s * q2));
            bent.around.push(scale * (2.0 * q1 - steep));
            bent.twist.push(scale * (steep + 2.0 * order * q1));
        }
    }
    out
}

/// `E h a^2 / (8 pi)`, N m: stretching energy of a unit of `P` with a stress function of unit compliance.
pub fn stiffness_unit(spec: &PlateSpec) -> f64 {
    spec.youngs_modulus * spec.thickness() * spec.radius().powi(2) / (8.0 * PI)
}

/// Shell modes of one order, ascending, from its flat modes.
///
/// # Panics
/// If the tables are of another order or do not reach the modes' wave numbers.
pub(super) fn shells(
    spec: &PlateSpec,
    section: &Section,
    modes: &[RadialMode],
    tables: (&JTable, &ITable),
) -> Vec<Shell> {
    let Some(m) = modes.first().map(|mode| mode.m) else { return Vec::new() };
    let (flat, stress) = (section.flat(modes, tables), section.stress(m));
    let (inertia, rigid) = section.inertia(m, &flat);
    let mut stiffness = section.bending(m, &flat) * spec.flat_omega().powi(2);
    let doming = section.doming(m, &stress, &flat);
    // G is positive definite, being an energy, and M a mass.
    let Some(compliance) = Cholesky::new(section.compliance(m, &stress)) else { return Vec::new() };
    let Some(inertia) = Cholesky::new(inertia) else { return Vec::new() };
    if let Some(stressed) = compliance.l().solve_lower_triangular(&doming) {
        stiffness += stressed.tr_mul(&stressed) * (2.0 * stiffness_unit(spec) / spec.mass);
    }
    let lower = inertia.l();
    let halved = lower.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
    let reduced = lower.solve_lower_triangular(&halved.transpose()).unwrap_or(halved);
    let solved = eigen::symmetric(reduced);
    let columns = lower.tr_solve_lower_triangular(&solved.vectors).unwrap_or(solved.vectors);
    let pairs = solved.values.into_iter().zip(columns.column_iter());
    pairs
        .map(|(omega_squared, column)| {
            let expansion: Vec<f64> = column.iter().copied().collect();
            let rigid = -expansion.iter().zip(&rigid).map(|(share, rigid)| share * rigid).sum::<f64>();
            Shell { omega_squared: omega_squared.max(0.0), expansion, rigid }
        })
        .collect()
}

/// Stress functions that stretch an uneven plate each by itself, as clamped modes do a uniform one.
#[derive(Serialize, Deserialize)]
pub struct StressModes {
    /// Nodal diameters.
    pub m: u32,
    /// Fourth power of the wave number that a uniform plate's would have, dimensionless, `[function]`, ascending.
    pub compliance: Vec<f64>,
    /// Polynomials in use, and the share of each, of unit mean square, `[function][polynomial]`.
    polynomials: usize,
    mix: Vec<Vec<f64>>,
    /// `B_kp`, 1/m, `[function][flat]`.
    pub doming: Vec<Vec<f64>>,
}

impl StressModes {
    /// Those of order `modes` with a wave number up to `limit` (dimensionless: times the radius), the lowest `most` of them.
    ///
    /// # Panics
    /// If the tables are of another order or do not reach the modes' wave numbers.
    pub fn new(
        section: &Section,
        modes: &[RadialMode],
        m: u32,
        tables: (&JTable, &ITable),
        (limit, most): (f64, usize),
    ) -> StressModes {
        let (flat, stress) = (section.flat(modes, tables), section.stress(m));
        let none = StressModes {
            m,
            polynomials: stress.len(),
            compliance: Vec::new(),
            mix: Vec::new(),
            doming: Vec::new(),
        };
        let square = section.means(m, stress.len(), |k, l, at| stress[k].value[at] * stress[l].value[at]);
        // By the inverse: the largest eigenvalues of it are the ones wanted, and the exact ones.
        let Some(compliance) = Cholesky::new(section.compliance(m, &stress)) else { return none };
        let lower = compliance.l();
        let Some(half) = lower.solve_lower_triangular(&square) else { return none };
        let Some(inverse) = lower.solve_lower_triangular(&half.transpose()) else { return none };
        let solved = eigen::symmetric(inverse);
        let wanted = solved.values.iter().rev().take_while(|value| limit.powi(4) * **value >= 1.0);
        let count = wanted.take(most).count();
        let size = solved.values.len();
        let vectors = DMatrix::from_fn(size, count, |row, k| {
            solved.vectors[(row, size - 1 - k)] / solved.values[size - 1 - k].sqrt()
        });
        let Some(mix) = lower.tr_solve_lower_triangular(&vectors) else { return none };
        let compliance = solved.values.iter().rev().take(count).map(|value| value.recip()).collect();
        let doming = mix.tr_mul(&section.doming(m, &stress, &flat));
        let doming = doming.row_iter().map(|row| row.iter().copied().collect()).collect();
        let mix = mix.column_iter().map(|column| column.iter().copied().collect()).collect();
        StressModes { m, compliance, polynomials: stress.len(), mix, doming }
    }

    /// Radial shapes at `radii` (shares of the radius), `[function][r]`.
    pub fn shapes(&self, radii: &[f64]) -> Vec<Vec<f64>> {
        let stress = stress_functions(self.m, self.polynomials, radii);
        let shape = |mix: &Vec<f64>| {
            let mut sum = vec![0.0; radii.len()];
            for (share, bent) in mix.iter().zip(&stress) {
                sum.iter_mut().zip(&bent.value).for_each(|(sum, value)| *sum += share * value);
            }
            sum
        };
        self.mix.iter().map(shape).collect()
    }
}
