//! Cubic interpolation in a table at even steps: Lagrange's polynomial through four neighbours.
//!
//! Limits: at either end of the table the four are not centred, and the error is some ten times larger.

/// Four neighbours in a table and their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stencil {
    /// The first of them.
    pub first: usize,
    /// Weights; they add to one.
    pub weights: [f64; 4],
}

impl Stencil {
    /// For the place `x` (in steps, held within the table) of a table of `length` entries, at least 4.
    pub fn at(x: f64, length: usize) -> Stencil {
        let x = x.clamp(0.0, (length - 1) as f64);
        let first = (x.floor() as usize).saturating_sub(1).min(length - 4);
        let t = x - first as f64;
        // Lagrange through the points 0, 1, 2, 3.
        let weights = [
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        ];
        Stencil { first, weights }
    }

    /// The value between, `value(i)` being the table's.
    pub fn blend(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.blend_all(std::array::from_fn(|i| value(self.first + i)))
    }

    /// The share between, `share(i)` being the table's, 0 to 1: a cubic through shares that change from one entry to the next
    /// swings beyond them.
    pub fn blend_shares(&self, share: impl Fn(usize) -> f64) -> f64 {
        self.blend(share).clamp(0.0, 1.0)
    }

    /// The value between, given the four.
    #[inline(always)]
    pub fn blend_all(&self, values: [f64; 4]) -> f64 {
        self.weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_met_anywhere_and_the_ends_are_held() {
        let cubic = |x: f64| 1.0 + x * (2.0 - x * (0.3 - 0.01 * x));
        for i in 0..=90 {
            let x = f64::from(i) / 10.0;
            assert!((Stencil::at(x, 10).blend(|i| cubic(i as f64)) - cubic(x)).abs() < 1e-12);
        }
        // A share that is taken over at once.
        let taken = |i: usize| if i < 2 { 0.0 } else { 1.0 };
        assert!(Stencil::at(0.5, 4).blend(taken) < -0.05);
        assert_eq!(Stencil::at(0.5, 4).blend_shares(taken), 0.0);
        assert_eq!(Stencil::at(2.5, 4).blend_shares(taken), 1.0);
        assert_eq!(Stencil::at(-3.0, 4).blend(|i| i as f64), 0.0);
        assert_eq!(Stencil::at(9.0, 4).blend(|i| i as f64), 3.0);
    }
}
