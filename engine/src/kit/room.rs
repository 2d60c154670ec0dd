//! The room about the kit: early reflections and a short diffuse tail, for the room microphones.
//!
//! Model: a shoebox. Each of its six surfaces mirrors every piece once (image sources: the ways from the images are
//! [`Tap`](super::line::Tap)s like any other, weakened by what the surface swallows). What comes after is diffuse: a feedback delay
//! network of eight lines whose lengths have no common divisor, mixed by a Hadamard matrix, which keeps energy, and weakened
//! on each round by what gives the reverberation time, more in the highs. It is fed by what all pieces send
//! out; left and right hear different signs of the same lines.
//!
//! Level of the tail: of a source of power `P` the diffuse field in a room of volume `V` and time `T` has the mean
//! square pressure `4 rho c P / A`, `A = 0.161 V / T` (Sabine); a source heard with `p` at a metre sends out
//! `4 pi p^2 / (rho c)`: `p_diffuse = p sqrt(16 pi / A)`.
//!
//! Source: Kuttruff, Room Acoustics, ch. 4, 5; Jot & Chaigne, AES preprint 3030, 1991.

use serde::{Deserialize, Serialize};

use super::BLOCK;
use crate::air::SPEED_OF_SOUND;
use crate::error::SpecError;
use crate::fitted;
use crate::layout::{FARTHEST, Point};

/// A room's description: a shoebox.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomSpec {
    /// Its inner corners, m: the least and the greatest of each coordinate, within 20 m of the origin and 2 m apart.
    #[serde(rename = "corners_m")]
    pub corners: [Point; 2],
    /// Share of the pressure that a surface sends back, 0 to 0.99: left and right wall, floor and ceiling, the walls behind
    /// the drummer and before the kit.
    pub reflected: [[f64; 2]; 3],
    /// Reverberation time at low frequency, s, 0.05 to 5.
    #[serde(rename = "reverberation_s")]
    pub time: f64,
    /// Above this the tail fades faster, Hz, 500 to 40,000.
    pub soft_hz: f64,
}

impl RoomSpec {
    /// The standard kit's: 7 x 3 x 6 m, the kit toward one end; reflections *by ear*: carpet, treated. Its `soft_hz` is *fitted*:
    /// with 5 kHz the octave of 8 kHz of drums is gone in half the time that recordings have; a room of this size and time
    /// loses little more to its air there.
    pub const STANDARD: RoomSpec = RoomSpec {
        corners: [[-3.3, 0.0, -2.0], [3.7, 3.0, 4.0]],
        reflected: [[0.75, 0.75], [fitted::ROOM_FLOOR, 0.65], [0.7, 0.75]],
        time: 0.5,
        soft_hz: fitted::ROOM_SOFT_HZ,
    };

    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the field.
    pub fn check(&self) -> Result<(), SpecError> {
        for (low, high) in self.corners[0].iter().zip(&self.corners[1]) {
            SpecError::check("corners_m", *low, -FARTHEST, FARTHEST - 2.0)?;
            SpecError::check("corners_m", *high, low + 2.0, FARTHEST)?;
        }
        for share in self.reflected.as_flattened() {
            SpecError::check("reflected", *share, 0.0, 0.99)?;
        }
        SpecError::check("reverberation_s", self.time, 0.05, 5.0)?;
        SpecError::check("soft_hz", self.soft_hz, 500.0, 40_000.0)?;
        Ok(())
    }

    fn sides(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.corners[1][axis] - self.corners[0][axis])
    }

    fn volume(&self) -> f64 {
        self.sides().iter().product()
    }

    /// Mean free way of sound between its surfaces, m.
    fn mean_way(&self) -> f64 {
        let [x, y, z] = self.sides();
        4.0 * self.volume() / (2.0 * (x * y + y * z + z * x))
    }
}

/// Lines of the network, and their lengths, m of air, in a room of that mean free way: between once and three times that.
const LINES: usize = 8;
const WAYS: [f64; LINES] = [3.01, 3.67, 4.21, 5.03, 5.81, 6.61, 7.43, 8.29];
const WAYS_MEAN: f64 = 4.0 * 126.0 / 162.0;

/// Pressure in the lines below this is silence, Pa: 140 dB under full scale, so that a kit sleeps within a second of what
/// is heard last.
const SILENCE: f32 = 2e-6;

/// Mirror images of a place in the room's surfaces, and the share of the pressure each sends back.
pub(super) fn images(room: &RoomSpec, source: &Point) -> [(Point, f64); 6] {
    std::array::from_fn(|i| {
        let (axis, side) = (i / 2, i % 2);
        let mut image = *source;
        image[axis] = 2.0 * room.corners[side][axis] - image[axis];
        (image, room.reflected[axis][side])
    })
}

/// One line of the network.
struct Loop {
    samples: Box<[f32]>,
    at: usize,
    /// What is left after a round, and the highs' own memory.
    keep: f32,
    soft: f32,
    held: f32,
}

/// The diffuse tail.
pub(super) struct Tail {
    loops: [Loop; LINES],
    feed: f32,
    silent: bool,
}

