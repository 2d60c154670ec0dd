//! When a stroke is, and on what.

/// Ticks in a quarter note.
pub(super) const PPQ: u32 = 480;

/// Ticks in a sixteenth note.
pub(super) const SIXTEENTH: u32 = PPQ / 4;

/// Ticks in a bar of 4/4.
pub(super) const BAR: u32 = 4 * PPQ;

/// One stroke of the score.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stroke {
    pub(super) tick: u32,
    pub(super) key: u8,
    pub(super) velocity: u8,
}
