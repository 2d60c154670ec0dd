//! A fader for one parameter: what hands do is as with a [knob](super::knob), and the cap goes as far as the hand.

use egui::{Color32, Rect, Stroke, Ui, pos2, vec2};

use super::gesture::Gesture;
use super::knob;
use super::theme;
use super::values::Item;

/// Size of the cap, points.
const CAP: [f32; 2] = [24.0, 13.0];

/// Shows a parameter as a fader, its way in one rectangle and its value in another, and reports what was done with it.
pub fn fader(
    ui: &mut Ui,
    [way, value]: [Rect; 2],
    item: &Item<'_>,
    accent: Color32,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let id = ui.scope_id().with(("fader", item.index));
    let way = way.shrink2(vec2(0.0, 0.5 * CAP[1] + 2.0));
    let hit = Rect::from_center_size(way.center(), vec2(CAP[0] + 8.0, way.height() + CAP[1]));
    let (response, place) = knob::hand(ui, hit, id, (item, 1.0 / way.height().max(1.0)), set);
    let palette = theme::of(ui);
    let y = |place: f32| way.max.y - place.clamp(0.0, 1.0) * way.height();
    let (x, at) = (way.center().x, y(place));
    let painter = ui.painter();
    painter.rect_filled(Rect::from_x_y_ranges(x - 2.0..=x + 2.0, way.y_range()), 2.0, palette.raised);
    painter.rect_filled(Rect::from_x_y_ranges(x - 2.0..=x + 2.0, at..=way.max.y), 2.0, accent);
    // Where it is until somebody moves it.
    let usual = y(item.place(item.usual()));
    painter.hline(x - 0.5 * CAP[0]..=x + 0.5 * CAP[0], usual, Stroke::new(1.0, palette.faint));
    let cap = Rect::from_center_size(pos2(x, at), vec2(CAP[0], CAP[1]));
    let active = response.hovered() || response.dragged();
    painter.rect(
        cap,
        3.0,
        if active { palette.hovered } else { palette.raised },
        Stroke::new(1.0, palette.faint),
        egui::StrokeKind::Inside,
    );
    painter.hline(cap.shrink(4.0).x_range(), at, Stroke::new(2.0, palette.text));
    response.on_hover_ui(|ui| {
        ui.label(knob::tip(item));
    });
    knob::value_text(ui, value, id.with("value"), item, set);
}
