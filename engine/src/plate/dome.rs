//! What doming does to a plate: shell modes from flat ones.
//!
//! Model: shallow spherical cap (Marguerre) with curvature `1/R` and a rim free in its plane.
//! Bending it stretches it: with the clamped plate's modes `Psi_k` as Airy functions and
//! `l_k = (2/R) int Psi_k lap(w) dA`, the stretching energy of small motion is
//! `sum c_k l_k^2`, `c_k = E h a^2 / (8 pi zeta_k^4)`.
//!
//! That sum is closed here instead of truncated. By Green's identity `int Psi_k lap(w)` is
//! `int w lap(Psi_k)`; the functions `lap(Psi_k) / zeta_k^2` are orthonormal, and they span
//! everything that is orthogonal to the harmonic function `r^m cos(m theta)`, which a shallow cap
//! can follow without stretching. With `h_p` the inner product of flat mode `p` with that function,
//!
//! ```text
//! K_pq / M = (omega_p^2 + omega_R^2) delta_pq - omega_R^2 h_p h_q,   omega_R^2 = E / (rho R^2)
//! ```
//!
//! For `m` 0 and 1 the harmonic function is a rigid motion, every `h_p` is zero, and
//! `omega^2 = omega_p^2 + omega_R^2` exactly. From `m = 2` on, shell frequencies interlace with
//! `sqrt(omega_p^2 + omega_R^2)`, so the `n`-th of an order belongs to the `n`-th flat one.
//!
//! The sum over a finite set of Airy functions, which nonlinear stretching needs, approaches this
//! from below; see [`curvature_overlap`].
//!
//! Source: Thomas, Touze, Chaigne, Non-linear vibrations of free-edge thin spherical shells,
//! Int. J. Solids Struct. 42, 2005. The closed sum is ours; a test holds it against the sum.
//!
//! Limits: shallow (rise up to about a quarter of the radius), thin, uniform, no bell; for those see [`thickness_taper`](super::thickness_taper).

use nalgebra::DMatrix;

use super::radial::{RadialMode, angular_norm};
use super::spec::PlateSpec;
use crate::math::eigen;

/// Relative distance of two wave numbers below which an overlap is taken in the limit: there the
/// closed form has lost half its digits.
const COINCIDENCE: f64 = 1e-7;

/// One eigenpair of an order: angular frequency squared, the share of each flat mode, and of the rigid motion.
pub(super) struct Shell {
    /// Square of the angular frequency, rad2/s2.
    pub omega_squared: f64,
    /// Share of each flat mode, `[flat]`.
    pub expansion: Vec<f64>,
    /// Share of the rigid motion `r^m`; none of a cap as thick everywhere.
    pub rigid: f64,
}

/// Shell modes of one order, ascending, from its flat modes.
pub(super) fn shells(spec: &PlateSpec, flat: &[RadialMode]) -> Vec<Shell> {
    let (unit, ring) = (spec.flat_omega(), spec.ring_omega() * spec.ring_omega());
    let omegas: Vec<f64> = flat.iter().map(|mode| unit * mode.root * mode.root).collect();
    let overlaps: Vec<f64> = flat.iter().map(RadialMode::harmonic_overlap).collect();
    let stiffness = DMatrix::from_fn(flat.len(), flat.len(), |p, q| {
        let diagonal = if p == q { omegas[p] * omegas[p] + ring } else { 0.0 };
        diagonal - ring * overlaps[p] * overlaps[q]
    });
    let solved = eigen::symmetric(stiffness);
    let columns = solved.vectors.column_iter().map(|v| v.iter().copied().collect());
    let pairs = solved.values.into_iter().zip(columns);
    pairs.map(|(omega_squared, expansion)| Shell { omega_squared, expansion, rigid: 0.0 }).collect()
}

