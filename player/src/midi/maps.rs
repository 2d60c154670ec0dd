//! Maps of other instruments: which of their notes plays which [reference](crate::midi_map) note.
//! The notes are in `modules.rs`.

mod modules;

use crate::midi_map::{Meaning, NoteTable, Stroke};
use modules::{ALESIS, EDRUMIN, EFNOTE, MEGADRUM, PLAIN, ROLAND, YAMAHA};

pub use modules::Pad;

/// Which notes a player's instrument sends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NoteMap {
    /// The reference itself.
    #[default]
    GeneralMidi,
    /// Roland TD modules.
    Roland,
    /// Yamaha DTX modules.
    Yamaha,
    /// Alesis modules.
    Alesis,
    /// One note after the other from 36 on, for pads and keyboards.
    Plain,
    /// Efnote modules.
    Efnote,
    /// Interfaces of single pads, such as the eDRUMin.
    Edrumin,
    /// Modules with a note for every opening of the hi-hat and for every choke, such as the MegaDrum.
    Megadrum,
}

impl NoteMap {
    /// Every map, in the order of the parameter that chooses one.
    /// Frozen: append only.
    pub const ALL: [NoteMap; 8] = [
        NoteMap::GeneralMidi,
        NoteMap::Roland,
        NoteMap::Yamaha,
        NoteMap::Alesis,
        NoteMap::Plain,
        NoteMap::Efnote,
        NoteMap::Edrumin,
        NoteMap::Megadrum,
    ];

    /// Names on screen and in presets, in the order of [`ALL`](Self::ALL).
    pub const NAMES: [&'static str; 8] =
        ["general", "roland", "yamaha", "alesis", "plain", "efnote", "edrumin", "megadrum"];

    /// The pads, or none for the reference itself, which plays every note as it is.
    pub fn pads(self) -> Option<&'static [Pad]> {
        match self {
            NoteMap::GeneralMidi => None,
            NoteMap::Roland => Some(&ROLAND),
            NoteMap::Yamaha => Some(&YAMAHA),
            NoteMap::Alesis => Some(&ALESIS),
            NoteMap::Plain => Some(&PLAIN),
            NoteMap::Efnote => Some(&EFNOTE),
            NoteMap::Edrumin => Some(&EDRUMIN),
            NoteMap::Megadrum => Some(&MEGADRUM),
        }
    }

    /// The reference note that a note plays.
    ///
    /// # Real-time
    /// A look-up in some thirty rows.
    pub fn plays(self, note: u8) -> Option<u8> {
        match self.pads() {
            None => Some(note),
            Some(pads) => pads.iter().find(|pad| pad.note == note).map(|pad| pad.plays),
        }
    }

    /// The stroke of a note on a kit with these reference notes, if it sounds.
    ///
    /// # Real-time
    /// A look-up.
    pub fn stroke(self, note: u8, table: &NoteTable) -> Option<&Stroke> {
        table.stroke(self.plays(note)?)
    }

    /// What a note is called, if it plays anything on a kit with these reference notes.
    pub fn name(self, note: u8, table: &NoteTable) -> Option<&str> {
        let row = table.row(self.plays(note)?)?;
        match row.meaning {
            Meaning::Silent => None,
            _ => Some(match self.pads() {
                None => &row.name,
                Some(pads) => pads.iter().find(|pad| pad.note == note)?.name,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit_document::{KitDocument, standard_slot};

    #[test]
    fn every_pad_has_a_note_of_its_own_and_plays_a_reference_note() {
        let table = KitDocument::standard().notes;
        for map in NoteMap::ALL {
            for (index, pad) in map.pads().unwrap_or_default().iter().enumerate() {
                assert!(table.row(pad.plays).is_some(), "{map:?}: {}", pad.name);
                let twice = map.pads().unwrap()[..index].iter().any(|other| other.note == pad.note);
                assert!(!twice, "{map:?}: {}", pad.note);
            }
        }
    }

    #[test]
    fn every_module_plays_the_drum_set_where_its_pads_are() {
        let table = KitDocument::standard().notes;
        let [kick_drum, snare_drum, ride] = ["kick", "snare", "ride"].map(|name| Some(standard_slot(name)));
        for (map, kick, snare, rim, bell, edge) in [
            (NoteMap::GeneralMidi, 36, 38, 40, 53, 93),
            (NoteMap::Roland, 36, 38, 40, 53, 59),
            (NoteMap::Yamaha, 36, 38, 40, 53, 52),
            (NoteMap::Alesis, 36, 38, 40, 53, 59),
            (NoteMap::Plain, 36, 37, 45, 47, 50),
            (NoteMap::Efnote, 36, 38, 40, 53, 59),
            (NoteMap::Edrumin, 36, 38, 40, 53, 59),
            (NoteMap::Megadrum, 36, 38, 40, 53, 59),
        ] {
            let slot = |note| map.stroke(note, &table).map(|stroke| stroke.slot);
            assert_eq!(slot(kick), kick_drum, "{map:?}");
            assert_eq!((slot(snare), slot(rim)), (snare_drum, snare_drum), "{map:?}");
            let radius = |note| map.stroke(note, &table).map(|stroke| stroke.radius);
            assert!(slot(bell) == ride && radius(bell) < Some(0.2), "{map:?}");
            assert!(slot(edge) == ride && radius(edge) > Some(0.9), "{map:?}");
        }
    }

    #[test]
    fn notes_that_a_module_does_not_send_are_silent() {
        let table = KitDocument::standard().notes;
        assert_eq!(NoteMap::Roland.stroke(60, &table), None);
        assert_eq!(NoteMap::Plain.stroke(35, &table), None);
        let struck = NoteMap::GeneralMidi.stroke(35, &table).map(|stroke| stroke.slot);
        assert_eq!(struck, Some(standard_slot("kick")));
    }

    #[test]
    fn names_are_of_the_notes_that_sound() {
        let table = KitDocument::standard().notes;
        assert_eq!(NoteMap::Roland.name(59, &table), Some("Ride Edge"));
        assert_eq!(NoteMap::GeneralMidi.name(38, &table), Some("Acoustic Snare"));
        assert_eq!(NoteMap::GeneralMidi.name(39, &table), None);
        assert_eq!(NoteMap::Plain.name(127, &table), None);
    }
}
