//! Bypass: what a host's own switch does to an instrument.
//!
//! There is nothing to pass through, so the instrument falls silent: its outputs fade within ten milliseconds, and notes strike
//! nothing. What rings goes on ringing unheard and controllers are followed, so that the kit is where it would be when it
//! is heard again.

/// Length of the fade, s. *By ear*: no click, and over before the next stroke of a roll.
const FADE: f32 = 0.01;

/// The gain between the kit and its outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bypass {
    /// Samples from silence: a whole number, so that the cut into buffers changes nothing.
    place: u32,
    /// Samples of the fade, at least 1.
    length: u32,
}

impl Bypass {
    /// A fade for a sample rate, Hz, at its end.
    pub fn new(sample_rate: f32, bypassed: bool) -> Bypass {
        let mut bypass = Bypass { place: 0, length: ((FADE * sample_rate) as u32).max(1) };
        bypass.settle(bypassed);
        bypass
    }

    /// Takes the fade to its end.
    pub fn settle(&mut self, bypassed: bool) {
        self.place = if bypassed { 0 } else { self.length };
    }

    /// Fades channels of one length; where nothing is bypassed no bit changes.
    ///
    /// # Real-time
    /// A division for each sample while it fades; no allocation.
    pub fn apply<'a>(&mut self, bypassed: bool, channels: impl Iterator<Item = &'a mut [f32]>) {
        if self.place == self.length && !bypassed {
            return;
        }
        let mut longest = 0;
        for channel in channels {
            longest = longest.max(channel.len());
            for (later, sample) in (1..).zip(channel) {
                *sample *= self.later(bypassed, later) as f32 / self.length as f32;
            }
        }
        self.place = self.later(bypassed, u32::try_from(longest).unwrap_or(u32::MAX));
    }

    /// The place so many samples later.
    fn later(&self, bypassed: bool, samples: u32) -> u32 {
        if bypassed {
            self.place.saturating_sub(samples)
        } else {
            self.place.saturating_add(samples).min(self.length)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 48_000.0;

    #[test]
    fn it_fades_to_silence_and_back_without_a_step() {
        let mut bypass = Bypass::new(RATE, false);
        let mut sound = vec![1.0_f32; 2_000];
        let (out, back) = sound.split_at_mut(1_000);
        bypass.apply(true, std::iter::once(out));
        bypass.apply(false, std::iter::once(back));
        assert!(sound.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.01 / (FADE * RATE)));
        assert_eq!((sound[999], sound[1_999]), (0.0, 1.0));
        assert!((sound[239] - 0.5).abs() < 1e-3, "half way after half the time: {}", sound[239]);
    }

    #[test]
    fn the_cut_into_buffers_changes_no_bit() {
        let cut = |lengths: &[usize]| {
            let (mut bypass, mut sound) = (Bypass::new(RATE, false), vec![0.7_f32; 700]);
            let mut rest = sound.as_mut_slice();
            for (index, &length) in lengths.iter().enumerate() {
                for _ in 0..length {
                    let (one, more) = rest.split_at_mut(1);
                    bypass.apply(index % 2 == 0, std::iter::once(one));
                    rest = more;
                }
            }
            sound
        };
        let mut whole = vec![0.7_f32; 700];
        let mut bypass = Bypass::new(RATE, false);
        let (out, back) = whole.split_at_mut(333);
        bypass.apply(true, std::iter::once(out));
        bypass.apply(false, std::iter::once(back));
        assert!(whole == cut(&[333, 367]));
    }

    #[test]
    fn heard_it_changes_no_bit() {
        let mut bypass = Bypass::new(RATE, false);
        let mut sound = [0.1_f32, -0.3, f32::MIN_POSITIVE / 2.0];
        bypass.apply(false, std::iter::once(&mut sound[..]));
        assert_eq!(sound, [0.1, -0.3, f32::MIN_POSITIVE / 2.0]);
    }
}
