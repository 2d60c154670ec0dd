//! The modes of a body that is not quite even, as rotations of the even ones.
//!
//! Scheme: with the even modes as coordinates (unit modal mass), what makes the body uneven adds couplings to the stiffness.
//! The even modes are taken in order of frequency in blocks of 128, and the eigenproblem of each block is solved; then once more in blocks
//! that lie half a block further. Both passes are rotations, so no energy is gained, and what remains between modes is weaker
//! than their distance.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::math::eigen;

/// Modes in a block.
pub const BLOCK: usize = 128;

/// What is left out of a mixed mode: coefficients at its ends whose squares sum to this. *Converged*: at most a
/// thousandth of a mode's energy.
const LEFT_OUT: f64 = 1e-3;

/// A mixed mode's coefficients (dimensionless) over the even modes from a first one on.
pub type MixedRow = (usize, Vec<f64>);

/// The mixed modes' angular frequencies (rad/s), ascending, and their coefficients; `omegas` are those of the even modes
/// (rad/s), and `couplings` gives what is added to the stiffness among a range of them, 1/s2.
pub fn solve(omegas: &[f64], couplings: impl Fn(Range<usize>) -> DMatrix<f64>) -> (Vec<f64>, Vec<MixedRow>) {
    let count = omegas.len();
    let mut squares: Vec<f64> = omegas.iter().map(|omega| omega * omega).collect();
    let mut rows: Vec<MixedRow> = (0..count).map(|i| (i, vec![1.0])).collect();
    for offset in [0, BLOCK / 2] {
        for start in (offset..count).step_by(BLOCK) {
            let block = start..(start + BLOCK).min(count);
            let of = block.clone();
            let low = rows[of.clone()].iter().map(|row| row.0).min().unwrap_or(start);
            let high = rows[of].iter().map(|row| row.0 + row.1.len()).max().unwrap_or(block.end);
            let mut stiffness = couplings(low..high);
            for (i, omega) in omegas[low..high].iter().enumerate() {
                stiffness[(i, i)] += omega * omega;
            }
            rotate(low, stiffness, &mut squares[block.clone()], &mut rows[block]);
        }
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| squares[a].total_cmp(&squares[b]));
    let omegas = order.iter().map(|&i| squares[i].max(0.0).sqrt()).collect();
    let rows = order.iter().map(|&i| trimmed(&rows[i])).collect();
    (omegas, rows)
}

/// Solves one block in terms of what its modes are by now; `stiffness` is that of the even modes from `low` on.
fn rotate(low: usize, stiffness: DMatrix<f64>, squares: &mut [f64], rows: &mut [MixedRow]) {
    let mut basis = DMatrix::zeros(stiffness.nrows(), rows.len());
    for (column, (first, row)) in rows.iter().enumerate() {
        for (i, coef) in row.iter().enumerate() {
            basis[(first - low + i, column)] = *coef;
        }
    }
    let solved = eigen::symmetric(basis.transpose() * stiffness * &basis);
    let vectors = basis * &solved.vectors;
    for (k, (square, row)) in squares.iter_mut().zip(rows).enumerate() {
        *square = solved.values[k];
        *row = (low, vectors.column(k).iter().copied().collect());
    }
}

/// What is added to the stiffness among some modes, 1/s2: `coupling` of two of them and of what their pairs have `shared`. The members of a
/// pair stand next to each other mostly, and what two pairs share is worked out once for all four.
pub fn among<T: Copy>(
    modes: Range<usize>,
    pair_of: impl Fn(usize) -> usize,
    shared: impl Fn(usize, usize) -> T,
    coupling: impl Fn(usize, usize, &T) -> f64,
) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(modes.len(), modes.len());
    let follows_its_twin = |k: usize| k > modes.start && pair_of(k) == pair_of(k - 1);
    // Of the pair of mode `i` with those of all modes up to it.
    let mut row: Vec<T> = Vec::with_capacity(modes.len());
    for (at, i) in modes.clone().enumerate() {
        if !follows_its_twin(i) {
            row.clear();
        }
        for j in modes.start + row.len()..=i {
            let twin = row.last().copied().filter(|_| follows_its_twin(j));
            row.push(twin.unwrap_or_else(|| shared(i, j)));
        }
        for (to, (j, shared)) in (modes.start..=i).zip(&row).enumerate() {
            let coupling = coupling(i, j, shared);
            matrix[(at, to)] = coupling;
            matrix[(to, at)] = coupling;
        }
    }
    matrix
}

/// Means around the circle of two shapes `a cos(m theta) + b sin(m theta)` with `cos(l theta)` and `sin(l theta)`, for the
/// `l` for which they are not zero.
pub fn around((m, a): (u32, [f64; 2]), (n, b): (u32, [f64; 2])) -> impl Iterator<Item = (u32, [f64; 2])> {
    let together = a[0] * b[0] + a[1] * b[1];
    let apart = a[0] * b[0] - a[1] * b[1];
    // sin(m) cos(n) and cos(m) sin(n).
    let (up, down) = (a[1] * b[0], a[0] * b[1]);
    let difference = if m == n {
        [if m == 0 { together } else { 0.5 * together }, 0.0]
    } else {
        let sign = if m > n { 0.25 } else { -0.25 };
        [0.25 * together, sign * (up - down)]
    };
    let sum = if m + n == 0 { [0.0; 2] } else { [0.25 * apart, 0.25 * (up + down)] };
    [(m.abs_diff(n), difference), (m + n, sum)].into_iter()
}

