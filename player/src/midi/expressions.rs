//! What expressions of a note do to the piece that it struck.

use overhear_engine::kit::{LOUDEST_DB, SILENT_DB};

/// What was done to a note.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expressions {
    /// Semitones that are added to the piece's tuning.
    pub bend: f64,
    /// Gain, a ratio.
    pub gain: f64,
    /// Added to the piece's pan, -1 to 1.
    pub pan: f64,
}

impl Expressions {
    /// Nothing.
    pub const NONE: Expressions = Expressions { bend: 0.0, gain: 1.0, pan: 0.0 };

    /// The level of a piece, dB, that has this one by itself.
    pub fn level(&self, own: f64) -> f64 {
        if self.gain == 1.0 || own <= SILENT_DB {
            return own;
        }
        (own + 20.0 * libm::log10(self.gain)).clamp(SILENT_DB, LOUDEST_DB)
    }

    /// The pan of a piece, -1 to 1, that has this one by itself.
    pub fn pan(&self, own: f64) -> f64 {
        (own + self.pan).clamp(-1.0, 1.0)
    }
}
