//! The energy of every piece, on a scale of decades.

use egui::{Align2, Rect, Ui, pos2, vec2};
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::KitSnapshot;

use crate::editor::plot::{Plot, energy_text};
use crate::editor::theme;
use crate::outputs::title;

/// Ends of the scale, J: what falls asleep, and a hard stroke on a kick.
const RANGE: (f32, f32) = (1e-10, 3.0);

/// Draws a bar for each piece.
pub fn show(ui: &Ui, rect: Rect, snapshot: &KitSnapshot) {
    let palette = theme::of(ui);
    let whole: f32 =
        snapshot.pieces.iter().map(|piece| piece.energy).filter(|energy| energy.is_finite()).sum();
    let plot = Plot::new(ui, rect, "Energy", &energy_text(whole));
    // No axis below: each bar says what it is.
    let area = Rect::from_min_max(plot.area.min, pos2(plot.area.max.x, rect.max.y - 8.0));
    let height = area.height() / PieceId::KIT.len() as f32;
    let painter = plot.painter();
    for (slot, piece) in PieceId::KIT.into_iter().enumerate() {
        let energy = snapshot.pieces[slot].energy;
        let row = Rect::from_min_size(area.min + vec2(0.0, slot as f32 * height), vec2(area.width(), height));
        let left = pos2(row.min.x, row.center().y);
        painter.text(left, Align2::LEFT_CENTER, title(piece), theme::caption(), palette.text);
        let right = pos2(row.max.x, row.center().y);
        painter.text(right, Align2::RIGHT_CENTER, energy_text(energy), theme::caption(), palette.faint);
        let room = Rect::from_min_max(
            pos2(row.min.x + 62.0, row.center().y - 3.0),
            pos2(row.max.x - 54.0, row.center().y + 3.0),
        );
        painter.rect_filled(room, 2.0, palette.background);
        let bar = Rect::from_min_size(room.min, vec2(room.width() * share(energy), room.height()));
        painter.rect_filled(bar, 2.0, palette.pieces[slot]);
    }
}

/// Place of an energy on the scale, 0 to 1.
fn share(energy: f32) -> f32 {
    let (least, most) = RANGE;
    if energy > least { ((energy / least).ln() / (most / least).ln()).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_stays_on_the_scale() {
        assert_eq!((share(f32::NAN), share(0.0), share(1e9)), (0.0, 0.0, 1.0));
        assert!(share(1e-3) > share(1e-6) && share(1e-6) > 0.0);
    }
}
