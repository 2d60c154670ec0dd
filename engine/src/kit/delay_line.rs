//! Delay lines: sound paths between two positions, with their delay and attenuation.
//!
//! A [`DelayLine`] holds the recent sound of a piece. A [`DelayTap`] reads it at some distance. Between samples it interpolates by
//! a polynomial (Lagrange): on the way to a microphone through twelve of them, which loses at most 1.5 dB at 16 kHz of 44.1;
//! from piece to piece through four.
//!
//! Positions on a line are counted by the kit's clock, so the output does not depend on the host's buffers.

use crate::air_load::SPEED_OF_SOUND;
use crate::block::BLOCK;
use crate::layout::FARTHEST;
use crate::modal::simd::Kernels;

/// Samples that the polynomial goes through, and how many of them are newer than the sample next to its position.
const TAPS: usize = 12;
const AHEAD: usize = TAPS / 2 - 1;

/// Length of the cross-fade of a moved tap, s. *By ear*: no click, and no gliding pitch.
const MOVE_TIME: f64 = 0.03;

/// Recent sound of a piece, as long as the longest path.
pub(super) struct DelayLine {
    /// A power of two and, after it, its first samples once more.
    samples: Box<[f32]>,
    mask: usize,
    /// Samples of silence since the latest sound.
    silence: usize,
    kernels: Kernels,
}

/// Samples repeated at the end: a tap reads in one stretch.
const REPEATED: usize = BLOCK + TAPS;

impl DelayLine {
    /// A silent line at a sample rate (Hz). Allocates.
    pub(super) fn new(sample_rate: f64) -> DelayLine {
        let longest = (sample_rate * FARTHEST / SPEED_OF_SOUND) as usize + 2 * REPEATED;
        let length = longest.next_power_of_two();
        DelayLine {
            samples: vec![0.0; length + REPEATED].into(),
            mask: length - 1,
            silence: length,
            kernels: Kernels::detect(),
        }
    }

    /// Whether it holds silence only.
    pub(super) fn is_silent(&self) -> bool {
        self.silence > self.mask
    }

    /// Writes a run from a time (samples) on.
    pub(super) fn send(&mut self, clock: u64, sound: &[f32]) {
        if sound.iter().all(|&x| x == 0.0) {
            if self.is_silent() {
                return;
            }
            self.silence += sound.len();
        } else {
            self.silence = 0;
        }
        for (i, &x) in sound.iter().enumerate() {
            let at = (clock as usize).wrapping_add(i) & self.mask;
            self.samples[at] = x;
            if at < REPEATED {
                self.samples[self.mask + 1 + at] = x;
            }
        }
    }

    /// Adds the sound at a tap from a time on.
    pub(super) fn hear(&self, clock: u64, tap: &DelayTap, out: &mut [f32]) {
        let first = (clock as usize).wrapping_sub(tap.newest + tap.count - 1) & self.mask;
        self.kernels.vectorized(
            #[inline(always)]
            || {
                for (i, weight) in tap.weights[..tap.count].iter().enumerate() {
                    let past = &self.samples[first + i..][..out.len()];
                    out.iter_mut().zip(past).for_each(|(out, x)| *out += weight * x);
                }
            },
        );
    }

    /// Silence again.
    pub(super) fn reset(&mut self) {
        self.samples.fill(0.0);
        self.silence = self.mask + 1;
    }
}

/// A position on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DelayTap {
    /// Age of the newest sample that it reads, samples.
    newest: usize,
    /// How many it reads, and their weights, oldest first.
    count: usize,
    weights: [f32; TAPS],
}

impl DelayTap {
    /// A tap with a delay (s) and a gain.
    pub(super) fn new(delay: f64, gain: f64, sample_rate: f64) -> DelayTap {
        DelayTap::through(AHEAD, delay, gain, sample_rate)
    }

    /// The same through at most so many samples newer than those next to its position, and as many older ones.
    fn through(ahead: usize, delay: f64, gain: f64, sample_rate: f64) -> DelayTap {
        let samples = (delay * sample_rate).clamp(0.0, FARTHEST / SPEED_OF_SOUND * sample_rate);
        // Samples that do not exist yet are not asked for: nearer, the polynomial goes through fewer.
        let newer = samples as usize;
        let reach = newer.min(ahead);
        let (newest, count) = (newer - reach, 2 * (reach + 1));
        let weight = |age: usize| -> f64 {
            let others = (newest..newest + count).filter(|&other| other != age);
            others.map(|other| (samples - other as f64) / (age as f64 - other as f64)).product()
        };
        let mut weights = [0.0; TAPS];
        for (weights, age) in weights.iter_mut().zip((newest..newest + count).rev()) {
            *weights = (weight(age) * gain) as f32;
        }
        DelayTap { newest, count, weights }
    }

    /// A path through free air, m, for a line that holds the sound at a metre. The delay is shorter by `lead`, m.
    pub(super) fn along(metres: f64, lead: f64, sample_rate: f64) -> DelayTap {
        DelayTap::new((metres - lead).max(0.0) / SPEED_OF_SOUND, spread(metres), sample_rate)
    }

