//! The kernels of a modal body: every loop over modes there is.
//!
//! One generic form each, compiled for the baseline of the architecture and for what `pulp` can
//! select at run time (AVX2 + FMA, AVX-512, NEON). Rows are whole multiples of [`LANES`] long.
//! Within one level results are bit-equal whatever way a stretch of samples is cut; across levels
//! they differ by rounding.

pub mod blocks;
pub mod driven;
pub mod flush;
pub mod folded;
pub mod front;
pub mod level;
pub mod peak;
pub mod polar;

use pulp::{Arch, Scalar128b, Simd, WithSimd};

use driven::Drive;

/// Forces that drive one run, at most.
pub const MAX_DRIVES: usize = 16;

/// Rows are padded to a multiple of this, the `f32` lanes of the widest registers.
pub const LANES: usize = 16;

/// Longest stretch of samples [`Kernels::ring`] takes.
pub const MAX_RUN: usize = 32;

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
    fn run<Op: Kernel>(&self, op: Op) -> Op::Output {
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

    /// `z <- z + turn * z`, complex, for every mode.
    pub fn rotate(&self, re: &mut [f32], im: &mut [f32], turn_re: &[f32], turn_im: &[f32]) {
        self.run(Rotate { re, im, turn_re, turn_im });
    }

    /// `y <- y + x * factor`.
    pub fn axpy(&self, y: &mut [f32], x: &[f32], factor: f32) {
        self.run(Axpy { y, x, factor });
    }

    /// `out <- a * b`.
    pub fn multiply(&self, out: &mut [f32], a: &[f32], b: &[f32]) {
        self.run(Multiply { out, a, b });
    }

    /// `sum a * b`, over as many as the shorter row has.
    pub fn dot(&self, a: &[f32], b: &[f32]) -> f32 {
        let length = a.len().min(b.len());
        self.run(Dot { a: &a[..length], b: &b[..length] })
    }

    /// `sum a * (x - y)`, each difference taken before it is weighted.
    pub fn dot_difference(&self, a: &[f32], x: &[f32], y: &[f32]) -> f32 {
        self.run(DotDifference { a, x, y })
    }

    /// `sum a * x^2`.
    pub fn dot_square(&self, a: &[f32], x: &[f32]) -> f32 {
        self.run(DotSquare { a, x })
    }

    /// `out <- a * x + b * y`.
    pub fn combine(&self, out: &mut [f32], (a, x): (&[f32], &[f32]), (b, y): (&[f32], &[f32])) {
        self.run(Combine { out, a, x, b, y });
    }

    /// `y <- y * factor`.
    pub fn scale(&self, y: &mut [f32], factor: f32) {
        self.run(Scale { y, factor });
    }

    /// Many samples of [`rotate`](Self::rotate), listening after each.
    ///
    /// # Panics
    /// If `out` is longer than [`MAX_RUN`].
    pub fn ring(&self, ring: &mut Ring<'_>) {
        ring.check();
        self.run(ring);
    }

    /// Whether every value is exactly zero.
    pub fn is_zero(&self, row: &[f32]) -> bool {
        row.iter().all(|&x| x == 0.0)
    }
}

/// A kernel, generic over the registers; `fma` multiplies and adds in the way the machine does fast.
trait Kernel {
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

struct Rotate<'a> {
    re: &'a mut [f32],
    im: &'a mut [f32],
    turn_re: &'a [f32],
    turn_im: &'a [f32],
}

/// One sample of one group of modes.
#[inline(always)]
fn turn<S: Simd>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    (re, im): (S::f32s, S::f32s),
    (t_re, t_im): (S::f32s, S::f32s),
) -> (S::f32s, S::f32s) {
    // The small change is summed first and added last, so that the state is rounded once a sample.
    // Rounding it twice lets the energy of slow modes wander by 1e-3 a second (measured).
    let change_re = fma(t_re, re, simd.neg_f32s(simd.mul_f32s(t_im, im)));
    let change_im = fma(t_im, re, simd.mul_f32s(t_re, im));
    (simd.add_f32s(re, change_re), simd.add_f32s(im, change_im))
}

