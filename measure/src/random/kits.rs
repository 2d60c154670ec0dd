//! Random kits: random pieces in random places, each played by notes of its own.

use std::f64::consts::TAU;

use overhear::kit_document::KitDocument;
use overhear::midi_map::{Foot, Meaning, NoteTable, Row, Stroke};
use overhear_engine::kit_spec::{Kind, KitSpec, MicrophonesSpec, PieceSpec, PlaceSpec};
use overhear_engine::strike::Striker;

use crate::{Chance, standard};

use super::parts;

/// A kit of so many pieces, 1 to 16, and the notes that play it: two strokes of each, the pedal of hi-hats, hands on cymbals.
///
/// # Panics
/// If the pieces find no room, which 16 of the largest do.
pub fn kit(chance: &mut Chance, pieces: usize) -> KitDocument {
    let mut kit = KitSpec { pieces: Vec::new(), ..standard() };
    let MicrophonesSpec { overheads, room } = &mut kit.microphones;
    for x in overheads.as_flattened_mut().iter_mut().chain(room.as_flattened_mut()) {
        *x += chance.between(-0.3, 0.3);
    }
    for number in 1..=pieces {
        let piece = PieceSpec { name: format!("piece-{number}"), ..super::piece(chance) };
        kit.pieces.push(parts::added(piece, chance));
        place_last(&mut kit, chance);
    }
    let notes = notes(&kit, chance);
    KitDocument { kit, notes }
}

/// Moves the last piece of a kit about until it stands in no other.
fn place_last(kit: &mut KitSpec, chance: &mut Chance) {
    const TRIES: usize = 10_000;
    for _ in 0..TRIES {
        let centre = [chance.between(-1.8, 1.8), chance.between(0.2, 1.4), chance.between(-2.0, 2.0)];
        let facing = [chance.between(-0.7, 0.7), chance.between(0.2, 1.0), chance.between(-0.7, 0.7)];
        if let Some(piece) = kit.pieces.last_mut() {
            piece.place = PlaceSpec { centre, facing };
        }
        if kit.check().is_ok() {
            return;
        }
    }
    panic!("no place for a piece: {:?}", kit.check());
}

fn notes(kit: &KitSpec, chance: &mut Chance) -> NoteTable {
    let mut notes = NoteTable::default();
    let mut next = 0..128;
    let mut add = |meaning: Meaning, pedal: Option<f64>| {
        let note = next.next().unwrap_or_default();
        notes.set(note, Some(Row { pedal, ..Row::new("Drawn", meaning) }));
        note
    };
    let mut ordinary = Vec::new();
    for (slot, piece) in kit.slots() {
        let kind = piece.instrument.kind();
        for _ in 0..2 {
            let (radius, angle) = (chance.unit(), chance.between(-TAU, TAU));
            let stroke = Stroke { slot, radius, angle, striker: chance.of(&Striker::ALL) };
            let pedal = (kind == Kind::HiHat && chance.happens(0.5)).then(|| chance.unit());
            let note = add(Meaning::Strikes(stroke), pedal);
            ordinary.push((slot, note));
        }
        match kind {
            Kind::Drum => {}
            Kind::Cymbal => drop(add(Meaning::Chokes(slot), None)),
            Kind::HiHat => drop(add(Meaning::Steps(slot, Foot::Position(chance.unit())), None)),
        }
    }
    for (slot, note) in ordinary {
        notes.set_ordinary(slot, Some(note));
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear::kit_file;

    #[test]
    fn random_kits_are_accepted_and_are_read_as_they_were_written() {
        for seed in 0..40 {
            let drawn = kit(&mut Chance::new(seed), 1 + seed as usize % 16);
            assert_eq!(drawn.check(), Ok(()), "seed {seed}");
            let text = kit_file::write(&drawn);
            let read = kit_file::read("drawn", &text).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert_eq!(read, drawn, "seed {seed}");
        }
    }
}
