//! Measured features of real kits.
//!
//! *Measured* on recordings: 3,123 one-shots of 36 acoustic kits, median and 10-90 % range, each of 19
//! sets of recordings weighing alike; close, overhead and mixed microphones all count, and so do
//! the rooms. Of many figures only the median is known. Their definitions are not published; those
//! of [`features`](super::features) are ours.

use super::features::Feature;

/// A figure of real kits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The measured feature.
    pub feature: Feature,
    /// Half of the recordings have less, in the feature's unit.
    pub median: f64,
    /// A tenth have less than the first, a tenth more than the second, in the feature's unit.
    pub range: Option<(f64, f64)>,
}

/// A growth of a figure with the loudness of the stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// The feature that grows.
    pub feature: Feature,
    /// Octaves per +20 dB.
    pub octaves: f64,
}

/// Largest distance at which a figure counts as near a median.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nearness {
    /// By this factor up or down: times, frequencies, densities.
    Factor(f64),
    /// By so much up or down: levels, dB.
    Distance(f64),
}

impl Figure {
    /// What a figure must lie in to count, in the feature's unit: the range, or what is [near](nearness) the median.
    pub fn bounds(&self) -> (f64, f64) {
        self.range.unwrap_or_else(|| match nearness(self.feature) {
            Nearness::Factor(factor) => (self.median / factor, self.median * factor),
            Nearness::Distance(distance) => (self.median - distance, self.median + distance),
        })
    }
}

/// How far from a bare median is near: narrower than the known ranges of figures of the same kind,
/// whose tenths lie a factor of two or more, or 3 to 10 dB, about their medians.
pub fn nearness(feature: Feature) -> Nearness {
    match feature {
        Feature::Crest => Nearness::Distance(3.0),
        Feature::Click
        | Feature::SecondLevel
        | Feature::Energy300
        | Feature::Energy1k
        | Feature::Energy3k
        | Feature::Energy8k => Nearness::Distance(6.0),
        Feature::SecondRatio => Nearness::Factor(1.15),
        _ => Nearness::Factor(1.5),
    }
}

/// How far a slope may be from the real one, octaves per +20 dB.
pub const SLOPE_WITHIN: f64 = 0.6;

/// When the band above 3 kHz of a recorded crash is loudest after soft, medium and hard strokes, ms.
pub const CRASH_BLOOM_MS: [f64; 3] = [5.0, 48.0, 114.0];

/// Factor within which a crash's must lie of these.
pub const BLOOM_WITHIN: f64 = 2.0;

const fn ranged(feature: Feature, median: f64, low: f64, high: f64) -> Figure {
    Figure { feature, median, range: Some((low, high)) }
}

const fn bare(feature: Feature, median: f64) -> Figure {
    Figure { feature, median, range: None }
}

/// The figures of a [subject](super::Subject), by its name; none for one that was not recorded.
pub fn figures(subject: &str) -> &'static [Figure] {
    match subject {
        "kick" => &KICK,
        "snare" => &SNARE,
        "rack-tom" => &RACK_TOM,
        "floor-tom" => &FLOOR_TOM,
        "crash" => &CRASH,
        "ride" => &RIDE,
        "splash" => &SPLASH,
        "hi-hat-closed" => &HAT_CLOSED,
        "hi-hat-open" => &HAT_OPEN,
        _ => &[],
    }
}

/// How a piece brightens with the stroke, where it is known.
pub fn slope(subject: &str) -> Option<Slope> {
    let (feature, octaves) = match subject {
        "kick" => (Feature::CentroidFirst, 0.9),
        "snare" => (Feature::CentroidFirst, 0.0),
        // 1.2 to 1.5.
        "rack-tom" | "floor-tom" => (Feature::CentroidFirst, 1.35),
        "crash" => (Feature::CentroidSecond, 1.5),
        _ => return None,
    };
    Some(Slope { feature, octaves })
}

use Feature::{
    Attack, Bloom, CentroidFirst, CentroidRest, CentroidSecond, Click, Crest, Decay, Decay1k, Decay2k,
    Decay4k, Decay8k, Decay125, Decay500, EarlyDecay, Energy1k, Energy3k, Energy8k, Energy300, Fundamental,
    PeaksHigh, PeaksLow, SecondLevel, SecondRatio, TemporalCentroid,
};

