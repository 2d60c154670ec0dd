//! Gains that follow their targets without a step.

/// Levels at or below this are silence, dB.
pub const SILENT_DB: f64 = -60.0;

/// Highest level, dB.
pub const LOUDEST_DB: f64 = 24.0;

/// Time constant of a level change, s. *By ear*: without zipper noise, without lag.
const LEVEL_TIME: f64 = 0.005;

/// A gain that follows its target exponentially, sample by sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gain {
    value: f32,
    target: f32,
    /// Share of the way left after a sample.
    keep: f32,
}

impl Gain {
    pub(super) fn new(sample_rate: f64) -> Gain {
        Gain { value: 1.0, target: 1.0, keep: (-1.0 / (LEVEL_TIME * sample_rate)).exp() as f32 }
    }

    pub(super) fn set_db(&mut self, db: f64) {
        let db = db.min(LOUDEST_DB);
        self.target = if db <= SILENT_DB { 0.0 } else { 10.0_f64.powf(db / 20.0) as f32 };
    }

    pub(super) fn next(&mut self) -> f32 {
        if self.value != self.target {
            self.value = self.target + (self.value - self.target) * self.keep;
            // -140 dB away is there; the last step cannot be heard.
            if (self.value - self.target).abs() < 1e-7 {
                self.value = self.target;
            }
        }
        self.value
    }

    /// Arrives at once.
    pub(super) fn jump(&mut self) {
        self.value = self.target;
    }
}

/// A place between left and right, constant in power.
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
        (self.sides[0].target, self.sides[1].target) = (cos as f32, sin as f32);
    }

    /// Gains of the left and the right output.
    pub(super) fn next(&mut self) -> [f32; 2] {
        [self.sides[0].next(), self.sides[1].next()]
    }

    /// Arrives at once.
    pub(super) fn jump(&mut self) {
        self.sides.iter_mut().for_each(Gain::jump);
    }
}
