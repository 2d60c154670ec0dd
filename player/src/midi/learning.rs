//! Learning a pad or a pedal from what arrives while a player tries it.
//!
//! A pad is struck softly, hard and in between, one stroke at a time; a pedal is left up for a moment, then pressed and released a
//! few times, with chicks and splashes. What was learned is a guess that the player sees and can correct.

use super::calibration::{CROSSTALK_TIME, LONGEST_RETRIGGER, Pad, Pedal};
use super::playing::PEDAL_CONTROLLER;

/// A message that arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Incoming {
    /// When, s from any beginning.
    pub time: f64,
    /// MIDI channel, 0 to 15.
    pub channel: u8,
    /// What it was.
    pub message: MidiMessage,
}

/// What arrived; numbers 0 to 127.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MidiMessage {
    /// A note and its velocity.
    Note(u8, u8),
    /// The end of a note.
    NoteOff(u8),
    /// Pressure on a note.
    Pressure(u8, u8),
    /// A controller and its value.
    Controller(u8, u8),
    /// A choke or an expression of a note.
    Expression(u8),
    /// A program change.
    Program(u8),
}

/// Fewest strokes from which a pad is learned.
pub const FEWEST_STROKES: usize = 4;

/// Least way between soft and hard strokes, velocities: less is one kind of stroke only.
const LEAST_RANGE: u8 = 20;

/// Whoever strikes one by one strikes no faster than this, s.
const ONE_BY_ONE: f64 = 0.001 * LONGEST_RETRIGGER as f64;

/// Least way of a pedal that is not stuck.
const LEAST_WAY: u8 = 12;

/// Longest time for which a splash holds the rims together, s.
const SPLASH_TIME: f64 = 0.2;

/// Notes of a pedal's chick on the maps at hand.
const CHICK_NOTE: u8 = 44;

/// What arrived while something is learned.
#[derive(Debug, Clone, Default)]
pub struct Lesson {
    heard: Vec<Incoming>,
}

/// A pad as it was learned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PadLesson {
    /// The note of the pad.
    pub note: u8,
    /// What its strokes are like.
    pub pad: Pad,
    /// Share of a stroke's velocity that reached other pads, percent.
    pub crosstalk: u8,
}

impl Lesson {
    /// Takes in what arrived.
    pub fn hear(&mut self, heard: Incoming) {
        self.heard.push(heard);
    }

    /// Strokes so far, without double triggers: times and velocities, of a note.
    fn strokes(&self, note: u8) -> Vec<(f64, u8)> {
        let mut strokes: Vec<(f64, u8)> = Vec::new();
        for heard in &self.heard {
            let MidiMessage::Note(number, velocity @ 1..) = heard.message else { continue };
            let apart = strokes.last().is_none_or(|(last, _)| heard.time - last > ONE_BY_ONE);
            if number == note && apart {
                strokes.push((heard.time, velocity));
            }
        }
        strokes
    }

    /// The note that was struck most.
    pub fn note(&self) -> Option<u8> {
        let mut counts = [0_u32; 128];
        for heard in &self.heard {
            if let MidiMessage::Note(note, 1..) = heard.message
                && let Some(count) = counts.get_mut(usize::from(note))
            {
                *count += 1;
            }
        }
        let (note, count) = (0..).zip(counts).max_by_key(|(_, count)| *count)?;
        (count > 0).then_some(note)
    }

    /// How many strokes of the pad have arrived.
    pub fn count(&self) -> usize {
        self.note().map_or(0, |note| self.strokes(note).len())
    }

    /// The pad that was struck, once enough strokes differ enough.
    pub fn pad(&self) -> Option<PadLesson> {
        let note = self.note()?;
        let strokes = self.strokes(note);
        let mut velocities: Vec<u8> = strokes.iter().map(|(_, velocity)| *velocity).collect();
        velocities.sort_unstable();
        let (low, high) = (*velocities.first()?, *velocities.last()?);
        if velocities.len() < FEWEST_STROKES || high - low < LEAST_RANGE {
            return None;
        }
        // Strokes in between are meant to be in the middle.
        let middle = f32::from(velocities[velocities.len() / 2] - low) / f32::from(high - low);
        let curve = if (0.1..=0.9).contains(&middle) { libm::logf(0.5) / libm::logf(middle) } else { 1.0 };
        let pad = Pad { low, high, curve, retrigger: self.double_trigger(note, &strokes) }.sane();
        Some(PadLesson { note, pad, crosstalk: self.crosstalk(note, &strokes) })
    }

    /// A time, ms, that is longer than whatever a stroke triggered twice.
    fn double_trigger(&self, note: u8, strokes: &[(f64, u8)]) -> u8 {
        let mut longest: f64 = 0.0;
        for heard in &self.heard {
            let MidiMessage::Note(number, 1..) = heard.message else { continue };
            let before = strokes.iter().rev().find(|(time, _)| *time < heard.time);
            if let Some((time, _)) =
                before.filter(|(time, _)| number == note && heard.time - time <= ONE_BY_ONE)
            {
                longest = longest.max(heard.time - time);
            }
        }
        if longest == 0.0 { 0 } else { ((1e3 * longest).ceil() + 1.0) as u8 }
    }

