//! Patch factors: what a disc pressed on a membrane feels of its waves.

use crate::strike::Striker;

/// Share of a wave of wavenumber `k` that a tip of radius `b` feels, `x = k b`: `2 J_1(x) / x`.
pub fn pressed_share(x: f64) -> f64 {
    if x < 1e-3 { 1.0 - x * x / 8.0 } else { 2.0 * libm::j1(x) / x }
}

/// What discs feel of each of many waves, worked out beforehand for some of them and blended between: a stroke has no
/// time for Bessel functions.
#[derive(Debug, Clone, Default)]
pub struct PatchFactors {
    /// Radii, ascending, and the share of every wave that a disc of that size feels.
    discs: Vec<(f64, Vec<f64>)>,
}

/// Radii of discs that are worked out beforehand, m: from the smallest to the largest that heads wrap themselves into, the
/// share between two known to 0.01 of waves that are felt much.
fn ladder() -> impl Iterator<Item = f64> {
    (0..LADDER).map(|i| 0.5e-3 * (f64::from(i) / 6.0).exp2())
}

/// Up to 40 mm.
const LADDER: i32 = 39;

impl PatchFactors {
    /// For every striker's own disc and a ladder of others, in units of `unit` (m); `share` of a disc, `[wave]`. Allocates.
    pub fn new(unit: f64, share: impl Fn(f64) -> Vec<f64>) -> PatchFactors {
        let radii = Striker::patches().chain(ladder()).map(|radius| radius / unit);
        let mut discs: Vec<(f64, Vec<f64>)> = radii.map(|disc| (disc, share(disc))).collect();
        discs.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        PatchFactors { discs }
    }

    /// The shares of a disc, unless it is smaller or larger than all that are known.
    pub fn of(&self, disc: f64) -> Option<Shares<'_>> {
        let above = self.discs.partition_point(|(known, _)| *known < disc);
        let (size, upper) = self.discs.get(above)?;
        if *size == disc {
            return Some(Shares { lower: upper, upper, toward: 0.0 });
        }
        let (smaller, lower) = self.discs.get(above.checked_sub(1)?)?;
        Some(Shares { lower, upper, toward: (disc - smaller) / (size - smaller) })
    }
}

/// The shares of one disc.
#[derive(Debug, Clone, Copy)]
pub struct Shares<'a> {
    lower: &'a [f64],
    upper: &'a [f64],
    /// How far from the one toward the other, 0 to 1.
    toward: f64,
}

impl Shares<'_> {
    /// That of the `k`th wave, dimensionless.
    pub fn get(&self, k: usize) -> f64 {
        self.lower[k] + self.toward * (self.upper[k] - self.lower[k])
    }
}
