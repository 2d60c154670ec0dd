//! Rendering of a run: many samples of a body at once, with its state in registers, with or without forces.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES, size};
use super::primitives::turn;
use crate::receiver::POINTS;

/// Longest run of [`Kernels::ring`], samples.
pub const MAX_RUN: usize = 32;

/// Most forces in a run.
pub const MAX_DRIVES: usize = 16;

/// A force at an input vector over a run.
#[derive(Debug, Clone, Copy)]
pub struct Drive<'a> {
    /// Effect of a unit force held for a sample, `[mode]`.
    pub gain_re: &'a [f32],
    /// Effect of a unit force held for a sample, `[mode]`.
    pub gain_im: &'a [f32],
    /// `[turn][sample]`, N: [`REST`] modes after [`REST`] modes take the forces of the turns one after the other.
    pub forces: &'a [f32],
    /// Turns, at least 1.
    pub turns: usize,
}

/// Operands of [`Kernels::ring`]; all rows `[mode]`.
pub struct Ring<'a> {
    /// State.
    pub re: &'a mut [f32],
    /// State.
    pub im: &'a mut [f32],
    /// Rotation less one.
    pub turn_re: &'a [f32],
    /// Rotation.
    pub turn_im: &'a [f32],
    /// Receivers; all `out` of one length.
    pub heard: [PressureSum<'a>; RECEIVERS],
}

/// Receivers of a body: those at its [points](POINTS), which take all modes, and one that takes the first modes only, as many as it
/// has weights.
pub const RECEIVERS: usize = POINTS + 1;

/// Zeros at the end of a row that is shorter than others: the largest number of modes that are advanced together.
pub const REST: usize = GROUPS * LANES;

/// One receiver.
pub struct PressureSum<'a> {
    /// Weights of the state, `[mode]`.
    pub weight_re: &'a [f32],
    /// Weights of the state, `[mode]`.
    pub weight_im: &'a [f32],
    /// Receives the sum after each sample.
    pub out: &'a mut [f32],
}

impl Ring<'_> {
    /// Samples of the run.
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

struct Driven<'a, 'b> {
    ring: &'a mut Ring<'b>,
    drives: &'a [Drive<'a>],
}

impl Kernels {
    /// Many samples of [`rotate`](Self::rotate), with the pressure after each.
    ///
    /// # Panics
    /// If `out` is longer than [`MAX_RUN`].
    pub fn ring(&self, ring: &mut Ring<'_>) {
        ring.check();
        self.run(ring);
    }

    /// [`ring`](Self::ring) with forces, each held over its sample.
    ///
    /// # Panics
    /// If a run is longer than [`MAX_RUN`], a drive shorter than it, or of more than [`MAX_DRIVES`].
    pub fn ring_driven(&self, ring: &mut Ring<'_>, drives: &[Drive<'_>]) {
        ring.check();
        assert!(drives.len() <= MAX_DRIVES, "{} drives", drives.len());
        self.run(Driven { ring, drives });
    }
}

impl Kernel for &mut Ring<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        ring_all(simd, fma, self, &[]);
    }
}

impl Kernel for Driven<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        ring_all(simd, fma, self.ring, self.drives);
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
    let mut sums = [[simd.splat_f32s(0.0); RECEIVERS]; MAX_RUN];
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

/// Advances `G` groups, unless they are still and nothing drives them; and listens at the receivers that reach them.
#[inline(always)]
fn ring_some<S: Simd, const G: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    first: usize,
    (re, im): (&mut [S::f32s], &mut [S::f32s]),
    rows: &RingRows<'_, S>,
    sums: &mut [[S::f32s; RECEIVERS]],
) {
    let at = first..first + G;
    let moves = any(simd, &re[at.clone()]) || any(simd, &im[at.clone()]);
    let driven =
        rows.drives().any(|drive| any(simd, &drive.0[at.clone()]) || any(simd, &drive.1[at.clone()]));
    match (moves || driven, driven, rows.reach_all(first + G)) {
        (false, ..) => {}
        (_, false, true) => ring_groups::<S, G, RECEIVERS, false>(simd, fma, first, (re, im), rows, sums),
        (_, false, false) => ring_groups::<S, G, POINTS, false>(simd, fma, first, (re, im), rows, sums),
        (_, true, true) => ring_groups::<S, G, RECEIVERS, true>(simd, fma, first, (re, im), rows, sums),
        (_, true, false) => ring_groups::<S, G, POINTS, true>(simd, fma, first, (re, im), rows, sums),
    }
}

