//! What the sweeps of random events and calls over both formats have in common.
//!
//! Each run has a seed of its own, which is printed; `OVERHEAR_SEED` repeats one. `OVERHEAR_SWEEP` says how many events are
//! sent in each format: `OVERHEAR_SWEEP=1000000 cargo test -p overhear sweep`. Debug builds abort on an allocation while they
//! process.

use std::time::{SystemTime, UNIX_EPOCH};

use fastrand::Rng;
use overhear_player::parameters::{BYPASS_ID, host_id, parameters};

/// Events that are sent in each format where nobody says how many.
const EVENTS: usize = 8_000;

/// Longest buffer, samples.
pub const FRAMES: usize = 512;

/// What the ceiling lets nothing beyond, full scale 1. With all gains at their ends a stroke comes within some thousandths.
const CEILING: f32 = 4.0;

/// Loudest sample of what is taken for silence, full scale 1.
const SILENT: f32 = 1e-4;

/// How long after all sound is off there may still be some, s.
pub const LAST: f64 = 5.0;

/// What is put behind a buffer, samples: whoever writes there is found out.
const BEHIND: usize = 1024;

/// Room for so many samples.
pub fn buffer(frames: usize) -> Vec<f32> {
    let mut samples = vec![0.0; frames];
    samples.resize(frames + BEHIND, f32::NAN);
    samples
}

/// Samples of a [`buffer`], full scale 1, behind which nothing was written.
pub fn written(mut samples: Vec<f32>, frames: usize) -> Vec<f32> {
    assert!(samples[frames..].iter().all(|sample| sample.is_nan()), "something was written behind a buffer");
    samples.truncate(frames);
    samples
}

/// Random numbers, and how many events are left.
pub struct Chance {
    pub random: Rng,
    seed: u64,
    left: usize,
}

impl Chance {
    pub fn new() -> Chance {
        let fresh = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |now| now.as_micros() as u64);
        let number = |name| std::env::var(name).ok().map(|text| text.parse().expect(name));
        let seed = number("OVERHEAR_SEED").unwrap_or_else(fresh);
        let left = number("OVERHEAR_SWEEP").map_or(EVENTS, |events| events as usize);
        println!("OVERHEAR_SEED={seed} OVERHEAR_SWEEP={left}");
        Chance { random: Rng::with_seed(seed), seed, left }
    }

    /// What a failure is to say.
    pub fn where_it_is(&self) -> String {
        format!("seed {}, {} events before the end", self.seed, self.left)
    }

    pub fn goes_on(&self) -> bool {
        self.left > 0
    }

    /// How many events the next buffer has: mostly some, now and then a flood.
    pub fn events(&mut self) -> usize {
        let most = if self.random.u32(..500) == 0 { 2_000 } else { 40 };
        let events = self.random.usize(..most);
        self.left = self.left.saturating_sub(events);
        events
    }

    /// Samples of the next buffer.
    pub fn frames(&mut self) -> usize {
        let most = [1, 2, 33, 64, 300, FRAMES + 1][self.random.usize(..6)];
        self.random.usize(..most)
    }

    pub fn of<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.random.usize(..from.len())]
    }

    /// When events of a buffer happen, samples: in order, or now and then as they come or after its end.
    pub fn times(&mut self, events: usize, frames: usize) -> Vec<u32> {
        let (beyond, ordered) =
            self.of(&[(1, true), (1, true), (1, true), (1, true), (1, false), (40, false)]);
        let mut times: Vec<_> =
            (0..events).map(|_| beyond * self.random.u32(..frames.max(1) as u32)).collect();
        if ordered {
            times.sort_unstable();
        }
        times
    }

    /// A share of a range, or what is none.
    pub fn share(&mut self) -> f64 {
        match self.random.u32(..20) {
            0 => self.of(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 2.0, 1e300, -0.0, 1e-310]),
            1 => self.of(&[0.0, 1.0]),
            _ => self.random.f64(),
        }
    }

    /// A parameter's id, or none's.
    pub fn id(&mut self) -> u32 {
        match self.random.usize(..=parameters().len() + 2) {
            index if index < parameters().len() => host_id(parameters()[index].id),
            index if index == parameters().len() => host_id(BYPASS_ID),
            _ => self.random.u32(..),
        }
    }

    /// A note, mostly one of a drum set.
    pub fn key(&mut self) -> i16 {
        if self.random.u32(..10) == 0 { self.random.i16(-2..140) } else { self.random.i16(35..97) }
    }

    /// A channel, mostly that of drums.
    pub fn channel(&mut self) -> i16 {
        if self.random.u32(..4) == 0 { self.random.i16(-2..20) } else { 9 }
    }

    /// What a host may have stored, with some bytes changed, cut out or made up.
    pub fn damaged(&mut self, stored: &[u8]) -> Vec<u8> {
        let mut bytes = stored.to_vec();
        for _ in 0..self.random.u32(1..4) {
            if bytes.is_empty() {
                break;
            }
            let at = self.random.usize(..bytes.len());
            match self.random.u32(..3) {
                0 => bytes[at] ^= 1 << self.random.u32(..8),
                1 => bytes.truncate(at),
                _ => bytes.insert(at, self.random.u8(..)),
            }
        }
        bytes
    }

    /// What is in buffers: finite, under the ceiling, and nothing behind them.
    pub fn believe<const CHANNELS: usize>(
        &self,
        sound: Vec<[Vec<f32>; CHANNELS]>,
        frames: usize,
    ) -> Vec<[Vec<f32>; CHANNELS]> {
        let sound: Vec<_> =
            sound.into_iter().map(|port| port.map(|channel| written(channel, frames))).collect();
        for sample in sound.iter().flatten().flatten() {
            assert!(sample.abs() <= CEILING, "{}: {sample}", self.where_it_is());
        }
        sound
    }

    /// Whether nothing is heard of samples, full scale 1.
    pub fn is_silent<'a>(mut samples: impl Iterator<Item = &'a f32>) -> bool {
        samples.all(|sample| sample.abs() < SILENT)
    }
}
