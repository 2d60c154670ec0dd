//! Static equilibrium of a pair of cymbals.

use crate::hi_hat::rim_points::POINTS;

/// Forces and deflections in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rest {
    /// `P`, N.
    pub(crate) preload: [f64; POINTS],
    /// Deflection by them, m.
    pub(crate) bend: [f64; POINTS],
    /// Energy of mounts and contacts, J.
    pub(crate) energy: f64,
}

impl Rest {
    /// Rims apart.
    pub(crate) const OPEN: Rest = Rest { preload: [0.0; POINTS], bend: [0.0; POINTS], energy: 0.0 };

    /// Interpolation to another equilibrium.
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
