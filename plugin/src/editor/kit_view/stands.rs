//! What the kit stands on: floor, shadows, stands and legs.
//!
//! Stands are plausible rather than measured: the layout says where pieces are, not what carries them.

use std::f32::consts::TAU;

use egui::Color32;

use super::bodies::{Body, Support};
use super::camera::Aim;
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, dot, scale, sub};
use crate::editor::theme::Palette;

/// Radius of a tube, m.
const TUBE: f32 = 0.009;

/// Draws what carries a piece, among all of the kit.
pub fn stand(scene: &mut Scene, body: &Body, kit: &[Body], palette: &Palette) {
    let chrome = [shade(palette.chrome, 0.45, 0.0), palette.chrome];
    let frame = &body.frame;
    let foot = on_floor(frame.centre);
    match body.support {
        Support::Spurs => {
            spurs(scene, body, chrome);
            pedal(scene, add(foot, scale(frame.ahead(), 0.06)), frame.ahead(), chrome);
        }
        Support::Arm => arm(scene, body, kit, chrome),
        Support::Basket => {
            let below = frame.at(0.0, 0.0, -body.kind.depth() - 0.02);
            basket(scene, body, chrome);
            tripod(scene, below, on_floor(below), 0.24, chrome);
        }
        Support::Legs(count) => legs(scene, body, count, chrome),
        Support::HatStand => {
            let top = add(frame.centre, [0.0, 0.16, 0.0]);
            scene.rod(top, add(frame.centre, [0.0, 0.05, 0.0]), 0.004, chrome);
            tripod(scene, add(frame.centre, [0.0, -0.07, 0.0]), foot, 0.24, chrome);
            pedal(scene, foot, [0.0, 0.0, -1.0], chrome);
        }
        Support::Stand => cymbal_stand(scene, body, chrome),
    }
}

/// The place on the floor below another.
fn on_floor([x, _, z]: V3) -> V3 {
    [x, 0.0, z]
}

fn cymbal_stand(scene: &mut Scene, body: &Body, chrome: [Color32; 2]) {
    let frame = &body.frame;
    let bell = body.surface(0.0, 0.0, 0.0);
    let above = |height: f32| add(bell, scale(frame.normal, height));
    scene.rod(above(0.035), bell, 0.006, chrome);
    // The wing nut.
    scene.rod(above(0.032), above(0.018), 0.011, chrome);
    let neck = add(frame.centre, scale(frame.normal, -0.05));
    scene.rod(frame.centre, neck, 0.006, chrome);
    let base = add(on_floor(frame.centre), [0.0, 0.0, 0.10]);
    let joint = [base[0], neck[1] - 0.12, base[2]];
    scene.rod(neck, joint, TUBE, chrome);
    tripod(scene, joint, base, 0.26, chrome);
}

/// An arm from a post beside the drum, which rests on a bass drum if there is one below and on the floor otherwise.
fn arm(scene: &mut Scene, body: &Body, kit: &[Body], chrome: [Color32; 2]) {
    let [holder, post] = arm_ends(body);
    scene.rod(holder, post, TUBE, chrome);
    match kit.iter().find_map(|below| height_over(below, post)) {
        Some(height) => scene.rod(post, [post[0], height, post[2]], 0.011, chrome),
        None => tripod(scene, post, on_floor(post), 0.26, chrome),
    }
}

/// Where an arm holds a drum, and the top of its post.
fn arm_ends(body: &Body) -> [V3; 2] {
    // Toward the middle of the kit, where two toms share it.
    let side = if body.frame.centre[0] > 0.0 { -1.0 } else { 1.0 };
    let (x, y) = (side * 0.55 * body.radius, 0.85 * body.radius);
    let holder = body.frame.at(x, y, -0.6 * body.kind.depth());
    [holder, add(holder, [side * 0.10, -0.02, 0.12])]
}

