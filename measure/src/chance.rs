//! Pseudo-random numbers.

use std::f64::consts::TAU;
use std::time::{SystemTime, UNIX_EPOCH};

use fastrand::Rng;
use overhear_engine::strike::{Strike, Striker};

/// The environment variable that chooses a seed.
const SEED_VARIABLE: &str = "OVERHEAR_SEED";

/// Numbers that look drawn by chance and are the same in every run.
pub struct Chance(Rng);

impl Chance {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Chance {
        Chance(Rng::with_seed(seed))
    }

    /// Seeds for a property: fixed ones, and one that is new in every run and is printed; or that of the environment
    /// variable `OVERHEAR_SEED` alone, to repeat a run.
    ///
    /// # Panics
    /// If the variable is not a number.
    pub fn seeds(fixed: &[u64]) -> Vec<u64> {
        let mut seeds = Chance::chosen(fixed);
        if std::env::var(SEED_VARIABLE).is_err() {
            let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64);
            seeds.push(now % 1_000_000);
            println!("the fresh seed: {SEED_VARIABLE}={} repeats this run", now % 1_000_000);
        }
        seeds
    }

    /// The fixed seeds alone, or that of the environment variable `OVERHEAR_SEED`.
    ///
    /// # Panics
    /// If the variable is not a number.
    pub fn chosen(fixed: &[u64]) -> Vec<u64> {
        let asked = std::env::var(SEED_VARIABLE).ok();
        asked.map_or_else(|| fixed.to_vec(), |text| vec![text.parse().expect("OVERHEAR_SEED is a number")])
    }

    /// In 0..1, dimensionless.
    pub fn unit(&mut self) -> f64 {
        self.0.f64()
    }

    /// In `low..high`, in their unit.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// True with this probability, 0 to 1.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// One of the indices below `count`.
    ///
    /// # Panics
    /// If there is none.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.usize(..count)
    }

    /// One of a list.
    ///
    /// # Panics
    /// If it is empty.
    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// Any stroke up to a speed, m/s.
    pub fn stroke(&mut self, fastest: f64) -> Strike {
        Strike {
            speed: self.between(0.0, fastest),
            radius: self.unit(),
            angle: self.between(0.0, TAU),
            striker: self.of(&Striker::ALL),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_its_own_sequence_every_time() {
        let drawn = |seed| -> Vec<u64> {
            let mut chance = Chance::new(seed);
            (0..100).map(|_| chance.unit().to_bits()).collect()
        };
        assert_eq!(drawn(1), drawn(1));
        assert_ne!(drawn(1), drawn(2));
    }

    #[test]
    fn numbers_are_spread_evenly_over_their_range() {
        let mut chance = Chance::new(7);
        let all: Vec<f64> = (0..100_000).map(|_| chance.between(-1.0, 3.0)).collect();
        assert!(all.iter().all(|x| (-1.0..3.0).contains(x)));
        let mean = all.iter().sum::<f64>() / 1e5;
        let variance = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1e5;
        assert!((mean - 1.0).abs() < 0.02 && (variance - 16.0 / 12.0).abs() < 0.02, "{mean} {variance}");
        let share = (0..10_000).filter(|_| chance.happens(0.2)).count();
        assert!((1850..2150).contains(&share), "{share}");
        let counts = (0..10_000).fold([0; 4], |mut counts, _| {
            counts[chance.below(4)] += 1;
            counts
        });
        assert!(counts.iter().all(|count| (2300..2700).contains(count)), "{counts:?}");
    }
}