/// `int Psi lap(w) dA` over the disc for an Airy function and a flat mode of the same order and
/// member, dimensionless; any radius, for the laplacian's `1/a^2` cancels the area's `a^2`.
///
/// `B^k_p` is this times `2/R`.
pub fn curvature_overlap(airy: &RadialMode, flat: &RadialMode) -> f64 {
    debug_assert_eq!(airy.m, flat.m);
    let (k, zeta) = (flat.root, airy.root);
    let (outer, inner) = (airy.rim_laplacian(), flat.rim_laplacian());
    let radial = if (k - zeta).abs() > COINCIDENCE * zeta {
        (inner.value * outer.slope - inner.slope * outer.value) / (zeta.powi(4) - k.powi(4))
    } else {
        // Numerator and denominator vanish together: the ratio of their derivatives by k.
        let m2 = f64::from(flat.m * flat.m);
        let curvature = (k * k - m2) * flat.bessel.value + (k * k + m2) * flat.modified.value;
        (k * curvature * outer.value - inner.slope / k * outer.slope) / (4.0 * k.powi(3))
    };
    angular_norm(flat.m) * radial
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;
    use crate::plate::edges::{clamped_modes, free_modes};
    use crate::plate::thickness_taper::stiffness_unit;
    use std::f64::consts::TAU;

    #[test]
    fn the_curvature_overlap_is_the_integral() {
        let rule = GaussLegendre::unit(160);
        for m in [0, 1, 3, 12, 50] {
            for airy in clamped_modes(m, 80.0).iter().step_by(3) {
                // The Airy function itself lies at the coincidence, in the limit.
                let mut others = free_modes(m, 0.34, 80.0);
                others.push(*airy);
                for flat in others.iter().step_by(2).chain([airy]) {
                    let integrand = |r| airy.value(r) * flat.laplacian(r) * r;
                    let want = angular_norm(m) * rule.integrate(integrand);
                    let got = curvature_overlap(airy, flat);
                    assert!((got - want).abs() < 1e-8 * airy.root, "{airy:?} {flat:?}: {got} {want}");
                }
            }
        }
    }

    /// `[p][q]` of `2 sum c_k B^k_p B^k_q / M` with Airy functions up to a wave number.
    fn summed(spec: &PlateSpec, flat: &[RadialMode], limit: f64) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(flat.len(), flat.len());
        for airy in clamped_modes(flat[0].m, limit) {
            let twice = 2.0 * stiffness_unit(spec) / (airy.root.powi(4) * spec.mass);
            let coupling = |w: &RadialMode| 2.0 * spec.curvature() * curvature_overlap(&airy, w);
            let row: Vec<f64> = flat.iter().map(coupling).collect();
            sum += DMatrix::from_fn(row.len(), row.len(), |p, q| twice * row[p] * row[q]);
        }
        sum
    }

    #[test]
    fn the_sum_over_airy_functions_approaches_its_closed_form_from_below() {
        let spec = crate::reference::cap_crash();
        let ring = spec.ring_omega().powi(2);
        for m in [0, 1, 2, 5, 10, 30] {
            let flat = free_modes(m, spec.poisson_ratio, 60.0);
            let overlaps: Vec<f64> = flat.iter().map(RadialMode::harmonic_overlap).collect();
            let missing = |limit| {
                let sum = summed(&spec, &flat, limit);
                (0..5).map(|p| 1.0 - overlaps[p] * overlaps[p] - sum[(p, p)] / ring).collect()
            };
            let (coarse, fine): (Vec<f64>, Vec<f64>) = (missing(60.0), missing(240.0));
            for (coarse, fine) in coarse.into_iter().zip(fine) {
                assert!(-1e-9 < fine && fine <= coarse && fine < 1e-4, "m {m}: {coarse}, {fine}");
            }
        }
    }

    #[test]
    fn shell_frequencies_are_those_of_enough_airy_functions_and_twice_as_many() {
        let spec = crate::reference::cap_crash();
        for m in [0, 2, 3, 10, 30] {
            let flat = free_modes(m, spec.poisson_ratio, 60.0);
            let flat_omega = |p: usize| spec.flat_omega() * flat[p].root * flat[p].root;
            let omegas: Vec<f64> = (0..flat.len()).map(flat_omega).collect();
            let closed = shells(&spec, &flat);
            for limit in [120.0, 240.0] {
                let mut stiffness = summed(&spec, &flat, limit);
                for (p, omega) in omegas.iter().enumerate() {
                    stiffness[(p, p)] += omega * omega;
                }
                let values = eigen::symmetric(stiffness).values;
                for (shell, value) in closed.iter().zip(values) {
                    let (got, want) = (value.sqrt() / TAU, shell.omega_squared.sqrt() / TAU);
                    assert!((got / want - 1.0).abs() < 1e-3, "m {m}: {got} Hz for {want} Hz");
                }
            }
        }
    }
}
