//! Many samples of a body that several forces drive, its state in registers throughout.

use pulp::Simd;

use super::{Kernel, Kernels, MAX_RUN, Ring, turn};

/// A force at a place over a run of samples.
#[derive(Debug, Clone, Copy)]
pub struct Drive<'a> {
    /// What a unit force held for a sample leaves, `[mode]`.
    pub gain_re: &'a [f32],
    /// What a unit force held for a sample leaves, `[mode]`.
    pub gain_im: &'a [f32],
    /// `[sample]`, N.
    pub forces: &'a [f32],
}

struct Driven<'a, 'b> {
    ring: &'a mut Ring<'b>,
    drives: &'a [Drive<'a>],
}

impl Kernels {
    /// [`ring`](Self::ring) with forces, each held over its sample.
    ///
    /// # Panics
    /// If `out` is longer than [`MAX_RUN`] or a drive shorter than `out`.
    pub fn ring_driven(&self, ring: &mut Ring<'_>, drives: &[Drive<'_>]) {
        assert!(ring.out.len() <= MAX_RUN, "a run of {} samples", ring.out.len());
        self.run(Driven { ring, drives });
    }
}

impl Kernel for Driven<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Driven { ring, drives } = self;
        let mut sums = [simd.splat_f32s(0.0); MAX_RUN];
        let re = S::as_mut_simd_f32s(ring.re).0;
        let im = S::as_mut_simd_f32s(ring.im).0;
        let rows =
            [ring.turn_re, ring.turn_im, ring.weight_re, ring.weight_im].map(|row| S::as_simd_f32s(row).0);
        for (group, (re, im)) in re.iter_mut().zip(im).enumerate() {
            let [t_re, t_im, w_re, w_im] = rows.map(|row| row[group]);
            let (mut z_re, mut z_im) = (*re, *im);
            for (n, sum) in sums[..ring.out.len()].iter_mut().enumerate() {
                (z_re, z_im) = turn(simd, fma, (z_re, z_im), (t_re, t_im));
                for drive in drives {
                    let force = simd.splat_f32s(drive.forces[n]);
                    z_re = fma(S::as_simd_f32s(drive.gain_re).0[group], force, z_re);
                    z_im = fma(S::as_simd_f32s(drive.gain_im).0[group], force, z_im);
                }
                *sum = fma(w_im, z_im, fma(w_re, z_re, *sum));
            }
            (*re, *im) = (z_re, z_im);
        }
        for (out, &sum) in ring.out.iter_mut().zip(&sums) {
            *out = simd.reduce_sum_f32s(sum);
        }
    }
}
