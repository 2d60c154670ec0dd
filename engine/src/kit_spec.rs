//! A kit as a document: every piece with all that is built into it, where it stands, the microphones, the room.
//!
//! Plain data in SI units. Whoever renders, measures, draws or stores a kit reads one of these;
//! [`KitSpec::standard`] is the only default there is. What acts while a piece rings is a control of its
//! [slot](crate::slot::Slot); what needs building is here. The names under which fields are serialized carry their units.

pub mod room;
mod standard;

use serde::{Deserialize, Serialize};

use crate::build_context::{BuildContext, BuildOptions, Idealization};
use crate::cymbal::spec::CymbalSpec;
use crate::drum::spec::DrumSpec;
use crate::error::SpecError;
use crate::hi_hat::spec::HiHatSpec;
use crate::layout::{FARTHEST, Layout, Pair, Placement, Point};
use crate::microphones::CloseSpec;
use crate::numbers::{self, Numbers, Visitor};
use crate::receiver::{ListeningPoint, Receivers};
use crate::slot::{SLOTS, Slot};
use crate::surface::wires;

use room::RoomSpec;

/// A kit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KitSpec {
    /// 1 to 16 pieces, each in the slot of its place here.
    pub pieces: Vec<PieceSpec>,
    /// The pairs of microphones.
    pub microphones: MicrophonesSpec,
    /// The room about the kit.
    pub room: RoomSpec,
}

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
pub enum InstrumentSpec {
    /// A drum: kick, snare, tom, timpani.
    Drum(DrumSpec),
    /// A cymbal on a stand.
    Cymbal(CymbalSpec),
    /// Two cymbals and a pedal.
    HiHat(HiHatSpec),
}

/// Which kind of instrument a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A drum, which has a pitch to tune.
    Drum,
    /// A cymbal on a stand.
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

/// The pairs of microphones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MicrophonesSpec {
    /// Above the kit, left and right, m.
    #[serde(rename = "overheads_m")]
    pub overheads: Pair,
    /// In the room, left and right, m.
    #[serde(rename = "room_m")]
    pub room: Pair,
}

/// All that building one piece depends on: where two of these are equal, so are the pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceBuild {
    /// The piece.
    pub spec: PieceSpec,
    /// From where it is heard.
    pub receivers: Receivers,
}

impl InstrumentSpec {
    /// Which kind it is.
    pub fn kind(&self) -> Kind {
        match self {
            InstrumentSpec::Drum(_) => Kind::Drum,
            InstrumentSpec::Cymbal(_) => Kind::Cymbal,
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
            InstrumentSpec::Cymbal(cymbal) if cymbal.stand.is_none() => {
                Err(SpecError::refused("stand", "is missing, accepted: a stand with bounce_hz, rock_hz, q"))
            }
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

impl Numbers for Defaults {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("muffle", &mut self.muffle, 0.0..=1.0);
        visitor.number("level_db", &mut self.level_db, -60.0..=12.0);
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

impl KitSpec {
    /// The pieces with their slots.
    pub fn slots(&self) -> impl Iterator<Item = (Slot, &PieceSpec)> {
        Slot::ALL.into_iter().zip(&self.pieces)
    }

    /// The drums with their slots.
    pub fn drums(&self) -> impl Iterator<Item = (Slot, &DrumSpec)> {
        self.slots().filter_map(|(slot, piece)| Some((slot, piece.drum()?)))
    }

    /// The piece in a slot.
    pub fn piece(&self, slot: Slot) -> Option<&PieceSpec> {
        self.pieces.get(slot.index())
    }

    /// The slot and the piece of a name.
    pub fn find(&self, name: &str) -> Option<(Slot, &PieceSpec)> {
        self.slots().find(|(_, piece)| piece.name == name)
    }

    /// A kit of one of these pieces alone, where it stands, or nothing if the slot is empty.
    #[must_use]
    pub fn alone(&self, slot: Slot) -> Option<KitSpec> {
        Some(KitSpec { pieces: vec![self.piece(slot)?.clone()], ..self.clone() })
    }

    /// Every piece changed.
    #[must_use]
    pub fn map(self, change: impl FnMut(PieceSpec) -> PieceSpec) -> KitSpec {
        KitSpec { pieces: self.pieces.into_iter().map(change).collect(), ..self }
    }

    /// Where everything stands.
    pub fn layout(&self) -> Layout {
        let MicrophonesSpec { overheads, room } = self.microphones;
        Layout {
            pieces: std::array::from_fn(|slot| self.pieces.get(slot).map(PieceSpec::placement)),
            overheads,
            room,
        }
    }

    /// What building the piece of a slot depends on.
    pub fn build(&self, slot: Slot) -> Option<PieceBuild> {
        let spec = self.piece(slot)?.clone();
        let [left, right] = self.microphones.overheads;
        let middle = std::array::from_fn(|i| 0.5 * (left[i] + right[i]));
        let seen = spec.placement().sees(&middle);
        let receivers = Receivers {
            near: spec.close.point(spec.instrument.radius()),
            far: ListeningPoint::far(seen.inclination, seen.azimuth),
        };
        Some(PieceBuild { spec, receivers })
    }

    /// Checks every number, every name, and that the pieces fit each other.
    ///
    /// # Errors
    /// [`SpecError`] with the path of what is wrong: `pieces.snare.batter.thickness_m`.
    pub fn check(&self) -> Result<(), SpecError> {
        let count = self.pieces.len();
        if !(1..=SLOTS).contains(&count) {
            return Err(SpecError::refused("pieces", format!("are {count}, accepted: 1 to {SLOTS}")));
        }
        for (at, piece) in self.pieces.iter().enumerate() {
            let path = format!("pieces.{}", piece.name);
            piece.check().map_err(|error| error.inside(&path))?;
            if self.pieces[..at].iter().any(|other| other.name == piece.name) {
                return Err(SpecError::refused(
                    &path,
                    "is there twice, accepted: a name of its own for each piece",
                ));
            }
        }
        self.check_places()?;
        for (name, pair) in [("overheads_m", &self.microphones.overheads), ("room_m", &self.microphones.room)]
        {
            for x in pair.as_flattened() {
                let path = format!("microphones.{name}");
                SpecError::check(&path, *x, -FARTHEST, FARTHEST)?;
            }
        }
        self.room.check().map_err(|error| error.inside("room"))
    }

    /// No drum stands in another.
    fn check_places(&self) -> Result<(), SpecError> {
        let drums: Vec<_> = self.pieces.iter().filter(|piece| piece.drum().is_some()).collect();
        for (at, a) in drums.iter().enumerate() {
            for b in &drums[..at] {
                let (own, other) = (a.placement(), b.placement());
                let apart = crate::layout::distance(&own.source(), &other.source());
                let least = OVERLAP * (own.radius + other.radius);
                if apart < least {
                    return Err(SpecError::refused(
                        &format!("pieces.{}.place.centre_m", a.name),
                        format!(
                            "puts its middle {apart:.2} m from that of `{}`, inside it, accepted: {least:.2} m or more",
                            b.name
                        ),
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Nearest that the middles of two drums can be, over the sum of their radii: shells that touch are a whole apart, and
/// a tom hangs over a kick.
const OVERLAP: f64 = 0.5;

impl PieceBuild {
    /// The context its instrument is built in.
    pub fn context(&self, options: BuildOptions) -> BuildContext {
        BuildContext { options, receivers: self.receivers, ideal: self.spec.ideal }
    }
}
