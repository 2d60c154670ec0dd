//! A piece's surface in perspective, displaced as it moves.
//!
//! The 145 points of the displacement field are refined by cubic interpolation, lit from above
//! left and coloured by displacement: up warm, down cold. World: the unit disc in x (right) and y
//! (away from the player), z up. The tallest displacement since the latest stroke fills a fixed
//! height, so that a ringing surface is seen to calm down.

use std::f32::consts::TAU;

use egui::epaint::Mesh;
use egui::{Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, vec2};
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{FieldShapes, PieceSnapshot, StrikeSnapshot};

use super::theme;

/// Rings and spokes of the field.
const RINGS: usize = 6;
const SPOKES: usize = 24;

/// Points drawn for each of the field's, along a radius and around.
const FINER: usize = 3;
const RADII: usize = RINGS * FINER;
const ANGLES: usize = SPOKES * FINER;

/// Height of the tallest displacement since the latest stroke, in radii.
const TALLEST: f32 = 0.24;

/// Displacements below this are not magnified further, m: a resting head is flat.
const STILL: f32 = 1e-7;

/// How long a stroke's mark stays, s.
const MARK_TIME: f64 = 1.2;

/// Where light comes from.
const LIGHT: [f32; 3] = [-0.45, 0.35, 0.82];

/// Distance of the eye from the centre, radii.
const EYE: f32 = 4.6;

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
            PieceId::Crash | PieceId::Ride | PieceId::Splash => (0.0, Color32::BLACK),
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

/// Perspective from a point of view onto a rectangle of the screen.
struct Eye {
    centre: Pos2,
    scale: f32,
    yaw: (f32, f32),
    pitch: (f32, f32),
}

impl Eye {
    fn new(rect: Rect, yaw: f32, pitch: f32, depth: f32) -> Eye {
        let (sin, cos) = pitch.sin_cos();
        // What the disc and its shell take up on the screen, in radii.
        let height = 2.0 * sin + (depth + 2.0 * TALLEST) * cos;
        let scale = (rect.width() / 2.5).min(rect.height() / (1.25 * height));
        let below = 0.5 * depth * cos * scale;
        let centre = rect.center() - vec2(0.0, below);
        Eye { centre, scale, yaw: yaw.sin_cos(), pitch: (sin, cos) }
    }

    /// Place on the screen, and distance from the eye.
    fn project(&self, [x, y, z]: [f32; 3]) -> (Pos2, f32) {
        let [right, away] = self.turned(x, y);
        let up = z * self.pitch.1 + away * self.pitch.0;
        let distance = EYE + away * self.pitch.1 - z * self.pitch.0;
        let scale = self.scale * EYE / distance.max(0.5);
        (self.centre + scale * vec2(right, -up), distance)
    }

    fn turned(&self, x: f32, y: f32) -> [f32; 2] {
        let (sin, cos) = self.yaw;
        [x * cos - y * sin, x * sin + y * cos]
    }
}

/// The refined surface: centre, then ring by ring.
struct Grid {
    /// `[radius][angle]`, the first radius being the centre throughout.
    heights: Vec<[f32; ANGLES]>,
    tallest: f32,
}

impl Grid {
    /// Refines the heights of a field's points, in radii, over a piece's profile.
    fn new(field: &[f32], look: &Look) -> Grid {
        let around: Vec<[f32; ANGLES]> = (0..RINGS).map(|ring| refined_ring(field, ring)).collect();
        let centre = field.first().copied().unwrap_or(0.0);
        // Beyond the centre a radius goes on along the opposite one.
        let at = |ring: isize, angle: usize| match ring {
            0 => centre,
            1.. => {
                let last = around.len() as isize;
                let inside = |ring: isize| around[ring as usize - 1][angle];
                if ring <= last { inside(ring) } else { 2.0 * inside(last) - inside(last - 1) }
            }
            _ => around[(-ring) as usize - 1][(angle + ANGLES / 2) % ANGLES],
        };
        let row = |radius: usize| {
            let (ring, part) = ((radius / FINER) as isize, (radius % FINER) as f32 / FINER as f32);
            std::array::from_fn(|angle| {
                let near = [ring - 1, ring, ring + 1, ring + 2].map(|ring| at(ring, angle));
                cubic(near, part) + look.profile(radius as f32 / RADII as f32)
            })
        };
        Grid { heights: (0..=RADII).map(row).collect(), tallest: TALLEST }
    }

    fn point(&self, radius: usize, angle: usize) -> [f32; 3] {
        let (sin, cos) = (angle as f32 * TAU / ANGLES as f32).sin_cos();
        let distance = radius as f32 / RADII as f32;
        [distance * cos, distance * sin, self.heights[radius][angle % ANGLES]]
    }

    /// Height at the nearest point.
    fn height(&self, x: f32, y: f32) -> f32 {
        let radius = ((x.hypot(y) * RADII as f32).round() as usize).min(RADII);
        let turn = y.atan2(x).rem_euclid(TAU) / TAU;
        self.heights[radius][(turn * ANGLES as f32).round() as usize % ANGLES]
    }

    /// Colour of a point by displacement and light.
    fn colour(&self, radius: usize, angle: usize, look: &Look) -> Color32 {
        let z = self.heights[radius][angle] - look.profile(radius as f32 / RADII as f32);
        let motion = (z / self.tallest).clamp(-1.0, 1.0);
        let tint = if motion > 0.0 { theme::ACCENT } else { theme::DEEP };
        let colour = theme::blend(look.colour, tint, 0.85 * motion.abs().powf(0.7));

        let (inner, outer) = (radius.saturating_sub(1), (radius + 1).min(RADII));
        let along = difference(self.point(outer, angle), self.point(inner, angle));
        let ring = radius.max(1);
        let around = difference(self.point(ring, angle + 1), self.point(ring, angle + ANGLES - 1));
        let normal = unit(cross(along, around));
        let light = dot(normal, unit(LIGHT)).max(0.0);
        theme::lit(colour, 0.42 + 0.62 * light + look.gloss * light.powi(24))
    }

