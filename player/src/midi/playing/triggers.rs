//! Notes that no hand has played: double triggers of a pad, and crosstalk from a louder one.

use crate::midi::calibration::{CROSSTALK_TIME, Pad};
use crate::midi_map::NOTES;

/// When which note was struck last.
#[derive(Debug, Clone)]
pub(super) struct Triggers {
    /// Sample rate, Hz.
    rate: f64,
    /// Samples since the beginning.
    now: u64,
    /// `[note]`: sample of the latest that sounded.
    latest: [Option<u64>; NOTES],
    /// The loudest of late: its sample, its note and its velocity.
    loud: Option<(u64, u8, f32)>,
}

impl Default for Triggers {
    fn default() -> Self {
        Triggers { rate: 48_000.0, now: 0, latest: [None; NOTES], loud: None }
    }
}

impl Triggers {
    /// Lets samples at a rate (Hz) pass.
    pub(super) fn advance(&mut self, samples: usize, rate: f64) {
        self.rate = rate;
        self.now += samples as u64;
    }

    /// Forgets all notes.
    pub(super) fn forget(&mut self) {
        *self = Triggers { now: self.now, rate: self.rate, ..Triggers::default() };
    }

    /// Whether a note of a velocity (above 0) was played by a hand: the first on its pad for the pad's retrigger time, and not as
    /// soft beside another pad as `crosstalk` (share of its velocity).
    pub(super) fn strike(&mut self, note: u8, velocity: f32, pad: &Pad, crosstalk: f32) -> bool {
        let (now, rate) = (self.now, self.rate);
        let within = |since: u64, seconds: f64| ((now - since) as f64) < seconds * rate;
        let Some(latest) = self.latest.get_mut(usize::from(note)) else { return true };
        if latest.is_some_and(|latest| within(latest, 1e-3 * f64::from(pad.retrigger))) {
            return false;
        }
        let loud = self.loud.filter(|(when, _, _)| within(*when, CROSSTALK_TIME));
        if loud.is_some_and(|(_, other, loud)| other != note && velocity < crosstalk * loud) {
            return false;
        }
        *latest = Some(now);
        if loud.is_none_or(|(_, _, loud)| velocity >= loud) {
            self.loud = Some((now, note, velocity));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_note_within_the_retrigger_time_is_dropped_and_a_later_one_is_not() {
        let mut triggers = Triggers::default();
        let pad = Pad { retrigger: 20, ..Pad::default() };
        let mut at = |milliseconds: f64, note: u8| {
            let sample = (48.0 * milliseconds) as usize;
            triggers.advance(sample - triggers.now as usize, 48_000.0);
            triggers.strike(note, 0.5, &pad, 0.0)
        };
        // What is dropped does not lengthen the time.
        let heard = [(0.0, 38), (10.0, 38), (15.0, 40), (20.5, 38), (30.0, 38), (41.0, 38)];
        assert_eq!(heard.map(|(time, note)| at(time, note)), [true, false, true, true, false, true]);
    }

    #[test]
    fn crosstalk_is_what_is_soft_beside_a_loud_stroke() {
        let mut triggers = Triggers::default();
        let mut strike = |milliseconds: f64, note: u8, velocity: f32| {
            let sample = (48.0 * milliseconds) as usize;
            triggers.advance(sample - triggers.now as usize, 48_000.0);
            triggers.strike(note, velocity, &Pad::default(), 0.2)
        };
        assert!(strike(0.0, 38, 0.9));
        assert!(!strike(3.0, 48, 0.1), "shaken");
        assert!(strike(4.0, 49, 0.5), "struck together");
        assert!(strike(20.0, 48, 0.1), "too late to be shaken");
    }
}
