//! Where a pair of cymbals rests.

use crate::hi_hat::rim_points::POINTS;

/// Forces and places while nothing moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rest {
    /// `P`, N.
    pub(crate) preload: [f64; POINTS],
    /// What they bend, m.
    pub(crate) bend: [f64; POINTS],
    /// Energy of mounts and contacts then, J.
    pub(crate) energy: f64,
}

impl Rest {
    /// Nothing presses.
    pub(crate) const OPEN: Rest = Rest { preload: [0.0; POINTS], bend: [0.0; POINTS], energy: 0.0 };

    /// A share of the way to another.
    pub(crate) fn toward(&self, other: &Rest, share: f64) -> Rest {
        let mix = |a: f64, b: f64| a + share * (b - a);
        let mix_all = |a: &[f64; POINTS], b: &[f64; POINTS]| std::array::from_fn(|i| mix(a[i], b[i]));
        Rest {
            preload: mix_all(&self.preload, &other.preload),
            bend: mix_all(&self.bend, &other.bend),
            energy: mix(self.energy, other.energy),
        }
    }
}
