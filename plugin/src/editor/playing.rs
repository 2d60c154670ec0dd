//! The panel of playing: what is sent by whom, and which note plays what.

use egui::{ComboBox, Rect, Ui, UiBuilder, pos2, vec2};

use super::knob::{self, Gesture};
use super::theme;
use crate::host_parameters::HostParameters;
use crate::midi::assignments::{Assignment, Assignments};
use crate::midi_map::{BEYOND, MAP, Meaning};
use crate::parameters::PARAMETERS;

/// Groups of parameters shown here rather than with a piece.
const GROUPS: [&str; 4] = ["Kit", "Microphones", "Playing", "Rendering"];

/// Room of a knob, points.
const CELL: [f32; 2] = [110.0, 96.0];

/// The panel of one window.
#[derive(Default)]
pub struct PlayingPanel {
    /// Reference note to be learned.
    reference: u8,
}

impl PlayingPanel {
    /// Draws the panel; `set` receives what is done to the parameter of an index.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        parameters: &HostParameters,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        ui.painter().rect_filled(rect, theme::CORNER, theme::PANEL);
        let shown = PARAMETERS.iter().zip(parameters.values()).enumerate();
        let shown = shown.filter(|(_, (parameter, _))| GROUPS.contains(&parameter.group));
        let inner = rect.shrink(12.0);
        let columns = ((inner.width() / CELL[0]) as usize).max(1);
        let mut bottom = inner.min.y;
        for (place, (index, (parameter, value))) in shown.enumerate() {
            let (column, row) = (place % columns, place / columns);
            let at = inner.min + vec2(column as f32 * CELL[0], row as f32 * CELL[1]);
            let cell = Rect::from_min_size(at, vec2(CELL[0], CELL[1] - 8.0));
            knob::knob(ui, cell, parameter.label, value, |gesture| set(index, gesture));
            bottom = cell.max.y;
        }
        let notes = Rect::from_min_max(pos2(inner.min.x, bottom + 12.0), inner.max);
        let assignments = parameters.assignments();
        ui.scope_builder(UiBuilder::new().max_rect(notes), |ui| {
            ui.horizontal(|ui| self.learn(ui, &assignments));
            ui.horizontal_wrapped(|ui| list(ui, &assignments));
        });
    }

    /// Choosing what the next note that arrives is to play.
    fn learn(&mut self, ui: &mut Ui, assignments: &Assignments) {
        let name =
            |note: u8| sounding().find(|(known, _)| *known == note).map_or("strike...", |(_, name)| name);
        ComboBox::from_id_salt("reference").width(170.0).selected_text(name(self.reference)).show_ui(
            ui,
            |ui| {
                for (note, name) in sounding() {
                    ui.selectable_value(&mut self.reference, note, name);
                }
            },
        );
        match assignments.learning() {
            Some(note) => {
                ui.label(format!("Strike the pad that is to play {}", name(note)));
                if ui.button("Cancel").clicked() {
                    assignments.learn(None);
                }
            }
            None => {
                if ui.button("Learn").clicked() {
                    assignments.learn(Some(self.reference));
                }
            }
        }
    }
}

/// Reference notes that sound.
fn sounding() -> impl Iterator<Item = (u8, &'static str)> {
    let strikes = |meaning: &Meaning| matches!(meaning, Meaning::Strikes(_));
    MAP.iter().chain(&BEYOND).filter(move |row| strikes(&row.meaning)).map(|row| (row.note, row.name))
}

/// Notes that do not follow their map; a click lets one follow it again.
fn list(ui: &mut Ui, assignments: &Assignments) {
    for (note, assignment) in assignments.changed() {
        let plays = match assignment {
            Assignment::Plays(reference) => {
                sounding().find(|(known, _)| *known == reference).map_or("silent", |(_, name)| name)
            }
            Assignment::Mapped | Assignment::Silent => "silent",
        };
        if ui.button(format!("{note}: {plays}  ✕")).clicked() {
            assignments.assign(note, Assignment::Mapped);
        }
    }
}
