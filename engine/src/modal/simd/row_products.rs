//! Products of a sparse matrix whose rows are short runs of coefficients.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES};
use crate::modal::row::{Row, zero_row};

/// Runs of coefficients, filled up with zeros to whole registers.
pub struct RowProducts {
    rows: Vec<Run>,
    coefs: Row,
    /// Values that a product reads: a whole number of registers.
    columns: usize,
}

/// The run of a row.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// The column it begins at, and its coefficients in multiples of [`LANES`].
    first: usize,
    lanes: usize,
}

impl RowProducts {
    /// From each row's first column and coefficients (dimensionless), of `columns` columns. Allocates.
    pub fn new(rows: &[(usize, Vec<f64>)], columns: usize) -> RowProducts {
        let columns = columns.next_multiple_of(LANES);
        let runs: Vec<Run> = rows
            .iter()
            .map(|(first, coefs)| {
                let lanes = coefs.len().div_ceil(LANES);
                // No run ends after the last column.
                Run { first: (*first).min(columns - lanes * LANES), lanes }
            })
            .collect();
        let mut table = zero_row(runs.iter().map(|run| run.lanes * LANES).sum());
        let mut at = 0;
        for ((first, coefs), run) in rows.iter().zip(&runs) {
            for (to, from) in table[at + first - run.first..].iter_mut().zip(coefs) {
                *to = *from as f32;
            }
            at += run.lanes * LANES;
        }
        RowProducts { rows: runs, coefs: table, columns }
    }
}

/// A product.
struct Product<'a> {
    matrix: &'a RowProducts,
    x: &'a [f32],
    out: &'a mut [f32],
}

impl Kernels {
    /// `out <- matrix x`; `x` is as long as the matrix has columns, rounded up to [`LANES`].
    pub fn row_products(&self, matrix: &RowProducts, x: &[f32], out: &mut [f32]) {
        self.run(Product { matrix, x: &x[..matrix.columns], out });
    }
}

impl Kernel for Product<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let per = LANES / S::F32_LANES;
        let mut coefs = S::as_simd_f32s(&self.matrix.coefs).0;
        for (out, run) in self.out.iter_mut().zip(&self.matrix.rows) {
            let (row, rest) = coefs.split_at(run.lanes * per);
            coefs = rest;
            let x = S::as_simd_f32s(&self.x[run.first..][..run.lanes * LANES]).0;
            let mut sums = [simd.splat_f32s(0.0); 2];
            let ((row, row_last), (x, x_last)) = (row.as_chunks::<2>(), x.as_chunks::<2>());
            for (row, x) in row.iter().zip(x) {
                sums[0] = fma(row[0], x[0], sums[0]);
                sums[1] = fma(row[1], x[1], sums[1]);
            }
            for (&row, &x) in row_last.iter().zip(x_last) {
                sums[0] = fma(row, x, sums[0]);
            }
            *out = simd.reduce_sum_f32s(simd.add_f32s(sums[0], sums[1]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_is_the_sum_of_its_products() {
        let columns = 70;
        let coef = |i: usize| ((i * 37 + 11) % 64) as f64 / 32.0 - 1.0;
        let rows: Vec<(usize, Vec<f64>)> = (0..columns)
            .map(|row| {
                let (first, length) = (row * 7 % columns, row * 13 % 40);
                (first, (0..length.min(columns - first)).map(|i| coef(row + i)).collect())
            })
            .collect();
        let mut x = zero_row(columns);
        (0..columns).for_each(|i| x[i] = coef(3 * i) as f32);
        for kernels in [Kernels::baseline(), Kernels::detect()] {
            let mut out = vec![f32::NAN; columns];
            kernels.row_products(&RowProducts::new(&rows, columns), &x, &mut out);
            for (out, (first, coefs)) in out.iter().zip(&rows) {
                let sum: f64 = coefs.iter().zip(&x[*first..]).map(|(a, b)| a * f64::from(*b)).sum();
                assert!((f64::from(*out) - sum).abs() < 1e-5, "{}: {out} {sum}", kernels.name());
            }
        }
    }
}
