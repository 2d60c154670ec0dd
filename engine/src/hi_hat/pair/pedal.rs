//! The pedal under a pair of cymbals: the foot, and the static equilibrium that follows its rod.

use crate::hi_hat::fading::Fading;
use crate::hi_hat::foot::Foot;

use super::arrival::Arrival;
use super::rest::Rest;

/// The foot, and the equilibrium of the pair.
pub(crate) struct Pedal {
    pub(crate) foot: Foot,
    /// The way that a note has sent the foot on.
    pub(crate) arrival: Option<Arrival>,
    /// What is still heard of ringing that it has ended.
    pub(crate) fading: Fading,
    /// Present equilibrium, the one it moves to, and the samples left until then.
    pub(crate) rest: Rest,
    pub(crate) goal: Rest,
    pub(crate) way: u32,
    /// Position of the rod that the goal belongs to, m.
    pub(crate) goal_place: f64,
    /// Of the present sample: force of the clutch's damper, N, and position of the upper cymbal at its start, m.
    pub(crate) damper: f64,
    pub(crate) from: f64,
    /// Since the last reset, J.
    pub(crate) work: f64,
}

impl Pedal {
    /// At rest, up; a sample lasts `dt` s. Allocates.
    pub(crate) fn up(dt: f64) -> Pedal {
        Pedal {
            foot: Foot::new(0.0),
            arrival: None,
            fading: Fading::new(dt),
            rest: Rest::OPEN,
            goal: Rest::OPEN,
            way: 0,
            goal_place: 0.0,
            damper: 0.0,
            from: 0.0,
            work: 0.0,
        }
    }

    /// Whether the rod or the equilibrium moves.
    pub(crate) fn moves(&self) -> bool {
        self.foot.moves() || self.way > 0 || self.arrival.is_some()
    }

    /// Starts to move to an equilibrium, within so many samples.
    pub(crate) fn lead_to(&mut self, goal: Rest, samples: u32) {
        (self.goal, self.way) = (goal, samples);
    }

    /// Takes the equilibrium of the present position of the rod at once.
    pub(crate) fn arrive(&mut self, rest: Rest) {
        (self.rest, self.goal, self.goal_place, self.way) = (rest, rest, self.foot.place(), 0);
    }

    /// Advances the equilibrium by a sample; false if it did not move.
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
