//! The features measured on a stroke, and their names.
//!
//! Times count from the first sample within 40 dB of the peak. Everything about energy is
//! weighted by energy (the square of the pressure), not by magnitude.

use std::collections::BTreeMap;

use crate::analysis::{OCTAVES, OneShot, broadband_decays, density, envelope, octave_decays, partials};
use crate::spectra::Transform;

/// A figure of a stroke. The order is that of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Feature {
    /// See [`envelope::attack_ms`].
    Attack,
    /// See [`envelope::click_db`].
    Click,
    /// See [`envelope::crest_db`].
    Crest,
    /// See [`envelope::temporal_centroid_ms`].
    TemporalCentroid,
    /// Mean frequency of the first 50 ms; stretches of time are those of [`OneShot::stretch`].
    CentroidFirst,
    /// Mean frequency from 50 to 250 ms.
    CentroidSecond,
    /// Mean frequency from 250 ms on.
    CentroidRest,
    /// See [`envelope::bloom_ms`].
    Bloom,
    /// See [`octave_decays`], in the octave of 125 Hz.
    Decay125,
    /// In the octave of 500 Hz.
    Decay500,
    /// In the octave of 1 kHz.
    Decay1k,
    /// In the octave of 2 kHz.
    Decay2k,
    /// In the octave of 4 kHz.
    Decay4k,
    /// In the octave of 8 kHz.
    Decay8k,
    /// See [`broadband_decays`].
    EarlyDecay,
    /// See [`broadband_decays`].
    Decay,
    /// See [`partials`](mod@partials).
    Fundamental,
    /// Frequency of the second partial over the fundamental.
    SecondRatio,
    /// Level of the second partial over the fundamental.
    SecondLevel,
    /// Energy from 300 Hz to 1 kHz, of the whole sound's.
    Energy300,
    /// Energy from 1 to 3 kHz.
    Energy1k,
    /// Energy from 3 to 8 kHz.
    Energy3k,
    /// Energy above 8 kHz.
    Energy8k,
    /// Peaks from 1.5 to 5 kHz, see [`density`](mod@density).
    PeaksLow,
    /// Peaks from 5 to 12 kHz.
    PeaksHigh,
}

/// The figures of a stroke, each in the unit of its feature; what it does not have is left out.
pub type Features = BTreeMap<Feature, f64>;

impl Feature {
    /// Its key in the JSON, unit and all; also how people read it.
    pub fn key(self) -> &'static str {
        match self {
            Feature::Attack => "attack_ms",
            Feature::Click => "click_db",
            Feature::Crest => "crest_db",
            Feature::TemporalCentroid => "temporal_centroid_ms",
            Feature::CentroidFirst => "centroid_0_50_ms_hz",
            Feature::CentroidSecond => "centroid_50_250_ms_hz",
            Feature::CentroidRest => "centroid_250_ms_on_hz",
            Feature::Bloom => "bloom_ms",
            Feature::Decay125 => "t60_125_hz_s",
            Feature::Decay500 => "t60_500_hz_s",
            Feature::Decay1k => "t60_1000_hz_s",
            Feature::Decay2k => "t60_2000_hz_s",
            Feature::Decay4k => "t60_4000_hz_s",
            Feature::Decay8k => "t60_8000_hz_s",
            Feature::EarlyDecay => "early_decay_s",
            Feature::Decay => "t60_s",
            Feature::Fundamental => "fundamental_hz",
            Feature::SecondRatio => "second_partial_ratio",
            Feature::SecondLevel => "second_partial_db",
            Feature::Energy300 => "energy_300_1000_hz_db",
            Feature::Energy1k => "energy_1_3_khz_db",
            Feature::Energy3k => "energy_3_8_khz_db",
            Feature::Energy8k => "energy_8_khz_on_db",
            Feature::PeaksLow => "peaks_1500_5000_hz",
            Feature::PeaksHigh => "peaks_5_12_khz",
        }
    }
}

/// Measures a sound at a sample rate (Hz).
pub fn measure(samples: &[f32], rate: f64) -> Features {
    let Some(shot) = OneShot::new(samples, rate) else {
        return Features::new();
    };
    let sound = shot.sound();
    let mut figures = envelope_figures(&shot);
    figures.extend(decay_figures(sound, rate));
    if let Some(found) = partials::partials(sound, rate) {
        figures.push((Feature::Fundamental, Some(found.fundamental_hz)));
        figures.push((Feature::SecondRatio, found.second.map(|(ratio, _)| ratio)));
        figures.push((Feature::SecondLevel, found.second.map(|(_, level)| level)));
    }
    figures.extend(energy_figures(sound, rate));
    let [low, high] = density::peaks_per_100_hz(&shot, [1500.0..5000.0, 5000.0..12_000.0]);
    figures.extend([(Feature::PeaksLow, low), (Feature::PeaksHigh, high)]);
    figures.into_iter().filter_map(|(feature, figure)| Some((feature, figure?))).collect()
}

