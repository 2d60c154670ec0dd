//! Levels of the pieces and the outputs: meters that jump up at once and fall slowly.

use egui::{Color32, Rect, Ui, vec2};
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::KitSnapshot;

use super::theme::Palette;

/// Bottom of the meters, dB.
pub const FLOOR_DB: f32 = -60.0;

/// Top of the meters, dB: a little reserve above full scale.
const TOP_DB: f32 = 6.0;

/// How fast a meter falls, dB/s: slow enough to be read.
const FALL: f32 = 36.0;

/// Levels shown, dB.
pub struct Levels {
    /// `[slot]`, then left and right.
    shown: [f32; SLOTS + 2],
    /// Clock of the latest snapshot whose peaks were taken.
    clock: u64,
}

impl Default for Levels {
    fn default() -> Levels {
        Levels { shown: [FLOOR_DB; SLOTS + 2], clock: 0 }
    }
}

impl Levels {
    /// Takes in a snapshot, `elapsed` seconds after the last.
    pub fn follow(&mut self, snapshot: &KitSnapshot, elapsed: f32) {
        // Where the processor draws, frames are far apart; after a rest there is nothing to fall.
        let fall = FALL * elapsed.clamp(0.0, 0.5);
        // A host that stopped leaves its last snapshot behind: its peaks count once.
        let fresh = if snapshot.clock == self.clock { 0.0 } else { 1.0 };
        self.clock = snapshot.clock;
        let pieces = snapshot.pieces.iter().map(|piece| piece.peak);
        for (level, peak) in self.shown.iter_mut().zip(pieces.chain(snapshot.peak)) {
            *level = decibels(fresh * peak).max(*level - fall).clamp(FLOOR_DB, TOP_DB);
        }
    }

    /// Whether a meter is still on its way down.
    pub fn move_on(&self) -> bool {
        self.shown.iter().any(|&level| level > FLOOR_DB)
    }

    /// A piece's, dB.
    pub fn piece(&self, slot: Slot) -> f32 {
        self.shown[slot.index()]
    }

    /// Those of the outputs, left and right, dB.
    pub fn main(&self) -> [f32; 2] {
        [self.shown[SLOTS], self.shown[SLOTS + 1]]
    }
}

/// A peak of full scale 1 in dB; the bottom of the meters for what is no number.
pub fn decibels(peak: f32) -> f32 {
    if peak > 0.0 { 20.0 * peak.log10() } else { FLOOR_DB }
}

/// A level (full scale 1) as text in dB; nothing below the meters.
pub fn text(level: f32) -> String {
    if level > FLOOR_DB { format!("{level:+.0} dB") } else { String::new() }
}

/// Place of a level on a meter, 0 to 1.
pub fn share(level: f32) -> f32 {
    ((level - FLOOR_DB) / (TOP_DB - FLOOR_DB)).clamp(0.0, 1.0)
}

/// Draws a level (full scale 1) as a bar that grows along the longer side of `rect`.
pub fn bar(ui: &Ui, rect: Rect, level: f32, colour: Color32, palette: &Palette) {
    let painter = ui.painter();
    painter.rect_filled(rect, 2.0, palette.background);
    let colour = if level >= 0.0 { palette.over } else { colour };
    let filled = if rect.width() > rect.height() {
        Rect::from_min_size(rect.min, vec2(rect.width() * share(level), rect.height()))
    } else {
        let height = rect.height() * share(level);
        Rect::from_min_size(rect.min + vec2(0.0, rect.height() - height), vec2(rect.width(), height))
    };
    painter.rect_filled(filled, 2.0, colour);
}
