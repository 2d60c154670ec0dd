//! Static equilibrium of bodies that rest on each other at several points.
//!
//! Model: without forces the points would overlap by `g`. The forces `F` reduce the overlap to the compressions
//! `d = g - S F`, where `S` holds the static compliances. Each force is that of the elastic contact, `F = K d^alpha`. The energy
//! `F S F / 2 + V(g - S F)` is convex in `F`. Its one minimum is the equilibrium. Newton's method finds it, with steps that end
//! near the least energy along them: where one point opens, a whole step may press another ten thousand times too far.

use super::ContactLaw;
use super::solver::eliminate;

/// Newton steps; 3 to 8 are needed, up to 15 without an estimate.
const MAX_STEPS: usize = 40;
/// Trials of the length of a step, and the share of the slope at its start that may be left at its end. *Converged*: of pairs whose
/// mounts yield a million times as far as their rims, all are found with these.
const MAX_TRIALS: usize = 30;
const SLOPE_LEFT: f64 = 0.5;
/// Largest error and largest last change of a force, relative to the largest force.
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
        if size(&right) <= FOUND * largest {
            break;
        }
        let change = eliminate(&mut matrix, &mut right, N);
        let moved: [f64; N] = std::array::from_fn(|i| product(&compliances[i], &change));
        let share = step_length(law, [forces, &change], [&d, &moved]);
        forces.iter_mut().zip(&change).for_each(|(force, change)| *force += share * change);
        // Where mounts yield a million times as far as rims, compressions and so the law's forces have lost as many digits.
        if size(&change) <= FOUND * size(forces) {
            break;
        }
    }
    // The force of an open contact is exactly zero.
    let d = compressions(compliances, overlap, forces);
    forces.iter_mut().zip(d).for_each(|(force, d)| *force = if d > 0.0 { force.max(0.0) } else { 0.0 });
}

fn size<const N: usize>(forces: &[f64; N]) -> f64 {
    forces.iter().fold(0.0, |most, force| most.max(force.abs()))
}

/// How much of a step to take. The energy is convex along it, so that its slope only rises; the whole is taken if the slope
/// does not rise above zero by more than a share, otherwise the place where it is about zero.
fn step_length<const N: usize>(
    law: &ContactLaw,
    [forces, change]: [&[f64; N]; 2],
    [d, moved]: [&[f64; N]; 2],
) -> f64 {
    let slope = |share: f64| -> f64 {
        let at =
            |i: usize| moved[i] * (forces[i] + share * change[i] - law.elastic(d[i] - share * moved[i]).0);
        (0..N).map(at).sum()
    };
    let least = SLOPE_LEFT * slope(0.0).abs();
    let (mut low, mut high, mut share) = (0.0, 1.0, 1.0);
    for _ in 0..MAX_TRIALS {
        let here = slope(share);
        if here.abs() <= least || (here < 0.0 && share == 1.0) {
            break;
        }
        *(if here < 0.0 { &mut low } else { &mut high }) = share;
        // Far too long steps are common, so the length is halved by its order of magnitude first.
        share = if low > 0.0 { 0.5 * (low + high) } else { 0.25 * high };
    }
    share
}

fn product<const N: usize>(row: &[f64; N], forces: &[f64; N]) -> f64 {
    row.iter().zip(forces).map(|(compliance, force)| compliance * force).sum()
}

/// `g - S F`, m.
pub fn compressions<const N: usize>(
    compliances: &[[f64; N]; N],
    overlap: &[f64; N],
    forces: &[f64; N],
) -> [f64; N] {
    std::array::from_fn(|i| overlap[i] - product(&compliances[i], forces))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Material, Tip};

    const N: usize = 16;

    /// Rims of two plates on soft mounts: a heave and two tilts that yield by so much (m/N), and shells that hardly do.
    fn pair(heave: f64, tilt: f64, shell: f64) -> [[f64; N]; N] {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / N as f64;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let apart = angle(i) - angle(j);
                let shells: f64 = (2..=8).map(|n| (f64::from(n) * apart).cos() / f64::from(n * n)).sum();
                heave + 4.0 * tilt * apart.cos() + shell * shells
            })
        })
    }

    #[test]
    fn forces_are_found_however_much_softer_mounts_are_than_rims_and_from_any_estimate() {
        let law =
            ContactLaw::new(&Tip::Solid { material: Material::BRONZE, radius: 2e-3 }, &Material::BRONZE, 0.5);
        let mut random = fastrand::Rng::with_seed(1);
        for trial in 0..400 {
            let soft = |random: &mut fastrand::Rng| 10.0_f64.powf(-5.0 + 5.0 * random.f64());
            let compliances = pair(soft(&mut random), soft(&mut random), 1e-5 * random.f64());
            let warp = 3e-3 * random.f64();
            let overlap = |random: &mut fastrand::Rng, y: f64| -> [f64; N] {
                std::array::from_fn(|_| y + warp * (2.0 * random.f64() - 1.0))
            };
            let mean = 6e-3 * random.f64();
            let at = overlap(&mut random, mean);
            let mut forces = [0.0; N];
            // Estimates: none, that of another place, one that is far off.
            match trial % 3 {
                1 => settle(&law, &compliances, &overlap(&mut random, 2e-3), &mut forces),
                2 => forces = std::array::from_fn(|_| 50.0 * random.f64()),
                _ => {}
            }
            settle(&law, &compliances, &at, &mut forces);
            let d = compressions(&compliances, &at, &forces);
            let largest = size(&forces);
            for (d, force) in d.iter().zip(&forces) {
                let held = law.elastic(*d).0;
                let off = (held - force).abs();
                assert!(off <= 1e-6 * largest, "trial {trial}: {force} N, {held} N of {largest} N");
            }
        }
    }
}
