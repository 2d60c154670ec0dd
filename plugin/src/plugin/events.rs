//! What happens within a slice, told to the performer at its sample.
//!
//! Hosts send the expressions that a note begins with behind the note, at the same sample. So notes wait until that
//! sample's events are through.

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

use crate::host_parameters::HostParameters;
use crate::incoming::Monitor;
use crate::outputs::Buffers;
use crate::plugin::sounding::{Sounding, SoundingNote};
use overhear_player::decimation::Decimation;
use overhear_player::midi::learning::MidiMessage;
use overhear_player::performer::Performer;

/// Notes of one sample that can wait; more than one has limbs and pads.
const MOST_NOTES: usize = 16;

/// Renders a slice with its events, each at its sample; late ones at once, none lost. Bypassed, notes strike nothing.
///
/// # Real-time
/// No allocation, no lock.
pub fn play<S>(
    performer: &mut Performer,
    sounding: &mut Sounding,
    mut decimation: Option<&mut Decimation>,
    buffers: &mut Buffers<'_>,
    parameters: &HostParameters,
    mut next_event: impl FnMut() -> Option<NoteEvent<S>>,
) {
    let (samples, bypassed) = (buffers.len(), parameters.is_bypassed());
    let mut notes = Notes::default();
    let mut now = 0;
    let mut render_until =
        |performer: &mut Performer, sounding: &mut Sounding, notes: &mut Notes, until: usize| {
            if until > now {
                notes.strike(performer, sounding);
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
        render_until(performer, sounding, &mut notes, samples.min(event.timing as usize));
        event.show(parameters.monitor());
        if event.who == Who::Others {
            event.tell_others(performer, sounding, &mut notes);
            continue;
        }
        let channel = event.on.unwrap_or_else(|| performer.any_channel());
        match event.what {
            What::NoteOn(_) if bypassed => {}
            What::NoteOn(velocity) => {
                let told = SoundingNote { id: event.id, channel, number: event.number };
                notes.add(performer, sounding, Note::new(event.timing, told, velocity));
            }
            What::Express(expression) => notes.express(performer, event.number, channel, expression),
            _ => {
                notes.strike(performer, sounding);
                event.tell(performer, channel, parameters);
            }
        }
    }
    render_until(performer, sounding, &mut notes, samples);
    notes.strike(performer, sounding);
    sounding.follow(samples.saturating_sub(1) as u32, performer);
    parameters.monitor().advance(samples);
}

/// What is done to a note.
#[derive(Clone, Copy, PartialEq)]
enum Expression {
    /// Place of its stroke, or of the next ones, 0 (centre) to 1 (rim).
    Brightness(f32),
    /// Semitones.
    Tuning(f32),
    /// A ratio.
    Volume(f32),
    /// -1 (left) to 1 (right).
    Pan(f32),
    /// 0 to 1.
    Pressure(f32),
}

impl Expression {
    fn act(self, performer: &mut Performer, number: u8, channel: u8) {
        match self {
            Expression::Brightness(place) => performer.move_hand(number, place, channel),
            Expression::Tuning(semitones) => performer.bend(number, semitones, channel),
            Expression::Volume(gain) => performer.scale(number, gain, channel),
            Expression::Pan(aside) => performer.pan(number, aside, channel),
            Expression::Pressure(pressure) => performer.pressure(number, pressure, channel),
        }
    }

    /// Its place among those that a note can wait with.
    fn kind(self) -> usize {
        match self {
            Expression::Brightness(_) => 0,
            Expression::Tuning(_) => 1,
            Expression::Volume(_) => 2,
            Expression::Pan(_) => 3,
            Expression::Pressure(_) => 4,
        }
    }
}

/// A note that waits for its expressions.
#[derive(Clone, Copy)]
struct Note {
    timing: u32,
    told: SoundingNote,
    velocity: f32,
    /// `[kind]`.
    expressions: [Option<Expression>; 5],
}

impl Note {
    fn new(timing: u32, told: SoundingNote, velocity: f32) -> Note {
        Note { timing, told, velocity, expressions: [None; 5] }
    }
}

/// The notes of one sample.
#[derive(Default)]
struct Notes {
    waiting: [Option<Note>; MOST_NOTES],
    count: usize,
}

impl Notes {
    fn add(&mut self, performer: &mut Performer, sounding: &mut Sounding, note: Note) {
        if self.count == MOST_NOTES {
            self.strike(performer, sounding);
        }
        self.waiting[self.count] = Some(note);
        self.count += 1;
    }

    /// Does something to the latest note of this number and channel that waits, or to what it struck.
    fn express(&mut self, performer: &mut Performer, number: u8, channel: u8, expression: Expression) {
        let waiting = self.waiting[..self.count].iter_mut().rev().flatten();
        let mut its = waiting.filter(|note| (note.told.number, note.told.channel) == (number, channel));
        match its.next() {
            Some(note) => note.expressions[expression.kind()] = Some(expression),
            None => expression.act(performer, number, channel),
        }
    }

    /// The notes that wait under an id, or all of a channel where neither is given.
    fn of(&self, id: VoiceID, channel: Option<u8>) -> [Option<SoundingNote>; MOST_NOTES] {
        self.waiting.map(|note| {
            note.map(|note| note.told).filter(|told| match id {
                VoiceID::ID(_) => told.id == id,
                VoiceID::Wildcard => channel.is_none_or(|channel| channel == told.channel),
            })
        })
    }

    fn strike(&mut self, performer: &mut Performer, sounding: &mut Sounding) {
        for note in self.waiting[..self.count].iter_mut().filter_map(Option::take) {
            let SoundingNote { channel, number, .. } = note.told;
            let place = note.expressions[0].and_then(|expression| match expression {
                Expression::Brightness(place) => Some(place),
                _ => None,
            });
            performer.aim(place);
            let sounds = performer.note_on(number, note.velocity, channel);
            let slot = performer.slot_of(number).filter(|_| sounds);
            sounding.strike(note.timing, note.told, slot);
            for expression in note.expressions[1..].iter().flatten() {
                expression.act(performer, number, channel);
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
    /// The host's number of the note, if it gives one.
    id: VoiceID,
    who: Who,
    /// Note, controller or program.
    number: u8,
    what: What,
}

/// Whom an event is about.
#[derive(Clone, Copy, PartialEq)]
enum Who {
    /// A note by its number, or no note.
    Number,
    /// Those of an id or a channel that sound.
    Others,
}

#[derive(Clone, Copy)]
enum What {
    NoteOn(f32),
    NoteOff,
    /// Of every note.
    NotesOff,
    Choke,
    /// Of every cymbal.
    ChokeAll,
    Express(Expression),
    Controller(f32),
    Program,
}

impl Message {
    fn of<S>(event: &NoteEvent<S>) -> Option<Message> {
        let note = |timing: u32, id: VoiceID, channel: Channel, key: Key, what: What| {
            let (who, number, what) = match (key.number(), id, what) {
                (Some(number), _, what) => (Who::Number, number, what),
                (None, VoiceID::ID(_), What::NoteOff | What::Choke | What::Express(_)) => {
                    (Who::Others, 0, what)
                }
                // Whoever means any note means all of them.
                (None, VoiceID::Wildcard, What::NoteOff) => (Who::Number, 0, What::NotesOff),
                (None, VoiceID::Wildcard, What::Choke) => (Who::Number, 0, What::ChokeAll),
                (None, VoiceID::Wildcard, What::Express(_)) => (Who::Others, 0, what),
                (None, ..) => return None,
            };
            Some(Message { timing, on: channel.number(), id, who, number, what })
        };
        let express = |timing: u32, id: VoiceID, channel: Channel, key: Key, expression: Expression| {
            note(timing, id, channel, key, What::Express(expression))
        };
        let other = |timing: u32, channel: u8, number: u8, what: What| {
            Some(Message { timing, on: Some(channel), id: VoiceID::Wildcard, who: Who::Number, number, what })
        };
        match *event {
            NoteEvent::NoteOn { timing, voice_id, channel, key, velocity } => {
                note(timing, voice_id, channel, key, What::NoteOn(velocity))
            }
            NoteEvent::NoteOff { timing, voice_id, channel, key, .. } => {
                note(timing, voice_id, channel, key, What::NoteOff)
            }
            NoteEvent::Choke { timing, voice_id, channel, key } => {
                note(timing, voice_id, channel, key, What::Choke)
            }
            NoteEvent::PolyPressure { timing, voice_id, channel, key, pressure } => {
                express(timing, voice_id, channel, key, Expression::Pressure(pressure))
            }
            NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness } => {
                express(timing, voice_id, channel, key, Expression::Brightness(brightness))
            }
            NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning } => {
                express(timing, voice_id, channel, key, Expression::Tuning(tuning))
            }
            NoteEvent::PolyVolume { timing, voice_id, channel, key, gain } => {
                express(timing, voice_id, channel, key, Expression::Volume(gain))
            }
            NoteEvent::PolyPan { timing, voice_id, channel, key, pan } => {
                express(timing, voice_id, channel, key, Expression::Pan(pan))
            }
            NoteEvent::MidiCC { timing, channel, cc, value } => {
                other(timing, channel, cc, What::Controller(value))
            }
            NoteEvent::MidiProgramChange { timing, channel, program } => {
                other(timing, channel, program, What::Program)
            }
            _ => None,
        }
    }

    /// Tells the notes that an id or a channel means.
    fn tell_others(&self, performer: &mut Performer, sounding: &mut Sounding, notes: &mut Notes) {
        match self.what {
            What::Express(expression) => {
                let waiting = notes.of(self.id, self.on);
                for SoundingNote { number, channel, .. } in waiting.into_iter().flatten() {
                    notes.express(performer, number, channel, expression);
                }
                // One that waits and strikes the same piece is no longer told apart.
                if waiting.iter().all(Option::is_none) {
                    for SoundingNote { number, channel, .. } in sounding.of(self.id, self.on) {
                        expression.act(performer, number, channel);
                    }
                }
            }
            What::NoteOff | What::Choke => {
                notes.strike(performer, sounding);
                for SoundingNote { number, channel, .. } in sounding.of(self.id, self.on) {
                    match self.what {
                        What::Choke => performer.choke(number, channel),
                        _ => performer.note_off(number, channel),
                    }
                }
            }
            _ => {}
        }
    }

    /// Shows the event to whoever looks.
    fn show(&self, monitor: &Monitor) {
        let steps = |share: f32| (127.0 * share.clamp(0.0, 1.0)).round() as u8;
        let message = match self.what {
            What::NoteOn(velocity) => MidiMessage::Note(self.number, steps(velocity)),
            What::NoteOff | What::NotesOff => MidiMessage::NoteOff(self.number),
            What::Express(Expression::Pressure(pressure)) => {
                MidiMessage::Pressure(self.number, steps(pressure))
            }
            What::Choke | What::ChokeAll | What::Express(_) => MidiMessage::Expression(self.number),
            What::Controller(value) => MidiMessage::Controller(self.number, steps(value)),
            What::Program => MidiMessage::Program(self.number),
        };
        monitor.write(self.timing, self.on.unwrap_or(0), message);
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
            What::NoteOn(_) | What::Express(_) => {}
        }
    }
}
