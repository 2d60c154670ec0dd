//! A kit and the notes that play it.

use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::KitSpec;

use crate::midi_map::NoteTable;

/// A kit and the notes that play it: what a kit file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct KitDocument {
    /// The kit.
    pub kit: KitSpec,
    /// What notes play on it.
    pub notes: NoteTable,
}

impl KitDocument {
    /// The standard kit with its notes.
    pub fn standard() -> KitDocument {
        let kit = KitSpec::standard();
        let notes = NoteTable::standard(&kit);
        KitDocument { kit, notes }
    }

    /// Checks the kit, and that notes play what it has.
    ///
    /// # Errors
    /// [`SpecError`] with the path of what is wrong: `pieces.snare.diameter_m`, `notes.38.radius`.
    pub fn check(&self) -> Result<(), SpecError> {
        self.kit.check()?;
        self.notes.check(&self.kit).map_err(|error| error.inside("notes"))
    }
}

impl Default for KitDocument {
    fn default() -> Self {
        KitDocument::standard()
    }
}

/// Slot of a piece of the standard kit, by its name in kit files.
///
/// # Panics
/// If the standard kit has no such piece.
pub fn standard_slot(name: &str) -> overhear_engine::slot::Slot {
    KitSpec::standard().find(name).expect("a piece of the standard kit").0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::midi_map::{Foot, Meaning, Row, Stroke};
    use overhear_engine::slot::Slot;
    use overhear_engine::strike::Striker;

    #[test]
    fn the_standard_kit_is_sound() {
        assert_eq!(KitDocument::standard().check(), Ok(()));
    }

    /// What is wrong with the standard kit after a change of its notes.
    fn refused(change: impl FnOnce(&mut NoteTable)) -> String {
        let mut document = KitDocument::standard();
        change(&mut document.notes);
        document.check().unwrap_err().to_string()
    }

    fn row(meaning: Meaning, pedal: Option<f64>) -> Option<Row> {
        Some(Row { pedal, ..Row::new("Tested", meaning) })
    }

    fn stroke(slot: Slot, radius: f64) -> Meaning {
        Meaning::Strikes(Stroke { slot, radius, angle: 0.0, striker: Striker::Stick })
    }

    #[test]
    fn notes_that_play_nothing_of_the_kit_are_refused_with_their_path() {
        let (kick, hat, empty) = (standard_slot("kick"), standard_slot("hi-hat"), Slot::ALL[12]);
        for (meaning, pedal, says) in [
            (stroke(empty, 0.5), None, "notes.3.piece is not in the kit"),
            (stroke(kick, 1.5), None, "notes.3.radius is 1.5, accepted: 0 to 1"),
            (stroke(kick, f64::NAN), None, "notes.3.radius is NaN"),
            (stroke(kick, 0.5), Some(0.5), "notes.3.pedal is given, accepted: only on a hi-hat"),
            (stroke(hat, 0.5), Some(1.5), "notes.3.pedal is 1.5, accepted: 0 to 1"),
            (Meaning::Steps(kick, Foot::Chick), None, "notes.3.pedal is given, accepted: only on a hi-hat"),
            (Meaning::Steps(hat, Foot::Position(-1.0)), None, "notes.3.pedal is -1, accepted: 0 to 1"),
            (Meaning::Steps(empty, Foot::Splash), None, "notes.3.piece is not in the kit"),
            (Meaning::Chokes(kick), None, "notes.3.choke is given, accepted: only on a cymbal"),
            (Meaning::Chokes(empty), None, "notes.3.piece is not in the kit"),
            (Meaning::Throws(hat, true), None, "notes.3.wires is given, accepted: only on a drum of the kit"),
        ] {
            let error = refused(|notes| notes.set(3, row(meaning, pedal)));
            assert!(error.contains(says), "{error}");
        }
        let nameless = Row::new(" ", Meaning::Silent);
        assert!(refused(|notes| notes.set(3, Some(nameless))).contains("notes.3.name"));
        assert!(refused(|notes| notes.set_ordinary(kick, Some(38))).contains("notes.kick.ordinary is 38"));
        for (slot, controller) in [(kick, 4), (empty, 16)] {
            let error = refused(|notes| notes.set_position_controller(slot, Some(controller)));
            assert!(error.contains("position_controller"), "{error}");
        }
    }

    #[test]
    fn a_kit_that_lost_a_piece_that_notes_play_is_refused() {
        let mut document = KitDocument::standard();
        document.kit.pieces.pop();
        assert!(document.check().unwrap_err().to_string().contains("is not in the kit"));
    }
}
