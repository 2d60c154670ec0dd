//! What a player's pads and pedal send, and what is meant by it.
//!
//! A pad's softest and hardest strokes and its curve become velocities from 1 to 127; the readings of a pedal become places
//! between up and down. Shared like the [assignments](super::assignments): the audio thread reads one atomic for a note or a
//! pedal, the editor changes them, the state stores them. All values are valid in any order: no lock is needed.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU8, AtomicU32, AtomicU64, Ordering};

use overhear_engine::hi_hat::TOUCHING;

use crate::midi_map::NOTES;

/// Where the pedal is when the hats are closed by a chick, 0 (up) to 1 (down): as the note of a closed hi-hat has it.
pub const CLOSED: f64 = 0.8;

/// Steps of a curve's exponent to 1.
const CURVE_STEPS: f32 = 32.0;

/// Longest retrigger time, ms.
pub const LONGEST_RETRIGGER: u8 = 100;

/// Pads whose strokes count as one blow that shakes others too, s: sound through a rack takes milliseconds.
pub const CROSSTALK_TIME: f64 = 0.012;

/// What the strokes on a pad are like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pad {
    /// Velocity of its softest stroke, 1 to 126.
    pub low: u8,
    /// Velocity of its hardest stroke, above the softest one's, to 127.
    pub high: u8,
    /// Exponent of the curve between them, dimensionless, 0.25 to 4; above 1 soft strokes become softer.
    pub curve: f32,
    /// A second note within this time of the first is a double trigger and dropped, ms; 0 drops none.
    pub retrigger: u8,
}

impl Default for Pad {
    /// A pad that sends what is meant.
    fn default() -> Self {
        Pad { low: 1, high: 127, curve: 1.0, retrigger: 0 }
    }
}

impl Pad {
    /// The nearest sound one.
    pub fn sane(self) -> Pad {
        let low = self.low.clamp(1, 126);
        let curve = if self.curve.is_nan() { 1.0 } else { self.curve.clamp(0.25, 4.0) };
        Pad {
            low,
            high: self.high.clamp(low + 1, 127),
            curve: (curve * CURVE_STEPS).round() / CURVE_STEPS,
            retrigger: self.retrigger.min(LONGEST_RETRIGGER),
        }
    }

    /// The velocity that is meant by one that arrives, both 0 to 1; nothing stays nothing.
    pub fn velocity(&self, arrives: f32) -> f32 {
        let sounds = arrives > 0.0;
        if !sounds || *self == (Pad { retrigger: self.retrigger, ..Pad::default() }) {
            return arrives;
        }
        let [low, high] = [self.low, self.high].map(f32::from);
        let share = ((127.0 * arrives - low) / (high - low)).clamp(0.0, 1.0);
        (1.0 + 126.0 * libm::powf(share, self.curve)) / 127.0
    }

    fn pack(self) -> u32 {
        let Pad { low, high, curve, retrigger } = self.sane();
        u32::from_le_bytes([low, high, (curve * CURVE_STEPS) as u8, retrigger])
    }

    fn unpack(packed: u32) -> Pad {
        let [low, high, curve, retrigger] = packed.to_le_bytes();
        Pad { low, high, curve: f32::from(curve) / CURVE_STEPS, retrigger }.sane()
    }
}

/// What the readings of a pedal mean, each 0 to 127. Which end is up decides the sense: a pedal whose readings fall as it
/// goes down is inverted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pedal {
    /// Where it is up.
    pub up: u8,
    /// Where a splash brings the rims together.
    pub splash: u8,
    /// Where a chick has closed them.
    pub chick: u8,
    /// Where it is down.
    pub down: u8,
    /// Readings that differ by no more than this are noise.
    pub noise: u8,
    /// Whether it is not listened to: it is stuck, and notes say where the foot is.
    pub stuck: bool,
}

impl Default for Pedal {
    /// A pedal that sends what is meant.
    fn default() -> Self {
        Pedal {
            up: 0,
            splash: (127.0 * TOUCHING) as u8,
            chick: (127.0 * CLOSED) as u8,
            down: 127,
            noise: 0,
            stuck: false,
        }
    }
}

