//! `realism`: every piece beside recordings, as the measuring library does it; the sounds are kept if that is asked for.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use clap::Args;
use overhear::building::Pace;
use overhear_cli::commands::{say, speed};
use overhear_cli::output::Folder;
use overhear_cli::progress::Progress;
use overhear_cli::settings;
use overhear_cli::wav::{Bits, WavFile};
use overhear_measure::realism::{self, Job, RATE, RecordingChain, SUBJECTS};

/// Arguments of `realism`.
#[derive(Debug, Args)]
pub struct RealismArguments {
    #[arg(value_name = "PIECE", help = subjects_help())]
    pieces: Vec<String>,
    /// Speeds of the strokes, m/s, up to 25
    #[arg(long, value_name = "M/S,M/S,...", value_delimiter = ',', value_parser = speed,
          default_values_t = realism::SPEEDS)]
    speeds: Vec<f64>,
    /// Strike the pieces of these names in the kit of a file
    #[arg(long, value_name = "FILE")]
    kit: Option<PathBuf>,
    /// Set a parameter, as in snare_tune=180 or offline_quality=high; repeatable
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Measure playback, with cymbals at `quality`; by default a bounce, at `offline_quality`
    #[arg(long)]
    live: bool,
    /// Print one JSON object (see docs/commands.md)
    #[arg(long)]
    json: bool,
    /// Write the sounds to this folder, as 32-bit float
    #[arg(long, value_name = "DIR")]
    wav: Option<PathBuf>,
}

impl RealismArguments {
    /// The request of these arguments.
    ///
    /// # Errors
    /// [`BadInput`](overhear_cli::error::BadInput) for a piece that was not recorded.
    fn request(&self) -> Result<realism::Request> {
        let mut speeds = self.speeds.clone();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        let subjects = realism::subjects(&self.pieces)?;
        let kit = settings::kit(self.kit.as_deref())?;
        let settings = settings::parse(&self.set, &kit.kit)?;
        let pace = if self.live { Pace::RealTime } else { Pace::Offline };
        Ok(realism::Request { subjects, speeds, kit, settings, pace })
    }
}

/// Measures, keeps the sounds if asked to, and prints the report.
///
/// # Errors
/// [`BadInput`](overhear_cli::error::BadInput) for a piece that was not recorded, a kit or a parameter that is not one, and
/// a sound that cannot be written.
pub fn run(arguments: RealismArguments) -> Result<()> {
    let request = arguments.request()?;
    overhear::cache::provide();
    let _folder = arguments.wav.as_deref().map(Folder::new).transpose()?;
    let progress = Mutex::new(Progress::new("realism", request.strokes() as u64));
    let report = realism::run_and_show(&request, &|job, heard| {
        progress.lock().unwrap_or_else(PoisonError::into_inner).advance(1);
        arguments.wav.as_deref().map_or(Ok(()), |folder| keep(folder, job, heard))
    })?;
    drop(progress);
    say(&if arguments.json { serde_json::to_string(&report)? + "\n" } else { report.to_string() })
}

/// What `--help` says of the subjects' names.
fn subjects_help() -> String {
    format!("What to strike, all if none is given: {}", SUBJECTS.map(|subject| subject.name).join(", "))
}

/// Writes the sound of a stroke through each recording chain.
fn keep(folder: &Path, job: &Job, heard: &[Vec<f32>; 2]) -> Result<()> {
    let Job { subject, speed, place, .. } = job;
    for (chain, sound) in RecordingChain::ALL.into_iter().zip(heard) {
        let path = folder.join(format!("{}-{speed}-at-{place}-{}.wav", subject.name, chain.name()));
        let mut file = WavFile::create(&path, Bits::Float32, RATE, 1, sound.len() as u64)?;
        file.write(&[sound])?;
        file.finish()?;
    }
    Ok(())
}
