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

use crate::workers::Deadline;

/// The share of a buffer's time during which the audio thread waits for workers. *A judgement*, not derived: the
/// rest is for the runs still to be rendered and for the mix.
const WAITING_SHARE: f64 = 0.75;

/// What one instance's buffers took. Times are those of the audio thread; any thread may ask.
#[derive(Debug)]
pub struct Deadlines {
    /// What times are counted from.
    epoch: Instant,
    /// When the audio thread waits no longer for workers in the present buffer, ns since the epoch; 0 between buffers.
    until: AtomicU64,
    /// Bits of the sample rate, Hz; 0 where there is no deadline.
    rate: AtomicU64,
    met: AtomicU64,
    late: AtomicU64,
    /// Bits of the largest share of a deadline that a buffer took.
    worst: AtomicU32,
}

impl Default for Deadlines {
    fn default() -> Deadlines {
        Deadlines {
            epoch: Instant::now(),
            until: AtomicU64::new(0),
            rate: AtomicU64::new(0),
            met: AtomicU64::new(0),
            late: AtomicU64::new(0),
            worst: AtomicU32::new(0),
        }
    }
}

impl Deadline for Deadlines {
    fn is_over(&self) -> bool {
        let until = self.until.load(Ordering::Relaxed);
        // Outside of a buffer there is none.
        until > 0 && nanoseconds(self.epoch.elapsed()) >= until
    }
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
        let done = self.waiting_until(begun, frames as f64 / rate, work);
        self.note(begun.elapsed(), frames as f64 / rate);
        done
    }

    /// Does the work of so many frames within a deadline for workers: that of the host's buffer, if it is
    /// [timed](Self::timed), or one of its own.
    ///
    /// # Real-time
    /// No allocation, no lock; a look at the clock at most.
    pub fn bounded<T>(&self, frames: usize, work: impl FnOnce() -> T) -> T {
        let rate = f64::from_bits(self.rate.load(Ordering::Relaxed));
        if rate <= 0.0 || frames == 0 || self.until.load(Ordering::Relaxed) > 0 {
            return work();
        }
        self.waiting_until(Instant::now(), frames as f64 / rate, work)
    }

    /// Does work that began then and may take so long, s.
    fn waiting_until<T>(&self, begun: Instant, length: f64, work: impl FnOnce() -> T) -> T {
        let begun = nanoseconds(begun.saturating_duration_since(self.epoch));
        self.until.store((begun + (1e9 * WAITING_SHARE * length) as u64).max(1), Ordering::Relaxed);
        let done = work();
        self.until.store(0, Ordering::Relaxed);
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

/// A time as a whole number; enough for five centuries.
fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
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
    fn workers_are_waited_for_within_three_quarters_of_the_buffer_and_only_within_one() {
        let deadlines = Deadlines::default();
        deadlines.expect(Some(44_100.0));
        assert!(!deadlines.is_over(), "no buffer, no deadline");
        let until = || deadlines.until.load(Ordering::Relaxed);
        // A buffer that began with the epoch and one that begins now: 32 frames last 726 us.
        deadlines.waiting_until(deadlines.epoch, 32.0 / 44_100.0, || assert_eq!(until(), 544_217));
        deadlines.waiting_until(deadlines.epoch, 0.0, || assert!(deadlines.is_over()));
        deadlines.timed(44_100 * 3_600, || {
            assert!(!deadlines.is_over());
            let whole = until();
            deadlines.bounded(1, || assert_eq!(until(), whole, "a slice has the time of its buffer"));
        });
        assert_eq!(until(), 0);
        deadlines.bounded(44_100, || assert!(until() > 0, "a slice of its own"));
        deadlines.expect(None);
        deadlines.bounded(1, || assert_eq!(until(), 0, "a file is not waited for"));
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
