//! What a hi-hat is: its cymbals, what holds them, how they lie on each other.

use serde::{Deserialize, Serialize};

use crate::contact::Material;
use crate::cymbal::spec::CymbalSpec;
use crate::damping::LossLaw;
use crate::error::SpecError;
use crate::numbers::{self, Numbers, Visitor};

use super::rigid::Mount;
use super::warp::WarpSpec;

/// Widest lower cymbal of a stack over the upper one: more, and the rim of the upper one would stand on the bell.
const WIDEST_STACK: f64 = 2.0;

/// A hi-hat's description, or of a stack: two cymbals on one stand, one pressed on the other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HiHatSpec {
    /// The upper cymbal.
    pub top: CymbalSpec,
    /// The lower cymbal, as wide as the upper one; of a stack as wide or wider.
    pub bottom: CymbalSpec,
    /// Force with which a nut presses the upper cymbal on the lower one, N, 0.5 to 200: of a stack, which has no pedal. None of a hi-hat.
    #[serde(rename = "pressed_n", default, skip_serializing_if = "Option::is_none")]
    pub pressed: Option<f64>,
    /// What holds the upper cymbal on the rod.
    pub clutch: Mount,
    /// What holds the lower cymbal.
    pub seat: Mount,
    /// How far the lower cymbal leans, rad, 0 to 0.05.
    #[serde(rename = "tilt_rad")]
    pub tilt: f64,
    /// Toward where, rad, -2 pi to 2 pi.
    #[serde(rename = "tilt_toward_rad")]
    pub toward: f64,
    /// How far the rims are from flat.
    pub warp: WarpSpec,
    /// Radius of the rims where they meet, m, 1e-4 to 1e-2.
    #[serde(rename = "rim_radius_m")]
    pub edge: f64,
    /// What the upper rim is made of, as the lower one feels it.
    pub rim: Material,
    /// Restitution of a landing, a ratio of speeds, 0.05 to 0.95.
    pub restitution: f64,
    /// Decay rate that rims which are clamped together add to every mode of both.
    pub rubbing: LossLaw,
    /// Clamping force at which they rub half as much, N, 1 to 1000.
    #[serde(rename = "half_rubbing_n")]
    pub half_rubbing: f64,
    /// Speed of a landing that a touch that lasts is as lossy as, m/s, 0.001 to 1.
    #[serde(rename = "lasting_touch_m_s")]
    pub lasting: f64,
}

impl Numbers for HiHatSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.top.visit_part("top", visitor);
        self.bottom.visit_part("bottom", visitor);
        if let Some(pressed) = &mut self.pressed {
            visitor.number("pressed_n", pressed, 0.5..=200.0);
        }
        self.clutch.visit_part("clutch", visitor);
        self.seat.visit_part("seat", visitor);
        visitor.number("tilt_rad", &mut self.tilt, 0.0..=0.05);
        visitor.number("tilt_toward_rad", &mut self.toward, -std::f64::consts::TAU..=std::f64::consts::TAU);
        self.warp.visit_part("warp", visitor);
        visitor.number("rim_radius_m", &mut self.edge, 1e-4..=1e-2);
        self.rim.visit_part("rim", visitor);
        visitor.number("restitution", &mut self.restitution, 0.05..=0.95);
        self.rubbing.visit_part("rubbing", visitor);
        visitor.number("half_rubbing_n", &mut self.half_rubbing, 1.0..=1000.0);
        visitor.number("lasting_touch_m_s", &mut self.lasting, 1e-3..=1.0);
    }
}

impl HiHatSpec {
    /// Where the rim of the upper cymbal meets the two, shares of the radii of the upper and the lower one: the rims of hi-hats meet, whose cymbals are
    /// as wide as each other within what [`check`](Self::check) accepts.
    pub fn meeting(&self) -> [f64; 2] {
        let below = if self.pressed.is_some() { self.top.diameter / self.bottom.diameter } else { 1.0 };
        [1.0, below.min(1.0)]
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the first that is out of range.
    pub fn check(&self) -> Result<(), SpecError> {
        numbers::check(self)?;
        for (name, half) in [("top", &self.top), ("bottom", &self.bottom)] {
            half.check().map_err(|error| error.inside(name))?;
            if half.stand.is_some() {
                return Err(SpecError::refused(
                    &format!("{name}.stand"),
                    "is given, accepted: none, a hi-hat's cymbals are held by clutch and seat",
                ));
            }
            if half.hammering.is_some() {
                return Err(SpecError::refused(
                    &format!("{name}.hammering"),
                    "is given, accepted: none, the rims of a hi-hat meet by the orders of turned cymbals",
                ));
            }
            if half.rivets.is_some() {
                return Err(SpecError::refused(
                    &format!("{name}.rivets"),
                    "is given, accepted: none, rivets are in cymbals on stands",
                ));
            }
        }
        // Rims of different radii would not meet; the upper cymbal of a stack stands on the lower one.
        let most = if self.pressed.is_some() { WIDEST_STACK } else { 1.01 };
        let (min, max) = (0.99 * self.top.diameter, most * self.top.diameter);
        SpecError::check("bottom.diameter_m", self.bottom.diameter, min, max)?;
        Ok(())
    }
}
