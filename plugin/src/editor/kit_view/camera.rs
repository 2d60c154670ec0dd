//! The point of view: a camera that circles the kit, and what it sees through a rectangle of the screen.

use std::sync::LazyLock;

use egui::{Pos2, Rect, vec2};
use overhear_engine::kit_spec::KitSpec;

use crate::view::View;

use super::bodies::Body;
use super::vector::{V3, add, cross, dot, scale, sub, unit};

/// Half the field of view across the shorter side, as a tangent: as of a 50 mm lens.
const APERTURE: f32 = 0.36;

/// Nothing is taken to be nearer, m.
pub const NEAREST: f32 = 0.05;

/// Heights of the eye above the horizon, rad: from the floor to nearly overhead.
const PITCH: (f32, f32) = (-0.15, 1.5);

/// Distances from the middle of the kit, m.
const DISTANCE: (f32, f32) = (0.7, 6.0);

/// What is looked at in the standard kit, m. *By ear*, so to say: so its picture is well filled.
const MIDDLE: V3 = [0.08, 0.66, -0.30];

/// How near and how far a small and a large kit are seen from, factors of the distance of the standard kit.
const SIZES: (f32, f32) = (0.45, 2.5);

/// Where the eye is, seen from the middle of the kit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Turn about the vertical, rad; 0 is from behind the drummer, above 0 to the drummer's right.
    pub yaw: f32,
    /// Height above the horizon, rad.
    pub pitch: f32,
    /// Distance, m.
    pub distance: f32,
}

impl Default for Camera {
    fn default() -> Camera {
        Camera::of(View::default().camera)
    }
}

impl Camera {
    /// A camera by its turn and height (rad) and its distance (m), within the room.
    pub fn of([yaw, pitch, distance]: [f32; 3]) -> Camera {
        Camera { yaw, pitch: pitch.clamp(PITCH.0, PITCH.1), distance: distance.clamp(DISTANCE.0, DISTANCE.1) }
    }

    /// Turn and height, rad, and distance, m.
    pub fn numbers(&self) -> [f32; 3] {
        [self.yaw, self.pitch, self.distance]
    }

    /// Turns by a drag, points.
    pub fn orbit(&mut self, right: f32, down: f32) {
        /// Turn for each point dragged, rad.
        const TURN: f32 = 0.007;
        self.yaw = (self.yaw - right * TURN).rem_euclid(std::f32::consts::TAU);
        self.pitch = (self.pitch + down * TURN).clamp(PITCH.0, PITCH.1);
    }

    /// Comes nearer by a factor.
    pub fn zoom(&mut self, factor: f32) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(DISTANCE.0, DISTANCE.1);
        }
    }

    /// What is seen of a kit through `rect`.
    pub fn through(&self, rect: Rect, aim: &Aim) -> Eye {
        let ((sin_yaw, cos_yaw), (sin, cos)) = (self.yaw.sin_cos(), self.pitch.sin_cos());
        let out = [sin_yaw * cos, sin, -cos_yaw * cos];
        Eye::new(rect, add(MIDDLE, aim.shift), out, aim.size * self.distance)
    }
}

/// What a camera looks at: where a kit is and how large, against the standard kit, for which the picture was composed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// From what is looked at in the standard kit to what is in this one, m.
    pub shift: V3,
    /// Its size as a factor of the standard kit's.
    pub size: f32,
}

impl Aim {
    /// The standard kit.
    pub const STANDARD: Aim = Aim { shift: [0.0; 3], size: 1.0 };

    /// A kit of these bodies.
    pub fn of(bodies: &[Body]) -> Aim {
        static STANDARD: LazyLock<(V3, f32)> = LazyLock::new(|| extent(&Body::all(&KitSpec::standard())));
        let ((middle, size), (usual, usual_size)) = (extent(bodies), *STANDARD);
        let size = (size / usual_size).clamp(SIZES.0, SIZES.1);
        // What is looked at lies beside the middle, the less the nearer the eye.
        let beside = scale(sub(MIDDLE, usual), size - 1.0);
        Aim { shift: add(sub(middle, usual), beside), size }
    }

    /// As far out as for the standard kit at least, and about its middle: where the room belongs to the picture.
    pub fn in_the_room(&self) -> Aim {
        Aim { size: self.size.max(1.0), ..Aim::STANDARD }
    }
}

/// Middle of the box about the bodies' surfaces, and half of its diagonal along the floor, m.
fn extent(bodies: &[Body]) -> (V3, f32) {
    let reach = |body: &Body| [body.radius, 0.0, body.radius];
    let fold = |start: f32, choose: fn(f32, f32) -> f32, side: f32| -> V3 {
        std::array::from_fn(|axis| {
            let ends = bodies.iter().map(|body| body.frame.centre[axis] + side * reach(body)[axis]);
            ends.fold(start, choose)
        })
    };
    let low = fold(f32::INFINITY, f32::min, -1.0);
    let high = fold(f32::NEG_INFINITY, f32::max, 1.0);
    let diagonal = sub(high, low);
    (scale(add(low, high), 0.5), 0.5 * diagonal[0].hypot(diagonal[2]))
}

