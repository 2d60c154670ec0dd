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
#[derive(Debug, Clone, Copy)]
pub(super) struct Gain {
    value: f32,
    target: f32,
    /// Share of the difference left after a sample.
    keep: f32,
}

/// A gain over the samples of a run.
pub(super) type GainRun = [f32; BLOCK];

/// A gain for every piece over a run.
pub(super) type GainRuns = [GainRun; SLOTS];

impl Gain {
    pub(super) fn new(sample_rate: f64) -> Gain {
        Gain { value: 1.0, target: 1.0, keep: (-1.0 / (LEVEL_TIME * sample_rate)).exp() as f32 }
    }

    pub(super) fn set(&mut self, gain: f32) {
        self.target = gain;
    }

    /// Whether it is zero and its target too.
    pub(super) fn is_shut(&self) -> bool {
        self.value == 0.0 && self.target == 0.0
    }

    /// Whether it has reached its target.
    pub(super) fn rests(&self) -> bool {
        self.value == self.target
    }

    /// Advances by a run; its values.
    pub(super) fn run(&mut self, samples: usize) -> GainRun {
        if self.value == self.target {
            return [self.value; BLOCK];
        }
        let mut out = [0.0; BLOCK];
        for out in &mut out[..samples] {
            self.value = self.target + (self.value - self.target) * self.keep;
            // -140 dB away counts as reached; the last step is inaudible.
            if (self.value - self.target).abs() < 1e-7 {
                self.value = self.target;
            }
            *out = self.value;
        }
        out
    }

    /// Takes its target at once.
    pub(super) fn jump(&mut self) {
        self.value = self.target;
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
