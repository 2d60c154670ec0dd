//! What every player does, and what it is given.

use anyhow::Result;
use overhear::kit_document::KitDocument;

use crate::message::Message;
use crate::settings::Setting;

/// Something that turns messages into sound, buffer by buffer.
pub trait Player {
    /// Renders one buffer with the messages in it, ordered by sample.
    ///
    /// # Errors
    /// If the plugin fails.
    fn render(&mut self, messages: &[Message], left: &mut [f32], right: &mut [f32]) -> Result<()>;
}

/// A player's settings.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Sample rate, Hz.
    pub rate: u32,
    /// The kit and its notes.
    pub kit: KitDocument,
    /// Parameters moved before the start.
    pub settings: Vec<Setting>,
}
