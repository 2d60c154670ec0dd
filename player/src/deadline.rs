//! Whether buffers are ready in time.
//!
//! A buffer of `n` frames must be ready within `n / rate` seconds, or the host has nothing to play. The whole of a
//! host's call is measured, the framework's share included. What is found is shared with whoever asks, and
//! nothing is ever done about it in secret: see the rules in `docs/performance.md`.
//!
//! The clock is the monotonic one of the standard library. On Linux it is read in the process itself (the kernel maps
//! it in), on macOS and Windows from a register: no system call, which a test holds it to. Linux machines whose clock
//! cannot be mapped (`hpet`, `acpi_pm`) make one.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// What one instance's buffers took. Times are those of the audio thread; any thread may ask.
#[derive(Debug, Default)]
pub struct Deadlines {
    /// Bits of the sample rate, Hz; 0 where nobody waits.
    rate: AtomicU64,
    met: AtomicU64,
    late: AtomicU64,
    /// Bits of the largest share of a deadline that a buffer took.
    worst: AtomicU32,
}

impl Deadlines {
    /// Buffers are awaited at a sample rate (Hz) from now on, or not at all: while a file is rendered. Starts anew.
    pub fn expect(&self, sample_rate: Option<f64>) {
        self.rate.store(sample_rate.unwrap_or(0.0).to_bits(), Ordering::Relaxed);
        self.met.store(0, Ordering::Relaxed);
        self.late.store(0, Ordering::Relaxed);
        self.worst.store(0, Ordering::Relaxed);
    }

    /// Does the work of a buffer of so many frames, and notes how long it took.
    ///
    /// # Real-time
    /// No allocation, no lock; two looks at the clock.
    pub fn timed<T>(&self, frames: usize, work: impl FnOnce() -> T) -> T {
        let rate = f64::from_bits(self.rate.load(Ordering::Relaxed));
        if rate <= 0.0 || frames == 0 {
            return work();
        }
        let begun = Instant::now();
        let done = work();
        self.note(begun.elapsed(), frames as f64 / rate);
        done
    }

    fn note(&self, took: Duration, deadline: f64) {
        let share = (took.as_secs_f64() / deadline) as f32;
        let count = if share > 1.0 { &self.late } else { &self.met };
        count.fetch_add(1, Ordering::Relaxed);
        // Bits of positive numbers are ordered as the numbers are.
        self.worst.fetch_max(share.to_bits(), Ordering::Relaxed);
    }

    /// Buffers that were ready too late.
    pub fn late(&self) -> u64 {
        self.late.load(Ordering::Relaxed)
    }

    /// All buffers that were awaited.
    pub fn buffers(&self) -> u64 {
        self.met.load(Ordering::Relaxed) + self.late()
    }

    /// The largest share of its deadline that a buffer took.
    pub fn worst_share(&self) -> f32 {
        f32::from_bits(self.worst.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_that_takes_longer_than_it_lasts_is_late_and_counted() {
        let deadlines = Deadlines::default();
        deadlines.expect(Some(48_000.0));
        // 48 frames last a millisecond, 96,000 two seconds.
        deadlines.timed(48, || std::thread::sleep(Duration::from_millis(3)));
        assert_eq!((deadlines.late(), deadlines.buffers()), (1, 1));
        assert!(deadlines.worst_share() >= 3.0, "{}", deadlines.worst_share());
        deadlines.timed(96_000, || ());
        assert_eq!((deadlines.late(), deadlines.buffers()), (1, 2));
    }

    #[test]
    fn nobody_waits_for_a_bounce() {
        let deadlines = Deadlines::default();
        deadlines.expect(None);
        deadlines.timed(1, || std::thread::sleep(Duration::from_millis(1)));
        assert_eq!(deadlines.buffers(), 0);
        deadlines.expect(Some(48_000.0));
        deadlines.timed(1, || std::thread::sleep(Duration::from_millis(1)));
        deadlines.expect(Some(44_100.0));
        assert_eq!((deadlines.late(), deadlines.buffers()), (0, 0));
    }
}
