//! The notes of a kit file: `notes` of each piece, and those that are silent.

mod entry;
mod text;

use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::{Kind, KitSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use toml::Value;

use crate::kit_document::KitDocument;
use crate::midi_map::{Meaning, NOTES, NoteTable, Row, Stroke};

use super::catalogue;
use super::drafts::Draft;
use super::error::{Fault, quoted};
use super::laying::NONE;
use super::source::Origins;
use super::typed;

use entry::Entry;

pub(super) use text::{write, write_silent};

/// Reads the notes of a kit.
pub(super) struct Reader<'a> {
    /// What the file starts from, if it does.
    pub(super) start: Option<&'a KitDocument>,
    /// The kit as it is with the file's changes, its pieces those of the drafts.
    pub(super) kit: &'a KitSpec,
    /// What the file says about each.
    pub(super) drafts: &'a [Draft],
    /// Where it says so.
    pub(super) origins: &'a Origins,
}

/// Notes that a file gives to pieces or to silence, with the paths of the entries.
struct Claims(Vec<Option<String>>);

impl Claims {
    fn take(&mut self, note: u8, path: &str, origins: &Origins) -> Result<(), Fault> {
        let Some(place) = self.0.get_mut(usize::from(note)) else { return Ok(()) };
        if let Some(other) = place {
            let other = origins.locate(other).path;
            let reason = format!("is note {note}, which {other} has too, accepted: each note once");
            return Err(Fault::of(path, origins, &reason));
        }
        *place = Some(path.to_owned());
        Ok(())
    }
}

