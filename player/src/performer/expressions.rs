//! What expressions of a note do to the piece that it struck, while it sounds and until the piece's next stroke.

use overhear_engine::slot::Slot;

use super::Performer;
use crate::midi::expressions::Expressions;
use crate::parameters::{SlotParameter, slot_index};

/// Most semitones of a bend, either way; the pieces' own ranges are narrower.
const MOST_BEND: f32 = 48.0;

impl Performer {
    /// Bends the pitch of the piece that a note strikes, semitones, within the piece's range and until its next stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn bend(&mut self, note: u8, semitones: f32, channel: u8) {
        let bend = f64::from(semitones.clamp(-MOST_BEND, MOST_BEND));
        self.express_note(note, channel, semitones, |now| Expressions { bend, ..now });
    }

    /// Scales the sound of the piece that a note strikes by a gain, a ratio of 0 to 4, until its next stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn scale(&mut self, note: u8, gain: f32, channel: u8) {
        let ratio = f64::from(gain.clamp(0.0, 4.0));
        self.express_note(note, channel, gain, |now| Expressions { gain: ratio, ..now });
    }

    /// Moves the piece that a note strikes to the left (below 0) or the right of where it is, -1 to 1, until its next
    /// stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn pan(&mut self, note: u8, aside: f32, channel: u8) {
        let pan = f64::from(aside.clamp(-1.0, 1.0));
        self.express_note(note, channel, aside, |now| Expressions { pan, ..now });
    }

    /// Moves the hand that plays a note's piece: its next strokes land there, 0 (centre) to 1 (rim), until the note ends.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn move_hand(&mut self, note: u8, place: f32, channel: u8) {
        self.playing.move_hand(note, place, channel);
    }

    fn express_note(
        &mut self,
        note: u8,
        channel: u8,
        value: f32,
        change: impl FnOnce(Expressions) -> Expressions,
    ) {
        if let Some(slot) = self.playing.bent(note, channel).filter(|_| !value.is_nan()) {
            self.express(slot, change(self.expressions[slot.index()]));
        }
    }

    /// Lets a slot's piece sound as expressions say.
    pub(super) fn express(&mut self, slot: Slot, expressions: Expressions) {
        let former = std::mem::replace(&mut self.expressions[slot.index()], expressions);
        if former.bend != expressions.bend {
            self.tune(slot);
        }
        if former.gain != expressions.gain {
            self.apply(slot_index(slot, SlotParameter::Level));
        }
        if former.pan != expressions.pan {
            self.apply(slot_index(slot, SlotParameter::Pan));
        }
    }

    /// Whether the piece of a slot still sounds.
    pub fn sounds(&self, slot: Slot) -> bool {
        match self.kit.piece(slot) {
            Some(piece) => !piece.is_asleep(),
            // A worker may have it.
            None => !self.kit.is_whole(),
        }
    }
}