impl Pedal {
    /// The nearest sound one: what is between up and down lies there, in order.
    pub fn sane(self) -> Pedal {
        let [up, down] = [self.up.min(127), self.down.min(127)];
        let (low, high) = (up.min(down), up.max(down));
        let [mut splash, chick] = [self.splash, self.chick].map(|between| between.clamp(low, high));
        if (splash > chick) == (down > up) {
            splash = chick;
        }
        Pedal { up, splash, chick, down, noise: self.noise.min(32), stuck: self.stuck || up == down }
    }

    /// Whether its readings fall as it goes down.
    pub fn is_inverted(&self) -> bool {
        self.down < self.up
    }

    /// Where it is, 0 (up) to 1 (down), at a reading, 0 to 1.
    pub fn place(&self, reading: f32) -> f64 {
        if (Pedal { noise: self.noise, ..Pedal::default() }) == *self {
            return f64::from(reading);
        }
        let reading = 127.0 * f64::from(reading);
        let points = [(self.up, 0.0), (self.splash, TOUCHING), (self.chick, CLOSED), (self.down, 1.0)];
        let toward = if self.is_inverted() { -1.0 } else { 1.0 };
        let mut place = 0.0;
        for pair in points.windows(2) {
            let [(from, low), (to, high)] = [pair[0], pair[1]];
            let (way, length) =
                (toward * (reading - f64::from(from)), toward * (f64::from(to) - f64::from(from)));
            if way >= 0.0 {
                let share = if length > 0.0 { (way / length).min(1.0) } else { 1.0 };
                place = low + (high - low) * share;
            }
        }
        place
    }

    fn pack(self) -> u64 {
        let Pedal { up, splash, chick, down, noise, stuck } = self.sane();
        u64::from_le_bytes([up, splash, chick, down, noise, u8::from(stuck), 0, 0])
    }

    fn unpack(packed: u64) -> Pedal {
        let [up, splash, chick, down, noise, stuck, _, _] = packed.to_le_bytes();
        Pedal { up, splash, chick, down, noise, stuck: stuck != 0 }.sane()
    }
}

/// What was learned of all pads and the pedal.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Learned {
    /// Pads that do not send what is meant, by their notes.
    pub pads: BTreeMap<u8, Pad>,
    /// The pedal, if it does not send what is meant.
    pub pedal: Option<Pedal>,
    /// A note within [`CROSSTALK_TIME`] of a louder one on another pad is dropped if its velocity is below this share of the other's,
    /// percent; 0 drops none.
    pub crosstalk: u8,
}

impl Learned {
    /// As stored: `38=12-118^1.25/8 pedal=110,60,30,4~2 crosstalk=20`; nothing learned is empty.
    pub fn to_text(&self) -> String {
        let mut words: Vec<String> = self
            .pads
            .iter()
            .map(|(note, pad)| {
                let Pad { low, high, curve, retrigger } = pad.sane();
                format!("{note}={low}-{high}^{curve}/{retrigger}")
            })
            .collect();
        if let Some(pedal) = self.pedal {
            let Pedal { up, splash, chick, down, noise, stuck } = pedal.sane();
            let stuck = if stuck { "!" } else { "" };
            words.push(format!("pedal={up},{splash},{chick},{down}~{noise}{stuck}"));
        }
        if self.crosstalk > 0 {
            words.push(format!("crosstalk={}", self.crosstalk));
        }
        words.join(" ")
    }

    /// Reads what [`to_text`](Self::to_text) writes, and says which words are not understood.
    pub fn from_text(text: &str) -> (Learned, Vec<&str>) {
        let (mut learned, mut unknown) = (Learned::default(), Vec::new());
        for word in text.split_whitespace() {
            if learned.read(word).is_none() {
                unknown.push(word);
            }
        }
        (learned, unknown)
    }

