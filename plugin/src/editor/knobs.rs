//! Rows of knobs, switches and lists: one for each parameter of a piece or a group.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::control;
use super::gesture::Gesture;
use super::theme;
use super::values::{Item, Values};

/// Room of a knob where there is enough, points.
const CELL: [f32; 2] = [96.0, 92.0];

/// Space between panels, points.
const GAP: f32 = 8.0;

/// Height of a panel of one row with its heading, points.
pub const PANEL_HEIGHT: f32 = 118.0;

/// Draws a panel with a heading and a row of knobs that shares its width.
pub fn panel(
    ui: &mut Ui,
    rect: Rect,
    (heading, accent): (&str, Color32),
    items: &[Item<'_>],
    set: &mut dyn FnMut(usize, Gesture),
) {
    let palette = theme::of(ui);
    ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
    let at = pos2(rect.min.x + 14.0, rect.min.y + 13.0);
    ui.painter().text(at, Align2::LEFT_CENTER, heading, theme::body(), accent);
    let inner = Rect::from_min_max(rect.min + vec2(8.0, 22.0), rect.max - vec2(8.0, 2.0));
    let width = CELL[0].min(inner.width() / items.len().max(1) as f32);
    for (place, item) in items.iter().enumerate() {
        let at = pos2(inner.min.x + place as f32 * width, inner.min.y);
        let cell = Rect::from_min_size(at, vec2(width, CELL[1].min(inner.height())));
        control::control(ui, cell, item, accent, set);
    }
}

/// Draws a panel for each group, beside each other.
pub fn panels(
    ui: &mut Ui,
    rect: Rect,
    groups: &[&str],
    values: Values<'_>,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let accent = theme::of(ui).accent;
    let width = rect.width() / groups.len().max(1) as f32;
    for (place, group) in groups.iter().enumerate() {
        let left = rect.min.x + place as f32 * width;
        let right = left + width - if place + 1 < groups.len() { GAP } else { 0.0 };
        let part = Rect::from_x_y_ranges(left..=right, rect.y_range());
        panel(ui, part, (group, accent), &values.of_group(group), set);
    }
}

/// Draws the knobs of groups in rows as they fit, and returns how far down they reach.
pub fn grid(
    ui: &mut Ui,
    rect: Rect,
    groups: &[&str],
    values: Values<'_>,
    set: &mut dyn FnMut(usize, Gesture),
) -> f32 {
    let palette = theme::of(ui);
    let mut top = rect.min.y;
    for group in groups {
        let heading = pos2(rect.min.x + 4.0, top + 10.0);
        ui.painter().text(heading, Align2::LEFT_CENTER, *group, theme::body(), palette.accent);
        top += 22.0;
        let items = values.of_group(group);
        let columns = ((rect.width() / CELL[0]) as usize).clamp(1, items.len().max(1));
        for (place, item) in items.iter().enumerate() {
            let (column, row) = ((place % columns) as f32, (place / columns) as f32);
            let at = pos2(rect.min.x + column * CELL[0], top + row * CELL[1]);
            let cell = Rect::from_min_size(at, vec2(CELL[0], CELL[1] - 4.0));
            control::control(ui, cell, item, palette.accent, set);
        }
        top += CELL[1] * items.len().div_ceil(columns) as f32 + 4.0;
    }
    top
}
