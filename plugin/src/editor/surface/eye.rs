//! The point of view: perspective from the world onto the screen.

use egui::{Pos2, Rect, vec2};

use super::TALLEST;

/// Distance of the eye from the centre, radii.
const EYE: f32 = 4.6;

/// Perspective from a point of view onto a rectangle of the screen.
pub struct Eye {
    centre: Pos2,
    scale: f32,
    yaw: (f32, f32),
    pitch: (f32, f32),
}

impl Eye {
    pub fn new(rect: Rect, yaw: f32, pitch: f32, depth: f32) -> Eye {
        let (sin, cos) = pitch.sin_cos();
        // What the disc and its shell take up on the screen, in radii.
        let height = 2.0 * sin + (depth + 2.0 * TALLEST) * cos;
        let scale = (rect.width() / 2.5).min(rect.height() / (1.25 * height));
        let below = 0.5 * depth * cos * scale;
        let centre = rect.center() - vec2(0.0, below);
        Eye { centre, scale, yaw: yaw.sin_cos(), pitch: (sin, cos) }
    }

    /// Place on the screen, and distance from the eye.
    pub fn project(&self, [x, y, z]: [f32; 3]) -> (Pos2, f32) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Vec2;

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
