//! What a parameter is moved by: a switch where it is on or off, a list where there is a choice, a knob otherwise.

use egui::{Align2, Color32, ComboBox, FontId, Rect, RichText, Sense, Stroke, Ui, UiBuilder, pos2, vec2};

use super::gesture::Gesture;
use super::knob;
use super::theme;
use super::values::Item;

/// Height of the name above, points.
const LINE: f32 = 18.0;

/// A switch, points.
const SWITCH: [f32; 2] = [38.0, 20.0];

/// Shows a parameter in `rect` and reports what was done with it.
pub fn control(
    ui: &mut Ui,
    rect: Rect,
    item: &Item<'_>,
    accent: Color32,
    set: &mut dyn FnMut(usize, Gesture),
) {
    match item.parameter.choices {
        [] => knob::knob(ui, rect, item, accent, set),
        ["off", "on"] => switch(ui, rect, item, accent, set),
        choices => list(ui, rect, item, choices, set),
    }
}

fn switch(ui: &mut Ui, rect: Rect, item: &Item<'_>, accent: Color32, set: &mut dyn FnMut(usize, Gesture)) {
    let palette = theme::of(ui);
    knob::label(ui, rect, item.parameter.label);
    let on = item.plain() >= 0.5;
    let body = Rect::from_center_size(rect.center(), vec2(SWITCH[0], SWITCH[1]));
    let id = ui.scope_id().with(("switch", item.index));
    let response = ui.interact(body.expand(4.0), id, Sense::click());
    if response.clicked() {
        item.put(if on { item.limits().0 } else { item.limits().1 }, set);
    }
    let radius = 0.5 * SWITCH[1];
    let painter = ui.painter();
    painter.rect(
        body,
        radius,
        if on { accent } else { palette.hovered },
        Stroke::new(1.0, if response.hovered() { palette.text } else { palette.raised }),
        egui::StrokeKind::Inside,
    );
    let x = if on { body.max.x - radius } else { body.min.x + radius };
    painter.circle_filled(pos2(x, body.center().y), radius - 4.0, palette.text);
    let below = pos2(rect.center().x, rect.max.y - 0.5 * LINE);
    painter.text(below, Align2::CENTER_CENTER, item.text(item.plain()), theme::body(), palette.text);
    response.on_hover_ui(|ui| {
        ui.label(tip(item));
    });
}

fn list(ui: &mut Ui, rect: Rect, item: &Item<'_>, choices: &[&str], set: &mut dyn FnMut(usize, Gesture)) {
    knob::label(ui, rect, item.parameter.label);
    let width = (rect.width() - 2.0).min(108.0);
    let body = Rect::from_center_size(rect.center(), vec2(width, 24.0));
    let low = item.limits().0;
    ui.scope_builder(UiBuilder::new().max_rect(body).id_salt(("choice", item.index)), |ui| {
        let chosen = fitting(ui, item.text(item.plain()), width);
        let shown = ComboBox::from_id_salt("choices").width(width).truncate().selected_text(chosen);
        let shown = shown.show_ui(ui, |ui| {
            for place in 0..choices.len() {
                let plain = low + place as f32;
                let is_chosen = (item.plain() - plain).abs() < 0.5;
                if ui.selectable_label(is_chosen, item.text(plain)).clicked() {
                    item.put(plain, set);
                }
            }
        });
        shown.response.on_hover_ui(|ui| {
            ui.label(tip(item));
        });
    });
}

/// A choice in the largest letters in which a list of this width shows it whole.
fn fitting(ui: &Ui, text: String, width: f32) -> RichText {
    let spacing = ui.spacing();
    let room = width - 2.0 * spacing.button_padding.x - spacing.icon_width - spacing.icon_spacing;
    let fits = |font: &FontId| {
        let galley = ui.painter().layout_no_wrap(text.clone(), font.clone(), Color32::WHITE);
        galley.size().x <= room
    };
    let font = [theme::body(), theme::caption()].into_iter().find(fits).unwrap_or_else(theme::small);
    RichText::new(text).font(font)
}

/// What a parameter is and what it can be.
fn tip(item: &Item<'_>) -> String {
    let usual = item.text(item.usual());
    format!(
        "{}: {}\n{}, default {usual}",
        item.group,
        item.parameter.label,
        item.parameter.choices.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shorter_choices_of_sticks_are_shown_whole() {
        let context = egui::Context::default();
        theme::apply(&context);
        // Narrower than a cell of the page.
        const WIDTH: f32 = 94.0;
        let mut room = 0.0;
        let mut widths = Vec::new();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let spacing = ui.spacing();
            room = WIDTH - 2.0 * spacing.button_padding.x - spacing.icon_width - spacing.icon_spacing;
            for text in ["as mapped", "stick", "shoulder", "felt-beater"] {
                let chosen = egui::WidgetText::from(fitting(ui, text.to_owned(), WIDTH));
                let galley = chosen.into_galley(ui, None, f32::INFINITY, theme::body());
                widths.push((text, galley.size().x));
            }
        });
        output.textures_delta.clear();
        assert!(widths.iter().all(|(_, width)| *width <= room), "{widths:?} in {room}");
    }
}
