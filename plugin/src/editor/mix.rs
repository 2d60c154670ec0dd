//! The page of the mix: a strip for each piece, and the main output.
//!
//! Mute and solo are moves of the levels, as hands would make them: what a host records and a project stores is
//! what is heard. The window remembers where a level was; one that was silent before it opened comes back at its default.

use egui::{Align2, Button, Color32, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};
use overhear_engine::slot::{SLOTS, Slot};

use super::fader;
use super::gesture::Gesture;
use super::knob;
use super::levels::{self, Levels};
use super::theme;
use super::values::{Item, Values};
use overhear_player::parameters::SlotParameter;

/// Height of a knob with its name and value, points.
const KNOB: f32 = 82.0;

/// Space between strips, points.
const GAP: f32 = 4.0;

/// Narrowest and widest strip, points: narrower ones would not show a value; as many as there are scroll.
const STRIP: (f32, f32) = (60.0, 190.0);

/// What was turned down, to be turned up again.
#[derive(Default)]
pub struct Mix {
    /// Levels before they were silenced, plain values, by slot.
    before: [Option<f32>; SLOTS],
    /// The piece that is heard alone, and which of the others were silenced for it, by slot.
    solo: Option<(Slot, [bool; SLOTS])>,
}

impl Mix {
    /// Draws the page.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        values: Values<'_>,
        shown: &Levels,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        let count = values.kit.pieces.len() as f32;
        let width = (rect.width() / (count + 1.0)).clamp(STRIP.0, STRIP.1);
        let long = (count * width).min((rect.width() - width).max(0.0));
        let (pieces, rest) = rect.split_left_right_at_x(rect.min.x + long);
        if count * width <= long + 0.5 {
            self.strips(ui, pieces, width, values, shown, set);
        } else {
            // More than there is room for; the main output stays beside them.
            let pieces = Rect::from_min_max(pieces.min, pieces.max - vec2(GAP, 0.0));
            ui.scope_builder(UiBuilder::new().max_rect(pieces), |ui| {
                ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
                    let size = vec2(count * width, ui.available_height());
                    let (whole, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                    self.strips(ui, whole, width, values, shown, set);
                });
            });
        }
        main_strip(ui, strip_at(rest, 0, width), values, shown, set);
    }

    /// A strip for every piece.
    fn strips(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        width: f32,
        values: Values<'_>,
        shown: &Levels,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        for (slot, piece) in values.kit.slots() {
            let accent = theme::of(ui).pieces[slot.index()];
            let rest = frame(ui, strip_at(rect, slot.index(), width), &piece.title, accent);
            let rest = self.switches(ui, rest, slot, values, set);
            let rest = item_knob(ui, rest, values.of_slot(slot, SlotParameter::Pan), accent, set);
            let level = values.of_slot(slot, SlotParameter::Level);
            fader_and_meters(ui, rest, level, &[shown.piece(slot)], (accent, accent), set);
        }
    }

    /// Forgets what was turned down: it was another kit's.
    pub fn forget(&mut self) {
        *self = Mix::default();
    }

    /// Mute and solo; gives what is left above them.
    fn switches(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        slot: Slot,
        values: Values<'_>,
        set: &mut dyn FnMut(usize, Gesture),
    ) -> Rect {
        let palette = theme::of(ui);
        let (rest, place) = rect.split_top_bottom_at_y(rect.max.y - 34.0);
        let muted = level_of(slot, values).is_some_and(|level| is_silent(&level));
        let alone = self.solo.is_some_and(|(of, _)| of == slot);
        let (left, right) = place.shrink2(vec2(6.0, 4.0)).split_left_right_at_fraction(0.5);
        let switch = |ui: &mut Ui, at: Rect, text: &str, on: Option<Color32>, tip: &str| {
            let fill = on.unwrap_or(palette.hovered);
            let ink = if on.is_some() { palette.background } else { palette.text };
            let button = Button::new(egui::RichText::new(text).color(ink)).fill(fill);
            ui.put(at.shrink2(vec2(2.0, 0.0)), button).on_hover_text(tip).clicked()
        };
        if switch(ui, left, "M", muted.then_some(palette.over), "Mute: turns the level all the way down") {
            if muted { self.raise(slot, values, set) } else { self.silence(slot, values, set) }
        }
        if switch(ui, right, "S", alone.then_some(palette.accent), "Solo: silences all others") {
            self.solo(slot, values, set);
        }
        rest
    }

    fn silence(&mut self, slot: Slot, values: Values<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        if let Some(level) = level_of(slot, values).filter(|level| !is_silent(level)) {
            self.before[slot.index()] = Some(level.plain());
            level.put(level.limits().0, set);
        }
    }

    fn raise(&mut self, slot: Slot, values: Values<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        if let Some(level) = level_of(slot, values) {
            level.put(self.before[slot.index()].take().unwrap_or(level.usual()), set);
        }
    }

    /// Lets a piece be heard alone, or all again.
    fn solo(&mut self, slot: Slot, values: Values<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        let former = self.solo.take();
        if let Some((_, silenced)) = former {
            let others = Slot::ALL.into_iter().filter(|other| silenced[other.index()]);
            others.for_each(|other| self.raise(other, values, set));
        }
        if former.is_some_and(|(of, _)| of == slot) {
            return;
        }
        // Values are as they were before the gestures of this frame.
        let heard = |other: Slot| {
            let again = former.is_some_and(|(_, silenced)| silenced[other.index()]);
            again || level_of(other, values).is_some_and(|level| !is_silent(&level))
        };
        let silenced = Slot::ALL.map(|other| other != slot && heard(other));
        for other in Slot::ALL.into_iter().filter(|other| silenced[other.index()]) {
            let Some(level) = level_of(other, values) else { continue };
            if !is_silent(&level) {
                self.before[other.index()] = Some(level.plain());
            }
            level.put(level.limits().0, set);
        }
        self.solo = Some((slot, silenced));
    }
}

