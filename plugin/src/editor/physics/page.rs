//! What the page of physics is drawn from, and how it is divided.

use std::sync::Arc;

use egui::{Rect, pos2};
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{FieldShapes, KitSnapshot};

use crate::sound::Sound;

/// Space between diagrams, points.
const GAP: f32 = 8.0;

/// What the page is drawn from.
pub struct Seen<'a> {
    pub snapshot: &'a KitSnapshot,
    pub kit: &'a KitSpec,
    /// The piece that the diagrams are about, and its mode shapes once it is built.
    pub selected: (Slot, &'a PieceSpec),
    pub shapes: Option<Arc<FieldShapes>>,
    pub sound: &'a Sound,
}

/// Two parts of a rectangle with a gap between, beside each other or one over the other; the first has the `share` (0 to 1).
pub fn halves(rect: Rect, share: f32, beside: bool) -> (Rect, Rect) {
    let gap = 0.5 * GAP;
    if beside {
        let x = rect.min.x + share * rect.width();
        (
            Rect::from_min_max(rect.min, pos2(x - gap, rect.max.y)),
            Rect::from_min_max(pos2(x + gap, rect.min.y), rect.max),
        )
    } else {
        let y = rect.min.y + share * rect.height();
        (
            Rect::from_min_max(rect.min, pos2(rect.max.x, y - gap)),
            Rect::from_min_max(pos2(rect.min.x, y + gap), rect.max),
        )
    }
}
