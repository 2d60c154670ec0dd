//! Gains that follow their targets without a step.

use crate::block::BLOCK;
use crate::slot::SLOTS;

/// Levels at or below this are silence, dB.
pub const SILENT_DB: f64 = -60.0;

/// Highest level, dB.
pub const LOUDEST_DB: f64 = 24.0;

/// Time constant of a level change, s. *By ear*: without zipper noise, without lag.
const LEVEL_TIME: f64 = 0.005;

/// A level (dB) as a gain.
pub(super) fn gain(db: f64) -> f32 {
    let db = db.min(LOUDEST_DB);
    if db <= SILENT_DB { 0.0 } else { 10.0_f64.powf(db / 20.0) as f32 }
}

/// A gain that follows its target exponentially, sample by sample.
///
/// What decays is its distance: a value of its own would stall where the last bits round away what is left to go, some 100 dB
/// below, and a level that was moved would never sound as one that was loaded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gain {
    target: f32,
    /// Where it is, beyond the target.
    distance: f32,
    /// Share of the distance left after a sample.
    keep: f32,
}

/// A gain over the samples of a run.
pub(super) type GainRun = [f32; BLOCK];

/// A gain for every piece over a run.
pub(super) type GainRuns = [GainRun; SLOTS];

impl Gain {
    pub(super) fn new(sample_rate: f64) -> Gain {
        Gain { target: 1.0, distance: 0.0, keep: (-1.0 / (LEVEL_TIME * sample_rate)).exp() as f32 }
    }

    pub(super) fn set(&mut self, gain: f32) {
        self.distance += self.target - gain;
        self.target = gain;
    }

    /// Whether it is zero and its target too.
    pub(super) fn is_shut(&self) -> bool {
        self.target == 0.0 && self.rests()
    }

    /// Whether it has reached its target.
    pub(super) fn rests(&self) -> bool {
        self.distance == 0.0
    }

    /// Advances by a run; its values.
    pub(super) fn run(&mut self, samples: usize) -> GainRun {
        if self.rests() {
            return [self.target; BLOCK];
        }
        let mut out = [0.0; BLOCK];
        for out in &mut out[..samples] {
            self.distance *= self.keep;
            // -140 dB away counts as reached; the last step is inaudible.
            if self.distance.abs() < 1e-7 {
                self.distance = 0.0;
            }
            *out = self.target + self.distance;
        }
        out
    }

    /// Takes its target at once.
    pub(super) fn jump(&mut self) {
        self.distance = 0.0;
    }
}

/// A pan between left and right of constant power.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pan {
    sides: [Gain; 2],
}

impl Pan {
    /// At `side`, -1 (left) to 1 (right).
    pub(super) fn new(sample_rate: f64, side: f64) -> Pan {
        let mut pan = Pan { sides: [Gain::new(sample_rate); 2] };
        pan.set(side);
        pan.jump();
        pan
    }

    pub(super) fn set(&mut self, side: f64) {
        let (sin, cos) = ((side.clamp(-1.0, 1.0) + 1.0) * std::f64::consts::FRAC_PI_4).sin_cos();
        self.sides[0].set(cos as f32);
        self.sides[1].set(sin as f32);
    }

    /// Of a pair, which is at full level in the middle.
    pub(super) fn set_balance(&mut self, side: f64) {
        self.sides[0].set((1.0 - side).clamp(0.0, 1.0) as f32);
        self.sides[1].set((1.0 + side).clamp(0.0, 1.0) as f32);
    }

    /// Whether it has reached its target.
    pub(super) fn rests(&self) -> bool {
        self.sides.iter().all(Gain::rests)
    }

    /// Gains of the left and the right output over a run.
    pub(super) fn run(&mut self, samples: usize) -> [GainRun; 2] {
        self.sides.each_mut().map(|side| side.run(samples))
    }

    /// Takes its target at once.
    pub(super) fn jump(&mut self) {
        self.sides.iter_mut().for_each(Gain::jump);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_that_was_moved_is_where_it_was_sent() {
        for target in [0.0, 0.3, 0.6, 1.0, 3.981] {
            for from in [0.0, 1.0, 15.8] {
                let mut moved = Gain::new(48_000.0);
                moved.set(from);
                moved.jump();
                moved.set(target);
                let longest = (20.0 * LEVEL_TIME * 48_000.0) as usize / BLOCK;
                for _ in 0..longest {
                    moved.run(BLOCK);
                }
                assert!(moved.rests(), "from {from} to {target}");
                assert_eq!(moved.run(BLOCK), [target; BLOCK], "from {from}");
            }
        }
    }

    #[test]
    fn a_gain_goes_on_from_where_it_is() {
        let mut gain = Gain::new(48_000.0);
        gain.set(0.2);
        let mut before = 1.0;
        for (place, target) in [0.2, 0.9, 0.1, 0.5].into_iter().cycle().take(40).enumerate() {
            gain.set(target);
            for value in gain.run(BLOCK) {
                assert!((value - before).abs() < 0.005, "block {place}: {before} to {value}");
                before = value;
            }
        }
    }
}
