//! What happens within a slice, told to the performer at its sample.
//!
//! Hosts send the expressions that a note begins with behind the note, at the same sample. So notes wait until that
//! sample's events are through.

use nice_plug::midi::{Channel, Key};
use nice_plug::prelude::*;

use crate::host_parameters::HostParameters;
use crate::outputs::Buffers;
use overhear_player::decimation::Decimation;
use overhear_player::performer::Performer;

/// Notes of one sample that can wait; more than one has limbs and pads.
const MOST_NOTES: usize = 16;

/// Renders a slice with its events, each at its sample; late ones at once, none lost. Bypassed, notes strike nothing.
///
/// # Real-time
/// No allocation, no lock.
pub fn play<S>(
    performer: &mut Performer,
    mut decimation: Option<&mut Decimation>,
    buffers: &mut Buffers<'_>,
    parameters: &HostParameters,
    mut next_event: impl FnMut() -> Option<NoteEvent<S>>,
) {
    let (samples, bypassed) = (buffers.len(), parameters.is_bypassed());
    let mut notes = Notes::default();
    let mut now = 0;
    let mut render_until = |performer: &mut Performer, notes: &mut Notes, until: usize| {
        if until > now {
            notes.strike(performer);
            let (main, mut others) = buffers.stretch(now, until);
            match &mut decimation {
                Some(decimation) => decimation.render_outputs(performer, main, &mut others),
                None => performer.render_outputs(main, &mut others),
            }
            now = until;
        }
    };
    while let Some(event) = next_event() {
        // Events that change nothing do not cut: the engine renders whole stretches at a lower cost.
        let Some(event) = Message::of(&event) else { continue };
        render_until(performer, &mut notes, samples.min(event.timing as usize));
        let channel = event.on.unwrap_or_else(|| performer.any_channel());
        match event.what {
            What::NoteOn(_) if bypassed => {}
            What::NoteOn(velocity) => notes.add(performer, event.number, channel, velocity),
            What::EventKey(place) => notes.place(event.number, channel, place),
            What::Bend(semitones) => notes.bend(performer, event.number, channel, semitones),
            _ => {
                notes.strike(performer);
                event.tell(performer, channel, parameters);
            }
        }
    }
    render_until(performer, &mut notes, samples);
    notes.strike(performer);
}

/// A note that waits for its expressions.
#[derive(Clone, Copy)]
struct Note {
    number: u8,
    channel: u8,
    velocity: f32,
    place: Option<f32>,
    bend: Option<f32>,
}

/// The notes of one sample.
#[derive(Default)]
struct Notes {
    waiting: [Option<Note>; MOST_NOTES],
    count: usize,
}

impl Notes {
    fn add(&mut self, performer: &mut Performer, number: u8, channel: u8, velocity: f32) {
        if self.count == MOST_NOTES {
            self.strike(performer);
        }
        self.waiting[self.count] = Some(Note { number, channel, velocity, place: None, bend: None });
        self.count += 1;
    }

    /// The latest note of this number and channel that waits.
    fn latest(&mut self, number: u8, channel: u8) -> Option<&mut Note> {
        let waiting = self.waiting[..self.count].iter_mut().rev().flatten();
        waiting.into_iter().find(|note| (note.number, note.channel) == (number, channel))
    }

    /// A stroke lands where it is told to; once it has landed there is nothing to move.
    fn place(&mut self, number: u8, channel: u8, place: f32) {
        if let Some(note) = self.latest(number, channel) {
            note.place = Some(place);
        }
    }

    fn bend(&mut self, performer: &mut Performer, number: u8, channel: u8, semitones: f32) {
        match self.latest(number, channel) {
            Some(note) => note.bend = Some(semitones),
            None => performer.bend(number, semitones, channel),
        }
    }

    fn strike(&mut self, performer: &mut Performer) {
        for note in self.waiting[..self.count].iter_mut().filter_map(Option::take) {
            performer.aim(note.place);
            performer.note_on(note.number, note.velocity, note.channel);
            if let Some(semitones) = note.bend {
                performer.bend(note.number, semitones, note.channel);
            }
        }
        self.count = 0;
    }
}

/// An event that means something to the performer.
struct Message {
    /// Sample in the slice, or behind it.
    timing: u32,
    /// None for any.
    on: Option<u8>,
    /// Note, controller or program.
    number: u8,
    what: What,
}

enum What {
    NoteOn(f32),
    NoteOff,
    /// Of every note.
    NotesOff,
    Choke,
    /// Of every cymbal.
    ChokeAll,
    Pressure(f32),
    /// 0 the centre to 1 the rim.
    EventKey(f32),
    /// Semitones.
    Bend(f32),
    Controller(f32),
    Program,
}

impl Message {
    fn of<S>(event: &NoteEvent<S>) -> Option<Message> {
        let note = |timing: u32, channel: Channel, key: Key, what: What| {
            let (number, what) = match (key.number(), what) {
                (Some(number), what) => (number, what),
                // Whoever means any note means all of them.
                (None, What::NoteOff) => (0, What::NotesOff),
                (None, What::Choke) => (0, What::ChokeAll),
                (None, _) => return None,
            };
            Some(Message { timing, on: channel.number(), number, what })
        };
        match *event {
            NoteEvent::NoteOn { timing, channel, key, velocity, .. } => {
                note(timing, channel, key, What::NoteOn(velocity))
            }
            NoteEvent::NoteOff { timing, channel, key, .. } => note(timing, channel, key, What::NoteOff),
            NoteEvent::Choke { timing, channel, key, .. } => note(timing, channel, key, What::Choke),
            NoteEvent::PolyPressure { timing, channel, key, pressure, .. } => {
                note(timing, channel, key, What::Pressure(pressure))
            }
            NoteEvent::PolyBrightness { timing, channel, key, brightness, .. } => {
                note(timing, channel, key, What::EventKey(brightness))
            }
            NoteEvent::PolyTuning { timing, channel, key, tuning, .. } => {
                note(timing, channel, key, What::Bend(tuning))
            }
            NoteEvent::MidiCC { timing, channel, cc, value } => {
                Some(Message { timing, on: Some(channel), number: cc, what: What::Controller(value) })
            }
            NoteEvent::MidiProgramChange { timing, channel, program } => {
                Some(Message { timing, on: Some(channel), number: program, what: What::Program })
            }
            _ => None,
        }
    }

    /// Tells what needs no waiting.
    fn tell(&self, performer: &mut Performer, channel: u8, parameters: &HostParameters) {
        let number = self.number;
        match self.what {
            What::NotesOff | What::ChokeAll if !performer.hears(channel) => {}
            What::NotesOff => performer.notes_off(),
            What::ChokeAll => performer.choke_all(),
            What::NoteOff => performer.note_off(number, channel),
            What::Choke => performer.choke(number, channel),
            What::Pressure(pressure) => performer.pressure(number, pressure, channel),
            What::Controller(value) => performer.control_change(number, value, channel),
            What::Program => {
                // Where nobody has moved the parameters for it, as in the framework's own program, they would be back
                // with the next slice.
                parameters.with_program(number, channel, |program| {
                    if parameters.are_at(program) {
                        performer.program_change(program, channel);
                    }
                });
            }
            What::NoteOn(_) | What::EventKey(_) | What::Bend(_) => {}
        }
    }
}
