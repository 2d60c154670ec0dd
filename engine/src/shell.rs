//! The wall of a drum's shell: how it bends and sounds when its hoop is struck.
//!
//! Model: a thin cylinder of length `L`, supported at both ends by hoops and bearing edges, whose wall moves as
//! `w = cos n theta sin(k pi z / L)`,
//!
//! ```text
//! omega^2 = E / (rho a^2 (1 - nu^2)) [ (1 - nu^2) l^4 / (n^2 + l^2)^2 + h^2 / (12 a^2) (n^2 + l^2)^2 ] / (1 + 1 / n^2)
//! ```
//!
//! with `l = k pi a / L`: stretching and bending of a shallow shell; motion along the circumference, `w / n`, adds to the mass. A
//! stick on the hoop pulls at the rods, and these at lugs that stand away from the wall by `e`: the
//! moment `F e` turns the wall where a lug is fixed, at `z`, so that a mode gets `F e dw/dz`. By reciprocity the hoop goes down
//! by as much of the mode. The wall is heard as point sources all over its outer face, in free air.
//!
//! Neglected: the inertia of the hoop between stick and rods (its own modes move beside the wall's), lugs as masses, the seam and
//! the grain of the wood, the shadow of the shell, heads as drivers (their pull on the edge meets a wall some
//! hundred times their impedance), vents.
//!
//! Source: Donnell's equations as in Leissa, Vibration of Shells (NASA SP-288), ch. 2; Soedel, Vibrations of Shells and Plates,
//! sec. 6.

use std::f64::consts::{PI, SQRT_2, TAU};

use serde::{Deserialize, Serialize};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::contact::Material;
use crate::math::trigonometry::sin_cos;
use crate::modal::Mode;
use crate::numbers::{Numbers, Visitor};
use crate::receiver::ReceiverPosition;

/// The wall of a shell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallSpec {
    /// What it is made of, of at least 1 GPa.
    pub material: Material,
    /// Thickness, m, 0.0005 to 0.03.
    #[serde(rename = "thickness_m")]
    pub thickness: f64,
    /// Quality factor of its modes with lugs and hoops on it, 2 to 1000.
    pub q: f64,
}

impl Numbers for WallSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.material.visit_bearing(visitor);
        visitor.number("thickness_m", &mut self.thickness, 5e-4..=0.03);
        visitor.number("q", &mut self.q, 2.0..=1000.0);
    }
}

/// Distance of a rod from the middle of the wall, m, and of the screws of a lug from the edge, m. *Trade sizes*.
const LUG: [f64; 2] = [0.018, 0.035];

/// Highest mode, Hz.
const LIMIT_HZ: f64 = 12_000.0;

/// Modes at most, both of a pair counted: of a thin or large wall those above are left out. A wooden shell has fewer.
const MOST: usize = 256;

/// Points along the wall in a wave, for the sound.
const POINTS: f64 = 6.0;

/// A cylinder's wall.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Cylinder {
    /// Radius, m.
    pub radius: f64,
    /// Distance from end to end, m.
    pub length: f64,
    /// What it is made of.
    pub wall: WallSpec,
}

/// A mode of the wall; of those with `n > 0` there are two, turned against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallMode {
    /// Waves around.
    pub n: u32,
    /// Half waves along.
    pub k: u32,
    /// The motion, of a shape of unit mean square.
    pub mode: Mode,
    /// How far the hoop over its largest motion goes down per modal displacement, dimensionless.
    pub hoop: f64,
}

impl Cylinder {
    /// Its modes to 12 kHz, lowest first, at most 256 with both of each pair counted; without losses if asked to.
    pub fn modes(&self, lossless: bool) -> Vec<WallMode> {
        let mut modes = self.all_modes(lossless);
        modes.sort_by(|a, b| a.mode.omega.total_cmp(&b.mode.omega));
        let mut members = 0;
        modes.retain(|mode| {
            members += if mode.n == 0 { 1 } else { 2 };
            members <= MOST
        });
        modes
    }

    /// All modes to 12 kHz, lowest order first.
    fn all_modes(&self, lossless: bool) -> Vec<WallMode> {
        let mut modes = Vec::new();
        for n in 0.. {
            let before = modes.len();
            modes.extend((1..).map(|k| self.mode(n, k, lossless)).take_while(WallMode::is_heard));
            // Stretching rules few waves around, bending many: beyond the ring frequency an order without any is the last.
            if modes.len() == before && self.bending(n, 1) > self.stretching(n, 1) {
                break;
            }
        }
        modes
    }

    /// Half waves along times `pi a / L`.
    fn along(&self, k: u32) -> f64 {
        f64::from(k) * PI * self.radius / self.length
    }

    /// The two terms in the bracket of the equation.
    fn stretching(&self, n: u32, k: u32) -> f64 {
        let (n, l) = (f64::from(n), self.along(k));
        let nu = self.wall.material.poisson_ratio;
        (1.0 - nu * nu) * l.powi(4) / (n * n + l * l).powi(2)
    }

    fn bending(&self, n: u32, k: u32) -> f64 {
        let (n, l) = (f64::from(n), self.along(k));
        (self.wall.thickness / self.radius).powi(2) / 12.0 * (n * n + l * l).powi(2)
    }

    fn mode(&self, n: u32, k: u32, lossless: bool) -> WallMode {
        let Material { youngs_modulus, poisson_ratio: nu, density, .. } = self.wall.material;
        let unit = youngs_modulus / (density * self.radius * self.radius * (1.0 - nu * nu));
        let around = if n == 0 { 1.0 } else { 1.0 + f64::from(n).powi(-2) };
        let omega = (unit * (self.stretching(n, k) + self.bending(n, k)) / around).sqrt();
        let sigma = if lossless { 0.0 } else { omega / (2.0 * self.wall.q) };
        let weight = density * self.wall.thickness * TAU * self.radius * self.length;
        let [arm, below] = LUG;
        let wave = f64::from(k) * PI / self.length;
        let largest = if n == 0 { SQRT_2 } else { 2.0 };
        let hoop = largest * arm * wave * (wave * below.min(0.5 * self.length)).cos();
        WallMode { n, k, mode: Mode { omega, sigma, mass: weight * around }, hoop }
    }

