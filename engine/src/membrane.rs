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
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 5; Rossing, Science of Percussion Instruments.

use serde::{Deserialize, Serialize};

use crate::air_load::{self, MassCurve, MassCurves, MembraneAir};
use crate::contact::Material;
use crate::damping::{EdgeSpec, LossLaw};
use crate::error::SpecError;
use crate::fitted;
use crate::math::bessel::{self, JTable};

/// A drum head.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MembraneSpec {
    /// Radius of the vibrating part, m.
    pub radius: f64,
    /// Thickness of the film, m, of all plies together.
    pub thickness: f64,
    /// Films that lie on one another: 1 or 2.
    pub plies: u32,
    /// What the film is made of.
    pub material: Material,
    /// Losses in the film.
    pub loss: LossLaw,
    /// What carries it at the rim; `None` for a rim that does not yield.
    pub edge: Option<EdgeSpec>,
}

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
}

/// Where a mode rings at some tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ringing {
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate by the losses of the film and the edge, 1/s.
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

/// Flexural rigidity of two plies that slide on one another over that of one film as thick, dimensionless: 1/4 if nothing
/// held them together. *Fitted*.
const BOND: f64 = fitted::PLY_BOND;

impl MembraneSpec {
    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the field.
    pub fn validated(self) -> Result<MembraneSpec, SpecError> {
        SpecError::check("head radius (m)", self.radius, 0.05, 1.0)?;
        SpecError::check("head thickness (m)", self.thickness, 1e-5, 2e-3)?;
        SpecError::check("plies", f64::from(self.plies), 1.0, 2.0)?;
        SpecError::check("film density (kg/m3)", self.material.density, 100.0, 25_000.0)?;
        Ok(self)
    }

    /// Area, m2.
    pub fn area(&self) -> f64 {
        std::f64::consts::PI * self.radius * self.radius
    }

    /// Mass per area, kg/m2.
    pub fn area_density(&self) -> f64 {
        self.material.density * self.thickness
    }

    /// Decay rate by what the edge takes from a wave of wavenumber `k` (1/m) on a head of tension `T` (N/m) that
    /// weighs `mass` (kg/m2) with its air, 1/s: `T^2 k^2 Re Y / (a mass omega^2)`.
    pub fn edge_sigma(&self, tension: f64, k: f64, mass: f64, omega: f64) -> f64 {
        let Some(edge) = &self.edge else { return 0.0 };
        (tension * k / omega).powi(2) * edge.mobility(omega) / (self.radius * mass)
    }

    /// Flexural rigidity `D = E h^3 / (12 (1 - nu^2))`, N m.
    pub fn flexural_rigidity(&self) -> f64 {
        let Material { youngs_modulus, poisson_ratio, .. } = self.material;
        youngs_modulus * self.thickness.powi(3) / (12.0 * (1.0 - poisson_ratio * poisson_ratio))
    }

    /// The same where a tip bends it sharply, N m: two plies slide on one another there, which waves of some micrometres
    /// hardly make them do.
    pub fn dented_rigidity(&self) -> f64 {
        if self.plies > 1 { BOND * self.flexural_rigidity() } else { self.flexural_rigidity() }
    }
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
        // Without air a head rings highest; nothing above this zero can ring below the limit.
        let speed = (range.reference_tension / spec.area_density()).sqrt();
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
            let mode = MembraneMode { m, n, zero, norm, load };
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

    /// Stiffness of a mode at a tension (N/m), N/m.
    pub fn restoring(&self, mode: &MembraneMode, tension: f64) -> f64 {
        self.stiffness(mode, tension) * self.spec.area()
    }

    /// Volume that a mode without nodal diameters displaces, per modal displacement, m2.
    pub fn volume(&self, mode: &MembraneMode) -> f64 {
        2.0 * self.spec.area() * mode.norm * libm::j1(mode.zero) / mode.zero
    }

