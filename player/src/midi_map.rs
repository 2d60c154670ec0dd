//! The reference notes of a kit: which note strikes what, where, and with what.
//!
//! A table like this belongs to a kit and is stored with it; [`NoteTable::standard`] is that of the standard kit: the General
//! MIDI drum map and beyond. Maps of other instruments and the user's own assignments name notes of this table.

use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::{Kind, KitSpec};
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::strike::Striker;

use crate::midi::figures::Figure;

mod standard;

/// MIDI notes.
pub const NOTES: usize = 128;

/// The controllers that may move the place of strokes.
pub const POSITION_CONTROLLERS: std::ops::RangeInclusive<u8> = 16..=19;

/// Longest name of a note, characters.
pub const LONGEST_NAME: usize = 40;

/// What a note strikes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Slot of the piece.
    pub slot: Slot,
    /// Distance from the centre as a share of the radius, 0 to 1.
    pub radius: f64,
    /// Direction of the place seen from the centre, rad; 0 is toward the player.
    pub angle: f64,
    /// What is swung.
    pub striker: Striker,
}

impl Stroke {
    /// Whether a position controller moves the stroke on a piece of a kind: those with a stick's tip or a mallet between
    /// bell and edge.
    pub fn moves_with_hand(&self, kind: Kind) -> bool {
        let (inner, outer) = reach(kind);
        let tip = !matches!(self.striker, Striker::CrossStick | Striker::RimShot | Striker::Shoulder);
        tip && (inner..=outer).contains(&self.radius)
    }
}

/// Least and greatest distance from the centre that a position controller reaches, shares of the radius.
pub fn reach(kind: Kind) -> (f64, f64) {
    match kind {
        Kind::Drum => (0.0, 0.95),
        // The bell has its own notes.
        Kind::Cymbal | Kind::HiHat => (0.25, 0.97),
    }
}

/// What a note does with a hi-hat's pedal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// It is there, 0 (up) to 1 (down), within milliseconds. Where a controller plays the pedal, see
    /// [`Playing::foot`](crate::midi::playing::Playing::foot).
    Position(f64),
    /// It is brought down as fast as the note is loud.
    Chick,
    /// It is brought down as fast as the note is loud, and up at once.
    Splash,
}

/// What a note means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    /// It strikes a piece.
    Strikes(Stroke),
    /// It is the pedal of the hi-hat in a slot.
    Steps(Slot, Foot),
    /// A hand grips the cymbal in a slot, as firmly as the note is loud, until the cymbal's next stroke.
    Chokes(Slot),
    /// The snare wires of the drum in a slot are thrown on or off.
    Throws(Slot, bool),
    /// It makes no sound.
    Silent,
}

/// A note of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its name on screen.
    pub name: String,
    /// What it means.
    pub meaning: Meaning,
    /// Position of a hi-hat's pedal at the stroke, 0 (up) to 1 (down).
    pub pedal: Option<f64>,
    /// Whether a drum's snare wires lie on at the stroke; none where they are as the player has set them.
    pub wires: Option<bool>,
    /// What the stroke is the beginning of, if it is no single one.
    pub figure: Option<Figure>,
}

impl Row {
    /// A row of a meaning, which leaves pedals and wires where they are.
    pub fn new(name: &str, meaning: Meaning) -> Row {
        Row { name: name.to_owned(), meaning, pedal: None, wires: None, figure: None }
    }
}

impl Meaning {
    /// The slot of the piece that it is about.
    pub fn slot(&self) -> Option<Slot> {
        match *self {
            Meaning::Strikes(Stroke { slot, .. })
            | Meaning::Steps(slot, _)
            | Meaning::Chokes(slot)
            | Meaning::Throws(slot, _) => Some(slot),
            Meaning::Silent => None,
        }
    }
}

/// What every note plays on a kit, and which controllers move the places of strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct NoteTable {
    /// `[note]`.
    rows: Vec<Option<Row>>,
    position_controllers: [Option<u8>; SLOTS],
    ordinary: [Option<u8>; SLOTS],
}

impl Default for NoteTable {
    /// A table in which no note plays anything.
    fn default() -> Self {
        NoteTable { rows: vec![None; NOTES], position_controllers: [None; SLOTS], ordinary: [None; SLOTS] }
    }
}

impl NoteTable {
    /// The row of a note, if it is in the table.
    ///
    /// # Real-time
    /// A table look-up.
    pub fn row(&self, note: u8) -> Option<&Row> {
        self.rows.get(usize::from(note))?.as_ref()
    }

    /// The stroke that a note asks for, if it strikes.
    ///
    /// # Real-time
    /// A table look-up.
    pub fn stroke(&self, note: u8) -> Option<&Stroke> {
        match &self.row(note)?.meaning {
            Meaning::Strikes(stroke) => Some(stroke),
            _ => None,
        }
    }

    /// What a note does with a hi-hat's pedal, and in which slot, if it does: by itself or before its stroke.
    ///
    /// # Real-time
    /// A table look-up.
    pub fn foot(&self, note: u8) -> Option<(Slot, Foot)> {
        let row = self.row(note)?;
        match row.meaning {
            Meaning::Steps(slot, foot) => Some((slot, foot)),
            Meaning::Strikes(stroke) => Some((stroke.slot, Foot::Position(row.pedal?))),
            _ => None,
        }
    }

    /// Every note of the table with its row, lowest first.
    pub fn rows(&self) -> impl Iterator<Item = (u8, &Row)> {
        (0..).zip(&self.rows).filter_map(|(note, row)| Some((note, row.as_ref()?)))
    }

