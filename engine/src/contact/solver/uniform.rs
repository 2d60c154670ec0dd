//! Contacts of one and the same law of Hertz at once, side by side, as those of two rims.
//!
//! The equations are those of [the solver](super): with `Y` the compliances and `f` where each compression would be
//! without any force, `d + Y F(d) = f`. `Y` is given as a matrix and a rank-one coupling through a
//! [nonlinear force](crate::potential), and is nearly diagonal: around a rim a wave comes less far within a sample than
//! from one place to the next. Newton's step solves `(1 + Y F') x = r`, for which a few rounds of Jacobi's method do what
//! elimination takes ten times as long for: a Newton step then leaves a thousandth of the error rather than its square.
//! All loops run over the contacts side by side.
//!
//! The force is that of [`ContactLaw::gradient`], by its difference quotient; [`hertz`](super::hertz) has it by roots.

use crate::contact::ContactLaw;
use crate::modal::simd::Kernels;

use super::product;

/// Newton steps; it needs 2 to 4.
const MAX_STEPS: usize = 12;
/// Rounds within one. *Converged*: a contact yields to another's force by half a percent of what it yields to its own at
/// most, to all others' by four.
const ROUNDS: usize = 2;
/// Error of the compressions over the largest, at which they are found. *Derived*: under the rounding of the shells'
/// displacements, which are `f32`.
const FOUND: f64 = 1e-9;

/// One sample's contacts.
#[derive(Debug, Clone, Copy)]
pub struct UniformContacts<'a, const N: usize> {
    /// The law of all; Hertz's.
    pub law: &'a ContactLaw,
    /// Compliance between any two contacts, symmetric, m/N.
    pub yields: &'a [[f64; N]; N],
    /// What the nonlinear force stiffens them by: `yields` less `u u / divisor`, m over the root of J.
    pub coupling: &'a [f64; N],
    /// See `coupling`; dimensionless.
    pub divisor: f64,
    /// Compression at the start of the sample, m.
    pub before: &'a [f64; N],
    /// At its end without any force, m.
    pub free: &'a [f64; N],
    /// Loss of each touch, s/m.
    pub lambda: &'a [f64; N],
    /// Length of the sample, s.
    pub dt: f64,
}

