//! Players: the engine itself, or the built plugin in an embedded host.
//!
//! Both are given the same MIDI messages at the same samples and the same parameters from the start, and
//! give the same samples, bit by bit.

mod engine;
mod role;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use overhear::kit_document::KitDocument;
use overhear::parameters::{self, COUNT, host_id, parameters};

use crate::bad_input;
use crate::host::{self, Bundle, Instance, Processor};

pub use crate::message::Message;
pub use engine::EnginePlayer;
pub use role::{Player, Setup};

/// Longest buffer that is played.
pub const LONGEST_BLOCK: u32 = 8192;

/// Source of the sound.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// The engine, through the performer the plugin uses.
    Engine,
    /// A CLAP bundle.
    Clap(PathBuf),
}

impl Source {
    /// Sets a player up and lets `work` use it.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if the bundle or the sample rate cannot be used; what
    /// `work` returns.
    pub fn perform<T: Send>(
        &self,
        setup: &Setup,
        work: impl FnOnce(&mut dyn Player) -> Result<T> + Send,
    ) -> Result<T> {
        match self {
            Source::Engine => work(&mut EnginePlayer::new(setup)?),
            Source::Clap(path) => {
                let mut instance = Bundle::load(path)?.instantiate()?;
                instance.set_offline()?;
                set_up(&mut instance, setup).map_err(|error| bad_input!("`{}` {error:#}", path.display()))?;
                instance.run(f64::from(setup.rate), 1..=LONGEST_BLOCK, |processor| {
                    work(&mut ClapPlayer { processor, events: Vec::new() })
                })
            }
        }
    }
}

/// Gives a plugin the kit and the parameters.
fn set_up(instance: &mut Instance, setup: &Setup) -> Result<()> {
    let kit = &setup.kit.kit;
    let mut values = BTreeMap::new();
    if setup.kit != KitDocument::standard() {
        host::set_kit(instance, &setup.kit).context("does not take the kit")?;
        // So far the plugin has the parameters of the standard kit.
        values.extend((0..COUNT).map(|index| (index, parameters::default_value(index, kit))));
    }
    values.extend(setup.settings.iter().copied());
    let known = instance.parameters()?;
    let value = |(index, value): (usize, f32)| {
        let parameter = &parameters()[index];
        let id = host_id(parameter.id);
        ensure!(known.iter().any(|info| info.id == id), "has no parameter {}", parameters::name(index, kit));
        Ok((id, parameter.in_clap(value)))
    };
    instance.set_parameters(&values.into_iter().map(value).collect::<Result<Vec<_>>>()?)
}

struct ClapPlayer<'a> {
    processor: &'a mut Processor,
    events: Vec<host::Event>,
}

impl Player for ClapPlayer<'_> {
    fn render(&mut self, messages: &[Message], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        self.events.clear();
        self.events.extend(messages.iter().map(|message| host::Event {
            offset: message.sample as u32,
            what: host::What::Midi(message.bytes),
        }));
        self.processor.process(&self.events, left, right)
    }
}

/// Buffer sizes of a take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blocks {
    /// All of one length.
    Fixed(u32),
    /// Of 1 to [`LONGEST_BLOCK`] samples, the same sequence every time.
    Random,
}

impl std::str::FromStr for Blocks {
    type Err = String;

    fn from_str(text: &str) -> Result<Blocks, String> {
        match text.parse() {
            _ if text == "random" => Ok(Blocks::Random),
            Ok(frames @ 1..=LONGEST_BLOCK) => Ok(Blocks::Fixed(frames)),
            _ => Err(format!("accepted: 1 to {LONGEST_BLOCK} samples, or random")),
        }
    }
}

impl Blocks {
    /// Lengths of the buffers, for ever.
    pub fn lengths(self) -> impl Iterator<Item = usize> {
        let mut random = fastrand::Rng::with_seed(0);
        std::iter::from_fn(move || match self {
            Blocks::Fixed(frames) => Some(frames as usize),
            Blocks::Random => {
                // Powers of two make short buffers as likely as long.
                let longest = 1 << random.u32(..=LONGEST_BLOCK.ilog2());
                Some(random.usize(1..=longest))
            }
        })
    }
}

