//! How surfaces answer light: head film, lacquer, chrome and lathed bronze, each as a colour for a place, its normal
//! and the eye.
//!
//! One lamp above and to the left of the drummer, and a sky that is lighter than the floor. Nothing throws light
//! on anything else.

use egui::Color32;

use super::vector::{V3, add, dot, sub, unit};

/// Toward the lamp.
const LAMP: V3 = [-0.42, 0.83, -0.37];

/// What a surface is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finish {
    /// Coated film: scatters.
    LocalHeadCompliance,
    /// Wood under lacquer: a broad shine over its colour.
    Lacquer,
    /// Mirrors sky and floor.
    Chrome,
    /// Lathed in circles: shines across them. Needs the direction along the circle.
    Bronze,
}

/// Colour of a surface at a place, of a normal (length one) toward the eye. `along` is the direction of lathing.
pub fn lit(colour: Color32, finish: Finish, place: V3, normal: V3, along: V3, eye: V3) -> Color32 {
    let sky = 0.5 + 0.5 * normal[1];
    let lamp = dot(normal, LAMP).max(0.0);
    let half = || unit(add(unit(sub(eye, place)), LAMP));
    match finish {
        Finish::LocalHeadCompliance => shade(colour, 0.40 + 0.20 * sky + 0.46 * lamp, 0.0),
        Finish::Lacquer => {
            let shine = power(dot(normal, half()).max(0.0), 5);
            shade(colour, 0.26 + 0.30 * sky + 0.55 * lamp, 0.42 * shine)
        }
        Finish::Chrome => {
            let shine = power(dot(normal, half()).max(0.0), 4);
            shade(colour, 0.30 + 0.42 * sky * sky + 0.30 * lamp, 0.55 * shine)
        }
        Finish::Bronze => {
            // What a groove mirrors lies in the plane across it.
            let across = 1.0 - dot(along, half()).powi(2);
            let shine = power(across.max(0.0), 5) * (0.25 + 0.75 * lamp);
            shade(colour, 0.30 + 0.14 * sky + 0.26 * lamp + 0.42 * shine, 0.34 * power(shine, 2))
        }
    }
}

/// `x` to the power `2^doublings`.
fn power(x: f32, doublings: u32) -> f32 {
    (0..doublings).fold(x, |x, _| x * x)
}

/// A colour under a share of full light, with a share of white added.
pub fn shade(colour: Color32, light: f32, white: f32) -> Color32 {
    let channel = |channel: u8| (f32::from(channel) * light + 255.0 * white).clamp(0.0, 255.0) as u8;
    Color32::from_rgb(channel(colour.r()), channel(colour.g()), channel(colour.b()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_faces_the_lamp_is_lighter() {
        for finish in [Finish::LocalHeadCompliance, Finish::Lacquer, Finish::Chrome, Finish::Bronze] {
            let grey = Color32::from_gray(120);
            let seen =
                |normal: V3| lit(grey, finish, [0.0; 3], unit(normal), [1.0, 0.0, 0.0], [0.0, 3.0, -3.0]).g();
            assert!(seen(LAMP) > seen([0.42, -0.83, 0.37]), "{finish:?}");
        }
    }
}
