//! The force law of several contacts side by side, one in each lane of a register.
//!
//! The force of a sample is the secant slope of the potential, `(V1 - V0) / (d1 - d0)`, times the loss factor at the
//! mean speed; see [`contact`](super). Two forms of the slope lose no digits however little a contact moves:
//!
//! * **Hertz's exponent**, 3/2. With `s0`, `s1` the roots of the compressions before and after, a contact that stays
//!   closed has
//!
//!   ```text
//!   (V1 - V0) / (d1 - d0) = 2/5 K (s1^4 + s1^3 s0 + s1^2 s0^2 + s1 s0^3 + s0^4) / (s1 + s0)
//!   ```
//!
//!   For one that closes or opens the quotient itself is exact, because one of the two potentials is zero.
//! * **Any other exponent**: the quotient, or for a small movement its Taylor series about the middle.

use super::{ContactLaw, ContactStep};

/// Hertz's exponent, dimensionless.
const HERTZ: f64 = 1.5;

/// Movement, relative to the compression, below which the quotient is replaced by its series.
const SERIES: f64 = 1e-4;

/// `N` contacts; every array is indexed `[contact]`. An unused lane is [apart](Self::APART).
#[derive(Debug, Clone)]
pub struct ContactLanes<const N: usize> {
    /// `K`, N/m^alpha.
    pub stiffness: [f64; N],
    /// `alpha`, dimensionless.
    pub exponent: [f64; N],
    /// Compression at the start of the sample, m.
    pub before: [f64; N],
    /// Compression at its end if no force acted anywhere, m.
    pub free: [f64; N],
    /// Loss of each touch over the length of the sample, 1/m.
    pub loss: [f64; N],
    /// First an estimate of each force, then the solution, N.
    pub force: [f64; N],
}

impl<const N: usize> ContactLanes<N> {
    /// All contacts are open.
    pub const APART: ContactLanes<N> = ContactLanes {
        stiffness: [0.0; N],
        exponent: [HERTZ; N],
        before: [-1.0; N],
        free: [-1.0; N],
        loss: [0.0; N],
        force: [0.0; N],
    };

    /// Puts a contact into a lane, with an estimate of its force, N.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, law: &ContactLaw, step: &ContactStep, force: f64) {
        (self.stiffness[lane], self.exponent[lane]) = (law.stiffness, law.exponent);
        (self.before[lane], self.free[lane]) = (step.before, step.free);
        (self.loss[lane], self.force[lane]) = (step.lambda / step.dt, force);
    }

    /// Whether all contacts follow Hertz's law.
    pub fn all_hertz(&self) -> bool {
        self.exponent.iter().all(|&exponent| exponent == HERTZ)
    }

    /// Roots of the compressions at the start of the sample, for [`gradient`](Self::gradient), root of m.
    #[inline(always)]
    pub fn roots(&self) -> [f64; N] {
        let mut roots = [0.0; N];
        // A loop: a closure would be compiled without the machine's instructions.
        for (root, before) in roots.iter_mut().zip(&self.before) {
            *root = before.max(0.0).sqrt();
        }
        roots
    }

    /// Forces (N) of a sample that ends at the compressions `d` (m), and their slopes by `d`, N/m; `roots` (root of m) are
    /// [those](Self::roots) of the compressions at its start. `ALL_HERTZ` promises [`all_hertz`](Self::all_hertz).
    #[inline(always)]
    pub fn gradient<const ALL_HERTZ: bool>(&self, roots: &[f64; N], d: &[f64; N]) -> ([f64; N], [f64; N]) {
        let (mut force, mut slope) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let (d0, d1) = (self.before[i], d[i]);
            let (elastic, steep) = if ALL_HERTZ || self.exponent[i] == HERTZ {
                secant_of_roots(self.stiffness[i], d0, d1, roots[i])
            } else {
                secant_of_powers(self.stiffness[i], self.exponent[i], d0, d1)
            };
            let factor = 1.0 + self.loss[i] * (d1 - d0);
            // Nothing sticks.
            let presses = factor > 0.0;
            force[i] = if presses { elastic * factor } else { 0.0 };
            slope[i] = if presses { steep * factor + elastic * self.loss[i] } else { 0.0 };
        }
        (force, slope)
    }
}

/// Secant slope of Hertz's potential (N) and its derivative by `d1` (N/m), without a branch; `s0` is the root of `d0`.
#[inline(always)]
fn secant_of_roots(stiffness: f64, d0: f64, d1: f64, s0: f64) -> (f64, f64) {
    let s1 = d1.max(0.0).sqrt();
    let k = 0.4 * stiffness;
    // Closed throughout.
    let over = 1.0 / (s1 + s0).max(f64::MIN_POSITIVE);
    let (a, b, c) = (s1 * s1, s0 * s0, s1 * s0);
    let through = k * (a * a + b * b + c * (a + b + c)) * over;
    let rises = 0.5 * k * (s1 * (3.0 * a + 6.0 * c + 4.0 * b) + 2.0 * s0 * b) * over * over;
    // It closes or opens within. By less than the least normal number it has not moved: the inverse would be infinite.
    let moved = d1 - d0;
    let by = 1.0 / if moved.abs() < f64::MIN_POSITIVE { 1.0 } else { moved };
    let mean = k * (a * a * s1 - b * b * s0) * by;
    let steepens = (2.5 * k * a * s1 - mean) * by;
    let closed = s0 > 0.0 && s1 > 0.0;
    if closed { (through, rises) } else { (mean, steepens) }
}

