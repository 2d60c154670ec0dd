//! The forces of one sample's contacts, found together: each moves the bodies of all others.
//!
//! With `Y` the compliances between the points and `f` where each compression would be without any force, the
//! compressions after the sample obey `d_i + sum_j Y_ij F_j(d_j) = f_i`, each force growing with its own
//! compression. Newton's method takes three to five steps. `1 + Y F'` is never singular, as `Y` is positive.
//!
//! If all contacts follow Hertz's law, each step solves its linear system by two sweeps of Jacobi's method, in all lanes at
//! once. A point yields more to its own force than to all others, by three to five times under snare wires and by twenty-five
//! around a hi-hat's rim, so a step leaves about a fiftieth of the error at most. Where contacts are closer to each other, and if that does
//! not converge, further steps use elimination, as all steps for other laws do. If Newton's method does not converge, as may happen where a contact opens,
//! single contacts are solved in turn (Gauss-Seidel), each between bounds.

use super::force::ContactLanes;
use super::{ContactLaw, ContactStep};
use crate::modal::simd::Kernels;

/// Contacts of one surface that can be solved together.
pub const MAX_CONTACTS: usize = 16;

/// Newton steps by Jacobi's method, and by elimination; 3 to 5 are needed.
const MAX_STEPS: usize = 12;

/// Most sweeps of Jacobi's method in each step.
const JACOBI_SWEEPS: usize = 2;

/// Change by a sweep, relative, after which none is needed: the next one would change a fiftieth.
const SWEPT: f64 = 0.14;

/// Change by the last sweep, relative, above which contacts are too close to each other for the method.
const MOST_MOVED: f64 = 0.4;

/// Change of a compression, relative, in the last step. A fiftieth of it is left, less than the rounding of the forces that
/// modes receive.
const LAST_STEP: f64 = 1e-8;

/// Sweeps over single contacts; they stop as soon as nothing changes.
const MAX_SWEEPS: usize = 40;

/// Change of a force, relative, below which the sweeps have found it.
const SETTLED: f64 = 1e-10;

/// Iterations for one contact between bounds; Newton needs 3 to 6, halving alone would need 50.
const MAX_ITERATIONS: usize = 60;

/// Compliance between contacts, `[contact][contact]`, symmetric, m/N.
pub type Compliances<const N: usize = MAX_CONTACTS> = [[f64; N]; N];

/// Finds all forces; they replace the estimates in `lanes`.
///
/// # Real-time
/// At most 12 steps of the order of the square of the contacts, 12 of that of the cube, and 40 sweeps; usually 4 steps.
pub fn solve<const N: usize>(kernels: Kernels, lanes: &mut ContactLanes<N>, compliances: &Compliances<N>) {
    let solved = if lanes.all_hertz() {
        kernels.vectorized(
            #[inline(always)]
            || newton::<N, true>(lanes, compliances),
        )
    } else {
        newton::<N, false>(lanes, compliances)
    };
    if !solved {
        sweep(lanes, compliances);
    }
}

/// The force of a single contact, N.
pub fn force(law: &ContactLaw, step: &ContactStep) -> f64 {
    let mut lanes = ContactLanes::<1>::APART;
    lanes.set(0, law, step, 0.0);
    solve(Kernels::baseline(), &mut lanes, &[[step.compliance]]);
    lanes.force[0]
}

/// Newton's method; whether it converged.
#[inline(always)]
fn newton<const N: usize, const ALL_HERTZ: bool>(
    lanes: &mut ContactLanes<N>,
    compliances: &Compliances<N>,
) -> bool {
    let roots = lanes.roots();
    let mut own = [0.0; N];
    for i in 0..N {
        own[i] = compliances[i][i];
    }
    let mut d = less(&lanes.free, &product(compliances, &lanes.force));
    let mut by_jacobi = if ALL_HERTZ { MAX_STEPS } else { 0 };
    for step in 0..by_jacobi + MAX_STEPS {
        let (force, slope) = lanes.gradient::<ALL_HERTZ>(&roots, &d);
        let moved = less(&lanes.free, &product(compliances, &force));
        let left = less(&moved, &d);
        let change = if step < by_jacobi {
            let (change, converges) = jacobi(compliances, &own, &slope, &left);
            if !converges {
                by_jacobi = 0;
            }
            change
        } else {
            eliminated(compliances, &slope, left)
        };
        let added = times(&slope, &change);
        for i in 0..N {
            lanes.force[i] = force[i] + added[i];
        }
        let found = less(&moved, &product(compliances, &added));
        // NaN does not count as settled. The bodies alone may agree while the law does not, where a change is far from the solution.
        let mut settled = true;
        for i in 0..N {
            let scale = LAST_STEP * lanes.before[i].abs().max(lanes.free[i].abs());
            settled &= (found[i] - d[i]).abs() <= scale && change[i].abs() <= 2.0 * scale;
        }
        d = found;
        if settled {
            lanes.force.iter_mut().for_each(|force| *force = force.max(0.0));
            return true;
        }
    }
    false
}

/// Nearly the solution of `(1 + Y F') change = left`, and whether contacts are far enough from each other for it; `own` is the diagonal of `Y`.
#[inline(always)]
fn jacobi<const N: usize>(
    compliances: &Compliances<N>,
    own: &[f64; N],
    slope: &[f64; N],
    left: &[f64; N],
) -> ([f64; N], bool) {
    let own = times(own, slope);
    let mut alone = [0.0; N];
    for i in 0..N {
        alone[i] = 1.0 / (1.0 + own[i]);
    }
    let mut change = times(left, &alone);
    let mut converges = true;
    if N > 1 {
        for _ in 0..JACOBI_SWEEPS {
            let others = less(&product(compliances, &times(slope, &change)), &times(&own, &change));
            let next = times(&less(left, &others), &alone);
            let (whole, moved) = (sizes(&next), sizes(&less(&next, &change)));
            change = next;
            // A sweep moves the change by less than the one before by the ratio in which it moved the first one.
            converges = moved <= MOST_MOVED * whole;
            if moved <= SWEPT * whole {
                break;
            }
        }
    }
    (change, converges)
}