impl Tail {
    /// Silent. Allocates.
    pub(super) fn new(room: &RoomSpec, sample_rate: f64) -> Tail {
        let absorption = 0.161 * room.volume() / room.time;
        let size = room.mean_way() / WAYS_MEAN;
        let loops = WAYS.map(|way| {
            let way = size * way;
            let length = (way / SPEED_OF_SOUND * sample_rate) as usize | 1;
            let round = length as f64 / sample_rate;
            Loop {
                samples: vec![0.0; length].into(),
                at: 0,
                keep: 10.0_f64.powf(-3.0 * round / room.time) as f32,
                soft: (1.0 - (-std::f64::consts::TAU * room.soft_hz / sample_rate).exp()) as f32,
                held: 0.0,
            }
        });
        // Of a feed `g` in each line the mean square in a line is `g^2 / (1 - keep^2)`; an ear sums all lines.
        let spread: f64 = loops.iter().map(|line| 1.0 / (1.0 - f64::from(line.keep).powi(2))).sum();
        let feed = (16.0 * std::f64::consts::PI / absorption / spread).sqrt() as f32;
        Tail { loops, feed, silent: true }
    }

    /// Whether nothing is under way.
    pub(super) fn is_silent(&self) -> bool {
        self.silent
    }

    /// Adds the tail of a sound to what is heard left and right.
    pub(super) fn render(&mut self, sound: &[f32], [left, right]: [&mut [f32]; 2]) {
        if self.silent && sound.iter().all(|&x| x == 0.0) {
            return;
        }
        self.silent = false;
        for ((&sound, left), right) in sound.iter().zip(left).zip(right) {
            let mut out = self.loops.each_mut().map(Loop::read);
            for (i, x) in out.iter().enumerate() {
                *left += if i & 1 == 0 { *x } else { -*x };
                *right += if i & 2 == 0 { *x } else { -*x };
            }
            hadamard(&mut out);
            for (line, x) in self.loops.iter_mut().zip(out) {
                line.write(x + self.feed * sound);
            }
        }
    }

    /// Makes silence exact; meant for now and then, on the kit's clock.
    pub(super) fn settle(&mut self) {
        let quiet = |line: &Loop| line.samples.iter().all(|x| x.abs() < SILENCE);
        if !self.silent && self.loops.iter().all(quiet) {
            self.reset();
        }
    }

    /// Silence.
    pub(super) fn reset(&mut self) {
        for line in &mut self.loops {
            line.samples.fill(0.0);
            (line.held, line.at) = (0.0, 0);
        }
        self.silent = true;
    }
}

impl Loop {
    fn read(&mut self) -> f32 {
        self.held += self.soft * (self.samples[self.at] - self.held);
        self.keep * self.held
    }

    fn write(&mut self, x: f32) {
        self.samples[self.at] = x;
        self.at = if self.at + 1 == self.samples.len() { 0 } else { self.at + 1 };
    }
}

/// Mixes eight values and keeps the sum of their squares.
fn hadamard(x: &mut [f32; LINES]) {
    for half in [1, 2, 4] {
        for i in (0..LINES).filter(|i| i & half == 0) {
            (x[i], x[i + half]) = (x[i] + x[i + half], x[i] - x[i + half]);
        }
    }
    x.iter_mut().for_each(|x| *x *= 0.353_553_4);
}

/// A run of silence.
pub(super) const SILENT_RUN: [f32; BLOCK] = [0.0; BLOCK];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tail_is_as_long_and_as_loud_as_sabines_room() {
        const RATE: f64 = 44_100.0;
        let mut tail = Tail::new(&RoomSpec::STANDARD, RATE);
        let (mut heard, mut sent) = (Vec::new(), 0.0);
        // A second of low noise, then silence.
        let (mut draw, mut low) = (1_u32, 0.0_f32);
        for block in 0..2_800 {
            let mut sound = SILENT_RUN;
            for x in &mut sound {
                draw = draw.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                low += 0.1 * ((draw >> 8) as f32 / 8_388_608.0 - 1.0 - low);
                *x = if block < 1_400 { low } else { 0.0 };
                sent += f64::from(*x).powi(2) / 44_800.0;
            }
            let (mut left, mut right) = (SILENT_RUN, SILENT_RUN);
            tail.render(&sound, [&mut left, &mut right]);
            heard.extend(left);
        }
        let square = |range: std::ops::Range<usize>| {
            heard[range.clone()].iter().map(|&x| f64::from(x).powi(2)).sum::<f64>() / range.len() as f64
        };
        let want = 16.0 * std::f64::consts::PI / (0.161 * 126.0 / RoomSpec::STANDARD.time) * sent;
        let level = 10.0 * (square(30_000..44_000) / want).log10();
        assert!(level.abs() < 3.0, "{level} dB");
        let fallen = 10.0 * (square(44_800..47_000) / square(58_000..60_200)).log10();
        let time = 60.0 * 13_200.0 / RATE / fallen;
        assert!((0.4..0.6).contains(&time), "{time} s");
    }

    #[test]
    fn an_image_is_as_far_behind_its_wall_as_the_source_is_before_it() {
        let images = images(&RoomSpec::STANDARD, &[0.5, 1.0, 1.0]);
        assert_eq!(images[2].0, [0.5, -1.0, 1.0]);
        assert!((images[1].0[0] - 6.9).abs() < 1e-12);
    }
}
