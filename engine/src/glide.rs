//! A control value that glides to where it is asked to be, on the kit's clock.

/// Time constant of the glide, s. *Measured*: at 5 ms a kick let down to its lowest pitch while it rings
/// clicks (8 dB steeper than the sound itself), at 10 ms nothing does.
const TIME_CONSTANT: f64 = 0.010;

/// Where a glide is closer to its aim than this share of it, it is there.
const ARRIVED: f64 = 1e-6;

/// A glide sampled once a block: two exponential ones in a row, so that it starts and ends softly. One
/// alone would take a seventh of the way in its first block, which is heard as a click.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glide {
    value: f64,
    /// What the value follows; follows the target.
    lead: f64,
    target: f64,
    min: f64,
    max: f64,
    /// Where it is as close as this to its aim it is there, if that is more than [`ARRIVED`].
    within: f64,
}

impl Glide {
    /// At rest at `value`, within `min..=max`, in units of the caller.
    pub fn new(value: f64, min: f64, max: f64) -> Glide {
        Glide { value, lead: value, target: value, min, max, within: 0.0 }
    }

    /// Arrives as soon as it is as close as `within`, in units of the caller.
    pub fn arriving_within(self, within: f64) -> Glide {
        Glide { within, ..self }
    }

    /// Where it is, in units of the caller.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Asks for a value, in units of the caller; clamped to the range, a NaN is ignored. It is there at once if it is as good as
    /// there already; true if that changed the value.
    pub fn set(&mut self, target: f64) -> bool {
        if target.is_nan() {
            return false;
        }
        self.target = target.clamp(self.min, self.max);
        self.is_close() && self.jump()
    }

    /// Whether it has as good as arrived.
    fn is_close(&self) -> bool {
        let close = (ARRIVED * self.target.abs().max(ARRIVED * self.max)).max(self.within);
        (self.value - self.target).abs() < close && (self.lead - self.target).abs() < close
    }

    /// Goes there at once; true if that changed the value.
    pub fn jump(&mut self) -> bool {
        let moved = self.value != self.target;
        self.value = self.target;
        self.lead = self.target;
        moved
    }

    /// Lets `seconds` pass; true if the value changed.
    pub fn advance(&mut self, seconds: f64) -> bool {
        if self.value == self.target && self.lead == self.target {
            return false;
        }
        let time = seconds / TIME_CONSTANT;
        let left = (-time).exp();
        let (value, lead) = (self.value - self.target, self.lead - self.target);
        self.value = self.target + (value + lead * time) * left;
        self.lead = self.target + lead * left;
        if self.is_close() {
            (self.value, self.lead) = (self.target, self.target);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glide_arrives_and_does_not_depend_on_how_time_is_cut() {
        let (mut whole, mut cut) = (Glide::new(1.0, 0.0, 2.0), Glide::new(1.0, 0.0, 2.0));
        whole.set(5.0);
        cut.set(5.0);
        whole.advance(0.004);
        (0..4).for_each(|_| assert!(cut.advance(0.001)));
        assert!((whole.value() - cut.value()).abs() < 1e-14);
        assert!((whole.value() - (2.0 - 1.4 * f64::exp(-0.4))).abs() < 1e-14);
        while whole.advance(0.001) {}
        assert_eq!(whole.value(), 2.0);
        whole.set(f64::NAN);
        assert!(!whole.advance(1.0));
    }

    #[test]
    fn what_differs_by_a_rounding_is_there_at_once() {
        let mut glide = Glide::new(0.3, 0.0, 1.0);
        assert!(!glide.set(0.3) && glide.set(f64::from(0.3_f32)));
        assert_eq!(glide.value(), f64::from(0.3_f32));
        assert!(!glide.advance(0.001));
        // Nor if something else was asked for in between, but not while it moves.
        assert!(!glide.set(0.5) && glide.set(0.3) && !glide.advance(0.001));
        glide.set(0.5);
        glide.advance(0.001);
        let value = glide.value();
        assert!(!glide.set(value) && glide.advance(0.001));
    }

    #[test]
    fn a_glide_starts_softly() {
        let mut glide = Glide::new(0.0, 0.0, 1.0);
        glide.set(1.0);
        let block = 32.0 / 44_100.0;
        let mut steps = (0..200).map(|_| {
            let before = glide.value();
            glide.advance(block);
            glide.value() - before
        });
        assert!(steps.next().unwrap() < 0.01);
        assert!(steps.all(|step| step < 0.028));
    }
}
