//! What a cymbal is: its plate and shape, what it is made of, held, muffled.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::damping::{LossLaw, Muffler};
use crate::error::SpecError;
use crate::numbers::{self, Numbers, Visitor};
use crate::plate::{Bell, Flange, PlateSpec};
use crate::split::Splitting;
use crate::surface::rivets::RivetsSpec;

use super::alloy::Alloy;
use super::hammering::HammeringSpec;

/// A cymbal's description.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CymbalSpec {
    /// Diameter, m, 0.1 to 0.8.
    #[serde(rename = "diameter_m")]
    pub diameter: f64,
    /// Mass, kg, up to 20: that of a plate from 0.4 mm to a hundredth of the diameter thick.
    #[serde(rename = "mass_kg")]
    pub mass: f64,
    /// Rise of the bow's centre over its rim, without the bell, m, 0 (flat) to a quarter of the diameter.
    #[serde(rename = "bow_m")]
    pub bow: f64,
    /// What rises over the bow in the middle, if anything does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bell: Option<Bell>,
    /// What turns up toward the rim, as a china's does, if anything does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flange: Option<Flange>,
    /// Thickness at the rim over that in the middle, 0.3 to 1 (as thick everywhere).
    pub taper: f64,
    /// What it is made of.
    pub alloy: Alloy,
    /// Losses beside those of the alloy: by heat and by internal friction.
    pub loss: LossLaw,
    /// What holds it; none of a hi-hat's cymbal, which its mount holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand: Option<Stand>,
    /// What muffles it.
    pub muffler: Muffler,
    /// How far the members of pairs are apart.
    pub evenness: Splitting,
    /// How it is hammered, if it is; none of a hi-hat's cymbal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hammering: Option<HammeringSpec>,
    /// Its rivets, if it has any; none of a hi-hat's cymbal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rivets: Option<RivetsSpec>,
}

/// A cymbal stand: felts the plate bounces and rocks on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stand {
    /// Frequency of the bounce, Hz, 1 to 200.
    pub bounce_hz: f64,
    /// Frequency of the rock, Hz, 0.5 to 100.
    pub rock_hz: f64,
    /// Quality factor of the bounce, and of the felts for whatever else moves on them, 0.6 to 100.
    pub q: f64,
    /// Quality factor of the rock, 0.6 to 100.
    pub rock_q: f64,
}

impl Numbers for Stand {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("bounce_hz", &mut self.bounce_hz, 1.0..=200.0);
        visitor.number("rock_hz", &mut self.rock_hz, 0.5..=100.0);
        visitor.number("q", &mut self.q, 0.6..=100.0);
        visitor.number("rock_q", &mut self.rock_q, 0.6..=100.0);
    }
}

impl Numbers for CymbalSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("diameter_m", &mut self.diameter, 0.1..=0.8);
        self.alloy.visit_part("alloy", visitor);
        // Within 20 kg, what a plate of this metal weighs that is as thin or as thick as is accepted.
        let face = self.alloy.density * PI * (0.5 * self.diameter).powi(2);
        let (lightest, heaviest) = (face * PlateSpec::THINNEST, face * PlateSpec::THICKEST * self.diameter);
        visitor.number("mass_kg", &mut self.mass, lightest..=heaviest.min(PlateSpec::HEAVIEST));
        visitor.number("bow_m", &mut self.bow, 0.0..=0.25 * self.diameter);
        if let Some(bell) = &mut self.bell {
            let radius = 0.5 * self.diameter;
            visitor.enter("bell");
            visitor.number("radius_m", &mut bell.radius, 0.05 * radius..=0.5 * radius);
            visitor.number("rise_m", &mut bell.rise, 0.0..=Bell::HIGHEST * bell.radius);
            visitor.leave();
        }
        if let Some(flange) = &mut self.flange {
            let radius = 0.5 * self.diameter;
            visitor.enter("flange");
            visitor.number("radius_m", &mut flange.radius, 0.5 * radius..=0.95 * radius);
            visitor.number("rise_m", &mut flange.rise, 0.0..=0.25 * radius);
            visitor.leave();
        }
        visitor.number("taper", &mut self.taper, 0.3..=1.0);
        self.loss.visit_part("loss", visitor);
        if let Some(stand) = &mut self.stand {
            stand.visit_part("stand", visitor);
        }
        self.muffler.visit_part("muffler", visitor);
        self.evenness.visit_part("evenness", visitor);
        if let Some(hammering) = &mut self.hammering {
            hammering.visit_part("hammering", visitor);
        }
        if let Some(rivets) = &mut self.rivets {
            rivets.visit_part("rivets", visitor);
        }
    }
}

impl CymbalSpec {
    /// Lowest, default and highest ratio a cymbal's frequencies can be scaled by.
    pub const TUNING: (f64, f64, f64) = (0.5, 1.0, 2.0);

    /// The plate.
    pub fn plate(&self) -> PlateSpec {
        PlateSpec {
            diameter: self.diameter,
            mass: self.mass,
            rise: self.bow,
            bell: self.bell,
            flange: self.flange,
            taper: self.taper,
            youngs_modulus: self.alloy.youngs_modulus,
            poisson_ratio: self.alloy.poisson_ratio,
            density: self.alloy.density,
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the first that is out of range.
    pub fn check(&self) -> Result<(), SpecError> {
        numbers::check(self)?;
        if let Muffler::Pillow { .. } | Muffler::Ring { .. } = self.muffler {
            return Err(SpecError::refused("muffler.kind", "is of drums, accepted for a cymbal: gel"));
        }
        if let Some(rivets) = &self.rivets {
            rivets.check().map_err(|error| error.inside("rivets"))?;
        }
        self.plate().check()
    }
}
