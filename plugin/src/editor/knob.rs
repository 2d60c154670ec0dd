//! A knob for one parameter: drag up or down, Shift for fine, wheel, double click to reset, click
//! on the value to type one.

use egui::text::LayoutJob;
use egui::{Align, Align2, Color32, Id, Key, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, pos2, vec2};
use nice_plug::prelude::Param;

use super::gesture::Gesture;
use super::theme;
use super::values::Item;

/// Height of the name and of the value, points.
const LINE: f32 = 18.0;

/// Share of the travel per point dragged.
const TRAVEL: f32 = 1.0 / 220.0;

/// How much slower a fine drag is.
const FINE: f32 = 0.1;

/// Ends of the knob's sweep, rad clockwise from straight up.
const SWEEP: f32 = 2.4;

/// Shows a parameter as a knob in `rect` and reports what was done with it.
pub fn knob(ui: &mut Ui, rect: Rect, item: &Item<'_>, accent: Color32, set: &mut dyn FnMut(usize, Gesture)) {
    let id = ui.scope_id().with(("knob", item.index));
    let dial = Rect::from_min_max(rect.min + vec2(0.0, LINE), rect.max - vec2(0.0, LINE));
    let radius = (dial.width().min(dial.height()) / 2.0 - 3.0).max(4.0);
    let hit = Rect::from_center_size(dial.center(), Vec2::splat(2.0 * radius + 6.0));
    let (response, place) = hand(ui, hit, id, (item, TRAVEL), set);
    let active = response.hovered() || response.dragged();
    draw(ui, dial.center(), radius, [place, item.place(item.usual())], accent, active);
    response.on_hover_ui(|ui| {
        ui.label(tip(item));
    });
    label(ui, rect, item.parameter.label);
    let value_rect = Rect::from_min_max(pos2(rect.min.x, rect.max.y - LINE), pos2(rect.max.x, rect.max.y));
    value_text(ui, value_rect, id.with("value"), item, set);
}

/// What a hand does with a parameter in `hit`, which moves by a share of its travel per point dragged; gives the place where it is, 0 to 1.
pub(super) fn hand(
    ui: &Ui,
    hit: Rect,
    id: Id,
    (item, travel): (&Item<'_>, f32),
    set: &mut dyn FnMut(usize, Gesture),
) -> (Response, f32) {
    let response = ui.interact(hit, id, Sense::click_and_drag());
    let mut place = item.value.unmodulated_normalized_value();

    // The place under the hand is kept apart from the value, which moves in steps: slow drags
    // would otherwise be rounded away.
    if response.drag_started() {
        set(item.index, Gesture::Begin);
        ui.data_mut(|data| data.insert_temp(id, place));
    }
    if response.dragged() {
        let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
        let held = ui.data(|data| data.get_temp(id)).unwrap_or(place);
        place = (held - response.drag_delta().y * travel * fine).clamp(0.0, 1.0);
        // Where the value ends the hand turns back at once.
        let (low, high) = item.limits();
        place = place.clamp(item.place(low), item.place(high));
        ui.data_mut(|data| data.insert_temp(id, place));
        set(item.index, Gesture::Set(item.at(place)));
    }
    if response.drag_stopped() {
        set(item.index, Gesture::End);
    }
    if response.double_clicked() {
        item.put(item.usual(), set);
    }
    if response.hovered() && !response.dragged() {
        let (wheel, fine) = ui.input(|input| (input.smooth_scroll_delta().y, input.modifiers.shift));
        if wheel != 0.0 {
            let step = wheel * travel * if fine { FINE } else { 0.5 };
            place = (place + step).clamp(0.0, 1.0);
            item.put(item.at(place), set);
        }
    }
    (response, place)
}

/// The name above a knob; a long one small and on two lines.
pub(super) fn label(ui: &Ui, cell: Rect, text: &str) {
    let colour = theme::of(ui).faint;
    let painter = ui.painter();
    let one = painter.layout_no_wrap(text.to_owned(), theme::caption(), colour);
    let galley = if one.size().x <= cell.width() {
        one
    } else {
        let mut job = LayoutJob::simple(text.to_owned(), theme::small(), colour, cell.width());
        job.halign = Align::Center;
        painter.layout_job(job)
    };
    // What is laid out about its middle has its place there.
    let left = if galley.job.halign == Align::Center { 0.0 } else { 0.5 * galley.size().x };
    let top = cell.min.y + 0.5 * (LINE - galley.size().y);
    painter.galley(pos2(cell.center().x - left, top), galley, colour);
}

/// What a parameter is, its unit and range, and what hands can do.
pub(super) fn tip(item: &Item<'_>) -> String {
    let (group, label, choices) = (item.group, item.parameter.label, item.parameter.choices);
    let range = if choices.is_empty() {
        let (low, high) = item.limits();
        let [low, high, usual] = [low, high, item.usual()].map(|plain| item.text(plain));
        format!("{low} to {high}, default {usual}")
    } else {
        choices.join(", ")
    };
    format!(
        "{group}: {label}\n{range}\nDrag to change, Shift for fine steps; double click to reset; click the value to type one"
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
pub(super) fn value_text(
    ui: &mut Ui,
    rect: Rect,
    id: Id,
    item: &Item<'_>,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let palette = theme::of(ui);
    let Some(typed) = ui.data(|data| data.get_temp::<String>(id)) else {
        // Without modulation: what was set is what can be typed over.
        let shown = item.text(item.plain());
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
    field(ui, rect, id, typed, item, set);
}

/// The field of a value; what is refused stays in it, in the colour of what went wrong, until it is changed or given up.
fn field(
    ui: &mut Ui,
    rect: Rect,
    id: Id,
    mut typed: String,
    item: &Item<'_>,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let refused = id.with("refused");
    let reason = ui.data(|data| data.get_temp::<String>(refused));
    let mut field = egui::TextEdit::singleline(&mut typed)
        .id(id.with("field"))
        .align(Align2::CENTER_CENTER)
        .font(theme::body());
    if reason.is_some() {
        field = field.text_color(theme::of(ui).over);
    }
    let mut response = ui.put(rect, field);
    if let Some(reason) = reason {
        response = response.on_hover_text(reason);
    }
    let (entered, left) = ui.input(|input| (input.key_pressed(Key::Enter), input.key_pressed(Key::Escape)));
    if response.changed() {
        ui.data_mut(|data| data.remove::<String>(refused));
    }
    if entered && let Err(error) = item.parse(&typed).map(|plain| item.put(plain, set)) {
        ui.data_mut(|data| {
            data.insert_temp(refused, error.to_string());
            data.insert_temp(id, typed);
        });
        response.request_focus();
    } else if response.lost_focus() || entered || left {
        ui.data_mut(|data| {
            data.remove::<String>(id);
            data.remove::<String>(refused);
        });
    } else {
        ui.data_mut(|data| data.insert_temp(id, typed));
    }
}
