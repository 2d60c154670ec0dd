//! Where the close microphones stand, and how far they are turned up.
//!
//! A drum's hangs over its rim, on the side away from the player, where clips hold them. So near a head every mode is
//! heard, also those that radiate next to nothing; [`radiation`](crate::radiation) has the near field. *Fitted*:
//! of nine places from 5 to 50 cm this one brings 49 of 60 features of kick, snare and toms into the range of
//! recordings (`cargo xtask realism` measures them), one fewer than 15 cm over .8 of the radius and as close to their
//! middles as any; over the middle of a head its lowest modes drown all else.
//! Cymbals and the timpani are heard from half a metre. Responses are flat but for that of the kick's microphone, which has a
//! [contour](crate::contour).

use serde::{Deserialize, Serialize};

use crate::contour::ContourSpec;
use crate::fitted;
use crate::layout::CLOSE;
use crate::numbers::{Numbers, Visitor};
use crate::receiver::ReceiverPosition;

/// A close microphone's description.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum CloseSpec {
    /// Over the rim of a drum.
    OverRim {
        /// Height over the rim, m, 0.02 to 0.5.
        #[serde(rename = "height_m")]
        height: f64,
        /// Direction from the drum's middle, rad; 0 is toward the player; -2 pi to 2 pi.
        #[serde(rename = "azimuth_rad")]
        azimuth: f64,
        /// Gain of its preamplifier, a factor, 0.001 to 10.
        gain: f64,
        /// How far its response is from flat, if it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        contour: Option<ContourSpec>,
    },
    /// Beside the struck surface.
    Beside {
        /// Distance from its centre, m, 0.05 to 3.
        #[serde(rename = "distance_m")]
        distance: f64,
        /// Angle from its axis, rad, 0 to 1.4.
        #[serde(rename = "inclination_rad")]
        inclination: f64,
        /// Direction from its centre, rad; 0 is toward the player; -2 pi to 2 pi.
        #[serde(rename = "azimuth_rad")]
        azimuth: f64,
        /// Distance at which sound is time zero of the mix, m, 0.05 to 3.
        #[serde(rename = "time_zero_m")]
        time_zero: f64,
        /// Gain of its preamplifier, a factor, 0.001 to 10.
        gain: f64,
        /// How far its response is from flat, if it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        contour: Option<ContourSpec>,
    },
}

impl Numbers for CloseSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        const AROUND: std::ops::RangeInclusive<f64> = -std::f64::consts::TAU..=std::f64::consts::TAU;
        match self {
            CloseSpec::OverRim { height, azimuth, gain, contour } => {
                visitor.number("height_m", height, 0.02..=0.5);
                visitor.number("azimuth_rad", azimuth, AROUND);
                visitor.number("gain", gain, 1e-3..=10.0);
                contour.iter_mut().for_each(|contour| contour.visit_part("contour", visitor));
            }
            CloseSpec::Beside { distance, inclination, azimuth, time_zero, gain, contour } => {
                visitor.number("distance_m", distance, 0.05..=3.0);
                visitor.number("inclination_rad", inclination, 0.0..=1.4);
                visitor.number("azimuth_rad", azimuth, AROUND);
                visitor.number("time_zero_m", time_zero, 0.05..=3.0);
                visitor.number("gain", gain, 1e-3..=10.0);
                contour.iter_mut().for_each(|contour| contour.visit_part("contour", visitor));
            }
        }
    }
}

impl CloseSpec {
    /// Over a rim as it is clipped there, out of the way of sticks. Its gain is *fitted*: a stroke at 6 m/s is as loud as
    /// from half a metre, within 1.5 dB, on every drum of the standard kit; so a preamplifier would be set.
    pub const OVER_RIM: CloseSpec = CloseSpec::OverRim {
        height: fitted::OVER_RIM_HEIGHT,
        azimuth: fitted::OVER_RIM_AZIMUTH,
        gain: fitted::OVER_RIM_GAIN,
        contour: Some(ContourSpec::RIM),
    };

    /// At a point, with a gain of 1.
    pub const fn beside(point: ReceiverPosition) -> CloseSpec {
        let ReceiverPosition { distance, inclination, azimuth } = point;
        CloseSpec::Beside { distance, inclination, azimuth, time_zero: CLOSE, gain: 1.0, contour: None }
    }

    /// The same microphone at a point: its gain, its contour and its time zero stay.
    #[must_use]
    pub fn moved_to(&self, point: ReceiverPosition, radius: f64) -> CloseSpec {
        let ReceiverPosition { distance, inclination, azimuth } = point;
        let CloseMicrophone { time_zero, gain, .. } = self.of(radius);
        let contour = self.contour();
        CloseSpec::Beside { distance, inclination, azimuth, time_zero, gain: f64::from(gain), contour }
    }

    /// How far its response is from flat, if it is.
    pub fn contour(&self) -> Option<ContourSpec> {
        match *self {
            CloseSpec::OverRim { contour, .. } | CloseSpec::Beside { contour, .. } => contour,
        }
    }

    /// Where it stands at a piece of that radius (m), seen from the middle of the struck surface.
    pub fn point(&self, radius: f64) -> ReceiverPosition {
        match *self {
            CloseSpec::OverRim { height, azimuth, .. } => ReceiverPosition::over(height, radius, azimuth),
            CloseSpec::Beside { distance, inclination, azimuth, .. } => {
                ReceiverPosition { distance, inclination, azimuth }
            }
        }
    }

    /// The microphone at a piece of that radius, m.
    pub fn of(&self, radius: f64) -> CloseMicrophone {
        let point = self.point(radius);
        match *self {
            CloseSpec::OverRim { gain, .. } => {
                CloseMicrophone { point, time_zero: point.distance, gain: gain as f32 }
            }
            CloseSpec::Beside { time_zero, gain, .. } => {
                CloseMicrophone { point, time_zero, gain: gain as f32 }
            }
        }
    }
}

/// A close microphone as it is set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloseMicrophone {
    /// Where it stands, seen from the middle of the struck surface.
    pub point: ReceiverPosition,
    /// Distance from there at which sound is time zero of the mix, m; farther off it is later by the difference.
    pub time_zero: f64,
    /// Gain of its preamplifier, a factor: the same wherever it is moved.
    pub gain: f32,
}
