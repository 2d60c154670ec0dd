//! `realism`: every piece in the kit, struck from soft to hard at several positions, compared with recordings.
//!
//! The kit has the plugin's defaults and is bounced or played live by the plugin's performer. Each stroke is
//! recorded twice: by the piece's close microphone alone, and in the full mix, both as the mean of left and right. The
//! median over the positions of each of the [`features`] is compared with the [`mod@reference`].

mod recording_chain;
pub mod features;
pub mod reference;
mod report;
mod request;
mod subject;
mod table;

use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use overhear_engine::kit_spec::Kind;
use overhear_engine::strike::Strike;
use rayon::prelude::*;

use recording_chain::Stand;

pub use recording_chain::RecordingChain;
pub use report::{Count, PieceReport, Report, Row, Stroke};
pub use request::{Job, Request};
pub use subject::{SUBJECTS, Subject, subjects};

/// Default speeds of the strokes, m/s: soft, medium, hard, as four drummers' sticks have them. *Literature*: Dahl, Acta Acustica 90,
/// 2004 (pp about 1 m/s, mf 3 to 4, ff 8 to 12). A kick's beater is as fast: 7 to 9 m/s in a hard
/// stroke that was filmed (metaltriggers.com, stroke analysis).
pub const SPEEDS: [f64; 3] = [1.5, 4.0, 8.0];

/// Sample rate, Hz.
pub const RATE: u32 = 48_000;

/// Recorded length of drums and cymbals, s: until each octave has fallen by more than 25 dB.
const DRUM_SECONDS: f64 = 4.0;
const CYMBAL_SECONDS: f64 = 8.0;

/// Is shown every stroke and its sound through each recording chain, full scale 1. An error ends the measurement.
pub type Show<'a> = dyn Fn(&Job, &[Vec<f32>; 2]) -> Result<()> + Sync + 'a;

/// Renders and measures everything, on as many threads as there are cores, each with a kit of its own.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if a subject's piece is missing or the kit cannot be built.
pub fn run(request: &Request) -> Result<Report> {
    run_and_show(request, &|_, _| Ok(()))
}

/// [`run`] that also shows every stroke, in no order, with its sound through each recording chain (full scale 1).
///
/// # Errors
/// As [`run`], and what `show` returns.
pub fn run_and_show(request: &Request, show: &Show) -> Result<Report> {
    // A kit is built for a thread, not for a stroke.
    let stands: Mutex<Vec<Stand>> = Mutex::default();
    let idle = || stands.lock().unwrap_or_else(PoisonError::into_inner).pop();
    let strike = |job: &Job| -> Result<[Stroke; 2]> {
        let mut stand = match idle() {
            Some(stand) => stand,
            None => Stand::new(RATE, &request.kit, &request.settings, request.pace)?,
        };
        let strokes = job.strike(&mut stand, request, show);
        stands.lock().unwrap_or_else(PoisonError::into_inner).push(stand);
        strokes
    };
    let strokes = request.jobs()?.par_iter().with_max_len(1).map(strike).collect::<Result<Vec<_>>>()?;
    Report::new(RATE, request, &strokes)
}

impl Job {
    /// Renders the stroke, shows its sounds, and measures it.
    fn strike(&self, stand: &mut Stand, request: &Request, show: &Show) -> Result<[Stroke; 2]> {
        let Job { subject, slot, speed, place } = *self;
        let strike = Strike { speed, radius: place, ..subject.strike(&request.kit, slot) };
        let kind = request.kit.kit.piece(slot).map(|piece| piece.instrument.kind());
        let seconds = if kind == Some(Kind::Drum) { DRUM_SECONDS } else { CYMBAL_SECONDS };
        let heard = stand.strike(slot, &strike, subject.pedal(&request.kit, slot), seconds);
        show(self, &heard)?;
        let rate = f64::from(RATE);
        Ok(heard.map(|sound| Stroke {
            features: features::measure(&sound, rate),
            level_db: features::level_db(&sound, rate),
        }))
    }
}

#[cfg(test)]
mod tests {
    use overhear::building::Pace;
    use overhear::kit_document::KitDocument;

    use super::*;

    #[test]
    fn a_stroke_has_every_figure_that_is_compared_or_says_it_has_not() {
        let report = run(&Request {
            subjects: subjects(&["rack-tom".to_owned()]).unwrap(),
            speeds: vec![2.0, 4.0],
            kit: KitDocument::standard(),
            settings: Vec::new(),
            pace: Pace::RealTime,
        });
        let report = report.unwrap();
        assert_eq!(report.pieces.iter().map(|piece| piece.heard).collect::<Vec<_>>(), RecordingChain::ALL);
        for piece in &report.pieces {
            assert_eq!(piece.features.len(), reference::figures("rack-tom").len());
            assert!(piece.features.iter().all(|row| row.values.len() == 2));
            assert!(piece.features.iter().filter(|row| row.values[0].is_some()).count() > 12);
            // The goals do not count the soft stroke.
            assert_eq!(piece.firm.of, piece.features.len());
        }
        // The sound at the microphone over the rim differs from that at the overheads.
        assert_ne!(report.pieces[0].features[0].values, report.pieces[1].features[0].values);
        assert!(report.to_string().contains("rack-tom"));
    }
}
