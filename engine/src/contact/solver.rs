//! Several contacts at once: their forces move each other's bodies and are found together.
//!
//! With `Y` the compliances between the points and `f` where each compression would be without any force, the
//! compressions after the sample obey `d_i + sum_j Y_ij F_j(d_j) = f_i`, each force growing with its own
//! compression. Newton's method on all of them takes a few steps, as `1 + Y F'` is never singular (`Y` is positive); where
//! it should wander, at the corner where a contact opens, sweeps over single contacts do it (Gauss-Seidel: they
//! converge because a place yields more to its own force than to another's).
//!
//! Three forms find the same forces: [`solve`] of any law, one contact after the other; [`hertz`] and [`uniform`] of
//! Hertz's law, in the lanes of registers, the one with a law for each contact, the other with one law for all and
//! a nonlinear force. Tests hold the law and the forces of each against the general one. They round differently.

pub mod hertz;
pub mod uniform;

use super::{ContactLaw, ContactStep};

/// Contacts of one surface that can be solved together.
pub const MAX_CONTACTS: usize = 16;

/// Newton steps before the sweeps are asked; it needs 2 or 3.
const MAX_STEPS: usize = 12;

/// Change of a compression, relative, in the last Newton step: what it leaves is the square of that. *Measured*:
/// the forces are those of the sweeps within 1e-9 of the largest.
const LAST_STEP: f64 = 1e-6;

/// Sweeps; they stop as soon as nothing changes.
const MAX_SWEEPS: usize = 40;

/// Change of a force, relative, below which the sweeps have found it.
const SETTLED: f64 = 1e-10;

/// One contact.
#[derive(Debug, Clone, Copy)]
pub struct ContactProblem {
    /// Its law.
    pub law: ContactLaw,
    /// Its sample, all other forces left out.
    pub step: ContactStep,
    /// Its force, N: a guess first, then what was found.
    pub force: f64,
}

/// Compliance between contacts, m/N; the diagonal is each step's own.
pub type Compliances<const N: usize = MAX_CONTACTS> = [[f64; N]; N];

/// Finds all forces.
///
/// # Real-time
/// At most 12 steps of the order of the cube of the contacts, then at most 40 sweeps; usually 3 steps.
#[inline(always)] // So that a caller may run it in all lanes.
pub fn solve<const N: usize>(problems: &mut [ContactProblem], compliances: &Compliances<N>) {
    match problems {
        [] => {}
        [one] => one.force = one.law.force(&one.step),
        several => {
            if !newton(several, compliances) {
                sweep(several, compliances);
            }
        }
    }
}

#[inline(always)]
fn newton<const N: usize>(problems: &mut [ContactProblem], compliances: &Compliances<N>) -> bool {
    let n = problems.len();
    let compliance = |problems: &[ContactProblem], i: usize, j: usize| {
        if i == j { problems[i].step.compliance } else { compliances[i][j] }
    };
    let (mut d, mut held, mut forces, mut slopes) = ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
    for i in 0..n {
        held[i] = problems[i].law.potential(problems[i].step.before);
        let moved: f64 = (0..n).map(|j| compliance(problems, i, j) * problems[j].force).sum();
        d[i] = problems[i].step.free - moved;
    }
    for _ in 0..MAX_STEPS {
        // Contacts that are open neither push nor are in the way: they follow from the closed ones.
        let (mut closed, mut count) = ([0; N], 0);
        for i in 0..n {
            (forces[i], slopes[i]) = problems[i].law.gradient(&problems[i].step, held[i], d[i]);
            if forces[i] != 0.0 || slopes[i] != 0.0 {
                closed[count] = i;
                count += 1;
            }
        }
        let closed = &closed[..count];
        // (1 + Y F') change = free - d - Y F
        let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
        for ((row, right), &i) in matrix.iter_mut().zip(&mut right).zip(closed) {
            let mut left = problems[i].step.free - d[i];
            for (entry, &j) in row.iter_mut().zip(closed) {
                let c = compliance(problems, i, j);
                left -= c * forces[j];
                *entry = c * slopes[j];
            }
            *right = left;
        }
        for (k, row) in matrix[..count].iter_mut().enumerate() {
            row[k] += 1.0;
        }
        let change = eliminate(&mut matrix, &mut right, count);
        for (&i, change) in closed.iter().zip(change) {
            forces[i] += slopes[i] * change;
        }
        let mut settled = true;
        for i in 0..n {
            let moved: f64 = closed.iter().map(|&j| compliance(problems, i, j) * forces[j]).sum();
            let found = problems[i].step.free - moved;
            let scale = problems[i].step.before.abs().max(problems[i].step.free.abs());
            settled &= (found - d[i]).abs() <= LAST_STEP * scale;
            d[i] = found;
        }
        if settled {
            problems.iter_mut().zip(forces).for_each(|(problem, force)| problem.force = force.max(0.0));
            return true;
        }
    }
    false
}

