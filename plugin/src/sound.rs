//! The latest of what is heard, for whoever draws its spectrum.
//!
//! A ring of single samples that the audio thread writes and anybody may read. A reader that is overtaken while it
//! reads gets newer samples in the place of older ones: a crack in one picture, which the next has not.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

/// Samples that are kept; a power of two.
pub const KEPT: usize = 16_384;

/// The ring; clones are ends of the same.
#[derive(Clone)]
pub struct Sound {
    ring: Arc<Ring>,
}

struct Ring {
    /// Bits of single precision numbers.
    samples: Box<[AtomicU32]>,
    /// Samples written so far.
    written: AtomicUsize,
    /// Sample rate, Hz, as bits.
    rate: AtomicU32,
}

impl Default for Sound {
    fn default() -> Sound {
        let samples = (0..KEPT).map(|_| AtomicU32::new(0)).collect();
        let rate = AtomicU32::new(48_000.0_f32.to_bits());
        Sound { ring: Arc::new(Ring { samples, written: AtomicUsize::new(0), rate }) }
    }
}

impl Sound {
    /// Adopts a sample rate (Hz).
    pub fn set_rate(&self, rate: f32) {
        self.ring.rate.store(rate.to_bits(), Ordering::Relaxed);
    }

    /// The sample rate, Hz.
    pub fn rate(&self) -> f32 {
        f32::from_bits(self.ring.rate.load(Ordering::Relaxed))
    }

    /// Adds what both outputs play, as their mean.
    ///
    /// # Real-time
    /// A store for each sample; no allocation, no lock.
    pub fn write(&self, left: &[f32], right: &[f32]) {
        let from = self.ring.written.load(Ordering::Relaxed);
        for (place, (left, right)) in left.iter().zip(right).enumerate() {
            let sample = 0.5 * (left + right);
            if let Some(slot) = self.ring.samples.get(from.wrapping_add(place) % KEPT) {
                slot.store(sample.to_bits(), Ordering::Relaxed);
            }
        }
        self.ring.written.store(from.wrapping_add(left.len().min(right.len())), Ordering::Release);
    }

    /// Samples written so far.
    pub fn written(&self) -> usize {
        self.ring.written.load(Ordering::Acquire)
    }

    /// Fills `into` with the latest samples, the newest last; at most as many as are kept. Numbers only.
    pub fn latest(&self, into: &mut [f32]) {
        self.until(self.written(), into);
    }

    /// Fills `into` with samples up to where so many had been [written](Self::written), as far back as is kept.
    pub fn until(&self, written: usize, into: &mut [f32]) {
        let length = into.len().min(KEPT);
        let back = self.written().wrapping_sub(written).min(KEPT - length);
        let from = self.written().wrapping_sub(back + length);
        for (place, sample) in into.iter_mut().enumerate().take(length) {
            let bits = self.ring.samples[from.wrapping_add(place) % KEPT].load(Ordering::Relaxed);
            let value = f32::from_bits(bits);
            *sample = if value.is_finite() { value } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_samples_come_back_in_order_across_the_end_of_the_ring() {
        let sound = Sound::default();
        let mut next = 0.0_f32;
        for block in [7, 512, 16_000, 300] {
            let samples: Vec<f32> = (0..block).map(|place| next + place as f32).collect();
            next += block as f32;
            sound.write(&samples, &samples);
        }
        let mut latest = [0.0; 1_000];
        sound.latest(&mut latest);
        assert_eq!((latest[999], latest[0]), (next - 1.0, next - 1_000.0));
        assert!(latest.windows(2).all(|pair| pair[1] == pair[0] + 1.0));
        sound.until(sound.written() - 500, &mut latest);
        assert_eq!(latest[999], next - 501.0);
        // Farther back than anything is kept.
        sound.until(0, &mut latest);
        assert_eq!(latest[0], next - KEPT as f32);
    }

    #[test]
    fn what_is_no_number_is_silence() {
        let sound = Sound::default();
        sound.write(&[f32::NAN], &[0.0]);
        let mut latest = [1.0];
        sound.latest(&mut latest);
        assert_eq!(latest, [0.0]);
    }
}
