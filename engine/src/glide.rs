//! A control value that glides to where it is asked to be, on the kit's clock.

/// Time constant of the glide, s. *By ear*: short enough to feel at once, long enough not to click.
const TIME_CONSTANT: f64 = 0.005;

/// Where a glide is closer to its aim than this share of it, it is there.
const ARRIVED: f64 = 1e-6;

/// An exponential glide sampled once a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glide {
    value: f64,
    target: f64,
    min: f64,
    max: f64,
}

impl Glide {
    /// At rest at `value`, within `min..=max`.
    pub fn new(value: f64, min: f64, max: f64) -> Glide {
        Glide { value, target: value, min, max }
    }

    /// Where it is.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Asks for a value; clamped to the range, a NaN is ignored.
    pub fn set(&mut self, target: f64) {
        if !target.is_nan() {
            self.target = target.clamp(self.min, self.max);
        }
    }

    /// Goes there at once; true if that changed the value.
    pub fn jump(&mut self) -> bool {
        let moved = self.value != self.target;
        self.value = self.target;
        moved
    }

    /// Lets `seconds` pass; true if the value changed.
    pub fn advance(&mut self, seconds: f64) -> bool {
        if self.value == self.target {
            return false;
        }
        self.value = self.target + (self.value - self.target) * (-seconds / TIME_CONSTANT).exp();
        if (self.value - self.target).abs() < ARRIVED * self.target.abs().max(ARRIVED * self.max) {
            self.value = self.target;
        }
        true
    }
}