/// The solution of `(1 + Y F') change = left`.
fn eliminated<const N: usize>(
    compliances: &Compliances<N>,
    slope: &[f64; N],
    mut left: [f64; N],
) -> [f64; N] {
    let mut matrix: Compliances<N> =
        std::array::from_fn(|i| std::array::from_fn(|j| compliances[i][j] * slope[j]));
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += 1.0;
    }
    eliminate(&mut matrix, &mut left, N)
}

/// Solves single contacts in turn until nothing changes.
#[cold]
fn sweep<const N: usize>(lanes: &mut ContactLanes<N>, compliances: &Compliances<N>) {
    // Newton's method may have left anything behind.
    lanes.force = [0.0; N];
    for _ in 0..MAX_SWEEPS {
        let mut changed = false;
        for (i, row) in compliances.iter().enumerate() {
            let others: f64 = (0..N).filter(|&j| j != i).map(|j| row[j] * lanes.force[j]).sum();
            let one = ContactLanes::<1> {
                stiffness: [lanes.stiffness[i]],
                exponent: [lanes.exponent[i]],
                before: [lanes.before[i]],
                free: [lanes.free[i] - others],
                loss: [lanes.loss[i]],
                force: [0.0],
            };
            let found = between_bounds(&one, row[i]);
            changed |= (found - lanes.force[i]).abs() > SETTLED * found;
            lanes.force[i] = found;
        }
        if !changed {
            break;
        }
    }
}

/// The force of a single contact by Newton's method between bounds, which always converges, N.
fn between_bounds(lane: &ContactLanes<1>, compliance: f64) -> f64 {
    let ([before], [free], roots) = (lane.before, lane.free, lane.roots());
    let at = |d: f64| {
        let ([force], [slope]) = lane.gradient::<false>(&roots, &[d]);
        (force, slope)
    };
    let (free_force, _) = at(free);
    if free_force <= 0.0 {
        return 0.0;
    }
    // g(d) = d + C F(d) - free grows strictly; its root lies in [free - C F(free), free].
    let (mut low, mut high) = (free - compliance * free_force, free);
    let tolerance = 1e-15 * before.abs().max(free.abs());
    // Bounds that are not numbers must not end the program, as `clamp` would; the force then is none and the piece is reset.
    let mut d = before.max(low).min(high);
    let mut force = free_force;
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = at(d);
        force = value;
        let g = d + compliance * value - free;
        if g > 0.0 {
            high = d;
        } else {
            low = d;
        }
        let mut next = d - g / (1.0 + compliance * slope);
        if !(low..=high).contains(&next) {
            next = 0.5 * (low + high);
        }
        let moved = (next - d).abs();
        d = next;
        if moved <= tolerance {
            break;
        }
    }
    // From the linear bodies rather than from the law: this keeps `d1 = free - C F` exact, which the energy balance needs.
    if compliance > 0.0 { ((free - d) / compliance).max(0.0) } else { force }
}

/// Values of a product that are summed at once, and columns that are summed apart, so that they hide each other's latency.
const WIDE: usize = 8;
const APART: usize = 4;

/// A symmetric matrix times a vector.
#[inline(always)]
pub(crate) fn product<const N: usize>(matrix: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    if !N.is_multiple_of(WIDE) {
        for (row, x) in matrix.iter().zip(x) {
            for i in 0..N {
                out[i] += row[i] * x;
            }
        }
        return out;
    }
    for (at, out) in out.as_chunks_mut::<WIDE>().0.iter_mut().enumerate() {
        let mut sums = [[0.0; WIDE]; APART];
        // By columns, which are rows.
        for (rows, xs) in matrix.as_chunks::<APART>().0.iter().zip(x.as_chunks::<APART>().0) {
            for k in 0..APART {
                let row = &rows[k].as_chunks::<WIDE>().0[at];
                for i in 0..WIDE {
                    sums[k][i] += row[i] * xs[k];
                }
            }
        }
        for i in 0..WIDE {
            out[i] = (sums[0][i] + sums[1][i]) + (sums[2][i] + sums[3][i]);
        }
    }
    out
}

/// `a - b`. Loops, here as above: closures would be compiled without the machine's instructions.
#[inline(always)]
fn less<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = a[i] - b[i];
    }
    out
}

/// Each of `a` times its partner of `b`.
#[inline(always)]
fn times<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = a[i] * b[i];
    }
    out
}

/// Sum of all, in an order that takes several at once.
#[inline(always)]
pub(crate) fn total<const N: usize>(x: &[f64; N]) -> f64 {
    let mut parts = [0.0; 8];
    for (i, x) in x.iter().enumerate() {
        parts[i % 8] += x;
    }
    ((parts[0] + parts[1]) + (parts[2] + parts[3])) + ((parts[4] + parts[5]) + (parts[6] + parts[7]))
}

/// Sum of all sizes.
#[inline(always)]
fn sizes<const N: usize>(x: &[f64; N]) -> f64 {
    let mut sizes = [0.0; N];
    for i in 0..N {
        sizes[i] = x[i].abs();
    }
    total(&sizes)
}

/// Solves a system of `n` equations. Without pivots: `1 + Y F'` is, but for a scaling, symmetric and positive.
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

#[cfg(test)]
mod tests;
