//! Notes of pieces that come, go and change places.
//!
//! A piece that comes plays what the piece of the standard kit that it is like plays. Where that one's own notes are free it
//! takes them; where another piece has them, it takes one of those that merely repeat that piece's ordinary stroke, as General MIDI's
//! second crash does, and free notes for the rest.

use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;

use crate::kit_document::KitDocument;
use crate::kit_file;
use crate::library::Instrument;
use crate::midi::figures::Figure;
use crate::midi_map::{Foot, LONGEST_NAME, Meaning, NoteTable, Row, Stroke};

/// Notes of a piece with what they play, the ordinary one first.
pub(super) type Notes = Vec<(u8, Row)>;

/// As many notes at most are given to a piece whose own ones another has.
const MOST: usize = 10;

/// Notes that are given away, in the order in which they are: beyond General MIDI's first, then below, then those of General
/// MIDI that no piece sounds like.
fn free(table: &NoteTable) -> impl Iterator<Item = u8> {
    let beyond = (82..=87).chain(125..=127).chain((0..=34).rev());
    let unused: Vec<u8> = beyond.clone().filter(|note| table.row(*note).is_none()).collect();
    let silent = |note: &u8| table.row(*note).is_some_and(|row| row.meaning == Meaning::Silent);
    let silent: Vec<u8> = beyond.chain(35..=81).chain(88..=124).filter(silent).collect();
    unused.into_iter().chain(silent)
}

/// What plays the piece of a slot, the ordinary note first.
pub(super) fn of_slot(table: &NoteTable, slot: Slot) -> Notes {
    let own = table.rows().filter(|(_, row)| row.meaning.slot() == Some(slot));
    let mut notes: Notes = own.map(|(note, row)| (note, row.clone())).collect();
    let ordinary = table.ordinary(slot);
    notes.sort_by_key(|(note, _)| Some(*note) != ordinary);
    notes
}

/// What plays the piece of the standard kit that an instrument is like; the first of its kind if that is another, as of a stack, which is made of hats but
/// played as a cymbal.
pub(super) fn of_model(instrument: &Instrument) -> Notes {
    let standard = KitSpec::standard();
    let kind = instrument.piece().ok().map(|piece| piece.instrument.kind());
    let is_of_kind = |piece: &PieceSpec| kind.is_none_or(|kind| piece.instrument.kind() == kind);
    let model = kit_file::library_model(instrument.name);
    let model = model.and_then(|model| standard.find(&model)).filter(|(_, piece)| is_of_kind(piece));
    let slot = model.or_else(|| standard.slots().find(|(_, piece)| is_of_kind(piece))).map(|found| found.0);
    slot.map_or_else(Notes::new, |slot| of_slot(&NoteTable::standard(&standard), slot))
}

/// A meaning about the piece of another slot.
fn about(meaning: Meaning, slot: Slot) -> Meaning {
    match meaning {
        Meaning::Strikes(stroke) => Meaning::Strikes(Stroke { slot, ..stroke }),
        Meaning::Steps(_, foot) => Meaning::Steps(slot, foot),
        Meaning::Chokes(_) => Meaning::Chokes(slot),
        Meaning::Throws(_, on) => Meaning::Throws(slot, on),
        Meaning::Silent => Meaning::Silent,
    }
}

/// The notes of pieces that change their slots; those of a piece that has none any more are silent.
pub(super) fn moved(table: &NoteTable, to: impl Fn(Slot) -> Option<Slot>) -> NoteTable {
    let mut moved = NoteTable::default();
    for (note, row) in table.rows() {
        let place = row.meaning.slot().map(&to);
        let row = match place {
            None => row.clone(),
            Some(Some(slot)) => Row { meaning: about(row.meaning, slot), ..row.clone() },
            Some(None) => Row::new(&row.name, Meaning::Silent),
        };
        moved.set(note, Some(row));
    }
    for slot in Slot::ALL {
        if let Some(place) = to(slot) {
            moved.set_ordinary(place, table.ordinary(slot));
            moved.set_position_controller(place, table.position_controller(slot));
        }
    }
    moved
}

