//! How the frequencies of slices move: by the random walk of their phases, and with the head's tension.
//!
//! Model: the sum of many modes spread over a width `w` (rad/s) loses the phase that a stroke gave all of them within some `1 / w`. A
//! single mode does the same if its frequency is shifted by `s` up or down, by a new random sign after every interval `T`: its phase
//! walks with the diffusion `D = s^2 T / 2`, and its line becomes a Lorentzian of half width `D` at half power. Turning a mode costs no energy.
//! In a window longer than `1 / D` lines that overlap so are noise, as those of the real modes are.

use fastrand::Rng;

use crate::block::BLOCK;
use crate::modal::simd::Kernels;
use crate::modal::{Row, zero_row};

/// Time for which a slice is shifted to one side, s: a block of 44.1 kHz. At its multiples the phases take the same course.
const INTERVAL: f64 = 32.0 / 44_100.0;

/// Signs drawn at once.
const SIGNS: usize = 32;

/// The walk of so many slices.
pub(super) struct Walk {
    /// Shift to either side, rad/s, `[slice]`.
    hops: Row,
    /// Rise of each slice's frequency per tension that is added to the head's, rad/s over N/m.
    rises: Row,
    /// Shifts of the present block, rad/s, `[slice]`.
    shifts: Row,
    /// Draws a seed for each interval.
    seeds: Rng,
    seed: u64,
    /// Draws the signs of the present interval.
    signs: u64,
    /// Blocks of an interval, and how many of the present one are over.
    blocks: u32,
    done: u32,
}

impl Walk {
    /// Phases that stay; the seed tells heads apart, the sample rate is in Hz. Allocates.
    pub(super) fn new(slices: usize, seed: u32, sample_rate: f64) -> Walk {
        let blocks = (INTERVAL * sample_rate / BLOCK as f64).round().max(1.0) as u32;
        let seed = u64::from(seed);
        let [hops, rises, shifts] = std::array::from_fn(|_| zero_row(slices));
        Walk { hops, rises, shifts, seeds: Rng::with_seed(seed), seed, signs: 0, blocks, done: 0 }
    }

    /// Sets the diffusion (1/s) of a slice's phase, and the rise of its frequency per tension that is added to the head's (rad/s over N/m).
    pub(super) fn set(&mut self, slice: usize, diffusion: f64, rise: f64) {
        self.rises[slice] = rise as f32;
        self.hops[slice] = (2.0 * diffusion / INTERVAL).sqrt() as f32;
    }

    /// Begins anew, as after a reset.
    pub(super) fn reset(&mut self) {
        (self.seeds, self.done) = (Rng::with_seed(self.seed), 0);
    }

    /// Shifts of the next block, rad/s: a step of the walk, and what a tension does that is added to the head's, N/m.
    ///
    /// # Real-time
    /// Linear in the number of slices.
    pub(super) fn step(&mut self, kernels: Kernels, added: f32) -> &[f32] {
        if self.done == 0 {
            self.signs = self.seeds.u64(..);
        }
        self.done = (self.done + 1) % self.blocks;
        let mut signs = Rng::with_seed(self.signs);
        let Walk { hops, rises, shifts, .. } = self;
        kernels.vectorized(
            #[inline(always)]
            || {
                let rows = hops.chunks(SIGNS).zip(rises.chunks(SIGNS));
                for (shifts, (hops, rises)) in shifts.chunks_mut(SIGNS).zip(rows) {
                    let bits = signs.u32(..);
                    for (i, (shift, (hop, rise))) in shifts.iter_mut().zip(hops.iter().zip(rises)).enumerate()
                    {
                        *shift = added * rise + f32::from_bits(hop.to_bits() ^ (bits >> i << 31));
                    }
                }
            },
        );
        &self.shifts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLICES: usize = 2048;

    /// Phases after so many blocks at a rate, rad.
    fn phases(walk: &mut Walk, rate: f64, blocks: usize) -> Vec<f64> {
        let mut phases = vec![0.0; SLICES];
        for _ in 0..blocks {
            let shifts = walk.step(Kernels::detect(), 0.0);
            let turned = shifts.iter().map(|shift| f64::from(*shift) * BLOCK as f64 / rate);
            phases.iter_mut().zip(turned).for_each(|(phase, turn)| *phase += turn);
        }
        phases
    }

    fn walk(rate: f64) -> Walk {
        let mut walk = Walk::new(SLICES, 7, rate);
        (0..SLICES).for_each(|slice| walk.set(slice, 10.0, 0.0));
        walk
    }

    #[test]
    fn phases_spread_by_twice_the_diffusion_times_the_time_at_every_rate() {
        for (rate, blocks) in [(44_100.0, 200), (88_200.0, 400), (176_400.0, 800)] {
            let phases = phases(&mut walk(rate), rate, blocks);
            let square = phases.iter().map(|phase| phase * phase).sum::<f64>() / SLICES as f64;
            let expected = 2.0 * 10.0 * (blocks * BLOCK) as f64 / rate;
            assert!((square / expected - 1.0).abs() < 0.1, "{rate}: {square} for {expected}");
        }
    }

    #[test]
    fn a_walk_that_begins_anew_takes_the_same_course_and_another_head_another() {
        let mut walk = walk(44_100.0);
        let first = phases(&mut walk, 44_100.0, 9);
        walk.reset();
        assert_eq!(first, phases(&mut walk, 44_100.0, 9));
        let mut other = Walk::new(SLICES, 8, 44_100.0);
        (0..SLICES).for_each(|slice| other.set(slice, 10.0, 0.0));
        assert_ne!(first, phases(&mut other, 44_100.0, 9));
    }
}