/// A symmetric matrix times a vector.
#[inline(always)]
pub(crate) fn product<const N: usize>(matrix: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    // By columns, which are rows: the sums run side by side.
    for (row, x) in matrix.iter().zip(x) {
        for (sum, y) in sum.iter_mut().zip(row) {
            *sum += y * x;
        }
    }
    sum
}

/// Solves a system of `n` equations. Without pivots: `1 + Y F'` is, but for a scaling, symmetric and positive.
#[inline(always)]
pub(crate) fn eliminate<const N: usize>(
    matrix: &mut [[f64; N]; N],
    right: &mut [f64; N],
    n: usize,
) -> [f64; N] {
    for k in 0..n {
        let (pivot, known) = (matrix[k], right[k]);
        for (row, right) in matrix[k + 1..n].iter_mut().zip(&mut right[k + 1..n]) {
            let factor = row[k] / pivot[k];
            if factor != 0.0 {
                row[k + 1..n].iter_mut().zip(&pivot[k + 1..n]).for_each(|(x, p)| *x -= factor * p);
                *right -= factor * known;
            }
        }
    }
    let mut solution = [0.0; N];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k][j] * solution[j]).sum();
        solution[k] = (right[k] - known) / matrix[k][k];
    }
    solution
}

fn sweep<const N: usize>(problems: &mut [ContactProblem], compliances: &Compliances<N>) {
    for _ in 0..MAX_SWEEPS {
        let mut changed = false;
        for i in 0..problems.len() {
            let others = (0..problems.len()).filter(|&j| j != i);
            let moved: f64 = others.map(|j| compliances[i][j] * problems[j].force).sum();
            let ContactProblem { law, step, force } = problems[i];
            let found = law.force(&ContactStep { free: step.free - moved, ..step });
            changed |= (found - force).abs() > SETTLED * found;
            problems[i].force = found;
        }
        if !changed {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Material, Tip};

    #[test]
    fn newton_finds_what_the_sweeps_find() {
        let tip = Tip::Solid { material: Material::STEEL, radius: 0.8e-3 };
        let law = ContactLaw::new(&tip, &Material::FILM, 0.35);
        let mut draw = 1_u64;
        let mut chance = move || {
            draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (draw >> 11) as f64 / (1_u64 << 53) as f64
        };
        for n in 2..=9 {
            for _ in 0..200 {
                let mutual = 3e-7 * chance();
                let compliances = [[mutual; MAX_CONTACTS]; MAX_CONTACTS];
                let mut problems: Vec<ContactProblem> = (0..n)
                    .map(|_| {
                        let before = 2e-6 * (chance() - 0.3);
                        let step = ContactStep {
                            before,
                            free: before + 4e-6 * (chance() - 0.5),
                            compliance: 3e-6,
                            lambda: 3.0,
                            dt: 2e-5,
                        };
                        ContactProblem { law, step, force: 0.0 }
                    })
                    .collect();
                let mut slow = problems.clone();
                assert!(newton(&mut problems, &compliances), "Newton wandered off");
                sweep(&mut slow, &compliances);
                let largest = slow.iter().map(|problem| problem.force).fold(0.0, f64::max);
                for (fast, slow) in problems.iter().zip(&slow) {
                    assert!(
                        (fast.force - slow.force).abs() <= 1e-9 * largest,
                        "{} {}",
                        fast.force,
                        slow.force
                    );
                }
            }
        }
    }
}