/// Gives notes to the piece of a title in a slot that has none so far.
pub(super) fn give(document: &mut KitDocument, slot: Slot, title: &str, notes: &Notes) {
    let table = &mut document.notes;
    let Some((own, ordinary)) = notes.first() else { return };
    let is_free =
        |table: &NoteTable, note: u8| table.row(note).is_none_or(|row| row.meaning == Meaning::Silent);
    if is_free(table, *own) {
        for (note, row) in notes.iter().filter(|(note, _)| is_free(table, *note)).cloned().collect::<Notes>()
        {
            table.set(note, Some(Row { meaning: about(row.meaning, slot), ..row }));
        }
        table.set_ordinary(slot, Some(*own));
        return;
    }
    let first = repeating(table, notes).or_else(|| free(table).next());
    let Some(first) = first else { return };
    let mut given: Vec<&Row> = Vec::new();
    for (_, row) in notes {
        let again = given.iter().any(|other| repeats(row, other));
        if given.len() < MOST && !again {
            given.push(row);
        }
    }
    let rest: Vec<u8> = free(table).filter(|note| *note != first).collect();
    for (row, note) in given.into_iter().zip([first].into_iter().chain(rest)) {
        let name = if row == ordinary { title.to_owned() } else { format!("{title} {}", place(row)) };
        let name = name.chars().take(LONGEST_NAME).collect();
        table.set(note, Some(Row { name, meaning: about(row.meaning, slot), ..row.clone() }));
    }
    table.set_ordinary(slot, Some(first));
}

/// A note that merely repeats the ordinary stroke of another piece: of the notes of the model, one that strikes as its ordinary
/// note does.
fn repeating(table: &NoteTable, notes: &Notes) -> Option<u8> {
    let (_, ordinary) = notes.first()?;
    let mut known = notes.iter().skip(1).filter(|(_, row)| repeats(row, ordinary)).map(|(note, _)| *note);
    known.find(|note| {
        let stroke = table.stroke(*note);
        stroke.is_some_and(|stroke| table.ordinary(stroke.slot) != Some(*note))
    })
}

/// Whether a row plays what another does, but for a hand's breadth.
fn repeats(row: &Row, other: &Row) -> bool {
    /// Shares of the radius.
    const NEAR: f64 = 0.15;
    let beside = (row.pedal, row.wires, row.figure) == (other.pedal, other.wires, other.figure);
    beside
        && match (row.meaning, other.meaning) {
            (Meaning::Strikes(own), Meaning::Strikes(other)) => {
                own.striker == other.striker && (own.radius - other.radius).abs() < NEAR
            }
            (own, other) => own == other,
        }
}

/// What a note plays on its piece, in a word or two.
fn place(row: &Row) -> &'static str {
    match (row.meaning, row.figure) {
        (_, Some(Figure::Flam)) => "flam",
        (_, Some(_)) => "roll",
        (Meaning::Steps(_, Foot::Splash), _) => "foot splash",
        (Meaning::Steps(..), _) => "pedal",
        (Meaning::Chokes(_), _) => "choke",
        (Meaning::Throws(_, on), _) => {
            if on {
                "wires on"
            } else {
                "wires off"
            }
        }
        (Meaning::Silent, _) => "silent",
        (Meaning::Strikes(stroke), _) => match (stroke.striker, row.pedal) {
            (Striker::RimShot, _) => "rimshot",
            (Striker::CrossStick, _) => "cross-stick",
            (_, Some(pedal)) if pedal > 0.6 => "closed",
            (_, Some(_)) => "open",
            (Striker::Shoulder, _) => "edge",
            _ if stroke.radius < 0.2 => "middle",
            _ if stroke.radius < 0.8 => "bow",
            _ => "edge",
        },
    }
}
