//! One stroke recorded by itself, its beginning found, and the stretches of time measured on it.
//!
//! The sound begins at the first sample within 40 dB of its peak. A little silence is put before
//! it, so that filters that are symmetric in time keep what they spread ahead of the stroke.

/// The sound begins where it first comes this close to its peak, as a share of it.
const ONSET_SHARE: f32 = 0.01;

/// Silence before the beginning, s: more than the filters of these modules spread.
const LEAD: f64 = 0.02;

/// Length of the fade between two intervals, s: slow enough to add next to nothing to
/// the spectrum above 100 Hz, a tenth of what is resolved.
const CROSSING: f64 = 0.01;

/// A sound that begins at a known sample.
#[derive(Debug, Clone, PartialEq)]
pub struct OneShot {
    /// Samples, silence before the beginning included.
    pub samples: Vec<f32>,
    /// The first sample of the sound.
    pub onset: usize,
    /// Hz.
    pub rate: f64,
}

impl OneShot {
    /// Finds the beginning of a sound at a sample rate (Hz); nothing in silence.
    pub fn new(samples: &[f32], rate: f64) -> Option<OneShot> {
        let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        if peak <= 0.0 || !samples.iter().all(|sample| sample.is_finite()) {
            return None;
        }
        let first = samples.iter().position(|sample| sample.abs() >= ONSET_SHARE * peak)?;
        let onset = (LEAD * rate) as usize;
        // The part before the beginning belongs to the sound and is kept as far as there is room.
        let kept = first.min(onset);
        let mut padded = vec![0.0; onset - kept];
        padded.extend_from_slice(&samples[first - kept..]);
        Some(OneShot { samples: padded, onset, rate })
    }

    /// The sound from its beginning, full scale 1.
    pub fn sound(&self) -> &[f32] {
        &self.samples[self.onset..]
    }

    /// The first `seconds` of the sound.
    pub fn first(&self, seconds: f64) -> &[f32] {
        let sound = self.sound();
        &sound[..sound.len().min((seconds * self.rate) as usize)]
    }

    /// A stretch of the sound, s after its beginning, faded over 10 ms about its ends so that
    /// neighbouring stretches add to the whole. From 0 it has everything before it.
    pub fn stretch(&self, from: f64, to: f64) -> Vec<f32> {
        let fade = |time: f64, end: f64| (0.5 + (time - end) / CROSSING).clamp(0.0, 1.0);
        let rise = |share: f64| 0.5 - 0.5 * (std::f64::consts::PI * share).cos();
        let gain = |n: usize| {
            let time = (n as f64 - self.onset as f64) / self.rate;
            let begun = if from > 0.0 { rise(fade(time, from)) } else { 1.0 };
            begun * (1.0 - rise(fade(time, to)))
        };
        let end = self.onset as f64 + (to + CROSSING) * self.rate;
        let end = if end < self.samples.len() as f64 { end as usize } else { self.samples.len() };
        self.samples[..end].iter().enumerate().map(|(n, &sample)| sample * gain(n) as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_beginning_is_found_wherever_it_lies() {
        for silence in [0, 3, 5000] {
            let mut samples = vec![1e-6; silence];
            samples.extend((0..2000).map(|n| (-0.01 * n as f32).exp()));
            let shot = OneShot::new(&samples, 48_000.0).unwrap();
            assert_eq!((shot.onset, shot.sound()[0], shot.sound().len()), (960, 1.0, 2000));
        }
        assert_eq!(OneShot::new(&[0.0; 50], 48_000.0), None);
        assert_eq!(OneShot::new(&[1.0, f32::NAN], 48_000.0), None);
    }

    #[test]
    fn neighbouring_stretches_add_to_the_whole() {
        let samples: Vec<f32> = (0..48_000).map(|n| 1.0 + 0.1 * (n as f32 * 0.3).sin()).collect();
        let shot = OneShot::new(&samples, 48_000.0).unwrap();
        let parts = [(0.0, 0.05), (0.05, 0.25), (0.25, f64::INFINITY)].map(|(a, b)| shot.stretch(a, b));
        for (n, &sample) in shot.samples.iter().enumerate() {
            let sum: f32 = parts.iter().map(|part| part.get(n).copied().unwrap_or(0.0)).sum();
            assert!((sum - sample).abs() < 1e-5, "{n}: {sum} {sample}");
        }
    }
}
