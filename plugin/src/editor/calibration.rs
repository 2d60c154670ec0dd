//! The page on which pads and the pedal are calibrated, beside what arrives.

use std::collections::VecDeque;

use egui::{DragValue, Grid, RichText, ScrollArea, Ui};
use overhear_player::midi::assignments::Assignments;
use overhear_player::midi::calibration::{LONGEST_RETRIGGER, Learned, Pad, Pedal};
use overhear_player::midi::learning::{FEWEST_STROKES, Incoming, Lesson, MidiMessage};

use super::theme;
use crate::incoming::Monitor;

/// Messages that are shown.
const SHOWN: usize = 200;

/// Width of what arrives, points.
const MONITOR: f32 = 250.0;

/// What is being learned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    Pad,
    Pedal,
}

/// The page of one window.
#[derive(Default)]
pub struct CalibrationPanel {
    /// Messages read so far.
    read: u64,
    /// The latest, newest first.
    latest: VecDeque<Incoming>,
    lesson: Option<(Subject, Lesson)>,
}

impl CalibrationPanel {
    /// Takes in what has arrived.
    pub fn follow(&mut self, monitor: &Monitor) {
        let now = monitor.count();
        for incoming in monitor.since(self.read) {
            if let Some((_, lesson)) = &mut self.lesson {
                lesson.hear(incoming);
            }
            self.latest.push_front(incoming);
        }
        self.latest.truncate(SHOWN);
        self.read = now;
    }

    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, assignments: &Assignments) {
        let height = ui.available_height();
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(ui.available_width() - MONITOR);
                ui.set_height(height);
                self.lessons(ui, assignments);
                ui.add_space(8.0);
                ScrollArea::vertical().id_salt("calibrated").auto_shrink(false).show(ui, |ui| {
                    pedal(ui, assignments);
                    ui.add_space(8.0);
                    pads(ui, assignments);
                });
            });
            ui.vertical(|ui| self.monitor(ui));
        });
    }

    /// What can be learned, and what is.
    fn lessons(&mut self, ui: &mut Ui, assignments: &Assignments) {
        let Some((subject, lesson)) = &self.lesson else {
            ui.horizontal(|ui| {
                for (name, subject) in [("Learn a pad", Subject::Pad), ("Learn the pedal", Subject::Pedal)] {
                    if ui.button(name).clicked() {
                        self.lesson = Some((subject, Lesson::default()));
                    }
                }
                let any = assignments.calibration().learned() != Learned::default();
                if ui.add_enabled(any, egui::Button::new("Forget all")).clicked() {
                    assignments.calibration().replace(&Learned::default());
                }
            });
            return;
        };
        let accent = theme::of(ui).accent;
        let mut done = false;
        match subject {
            Subject::Pad => {
                ui.colored_label(accent, "Strike one pad softly, hard and in between, one stroke at a time");
                let found = lesson.pad();
                let strokes = lesson.count();
                ui.label(found.map_or_else(
                    || format!("{strokes} strokes so far, of at least {FEWEST_STROKES} that differ"),
                    |found| {
                        let Pad { low, high, curve, retrigger } = found.pad;
                        let note = found.note;
                        format!("Note {note}: velocity {low} to {high}, curve {curve:.2}, retrigger {retrigger} ms")
                    },
                ));
                ui.horizontal(|ui| {
                    if ui.add_enabled(found.is_some(), egui::Button::new("Keep")).clicked()
                        && let Some(found) = found
                    {
                        let calibration = assignments.calibration();
                        calibration.set_pad(found.note, found.pad);
                        let before = calibration.learned().crosstalk;
                        calibration.set_crosstalk(before.max(found.crosstalk));
                        done = true;
                    }
                    done |= ui.button("Cancel").clicked();
                });
            }
            Subject::Pedal => {
                let task =
                    "Leave the pedal up, then press and release it some times, with chicks and splashes";
                ui.colored_label(accent, task);
                let found = lesson.pedal();
                ui.label(found.map_or_else(|| "Nothing of it has arrived".to_owned(), |pedal| told(&pedal)));
                ui.horizontal(|ui| {
                    if ui.add_enabled(found.is_some(), egui::Button::new("Keep")).clicked()
                        && let Some(pedal) = found
                    {
                        assignments.calibration().set_pedal(pedal);
                        done = true;
                    }
                    done |= ui.button("Cancel").clicked();
                });
            }
        }
        if done {
            self.lesson = None;
        }
    }

    /// What has arrived.
    fn monitor(&self, ui: &mut Ui) {
        let faint = theme::of(ui).faint;
        ui.label(RichText::new("Incoming").color(theme::of(ui).accent));
        ScrollArea::vertical().id_salt("incoming").auto_shrink(false).show(ui, |ui| {
            Grid::new("messages").num_columns(3).spacing([10.0, 2.0]).show(ui, |ui| {
                for incoming in &self.latest {
                    ui.colored_label(faint, format!("{:.3} s", incoming.time));
                    ui.colored_label(faint, format!("ch {}", incoming.channel + 1));
                    ui.label(text(incoming.message));
                    ui.end_row();
                }
            });
        });
    }
}