    fn read(&mut self, word: &str) -> Option<()> {
        let (what, says) = word.split_once('=')?;
        match what {
            "crosstalk" => self.crosstalk = says.parse().ok().filter(|percent| *percent <= 100)?,
            "pedal" => {
                let (says, stuck) = says.strip_suffix('!').map_or((says, false), |says| (says, true));
                let (places, noise) = says.split_once('~')?;
                let mut places = places.split(',').map(|place| place.parse().ok());
                let mut next = || places.next().flatten();
                let (up, splash, chick, down) = (next()?, next()?, next()?, next()?);
                let noise = noise.parse().ok()?;
                self.pedal = Some(Pedal { up, splash, chick, down, noise, stuck }.sane());
            }
            note => {
                let note: u8 = note.parse().ok().filter(|note: &u8| usize::from(*note) < NOTES)?;
                let (range, rest) = says.split_once('^')?;
                let ((low, high), (curve, retrigger)) = (range.split_once('-')?, rest.split_once('/')?);
                let pad = Pad {
                    low: low.parse().ok()?,
                    high: high.parse().ok()?,
                    curve: curve.parse().ok()?,
                    retrigger: retrigger.parse().ok()?,
                };
                self.pads.insert(note, pad.sane());
            }
        }
        Some(())
    }
}

/// The calibration of all pads and the pedal, shared.
#[derive(Debug)]
pub struct Calibration {
    pads: [AtomicU32; NOTES],
    pedal: AtomicU64,
    crosstalk: AtomicU8,
}

impl Default for Calibration {
    fn default() -> Self {
        let calibration = Calibration {
            pads: [const { AtomicU32::new(0) }; NOTES],
            pedal: AtomicU64::new(0),
            crosstalk: AtomicU8::new(0),
        };
        calibration.replace(&Learned::default());
        calibration
    }
}

impl Calibration {
    /// What the strokes of a note's pad are like.
    ///
    /// # Real-time
    /// One load.
    pub fn pad(&self, note: u8) -> Pad {
        let packed = self.pads.get(usize::from(note));
        packed.map_or_else(Pad::default, |packed| Pad::unpack(packed.load(Ordering::Relaxed)))
    }

    /// What the pedal's readings mean.
    ///
    /// # Real-time
    /// One load.
    pub fn pedal(&self) -> Pedal {
        Pedal::unpack(self.pedal.load(Ordering::Relaxed))
    }

    /// Share of a louder stroke's velocity below which a note on another pad is crosstalk, 0 to 1.
    ///
    /// # Real-time
    /// One load.
    pub fn crosstalk(&self) -> f32 {
        f32::from(self.crosstalk.load(Ordering::Relaxed)) / 100.0
    }

    /// Takes over what was learned of a pad. Notes beyond 127 are ignored.
    pub fn set_pad(&self, note: u8, pad: Pad) {
        if let Some(packed) = self.pads.get(usize::from(note)) {
            packed.store(pad.pack(), Ordering::Relaxed);
        }
    }

    /// Takes over what was learned of the pedal.
    pub fn set_pedal(&self, pedal: Pedal) {
        self.pedal.store(pedal.pack(), Ordering::Relaxed);
    }

    /// Drops notes below this share (percent) of a louder one at the same time.
    pub fn set_crosstalk(&self, percent: u8) {
        self.crosstalk.store(percent.min(100), Ordering::Relaxed);
    }

    /// Everything that is not as it is by default.
    pub fn learned(&self) -> Learned {
        let pads = (0..NOTES as u8).map(|note| (note, self.pad(note)));
        Learned {
            pads: pads.filter(|(_, pad)| *pad != Pad::default()).collect(),
            pedal: Some(self.pedal()).filter(|pedal| *pedal != Pedal::default()),
            crosstalk: self.crosstalk.load(Ordering::Relaxed),
        }
    }

    /// Puts this in place of all that was learned before.
    pub fn replace(&self, learned: &Learned) {
        for note in 0..NOTES as u8 {
            self.set_pad(note, learned.pads.get(&note).copied().unwrap_or_default());
        }
        self.set_pedal(learned.pedal.unwrap_or_default());
        self.set_crosstalk(learned.crosstalk);
    }

