//! The report: figures beside those of real kits, under the names of the JSON.

use anyhow::Result;
use overhear_engine::strike::Striker;
use serde::Serialize;

use super::features::{Feature, Features};
use super::recording_chain::RecordingChain;
use super::reference::{self, Figure};
use super::request::Request;
use super::subject::Subject;

/// The goals are about strokes as fast as this or faster, m/s.
const FIRM: f64 = 3.0;

/// All pieces. The fields are the keys of the JSON and stay.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Speeds of the strokes, m/s.
    pub speeds_m_s: Vec<f64>,
    /// `[piece, recording chain]`: each piece at its close microphone, then in the mix.
    pub pieces: Vec<PieceReport>,
}

/// One piece through one recording chain.
#[derive(Debug, Clone, Serialize)]
pub struct PieceReport {
    /// Name of the piece.
    pub piece: &'static str,
    /// Its recording chain.
    pub heard: RecordingChain,
    /// Name of the striker.
    pub striker: &'static str,
    /// Places, shares of the radius.
    pub at: [f64; 3],
    /// `[feature]`.
    pub features: Vec<Row>,
    /// Brightening of the piece, if it is known for real ones.
    pub slope: Option<SlopeRow>,
    /// Figures whose real range is known, over all speeds.
    pub ranges: Count,
    /// Figures whose real median only is known, over all speeds.
    pub medians: Count,
    /// All figures of strokes at 3 m/s and more.
    pub firm: Count,
}

/// Number of figures inside.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Figures inside the real range, or near the real median.
    pub inside: usize,
    /// Figures compared.
    pub of: usize,
}

impl Count {
    /// Share of figures inside; 1 if there are none.
    pub fn share(self) -> f64 {
        if self.of == 0 { 1.0 } else { self.inside as f64 / self.of as f64 }
    }

    fn add(self, other: Count) -> Count {
        Count { inside: self.inside + other.inside, of: self.of + other.of }
    }
}

/// One feature of a piece at every speed.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Name and unit.
    pub feature: &'static str,
    /// Median of real kits, in the feature's unit.
    pub median: f64,
    /// Whether the bounds are the real 10-90 % range; otherwise they only say what is near the median.
    pub ranged: bool,
    /// Least that counts as inside, in the feature's unit.
    pub low: f64,
    /// Most that counts as inside, in the feature's unit.
    pub high: f64,
    /// `[speed]`: the median of the places, in the feature's unit; null for what most strokes do not have.
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
    /// Growth here, octaves per 20 dB: the straight line through the speeds by least squares.
    pub value: Option<f64>,
    /// Whether it is near the real one.
    pub inside: bool,
}

/// A measured stroke.
#[derive(Debug, Clone, Default)]
pub struct Stroke {
    /// Its figures.
    pub features: Features,
    /// Its level, dB.
    pub level_db: Option<f64>,
}

impl Row {
    /// `strokes[speed][place]`.
    fn new(figure: &Figure, strokes: &[Vec<Stroke>]) -> Row {
        let (low, high) = figure.bounds();
        let values: Vec<_> = strokes.iter().map(|places| median(figure.feature, places)).collect();
        let inside =
            values.iter().map(|value| value.is_some_and(|value| low <= value && value <= high)).collect();
        let (feature, median, ranged) = (figure.feature.key(), figure.median, figure.range.is_some());
        Row { feature, median, ranged, low, high, values, inside }
    }

    /// Over the speeds that are wanted.
    fn count(&self, speeds: &[f64], wanted: impl Fn(f64) -> bool) -> Count {
        let inside = || self.inside.iter().zip(speeds).filter(|(_, speed)| wanted(**speed));
        Count { inside: inside().filter(|(inside, _)| **inside).count(), of: inside().count() }
    }
}

/// The median over the places; nothing if most of the strokes do not have it.
fn median(feature: Feature, places: &[Stroke]) -> Option<f64> {
    let mut found: Vec<f64> =
        places.iter().filter_map(|stroke| stroke.features.get(&feature).copied()).collect();
    found.sort_by(f64::total_cmp);
    let middle = found.len() / 2;
    match found.len() {
        some if 2 * some <= places.len() => None,
        odd if odd % 2 == 1 => Some(found[middle]),
        _ => Some(0.5 * (found[middle - 1] + found[middle])),
    }
}