/// Secant slope of the potential `K d^(alpha+1) / (alpha+1)` (N) and its derivative by `d1` (N/m).
fn secant_of_powers(stiffness: f64, exponent: f64, d0: f64, d1: f64) -> (f64, f64) {
    let force = |d: f64| if d > 0.0 { stiffness * d.powf(exponent) } else { 0.0 };
    let moved = d1 - d0;
    if moved.abs() > SERIES * d0.abs().max(d1.abs()) {
        // V(d) = F(d) d / (alpha + 1)
        let (start, end) = (force(d0), force(d1));
        let mean = (end * d1 / (exponent + 1.0) - start * d0 / (exponent + 1.0)) / moved;
        return (mean, (end - mean) / moved);
    }
    let middle = 0.5 * (d0 + d1);
    if middle <= 0.0 {
        return (0.0, 0.0);
    }
    // The next term is of relative order (moved / d)^4.
    let curvature = exponent * (exponent - 1.0) * moved * moved / (24.0 * middle * middle);
    let force = force(middle);
    (force * (1.0 + curvature), 0.5 * exponent * force / middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Material, Tip};

    /// Force and slope as the equation stands, differences and all.
    fn naive(law: &ContactLaw, lambda: f64, dt: f64, d0: f64, d1: f64) -> (f64, f64) {
        let moved = d1 - d0;
        let mean = (law.potential(d1) - law.potential(d0)) / moved;
        let factor = 1.0 + lambda * moved / dt;
        let slope = (law.elastic(d1).0 - mean) / moved;
        if factor > 0.0 { (mean * factor, slope * factor + mean * lambda / dt) } else { (0.0, 0.0) }
    }

    fn lanes(law: &ContactLaw, lambda: f64, dt: f64, before: f64) -> ContactLanes<4> {
        let mut lanes = ContactLanes::APART;
        let step = ContactStep { before, free: 0.0, compliance: 0.0, lambda, dt };
        (0..4).for_each(|i| lanes.set(i, law, &step, 0.0));
        lanes
    }

    fn laws() -> [ContactLaw; 3] {
        let solid = Tip::Solid { material: Material::STEEL, radius: 0.8e-3 };
        let felt = |exponent| Tip::Felt { stiffness: 3e8, exponent };
        [solid, felt(2.5), felt(1.5)].map(|tip| ContactLaw::new(&tip, &Material::FILM, 0.35))
    }

    #[test]
    fn forces_and_slopes_are_those_of_the_equation() {
        let dt = 1.0 / 44_100.0;
        for law in laws() {
            for lambda in [0.0, 30.0] {
                for before in [-3e-7, 0.0, 1e-9, 2e-7, 3e-6] {
                    for after in [-2e-7, 3e-9, 1.9e-7, 2.1e-7, 4e-6] {
                        let lanes = lanes(&law, lambda, dt, before);
                        let (forces, slopes) = lanes.gradient::<false>(&lanes.roots(), &[after; 4]);
                        let (force, slope) = naive(&law, lambda, dt, before, after);
                        assert!((forces[3] - force).abs() <= 1e-9 * force.abs(), "{law:?} {before} {after}");
                        assert!((slopes[3] - slope).abs() <= 1e-6 * slope.abs(), "{law:?} {before} {after}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_contact_that_barely_moves_has_the_static_force() {
        for law in laws() {
            for moved in [0.0, 1e-18, 1e-14, 1e-12] {
                let (d, lanes) = (2e-7, lanes(&law, 0.0, 1e-5, 2e-7));
                let (forces, slopes) = lanes.gradient::<false>(&lanes.roots(), &[d + moved; 4]);
                let (force, slope) = law.elastic(d + 0.5 * moved);
                assert!((forces[0] / force - 1.0).abs() < 1e-9, "{law:?} {moved}: {} {force}", forces[0]);
                assert!((slopes[0] / (0.5 * slope) - 1.0).abs() < 1e-4, "{law:?} {moved}: {}", slopes[0]);
            }
        }
    }

    #[test]
    fn a_contact_that_closes_by_a_denormal_number_has_no_force() {
        for law in laws() {
            for (before, after) in [(0.0, 2.3e-315), (-1e-315, 1e-315), (1e-315, 0.0), (5e-324, 1e-323)] {
                let lanes = lanes(&law, 30.0, 1e-5, before);
                let (forces, slopes) = lanes.gradient::<false>(&lanes.roots(), &[after; 4]);
                assert_eq!(forces[0], 0.0, "{law:?} {before:e} {after:e}");
                assert!(slopes[0].is_finite(), "{law:?} {before:e} {after:e}: {}", slopes[0]);
            }
        }
    }

    #[test]
    fn lanes_of_hertz_need_no_power() {
        let law = &laws()[0];
        let lanes = lanes(law, 30.0, 1e-5, 2e-7);
        assert!(lanes.all_hertz());
        let d = [-1e-7, 1e-9, 2e-7, 3e-6];
        assert_eq!(lanes.gradient::<true>(&lanes.roots(), &d), lanes.gradient::<false>(&lanes.roots(), &d));
    }
}
