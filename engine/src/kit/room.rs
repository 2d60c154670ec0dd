//! The room about the kit: early reflections and a short diffuse tail, for the room microphones.
//!
//! Model: a shoebox. Each of its six surfaces mirrors every piece once (image sources: the ways from the images are
//! [`DelayTap`](super::delay_line::DelayTap)s like any other, weakened by what the surface swallows). What comes after is diffuse: a feedback delay
//! network of eight lines whose lengths have no common divisor, mixed by a Hadamard matrix, which keeps energy, and weakened
//! on each round by what gives the reverberation time, more in the highs. It is fed by what all pieces send
//! out; left and right hear different signs of the same lines.
//!
//! Level of the tail: of a source of power `P` the diffuse field in a room of volume `V` and time `T` has the mean
//! square pressure `4 rho c P / A`, `A = 0.161 V / T` (Sabine); a source heard with `p` at a metre sends out
//! `4 pi p^2 / (rho c)`: `p_diffuse = p sqrt(16 pi / A)`.
//!
//! Source: Kuttruff, Room Acoustics, ch. 4, 5; Jot & Chaigne, AES preprint 3030, 1991.

use crate::air_load::SPEED_OF_SOUND;
use crate::block::BLOCK;
use crate::kit_spec::room::RoomSpec;
use crate::layout::Point;

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
