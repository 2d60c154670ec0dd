//! The page of what is about the kit as a whole, and of the window.

use egui::{Rect, ScrollArea, Sense, Ui, UiBuilder, pos2};

use super::gesture::Gesture;
use super::values::Values;
use super::{knobs, theme};

/// Scales of the interface that can be chosen.
const SCALES: [(f32, &str); 5] =
    [(0.75, "75 %"), (1.0, "100 %"), (1.25, "125 %"), (1.5, "150 %"), (2.0, "200 %")];

/// Draws the page; `zoom` is the scale of the interface, a factor.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    values: Values<'_>,
    zoom: &mut f32,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let groups = ["Kit", "Playing", "Rendering"];
    ui.painter().rect_filled(rect, theme::CORNER, theme::of(ui).panel);
    ui.scope_builder(UiBuilder::new().max_rect(rect.shrink(10.0)), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let inner = ui.max_rect();
            let bottom = knobs::grid(ui, inner, &groups, values, set);
            let grid = Rect::from_min_max(inner.min, pos2(inner.max.x, bottom));
            ui.allocate_rect(grid, Sense::hover());
            ui.horizontal(|ui| {
                ui.label("Interface scale");
                for (scale, name) in SCALES {
                    if ui.selectable_label(*zoom == scale, name).clicked() {
                        *zoom = scale;
                        ui.ctx().set_zoom_factor(scale);
                    }
                }
            });
        });
    });
}
