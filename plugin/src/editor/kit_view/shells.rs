//! What holds the heads: shells with hoops and lugs, and a kettle.

use std::f32::consts::TAU;

use egui::Color32;

use super::bodies::{Body, Frame, Kind, Support};
use super::light::{Finish, lit, shade};
use super::scene::Scene;
use super::vector::V3;
use crate::editor::theme::Palette;

/// Sides of what is round.
const SIDES: usize = 48;

/// Parts of a shell from end to end, for the sort.
const ROWS: usize = 3;

/// How far a hoop stands out from the head, over its radius.
const HOOP: f32 = 1.035;

/// A ring of a body of revolution: height over the struck head (m) and radius (m).
type Ring = (f32, f32);

/// Draws what a drum has beside its struck head; a cymbal has nothing.
pub fn shell(scene: &mut Scene, body: &Body, glow: Color32, palette: &Palette) {
    let (frame, radius) = (&body.frame, body.radius);
    match body.kind {
        Kind::Cymbal { .. } | Kind::HiHat { .. } | Kind::Stack { .. } => return,
        Kind::Head => hoop(scene, frame, radius, [0.008, -0.03], palette.chrome, Finish::Chrome),
        Kind::Kettle { depth } => kettle(scene, body, depth, palette),
        Kind::Drum { depth, shell, closed, lugs } => {
            let rings: Vec<Ring> =
                (0..=ROWS).map(|row| (-depth * row as f32 / ROWS as f32, radius)).collect();
            sides(scene, frame, &rings, shell, Finish::Lacquer, true);
            if closed {
                other_head(scene, frame, radius, depth, palette);
            } else {
                sides(scene, frame, &rings, shade(shell, 0.5, 0.0), Finish::Lacquer, false);
            }
            fittings(scene, body, depth, lugs, palette);
        }
    }
    if glow != Color32::TRANSPARENT {
        circle(scene, frame, HOOP * radius, 0.011, 2.0, glow);
    }
}

fn kettle(scene: &mut Scene, body: &Body, depth: f32, palette: &Palette) {
    let (frame, radius) = (&body.frame, body.radius);
    // An ellipse, as bowls nearly are.
    let rings: Vec<Ring> = (0..=8)
        .map(|ring| {
            let (sin, cos) = (ring as f32 / 8.0 * 0.25 * TAU).sin_cos();
            (-depth * sin, radius * cos.max(0.02))
        })
        .collect();
    sides(scene, frame, &rings, palette.copper, Finish::Lacquer, true);
    hoop(scene, frame, radius, [0.008, -0.03], palette.chrome, Finish::Chrome);
    lugs(scene, frame, radius, [0.0, -0.09], 6, palette);
}

/// Hoops and lugs of a shell.
fn fittings(scene: &mut Scene, body: &Body, depth: f32, counted: Option<u32>, palette: &Palette) {
    let (frame, radius) = (&body.frame, body.radius);
    // A bass drum's hoops are of wood and deep.
    let (colour, finish, height, count) = if body.support == Support::Spurs {
        (palette.hoop, Finish::Lacquer, 0.045, 10)
    } else {
        (palette.chrome, Finish::Chrome, 0.022, 8)
    };
    // A shallow drum's leave some of its shell free.
    let height = f32::min(height, 0.3 * depth);
    hoop(scene, frame, radius, [0.009, 0.009 - height], colour, finish);
    hoop(scene, frame, radius, [height - depth - 0.009, -depth - 0.009], colour, finish);
    let count = counted.map_or(count, |counted| counted as usize);
    lugs(scene, frame, radius, [-height, height - depth], count, palette);
}

/// The sides of a body of revolution that are seen from outside, or from within.
fn sides(scene: &mut Scene, frame: &Frame, rings: &[Ring], colour: Color32, finish: Finish, outside: bool) {
    for pair in rings.windows(2) {
        band(scene, frame, [pair[0], pair[1]], colour, finish, outside);
    }
}