/// Height (m) of the shell of a bass drum below a place, if it lies there.
fn height_over(body: &Body, place: V3) -> Option<f32> {
    if body.support != Support::Spurs {
        return None;
    }
    let frame = &body.frame;
    let to = sub(place, frame.centre);
    let (along, across) = (-dot(to, frame.normal), dot(to, frame.right));
    let over = (0.0..=body.kind.depth()).contains(&along) && across.abs() < 0.8 * body.radius;
    // It goes in a little.
    let height = frame.centre[1] + (body.radius.powi(2) - across.powi(2)).max(0.0).sqrt() - 0.015;
    (over && height < place[1]).then_some(height)
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

fn legs(scene: &mut Scene, body: &Body, count: usize, chrome: [Color32; 2]) {
    let (frame, radius) = (&body.frame, body.radius);
    let held = f32::min(0.16, 0.7 * body.kind.depth());
    for leg in 0..count {
        let (sin, cos) = (leg as f32 * TAU / count as f32 + 0.9).sin_cos();
        let top = frame.at(1.05 * radius * cos, 1.05 * radius * sin, -held);
        scene.rod(top, [top[0], 0.03, top[2]], 0.007, chrome);
        let outward = frame.direction(0.05 * cos, 0.05 * sin, 0.0);
        scene.rod([top[0], 0.03, top[2]], [top[0] + outward[0], 0.0, top[2] + outward[2]], 0.008, chrome);
    }
}

/// Arms that hold a drum from below.
fn basket(scene: &mut Scene, body: &Body, chrome: [Color32; 2]) {
    let (frame, radius, depth) = (&body.frame, body.radius, body.kind.depth());
    let middle = frame.at(0.0, 0.0, -depth - 0.05);
    for arm in 0..3 {
        let (sin, cos) = (arm as f32 * TAU / 3.0 + 0.4).sin_cos();
        let rim = frame.at(1.06 * radius * cos, 1.06 * radius * sin, -depth + 0.01);
        let corner = frame.at(1.02 * radius * cos, 1.02 * radius * sin, -depth - 0.03);
        scene.rod(middle, corner, 0.006, chrome);
        scene.rod(corner, rim, 0.006, chrome);
    }
}

/// Spurs of a bass drum, away from who plays it.
fn spurs(scene: &mut Scene, body: &Body, chrome: [Color32; 2]) {
    let (frame, radius, depth) = (&body.frame, body.radius, body.kind.depth());
    for side in [-1.0, 1.0] {
        let top = frame.at(side * 0.9 * radius, -0.45 * radius, -0.75 * depth);
        let ground = frame.at(side * 1.5 * radius, 0.0, -0.75 * depth - 0.12);
        scene.rod(top, on_floor(ground), 0.007, chrome);
    }
}

/// A plate for a foot at a stand, its heel in a direction along the floor.
fn pedal(scene: &mut Scene, foot: V3, toward: V3, chrome: [Color32; 2]) {
    let across = [-toward[2], 0.0, toward[0]];
    for side in [-0.03, 0.0, 0.03] {
        let at = |share: f32, away: f32, height: f32| {
            add(add(foot, scale(across, share * side)), add(scale(toward, away), [0.0, height, 0.0]))
        };
        scene.rod(at(1.1, 0.27, 0.015), at(1.0, 0.03, 0.09), 0.012, chrome);
    }
}

/// Draws floor and shadows; before everything else, as nothing is behind them.
pub fn floor(scene: &Scene, bodies: &[Body], aim: &Aim, palette: &Palette) -> egui::Shape {
    let mut mesh = egui::epaint::Mesh::default();
    // A rug that fades out into the floor.
    let rug = [0.05 + aim.shift[0], -0.004, -0.32 + aim.shift[2]];
    disc(scene, &mut mesh, rug, 1.75 * aim.size, palette.rug, palette.floor.gamma_multiply(0.0));
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

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::KitSpec;

    #[test]
    fn an_arm_rests_on_the_bass_drum_below_and_without_one_on_the_floor() {
        let bodies = Body::all(&KitSpec::standard());
        let [kick, tom] = [0, 2].map(|slot| bodies[slot]);
        let [_, post] = arm_ends(&tom);
        let height = height_over(&kick, post).expect("the kick is below");
        // In its shell, at the top.
        assert!((0.54..0.58).contains(&height), "{height}");
        assert_eq!(height_over(&tom, post), None, "nothing else carries one");
        let beside = add(post, [0.6, 0.0, 0.0]);
        assert_eq!(height_over(&kick, beside), None);
    }
}
