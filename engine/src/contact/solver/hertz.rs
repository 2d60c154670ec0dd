//! Several contacts of Hertz's law at once, side by side in the lanes of a register.
//!
//! The equations of [the solver](super), with `F = K d^(3/2) (1 + lambda d')`. With `s0`, `s1` the roots of the compressions
//! before and after, the discrete gradient of a contact that stays closed needs no difference quotient,
//!
//! ```text
//! (V1 - V0) / (d1 - d0) = 2/5 K (s1^4 + s1^3 s0 + s1^2 s0^2 + s1 s0^3 + s0^4) / (s1 + s0)
//! ```
//!
//! and so loses no digits however slowly it moves. Newton's system `(1 + Y F') change = left` is solved only nearly, by
//! two sweeps of Jacobi: a place yields more to its own force than to all others, by three to five times under snare wires,
//! so that every step leaves about a fiftieth of the error, and the next one takes that away.

use crate::contact::ContactLaw;
use crate::modal::simd::Kernels;

use super::product;

/// The dimensionless exponent these are solved for.
pub const EXPONENT: f64 = 1.5;

/// Steps before the general solver is asked; 3 to 5 do it.
const MAX_STEPS: usize = 12;

/// Sweeps for each step's system.
const SWEEPS: usize = 2;

/// Change of a compression, relative, in the last step: a fiftieth of it is left, under the rounding of the forces that modes
/// are given.
const LAST_STEP: f64 = 1e-8;

/// So many contacts, each number `[contact]`; what is not used is apart.
#[derive(Debug, Clone)]
pub struct Hertz<const N: usize> {
    /// `K`, N/m^1.5.
    pub stiffness: [f64; N],
    /// Compression at the start of the sample, m.
    pub before: [f64; N],
    /// Compression at its end if no force acted anywhere, m.
    pub free: [f64; N],
    /// Loss of each touch over the length of the sample, 1/m.
    pub loss: [f64; N],
    /// A guess at each force first, N, then what was found.
    pub force: [f64; N],
    /// `[contact][contact]`, m/N.
    pub compliance: [[f64; N]; N],
}

impl<const N: usize> Hertz<N> {
    /// All apart.
    pub const APART: Hertz<N> = Hertz {
        stiffness: [0.0; N],
        before: [-1.0; N],
        free: [-1.0; N],
        loss: [0.0; N],
        force: [0.0; N],
        compliance: [[0.0; N]; N],
    };

    /// Whether these contacts are solved for such a law.
    pub fn knows(law: &ContactLaw) -> bool {
        law.exponent == EXPONENT
    }

    /// Finds all forces; false if it did not.
    ///
    /// # Real-time
    /// At most 12 steps of the order of the square of the contacts.
    pub fn solve(&mut self, kernels: Kernels) -> bool {
        kernels.vectorized(
            #[inline(always)]
            || self.solve_lanes(),
        )
    }

    #[inline(always)]
    fn solve_lanes(&mut self) -> bool {
        let root: [f64; N] = std::array::from_fn(|i| self.before[i].max(0.0).sqrt());
        let mut d = self.moved(&self.force);
        for _ in 0..MAX_STEPS {
            let (force, slope) = self.gradient(&root, &d);
            let moved = self.moved(&force);
            let left: [f64; N] = std::array::from_fn(|i| moved[i] - d[i]);
            let own: [f64; N] = std::array::from_fn(|i| self.compliance[i][i] * slope[i]);
            let mut change: [f64; N] = std::array::from_fn(|i| left[i] / (1.0 + own[i]));
            for _ in 0..SWEEPS {
                let pushed: [f64; N] = std::array::from_fn(|i| slope[i] * change[i]);
                let all = product(&self.compliance, &pushed);
                for i in 0..N {
                    change[i] = (left[i] - all[i] + own[i] * change[i]) / (1.0 + own[i]);
                }
            }
            for i in 0..N {
                self.force[i] = force[i] + slope[i] * change[i];
            }
            let found = self.moved(&self.force);
            // What is not a number has not settled.
            let mut settled = true;
            for i in 0..N {
                let scale = LAST_STEP * self.before[i].abs().max(self.free[i].abs());
                settled &= (found[i] - d[i]).abs() <= scale;
            }
            d = found;
            if settled {
                self.force.iter_mut().for_each(|force| *force = force.max(0.0));
                return true;
            }
        }
        false
    }

    /// Compressions under these forces, m.
    #[inline(always)]
    fn moved(&self, force: &[f64; N]) -> [f64; N] {
        let yields = product(&self.compliance, force);
        std::array::from_fn(|i| self.free[i] - yields[i])
    }

