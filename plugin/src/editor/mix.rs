//! The page of the mix: a strip for each piece, and the main output.
//!
//! Mute and solo are moves of the levels, as hands would make them: what a host records and a project stores is
//! what is heard. The window remembers where a level was; one that was silent before it opened comes back at its default.

use egui::{Align2, Button, Color32, Rect, Ui, UiBuilder, pos2, vec2};
use nice_plug::prelude::{FloatParam, Param};
use overhear_engine::piece::PieceId;

use super::history::put;
use super::knob::{self, Gesture};
use super::levels::{self, Levels};
use super::{knobs, theme};
use crate::outputs::title;
use crate::parameters::{PARAMETERS, find};

/// Pieces of the kit.
const PIECES: usize = PieceId::KIT.len();

/// Height of a knob with its name and value, points.
const KNOB: f32 = 82.0;

/// What was turned down, to be turned up again.
#[derive(Default)]
pub struct Mix {
    /// Levels before they were silenced, plain values, by slot.
    before: [Option<f32>; PIECES],
    /// The piece that is heard alone, and which of the others were silenced for it.
    solo: Option<(usize, [bool; PIECES])>,
}

impl Mix {
    /// Draws the page.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        values: &[FloatParam],
        shown: &Levels,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        let palette = theme::of(ui);
        let width = rect.width() / (PIECES + 1) as f32;
        let strip = |place: usize| {
            let left = rect.min.x + place as f32 * width;
            Rect::from_min_max(pos2(left, rect.min.y), pos2(left + width - 4.0, rect.max.y))
        };
        for (slot, piece) in PieceId::KIT.into_iter().enumerate() {
            let accent = palette.pieces[slot];
            let rect = strip(slot);
            let rest = frame(ui, rect, title(piece), accent);
            let rest = self.switches(ui, rest, slot, values, set);
            let rest = group_knob(ui, rest, (title(piece), "Level"), values, accent, set);
            let rest = group_knob(ui, rest, (title(piece), "Pan"), values, accent, set);
            meters(ui, rest, &[shown.piece(slot)], accent);
        }
        let rest = frame(ui, strip(PIECES), "Main", palette.text);
        // As far down as the others' switches.
        let rest = Rect::from_min_max(rest.min, rest.max - vec2(0.0, 34.0));
        let rest = group_knob(ui, rest, ("Kit", "Level"), values, palette.accent, set);
        let rest = Rect::from_min_max(rest.min, rest.max - vec2(0.0, KNOB));
        meters(ui, rest, &shown.main(), palette.level);
    }

    /// Mute and solo; gives what is left above them.
    fn switches(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        slot: usize,
        values: &[FloatParam],
        set: &mut dyn FnMut(usize, Gesture),
    ) -> Rect {
        let palette = theme::of(ui);
        let (rest, place) = rect.split_top_bottom_at_y(rect.max.y - 34.0);
        let muted = level_of(slot, values).is_some_and(|(_, value, least)| value <= least);
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

    fn silence(&mut self, slot: usize, values: &[FloatParam], set: &mut dyn FnMut(usize, Gesture)) {
        if let Some((index, value, least)) = level_of(slot, values).filter(|(_, value, least)| value > least)
        {
            self.before[slot] = Some(value);
            put(index, least, set);
        }
    }

    fn raise(&mut self, slot: usize, values: &[FloatParam], set: &mut dyn FnMut(usize, Gesture)) {
        if let Some((index, ..)) = level_of(slot, values) {
            put(index, self.before[slot].take().unwrap_or(PARAMETERS[index].default), set);
        }
    }

    /// Lets a piece be heard alone, or all again.
    fn solo(&mut self, slot: usize, values: &[FloatParam], set: &mut dyn FnMut(usize, Gesture)) {
        let former = self.solo.take();
        if let Some((_, silenced)) = former {
            (0..PIECES).filter(|&other| silenced[other]).for_each(|other| self.raise(other, values, set));
        }
        if former.is_some_and(|(of, _)| of == slot) {
            return;
        }
        // Values are as they were before the gestures of this frame.
        let heard = |other: usize| {
            let again = former.is_some_and(|(_, silenced)| silenced[other]);
            again || level_of(other, values).is_some_and(|(_, value, least)| value > least)
        };
        let silenced = std::array::from_fn(|other| other != slot && heard(other));
        for other in (0..PIECES).filter(|&other| silenced[other]) {
            let Some((index, value, least)) = level_of(other, values) else { continue };
            if value > least {
                self.before[other] = Some(value);
            }
            put(index, least, set);
        }
        self.solo = Some((slot, silenced));
    }
}

/// Index of a piece's level, its value and its least value.
fn level_of(slot: usize, values: &[FloatParam]) -> Option<(usize, f32, f32)> {
    let name = format!("{}_level", PieceId::KIT[slot].name().replace('-', "_"));
    let (index, parameter) = find(&name).ok()?;
    Some((index, values.get(index)?.unmodulated_plain_value(), parameter.min))
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

/// The knob of a group with a label at the bottom; gives what is left above it.
fn group_knob(
    ui: &mut Ui,
    rect: Rect,
    (group, label): (&str, &str),
    values: &[FloatParam],
    accent: Color32,
    set: &mut dyn FnMut(usize, Gesture),
) -> Rect {
    let (rest, place) = rect.split_top_bottom_at_y(rect.max.y - KNOB);
    let found = knobs::of_group(group, values).find(|(_, parameter, _)| parameter.label == label);
    if let Some((index, parameter, value)) = found {
        ui.scope_builder(UiBuilder::new().max_rect(place).id_salt("mix"), |ui| {
            knob::knob(ui, place, parameter, value, accent, |gesture| set(index, gesture));
        });
    }
    rest
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
        let parameters = HostParameters::default();
        let (index, usual, least) = level_of(2, parameters.values()).unwrap();
        let (mut mix, mut gestures) = (Mix::default(), Vec::new());
        mix.silence(2, parameters.values(), &mut |index, gesture| gestures.push((index, gesture)));
        mix.raise(2, parameters.values(), &mut |index, gesture| gestures.push((index, gesture)));
        assert_eq!(levels_after(&gestures), [(index, least), (index, usual)]);
        assert_eq!(gestures.len(), 6, "each a whole gesture");
    }

    #[test]
    fn solo_silences_all_others_and_lets_them_back() {
        let parameters = HostParameters::default();
        let (mut mix, mut gestures) = (Mix::default(), Vec::new());
        mix.solo(1, parameters.values(), &mut |index, gesture| gestures.push((index, gesture)));
        let silenced = levels_after(&gestures);
        let (own, ..) = level_of(1, parameters.values()).unwrap();
        assert_eq!(silenced.len(), PIECES - 1);
        assert!(silenced.iter().all(|&(index, value)| index != own && value == PARAMETERS[index].min));
        gestures.clear();
        mix.solo(1, parameters.values(), &mut |index, gesture| gestures.push((index, gesture)));
        let back = levels_after(&gestures);
        assert_eq!(back.len(), PIECES - 1);
        assert!(back.iter().all(|&(index, value)| value == PARAMETERS[index].default));
    }
}
