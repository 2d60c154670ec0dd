//! Sticks that replay each stroke from what its contact measured.
//!
//! Time is stretched: the tip comes down at the stroke's speed, stays for the contact time, and leaves at the speed
//! it was measured to leave with, all of it so many times slower.

use overhear_engine::snapshot::StrikeSnapshot;

use super::bodies::Body;
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, scale, sub, unit};
use crate::editor::theme::Palette;

/// How many times slower the replay is: a factor.
pub const STRETCH: f64 = 30.0;

/// Time of the replay before the tip touches, s unstretched.
const BEFORE: f64 = 3e-3;

/// Time of the replay after the tip has left, s unstretched.
const AFTER: f64 = 14e-3;

/// A stroke that is being replayed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replay {
    /// Number of the stroke on its piece.
    pub count: u32,
    /// When it was seen, s of the editor's time.
    pub seen: f64,
}

impl Default for Replay {
    fn default() -> Replay {
        Replay { count: 0, seen: f64::NEG_INFINITY }
    }
}

impl Replay {
    /// Takes in what a snapshot says, at a time (s).
    pub fn follow(&mut self, strike: &StrikeSnapshot, now: f64) {
        if strike.count != self.count {
            *self = Replay { count: strike.count, seen: now };
        }
    }

    /// Whether there is something to be seen at a time, s.
    pub fn is_on(&self, strike: &StrikeSnapshot, now: f64) -> bool {
        self.count > 0 && self.time(now) < f64::from(strike.contact_time) + AFTER
    }

    /// Time since the first touch, s unstretched; negative before.
    fn time(&self, now: f64) -> f64 {
        (now - self.seen) / STRETCH - BEFORE
    }

    /// How long ago the tip touched, s of the editor's time.
    pub fn since_touch(&self, now: f64) -> f64 {
        self.time(now) * STRETCH
    }

    /// Height of the tip over the surface, m, if there is something to be seen.
    pub fn height(&self, strike: &StrikeSnapshot, now: f64) -> Option<f32> {
        if !self.is_on(strike, now) {
            return None;
        }
        let time = self.time(now);
        let left = time - f64::from(strike.contact_time);
        let height = if time < 0.0 {
            -time * f64::from(strike.speed)
        } else if left < 0.0 {
            0.0
        } else {
            left * f64::from(strike.leaving_speed.max(0.0))
        };
        // Fast strokes come from beyond the picture.
        Some(height.clamp(0.0, 0.25) as f32)
    }
}

/// Draws the stick of a stroke with its tip at a height (m) over where it lands.
pub fn draw(scene: &mut Scene, body: &Body, landing: V3, height: f32, palette: &Palette) {
    let tip = add(landing, scale(body.frame.normal, height + 0.006));
    if body.has_beater() {
        // A beater on its rod, which turns about the pedal.
        let chrome = [shade(palette.chrome, 0.45, 0.0), palette.chrome];
        let beater = add(tip, scale(body.frame.normal, 0.025));
        let [x, _, z] = add(body.frame.centre, scale(body.frame.ahead(), 0.10));
        let axle = [x, 0.09, z];
        scene.rod(axle, beater, 0.004, chrome);
        let felt = [shade(palette.film, 0.55, 0.0), shade(palette.film, 0.9, 0.0)];
        scene.rod(
            add(beater, scale(body.frame.normal, -0.024)),
            add(beater, scale(body.frame.normal, 0.024)),
            0.028,
            felt,
        );
        return;
    }
    // From the player's hands, the left for what stands to the left.
    let side = if body.frame.centre[0] < -0.2 { -0.22 } else { 0.22 };
    let toward = unit(sub([side + 0.35 * body.frame.centre[0], body.frame.centre[1] + 0.16, -0.95], landing));
    // It turns about the hand as it rises.
    let hand = add(landing, scale(toward, 0.40));
    let direction = unit(sub(hand, tip));
    let wood = [shade(palette.wood, 0.55, 0.0), palette.wood];
    let at = |distance: f32| add(tip, scale(direction, distance));
    // Its tip would be behind what it lies on.
    scene.lift = 0.03;
    scene.taper(at(0.0), at(0.012), [0.0055, 0.0065], wood);
    scene.taper(at(0.012), at(0.022), [0.0065, 0.0045], wood);
    scene.taper(at(0.022), at(0.10), [0.0045, 0.0085], wood);
    scene.taper(at(0.10), at(0.38), [0.0085, 0.0095], wood);
    scene.lift = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tip_lands_stays_and_leaves_as_it_was_measured() {
        let strike = StrikeSnapshot {
            count: 1,
            speed: 4.0,
            contact_time: 5e-3,
            leaving_speed: 1.5,
            ..StrikeSnapshot::default()
        };
        let mut replay = Replay::default();
        assert_eq!(replay.height(&strike, 0.0), None);
        replay.follow(&strike, 10.0);
        let at = |milliseconds: f64| replay.height(&strike, 10.0 + STRETCH * (BEFORE + 1e-3 * milliseconds));
        assert!((at(-2.0).unwrap() - 8e-3).abs() < 1e-6);
        assert_eq!((at(0.5), at(4.5)), (Some(0.0), Some(0.0)));
        assert!((at(9.0).unwrap() - 6e-3).abs() < 1e-6);
        assert_eq!(at(100.0), None);
    }
}
