//! The notes of the standard kit: the General MIDI drum map and beyond.
//!
//! | note | General MIDI name | struck |
//! |---|---|---|
//! | 35, 36 | bass drums | kick, felt beater |
//! | 37 | side stick | snare, cross-stick |
//! | 38, 40 | snares | snare, stick; 40 a rimshot |
//! | 41, 43, 45 | low floor, high floor, low tom | floor tom, stick |
//! | 47, 48, 50 | low-mid, hi-mid, high tom | rack tom, stick |
//! | 49, 57, 52 | crashes, Chinese cymbal | crash, stick shoulder on the edge |
//! | 51, 59 | rides | ride, stick on the bow |
//! | 53 | ride bell | ride, stick shoulder on the bell |
//! | 55 | splash | splash, stick on the edge |
//! | 60 to 63 | bongos, high congas | rack tom, soft mallet for a hand |
//! | 64 | low conga | floor tom, soft mallet for a hand |
//! | 65, 66 | timbales | rack tom, floor tom, stick |
//! | 42, 46 | closed, open hi-hat | hi-hat, stick shoulder on the edge; brings the pedal down, or up |
//! | 44 | pedal hi-hat | the hi-hat's pedal, down, as fast as the note is loud |
//! | 39, 54, 56, 58, 67 to 81 | hand percussion | silent: nothing in the kit sounds like it |
//!
//! Beyond General MIDI's notes:
//!
//! | note | struck |
//! |---|---|
//! | 88 | timpani, soft mallet where timpanists play |
//! | 89 | timpani, hard mallet at the same place |
//! | 90 | timpani, soft mallet in the middle: a thud |
//! | 91, 92 | crash, stick on the bow, its shoulder on the bell |
//! | 93 | ride, stick shoulder on the edge |
//! | 94 | snare, stick near the rim |
//! | 95, 96 | rack tom, floor tom, rimshots |
//! | 97 | the hi-hat's pedal, down and up at once: a foot splash |
//! | 98, 99 | hi-hat, stick on the bow and on the bell, the pedal where it is |
//! | 100 | hi-hat, half open: stick shoulder on the edge; brings the pedal to where the rims just meet |
//! | 101 to 104 | hi-hat, stick on the bow and on the bell, closed and open |
//! | 105 to 110 | hi-hat, stick shoulder on the edge: tight, loose, and four openings up to the widest |
//! | 111 to 114 | a hand on crash, ride, splash, hi-hat |
//! | 115 to 117 | snare with its wires thrown off: stick, rimshot, cross-stick |
//! | 118 | snare, soft mallet for a brush |
//! | 119, 120 | the snare's wires thrown off, and on |
//! | 121 | snare, a flam |
//! | 122 to 124 | snare, rolls that last as long as the note: double strokes, pressed, buzz |
//!
//! All others are silent. Places are where drummers play: a third of the way out on a drum rather than dead centre, where only
//! the round modes answer.

use std::f64::consts::PI;

use overhear_engine::kit_spec::KitSpec;
use overhear_engine::strike::Striker::{self, *};

use crate::midi::figures::Figure;

use super::{Foot, Meaning, NoteTable, Row, Stroke};

impl NoteTable {
    /// The standard notes. They find pieces by the names that these have in the standard kit; notes of a piece that a kit
    /// does not have are silent.
    pub fn standard(kit: &KitSpec) -> NoteTable {
        let mut table = NoteTable::default();
        for Note { number, name, plays, pedal, wires, figure } in NOTES_PLAYED {
            let slot = |piece: &str| kit.find(piece).map(|(slot, _)| slot);
            let meaning = match plays {
                Plays::Stroke(piece, radius, angle, striker) => {
                    slot(piece).map(|slot| Meaning::Strikes(Stroke { slot, radius, angle, striker }))
                }
                Plays::Pedal(piece, foot) => slot(piece).map(|slot| Meaning::Steps(slot, foot)),
                Plays::Choke(piece) => slot(piece).map(Meaning::Chokes),
                Plays::Throw(piece, on) => slot(piece).map(|slot| Meaning::Throws(slot, on)),
            };
            let (pedal, wires, figure) = meaning.map_or((None, None, None), |_| (pedal, wires, figure));
            let meaning = meaning.unwrap_or(Meaning::Silent);
            table.set(number, Some(Row { name: name.to_owned(), meaning, pedal, wires, figure }));
        }
        for (number, name) in SILENT {
            table.set(number, Some(Row::new(name, Meaning::Silent)));
        }
        for (piece, ordinary, controller) in PIECES {
            if let Some((slot, _)) = kit.find(piece) {
                table.set_ordinary(slot, Some(ordinary));
                table.set_position_controller(slot, controller);
            }
        }
        table
    }
}