const KICK: [Figure; 18] = [
    ranged(Attack, 7.1, 4.0, 14.0),
    ranged(Click, -31.0, -44.0, -22.0),
    ranged(Crest, 14.6, 11.0, 17.0),
    ranged(TemporalCentroid, 31.0, 17.0, 71.0),
    bare(CentroidFirst, 122.0),
    bare(CentroidSecond, 78.0),
    bare(Decay125, 0.96),
    bare(Decay500, 0.50),
    bare(Decay2k, 0.32),
    bare(Decay8k, 0.32),
    bare(EarlyDecay, 0.46),
    bare(Decay, 0.86),
    ranged(Fundamental, 47.0, 39.0, 116.0),
    bare(SecondRatio, 1.57),
    bare(SecondLevel, -9.0),
    bare(Energy1k, -25.0),
    bare(Energy3k, -29.0),
    bare(Energy8k, -42.0),
];

const SNARE: [Figure; 18] = [
    ranged(Attack, 5.5, 1.8, 9.5),
    ranged(Click, -24.0, -33.0, -14.0),
    ranged(Crest, 16.9, 13.0, 20.0),
    ranged(TemporalCentroid, 24.0, 14.0, 48.0),
    bare(CentroidFirst, 434.0),
    bare(CentroidSecond, 981.0),
    bare(Decay125, 0.43),
    bare(Decay500, 0.55),
    bare(Decay2k, 0.40),
    bare(Decay8k, 0.36),
    bare(EarlyDecay, 0.34),
    bare(Decay, 0.52),
    ranged(Fundamental, 224.0, 159.0, 340.0),
    bare(SecondRatio, 1.51),
    bare(SecondLevel, -7.5),
    bare(Energy1k, -13.0),
    bare(Energy3k, -14.0),
    bare(Energy8k, -21.0),
];

const RACK_TOM: [Figure; 18] = [
    ranged(Attack, 4.8, 2.0, 24.0),
    ranged(Click, -22.0, -33.0, -14.0),
    ranged(Crest, 13.1, 9.0, 18.0),
    ranged(TemporalCentroid, 86.0, 33.0, 165.0),
    bare(CentroidFirst, 355.0),
    bare(CentroidSecond, 142.0),
    bare(Decay125, 1.54),
    bare(Decay500, 0.97),
    bare(Decay2k, 0.46),
    bare(Decay8k, 0.36),
    bare(EarlyDecay, 1.25),
    bare(Decay, 1.6),
    ranged(Fundamental, 120.0, 99.0, 156.0),
    bare(SecondRatio, 1.79),
    bare(SecondLevel, -20.0),
    bare(Energy1k, -19.0),
    bare(Energy3k, -25.0),
    bare(Energy8k, -34.0),
];

const FLOOR_TOM: [Figure; 18] = [
    ranged(Attack, 6.0, 2.8, 30.0),
    ranged(Click, -22.0, -31.0, -14.0),
    ranged(Crest, 13.4, 8.5, 18.0),
    ranged(TemporalCentroid, 94.0, 29.0, 175.0),
    bare(CentroidFirst, 307.0),
    bare(CentroidSecond, 115.0),
    bare(Decay125, 1.82),
    bare(Decay500, 1.21),
    bare(Decay2k, 0.45),
    bare(Decay8k, 0.35),
    bare(EarlyDecay, 1.5),
    bare(Decay, 1.8),
    ranged(Fundamental, 80.0, 67.0, 166.0),
    bare(SecondRatio, 1.84),
    bare(SecondLevel, -18.0),
    bare(Energy1k, -19.0),
    bare(Energy3k, -25.0),
    bare(Energy8k, -35.0),
];

const CRASH: [Figure; 18] = [
    ranged(Attack, 10.5, 1.3, 109.0),
    bare(Crest, 12.8),
    ranged(TemporalCentroid, 260.0, 151.0, 401.0),
    bare(CentroidFirst, 2400.0),
    bare(CentroidSecond, 4700.0),
    bare(CentroidRest, 4000.0),
    ranged(Bloom, 83.0, 4.0, 270.0),
    bare(Decay500, 5.0),
    bare(Decay1k, 5.5),
    bare(Decay2k, 6.0),
    bare(Decay4k, 4.3),
    bare(Decay8k, 3.2),
    bare(Energy300, -9.0),
    bare(Energy1k, -11.0),
    bare(Energy3k, -3.0),
    bare(Energy8k, -8.0),
    bare(PeaksLow, 2.0),
    bare(PeaksHigh, 1.9),
];

