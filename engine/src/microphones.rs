//! Where the close microphones stand unless somebody moves them, and how far they are turned up.
//!
//! A drum's hangs over its rim, on the side away from the player, where clips hold them. So near a head every mode is
//! heard, also those that radiate next to nothing; [`listening`](crate::listening) has the near field. *Measured*:
//! of nine places from 5 to 50 cm this one brings 49 of 60 features of kick, snare and toms into the range of
//! recordings (`cargo xtask realism` measures them), one fewer than 15 cm over .8 of the radius and as close to their
//! middles as any; over the middle of a head its lowest modes drown all else.
//! Cymbals and the timpani are heard from half a metre.

use crate::drum::DrumSpec;
use crate::layout::CLOSE;
use crate::listening::ListeningPoint;
use crate::piece::PieceId;

/// Height over the rim, m.
const HEIGHT: f64 = 0.08;

/// Direction from the drum's middle, rad; 0 is toward the player. Out of the way of sticks.
const DIRECTION: f64 = 2.5;

/// Gain of a microphone over a rim. *Measured*: a stroke at 6 m/s is as loud as from half a metre, within 1.5 dB, on
/// every drum; so a preamplifier would be set.
const PAD: f32 = 0.28;

/// A close microphone as it is set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloseMicrophone {
    /// Where it stands, seen from the middle of the struck surface.
    pub point: ListeningPoint,
    /// Distance from there at which sound is time zero of the mix, m; farther off it is later by the difference.
    pub time_zero: f64,
    /// Gain of its preamplifier, a factor: the same wherever it is moved.
    pub gain: f32,
}

impl CloseMicrophone {
    /// The one of a piece that was asked for at a place, or, with none, at its own (`own`).
    pub fn new(id: PieceId, asked: Option<ListeningPoint>, own: ListeningPoint) -> CloseMicrophone {
        match (asked, over_rim(id)) {
            (Some(point), Some(rim)) => CloseMicrophone { point, time_zero: rim.distance, gain: PAD },
            (asked, _) => CloseMicrophone { point: asked.unwrap_or(own), time_zero: CLOSE, gain: 1.0 },
        }
    }
}

/// Place over the rim of a drum, for those whose microphone hangs there.
pub fn over_rim(id: PieceId) -> Option<ListeningPoint> {
    let drum = match id {
        PieceId::Kick => DrumSpec::kick(),
        PieceId::Snare => DrumSpec::snare(),
        PieceId::RackTom => DrumSpec::rack_tom(),
        PieceId::FloorTom => DrumSpec::floor_tom(),
        _ => return None,
    };
    Some(ListeningPoint::over(HEIGHT, drum.batter.membrane.radius, DIRECTION))
}
