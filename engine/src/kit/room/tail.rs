//! The diffuse tail of the room: a network of delays as dense as a room.
//!
//! Model: sixteen long lines (one to ten mean free ways), what is lost on them, a Hadamard matrix, sixteen short lines, the matrix
//! again, and round. The matrix keeps energy, and what is lost on a way is as its length, so that all modes of an octave
//! last equally long ([losses](super::losses)). The two matrices with short lines between scatter: each round makes 256 echoes of
//! one; the sound enters at sixteen times, so that the first round has as many; what a piece sends in each direction has lines of its
//! own, for a reverberant field is made of all directions. All lengths are primes. The ways of all lines add up to 0.67 s or more: that many modes per hertz. Left and right hear different lines.
//!
//! ```text
//! sounds --> 16 taps --(+)--> H --> long lines --> losses --> H --> short lines --+--> left (even), right (odd)
//!                      ^                                                         |
//!                      +---------------------------------------------------------+
//! ```
//!
//! Level: of a source of power `P` the diffuse field in a room of volume `V` and time `T` has the mean square
//! pressure `4 rho c P / A`, `A = 0.161 V / T` (Sabine); a source heard with `p` at a metre sends out
//! `4 pi p^2 / (rho c)`: `p_diffuse^2 = p^2 16 pi / A`. Of a short sound, that is `16 pi / A (6 ln 10 / T) 10^(-6 t / T)` per
//! second after it was sent (Barron: from when the sound itself arrives); at `t = 0` the same for all `T`. In the network
//! a side's eight lines carry `8 feed^2 / t_m 10^(-6 t / T)`, `t_m` the mean time of a round (renewal).
//!
//! Limits: the tail is the same wherever in the room the pieces and the microphones are; a room has far more modes than this
//! tail above 100 Hz, so that a tail of more than a second could be told from one.
//!
//! Source: Jot & Chaigne, AES preprint 3030, 1991; Schlecht & Habets, IEEE/ACM TASLP 28, 2020 (scattering); Barron & Lee,
//! JASA 84, 1988.

use std::f64::consts::PI;

use super::losses::{Losses, SHELVES};
use crate::air_load::SPEED_OF_SOUND;
use crate::block::{BLOCK, SILENT_RUN};
use crate::kit_spec::room::RoomSpec;
use crate::receiver::DIRECTIONS;

/// Lines of each kind.
const LINES: usize = 16;

/// Shortest and longest long line, and shortest and longest short one, mean free ways.
const LONG: [f64; 2] = [1.6, 8.0];
const SHORT: [f64; 2] = [0.15, 1.3];

/// What scatters the sound before it enters: ways of all passes, mean free ways, and how much of the sound is left behind in each.
const SCATTERS: usize = 4;
const SCATTER: [f64; SCATTERS] = [0.089, 0.144, 0.233, 0.377];
const SCATTERED: f32 = 0.6;

/// The octave of 1 kHz.
const USUAL: usize = 4;

/// Mean free way of the smallest room whose lines are made to its measure, m: smaller ones get these, for the sake of their modes.
const LEAST_WAY: f64 = 3.1;

/// Pressure in the lines below this is silence, Pa: 140 dB under full scale, so that a kit sleeps within a second of what
/// is heard last.
const SILENCE: f32 = 2e-6;

/// The golden ratio's fraction: its multiples scatter without a rhythm.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// A run of every line.
type Runs = [[f32; BLOCK]; LINES];
/// A number for each line.
type Row = [f32; LINES];

/// The tail.
pub(in crate::kit) struct Tail {
    scatter: [[Scatter; SCATTERS]; DIRECTIONS],
    entry: [Entry; DIRECTIONS],
    long: Lines,
    short: Lines,
    /// What is left after each short line.
    short_gains: Row,
    weakening: Weakening,
    /// Where in each long line it is listened to, samples from its beginning, and how much.
    receivers: [(usize, f32); LINES],
    silent: bool,
}