    /// Puts a row in a note's place, or takes it out. Notes beyond 127 are ignored.
    pub fn set(&mut self, note: u8, row: Option<Row>) {
        if let Some(place) = self.rows.get_mut(usize::from(note)) {
            *place = row;
        }
    }

    /// The controller, 16 to 19, that moves the place of strokes on a slot's piece.
    ///
    /// # Real-time
    /// A table look-up.
    pub fn position_controller(&self, slot: Slot) -> Option<u8> {
        self.position_controllers[slot.index()]
    }

    /// Lets a controller move the place of strokes on a slot's piece, or none.
    pub fn set_position_controller(&mut self, slot: Slot, controller: Option<u8>) {
        self.position_controllers[slot.index()] = controller;
    }

    /// The note that stands for a slot's piece: what is struck where nobody says more than the piece.
    pub fn ordinary(&self, slot: Slot) -> Option<u8> {
        self.ordinary[slot.index()]
    }

    /// Lets a note stand for a slot's piece, or none.
    pub fn set_ordinary(&mut self, slot: Slot, note: Option<u8>) {
        self.ordinary[slot.index()] = note;
    }

    /// Checks that notes play pieces that a kit has.
    ///
    /// # Errors
    /// [`SpecError`] with the path of what is wrong: `38.radius`.
    pub fn check(&self, kit: &KitSpec) -> Result<(), SpecError> {
        for (note, row) in self.rows() {
            row.check(kit).map_err(|error| error.inside(&note.to_string()))?;
        }
        for slot in Slot::ALL {
            let path = kit
                .piece(slot)
                .map_or_else(|| format!("slot {}", slot.index() + 1), |piece| piece.name.clone());
            let controller = self.position_controller(slot);
            if controller.is_some_and(|it| kit.piece(slot).is_none() || !POSITION_CONTROLLERS.contains(&it)) {
                let reason = "is not accepted: one of 16 to 19, on a piece of the kit";
                return Err(SpecError::refused("position_controller", reason).inside(&path));
            }
            let strikes = |note: u8| self.stroke(note).is_some_and(|stroke| stroke.slot == slot);
            if let Some(note) = self.ordinary(slot).filter(|&note| !strikes(note)) {
                let reason = format!("is {note}, accepted: a note that strikes the piece");
                return Err(SpecError::refused("ordinary", reason).inside(&path));
            }
        }
        Ok(())
    }
}

impl Row {
    fn check(&self, kit: &KitSpec) -> Result<(), SpecError> {
        let length = self.name.trim().chars().count();
        if length == 0 || length > LONGEST_NAME || self.name.chars().any(char::is_control) {
            let reason = format!("is `{}`, accepted: 1 to {LONGEST_NAME} characters", self.name);
            return Err(SpecError::refused("name", reason));
        }
        let kind = |slot: Slot| {
            let piece = kit.piece(slot).map(|piece| piece.instrument.kind());
            piece.ok_or_else(|| SpecError::refused("piece", "is not in the kit, accepted: one of its pieces"))
        };
        self.check_wires(kit)?;
        let stepped = match self.meaning {
            Meaning::Silent | Meaning::Throws(..) => None,
            Meaning::Chokes(slot) => {
                if kind(slot)? == Kind::Drum {
                    return Err(SpecError::refused("choke", "is given, accepted: only on a cymbal"));
                }
                None
            }
            Meaning::Strikes(Stroke { slot, radius, angle, .. }) => {
                SpecError::check("radius", radius, 0.0, 1.0)?;
                SpecError::check("angle_rad", angle, -std::f64::consts::TAU, std::f64::consts::TAU)?;
                Some(kind(slot)?).filter(|_| self.pedal.is_some())
            }
            Meaning::Steps(slot, foot) => {
                if let Foot::Position(place) = foot {
                    SpecError::check("pedal", place, 0.0, 1.0)?;
                }
                Some(kind(slot)?)
            }
        };
        if self.pedal.is_some() && !matches!(self.meaning, Meaning::Strikes(_)) {
            return Err(SpecError::refused("pedal", "is given, accepted: only before a stroke"));
        }
        if self.figure.is_some() && !matches!(self.meaning, Meaning::Strikes(_)) {
            return Err(SpecError::refused("figure", "is given, accepted: only with a stroke"));
        }
        SpecError::check("pedal", self.pedal.unwrap_or(0.0), 0.0, 1.0)?;
        match stepped {
            Some(Kind::Drum | Kind::Cymbal) => {
                Err(SpecError::refused("pedal", "is given, accepted: only on a hi-hat"))
            }
            Some(Kind::HiHat) | None => Ok(()),
        }
    }

    /// Checks that wires which a note throws are there.
    fn check_wires(&self, kit: &KitSpec) -> Result<(), SpecError> {
        let thrown = match self.meaning {
            Meaning::Throws(slot, _) => Some(slot),
            Meaning::Strikes(stroke) if self.wires.is_some() => Some(stroke.slot),
            _ if self.wires.is_some() => {
                return Err(SpecError::refused("wires", "is given, accepted: only with a stroke"));
            }
            _ => None,
        };
        // On a drum without wires it does nothing.
        let drum = |slot: Slot| kit.piece(slot).is_some_and(|piece| piece.instrument.kind() == Kind::Drum);
        match thrown {
            Some(slot) if !drum(slot) => {
                Err(SpecError::refused("wires", "is given, accepted: only on a drum of the kit"))
            }
            _ => Ok(()),
        }
    }
}
