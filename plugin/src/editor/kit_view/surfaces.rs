//! Heads and plates: the surfaces that move.

use std::f32::consts::TAU;

use egui::Color32;

use super::bodies::{Body, Frame};
use super::light::{Finish, lit, shade};
use super::scene::Scene;
use super::vector::{V3, add, cross, dot, scale, sub, unit};
use crate::editor::field::{ANGLES, RADII, Refined};
use crate::editor::theme::Palette;

/// What motion is shown by colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tint {
    /// Up warm, down cold.
    #[default]
    Displacement,
    /// The piece's own colour, the more the more a place moves.
    Energy,
}

/// How a surface moves now.
pub struct Motion<'a> {
    /// Displacement as drawn, m.
    pub heights: &'a Refined,
    pub tint: Tint,
    pub accent: Color32,
    /// How much the pointer or a stroke lights it up, 0 to 1.
    pub glow: f32,
}

/// Points at `(ring, angle)` around a frame.
type Points = Vec<[V3; ANGLES]>;

/// Draws a head or plate as it moves.
pub fn moving(scene: &mut Scene, body: &Body, motion: &Motion<'_>, palette: &Palette) {
    let points = points(body, motion.heights);
    let seen_from_above = scene.eye.faces(body.frame.centre, body.frame.normal);
    let finish = finish(body);
    let colour = if finish == Finish::LocalHeadCompliance { palette.film } else { palette.bronze };
    let tallest = body.tallest();
    grid(scene, &points, |scene, ring, angle| {
        let point = points[ring][angle];
        let normal = normal(&points, &body.frame, ring, angle);
        let normal = if seen_from_above { normal } else { scale(normal, -1.0) };
        let share = (motion.heights[ring][angle] / tallest).clamp(-1.0, 1.0);
        let tinted = match motion.tint {
            Tint::Displacement => {
                let tint = if share > 0.0 { palette.up } else { palette.down };
                colour.lerp_to_gamma(tint, 0.9 * share.abs().powf(0.7))
            }
            Tint::Energy => colour.lerp_to_gamma(motion.accent, (1.3 * share.abs().sqrt()).min(1.0)),
        };
        let tinted = tinted.lerp_to_gamma(motion.accent, 0.22 * motion.glow);
        let ring_direction = along(&body.frame, angle);
        let mut lit = lit(tinted, finish, point, normal, ring_direction, scene.eye.place());
        if finish == Finish::Bronze {
            // Grooves of the lathe, and a bell that was not lathed.
            let groove = if ring % 2 == 0 { 1.0 } else { 0.93 };
            lit = shade(lit, if ring <= 2 { 1.06 } else { groove }, 0.0);
        } else if !seen_from_above {
            lit = shade(lit, 0.8, 0.0);
        }
        lit
    });
    edge(scene, &points[RADII], finish, palette);
    rivets(scene, body, motion.heights, seen_from_above, palette);
}

/// Draws the heads of rivets, or their lower ends from below, where the surface is.
fn rivets(scene: &mut Scene, body: &Body, heights: &Refined, seen_from_above: bool, palette: &Palette) {
    /// Radius of a head and how far it rises, m, and how much nearer it is painted than the plate that it lies on.
    const HEAD: (f32, f32, f32) = (0.0045, 0.003, 0.03);
    let Some(rivets) = body.rivets else { return };
    let radius = rivets.radius as f32;
    let colours = [shade(palette.bronze, 0.7, 0.0), shade(palette.bronze, 1.3, 0.1)];
    let side = if seen_from_above { 1.0 } else { -1.0 };
    scene.lift += HEAD.2;
    for angle in rivets.angles() {
        let (sin, cos) = (angle as f32).sin_cos();
        // Its angle counts from the player's side, that of the grid from the right.
        let [x, y] = [radius * sin, -radius * cos];
        let spoke = (y.atan2(x).rem_euclid(TAU) / TAU * ANGLES as f32).round() as usize % ANGLES;
        let ring = ((radius * RADII as f32).round() as usize).min(RADII);
        let at = body.surface(x, y, heights[ring][spoke]);
        scene.rod(at, add(at, scale(body.frame.normal, side * HEAD.1)), HEAD.0, colours);
    }
    scene.lift -= HEAD.2;
}

/// Draws a plate that does not move.
pub fn still(scene: &mut Scene, body: &Body, palette: &Palette) {
    let frame = body.frame;
    let points = points(body, &[[0.0; ANGLES]; RADII + 1]);
    let front = scene.eye.faces(frame.centre, frame.normal);
    grid(scene, &points, |scene, ring, angle| {
        let normal = normal(&points, &frame, ring, angle);
        let normal = if front { normal } else { scale(normal, -1.0) };
        let eye = scene.eye.place();
        lit(palette.bronze, Finish::Bronze, points[ring][angle], normal, along(&frame, angle), eye)
    });
    edge(scene, &points[RADII], Finish::Bronze, palette);
}

fn finish(body: &Body) -> Finish {
    if body.plate().is_some() { Finish::Bronze } else { Finish::LocalHeadCompliance }
}

fn points(body: &Body, heights: &Refined) -> Points {
    (0..=RADII)
        .map(|ring| {
            let radius = ring as f32 / RADII as f32;
            std::array::from_fn(|angle| {
                let (sin, cos) = (angle as f32 * TAU / ANGLES as f32).sin_cos();
                body.surface(radius * cos, radius * sin, heights[ring][angle])
            })
        })
        .collect()
}

/// Direction of the circle through a spoke.
fn along(frame: &Frame, angle: usize) -> V3 {
    let (sin, cos) = (angle as f32 * TAU / ANGLES as f32).sin_cos();
    frame.direction(-sin, cos, 0.0)
}

/// Normal of the surface from its neighbours, on the struck side.
fn normal(points: &Points, frame: &Frame, ring: usize, angle: usize) -> V3 {
    if ring == 0 {
        return frame.normal;
    }
    let outward = sub(points[(ring + 1).min(RADII)][angle], points[ring - 1][angle]);
    let around = sub(points[ring][(angle + 1) % ANGLES], points[ring][(angle + ANGLES - 1) % ANGLES]);
    let normal = unit(cross(outward, around));
    if dot(normal, frame.normal) < 0.0 { scale(normal, -1.0) } else { normal }
}

/// Adds the faces between points of a colour each.
fn grid(scene: &mut Scene, points: &Points, colour: impl Fn(&Scene, usize, usize) -> Color32) {
    let indices: Vec<[u32; ANGLES]> = (0..=RADII)
        .map(|ring| {
            std::array::from_fn(|angle| {
                let colour = colour(scene, ring, angle);
                scene.vertex(points[ring][angle], colour)
            })
        })
        .collect();
    for ring in 0..RADII {
        for angle in 0..ANGLES {
            let next = (angle + 1) % ANGLES;
            let [inner, outer] = [indices[ring], indices[ring + 1]];
            scene.face([inner[angle], inner[next], outer[angle], outer[next]], 0.0);
        }
    }
}

/// The rim of a plate, where light catches it; of a head, what the hoop is laid over.
fn edge(scene: &mut Scene, rim: &[V3; ANGLES], finish: Finish, palette: &Palette) {
    let (width, colour) = match finish {
        Finish::Bronze => (1.0, shade(palette.bronze, 1.18, 0.05)),
        _ => (1.0, shade(palette.film, 0.55, 0.0)),
    };
    for angle in 0..ANGLES {
        scene.line(rim[angle], rim[(angle + 1) % ANGLES], width, colour, 0.004);
    }
}