impl<const N: usize> UniformContacts<'_, N> {
    /// Finds the forces, N, from a guess; whether that succeeded.
    ///
    /// # Real-time
    /// At most 12 steps of a sixth of a microsecond; usually 3.
    pub fn solve(&self, kernels: &Kernels, forces: &mut [f64; N]) -> bool {
        kernels.vectorized(
            #[inline(always)]
            || self.newton(forces),
        )
    }

    #[inline(always)]
    fn newton(&self, forces: &mut [f64; N]) -> bool {
        let held = self.before.map(|d| 0.4 * self.law.stiffness * d.max(0.0).powi(2) * d.max(0.0).sqrt());
        let moved = self.times(forces);
        let mut d: [f64; N] = std::array::from_fn(|i| self.free[i] - moved[i]);
        let own: [f64; N] =
            std::array::from_fn(|i| self.yields[i][i] - self.coupling[i] * self.coupling[i] / self.divisor);
        for _ in 0..MAX_STEPS {
            let (found, slopes) = self.press(&held, &d);
            let moved = self.times(&found);
            let left: [f64; N] = std::array::from_fn(|i| self.free[i] - d[i] - moved[i]);
            let larger = |most: f64, x: &f64| if x.abs() > most { x.abs() } else { most };
            let limit = FOUND * d.iter().chain(self.free).fold(0.0, larger);
            // Looked at all at once, and so that what is not a number is not found.
            if left.iter().fold(true, |found, x| found & (x.abs() <= limit)) {
                *forces = found;
                return true;
            }
            let mut change: [f64; N] = std::array::from_fn(|i| left[i] / (1.0 + own[i] * slopes[i]));
            for _ in 1..ROUNDS {
                let pressed: [f64; N] = std::array::from_fn(|i| slopes[i] * change[i]);
                let moved = self.times(&pressed);
                change = std::array::from_fn(|i| {
                    (left[i] - moved[i] + own[i] * pressed[i]) / (1.0 + own[i] * slopes[i])
                });
            }
            d = std::array::from_fn(|i| d[i] + change[i]);
        }
        false
    }

    /// `Y x`.
    #[inline(always)]
    fn times(&self, x: &[f64; N]) -> [f64; N] {
        let out = product(self.yields, x);
        let along = self.coupling.iter().zip(x).map(|(u, x)| u * x).sum::<f64>() / self.divisor;
        std::array::from_fn(|i| out[i] - self.coupling[i] * along)
    }

    /// Forces and their slopes at the end of a sample that ends at `d`, as [`ContactLaw::gradient`] has them.
    #[inline(always)]
    fn press(&self, held: &[f64; N], d: &[f64; N]) -> ([f64; N], [f64; N]) {
        let (mut forces, mut slopes) = ([0.0; N], [0.0; N]);
        let k = self.law.stiffness;
        for i in 0..N {
            let (d0, d1) = (self.before[i], d[i]);
            let moved = d1 - d0;
            let far = moved.abs() > 1e-4 * d0.abs().max(d1.abs());
            let pressed = d1.max(0.0);
            let end = k * pressed * pressed.sqrt();
            let over = if far { moved } else { 1.0 };
            let mean = (0.4 * end * pressed - held[i]) / over;
            let rise = (end - mean) / over;
            // Taylor about the middle, where the quotient loses its digits.
            let middle = 0.5 * (d0 + d1);
            let (over, k) = if middle > 0.0 { (middle, k) } else { (1.0, 0.0) };
            let force = k * over * over.sqrt();
            let near = force * (1.0 + moved * moved / (32.0 * over * over));
            let (elastic, slope) = if far { (mean, rise) } else { (near, 0.75 * force / over) };
            let factor = 1.0 + self.lambda[i] * moved / self.dt;
            let open = factor <= 0.0;
            forces[i] = if open { 0.0 } else { elastic * factor };
            slopes[i] = if open { 0.0 } else { slope * factor + elastic * self.lambda[i] / self.dt };
        }
        (forces, slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::solver::{self, ContactProblem};
    use crate::contact::{ContactStep, Material, Tip};

    const POINTS: usize = 16;

    #[test]
    fn the_rims_alone_find_what_all_contacts_together_do() {
        let tip = Tip::Solid { material: Material::BRONZE, radius: 1e-3 };
        let law = ContactLaw::new(&tip, &Material::BRONZE, 0.4);
        let mut draw = 7_u64;
        let mut chance = move || {
            draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (draw >> 11) as f64 / (1_u64 << 53) as f64
        };
        let dt = 1.0 / 44_100.0;
        for _ in 0..300 {
            let scattered: [[f64; POINTS]; POINTS] =
                [(); POINTS].map(|()| [(); POINTS].map(|()| chance() - 0.5));
            let mut yields = scattered;
            for (i, row) in yields.iter_mut().enumerate() {
                for (j, y) in row.iter_mut().enumerate() {
                    *y = if i == j { 5e-7 } else { 2e-8 * (scattered[i][j] + scattered[j][i]) };
                }
            }
            let coupling: [f64; POINTS] = std::array::from_fn(|_| 2e-4 * (chance() - 0.5));
            let divisor = 2.3;
            let before: [f64; POINTS] = std::array::from_fn(|_| 4e-6 * (chance() - 0.3));
            let free: [f64; POINTS] = before.map(|d| d + 8e-6 * (chance() - 0.5));
            let lambda = [5.0; POINTS];
            // Some that are open and stay where they are.
            let (mut before, mut free) = (before, free);
            (before[3], free[3]) = (-1e-4, -1e-4);
            (before[4], free[4]) = (-1e-4, -1e-4 + 1e-9);
            let rims = UniformContacts {
                law: &law,
                yields: &yields,
                coupling: &coupling,
                divisor,
                before: &before,
                free: &free,
                lambda: &lambda,
                dt,
            };
            let mut forces = [0.0; POINTS];
            assert!(rims.solve(&Kernels::detect(), &mut forces), "no forces found");
            for (i, row) in yields.iter_mut().enumerate() {
                for (j, y) in row.iter_mut().enumerate() {
                    *y -= coupling[i] * coupling[j] / divisor;
                }
            }
            let mut problems: Vec<ContactProblem> = (0..POINTS)
                .map(|i| {
                    let step = ContactStep {
                        before: before[i],
                        free: free[i],
                        compliance: yields[i][i],
                        lambda: lambda[i],
                        dt,
                    };
                    ContactProblem { law, step, force: 0.0 }
                })
                .collect();
            solver::solve(&mut problems, &yields);
            let largest = forces.iter().fold(0.0_f64, |most, x| most.max(*x));
            for (force, problem) in forces.iter().zip(&problems) {
                assert!((force - problem.force).abs() <= 1e-6 * largest, "{force} {}", problem.force);
            }
        }
    }

    #[test]
    fn forces_and_slopes_are_those_of_the_law() {
        let tip = Tip::Solid { material: Material::BRONZE, radius: 1e-3 };
        let law = ContactLaw::new(&tip, &Material::BRONZE, 0.4);
        let (dt, lambda) = (1.0 / 44_100.0, 30.0);
        for before in [-3e-7, 1e-9, 2e-7, 3e-6] {
            for after in [-2e-7, 3e-9, 2e-7 + 1e-12, 1.9e-7, 4e-6] {
                let step = ContactStep { before, free: 0.0, compliance: 0.0, lambda, dt };
                let (force, slope) = law.gradient(&step, law.potential(before), after);
                let contacts = UniformContacts::<4> {
                    law: &law,
                    yields: &[[0.0; 4]; 4],
                    coupling: &[0.0; 4],
                    divisor: 1.0,
                    before: &[before; 4],
                    free: &[0.0; 4],
                    lambda: &[lambda; 4],
                    dt,
                };
                let (forces, slopes) = contacts.press(&[law.potential(before); 4], &[after; 4]);
                assert!(
                    (forces[2] - force).abs() <= 1e-9 * force.abs(),
                    "{before} {after}: {} {force}",
                    forces[2]
                );
                assert!(
                    (slopes[2] - slope).abs() <= 1e-6 * slope.abs(),
                    "{before} {after}: {} {slope}",
                    slopes[2]
                );
            }
        }
    }
}
