//! Many samples of a body that several forces drive, its state in registers throughout.

use pulp::Simd;

use super::{Kernel, Kernels, MAX_DRIVES, Ring, ring_all};

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
    /// If a run is longer than [`MAX_RUN`](super::MAX_RUN), a drive shorter than it, or of more than [`MAX_DRIVES`].
    pub fn ring_driven(&self, ring: &mut Ring<'_>, drives: &[Drive<'_>]) {
        ring.check();
        assert!(drives.len() <= MAX_DRIVES, "{} drives", drives.len());
        self.run(Driven { ring, drives });
    }
}

impl Kernel for Driven<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        ring_all(simd, fma, self.ring, self.drives);
    }
}
