//! Decay times in octave bands.
//!
//! A band is cut out by multiplying the spectrum of the whole sound with a window that is flat
//! inside the octave and has raised-cosine edges, which shifts no energy in time. Schroeder's
//! backward integral (JASA 1965) of its square is fitted by a straight line from -5 to -25 dB, and
//! the slope extended to 60 dB, as ISO 3382 has it for T20; its early decay time is fitted from 0
//! to -10 dB. The energy that would have come after
//! the end of the sound is estimated from the slope and added, until the slope stays.

use std::ops::Range;

use crate::spectra::{self, Transform};

/// Centres of the bands, Hz.
pub const OCTAVES: [f64; 10] = [31.5, 63.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// The fitted stretch of a decay, dB below the whole: last to first.
const LATE: Range<f64> = -25.0..-5.0;

/// The stretch of the early decay.
const EARLY: Range<f64> = -10.0..0.0;

/// A band with less than this share of the sound's energy holds its neighbours' skirts.
const LEAST_SHARE: f64 = 1e-8;

/// The filter alone gives a click about 4.5 (measured): less than this is the filter, not the sound.
const LEAST_BANDWIDTH_TIMES_T60: f64 = 6.0;

/// What is gone sooner is the click of the stroke and rings in no body, s.
const LEAST_T60: f64 = 0.005;

/// Decay time by 60 dB of each of [`OCTAVES`], s; nothing where the band holds too little or has
/// not decayed far enough when the sound ends.
pub fn octave_decays(samples: &[f32], rate: f64) -> [Option<f64>; OCTAVES.len()] {
    let Some(transform) = Transform::new(samples, rate) else {
        return [None; OCTAVES.len()];
    };
    let total: f64 = samples.iter().map(|&sample| f64::from(sample).powi(2)).sum();
    OCTAVES.map(|centre| {
        // A band cut by the end of the spectrum is not that octave.
        if centre * std::f64::consts::SQRT_2 > rate / 2.0 {
            return None;
        }
        let mut energy = transform.filtered(|hz| octave_window(hz / centre))?;
        energy.iter_mut().for_each(|sample| *sample *= *sample);
        if energy.iter().sum::<f64>() < LEAST_SHARE * total {
            return None;
        }
        let t60 = decay_time(&energy, rate, LATE)?;
        let bandwidth = centre / std::f64::consts::SQRT_2;
        (t60 >= LEAST_T60.max(LEAST_BANDWIDTH_TIMES_T60 / bandwidth)).then_some(t60)
    })
}

/// Decay times of the whole sound, s: the early one, of its first 10 dB, and the late one. Both
/// are extended to 60 dB.
pub fn broadband_decays(samples: &[f32], rate: f64) -> [Option<f64>; 2] {
    let energy: Vec<f64> = samples.iter().map(|&sample| f64::from(sample).powi(2)).collect();
    let total: f64 = energy.iter().sum();
    if total <= 0.0 || !total.is_finite() {
        return [None; 2];
    }
    [EARLY, LATE].map(|levels| decay_time(&energy, rate, levels))
}

/// Transmission at a frequency given as a ratio to the band's centre: half at the octave's edges.
fn octave_window(ratio: f64) -> f64 {
    if ratio <= 0.0 {
        return 0.0;
    }
    // A third of an octave of slope on either side of each edge.
    spectra::slope((0.5 - ratio.log2().abs()) * 3.0)
}

/// Decay time of a band's instantaneous energy.
fn decay_time(energy: &[f64], rate: f64, levels: Range<f64>) -> Option<f64> {
    let mut remaining = energy.to_vec();
    let mut sum = 0.0;
    for value in remaining.iter_mut().rev() {
        sum += *value;
        *value = sum;
    }
    // The level of the last twentieth is the level at which the sound is cut off.
    let last = energy.len() / 20;
    let end_power = energy[energy.len() - last.max(1)..].iter().sum::<f64>() / last.max(1) as f64;
    let mut lost = 0.0;
    let mut t60 = None;
    for _ in 0..8 {
        t60 = Some(slope(&remaining, lost, rate, &levels)?);
        let sigma = 6.9078 / t60?;
        // An exponential of that power goes on for 1 / (2 sigma).
        lost = end_power * rate / (2.0 * sigma);
    }
    // The missing part must lie below the fitted part.
    let floor = 10f64.powf(levels.start / 10.0);
    (lost < floor * (remaining[0] + lost)).then_some(t60?)
}

/// Decay time from the line through the remaining energy between the two levels.
fn slope(remaining: &[f64], lost: f64, rate: f64, levels: &Range<f64>) -> Option<f64> {
    let whole = remaining.first()? + lost;
    let (mut n, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (index, &energy) in remaining.iter().enumerate() {
        let level = 10.0 * ((energy + lost) / whole).log10();
        if level > levels.end {
            continue;
        }
        if level < levels.start {
            let slope = (n * xy - x * y) / (n * xx - x * x);
            return (n >= 8.0 && slope < 0.0).then(|| -60.0 / slope);
        }
        let time = index as f64 / rate;
        n += 1.0;
        x += time;
        y += level;
        xx += time * time;
        xy += time * level;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn ringing(partials: &[(f64, f64)], seconds: f64) -> Vec<f32> {
        (0..(seconds * RATE) as usize)
            .map(|n| {
                let t = n as f64 / RATE;
                let sum = partials.iter().map(|&(frequency, t60)| {
                    (-6.9078 * t / t60).exp() * (std::f64::consts::TAU * frequency * t).sin()
                });
                (0.2 * sum.sum::<f64>()) as f32
            })
            .collect()
    }

    #[test]
    fn each_octave_gives_the_decay_of_what_rings_in_it() {
        let partials =
            [(31.5, 2.0), (63.0, 1.5), (250.0, 0.8), (1000.0, 0.5), (4000.0, 0.2), (16_000.0, 0.1)];
        let decays = octave_decays(&ringing(&partials, 3.0), RATE);
        for (centre, t60) in partials {
            let band = OCTAVES.iter().position(|octave| *octave == centre).unwrap();
            let found = decays[band].unwrap();
            assert!((found / t60 - 1.0).abs() < 0.03, "{centre} Hz: {found} for {t60}");
        }
    }

    #[test]
    fn a_sound_cut_before_its_decay_is_corrected_or_refused() {
        let cut = |seconds| octave_decays(&ringing(&[(1000.0, 3.0)], seconds), RATE)[5];
        // 40 dB of 60 heard.
        assert!((cut(2.0).unwrap() / 3.0 - 1.0).abs() < 0.02);
        // 20 dB of 60 heard.
        assert_eq!(cut(1.0), None);
    }

    #[test]
    fn a_bend_in_the_decay_parts_early_from_late() {
        // 20 dB down a slow partial takes over.
        let fast = ringing(&[(200.0, 0.3)], 4.0);
        let slow = ringing(&[(300.0, 3.0)], 4.0);
        let both: Vec<f32> = std::iter::zip(&fast, &slow).map(|(fast, slow)| fast + 0.1 * slow).collect();
        let [early, late] = broadband_decays(&both, RATE).map(Option::unwrap);
        assert!((0.3..0.6).contains(&early) && late > 2.0, "{early} {late}");
        let [early, late] = broadband_decays(&fast, RATE).map(Option::unwrap);
        assert!((early / 0.3 - 1.0).abs() < 0.03 && (late / 0.3 - 1.0).abs() < 0.03, "{early} {late}");
        assert_eq!(broadband_decays(&[0.0; 100], RATE), [None; 2]);
    }

    #[test]
    fn empty_bands_silence_and_steady_sounds_have_no_decay() {
        let decays = octave_decays(&ringing(&[(1000.0, 0.5)], 2.0), RATE);
        assert!(decays[5].is_some());
        assert_eq!((decays[1], decays[9]), (None, None));
        assert_eq!(octave_decays(&[0.0; 4800], RATE), [None; 10]);
        assert_eq!(octave_decays(&[], RATE), [None; 10]);
        assert_eq!(octave_decays(&ringing(&[(1000.0, 1e9)], 1.0), RATE), [None; 10]);
    }

    #[test]
    fn bands_beyond_nyquist_are_left_out() {
        let noise: Vec<f32> = (0..22_050).map(|n| ((n * n) % 17) as f32 - 8.0).collect();
        assert_eq!(octave_decays(&noise, 22_050.0)[9], None);
    }
}