impl Tail {
    /// Silent. Allocates.
    pub(in crate::kit) fn new(room: &RoomSpec, sample_rate: f64) -> Tail {
        let unit = room.mean_way().max(LEAST_WAY) / SPEED_OF_SOUND * sample_rate;
        let mut taken = Vec::new();
        // Long lines crowd toward short ways: the tail begins early and has no gap.
        let long = lengths(&mut taken, |x| unit * LONG[0] * (LONG[1] / LONG[0]).powf(x));
        let short = lengths(&mut taken, |x| unit * (SHORT[0] + (SHORT[1] - SHORT[0]) * x));
        let between = short.iter().sum::<usize>() as f64 / LINES as f64 / sample_rate;
        let round = long.iter().sum::<usize>() as f64 / LINES as f64 / sample_rate + between;
        let times = room.times();
        // Short ways lose the same of all octaves; the long ones make up for the difference.
        let usual = times[USUAL];
        let left = |length: usize| 10.0_f64.powf(-3.0 * length as f64 / sample_rate / usual);
        let losses = long.map(|length| {
            let way = length as f64 / sample_rate;
            let lost = times.map(|time| -60.0 * (way / time + between * (1.0 / time - 1.0 / usual)));
            Losses::nearest(&lost, sample_rate)
        });
        // Neighbours among the long lines do not go on as neighbours.
        let short = std::array::from_fn(|i| short[i * 7 % LINES]);
        let lines_a_side = LINES as f64 / 2.0;
        let square =
            16.0 * PI / (0.161 * room.volume()) * (6.0 * std::f64::consts::LN_10) * round / lines_a_side;
        let scatter: [[usize; SCATTERS]; DIRECTIONS] =
            std::array::from_fn(|_| SCATTER.map(|way| prime(&mut taken, unit * way)));
        let lead = scatter.as_flattened().iter().sum::<usize>() / DIRECTIONS;
        let feed = |(i, delay): (usize, usize)| {
            let sign = if i.count_ones() % 2 == 0 { 1.0 } else { -1.0 };
            (delay, (sign * square.sqrt() * left(lead + delay)) as f32)
        };
        // Anywhere in a line, the longer the more.
        let all = long.iter().sum::<usize>() as f64 / LINES as f64;
        let receivers = std::array::from_fn(|i| {
            let delay = ((GOLDEN * (i as f64 + 0.5)).fract() * long[i] as f64) as usize;
            let delay = delay.clamp(BLOCK, long[i]);
            let sign = if i / 2 % 2 == 0 { 1.0 } else { -1.0 };
            (delay, (sign * (long[i] as f64 / all).sqrt() * left(delay) / SCALE) as f32)
        });
        Tail {
            scatter: scatter.map(|ways| ways.map(Scatter::new)),
            entry: std::array::from_fn(|direction| {
                // Pairs of neighbours by turns: left and right hear lines of both.
                let own = |i: usize| i / 2 % DIRECTIONS == direction;
                Entry::new(std::array::from_fn(|i| {
                    let (delay, gain) = feed((i, short[LINES - 1 - i] / 2));
                    (delay, if own(i) { gain } else { 0.0 })
                }))
            }),
            long: Lines::new(long),
            short: Lines::new(short),
            short_gains: short.map(|length| left(length) as f32),
            weakening: Weakening::new(&losses, sample_rate),
            receivers,
            silent: true,
        }
    }

    /// Whether nothing is under way.
    pub(in crate::kit) fn is_silent(&self) -> bool {
        self.silent
    }

    /// Adds the tail of what was sent in each direction, up to [`BLOCK`] samples of one length, to the left and right output.
    pub(in crate::kit) fn render(&mut self, sent: [&[f32]; DIRECTIONS], [left, right]: [&mut [f32]; 2]) {
        if self.silent && sent.iter().all(|sound| sound.iter().all(|&x| x == 0.0)) {
            return;
        }
        self.silent = false;
        let samples = sent[0].len();
        let (mut near, mut far) = ([SILENT_RUN; LINES], [SILENT_RUN; LINES]);
        self.short.read(&mut near, samples);
        self.long.read(&mut far, samples);
        for (line, gain) in near.iter_mut().zip(self.short_gains) {
            line.iter_mut().for_each(|x| *x *= gain);
        }
        for (i, &(delay, gain)) in self.receivers.iter().enumerate() {
            self.long.listen(i, delay, gain, if i % 2 == 0 { &mut *left } else { &mut *right });
        }
        self.weakening.render(&mut far, samples);
        hadamard(&mut far);
        self.short.write(&far, samples);
        for ((scatter, entry), sound) in self.scatter.iter_mut().zip(&mut self.entry).zip(sent) {
            let mut scattered = SILENT_RUN;
            scattered[..samples].copy_from_slice(sound);
            scatter.iter_mut().for_each(|scatter| scatter.render(&mut scattered[..samples]));
            entry.add(&scattered[..samples], &mut near);
        }
        hadamard(&mut near);
        self.long.write(&near, samples);
    }

    /// Makes silence exact; meant for now and then, on the kit's clock.
    pub(in crate::kit) fn settle(&mut self) {
        if self.silent {
            return;
        }
        // All passes fade faster than the rest: they end before their numbers become too small to be fast.
        self.scatter
            .as_flattened_mut()
            .iter_mut()
            .filter(|scatter| scatter.is_quiet())
            .for_each(Scatter::reset);
        if self.entry.iter().all(Entry::is_quiet)
            && self.short.are_quiet(SILENCE)
            && self.long.are_quiet(SCALE as f32 * SILENCE)
        {
            self.reset();
        }
    }

