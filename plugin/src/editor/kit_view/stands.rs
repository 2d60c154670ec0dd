//! What the kit stands on: floor, shadows, stands and legs.
//!
//! Stands are plausible rather than measured: the layout says where pieces are, not what carries them.

use std::f32::consts::TAU;

use egui::Color32;
use overhear_engine::piece::PieceId;

use super::bodies::{Body, Frame, Kind};
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, scale};
use crate::editor::theme::Palette;

/// Radius of a tube, m.
const TUBE: f32 = 0.009;

/// Draws what carries a piece.
pub fn stand(scene: &mut Scene, body: &Body, palette: &Palette) {
    let chrome = [shade(palette.chrome, 0.45, 0.0), palette.chrome];
    let frame = &body.frame;
    let foot = |body: &Body, away: f32| [body.frame.centre[0], 0.0, body.frame.centre[2] + away];
    match (body.piece, body.kind) {
        (PieceId::Kick, Kind::Drum { depth, .. }) => {
            spurs(scene, frame, body.radius, depth, chrome);
            pedal(scene, [frame.centre[0], 0.0, frame.centre[2] - 0.06], chrome);
        }
        (PieceId::RackTom, Kind::Drum { depth, .. }) => {
            // On an arm from a stand between the toms.
            let holder = frame.at(0.55 * body.radius, 0.85 * body.radius, -0.6 * depth);
            let post = [holder[0] + 0.10, holder[1] - 0.02, holder[2] + 0.12];
            scene.rod(holder, post, TUBE, chrome);
            scene.rod(post, [post[0], 0.56, post[2]], 0.011, chrome);
        }
        (PieceId::Snare, Kind::Drum { depth, .. }) => {
            let below = frame.at(0.0, 0.0, -depth - 0.02);
            basket(scene, frame, body.radius, depth, chrome);
            tripod(scene, below, [below[0], 0.0, below[2]], 0.24, chrome);
        }
        (PieceId::FloorTom, Kind::Drum { .. }) => legs(scene, frame, body.radius, 3, chrome),
        (PieceId::Timpani, _) => legs(scene, frame, body.radius, 4, chrome),
        (PieceId::HiHat, _) => {
            let top = add(frame.centre, [0.0, 0.16, 0.0]);
            scene.rod(top, add(frame.centre, [0.0, 0.05, 0.0]), 0.004, chrome);
            tripod(scene, add(frame.centre, [0.0, -0.07, 0.0]), foot(body, 0.0), 0.24, chrome);
            pedal(scene, foot(body, 0.0), chrome);
        }
        _ => {
            let bell = body.surface(0.0, 0.0, 0.0);
            scene.rod(add(bell, scale(frame.normal, 0.035)), bell, 0.006, chrome);
            // The wing nut.
            scene.rod(
                add(bell, scale(frame.normal, 0.032)),
                add(bell, scale(frame.normal, 0.018)),
                0.011,
                chrome,
            );
            let neck = add(frame.centre, scale(frame.normal, -0.05));
            scene.rod(frame.at(0.0, 0.0, 0.0), neck, 0.006, chrome);
            let base = foot(body, 0.10);
            scene.rod(neck, [base[0], neck[1] - 0.12, base[2]], TUBE, chrome);
            tripod(scene, [base[0], neck[1] - 0.12, base[2]], base, 0.26, chrome);
        }
    }
}

/// A tube from `top` down, on three legs that reach out by `spread` (m).
fn tripod(scene: &mut Scene, top: V3, foot: V3, spread: f32, chrome: [Color32; 2]) {
    scene.rod(top, [foot[0], 0.06, foot[2]], TUBE, chrome);
    for leg in 0..3 {
        let (sin, cos) = (leg as f32 * TAU / 3.0 + 0.5).sin_cos();
        let ground = [foot[0] + spread * cos, 0.008, foot[2] + spread * sin];
        scene.rod([foot[0], 0.26, foot[2]], ground, 0.007, chrome);
    }
}