impl PieceReport {
    /// Sets a piece's strokes with a striker, `[speed][place]`, beside the recordings; speeds are in m/s.
    pub fn new(
        (subject, striker): (&Subject, Striker),
        heard: RecordingChain,
        speeds: &[f64],
        strokes: &[Vec<Stroke>],
    ) -> PieceReport {
        let features: Vec<Row> =
            reference::figures(subject.name).iter().map(|figure| Row::new(figure, strokes)).collect();
        let count = |rows: &dyn Fn(&Row) -> bool, wanted: &dyn Fn(f64) -> bool| {
            let counts = features.iter().filter(|row| rows(row)).map(|row| row.count(speeds, wanted));
            counts.fold(Count::default(), Count::add)
        };
        let ranges = count(&|row| row.ranged, &|_| true);
        let medians = count(&|row| !row.ranged, &|_| true);
        let firm = count(&|_| true, &|speed| speed >= FIRM);
        let slope = reference::slope(subject.name).map(|slope| {
            let value = growth(slope.feature, &strokes.concat());
            let inside = value.is_some_and(|value| (value - slope.octaves).abs() <= reference::SLOPE_WITHIN);
            SlopeRow { feature: slope.feature.key(), median: slope.octaves, value, inside }
        });
        PieceReport {
            piece: subject.name,
            heard,
            striker: striker.name(),
            at: subject.places,
            features,
            slope,
            ranges,
            medians,
            firm,
        }
    }

    /// When the band above 3 kHz peaks, ms, `[speed]`, if strokes of every speed have it.
    pub fn bloom(&self) -> Option<Vec<f64>> {
        let row = self.features.iter().find(|row| row.feature == Feature::Bloom.key())?;
        row.values.iter().copied().collect()
    }
}

impl Report {
    /// Sorts strokes, in the order of the request's subjects, speeds and places, by subject and recording chain.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if the kit has no piece of a subject's name.
    pub fn new(sample_rate_hz: u32, request: &Request, strokes: &[[Stroke; 2]]) -> Result<Report> {
        let (speeds, mut pieces, mut rest) = (&request.speeds, Vec::new(), strokes);
        for subject in &request.subjects {
            let striker = subject.strike(&request.kit, subject.slot(&request.kit)?).striker;
            let (own, others) = rest.split_at(rest.len().min(speeds.len() * subject.places.len()));
            rest = others;
            for (which, chain) in RecordingChain::ALL.into_iter().enumerate() {
                let by_speed = own.chunks(subject.places.len());
                let heard_so =
                    |places: &[[Stroke; 2]]| places.iter().map(|both| both[which].clone()).collect();
                let strokes: Vec<Vec<Stroke>> = by_speed.map(heard_so).collect();
                pieces.push(PieceReport::new((subject, striker), chain, speeds, &strokes));
            }
        }
        Ok(Report { sample_rate_hz: f64::from(sample_rate_hz), speeds_m_s: speeds.clone(), pieces })
    }

    /// Sum of a count over all pieces through one recording chain.
    pub fn all(&self, heard: RecordingChain, count: fn(&PieceReport) -> Count) -> Count {
        let pieces = self.pieces.iter().filter(|piece| piece.heard == heard);
        pieces.map(count).fold(Count::default(), Count::add)
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
        let strokes = [vec![stroke(-20.0, 355.0)], vec![stroke(-10.0, 3550.0)]];
        let report =
            PieceReport::new((&SUBJECTS[2], Striker::Stick), RecordingChain::Close, &[1.5, 5.0], &strokes);
        let row = |key: &str| report.features.iter().find(|row| row.feature == key).unwrap();
        assert_eq!(row("attack_ms").inside, [true, true]);
        assert_eq!(row("centroid_0_50_ms_hz").inside, [true, false]);
        assert_eq!((row("crest_db").values[0], row("crest_db").inside[0]), (None, false));
        assert_eq!(report.ranges, Count { inside: 2, of: 10 });
        assert_eq!(report.firm, Count { inside: 1, of: 18 });
    }

    #[test]
    fn several_places_count_by_their_median_and_need_most_of_them() {
        let strokes = [300.0, 900.0, 400.0].map(|centroid| stroke(-20.0, centroid));
        assert_eq!(median(Feature::CentroidFirst, &strokes), Some(400.0));
        assert_eq!(median(Feature::CentroidFirst, &strokes[..2]), Some(600.0));
        let only = [strokes[0].clone(), Stroke::default(), Stroke::default()];
        assert_eq!(median(Feature::CentroidFirst, &only), None);
    }
}