/// A band between two rings, seen from outside or from within; only what faces the eye.
fn band(scene: &mut Scene, frame: &Frame, rings: [Ring; 2], colour: Color32, finish: Finish, outside: bool) {
    let sign = if outside { 1.0 } else { -1.0 };
    // Across the band, the normal leans as its sides do.
    let (rise, narrowing) = (rings[0].0 - rings[1].0, rings[0].1 - rings[1].1);
    let slope = -narrowing / rise.hypot(narrowing).max(1e-6);
    let out = (1.0 - slope * slope).max(0.0).sqrt();
    let at = |side: usize, (z, radius): Ring| -> (V3, V3) {
        let (sin, cos) = (side as f32 * TAU / SIDES as f32).sin_cos();
        let normal = frame.direction(sign * out * cos, sign * out * sin, sign * slope);
        (frame.at(radius * cos, radius * sin, z), normal)
    };
    for side in 0..SIDES {
        let corners =
            [at(side, rings[0]), at(side + 1, rings[0]), at(side, rings[1]), at(side + 1, rings[1])];
        let [facing, next] = [0, 1].map(|corner| scene.eye.faces(corners[corner].0, corners[corner].1));
        if facing != next {
            // Where it turns away an edge is seen.
            let corner = if facing { 0 } else { 1 };
            let shade = shade(colour, 0.5, 0.0);
            scene.line(corners[corner].0, corners[corner + 2].0, 0.6, shade, 0.002);
        }
        if !(facing || next) {
            continue;
        }
        let eye = scene.eye.place();
        let corners = corners.map(|(place, normal)| {
            let colour = lit(colour, finish, place, normal, frame.normal, eye);
            scene.vertex(place, colour)
        });
        scene.face(corners, 0.0);
    }
}

/// A hoop between two heights (m): its outside, its inside beyond the head, and the edge between.
fn hoop(
    scene: &mut Scene,
    frame: &Frame,
    radius: f32,
    [top, bottom]: [f32; 2],
    colour: Color32,
    finish: Finish,
) {
    let outer = HOOP * radius;
    band(scene, frame, [(top, outer), (bottom, outer)], colour, finish, true);
    band(scene, frame, [(top, radius), (top - 0.009, radius)], colour, finish, false);
    let above = scene.eye.faces(frame.at(0.0, 0.0, top), frame.normal);
    let z = if above { top } else { bottom };
    let light = lit(
        colour,
        finish,
        frame.centre,
        frame.direction(0.0, 0.0, if above { 1.0 } else { -1.0 }),
        frame.right,
        scene.eye.place(),
    );
    ring(scene, frame, [radius, outer], z, light);
    circle(scene, frame, outer, z, 0.6, shade(colour, 0.9, 0.0));
}

/// A flat ring between two radii at a height.
fn ring(scene: &mut Scene, frame: &Frame, radii: [f32; 2], z: f32, colour: Color32) {
    let at = |side: usize, radius: f32| {
        let (sin, cos) = (side as f32 * TAU / SIDES as f32).sin_cos();
        frame.at(radius * cos, radius * sin, z)
    };
    for side in 0..SIDES {
        let corners =
            [at(side, radii[0]), at(side + 1, radii[0]), at(side, radii[1]), at(side + 1, radii[1])];
        let corners = corners.map(|place| scene.vertex(place, colour));
        scene.face(corners, 0.003);
    }
}

/// A circle about the axis: its radius and its height, m, and the width of its line, points.
pub fn circle(scene: &mut Scene, frame: &Frame, radius: f32, z: f32, width: f32, colour: Color32) {
    let at = |side: usize| {
        let (sin, cos) = (side as f32 * TAU / SIDES as f32).sin_cos();
        frame.at(radius * cos, radius * sin, z)
    };
    for side in 0..SIDES {
        scene.line(at(side), at(side + 1), width, colour, 0.006);
    }
}

/// The head at the other end, if it is seen.
fn other_head(scene: &mut Scene, frame: &Frame, radius: f32, depth: f32, palette: &Palette) {
    let middle = frame.at(0.0, 0.0, -depth);
    let down = frame.direction(0.0, 0.0, -1.0);
    if scene.eye.faces(middle, down) {
        let colour =
            lit(palette.film, Finish::LocalHeadCompliance, middle, down, frame.right, scene.eye.place());
        ring(scene, frame, [0.0, radius], -depth, shade(colour, 0.92, 0.0));
    }
}

/// Tension rods around a shell, from one height to another.
fn lugs(
    scene: &mut Scene,
    frame: &Frame,
    radius: f32,
    [top, bottom]: [f32; 2],
    count: usize,
    palette: &Palette,
) {
    // Sides of a shell are tall, and sorted by their middle.
    scene.lift = 0.07;
    for lug in 0..count {
        let (sin, cos) = ((lug as f32 + 0.5) * TAU / count as f32).sin_cos();
        let out = 1.03 * radius;
        let [from, to] = [top, bottom].map(|z| frame.at(out * cos, out * sin, z));
        if scene.eye.faces(from, frame.direction(cos, sin, 0.0)) {
            let colours = [shade(palette.chrome, 0.55, 0.0), palette.chrome];
            scene.rod(from, to, 0.0045, colours);
            let middle = [0.38, 0.62].map(|share| super::vector::between(from, to, share));
            scene.rod(middle[0], middle[1], 0.009, colours);
        }
    }
    scene.lift = 0.0;
}
