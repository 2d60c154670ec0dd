//! Modes of a round body at a few evenly spaced points around its rim.
//!
//! At `2 (c - 1)` points an order `m` is the same as the lowest order of the same remainder (aliasing). Each mode therefore
//! belongs to one of `c` classes, and each class has two amplitudes, of the cosine and of the sine. Reading all points costs as
//! much as reading two.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES};
use crate::math::negligible::drop_negligible;
use crate::modal::row::{Row, zero_row};

/// Most classes there can be.
pub const MAX_CLASSES: usize = 17;

/// Amplitude of the cosine and of the sine, `[class]`.
pub type Amplitudes = [[f32; 2]; MAX_CLASSES];

/// The modes of each amplitude.
pub struct RimHarmonics {
    /// Groups of lanes with modes of a class in them, class by class.
    groups: Vec<Group>,
    /// Shares of a mode in its class's cosine and sine, [`LANES`] values for every group.
    cos: Row,
    sin: Row,
}

/// Some modes of one class.
#[derive(Debug, Clone, Copy)]
struct Group {
    class: usize,
    /// First of its lanes, in lanes.
    lanes: usize,
}

impl Default for RimHarmonics {
    /// Of no modes.
    fn default() -> RimHarmonics {
        RimHarmonics { groups: Vec::new(), cos: zero_row(0), sin: zero_row(0) }
    }
}

impl RimHarmonics {
    /// From every mode's class and its shares of the cosine and the sine, `[mode]`. Fastest where modes of a
    /// class lie together. Allocates.
    ///
    /// # Panics
    /// If there are more than [`MAX_CLASSES`] classes.
    pub fn new(modes: &[(usize, [f64; 2])]) -> RimHarmonics {
        assert!(modes.iter().all(|&(class, _)| class < MAX_CLASSES));
        let mut shares: Vec<[f64; 2]> = modes.iter().map(|mode| mode.1).collect();
        drop_negligible(shares.as_flattened_mut());
        let mut groups = Vec::new();
        for class in 0..MAX_CLASSES {
            let present = modes.chunks(LANES).map(|some| some.iter().any(|mode| mode.0 == class));
            let lanes = present.enumerate().filter(|&(_, any)| any);
            groups.extend(lanes.map(|(lanes, _)| Group { class, lanes }));
        }
        let (mut cos, mut sin) = (zero_row(groups.len() * LANES), zero_row(groups.len() * LANES));
        for (at, group) in groups.iter().enumerate() {
            let members = modes.iter().zip(&shares).skip(group.lanes * LANES).take(LANES).enumerate();
            for (lane, (_, &[c, s])) in members.filter(|(_, (mode, _))| mode.0 == group.class) {
                (cos[at * LANES + lane], sin[at * LANES + lane]) = (c as f32, s as f32);
            }
        }
        RimHarmonics { groups, cos, sin }
    }

    /// Square of every mode's amplitude at the rim, `(mode, square)`, but those that have none.
    pub fn sizes(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        let rows = self.cos.iter().zip(self.sin.iter()).enumerate();
        rows.filter(|&(_, (&c, &s))| c != 0.0 || s != 0.0)
            .map(|(at, (&c, &s))| (self.groups[at / LANES].lanes * LANES + at % LANES, c * c + s * s))
    }

    /// Every mode's share of its class, `(mode, class, [cosine, sine])`, but those that have none.
    pub fn shares(&self) -> impl Iterator<Item = (usize, usize, [f64; 2])> + '_ {
        let rows = self.cos.iter().zip(self.sin.iter()).enumerate();
        rows.filter(|&(_, (&c, &s))| c != 0.0 || s != 0.0).map(|(at, (&c, &s))| {
            let group = self.groups[at / LANES];
            (group.lanes * LANES + at % LANES, group.class, [f64::from(c), f64::from(s)])
        })
    }
}

struct Gather<'a> {
    folded: &'a RimHarmonics,
    x: &'a [f32],
}

/// Operands of [`Kernels::spread_folded`]; rows `[mode]`.
pub struct Spread<'a> {
    /// State.
    pub re: &'a mut [f32],
    /// State.
    pub im: &'a mut [f32],
    /// Effect of a unit force held for a sample.
    pub hold_re: &'a [f32],
    /// Effect of a unit force held for a sample.
    pub hold_im: &'a [f32],
}

struct SpreadAll<'a, 'b> {
    folded: &'a RimHarmonics,
    forces: &'a Amplitudes,
    body: Spread<'b>,
}

impl Kernels {
    /// Sums a row `[mode]` into amplitudes; modes that it does not reach count as zero.
    pub fn gather_folded(&self, folded: &RimHarmonics, x: &[f32]) -> Amplitudes {
        self.run(Gather { folded, x })
    }

    /// Adds the effect of forces on the amplitudes, held for a sample, to a body's state.
    pub fn spread_folded(&self, folded: &RimHarmonics, forces: &Amplitudes, body: Spread<'_>) {
        self.run(SpreadAll { folded, forces, body });
    }
}

impl Kernel for Gather<'_> {
    type Output = Amplitudes;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> Amplitudes {
        let mut out = Amplitudes::default();
        let x = S::as_simd_f32s(self.x).0;
        let (cos, sin) = (S::as_simd_f32s(&self.folded.cos).0, S::as_simd_f32s(&self.folded.sin).0);
        let per = LANES / S::F32_LANES;
        let rows = cos.chunks_exact(per).zip(sin.chunks_exact(per));
        let zero = simd.splat_f32s(0.0);
        let (mut class, mut sums) = (0, [zero; 2]);
        for (group, (cos, sin)) in self.folded.groups.iter().zip(rows) {
            if (group.lanes + 1) * per > x.len() {
                continue;
            }
            if group.class != class {
                // A loop, as a closure would be compiled without the machine's instructions.
                out[class] = [simd.reduce_sum_f32s(sums[0]), simd.reduce_sum_f32s(sums[1])];
                (class, sums) = (group.class, [zero; 2]);
            }
            for ((&x, &c), &s) in x[group.lanes * per..][..per].iter().zip(cos).zip(sin) {
                sums = [fma(c, x, sums[0]), fma(s, x, sums[1])];
            }
        }
        out[class] = [simd.reduce_sum_f32s(sums[0]), simd.reduce_sum_f32s(sums[1])];
        out
    }
}

impl Kernel for SpreadAll<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Spread { re, im, hold_re, hold_im } = self.body;
        let (re, im) = (S::as_mut_simd_f32s(re).0, S::as_mut_simd_f32s(im).0);
        let (hold_re, hold_im) = (S::as_simd_f32s(hold_re).0, S::as_simd_f32s(hold_im).0);
        let (cos, sin) = (S::as_simd_f32s(&self.folded.cos).0, S::as_simd_f32s(&self.folded.sin).0);
        let per = LANES / S::F32_LANES;
        let rows = cos.chunks_exact(per).zip(sin.chunks_exact(per));
        for (group, (cos, sin)) in self.folded.groups.iter().zip(rows) {
            let [c, s] = self.forces[group.class].map(|force| simd.splat_f32s(force));
            for (i, (&cos, &sin)) in cos.iter().zip(sin).enumerate() {
                let at = group.lanes * per + i;
                let force = fma(cos, c, simd.mul_f32s(sin, s));
                re[at] = fma(hold_re[at], force, re[at]);
                im[at] = fma(hold_im[at], force, im[at]);
            }
        }
    }
}