/// A message as it is shown.
fn text(message: MidiMessage) -> String {
    match message {
        MidiMessage::Note(note, velocity) => format!("note {note} velocity {velocity}"),
        MidiMessage::NoteOff(note) => format!("note {note} off"),
        MidiMessage::Pressure(note, value) => format!("note {note} pressure {value}"),
        MidiMessage::Controller(number, value) => format!("CC {number} {value}"),
        MidiMessage::Expression(note) => format!("note {note} expression"),
        MidiMessage::Program(number) => format!("program {number}"),
    }
}

/// A pedal as it is told.
fn told(pedal: &Pedal) -> String {
    if pedal.stuck {
        return "It hardly moves: it is stuck, and notes will say where the foot is".to_owned();
    }
    let Pedal { up, splash, chick, down, noise, .. } = pedal;
    let sense = if pedal.is_inverted() { "inverted" } else { "straight" };
    format!("{sense}: up {up}, splash {splash}, chick {chick}, down {down}, noise {noise}")
}

/// A number that can be dragged, typed, or moved by the keys of arrows.
fn number(ui: &mut Ui, name: &str, value: &mut u8, most: u8) -> bool {
    ui.label(name);
    ui.add(DragValue::new(value).range(0..=most)).changed()
}

fn pedal(ui: &mut Ui, assignments: &Assignments) {
    let calibration = assignments.calibration();
    let mut pedal = calibration.pedal();
    ui.label(RichText::new("Pedal").color(theme::of(ui).accent));
    let mut changed = false;
    ui.horizontal_wrapped(|ui| {
        changed |= number(ui, "up", &mut pedal.up, 127);
        changed |= number(ui, "foot splash", &mut pedal.splash, 127);
        changed |= number(ui, "chick", &mut pedal.chick, 127);
        changed |= number(ui, "down", &mut pedal.down, 127);
        changed |= number(ui, "noise", &mut pedal.noise, 32);
        changed |= ui.checkbox(&mut pedal.stuck, "stuck").changed();
        if ui.button("Reverse").clicked() {
            let turned = |reading: u8| {
                let way = reading.saturating_sub(pedal.up.min(pedal.down));
                pedal.up.max(pedal.down).saturating_sub(way)
            };
            let [splash, chick] = [pedal.splash, pedal.chick].map(turned);
            pedal = Pedal { up: pedal.down, down: pedal.up, splash, chick, ..pedal };
            changed = true;
        }
    });
    if changed {
        calibration.set_pedal(pedal);
    }
}

fn pads(ui: &mut Ui, assignments: &Assignments) {
    let calibration = assignments.calibration();
    let learned = calibration.learned();
    ui.label(RichText::new("Pads").color(theme::of(ui).accent));
    ui.horizontal(|ui| {
        let mut crosstalk = learned.crosstalk;
        if number(ui, "crosstalk below, %", &mut crosstalk, 100) {
            calibration.set_crosstalk(crosstalk);
        }
    });
    Grid::new("pads").num_columns(10).spacing([6.0, 4.0]).show(ui, |ui| {
        for (note, mut pad) in learned.pads {
            ui.label(format!("note {note}"));
            let mut changed = number(ui, "soft", &mut pad.low, 126);
            changed |= number(ui, "hard", &mut pad.high, 127);
            ui.label("curve");
            changed |= ui.add(DragValue::new(&mut pad.curve).range(0.25..=4.0).speed(0.01)).changed();
            changed |= number(ui, "retrigger, ms", &mut pad.retrigger, LONGEST_RETRIGGER);
            if changed {
                calibration.set_pad(note, pad);
            }
            if ui.button("Forget").clicked() {
                calibration.set_pad(note, Pad::default());
            }
            ui.end_row();
        }
    });
}
