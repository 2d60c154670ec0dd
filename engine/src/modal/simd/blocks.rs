//! Products with a matrix made of square blocks along its diagonal, most of them twice.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES};

/// One block of a [`BlockProduct`].
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// Where its rows and columns begin.
    pub start: usize,
    /// Number of rows and columns.
    pub size: usize,
    /// Whether it stands for a second one too, of the rows and columns that follow.
    pub twice: bool,
}

impl Block {
    /// Rows of one member, padded.
    pub fn padded(&self) -> usize {
        self.size.div_ceil(LANES) * LANES
    }

    /// Rows it takes in all.
    pub fn rows(&self) -> usize {
        self.padded() * if self.twice { 2 } else { 1 }
    }
}

/// What [`Kernels::blocks`] works on.
pub struct BlockProduct<'a> {
    /// The blocks, in the order of `matrix`.
    pub blocks: &'a [Block],
    /// Their columns, one after the other, padded.
    pub matrix: &'a [f32],
    /// `[row]`, padded between blocks.
    pub x: &'a [f32],
    /// `[row]`.
    pub y: &'a mut [f32],
}

impl Kernels {
    /// `y <- A x` with `A` made of square blocks along its diagonal.
    ///
    /// Each block's rows and columns begin at a multiple of [`LANES`] in `x` and `y`, and its matrix is stored
    /// column by column, each padded with zeros to whole lanes; that of a block which stands for two, once.
    pub fn blocks(&self, product: BlockProduct<'_>) {
        self.run(product);
    }
}

impl Kernel for BlockProduct<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let mut matrix = S::as_simd_f32s(self.matrix).0;
        let none = simd.splat_f32s(0.0);
        for block in self.blocks {
            let padded = block.padded();
            let width = padded / S::F32_LANES;
            let x = &self.x[block.start..][..block.rows()];
            let y = S::as_mut_simd_f32s(&mut self.y[block.start..][..block.rows()]).0;
            let (columns, rest) = matrix.split_at(width * block.size);
            matrix = rest;
            let (x, x_twin) = x.split_at(padded);
            let (y, y_twin) = y.split_at_mut(width);
            for v in 0..width {
                // Even and odd columns side by side hide the latency of the addition.
                let [mut even, mut odd, mut even_twin, mut odd_twin] = [none; 4];
                let mut pairs = columns.chunks_exact(2 * width);
                let (xs, last) = x[..block.size].as_chunks::<2>();
                if block.twice {
                    let (twins, last_twin) = x_twin[..block.size].as_chunks::<2>();
                    for ((pair, x), twin) in pairs.by_ref().zip(xs).zip(twins) {
                        let (a, b) = (pair[v], pair[width + v]);
                        even = fma(a, simd.splat_f32s(x[0]), even);
                        even_twin = fma(a, simd.splat_f32s(twin[0]), even_twin);
                        odd = fma(b, simd.splat_f32s(x[1]), odd);
                        odd_twin = fma(b, simd.splat_f32s(twin[1]), odd_twin);
                    }
                    if let ([x], [twin]) = (last, last_twin) {
                        let a = pairs.remainder()[v];
                        even = fma(a, simd.splat_f32s(*x), even);
                        even_twin = fma(a, simd.splat_f32s(*twin), even_twin);
                    }
                    y_twin[v] = simd.add_f32s(even_twin, odd_twin);
                } else {
                    for (pair, x) in pairs.by_ref().zip(xs) {
                        even = fma(pair[v], simd.splat_f32s(x[0]), even);
                        odd = fma(pair[width + v], simd.splat_f32s(x[1]), odd);
                    }
                    if let [x] = last {
                        even = fma(pairs.remainder()[v], simd.splat_f32s(*x), even);
                    }
                }
                y[v] = simd.add_f32s(even, odd);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::zero_row;

    #[test]
    fn it_is_the_product_with_each_block_whatever_its_size() {
        let sizes = [(1, false), (3, true), (16, true), (17, true), (20, false), (5, true)];
        let value = |i: usize| ((i * 37 + 11) % 64) as f32 / 32.0 - 1.0;
        let (mut blocks, mut start, mut entries) = (Vec::new(), 0, 0);
        for (size, twice) in sizes {
            let block = Block { start, size, twice };
            start += block.rows();
            entries += block.padded() * size;
            blocks.push(block);
        }
        let (mut matrix, mut x, mut y) = (zero_row(entries), zero_row(start), zero_row(start));
        let (mut at, mut expected) = (0, vec![0.0_f32; start]);
        for block in &blocks {
            let padded = block.padded();
            for column in 0..block.size {
                for row in 0..block.size {
                    matrix[at + column * padded + row] = value(at + column * 3 + row);
                }
            }
            for member in 0..block.rows() / padded {
                let first = block.start + member * padded;
                (0..block.size).for_each(|i| x[first + i] = value(first + 5 * i));
                for row in 0..block.size {
                    let terms =
                        (0..block.size).map(|column| matrix[at + column * padded + row] * x[first + column]);
                    expected[first + row] = terms.sum();
                }
            }
            at += padded * block.size;
        }
        for kernels in [Kernels::baseline(), Kernels::detect()] {
            kernels.blocks(BlockProduct { blocks: &blocks, matrix: &matrix, x: &x, y: &mut y });
            for (found, expected) in y.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-5, "{}: {found} {expected}", kernels.name());
            }
        }
    }
}
