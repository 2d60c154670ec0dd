//! Zeroing of modes whose state has decayed.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, size};

/// Below this any mode's state is set to zero: 16 decades under the motion of a soft stroke, and
/// 3 above what has a square that is the smallest normal `f32`. *Derived*.
pub const QUIET: f32 = 1e-16;

impl Kernels {
    /// Zeroes the modes whose state is below `below` (`[mode]`), or below [`QUIET`].
    pub fn flush(&self, re: &mut [f32], im: &mut [f32], below: Option<&[f32]>) {
        self.run(Flush { re, im, below });
    }
}

struct Flush<'a> {
    re: &'a mut [f32],
    im: &'a mut [f32],
    below: Option<&'a [f32]>,
}

impl Kernel for Flush<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let quiet = simd.splat_f32s(QUIET);
        let below = self.below.map_or(&[][..], |row| S::as_simd_f32s(row).0);
        let (re, im) = (S::as_mut_simd_f32s(self.re).0, S::as_mut_simd_f32s(self.im).0);
        for (i, (re, im)) in re.iter_mut().zip(im).enumerate() {
            let size = simd.max_f32s(size(simd, *re), size(simd, *im));
            let gone = simd.less_than_f32s(size, below.get(i).copied().unwrap_or(quiet));
            let zero = simd.splat_f32s(0.0);
            *re = simd.select_f32s(gone, zero, *re);
            *im = simd.select_f32s(gone, zero, *im);
        }
    }
}