    /// The surface as triangles, the farthest first.
    fn mesh(&self, eye: &Eye, look: &Look) -> Shape {
        let mut mesh = Mesh::default();
        let mut distances = Vec::with_capacity((RADII + 1) * ANGLES);
        for radius in 0..=RADII {
            for angle in 0..ANGLES {
                let (at, distance) = eye.project(self.point(radius, angle));
                mesh.colored_vertex(at, self.colour(radius, angle, look));
                distances.push(distance);
            }
        }
        let index = |radius: usize, angle: usize| (radius * ANGLES + angle % ANGLES) as u32;
        let mut quads: Vec<(f32, [u32; 4])> = Vec::with_capacity(RADII * ANGLES);
        for radius in 0..RADII {
            for angle in 0..ANGLES {
                let corners = [(radius, angle), (radius + 1, angle)]
                    .map(|(radius, angle)| [index(radius, angle), index(radius, angle + 1)]);
                let [[a, b], [c, d]] = corners;
                let distance = [a, b, c, d].iter().map(|&i| distances[i as usize]).sum();
                quads.push((distance, [a, b, c, d]));
            }
        }
        quads.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, [a, b, c, d]) in quads {
            mesh.add_triangle(a, c, b);
            mesh.add_triangle(b, c, d);
        }
        Shape::mesh(mesh)
    }

    /// The field's rings and spokes, which show the bending that light alone does not.
    fn wires(&self, eye: &Eye) -> Vec<Shape> {
        let stroke = Stroke::new(1.0, Color32::from_black_alpha(30));
        let at = |radius, angle| eye.project(self.point(radius, angle)).0;
        let ring = |ring: usize| {
            let points = (0..ANGLES).map(|angle| at(ring * FINER, angle)).collect();
            Shape::closed_line(points, stroke)
        };
        let spoke = |spoke: usize| {
            let points = (0..=RADII).map(|radius| at(radius, spoke * FINER)).collect();
            Shape::line(points, stroke)
        };
        // Every third spoke: more would blacken the centre.
        (1..RINGS).map(ring).chain((0..SPOKES).step_by(3).map(spoke)).collect()
    }

    fn rim(&self, eye: &Eye, look: &Look) -> Shape {
        let points = (0..ANGLES).map(|angle| eye.project(self.point(RADII, angle)).0).collect();
        let width = if look.depth > 0.0 { 4.0 } else { 1.5 };
        Shape::closed_line(points, Stroke::new(width, look.rim))
    }
}

/// One ring of the field with points added between the spokes.
fn refined_ring(field: &[f32], ring: usize) -> [f32; ANGLES] {
    let at = |spoke: usize| field.get(1 + ring * SPOKES + spoke % SPOKES).copied().unwrap_or(0.0);
    std::array::from_fn(|angle| {
        let (spoke, part) = (angle / FINER, (angle % FINER) as f32 / FINER as f32);
        cubic([SPOKES - 1, 0, 1, 2].map(|offset| at(spoke + offset)), part)
    })
}

/// Catmull-Rom interpolation between the middle two of four equidistant values.
fn cubic([a, b, c, d]: [f32; 4], part: f32) -> f32 {
    let linear = 0.5 * (c - a);
    let square = a - 2.5 * b + 2.0 * c - 0.5 * d;
    let cube = 0.5 * (d - a) + 1.5 * (b - c);
    b + part * (linear + part * (square + part * cube))
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

fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn unit(a: [f32; 3]) -> [f32; 3] {
    let length = dot(a, a).sqrt().max(f32::MIN_POSITIVE);
    a.map(|component| component / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Vec2;

    #[test]
    fn the_refined_grid_passes_through_the_field() {
        let field: Vec<f32> =
            FieldShapes::grid().iter().map(|[x, y]| 0.1 * x - 0.05 * y + 0.02 * x * y).collect();
        let drum = Look::of(PieceId::Snare);
        let grid = Grid::new(&field, &drum);
        assert!((grid.heights[0][0] - field[0]).abs() < 1e-6);
        for ring in 1..=RINGS {
            for spoke in 0..SPOKES {
                let refined = grid.heights[ring * FINER][spoke * FINER];
                assert!((refined - field[1 + (ring - 1) * SPOKES + spoke]).abs() < 1e-6);
            }
        }
        let [x, y, z] = grid.point(RADII / 2, ANGLES / 8);
        assert!((z - (0.1 * x - 0.05 * y + 0.02 * x * y)).abs() < 1e-3);
    }

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

    #[test]
    fn nearer_points_are_larger_and_lower() {
        let rect = Rect::from_min_size(Pos2::ZERO, Vec2::splat(400.0));
        let eye = Eye::new(rect, 0.0, 0.6, 0.0);
        let (near, near_distance) = eye.project([0.0, -1.0, 0.0]);
        let (far, far_distance) = eye.project([0.0, 1.0, 0.0]);
        assert!(near.y > far.y && near_distance < far_distance);
        let width = |y: f32| eye.project([0.5, y, 0.0]).0.x - eye.project([-0.5, y, 0.0]).0.x;
        assert!(width(-1.0) > width(1.0));
        assert!(rect.contains(near) && rect.contains(far));
    }
}