    /// Silence.
    pub(in crate::kit) fn reset(&mut self) {
        self.scatter.as_flattened_mut().iter_mut().for_each(Scatter::reset);
        self.entry.iter_mut().for_each(Entry::reset);
        self.long.reset();
        self.short.reset();
        self.weakening.reset();
        self.silent = true;
    }
}

/// An all pass: an echo of its own again and again, all frequencies as loud as before.
struct Scatter {
    samples: Box<[f32]>,
    at: usize,
}

impl Scatter {
    fn new(length: usize) -> Scatter {
        Scatter { samples: vec![0.0; length].into(), at: 0 }
    }

    fn render(&mut self, sound: &mut [f32]) {
        let first = sound.len().min(self.samples.len() - self.at);
        let (before, after) = sound.split_at_mut(first);
        let wrapped = after.len();
        for (run, from) in [(before, self.at), (after, 0)] {
            for (x, held) in run.iter_mut().zip(&mut self.samples[from..]) {
                let inside = *x - SCATTERED * *held;
                *x = *held + SCATTERED * inside;
                *held = inside;
            }
        }
        self.at = if self.at + first < self.samples.len() { self.at + first } else { wrapped };
    }

    fn is_quiet(&self) -> bool {
        self.samples.iter().all(|x| x.abs() < SILENCE)
    }

    fn reset(&mut self) {
        self.samples.fill(0.0);
    }
}

/// How sound enters: at a time and with a gain of its own in each line.
struct Entry {
    /// What came in, the newest just before `at`.
    history: Box<[f32]>,
    at: usize,
    longest: usize,
    /// Delays, samples, and gains.
    taps: [(usize, f32); LINES],
}

impl Entry {
    /// How much longer the history is than the longest delay, samples: how seldom it is moved back to the beginning.
    const SPARE: usize = 64 * BLOCK;

    fn new(taps: [(usize, f32); LINES]) -> Entry {
        let longest = taps.iter().fold(0, |longest, tap| longest.max(tap.0));
        Entry { history: vec![0.0; longest + Entry::SPARE].into(), at: longest, longest, taps }
    }

    fn add(&mut self, sound: &[f32], runs: &mut Runs) {
        if self.at + sound.len() > self.history.len() {
            self.history.copy_within(self.at - self.longest..self.at, 0);
            self.at = self.longest;
        }
        self.history[self.at..self.at + sound.len()].copy_from_slice(sound);
        for (run, (delay, gain)) in runs.iter_mut().zip(self.taps) {
            let delayed = &self.history[self.at - delay..];
            run.iter_mut().zip(&delayed[..sound.len()]).for_each(|(x, delayed)| *x += gain * delayed);
        }
        self.at += sound.len();
    }

    fn is_quiet(&self) -> bool {
        self.history[self.at - self.longest..self.at].iter().all(|x| x.abs() < SILENCE)
    }

    fn reset(&mut self) {
        self.history.fill(0.0);
        self.at = self.longest;
    }
}

/// Delay lines, each as long as its delay, none shorter than a run.
struct Lines {
    lines: [Box<[f32]>; LINES],
    at: [usize; LINES],
}

impl Lines {
    fn new(lengths: [usize; LINES]) -> Lines {
        Lines { lines: lengths.map(|length| vec![0.0; length].into()), at: [0; LINES] }
    }

    /// What comes out next.
    fn read(&self, runs: &mut Runs, samples: usize) {
        for ((run, line), &at) in runs.iter_mut().zip(&self.lines).zip(&self.at) {
            let next = &line[at..];
            // Nearly always: a whole run in one piece.
            match next.first_chunk() {
                Some(whole) if samples == BLOCK => *run = *whole,
                _ => {
                    let first = samples.min(next.len());
                    run[..first].copy_from_slice(&next[..first]);
                    run[first..samples].copy_from_slice(&line[..samples - first]);
                }
            }
        }
    }

    /// Adds what a line was given so many samples ago, not fewer than are asked for.
    fn listen(&self, i: usize, delay: usize, gain: f32, out: &mut [f32]) {
        let line = &self.lines[i];
        let at = if self.at[i] < delay { self.at[i] + line.len() - delay } else { self.at[i] - delay };
        let (before, after) = out.split_at_mut(out.len().min(line.len() - at));
        for (out, line) in [(before, &line[at..]), (after, &line[..])] {
            out.iter_mut().zip(line).for_each(|(out, x)| *out += gain * x);
        }
    }

