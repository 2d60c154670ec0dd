//! A kit as a document: every piece with all that is built into it, where it stands, the microphones, the room.
//!
//! Plain data in SI units. Whoever renders, measures, draws or stores a kit reads one of these;
//! [`KitSpec::standard`] is the only default there is. What acts while a piece rings is a control of its
//! [slot](crate::slot::Slot); what needs building is here. The names under which fields are serialized carry their units.

pub mod piece;
pub mod places;
pub mod room;
mod standard;

use serde::{Deserialize, Serialize};

use crate::build_context::{BuildContext, BuildOptions};
use crate::drum::spec::DrumSpec;
use crate::error::SpecError;
use crate::layout::{FARTHEST, Layout, Pair, Point};
use crate::receiver::{ReceiverPosition, Receivers};
use crate::slot::{SLOTS, Slot};

pub use piece::{Defaults, InstrumentSpec, Kind, PieceSpec, PlaceSpec};
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
        let placement = spec.placement();
        let toward = |microphone: Point| {
            let seen = placement.sees(&microphone);
            ReceiverPosition::far(seen.inclination, seen.azimuth)
        };
        let receivers = Receivers {
            near: spec.close.point(spec.instrument.radius()),
            far: self.microphones.overheads.map(toward),
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

    /// No piece stands in another.
    fn check_places(&self) -> Result<(), SpecError> {
        for (at, piece) in self.pieces.iter().enumerate() {
            let Some(other) = self.pieces[..at].iter().find(|other| places::inside(piece, other)) else {
                continue;
            };
            let [x, y, z] = piece.place.centre;
            let others = self.pieces.iter().filter(|other| other.name != piece.name);
            let accepted = places::free_place(piece, others).map_or_else(
                || "another place".to_owned(),
                |[x, y, z]| format!("[{x}, {y}, {z}], the nearest place that is free"),
            );
            return Err(SpecError::refused(
                &format!("pieces.{}.place.centre_m", piece.name),
                format!("is [{x:.2}, {y:.2}, {z:.2}], inside `{}`, accepted: {accepted}", other.name),
            ));
        }
        Ok(())
    }
}

impl PieceBuild {
    /// The context its instrument is built in.
    pub fn context(&self, options: BuildOptions) -> BuildContext {
        BuildContext { options, receivers: self.receivers, ideal: self.spec.ideal }
    }
}
