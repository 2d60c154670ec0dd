//! What stands around the surface: the list of pieces with their levels, the main level, the
//! selected piece's knobs, and one line about its latest stroke.

use std::sync::Arc;

use egui::{Align2, Color32, Pos2, Rect, Sense, Ui, pos2, vec2};
use nice_plug::prelude::FloatParam;
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{FieldShapes, KitSnapshot, PieceSnapshot};

use super::knob::{self, Gesture};
use super::surface::Surface;
use super::theme;
use crate::NAME;
use crate::outputs::title;
use crate::parameters::{PARAMETERS, Parameter};

/// Space around and between panels, points.
const GAP: f32 = 10.0;

/// Room of a knob where there is enough, points.
const KNOB_WIDTH: f32 = 96.0;

/// Knobs of the kit beside a piece's; the panel of playing has all of them.
const KIT_KNOBS: usize = 2;

/// Bottom of the meters, dB.
const FLOOR_DB: f32 = -60.0;

/// Top of the meters, dB: a little reserve above full scale.
const TOP_DB: f32 = 6.0;

/// How fast a meter falls, dB/s: slow enough to be read.
const FALL: f32 = 36.0;

/// Everything one window shows and remembers.
pub struct Panels {
    selected: usize,
    surface: Surface,
    /// Levels shown, dB: one for each piece, then left and right.
    levels: [f32; PieceId::KIT.len() + 2],
    /// Where the surface was drawn last.
    stage: Rect,
    /// Clock of the latest snapshot whose peaks were taken.
    clock: u64,
}

impl Default for Panels {
    fn default() -> Self {
        Panels {
            selected: 1,
            surface: Surface::default(),
            levels: [FLOOR_DB; PieceId::KIT.len() + 2],
            stage: Rect::ZERO,
            clock: 0,
        }
    }
}

/// Where in a window there is room in the header.
pub fn bar_rect(window: Rect) -> Rect {
    let right = window.max.x - GAP;
    Rect::from_min_max(
        pos2((right - 520.0).max(window.min.x), window.min.y + 6.0),
        pos2(right, window.min.y + 38.0),
    )
}

impl Panels {
    /// Draws one frame. `shapes` gives a slot's mode shapes once it is built; `set` receives what
    /// is done to the parameter of an index.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        snapshot: &KitSnapshot,
        shapes: &dyn Fn(usize) -> Option<Arc<FieldShapes>>,
        parameters: &[FloatParam],
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        self.follow_levels(ui, snapshot);
        let whole = ui.max_rect().shrink(GAP);
        ui.painter().rect_filled(ui.max_rect(), 0.0, theme::BACKGROUND);
        let (header, rest) = whole.split_top_bottom_at_y(whole.min.y + 34.0);
        let (upper, knobs) = rest.split_top_bottom_at_y(rest.max.y - 128.0);
        let upper = Rect::from_min_max(upper.min, upper.max - vec2(0.0, GAP));
        let (list, right) = upper.split_left_right_at_x(upper.min.x + 210.0);
        let (stage, meters) = right.split_left_right_at_x(right.max.x - 54.0);
        let stage = Rect::from_min_max(stage.min + vec2(GAP, 0.0), stage.max - vec2(GAP, 0.0));

