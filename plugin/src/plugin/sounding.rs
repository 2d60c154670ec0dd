//! The notes that sound, by the ids that hosts give them.
//!
//! A piece sounds on after the stroke of a note, and what is done to a note is done to its piece until the next stroke. So the
//! latest note on a piece is the one that sounds there: another stroke ends it, and so does the piece's silence. Hosts are
//! told of these ends.

use nice_plug::midi::{Channel, Key, NoteEvent, VoiceID};
use overhear_engine::slot::{SLOTS, Slot};
use overhear_player::performer::Performer;

/// Most ends of a buffer that hosts are told of.
const MOST_ENDS: usize = 256;

/// A note as the host knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoundingNote {
    /// The host's own number of it, if it has one.
    pub id: VoiceID,
    /// MIDI channel, 0 to 15.
    pub channel: u8,
    /// MIDI note.
    pub number: u8,
}

/// The notes that sound, and those that have ended since the host was told.
pub struct Sounding {
    /// `[slot]`.
    notes: [Option<SoundingNote>; SLOTS],
    /// With the sample in the slice.
    ends: [Option<(u32, SoundingNote)>; MOST_ENDS],
    count: usize,
}

impl Default for Sounding {
    fn default() -> Self {
        Sounding { notes: [None; SLOTS], ends: [None; MOST_ENDS], count: 0 }
    }
}

impl Sounding {
    /// A note has struck a slot's piece, or nothing.
    ///
    /// # Real-time
    /// A store.
    pub fn strike(&mut self, timing: u32, note: SoundingNote, slot: Option<Slot>) {
        let ended = match slot {
            Some(slot) => self.notes[slot.index()].replace(note),
            None => Some(note),
        };
        ended.into_iter().for_each(|ended| self.end(timing, ended));
    }

    fn end(&mut self, timing: u32, note: SoundingNote) {
        if let Some(place) = self.ends.get_mut(self.count) {
            *place = Some((timing, note));
            self.count += 1;
        }
    }

    /// Ends the notes of pieces that are silent at a sample of the slice.
    ///
    /// # Real-time
    /// A look at every piece.
    pub fn follow(&mut self, timing: u32, performer: &Performer) {
        for slot in Slot::ALL {
            if !performer.sounds(slot)
                && let Some(note) = self.notes[slot.index()].take()
            {
                self.end(timing, note);
            }
        }
    }

    /// The notes that sound and have this id, or all of a channel where neither id nor channel is given.
    pub fn of(&self, id: VoiceID, channel: Option<u8>) -> impl Iterator<Item = SoundingNote> {
        let wanted = move |note: &SoundingNote| match id {
            VoiceID::ID(_) => note.id == id,
            VoiceID::Wildcard => channel.is_none_or(|channel| channel == note.channel),
        };
        self.notes.into_iter().flatten().filter(wanted)
    }

    /// Tells of the notes that have ended.
    ///
    /// # Real-time
    /// A call for each.
    pub fn tell<S>(&mut self, mut tell: impl FnMut(NoteEvent<S>)) {
        for (timing, note) in self.ends[..self.count].iter_mut().filter_map(Option::take) {
            tell(NoteEvent::VoiceTerminated {
                timing,
                voice_id: note.id,
                channel: Channel::Number(note.channel),
                key: Key::Number(note.number),
            });
        }
        self.count = 0;
    }

    /// Forgets all notes, of which the host knows that they are gone.
    pub fn forget(&mut self) {
        (self.notes, self.count) = ([None; SLOTS], 0);
    }
}
