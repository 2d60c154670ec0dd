//! Check of a [`Pair`] once a block: whether its rims may meet, whether it rests.

use crate::modal::ModalBody;

use super::pair::Pair;
use super::rigid::Rigid;

/// Distance by which a striker may push the rim within a block: at least, m, and relative to its own. *Derived*: 5 m/s for a
/// millisecond; a light body leaves a heavy one at up to twice its speed.
const PUSHED: (f64, f64) = (5e-3, 2.0);

/// Energy below which touching cymbals are at rest, J: 10 dB below that at which a piece sleeps.
pub(super) const STILL: f64 = 1e-11;

/// Result of the check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Settled {
    /// Something moves.
    Moving,
    /// The cymbals rest on each other; the caller resets the upper shell.
    Parked,
    /// A value is not finite.
    Broken,
}

impl Pair {
    /// Called once a block: follows the rod, zeroes what has decayed, and checks whether the rims may meet. `way` is the distance
    /// (m) that the fastest striker of the upper cymbal, if there is one, moves in a block.
    ///
    /// # Real-time
    /// Linear in the number of modes, and some microseconds while the pedal moves.
    pub(super) fn look(&mut self, top: &mut ModalBody, strikers: Option<f64>) -> Settled {
        let pushed = strikers.map_or(0.0, |way| PUSHED.0.max(PUSHED.1 * way));
        let strikers = strikers.is_some();
        self.lower.modal.flush_quiet();
        let finite = self.lower.modal.is_finite()
            && self.rigid.iter().all(Rigid::is_finite)
            && self.rims.compression.iter().all(|d| d.is_finite());
        if !finite {
            return Settled::Broken;
        }
        if !strikers {
            self.carried = [0.0; 3];
        }
        if self.pedal.arrival.is_none() && self.pedal.goal_place != self.pedal.foot.place() {
            let Pair { statics, pedal, rims, rigid, .. } = self;
            let rest = statics.balance(pedal.foot.place(), &pedal.goal.preload, &rims.law, rigid).rest;
            self.measure_from(rest, top);
        }
        if self.pedal.moves() {
            self.engage(top);
            return Settled::Moving;
        }
        let touching = self.is_touching();
        if !strikers && touching && self.held() < STILL && self.held_energy() + top.energy() < STILL {
            self.lower.modal.reset();
            self.come_to_rest();
            return Settled::Parked;
        }
        if touching || self.may_meet(top, pushed) {
            self.engage(top);
        } else {
            if self.engaged {
                self.take_air_along(-1.0);
            }
            self.engaged = false;
            if !strikers && !self.still && self.held() < STILL * 1e-3 {
                self.come_to_rest();
            }
        }
        Settled::Moving
    }

    /// Whether the rims may meet by themselves, or if brought nearer by so much (m).
    fn may_meet(&self, top: &ModalBody, nearer: f64) -> bool {
        let y = self.pedal.foot.place();
        let nearest = self.statics.nearest() - y - nearer;
        let stiff = self.rigid[0].reach(y) + self.rigid[1].reach(0.0);
        nearest < stiff
            || nearest
                < stiff + top.folded_reach(&self.folded[0]) + self.lower.modal.folded_reach(&self.folded[1])
    }
}
