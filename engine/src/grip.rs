//! How firmly a hand holds a piece.

use crate::glide::Glide;

/// How firmly a hand holds a piece, from 0 (not at all) to 1, and how firmly its modes know.
pub struct Grip {
    firmness: Glide,
    /// As the modes have it.
    followed: f64,
}

impl Grip {
    /// A hand closes so many times more slowly than a control glides: in some 25 ms.
    const SLOWER: f64 = 5.0;
    /// Where a hand is as close as this it has arrived: its losses are then below a hundredth of any piece's own.
    const NEAR: f64 = 1e-4;

    /// No hand.
    pub fn new() -> Grip {
        Grip { firmness: Glide::new(0.0, 0.0, 1.0).arriving_within(Grip::NEAR), followed: 0.0 }
    }

    /// Asks for a firmness, 0 to 1; clamped, a NaN is ignored.
    pub fn set(&mut self, firmness: f64) {
        self.firmness.set(firmness);
    }

    /// Lets `seconds` pass.
    pub fn advance(&mut self, seconds: f64) {
        self.firmness.advance(seconds / Grip::SLOWER);
    }

    /// Whether the hand has moved since the modes followed it.
    pub fn has_moved(&self) -> bool {
        self.firmness.value() != self.followed
    }

    /// The present firmness, 0 to 1, which the modes follow now.
    pub fn follow(&mut self) -> f64 {
        self.followed = self.firmness.value();
        self.followed
    }

    /// Closes or opens at once; whether the modes are to follow.
    pub fn jump(&mut self) -> bool {
        self.firmness.jump();
        self.has_moved()
    }
}

impl Default for Grip {
    fn default() -> Grip {
        Grip::new()
    }
}
