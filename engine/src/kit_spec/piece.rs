//! A piece of a kit as a document: what it is, where it stands, how its controls stand.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::build_context::Idealization;
use crate::cymbal::spec::CymbalSpec;
use crate::drum::spec::DrumSpec;
use crate::error::SpecError;
use crate::hi_hat::spec::HiHatSpec;
use crate::layout::{FARTHEST, Placement, Point};
use crate::microphones::CloseSpec;
use crate::numbers::{self, Numbers, Visitor};
use crate::surface::wires;

/// A piece of a kit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PieceSpec {
    /// Name on command lines, in files and parameters: lower-case letters, digits and dashes; its own in the kit.
    pub name: String,
    /// Name on screen and of its output.
    pub title: String,
    /// What it is.
    pub instrument: InstrumentSpec,
    /// Where it stands.
    pub place: PlaceSpec,
    /// Its close microphone.
    pub close: CloseSpec,
    /// How its controls stand before anybody moves them.
    pub defaults: Defaults,
    /// What is left out of it, for measurements.
    #[serde(default, skip_serializing_if = "Idealization::is_none")]
    pub ideal: Idealization,
}

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[expect(clippy::large_enum_variant, reason = "a kit has sixteen at most")]
pub enum InstrumentSpec {
    /// A drum: kick, snare, tom, timpani.
    Drum(DrumSpec),
    /// A cymbal on a stand.
    Cymbal(CymbalSpec),
    /// Two cymbals and a pedal, or a stack of two.
    HiHat(HiHatSpec),
}

/// Which kind of instrument a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A drum, which has a pitch to tune.
    Drum,
    /// A cymbal on a stand, or a stack of two.
    Cymbal,
    /// Two cymbals and a pedal.
    HiHat,
}

/// Where a piece stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaceSpec {
    /// Centre of the struck surface, m; see [`layout`](crate::layout) for the directions.
    #[serde(rename = "centre_m")]
    pub centre: Point,
    /// Where the struck side faces; of any length but zero.
    pub facing: Point,
}

/// How a piece's controls stand before anybody moves them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Defaults {
    /// Muffling, 0 to 1.
    pub muffle: f64,
    /// Level in every microphone, dB, -60 (silent) to 12.
    pub level_db: f64,
    /// Place in the stereo, -1 (left) to 1 (right).
    pub pan: f64,
    /// Force that presses snare wires on, N, 0.03 to 1.5; of a drum with wires.
    #[serde(rename = "preload_n", default, skip_serializing_if = "Option::is_none")]
    pub preload: Option<f64>,
}

impl InstrumentSpec {
    /// Which kind it is.
    pub fn kind(&self) -> Kind {
        match self {
            InstrumentSpec::Drum(_) => Kind::Drum,
            InstrumentSpec::Cymbal(_) => Kind::Cymbal,
            // A stack has no pedal, and is played as any other cymbal.
            InstrumentSpec::HiHat(hat) if hat.pressed.is_some() => Kind::Cymbal,
            InstrumentSpec::HiHat(_) => Kind::HiHat,
        }
    }

    /// Lowest, own and highest tuning: Hz of a drum, ratio of a cymbal.
    pub fn tunings(&self) -> [f64; 3] {
        match self {
            InstrumentSpec::Drum(drum) => drum.pitches(),
            InstrumentSpec::Cymbal(_) | InstrumentSpec::HiHat(_) => {
                let (low, own, high) = CymbalSpec::TUNING;
                [low, own, high]
            }
        }
    }

    /// Radius of what is struck, m.
    pub fn radius(&self) -> f64 {
        0.5 * match self {
            InstrumentSpec::Drum(drum) => drum.diameter,
            InstrumentSpec::Cymbal(cymbal) => cymbal.diameter,
            InstrumentSpec::HiHat(hat) => hat.top.diameter,
        }
    }

    fn check(&self) -> Result<(), SpecError> {
        match self {
            InstrumentSpec::Drum(drum) => drum.check(),
            InstrumentSpec::Cymbal(cymbal) if cymbal.stand.is_none() => Err(SpecError::refused(
                "stand",
                "is missing, accepted: a stand with bounce_hz, rock_hz, q, rock_q",
            )),
            InstrumentSpec::Cymbal(cymbal) => cymbal.check(),
            InstrumentSpec::HiHat(hat) => hat.check(),
        }
    }
}

impl Numbers for InstrumentSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        match self {
            InstrumentSpec::Drum(drum) => drum.visit(visitor),
            InstrumentSpec::Cymbal(cymbal) => cymbal.visit(visitor),
            InstrumentSpec::HiHat(hat) => hat.visit(visitor),
        }
    }
}

