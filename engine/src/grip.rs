//! How firmly a hand holds a piece, and when its modes follow.

use crate::glide::Glide;

/// How firmly a hand holds a piece, from 0 (not at all) to 1, and how firmly its modes know.
///
/// A hand changes losses only, so its steps are not heard: displacement and velocity go on as they were. The modes therefore
/// follow it once in [`EVERY`](Grip::EVERY) blocks, and the pieces of a kit take turns, so that no block pays for all of them.
pub struct Grip {
    firmness: Glide,
    /// As the modes have it.
    followed: f64,
    /// Blocks until the modes follow, and those at the beginning of a movement.
    wait: u32,
    turn: u32,
    /// Blocks from one time that the modes follow to the next.
    every: u32,
}

impl Grip {
    /// A hand closes so many times more slowly than a control glides: in some 25 ms.
    const SLOWER: f64 = 5.0;
    /// Blocks from one time that the modes follow to the next. *Converged*: beside modes that follow in every block the level of
    /// any 20 ms of a choked crash, ride or splash differs by at most 0.17 dB; the samples by up to 0.01 of the loudest, as if the hand
    /// came two blocks later, of the splash, whose highs part in phase, by 0.11. Drums lose to a hand more slowly than cymbals do.
    pub const EVERY: u32 = 4;
    /// Where a hand is as close as this it has arrived: its losses are then below a hundredth of any piece's own.
    const NEAR: f64 = 1e-4;

    /// No hand.
    pub fn new() -> Grip {
        Grip {
            firmness: Glide::new(0.0, 0.0, 1.0).arriving_within(Grip::NEAR),
            followed: 0.0,
            wait: 0,
            turn: 0,
            every: Grip::EVERY,
        }
    }

    /// Lets the modes follow once in so many blocks, at least 1; for comparisons.
    pub fn set_every(&mut self, blocks: u32) {
        self.every = blocks.max(1);
    }

    /// Takes turns with other pieces: those with numbers that differ by less than [`EVERY`](Self::EVERY) follow in different
    /// blocks if they are gripped in one.
    pub fn take_turn(&mut self, number: usize) {
        self.turn = (number % Grip::EVERY as usize) as u32;
        self.wait = self.turn;
    }

    /// Asks for a firmness, 0 to 1; clamped, a NaN is ignored.
    pub fn set(&mut self, firmness: f64) {
        self.firmness.set(firmness);
    }

    /// Lets `seconds` pass.
    pub fn advance(&mut self, seconds: f64) {
        self.firmness.advance(seconds / Grip::SLOWER);
    }

    /// Whether the modes are to follow; asked once a block.
    pub fn is_due(&mut self) -> bool {
        if self.firmness.value() == self.followed {
            self.wait = self.turn;
            return false;
        }
        let due = self.wait == 0;
        self.wait = if due { self.every - 1 } else { self.wait - 1 };
        due
    }

    /// The present firmness, 0 to 1, which the modes follow now.
    pub fn follow(&mut self) -> f64 {
        self.followed = self.firmness.value();
        self.followed
    }

    /// Closes or opens at once; whether the modes are to follow.
    pub fn jump(&mut self) -> bool {
        self.firmness.jump();
        self.wait = self.turn;
        self.firmness.value() != self.followed
    }
}

impl Default for Grip {
    fn default() -> Grip {
        Grip::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_follow_a_hand_in_turn_until_it_has_arrived_and_no_longer() {
        let block = 32.0 / 44_100.0;
        let turns = [0, 1, 5].map(|number| {
            let mut grip = Grip::new();
            grip.take_turn(number);
            grip.set(1.0);
            let due: Vec<u32> = (0..2000)
                .filter(|_| {
                    grip.advance(block);
                    let due = grip.is_due();
                    due.then(|| grip.follow());
                    due
                })
                .collect();
            assert_eq!(grip.followed, 1.0);
            assert!(due.windows(2).all(|pair| pair[1] - pair[0] == Grip::EVERY));
            // Within 0.7 s.
            assert!(f64::from(due[due.len() - 1]) * block < 0.7, "{due:?}");
            due[0]
        });
        assert_eq!(turns, [0, 1, 1]);
    }
}
