//! The reference notes: the General MIDI drum map and beyond. Which note strikes what, where, and with what.
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
//! | 53 | ride bell | ride, stick on the bell |
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
//! | 91, 92 | crash, stick on the bow and on the bell |
//! | 93 | ride, stick shoulder on the edge |
//! | 94 | snare, stick near the rim |
//! | 95, 96 | rack tom, floor tom, rimshots |
//! | 97 | the hi-hat's pedal, down and up at once: a foot splash |
//! | 98, 99 | hi-hat, stick on the bow and on the bell, the pedal where it is |
//! | 100 | hi-hat, half open: stick shoulder on the edge; brings the pedal to where the rims just meet |
//!
//! All others outside 35 to 81 are silent. Places are where drummers play: a third of the way out on a
//! drum rather than dead centre, where only the round modes answer.

use std::f64::consts::PI;

use overhear_engine::piece::PieceId;
use overhear_engine::strike::Striker;

/// First note of the General MIDI drum map.
pub const FIRST_NOTE: u8 = 35;

/// Last note of the General MIDI drum map.
pub const LAST_NOTE: u8 = 81;

/// What a note strikes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// The piece.
    pub piece: PieceId,
    /// Distance from the centre as a share of the radius, 0 to 1.
    pub radius: f64,
    /// Direction of the place seen from the centre, rad; 0 is toward the player.
    pub angle: f64,
    /// What is swung.
    pub striker: Striker,
}

impl Stroke {
    /// Whether a position controller moves the stroke: those with a stick's tip or a mallet between bell and edge.
    pub fn moves_with_hand(&self) -> bool {
        let (inner, outer) = self.reach();
        let tip = !matches!(self.striker, Striker::CrossStick | Striker::RimShot | Striker::Shoulder);
        tip && (inner..=outer).contains(&self.radius)
    }

    /// Least and greatest distance from the centre that a position controller reaches, shares of the radius.
    pub fn reach(&self) -> (f64, f64) {
        // The bell has its own notes.
        if self.piece.is_drum() { (0.0, 0.95) } else { (0.25, 0.97) }
    }
}

/// What a note means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    /// It strikes a piece.
    Strikes(Stroke),
    /// It is the hi-hat's pedal.
    Steps(Foot),
    /// It makes no sound, for the reason given.
    Silent(&'static str),
}

/// What a note does with the hi-hat's pedal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// Before a stroke it is brought there, 0 (up) to 1 (down), unless a controller plays the pedal.
    Brought(f64),
    /// It is brought down as fast as the note is loud.
    Chick,
    /// It is brought down as fast as the note is loud, and up at once.
    Splash,
}

/// What a note does with the hi-hat's pedal, if it does.
///
/// # Real-time
/// A table look-up.
pub fn foot(note: u8) -> Option<Foot> {
    match (note, &row_of(note)?.meaning) {
        (_, Meaning::Steps(foot)) => Some(*foot),
        // Where drummers have them: firmly closed; open, so that a stroke makes the rims clash;
        // resting on one side.
        (42, _) => Some(Foot::Brought(0.8)),
        (46, _) => Some(Foot::Brought(0.4)),
        (100, _) => Some(Foot::Brought(0.5)),
        _ => None,
    }
}

/// One row of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// MIDI note.
    pub note: u8,
    /// Name of the note in General MIDI.
    pub name: &'static str,
    /// What it means here.
    pub meaning: Meaning,
}

/// The row of a note, if it is in the map.
///
/// # Real-time
/// A table look-up.
pub fn row_of(note: u8) -> Option<&'static Row> {
    let general = note.checked_sub(FIRST_NOTE).and_then(|index| MAP.get(usize::from(index)));
    general.or_else(|| BEYOND.iter().find(|row| row.note == note))
}

/// The stroke that a note asks for, if it sounds.
///
/// # Real-time
/// A table look-up.
pub fn stroke(note: u8) -> Option<&'static Stroke> {
    match &row_of(note)?.meaning {
        Meaning::Strikes(stroke) => Some(stroke),
        Meaning::Steps(_) | Meaning::Silent(_) => None,
    }
}

const NOTHING_LIKE_IT: Meaning = Meaning::Silent("nothing in the kit sounds like it");

const fn strikes(piece: PieceId, radius: f64, angle: f64, striker: Striker) -> Meaning {
    Meaning::Strikes(Stroke { piece, radius, angle, striker })
}