impl Kernel for Rotate<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let (re, im) = (S::as_mut_simd_f32s(self.re).0, S::as_mut_simd_f32s(self.im).0);
        let (t_re, t_im) = (S::as_simd_f32s(self.turn_re).0, S::as_simd_f32s(self.turn_im).0);
        for ((re, im), (&t_re, &t_im)) in re.iter_mut().zip(im).zip(t_re.iter().zip(t_im)) {
            (*re, *im) = turn(simd, fma, (*re, *im), (t_re, t_im));
        }
    }
}

struct Axpy<'a> {
    y: &'a mut [f32],
    x: &'a [f32],
    factor: f32,
}

impl Kernel for Axpy<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factor = simd.splat_f32s(self.factor);
        for (y, &x) in S::as_mut_simd_f32s(self.y).0.iter_mut().zip(S::as_simd_f32s(self.x).0) {
            *y = fma(x, factor, *y);
        }
    }
}

struct Multiply<'a> {
    out: &'a mut [f32],
    a: &'a [f32],
    b: &'a [f32],
}

impl Kernel for Multiply<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factors = S::as_simd_f32s(self.a).0.iter().zip(S::as_simd_f32s(self.b).0);
        for (out, (&a, &b)) in S::as_mut_simd_f32s(self.out).0.iter_mut().zip(factors) {
            *out = simd.mul_f32s(a, b);
        }
    }
}

struct Dot<'a> {
    a: &'a [f32],
    b: &'a [f32],
}

impl Kernel for Dot<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        // Four sums side by side hide the latency of the addition.
        let mut sums = [simd.splat_f32s(0.0); 4];
        let (a, b) = (S::as_simd_f32s(self.a).0, S::as_simd_f32s(self.b).0);
        let (a_fours, a_rest) = a.as_chunks::<4>();
        let (b_fours, b_rest) = b.as_chunks::<4>();
        for (a, b) in a_fours.iter().zip(b_fours) {
            for i in 0..4 {
                sums[i] = fma(a[i], b[i], sums[i]);
            }
        }
        for (i, (&a, &b)) in a_rest.iter().zip(b_rest).enumerate() {
            sums[i] = fma(a, b, sums[i]);
        }
        simd.reduce_sum_f32s(simd.add_f32s(simd.add_f32s(sums[0], sums[1]), simd.add_f32s(sums[2], sums[3])))
    }
}

struct DotDifference<'a> {
    a: &'a [f32],
    x: &'a [f32],
    y: &'a [f32],
}

impl Kernel for DotDifference<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let mut sum = simd.splat_f32s(0.0);
        let [a, x, y] = [self.a, self.x, self.y].map(|row| S::as_simd_f32s(row).0);
        for ((&a, &x), &y) in a.iter().zip(x).zip(y) {
            sum = fma(a, simd.sub_f32s(x, y), sum);
        }
        simd.reduce_sum_f32s(sum)
    }
}

struct DotSquare<'a> {
    a: &'a [f32],
    x: &'a [f32],
}

impl Kernel for DotSquare<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let mut sum = simd.splat_f32s(0.0);
        for (&a, &x) in S::as_simd_f32s(self.a).0.iter().zip(S::as_simd_f32s(self.x).0) {
            sum = fma(simd.mul_f32s(a, x), x, sum);
        }
        simd.reduce_sum_f32s(sum)
    }
}

struct Combine<'a> {
    out: &'a mut [f32],
    a: &'a [f32],
    x: &'a [f32],
    b: &'a [f32],
    y: &'a [f32],
}

impl Kernel for Combine<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let [a, x, b, y] = [self.a, self.x, self.b, self.y].map(|row| S::as_simd_f32s(row).0);
        let terms = a.iter().zip(x).zip(b.iter().zip(y));
        for (out, ((&a, &x), (&b, &y))) in S::as_mut_simd_f32s(self.out).0.iter_mut().zip(terms) {
            *out = fma(a, x, simd.mul_f32s(b, y));
        }
    }
}

struct Scale<'a> {
    y: &'a mut [f32],
    factor: f32,
}

impl Kernel for Scale<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factor = simd.splat_f32s(self.factor);
        for y in S::as_mut_simd_f32s(self.y).0 {
            *y = simd.mul_f32s(*y, factor);
        }
    }
}