/// A row without the weak coefficients at its ends, and again of unit length.
fn trimmed((first, row): &(usize, Vec<f64>)) -> (usize, Vec<f64>) {
    let cut = |from_end: bool| {
        let mut sum = 0.0;
        let squares = row.iter().map(|coef| coef * coef);
        let weak = |square: f64, sum: &mut f64| {
            *sum += square;
            *sum <= 0.5 * LEFT_OUT
        };
        if from_end {
            squares.rev().take_while(|&square| weak(square, &mut sum)).count()
        } else {
            squares.take_while(|&square| weak(square, &mut sum)).count()
        }
    };
    let (head, tail) = (cut(false), cut(true));
    let kept = &row[head..row.len() - tail];
    let length = kept.iter().map(|coef| coef * coef).sum::<f64>().sqrt();
    (first + head, kept.iter().map(|coef| coef / length).collect())
}

/// For each row (dimensionless coefficients) the index of the even mode it is most of, no two the same.
pub fn named(rows: &[(usize, Vec<f64>)]) -> Vec<usize> {
    let mut claims: Vec<(f64, usize, usize)> = Vec::new();
    for (k, (first, row)) in rows.iter().enumerate() {
        claims.extend(row.iter().enumerate().map(|(i, coef)| (coef * coef, k, first + i)));
    }
    claims.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let (mut names, mut taken) = (vec![None; rows.len()], vec![false; rows.len()]);
    for (_, k, part) in claims {
        if names[k].is_none() && !taken[part] {
            names[k] = Some(part);
            taken[part] = true;
        }
    }
    let mut free = (0..rows.len()).filter(|&part| !taken[part]).collect::<Vec<_>>().into_iter();
    names.into_iter().map(|name| name.or_else(|| free.next()).unwrap_or(0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_far_apart_stay_and_modes_that_meet_are_mixed() {
        // Ten pairs of modes: of each pair the second is 1e-3 higher, and coupled with the first by as much.
        let omegas: Vec<f64> =
            (0..20).map(|i| 1e3 * (1 + i / 2) as f64 * (1.0 + 1e-3 * f64::from(i % 2))).collect();
        let couplings = |modes: Range<usize>| {
            let of = |i: usize, j: usize| {
                let pair = i / 2 == j / 2 && i != j;
                if pair { 1e-3 * omegas[i] * omegas[j] } else { 0.0 }
            };
            DMatrix::from_fn(modes.len(), modes.len(), |i, j| of(modes.start + i, modes.start + j))
        };
        let (mixed, rows) = solve(&omegas, couplings);
        for (k, (first, row)) in rows.iter().enumerate() {
            assert_eq!((*first, row.len()), (k - k % 2, 2), "mode {k}");
            // Of [[1, c], [c, 1 + 2 e]] with c = e: tan of twice the angle is 1.
            let larger = row[0].abs().max(row[1].abs());
            assert!((larger - std::f64::consts::FRAC_PI_8.cos()).abs() < 1e-3, "mode {k}: {row:?}");
            let center = 1e3 * (1 + k / 2) as f64;
            let shift = (mixed[k] / center).powi(2) - 1.0;
            let want = 1e-3 * (1.0 + 2.0_f64.sqrt() * if k % 2 == 0 { -1.0 } else { 1.0 });
            assert!((shift - want).abs() < 1e-5, "mode {k}: {shift} {want}");
        }
        assert_eq!(named(&rows), (0..20).collect::<Vec<_>>());
    }

    #[test]
    fn what_two_pairs_share_is_worked_out_once_for_the_twins_that_stand_together() {
        // Pairs 3, 3, 5, 4, 4, 5: the last twin stands apart.
        let pairs = [3, 3, 5, 4, 4, 5];
        let worked_out = std::cell::Cell::new(0);
        let shared = |i: usize, j: usize| {
            worked_out.set(worked_out.get() + 1);
            pairs[i] * pairs[j]
        };
        let matrix = among(0..6, |k| pairs[k], shared, |i, j, product| (product * (i + 1) * (j + 1)) as f64);
        for (i, one) in pairs.iter().enumerate() {
            for (j, other) in pairs.iter().enumerate() {
                assert_eq!(matrix[(i, j)], (one * other * (i + 1) * (j + 1)) as f64, "{i} {j}");
            }
        }
        // Of four runs of twins each with itself and those before it.
        assert_eq!(worked_out.get(), 10);
        assert_eq!(among(2..5, |k| pairs[k], shared, |_, _, product| *product as f64)[(2, 0)], 20.0);
    }
}