const fn row(note: u8, name: &'static str, meaning: Meaning) -> Row {
    Row { note, name, meaning }
}

/// The map, note by note from [`FIRST_NOTE`] to [`LAST_NOTE`]. Places are by ear.
pub static MAP: [Row; (LAST_NOTE - FIRST_NOTE + 1) as usize] = {
    use PieceId::*;
    use Striker::*;
    [
        row(35, "Acoustic Bass Drum", strikes(Kick, 0.20, 0.0, FeltBeater)),
        row(36, "Bass Drum 1", strikes(Kick, 0.20, 0.0, FeltBeater)),
        row(37, "Side Stick", strikes(Snare, 0.30, 0.0, CrossStick)),
        row(38, "Acoustic Snare", strikes(Snare, 0.25, 0.3, Stick)),
        row(39, "Hand Clap", NOTHING_LIKE_IT),
        row(40, "Electric Snare", strikes(Snare, 0.40, 0.3, RimShot)),
        row(41, "Low Floor Tom", strikes(FloorTom, 0.25, -0.4, Stick)),
        row(42, "Closed Hi-Hat", strikes(HiHat, 0.97, 0.0, Shoulder)),
        row(43, "High Floor Tom", strikes(FloorTom, 0.35, -0.4, Stick)),
        row(44, "Pedal Hi-Hat", Meaning::Steps(Foot::Chick)),
        row(45, "Low Tom", strikes(FloorTom, 0.45, -0.4, Stick)),
        row(46, "Open Hi-Hat", strikes(HiHat, 0.97, 0.0, Shoulder)),
        row(47, "Low-Mid Tom", strikes(RackTom, 0.25, 0.2, Stick)),
        row(48, "Hi-Mid Tom", strikes(RackTom, 0.30, 0.2, Stick)),
        row(49, "Crash Cymbal 1", strikes(Crash, 0.97, 0.0, Shoulder)),
        row(50, "High Tom", strikes(RackTom, 0.35, 0.2, Stick)),
        row(51, "Ride Cymbal 1", strikes(Ride, 0.60, 0.0, Stick)),
        row(52, "Chinese Cymbal", strikes(Crash, 0.97, PI / 2.0, Shoulder)),
        row(53, "Ride Bell", strikes(Ride, 0.12, 0.0, Stick)),
        row(54, "Tambourine", NOTHING_LIKE_IT),
        row(55, "Splash Cymbal", strikes(Splash, 0.95, 0.0, Stick)),
        row(56, "Cowbell", NOTHING_LIKE_IT),
        row(57, "Crash Cymbal 2", strikes(Crash, 0.97, 0.7, Shoulder)),
        row(58, "Vibraslap", NOTHING_LIKE_IT),
        row(59, "Ride Cymbal 2", strikes(Ride, 0.75, 0.3, Stick)),
        row(60, "Hi Bongo", strikes(RackTom, 0.65, 0.2, TimpaniMallet)),
        row(61, "Low Bongo", strikes(RackTom, 0.50, 0.2, TimpaniMallet)),
        row(62, "Mute Hi Conga", strikes(RackTom, 0.75, 0.2, TimpaniMallet)),
        row(63, "Open Hi Conga", strikes(RackTom, 0.35, 0.2, TimpaniMallet)),
        row(64, "Low Conga", strikes(FloorTom, 0.35, -0.4, TimpaniMallet)),
        row(65, "High Timbale", strikes(RackTom, 0.45, 0.2, Stick)),
        row(66, "Low Timbale", strikes(FloorTom, 0.45, -0.4, Stick)),
        row(67, "High Agogo", NOTHING_LIKE_IT),
        row(68, "Low Agogo", NOTHING_LIKE_IT),
        row(69, "Cabasa", NOTHING_LIKE_IT),
        row(70, "Maracas", NOTHING_LIKE_IT),
        row(71, "Short Whistle", NOTHING_LIKE_IT),
        row(72, "Long Whistle", NOTHING_LIKE_IT),
        row(73, "Short Guiro", NOTHING_LIKE_IT),
        row(74, "Long Guiro", NOTHING_LIKE_IT),
        row(75, "Claves", NOTHING_LIKE_IT),
        row(76, "Hi Wood Block", NOTHING_LIKE_IT),
        row(77, "Low Wood Block", NOTHING_LIKE_IT),
        row(78, "Mute Cuica", NOTHING_LIKE_IT),
        row(79, "Open Cuica", NOTHING_LIKE_IT),
        row(80, "Mute Triangle", NOTHING_LIKE_IT),
        row(81, "Open Triangle", NOTHING_LIKE_IT),
    ]
};