    /// Numbers that change with whatever is learned.
    pub(super) fn words(&self) -> impl Iterator<Item = u64> {
        let pads = self.pads.iter().map(|pad| u64::from(pad.load(Ordering::Relaxed)));
        let rest = [self.pedal.load(Ordering::Relaxed), u64::from(self.crosstalk.load(Ordering::Relaxed))];
        pads.chain(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_calibrated_arrives_as_it_is() {
        let calibration = Calibration::default();
        for velocity in 0..=127 {
            let share = f32::from(velocity as u8) / 127.0;
            assert_eq!(calibration.pad(38).velocity(share), share);
            assert_eq!(calibration.pedal().place(share), f64::from(share));
        }
        assert_eq!(calibration.learned(), Learned::default());
        assert_eq!(Learned::default().to_text(), "");
    }

    #[test]
    fn a_pad_s_own_range_becomes_the_whole_one_in_order() {
        let pad = Pad { low: 20, high: 100, curve: 1.5, retrigger: 5 };
        let velocities: Vec<f32> = (1..=127).map(|v| 127.0 * pad.velocity(v as f32 / 127.0)).collect();
        assert!(velocities.is_sorted());
        assert!((velocities[19] - 1.0).abs() < 1e-3 && (velocities[99] - 127.0).abs() < 1e-3);
        assert_eq!(pad.velocity(0.0), 0.0, "the end of a note stays one");
        assert!(pad.velocity(60.0 / 127.0) < 0.5, "soft strokes are softer");
    }

    #[test]
    fn a_pedal_runs_from_up_to_down_whatever_its_sense() {
        let pedal = Pedal { up: 110, splash: 60, chick: 30, down: 4, noise: 2, stuck: false };
        assert!(pedal.is_inverted());
        let place = |reading: u8| pedal.place(f32::from(reading) / 127.0);
        for (reading, wanted) in [(127, 0.0), (110, 0.0), (60, TOUCHING), (30, CLOSED), (4, 1.0), (0, 1.0)] {
            assert!((place(reading) - wanted).abs() < 1e-6, "{reading}: {}", place(reading));
        }
        assert!((0..127).all(|reading| place(reading) >= place(reading + 1)));
    }

    #[test]
    fn text_and_what_was_learned_agree_both_ways() {
        let learned = Learned {
            pads: BTreeMap::from([
                (38, Pad { low: 12, high: 118, curve: 1.25, retrigger: 8 }),
                (51, Pad { low: 3, high: 90, ..Pad::default() }),
            ]),
            pedal: Some(Pedal { up: 110, splash: 60, chick: 30, down: 4, noise: 2, stuck: false }),
            crosstalk: 20,
        };
        let calibration = Calibration::default();
        calibration.replace(&learned);
        assert_eq!(calibration.learned(), learned);
        let text = learned.to_text();
        assert_eq!(text, "38=12-118^1.25/8 51=3-90^1/0 pedal=110,60,30,4~2 crosstalk=20");
        assert_eq!(Learned::from_text(&text), (learned, Vec::new()));
        let (read, unknown) = Learned::from_text("200=1-2^1/0 38=1-127^1/4 loud pedal=1,2 crosstalk=900");
        assert_eq!((read.pads.len(), unknown.len()), (1, 4), "{unknown:?}");
    }

    #[test]
    fn whatever_is_set_is_sane() {
        let calibration = Calibration::default();
        calibration.set_pad(38, Pad { low: 127, high: 0, curve: f32::NAN, retrigger: 255 });
        assert_eq!(
            calibration.pad(38),
            Pad { low: 126, high: 127, curve: 1.0, retrigger: LONGEST_RETRIGGER }
        );
        calibration.set_pedal(Pedal { up: 50, down: 50, ..Pedal::default() });
        assert!(calibration.pedal().stuck);
        calibration.set_pedal(Pedal { splash: 120, chick: 10, ..Pedal::default() });
        let Pedal { splash, chick, .. } = calibration.pedal();
        assert!(splash <= chick, "{splash} {chick}");
        calibration.set_pad(200, Pad::default());
    }
}
