//! The user's own assignments: notes that play something else than their map says.
//!
//! Shared by the audio thread, which reads one atomic per note and takes part in learning, the editor, which
//! changes it, and the state, which stores it. All values are valid in any order: no lock is needed.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};
use std::sync::atomic::{AtomicU8, Ordering};

use super::calibration::{Calibration, Learned};

pub use crate::midi_map::NOTES;

/// Stored for a note that follows its map.
const MAPPED: u8 = 0xFF;

/// Stored for a note that is silent.
const SILENT: u8 = 0xFE;

/// Stored while nothing is learned.
const IDLE: u8 = 0xFF;

/// What a note plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assignment {
    /// What the map says.
    Mapped,
    /// Nothing.
    Silent,
    /// A note of the kit's table, 0 to 127; silent where the table has none.
    Plays(u8),
}

impl Assignment {
    fn from_byte(byte: u8) -> Assignment {
        match byte {
            MAPPED => Assignment::Mapped,
            note if usize::from(note) < NOTES => Assignment::Plays(note),
            _ => Assignment::Silent,
        }
    }

    fn to_byte(self) -> u8 {
        match self {
            Assignment::Mapped => MAPPED,
            Assignment::Silent => SILENT,
            Assignment::Plays(note) => note,
        }
    }

    /// As written in presets and states: `silent` or the number of a reference note.
    pub fn to_text(self) -> Option<String> {
        match self {
            Assignment::Mapped => None,
            Assignment::Silent => Some("silent".to_owned()),
            Assignment::Plays(note) => Some(note.to_string()),
        }
    }

    /// Reads what [`to_text`](Self::to_text) writes.
    pub fn from_text(text: &str) -> Option<Assignment> {
        match text {
            "silent" => Some(Assignment::Silent),
            _ => {
                let note = text.parse().ok().filter(|&note| usize::from(note) < NOTES)?;
                Some(Assignment::Plays(note))
            }
        }
    }
}

/// Assignments of all notes, the reference note that waits for a pad, and the calibration of pads and pedal.
#[derive(Debug)]
pub struct Assignments {
    notes: [AtomicU8; NOTES],
    learning: AtomicU8,
    calibration: Calibration,
}

/// All that a user has taught an instance about what arrives.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Taught {
    /// Every note that does not follow its map.
    pub notes: BTreeMap<u8, Assignment>,
    /// What was learned of pads and pedal.
    pub calibration: Learned,
}

impl Default for Assignments {
    fn default() -> Self {
        Assignments {
            notes: [const { AtomicU8::new(MAPPED) }; NOTES],
            learning: AtomicU8::new(IDLE),
            calibration: Calibration::default(),
        }
    }
}

impl Assignments {
    /// What a note plays.
    ///
    /// # Real-time
    /// One load.
    pub fn of(&self, note: u8) -> Assignment {
        self.notes
            .get(usize::from(note))
            .map_or(Assignment::Mapped, |byte| Assignment::from_byte(byte.load(Ordering::Relaxed)))
    }

    /// Lets a note play something else. Notes beyond 127 are ignored.
    pub fn assign(&self, note: u8, assignment: Assignment) {
        if let Some(byte) = self.notes.get(usize::from(note)) {
            byte.store(assignment.to_byte(), Ordering::Relaxed);
        }
    }

    /// Lets the next note that arrives play this reference note; `None` gives learning up.
    pub fn learn(&self, reference: Option<u8>) {
        let wanted = reference.filter(|&note| usize::from(note) < NOTES);
        self.learning.store(wanted.unwrap_or(IDLE), Ordering::Relaxed);
    }

    /// The reference note that waits for a pad.
    pub fn learning(&self) -> Option<u8> {
        Some(self.learning.load(Ordering::Relaxed)).filter(|&note| note != IDLE)
    }

    /// The calibration of pads and pedal.
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// All that the user has taught.
    pub fn taught(&self) -> Taught {
        Taught { notes: self.changed(), calibration: self.calibration.learned() }
    }

    /// Puts this in place of all that the user has taught.
    pub fn teach(&self, taught: &Taught) {
        self.replace(&taught.notes);
        self.calibration.replace(&taught.calibration);
    }

    /// A number that changes with whatever is assigned, calibrated or waits to be learned.
    pub fn fingerprint(&self) -> u64 {
        let bytes = self.notes.iter().chain([&self.learning]).map(|byte| byte.load(Ordering::Relaxed));
        let mut hasher = DefaultHasher::new();
        bytes.for_each(|byte| hasher.write_u8(byte));
        self.calibration.words().for_each(|word| hasher.write_u64(word));
        hasher.finish()
    }

    /// Tells what is learned that a note arrived.
    ///
    /// # Real-time
    /// A load, and two stores when something was waiting.
    pub fn heard(&self, note: u8) {
        if let Some(reference) = self.learning() {
            self.assign(note, Assignment::Plays(reference));
            self.learn(None);
        }
    }

    /// Every note that does not follow its map.
    pub fn changed(&self) -> BTreeMap<u8, Assignment> {
        (0..NOTES as u8)
            .map(|note| (note, self.of(note)))
            .filter(|&(_, assignment)| assignment != Assignment::Mapped)
            .collect()
    }

    /// Puts these in place of all there were.
    pub fn replace(&self, changed: &BTreeMap<u8, Assignment>) {
        for note in 0..NOTES as u8 {
            self.assign(note, changed.get(&note).copied().unwrap_or(Assignment::Mapped));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_follows_its_map_until_it_is_assigned() {
        let assignments = Assignments::default();
        assert_eq!(assignments.of(38), Assignment::Mapped);
        assignments.assign(38, Assignment::Plays(49));
        assignments.assign(40, Assignment::Silent);
        assert_eq!((assignments.of(38), assignments.of(40)), (Assignment::Plays(49), Assignment::Silent));
        assert_eq!(assignments.changed().len(), 2);
        assignments.replace(&BTreeMap::from([(41, Assignment::Plays(36))]));
        assert_eq!(assignments.changed(), BTreeMap::from([(41, Assignment::Plays(36))]));
    }

    #[test]
    fn learning_takes_one_note_and_no_more() {
        let assignments = Assignments::default();
        assignments.heard(50);
        assert!(assignments.changed().is_empty());
        assignments.learn(Some(51));
        assert_eq!(assignments.learning(), Some(51));
        assignments.heard(17);
        assignments.heard(18);
        assert_eq!(assignments.changed(), BTreeMap::from([(17, Assignment::Plays(51))]));
        assignments.learn(Some(200));
        assert_eq!(assignments.learning(), None, "there is no note 200");
    }

    #[test]
    fn text_and_assignment_agree_both_ways() {
        for assignment in [Assignment::Silent, Assignment::Plays(38), Assignment::Plays(90)] {
            assert_eq!(Assignment::from_text(&assignment.to_text().unwrap()), Some(assignment));
        }
        for text in ["", "128", "-1", "loud", "1e2"] {
            assert_eq!(Assignment::from_text(text), None, "{text}");
        }
    }

    #[test]
    fn notes_beyond_midi_are_left_alone() {
        let assignments = Assignments::default();
        assignments.assign(200, Assignment::Silent);
        assert_eq!(assignments.of(200), Assignment::Mapped);
        assert!(assignments.changed().is_empty());
    }
}