/// A piece's level.
fn level_of(slot: Slot, values: Values<'_>) -> Option<Item<'_>> {
    values.of_slot(slot, SlotParameter::Level)
}

fn is_silent(level: &Item<'_>) -> bool {
    level.plain() <= level.limits().0
}

/// The place of a strip in a row of them.
fn strip_at(rect: Rect, place: usize, width: f32) -> Rect {
    let left = rect.min.x + place as f32 * width;
    Rect::from_min_max(pos2(left, rect.min.y), pos2(left + width - GAP, rect.max.y))
}

/// The strip of the main output.
fn main_strip(
    ui: &mut Ui,
    rect: Rect,
    values: Values<'_>,
    shown: &Levels,
    set: &mut dyn FnMut(usize, Gesture),
) {
    let palette = theme::of(ui);
    let rest = frame(ui, rect, "Main", palette.text);
    // As far down as the others' switches.
    let rest = Rect::from_min_max(rest.min, rest.max - vec2(0.0, 34.0));
    let rest = Rect::from_min_max(rest.min, rest.max - vec2(0.0, KNOB));
    let colours = (palette.accent, palette.level);
    fader_and_meters(ui, rest, values.named("master_level"), &shown.main(), colours, set);
}

/// A strip's panel and name; gives what is left below.
fn frame(ui: &Ui, rect: Rect, name: &str, accent: Color32) -> Rect {
    let palette = theme::of(ui);
    let painter = ui.painter();
    painter.rect_filled(rect, theme::CORNER, palette.panel);
    let edge = Rect::from_min_size(rect.min, vec2(rect.width(), 3.0));
    painter.rect_filled(edge, 2.0, accent);
    let at = pos2(rect.center().x, rect.min.y + 16.0);
    painter.with_clip_rect(rect).text(at, Align2::CENTER_CENTER, name, theme::caption(), palette.text);
    Rect::from_min_max(rect.min + vec2(0.0, 30.0), rect.max)
}

/// A knob at the bottom; gives what is left above it.
fn item_knob(
    ui: &mut Ui,
    rect: Rect,
    item: Option<Item<'_>>,
    accent: Color32,
    set: &mut dyn FnMut(usize, Gesture),
) -> Rect {
    let (rest, place) = rect.split_top_bottom_at_y(rect.max.y - KNOB);
    if let Some(item) = item {
        ui.scope_builder(UiBuilder::new().max_rect(place).id_salt("mix"), |ui| {
            knob::knob(ui, place, &item, accent, set);
        });
    }
    rest
}

/// A fader, and beside it the meters of what it lets through.
fn fader_and_meters(
    ui: &mut Ui,
    rect: Rect,
    item: Option<Item<'_>>,
    shown: &[f32],
    (accent, colour): (Color32, Color32),
    set: &mut dyn FnMut(usize, Gesture),
) {
    let (tall, value) = rect.split_top_bottom_at_y(rect.max.y - 18.0);
    let middle = tall.center().x;
    if let Some(item) = item {
        let way = Rect::from_x_y_ranges(middle - 34.0..=middle + 2.0, tall.y_range());
        ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt("mix"), |ui| {
            fader::fader(ui, [way, value], &item, accent, set);
        });
    }
    meters(ui, tall.translate(vec2(16.0, 0.0)), shown, colour);
}

