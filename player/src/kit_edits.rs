//! Changes of a kit by hand: pieces that come, go, are exchanged, moved and resized, and the notes that follow them.
//!
//! Every function takes a document and gives a whole new one, checked, with the slot that each of its pieces had before; what is
//! refused leaves the document that there is untouched. A piece that goes is replaced by the last one, so that no other
//! changes its slot, which is its output and its parameters.

pub mod features;
mod names;
mod notes;
pub mod sizes;

use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::{KitSpec, PieceSpec, places};
use overhear_engine::layout::distance;
use overhear_engine::slot::{SLOTS, Slot};

use crate::kit_document::KitDocument;
use crate::library::Instrument;

use notes::Notes;

/// Where a piece of a changed kit comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// It was not there.
    New,
    /// It was in that slot.
    Same(Slot),
    /// Another one was in that slot, in whose place it is.
    Exchanged(Slot),
}

/// A changed kit.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The kit and its notes.
    pub document: KitDocument,
    /// Where its pieces come from, by slot.
    pub origins: Vec<Origin>,
    /// The piece that the change was about.
    pub about: Slot,
}

/// Adds an instrument of the library where there is room for it, with notes of its own.
///
/// # Errors
/// [`SpecError`] of a 17th piece.
pub fn add(document: &KitDocument, instrument: &Instrument) -> Result<Edit, SpecError> {
    let piece = instrument.piece().map_err(|error| SpecError::refused("library", error.to_string()))?;
    append(document, piece, &notes::of_model(instrument))
}

/// Adds a piece like another one beside it.
///
/// # Errors
/// [`SpecError`] of a 17th piece or an empty slot.
pub fn duplicate(document: &KitDocument, slot: Slot) -> Result<Edit, SpecError> {
    let piece = piece_of(&document.kit, slot)?.clone();
    append(document, piece, &notes::of_slot(&document.notes, slot))
}

/// Adds the pieces of another kit, each with its notes, as far as they are free.
///
/// # Errors
/// [`SpecError`] of a 17th piece.
pub fn add_all(document: &KitDocument, other: &KitDocument) -> Result<Edit, SpecError> {
    let mut added: Option<Edit> = None;
    for (slot, piece) in other.kit.slots() {
        let present = added.as_ref().map_or(document, |edit| &edit.document);
        let edit = append(present, piece.clone(), &notes::of_slot(&other.notes, slot))?;
        let origins = match added {
            Some(former) => former.origins.into_iter().chain([Origin::New]).collect(),
            None => edit.origins,
        };
        added = Some(Edit { origins, ..edit });
    }
    added.ok_or_else(|| SpecError::refused("pieces", "are none, accepted: a kit with pieces"))
}

fn append(document: &KitDocument, mut piece: PieceSpec, notes: &Notes) -> Result<Edit, SpecError> {
    let count = document.kit.pieces.len();
    let about = Slot::new(count).ok_or_else(|| {
        let reason = format!("would be {}, accepted: 1 to {SLOTS}; remove one first", count + 1);
        SpecError::refused("pieces", reason)
    })?;
    let mut document = document.clone();
    names::make_distinct(&mut piece, &document.kit, None);
    place(&mut piece, &document.kit);
    notes::give(&mut document, about, &piece.title, notes);
    document.kit.pieces.push(piece);
    let kept = Slot::ALL.into_iter().take(count).map(Origin::Same);
    checked(Edit { document, origins: kept.chain([Origin::New]).collect(), about })
}

/// Takes a piece away; the last piece takes its slot.
///
/// # Errors
/// [`SpecError`] of the last piece that there is.
pub fn remove(document: &KitDocument, slot: Slot) -> Result<Edit, SpecError> {
    piece_of(&document.kit, slot)?;
    let count = document.kit.pieces.len();
    if count == 1 {
        return Err(SpecError::refused("pieces", "would be 0, accepted: 1 to 16"));
    }
    let last = Slot::ALL[count - 1];
    let mut document = document.clone();
    document.kit.pieces.swap_remove(slot.index());
    document.notes = notes::moved(&document.notes, |of| match of {
        _ if of == slot => None,
        _ if of == last => Some(slot),
        _ => Some(of),
    });
    let origin = |at: Slot| Origin::Same(if at == slot { last } else { at });
    let origins = Slot::ALL.into_iter().take(count - 1).map(origin).collect();
    checked(Edit { document, origins, about: Slot::ALL[slot.index().min(count - 2)] })
}