    /// Mass of the air on one face at an angular frequency, kg.
    pub fn face_mass(&self, mode: &MembraneMode, omega: f64) -> f64 {
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

    /// Where a mode rings at a tension (N/m).
    pub fn ringing(&self, mode: &MembraneMode, tension: f64) -> Ringing {
        let force = self.stiffness(mode, tension) * self.spec.area();
        let film = self.spec.area_density() * self.spec.area();
        let mut omega = (force / film).sqrt();
        let mut mass = film;
        // The mass falls slowly with frequency: each round gains two digits or more.
        for _ in 0..40 {
            mass = self.mass(mode, omega);
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
        Ringing { omega, sigma: self.spec.loss.sigma(omega) + edge + mount, mass }
    }

    /// The tension (N/m) that puts mode `(m, n)` at a frequency (Hz); `None` if there is no such mode.
    pub fn tension_for(&self, m: u32, n: u32, frequency_hz: f64) -> Option<f64> {
        let mode = self.modes.iter().find(|mode| (mode.m, mode.n) == (m, n))?;
        let omega = std::f64::consts::TAU * frequency_hz;
        let k2 = (mode.zero / self.spec.radius).powi(2);
        let force = omega * omega * self.mass(mode, omega) / self.spec.area();
        Some(force / k2 - self.spec.flexural_rigidity() * k2)
    }
}

/// The zeros of `J_m` up to `most`.
fn zeros_to(m: u32, most: f64) -> Vec<f64> {
    // They lie further apart than pi / 1.1, and none below m.
    let guess = ((most - f64::from(m)).max(0.0) / 2.8) as u32 + 2;
    bessel::zeros(m, guess).into_iter().filter(|&zero| zero <= most).collect()
}

/// Tension of a head in vacuum whose mode of zero `zero` is at `frequency_hz`, N/m: where to start
/// looking, and a lower bound for a head in air.
pub fn vacuum_tension(spec: &MembraneSpec, zero: f64, frequency_hz: f64) -> f64 {
    spec.area_density() * (std::f64::consts::TAU * frequency_hz * spec.radius / zero).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timpani() -> MembraneSpec {
        MembraneSpec {
            radius: 0.3302,
            thickness: 0.19e-3,
            plies: 1,
            material: Material::FILM,
            loss: LossLaw::NONE,
            edge: None,
        }
    }

    fn range(tension: f64) -> ModeRange {
        ModeRange { reference_tension: tension, limit_hz: 1500.0 }
    }

    fn frequency(membrane: &Membrane, m: u32, n: u32, tension: f64) -> f64 {
        let mode = membrane.modes().iter().find(|mode| (mode.m, mode.n) == (m, n)).unwrap();
        membrane.ringing(mode, tension).omega / std::f64::consts::TAU
    }

    #[test]
    fn second_mode_of_an_ideal_membrane_is_1_593_times_the_first() {
        let spec = MembraneSpec { thickness: 0.02e-3, ..timpani() };
        let membrane = Membrane::new(spec, Surroundings::Vacuum, &range(2729.0)).unwrap();
        let ratio = frequency(&membrane, 1, 1, 2729.0) / frequency(&membrane, 0, 1, 2729.0);
        assert!((ratio - 1.593_340_5).abs() < 1e-5, "{ratio}");
    }

    #[test]
    fn timpani_head_in_air_has_the_measured_ratios() {
        let membrane = Membrane::new(timpani(), Surroundings::Air, &range(2729.0)).unwrap();
        assert!((timpani().area_density() * timpani().area() - 0.0904).abs() < 1e-4);
        let principal = frequency(&membrane, 1, 1, 2729.0);
        for (m, computed, measured) in
            [(2, 1.470, 1.48), (3, 1.922, 1.92), (4, 2.363, 2.36), (5, 2.797, 2.78)]
        {
            let ratio = frequency(&membrane, m, 1, 2729.0) / principal;
            assert!((ratio / computed - 1.0).abs() < 0.002, "({m},1): {ratio} for {computed}");
            assert!((ratio / measured - 1.0).abs() < 0.01, "({m},1): {ratio} for {measured}");
        }
    }

    #[test]
    fn the_tension_for_a_pitch_gives_that_pitch() {
        let membrane = Membrane::new(timpani(), Surroundings::Air, &range(2729.0)).unwrap();
        for pitch in [110.0, 130.8, 160.0] {
            let tension = membrane.tension_for(1, 1, pitch).unwrap();
            assert!((frequency(&membrane, 1, 1, tension) / pitch - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_mount_takes_from_modes_that_pull_on_the_whole_drum_alone() {
        let ringing = |mount| {
            let edge = EdgeSpec { resistance: 400.0, corner_hz: 200.0, mount };
            let spec = MembraneSpec { edge: Some(edge), ..timpani() };
            let membrane = Membrane::new(spec, Surroundings::Air, &range(2729.0)).unwrap();
            membrane
                .modes()
                .iter()
                .map(|mode| (mode.m, membrane.ringing(mode, 2729.0).sigma))
                .collect::<Vec<_>>()
        };
        for ((m, free), (_, held)) in ringing(0.0).into_iter().zip(ringing(7.0)) {
            let expected = if m <= 1 { 7.0 } else { 0.0 };
            assert!((held - free - expected).abs() < 1e-9, "order {m}: {free} to {held} 1/s");
        }
    }

    #[test]
    fn an_edge_takes_the_same_from_every_mode_above_its_corner() {
        let edge = EdgeSpec { resistance: 400.0, corner_hz: 200.0, mount: 0.0 };
        let spec = MembraneSpec { thickness: 0.02e-3, edge: Some(edge), ..timpani() };
        let membrane = Membrane::new(spec, Surroundings::Vacuum, &range(2729.0)).unwrap();
        for mode in membrane.modes() {
            let ringing = membrane.ringing(mode, 2729.0);
            // sigma = T Re Y / a, but for the little that the film's stiffness adds to the frequency.
            let law = 2729.0 * edge.mobility(ringing.omega) / spec.radius;
            assert!((ringing.sigma / law - 1.0).abs() < 1e-3, "({}, {}): {ringing:?} {law}", mode.m, mode.n);
            // Rellich: the mean square slope around the rim is k^2.
            let around = if mode.m == 0 { 1.0 } else { 0.5 };
            let k = mode.zero / spec.radius;
            assert!((around * membrane.rim_slope(mode).powi(2) / (k * k) - 1.0).abs() < 1e-12);
            let step = 1e-5;
            let shape = membrane.radial_shapes(&[1.0 - step]);
            let at = membrane.modes().iter().position(|other| other == mode).unwrap();
            let slope = -shape[at] / (step * spec.radius);
            assert!((slope / membrane.rim_slope(mode) - 1.0).abs() < 1e-2, "{slope}");
        }
    }
}
