//! Points from which a disc is heard, and what a disc and its modes show of themselves toward one.
//!
//! Coordinates: seen from the disc's centre; angles as in [`Strike`](crate::strike::Strike).

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::mode::Member;
use crate::numbers::{Numbers, Visitor};

/// A listening point beside a disc.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReceiverPosition {
    /// Distance from the disc's centre, m, 0.02 to 20.
    #[serde(rename = "distance_m")]
    pub distance: f64,
    /// Angle from the disc's axis, rad, 0 to 1.5.
    #[serde(rename = "inclination_rad")]
    pub inclination: f64,
    /// Direction of the point seen from the centre, in the disc's own angle, rad, -2 pi to 2 pi.
    #[serde(rename = "azimuth_rad")]
    pub azimuth: f64,
}

impl Numbers for ReceiverPosition {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("distance_m", &mut self.distance, 0.02..=20.0);
        visitor.number("inclination_rad", &mut self.inclination, 0.0..=1.5);
        visitor.number("azimuth_rad", &mut self.azimuth, -TAU..=TAU);
    }
}

/// Distance from which everything is far, m: a head's finest wave in air reaches its far field within half of it.
const FAR: f64 = 8.0;

impl ReceiverPosition {
    /// A point far away in a direction (rad), at least a little above the disc's plane.
    pub const fn far(inclination: f64, azimuth: f64) -> ReceiverPosition {
        ReceiverPosition { distance: FAR, inclination: inclination.clamp(0.0, 1.45), azimuth }
    }

    /// The same point seen from a place `depth` (m) further along the disc's axis, away from it.
    pub fn from_behind(&self, depth: f64) -> ReceiverPosition {
        let (sin, cos) = self.inclination.sin_cos();
        let (height, offset) = (self.distance * cos + depth, self.distance * sin);
        ReceiverPosition { distance: height.hypot(offset), inclination: offset.atan2(height), ..*self }
    }

    /// A point at that height (m) over a place on the disc: distance from the centre, m, and direction, rad.
    pub fn over(height: f64, offset: f64, azimuth: f64) -> ReceiverPosition {
        ReceiverPosition { distance: height.hypot(offset), inclination: offset.atan2(height), azimuth }
    }

    /// Height over the disc's plane and distance from its axis, m.
    pub fn height_and_offset(&self) -> [f64; 2] {
        let (sin, cos) = self.inclination.sin_cos();
        [self.distance * cos, self.distance * sin]
    }

    /// How much of the half-space a disc of that radius (m) fills, seen from the point: its solid angle over 2 pi.
    pub fn fills(&self, radius: f64) -> f64 {
        /// Directions about the foot of the point. *Derived*: 1e-3 off at a tenth of the radius over the rim.
        const DIRECTIONS: usize = 192;
        let [height, offset] = self.height_and_offset();
        // Of a sector of the disc, `int h r / d^3 dr` in closed form.
        let square = self.distance * self.distance;
        let sector = |i: usize| {
            let along = offset * (PI * (i as f64 + 0.5) / DIRECTIONS as f64).cos();
            let edge = (square - 2.0 * along * radius + radius * radius).sqrt();
            ((along * radius - square) / edge + self.distance) / (square - along * along)
        };
        height * (0..DIRECTIONS).map(sector).sum::<f64>() / DIRECTIONS as f64
    }

    /// Distance to a place on the disc, `radius` (m) from its centre in direction `angle` (rad), m.
    pub fn distance_to(&self, radius: f64, angle: f64) -> f64 {
        let offset = self.distance * self.inclination.sin();
        let across = 2.0 * offset * radius * (angle - self.azimuth).cos();
        (self.distance * self.distance + radius * radius - across).sqrt()
    }

    /// Root mean square of one over the distance to the rim of a disc of that radius (m), 1/m.
    pub fn rim_nearness(&self, radius: f64) -> f64 {
        let offset = self.distance * self.inclination.sin();
        let mean = self.distance * self.distance + radius * radius;
        (mean * mean - 4.0 * (offset * radius).powi(2)).sqrt().sqrt().recip()
    }

    /// What a member whose pair's axes lie at `axis` (rad) shows of itself toward the point, -1 to 1.
    pub fn toward(&self, m: u32, member: Member, axis: f64) -> f64 {
        let (sin, cos) = (f64::from(m) * (self.azimuth - axis)).sin_cos();
        match member {
            Member::Cosine => cos,
            Member::Sine => sin,
        }
    }
}

/// Directions in which a piece is heard from far away: those of the left and the right overhead.
pub const DIRECTIONS: usize = 2;

/// Points from which all of a piece is heard: the near one, then those far away.
pub const POINTS: usize = 1 + DIRECTIONS;

/// From where a piece is heard, seen from its struck surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Receivers {
    /// The close microphone.
    pub near: ReceiverPosition,
    /// Points far away, one in each direction.
    pub far: [ReceiverPosition; DIRECTIONS],
}

impl Receivers {
    /// All points, the near one first.
    pub fn points(&self) -> [ReceiverPosition; POINTS] {
        std::array::from_fn(|i| if i == 0 { self.near } else { self.far[i - 1] })
    }

    /// Factor that makes of the pressure at each point the one that is passed on, dimensionless: from far away, that at a metre.
    pub fn scales(&self) -> [f64; POINTS] {
        std::array::from_fn(|i| if i == 0 { 1.0 } else { self.far[i - 1].distance })
    }
}
