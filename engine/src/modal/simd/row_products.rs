//! Products of a sparse matrix whose rows are runs of coefficients, with one vector or with several at once.
//!
//! Neighbouring rows lie over nearly the same columns. Some are taken together over all columns that any of them has, so that what is
//! read of a vector serves all of them: reading is what limits these products.

use std::ops::Range;

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES};
use crate::modal::row::{Row, zero_row};

/// Rows taken together. *Measured*: with AVX2, where reads limit, four take 0.6 of the time of one by one.
const TOGETHER: usize = 4;

/// Most sums at once that 16 registers hold beside what they are made of.
const SUMS: usize = 12;

/// Rows of coefficients, taken together and filled up with zeros to whole registers.
pub struct RowProducts {
    groups: Vec<Group>,
    /// `[group][register of 16 columns][row of the group][lane]`.
    coefs: Row,
    /// Values that a product reads and writes, without padding.
    rows: usize,
    columns: usize,
}

/// Rows taken together.
#[derive(Debug, Clone, Copy)]
struct Group {
    /// The column they begin at, a multiple of [`LANES`], and how many they span in multiples of it.
    first: usize,
    lanes: usize,
    /// Where their coefficients begin.
    start: usize,
}

impl RowProducts {
    /// From each row's first column and coefficients (dimensionless), of `columns` columns. Allocates.
    pub fn new(rows: &[(usize, Vec<f64>)], columns: usize) -> RowProducts {
        let (mut groups, mut start) = (Vec::new(), 0);
        for together in rows.chunks(TOGETHER) {
            let runs = together.iter().filter(|(_, coefs)| !coefs.is_empty());
            let spans = runs.map(|(first, coefs)| (*first, first + coefs.len()));
            let (low, high) = spans.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0, 0));
            let first = low / LANES * LANES;
            let lanes = (high - first).div_ceil(LANES);
            groups.push(Group { first, lanes, start });
            start += lanes * LANES * TOGETHER;
        }
        let mut table = zero_row(start);
        for (together, group) in rows.chunks(TOGETHER).zip(&groups) {
            for (row, (first, coefs)) in together.iter().enumerate() {
                for (column, coef) in (first.saturating_sub(group.first)..).zip(coefs) {
                    let (register, lane) = (column / LANES, column % LANES);
                    table[group.start + (register * TOGETHER + row) * LANES + lane] = *coef as f32;
                }
            }
        }
        RowProducts { groups, coefs: table, rows: rows.len(), columns }
    }

    /// Parts into which [`Kernels::some_row_products`] can be divided.
    pub fn parts(&self) -> usize {
        self.groups.len()
    }
}

/// Products with one vector.
struct Product<'a> {
    matrix: &'a RowProducts,
    x: &'a [f32],
    out: &'a mut [f32],
}

/// Products of some groups of rows with several vectors.
struct Products<'a, const N: usize> {
    matrix: &'a RowProducts,
    groups: Range<usize>,
    x: [&'a [f32]; N],
    out: [&'a mut [f32]; N],
}

impl Kernels {
    /// `out <- matrix x`, as many as `out` has; `x` is as long as the matrix has columns, rounded up to [`LANES`].
    ///
    /// # Panics
    /// If `x` is too short.
    pub fn row_products(&self, matrix: &RowProducts, x: &[f32], out: &mut [f32]) {
        let rows = matrix.rows.min(out.len());
        let (x, out) = (&x[..matrix.columns.next_multiple_of(LANES)], &mut out[..rows]);
        self.run(Product { matrix, x, out });
    }

    /// Some [parts](RowProducts::parts) of the products with several vectors, each as [`row_products`](Self::row_products).
    ///
    /// # Panics
    /// If a vector is too short, or if there are no such parts.
    pub fn some_row_products<const N: usize>(
        &self,
        matrix: &RowProducts,
        parts: Range<usize>,
        x: [&[f32]; N],
        out: [&mut [f32]; N],
    ) {
        let x = x.map(|x| &x[..matrix.columns.next_multiple_of(LANES)]);
        let out = out.map(|out| &mut out[..matrix.rows]);
        self.run(Products { matrix, groups: parts, x, out });
    }
}

impl Kernel for Product<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let per = LANES / S::F32_LANES;
        for (group, out) in self.matrix.groups.iter().zip(self.out.chunks_mut(TOGETHER)) {
            let Group { first, lanes, start } = *group;
            let coefs = S::as_simd_f32s(&self.matrix.coefs[start..][..lanes * LANES * TOGETHER]).0;
            let x = S::as_simd_f32s(&self.x[first..][..lanes * LANES]).0;
            // Two sums a row where registers are narrower, which hide each other's latency.
            let mut sums = [[simd.splat_f32s(0.0); 2]; TOGETHER];
            for (coefs, x) in coefs.chunks_exact(TOGETHER * per).zip(x.chunks_exact(per)) {
                for (row, sums) in coefs.chunks_exact(per).zip(&mut sums) {
                    for v in 0..per {
                        sums[v % 2] = fma(row[v], x[v], sums[v % 2]);
                    }
                }
            }
            for (out, sums) in out.iter_mut().zip(sums) {
                *out = simd.reduce_sum_f32s(simd.add_f32s(sums[0], sums[1]));
            }
        }
    }
}

