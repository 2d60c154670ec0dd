//! Standard MIDI Files as channel messages at exact times.
//!
//! Formats 0, 1 and 2, tempo maps, running status and SMPTE time bases are read. Tempo events
//! act on all tracks of a format 0 or 1 file, whichever track they are in; the patterns of a
//! format 2 file have a tempo each and are played one after the other.
//!
//! **Times.** A time is kept as an exact fraction of a second: whole ticks times whole
//! microseconds over the time base. It becomes a sample only once, as the sample nearest to
//! `time * rate`, halves up ([`Song::sample`]). Nothing accumulates, and every message lands on the
//! same sample whatever tempo changes, tracks or empty stretches come before it.

mod chunks;

use std::path::Path;

use anyhow::Result;
use midly::{EventIter, MetaMessage, MidiMessage, Timing, TrackEventKind};

use crate::bad_input;
use crate::message::{self, Bytes, Meaning};
use chunks::Chunks;

/// Tempo until a file says otherwise, microseconds per quarter note.
const DEFAULT_TEMPO: u32 = 500_000;

/// A channel message of a song.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    /// Time from the start of the file in units of [`Song::unit`].
    pub time: u128,
    /// The message.
    pub bytes: Bytes,
}

/// A struck note.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Note {
    /// Time from the start of the file in units of [`Song::unit`].
    pub time: u128,
    /// Channel, 0 to 15.
    pub channel: u8,
    /// MIDI note number.
    pub key: u8,
    /// Velocity, 1 to 127.
    pub velocity: u8,
}

/// The channel messages of a MIDI file in the order they are played.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Song {
    /// Messages by time; those at one time in the order of the tracks and of the file.
    pub events: Vec<Event>,
    /// Units of [`Event::time`] per second.
    pub unit: u128,
}

impl Song {
    /// Reads a MIDI file.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) with the path if it is missing or broken.
    pub fn read(path: &Path) -> Result<Song> {
        let bytes =
            std::fs::read(path).map_err(|error| bad_input!("cannot read `{}`: {error}", path.display()))?;
        Song::parse(&bytes)
            .map_err(|reason| bad_input!("`{}` is not a whole MIDI file: {reason}", path.display()))
    }

    /// Reads the bytes of a MIDI file.
    ///
    /// # Errors
    /// The defect, in a few words.
    pub fn parse(bytes: &[u8]) -> Result<Song, String> {
        let Chunks { timing, sequential, tracks } = Chunks::parse(bytes)?;
        let base = TimeBase::new(timing)?;
        let tracks = tracks
            .iter()
            .enumerate()
            .map(|(index, track)| read_track(index + 1, track))
            .collect::<Result<Vec<_>, _>>()?;
        let mut song = Song { events: Vec::new(), unit: base.unit };
        if sequential {
            let mut start = 0;
            for track in &tracks {
                start = song.append(&base, start, track);
            }
        } else {
            let mut merged: Vec<_> = tracks.into_iter().flatten().collect();
            // Stable: events at one tick stay in the order of tracks and file.
            merged.sort_by_key(|event| event.tick);
            song.append(&base, 0, &merged);
        }
        Ok(song)
    }

    /// Appends events that start at `start` and tells where they end.
    fn append(&mut self, base: &TimeBase, start: u128, events: &[TrackEvent]) -> u128 {
        let (mut time, mut tick, mut tempo) = (start, 0, DEFAULT_TEMPO);
        for event in events {
            time += u128::from(event.tick - tick) * base.per_tick(tempo);
            tick = event.tick;
            match event.what {
                What::Tempo(new) => tempo = new,
                What::Message(bytes) => self.events.push(Event { time, bytes }),
                What::End => {}
            }
        }
        time
    }

    /// The sample nearest to a time at a sample rate (Hz), halves up.
    pub fn sample(&self, time: u128, rate: u32) -> u64 {
        let doubled = 2 * time * u128::from(rate) + self.unit;
        u64::try_from(doubled / (2 * self.unit)).unwrap_or(u64::MAX)
    }