impl Reader<'_> {
    /// The table of notes, checked.
    pub(super) fn read(&self, silent: Option<&Value>) -> Result<NoteTable, Fault> {
        let mut table = self.started();
        let mut claims = Claims(vec![None; NOTES]);
        for (slot, piece) in self.kit.slots() {
            let Some(draft) = self.drafts.get(slot.index()) else { continue };
            let path = format!("pieces.{}", piece.name);
            if let Some(controller) = draft.beside.get("position_controller") {
                let path = format!("{path}.position_controller");
                table.set_position_controller(slot, self.controller(controller, &path)?);
            }
            if let Some(notes) = draft.beside.get("notes") {
                self.piece(&mut table, &mut claims, (slot, piece, draft), notes)?;
            }
        }
        self.silence(&mut table, &mut claims, silent)?;
        // A piece whose note another has taken has lost it.
        for slot in Slot::ALL {
            let strikes = |note: &u8| table.stroke(*note).is_some_and(|stroke| stroke.slot == slot);
            if table.ordinary(slot).is_some_and(|note| !strikes(&note)) {
                let first = table.rows().map(|(note, _)| note).find(strikes);
                table.set_ordinary(slot, first);
            }
        }
        table
            .check(self.kit)
            .map_err(|error| Fault::of_spec(&in_file(error, &claims, self.origins), self.origins))?;
        Ok(table)
    }

    /// The notes of the start: of its pieces that keep theirs; the others are silent.
    fn started(&self) -> NoteTable {
        let mut table = NoteTable::default();
        let Some(start) = self.start else { return table };
        let keeps = |slot: Slot| -> Option<Slot> {
            let name = &start.kit.piece(slot)?.name;
            let own =
                |draft: &Draft| draft.is_kept && draft.name == *name && !draft.beside.contains_key("notes");
            Slot::new(self.drafts.iter().position(own)?)
        };
        for (note, row) in start.notes.rows() {
            let meaning = match row.meaning {
                Meaning::Strikes(stroke) => {
                    keeps(stroke.slot).map(|slot| Meaning::Strikes(Stroke { slot, ..stroke }))
                }
                Meaning::Steps(slot, foot) => keeps(slot).map(|slot| Meaning::Steps(slot, foot)),
                Meaning::Chokes(slot) => keeps(slot).map(Meaning::Chokes),
                Meaning::Throws(slot, on) => keeps(slot).map(|slot| Meaning::Throws(slot, on)),
                Meaning::Silent => None,
            };
            let (pedal, wires, figure) =
                meaning.map_or((None, None, None), |_| (row.pedal, row.wires, row.figure));
            let meaning = meaning.unwrap_or(Meaning::Silent);
            let row = Row { name: row.name.clone(), meaning, pedal, wires, figure };
            table.set(note, Some(row));
        }
        for (old, piece) in start.kit.slots() {
            if let Some(slot) = keeps(old) {
                table.set_ordinary(slot, start.notes.ordinary(old));
            }
            let kept = self.drafts.iter().position(|draft| draft.is_kept && draft.name == piece.name);
            if let Some(slot) = kept.and_then(Slot::new) {
                table.set_position_controller(slot, start.notes.position_controller(old));
            }
        }
        table
    }

    fn controller(&self, value: &Value, path: &str) -> Result<Option<u8>, Fault> {
        match value {
            Value::String(none) if none == NONE => Ok(None),
            value => {
                let given: u32 = typed::read(value, path, &[], self.origins)?;
                // Whether it is one of those that may is checked with the table.
                Ok(Some(u8::try_from(given).unwrap_or(u8::MAX)))
            }
        }
    }

    fn piece(
        &self,
        table: &mut NoteTable,
        claims: &mut Claims,
        (slot, piece, draft): (Slot, &PieceSpec, &Draft),
        notes: &Value,
    ) -> Result<(), Fault> {
        let path = format!("pieces.{}.notes", piece.name);
        let Value::Array(notes) = notes else {
            return Err(Fault::of(&path, self.origins, "is not an array, accepted: an array of notes"));
        };
        let usual = self.usual(piece, draft);
        let (mut marked, mut first) = (None, None);
        for (index, value) in notes.iter().enumerate() {
            let path = format!("{path}.{index}");
            let (note, row, ordinary) = self.row(value, &path, (slot, piece), &usual)?;
            claims.take(note, &path, self.origins)?;
            if matches!(row.meaning, Meaning::Strikes(_)) {
                match ordinary {
                    Some(true) if marked.is_some() => {
                        let reason = "is the piece's second ordinary note, accepted: one";
                        return Err(Fault::of(&format!("{path}.ordinary"), self.origins, reason));
                    }
                    Some(true) => marked = Some(note),
                    Some(false) => {}
                    None => first = first.or(Some(note)),
                }
            } else if ordinary.is_some() {
                let reason = "is given, accepted: only with a stroke";
                return Err(Fault::of(&format!("{path}.ordinary"), self.origins, reason));
            }
            table.set(note, Some(row));
        }
        table.set_ordinary(slot, marked.or(first));
        Ok(())
    }

    /// A note, its row, and whether it is said to be the ordinary one.
    fn row(
        &self,
        value: &Value,
        path: &str,
        (slot, piece): (Slot, &PieceSpec),
        usual: &Row,
    ) -> Result<(u8, Row, Option<bool>), Fault> {
        let entry = Entry::read(value, path, self.origins)?;
        let Some(note) = u8::try_from(entry.note).ok().filter(|note| usize::from(*note) < NOTES) else {
            let at = if value.is_table() { format!("{path}.note") } else { path.to_owned() };
            return Err(Fault::of(
                &at,
                self.origins,
                &format!("is {}, accepted: 0 to {}", entry.note, NOTES - 1),
            ));
        };
        let known = self.known(note, piece.instrument.kind());
        let known_name = || known.map_or_else(|| piece.title.clone(), |row| row.name.clone());
        let name = entry.name.clone().unwrap_or_else(known_name);
        let is_stroke = entry.is_stroke();
        if let Some(meaning) = self.by_hand(&entry, path, slot, known)? {
            return Ok((note, Row::new(&name, meaning), entry.ordinary));
        }
        let steps = match (entry.foot, known.map(|row| row.meaning)) {
            (Some(_), _) if is_stroke => {
                let reason = "is given with a stroke, accepted: foot alone, or at, angle_rad, stick, pedal";
                return Err(Fault::of(&format!("{path}.foot"), self.origins, reason));
            }
            (Some(foot), _) => Some(foot),
            (None, Some(Meaning::Steps(_, foot))) if !is_stroke => Some(foot),
            (None, _) => None,
        };
        if let Some(foot) = steps {
            return Ok((note, Row::new(&name, Meaning::Steps(slot, foot)), entry.ordinary));
        }
        let as_known = known.filter(|row| matches!(row.meaning, Meaning::Strikes(_))).unwrap_or(usual);
        let Meaning::Strikes(stroke) = as_known.meaning else {
            return Err(Fault::of(path, self.origins, "is not a stroke, accepted: at, angle_rad, stick"));
        };
        let striker = entry.striker(path, self.origins)?.unwrap_or(stroke.striker);
        let radius = entry.at.unwrap_or(stroke.radius);
        let angle = entry.angle_rad.unwrap_or(stroke.angle);
        let meaning = Meaning::Strikes(Stroke { slot, radius, angle, striker });
        let (pedal, wires) = (entry.pedal.unwrap_or(as_known.pedal), entry.wires.or(as_known.wires));
        let figure = entry.figure(path, self.origins)?.or(as_known.figure);
        Ok((note, Row { name, meaning, pedal, wires, figure }, entry.ordinary))
    }

    /// What a hand does instead of a stroke, if the entry or what is known of its note says so.
    fn by_hand(
        &self,
        entry: &Entry,
        path: &str,
        slot: Slot,
        known: Option<&Row>,
    ) -> Result<Option<Meaning>, Fault> {
        let Some(hand) = &entry.hand else {
            let nothing = !entry.is_stroke() && entry.foot.is_none();
            return Ok(known.filter(|_| nothing).and_then(|row| match row.meaning {
                Meaning::Chokes(_) => Some(Meaning::Chokes(slot)),
                Meaning::Throws(_, on) => Some(Meaning::Throws(slot, on)),
                _ => None,
            }));
        };
        let path = format!("{path}.hand");
        if entry.is_stroke() || entry.foot.is_some() {
            return Err(Fault::of(
                &path,
                self.origins,
                "is given with a stroke or a foot, accepted: hand alone",
            ));
        }
        let meaning =
            entry::HANDS.into_iter().find(|(name, _)| name == hand).map(|(_, meaning)| meaning(slot));
        let refused = || {
            let names = entry::HANDS.map(|(name, _)| name).join(", ");
            Fault::of(&path, self.origins, &format!("is {}, accepted: {names}", quoted(hand)))
        };
        meaning.map(Some).ok_or_else(refused)
    }

    /// What a note plays in the start, if it is on a piece of that kind.
    fn known(&self, note: u8, kind: Kind) -> Option<&Row> {
        let KitDocument { kit, notes } = self.start?;
        let row = notes.row(note)?;
        let slot = row.meaning.slot()?;
        (kit.piece(slot)?.instrument.kind() == kind).then_some(row)
    }

    /// How a piece is struck where nothing is said: as it is in the start, or that which it is like, or one of its kind.
    fn usual(&self, piece: &PieceSpec, draft: &Draft) -> Row {
        let kind = piece.instrument.kind();
        let mut name = Some(draft.name.clone());
        // As far as a chain of likenesses can reach.
        for _ in 0..=self.drafts.len() + catalogue::LONGEST_CHAIN {
            let Some(own) = &name else { break };
            let ordinary = self.start.and_then(|start| {
                let (slot, piece) = start.kit.find(own)?;
                start.notes.row(start.notes.ordinary(slot)?).filter(|_| piece.instrument.kind() == kind)
            });
            if let Some(row) = ordinary {
                return row.clone();
            }
            let draft = self.drafts.iter().find(|draft| draft.name == *own);
            let like = |draft: &Draft| Some(draft.beside.get("like")?.as_str()?.to_owned());
            name = draft.map_or_else(|| catalogue::likeness(own), like);
        }
        let (radius, striker) = match kind {
            Kind::Drum => DRUM,
            Kind::Cymbal => CYMBAL,
            Kind::HiHat => HI_HAT,
        };
        // The slot is that of whoever asks.
        let stroke = Stroke { slot: Slot::ALL[0], radius, angle: 0.0, striker };
        Row::new(&piece.title, Meaning::Strikes(stroke))
    }

    fn silence(
        &self,
        table: &mut NoteTable,
        claims: &mut Claims,
        silent: Option<&Value>,
    ) -> Result<(), Fault> {
        let rows = match silent {
            None => return Ok(()),
            Some(Value::Table(rows)) => rows,
            Some(_) => {
                return Err(Fault::of(
                    "silent",
                    self.origins,
                    "is not a table, accepted: notes with their names",
                ));
            }
        };
        for (key, name) in rows {
            let path = format!("silent.{key}");
            let Some(note) = key.parse().ok().filter(|note: &u8| usize::from(*note) < NOTES) else {
                let reason = format!("is not a note, accepted: 0 to {}", NOTES - 1);
                return Err(Fault::of(&path, self.origins, &reason));
            };
            claims.take(note, &path, self.origins)?;
            let name: String = typed::read(name, &path, &[], self.origins)?;
            table.set(note, Some(Row::new(&name, Meaning::Silent)));
        }
        Ok(())
    }
}

