//! Modes that have become inaudible, and may be zeroed.
//!
//! Model: a mode of state `z` contributes at most `(|w_re| + |w_im|) max(|re z|, |im z|)` to a receiver. A mode is zeroed once
//! that is below a share `1 / N` of `INAUDIBLE` at every receiver. The error of all `N` modes together is then less than
//! `INAUDIBLE`, as each would only have decayed. That holds for modes without a force: those that a force acts on are given by
//! its input vector. Lanes in which all modes are zero are skipped ([`ModalBody::ring`]).

use super::coefs::TOGETHER;
use super::simd::flush::QUIET;
use super::{InputVector, ModalBody, ReceiverWeights, Row, zero_row};

/// Inaudible pressure, Pa: 120 dB under full scale, which is
/// [`FULL_SCALE`](crate::level::FULL_SCALE).
const INAUDIBLE: f64 = 1e-6 * crate::level::FULL_SCALE as f64;

/// Largest displacement that may be zeroed even if it is inaudible, m, as wires and sticks meet it. *Derived*: a millionth of
/// a head's deflection at a kilohertz under a soft stroke.
const LARGEST: f64 = 1e-13;

/// The state of each mode below which it is zeroed.
pub struct InaudibleModes {
    /// `[mode]`, m.
    below: Row,
}

impl InaudibleModes {
    /// The thresholds of so many modes, first at the smallest state that is kept at all. Allocates.
    pub fn new(modes: usize) -> InaudibleModes {
        let mut below = zero_row(modes);
        below.fill(QUIET);
        InaudibleModes { below }
    }
}

/// The thresholds of the modes from `at` on; see [`ModalBody::update_thresholds`].
#[inline(always)]
fn thresholds(
    below: &mut [f32; TOGETHER],
    at: usize,
    share: f64,
    (weights, first, driven): (&ReceiverWeights, usize, Option<&InputVector>),
) {
    let mut loudest = [0.0_f32; TOGETHER];
    for receiver in &weights.receivers {
        let [re, im] = [&receiver.weight_re, &receiver.weight_im].map(|row| row.get(at..at + TOGETHER));
        let Some((re, im)) = re.zip(im) else { continue };
        for (loudest, (re, im)) in loudest.iter_mut().zip(re.iter().zip(im)) {
            *loudest = loudest.max(re.abs() + im.abs());
        }
    }
    for (below, loudest) in below.iter_mut().zip(loudest) {
        *below = ((share / f64::from(loudest)).min(LARGEST) as f32).max(QUIET);
    }
    for (i, below) in below.iter_mut().enumerate() {
        let is_driven = driven.is_some_and(|input| input.shape.get(at + i) != Some(&0.0));
        if at + i < first || is_driven {
            *below = QUIET;
        }
    }
}

impl ModalBody {
    /// Updates the thresholds of modes from `first` on, except of those that a force at `driven` acts on, after a change of
    /// modes, receiver weights or input vector.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn update_thresholds(
        &self,
        inaudible: &mut InaudibleModes,
        weights: &ReceiverWeights,
        first: usize,
        driven: Option<&InputVector>,
    ) {
        let share = INAUDIBLE / self.modes.len().max(1) as f64;
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let (all, _) = inaudible.below.as_chunks_mut::<TOGETHER>();
                for (chunk, all) in all.iter_mut().enumerate() {
                    thresholds(all, chunk * TOGETHER, share, (weights, first, driven));
                }
            },
        );
    }

    /// Zeroes modes that are inaudible.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn flush_inaudible(&mut self, inaudible: &InaudibleModes) {
        self.kernels.flush(&mut self.state.re, &mut self.state.im, Some(&inaudible.below));
    }
}
