//! The calibration loop: what a cost is measured in.
//!
//! 4,096 `f32` (16 KiB, within the first cache) starting at .5, `x = x * 0.9999 + 1e-4` over all of them, 2^18
//! passes: 2^30 multiplications and additions, compiled for the baseline of the architecture like the rest of
//! this program.

use std::hint::black_box;

use cpu_time::ThreadTime;

/// Numbers it goes over.
const LENGTH: usize = 4096;

/// Passes of the whole loop.
const PASSES: u32 = 1 << 18;

/// Slices the whole loop is cut into.
pub const SLICES: u32 = 64;

/// The loop, ready to run slice by slice.
pub struct Calibration {
    numbers: Vec<f32>,
}

impl Default for Calibration {
    fn default() -> Calibration {
        Calibration::new()
    }
}

impl Calibration {
    /// At its beginning.
    pub fn new() -> Calibration {
        Calibration { numbers: black_box(vec![0.5; LENGTH]) }
    }

    /// Runs one slice; CPU time it took, s.
    pub fn slice(&mut self) -> f64 {
        let start = ThreadTime::now();
        let (factor, step) = (black_box(0.9999_f32), black_box(1e-4_f32));
        for _ in 0..PASSES / SLICES {
            for x in &mut self.numbers {
                *x = *x * factor + step;
            }
            black_box(&mut self.numbers);
        }
        start.elapsed().as_secs_f64()
    }
}