/// Where and with what a piece of a kind is struck where nothing says so: share of the radius, stick. *By ear*: where the
/// standard notes have a tom, a ride and an open hi-hat.
const DRUM: (f64, Striker) = (0.3, Striker::Stick);
const CYMBAL: (f64, Striker) = (0.6, Striker::Stick);
const HI_HAT: (f64, Striker) = (0.97, Striker::Shoulder);

/// A refusal of the table of notes with the path that it has in the file.
fn in_file(error: SpecError, claims: &Claims, origins: &Origins) -> SpecError {
    let field = error.field().to_owned();
    let (of, what) = field.split_once('.').unwrap_or((&field, ""));
    let path = match of.parse().ok().and_then(|note: usize| claims.0.get(note)?.as_deref()) {
        Some(silent) if silent.starts_with("silent") => silent.to_owned(),
        // Two names of the table's are others in a file.
        Some(entry) if what == "radius" => format!("{entry}.at"),
        Some(entry) if matches!(what, "choke" | "wires") && origins.has(&format!("{entry}.hand")) => {
            format!("{entry}.hand")
        }
        Some(entry) if what == "pedal" && origins.has(&format!("{entry}.foot")) => format!("{entry}.foot"),
        Some(entry) => format!("{entry}.{what}"),
        None if of.parse::<u8>().is_ok() => format!("notes.{field}"),
        None => format!("pieces.{field}"),
    };
    match error {
        SpecError::OutOfRange { value, min, max, .. } => {
            SpecError::OutOfRange { field: path, value, min, max }
        }
        SpecError::Refused { reason, .. } => SpecError::Refused { field: path, reason },
    }
}
