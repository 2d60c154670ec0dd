//! `realism`: every piece in the kit, struck from soft to hard at several positions, compared with recordings.
//!
//! The kit has the plugin's defaults and is bounced or played live by the plugin's performer. Each stroke is
//! recorded twice: by the piece's close microphone alone, and in the full mix, both as the mean of left and right. The
//! median over the positions of each of the [`features`] is compared with the [`mod@reference`].

mod ears;
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
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear_engine::kit_spec::Kind;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Strike;

use crate::output::Folder;
use crate::progress::Progress;
use crate::settings::Setting;
use crate::wav::{Bits, WavFile};

use ears::Stand;

pub use ears::Ear;
pub use report::{Count, PieceReport, Report, Row, Stroke};
pub use subject::{SUBJECTS, Subject, subjects};

/// Default speeds of the strokes, m/s: soft, medium, hard.
pub const SPEEDS: [f64; 3] = [1.5, 3.0, 5.0];

/// Sample rate, Hz.
pub const RATE: u32 = 48_000;

/// Recorded length of drums and cymbals, s: until each octave has fallen by more than 25 dB.
const DRUM_SECONDS: f64 = 4.0;
const CYMBAL_SECONDS: f64 = 8.0;

/// Request for a measurement.
#[derive(Debug, Clone)]
pub struct Request {
    /// The pieces, as they were recorded.
    pub subjects: Vec<Subject>,
    /// Speeds of the strokes, m/s, ascending.
    pub speeds: Vec<f64>,
    /// The kit, which has pieces of the subjects' names, and its notes.
    pub kit: KitDocument,
    /// Parameters that are not at their default.
    pub settings: Vec<Setting>,
    /// Whether the kit is bounced or played live; this selects the quality of its cymbals.
    pub pace: Pace,
    /// A folder to keep the sounds in.
    pub wav: Option<PathBuf>,
}

/// One stroke of a subject.
#[derive(Debug, Clone, Copy)]
pub struct Job {
    /// The struck subjects.
    pub subject: Subject,
    /// Its slot.
    pub slot: Slot,
    /// Speed, m/s.
    pub speed: f64,
    /// Place, share of the radius.
    pub place: f64,
}

/// Who is shown a stroke and what the ears hear of it, full scale 1.
pub type Show<'a> = dyn Fn(&Job, &[Vec<f32>; 2]) + Sync + 'a;

impl Request {
    /// Every stroke: subject by subject, speed by speed, place by place.
    fn jobs(&self) -> Result<Vec<Job>> {
        let mut jobs = Vec::new();
        for &subject in &self.subjects {
            let slot = subject.slot(&self.kit)?;
            for &speed in &self.speeds {
                jobs.extend(subject.places.map(|place| Job { subject, slot, speed, place }));
            }
        }
        Ok(jobs)
    }
}

/// Renders and measures everything, on as many threads as there are cores, each with a kit of its own.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if a sound cannot be written.
pub fn run(request: &Request) -> Result<Report> {
    run_and_show(request, &|_, _| ())
}

/// The same, showing every stroke, in no order, with what each ear hears of it (full scale 1).
///
/// # Errors
/// As [`run`].
pub fn run_and_show(request: &Request, show: &Show) -> Result<Report> {
    let _folder = request.wav.as_deref().map(Folder::new).transpose()?;
    let jobs = request.jobs()?;
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Option<[Stroke; 2]>>> = Mutex::new(vec![None; jobs.len()]);
    let progress = Mutex::new(Progress::new("realism", jobs.len() as u64));
    let work = || -> Result<()> {
        let mut stand = Stand::new(RATE, &request.kit, &request.settings, request.pace)?;
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(index) else { return Ok(()) };
            let strokes = job.strike(&mut stand, request, show)?;
            progress.lock().unwrap_or_else(PoisonError::into_inner).advance(1);
            done.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(strokes);
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from).min(jobs.len());
    thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.collect::<Result<()>>()
    })?;
    let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    let strokes: Vec<[Stroke; 2]> = done.into_iter().flatten().collect();
    Report::new(RATE, request, &strokes)
}

impl Job {
    /// Renders the stroke, keeps what each ear hears if asked to, and measures it.
    fn strike(&self, stand: &mut Stand, request: &Request, show: &Show) -> Result<[Stroke; 2]> {
        let Job { subject, slot, speed, place } = *self;
        let strike = Strike { speed, radius: place, ..subject.strike(&request.kit, slot) };
        let kind = request.kit.kit.piece(slot).map(|piece| piece.instrument.kind());
        let seconds = if kind == Some(Kind::Drum) { DRUM_SECONDS } else { CYMBAL_SECONDS };
        let heard = stand.strike(slot, &strike, subject.pedal(&request.kit, slot), seconds);
        if let Some(folder) = &request.wav {
            for (ear, sound) in Ear::ALL.into_iter().zip(&heard) {
                let name = format!("{}-{speed}-at-{place}-{}.wav", subject.name, ear.name());
                let (path, frames) = (folder.join(name), sound.len() as u64);
                let mut file = WavFile::create(&path, Bits::Float32, RATE, 1, frames)?;
                file.write(&[sound])?;
                file.finish()?;
            }
        }
        show(self, &heard);
        let rate = f64::from(RATE);
        Ok(heard.map(|sound| Stroke {
            features: features::measure(&sound, rate),
            level_db: features::level_db(&sound, rate),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_has_every_figure_that_is_compared_or_says_it_has_not() {
        let report = run(&Request {
            subjects: subjects(&["rack-tom".to_owned()]).unwrap(),
            speeds: vec![2.0, 4.0],
            kit: KitDocument::standard(),
            settings: Vec::new(),
            pace: Pace::RealTime,
            wav: None,
        });
        let report = report.unwrap();
        assert_eq!(report.pieces.iter().map(|piece| piece.heard).collect::<Vec<_>>(), Ear::ALL);
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
