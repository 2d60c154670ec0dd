//! The subjects of the recordings: pieces, and the hi-hat closed and open.

use anyhow::Result;
use overhear::kit_document::KitDocument;
use overhear::midi_map::Foot;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Strike;

use crate::bad_input;
use crate::{hear, settings};

/// A piece as it was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subject {
    /// Places where it is struck, shares of the radius: about the one its note has.
    pub places: [f64; 3],
    /// The piece's own name, or with what its pedal does.
    pub name: &'static str,
    /// Name of the piece in the kit.
    pub piece: &'static str,
    /// The note whose stroke and pedal it has, if not the piece's ordinary one.
    pub note: Option<u8>,
}

/// All there are recordings of, in the order of the report.
pub const SUBJECTS: [Subject; 9] = [
    Subject { name: "kick", places: [0.1, 0.2, 0.3], piece: "kick", note: None },
    Subject { name: "snare", places: [0.15, 0.25, 0.35], piece: "snare", note: None },
    Subject { name: "rack-tom", places: [0.2, 0.3, 0.4], piece: "rack-tom", note: None },
    Subject { name: "floor-tom", places: [0.12, 0.22, 0.32], piece: "floor-tom", note: None },
    Subject { name: "crash", places: [0.9, 0.94, 0.97], piece: "crash", note: None },
    Subject { name: "ride", places: [0.5, 0.6, 0.7], piece: "ride", note: None },
    Subject { name: "splash", places: [0.9, 0.95, 0.97], piece: "splash", note: None },
    Subject { name: "hi-hat-closed", places: [0.9, 0.94, 0.97], piece: "hi-hat", note: Some(42) },
    Subject { name: "hi-hat-open", places: [0.9, 0.94, 0.97], piece: "hi-hat", note: Some(46) },
];

impl Subject {
    /// The slot of the piece.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if the kit has no piece of that name.
    pub fn slot(&self, document: &KitDocument) -> Result<Slot> {
        Ok(settings::piece(&document.kit, self.piece)?.0)
    }

    /// The stroke on the piece of a slot.
    pub fn strike(&self, document: &KitDocument, slot: Slot) -> Strike {
        let ordinary = hear::default_strike(document, slot);
        let mapped = self.note.and_then(|note| document.notes.stroke(note));
        mapped.filter(|stroke| stroke.slot == slot).map_or(ordinary, |stroke| Strike {
            radius: stroke.radius,
            angle: stroke.angle,
            striker: stroke.striker,
            ..ordinary
        })
    }

    /// Position of the pedal of a slot, from 0 (up) to 1 (down).
    pub fn pedal(&self, document: &KitDocument, slot: Slot) -> Option<f64> {
        match document.notes.foot(self.note?)? {
            (moved, Foot::Position(pedal)) if moved == slot => Some(pedal),
            _ => None,
        }
    }
}

/// The subjects of those names, or of pieces of those names; all for none.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the subjects.
pub fn subjects(names: &[String]) -> Result<Vec<Subject>> {
    if names.is_empty() {
        return Ok(SUBJECTS.to_vec());
    }
    let mut found = Vec::new();
    for name in names {
        let before = found.len();
        found.extend(SUBJECTS.into_iter().filter(|it| it.name == name || it.piece == name));
        if found.len() == before {
            let accepted = SUBJECTS.map(|subject| subject.name).join(", ");
            return Err(bad_input!("there are no recordings of `{name}`, accepted: {accepted}"));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::realism::reference;

    #[test]
    fn every_subject_has_a_reference_and_a_name_of_its_own() {
        for subject in SUBJECTS {
            assert!(reference::figures(subject.name).len() > 10, "{subject:?}");
            assert_eq!(subjects(&[subject.name.to_owned()]).unwrap(), [subject]);
        }
        assert_eq!(subjects(&[]).unwrap(), SUBJECTS);
        assert!(subjects(&["timpani".to_owned()]).unwrap_err().to_string().contains("accepted: kick, snare"));
    }

    #[test]
    fn every_subject_is_a_piece_of_the_standard_kit() {
        let document = KitDocument::standard();
        assert!(SUBJECTS.iter().all(|subject| subject.slot(&document).is_ok()));
    }

    #[test]
    fn every_subject_is_struck_about_where_its_note_lands() {
        let document = KitDocument::standard();
        for subject in SUBJECTS {
            let played = subject.strike(&document, subject.slot(&document).unwrap()).radius;
            let [nearer, middle, farther] = subject.places;
            println!("{}: {played}", subject.name);
            assert!(
                (middle - played).abs() < 0.051 && nearer < middle && middle < farther,
                "{subject:?} {played}"
            );
        }
    }

    #[test]
    fn a_hi_hat_is_measured_closed_and_open() {
        let hats = subjects(&["hi-hat".to_owned()]).unwrap();
        let document = KitDocument::standard();
        let pedal = |hat: &Subject| hat.pedal(&document, hat.slot(&document).unwrap()).expect("a pedal");
        let pedals: Vec<_> = hats.iter().map(pedal).collect();
        assert!(pedals.len() == 2 && pedals[0] > 0.6 && pedals[1] < 0.6, "{pedals:?}");
    }
}
