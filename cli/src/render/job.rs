//! One song to its files.

use std::fmt;
use std::path::PathBuf;

use anyhow::{Result, ensure};

use super::stems::Stems;
use super::style::Style;
use crate::message::{Meaning, Message};
use crate::output::Folder;
use crate::player::{Played, Take};
use crate::progress::Progress;
use crate::settings;
use crate::song::Song;
use crate::wav::WavFile;

/// One song and where it goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// The MIDI file.
    pub song: PathBuf,
    /// The WAV file.
    pub output: PathBuf,
    /// A folder for one more file per microphone.
    pub stems: Option<PathBuf>,
}

/// Result of a job, in one line.
#[derive(Debug, Clone)]
pub struct Report {
    output: PathBuf,
    seconds: f64,
    played: Played,
    clipped: u64,
    notes: usize,
    silent: usize,
    stems: usize,
}

/// What a song comes to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// Its messages at their samples.
    pub take: Take,
    /// Its notes.
    pub notes: usize,
    /// How many of them strike nothing.
    pub silent: usize,
}

/// A song's messages at their samples. It ends the style's tail after its last note.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the song is too long to be meant.
pub fn takes(song: &Song, style: &Style) -> Result<Taken> {
    let (mut notes, mut silent, mut last) = (0, 0, 0);
    let mut messages = Vec::new();
    for event in &song.events {
        let message = Message { sample: song.sample(event.time, style.rate), bytes: event.bytes };
        if style.channel.is_some_and(|channel| channel != message.channel() + 1) {
            continue;
        }
        if let Meaning::NoteOn { key, .. } = message.meaning() {
            notes += 1;
            silent += usize::from(!settings::plays(&style.settings, &style.kit.notes, key));
            last = message.sample;
        }
        messages.push(message);
    }
    let tail = (style.tail * f64::from(style.rate)).round() as u64;
    Ok(Taken { take: Take { messages, frames: last.saturating_add(tail) }, notes, silent })
}

impl Job {
    /// Renders the song and its stems. Shows progress if no other job does.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for what cannot be read or written; nothing is left
    /// behind then.
    pub fn run(&self, style: &Style, show: bool) -> Result<Report> {
        let song = Song::read(&self.song)?;
        let Taken { take, notes, silent } = takes(&song, style)?;
        let mut file = WavFile::create(&self.output, style.bits, style.rate, 2, take.frames)?;
        let _folder = self.stems.as_deref().map(Folder::new).transpose()?;
        let stems =
            self.stems.as_deref().map(|folder| Stems::create(folder, &self.output, style, take.frames));
        let stems = stems.transpose()?;
        let name = self.output.display().to_string();
        let progress = |label: String| {
            if show { Progress::new(label, take.frames) } else { Progress::hidden() }
        };
        let played = play(&take, style, &mut file, progress(name.clone()))?;
        let mut files = vec![file];
        if let Some(stems) = stems {
            files.extend(stems.render(&take, style, progress(format!("{name}, stems")))?);
        }
        let stems = files.len() - 1;
        // All files are complete before any of them is renamed.
        let clipped = files.into_iter().map(WavFile::finish).sum::<Result<u64>>()?;
        Ok(Report {
            output: self.output.clone(),
            seconds: take.frames as f64 / f64::from(style.rate),
            played,
            clipped,
            notes,
            silent,
            stems,
        })
    }
}

fn play(take: &Take, style: &Style, file: &mut WavFile, mut progress: Progress) -> Result<Played> {
    let played = style.source.perform(&style.setup(), |player| {
        take.play(player, style.blocks, |left, right| {
            progress.advance(left.len() as u64);
            file.write(&[left, right])
        })
    })?;
    ensure!(played.finite, "the render contains values that are not numbers");
    Ok(played)
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Report { output, seconds, played, clipped, notes, silent, stems } = self;
        write!(f, "{}: {seconds:.2} s, {notes} notes", output.display())?;
        if *silent > 0 {
            write!(f, " ({silent} of them play no piece of the kit)")?;
        }
        write!(f, ", peak {}, rendered in {:.1} s", decibels(played.peak), played.busy.as_secs_f64())?;
        if *clipped > 0 {
            write!(f, ", {clipped} samples clipped")?;
        }
        if *stems > 0 {
            write!(f, ", {stems} stems")?;
        }
        Ok(())
    }
}

/// A peak, full scale 1, as text in dBFS.
pub fn decibels(peak: f32) -> String {
    if peak > 0.0 { format!("{:.1} dBFS", 20.0 * peak.log10()) } else { "silent".to_owned() }
}
