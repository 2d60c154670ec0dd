//! The air inside a drum: modes of a hard-walled cylinder, and how heads drive them.
//!
//! Model: pressure modes `J_m(alpha r) cos/sin(m theta) cos(l pi z / L)`, `J_m'(alpha) = 0`, `r` the share of
//! the radius, `z` from the batter. The uniform one is the spring `rho c^2 A^2 / V` of the real
//! volume. Each mode `j` presses back on what the heads displace against it, the volume `c_j . q`:
//!
//! ```text
//! P_j = kappa_j omega^2 (c_j . q) / (omega_j^2 - omega^2) ... kappa_j = rho c^2 / int psi_j^2 dV
//! ```
//!
//! which is a spring `kappa_j` between `c_j . q` and a mass `mu_j = kappa_j / omega_j^2` that rides on it: an
//! energy `kappa_j (c_j . q - y_j)^2 / 2 + mu_j y_j'^2 / 2`, symmetric and never negative. Far below `omega_j` the
//! mass moves along and is all that is felt; modes above those kept are therefore added as mass,
//! so that no air is left out and none counted twice.
//!
//! A vessel whose far end is open holds no pressure there: its modes go as `cos((l + 1/2) pi z / L')`, `L'` the depth and
//! what the air beyond adds, `.613 a` (Levine & Schwinger 1948); none is uniform, and far below all of them the
//! air moves as one plug. What leaves the end is, of the modes that do not vary across it, the volume
//! `2 (-1)^l / ((l + 1/2) pi) y_l`; others do not reach it below their own frequency, which is neglected above, too.
//!
//! A port, a hole of the radius `b` in the far head, is a plug of air of the mass `rho / (2 b)` per volume squared (Rayleigh: what
//! moves on both sides of a hole in a thin wall) that the modes which do not vary across the drum push on. With the uniform spring it
//! is Helmholtz's resonator. It is narrow against waves along the head, so that others push on it by little: neglected. A vent is such a
//! hole in the wall half way along a cylinder, where modes with an odd number of half waves do not push on it, or at the bottom of a kettle;
//! see [`hole`].
//!
//! Displacements count along the stroke: the batter's into the drum, the resonant head's out of it.
//!
//! Source: Fahy & Gardonio, Sound and Structural Vibration, ch. 7.

pub mod hole;

use std::f64::consts::{PI, TAU};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::fitted;
use crate::math::bessel;

use hole::{Hole, HoleAir};

/// Holes of a drum at most: a port and a vent.
pub const HOLES: usize = 2;

/// The enclosed air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CavitySpec {
    /// Radius, m.
    pub radius: f64,
    /// Real volume, m3; a kettle is not a cylinder.
    pub volume: f64,
    /// Distance from head to head, or of a cylinder of the same volume, m.
    pub depth: f64,
    /// Quality factor of its modes: losses at the wall, and through vents that are not described. *By ear*.
    pub q: f64,
    /// Whether the far end is open.
    pub open: bool,
    /// Its holes, which a vessel with an open end has not.
    pub holes: [Option<Hole>; HOLES],
}

/// One mode of the air, of one order.
#[derive(Debug, Clone, PartialEq)]
pub struct CavityMode {
    /// Nodal circles of the pressure, from 0.
    pub circles: u32,
    /// Half waves along the axis.
    pub half_waves: u32,
    /// Angular frequency, rad/s; 0 is the uniform spring.
    pub omega: f64,
    /// Spring, Pa/m3.
    pub spring: f64,
    /// Volume displaced per modal displacement, m2: batter modes, then resonant modes.
    pub volume: Vec<f64>,
    /// Volume that leaves an open end per displacement of the mass, m2.
    pub outlet: f64,
    /// Volume displaced per displacement of the air of each hole of the order, m2.
    pub holes: [f64; HOLES],
}

/// A head mode as the cavity sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadShape {
    /// `j_mn`, dimensionless.
    pub zero: f64,
    /// `N`, signed as in the shape.
    pub norm: f64,
    /// Whether it is on the far (resonant) end.
    pub far: bool,
}

/// The air of one order against the heads' modes of that order.
#[derive(Debug, Clone, PartialEq)]
pub struct CavityOrder {
    /// Modes kept as such; springs first.
    pub modes: Vec<CavityMode>,
    /// Mass of all others, kg, `[head mode][head mode]`, row by row.
    pub mass: Vec<f64>,
    /// Volume that leaves an open end by the others per modal displacement, m2, `[head mode]`.
    pub outlet: Vec<f64>,
    /// The air of its holes; none of orders with nodal diameters.
    pub holes: Vec<HoleAir>,
}

/// Length of air that moves beyond an open end, over the radius (Levine & Schwinger 1948).
const END: f64 = 0.613_3;