/// What [`Kernels::ring`] works on; all rows `[mode]`.
pub struct Ring<'a> {
    /// State.
    pub re: &'a mut [f32],
    /// State.
    pub im: &'a mut [f32],
    /// Rotation less one.
    pub turn_re: &'a [f32],
    /// Rotation.
    pub turn_im: &'a [f32],
    /// Where it is heard; all `out` of one length.
    pub heard: [Heard<'a>; EARS],
}

/// Points at which a body is heard at once: two that hear all of it, near and far, and one that hears its first modes
/// alone, as few as its weights are long.
pub const EARS: usize = 3;

/// Ears that hear all modes.
const FULL: usize = 2;

/// A row that is shorter than others ends in so many zeros, the modes that are advanced together at most.
pub const REST: usize = GROUPS * LANES;

/// One point at which a body is heard.
pub struct Heard<'a> {
    /// What of the state is heard, `[mode]`.
    pub weight_re: &'a [f32],
    /// What of the state is heard, `[mode]`.
    pub weight_im: &'a [f32],
    /// Receives the sum after each sample.
    pub out: &'a mut [f32],
}

impl Ring<'_> {
    /// Samples asked for.
    fn samples(&self) -> usize {
        self.heard[0].out.len()
    }

    fn check(&self) {
        let samples = self.samples();
        assert!(samples <= MAX_RUN, "a run of {samples} samples");
        assert!(self.heard.iter().all(|heard| heard.out.len() == samples), "runs of different lengths");
    }
}

/// Groups of modes advanced together: their rotations are independent, which hides the latency
/// of each. *Measured*: 4 is fastest with 16 and with 32 registers.
const GROUPS: usize = 4;

impl Kernel for &mut Ring<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        ring_all(simd, fma, self, &[]);
    }
}

/// Advances all groups of modes that move or are driven, and listens.
#[inline(always)]
fn ring_all<S: Simd>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    ring: &mut Ring<'_>,
    drives: &[Drive<'_>],
) {
    let n = ring.samples();
    let mut sums = [[simd.splat_f32s(0.0); EARS]; MAX_RUN];
    let state = (S::as_mut_simd_f32s(ring.re).0, S::as_mut_simd_f32s(ring.im).0);
    let rows = RingRows::new(ring.turn_re, ring.turn_im, &ring.heard, drives);
    let groups = state.0.len();
    let (mut first, sums) = (0, &mut sums[..n]);
    while first + GROUPS <= groups {
        ring_some::<S, GROUPS>(simd, fma, first, (&mut *state.0, &mut *state.1), &rows, sums);
        first += GROUPS;
    }
    for rest in first..groups {
        ring_some::<S, 1>(simd, fma, rest, (&mut *state.0, &mut *state.1), &rows, sums);
    }
    write_sums(simd, sums, &mut ring.heard);
}

/// Advances `G` groups, unless they are still and nothing drives them; as many ears as reach them listen.
#[inline(always)]
fn ring_some<S: Simd, const G: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    first: usize,
    (re, im): (&mut [S::f32s], &mut [S::f32s]),
    rows: &RingRows<'_, S>,
    sums: &mut [[S::f32s; EARS]],
) {
    let at = first..first + G;
    let moves = any(simd, &re[at.clone()]) || any(simd, &im[at.clone()]);
    let driven =
        rows.drives().any(|drive| any(simd, &drive.0[at.clone()]) || any(simd, &drive.1[at.clone()]));
    match (moves || driven, driven, rows.reach_all(first + G)) {
        (false, ..) => {}
        (_, false, true) => ring_groups::<S, G, EARS, false>(simd, fma, first, (re, im), rows, sums),
        (_, false, false) => ring_groups::<S, G, FULL, false>(simd, fma, first, (re, im), rows, sums),
        (_, true, true) => ring_groups::<S, G, EARS, true>(simd, fma, first, (re, im), rows, sums),
        (_, true, false) => ring_groups::<S, G, FULL, true>(simd, fma, first, (re, im), rows, sums),
    }
}

/// Whether any lane is not zero.
#[inline(always)]
fn any<S: Simd>(simd: S, row: &[S::f32s]) -> bool {
    let largest =
        row.iter().fold(simd.splat_f32s(0.0), |largest, &x| simd.max_f32s(largest, simd.abs_f32s(x)));
    // A NaN may pass for nothing here: whoever looks whether all is finite finds it.
    simd.reduce_max_f32s(largest) != 0.0
}

