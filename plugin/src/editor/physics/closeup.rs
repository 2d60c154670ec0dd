//! One piece near by: its surface as it moves, or one of its modes alone.

use egui::{Align2, Rect, Sense, Ui, pos2};
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::slot::Slot;

use super::bending;
use super::page::Seen;
use crate::editor::field::{self, Magnifier};
use crate::editor::kit_view::bodies::{Body, Frame};
use crate::editor::kit_view::camera::Eye;
use crate::editor::kit_view::scene::Scene;
use crate::editor::kit_view::surfaces::{self, Motion, Tint};
use crate::editor::plot::length_text;
use crate::editor::theme;

/// How often a mode that is shown alone swings, Hz: as slow as is pleasant.
const SWING: f64 = 0.8;

/// A view of one surface.
pub struct Closeup {
    magnifier: Magnifier,
    /// The piece the magnifier is about.
    slot: Option<Slot>,
    yaw: f32,
    pitch: f32,
}

impl Default for Closeup {
    fn default() -> Closeup {
        Closeup { magnifier: Magnifier::default(), slot: None, yaw: 0.4, pitch: 0.62 }
    }
}

impl Closeup {
    /// Draws the selected piece, or a mode of it.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, seen: &Seen<'_>, mode: Option<usize>) {
        let palette = theme::of(ui);
        let (slot, spec) = seen.selected;
        if self.slot != Some(slot) {
            (self.slot, self.magnifier) = (Some(slot), Magnifier::default());
        }
        ui.painter().rect_filled(rect, theme::CORNER, palette.panel);
        let response = ui.interact(rect, ui.scope_id().with("closeup"), Sense::drag());
        let drag = response.drag_delta() * 0.008;
        self.yaw -= drag.x;
        self.pitch = (self.pitch + drag.y).clamp(0.15, 1.45);
        let Some(shapes) = &seen.shapes else { return };

        // It lies flat before the eye.
        let body = Body { frame: Frame::new([0.0; 3], [0.0, 1.0, 0.0]), ..Body::of(spec) };
        let ((sin, cos), (rise, flat)) = (self.yaw.sin_cos(), self.pitch.sin_cos());
        let view = Rect::from_min_max(pos2(rect.min.x, rect.min.y + 18.0), rect.max);
        let eye = Eye::new(view, [0.0; 3], [sin * flat, rise, -cos * flat], 3.0 * body.radius);
        let mut scene = Scene::new(eye);
        let modes = &seen.snapshot.pieces[slot.index()].displacement;
        let (now, elapsed) = ui.input(|input| (input.time, input.unstable_dt));
        let live = field::displacement(shapes, modes);
        self.magnifier.follow(&live, elapsed);
        let (points, factor) = match mode {
            Some(mode) => {
                let shape: Vec<f32> = shapes.shapes.iter().map(|point| point[mode]).collect();
                let most = shape.iter().fold(1e-6_f32, |most, z| most.max(z.abs()));
                let swing = (std::f64::consts::TAU * SWING * now).sin() as f32;
                (shape, swing * body.tallest() / most)
            }
            None => (live, self.magnifier.factor(body.tallest())),
        };
        let scaled: Vec<f32> = points.iter().map(|z| z * factor).collect();
        let heights = field::refined(&scaled);
        let accent = palette.pieces[slot.index()];
        let motion = Motion { heights: &heights, tint: Tint::Displacement, accent, glow: 0.0 };
        surfaces::moving(&mut scene, &body, &motion, palette);
        let painter = ui.painter_at(rect);
        painter.add(scene.finish());
        let remark = match mode {
            Some(_) => "one mode alone, slowed down".to_owned(),
            None => self.remark(spec, factor),
        };
        let line = rect.min.y + 14.0;
        let left = pos2(rect.min.x + 12.0, line);
        painter.text(left, Align2::LEFT_CENTER, "Surface", theme::body(), palette.text);
        let right = pos2(rect.max.x - 12.0, line);
        painter.text(right, Align2::RIGHT_CENTER, remark, theme::caption(), palette.faint);
    }

    /// How far it moves, against its thickness if it is a plate, and how much larger it is drawn.
    fn remark(&self, piece: &PieceSpec, factor: f32) -> String {
        let moved = self.magnifier.tallest();
        if moved < 1e-7 {
            return "at rest".to_owned();
        }
        let far = length_text(moved);
        match bending::thickness(piece) {
            Some(thickness) => {
                format!("moves {far}, {:.2} of its thickness, magnified {factor:.0} times", moved / thickness)
            }
            None => format!("moves {far}, magnified {factor:.0} times"),
        }
    }
}
