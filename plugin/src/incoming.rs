//! What arrives, for the page that shows it: the latest messages with their times.
//!
//! The audio thread writes into a ring and never waits; whoever looks reads what it has not read yet. What is overwritten
//! before anybody has looked is lost to the page only.

use std::sync::atomic::{AtomicU64, Ordering};

use overhear_player::midi::learning::{Incoming, MidiMessage};

/// Messages that are kept.
const KEPT: usize = 512;

/// The ring.
pub struct Monitor {
    /// When, s, as the bits of a number, and what.
    kept: [(AtomicU64, AtomicU64); KEPT],
    /// How many have ever been written.
    written: AtomicU64,
    /// Samples that have passed.
    clock: AtomicU64,
    /// Bits of the sample rate, Hz.
    rate: AtomicU64,
}

impl Default for Monitor {
    fn default() -> Self {
        Monitor {
            kept: [const { (AtomicU64::new(0), AtomicU64::new(0)) }; KEPT],
            written: AtomicU64::new(0),
            clock: AtomicU64::new(0),
            rate: AtomicU64::new(48_000_f64.to_bits()),
        }
    }
}

impl Monitor {
    /// Adopts a sample rate, Hz.
    pub fn set_rate(&self, rate: f64) {
        self.rate.store(rate.to_bits(), Ordering::Relaxed);
    }

    /// Lets samples pass.
    ///
    /// # Real-time
    /// An addition.
    pub fn advance(&self, samples: usize) {
        self.clock.fetch_add(samples as u64, Ordering::Relaxed);
    }

    /// Keeps a message that arrives so many samples from now.
    ///
    /// # Real-time
    /// Some stores; nobody is waited for.
    pub fn write(&self, after: u32, channel: u8, message: MidiMessage) {
        let rate = f64::from_bits(self.rate.load(Ordering::Relaxed));
        let time = (self.clock.load(Ordering::Relaxed) + u64::from(after)) as f64 / rate;
        let place = self.written.load(Ordering::Relaxed);
        let (when, what) = &self.kept[place as usize % KEPT];
        when.store(time.to_bits(), Ordering::Relaxed);
        what.store(pack(channel, message), Ordering::Relaxed);
        self.written.store(place + 1, Ordering::Release);
    }

    /// How many have ever been written.
    pub fn count(&self) -> u64 {
        self.written.load(Ordering::Acquire)
    }

    /// Those from the one of a number on, as far as they are kept, the oldest first.
    pub fn since(&self, number: u64) -> Vec<Incoming> {
        let written = self.count();
        // The oldest may be overwritten in this instant.
        let first = number.max(written.saturating_sub(KEPT as u64 - 16));
        (first..written)
            .filter_map(|place| {
                let (when, what) = &self.kept[place as usize % KEPT];
                let time = f64::from_bits(when.load(Ordering::Relaxed));
                let (channel, message) = unpack(what.load(Ordering::Relaxed))?;
                Some(Incoming { time, channel, message })
            })
            .collect()
    }
}

fn pack(channel: u8, message: MidiMessage) -> u64 {
    let [kind, number, value] = match message {
        MidiMessage::Note(number, velocity) => [1, number, velocity],
        MidiMessage::NoteOff(number) => [2, number, 0],
        MidiMessage::Pressure(number, value) => [3, number, value],
        MidiMessage::Controller(number, value) => [4, number, value],
        MidiMessage::Expression(number) => [5, number, 0],
        MidiMessage::Program(number) => [6, number, 0],
    };
    u64::from_le_bytes([kind, number, value, channel, 0, 0, 0, 0])
}

fn unpack(packed: u64) -> Option<(u8, MidiMessage)> {
    let [kind, number, value, channel, ..] = packed.to_le_bytes();
    let message = match kind {
        1 => MidiMessage::Note(number, value),
        2 => MidiMessage::NoteOff(number),
        3 => MidiMessage::Pressure(number, value),
        4 => MidiMessage::Controller(number, value),
        5 => MidiMessage::Expression(number),
        6 => MidiMessage::Program(number),
        _ => return None,
    };
    Some((channel, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_once_in_order_with_its_time() {
        let monitor = Monitor::default();
        monitor.set_rate(1_000.0);
        let messages = [
            MidiMessage::Note(38, 101),
            MidiMessage::NoteOff(38),
            MidiMessage::Pressure(49, 64),
            MidiMessage::Controller(4, 127),
            MidiMessage::Expression(38),
            MidiMessage::Program(3),
        ];
        for (at, message) in (0..).zip(messages) {
            monitor.write(at, 9, message);
            monitor.advance(100);
        }
        let read = monitor.since(0);
        assert_eq!(read.iter().map(|incoming| incoming.message).collect::<Vec<_>>(), messages);
        assert!(read.iter().all(|incoming| incoming.channel == 9));
        assert!((read[2].time - 0.202).abs() < 1e-12);
        assert!(monitor.since(monitor.count()).is_empty());
        (0..2_000).for_each(|_| monitor.write(0, 0, MidiMessage::Program(1)));
        assert!(monitor.since(6).len() < KEPT);
    }
}
