//! Static equilibrium of bodies that rest on each other at several points.
//!
//! Model: without forces the points would overlap by `g`. The forces `F` reduce the overlap to the compressions
//! `d = g - S F`, where `S` holds the static compliances. Each force is that of the elastic contact, `F = K d^alpha`. The energy
//! `F S F / 2 + V(g - S F)` is convex in `F`. Its one minimum is the equilibrium. Newton's method finds it, with steps halved until
//! the energy falls.

use super::ContactLaw;
use super::solver::eliminate;

/// Newton steps; 3 to 8 are needed, up to 15 without an estimate.
const MAX_STEPS: usize = 40;
/// Halvings of a step.
const MAX_HALVINGS: usize = 12;
/// Largest error of a force, relative to the largest force.
const FOUND: f64 = 1e-13;

/// Finds the static forces at all points, N. `overlap` is `g`, m; `compliances` are static, m/N; `forces` is an estimate
/// first.
///
/// # Real-time
/// At most 40 steps of the order of the cube of the points, a microsecond each; usually 5.
pub fn settle<const N: usize>(
    law: &ContactLaw,
    compliances: &[[f64; N]; N],
    overlap: &[f64; N],
    forces: &mut [f64; N],
) {
    if overlap.iter().all(|&g| g <= 0.0) {
        forces.fill(0.0);
        return;
    }
    for _ in 0..MAX_STEPS {
        let d = compressions(compliances, overlap, forces);
        let mut matrix = [[0.0; N]; N];
        let mut right = [0.0; N];
        let mut largest = 0.0_f64;
        for i in 0..N {
            let (force, slope) = law.elastic(d[i]);
            right[i] = force - forces[i];
            largest = largest.max(force);
            matrix[i] = compliances[i].map(|s| slope * s);
            matrix[i][i] += 1.0;
        }
        let error = right.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if error <= FOUND * largest {
            break;
        }
        let change = eliminate(&mut matrix, &mut right, N);
        let before = energy(law, overlap, forces, &d);
        let mut share = 1.0;
        for _ in 0..MAX_HALVINGS {
            let next: [f64; N] = std::array::from_fn(|i| forces[i] + share * change[i]);
            let d = compressions(compliances, overlap, &next);
            if energy(law, overlap, &next, &d) <= before {
                *forces = next;
                break;
            }
            share *= 0.5;
        }
    }
    // Through the law, so that the force of an open contact is exactly zero.
    let d = compressions(compliances, overlap, forces);
    *forces = d.map(|d| law.elastic(d).0);
}

/// `g - S F`, m.
pub fn compressions<const N: usize>(
    compliances: &[[f64; N]; N],
    overlap: &[f64; N],
    forces: &[f64; N],
) -> [f64; N] {
    std::array::from_fn(|i| {
        overlap[i]
            - compliances[i].iter().zip(forces).map(|(compliance, force)| compliance * force).sum::<f64>()
    })
}

fn energy<const N: usize>(law: &ContactLaw, overlap: &[f64; N], forces: &[f64; N], d: &[f64; N]) -> f64 {
    (0..N).map(|i| 0.5 * forces[i] * (overlap[i] - d[i]) + law.potential(d[i])).sum()
}
