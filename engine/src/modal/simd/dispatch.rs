//! Dispatch of the kernels to an instruction set.

use pulp::{Arch, Scalar128b, Simd, WithSimd};

use super::level;

/// Rows are padded to a multiple of this, the `f32` lanes of the widest registers.
pub const LANES: usize = 16;

/// The kernels for one instruction set.
#[derive(Clone, Copy)]
pub struct Kernels {
    level: Level,
}

#[derive(Clone, Copy)]
enum Level {
    /// Four lanes of plain arithmetic: SSE2 on x86-64.
    Baseline,
    Detected(Arch),
}

impl Kernels {
    /// The best this machine has, within the [limit](level::limit).
    pub fn detect() -> Kernels {
        level::detect().map_or_else(Kernels::baseline, |arch| Kernels { level: Level::Detected(arch) })
    }

    /// The form every machine has.
    pub fn baseline() -> Kernels {
        Kernels { level: Level::Baseline }
    }

    /// Name of the instruction set in use.
    pub fn name(&self) -> &'static str {
        match self.level {
            Level::Baseline if cfg!(target_arch = "x86_64") => "sse2",
            Level::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Level::Detected(Arch::V4(_)) => "avx512",
            #[cfg(target_arch = "x86_64")]
            Level::Detected(Arch::V3(_)) => "avx2",
            Level::Detected(_) => "native",
        }
    }

    #[inline(always)]
    pub(super) fn run<Op: Kernel>(&self, op: Op) -> Op::Output {
        match self.level {
            Level::Baseline => Scalar128b.vectorize(Unfused(op)),
            Level::Detected(arch) => arch.dispatch(Fused(op)),
        }
    }

    /// Runs plain loops compiled for this instruction set; `op` must be inlined.
    #[inline(always)]
    pub fn vectorized<R>(&self, op: impl FnOnce() -> R) -> R {
        match self.level {
            Level::Baseline => op(),
            Level::Detected(arch) => arch.dispatch(op),
        }
    }
}

/// A kernel, generic over the registers; `fma` is the fastest multiply-add of the machine.
pub(super) trait Kernel {
    type Output;
    fn with<S: Simd>(
        self,
        simd: S,
        fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    ) -> Self::Output;
}

/// For machines that multiply and add in one instruction.
struct Fused<Op>(Op);
/// For those that would have to emulate that, slowly.
struct Unfused<Op>(Op);

impl<Op: Kernel> WithSimd for Fused<Op> {
    type Output = Op::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Op::Output {
        self.0.with(
            simd,
            #[inline(always)]
            |a, b, c| simd.mul_add_f32s(a, b, c),
        )
    }
}

impl<Op: Kernel> WithSimd for Unfused<Op> {
    type Output = Op::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Op::Output {
        self.0.with(
            simd,
            #[inline(always)]
            |a, b, c| simd.add_f32s(simd.mul_f32s(a, b), c),
        )
    }
}

/// Size of each lane. `abs_f32s` is a call where the compiler does not inline it, as in test builds, and takes a sixth of all time
/// there.
#[inline(always)]
pub(super) fn size<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    simd.max_f32s(x, simd.sub_f32s(simd.splat_f32s(0.0), x))
}
