//! Bodies that rest on each other at several points: the forces that hold them, all being still.
//!
//! Model: what the points would overlap by without any force, `g`, less what the forces `F` bend and push away, is
//! what they are pressed together by, `d = g - S F`; and each force is that of the elastic contact, `F = K d^alpha`.
//! `S` has the steady compliances of all that gives way. The energy `f S f / 2 + V(g - S f)` is convex in `f`; Newton's
//! method, with steps halved until the energy falls, finds its one minimum, which is the balance.

use super::ContactLaw;
use super::solver::eliminate;

/// Steps; it needs 3 to 8, from nothing up to 15.
const MAX_STEPS: usize = 40;
/// Halvings of one.
const MAX_HALVINGS: usize = 12;
/// Error of a force over the largest, below which all are found.
const FOUND: f64 = 1e-13;

/// Forces at all points that hold bodies which would overlap by `overlap` (m) without them, N; `forces` is a guess
/// first. `yields` are compliances, m/N.
///
/// # Real-time
/// At most 40 steps of the order of the cube of the points, a microsecond each; usually 5.
pub fn settle<const N: usize>(
    law: &ContactLaw,
    yields: &[[f64; N]; N],
    overlap: &[f64; N],
    forces: &mut [f64; N],
) {
    if overlap.iter().all(|&g| g <= 0.0) {
        forces.fill(0.0);
        return;
    }
    for _ in 0..MAX_STEPS {
        let d = compressions(yields, overlap, forces);
        let mut matrix = [[0.0; N]; N];
        let mut right = [0.0; N];
        let mut largest = 0.0_f64;
        for i in 0..N {
            let (force, slope) = law.elastic(d[i]);
            right[i] = force - forces[i];
            largest = largest.max(force);
            matrix[i] = yields[i].map(|s| slope * s);
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
            let d = compressions(yields, overlap, &next);
            if energy(law, overlap, &next, &d) <= before {
                *forces = next;
                break;
            }
            share *= 0.5;
        }
    }
    // The law itself has the last word, so that what is open presses with exactly nothing.
    let d = compressions(yields, overlap, forces);
    *forces = d.map(|d| law.elastic(d).0);
}

/// `g - S F`, m.
pub fn compressions<const N: usize>(
    yields: &[[f64; N]; N],
    overlap: &[f64; N],
    forces: &[f64; N],
) -> [f64; N] {
    std::array::from_fn(|i| {
        overlap[i] - yields[i].iter().zip(forces).map(|(yields, force)| yields * force).sum::<f64>()
    })
}

fn energy<const N: usize>(law: &ContactLaw, overlap: &[f64; N], forces: &[f64; N], d: &[f64; N]) -> f64 {
    (0..N).map(|i| 0.5 * forces[i] * (overlap[i] - d[i]) + law.potential(d[i])).sum()
}
