//! Rows of knobs: one for each parameter of a group.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};
use nice_plug::prelude::FloatParam;

use super::knob::{self, Gesture};
use super::theme;
use crate::parameters::{PARAMETERS, Parameter};

/// Room of a knob where there is enough, points.
const CELL: [f32; 2] = [96.0, 92.0];

/// Height of a panel of one row with its heading, points.
pub const PANEL_HEIGHT: f32 = 118.0;

/// Parameters of a group by their index.
pub fn of_group<'a>(
    group: &'a str,
    values: &'a [FloatParam],
) -> impl Iterator<Item = (usize, &'static Parameter, &'a FloatParam)> + 'a {
    let all = PARAMETERS.iter().zip(values).enumerate();
    all.filter(move |(_, (parameter, _))| parameter.group == group)
        .map(|(index, (parameter, value))| (index, parameter, value))
}

/// Draws a panel with a heading and a row of knobs that shares its width.
pub fn panel(
    ui: &mut Ui,
    rect: Rect,
    (group, accent): (&str, Color32),
    values: &[FloatParam],
    set: &mut dyn FnMut(usize, Gesture),
) {
    let palette = theme::of(ui);
    ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
    let heading = pos2(rect.min.x + 14.0, rect.min.y + 13.0);
    ui.painter().text(heading, Align2::LEFT_CENTER, group, theme::body(), accent);
    let inner = Rect::from_min_max(rect.min + vec2(8.0, 22.0), rect.max - vec2(8.0, 2.0));
    let count = of_group(group, values).count().max(1);
    let width = CELL[0].min(inner.width() / count as f32);
    for (place, (index, parameter, value)) in of_group(group, values).enumerate() {
        let at = pos2(inner.min.x + place as f32 * width, inner.min.y);
        let cell = Rect::from_min_size(at, vec2(width, CELL[1].min(inner.height())));
        knob::knob(ui, cell, parameter, value, accent, |gesture| set(index, gesture));
    }
}

/// Draws knobs in rows as they fit, and returns how far down they reach.
pub fn grid(
    ui: &mut Ui,
    rect: Rect,
    groups: &[&str],
    values: &[FloatParam],
    set: &mut dyn FnMut(usize, Gesture),
) -> f32 {
    let palette = theme::of(ui);
    let mut top = rect.min.y;
    for group in groups {
        let heading = pos2(rect.min.x + 4.0, top + 10.0);
        ui.painter().text(heading, Align2::LEFT_CENTER, *group, theme::body(), palette.accent);
        top += 22.0;
        let count = of_group(group, values).count();
        let columns = ((rect.width() / CELL[0]) as usize).clamp(1, count.max(1));
        for (place, (index, parameter, value)) in of_group(group, values).enumerate() {
            let (column, row) = ((place % columns) as f32, (place / columns) as f32);
            let at = pos2(rect.min.x + column * CELL[0], top + row * CELL[1]);
            let cell = Rect::from_min_size(at, vec2(CELL[0], CELL[1] - 4.0));
            knob::knob(ui, cell, parameter, value, palette.accent, |gesture| set(index, gesture));
        }
        top += CELL[1] * count.div_ceil(columns) as f32 + 4.0;
    }
    top
}
