//! Circular membrane, clamped at its rim: mode shapes, frequencies, masses and losses in air.
//!
//! Model: uniform tension `T`, a film of thickness `h`, small displacement. Shapes
//! `N J_m(j_mn r) cos/sin(m theta)` of unit mean square, `r` the share of the radius `a`; with
//! `k = j_mn / a`, `A` the area, `D` the film's flexural rigidity,
//!
//! ```text
//! omega^2 (M + added mass(omega)) = (T k^2 + D k^4) A
//! ```
//!
//! The added mass depends on the frequency, which is found by fixed point. Losses are the film's
//! own; what a head sends out depends on what it is part of, see [`drum`](crate::drum).
//!
//! A [mesh] moves the air on it by a part only. A [dot] mixes modes of one order; [`ringing`](Membrane::ringing) is then a mode's by itself, and
//! [`tension_for`](Membrane::tension_for) solves for the mixture.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 5; Rossing, Science of Percussion Instruments.

pub mod dot;
pub mod mesh;
mod spec;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::air_load::{self, MassCurve, MassCurves, MembraneAir};
use crate::error::SpecError;
use crate::math::bessel::{self, JTable};
use crate::math::eigen;

use dot::AtEdge;
use mesh::Slip;
pub use spec::MembraneSpec;

/// What stands on the two faces of a head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surroundings {
    /// Nothing.
    Vacuum,
    /// Air on both faces; one looks outward and radiates.
    Air,
}

/// How far a set of modes reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeRange {
    /// Tension at which the modes below `limit_hz` are chosen, N/m.
    pub reference_tension: f64,
    /// Highest frequency, Hz.
    pub limit_hz: f64,
}

/// One pair of modes (one mode for `m = 0`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MembraneMode {
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles, the rim counted.
    pub n: u32,
    /// `j_mn`.
    pub zero: f64,
    /// `N`.
    pub norm: f64,
    /// Load of one face.
    load: MassCurve,
    /// At the edge of the dot.
    at_dot: AtEdge,
}

/// Where a mode rings at some tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ringing {
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate by the losses of the film and the edge, and by the flow through a mesh, 1/s.
    pub sigma: f64,
    /// Modal mass with the air it carries, kg.
    pub mass: f64,
}

/// A head and its modes, lowest first.
///
/// ```
/// use overhear_engine::contact::Material;
/// use overhear_engine::damping::LossLaw;
/// use overhear_engine::membrane::{Membrane, MembraneSpec, ModeRange, Surroundings};
///
/// // A timpani head: 26 in of film at 2729 N/m.
/// let spec = MembraneSpec {
///     radius: 0.3302,
///     thickness: 0.19e-3,
///     plies: 1,
///     material: Material::FILM,
///     loss: LossLaw::NONE,
///     edge: None,
///     dot: None,
///     mesh: None,
/// };
/// let range = ModeRange { reference_tension: 2729.0, limit_hz: 600.0 };
/// let head = Membrane::new(spec, Surroundings::Air, &range)?;
/// let hz = |m, n| {
///     let mode = head.modes().iter().find(|mode| (mode.m, mode.n) == (m, n)).expect("a low mode");
///     head.ringing(mode, 2729.0).omega / std::f64::consts::TAU
/// };
/// // The air makes a fifth of what is 1.34 in vacuum.
/// assert!((hz(2, 1) / hz(1, 1) - 1.47).abs() < 0.01);
/// assert!((head.tension_for(1, 1, hz(1, 1)).expect("a mode") / 2729.0 - 1.0).abs() < 1e-9);
/// # Ok::<(), overhear_engine::error::SpecError>(())
/// ```
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Membrane {
    spec: MembraneSpec,
    modes: Vec<MembraneMode>,
}

/// Most modes (pairs count twice) a head carries; beyond it the highest are left out. *Derived*: 1,200 fill
/// three octaves and a half of a kick and cost a hundredth of a core.
const MAX_MODES: usize = 2000;

impl Membrane {
    /// The modes of a head, for all tensions. Allocates; tens of milliseconds.
    ///
    /// # Errors
    /// [`SpecError`] if the spec is out of range.
    pub fn new(
        spec: MembraneSpec,
        surroundings: Surroundings,
        range: &ModeRange,
    ) -> Result<Membrane, SpecError> {
        Membrane::sharing(spec, surroundings, range, &mut MassCurves::default())
    }