fn legs(scene: &mut Scene, frame: &Frame, radius: f32, count: usize, chrome: [Color32; 2]) {
    for leg in 0..count {
        let (sin, cos) = (leg as f32 * TAU / count as f32 + 0.9).sin_cos();
        let top = frame.at(1.05 * radius * cos, 1.05 * radius * sin, -0.16);
        scene.rod(top, [top[0], 0.03, top[2]], 0.007, chrome);
        let outward = frame.direction(0.05 * cos, 0.05 * sin, 0.0);
        scene.rod([top[0], 0.03, top[2]], [top[0] + outward[0], 0.0, top[2] + outward[2]], 0.008, chrome);
    }
}

/// Arms that hold a snare drum from below.
fn basket(scene: &mut Scene, frame: &Frame, radius: f32, depth: f32, chrome: [Color32; 2]) {
    let middle = frame.at(0.0, 0.0, -depth - 0.05);
    for arm in 0..3 {
        let (sin, cos) = (arm as f32 * TAU / 3.0 + 0.4).sin_cos();
        let rim = frame.at(1.06 * radius * cos, 1.06 * radius * sin, -depth + 0.01);
        let corner = frame.at(1.02 * radius * cos, 1.02 * radius * sin, -depth - 0.03);
        scene.rod(middle, corner, 0.006, chrome);
        scene.rod(corner, rim, 0.006, chrome);
    }
}

/// Spurs of a bass drum, toward the audience.
fn spurs(scene: &mut Scene, frame: &Frame, radius: f32, depth: f32, chrome: [Color32; 2]) {
    for side in [-1.0, 1.0] {
        let top = frame.at(side * 0.9 * radius, -0.45 * radius, -0.75 * depth);
        scene.rod(top, [side * 0.42, 0.0, top[2] + 0.12], 0.007, chrome);
    }
}

/// A plate for a foot at a stand.
fn pedal(scene: &mut Scene, foot: V3, chrome: [Color32; 2]) {
    for side in [-0.03, 0.0, 0.03] {
        let heel = [foot[0] + 1.1 * side, 0.015, foot[2] - 0.27];
        scene.rod(heel, [foot[0] + side, 0.09, foot[2] - 0.03], 0.012, chrome);
    }
}

/// Draws floor and shadows; before everything else, as nothing is behind them.
pub fn floor(scene: &Scene, bodies: &[Body], palette: &Palette) -> egui::Shape {
    let mut mesh = egui::epaint::Mesh::default();
    // A rug that fades out into the floor.
    disc(scene, &mut mesh, [0.05, -0.004, -0.32], 1.75, palette.rug, palette.floor.gamma_multiply(0.0));
    for body in bodies {
        let [x, height, z] = body.frame.centre;
        // The higher it hangs the wider and fainter its shadow.
        let radius = body.radius * (1.15 + 0.35 * height);
        let depth = (0.55 / (1.0 + 1.2 * height)).clamp(0.12, 0.6);
        let place = [x + 0.10 * height, -0.002, z + 0.10 * height];
        let dark = Color32::from_black_alpha((255.0 * depth * palette.shadow) as u8);
        disc(scene, &mut mesh, place, radius, dark, Color32::TRANSPARENT);
    }
    egui::Shape::mesh(mesh)
}

/// A disc on the floor whose colour changes toward its edge.
fn disc(
    scene: &Scene,
    mesh: &mut egui::epaint::Mesh,
    centre: V3,
    radius: f32,
    inner: Color32,
    outer: Color32,
) {
    const SIDES: usize = 40;
    let first = mesh.vertices.len() as u32;
    let mut add = |place: V3, colour: Color32| mesh.colored_vertex(scene.eye.project(place).0, colour);
    let at = |side: usize, radius: f32| {
        let (sin, cos) = (side as f32 * TAU / SIDES as f32).sin_cos();
        [centre[0] + radius * cos, centre[1], centre[2] + radius * sin]
    };
    add(centre, inner);
    let half = inner.lerp_to_gamma(outer, 0.35);
    for side in 0..SIDES {
        add(at(side, 0.6 * radius), half);
        add(at(side, radius), outer);
    }
    for side in 0..SIDES as u32 {
        let next = (side + 1) % SIDES as u32;
        let [a, b] = [first + 1 + 2 * side, first + 1 + 2 * next];
        mesh.add_triangle(first, a, b);
        mesh.add_triangle(a, b, a + 1);
        mesh.add_triangle(b, a + 1, b + 1);
    }
}
