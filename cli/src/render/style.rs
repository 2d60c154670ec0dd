//! How a song is played and stored.

use overhear::kit_document::KitDocument;

use crate::player::{Blocks, Setup, Source};
use crate::settings::Setting;
use crate::wav::Bits;

/// How to play and store a song.
#[derive(Debug, Clone)]
pub struct Style {
    /// Source of the sound.
    pub source: Source,
    /// Sample rate, Hz.
    pub rate: u32,
    /// The kit and its notes.
    pub kit: KitDocument,
    /// Parameters moved before the start.
    pub settings: Vec<Setting>,
    /// How the sound is cut into buffers.
    pub blocks: Blocks,
    /// How samples are stored.
    pub bits: Bits,
    /// Sound after the last note, seconds.
    pub tail: f64,
    /// The only channel played, 1 to 16, or all.
    pub channel: Option<u8>,
}

impl Style {
    /// Settings of the performer.
    pub fn setup(&self) -> Setup {
        Setup { rate: self.rate, kit: self.kit.clone(), settings: self.settings.clone() }
    }
}
