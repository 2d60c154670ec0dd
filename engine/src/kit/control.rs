//! What of a kit can be moved while it plays.

use crate::piece::PieceId;

/// A live control of the kit. Acts from the next sample on, smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Pitch of a drum, Hz, or of a cymbal, ratio; see [`Piece::tuning_range`](crate::piece::Piece::tuning_range).
    Tuning(PieceId),
    /// Muffling of a piece, 0 to 1.
    Muffling(PieceId),
    /// Force that presses the snare wires on, N.
    SnarePreload,
    /// Whether the snare wires lie against the head: below one half they are off.
    SnareWires,
    /// Level of a piece in the mix, dB; at or below [`SILENT_DB`](crate::kit::SILENT_DB) the piece is silent.
    Level(PieceId),
    /// Where a piece lies in the stereo, -1 (left) to 1 (right); see [`Placement::side`].
    ///
    /// [`Placement::side`]: crate::layout::Placement::side
    Pan(PieceId),
    /// Level of the whole mix, dB.
    Master,
}
