//! What is drawn of the world: faces and lines gathered from all bodies, then painted from the farthest to the
//! nearest.
//!
//! Bodies add faces in any order; one sort by depth makes nearer ones cover farther ones. That is right for faces
//! that do not cut through each other, small against the distance between bodies. Edges of faces are hard:
//! lines that fade out over a point are laid over those that are seen against something else.

use egui::epaint::{Mesh, Vertex};
use egui::{Color32, Pos2, Shape, Vec2};

use super::camera::{Eye, NEAREST};
use super::vector::{V3, between};

/// Over how much an edge fades, points.
const SOFT: f32 = 0.7;

/// Faces and lines of one picture.
pub struct Scene {
    pub eye: Eye,
    /// How much nearer than it is everything is painted, m: for what lies on something else.
    pub lift: f32,
    vertices: Vec<Vertex>,
    depths: Vec<f32>,
    /// Sort key, the farthest smallest, and corners.
    faces: Vec<(u32, [u32; 4])>,
}

impl Scene {
    pub fn new(eye: Eye) -> Scene {
        Scene {
            eye,
            lift: 0.0,
            vertices: Vec::with_capacity(10_000),
            depths: Vec::with_capacity(10_000),
            faces: Vec::with_capacity(10_000),
        }
    }

    /// Adds a corner.
    pub fn vertex(&mut self, point: V3, colour: Color32) -> u32 {
        let (at, depth) = self.eye.project(point);
        self.screen_vertex(at, depth, colour)
    }

    fn screen_vertex(&mut self, at: Pos2, depth: f32, colour: Color32) -> u32 {
        let index = self.vertices.len() as u32;
        self.vertices.push(Vertex { pos: at, uv: egui::epaint::WHITE_UV, color: colour });
        self.depths.push(depth);
        index
    }

    /// Adds a face from `a` to `d`, with `b` and `c` between them: two triangles. It is painted as if it
    /// were nearer by `lift`, m.
    pub fn face(&mut self, [a, b, c, d]: [u32; 4], lift: f32) {
        let depth: f32 = [a, b, c, d].iter().map(|&i| self.depths[i as usize]).sum();
        self.push(0.25 * depth - lift, [a, b, c, d]);
    }

    fn push(&mut self, depth: f32, corners: [u32; 4]) {
        // Depths are above zero, and the bits of such numbers are in their order.
        let nearest = corners.iter().map(|&i| self.depths[i as usize]).fold(f32::INFINITY, f32::min);
        // What reaches behind the eye is not seen from there.
        if nearest > NEAREST {
            self.faces.push((!(depth - self.lift).max(0.0).to_bits(), corners));
        }
    }

    /// Adds a line of a width (points) that fades out at its sides.
    pub fn line(&mut self, from: V3, to: V3, width: f32, colour: Color32, lift: f32) {
        let half = 0.5 * width + SOFT;
        let clear = Color32::TRANSPARENT;
        self.strip(from, to, [half, half], &[(-1.0, clear), (0.0, colour), (1.0, clear)], lift);
    }

    /// Adds a round rod of a radius (m), lit from the side; long ones in parts, for the sort.
    pub fn rod(&mut self, from: V3, to: V3, radius: f32, [dark, light]: [Color32; 2]) {
        self.taper(from, to, [radius; 2], [dark, light]);
    }

    /// A [`rod`](Self::rod) with another radius (m) at each end.
    pub fn taper(&mut self, from: V3, to: V3, radii: [f32; 2], [dark, light]: [Color32; 2]) {
        /// Length of a part, m.
        const PART: f32 = 0.12;
        let length = super::vector::length(super::vector::sub(to, from));
        let parts = (length / PART).ceil().clamp(1.0, 24.0) as usize;
        let radius = |share: f32| radii[0] + share * (radii[1] - radii[0]);
        for part in 0..parts {
            let shares = [part, part + 1].map(|part| part as f32 / parts as f32);
            let ends = shares.map(|share| between(from, to, share));
            let halves: [f32; 2] = std::array::from_fn(|end| {
                let (_, depth) = self.eye.project(ends[end]);
                self.eye.points(radius(shares[end]), depth).max(0.35) + SOFT
            });
            let core = 1.0 - SOFT / halves[0].max(halves[1]);
            let clear = Color32::TRANSPARENT;
            let profile = [(-1.0, clear), (-core, dark), (-0.35 * core, light), (core, dark), (1.0, clear)];
            self.strip(ends[0], ends[1], halves, &profile, 0.0);
        }
    }

    /// A band along a line: colours across it, at shares of its half widths (points).
    fn strip(&mut self, from: V3, to: V3, halves: [f32; 2], profile: &[(f32, Color32)], lift: f32) {
        let ends = [from, to].map(|end| self.eye.project(end));
        let along = ends[1].0 - ends[0].0;
        let across = if along.length_sq() > 1e-6 { along.normalized().rot90() } else { Vec2::X };
        let depth = 0.5 * (ends[0].1 + ends[1].1) - lift;
        let mut former = None;
        for &(share, colour) in profile {
            let pair: [u32; 2] = std::array::from_fn(|end| {
                let (at, depth) = ends[end];
                self.screen_vertex(at + share * halves[end] * across, depth, colour)
            });
            if let Some([a, b]) = former.replace(pair) {
                self.push(depth, [a, b, pair[0], pair[1]]);
            }
        }
    }

    /// Everything, the farthest first.
    pub fn finish(mut self) -> Shape {
        self.faces.sort_unstable_by_key(|&(key, _)| key);
        let mut mesh = Mesh { vertices: self.vertices, ..Mesh::default() };
        mesh.indices.reserve(6 * self.faces.len());
        for (_, [a, b, c, d]) in self.faces {
            mesh.indices.extend_from_slice(&[a, b, c, b, c, d]);
        }
        Shape::mesh(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Aim, Camera};
    use super::*;
    use egui::Rect;

    #[test]
    fn the_nearer_face_is_painted_last() {
        let rect = Rect::from_min_size(Pos2::ZERO, Vec2::splat(400.0));
        let mut scene =
            Scene::new(Camera { yaw: 0.0, pitch: 0.0, distance: 3.0 }.through(rect, &Aim::STANDARD));
        let mut square = |z: f32| {
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
                .map(|[x, y]| scene.vertex([x, y, z], Color32::RED));
            scene.face(corners, 0.0);
            corners[0]
        };
        // The eye is at negative z.
        let (near, far) = (square(-1.0), square(1.0));
        let Shape::Mesh(mesh) = scene.finish() else { panic!("no mesh") };
        assert_eq!((mesh.indices[0], mesh.indices[6]), (far, near));
    }
}