    /// A path from piece to piece, m, by a cubic. More points would lose less at high frequencies, which drive no piece, and
    /// read samples that are newer, so that the kit's blocks would have to be shorter.
    pub(super) fn to_piece(metres: f64, sample_rate: f64) -> DelayTap {
        DelayTap::through(1, metres / SPEED_OF_SOUND, spread(metres), sample_rate)
    }

    /// The same, weaker.
    pub(super) fn weakened(self, share: f32) -> DelayTap {
        DelayTap { weights: self.weights.map(|weight| weight * share), ..self }
    }

    /// Longest run (samples) that can be read before it is written.
    pub(super) fn reach(&self) -> usize {
        self.newest
    }
}

/// Pressure at a distance (m) over that at a metre.
fn spread(metres: f64) -> f64 {
    1.0 / metres.max(crate::layout::NEAREST)
}

/// A tap that moves by a cross-fade.
#[derive(Debug, Clone, Copy)]
pub(super) struct MovingDelayTap {
    from: DelayTap,
    to: DelayTap,
    /// The next target.
    next: DelayTap,
    /// Progress of the cross-fade, 0 to 1, and its change in a sample.
    share: f32,
    step: f32,
}

impl MovingDelayTap {
    pub(super) fn new(tap: DelayTap, sample_rate: f64) -> MovingDelayTap {
        let step = (1.0 / (MOVE_TIME * sample_rate)) as f32;
        MovingDelayTap { from: tap, to: tap, next: tap, share: 1.0, step }
    }

    pub(super) fn set(&mut self, tap: DelayTap) {
        self.next = tap;
    }

    /// Ends the cross-fade.
    pub(super) fn jump(&mut self) {
        (self.from, self.to, self.share) = (self.next, self.next, 1.0);
    }

    /// Adds the sound at the tap from a time on, and advances the cross-fade.
    pub(super) fn hear(&mut self, line: &DelayLine, clock: u64, out: &mut [f32]) {
        let mut done = 0;
        while done < out.len() {
            if self.share >= 1.0 && self.next != self.to {
                (self.from, self.to, self.share) = (self.to, self.next, 0.0);
            }
            let left = &mut out[done..];
            let now = clock + done as u64;
            if self.share >= 1.0 {
                line.hear(now, &self.to, left);
                return;
            }
            let (mut old, mut new) = ([0.0; BLOCK], [0.0; BLOCK]);
            line.hear(now, &self.from, &mut old[..left.len()]);
            line.hear(now, &self.to, &mut new[..left.len()]);
            for (out, (old, new)) in left.iter_mut().zip(old.iter().zip(&new)) {
                self.share = (self.share + self.step).min(1.0);
                *out += old + self.share * (new - old);
                done += 1;
                if self.share >= 1.0 {
                    break;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 44_100.0;

    /// Response to an impulse at time 0, rendered in runs of that length.
    fn arrival(tap: DelayTap, run: usize) -> Vec<f32> {
        let mut line = DelayLine::new(RATE);
        let mut heard = vec![0.0; 960];
        for (i, out) in heard.chunks_mut(run).enumerate() {
            let mut sound = vec![0.0; out.len()];
            if i == 0 {
                sound[0] = 1.0;
            }
            line.send((i * run) as u64, &sound);
            line.hear((i * run) as u64, &tap, out);
        }
        heard
    }

    #[test]
    fn sound_arrives_when_its_way_over_its_speed_has_passed() {
        for metres in [0.3, 0.441, 1.0, 3.43] {
            let heard = arrival(DelayTap::along(metres, 0.0, RATE), 32);
            let total: f64 = heard.iter().map(|&x| f64::from(x)).sum();
            let mean = heard.iter().enumerate().map(|(i, &x)| i as f64 * f64::from(x)).sum::<f64>() / total;
            assert!((mean - metres / SPEED_OF_SOUND * RATE).abs() < 1e-3, "{metres}: {mean}");
            assert!((total - 1.0 / metres).abs() < 1e-5, "{metres}: {total}");
        }
    }

    #[test]
    fn how_time_is_cut_does_not_change_what_arrives() {
        let tap = DelayTap::new(0.0102, 0.7, RATE);
        assert_eq!(arrival(tap, 32), arrival(tap, 5));
        // Nor while it moves.
        let moving = |run: usize| {
            let mut line = DelayLine::new(RATE);
            let mut tap = MovingDelayTap::new(DelayTap::new(0.001, 1.0, RATE), RATE);
            tap.set(DelayTap::new(0.004, 0.5, RATE));
            let mut heard = vec![0.0; 4_800];
            for (i, out) in heard.chunks_mut(run).enumerate() {
                let at = i * run;
                let sound: Vec<f32> = (at..at + out.len()).map(|n| (0.1 * n as f32).sin()).collect();
                line.send(at as u64, &sound);
                tap.hear(&line, at as u64, out);
            }
            heard
        };
        assert_eq!(moving(32), moving(3));
    }

    #[test]
    fn a_way_of_no_length_is_no_delay() {
        assert_eq!(arrival(DelayTap::new(0.0, 1.0, RATE), 32)[..3], [1.0, 0.0, 0.0]);
    }
}