type Figures = Vec<(Feature, Option<f64>)>;

fn envelope_figures(shot: &OneShot) -> Figures {
    let centroid = |from, to| Transform::new(&shot.stretch(from, to), shot.rate)?.centroid(AUDIBLE);
    vec![
        (Feature::Attack, envelope::attack_ms(shot)),
        (Feature::Click, envelope::click_db(shot)),
        (Feature::Crest, envelope::crest_db(shot)),
        (Feature::TemporalCentroid, envelope::temporal_centroid_ms(shot)),
        (Feature::CentroidFirst, centroid(0.0, 0.05)),
        (Feature::CentroidSecond, centroid(0.05, 0.25)),
        (Feature::CentroidRest, centroid(0.25, f64::INFINITY)),
        (Feature::Bloom, envelope::bloom_ms(shot)),
    ]
}

/// What is heard, Hz.
const AUDIBLE: std::ops::Range<f64> = 20.0..20_000.0;

fn decay_figures(sound: &[f32], rate: f64) -> Figures {
    let octaves = octave_decays(sound, rate);
    let at = |centre| OCTAVES.iter().position(|&octave| octave == centre).and_then(|k| octaves[k]);
    let [early, late] = broadband_decays(sound, rate);
    vec![
        (Feature::Decay125, at(125.0)),
        (Feature::Decay500, at(500.0)),
        (Feature::Decay1k, at(1000.0)),
        (Feature::Decay2k, at(2000.0)),
        (Feature::Decay4k, at(4000.0)),
        (Feature::Decay8k, at(8000.0)),
        (Feature::EarlyDecay, early),
        (Feature::Decay, late),
    ]
}

fn energy_figures(sound: &[f32], rate: f64) -> Figures {
    let Some(transform) = Transform::new(sound, rate) else {
        return Vec::new();
    };
    let whole = transform.energy(AUDIBLE);
    let share = |from, to| {
        let share = transform.energy(from..to) / whole;
        (share > 0.0).then(|| 10.0 * share.log10())
    };
    vec![
        (Feature::Energy300, share(300.0, 1000.0)),
        (Feature::Energy1k, share(1000.0, 3000.0)),
        (Feature::Energy3k, share(3000.0, 8000.0)),
        (Feature::Energy8k, share(8000.0, AUDIBLE.end)),
    ]
}

/// Energy of the first 250 ms, dB: how loud a stroke is for the slopes of the dynamics.
pub fn level_db(samples: &[f32], rate: f64) -> Option<f64> {
    let shot = OneShot::new(samples, rate)?;
    let energy: f64 = shot.first(0.25).iter().map(|&sample| f64::from(sample).powi(2)).sum();
    (energy > 0.0).then(|| 10.0 * energy.log10())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decaying_sine_has_the_figures_it_must_have() {
        let samples: Vec<f32> = (0..4 * 48_000)
            .map(|n| {
                let t = f64::from(n) / 48_000.0;
                ((-6.9078 * t / 1.5).exp() * (std::f64::consts::TAU * 125.0 * t).sin()) as f32
            })
            .collect();
        let found = measure(&samples, 48_000.0);
        let near = |feature, want: f64, within: f64| {
            let figure = found[&feature];
            assert!((figure - want).abs() < within, "{feature:?}: {figure} for {want}");
        };
        near(Feature::TemporalCentroid, 1500.0 / 13.8155, 1.0);
        near(Feature::CentroidSecond, 125.0, 1.0);
        near(Feature::CentroidRest, 125.0, 1.0);
        near(Feature::Decay125, 1.5, 0.02);
        near(Feature::EarlyDecay, 1.5, 0.05);
        near(Feature::Decay, 1.5, 0.02);
        near(Feature::Fundamental, 125.0, 0.2);
        assert!(found[&Feature::Click] < -40.0 && found[&Feature::Energy3k] < -60.0, "{found:?}");
        assert!(!found.contains_key(&Feature::Decay2k) && !found.contains_key(&Feature::SecondRatio));
        assert!(measure(&[0.0; 1000], 48_000.0).is_empty());
    }

    #[test]
    fn the_level_grows_by_20_db_when_the_sound_grows_tenfold() {
        let level = |size: f32| level_db(&[0.3 * size, -0.2 * size, 0.1 * size], 48_000.0).unwrap();
        assert!((level(1.0) - level(0.1) - 20.0).abs() < 1e-3);
    }
}
