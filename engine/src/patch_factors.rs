//! Patch factors: what a disc pressed on a membrane feels of its waves.

use crate::strike::Striker;

/// Share of a wave of wavenumber `k` that a tip of radius `b` feels, `x = k b`: `2 J_1(x) / x`.
pub fn pressed_share(x: f64) -> f64 {
    if x < 1e-3 { 1.0 - x * x / 8.0 } else { 2.0 * libm::j1(x) / x }
}

/// What strikers' discs feel of each of many waves, worked out beforehand: a stroke has no time for Bessel functions.
#[derive(Debug, Clone, Default)]
pub struct PatchFactors {
    /// Radii, and the share of every wave that a disc of that size feels, dimensionless.
    discs: Vec<(f64, Vec<f64>)>,
}

impl PatchFactors {
    /// For every striker's discs, in units of `unit` (m); `share` of a disc, `[wave]`. Allocates.
    pub fn new(unit: f64, share: impl Fn(f64) -> Vec<f64>) -> PatchFactors {
        PatchFactors {
            discs: Striker::patches().map(|radius| radius / unit).map(|disc| (disc, share(disc))).collect(),
        }
    }

    /// The shares of a disc, `[wave]`, if it is one of those.
    pub fn of(&self, disc: f64) -> Option<&[f64]> {
        self.discs.iter().find(|(known, _)| *known == disc).map(|(_, shares)| &shares[..])
    }
}
