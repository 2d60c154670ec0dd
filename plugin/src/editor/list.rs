//! The list of pieces: which one the panels are about, and how loud each is.

use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::KitSnapshot;

use super::levels::{self, Levels};
use super::theme;
use crate::outputs::title;

/// Tallest row, points.
const TALLEST: f32 = 66.0;

/// Space between rows, points.
const GAP: f32 = 4.0;

/// Draws the list; a click chooses a piece.
pub fn show(ui: &mut Ui, rect: Rect, selected: &mut usize, snapshot: &KitSnapshot, shown: &Levels) {
    let palette = theme::of(ui);
    let rows = PieceId::KIT.len() + 1;
    let height = ((rect.height() + GAP) / rows as f32).min(TALLEST);
    let row = |place: usize| {
        Rect::from_min_size(rect.min + vec2(0.0, place as f32 * height), vec2(rect.width(), height - GAP))
    };
    for (slot, piece) in PieceId::KIT.into_iter().enumerate() {
        let row = row(slot);
        let response = ui.interact(row, ui.scope_id().with(("piece", slot)), Sense::click());
        if response.clicked() {
            *selected = slot;
        }
        let fill = match (*selected == slot, response.hovered()) {
            (true, _) => palette.raised,
            (false, true) => palette.hovered,
            (false, false) => palette.panel,
        };
        let accent = palette.pieces[slot];
        let painter = ui.painter();
        painter.rect_filled(row, theme::CORNER, fill);
        let width = if *selected == slot { 5.0 } else { 3.0 };
        painter.rect_filled(Rect::from_min_size(row.min, vec2(width, row.height())), 2.0, accent);
        let ready = snapshot.pieces[slot].ready;
        let colour = if ready { palette.text } else { palette.faint };
        let middle = row.min.y + 0.40 * row.height();
        let name = pos2(row.min.x + 14.0, middle);
        painter.text(name, Align2::LEFT_CENTER, title(piece), theme::body(), colour);
        let note = if ready { levels::text(shown.piece(slot)) } else { "building".into() };
        let at = pos2(row.max.x - 10.0, middle);
        painter.text(at, Align2::RIGHT_CENTER, note, theme::caption(), palette.faint);
        levels::bar(ui, strip(row, 0.0, 4.0), shown.piece(slot), accent, palette);
    }
    let row = row(rows - 1);
    ui.painter().rect_filled(row, theme::CORNER, palette.panel);
    let [left, right] = shown.main();
    let middle = row.min.y + 0.36 * row.height();
    let painter = ui.painter();
    painter.text(pos2(row.min.x + 14.0, middle), Align2::LEFT_CENTER, "Main", theme::body(), palette.text);
    let loudest = levels::text(left.max(right));
    painter.text(
        pos2(row.max.x - 10.0, middle),
        Align2::RIGHT_CENTER,
        loudest,
        theme::caption(),
        palette.faint,
    );
    for (place, level) in [left, right].into_iter().enumerate() {
        levels::bar(ui, strip(row, 5.0 * (1 - place) as f32, 4.0), level, palette.level, palette);
    }
}

/// A meter's place at the bottom of a row.
fn strip(row: Rect, up: f32, height: f32) -> Rect {
    let bottom = row.max.y - 0.12 * row.height() - up;
    Rect::from_min_max(pos2(row.min.x + 14.0, bottom - height), pos2(row.max.x - 10.0, bottom))
}
