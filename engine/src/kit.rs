//! The kit: pieces rendered in short blocks on the kit's own clock and mixed to stereo.

use crate::piece::{Piece, PieceId};
use crate::snapshot::KitSnapshot;
use crate::strike::Strike;

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;

/// A live control of the kit. Acts at the next sample, smoothed on the kit's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Pitch of a drum, Hz, or of a cymbal, ratio; see [`Piece::tuning_range`].
    Tuning(PieceId),
    /// Muffling of a piece, 0 to 1.
    Muffling(PieceId),
    /// Level of a piece in the mix, dB; at or below [`SILENT_DB`] the piece is silent.
    Level(PieceId),
    /// Level of the whole mix, dB.
    Master,
}

/// Levels at or below this are silence, dB.
pub const SILENT_DB: f64 = -60.0;

/// The drum kit. Owns its pieces; renders them; the only way sound leaves the engine.
pub struct Kit {
    pieces: [Option<Box<Piece>>; PieceId::KIT.len()],
    clock: u64,
    dropped_strikes: u32,
}

impl Kit {
    /// An empty kit at a sample rate (Hz). Pieces arrive through [`install`](Self::install).
    pub fn new(_sample_rate: f64) -> Kit {
        Kit { pieces: Default::default(), clock: 0, dropped_strikes: 0 }
    }

    /// Puts a piece in its place and returns what stood there, to be dropped elsewhere.
    ///
    /// The piece takes over the present tuning and muffling. A piece that does not belong to the
    /// kit is handed back.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, piece: Box<Piece>) -> Option<Box<Piece>> {
        match piece.id().slot() {
            Some(slot) => self.pieces[slot].replace(piece),
            None => Some(piece),
        }
    }

    /// Whether every piece has been installed.
    pub fn is_complete(&self) -> bool {
        self.pieces.iter().all(Option::is_some)
    }

    /// Strikes a piece at the next sample. A stroke on a piece not yet built is dropped and counted.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, id: PieceId, strike: &Strike) {
        match id.slot().and_then(|slot| self.pieces[slot].as_mut()) {
            Some(piece) => piece.strike(strike),
            None => self.dropped_strikes = self.dropped_strikes.saturating_add(1),
        }
    }

    /// Moves a control from the next sample on.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set(&mut self, _control: Control, _value: f64) {}

    /// Renders both outputs, full scale 1, overwriting them. Any length; both the same.
    ///
    /// The same strikes and controls at the same samples give the same output, however the
    /// calls cut the time.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        self.clock += left.len() as u64;
    }

    /// Puts every piece to rest and the clock to zero; controls keep their values.
    pub fn reset(&mut self) {
        self.clock = 0;
    }

    /// Describes the kit to whoever draws it, and starts the peaks anew.
    ///
    /// # Real-time
    /// A copy, no allocation.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        into.clock = self.clock;
        into.dropped_strikes = self.dropped_strikes;
    }
}
