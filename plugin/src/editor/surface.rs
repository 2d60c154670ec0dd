//! A piece's surface in perspective, displaced as it moves.
//!
//! The 145 points of the displacement field are refined by cubic interpolation, lit from above
//! left and coloured by displacement: up warm, down cold. World: the unit disc in x (right) and y
//! (away from the player), z up. The tallest displacement since the latest stroke fills a fixed
//! height, so that a ringing surface is seen to calm down.

use std::f32::consts::TAU;

use egui::epaint::Mesh;
use egui::{Color32, Rect, Sense, Shape, Stroke, Ui};
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{FieldShapes, PieceSnapshot, StrikeSnapshot};

use super::theme;

mod eye;
mod grid;

use eye::Eye;
use grid::{ANGLES, Grid};

/// Height of the tallest displacement since the latest stroke, in radii.
const TALLEST: f32 = 0.24;

/// Displacements below this are not magnified further, m: a resting head is flat.
const STILL: f32 = 1e-7;

/// How long a stroke's mark stays, s.
const MARK_TIME: f64 = 1.2;

/// Where light comes from.
const LIGHT: [f32; 3] = [-0.45, 0.35, 0.82];

/// A view of one surface: where it is seen from, and its scale.
pub struct Surface {
    /// Turn about the vertical, rad.
    yaw: f32,
    /// Height of the eye above the horizon, rad.
    pitch: f32,
    /// Tallest displacement since the latest stroke, m.
    tallest: f32,
    /// The latest stroke seen, and when.
    strike: (u32, f64),
}

impl Default for Surface {
    fn default() -> Self {
        Surface { yaw: 0.35, pitch: 0.62, tallest: 0.0, strike: (0, f64::NEG_INFINITY) }
    }
}

impl Surface {
    /// Forgets scale and stroke, for another piece to be shown; keeps the point of view.
    pub fn forget(&mut self) {
        *self = Surface { yaw: self.yaw, pitch: self.pitch, ..Surface::default() };
    }

    /// Tallest displacement since the latest stroke, m.
    pub fn tallest(&self) -> f32 {
        self.tallest
    }

    /// Draws a piece into `rect`; dragging turns it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        piece: PieceId,
        shapes: &FieldShapes,
        snapshot: &PieceSnapshot,
    ) {
        let response = ui.interact(rect, ui.scope_id().with("surface"), Sense::drag());
        if response.dragged() {
            let drag = response.drag_delta() * 0.008;
            self.yaw -= drag.x;
            self.pitch = (self.pitch + drag.y).clamp(0.15, 1.45);
        }
        let now = ui.input(|input| input.time);
        let field = displacement(shapes, &snapshot.displacement);
        self.follow(&field, &snapshot.strike, now);

        let look = Look::of(piece);
        let eye = Eye::new(rect, self.yaw, self.pitch, look.depth);
        let scale = TALLEST / self.tallest.max(STILL);
        let heights: Vec<f32> = field.iter().map(|z| z * scale).collect();
        let points = Grid::new(&heights, &look);
        let painter = ui.painter_at(rect);
        if look.depth > 0.0 {
            painter.add(shell(&eye, &look));
        }
        painter.add(points.mesh(&eye, &look));
        painter.extend(points.wires(&eye));
        painter.add(points.rim(&eye, &look));
        self.mark(&painter, &eye, &points, &snapshot.strike, now);
    }

    fn follow(&mut self, field: &[f32], strike: &StrikeSnapshot, now: f64) {
        if strike.count != self.strike.0 {
            self.strike = (strike.count, now);
            self.tallest = 0.0;
        }
        self.tallest = field.iter().fold(self.tallest, |tallest, z| tallest.max(z.abs()));
    }

    /// The place of the latest stroke, fading.
    fn mark(&self, painter: &egui::Painter, eye: &Eye, points: &Grid, strike: &StrikeSnapshot, now: f64) {
        let age = ((now - self.strike.1) / MARK_TIME) as f32;
        if strike.count == 0 || !(0.0..1.0).contains(&age) {
            return;
        }
        // Directions count from the player, who stands at negative y.
        let (sin, cos) = strike.angle.sin_cos();
        let (x, y) = (strike.radius * sin, -strike.radius * cos);
        let (at, _) = eye.project([x, y, points.height(x, y)]);
        let colour = theme::TEXT.gamma_multiply(1.0 - age);
        painter.circle_filled(at, 3.5, colour);
        painter.circle_stroke(at, 6.0 + 26.0 * age, Stroke::new(1.5, colour));
    }
}

