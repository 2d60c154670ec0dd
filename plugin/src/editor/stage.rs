//! The page of the kit: the picture, how hard hands strike it, and what of it is shown.

use egui::{Align2, Key, Rect, Sense, Ui, pos2, vec2};
use overhear_engine::slot::Slot;
use overhear_engine::strike::{Strike, Striker};

use super::kit_view::surfaces::Tint;
use super::kit_view::{Done, KitView, Seen, Target, stroke_near};
use super::theme;
use overhear_player::midi_map::NoteTable;
use overhear_player::strokes::Stroke;

/// Slowest stroke of a hand, m/s: as of a note's lowest velocity.
pub const SLOWEST: f32 = 0.4;

/// Width of the strip of speeds, points.
const STRIP: f32 = 34.0;

/// Keys that play the pieces, in the order of the list.
const KEYS: [Key; 10] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
    Key::Num0,
];

/// How hard hands strike.
pub struct Stage {
    /// Place on the strip, 0 (slowest) to 1 (as fast as a note can be).
    place: f32,
}

impl Default for Stage {
    fn default() -> Stage {
        Stage { place: 0.75 }
    }
}

impl Stage {
    /// Speed of a hand at a place on the strip, m/s, where the fastest is `dynamics`.
    fn speed(&self, ui: &Ui, dynamics: f32) -> f32 {
        // Shift strikes as hard as can be, Alt barely.
        let (hard, soft) = ui.input(|input| (input.modifiers.shift, input.modifiers.alt));
        let place = if hard {
            1.0
        } else if soft {
            0.2
        } else {
            self.place
        };
        SLOWEST * (dynamics.max(SLOWEST) / SLOWEST).powf(place)
    }

    /// Draws the picture; `dynamics` is the fastest stroke, m/s. Says what a hand did beside striking.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        kit: &mut KitView,
        seen: &Seen<'_>,
        dynamics: f32,
        play: &mut dyn FnMut(Stroke),
    ) -> Done {
        let speed = self.speed(ui, dynamics);
        let done = kit.show(ui, rect, seen);
        let notes = &seen.document.notes;
        if let Some(target) = done.struck {
            play(aimed(&target, notes, speed));
        }
        let key = pressed_key(ui).and_then(Slot::new);
        if let Some(slot) = key.filter(|slot| seen.document.kit.piece(*slot).is_some()) {
            play(usual(slot, notes, speed));
        }
        let strip =
            Rect::from_min_max(pos2(rect.max.x - STRIP - 8.0, rect.min.y + 12.0), rect.max - vec2(8.0, 12.0));
        self.strip(ui, strip, dynamics, speed);
        tint_switch(ui, rect, kit);
        done
    }

    /// The strip of speeds: press or drag it.
    fn strip(&mut self, ui: &mut Ui, rect: Rect, dynamics: f32, speed: f32) {
        let palette = theme::of(ui);
        let response = ui.interact(rect, ui.scope_id().with("speed"), Sense::click_and_drag());
        let groove = Rect::from_min_max(
            pos2(rect.center().x - 4.0, rect.min.y + 20.0),
            pos2(rect.center().x + 4.0, rect.max.y - 20.0),
        );
        if let Some(at) = response.interact_pointer_pos() {
            self.place = ((groove.max.y - at.y) / groove.height().max(1.0)).clamp(0.0, 1.0);
        }
        let share = (speed / SLOWEST).ln() / (dynamics.max(1.01 * SLOWEST) / SLOWEST).ln();
        let painter = ui.painter();
        painter.rect_filled(rect, theme::CORNER, palette.panel.gamma_multiply(0.85));
        painter.rect_filled(groove, 4.0, palette.raised);
        let top = groove.max.y - share.clamp(0.0, 1.0) * groove.height();
        painter.rect_filled(Rect::from_min_max(pos2(groove.min.x, top), groove.max), 4.0, palette.accent);
        painter.circle_filled(pos2(groove.center().x, top), 7.0, palette.text);
        let text = |at, text: String| {
            painter.text(at, Align2::CENTER_CENTER, text, theme::caption(), palette.text);
        };
        text(pos2(rect.center().x, rect.min.y + 10.0), format!("{speed:.1}"));
        text(pos2(rect.center().x, rect.max.y - 10.0), "m/s".to_owned());
        response.on_hover_text(
            "Speed of a stroke by mouse, in metres per second.\nShift: highest speed; Alt: soft. \
             Keys 1 to 9 and 0 strike the pieces in the order of the list.",
        );
    }
}

/// Lets hands choose what colour shows.
fn tint_switch(ui: &mut Ui, rect: Rect, kit: &mut KitView) {
    let place = Rect::from_min_size(rect.min + vec2(10.0, 8.0), vec2(190.0, 24.0));
    ui.scope_builder(egui::UiBuilder::new().max_rect(place), |ui| {
        ui.horizontal(|ui| {
            ui.selectable_value(&mut kit.tint, Tint::Displacement, "Displacement")
                .on_hover_text("Warm colours: up; cold colours: down");
            ui.selectable_value(&mut kit.tint, Tint::Energy, "Energy")
                .on_hover_text("The colour of the piece becomes stronger where the surface moves more");
        });
    });
}

/// Which of the keys has just been pressed, unless something is being typed.
fn pressed_key(ui: &Ui) -> Option<usize> {
    if ui.memory(|memory| memory.focused().is_some()) {
        return None;
    }
    ui.input(|input| KEYS.iter().position(|&key| input.key_pressed(key)))
}

/// The stroke of a piece's ordinary note; of a piece without notes with a stick, half way out.
fn usual(slot: Slot, notes: &NoteTable, speed: f32) -> Stroke {
    let stroke = notes.ordinary(slot).and_then(|note| notes.stroke(note));
    let (radius, angle, striker) =
        stroke.map_or((0.5, 0.0, Striker::Stick), |stroke| (stroke.radius, stroke.angle, stroke.striker));
    Stroke { slot, strike: Strike { speed: f64::from(speed), radius, angle, striker } }
}

/// A stroke at a place: with what the nearest note is played with, or else the ordinary one.
fn aimed(target: &Target, notes: &NoteTable, speed: f32) -> Stroke {
    let (radius, angle) = (f64::from(target.radius), f64::from(target.angle));
    let usual = usual(target.slot, notes, speed);
    let near = stroke_near(notes, target.slot, radius);
    let striker = near.map_or(usual.strike.striker, |(_, _, stroke)| stroke.striker);
    Stroke { strike: Strike { radius, angle, striker, ..usual.strike }, ..usual }
}
