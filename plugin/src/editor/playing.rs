//! The page of notes: which note plays what, and learning of new ones.

use egui::{Align2, ComboBox, Rect, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};
use overhear_engine::piece::PieceId;

use super::theme;
use crate::host_parameters::HostParameters;
use crate::midi::assignments::{Assignment, Assignments};
use crate::midi_map::{BEYOND, MAP, Meaning, Row};

/// Height of a note's row, points.
const ROW: f32 = 24.0;

/// Least width of a column of notes, points.
const COLUMN: f32 = 270.0;

/// The page of one window.
#[derive(Default)]
pub struct PlayingPanel {
    /// Reference note to be learned.
    reference: u8,
}

impl PlayingPanel {
    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, parameters: &HostParameters) {
        let palette = theme::of(ui);
        ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
        let inner = rect.shrink(12.0);
        let assignments = parameters.assignments();
        ui.scope_builder(UiBuilder::new().max_rect(inner), |ui| {
            ui.horizontal(|ui| self.learn(ui, &assignments));
            ui.add_space(6.0);
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.rows(ui, parameters, &assignments));
        });
    }

    /// Choosing what the next note that arrives is to play.
    fn learn(&mut self, ui: &mut Ui, assignments: &Assignments) {
        ComboBox::from_id_salt("reference").width(190.0).selected_text(name_of(self.reference)).show_ui(
            ui,
            |ui| {
                for row in sounding() {
                    ui.selectable_value(&mut self.reference, row.note, row.name);
                }
            },
        );
        match assignments.learning() {
            Some(note) => {
                ui.colored_label(
                    theme::of(ui).accent,
                    format!("Strike the pad that is to play {}", name_of(note)),
                );
                if ui.button("Cancel").clicked() {
                    assignments.learn(None);
                }
            }
            None => {
                let tip = "The next note that arrives will play this";
                if ui.button("Learn").on_hover_text(tip).clicked() {
                    assignments.learn(Some(self.reference));
                }
            }
        }
    }

    /// Every note that sounds, in columns; those assigned by hand can be given back to the map.
    fn rows(&mut self, ui: &mut Ui, parameters: &HostParameters, assignments: &Assignments) {
        let notes = parameters.note_names();
        let inner = ui.max_rect();
        let columns = ((inner.width() / COLUMN) as usize).max(1);
        let long = notes.len().div_ceil(columns);
        let width = inner.width() / columns as f32;
        let whole = Rect::from_min_size(inner.min, vec2(inner.width(), long as f32 * ROW));
        ui.allocate_rect(whole, Sense::hover());
        for (place, (note, name)) in notes.into_iter().enumerate() {
            let at = vec2((place / long) as f32 * width, (place % long) as f32 * ROW);
            let row = Rect::from_min_size(inner.min + at, vec2(width - 10.0, ROW - 3.0));
            self.row(ui, row, (note, name), assignments);
        }
    }

    fn row(&mut self, ui: &mut Ui, rect: Rect, (note, name): (u8, &str), assignments: &Assignments) {
        let palette = theme::of(ui);
        let own = assignments.of(note) != Assignment::Mapped;
        let reference = match assignments.of(note) {
            Assignment::Plays(reference) => reference,
            _ => sounding().find(|row| row.name == name).map_or(note, |row| row.note),
        };
        let response = ui.interact(rect, ui.scope_id().with(("note", note)), Sense::click());
        let fill = if response.hovered() { palette.hovered } else { palette.background.gamma_multiply(0.5) };
        let painter = ui.painter();
        painter.rect_filled(rect, 4.0, fill);
        let accent =
            piece_of(reference).and_then(PieceId::slot).map_or(palette.faint, |slot| palette.pieces[slot]);
        painter.rect_filled(Rect::from_min_size(rect.min, vec2(3.0, rect.height())), 2.0, accent);
        let y = rect.center().y;
        let number = pos2(rect.min.x + 36.0, y);
        painter.text(number, Align2::RIGHT_CENTER, note, theme::caption(), palette.faint);
        painter.text(pos2(rect.min.x + 46.0, y), Align2::LEFT_CENTER, name, theme::body(), palette.text);
        let (mark, tip) = if own {
            ("learned", "Assigned by hand; click to let it follow the map again")
        } else {
            ("", "Click to choose it for learning")
        };
        painter.text(pos2(rect.max.x - 8.0, y), Align2::RIGHT_CENTER, mark, theme::caption(), palette.accent);
        if response.on_hover_text(tip).clicked() {
            if own {
                assignments.assign(note, Assignment::Mapped);
            } else {
                self.reference = reference;
            }
        }
    }
}

/// Rows of reference notes that sound.
fn sounding() -> impl Iterator<Item = &'static Row> {
    MAP.iter().chain(&BEYOND).filter(|row| !matches!(row.meaning, Meaning::Silent(_)))
}

fn name_of(note: u8) -> &'static str {
    sounding().find(|row| row.note == note).map_or("choose a note", |row| row.name)
}

fn piece_of(reference: u8) -> Option<PieceId> {
    let row = sounding().find(|row| row.note == reference)?;
    match &row.meaning {
        Meaning::Strikes(stroke) => Some(stroke.piece),
        Meaning::Steps(_) => Some(PieceId::HiHat),
        Meaning::Silent(_) => None,
    }
}
