//! Stems: each microphone of a song in a file of its own.
//!
//! One pass of the engine, whatever plays the song: both give the same samples. Every piece's close microphone, the
//! overheads and the room, at the level of the mix, so that they add up to the song.

use std::path::Path;

use anyhow::Result;
use overhear::parameters::{find, parameters};
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::SLOTS;

use super::style::Style;
use crate::bad_input;
use crate::player::{EnginePlayer, LONGEST_BLOCK, Message, Player, Take};
use crate::progress::Progress;
use crate::wav::WavFile;

/// Files of the stems.
pub struct Stems {
    /// Each with the [output](overhear_engine::kit::Kit::render_outputs) that it takes.
    files: Vec<(usize, WavFile)>,
}

/// Outputs and names of the stems.
fn names(kit: &KitSpec) -> impl Iterator<Item = (usize, &str)> {
    let pieces = kit.slots().map(|(slot, piece)| (slot.index(), &*piece.name));
    pieces.chain([(SLOTS, "overheads"), (SLOTS + 1, "room")])
}

impl Stems {
    /// Creates the files in an existing folder; none of them may be the song.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if one cannot be written.
    pub fn create(folder: &Path, song: &Path, style: &Style, frames: u64) -> Result<Stems> {
        let create = |(output, name)| {
            let path = folder.join(format!("{name}.wav"));
            if path == song {
                return Err(bad_input!(
                    "`{}` would be both the song and a stem, accepted: different names",
                    path.display(),
                ));
            }
            Ok((output, WavFile::create(&path, style.bits, style.rate, 2, frames)?))
        };
        Ok(Stems { files: names(&style.kit.kit).map(create).collect::<Result<_>>()? })
    }

    /// Plays the take into the files.
    ///
    /// # Errors
    /// If the engine or a file fails.
    pub fn render(self, take: &Take, style: &Style, mut progress: Progress) -> Result<Vec<WavFile>> {
        let engine = EnginePlayer::new(&style.setup())?;
        let master = find("master_level", &style.kit.kit)?;
        let parameter = &parameters()[master];
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
        Ok(player.files.into_iter().map(|(_, file)| file).collect())
    }
}

struct StemPlayer {
    engine: EnginePlayer,
    /// Of the master.
    gain: f32,
    files: Vec<(usize, WavFile)>,
    /// `[output][side]`.
    buffers: Vec<[Vec<f32>; 2]>,
}

impl Player for StemPlayer {
    fn render(&mut self, messages: &[Message], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        let StemPlayer { engine, buffers, files, gain } = self;
        engine.play(messages, left.len(), |performer, part| {
            let mut outputs: Vec<Stereo<'_>> =
                buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[part.clone()])).collect();
            performer.render_outputs([&mut left[part.clone()], &mut right[part]], &mut outputs);
        });
        for (output, file) in files {
            let [left, right] = buffers[*output].each_mut().map(|side| &mut side[..left.len()]);
            left.iter_mut().chain(right.iter_mut()).for_each(|sample| *sample *= *gain);
            file.write(&[left, right])?;
        }
        Ok(())
    }
}