/// Perspective from a place onto a rectangle of the screen.
#[derive(Debug, Clone, Copy)]
pub struct Eye {
    place: V3,
    right: V3,
    up: V3,
    forward: V3,
    centre: Pos2,
    /// Points for a tangent of one.
    scale: f32,
}

impl Eye {
    /// An eye at a distance (m) in the direction `out` from what it looks at.
    pub fn new(rect: Rect, target: V3, out: V3, distance: f32) -> Eye {
        let forward = scale(unit(out), -1.0);
        let right = unit(cross([0.0, 1.0, 0.0], forward));
        let up = cross(forward, right);
        // A wide window shows more to the sides, a narrow one stays whole.
        let shorter = rect.height().min(rect.width() / 1.25).max(1.0);
        let place = add(target, scale(unit(out), distance));
        Eye { place, right, up, forward, centre: rect.center(), scale: 0.5 * shorter / APERTURE }
    }

    /// Where it is, m.
    pub fn place(&self) -> V3 {
        self.place
    }

    /// Place on the screen, and distance along the line of sight, m.
    pub fn project(&self, point: V3) -> (Pos2, f32) {
        let to = sub(point, self.place);
        let depth = dot(to, self.forward).max(NEAREST);
        let scale = self.scale / depth;
        (self.centre + scale * vec2(dot(to, self.right), -dot(to, self.up)), depth)
    }

    /// Points on the screen of a length (m) at a depth (m).
    pub fn points(&self, length: f32, depth: f32) -> f32 {
        length * self.scale / depth.max(NEAREST)
    }

    /// Direction in which a place of the screen lies; not of length one.
    pub fn ray(&self, at: Pos2) -> V3 {
        let offset = (at - self.centre) / self.scale;
        add(self.forward, add(scale(self.right, offset.x), scale(self.up, -offset.y)))
    }

    /// How far (m) to the right of the screen a direction goes.
    pub fn along(&self, direction: V3) -> f32 {
        dot(direction, self.right)
    }

    /// How far (m) away from the eye a direction goes.
    pub fn ahead(&self, direction: V3) -> f32 {
        dot(direction, self.forward)
    }

    /// Whether a face at `point` with that normal is seen from its front.
    pub fn faces(&self, point: V3, normal: V3) -> bool {
        dot(sub(self.place, point), normal) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window() -> Rect {
        Rect::from_min_size(Pos2::ZERO, vec2(800.0, 600.0))
    }

    #[test]
    fn from_behind_the_drummer_right_is_right_and_the_audience_is_far() {
        let eye = Camera { yaw: 0.0, pitch: 0.5, distance: 3.0 }.through(window(), &Aim::STANDARD);
        let (left, _) = eye.project([-0.5, 0.7, -0.3]);
        let (right, _) = eye.project([0.5, 0.7, -0.3]);
        assert!(left.x < right.x);
        let (_, near) = eye.project([0.0, 0.7, -1.0]);
        let (_, far) = eye.project([0.0, 0.7, 1.0]);
        assert!(near < far);
    }

    #[test]
    fn a_ray_goes_through_what_is_seen_there() {
        let eye = Camera::default().through(window(), &Aim::STANDARD);
        let point = [0.3, 0.6, 0.1];
        let (at, depth) = eye.project(point);
        let there = add(eye.place(), scale(eye.ray(at), depth));
        assert!(sub(there, point).iter().all(|difference| difference.abs() < 1e-4), "{there:?}");
    }

    #[test]
    fn the_standard_kit_is_seen_as_composed_and_a_small_one_from_nearer_about_its_own_middle() {
        let kit = KitSpec::standard();
        assert_eq!(Aim::of(&Body::all(&kit)), Aim::STANDARD);
        let (timpani, _) = kit.find("timpani").unwrap();
        let aim = Aim::of(&Body::all(&kit.alone(timpani).unwrap()));
        assert!(aim.size < 0.6 && aim.shift[0] > 0.5, "{aim:?}");
        assert_eq!(aim.in_the_room(), Aim::STANDARD);
    }

    #[test]
    fn no_drag_and_no_wheel_leaves_the_room() {
        let mut camera = Camera::default();
        camera.orbit(1e6, 1e6);
        camera.zoom(1e9);
        assert!(camera.pitch <= PITCH.1 && camera.distance >= DISTANCE.0);
        camera.zoom(f32::NAN);
        camera.zoom(0.0);
        assert!(camera.distance.is_finite());
    }
}