/// Messages to play and for how long.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Take {
    /// Messages by sample.
    pub messages: Vec<Message>,
    /// Length, samples.
    pub frames: u64,
}

/// Result of playing a take.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Played {
    /// Greatest magnitude of a sample, full scale 1.
    pub peak: f32,
    /// Whether every sample was a number.
    pub finite: bool,
    /// Time spent rendering.
    pub busy: Duration,
}

impl Take {
    /// Plays the take and hands every buffer of left and right samples to `sink`.
    ///
    /// # Errors
    /// If the player or the sink fails.
    pub fn play(
        &self,
        player: &mut dyn Player,
        blocks: Blocks,
        mut sink: impl FnMut(&[f32], &[f32]) -> Result<()>,
    ) -> Result<Played> {
        let mut played = Played { finite: true, ..Played::default() };
        let mut buffers = [vec![0.0; LONGEST_BLOCK as usize], vec![0.0; LONGEST_BLOCK as usize]];
        let [left, right] = &mut buffers;
        let (mut start, mut next, mut inside) = (0, 0, Vec::new());
        for length in blocks.lengths() {
            let end = self.frames.min(start + length as u64);
            if start == end {
                break;
            }
            let later = self.messages[next..].iter().position(|message| message.sample >= end);
            let last = later.map_or(self.messages.len(), |count| next + count);
            inside.clear();
            let within = |message: &Message| Message { sample: message.sample - start, ..*message };
            inside.extend(self.messages[next..last].iter().map(within));
            let frames = (end - start) as usize;
            let (left, right) = (&mut left[..frames], &mut right[..frames]);
            let begun = Instant::now();
            player.render(&inside, left, right).with_context(|| format!("at sample {start}"))?;
            played.busy += begun.elapsed();
            for &sample in left.iter().chain(right.iter()) {
                played.peak = played.peak.max(sample.abs());
                played.finite &= sample.is_finite();
            }
            sink(left, right)?;
            (start, next) = (end, last);
        }
        Ok(played)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes the number of the sample, and 1000 more where a message is.
    struct Ruler(u64);

    impl Player for Ruler {
        fn render(&mut self, messages: &[Message], left: &mut [f32], right: &mut [f32]) -> Result<()> {
            for sample in left.iter_mut() {
                *sample = self.0 as f32;
                self.0 += 1;
            }
            for message in messages {
                left[message.sample as usize] += 1000.0;
            }
            right.copy_from_slice(left);
            Ok(())
        }
    }

    fn ruled(blocks: Blocks) -> Vec<f32> {
        let note = |sample| Message::note(sample, 9, 36, 1);
        let take = Take { messages: [0, 16, 17, 17, 99].map(note).to_vec(), frames: 100 };
        let mut all = Vec::new();
        let played = take.play(&mut Ruler(0), blocks, |left, right| {
            assert_eq!(left, right);
            all.extend_from_slice(left);
            Ok(())
        });
        assert_eq!(played.unwrap().peak, 2017.0);
        all
    }

    #[test]
    fn every_cut_gives_every_message_its_sample() {
        let whole = ruled(Blocks::Fixed(8192));
        assert_eq!(whole.len(), 100);
        assert_eq!((whole[15], whole[16], whole[17], whole[99]), (15.0, 1016.0, 2017.0, 1099.0));
        for blocks in [Blocks::Fixed(1), Blocks::Fixed(17), Blocks::Random] {
            assert_eq!(ruled(blocks), whole, "{blocks:?}");
        }
    }

    #[test]
    fn random_blocks_are_the_same_every_time_and_within_bounds() {
        let lengths = |_| Blocks::Random.lengths().take(10_000).collect::<Vec<_>>();
        let sizes = lengths(0);
        assert_eq!(sizes, lengths(1));
        assert!(sizes.iter().all(|length| (1..=8192).contains(length)));
        assert!(sizes.contains(&1) && sizes.iter().any(|length| *length > 6000));
    }

    #[test]
    fn block_sizes_are_read_and_refused() {
        assert_eq!("64".parse(), Ok(Blocks::Fixed(64)));
        assert_eq!("random".parse(), Ok(Blocks::Random));
        for text in ["0", "8193", "-1", "many", ""] {
            assert!(text.parse::<Blocks>().unwrap_err().contains("1 to 8192"));
        }
    }
}
