//! Unevenness of the limbs that play: where strokes land, and how fast.

use std::f64::consts::TAU;

use fastrand::Rng;
use overhear_engine::strike::Striker;

/// What swings the striker of a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Limb {
    /// The hand of the first stroke, and of every other one after it.
    Right,
    Left,
    /// On the pedal of a beater, which always meets the same place.
    Foot,
}

impl Limb {
    /// Side of a hand: 1 to the right, -1 to the left.
    fn side(self) -> f64 {
        match self {
            Limb::Right => 1.0,
            Limb::Left => -1.0,
            Limb::Foot => 0.0,
        }
    }

    /// Speed at which a striker touches over that of a stick's tip, for a note of full velocity.
    pub(super) fn speed_share(self, striker: Striker) -> f64 {
        match (self, striker) {
            (Limb::Foot, _) => BEATER_SHARE,
            (_, Striker::CrossStick) => CROSS_STICK_SHARE,
            (_, Striker::Shoulder) => SHOULDER_SHARE,
            _ => 1.0,
        }
    }
}

/// Speed of a pedal's beater over that of a stick, for a note of full velocity. *Literature*: a hard kick filmed at 220 frames a second turns the
/// beater at 2,000 degrees a second, 7 to 9 m/s at its head.
const BEATER_SHARE: f64 = 0.8;

/// Speed of a cross-stick over that of a free stick, for a note of full velocity. *Judgement*: the hand lies on the head and turns the stick about
/// its tip; the side is lifted from the rim by some 5 cm, where free tips fall from 10 to 40. With it cross-sticks are softer than strokes on the head
/// as in mixed recordings (`docs/realism.md`).
const CROSS_STICK_SHARE: f64 = 0.4;

/// Speed of a stick's shoulder over that of its tip. *Derived*: it lies 5 cm behind the tip of a stick that turns in the fingers, 27 cm behind the
/// tip (0.82), or about the wrist, 37 cm behind it (0.86).
const SHOULDER_SHARE: f64 = 0.85;

/// Distance of a hand's mean place from where both are aimed, over the mean distance of single strokes. *Assumed*, from
/// no measurement.
const HAND_APART: f64 = 0.5;

/// Radius of the disc around a hand's mean place, over the same. *Derived*: the mean distance from a point at the share `x` of
/// the radius `R` of a disc is `2 R / 3 (1 + 3 x^2 / 4)`, to a thousandth for `x` below a half; here it is 1.
const HAND_REACH: f64 = 1.362;

/// How much faster the right hand is than both in the mean, over the mean deviation of single strokes, both in dB. *Assumed*, from no
/// measurement.
const HAND_STRONGER: f64 = 0.3;

/// A limb at a stroke, and how it misses what it is aimed at.
pub(super) struct Arm {
    limb: Limb,
    /// Of the distance, the direction and the speed, each in 0 to 1.
    drawn: [f64; 3],
}

impl Arm {
    /// Draws a stroke. Every stroke draws as much, so that it depends only on how many came before it.
    pub(super) fn new(limb: Limb, rng: &mut Rng) -> Arm {
        Arm { limb, drawn: std::array::from_fn(|_| rng.f64()) }
    }

    /// A place near the one aimed at (share of the radius, rad), at a mean distance of `spread` (share of the radius).
    pub(super) fn placed(&self, (radius, angle): (f64, f64), spread: f64) -> (f64, f64) {
        if spread == 0.0 || self.limb == Limb::Foot {
            return (radius, angle);
        }
        // Uniform in a disc on the hand's side. The angle runs from the player to the right.
        let away = HAND_REACH * spread * self.drawn[0].sqrt();
        let (across, along) = libm::sincos(TAU * self.drawn[1]);
        let (sin, cos) = libm::sincos(angle);
        let aside = HAND_APART * spread * self.limb.side();
        let (x, y) = (radius * cos + away * along, radius * sin + away * across + aside);
        (libm::hypot(x, y).min(1.0), libm::atan2(y, x))
    }

    /// Ratio of a stroke's speed to what is asked: uniform in dB around that of the limb, with the spread (dB) as its mean size.
    pub(super) fn uneven_speed(&self, spread: f64) -> f64 {
        if spread == 0.0 {
            return 1.0;
        }
        let stronger = HAND_STRONGER * self.limb.side();
        // Half the width, so that the mean size (width^2 + stronger^2) / (2 width) is 1.
        let width = 1.0 + (1.0 - stronger * stronger).sqrt();
        libm::pow(10.0, (width * (2.0 * self.drawn[2] - 1.0) + stronger) * spread / 20.0)
    }
}
