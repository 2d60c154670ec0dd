//! The list of pieces: which one the panels are about, and how loud each is.

use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;

use super::levels::{self, Levels};
use super::theme;

/// Tallest row, points.
const TALLEST: f32 = 66.0;

/// Space between rows, points.
const GAP: f32 = 4.0;

/// Draws the list of a kit; a click chooses a piece.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    kit: &KitSpec,
    selected: &mut Slot,
    snapshot: &KitSnapshot,
    shown: &Levels,
) {
    let palette = theme::of(ui);
    let rows = kit.pieces.len() + 1;
    let height = ((rect.height() + GAP) / rows as f32).min(TALLEST);
    let row = |place: usize| {
        Rect::from_min_size(rect.min + vec2(0.0, place as f32 * height), vec2(rect.width(), height - GAP))
    };
    for (slot, piece) in kit.slots() {
        let row = row(slot.index());
        let response = ui.interact(row, ui.scope_id().with(("piece", slot)), Sense::click());
        if response.clicked() {
            *selected = slot;
        }
        let fill = match (*selected == slot, response.hovered()) {
            (true, _) => palette.raised,
            (false, true) => palette.hovered,
            (false, false) => palette.panel,
        };
        let accent = palette.pieces[slot.index()];
        let painter = ui.painter();
        painter.rect_filled(row, theme::CORNER, fill);
        let width = if *selected == slot { 5.0 } else { 3.0 };
        painter.rect_filled(Rect::from_min_size(row.min, vec2(width, row.height())), 2.0, accent);
        let ready = snapshot.pieces[slot.index()].ready;
        let colour = if ready { palette.text } else { palette.faint };
        let middle = row.min.y + 0.40 * row.height();
        let note = if ready { levels::text(shown.piece(slot)) } else { "building".into() };
        let at = pos2(row.max.x - 10.0, middle);
        let noted = painter.text(at, Align2::RIGHT_CENTER, note, theme::caption(), palette.faint);
        // A long title ends where the level begins.
        let room = Rect::from_x_y_ranges(row.min.x..=noted.min.x - 6.0, row.y_range());
        let name = pos2(row.min.x + 14.0, middle);
        painter.with_clip_rect(room).text(name, Align2::LEFT_CENTER, &piece.title, theme::body(), colour);
        levels::bar(ui, strip(row, 0.0), shown.piece(slot), accent, palette);
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
        levels::bar(ui, strip(row, (1 - place) as f32), level, palette.level, palette);
    }
}

/// Height of a meter in a row, points.
fn thickness(row: Rect) -> f32 {
    if row.height() < 32.0 { 2.0 } else { 4.0 }
}

/// A meter's place at the bottom of a row, so many meters up.
fn strip(row: Rect, up: f32) -> Rect {
    let height = thickness(row);
    let bottom = row.max.y - 0.12 * row.height() - up * (height + 1.0);
    Rect::from_min_max(pos2(row.min.x + 14.0, bottom - height), pos2(row.max.x - 10.0, bottom))
}
