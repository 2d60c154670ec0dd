//! Channel messages of MIDI: what songs hold and players play.

/// The bytes of a channel message: the status, and two of data. A message with one byte of data has a zero behind it.
pub type Bytes = [u8; 3];

/// What a channel message asks for. Data is 0 to 127.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// A note begins.
    NoteOn {
        /// MIDI note number.
        key: u8,
        /// Velocity, 1 to 127.
        velocity: u8,
    },
    /// A note ends: also a note that begins with a velocity of 0.
    NoteOff {
        /// MIDI note number.
        key: u8,
    },
    /// Pressure on one note.
    Pressure {
        /// MIDI note number.
        key: u8,
        /// How hard.
        pressure: u8,
    },
    /// A controller moves.
    Controller {
        /// Number of the controller.
        number: u8,
        /// Where it is then.
        value: u8,
    },
    /// A program change.
    Program(u8),
    /// What the instrument does not use: pitch bend, pressure on a channel.
    Other,
}

/// A message at a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Message {
    /// Sample in the buffer (in a [`Take`](crate::player::Take): in the whole).
    pub sample: u64,
    /// The message.
    pub bytes: Bytes,
}

impl Message {
    /// A note on a channel, 0 to 15, of a velocity, 1 to 127.
    pub fn note(sample: u64, channel: u8, key: u8, velocity: u8) -> Message {
        Message { sample, bytes: [0x90 | channel, key, velocity] }
    }

    /// Channel, 0 to 15.
    pub fn channel(&self) -> u8 {
        channel(&self.bytes)
    }

    /// What it asks for.
    pub fn meaning(&self) -> Meaning {
        meaning(&self.bytes)
    }
}

/// The channel of a message, 0 to 15.
pub fn channel(bytes: &Bytes) -> u8 {
    bytes[0] & 0x0F
}

/// What a message asks for.
pub fn meaning(&[status, first, second]: &Bytes) -> Meaning {
    match (status & 0xF0, second) {
        (0x90, 1..) => Meaning::NoteOn { key: first, velocity: second },
        (0x80 | 0x90, _) => Meaning::NoteOff { key: first },
        (0xA0, pressure) => Meaning::Pressure { key: first, pressure },
        (0xB0, value) => Meaning::Controller { number: first, value },
        (0xC0, _) => Meaning::Program(first),
        _ => Meaning::Other,
    }
}