/// Puts an instrument of the library in the place of a piece, or beside it if it is too large for that. One of the same kind keeps
/// name, place and notes.
///
/// # Errors
/// [`SpecError`] of what does not fit there, or of an empty slot.
pub fn exchange(document: &KitDocument, slot: Slot, instrument: &Instrument) -> Result<Edit, SpecError> {
    let former = piece_of(&document.kit, slot)?.clone();
    let mut piece = instrument.piece().map_err(|error| SpecError::refused("library", error.to_string()))?;
    let mut document = document.clone();
    let wired = |piece: &PieceSpec| piece.drum().is_some_and(|drum| drum.wires.is_some());
    if piece.instrument.kind() == former.instrument.kind() && wired(&piece) == wired(&former) {
        piece.name.clone_from(&former.name);
        piece.place = former.place;
        piece.defaults.pan = former.defaults.pan;
        names::make_distinct(&mut piece, &document.kit, Some(slot));
    } else {
        piece.place.centre = former.place.centre;
        names::make_distinct(&mut piece, &document.kit, Some(slot));
        document.notes = notes::moved(&document.notes, |of| (of != slot).then_some(of));
        notes::give(&mut document, slot, &piece.title, &notes::of_model(instrument));
    }
    let pieces = &document.kit.pieces;
    let others = pieces.iter().enumerate().filter(|(of, _)| *of != slot.index()).map(|(_, other)| other);
    if others.clone().any(|other| places::inside(&piece, other)) {
        piece.place.centre = places::free_place(&piece, others).unwrap_or(piece.place.centre);
    }
    document.kit.pieces[slot.index()] = piece;
    let mut origins = kept(&document.kit);
    origins[slot.index()] = Origin::Exchanged(slot);
    checked(Edit { document, origins, about: slot })
}

/// Changes a piece.
///
/// # Errors
/// [`SpecError`] of what is not accepted, or of an empty slot.
pub fn change(
    document: &KitDocument,
    slot: Slot,
    change: impl FnOnce(&mut PieceSpec),
) -> Result<Edit, SpecError> {
    piece_of(&document.kit, slot)?;
    let mut document = document.clone();
    change(&mut document.kit.pieces[slot.index()]);
    let origins = kept(&document.kit);
    checked(Edit { document, origins, about: slot })
}

/// A kit in the place of another; its pieces are those of the same names.
pub fn replace(document: &KitDocument, other: KitDocument) -> Edit {
    let origin = |piece: &PieceSpec| {
        document.kit.find(&piece.name).map_or(Origin::New, |(slot, _)| Origin::Exchanged(slot))
    };
    let origins = other.kit.pieces.iter().map(origin).collect();
    Edit { document: other, origins, about: Slot::ALL[0] }
}

/// A kit of the piece of a slot alone, with its notes: what a file of a piece holds.
///
/// # Errors
/// [`SpecError`] of an empty slot.
pub fn alone(document: &KitDocument, slot: Slot) -> Result<KitDocument, SpecError> {
    let kit = document.kit.alone(slot).ok_or_else(|| SpecError::refused("piece", "is not in the kit"))?;
    let only = |of: Slot| (of == slot).then_some(Slot::ALL[0]);
    Ok(KitDocument { kit, notes: notes::moved(&document.notes, only) })
}

fn kept(kit: &KitSpec) -> Vec<Origin> {
    kit.slots().map(|(slot, _)| Origin::Same(slot)).collect()
}

fn checked(edit: Edit) -> Result<Edit, SpecError> {
    edit.document.check()?;
    Ok(edit)
}

fn piece_of(kit: &KitSpec, slot: Slot) -> Result<&PieceSpec, SpecError> {
    kit.piece(slot).ok_or_else(|| SpecError::refused("piece", "is not in the kit"))
}

/// Moves a piece to the nearest place on the floor where it stands free of the others.
fn place(piece: &mut PieceSpec, kit: &KitSpec) {
    /// Distance of one ring of places from the next, m, places on a ring, and rings.
    const RING: f64 = 0.1;
    const PLACES: usize = 24;
    const RINGS: usize = 40;
    let usual = piece.place.centre;
    for ring in 0..=RINGS {
        for place in 0..PLACES {
            let angle = std::f64::consts::TAU * place as f64 / PLACES as f64;
            let away = RING * ring as f64;
            piece.place.centre = [usual[0] + away * angle.cos(), usual[1], usual[2] + away * angle.sin()];
            if is_free(piece, kit) {
                return;
            }
        }
    }
}

fn is_free(piece: &PieceSpec, kit: &KitSpec) -> bool {
    // Less than the sum of the radii: cymbals hang over one another a little, as do toms and what hangs over them.
    const CLOSE: f64 = 0.85;
    kit.pieces.iter().all(|other| {
        if places::inside(piece, other) {
            return false;
        }
        let apart = distance(&piece.place.centre, &other.place.centre);
        let middles = distance(&piece.placement().source(), &other.placement().source());
        apart.min(middles) > CLOSE * (piece.instrument.radius() + other.instrument.radius())
    })
}

#[cfg(test)]
mod tests;