const RIDE: [Figure; 18] = [
    ranged(Attack, 1.8, 0.5, 4.0),
    bare(Crest, 20.5),
    ranged(TemporalCentroid, 195.0, 76.0, 427.0),
    bare(CentroidFirst, 9000.0),
    bare(CentroidSecond, 5700.0),
    bare(CentroidRest, 2900.0),
    ranged(Bloom, 4.0, 4.0, 6.0),
    bare(Decay500, 8.4),
    bare(Decay1k, 7.7),
    bare(Decay2k, 6.0),
    bare(Decay4k, 4.5),
    bare(Decay8k, 2.8),
    bare(Energy300, -11.0),
    bare(Energy1k, -11.0),
    bare(Energy3k, -6.0),
    bare(Energy8k, -4.0),
    bare(PeaksLow, 2.4),
    bare(PeaksHigh, 2.3),
];

const SPLASH: [Figure; 18] = [
    ranged(Attack, 12.0, 1.0, 137.0),
    bare(Crest, 14.2),
    bare(TemporalCentroid, 171.0),
    bare(CentroidFirst, 5100.0),
    bare(CentroidSecond, 6200.0),
    bare(CentroidRest, 4000.0),
    ranged(Bloom, 27.0, 6.0, 150.0),
    bare(Decay500, 4.0),
    bare(Decay1k, 3.2),
    bare(Decay2k, 3.1),
    bare(Decay4k, 2.8),
    bare(Decay8k, 1.9),
    bare(Energy300, -16.0),
    bare(Energy1k, -9.0),
    bare(Energy3k, -4.0),
    bare(Energy8k, -5.0),
    bare(PeaksLow, 1.7),
    bare(PeaksHigh, 1.8),
];

const HAT_CLOSED: [Figure; 17] = [
    ranged(Attack, 1.8, 0.8, 15.0),
    bare(Crest, 19.2),
    ranged(TemporalCentroid, 28.0, 17.0, 51.0),
    bare(CentroidFirst, 8400.0),
    bare(CentroidSecond, 6800.0),
    ranged(Bloom, 6.0, 4.0, 24.0),
    bare(Decay500, 0.43),
    bare(Decay1k, 0.35),
    bare(Decay2k, 0.32),
    bare(Decay4k, 0.30),
    bare(Decay8k, 0.27),
    bare(Energy300, -13.0),
    bare(Energy1k, -14.0),
    bare(Energy3k, -7.0),
    bare(Energy8k, -2.0),
    bare(PeaksLow, 0.86),
    bare(PeaksHigh, 0.74),
];

const HAT_OPEN: [Figure; 18] = [
    ranged(Attack, 13.0, 1.0, 56.0),
    bare(Crest, 14.3),
    ranged(TemporalCentroid, 159.0, 96.0, 250.0),
    bare(CentroidFirst, 7400.0),
    bare(CentroidSecond, 5800.0),
    bare(CentroidRest, 5000.0),
    ranged(Bloom, 22.0, 4.0, 73.0),
    bare(Decay500, 3.3),
    bare(Decay1k, 2.9),
    bare(Decay2k, 3.0),
    bare(Decay4k, 2.9),
    bare(Decay8k, 2.5),
    bare(Energy300, -10.0),
    bare(Energy1k, -11.0),
    bare(Energy3k, -5.0),
    bare(Energy8k, -4.0),
    bare(PeaksLow, 2.0),
    bare(PeaksHigh, 1.85),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::realism::SUBJECTS;

    #[test]
    fn medians_lie_in_their_ranges_and_tables_in_the_order_of_the_report() {
        for subject in SUBJECTS {
            let figures = figures(subject.name);
            for figure in figures {
                let (low, high) = figure.bounds();
                assert!(low <= figure.median && figure.median <= high, "{subject:?} {figure:?}");
            }
            assert!(figures.windows(2).all(|pair| pair[0].feature < pair[1].feature), "{subject:?}");
        }
    }
}