    /// As [`new`](Self::new), with what other heads of a drum have worked out.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn sharing(
        spec: MembraneSpec,
        surroundings: Surroundings,
        range: &ModeRange,
        curves: &mut MassCurves,
    ) -> Result<Membrane, SpecError> {
        let spec = spec.validated()?;
        // Without air a head rings highest, and lowest if all of it weighs what its dot does; nothing above this zero can ring below the limit.
        let most = spec.area_density() + spec.added_by_dot().map_or(0.0, |dot| dot.density);
        let speed = (range.reference_tension / most).sqrt();
        let most = std::f64::consts::TAU * range.limit_hz * spec.radius / speed * 1.3;
        let mut candidates: Vec<(u32, u32, f64)> = (0..)
            .map(|m| (m, zeros_to(m, most)))
            .take_while(|(_, zeros)| !zeros.is_empty())
            .flat_map(|(m, zeros)| zeros.into_iter().zip(1..).map(move |(zero, n)| (m, n, zero)))
            .collect();
        candidates.sort_by(|a, b| a.2.total_cmp(&b.2));
        let mut count = 0;
        candidates.retain(|&(m, ..)| {
            count += if m == 0 { 1 } else { 2 };
            count <= MAX_MODES
        });
        let reach = MembraneAir::reach(candidates.last().map_or(0.0, |last| last.2));
        let orders = candidates.iter().map(|c| c.0).max().unwrap_or(0);
        let tables = JTable::orders(orders, reach);
        let mut membrane = Membrane { spec, modes: Vec::with_capacity(candidates.len()) };
        for (m, n, zero) in candidates {
            let norm = air_load::shape_norm(m, bessel::j_prime(m, zero));
            let load = match surroundings {
                Surroundings::Vacuum => MassCurve::VACUUM,
                Surroundings::Air => curves.get(&MembraneAir::new(m, &tables[m as usize]), zero),
            };
            let at_dot = spec.at_dot(m, zero);
            let mode = MembraneMode { m, n, zero, norm, load, at_dot };
            let frequency = membrane.ringing(&mode, range.reference_tension).omega / std::f64::consts::TAU;
            if frequency <= range.limit_hz {
                membrane.modes.push(mode);
            }
        }
        Ok(membrane)
    }

    /// The same head, its modes ordered by diameters, then circles.
    pub fn by_order(mut self) -> Membrane {
        self.modes.sort_by_key(|mode| (mode.m, mode.n));
        self
    }

    /// The head.
    pub fn spec(&self) -> &MembraneSpec {
        &self.spec
    }

    /// Its modes, by their zeros.
    pub fn modes(&self) -> &[MembraneMode] {
        &self.modes
    }

    /// Radial shapes of all modes at `radii` (shares of the radius), `[mode][radius]`, within 1e-8.
    pub fn radial_shapes(&self, radii: &[f64]) -> Vec<f64> {
        let orders = self.modes.iter().map(|mode| mode.m).max().unwrap_or(0);
        let reach = self.modes.iter().map(|mode| mode.zero).fold(0.0, f64::max);
        let tables = JTable::orders(orders, reach);
        let shape = |mode: &MembraneMode, r: f64| mode.norm * tables[mode.m as usize].value(mode.zero * r);
        self.modes.iter().flat_map(|mode| radii.iter().map(|&r| shape(mode, r)).collect::<Vec<_>>()).collect()
    }

    /// Mass (kg) and stiffness (N/m) that the dot adds between two modes of one order, or to one.
    pub fn added(&self, one: &MembraneMode, other: &MembraneMode) -> (f64, f64) {
        let Some(dot) = self.spec.added_by_dot() else { return (0.0, 0.0) };
        let covered = self.spec.area() * dot::overlap(one.m, dot.reach, one.at_dot, other.at_dot);
        let waves = (one.zero * other.zero / self.spec.radius.powi(2)).powi(2);
        (dot.density * covered, dot.rigidity * waves * covered)
    }

    /// Stiffness of a mode at a tension (N/m) without the dot's, N/m.
    pub fn restoring(&self, mode: &MembraneMode, tension: f64) -> f64 {
        self.stiffness(mode, tension) * self.spec.area()
    }

    /// Volume that a mode without nodal diameters displaces, per modal displacement, m2.
    pub fn volume(&self, mode: &MembraneMode) -> f64 {
        2.0 * self.spec.area() * mode.norm * libm::j1(mode.zero) / mode.zero
    }

    /// How far the air on both faces follows a mode at an angular frequency, rad/s.
    pub fn slip(&self, mode: &MembraneMode, omega: f64) -> Slip {
        let air = |mode| 2.0 * self.air_mass(mode, omega) / self.spec.area();
        self.spec.mesh.map_or(Slip::NONE, |mesh| Slip::new(&mesh, self.spec.thickness, air(mode), omega))
    }

    /// Mass of the air on one face that the mode feels at an angular frequency, kg.
    pub fn face_mass(&self, mode: &MembraneMode, omega: f64) -> f64 {
        self.air_mass(mode, omega) * self.slip(mode, omega).mass
    }

    /// Mass of the air that moves with one face of a tight film, kg.
    fn air_mass(&self, mode: &MembraneMode, omega: f64) -> f64 {
        let u = omega * self.spec.radius / air_load::SPEED_OF_SOUND;
        air_load::DENSITY * self.spec.radius.powi(3) * mode.load.at(u)
    }

    /// Slope of a mode's shape across the rim, 1/m, at its largest around the rim.
    ///
    /// Of every mode of unit mean square, `int slope^2 ds = 2 k^2 A / a` around the rim (Rellich's identity).
    pub fn rim_slope(&self, mode: &MembraneMode) -> f64 {
        let sign = if mode.n.is_multiple_of(2) { 1.0 } else { -1.0 };
        let largest = if mode.m == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
        sign * largest * mode.zero / self.spec.radius
    }

    /// `T k^2 + D k^4`, N/m3.
    fn stiffness(&self, mode: &MembraneMode, tension: f64) -> f64 {
        let k2 = (mode.zero / self.spec.radius).powi(2);
        (tension + self.spec.flexural_rigidity() * k2) * k2
    }

    /// Modal mass at an angular frequency, kg: the film and the air on both faces.
    fn mass(&self, mode: &MembraneMode, omega: f64) -> f64 {
        self.spec.area_density() * self.spec.area() + 2.0 * self.face_mass(mode, omega)
    }

    /// Where a mode rings at a tension (N/m), not mixed with others by a dot.
    pub fn ringing(&self, mode: &MembraneMode, tension: f64) -> Ringing {
        let (weight, stiffness) = self.added(mode, mode);
        let force = self.restoring(mode, tension) + stiffness;
        let film = self.spec.area_density() * self.spec.area() + weight;
        let mut omega = (force / film).sqrt();
        let mut mass = film;
        // The mass falls slowly with frequency: each round gains two digits or more.
        for _ in 0..40 {
            mass = self.mass(mode, omega) + weight;
            let next = (force / mass).sqrt();
            let settled = (next / omega - 1.0).abs() < 1e-13;
            omega = next;
            if settled {
                break;
            }
        }
        let k = mode.zero / self.spec.radius;
        let edge = self.spec.edge_sigma(tension, k, mass / self.spec.area(), omega);
        let mount = self.spec.edge.map_or(0.0, |edge| edge.mount_sigma(mode.m));
        let flow = 0.5 * self.slip(mode, omega).resistance * self.spec.area() / mass;
        Ringing { omega, sigma: self.spec.loss.sigma(omega) + edge + mount + flow, mass }
    }

    /// The tension (N/m) that puts mode `(m, n)` at a frequency (Hz); `None` if there is no such mode.
    pub fn tension_for(&self, m: u32, n: u32, frequency_hz: f64) -> Option<f64> {
        let mode = self.modes.iter().find(|mode| (mode.m, mode.n) == (m, n))?;
        let omega = std::f64::consts::TAU * frequency_hz;
        if self.spec.dot.is_some() {
            return self.tension_under_dot(m, n, omega);
        }
        let k2 = (mode.zero / self.spec.radius).powi(2);
        let force = omega * omega * self.mass(mode, omega) / self.spec.area();
        Some(force / k2 - self.spec.flexural_rigidity() * k2)
    }

    /// The tension (N/m) that puts the mode of `n` circles among those that the dot makes of the order `m` at an angular frequency: at one
    /// frequency, `T k^2` balances what is left of the inertia, and the mode of fewest circles needs the most tension.
    fn tension_under_dot(&self, m: u32, n: u32, omega: f64) -> Option<f64> {
        let modes: Vec<&MembraneMode> = self.modes.iter().filter(|mode| mode.m == m).collect();
        let (area, bare) = (self.spec.area(), |mode| self.restoring(mode, 0.0));
        let balance = DMatrix::from_fn(modes.len(), modes.len(), |i, j| {
            let (one, other) = (modes[i], modes[j]);
            let (mut mass, mut stiffness) = self.added(one, other);
            if i == j {
                mass += self.mass(one, omega);
                stiffness += bare(one);
            }
            let waves = one.zero * other.zero / self.spec.radius.powi(2);
            (omega * omega * mass - stiffness) / (waves * area)
        });
        eigen::symmetric(balance).values.into_iter().rev().nth(n as usize - 1)
    }
}

/// The zeros of `J_m` up to `most`.
fn zeros_to(m: u32, most: f64) -> Vec<f64> {
    // They lie further apart than pi / 1.1, and none below m.
    let guess = ((most - f64::from(m)).max(0.0) / 2.8) as u32 + 2;
    bessel::zeros(m, guess).into_iter().filter(|&zero| zero <= most).collect()
}

/// Tension of a head in vacuum whose mode of the order `m` and of zero `zero` is at `frequency_hz`, N/m: where to start
/// looking, and a lower bound for a head in air.
pub fn vacuum_tension(spec: &MembraneSpec, (m, zero): (u32, f64), frequency_hz: f64) -> f64 {
    spec.moved(m, zero).0 * (std::f64::consts::TAU * frequency_hz * spec.radius / zero).powi(2)
}

#[cfg(test)]
mod tests;