        self.stage = stage;
        self.header(ui, header, snapshot);
        self.list(ui, list, snapshot);
        self.stage(ui, stage, snapshot, shapes);
        self.main_meters(ui, meters);
        self.knobs(ui, knobs, parameters, set);
    }

    /// Where the surface was drawn last.
    pub fn stage_rect(&self) -> Rect {
        self.stage
    }

    /// Meters jump up at once and fall slowly.
    fn follow_levels(&mut self, ui: &Ui, snapshot: &KitSnapshot) {
        let fall = FALL * ui.input(|input| input.stable_dt).min(0.1);
        // A host that stopped leaves its last snapshot behind: its peaks count once.
        let fresh = if snapshot.clock == self.clock { 0.0 } else { 1.0 };
        self.clock = snapshot.clock;
        let pieces = snapshot.pieces.iter().map(|piece| piece.peak);
        let mut moving = false;
        for (level, peak) in self.levels.iter_mut().zip(pieces.chain(snapshot.peak)) {
            *level = decibels(fresh * peak).max(*level - fall).clamp(FLOOR_DB, TOP_DB);
            moving |= *level > FLOOR_DB;
        }
        if moving {
            // The meters still fall where the kit is already silent.
            ui.ctx().request_repaint_after_secs(1.0 / 60.0);
        }
    }

    fn header(&self, ui: &Ui, rect: Rect, snapshot: &KitSnapshot) {
        let painter = ui.painter();
        let left = rect.left_center() - vec2(0.0, 6.0);
        let title = painter.text(left, Align2::LEFT_CENTER, NAME, theme::heading(), theme::TEXT);
        let (status, colour) = status(snapshot);
        let beside = pos2(title.max.x + 16.0, left.y + 2.0);
        painter.text(beside, Align2::LEFT_CENTER, status, theme::body(), colour);
    }

    fn list(&mut self, ui: &mut Ui, rect: Rect, snapshot: &KitSnapshot) {
        let rows = PieceId::KIT.len() as f32;
        let height = ((rect.height() + 4.0) / rows).min(84.0);
        for (slot, piece) in PieceId::KIT.into_iter().enumerate() {
            let top = rect.min + vec2(0.0, slot as f32 * height);
            let row = Rect::from_min_size(top, vec2(rect.width(), height - 4.0));
            let response = ui.interact(row, ui.scope_id().with(("piece", slot)), Sense::click());
            if response.clicked() && self.selected != slot {
                self.selected = slot;
                self.surface.forget();
            }
            let fill = match (self.selected == slot, response.hovered()) {
                (true, _) => theme::RAISED,
                (false, true) => theme::HOVERED,
                (false, false) => theme::PANEL,
            };
            let painter = ui.painter();
            painter.rect_filled(row, theme::CORNER, fill);
            if self.selected == slot {
                let edge = Rect::from_min_size(row.min, vec2(3.0, row.height()));
                painter.rect_filled(edge, theme::CORNER, theme::ACCENT);
            }
            let state = &snapshot.pieces[slot];
            let colour = if state.ready { theme::TEXT } else { theme::FAINT };
            let middle = row.min.y + 0.38 * row.height();
            let name = pos2(row.min.x + 14.0, middle);
            painter.text(name, Align2::LEFT_CENTER, title(piece), theme::body(), colour);
            let note = if state.ready { level_text(self.levels[slot]) } else { "building".into() };
            let at = pos2(row.max.x - 12.0, middle);
            painter.text(at, Align2::RIGHT_CENTER, note, theme::caption(), theme::FAINT);
            let meter = Rect::from_min_max(
                pos2(row.min.x + 14.0, row.max.y - 12.0),
                pos2(row.max.x - 12.0, row.max.y - 7.0),
            );
            level_bar(ui, meter, self.levels[slot]);
        }
    }

    fn stage(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        snapshot: &KitSnapshot,
        shapes: &dyn Fn(usize) -> Option<Arc<FieldShapes>>,
    ) {
        ui.painter().rect_filled(rect, theme::CORNER, theme::PANEL);
        let piece = PieceId::KIT[self.selected];
        let state = &snapshot.pieces[self.selected];
        let view = rect.shrink(8.0);
        if let Some(shapes) = shapes(self.selected) {
            self.surface.show(ui, view, piece, &shapes, state);
        }
        let painter = ui.painter_at(rect);
        let corner = view.min + vec2(6.0, 4.0);
        painter.text(corner, Align2::LEFT_TOP, title(piece), theme::heading(), theme::TEXT);
        let scale = format!("tallest since the stroke {}", length_text(self.surface.tallest()));
        let below = corner + vec2(0.0, 26.0);
        painter.text(below, Align2::LEFT_TOP, scale, theme::caption(), theme::FAINT);
        let bottom = pos2(view.min.x + 6.0, view.max.y - 4.0);
        let line = stroke_text(state);
        painter.text(bottom, Align2::LEFT_BOTTOM, line, theme::body(), theme::TEXT);
    }

    /// Levels shown of the two outputs, dB.
    pub fn main_levels(&self) -> (f32, f32) {
        let [.., left, right] = self.levels;
        (left, right)
    }

    fn main_meters(&self, ui: &Ui, rect: Rect) {
        let painter = ui.painter();
        painter.rect_filled(rect, theme::CORNER, theme::PANEL);
        let label = pos2(rect.center().x, rect.max.y - 12.0);
        painter.text(label, Align2::CENTER_CENTER, "Main", theme::caption(), theme::FAINT);
        let (left, right) = self.main_levels();
        let loudest = pos2(rect.center().x, rect.min.y + 12.0);
        let text = level_text(left.max(right));
        painter.text(loudest, Align2::CENTER_CENTER, text, theme::caption(), theme::FAINT);
        for (level, x) in [(left, -9.0), (right, 9.0)] {
            let centre = rect.center().x + x;
            let bar =
                Rect::from_x_y_ranges(centre - 6.0..=centre + 6.0, rect.min.y + 24.0..=rect.max.y - 24.0);
            painter.rect_filled(bar, 2.0, theme::RAISED);
            let top = bar.max.y - bar.height() * share(level);
            let filled = Rect::from_min_max(pos2(bar.min.x, top), bar.max);
            painter.rect_filled(filled, 2.0, level_colour(level));
            let full_scale = bar.max.y - bar.height() * share(0.0);
            painter.hline(bar.x_range(), full_scale, (1.0, theme::FAINT));
        }
    }

    fn knobs(&self, ui: &mut Ui, rect: Rect, parameters: &[FloatParam], set: &mut dyn FnMut(usize, Gesture)) {
        ui.painter().rect_filled(rect, theme::CORNER, theme::PANEL);
        let piece = title(PieceId::KIT[self.selected]);
        let left = rect.min.x + 12.0;
        let kit_room = KIT_KNOBS as f32 * KNOB_WIDTH;
        let kit = rect.max.x - kit_room - 12.0;
        for (group, start, room, most) in
            [(piece, left, kit - left, PARAMETERS.len()), ("Kit", kit, kit_room, KIT_KNOBS)]
        {
            caption(ui, pos2(start + 6.0, rect.min.y + 13.0), group);
            let of_group =
                |(_, (parameter, _)): &(usize, (&Parameter, &FloatParam))| parameter.group == group;
            let shown = || PARAMETERS.iter().zip(parameters).enumerate().filter(of_group).take(most);
            let width = KNOB_WIDTH.min(room / shown().count().max(1) as f32);
            for (place, (index, (parameter, value))) in shown().enumerate() {
                let at = pos2(start + place as f32 * width, rect.min.y + 26.0);
                let cell = Rect::from_min_size(at, vec2(width, 96.0));
                knob::knob(ui, cell, parameter.label, value, |gesture| set(index, gesture));
            }
        }
    }
}

