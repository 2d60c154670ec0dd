//! The most the machine can do: multiplications and additions that wait for nothing but each other.
//!
//! For measurements; nothing that sounds is made of it.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels};

/// Registers of sums: as many as hide the latency of one sum, and fit with the two factors.
const SUMS: usize = 12;

struct Peak {
    passes: usize,
    start: [f32; SUMS],
}

impl Kernels {
    /// Multiplies and adds in so many passes over sums in registers; how many multiplications with an addition those
    /// were, and what came out, which is of no use but keeps the work from being left out.
    pub fn multiply_and_add(&self, passes: usize, start: f32) -> (f64, f32) {
        self.run(Peak { passes, start: std::array::from_fn(|i| start + i as f32) })
    }
}

impl Kernel for Peak {
    type Output = (f64, f32);
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> (f64, f32) {
        let (factor, step) = (simd.splat_f32s(0.999), simd.splat_f32s(1e-4));
        let mut sums = [factor; SUMS];
        for (sum, start) in sums.iter_mut().zip(self.start) {
            *sum = simd.splat_f32s(start);
        }
        for _ in 0..self.passes {
            for sum in &mut sums {
                *sum = fma(*sum, factor, step);
            }
        }
        let mut total = 0.0;
        for sum in sums {
            total += simd.reduce_sum_f32s(sum);
        }
        ((self.passes * SUMS * S::F32_LANES) as f64, total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_comes_to_the_same_and_counts_its_lanes() {
        for (kernels, least) in [(Kernels::baseline(), 4.0), (Kernels::detect(), 4.0)] {
            let (count, result) = kernels.multiply_and_add(1000, 0.5);
            let lanes = count / (1000.0 * SUMS as f64);
            assert!(lanes >= least && lanes.fract() == 0.0, "{lanes}");
            // Twelve sums in every lane, each on its way from its start to .1.
            let each = |i: usize| 0.1 + (0.4 + i as f64) * 0.999_f64.powi(1000);
            let want: f64 = (0..SUMS).map(each).sum();
            assert!((f64::from(result) / lanes / want - 1.0).abs() < 1e-4, "{result} for {want}");
        }
    }
}
