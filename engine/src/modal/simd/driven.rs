//! Many samples of a body that several forces drive, its state in registers throughout.

use pulp::Simd;

use super::{EARS, Kernel, Kernels, MAX_RUN, Ring, RingRows, turn, write_sums};

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
    /// If a run is longer than [`MAX_RUN`] or a drive shorter than it.
    pub fn ring_driven(&self, ring: &mut Ring<'_>, drives: &[Drive<'_>]) {
        ring.check();
        self.run(Driven { ring, drives });
    }
}

impl Kernel for Driven<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Driven { ring, drives } = self;
        let n = ring.samples();
        let mut sums = [[simd.splat_f32s(0.0); EARS]; MAX_RUN];
        let re = S::as_mut_simd_f32s(ring.re).0;
        let im = S::as_mut_simd_f32s(ring.im).0;
        let rows = RingRows::<S>::new(ring.turn_re, ring.turn_im, &ring.heard);
        for (group, (re, im)) in re.iter_mut().zip(im).enumerate() {
            let [t_re, t_im] = rows.turn.map(|row| row[group]);
            let none = simd.splat_f32s(0.0);
            let weights = rows.heard.map(|heard| heard.map(|row| row.get(group).copied().unwrap_or(none)));
            let (mut z_re, mut z_im) = (*re, *im);
            for (sample, sum) in sums[..n].iter_mut().enumerate() {
                (z_re, z_im) = turn(simd, fma, (z_re, z_im), (t_re, t_im));
                for drive in drives {
                    let force = simd.splat_f32s(drive.forces[sample]);
                    z_re = fma(S::as_simd_f32s(drive.gain_re).0[group], force, z_re);
                    z_im = fma(S::as_simd_f32s(drive.gain_im).0[group], force, z_im);
                }
                for (sum, [w_re, w_im]) in sum.iter_mut().zip(weights) {
                    *sum = fma(w_im, z_im, fma(w_re, z_re, *sum));
                }
            }
            (*re, *im) = (z_re, z_im);
        }
        write_sums(simd, &sums, &mut ring.heard);
    }
}
