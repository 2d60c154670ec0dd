//! The refined surface: the field's points and what cubic interpolation puts between them, lit
//! and coloured.

use std::f32::consts::TAU;

use egui::epaint::Mesh;
use egui::{Color32, Shape, Stroke};

use super::eye::Eye;
use super::{LIGHT, Look, TALLEST};
use crate::editor::theme;

/// Rings and spokes of the field.
const RINGS: usize = 6;
const SPOKES: usize = 24;

/// Points drawn for each of the field's, along a radius and around.
const FINER: usize = 3;
const RADII: usize = RINGS * FINER;
pub const ANGLES: usize = SPOKES * FINER;

/// The refined surface: centre, then ring by ring.
pub struct Grid {
    /// `[radius][angle]`, the first radius being the centre throughout.
    heights: Vec<[f32; ANGLES]>,
    tallest: f32,
}

impl Grid {
    /// Refines the heights of a field's points, in radii, over a piece's profile.
    pub fn new(field: &[f32], look: &Look) -> Grid {
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

    pub fn point(&self, radius: usize, angle: usize) -> [f32; 3] {
        let (sin, cos) = (angle as f32 * TAU / ANGLES as f32).sin_cos();
        let distance = radius as f32 / RADII as f32;
        [distance * cos, distance * sin, self.heights[radius][angle % ANGLES]]
    }

    /// Height at the nearest point.
    pub fn height(&self, x: f32, y: f32) -> f32 {
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
    pub fn mesh(&self, eye: &Eye, look: &Look) -> Shape {
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
    pub fn wires(&self, eye: &Eye) -> Vec<Shape> {
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

    pub fn rim(&self, eye: &Eye, look: &Look) -> Shape {
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
    use overhear_engine::piece::PieceId;
    use overhear_engine::snapshot::FieldShapes;

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
}
