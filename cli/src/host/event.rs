//! Events a host sends.

use clack_host::events::Pckn;
use clack_host::events::event_types::{
    MidiEvent, NoteChokeEvent, NoteOffEvent, NoteOnEvent, ParamModEvent, ParamValueEvent,
};
use clack_host::events::io::EventBuffer;
use clack_host::utils::ClapId;

/// An event within a buffer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Sample in the buffer.
    pub offset: u32,
    /// The event.
    pub what: What,
}

/// Kind of an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum What {
    /// A note begins.
    NoteOn {
        /// Channel, 0 to 15.
        channel: u8,
        /// MIDI note number.
        key: u8,
        /// Velocity, 0 to 1.
        velocity: f32,
    },
    /// A note ends.
    NoteOff {
        /// Channel, 0 to 15.
        channel: u8,
        /// MIDI note number.
        key: u8,
    },
    /// A note is choked.
    Choke {
        /// Channel, 0 to 15.
        channel: u8,
        /// MIDI note number.
        key: u8,
    },
    /// Every note on every channel is choked.
    ChokeAll,
    /// A parameter moves.
    Parameter {
        /// Id of the parameter in the format.
        id: u32,
        /// Value in the format's range.
        value: f64,
    },
    /// A parameter is moved away from its value for a while.
    Modulation {
        /// Id of the parameter in the format.
        id: u32,
        /// Distance from the value, in the format's range.
        amount: f64,
    },
    /// Three bytes of MIDI.
    Midi([u8; 3]),
}

impl Event {
    /// Appends the event to a buffer for the plugin. A parameter without a valid id is left out.
    pub fn push(&self, buffer: &mut EventBuffer) {
        let Event { offset, what } = *self;
        let note = |channel: u8, key: u8| {
            Pckn::new(0u16, u16::from(channel), u16::from(key), clack_host::events::Match::All)
        };
        match what {
            What::NoteOn { channel, key, velocity } => {
                buffer.push(&NoteOnEvent::new(offset, note(channel, key), f64::from(velocity)));
            }
            What::NoteOff { channel, key } => {
                buffer.push(&NoteOffEvent::new(offset, note(channel, key), 0.0));
            }
            What::Choke { channel, key } => {
                buffer.push(&NoteChokeEvent::new(offset, note(channel, key)));
            }
            What::ChokeAll => buffer.push(&NoteChokeEvent::new(offset, Pckn::match_all())),
            What::Parameter { id, value } => {
                if let Some(id) = ClapId::from_raw(id) {
                    buffer.push(&ParamValueEvent::new(offset, id, Pckn::match_all(), value));
                }
            }
            What::Modulation { id, amount } => {
                if let Some(id) = ClapId::from_raw(id) {
                    buffer.push(&ParamModEvent::new(offset, id, Pckn::match_all(), amount));
                }
            }
            What::Midi(data) => buffer.push(&MidiEvent::new(offset, 0, data)),
        }
    }
}