/// How far past the heads' finest shape the radial sum for the mass runs.
const EXTRA_CIRCLES: u32 = 6;

/// Terms of the sum along the axis; the rest is below a thousandth of the mass.
const HALF_WAVES: u32 = 400;

impl CavitySpec {
    /// A cylinder of a radius and a depth, m.
    pub fn cylinder(radius: f64, depth: f64) -> CavitySpec {
        CavitySpec {
            radius,
            volume: PI * radius * radius * depth,
            depth,
            q: fitted::AIR_Q,
            open: false,
            holes: [None; HOLES],
        }
    }

    /// Stiffness of the uniform mode against a piston of the head's area, N/m.
    pub fn uniform_spring(&self) -> f64 {
        let area = PI * self.radius * self.radius;
        DENSITY * SPEED_OF_SOUND.powi(2) * area * area / self.volume
    }

    /// The air of order `m` against `heads`; modes below `limit` (rad/s) are kept as modes.
    pub fn order(&self, m: u32, heads: &[HeadShape], limit: f64) -> CavityOrder {
        let count = heads.len();
        let finest = heads.iter().map(|head| head.zero).fold(0.0, f64::max);
        let circles = (finest / PI) as u32 + EXTRA_CIRCLES;
        let mut alphas = bessel::zeros_prime(m, circles);
        if m == 0 {
            alphas.insert(0, 0.0);
        }
        let area = PI * self.radius * self.radius;
        let holes = self.holes.into_iter().flatten().filter(|_| m == 0).map(|hole| hole.air(area)).collect();
        let (mass, outlet) = (vec![0.0; count * count], vec![0.0; count]);
        let mut order = CavityOrder { modes: Vec::new(), mass, outlet, holes };
        for (circles, &alpha) in alphas.iter().enumerate() {
            self.add_radial(m, circles as u32, alpha, heads, limit, &mut order);
        }
        order.modes.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        order
    }

    /// All modes along the axis that share one radial function.
    fn add_radial(
        &self,
        m: u32,
        circles: u32,
        alpha: f64,
        heads: &[HeadShape],
        limit: f64,
        order: &mut CavityOrder,
    ) {
        let around = if m == 0 { TAU } else { PI };
        let peak = bessel::j(m, alpha);
        let radial_norm =
            if alpha == 0.0 { 0.5 } else { 0.5 * (1.0 - (f64::from(m) / alpha).powi(2)) * peak * peak };
        let area = self.radius * self.radius * around;
        let overlaps: Vec<f64> = heads.iter().map(|head| area * overlap(m, head, alpha, peak)).collect();
        // Sum over the axis of mu_l, and of mu_l (-1)^l, of the modes that are only mass.
        let (mut even, mut alternating) = (0.0, 0.0);
        // What leaves an open end, as long as all move as one.
        let mut outlet = if self.open && alpha == 0.0 { 1.0 } else { 0.0 };
        for l in 0..HALF_WAVES {
            let along = if l == 0 && !self.open { 1.0 } else { 0.5 };
            let uniform = alpha == 0.0 && l == 0 && !self.open;
            let cylinder = PI * self.radius * self.radius * self.depth;
            // Only the uniform mode knows that the vessel is not a cylinder.
            let depth = match (uniform, self.open) {
                (true, _) => self.depth * self.volume / cylinder,
                (_, true) => self.depth + END * self.radius,
                _ => self.depth,
            };
            let half_waves = f64::from(l) + if self.open { 0.5 } else { 0.0 };
            let spring = DENSITY * SPEED_OF_SOUND.powi(2) / (area * radial_norm * depth * along);
            let wave = (alpha / self.radius).hypot(half_waves * PI / depth);
            let omega = SPEED_OF_SOUND * wave;
            let sign = if l % 2 == 0 { 1.0 } else { -1.0 };
            if omega < limit {
                let side = |head: &HeadShape| if head.far { -sign } else { 1.0 };
                let volume = heads.iter().zip(&overlaps).map(|(head, c)| side(head) * c).collect();
                let own = if alpha == 0.0 && self.open { 2.0 * sign / (half_waves * PI) } else { 0.0 };
                outlet -= own;
                let mut holes = [0.0; HOLES];
                for (own, air) in holes.iter_mut().zip(&order.holes).filter(|_| alpha == 0.0) {
                    *own = -air.hole.pressure(l) * PI * self.radius * self.radius;
                }
                order.modes.push(CavityMode {
                    circles,
                    half_waves: l,
                    omega,
                    spring,
                    volume,
                    outlet: own,
                    holes,
                });
            } else {
                even += spring / (omega * omega);
                alternating += sign * spring / (omega * omega);
            }
        }
        for (total, c) in order.outlet.iter_mut().zip(&overlaps) {
            *total += outlet * c;
        }
        for (i, a) in heads.iter().enumerate() {
            for (k, b) in heads.iter().enumerate() {
                let mu = if a.far == b.far { even } else { -alternating };
                order.mass[i * heads.len() + k] += mu * overlaps[i] * overlaps[k];
            }
        }
    }
}

