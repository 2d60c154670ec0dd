//! Steps and impulses of the sound where the modes change, spread over some blocks.
//!
//! Modes that change keep their displacement and velocity. What is heard are their accelerations, which step: by twice the
//! change of the frequency. The height of the step is added to the sound and taken back along a straight line until the
//! modes may change again, so that a pitch that glides in steps is heard without them.
//!
//! Limits: other pieces receive the smoothed sound too. What is added to it belongs to no mode. While a piece is retuned, the
//! exchange of energy between pieces is not shown to be passive.

use super::{Pressure, RECEIVERS};
use crate::block::{BLOCK, FOLLOWED};

/// Samples over which a step is taken back.
const SPREAD: usize = FOLLOWED * BLOCK;

/// What is still to be taken back.
#[derive(Debug, Clone, Copy, Default)]
pub struct Smoothing {
    /// Pressure added to the present sample at each receiver, and how much less it is in the next, Pa.
    added: Pressure,
    slope: Pressure,
    /// Pressure of impulses at each receiver, Pa, the same in every sample.
    held: Pressure,
    /// Samples until nothing is left of the steps, and of the impulses.
    left: usize,
    held_left: usize,
}

impl Smoothing {
    /// The pressure at each receiver (Pa) has changed between two samples.
    pub fn step(&mut self, before: Pressure, after: Pressure) {
        if before == after {
            return;
        }
        for i in 0..RECEIVERS {
            self.added[i] += before[i] - after[i];
            self.slope[i] = self.added[i] / SPREAD as f32;
        }
        self.left = SPREAD;
    }

    /// Velocities have changed by impulses: their pressure at each receiver (Pa) is added throughout a block. Called at its
    /// beginning.
    pub fn hold(&mut self, impulse: Pressure) {
        self.held = impulse;
        self.held_left = BLOCK;
    }

    /// Whether nothing is left.
    pub fn is_over(&self) -> bool {
        self.left == 0 && self.held_left == 0
    }

    /// Adds what is left to the next samples.
    pub fn add_to(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        let (stepped, held) = (out[0].len().min(self.left), out[0].len().min(self.held_left));
        if stepped > 0 {
            for (out, (added, slope)) in out.iter_mut().zip(self.added.iter_mut().zip(&self.slope)) {
                for out in &mut out[..stepped] {
                    *out += *added;
                    *added -= slope;
                }
            }
            self.left -= stepped;
            if self.left == 0 {
                (self.added, self.slope) = Default::default();
            }
        }
        if held > 0 {
            for (out, impulse) in out.iter_mut().zip(&self.held) {
                out[..held].iter_mut().for_each(|out| *out += impulse);
            }
            self.held_left -= held;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impulse_is_held_for_a_block_however_time_is_cut() {
        let held = |run: usize| {
            let mut smoothing = Smoothing::default();
            smoothing.hold([1.0, 0.0, 0.5, 0.0]);
            let mut rows = [[0.0_f32; 2 * BLOCK]; RECEIVERS];
            for from in (0..2 * BLOCK).step_by(run) {
                let to = (from + run).min(2 * BLOCK);
                smoothing.add_to(&mut rows.each_mut().map(|row| &mut row[from..to]));
            }
            rows
        };
        let rows = held(2 * BLOCK);
        assert!(rows[0][..BLOCK].iter().all(|&x| x == 1.0) && rows[0][BLOCK..].iter().all(|&x| x == 0.0));
        assert_eq!(held(5), rows);
    }

    #[test]
    fn a_step_becomes_a_line_however_time_is_cut() {
        let smoothed = |run: usize| {
            let mut smoothing = Smoothing::default();
            smoothing.step([1.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0]);
            let mut rows = [[0.0_f32; 2 * SPREAD]; RECEIVERS];
            for from in (0..2 * SPREAD).step_by(run) {
                let to = (from + run).min(2 * SPREAD);
                smoothing.add_to(&mut rows.each_mut().map(|row| &mut row[from..to]));
            }
            rows
        };
        let rows = smoothed(2 * SPREAD);
        for (i, (first, second)) in rows[0].iter().zip(&rows[1]).enumerate().take(SPREAD) {
            let left = 1.0 - i as f32 / SPREAD as f32;
            assert!((first - left).abs() < 1e-5 && (second + 2.0 * left).abs() < 1e-5);
        }
        assert!(rows.iter().all(|row| row[SPREAD..].iter().all(|&x| x == 0.0)));
        assert_eq!(smoothed(5), rows);
    }
}
