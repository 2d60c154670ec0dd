//! How real bodies miss being round: the two modes of a pair are a little apart, about axes of their own.
//!
//! Model: each pair of order `(m, n)` gets a relative detuning and a direction, drawn once from its
//! numbers (the same for every build). A perfect circle would ring without the slow beating that
//! real heads and cymbals have.

use serde::{Deserialize, Serialize};

use crate::mode::Member;
use crate::numbers::{Numbers, Visitor};

/// How much the members of pairs are apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Splitting {
    /// Mean relative difference of the two frequencies, 0 to 0.05.
    pub detuning: f64,
    /// Tells the unevenness of one body from another's.
    pub seed: u32,
}

impl Numbers for Splitting {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("detuning", &mut self.detuning, 0.0..=0.05);
    }
}

impl Splitting {
    /// Perfectly round.
    pub const ROUND: Splitting = Splitting { detuning: 0.0, seed: 0 };
    /// A head tuned by ear at its lugs. *Literature*: 0.3 to 1 %.
    pub const DRUM: Splitting = Splitting { detuning: 0.006, seed: 1 };
    /// A head cleared with care, as timpanists do.
    pub const CLEARED: Splitting = Splitting { detuning: 0.001, seed: 2 };
    /// A hammered cymbal. *Literature*: 0.3 to 1 %.
    pub const CYMBAL: Splitting = Splitting { detuning: 0.006, seed: 3 };

    /// The members of order `(m, n)` and the factor on their frequency.
    pub fn members(&self, m: u32, n: u32) -> impl Iterator<Item = (Member, f64)> + use<> {
        // Between a half and one and a half times the mean, either way round.
        let draw = hash(self.seed, m, n, 0);
        let half =
            0.5 * self.detuning * (0.5 + draw) * if hash(self.seed, m, n, 1) < 0.5 { -1.0 } else { 1.0 };
        let count = if m == 0 { 1 } else { 2 };
        let offset = if m == 0 { [0.0; 2] } else { [half, -half] };
        [Member::Cosine, Member::Sine].into_iter().zip(offset.map(|x| 1.0 + x)).take(count)
    }

    /// Direction of the pair's axes, rad.
    pub fn axis(&self, m: u32, n: u32) -> f64 {
        hash(self.seed, m, n, 2) * std::f64::consts::TAU
    }
}

/// A number in 0..1 that looks drawn by chance (the finalizer of MurmurHash3).
pub fn hash(seed: u32, m: u32, n: u32, what: u32) -> f64 {
    let mut x = u64::from(seed) << 48 ^ u64::from(m) << 32 ^ u64::from(n) << 8 ^ u64::from(what);
    x = (x ^ x >> 33).wrapping_mul(0xff51_afd7_ed55_8ccd);
    x = (x ^ x >> 33).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    x ^= x >> 33;
    (x >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_split_by_the_mean_and_symmetrically() {
        let mut sum = 0.0;
        for m in 1..=40 {
            for n in 1..=20 {
                let factors: Vec<f64> = Splitting::DRUM.members(m, n).map(|(_, factor)| factor).collect();
                assert!((factors[0] + factors[1] - 2.0).abs() < 1e-15);
                sum += (factors[0] - factors[1]).abs();
            }
        }
        assert!((sum / 800.0 / 0.006 - 1.0).abs() < 0.05, "{}", sum / 800.0);
        assert_eq!(Splitting::DRUM.members(0, 3).count(), 1);
        assert!(Splitting::ROUND.members(4, 1).all(|(_, factor)| factor == 1.0));
    }
}
