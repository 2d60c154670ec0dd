//! Density of the peaks of a spectrum.
//!
//! Frames of 85 ms under a raised cosine, half overlapped, from 20 ms after the stroke to half a
//! second or to where less than a ten-thousandth of the loudest frame's energy is left. In each,
//! every bin (11.7 Hz) of the band that stands 3 dB above the lowest on either side, up to the next higher
//! peak, counts; the figure is the mean over the frames, each weighing alike. Noise has about 2
//! per 100 Hz, a lone partial one in all: the figure tells lines from noise, not how many lines there
//! are where they lie closer than 30 Hz.

use std::ops::Range;

use super::one_shot::OneShot;
use crate::spectra::Frames;

/// Length of a frame, s.
const FRAME: f64 = 4096.0 / 48_000.0;

/// The stretch of the sound that is looked at, s.
const STRETCH: Range<f64> = 0.02..0.52;

/// A frame with less than this share of the loudest's energy is not looked at.
const LEAST_SHARE: f64 = 1e-4;

/// How far a peak stands out, as a ratio of powers.
const PROMINENCE: f64 = 2.0;

/// Peaks per 100 Hz in each band (Hz).
pub fn peaks_per_100_hz<const N: usize>(shot: &OneShot, bands: [Range<f64>; N]) -> [Option<f64>; N] {
    let frames = frames(shot);
    let loudest = frames.iter().map(|frame| frame.iter().sum::<f64>()).fold(0.0, f64::max);
    bands.map(|band| {
        let [first, last] = [band.start, band.end].map(|hz| (hz * FRAME).round() as usize);
        let counts: Vec<usize> = frames
            .iter()
            .filter(|frame| frame.iter().sum::<f64>() > LEAST_SHARE * loudest && last < frame.len())
            .map(|frame| prominent(&frame[first..last]))
            .collect();
        let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
        (!counts.is_empty()).then(|| mean * 100.0 / (band.end - band.start))
    })
}

/// `[frame][bin]`: powers.
fn frames(shot: &OneShot) -> Vec<Vec<f64>> {
    let length = (FRAME * shot.rate).round() as usize;
    let mut frames = Frames::new(length);
    let sound = shot.sound();
    let [first, last] = [STRETCH.start, STRETCH.end].map(|seconds| (seconds * shot.rate) as usize);
    let starts = (first..last.min(sound.len())).step_by((length / 2).max(1));
    let whole = starts.take_while(|start| start + length <= sound.len());
    whole.map(|start| frames.powers(sound, start as isize).collect()).collect()
}

/// Peaks that stand out among powers.
fn prominent(powers: &[f64]) -> usize {
    let (mut count, mut valley, mut peak, mut rising) = (0, f64::INFINITY, 0.0, true);
    for &power in powers {
        if rising {
            valley = power.min(valley);
            if power > PROMINENCE * valley {
                (rising, peak) = (false, power);
            }
        } else if power > peak {
            peak = power;
        } else if power * PROMINENCE < peak {
            count += 1;
            (rising, valley) = (true, power);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Chance;

    const RATE: f64 = 48_000.0;

    fn density(sample: impl FnMut(usize) -> f32) -> [Option<f64>; 2] {
        let samples: Vec<f32> = (0..48_000).map(sample).collect();
        peaks_per_100_hz(&OneShot::new(&samples, RATE).unwrap(), [1500.0..5000.0, 5000.0..12_000.0])
    }

    #[test]
    fn noise_has_about_two_peaks_in_100_hz() {
        let mut chance = Chance::new(1);
        let found = density(|_| chance.between(-1.0, 1.0) as f32);
        for figure in found {
            assert!((1.7..2.5).contains(&figure.unwrap()), "{found:?}");
        }
    }

    #[test]
    fn lines_200_hz_apart_are_half_a_peak_in_100_hz() {
        let found = density(|n| {
            let sine = |k: f64| (std::f64::consts::TAU * (200.0 * k + 0.3) * n as f64 / RATE).sin();
            (5..70).map(f64::from).map(sine).sum::<f64>() as f32
        });
        for figure in found {
            assert!((figure.unwrap() - 0.5).abs() < 0.05, "{found:?}");
        }
    }
}