/// The rows a ring reads.
struct RingRows<'a, S: Simd> {
    turn: [&'a [S::f32s]; 2],
    heard: [[&'a [S::f32s]; 2]; EARS],
    drives: [DriveRows<'a, S>; MAX_DRIVES],
    driven: usize,
}

/// What a unit force leaves, real and imaginary part, and the forces.
type DriveRows<'a, S> = (&'a [<S as Simd>::f32s], &'a [<S as Simd>::f32s], &'a [f32]);

impl<'a, S: Simd> RingRows<'a, S> {
    #[inline(always)]
    fn new(
        turn_re: &'a [f32],
        turn_im: &'a [f32],
        heard: &'a [Heard<'_>; EARS],
        drives: &'a [Drive<'_>],
    ) -> Self {
        let pair =
            |heard: &'a Heard<'_>| [heard.weight_re, heard.weight_im].map(|row| S::as_simd_f32s(row).0);
        let mut rows: [DriveRows<'a, S>; MAX_DRIVES] = [(&[], &[], &[]); MAX_DRIVES];
        for (row, drive) in rows.iter_mut().zip(drives) {
            *row = (S::as_simd_f32s(drive.gain_re).0, S::as_simd_f32s(drive.gain_im).0, drive.forces);
        }
        RingRows {
            turn: [turn_re, turn_im].map(|row| S::as_simd_f32s(row).0),
            heard: heard.each_ref().map(pair),
            drives: rows,
            driven: drives.len(),
        }
    }

    #[inline(always)]
    fn drives(&self) -> impl Iterator<Item = &DriveRows<'a, S>> {
        self.drives[..self.driven].iter()
    }

    /// Whether every ear hears groups up to there.
    #[inline(always)]
    fn reach_all(&self, groups: usize) -> bool {
        groups <= self.heard[EARS - 1][0].len()
    }
}

/// Adds up the lanes of every sample's sums.
#[inline(always)]
fn write_sums<S: Simd>(simd: S, sums: &[[S::f32s; EARS]], heard: &mut [Heard<'_>; EARS]) {
    for (ear, heard) in heard.iter_mut().enumerate() {
        for (out, sum) in heard.out.iter_mut().zip(sums) {
            *out = simd.reduce_sum_f32s(sum[ear]);
        }
    }
}

/// Advances `G` groups of modes through every sample, their state in registers throughout; the first `E` ears hear
/// them, and drives act on them if they are `DRIVEN`.
#[inline(always)]
fn ring_groups<S: Simd, const G: usize, const E: usize, const DRIVEN: bool>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    first: usize,
    (re, im): (&mut [S::f32s], &mut [S::f32s]),
    rows: &RingRows<'_, S>,
    sums: &mut [[S::f32s; EARS]],
) {
    let load = |row: &[S::f32s]| -> [S::f32s; G] {
        let row = &row[first..first + G];
        std::array::from_fn(|i| row[i])
    };
    let (mut z_re, mut z_im) = (load(re), load(im));
    let [t_re, t_im] = rows.turn.map(load);
    let weights: [_; E] = std::array::from_fn(|ear| rows.heard[ear].map(load));
    for (sample, sum) in sums.iter_mut().enumerate() {
        for i in 0..G {
            (z_re[i], z_im[i]) = turn(simd, fma, (z_re[i], z_im[i]), (t_re[i], t_im[i]));
        }
        if DRIVEN {
            for (gain_re, gain_im, forces) in rows.drives() {
                let force = simd.splat_f32s(forces[sample]);
                let (gain_re, gain_im) = (&gain_re[first..first + G], &gain_im[first..first + G]);
                for i in 0..G {
                    z_re[i] = fma(gain_re[i], force, z_re[i]);
                    z_im[i] = fma(gain_im[i], force, z_im[i]);
                }
            }
        }
        for i in 0..G {
            for (sum, [w_re, w_im]) in sum.iter_mut().zip(&weights) {
                *sum = fma(w_im[i], z_im[i], fma(w_re[i], z_re[i], *sum));
            }
        }
    }
    re[first..first + G].copy_from_slice(&z_re);
    im[first..first + G].copy_from_slice(&z_im);
}
