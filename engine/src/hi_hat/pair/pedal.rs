//! The pedal under a pair of cymbals: the foot on it, and the balance that follows its rod.

use crate::hi_hat::foot::Foot;

use super::rest::Rest;

/// Samples in which the balance follows the rod: a block.
const FOLLOWING: u32 = 32;

/// The foot, and where the pair rests.
pub(crate) struct Pedal {
    pub(crate) foot: Foot,
    /// Where the pair rests, where it will once the pedal has stopped, and what of the way is left, in samples.
    pub(crate) rest: Rest,
    pub(crate) goal: Rest,
    pub(crate) way: u32,
    /// Place of the rod that the goal is for, m.
    pub(crate) goal_place: f64,
    /// Of the present sample: force of the clutch's damper, N, and where the upper cymbal was, m.
    pub(crate) damper: f64,
    pub(crate) from: f64,
    /// Since the last reset, J.
    pub(crate) work: f64,
}

impl Pedal {
    /// At rest, up.
    pub(crate) fn up() -> Pedal {
        Pedal {
            foot: Foot::new(0.0),
            rest: Rest::OPEN,
            goal: Rest::OPEN,
            way: 0,
            goal_place: 0.0,
            damper: 0.0,
            from: 0.0,
            work: 0.0,
        }
    }

    /// Whether rod or balance move.
    pub(crate) fn moves(&self) -> bool {
        self.foot.moves() || self.way > 0
    }

    /// Sets out for the balance that belongs to the present place of the rod.
    pub(crate) fn set_out(&mut self, goal: Rest) {
        (self.goal, self.goal_place, self.way) = (goal, self.foot.place(), FOLLOWING);
    }

    /// Is there: `rest` belongs to the present place of the rod.
    pub(crate) fn arrive(&mut self, rest: Rest) {
        (self.rest, self.goal, self.goal_place, self.way) = (rest, rest, self.foot.place(), 0);
    }

    /// A sample passes for the balance; false if it has stayed.
    pub(crate) fn lead(&mut self) -> bool {
        if self.way == 0 {
            return false;
        }
        self.rest =
            if self.way == 1 { self.goal } else { self.rest.toward(&self.goal, 1.0 / f64::from(self.way)) };
        self.way -= 1;
        true
    }
}
