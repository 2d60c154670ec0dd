//! `render`: MIDI files to WAV files, one deterministic job per file.

mod job;
mod stems;
mod style;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;

use anyhow::{Context, Result};
use rayon::prelude::*;

use crate::bad_input;
use crate::output::Folder;
use crate::player::Source;

pub use job::{Job, Report, Taken, decibels, takes};
pub use style::Style;

/// A request to render.
#[derive(Debug, Clone)]
pub struct Request {
    /// MIDI files, and folders of them.
    pub inputs: Vec<PathBuf>,
    /// The WAV file, or a folder for several.
    pub output: PathBuf,
    /// A folder for one more file per microphone.
    pub stems: Option<PathBuf>,
    /// Files rendered at once; as many as there are cores by default.
    pub jobs: Option<usize>,
    /// Style of playing.
    pub style: Style,
}

/// Renders everything asked for.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) for what cannot be read or written; every file that can be
/// rendered is, and the first error is returned.
pub fn run(request: &Request) -> Result<()> {
    let songs = songs(&request.inputs)?;
    let many = songs.len() > 1 || request.inputs.iter().any(|input| input.is_dir());
    let jobs = jobs(request, &songs, many)?;
    let _folder = if many { Some(Folder::new(&request.output)?) } else { None };
    // Before any work: a bundle that cannot be loaded fails all jobs alike.
    if let Source::Clap(path) = &request.style.source {
        crate::host::Bundle::load(path)?;
    }
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let workers = request.jobs.unwrap_or(cores).min(jobs.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build();
    let pool = pool.context("the system starts no more threads")?;
    let render = |job: &Job| match job.run(&request.style, workers == 1) {
        Ok(report) => {
            // The songs matter, whether or not anyone still reads this.
            drop(writeln!(std::io::stdout(), "{report}"));
            None
        }
        Err(error) => Some(error),
    };
    let errors: Vec<_> = pool.install(|| jobs.par_iter().with_max_len(1).filter_map(render).collect());
    let failed = errors.len();
    let mut errors = errors.into_iter();
    match errors.next() {
        None => Ok(()),
        Some(error) if failed == 1 => Err(error),
        Some(error) => Err(error.context(format!("{failed} of {} files failed", jobs.len()))),
    }
}

/// The MIDI files named, those in folders by name.
fn songs(inputs: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut songs = Vec::new();
    for input in inputs {
        if !input.is_dir() {
            songs.push(input.clone());
            continue;
        }
        let entries = std::fs::read_dir(input)
            .map_err(|error| bad_input!("cannot read the folder `{}`: {error}", input.display()))?;
        let mut found: Vec<_> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.is_file() && is_midi(path))
            .collect();
        if found.is_empty() {
            return Err(bad_input!(
                "the folder `{}` holds no MIDI file, accepted: .mid, .midi, .smf, .rmi",
                input.display(),
            ));
        }
        found.sort();
        songs.append(&mut found);
    }
    Ok(songs)
}

fn is_midi(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    ["mid", "midi", "smf", "rmi"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// Which song becomes which files.
fn jobs(request: &Request, songs: &[PathBuf], many: bool) -> Result<Vec<Job>> {
    let into_folder = many || request.output.is_dir();
    if many && request.output.is_file() {
        return Err(bad_input!(
            "`{}` is a file, accepted for several songs: a folder",
            request.output.display(),
        ));
    }
    let mut jobs: Vec<Job> = Vec::new();
    for song in songs {
        let name = song.file_stem().context("a song without a name")?;
        let output = if into_folder {
            let mut file = name.to_owned();
            file.push(".wav");
            request.output.join(file)
        } else {
            request.output.clone()
        };
        if jobs.iter().any(|job| job.output == output) {
            return Err(bad_input!(
                "two songs would become `{}`, accepted: songs of different names",
                output.display(),
            ));
        }
        if output.canonicalize().is_ok_and(|output| Some(output) == song.canonicalize().ok()) {
            return Err(bad_input!(
                "`{}` is the song itself, accepted: another name for the sound",
                output.display(),
            ));
        }
        let stems = request.stems.as_ref().map(|stems| if many { stems.join(name) } else { stems.clone() });
        jobs.push(Job { song: song.clone(), output, stems });
    }
    Ok(jobs)
}