impl Defaults {
    /// Accepted levels, dB.
    pub const LEVEL_DB: RangeInclusive<f64> = -60.0..=12.0;
}

impl Numbers for Defaults {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("muffle", &mut self.muffle, 0.0..=1.0);
        visitor.number("level_db", &mut self.level_db, Defaults::LEVEL_DB);
        visitor.number("pan", &mut self.pan, -1.0..=1.0);
        if let Some(preload) = &mut self.preload {
            visitor.number("preload_n", preload, wires::PRELOAD);
        }
    }
}

impl Numbers for PlaceSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        for (axis, x) in ["centre_m.x", "centre_m.y", "centre_m.z"].into_iter().zip(&mut self.centre) {
            visitor.number(axis, x, -FARTHEST..=FARTHEST);
        }
        for (axis, x) in ["facing.x", "facing.y", "facing.z"].into_iter().zip(&mut self.facing) {
            visitor.number(axis, x, -1e3..=1e3);
        }
    }
}

impl Numbers for PieceSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.instrument.visit(visitor);
        self.place.visit_part("place", visitor);
        self.close.visit_part("close", visitor);
        self.defaults.visit_part("defaults", visitor);
    }
}

impl PieceSpec {
    /// Where it stands and how much room it takes.
    pub fn placement(&self) -> Placement {
        let PlaceSpec { centre, facing } = self.place;
        let (depth, radius) = match &self.instrument {
            InstrumentSpec::Drum(drum) => (drum.body_depth(), drum.radius()),
            // Cymbals hang above.
            InstrumentSpec::Cymbal(_) | InstrumentSpec::HiHat(_) => (0.0, 0.0),
        };
        Placement::new(centre, facing, depth, radius)
    }

    /// The drum, if it is one.
    pub fn drum(&self) -> Option<&DrumSpec> {
        match &self.instrument {
            InstrumentSpec::Drum(drum) => Some(drum),
            _ => None,
        }
    }

    /// The same piece without losses: all damping and radiation off.
    #[must_use]
    pub fn lossless(self) -> PieceSpec {
        PieceSpec { ideal: Idealization { lossless: true, ..self.ideal }, ..self }
    }

    /// The same piece with small bending: no stretch of heads, no coupling of modes.
    #[must_use]
    pub fn linear(self) -> PieceSpec {
        PieceSpec { ideal: Idealization { linear: true, ..self.ideal }, ..self }
    }

    /// The same piece, perfectly round.
    #[must_use]
    pub fn round(self) -> PieceSpec {
        PieceSpec { ideal: Idealization { round: true, ..self.ideal }, ..self }
    }

    /// Checks everything about it but its neighbours.
    ///
    /// # Errors
    /// [`SpecError`] with the path of what is wrong inside the piece.
    pub fn check(&self) -> Result<(), SpecError> {
        let known = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let starts = self.name.starts_with(|c: char| c.is_ascii_lowercase());
        if !starts || !self.name.chars().all(known) || self.name.len() > 24 || RESERVED.contains(&&*self.name)
        {
            return Err(SpecError::refused(
                "name",
                format!(
                    "is `{}`, accepted: 1 to 24 lower-case letters, digits and dashes, a letter first, none of {}",
                    self.name,
                    RESERVED.join(", ")
                ),
            ));
        }
        let title = self.title.trim();
        if title.is_empty() || title.chars().count() > 24 || title.chars().any(char::is_control) {
            return Err(SpecError::refused(
                "title",
                format!("is `{}`, accepted: 1 to 24 characters", self.title),
            ));
        }
        self.instrument.check()?;
        numbers::check(self)?;
        if self.place.facing.iter().map(|x| x * x).sum::<f64>() < 1e-6 {
            return Err(SpecError::refused("place.facing", "has no length, accepted: a direction"));
        }
        let wires = self.drum().is_some_and(|drum| drum.wires.is_some());
        match (wires, self.defaults.preload) {
            (true, None) => {
                Err(SpecError::refused("defaults.preload_n", "is missing, accepted: 0.03 to 1.5"))
            }
            (false, Some(_)) => {
                Err(SpecError::refused("defaults.preload_n", "is given, accepted: only on a drum with wires"))
            }
            _ => Ok(()),
        }
    }
}

/// Names that mean something else where pieces are named.
const RESERVED: [&str; 6] = ["overheads", "room", "master", "close", "kit", "slot"];