    /// A share, percent, above whatever strokes on the pad made others send.
    fn crosstalk(&self, note: u8, strokes: &[(f64, u8)]) -> u8 {
        let mut largest: f64 = 0.0;
        for heard in &self.heard {
            let MidiMessage::Note(number, velocity @ 1..) = heard.message else { continue };
            let same = strokes.iter().find(|(time, _)| (heard.time - time).abs() <= CROSSTALK_TIME);
            if let Some((_, loud)) = same.filter(|_| number != note) {
                largest = largest.max(f64::from(velocity) / f64::from(*loud));
            }
        }
        // What is half as loud was played.
        if largest == 0.0 || largest > 0.5 { 0 } else { (100.0 * largest).ceil() as u8 + 2 }
    }

    /// Readings of the pedal: times and values.
    fn readings(&self) -> Vec<(f64, u8)> {
        let reading = |heard: &Incoming| match heard.message {
            MidiMessage::Controller(PEDAL_CONTROLLER, value) => Some((heard.time, value)),
            _ => None,
        };
        self.heard.iter().filter_map(reading).collect()
    }

    /// The pedal that was tried; none if nothing of it has arrived. One that hardly moved is stuck.
    pub fn pedal(&self) -> Option<Pedal> {
        let readings = self.readings();
        let values = || readings.iter().map(|(_, value)| *value);
        let (low, high) = (values().min()?, values().max()?);
        if high - low < LEAST_WAY {
            return Some(Pedal { stuck: true, ..Pedal::default() });
        }
        let noise = noise(&readings, high - low);
        // Ends that noise alone reaches would be reached by chance only.
        let (low, high) = (low + noise, high - noise);
        let [mut up, mut down] = [low, high];
        if self.is_inverted(&readings, (low, high)) {
            std::mem::swap(&mut up, &mut down);
        }
        let between = |share: f64| (f64::from(up) + share * (f64::from(down) - f64::from(up))).round() as u8;
        let usual = Pedal::default();
        let chick = self.chick(&readings, (up, down)).unwrap_or(between(f64::from(usual.chick) / 127.0));
        let splash = splash(&readings, (up, down), noise);
        let splash = splash.unwrap_or(between(f64::from(usual.splash) / 127.0));
        Some(Pedal { up, splash, chick, down, noise, stuck: false }.sane())
    }

    /// Whether readings fall as the pedal goes down: chicks sound where it is down; without them it was left up at first.
    fn is_inverted(&self, readings: &[(f64, u8)], (low, high): (u8, u8)) -> bool {
        let middle = (f64::from(low) + f64::from(high)) / 2.0;
        let at_chicks: Vec<f64> =
            self.chicks().filter_map(|time| at(readings, time)).map(f64::from).collect();
        if at_chicks.is_empty() {
            return readings.first().is_some_and(|(_, first)| f64::from(*first) > middle);
        }
        at_chicks.iter().sum::<f64>() / (at_chicks.len() as f64) < middle
    }

    fn chicks(&self) -> impl Iterator<Item = f64> {
        let is_chick = |heard: &&Incoming| matches!(heard.message, MidiMessage::Note(CHICK_NOTE, 1..));
        self.heard.iter().filter(is_chick).map(|heard| heard.time)
    }

    /// Where the pedal is when chicks sound: the reading of the one that was farthest up, as all of them close the hats.
    fn chick(&self, readings: &[(f64, u8)], (up, down): (u8, u8)) -> Option<u8> {
        let closed = self.chicks().filter_map(|time| at(readings, time));
        let closed = closed.min_by_key(|reading| if down > up { *reading } else { 127 - *reading })?;
        Some(closed)
    }
}

/// The latest reading at a time.
fn at(readings: &[(f64, u8)], time: f64) -> Option<u8> {
    readings.iter().rev().find(|(read, _)| *read <= time).map(|(_, value)| *value)
}

/// Steps back and forth that a foot does not make: the largest of those that are small beside the whole way.
fn noise(readings: &[(f64, u8)], way: u8) -> u8 {
    let steps = |three: &[(f64, u8)]| {
        let [a, b, c] = [three[0].1, three[1].1, three[2].1].map(i32::from);
        ((b - a) * (c - b) < 0).then(|| (b - a).abs().min((c - b).abs()) as u8)
    };
    let small = |step: &u8| u32::from(*step) * 8 <= u32::from(way);
    readings.windows(3).filter_map(steps).filter(small).max().unwrap_or(0)
}

/// How far down the shallowest press goes that is over within a splash's time.
fn splash(readings: &[(f64, u8)], (up, down): (u8, u8), noise: u8) -> Option<u8> {
    let depth = |value: u8| {
        let way = f64::from(down) - f64::from(up);
        (f64::from(value) - f64::from(up)) / way
    };
    // Beyond noise, and no foot that only rests.
    let least = (2.0 * f64::from(noise) / f64::from(up.abs_diff(down).max(1))).max(0.25);
    let (mut begun, mut deepest): (Option<f64>, (f64, u8)) = (None, (0.0, up));
    let mut shallowest: Option<(f64, u8)> = None;
    for &(time, value) in readings {
        let now = depth(value);
        if now > least {
            begun = begun.or(Some(time));
            if now > deepest.0 {
                deepest = (now, value);
            }
        } else if let Some(since) = begun.take() {
            let found = std::mem::replace(&mut deepest, (0.0, up));
            if time - since <= SPLASH_TIME && shallowest.is_none_or(|(depth, _)| found.0 < depth) {
                shallowest = Some(found);
            }
        }
    }
    shallowest.map(|(_, value)| value)
}

#[cfg(test)]
mod tests;