/// Displacement at every point of the field, m; zero where it is not a number.
pub fn displacement(shapes: &FieldShapes, modes: &[f32]) -> Vec<f32> {
    let at = |shape: &[f32]| shape.iter().zip(modes).map(|(shape, q)| shape * q).sum::<f32>();
    let finite = |z: f32| if z.is_finite() { z } else { 0.0 };
    shapes.shapes.iter().map(|shape| finite(at(shape))).collect()
}

/// What a piece looks like at rest.
struct Look {
    colour: Color32,
    /// Share of mirrored light.
    gloss: f32,
    /// Depth of the shell below the head, radii; a cymbal has none.
    depth: f32,
    shell: Color32,
    rim: Color32,
    /// Rise of a cymbal's bow and of its bell, radii.
    bow: f32,
    bell: f32,
}

impl Look {
    /// Proportions from the sizes the engine builds, shells shortened so that they fit the view.
    fn of(piece: PieceId) -> Look {
        let (depth, shell) = match piece {
            PieceId::Kick => (0.85, Color32::from_rgb(106, 44, 38)),
            PieceId::Snare => (0.5, Color32::from_rgb(150, 146, 140)),
            PieceId::RackTom => (0.75, Color32::from_rgb(106, 44, 38)),
            PieceId::FloorTom => (1.05, Color32::from_rgb(106, 44, 38)),
            PieceId::Timpani => (0.9, Color32::from_rgb(150, 92, 52)),
            PieceId::Crash | PieceId::Ride | PieceId::Splash | PieceId::HiHat => (0.0, Color32::BLACK),
        };
        if piece.is_drum() {
            let head = Color32::from_rgb(222, 216, 204);
            let rim = Color32::from_rgb(198, 196, 192);
            Look { colour: head, gloss: 0.05, depth, shell, rim, bow: 0.0, bell: 0.0 }
        } else {
            let bronze = Color32::from_rgb(196, 152, 78);
            let rim = Color32::from_rgb(226, 190, 120);
            Look { colour: bronze, gloss: 0.45, depth, shell, rim, bow: 0.12, bell: 0.07 }
        }
    }

    /// Height at rest at a distance from the centre, radii.
    fn profile(&self, radius: f32) -> f32 {
        let bell = (1.0 - (radius / 0.2).powi(2)).max(0.0).sqrt();
        self.bow * (1.0 - radius * radius) + self.bell * bell
    }
}

/// The visible side of a drum's shell.
fn shell(eye: &Eye, look: &Look) -> Shape {
    let mut mesh = Mesh::default();
    for angle in 0..ANGLES {
        let ends = [angle, angle + 1].map(|angle| {
            let (sin, cos) = (angle as f32 * TAU / ANGLES as f32).sin_cos();
            (cos, sin)
        });
        let top = ends.map(|(x, y)| eye.project([x, y, 0.0]).0);
        let (x, y) = ends[0];
        let edge = eye.project([x, y, -look.depth]).0 - top[0];
        let along = top[1] - top[0];
        // Turned away from the eye.
        if along.x * edge.y - along.y * edge.x <= 0.0 {
            continue;
        }
        let first = mesh.vertices.len() as u32;
        for (x, y) in ends {
            let light = 0.45 + 0.5 * (LIGHT[0] * x - LIGHT[1] * y).max(0.0);
            for (z, light) in [(0.0, light), (-look.depth, 0.55 * light)] {
                mesh.colored_vertex(eye.project([x, y, z]).0, theme::lit(look.shell, light));
            }
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 2, first + 3);
    }
    Shape::mesh(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacement_is_the_sum_of_modes_and_always_a_number() {
        let mut shapes = FieldShapes { points: vec![[0.0; 2]; 2], shapes: vec![[0.0; 32]; 2] };
        shapes.shapes[0][3] = 2.0;
        let mut modes = [0.0; 32];
        modes[3] = 0.5;
        assert_eq!(displacement(&shapes, &modes), [1.0, 0.0]);
        modes[3] = f32::NAN;
        assert_eq!(displacement(&shapes, &modes), [0.0, 0.0]);
    }

    #[test]
    fn the_scale_holds_until_the_next_stroke() {
        let mut surface = Surface::default();
        let first = StrikeSnapshot { count: 1, ..StrikeSnapshot::default() };
        surface.follow(&[0.0, -2e-3], &first, 0.0);
        surface.follow(&[1e-3, 0.0], &first, 0.1);
        assert_eq!(surface.tallest(), 2e-3);
        surface.follow(&[1e-3, 0.0], &StrikeSnapshot { count: 2, ..first }, 0.2);
        assert_eq!(surface.tallest(), 1e-3);
    }
}
