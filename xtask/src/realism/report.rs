//! The report: figures beside those of real kits, under the names of the JSON.

use serde::Serialize;

use super::Subject;
use super::features::{Feature, Features};
use super::reference::{self, Figure};

/// All pieces. The fields are the keys of the JSON and stay.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Speeds of the strokes, m/s.
    pub speeds_m_s: Vec<f64>,
    /// `[piece]`.
    pub pieces: Vec<PieceReport>,
    /// Over all pieces and speeds.
    pub ranges: Count,
    /// Over all pieces and speeds.
    pub medians: Count,
}

/// One piece.
#[derive(Debug, Clone, Serialize)]
pub struct PieceReport {
    /// Name of the piece.
    pub piece: &'static str,
    /// Name of the striker.
    pub striker: &'static str,
    /// Place, share of the radius.
    pub at: f64,
    /// `[feature]`.
    pub features: Vec<Row>,
    /// How the piece brightens, if that is known of real ones.
    pub slope: Option<SlopeRow>,
    /// Figures whose real range is known, over all speeds.
    pub ranges: Count,
    /// Figures whose real median only is known, over all speeds.
    pub medians: Count,
}

/// How many figures lie inside.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Figures inside the real range, or near the real median.
    pub inside: usize,
    /// Figures compared.
    pub of: usize,
}

impl Count {
    fn add(self, other: Count) -> Count {
        Count { inside: self.inside + other.inside, of: self.of + other.of }
    }
}

/// One feature of a piece at every speed.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Name and unit.
    pub feature: &'static str,
    /// Median of real kits.
    pub median: f64,
    /// Whether the bounds are the real 10-90 % range; otherwise they only say what is near the median.
    pub ranged: bool,
    /// Least that counts as inside.
    pub low: f64,
    /// Most that counts as inside.
    pub high: f64,
    /// `[speed]`; null for what the stroke does not have.
    pub values: Vec<Option<f64>>,
    /// `[speed]`: whether it lies inside.
    pub inside: Vec<bool>,
}

/// How a feature grows with the level of the stroke.
#[derive(Debug, Clone, Serialize)]
pub struct SlopeRow {
    /// Name and unit of what grows.
    pub feature: &'static str,
    /// Growth of real ones, octaves per +20 dB.
    pub median: f64,
    /// Growth here: the straight line through the speeds by least squares.
    pub value: Option<f64>,
    /// Whether it is near the real one.
    pub inside: bool,
}

/// A measured stroke.
#[derive(Debug, Clone)]
pub struct Stroke {
    /// Its figures.
    pub features: Features,
    /// How loud it is, dB.
    pub level_db: Option<f64>,
}

impl Row {
    fn new(figure: &Figure, strokes: &[Stroke]) -> Row {
        let (low, high) = figure.bounds();
        let values: Vec<_> =
            strokes.iter().map(|stroke| stroke.features.get(&figure.feature).copied()).collect();
        let inside =
            values.iter().map(|value| value.is_some_and(|value| low <= value && value <= high)).collect();
        let (feature, median, ranged) = (figure.feature.key(), figure.median, figure.range.is_some());
        Row { feature, median, ranged, low, high, values, inside }
    }

    fn count(&self) -> Count {
        Count { inside: self.inside.iter().filter(|inside| **inside).count(), of: self.inside.len() }
    }
}

impl PieceReport {
    /// Sets a piece's strokes beside the recordings.
    pub fn new(subject: &Subject, strokes: &[Stroke]) -> PieceReport {
        let features: Vec<Row> =
            reference::figures(subject.name).iter().map(|figure| Row::new(figure, strokes)).collect();
        let count = |ranged: bool| {
            features
                .iter()
                .filter(|row| row.ranged == ranged)
                .map(Row::count)
                .fold(Count::default(), Count::add)
        };
        let (ranges, medians) = (count(true), count(false));
        let strike = subject.strike();
        let slope = reference::slope(subject.name).map(|slope| {
            let value = growth(slope.feature, strokes);
            let inside = value.is_some_and(|value| (value - slope.octaves).abs() <= reference::SLOPE_WITHIN);
            SlopeRow { feature: slope.feature.key(), median: slope.octaves, value, inside }
        });
        PieceReport {
            piece: subject.name,
            striker: strike.striker.name(),
            at: strike.radius,
            features,
            slope,
            ranges,
            medians,
        }
    }
}

impl Report {
    /// Counts over all pieces.
    pub fn new(sample_rate_hz: f64, speeds_m_s: Vec<f64>, pieces: Vec<PieceReport>) -> Report {
        let sum =
            |count: fn(&PieceReport) -> Count| pieces.iter().map(count).fold(Count::default(), Count::add);
        let (ranges, medians) = (sum(|piece| piece.ranges), sum(|piece| piece.medians));
        Report { sample_rate_hz, speeds_m_s, pieces, ranges, medians }
    }
}

/// Octaves that a feature grows by when the level grows by 20 dB; nothing for strokes all as loud.
fn growth(feature: Feature, strokes: &[Stroke]) -> Option<f64> {
    let points: Vec<(f64, f64)> = strokes
        .iter()
        .filter_map(|stroke| Some((stroke.level_db?, stroke.features.get(&feature)?.log2())))
        .collect();
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let (xx, xy) = points
        .iter()
        .fold((0.0, 0.0), |(xx, xy), point| (xx + (point.0 - x).powi(2), xy + (point.0 - x) * (point.1 - y)));
    (xx > 1e-6).then(|| 20.0 * xy / xx)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::realism::SUBJECTS;

    fn stroke(level: f64, centroid: f64) -> Stroke {
        let features = Features::from([(Feature::CentroidFirst, centroid), (Feature::Attack, 4.0)]);
        Stroke { features, level_db: Some(level) }
    }

    #[test]
    fn an_octave_in_10_db_is_two_in_20() {
        let strokes = [stroke(-30.0, 200.0), stroke(-20.0, 400.0), stroke(-10.0, 800.0)];
        assert!((growth(Feature::CentroidFirst, &strokes).unwrap() - 2.0).abs() < 1e-9);
        assert_eq!(growth(Feature::CentroidFirst, &strokes[..1]), None);
    }

    #[test]
    fn what_is_missing_is_outside_and_what_is_in_range_inside() {
        let report = PieceReport::new(&SUBJECTS[2], &[stroke(-20.0, 355.0), stroke(-10.0, 3550.0)]);
        let row = |key: &str| report.features.iter().find(|row| row.feature == key).unwrap();
        assert_eq!(row("attack_ms").inside, [true, true]);
        assert_eq!(row("centroid_0_50_ms_hz").inside, [true, false]);
        assert_eq!((row("crest_db").values[0], row("crest_db").inside[0]), (None, false));
        assert_eq!(report.ranges, Count { inside: 2, of: 10 });
    }
}