    /// Time of the last note, seconds; nothing in a file without notes.
    pub fn last_note(&self) -> Option<f64> {
        self.notes().last().map(|note| note.time as f64 / self.unit as f64)
    }

    /// The notes that are struck.
    pub fn notes(&self) -> impl Iterator<Item = Note> {
        self.events.iter().filter_map(|&Event { time, bytes }| match message::meaning(&bytes) {
            Meaning::NoteOn { key, velocity } => {
                Some(Note { time, channel: message::channel(&bytes), key, velocity })
            }
            _ => None,
        })
    }
}

/// Conversion of ticks to time.
struct TimeBase {
    /// Units in a second.
    unit: u128,
    /// Units in a tick, if the tempo does not matter.
    fixed: Option<u128>,
}

impl TimeBase {
    fn new(timing: Timing) -> Result<TimeBase, String> {
        let (unit, fixed) = match timing {
            // A tick lasts tempo / (ticks per quarter) microseconds.
            Timing::Metrical(ticks) => (u128::from(ticks.as_int()) * 1_000_000, None),
            Timing::Timecode(fps, subframes) => {
                let subframes = u128::from(subframes);
                match fps.as_int() {
                    // The code 29 means 30000 / 1001 frames a second.
                    29 => (30_000 * subframes, Some(1001)),
                    whole => (u128::from(whole) * subframes, Some(1)),
                }
            }
        };
        if unit == 0 {
            return Err("its time base is 0 ticks".to_owned());
        }
        Ok(TimeBase { unit, fixed })
    }

    fn per_tick(&self, tempo: u32) -> u128 {
        self.fixed.unwrap_or(u128::from(tempo))
    }
}

struct TrackEvent {
    tick: u64,
    what: What,
}

enum What {
    Message(Bytes),
    Tempo(u32),
    End,
}

/// The events of a track that matter; `number` counts from 1 and is for messages.
fn read_track(number: usize, bytes: &[u8]) -> Result<Vec<TrackEvent>, String> {
    let mut events = Vec::new();
    let (mut tick, mut read) = (0u64, 0);
    for event in EventIter::new(bytes).bytemapped() {
        let (source, event) = event.map_err(|error| format!("track {number}: {error}"))?;
        read += source.len();
        tick += u64::from(event.delta.as_int());
        let what = match event.kind {
            TrackEventKind::Midi { channel, message } => What::Message(bytes_of(channel.as_int(), message)),
            TrackEventKind::Meta(MetaMessage::Tempo(tempo)) => What::Tempo(tempo.as_int()),
            TrackEventKind::Meta(MetaMessage::EndOfTrack) => {
                events.push(TrackEvent { tick, what: What::End });
                return Ok(events);
            }
            _ => continue,
        };
        events.push(TrackEvent { tick, what });
    }
    // The parser ends a track quietly at the first event it cannot read.
    if read < bytes.len() {
        return Err(format!("track {number} breaks off at byte {read} of {}", bytes.len()));
    }
    events.push(TrackEvent { tick, what: What::End });
    Ok(events)
}

/// The bytes of a message on a channel.
fn bytes_of(channel: u8, message: MidiMessage) -> Bytes {
    let (kind, first, second) = match message {
        MidiMessage::NoteOff { key, vel } => (0x80, key.as_int(), vel.as_int()),
        MidiMessage::NoteOn { key, vel } => (0x90, key.as_int(), vel.as_int()),
        MidiMessage::Aftertouch { key, vel } => (0xA0, key.as_int(), vel.as_int()),
        MidiMessage::Controller { controller, value } => (0xB0, controller.as_int(), value.as_int()),
        MidiMessage::ProgramChange { program } => (0xC0, program.as_int(), 0),
        MidiMessage::ChannelAftertouch { vel } => (0xD0, vel.as_int(), 0),
        MidiMessage::PitchBend { bend } => {
            let bend = bend.0.as_int();
            (0xE0, (bend & 0x7F) as u8, (bend >> 7) as u8)
        }
    };
    [kind | channel, first, second]
}

#[cfg(test)]
mod tests;
