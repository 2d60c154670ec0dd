//! One sample of the coupled modes in two passes: the free step, and the effect of forces.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels};
use super::primitives::turn;
use super::ring::RECEIVERS;

/// Most forces in a sample.
pub const FORCES: usize = 2;

/// A force, and the effect of a unit force held for a sample, `[mode]`, real and imaginary part.
pub type HeldForce<'a> = (f32, [&'a [f32]; 2]);

/// Operands of [`Kernels::rotate_along`]; all rows `[mode]`, of one length.
pub struct Along<'a> {
    /// State.
    pub re: &'a mut [f32],
    /// State.
    pub im: &'a mut [f32],
    /// Rotation less one.
    pub turn_re: &'a [f32],
    /// Rotation.
    pub turn_im: &'a [f32],
    /// Direction.
    pub shape: &'a [f32],
}

/// Operands of [`Kernels::push_and_hear`]; all rows `[mode]`.
pub struct PushAndHear<'a> {
    /// State.
    pub re: &'a mut [f32],
    /// State.
    pub im: &'a mut [f32],
    /// Forces; their rows are as long as the state or longer.
    pub forces: [HeldForce<'a>; FORCES],
    /// Weights of the state at each receiver, real and imaginary part. Missing weights are zero.
    pub weights: [[&'a [f32]; 2]; RECEIVERS],
}

impl Kernels {
    /// [`rotate`](Self::rotate) that returns the movement of the imaginary parts along a direction.
    pub fn rotate_along(&self, along: Along<'_>) -> f32 {
        self.run(along)
    }

    /// Adds the effect of forces to the state, and returns the pressure at each receiver.
    pub fn push_and_hear(&self, work: PushAndHear<'_>) -> [f32; RECEIVERS] {
        self.run(work)
    }
}

impl Kernel for Along<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let (re, im) = (S::as_mut_simd_f32s(self.re).0, S::as_mut_simd_f32s(self.im).0);
        let [t_re, t_im, shape] = [self.turn_re, self.turn_im, self.shape].map(|row| S::as_simd_f32s(row).0);
        let mut sum = simd.splat_f32s(0.0);
        let rows = re.iter_mut().zip(im).zip(t_re.iter().zip(t_im)).zip(shape);
        for (((re, im), (&t_re, &t_im)), &shape) in rows {
            let (re_after, im_after) = turn(simd, fma, (*re, *im), (t_re, t_im));
            sum = fma(shape, simd.sub_f32s(im_after, *im), sum);
            (*re, *im) = (re_after, im_after);
        }
        simd.reduce_sum_f32s(sum)
    }
}

impl Kernel for PushAndHear<'_> {
    type Output = [f32; RECEIVERS];
    #[inline(always)]
    fn with<S: Simd>(
        self,
        simd: S,
        fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    ) -> [f32; RECEIVERS] {
        let (re, im) = (S::as_mut_simd_f32s(self.re).0, S::as_mut_simd_f32s(self.im).0);
        let groups = re.len();
        let both = self.forces[1].0 != 0.0;
        let [(first, first_gains), (second, second_gains)] = self.forces;
        let held = [simd.splat_f32s(first), simd.splat_f32s(second)];
        let gains = [first_gains, second_gains].map(|gains| gains.map(|row| S::as_simd_f32s(row).0));
        let weights = self.weights.map(|receiver| receiver.map(|row| S::as_simd_f32s(row).0));
        // The last receiver takes the first modes only.
        let reached = weights[RECEIVERS - 1][0].len().min(groups);
        let mut sums = [[simd.splat_f32s(0.0); 2]; RECEIVERS];
        for i in 0..groups {
            let (mut z_re, mut z_im) = (re[i], im[i]);
            z_re = fma(gains[0][0][i], held[0], z_re);
            z_im = fma(gains[0][1][i], held[0], z_im);
            if both {
                z_re = fma(gains[1][0][i], held[1], z_re);
                z_im = fma(gains[1][1][i], held[1], z_im);
            }
            (re[i], im[i]) = (z_re, z_im);
            for receiver in 0..RECEIVERS - 1 {
                let [w_re, w_im] = weights[receiver];
                sums[receiver] =
                    [fma(w_re[i], z_re, sums[receiver][0]), fma(w_im[i], z_im, sums[receiver][1])];
            }
            if i < reached {
                let [w_re, w_im] = weights[RECEIVERS - 1];
                sums[RECEIVERS - 1] =
                    [fma(w_re[i], z_re, sums[RECEIVERS - 1][0]), fma(w_im[i], z_im, sums[RECEIVERS - 1][1])];
            }
        }
        let mut heard = [0.0; RECEIVERS];
        for (heard, [re, im]) in heard.iter_mut().zip(sums) {
            *heard = simd.reduce_sum_f32s(simd.add_f32s(re, im));
        }
        heard
    }
}
