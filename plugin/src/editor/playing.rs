//! The page of notes: which note plays what, learning of new ones, and calibration of what arrives.

use egui::{Align2, ComboBox, Rect, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};
use overhear_engine::slot::Slot;

use super::calibration::CalibrationPanel;
use super::theme;
use super::values::Values;
use crate::host_parameters::HostParameters;
use overhear_player::kit_document::KitDocument;
use overhear_player::midi::assignments::{Assignment, Assignments};
use overhear_player::midi::maps::NoteMap;
use overhear_player::midi_map::{NoteTable, Row};

/// Height of a note's row, points.
const ROW: f32 = 24.0;

/// Least width of a column of notes, points.
const COLUMN: f32 = 270.0;

/// The page of one window.
#[derive(Default)]
pub struct PlayingPanel {
    /// Reference note to be learned.
    reference: u8,
    /// Whether it is about calibration instead of notes.
    calibrates: bool,
    calibration: CalibrationPanel,
}

/// What the rows of the page are drawn from.
struct Notes<'a> {
    table: &'a NoteTable,
    assignments: &'a Assignments,
    /// The map of the instrument that is played.
    map: NoteMap,
}

impl PlayingPanel {
    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, parameters: &HostParameters, document: &KitDocument) {
        let palette = theme::of(ui);
        ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
        let inner = rect.shrink(12.0);
        let assignments = parameters.assignments();
        let values = Values { all: parameters.values(), kit: &document.kit };
        let map = values.named("note_map").and_then(|map| NoteMap::ALL.get(map.plain() as usize).copied());
        let notes = Notes { table: &document.notes, assignments: &assignments, map: map.unwrap_or_default() };
        ui.scope_builder(UiBuilder::new().max_rect(inner), |ui| {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.calibrates, false, "Notes");
                ui.selectable_value(&mut self.calibrates, true, "Calibration");
                if !self.calibrates {
                    ui.separator();
                    self.learn(ui, &notes);
                }
            });
            self.calibration.follow(parameters.monitor());
            if self.calibrates {
                ui.add_space(6.0);
                self.calibration.show(ui, &assignments);
                return;
            }
            ui.add_space(6.0);
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.rows(ui, parameters, &notes));
        });
    }

    /// Choosing what the next note that arrives is to play.
    fn learn(&mut self, ui: &mut Ui, notes: &Notes<'_>) {
        let name_of = |note| notes.sounding(note).map_or("choose a note", |row| &row.name);
        ComboBox::from_id_salt("reference").width(190.0).selected_text(name_of(self.reference)).show_ui(
            ui,
            |ui| {
                for (note, row) in notes.table.rows().filter(|(_, row)| sounds(row)) {
                    ui.selectable_value(&mut self.reference, note, &row.name);
                }
            },
        );
        match notes.assignments.learning() {
            Some(note) => {
                ui.colored_label(
                    theme::of(ui).accent,
                    format!("Strike the pad that should play {}", name_of(note)),
                );
                if ui.button("Cancel").clicked() {
                    notes.assignments.learn(None);
                }
            }
            None => {
                let tip = "The next incoming note will play this";
                if ui.button("Learn").on_hover_text(tip).clicked() {
                    notes.assignments.learn(Some(self.reference));
                }
            }
        }
    }

    /// Every note that sounds, in columns; those assigned by hand can be given back to the map.
    fn rows(&mut self, ui: &mut Ui, parameters: &HostParameters, notes: &Notes<'_>) {
        let names = parameters.note_names();
        let inner = ui.max_rect();
        let columns = ((inner.width() / COLUMN) as usize).max(1);
        let long = names.len().div_ceil(columns).max(1);
        let width = inner.width() / columns as f32;
        let whole = Rect::from_min_size(inner.min, vec2(inner.width(), long as f32 * ROW));
        ui.allocate_rect(whole, Sense::hover());
        for (place, (note, name)) in names.iter().enumerate() {
            let at = vec2((place / long) as f32 * width, (place % long) as f32 * ROW);
            let row = Rect::from_min_size(inner.min + at, vec2(width - 10.0, ROW - 3.0));
            self.row(ui, row, (*note, name), notes);
        }
    }

    fn row(&mut self, ui: &mut Ui, rect: Rect, (note, name): (u8, &str), notes: &Notes<'_>) {
        let palette = theme::of(ui);
        let own = notes.assignments.of(note) != Assignment::Mapped;
        let reference = notes.reference(note);
        let response = ui.interact(rect, ui.scope_id().with(("note", note)), Sense::click());
        let fill = if response.hovered() { palette.hovered } else { palette.background.gamma_multiply(0.5) };
        let painter = ui.painter();
        painter.rect_filled(rect, 4.0, fill);
        let slot = notes.sounding(reference).and_then(piece_of);
        let accent = slot.map_or(palette.faint, |slot| palette.pieces[slot.index()]);
        painter.rect_filled(Rect::from_min_size(rect.min, vec2(3.0, rect.height())), 2.0, accent);
        let y = rect.center().y;
        let number = pos2(rect.min.x + 36.0, y);
        painter.text(number, Align2::RIGHT_CENTER, note, theme::caption(), palette.faint);
        painter.text(pos2(rect.min.x + 46.0, y), Align2::LEFT_CENTER, name, theme::body(), palette.text);
        let (mark, tip) = if own {
            ("learned", "Assigned by hand; click to return it to the map")
        } else {
            ("", "Click to select it for Learn")
        };
        painter.text(pos2(rect.max.x - 8.0, y), Align2::RIGHT_CENTER, mark, theme::caption(), palette.accent);
        if response.on_hover_text(tip).clicked() {
            if own {
                notes.assignments.assign(note, Assignment::Mapped);
            } else {
                self.reference = reference;
            }
        }
    }
}

impl Notes<'_> {
    /// The reference note that a note plays.
    fn reference(&self, note: u8) -> u8 {
        match self.assignments.of(note) {
            Assignment::Plays(reference) => reference,
            Assignment::Mapped | Assignment::Silent => self.map.plays(note).unwrap_or(note),
        }
    }

    /// The row of a reference note that sounds.
    fn sounding(&self, reference: u8) -> Option<&Row> {
        self.table.row(reference).filter(|row| sounds(row))
    }
}

fn sounds(row: &Row) -> bool {
    piece_of(row).is_some()
}

/// The piece that a row plays.
fn piece_of(row: &Row) -> Option<Slot> {
    row.meaning.slot()
}
