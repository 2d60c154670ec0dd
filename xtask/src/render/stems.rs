//! The microphones of a song, each to a file of its own.
//!
//! One pass of the engine, whatever plays the song: both give the same samples. Every piece's close microphone, the
//! overheads and the room, at the level of the mix, so that they add up to the song.

use std::path::Path;

use anyhow::Result;
use overhear::parameters::find;
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::piece::PieceId;

use super::Style;
use crate::bad_input;
use crate::player::{EnginePlayer, Hit, LONGEST_BLOCK, Player, Setup, Take};
use crate::progress::Progress;
use crate::wav::WavFile;

/// Files of the stems, in the order of [`Kit::render_outputs`](overhear_engine::kit::Kit::render_outputs).
pub struct Stems {
    files: Vec<WavFile>,
}

/// Names of the stems.
fn names() -> impl Iterator<Item = &'static str> {
    PieceId::KIT.into_iter().map(PieceId::name).chain(["overheads", "room"])
}

impl Stems {
    /// Creates the files in an existing folder; none of them may be the song.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if one cannot be written.
    pub fn create(folder: &Path, song: &Path, style: &Style, frames: u64) -> Result<Stems> {
        let create = |name| {
            let path = folder.join(format!("{name}.wav"));
            if path == song {
                return Err(bad_input!(
                    "`{}` would be the song and a stem, accepted: different names",
                    path.display(),
                ));
            }
            WavFile::create(&path, style.bits, style.rate, 2, frames)
        };
        Ok(Stems { files: names().map(create).collect::<Result<_>>()? })
    }

    /// Plays the take into the files.
    ///
    /// # Errors
    /// If the engine or a file fails.
    pub fn render(self, take: &Take, style: &Style, mut progress: Progress) -> Result<Vec<WavFile>> {
        let setup = Setup { rate: style.rate, settings: style.settings.clone(), stage: style.stage };
        let engine = EnginePlayer::new(&setup)?;
        let (master, parameter) = find("master_level")?;
        let decibels = engine.performer.parameter(master).unwrap_or(parameter.default);
        let silent = decibels <= parameter.min;
        let buffer = || vec![0.0; LONGEST_BLOCK as usize];
        let mut player = StemPlayer {
            engine,
            gain: if silent { 0.0 } else { 10.0_f32.powf(decibels / 20.0) },
            files: self.files,
            buffers: (0..OUTPUTS).map(|_| [buffer(), buffer()]).collect(),
        };
        take.play(&mut player, style.blocks, |left, _| {
            progress.advance(left.len() as u64);
            Ok(())
        })?;
        Ok(player.files)
    }
}

struct StemPlayer {
    engine: EnginePlayer,
    /// Of the master.
    gain: f32,
    files: Vec<WavFile>,
    /// `[output][side]`.
    buffers: Vec<[Vec<f32>; 2]>,
}

impl Player for StemPlayer {
    fn render(&mut self, hits: &[Hit], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        let StemPlayer { engine, buffers, files, gain } = self;
        engine.play(hits, left.len(), |performer, part| {
            let mut outputs: Vec<Stereo<'_>> =
                buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[part.clone()])).collect();
            performer.render_outputs([&mut left[part.clone()], &mut right[part]], &mut outputs);
        });
        for (file, pair) in files.iter_mut().zip(buffers) {
            let [left, right] = pair.each_mut().map(|side| &mut side[..left.len()]);
            left.iter_mut().chain(right.iter_mut()).for_each(|sample| *sample *= *gain);
            file.write(&[left, right])?;
        }
        Ok(())
    }
}