/// `int_0^1 N J_m(j r) J_m(alpha r) r dr`, with `J_m(j) = 0`, `J_m'(alpha) = 0`; `peak` is `J_m(alpha)`.
fn overlap(m: u32, head: &HeadShape, alpha: f64, peak: f64) -> f64 {
    let slope = bessel::j_prime(m, head.zero);
    head.norm * head.zero * slope * peak / (alpha * alpha - head.zero * head.zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::air_load::shape_norm;

    fn head(m: u32, n: u32, far: bool) -> HeadShape {
        let zero = bessel::zero(m, n);
        HeadShape { zero, norm: shape_norm(m, bessel::j_prime(m, zero)), far }
    }

    #[test]
    fn first_transverse_mode_of_a_snare_is_565_hz() {
        let order = CavitySpec::cylinder(0.1778, 0.1397).order(1, &[head(1, 1, false)], TAU * 3000.0);
        let hz = order.modes[0].omega / TAU;
        assert!((hz - 565.0).abs() < 1.0, "{hz}");
    }

    #[test]
    fn the_uniform_spring_follows_the_real_volume() {
        let whole = CavitySpec::cylinder(0.2, 0.3);
        let half = CavitySpec { volume: 0.5 * whole.volume, ..whole };
        let spring = |spec: &CavitySpec| spec.order(0, &[head(0, 1, false)], 1000.0).modes[0].spring;
        assert!((spring(&half) / spring(&whole) - 2.0).abs() < 1e-12);
        let area = PI * 0.04;
        assert!((spring(&whole) * area * area / whole.uniform_spring() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_open_pipe_is_a_plug_of_air_that_all_leaves_far_below_its_modes() {
        let (a, depth) = (0.15, 0.23);
        let open = CavitySpec { open: true, ..CavitySpec::cylinder(a, depth) };
        let shape = head(0, 1, false);
        let piston = PI * a * a * 2.0 * overlap(0, &shape, 0.0, 1.0);
        let length = depth + END * a;
        // All as mass, and all as modes far above the motion.
        let order = open.order(0, &[shape], 0.0);
        let cross: f64 = bessel::zeros_prime(0, (shape.zero / PI) as u32 + EXTRA_CIRCLES)
            .into_iter()
            .map(|alpha| {
                let peak = bessel::j(0, alpha);
                let c = TAU * a * a * overlap(0, &shape, alpha, peak);
                let (norm, k) = (0.5 * peak * peak * a * a * TAU, alpha / a);
                DENSITY * c * c * (k * length).tanh() / (norm * k)
            })
            .sum();
        let plug = DENSITY * piston * piston * length / (PI * a * a);
        assert!((order.mass[0] / (plug + cross) - 1.0).abs() < 0.01, "{} {plug} {cross}", order.mass[0]);
        assert!((order.outlet[0] / piston - 1.0).abs() < 1e-9);
        let kept = open.order(0, &[shape], TAU * 20_000.0);
        let along = kept.modes.iter().filter(|mode| mode.circles == 0);
        let left: f64 = along.map(|mode| mode.outlet * mode.volume[0]).sum::<f64>() + kept.outlet[0];
        assert!((left / piston - 1.0).abs() < 1e-9);
        assert!((kept.modes[0].omega / (SPEED_OF_SOUND * PI / (2.0 * length)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn air_left_as_mass_is_that_of_the_closed_form() {
        // Far below every mode of order 1 the field of a radial function is cosh(k (L - z)): its mass is
        // rho C^2 coth(k L) / (k norm).
        let (a, depth) = (0.15, 0.2);
        let shape = head(1, 1, false);
        let order = CavitySpec::cylinder(a, depth).order(1, &[shape], 0.0);
        let mut exact = 0.0;
        for alpha in bessel::zeros_prime(1, (shape.zero / PI) as u32 + EXTRA_CIRCLES) {
            let peak = bessel::j(1, alpha);
            let norm = 0.5 * (1.0 - 1.0 / (alpha * alpha)) * peak * peak * a * a * PI;
            let c = a * a * PI * overlap(1, &shape, alpha, peak);
            let k = alpha / a;
            exact += DENSITY * c * c / (norm * k * (k * depth).tanh());
        }
        assert!((order.mass[0] / exact - 1.0).abs() < 0.01, "{} {exact}", order.mass[0]);
    }
}
