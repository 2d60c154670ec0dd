//! What is heard of a body: all receivers in one pass over its state.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels};
use super::ring::RECEIVERS;

/// Operands of [`Kernels::hear`]; all rows `[mode]`, weights as long as the state or shorter: what a row lacks is zero.
pub struct Hear<'a> {
    /// State.
    pub re: &'a [f32],
    /// State.
    pub im: &'a [f32],
    /// Weights of the state at each receiver, real and imaginary part, all but those of the last receiver of one length.
    pub weights: [[&'a [f32]; 2]; RECEIVERS],
}

impl Kernels {
    /// Weighted sum of the state at each receiver.
    pub fn hear(&self, work: Hear<'_>) -> [f32; RECEIVERS] {
        self.run(work)
    }
}

impl Kernel for Hear<'_> {
    type Output = [f32; RECEIVERS];
    #[inline(always)]
    fn with<S: Simd>(
        self,
        simd: S,
        fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    ) -> [f32; RECEIVERS] {
        let (re, im) = (S::as_simd_f32s(self.re).0, S::as_simd_f32s(self.im).0);
        let weights = self.weights.map(|receiver| receiver.map(|row| S::as_simd_f32s(row).0));
        let groups = weights[0][0].len().min(re.len());
        let (most, last) = weights.split_at(RECEIVERS - 1);
        let reached = last[0][0].len().min(groups);
        let mut sums = [[simd.splat_f32s(0.0); 2]; RECEIVERS];
        for i in 0..groups {
            for (sum, [w_re, w_im]) in sums.iter_mut().zip(most) {
                *sum = [fma(w_re[i], re[i], sum[0]), fma(w_im[i], im[i], sum[1])];
            }
        }
        let [w_re, w_im] = last[0];
        for i in 0..reached {
            let sum = &mut sums[RECEIVERS - 1];
            *sum = [fma(w_re[i], re[i], sum[0]), fma(w_im[i], im[i], sum[1])];
        }
        let mut heard = [0.0; RECEIVERS];
        for (heard, [re, im]) in heard.iter_mut().zip(sums) {
            *heard = simd.reduce_sum_f32s(simd.add_f32s(re, im));
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::row::zero_row;

    #[test]
    fn it_is_the_sum_of_products_at_each_receiver() {
        const MODES: usize = 96;
        let value = |i: usize| ((i * 37 + 11) % 64) as f32 / 32.0 - 1.0;
        let row = |salt: usize, length: usize| {
            let mut row = zero_row(length);
            (0..length).for_each(|i| row[i] = value(salt + i));
            row
        };
        let (re, im) = (row(1, MODES), row(2, MODES));
        for reach in [0, 32, MODES] {
            let lengths: [usize; RECEIVERS] =
                std::array::from_fn(|receiver| if receiver + 1 < RECEIVERS { MODES } else { reach });
            let rows: [_; RECEIVERS] = std::array::from_fn(|receiver| {
                [row(3 + receiver, lengths[receiver]), row(50 + receiver, lengths[receiver])]
            });
            let product = |a: &[f32], b: &[f32]| -> f32 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
            for kernels in [Kernels::baseline(), Kernels::detect()] {
                let weights = rows.each_ref().map(|pair| pair.each_ref().map(|row| &row[..]));
                let heard = kernels.hear(Hear { re: &re, im: &im, weights });
                for (heard, [w_re, w_im]) in heard.into_iter().zip(&rows) {
                    let expected = product(w_re, &re) + product(w_im, &im);
                    assert!((heard - expected).abs() < 1e-4, "{}: {heard} {expected}", kernels.name());
                }
            }
        }
    }
}