    /// Forces of a sample that ends at these compressions, and their slopes; `s0` are the roots of those before.
    #[inline(always)]
    fn gradient(&self, s0: &[f64; N], d: &[f64; N]) -> ([f64; N], [f64; N]) {
        let (mut force, mut slope) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let (d0, d1, s0) = (self.before[i], d[i], s0[i]);
            let s1 = d1.max(0.0).sqrt();
            let k = 0.4 * self.stiffness[i];
            // Closed throughout.
            let over = 1.0 / (s1 + s0).max(f64::MIN_POSITIVE);
            let (a, b, c) = (s1 * s1, s0 * s0, s1 * s0);
            let through = k * (a * a + b * b + c * (a + b + c)) * over;
            let rises = 0.5 * k * (s1 * (3.0 * a + 6.0 * c + 4.0 * b) + 2.0 * s0 * b) * over * over;
            // It closes or opens within.
            let moved = d1 - d0;
            let by = 1.0 / if moved == 0.0 { 1.0 } else { moved };
            let mean = k * (a * a * s1 - b * b * s0) * by;
            let steepens = (2.5 * k * a * s1 - mean) * by;
            let closed = s0 > 0.0 && s1 > 0.0;
            let (elastic, steep) = if closed { (through, rises) } else { (mean, steepens) };
            let factor = 1.0 + self.loss[i] * moved;
            let held = factor > 0.0;
            force[i] = if held { elastic * factor } else { 0.0 };
            slope[i] = if held { steep * factor + elastic * self.loss[i] } else { 0.0 };
        }
        (force, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactStep, Material, Tip};

    fn law() -> ContactLaw {
        let tip = Tip::Solid { material: Material::STEEL, radius: 0.8e-3 };
        ContactLaw::new(&tip, &Material::FILM, 0.35)
    }

    #[test]
    fn forces_and_slopes_are_those_of_the_law() {
        let (law, dt) = (law(), 1.0 / 44_100.0);
        for before in [-3e-7, 1e-9, 2e-7, 3e-6] {
            for after in [-2e-7, 3e-9, 2e-7 + 1e-12, 1.9e-7, 4e-6] {
                let step = ContactStep { before, free: 0.0, compliance: 0.0, lambda: 30.0, dt };
                let (force, slope) = law.gradient(&step, law.potential(before), after);
                let hertz = Hertz::<8> {
                    stiffness: [law.stiffness; 8],
                    before: [before; 8],
                    loss: [30.0 / dt; 8],
                    ..Hertz::APART
                };
                let (forces, slopes) = hertz.gradient(&[before.max(0.0).sqrt(); 8], &[after; 8]);
                assert!(
                    (forces[3] - force).abs() <= 1e-9 * force.abs(),
                    "{before} {after}: {} {force}",
                    forces[3]
                );
                assert!(
                    (slopes[3] - slope).abs() <= 1e-6 * slope.abs(),
                    "{before} {after}: {} {slope}",
                    slopes[3]
                );
            }
        }
    }

    #[test]
    fn it_finds_what_the_general_solver_finds() {
        let law = law();
        let mut draw = 1_u64;
        let mut chance = move || {
            draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (draw >> 11) as f64 / (1_u64 << 53) as f64
        };
        let dt = 2e-5;
        for _ in 0..500 {
            let mutual = 3e-7 * chance();
            let mut hertz = Hertz::<8>::APART;
            let mut problems = Vec::new();
            let mut compliance = [[mutual; super::super::MAX_CONTACTS]; super::super::MAX_CONTACTS];
            for (i, compliance) in compliance.iter_mut().enumerate().take(7) {
                let before = 2e-6 * (chance() - 0.3);
                let free = before + 4e-6 * (chance() - 0.5);
                let step = ContactStep { before, free, compliance: 3e-6, lambda: 3.0, dt };
                problems.push(super::super::ContactProblem { law, step, force: 0.0 });
                (hertz.stiffness[i], hertz.before[i], hertz.free[i], hertz.loss[i]) =
                    (law.stiffness, before, free, 3.0 / dt);
                hertz.compliance[i][..7].fill(mutual);
                (hertz.compliance[i][i], compliance[i]) = (3e-6, 3e-6);
            }
            assert!(hertz.solve(Kernels::detect()), "did not settle");
            super::super::solve(&mut problems, &compliance);
            let largest = problems.iter().map(|problem| problem.force).fold(0.0, f64::max);
            for (fast, slow) in hertz.force.iter().zip(&problems) {
                assert!((fast - slow.force).abs() <= 1e-8 * largest, "{fast} {}", slow.force);
            }
        }
    }
}
