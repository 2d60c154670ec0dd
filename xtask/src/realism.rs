//! `realism`: every piece by itself, struck softly to hard, beside recordings of real ones.
//!
//! Each piece is rendered as `hear` renders it, with the stroke its ordinary note gives it and the
//! kit's default muffling; the [`features`] are measured and set beside the [`mod@reference`]. What is
//! heard is the piece's own listening point: no neighbours, no room, no mix.

pub mod features;
pub mod reference;
mod report;
mod subject;
mod table;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use anyhow::Result;
use overhear_engine::kit::Control;
use overhear_engine::piece::{BuildOptions, PieceId, Quality};
use overhear_engine::strike::Strike;

use crate::bad_input;
use crate::hear;
use crate::output::Folder;
use crate::progress::Progress;
use crate::settings::{self, PieceSetting};
use crate::wav::{Bits, WavFile};

pub use report::{PieceReport, Report, Row, Stroke};
pub use subject::{SUBJECTS, Subject, subjects};

/// Speeds of the strokes unless told otherwise, m/s: soft, medium, hard.
pub const SPEEDS: [f64; 3] = [1.5, 3.0, 5.0];

/// Sample rate, Hz.
const RATE: f64 = 48_000.0;

/// How long drums and cymbals are heard, s: until each octave has fallen by more than 25 dB.
const DRUM_SECONDS: f64 = 4.0;
const CYMBAL_SECONDS: f64 = 8.0;

/// What to measure.
#[derive(Debug, Clone)]
pub struct Request {
    /// The pieces, as they were recorded.
    pub subjects: Vec<Subject>,
    /// Speeds of the strokes, m/s, ascending.
    pub speeds: Vec<f64>,
    /// Tuning and muffling, where it is not the kit's; each of one of the pieces.
    pub settings: Vec<(PieceId, PieceSetting)>,
    /// A folder to keep the sounds in.
    pub wav: Option<PathBuf>,
}

/// Reads the values of `--set`, each for the piece it acts on.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with the value and what is accepted.
pub fn settings(subjects: &[Subject], assignments: &[String]) -> Result<Vec<(PieceId, PieceSetting)>> {
    let read = |text: &String| {
        let acts = |subject: &&Subject| text.trim().starts_with(&subject.piece.name().replace('-', "_"));
        let &Subject { piece, .. } = subjects.iter().find(acts).ok_or_else(|| {
            let names = subjects.iter().map(|subject| subject.name).collect::<Vec<_>>().join(", ");
            bad_input!("`{text}` acts on no piece that is measured: {names}")
        })?;
        let settings = settings::parse_for_piece(piece, std::slice::from_ref(text))?;
        Ok(settings.into_iter().map(move |setting| (piece, setting)).collect::<Vec<_>>())
    };
    Ok(assignments.iter().map(read).collect::<Result<Vec<_>>>()?.concat())
}

/// Renders and measures everything, on as many threads as there are cores.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if a sound cannot be written.
pub fn run(request: &Request) -> Result<Report> {
    let _folder = request.wav.as_deref().map(Folder::new).transpose()?;
    let jobs: Vec<(Subject, f64)> = request
        .subjects
        .iter()
        .flat_map(|&subject| request.speeds.iter().map(move |&speed| (subject, speed)))
        .collect();
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Option<Result<Stroke>>>> = Mutex::new(jobs.iter().map(|_| None).collect());
    let progress = Mutex::new(Progress::new("realism", jobs.len() as u64));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(&(subject, speed)) = jobs.get(index) else {
                return;
            };
            let result = stroke(&subject, speed, request);
            progress.lock().unwrap_or_else(PoisonError::into_inner).advance(1);
            done.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(result);
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| (0..cores.min(jobs.len())).for_each(|_| drop(scope.spawn(work))));
    let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    let strokes = done.into_iter().flatten().collect::<Result<Vec<Stroke>>>()?;
    let per_piece = request.subjects.iter().zip(strokes.chunks(request.speeds.len().max(1)));
    let pieces = per_piece.map(|(subject, strokes)| PieceReport::new(subject, strokes)).collect();
    Ok(Report::new(RATE, request.speeds.clone(), pieces))
}

/// Renders one stroke, keeps it if asked to, and measures it.
fn stroke(subject: &Subject, speed: f64, asked: &Request) -> Result<Stroke> {
    let piece = subject.piece;
    let strike = Strike { speed, ..subject.strike() };
    let muffling = Control::Muffling(piece);
    let mut settings = vec![PieceSetting { control: muffling, value: settings::default_muffling(piece) }];
    settings.extend(subject.pedal());
    settings.extend(asked.settings.iter().filter(|(of, _)| *of == piece).map(|(_, setting)| *setting));
    // Nothing that rests where it is needs time to get there.
    settings.retain(|setting| setting.control != muffling || setting.value > 0.0);
    let seconds = if piece.is_drum() { DRUM_SECONDS } else { CYMBAL_SECONDS };
    // Nobody waits for it: what a bounce sounds like.
    let options = BuildOptions { quality: Quality::Offline, ..BuildOptions::new(RATE) };
    let request = hear::Request { piece, strike, settings, options, seconds, wav: None };
    let sound = hear::render(&request)?;
    if let Some(folder) = &asked.wav {
        let path = folder.join(format!("{}-{speed}.wav", subject.name));
        let mut file = WavFile::create(&path, Bits::Float32, RATE as u32, 1, sound.samples.len() as u64)?;
        file.write(&[&sound.samples])?;
        file.finish()?;
    }
    let samples = &sound.samples;
    Ok(Stroke { features: features::measure(samples, RATE), level_db: features::level_db(samples, RATE) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_has_every_figure_that_is_compared_or_says_it_has_not() {
        let report = run(&Request {
            subjects: subjects(&["rack-tom".to_owned()]).unwrap(),
            speeds: vec![2.0, 4.0],
            settings: Vec::new(),
            wav: None,
        });
        let report = report.unwrap();
        let piece = &report.pieces[0];
        assert_eq!(piece.features.len(), reference::figures("rack-tom").len());
        assert!(piece.features.iter().all(|row| row.values.len() == 2));
        assert!(piece.features.iter().filter(|row| row.values[0].is_some()).count() > 12);
        assert!(report.to_string().contains("rack-tom"));
    }
}