/// Meters side by side, with the loudest as text above.
fn meters(ui: &Ui, rect: Rect, shown: &[f32], colour: Color32) {
    let palette = theme::of(ui);
    let loudest = shown.iter().copied().fold(levels::FLOOR_DB, f32::max);
    let above = pos2(rect.center().x, rect.min.y + 8.0);
    ui.painter().text(above, Align2::CENTER_CENTER, levels::text(loudest), theme::caption(), palette.faint);
    let tall = rect.min.y + 20.0..=(rect.max.y - 8.0).max(rect.min.y + 21.0);
    for (place, &level) in shown.iter().enumerate() {
        let centre = rect.center().x + 14.0 * (place as f32 - 0.5 * (shown.len() - 1) as f32);
        let bar = Rect::from_x_y_ranges(centre - 5.0..=centre + 5.0, tall.clone());
        levels::bar(ui, bar, level, colour, palette);
        let full = bar.max.y - bar.height() * levels::share(0.0);
        ui.painter().hline(bar.x_range(), full, (1.0, palette.faint));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::host_parameters::HostParameters;
    use overhear_engine::kit_spec::KitSpec;

    /// What gestures leave the levels at.
    fn levels_after(gestures: &[(usize, Gesture)]) -> Vec<(usize, f32)> {
        let values = gestures.iter().filter_map(|&(index, gesture)| match gesture {
            Gesture::Set(value) => Some((index, value)),
            _ => None,
        });
        values.collect()
    }

    #[test]
    fn mute_silences_and_comes_back_where_it_was() {
        let (parameters, kit) = (HostParameters::default(), KitSpec::standard());
        let values = Values { all: parameters.values(), kit: &kit };
        let tom = Slot::ALL[2];
        let level = level_of(tom, values).unwrap();
        let (mut mix, mut gestures) = (Mix::default(), Vec::new());
        mix.silence(tom, values, &mut |index, gesture| gestures.push((index, gesture)));
        mix.raise(tom, values, &mut |index, gesture| gestures.push((index, gesture)));
        let wanted = [(level.index, level.limits().0), (level.index, level.plain())];
        assert_eq!(levels_after(&gestures), wanted);
        assert_eq!(gestures.len(), 6, "each a whole gesture");
    }

    #[test]
    fn solo_silences_all_others_and_lets_them_back() {
        let (parameters, kit) = (HostParameters::default(), KitSpec::standard());
        let values = Values { all: parameters.values(), kit: &kit };
        let snare = Slot::ALL[1];
        let (mut mix, mut gestures) = (Mix::default(), Vec::new());
        mix.solo(snare, values, &mut |index, gesture| gestures.push((index, gesture)));
        let silenced = levels_after(&gestures);
        let others: Vec<_> = kit
            .slots()
            .filter(|(slot, _)| *slot != snare)
            .map(|(slot, _)| level_of(slot, values).unwrap())
            .collect();
        let down: Vec<_> = others.iter().map(|level| (level.index, level.limits().0)).collect();
        assert_eq!(silenced, down);
        gestures.clear();
        mix.solo(snare, values, &mut |index, gesture| gestures.push((index, gesture)));
        let back: Vec<_> = others.iter().map(|level| (level.index, level.plain())).collect();
        assert_eq!(levels_after(&gestures), back);
    }
}