    /// Puts in as much as was read in its place.
    fn write(&mut self, runs: &Runs, samples: usize) {
        for ((run, line), at) in runs.iter().zip(&mut self.lines).zip(&mut self.at) {
            let left = line.len() - *at;
            match line[*at..].first_chunk_mut() {
                Some(whole) if samples == BLOCK => *whole = *run,
                _ => {
                    let first = samples.min(left);
                    line[*at..*at + first].copy_from_slice(&run[..first]);
                    line[..samples - first].copy_from_slice(&run[first..samples]);
                }
            }
            *at = if samples < left { *at + samples } else { samples - left };
        }
    }

    fn are_quiet(&self, silence: f32) -> bool {
        self.lines.iter().all(|line| line.iter().all(|x| x.abs() < silence))
    }

    fn reset(&mut self) {
        self.lines.iter_mut().for_each(|line| line.fill(0.0));
        self.at = [0; LINES];
    }
}

/// [`Losses`] of all lines, side by side.
struct Weakening {
    gain: Row,
    shelves: [Row; SHELVES],
    steps: [f32; SHELVES],
    low_pass: Row,
    /// What the low passes hold: of each shelf, and the last.
    held: [Row; SHELVES],
    last: Row,
}

impl Weakening {
    fn new(losses: &[Losses; LINES], sample_rate: f64) -> Weakening {
        let steps = Losses::shelf_steps(sample_rate);
        Weakening {
            // Both matrices are left as sums; what they add is taken back here.
            gain: losses.map(|losses| (losses.gain / (SCALE * SCALE)) as f32),
            // `x - y` before the step is `1 - a` times what it is after.
            shelves: std::array::from_fn(|k| {
                losses.map(|losses| (losses.shelves[k] * (1.0 - steps[k])) as f32)
            }),
            steps: steps.map(|step| step as f32),
            low_pass: losses.map(|losses| losses.low_pass as f32),
            held: [[0.0; LINES]; SHELVES],
            last: [0.0; LINES],
        }
    }

    #[expect(clippy::needless_range_loop, reason = "a time is one sample of every line")]
    fn render(&mut self, runs: &mut Runs, samples: usize) {
        for t in 0..samples {
            let mut frame: Row = std::array::from_fn(|i| runs[i][t]);
            frame.iter_mut().zip(&self.gain).for_each(|(x, gain)| *x *= gain);
            for ((held, share), step) in self.held.iter_mut().zip(&self.shelves).zip(self.steps) {
                for i in 0..LINES {
                    let high = frame[i] - held[i];
                    held[i] += step * high;
                    frame[i] += share[i] * high;
                }
            }
            for i in 0..LINES {
                self.last[i] += self.low_pass[i] * (frame[i] - self.last[i]);
                runs[i][t] = self.last[i];
            }
        }
    }

    fn reset(&mut self) {
        self.held = [[0.0; LINES]; SHELVES];
        self.last = [0.0; LINES];
    }
}

/// How much louder each line is after [`hadamard`].
const SCALE: f64 = 4.0;

/// Mixes the lines; the sum of their squares is [`SCALE`] squared times what it was.
#[expect(clippy::needless_range_loop, reason = "a time is one sample of every line")]
fn hadamard(runs: &mut Runs) {
    for quarter in [1, LINES / 4] {
        for first in (0..LINES).filter(|i| i / quarter % 4 == 0) {
            for t in 0..BLOCK {
                let [a, b, c, d] = std::array::from_fn(|k| runs[first + k * quarter][t]);
                let [ab, a_b, cd, c_d] = [a + b, a - b, c + d, c - d];
                runs[first][t] = ab + cd;
                runs[first + quarter][t] = a_b + c_d;
                runs[first + 2 * quarter][t] = ab - cd;
                runs[first + 3 * quarter][t] = a_b - c_d;
            }
        }
    }
}

/// Lengths of lines, samples: [primes](prime) at `length` of places scattered evenly over 0 to 1.
fn lengths(taken: &mut Vec<usize>, length: impl Fn(f64) -> f64) -> [usize; LINES] {
    std::array::from_fn(|i| {
        let place = (i as f64 + (GOLDEN * i as f64).fract()) / LINES as f64;
        prime(taken, length(place))
    })
}

/// The first prime that nobody has yet from there on, not shorter than a run.
fn prime(taken: &mut Vec<usize>, samples: f64) -> usize {
    let mut samples = (samples as usize).max(BLOCK) | 1;
    while taken.contains(&samples) || !is_prime(samples) {
        samples += 2;
    }
    taken.push(samples);
    samples
}

/// Whether an odd number is prime.
fn is_prime(x: usize) -> bool {
    (3..).step_by(2).take_while(|d| d * d <= x).all(|d| !x.is_multiple_of(d))
}

#[cfg(test)]
mod tests;