/// One sentence about the kit as a whole.
fn status(snapshot: &KitSnapshot) -> (String, Color32) {
    let quarantines: u32 = snapshot.pieces.iter().map(|piece| piece.quarantines).sum();
    let ready = snapshot.pieces.iter().filter(|piece| piece.ready).count();
    if quarantines > 0 {
        (format!("A piece went out of bounds {quarantines} times and was reset"), theme::OVER)
    } else if snapshot.clock == 0 {
        ("Waiting for the host to run".to_owned(), theme::FAINT)
    } else if ready < PieceId::KIT.len() {
        (format!("Building the kit: {ready} of {} pieces", PieceId::KIT.len()), theme::ACCENT)
    } else if snapshot.late_buffers > 0 {
        (
            format!("{} buffers were late: lower the quality, or add a worker", snapshot.late_buffers),
            theme::OVER,
        )
    } else if snapshot.missed_runs > 0 {
        let missed = snapshot.missed_runs;
        (format!("Workers left pieces silent for {missed} blocks: use fewer of them"), theme::OVER)
    } else if snapshot.dropped_strikes > 0 {
        let dropped = snapshot.dropped_strikes;
        (format!("Ready; {dropped} early strokes were dropped"), theme::FAINT)
    } else {
        ("Ready".to_owned(), theme::FAINT)
    }
}

/// What the latest stroke's contact measured.
fn stroke_text(piece: &PieceSnapshot) -> String {
    let stroke = &piece.strike;
    if stroke.count == 0 {
        return "Not struck yet".to_owned();
    }
    let touches = match stroke.touches {
        0 | 1 => String::new(),
        touches => format!(" in {touches} touches"),
    };
    format!(
        "Struck at {:.2} m/s, {:.2} of the radius: {:.2} ms of contact{touches}, peak {:.0} N, \
         leaves at {:.2} m/s",
        stroke.speed,
        stroke.radius,
        stroke.contact_time * 1e3,
        stroke.peak_force,
        stroke.leaving_speed
    )
}

fn caption(ui: &Ui, at: Pos2, text: &str) {
    ui.painter().text(at, Align2::LEFT_CENTER, text, theme::body(), theme::TEXT);
}

/// A length in the unit that suits it.
fn length_text(length: f32) -> String {
    match length {
        l if l >= 1e-3 => format!("{:.2} mm", l * 1e3),
        l if l >= 1e-6 => format!("{:.1} µm", l * 1e6),
        l if l > 0.0 => "below 1 µm".to_owned(),
        _ => "0".to_owned(),
    }
}

fn decibels(peak: f32) -> f32 {
    if peak > 0.0 { 20.0 * peak.log10() } else { FLOOR_DB }
}

fn level_text(level: f32) -> String {
    if level > FLOOR_DB { format!("{level:+.0} dB") } else { String::new() }
}

/// Place of a level on a meter, 0 to 1.
fn share(level: f32) -> f32 {
    ((level - FLOOR_DB) / (TOP_DB - FLOOR_DB)).clamp(0.0, 1.0)
}

fn level_colour(level: f32) -> Color32 {
    match level {
        l if l >= 0.0 => theme::OVER,
        l if l >= -6.0 => theme::ACCENT,
        _ => theme::LEVEL,
    }
}

fn level_bar(ui: &Ui, rect: Rect, level: f32) {
    ui.painter().rect_filled(rect, 2.0, theme::BACKGROUND);
    let filled = Rect::from_min_size(rect.min, vec2(rect.width() * share(level), rect.height()));
    ui.painter().rect_filled(filled, 2.0, level_colour(level));
}
