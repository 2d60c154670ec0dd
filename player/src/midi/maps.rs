//! Maps of other instruments: which of their notes plays which [reference](crate::midi_map) note.
//!
//! *Literature*: the modules' own tables of transmitted notes, as they leave the factory: Roland TD-17 (the same on
//! TD-27 and TD-50), Yamaha DTX502, Alesis Nitro.

use crate::midi_map::{Meaning, NoteTable, Stroke};

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
}

/// A pad of an instrument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pad {
    /// MIDI note that it sends.
    pub note: u8,
    /// Its name on the instrument.
    pub name: &'static str,
    /// The reference note that it plays.
    pub plays: u8,
}

const fn pad(note: u8, name: &'static str, plays: u8) -> Pad {
    Pad { note, name, plays }
}

impl NoteMap {
    /// Every map, in the order of the parameter that chooses one.
    pub const ALL: [NoteMap; 5] =
        [NoteMap::GeneralMidi, NoteMap::Roland, NoteMap::Yamaha, NoteMap::Alesis, NoteMap::Plain];

    /// Names on screen and in presets, in the order of [`ALL`](Self::ALL).
    pub const NAMES: [&'static str; 5] = ["general", "roland", "yamaha", "alesis", "plain"];

    /// The pads, or none for the reference itself, which plays every note as it is.
    pub fn pads(self) -> Option<&'static [Pad]> {
        match self {
            NoteMap::GeneralMidi => None,
            NoteMap::Roland => Some(&ROLAND),
            NoteMap::Yamaha => Some(&YAMAHA),
            NoteMap::Alesis => Some(&ALESIS),
            NoteMap::Plain => Some(&PLAIN),
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
            Meaning::Strikes(_) | Meaning::Steps(..) => Some(match self.pads() {
                None => &row.name,
                Some(pads) => pads.iter().find(|pad| pad.note == note)?.name,
            }),
        }
    }
}

static ROLAND: [Pad; 26] = [
    pad(22, "Hi-Hat Closed Edge", 42),
    pad(26, "Hi-Hat Open Edge", 46),
    pad(36, "Kick", 36),
    pad(37, "Snare Cross Stick", 37),
    pad(38, "Snare Head", 38),
    pad(39, "Tom 4 Rim", 96),
    pad(40, "Snare Rim", 40),
    pad(41, "Tom 4 Head", 41),
    pad(42, "Hi-Hat Closed Bow", 42),
    pad(43, "Tom 3 Head", 43),
    pad(44, "Hi-Hat Pedal", 44),
    pad(45, "Tom 2 Head", 47),
    pad(46, "Hi-Hat Open Bow", 46),
    pad(47, "Tom 2 Rim", 95),
    pad(48, "Tom 1 Head", 48),
    pad(49, "Crash 1 Bow", 91),
    pad(50, "Tom 1 Rim", 95),
    pad(51, "Ride Bow", 51),
    pad(52, "Crash 2 Edge", 57),
    pad(53, "Ride Bell", 53),
    pad(55, "Crash 1 Edge", 49),
    pad(57, "Crash 2 Bow", 91),
    pad(58, "Tom 3 Rim", 96),
    pad(59, "Ride Edge", 93),
    pad(27, "Aux Head", 55),
    pad(28, "Aux Rim", 55),
];

static YAMAHA: [Pad; 28] = [
    pad(27, "Snare Off Closed Rim", 37),
    pad(31, "Snare Off Head", 38),
    pad(34, "Snare Off Open Rim", 40),
    pad(35, "Kick 2", 35),
    pad(36, "Kick", 36),
    pad(37, "Snare Closed Rim", 37),
    pad(38, "Snare Head", 38),
    pad(40, "Snare Open Rim", 40),
    pad(42, "Hi-Hat Closed", 42),
    pad(43, "Tom 3", 43),
    pad(44, "Hi-Hat Foot Close", 44),
    pad(46, "Hi-Hat Open", 46),
    pad(47, "Tom 2", 47),
    pad(48, "Tom 1", 48),
    pad(49, "Crash Edge", 49),
    pad(51, "Ride Bow", 51),
    pad(52, "Ride Edge", 93),
    pad(53, "Ride Cup", 53),
    pad(55, "Crash Cup", 92),
    pad(57, "Pad 8", 55),
    pad(59, "Crash Bow", 91),
    pad(78, "Hi-Hat Open Edge", 46),
    pad(79, "Hi-Hat Closed Edge", 42),
    pad(83, "Hi-Hat Foot Splash", 97),
    pad(85, "Hi-Hat Open Cup", 46),
    pad(86, "Hi-Hat Closed Cup", 42),
    pad(50, "Tom 1 Rim", 95),
    pad(58, "Tom 3 Rim", 96),
];

static ALESIS: [Pad; 23] = [
    pad(21, "Hi-Hat Splash", 97),
    pad(23, "Hi-Hat Half Open", 100),
    pad(36, "Kick", 36),
    pad(38, "Snare Head", 38),
    pad(39, "Tom 4 Rim", 96),
    pad(40, "Snare Rim", 40),
    pad(41, "Tom 4", 41),
    pad(42, "Hi-Hat Closed", 42),
    pad(43, "Tom 3", 43),
    pad(44, "Hi-Hat Pedal", 44),
    pad(45, "Tom 2", 47),
    pad(46, "Hi-Hat Open", 46),
    pad(47, "Tom 2 Rim", 95),
    pad(48, "Tom 1", 48),
    pad(49, "Crash 1", 49),
    pad(50, "Tom 1 Rim", 95),
    pad(51, "Ride", 51),
    pad(52, "Crash 2 Edge", 57),
    pad(53, "Ride Bell", 53),
    pad(55, "Crash 1 Edge", 49),
    pad(57, "Crash 2", 57),
    pad(58, "Tom 3 Rim", 96),
    pad(59, "Ride Edge", 93),
];

static PLAIN: [Pad; 22] = [
    pad(36, "Kick", 36),
    pad(37, "Snare", 38),
    pad(38, "Hi-Hat Closed", 42),
    pad(39, "Hi-Hat Open", 46),
    pad(40, "Rack Tom", 48),
    pad(41, "Floor Tom", 43),
    pad(42, "Ride", 51),
    pad(43, "Crash", 49),
    pad(44, "Snare Cross Stick", 37),
    pad(45, "Snare Rim Shot", 40),
    pad(46, "Hi-Hat Pedal", 44),
    pad(47, "Ride Bell", 53),
    pad(48, "Splash", 55),
    pad(49, "Crash Bow", 91),
    pad(50, "Ride Edge", 93),
    pad(51, "Snare Edge", 94),
    pad(52, "Rack Tom Rim Shot", 95),
    pad(53, "Floor Tom Rim Shot", 96),
    pad(54, "Timpani", 88),
    pad(55, "Timpani Hard", 89),
    pad(56, "Timpani Centre", 90),
    pad(57, "Crash Bell", 92),
];

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
