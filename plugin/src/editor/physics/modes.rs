//! The modes of a piece as a list; a click shows one alone.

use std::f32::consts::TAU;

use egui::{Align2, Color32, Rect, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};
use overhear_engine::snapshot::{FIELD_MODES, FieldShapes, PieceSnapshot};

use crate::editor::plot::time_text;
use crate::editor::theme;

/// Height of a row, points.
const ROW: f32 = 20.0;

/// Room above the list, points.
const HEAD: f32 = 46.0;

/// Draws the list; says which row was clicked.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    piece: &PieceSnapshot,
    shapes: Option<&FieldShapes>,
    chosen: Option<usize>,
    accent: Color32,
) -> Option<usize> {
    let palette = theme::of(ui);
    ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
    let painter = ui.painter();
    let line = rect.min.y + 14.0;
    painter.text(pos2(rect.min.x + 12.0, line), Align2::LEFT_CENTER, "Modes", theme::body(), palette.text);
    let hint = "click one to see its shape";
    painter.text(pos2(rect.max.x - 12.0, line), Align2::RIGHT_CENTER, hint, theme::caption(), palette.faint);
    let heads = [(0.0, "diameters, circles"), (0.64, "Hz"), (0.93, "T60")];
    let inner = Rect::from_min_max(rect.min + vec2(12.0, HEAD), rect.max - vec2(6.0, 6.0));
    let at = |row: Rect, share: f32| pos2(row.min.x + share * (row.width() - 12.0), row.center().y);
    for (share, text) in heads {
        let align = if share > 0.0 { Align2::RIGHT_CENTER } else { Align2::LEFT_CENTER };
        let place = pos2(at(inner, share).x, rect.min.y + 35.0);
        painter.text(place, align, text, theme::caption(), palette.faint);
    }
    let loudest = piece.displacement.iter().fold(1e-9_f32, |most, q| most.max(q.abs()));
    let mut clicked = None;
    ui.scope_builder(UiBuilder::new().max_rect(inner), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for mode in (0..FIELD_MODES).filter(|&mode| piece.modes[mode].omega > 0.0) {
                let (row, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
                if response.clicked() {
                    clicked = Some(mode);
                }
                let painter = ui.painter();
                let fill = match (chosen == Some(mode), response.hovered()) {
                    (true, _) => palette.raised,
                    (false, true) => palette.hovered,
                    (false, false) => Color32::TRANSPARENT,
                };
                painter.rect_filled(row, 3.0, fill);
                // How much it moves now, against the one that moves most.
                let share = (piece.displacement[mode].abs() / loudest).min(1.0).sqrt();
                let bar = Rect::from_min_size(
                    row.min + vec2(0.0, 3.0),
                    vec2(3.0 + 30.0 * share, row.height() - 6.0),
                );
                painter.rect_filled(bar, 2.0, accent.gamma_multiply(0.25 + 0.5 * share));
                let order = shapes.and_then(|shapes| shapes.orders.get(mode));
                let name = order.map_or(String::new(), |[m, n]| format!("({m}, {n})"));
                let values = piece.modes[mode];
                let texts = [
                    (0.16, Align2::LEFT_CENTER, name),
                    (0.64, Align2::RIGHT_CENTER, format!("{:.1}", values.omega / TAU)),
                    (0.93, Align2::RIGHT_CENTER, time_text(t60(values.sigma))),
                ];
                for (share, align, text) in texts {
                    painter.text(at(row, share), align, text, theme::caption(), palette.text);
                }
            }
        });
    });
    clicked
}

/// Time in which an amplitude that decays at a rate (1/s) falls by 60 dB, s.
fn t60(sigma: f32) -> f32 {
    1e3_f32.ln() / sigma.max(1e-3)
}