/// Pieces with their ordinary note and the controller of the place of strokes on them.
const PIECES: [(&str, u8, Option<u8>); 9] = [
    ("kick", 36, None),
    ("snare", 38, Some(16)),
    ("rack-tom", 48, Some(18)),
    ("floor-tom", 43, Some(18)),
    ("crash", 49, Some(19)),
    ("ride", 51, Some(17)),
    ("splash", 55, Some(19)),
    ("timpani", 88, None),
    ("hi-hat", 42, Some(19)),
];

/// What a note plays.
#[derive(Clone, Copy)]
enum Plays {
    /// Strikes a piece: distance from the centre (share of the radius), direction (rad), what is swung.
    Stroke(&'static str, f64, f64, Striker),
    Pedal(&'static str, Foot),
    /// A hand on a cymbal.
    Choke(&'static str),
    /// Snare wires on or off.
    Throw(&'static str, bool),
}

#[derive(Clone, Copy)]
struct Note {
    number: u8,
    name: &'static str,
    plays: Plays,
    pedal: Option<f64>,
    wires: Option<bool>,
    figure: Option<Figure>,
}

const fn note(
    number: u8,
    name: &'static str,
    piece: &'static str,
    (radius, angle): (f64, f64),
    striker: Striker,
) -> Note {
    Note {
        number,
        name,
        plays: Plays::Stroke(piece, radius, angle, striker),
        pedal: None,
        wires: None,
        figure: None,
    }
}

/// What is no stroke.
const fn action(number: u8, name: &'static str, plays: Plays) -> Note {
    Note { number, name, plays, pedal: None, wires: None, figure: None }
}

/// A figure on the snare.
const fn figure(number: u8, name: &'static str, figure: Figure) -> Note {
    Note { figure: Some(figure), ..note(number, name, "snare", (0.25, 0.3), Stick) }
}

/// A stroke on the snare with its wires thrown off.
const fn snare_off(number: u8, name: &'static str, at: (f64, f64), striker: Striker) -> Note {
    Note { wires: Some(false), ..note(number, name, "snare", at, striker) }
}

/// A stroke with the tip on a hi-hat's bow or bell with the pedal brought to a place.
const fn tip(number: u8, name: &'static str, radius: f64, pedal: f64) -> Note {
    Note { pedal: Some(pedal), ..note(number, name, "hi-hat", (radius, 0.0), Stick) }
}

/// A stroke on a hi-hat's edge with the pedal brought to a place.
const fn edge(number: u8, name: &'static str, pedal: f64) -> Note {
    Note { pedal: Some(pedal), ..note(number, name, "hi-hat", (0.97, 0.0), Shoulder) }
}

const fn pedal(number: u8, name: &'static str, foot: Foot) -> Note {
    action(number, name, Plays::Pedal("hi-hat", foot))
}

/// Place of the pedal in an open note: the rims reach each other at one side. *Fitted* to decays of recorded open hats, 3.3, 2.9, 3.0, 2.9
/// and 2.5 s in the octaves from 500 Hz to 8 kHz; tried 0.40 to 0.48: EXPERIMENTS.md, "Open hi-hats ring like rides".
const OPEN: f64 = 0.455;

/// Place of the pedal in a half-open note: the rims lean on each other at one side, by 2 N. *Fitted* to how much recorded half-open
/// hats have lost after a quarter of a second, 9 to 13 dB; tried 0.47 to 0.52.
const HALF_OPEN: f64 = 0.48;

/// Every note that sounds. Places are *by ear*; ordinary strokes on snare and toms land 4.5 cm from the middle of the head, large or
/// small. Pedals are where drummers have them: firmly closed; open, so that the rims just meet;
/// half open, so that they lean on each other.
const NOTES_PLAYED: [Note; 65] = [
    note(35, "Acoustic Bass Drum", "kick", (0.20, 0.0), FeltBeater),
    note(36, "Bass Drum 1", "kick", (0.20, 0.0), FeltBeater),
    note(37, "Side Stick", "snare", (0.30, 0.0), CrossStick),
    note(38, "Acoustic Snare", "snare", (0.25, 0.3), Stick),
    note(40, "Electric Snare", "snare", (0.40, 0.3), RimShot),
    note(41, "Low Floor Tom", "floor-tom", (0.15, -0.4), Stick),
    edge(42, "Closed Hi-Hat", 0.8),
    note(43, "High Floor Tom", "floor-tom", (0.22, -0.4), Stick),
    pedal(44, "Pedal Hi-Hat", Foot::Chick),
    note(45, "Low Tom", "floor-tom", (0.45, -0.4), Stick),
    edge(46, "Open Hi-Hat", OPEN),
    note(47, "Low-Mid Tom", "rack-tom", (0.25, 0.2), Stick),
    note(48, "Hi-Mid Tom", "rack-tom", (0.30, 0.2), Stick),
    note(49, "Crash Cymbal 1", "crash", (0.97, 0.0), Shoulder),
    note(50, "High Tom", "rack-tom", (0.35, 0.2), Stick),
    note(51, "Ride Cymbal 1", "ride", (0.60, 0.0), Stick),
    note(52, "Chinese Cymbal", "crash", (0.97, PI / 2.0), Shoulder),
    note(53, "Ride Bell", "ride", (0.12, 0.0), Shoulder),
    note(55, "Splash Cymbal", "splash", (0.95, 0.0), Stick),
    note(57, "Crash Cymbal 2", "crash", (0.97, 0.7), Shoulder),
    note(59, "Ride Cymbal 2", "ride", (0.75, 0.3), Stick),
    note(60, "Hi Bongo", "rack-tom", (0.65, 0.2), TimpaniMallet),
    note(61, "Low Bongo", "rack-tom", (0.50, 0.2), TimpaniMallet),
    note(62, "Mute Hi Conga", "rack-tom", (0.75, 0.2), TimpaniMallet),
    note(63, "Open Hi Conga", "rack-tom", (0.35, 0.2), TimpaniMallet),
    note(64, "Low Conga", "floor-tom", (0.35, -0.4), TimpaniMallet),
    note(65, "High Timbale", "rack-tom", (0.45, 0.2), Stick),
    note(66, "Low Timbale", "floor-tom", (0.45, -0.4), Stick),
    note(88, "Timpani", "timpani", (0.75, 0.0), TimpaniMallet),
    note(89, "Timpani Hard", "timpani", (0.75, 0.0), HardMallet),
    note(90, "Timpani Centre", "timpani", (0.10, 0.0), TimpaniMallet),
    note(91, "Crash Bow", "crash", (0.60, 0.0), Stick),
    note(92, "Crash Bell", "crash", (0.12, 0.0), Shoulder),
    note(93, "Ride Edge", "ride", (0.97, 0.0), Shoulder),
    note(94, "Snare Edge", "snare", (0.85, 0.3), Stick),
    note(95, "Rack Tom Rim Shot", "rack-tom", (0.40, 0.2), RimShot),
    note(96, "Floor Tom Rim Shot", "floor-tom", (0.40, -0.4), RimShot),
    pedal(97, "Hi-Hat Foot Splash", Foot::Splash),
    note(98, "Hi-Hat Bow", "hi-hat", (0.65, 0.0), Stick),
    note(99, "Hi-Hat Bell", "hi-hat", (0.12, 0.0), Stick),
    edge(100, "Hi-Hat Half Open", HALF_OPEN),
    tip(101, "Hi-Hat Closed Bow", 0.65, 0.8),
    tip(102, "Hi-Hat Open Bow", 0.65, OPEN),
    tip(103, "Hi-Hat Closed Bell", 0.12, 0.8),
    tip(104, "Hi-Hat Open Bell", 0.12, OPEN),
    edge(105, "Hi-Hat Tight", 1.0),
    edge(106, "Hi-Hat Loose", 0.65),
    edge(107, "Hi-Hat Open 1", 0.4),
    edge(108, "Hi-Hat Open 2", 0.3),
    edge(109, "Hi-Hat Open 3", 0.15),
    edge(110, "Hi-Hat Fully Open", 0.0),
    action(111, "Crash Choke", Plays::Choke("crash")),
    action(112, "Ride Choke", Plays::Choke("ride")),
    action(113, "Splash Choke", Plays::Choke("splash")),
    action(114, "Hi-Hat Choke", Plays::Choke("hi-hat")),
    snare_off(115, "Snare Off", (0.25, 0.3), Stick),
    snare_off(116, "Snare Off Rim Shot", (0.40, 0.3), RimShot),
    snare_off(117, "Snare Off Side Stick", (0.30, 0.0), CrossStick),
    // No striker of the engine's sweeps: the softest that taps.
    note(118, "Snare Brush", "snare", (0.25, 0.3), YarnMallet),
    action(119, "Snare Wires Off", Plays::Throw("snare", false)),
    action(120, "Snare Wires On", Plays::Throw("snare", true)),
    figure(121, "Snare Flam", Figure::Flam),
    figure(122, "Snare Double Strokes", Figure::DoubleStrokes),
    figure(123, "Snare Press Roll", Figure::Press),
    figure(124, "Snare Buzz Roll", Figure::Buzz),
];

/// Notes of General MIDI that are silent: nothing in the kit sounds like them.
const SILENT: [(u8, &str); 19] = [
    (39, "Hand Clap"),
    (54, "Tambourine"),
    (56, "Cowbell"),
    (58, "Vibraslap"),
    (67, "High Agogo"),
    (68, "Low Agogo"),
    (69, "Cabasa"),
    (70, "Maracas"),
    (71, "Short Whistle"),
    (72, "Long Whistle"),
    (73, "Short Guiro"),
    (74, "Long Guiro"),
    (75, "Claves"),
    (76, "Hi Wood Block"),
    (77, "Low Wood Block"),
    (78, "Mute Cuica"),
    (79, "Open Cuica"),
    (80, "Mute Triangle"),
    (81, "Open Triangle"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::KitSpec;

    fn standard() -> (KitSpec, NoteTable) {
        let kit = KitSpec::standard();
        let table = NoteTable::standard(&kit);
        (kit, table)
    }

    #[test]
    fn general_midi_is_whole_and_every_note_has_one_row() {
        let (kit, table) = standard();
        assert_eq!(table.rows().count(), NOTES_PLAYED.len() + SILENT.len());
        assert!((35..=81).all(|note| table.row(note).is_some()));
        assert_eq!(table.check(&kit), Ok(()));
    }

    #[test]
    fn every_note_strikes_a_place_on_a_piece_of_the_kit_or_is_silent() {
        let (kit, table) = standard();
        for (note, row) in table.rows() {
            match row.meaning {
                Meaning::Strikes(stroke) => {
                    assert!(kit.piece(stroke.slot).is_some(), "{}", row.name);
                    assert!((0.1..=1.0).contains(&stroke.radius), "{}", row.name);
                }
                Meaning::Steps(..) => assert!(table.foot(note).is_some()),
                Meaning::Chokes(slot) => {
                    assert_ne!(
                        kit.piece(slot).unwrap().instrument.kind(),
                        overhear_engine::kit_spec::Kind::Drum
                    );
                }
                Meaning::Throws(slot, _) => assert!(kit.piece(slot).unwrap().defaults.preload.is_some()),
                Meaning::Silent => assert!(SILENT.iter().any(|(silent, _)| *silent == note), "{}", row.name),
            }
        }
    }

    #[test]
    fn every_piece_of_the_kit_has_an_ordinary_note() {
        let (kit, table) = standard();
        for (slot, piece) in kit.slots() {
            let ordinary = table.ordinary(slot).and_then(|note| table.stroke(note));
            assert!(ordinary.is_some_and(|stroke| stroke.slot == slot), "{}", piece.name);
        }
    }

    #[test]
    fn notes_outside_the_map_are_silent() {
        let (_, table) = standard();
        for note in (0..35).chain(82..=u8::MAX) {
            let plays = table.stroke(note).is_some() || table.foot(note).is_some();
            assert_eq!(
                plays,
                (88..=110).contains(&note) || (115..=118).contains(&note) || (121..=124).contains(&note),
                "{note}"
            );
        }
    }

    #[test]
    fn a_kit_without_a_piece_is_silent_where_it_would_be_struck() {
        let mut kit = KitSpec::standard();
        kit.pieces.retain(|piece| piece.name != "hi-hat" && piece.name != "kick");
        let table = NoteTable::standard(&kit);
        assert_eq!(table.check(&kit), Ok(()));
        for note in [35, 36, 42, 44, 46, 97, 100] {
            assert_eq!(table.row(note).map(|row| row.meaning), Some(Meaning::Silent), "{note}");
            assert_eq!(table.foot(note), None);
        }
        let (snare, _) = kit.find("snare").unwrap();
        assert_eq!(table.stroke(38).map(|stroke| stroke.slot), Some(snare));
    }

    /// The table in the module's documentation is what people read.
    #[test]
    fn documented_groups_hold() {
        let (kit, table) = standard();
        let struck = |note| table.stroke(note).and_then(|stroke| Some(kit.piece(stroke.slot)?.name.as_str()));
        for (notes, expected) in [
            (&[35, 36][..], Some("kick")),
            (&[37, 38, 40], Some("snare")),
            (&[41, 43, 45, 64, 66], Some("floor-tom")),
            (&[47, 48, 50, 60, 61, 62, 63, 65], Some("rack-tom")),
            (&[49, 52, 57], Some("crash")),
            (&[51, 53, 59], Some("ride")),
            (&[55], Some("splash")),
            (&[88, 89, 90], Some("timpani")),
            (&[91, 92], Some("crash")),
            (&[93], Some("ride")),
            (&[94, 115, 116, 117, 118, 121, 122, 123, 124], Some("snare")),
            (&[95], Some("rack-tom")),
            (&[96], Some("floor-tom")),
            (&[42, 46, 98, 99, 100, 101, 102, 103, 104, 105, 106, 107, 108, 109, 110], Some("hi-hat")),
            (&[44, 97, 111, 112, 113, 114, 119, 120, 39, 54, 56, 58, 67, 81], None),
        ] {
            assert!(notes.iter().all(|&note| struck(note) == expected), "{notes:?}");
        }
    }
}