/// Whether any lane is not zero.
#[inline(always)]
fn any<S: Simd>(simd: S, row: &[S::f32s]) -> bool {
    let mut largest = simd.splat_f32s(0.0);
    // A loop: a closure may be compiled without the instructions of `S`.
    for &x in row {
        largest = simd.max_f32s(largest, size(simd, x));
    }
    // A NaN may count as zero here: the check for finite values finds it.
    simd.reduce_max_f32s(largest) != 0.0
}

/// The rows of a run.
struct RingRows<'a, S: Simd> {
    turn: [&'a [S::f32s]; 2],
    heard: [[&'a [S::f32s]; 2]; RECEIVERS],
    drives: [DriveRows<'a, S>; MAX_DRIVES],
    driven: usize,
}

/// Effect of a unit force, real and imaginary part, the forces, and their turns.
type DriveRows<'a, S> = (&'a [<S as Simd>::f32s], &'a [<S as Simd>::f32s], &'a [f32], usize);

/// The forces that act on modes from a lane on.
#[inline(always)]
fn forces_of(forces: &[f32], turns: usize, lane: usize) -> &[f32] {
    let samples = forces.len() / turns;
    &forces[lane / REST % turns * samples..][..samples]
}

impl<'a, S: Simd> RingRows<'a, S> {
    #[inline(always)]
    fn new(
        turn_re: &'a [f32],
        turn_im: &'a [f32],
        heard: &'a [PressureSum<'_>; RECEIVERS],
        drives: &'a [Drive<'_>],
    ) -> Self {
        let pair =
            |heard: &'a PressureSum<'_>| [heard.weight_re, heard.weight_im].map(|row| S::as_simd_f32s(row).0);
        let mut rows: [DriveRows<'a, S>; MAX_DRIVES] = [(&[], &[], &[], 1); MAX_DRIVES];
        for (row, drive) in rows.iter_mut().zip(drives) {
            *row = (
                S::as_simd_f32s(drive.gain_re).0,
                S::as_simd_f32s(drive.gain_im).0,
                drive.forces,
                drive.turns,
            );
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

    /// Whether every receiver takes groups up to there.
    #[inline(always)]
    fn reach_all(&self, groups: usize) -> bool {
        groups <= self.heard[RECEIVERS - 1][0].len()
    }
}

/// Adds up the lanes of every sample's sums.
#[inline(always)]
fn write_sums<S: Simd>(simd: S, sums: &[[S::f32s; RECEIVERS]], heard: &mut [PressureSum<'_>; RECEIVERS]) {
    for (receiver, heard) in heard.iter_mut().enumerate() {
        for (out, sum) in heard.out.iter_mut().zip(sums) {
            *out = simd.reduce_sum_f32s(sum[receiver]);
        }
    }
}

/// Advances `G` groups of modes through every sample, their state in registers throughout; the first `E` receivers hear
/// them, and drives act on them if they are `DRIVEN`.
#[inline(always)]
fn ring_groups<S: Simd, const G: usize, const E: usize, const DRIVEN: bool>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    first: usize,
    (re, im): (&mut [S::f32s], &mut [S::f32s]),
    rows: &RingRows<'_, S>,
    sums: &mut [[S::f32s; RECEIVERS]],
) {
    let load = |row: &[S::f32s]| -> [S::f32s; G] {
        let row = &row[first..first + G];
        std::array::from_fn(|i| row[i])
    };
    let (mut z_re, mut z_im) = (load(re), load(im));
    let [t_re, t_im] = rows.turn.map(load);
    let weights: [_; E] = std::array::from_fn(|receiver| rows.heard[receiver].map(load));
    let mut acting: [&[f32]; MAX_DRIVES] = [&[]; MAX_DRIVES];
    for (acting, (_, _, forces, turns)) in acting.iter_mut().zip(rows.drives()) {
        *acting = forces_of(forces, *turns, first * S::F32_LANES);
    }
    for (sample, sum) in sums.iter_mut().enumerate() {
        for i in 0..G {
            (z_re[i], z_im[i]) = turn(simd, fma, (z_re[i], z_im[i]), (t_re[i], t_im[i]));
        }
        if DRIVEN {
            for ((gain_re, gain_im, ..), forces) in rows.drives().zip(&acting) {
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
