//! A knob for one parameter: drag up or down, Shift for fine, wheel, double click to reset, click
//! on the value to type one.

use egui::{Align2, Color32, Id, Key, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2};
use nice_plug::prelude::*;

use super::theme;
use crate::parameters::Parameter;

/// What a hand does with a parameter; hosts record from `Begin` to `End`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gesture {
    /// It takes hold.
    Begin,
    /// It moves to a plain value.
    Set(f32),
    /// It lets go.
    End,
}

/// Height of the name and of the value, points.
const LINE: f32 = 18.0;

/// Share of the travel per point dragged.
const TRAVEL: f32 = 1.0 / 220.0;

/// How much slower a fine drag is.
const FINE: f32 = 0.1;

/// Ends of the knob's sweep, rad clockwise from straight up.
const SWEEP: f32 = 2.4;

/// Shows a parameter as a knob in `rect` and reports what was done with it.
pub fn knob(
    ui: &mut Ui,
    rect: Rect,
    parameter: &Parameter,
    value: &FloatParam,
    accent: Color32,
    mut set: impl FnMut(Gesture),
) {
    let palette = theme::of(ui);
    let id = ui.scope_id().with(("knob", value.name()));
    let dial = Rect::from_min_max(rect.min + vec2(0.0, LINE), rect.max - vec2(0.0, LINE));
    let radius = (dial.width().min(dial.height()) / 2.0 - 3.0).max(4.0);
    let hit = Rect::from_center_size(dial.center(), Vec2::splat(2.0 * radius + 6.0));
    let response = ui.interact(hit, id, Sense::click_and_drag());
    let mut place = value.unmodulated_normalized_value();

    // The place under the hand is kept apart from the value, which moves in steps: slow drags
    // would otherwise be rounded away.
    if response.drag_started() {
        set(Gesture::Begin);
        ui.data_mut(|data| data.insert_temp(id, place));
    }
    if response.dragged() {
        let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
        let held = ui.data(|data| data.get_temp(id)).unwrap_or(place);
        place = (held - response.drag_delta().y * TRAVEL * fine).clamp(0.0, 1.0);
        ui.data_mut(|data| data.insert_temp(id, place));
        set(Gesture::Set(value.preview_plain(place)));
    }
    if response.drag_stopped() {
        set(Gesture::End);
    }
    if response.double_clicked() {
        move_once(&mut set, value.default_plain_value());
    }
    if response.hovered() && !response.dragged() {
        let (wheel, fine) = ui.input(|input| (input.smooth_scroll_delta().y, input.modifiers.shift));
        if wheel != 0.0 {
            let step = wheel * TRAVEL * if fine { FINE } else { 0.5 };
            place = (place + step).clamp(0.0, 1.0);
            move_once(&mut set, value.preview_plain(place));
        }
    }

    let active = response.hovered() || response.dragged();
    draw(ui, dial.center(), radius, [place, value.default_normalized_value()], accent, active);
    response.on_hover_ui(|ui| {
        ui.label(tip(parameter));
    });
    let name_at = pos2(rect.center().x, rect.min.y + LINE / 2.0);
    ui.painter().text(name_at, Align2::CENTER_CENTER, parameter.label, theme::caption(), palette.faint);
    let value_rect = Rect::from_min_max(pos2(rect.min.x, rect.max.y - LINE), pos2(rect.max.x, rect.max.y));
    value_text(ui, value_rect, id.with("value"), value, &mut set);
}

fn move_once(set: &mut impl FnMut(Gesture), value: f32) {
    set(Gesture::Begin);
    set(Gesture::Set(value));
    set(Gesture::End);
}

/// What a parameter is, its unit and range, and what hands can do.
fn tip(parameter: &Parameter) -> String {
    let Parameter { group, label, unit, .. } = parameter;
    let [low, high, usual] = [parameter.min, parameter.max, parameter.default].map(|x| parameter.text(x));
    let range = if parameter.choices.is_empty() {
        format!("{low} to {high}{unit}, usually {usual}{unit}")
    } else {
        parameter.choices.join(", ")
    };
    format!(
        "{group}: {label}\n{range}\nDrag, with Shift finely; double click to reset; click the value to type one"
    )
}

fn draw(ui: &Ui, centre: Pos2, radius: f32, [place, default]: [f32; 2], accent: Color32, active: bool) {
    let (painter, palette) = (ui.painter(), theme::of(ui));
    let body = if active { palette.raised } else { palette.hovered };
    painter.circle(centre, radius * 0.72, body, Stroke::new(1.0, palette.raised));
    arc(ui, centre, radius, 0.0, 1.0, palette.raised);
    // The arc grows from the default, so that what was changed shows.
    arc(ui, centre, radius, default.min(place), default.max(place), accent);
    let direction = at_place(place);
    let pointer = [centre + 0.3 * radius * direction, centre + 0.68 * radius * direction];
    painter.line_segment(pointer, Stroke::new(2.5, palette.text));
}

fn arc(ui: &Ui, centre: Pos2, radius: f32, from: f32, to: f32, colour: Color32) {
    const POINTS: usize = 40;
    let points = (0..=POINTS)
        .map(|point| {
            let place = from + (to - from) * point as f32 / POINTS as f32;
            centre + radius * at_place(place)
        })
        .collect();
    ui.painter().line(points, Stroke::new(3.0, colour));
}

/// Direction of a place on the travel, 0 to 1.
fn at_place(place: f32) -> Vec2 {
    let (sin, cos) = ((2.0 * place - 1.0) * SWEEP).sin_cos();
    vec2(sin, -cos)
}

/// The value with its unit; a click turns it into a field to type in.
fn value_text(ui: &mut Ui, rect: Rect, id: Id, value: &FloatParam, set: &mut impl FnMut(Gesture)) {
    let palette = theme::of(ui);
    // Without modulation: what was set is what can be typed over.
    let shown = value.normalized_value_to_string(value.unmodulated_normalized_value(), true);
    let Some(mut typed) = ui.data(|data| data.get_temp::<String>(id)) else {
        let response = ui.interact(rect, id, Sense::click());
        let colour = if response.hovered() { palette.accent } else { palette.text };
        let centre = rect.center();
        ui.painter().text(centre, Align2::CENTER_CENTER, &shown, theme::body(), colour);
        if response.on_hover_cursor(egui::CursorIcon::Text).clicked() {
            ui.data_mut(|data| data.insert_temp(id, shown));
            ui.memory_mut(|memory| memory.request_focus(id.with("field")));
        }
        return;
    };
    let field = egui::TextEdit::singleline(&mut typed)
        .id(id.with("field"))
        .align(Align2::CENTER_CENTER)
        .font(theme::body());
    let response = ui.put(rect, field);
    let (entered, left) = ui.input(|input| (input.key_pressed(Key::Enter), input.key_pressed(Key::Escape)));
    if response.lost_focus() || entered || left {
        if entered && let Some(place) = value.string_to_normalized_value(&typed) {
            move_once(set, value.preview_plain(place));
        }
        ui.data_mut(|data| data.remove::<String>(id));
    } else {
        ui.data_mut(|data| data.insert_temp(id, typed));
    }
}
