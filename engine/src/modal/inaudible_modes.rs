//! Modes that ring on after nobody can hear them, and may sleep.
//!
//! Model: a mode of state `z` is heard at an ear by at most `(|w_re| + |w_im|) max(|re z|, |im z|)`. Put to rest where that is
//! below a share `1 / N` of `INAUDIBLE` at every ear, all `N` modes together are missed by less than `INAUDIBLE`
//! from then on, for what is left of each would only have decayed. That holds for modes that nothing drives: what does is
//! given as a port. Once all modes of some lanes sleep, they are passed over ([`ModalBody::ring`]).

use super::simd::flush::QUIET;
use super::{InputVector, ModalBody, ReceiverWeights, Row, zero_row};

/// Pressure that nobody misses, Pa: 120 dB under full scale, which is
/// [`FULL_SCALE`](crate::level::FULL_SCALE).
const INAUDIBLE: f64 = 1e-6 * crate::level::FULL_SCALE as f64;

/// Largest displacement that may be forgotten however little is heard of it, m: wires and sticks do not feel it. *Derived*: a
/// millionth of what a soft stroke bends a head by at a kilohertz.
const LARGEST: f64 = 1e-13;

/// The state of each mode below which it may sleep.
pub struct InaudibleModes {
    /// `[mode]`, m.
    below: Row,
}

impl InaudibleModes {
    /// For so many modes, none of which may sleep before it is gone. Allocates.
    pub fn new(modes: usize) -> InaudibleModes {
        let mut below = zero_row(modes);
        below.fill(QUIET);
        InaudibleModes { below }
    }
}

impl ModalBody {
    /// Works out below which state each mode from `first` on that no force at `driven` drives may sleep, after a change of
    /// modes, of the pickup or of the port.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn update_thresholds(
        &self,
        faint: &mut InaudibleModes,
        pickup: &ReceiverWeights,
        first: usize,
        driven: Option<&InputVector>,
    ) {
        let share = INAUDIBLE / self.modes.len().max(1) as f64;
        for (k, below) in faint.below.iter_mut().enumerate() {
            let undriven = driven.is_none_or(|port| port.shape.get(k) == Some(&0.0));
            let loudest = pickup.ears.iter().fold(0.0_f32, |loudest, ear| {
                let [re, im] =
                    [&ear.weight_re, &ear.weight_im].map(|row| row.get(k).map_or(0.0, |w| w.abs()));
                loudest.max(re + im)
            });
            let may = k >= first && undriven;
            *below = if may { (share / f64::from(loudest)).min(LARGEST) as f32 } else { QUIET }.max(QUIET);
        }
    }

    /// Puts modes to rest that nobody can hear any more.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn flush_inaudible(&mut self, faint: &InaudibleModes) {
        self.kernels.flush(&mut self.state.re, &mut self.state.im, Some(&faint.below));
    }
}