impl<const N: usize> Kernel for Products<'_, N> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Products { matrix, groups, x, mut out } = self;
        let first_row = groups.start * TOGETHER;
        for (i, &Group { first, lanes, start }) in matrix.groups[groups].iter().enumerate() {
            let coefs = S::as_simd_f32s(&matrix.coefs[start..][..lanes * LANES * TOGETHER]).0;
            let x = x.map(
                #[inline(always)]
                |x| S::as_simd_f32s(&x[first..][..lanes * LANES]).0,
            );
            let at = first_row + i * TOGETHER;
            let mut row = 0;
            while row < TOGETHER {
                row += if 2 * N <= SUMS {
                    some_rows::<S, N, 2>(simd, fma, (coefs, row), &x, (&mut out, at))
                } else {
                    some_rows::<S, N, 1>(simd, fma, (coefs, row), &x, (&mut out, at))
                };
            }
        }
    }
}

/// Products of `R` rows of a group from one on with `N` vectors, into rows from `at` on; returns `R`.
#[inline(always)]
fn some_rows<S: Simd, const N: usize, const R: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    (coefs, first): (&[S::f32s], usize),
    x: &[&[S::f32s]; N],
    (out, at): (&mut [&mut [f32]; N], usize),
) -> usize {
    let per = LANES / S::F32_LANES;
    let mut sums = [[simd.splat_f32s(0.0); N]; R];
    for (register, coefs) in coefs.chunks_exact(TOGETHER * per).enumerate() {
        for v in 0..per {
            for n in 0..N {
                let x = x[n][register * per + v];
                for r in 0..R {
                    sums[r][n] = fma(coefs[(first + r) * per + v], x, sums[r][n]);
                }
            }
        }
    }
    for (r, sums) in sums.into_iter().enumerate() {
        for (out, sum) in out.iter_mut().zip(sums) {
            if let Some(out) = out.get_mut(at + first + r) {
                *out = simd.reduce_sum_f32s(sum);
            }
        }
    }
    R
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_is_the_sum_of_its_products_with_one_vector_and_with_several() {
        let columns = 70;
        let coef = |i: usize| ((i * 37 + 11) % 64) as f64 / 32.0 - 1.0;
        let rows: Vec<(usize, Vec<f64>)> = (0..columns)
            .map(|row| {
                let (first, length) = (row * 7 % columns, row * 13 % 40);
                (first, (0..length.min(columns - first)).map(|i| coef(row + i)).collect())
            })
            .collect();
        let x: [Row; 8] = std::array::from_fn(|n| {
            let mut x = zero_row(columns);
            (0..columns).for_each(|i| x[i] = coef(3 * i + n) as f32);
            x
        });
        let matrix = RowProducts::new(&rows, columns);
        let half = matrix.parts() / 2;
        for kernels in [Kernels::baseline(), Kernels::detect()] {
            let mut one = vec![f32::NAN; columns];
            kernels.row_products(&matrix, &x[0], &mut one);
            let mut six = vec![vec![f32::NAN; columns]; 6];
            let mut eight = vec![vec![f32::NAN; columns]; 8];
            for parts in [half..matrix.parts(), 0..half] {
                fn slices<const N: usize>(rows: &mut [Vec<f32>]) -> [&mut [f32]; N] {
                    let mut rows = rows.iter_mut();
                    std::array::from_fn(|_| rows.next().map_or(&mut [][..], |row| &mut row[..]))
                }
                let first_six = std::array::from_fn(|n| &x[n][..]);
                kernels.some_row_products::<6>(&matrix, parts.clone(), first_six, slices(&mut six));
                kernels.some_row_products::<8>(
                    &matrix,
                    parts,
                    x.each_ref().map(|x| &x[..]),
                    slices(&mut eight),
                );
            }
            for (row, (first, coefs)) in rows.iter().enumerate() {
                for (n, x) in x.iter().enumerate() {
                    let sum: f64 = coefs.iter().zip(&x[*first..]).map(|(a, b)| a * f64::from(*b)).sum();
                    let of_six = six.get(n).map(|out| out[row]);
                    let outs = [(n == 0).then_some(one[row]), of_six, Some(eight[n][row])];
                    for out in outs.into_iter().flatten() {
                        assert!((f64::from(out) - sum).abs() < 1e-5, "{}: {out} {sum}", kernels.name());
                    }
                }
            }
        }
    }
}