/// Notes of our own, beyond the General MIDI drum map. Places are by ear.
pub static BEYOND: [Row; 13] = {
    use PieceId::*;
    use Striker::*;
    [
        row(88, "Timpani", strikes(Timpani, 0.75, 0.0, TimpaniMallet)),
        row(89, "Timpani Hard", strikes(Timpani, 0.75, 0.0, HardMallet)),
        row(90, "Timpani Centre", strikes(Timpani, 0.10, 0.0, TimpaniMallet)),
        row(91, "Crash Bow", strikes(Crash, 0.60, 0.0, Stick)),
        row(92, "Crash Bell", strikes(Crash, 0.12, 0.0, Stick)),
        row(93, "Ride Edge", strikes(Ride, 0.97, 0.0, Shoulder)),
        row(94, "Snare Edge", strikes(Snare, 0.85, 0.3, Stick)),
        row(95, "Rack Tom Rim Shot", strikes(RackTom, 0.40, 0.2, RimShot)),
        row(96, "Floor Tom Rim Shot", strikes(FloorTom, 0.40, -0.4, RimShot)),
        row(97, "Hi-Hat Foot Splash", Meaning::Steps(Foot::Splash)),
        row(98, "Hi-Hat Bow", strikes(HiHat, 0.65, 0.0, Stick)),
        row(99, "Hi-Hat Bell", strikes(HiHat, 0.12, 0.0, Stick)),
        row(100, "Hi-Hat Half Open", strikes(HiHat, 0.97, 0.0, Shoulder)),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_run_from_35_to_81_in_order() {
        for (row, note) in MAP.iter().zip(FIRST_NOTE..=LAST_NOTE) {
            assert_eq!(row.note, note);
        }
        assert_eq!(MAP.len(), 47);
    }

    #[test]
    fn every_note_strikes_a_place_on_a_piece_of_the_kit_or_says_why_not() {
        for row in MAP.iter().chain(&BEYOND) {
            match row.meaning {
                Meaning::Strikes(stroke) => {
                    assert!(stroke.piece.slot().is_some(), "{}", row.name);
                    assert!((0.1..=1.0).contains(&stroke.radius), "{}", row.name);
                }
                Meaning::Steps(_) => assert!(foot(row.note).is_some()),
                Meaning::Silent(reason) => assert!(!reason.is_empty(), "{}", row.name),
            }
        }
    }

    #[test]
    fn every_piece_of_the_kit_has_a_note() {
        for piece in PieceId::KIT {
            assert!((0..=127).filter_map(stroke).any(|stroke| stroke.piece == piece));
        }
    }

    #[test]
    fn notes_outside_the_map_are_silent() {
        for note in (0..FIRST_NOTE).chain(LAST_NOTE + 1..=u8::MAX) {
            assert_eq!(stroke(note).is_some() || foot(note).is_some(), (88..=100).contains(&note));
        }
    }

    /// The table in the module's documentation is what people read.
    #[test]
    fn documented_groups_hold() {
        let piece = |note| stroke(note).map(|stroke| stroke.piece);
        for (notes, expected) in [
            (&[35, 36][..], Some(PieceId::Kick)),
            (&[37, 38, 40], Some(PieceId::Snare)),
            (&[41, 43, 45, 64, 66], Some(PieceId::FloorTom)),
            (&[47, 48, 50, 60, 61, 62, 63, 65], Some(PieceId::RackTom)),
            (&[49, 52, 57], Some(PieceId::Crash)),
            (&[51, 53, 59], Some(PieceId::Ride)),
            (&[55], Some(PieceId::Splash)),
            (&[88, 89, 90], Some(PieceId::Timpani)),
            (&[91, 92], Some(PieceId::Crash)),
            (&[93], Some(PieceId::Ride)),
            (&[94], Some(PieceId::Snare)),
            (&[95], Some(PieceId::RackTom)),
            (&[96], Some(PieceId::FloorTom)),
            (&[42, 46, 98, 99, 100], Some(PieceId::HiHat)),
            (&[44, 97, 39, 54, 56, 58, 67, 81], None),
        ] {
            assert!(notes.iter().all(|&note| piece(note) == expected), "{notes:?}");
        }
    }
}
