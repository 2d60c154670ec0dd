//! A drum's two lowest notes: the fundamental and the second partial.
//!
//! Both are peaks of the spectrum of the first half second. The fundamental is the strongest
//! between 30 and 500 Hz. The second partial is the strongest other peak from 1.2 to 3.2 times as
//! high; to be one, it rises at least 3 dB above everything between itself and the fundamental's
//! flank, so that no ripple of a flank is taken for it.

use crate::spectra::OnsetSpectrum;

/// Length of the transformed sound, s.
const WITHIN: f64 = 0.5;

/// Search range of the fundamental, Hz.
const FUNDAMENTAL_HZ: [f64; 2] = [30.0, 500.0];

/// Where the second partial is sought, over the fundamental.
const SECOND: [f64; 2] = [1.2, 3.2];

/// Prominence of a partial, dB.
const PROMINENCE_DB: f64 = 3.0;

/// Two partials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partials {
    /// Hz.
    pub fundamental_hz: f64,
    /// The second partial: its frequency over the fundamental's and its level over that, dB.
    pub second: Option<(f64, f64)>,
}

/// Finds both in a sound at a sample rate (Hz).
pub fn partials(samples: &[f32], rate: f64) -> Option<Partials> {
    let spectrum = OnsetSpectrum::of_onset(samples, rate, WITHIN);
    let [low, high] = FUNDAMENTAL_HZ;
    let fundamental = spectrum.strongest_between(low, high)?;
    let level = spectrum.level_db(fundamental)?;
    let peaks = spectrum.peaks(SECOND.map(|ratio| ratio * fundamental), PROMINENCE_DB);
    let second =
        peaks.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(hz, db)| (hz / fundamental, db - level));
    Some(Partials { fundamental_hz: fundamental, second })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn ringing(partials: &[(f64, f64, f64)]) -> Vec<f32> {
        (0..48_000)
            .map(|n| {
                let t = f64::from(n) / RATE;
                let part = |&(frequency, t60, size): &(f64, f64, f64)| {
                    size * (-6.9078 * t / t60).exp() * (std::f64::consts::TAU * frequency * t).sin()
                };
                partials.iter().map(part).sum::<f64>() as f32
            })
            .collect()
    }

    #[test]
    fn two_partials_are_found_with_their_ratio_and_level() {
        let found = partials(&ringing(&[(100.0, 1.5, 1.0), (180.0, 1.5, 0.1), (700.0, 1.0, 0.5)]), RATE);
        let Partials { fundamental_hz, second } = found.unwrap();
        let (ratio, level) = second.unwrap();
        assert!((fundamental_hz - 100.0).abs() < 0.2, "{fundamental_hz}");
        assert!((ratio - 1.8).abs() < 0.01 && (level + 20.0).abs() < 0.7, "{ratio} {level}");
    }

    #[test]
    fn a_lonely_partial_has_no_second() {
        let found = partials(&ringing(&[(100.0, 1.5, 1.0)]), RATE).unwrap();
        assert!((found.fundamental_hz - 100.0).abs() < 0.2);
        assert_eq!(found.second, None);
        assert_eq!(partials(&[0.0; 4800], RATE), None);
    }
}
