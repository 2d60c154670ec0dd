//! What the machine could do at most, beside what the kit does with it.

use cpu_time::ThreadTime;
use overhear_engine::modal::simd::Kernels;
use overhear_engine::piece::Piece;
use serde::Serialize;

/// Multiplications with an addition that a mode takes a sample as it rings: its rotation (4), two receivers (2 each).
const PER_MODE: f64 = 8.0;

/// Passes of one measurement, and measurements; the quickest counts.
const PASSES: usize = 2_000_000;
const TRIES: usize = 5;

/// The limit, and how much of it a kit takes whose every mode just rings.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Limit {
    /// `f32` multiplications with an addition, 1/s, on one core, in the instruction set in use.
    pub multiply_adds_per_s: f64,
    /// Modes of the whole kit.
    pub modes: usize,
    /// Share of the limit that all of them take as they ring.
    pub ringing_share: f64,
}

impl Limit {
    /// Measures the machine, counts the modes of a kit at a sample rate in Hz.
    pub fn measure(kit: &[Piece], rate: f64) -> Limit {
        let kernels = Kernels::detect();
        let once = || {
            let start = ThreadTime::now();
            let (count, result) = kernels.multiply_and_add(PASSES, std::hint::black_box(0.5));
            std::hint::black_box(result);
            count / start.elapsed().as_secs_f64()
        };
        let multiply_adds_per_s = (0..TRIES).map(|_| once()).fold(0.0, f64::max);
        let modes = kit.iter().map(|piece| piece.modes().len()).sum();
        let ringing_share = PER_MODE * modes as f64 * rate / multiply_adds_per_s;
        Limit { multiply_adds_per_s, modes, ringing_share }
    }
}
