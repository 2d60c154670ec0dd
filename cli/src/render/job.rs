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
    counts: Counts,
    stems: usize,
}

/// What a song comes to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// Its messages at their samples.
    pub take: Take,
    /// What is in it.
    pub counts: Counts,
}

/// What is in a song.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Notes that are played.
    pub notes: usize,
    /// How many of them strike nothing.
    pub silent: usize,
    /// How many of them are on other channels than General MIDI's drums, in a song with notes there.
    pub elsewhere: usize,
    /// Program changes that are not followed.
    pub ignored: usize,
}

/// The channel of General MIDI's drums, from 1.
const DRUMS: u8 = 10;

/// A song's messages at their samples. It ends the style's tail after its last note.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the song is too long to be meant.
pub fn takes(song: &Song, style: &Style) -> Result<Taken> {
    let (mut counts, mut drums, mut last) = (Counts::default(), 0, 0);
    let follows = settings::follows_programs(&style.settings);
    let mut messages = Vec::new();
    for event in &song.events {
        let message = Message { sample: song.sample(event.time, style.rate), bytes: event.bytes };
        let channel = message.channel() + 1;
        if style.channel.is_some_and(|only| only != channel) {
            continue;
        }
        match message.meaning() {
            Meaning::NoteOn { key, .. } => {
                counts.notes += 1;
                counts.silent += usize::from(!settings::plays(&style.settings, &style.kit.notes, key));
                drums += usize::from(channel == DRUMS);
                last = message.sample;
            }
            Meaning::Program(_) => counts.ignored += usize::from(!follows),
            _ => {}
        }
        messages.push(message);
    }
    counts.elsewhere = if drums > 0 { counts.notes - drums } else { 0 };
    let tail = (style.tail * f64::from(style.rate)).round() as u64;
    Ok(Taken { take: Take { messages, frames: last.saturating_add(tail) }, counts })
}

impl Job {
    /// Renders the song and its stems. Shows progress if no other job does.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for what cannot be read or written; nothing is left
    /// behind then.
    pub fn run(&self, style: &Style, show: bool) -> Result<Report> {
        let song = Song::read(&self.song)?;
        let Taken { take, counts } = takes(&song, style)?;
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
            counts,
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
        let Report { output, seconds, played, clipped, counts, stems } = self;
        let Counts { notes, silent, elsewhere, ignored } = counts;
        write!(f, "{}: {seconds:.2} s, {notes} notes", output.display())?;
        if *silent > 0 {
            write!(f, " ({silent} of them play no piece of the kit)")?;
        }
        if *elsewhere > 0 {
            write!(f, " ({elsewhere} of them not on channel {DRUMS}: --channel {DRUMS} leaves them out)")?;
        }
        if *ignored > 0 {
            write!(f, " (program changes not followed: {ignored}; --set program_changes=on follows them)")?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::player::{Blocks, Source};
    use crate::song::Event;
    use crate::wav::Bits;
    use overhear::kit_document::KitDocument;

    /// What is in a song of program changes and notes on two channels, played so.
    fn counted(channel: Option<u8>, set: &[&str]) -> Counts {
        let bytes = [[0xC9, 0, 0], [0x99, 36, 90], [0x90, 60, 90], [0x90, 2, 90], [0x80, 60, 0]];
        let events = bytes.map(|bytes| Event { time: 0, bytes }).to_vec();
        let set: Vec<String> = set.iter().map(|&text| text.to_owned()).collect();
        let settings::Chosen { kit, settings } = settings::choose("default", None, &set).unwrap();
        assert_eq!(kit, KitDocument::standard());
        let (source, blocks, bits) = (Source::Engine, Blocks::Fixed(512), Bits::Float32);
        let style = Style { source, rate: 48_000, kit, settings, blocks, bits, tail: 0.0, channel };
        takes(&Song { events, unit: 1000 }, &style).unwrap().counts
    }

    #[test]
    fn songs_tell_what_is_not_for_drums_and_what_is_not_followed() {
        assert_eq!(counted(None, &[]), Counts { notes: 3, silent: 1, elsewhere: 2, ignored: 0 });
        assert_eq!(counted(Some(10), &[]), Counts { notes: 1, silent: 0, elsewhere: 0, ignored: 0 });
        // Without notes where drums are, other channels are what is meant.
        assert_eq!(
            counted(Some(1), &["kick_muffle=.5"]),
            Counts { notes: 2, silent: 1, elsewhere: 0, ignored: 0 }
        );
        assert_eq!(counted(None, &["kick_muffle=.5"]).ignored, 1);
        assert_eq!(counted(None, &["kick_muffle=.5", "program_changes=on"]).ignored, 0);
    }
}