    /// Pressure at a point over the modal acceleration, Pa s2/m, of the member of a mode that is largest toward the point. The delay from
    /// the centre of the head is taken out.
    pub fn transfer(&self, mode: &WallMode, point: ReceiverPosition) -> [f64; 2] {
        let wave = mode.mode.omega / SPEED_OF_SOUND;
        let [height, offset] = point.height_and_offset();
        let rate = POINTS / TAU;
        let half = 8 + (0.5 * rate * TAU * self.radius * wave) as usize + 2 * mode.n as usize;
        let down = 4 + (rate * self.length * wave) as usize + 4 * mode.k as usize;
        let largest = if mode.n == 0 { SQRT_2 } else { 2.0 };
        // Both halves around are alike. Square of the distance across, and the shape.
        let places: Vec<[f64; 2]> = (0..half)
            .map(|j| {
                let theta = PI * (j as f64 + 0.5) / half as f64;
                let across =
                    offset * offset + self.radius * self.radius - 2.0 * offset * self.radius * theta.cos();
                [across, (f64::from(mode.n) * theta).cos()]
            })
            .collect();
        let (mut re, mut im) = (0.0, 0.0);
        for i in 0..down {
            let share = (i as f64 + 0.5) / down as f64;
            let shape = largest * (f64::from(mode.k) * PI * share).sin();
            let above = height + share * self.length;
            for [across, around] in &places {
                let d = (above * above + across).sqrt();
                let (sin, cos) = sin_cos(wave * (point.distance - d));
                let part = shape * around / d;
                re += part * cos;
                im += part * sin;
            }
        }
        let scale = DENSITY / (4.0 * PI) * TAU * self.radius * self.length / (half * down) as f64;
        [scale * re, scale * im]
    }
}

impl WallMode {
    fn is_heard(&self) -> bool {
        self.mode.omega <= TAU * LIMIT_HZ
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A snare's shell of steel, without its hoops.
    fn steel() -> Cylinder {
        let wall = WallSpec { material: Material::STEEL, thickness: 1.2e-3, q: 100.0 };
        Cylinder { radius: 0.178, length: 0.14, wall }
    }

    #[test]
    fn many_waves_around_ring_as_a_plate_bends_and_one_along_rings_at_the_ring_frequency() {
        let shell = steel();
        let Material { youngs_modulus: e, poisson_ratio: nu, density, .. } = shell.wall.material;
        let modes = shell.all_modes(true);
        let last = modes.iter().filter(|mode| mode.k == 1).max_by_key(|mode| mode.n).unwrap();
        let k2 = (f64::from(last.n) / shell.radius).powi(2) + (PI / shell.length).powi(2);
        let plate = k2 * shell.wall.thickness * (e / (12.0 * density * (1.0 - nu * nu))).sqrt();
        assert!((last.mode.omega / plate - 1.0).abs() < 0.01, "{} {plate}", last.mode.omega);
        // Without waves around, the wall breathes, as fast as sound in it goes once around in a radian.
        let ring = (e / density).sqrt() / shell.radius;
        let breathing = shell.mode(0, 1, true).mode.omega;
        assert!((breathing / ring - 1.0).abs() < 0.01, "{breathing} {ring}");
    }

    #[test]
    fn modes_are_as_dense_as_those_of_a_plate_of_that_area_below_the_limit() {
        let shell = steel();
        let members = |mode: &WallMode| if mode.n == 0 { 1.0 } else { 2.0 };
        let count: f64 = shell.all_modes(true).iter().map(members).sum();
        let Material { youngs_modulus: e, poisson_ratio: nu, density, .. } = shell.wall.material;
        let rigidity = shell.wall.thickness * (e / (12.0 * density * (1.0 - nu * nu))).sqrt();
        let plate = TAU * shell.radius * shell.length * TAU * LIMIT_HZ / (4.0 * PI * rigidity);
        assert!((0.6..1.2).contains(&(count / plate)), "{count} for {plate}");
    }

    #[test]
    fn the_thinnest_and_largest_wall_has_no_more_modes_than_can_be_played() {
        let wall = WallSpec { material: Material::FILM, thickness: 5e-4, q: 100.0 };
        let shell = Cylinder { radius: 0.41, length: 1.0, wall };
        let modes = shell.modes(true);
        let members: usize = modes.iter().map(|mode| if mode.n == 0 { 1 } else { 2 }).sum();
        assert!((MOST - 1..=MOST).contains(&members), "{members}");
        assert!(modes.is_sorted_by(|a, b| a.mode.omega <= b.mode.omega));
    }

    #[test]
    fn a_breathing_wall_is_heard_far_away_as_the_volume_it_moves() {
        let shell = steel();
        // Slow enough to be a point source, whatever it would do by itself.
        let mut mode = shell.mode(0, 1, true);
        mode.mode.omega = TAU * 20.0;
        let point = ReceiverPosition { distance: 8.0, inclination: 0.6, azimuth: 0.0 };
        let [re, im] = shell.transfer(&mode, point);
        let volume = SQRT_2 * 2.0 / PI * TAU * shell.radius * shell.length;
        let expected = DENSITY * volume / (4.0 * PI * point.distance);
        assert!((re.hypot(im) / expected - 1.0).abs() < 0.02, "{re} {im} {expected}");
    }
}
