//! Pseudo-random numbers.

use std::f64::consts::TAU;
use std::time::{SystemTime, UNIX_EPOCH};

use overhear_engine::strike::{Strike, Striker};

/// Numbers that look drawn by chance and are the same in every run (xorshift64*).
pub struct Chance(u64);

impl Chance {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Chance {
        Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Seeds for a property: fixed ones, and one that is new in every run and is printed; or that of the environment
    /// variable `OVERHEAR_SEED` alone, to repeat a run.
    ///
    /// # Panics
    /// If the variable is not a number.
    pub fn seeds(fixed: &[u64]) -> Vec<u64> {
        if let Ok(text) = std::env::var("OVERHEAR_SEED") {
            return vec![text.parse().expect("OVERHEAR_SEED is a number")];
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64);
        let fresh = now % 1_000_000;
        println!("the fresh seed: OVERHEAR_SEED={fresh} repeats this run");
        fixed.iter().copied().chain([fresh]).collect()
    }

    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// In 0..1, dimensionless.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
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
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() >> 33) as usize % count
    }

    /// One of a list.
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
