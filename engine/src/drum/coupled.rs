//! The modes of a whole drum: two heads, the air between them, the air around them.
//!
//! Model: for each number of nodal diameters the heads' own modes `q` and the enclosed air's `y`
//! (see [`cavity`](crate::cavity)) are one linear system,
//!
//! ```text
//! K = diag(T k^2 + D k^4) A + sum_j kappa_j [c_j; -1] [c_j; -1]^T      M = diag(film + outer air) + inner air
//! ```
//!
//! whose eigenvectors say how much of each head is in each mode of the drum; a [dot](crate::membrane::dot) adds its mass and its stiffness
//! between the modes of its head. The heads' outer faces carry
//! the air of a baffled disc, less what flows around the rim of a drum that stands free; the inner
//! faces only the cavity's. Losses are small and added mode by mode: film, cavity, and what the two heads
//! together send out. With `F_b`, `F_r` the Hankel transforms of their shares,
//!
//! ```text
//! R = rho omega a^3 C_m  B / 2  int_0^u  F_b^2 + F_r^2 - 2 F_b F_r cos(k_z l)  ds
//! ```
//!
//! the heads radiate into all of space (`B` = 1) as two layers the length `l` apart: a
//! motion of both the same way moves no net air and rings on, one against the other is a monopole
//! and dies. `l` is the shell's length and what the air around a disc of no length adds, `8 a / (3 pi)`. Where the
//! body is large against the wave, `B` = 4/3: waves on a head are slower than sound and cancel but for a strip along
//! the rim, and there the body fills a quarter of space, not half of it as a baffle would. Between, `B` rises as
//! [`diffraction`] has it for a source that faces all of the body.
//!
//! A shell without its other head sends out at its open end what the enclosed air pushes there, as a piston. A port in the other head
//! is one more degree of freedom of the modes without nodal diameters, and is heard as such a piston of the same volume: it moves much only
//! where the wave is longer than the drum is wide. So is a vent in the wall, of which the same holds; that of a kettle is behind the baffle,
//! where nothing is heard.
//!
//! Limits: the heads' outer air does not couple their modes; losses do not couple modes.

use nalgebra::{DMatrix, DVector};

use serde::{Deserialize, Serialize};

use crate::air_load::{self, DENSITY, HankelShape, SPEED_OF_SOUND};
use crate::cavity::CavityOrder;
use crate::diffraction::{self, Outside};
use crate::math::bessel::JTable;
use crate::math::{eigen, quadrature};
use crate::membrane::mesh::Slip;
use crate::membrane::{Membrane, MembraneMode};

/// A head stretched to a tension (N/m).
#[derive(Clone, Copy)]
pub struct Stretched<'a> {
    /// The head.
    pub membrane: &'a Membrane,
    /// N/m.
    pub tension: f64,
}

/// The modes of one order are sought among these.
pub struct OrderProblem<'a> {
    /// Nodal diameters.
    pub m: u32,
    /// The struck head.
    pub batter: Stretched<'a>,
    /// The other head.
    pub resonant: Option<Stretched<'a>>,
    /// The enclosed air, against the batter's modes of this order, then the resonant head's.
    pub cavity: Option<&'a CavityOrder>,
    /// Quality factor of the cavity's modes.
    pub cavity_q: f64,
    /// What surrounds the drum.
    pub outside: Outside,
    /// `J_m`, far enough for the heads' zeros.
    pub bessel: &'a JTable,
}

/// A mode of the drum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoupledMode {
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate, 1/s.
    pub sigma: f64,
    /// Share of each head mode and then each cavity mode, of unit modal mass.
    pub vector: Vec<f64>,
    /// The same in coordinates where modes are at right angles; a unit vector.
    pub direction: Vec<f64>,
    /// Share of the kinetic energy that is the batter's, and the resonant head's; the rest is the air's.
    pub share: [f64; 2],
    /// Such shares of every head mode, of the air of every hole, and of every cavity mode.
    pub shares: Vec<f64>,
    /// Share of the kinetic energy that is in air going along the drum as one, from head to head.
    pub flow: f64,
    /// Displacement of the air at an open end or in holes, along the stroke, as a piston as wide as the head: its ratio to the modal
    /// displacement.
    pub outlet: f64,
    /// Area of the monopole in a baffle that would radiate its power at unit modal acceleration, m2.
    pub monopole_area: f64,
}

/// Slower than this nothing is a mode of the drum, rad/s.
pub const SLOWEST: f64 = 30.0;

/// One head mode with what it brings.
struct Part<'a> {
    mode: &'a MembraneMode,
    head: Stretched<'a>,
    far: bool,
}

/// End correction of a pipe in free air over that of one in a baffle, less one (Levine & Schwinger 1948).
const RIM_RELIEF: f64 = 0.613_3 / 0.848_8 - 1.0;

/// `j_01`, the shape the relief is known for.
const J01: f64 = 2.404_825_557_695_773;

impl<'a> OrderProblem<'a> {
    fn parts(&self) -> Vec<Part<'a>> {
        let of = |head: Stretched<'a>, far| {
            let modes = head.membrane.modes().iter().filter(|mode| mode.m == self.m);
            modes.map(move |mode| Part { mode, head, far }).collect::<Vec<_>>()
        };
        let mut parts = of(self.batter, false);
        parts.extend(self.resonant.into_iter().flat_map(|head| of(head, true)));
        parts
    }

    /// Every mode of this order, lowest first.
    pub fn solve(&self) -> Vec<CoupledMode> {
        let parts = self.parts();
        if parts.is_empty() {
            return Vec::new();
        }
        // The outer air's mass depends on the frequency, slowly; it is taken where each head mode would
        // ring by itself, so that all modes come out of one system and move smoothly with the pitch.
        let omegas: Vec<f64> =
            parts.iter().map(|part| part.head.membrane.ringing(part.mode, part.head.tension).omega).collect();
        let solved = self.eigenmodes(&parts, &omegas);
        let masses = self.head_masses(&parts, &omegas);
        let shapes: Vec<HankelShape> =
            parts.iter().map(|part| HankelShape::new(self.m, part.mode.zero, self.bessel)).collect();
        solved.into_iter().map(|mode| self.finish(&parts, &masses, &shapes, mode)).collect()
    }

    /// Mass of each head mode with the air on its outer face, kg.
    fn head_masses(&self, parts: &[Part], omegas: &[f64]) -> Vec<f64> {
        let mass = |(part, &omega): (&Part, &f64)| {
            let spec = part.head.membrane.spec();
            let relief = match self.outside {
                Outside::Baffle => 1.0,
                Outside::Free { .. } => 1.0 + RIM_RELIEF * J01 / part.mode.zero,
            };
            let inner = if self.cavity.is_some() { 0.0 } else { 1.0 };
            let face = part.head.membrane.face_mass(part.mode, omega);
            spec.area_density() * spec.area() + (relief + inner) * face
        };
        parts.iter().zip(omegas).map(mass).collect()
    }

    /// Frequencies and vectors.
    fn eigenmodes(&self, parts: &[Part], omegas: &[f64]) -> Vec<Solution> {
        let heads = parts.len();
        let (modes, mass) = (Vec::new(), vec![0.0; heads * heads]);
        let none = CavityOrder { modes, mass, outlet: Vec::new(), holes: Vec::new() };
        let cavity = self.cavity.unwrap_or(&none);
        let springs: Vec<_> = cavity.modes.iter().filter(|mode| mode.omega > 0.0).collect();
        // Heads, air, holes.
        let holes = heads + springs.len();
        let size = holes + cavity.holes.len();
        let mut stiffness = DMatrix::zeros(size, size);
        let mut mass = DMatrix::zeros(size, size);
        for (i, (part, own)) in parts.iter().zip(self.head_masses(parts, omegas)).enumerate() {
            stiffness[(i, i)] = part.head.membrane.restoring(part.mode, part.head.tension);
            mass[(i, i)] = own;
        }
        for i in 0..heads {
            for k in 0..heads {
                mass[(i, k)] += cavity.mass[i * heads + k];
            }
        }
        for (i, k, (weight, stiff)) in dots(parts) {
            mass[(i, k)] += weight;
            stiffness[(i, k)] += stiff;
        }
        for mode in &cavity.modes {
            for i in 0..heads {
                for k in 0..heads {
                    stiffness[(i, k)] += mode.spring * mode.volume[i] * mode.volume[k];
                }
            }
        }
        for (j, mode) in springs.iter().enumerate() {
            let y = heads + j;
            stiffness[(y, y)] = mode.spring;
            mass[(y, y)] = mode.spring / (mode.omega * mode.omega);
            for i in 0..heads {
                stiffness[(i, y)] = -mode.spring * mode.volume[i];
                stiffness[(y, i)] = stiffness[(i, y)];
            }
        }
        for (h, air) in cavity.holes.iter().enumerate() {
            let x = holes + h;
            mass[(x, x)] = air.mass;
            for mode in &cavity.modes {
                for (k, volume) in mode.holes.iter().enumerate().take(cavity.holes.len()) {
                    stiffness[(x, holes + k)] += mode.spring * mode.holes[h] * volume;
                }
                for i in 0..heads {
                    stiffness[(i, x)] += mode.spring * mode.volume[i] * mode.holes[h];
                    stiffness[(x, i)] = stiffness[(i, x)];
                }
            }
            for (j, mode) in springs.iter().enumerate() {
                stiffness[(heads + j, x)] = -mode.spring * mode.holes[h];
                stiffness[(x, heads + j)] = stiffness[(heads + j, x)];
            }
        }
        generalized(stiffness, mass)
    }

    /// Adds up a mode's losses.
    fn finish(
        &self,
        parts: &[Part],
        masses: &[f64],
        shapes: &[HankelShape],
        solution: Solution,
    ) -> CoupledMode {
        let Solution { omega, vector, direction } = solution;
        let heads = parts.len();
        let mut share = [0.0; 2];
        let mut shares = Vec::with_capacity(vector.len());
        let (mut sigma, mut flow) = (0.0, 0.0);
        for ((part, mass), x) in parts.iter().zip(masses).zip(&vector) {
            let kinetic = mass * x * x;
            shares.push(kinetic);
            share[usize::from(part.far)] += kinetic;
            sigma += kinetic * part.head.membrane.spec().loss.sigma(omega);
        }
        for (i, k, (weight, _)) in dots(parts) {
            // The head's motion under its dot carries the film and the dot.
            let (head, kinetic) = (parts[i].head.membrane.spec(), vector[i] * weight * vector[k]);
            let Some(dot) = head.added_by_dot() else { continue };
            shares[i] += kinetic;
            share[usize::from(parts[i].far)] += kinetic;
            let both = kinetic * (1.0 + head.area_density() / dot.density);
            sigma += kinetic * head.loss.sigma(omega) + both * dot.loss.sigma(omega);
        }
        sigma += self.edge_sigma(parts, omega, &vector, share[0] + share[1]);
        let slips: Vec<Slip> = parts.iter().map(|part| part.head.membrane.slip(part.mode, omega)).collect();
        let area = self.batter.membrane.spec().area();
        sigma += slips.iter().zip(&vector).map(|(slip, x)| 0.5 * slip.resistance * area * x * x).sum::<f64>();
        // What of the heads' motion the air follows.
        let followed: Vec<f64> = slips.iter().zip(&vector).map(|(slip, x)| slip.velocity * x).collect();
        if let Some(cavity) = self.cavity {
            let springs = cavity.modes.iter().filter(|mode| mode.omega > 0.0);
            for (mode, y) in springs.zip(&vector[heads..]) {
                let kinetic = mode.spring / (mode.omega * mode.omega) * y * y;
                shares.push(kinetic);
                if self.m == 0 && mode.circles == 0 {
                    flow += kinetic;
                }
                // A loss factor, not a dashpot: air that only rides along loses as slowly as it moves.
                sigma += kinetic * omega / (2.0 * self.cavity_q);
            }
            let moved = &vector[vector.len() - cavity.holes.len()..];
            for (k, (air, x)) in cavity.holes.iter().zip(moved).enumerate() {
                let kinetic = air.mass * x * x;
                shares.insert(heads + k, kinetic);
                sigma += kinetic * omega / (2.0 * air.hole.quality(omega));
            }
        }
        let outlet = match self.cavity {
            Some(cavity) => self.outlet(cavity, &vector, heads),
            None => self.through(parts, &followed),
        };
        let resistance = self.resistance((parts, shapes), omega, &followed, outlet);
        let radius = self.batter.membrane.spec().radius;
        sigma += 0.5 * DENSITY * omega * radius.powi(3) * resistance;
        let monopole_area = air_load::monopole_area(radius, resistance, omega);
        CoupledMode { omega, sigma, vector, direction, share, shares, flow, outlet, monopole_area }
    }

    /// Decay rate by what the edges take from a mode of unit modal mass, 1/s: `T^2 Re Y int (dw/dn)^2 ds / (2 omega^2)`
    /// of each head, and what the mount takes of the heads' share of its energy.
    fn edge_sigma(&self, parts: &[Part], omega: f64, vector: &[f64], share: f64) -> f64 {
        let mut pulls = [0.0; 2];
        for (part, q) in parts.iter().zip(vector) {
            pulls[usize::from(part.far)] += q * part.head.tension * part.head.membrane.rim_slope(part.mode);
        }
        let Some(edge) = self.batter.membrane.spec().edge else { return 0.0 };
        let radius = self.batter.membrane.spec().radius;
        let around = radius * std::f64::consts::PI * if self.m == 0 { 2.0 } else { 1.0 };
        let square = pulls.iter().map(|pull| pull * pull).sum::<f64>();
        0.5 * around * square * edge.mobility(omega) / (omega * omega) + share * edge.mount_sigma(self.m)
    }

    /// Displacement of the air at the open end of a shell under a mesh: all that passes the one passes the other.
    fn through(&self, parts: &[Part], followed: &[f64]) -> f64 {
        let Outside::Free { .. } = self.outside else { return 0.0 };
        let volume = |(part, x): (&Part, &f64)| x * part.head.membrane.volume(part.mode);
        let volume: f64 = if self.m == 0 { parts.iter().zip(followed).map(volume).sum() } else { 0.0 };
        volume / self.batter.membrane.spec().area()
    }

    /// Displacement of the air at an open end or in holes.
    fn outlet(&self, cavity: &CavityOrder, vector: &[f64], heads: usize) -> f64 {
        let springs = cavity.modes.iter().filter(|mode| mode.omega > 0.0).map(|mode| mode.outlet);
        let volume: f64 = springs.zip(&vector[heads..]).map(|(outlet, y)| outlet * y).sum();
        let plug: f64 = cavity.outlet.iter().zip(vector).map(|(outlet, q)| outlet * q).sum();
        let holes: f64 = vector[vector.len() - cavity.holes.len()..].iter().sum();
        (volume + plug) / self.batter.membrane.spec().area() + holes
    }

    /// Radiation resistance over `rho omega a^3` at unit modal displacement.
    fn resistance(
        &self,
        (parts, shapes): (&[Part], &[HankelShape]),
        omega: f64,
        vector: &[f64],
        outlet: f64,
    ) -> f64 {
        let radius = self.batter.membrane.spec().radius;
        let u = omega * radius / SPEED_OF_SOUND;
        let apart = match self.outside {
            Outside::Baffle => None,
            Outside::Free { length } => Some(length / radius + 8.0 / (3.0 * std::f64::consts::PI)),
        };
        // A quarter of a node for each radian that the integrand swings over the interval, and some.
        let rule = quadrature::shared_unit((0.3 * (2.0 + apart.unwrap_or(0.0)) * u) as usize + 10);
        let power = |t: f64| {
            let (s, x) = (u * t, u * (1.0 - t * t).max(0.0).sqrt());
            let mut face = [0.0; 2];
            if outlet != 0.0 {
                // The Hankel transform of a piston.
                face[1] = outlet * if x < 1e-6 { 0.5 } else { libm::j1(x) / x };
            }
            let bessel = self.bessel.value(x);
            for ((part, shape), q) in parts.iter().zip(shapes).zip(vector) {
                face[usize::from(part.far)] += q * shape.of_bessel(x, bessel);
            }
            let [near, far] = face;
            match apart {
                None => near * near,
                Some(apart) => near * near + far * far - 2.0 * near * far * (apart * s).cos(),
            }
        };
        let space = match self.outside {
            Outside::Baffle => 1.0,
            Outside::Free { .. } => 0.5 + (diffraction::baffling(u) - 1.0) / 6.0,
        };
        air_load::circle(self.m) * space * u * rule.integrate(power)
    }
}

/// Mass (kg) and stiffness (N/m) that the heads' dots add to each pair of modes on one head.
fn dots<'a>(parts: &'a [Part<'a>]) -> impl Iterator<Item = (usize, usize, (f64, f64))> + 'a {
    let dotted = |part: &Part| part.head.membrane.spec().dot.is_some();
    let under = parts.iter().enumerate().filter(move |(_, part)| dotted(part));
    under.flat_map(move |(i, one)| {
        let on_it = parts.iter().enumerate().filter(|(_, other)| other.far == one.far);
        on_it.map(move |(k, other)| (i, k, one.head.membrane.added(one.mode, other.mode)))
    })
}

/// An eigenvector of the coupled problem.
struct Solution {
    omega: f64,
    vector: Vec<f64>,
    direction: Vec<f64>,
}

/// Solves `K x = omega^2 M x` for symmetric `K` and positive `M`: frequencies and vectors of unit
/// modal mass, ascending. Motions without stiffness are left out, slow ones are not: a mode that passes [`SLOWEST`] is to be followed.
fn generalized(stiffness: DMatrix<f64>, mass: DMatrix<f64>) -> Vec<Solution> {
    /// Least stiffness over mass, 1/s2. What rounding leaves is less: air that goes in by one hole and out by the other has no stiffness.
    const LEAST: f64 = 1.0;
    let Some(root) = mass.cholesky() else {
        return Vec::new();
    };
    let l = root.l();
    let half = l.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
    let reduced = l.solve_lower_triangular(&half.transpose()).unwrap_or_else(|| half.transpose());
    let solved = eigen::symmetric(0.5 * (&reduced + reduced.transpose()));
    let transposed = l.transpose();
    (0..solved.values.len())
        .filter(|&k| solved.values[k] > LEAST)
        .map(|k| {
            let direction: DVector<f64> = solved.vectors.column(k).into();
            let x = transposed.solve_upper_triangular(&direction).unwrap_or_else(|| direction.clone());
            Solution {
                omega: solved.values[k].sqrt(),
                vector: x.iter().copied().collect(),
                direction: direction.iter().copied().collect(),
            }
        })
        .collect()
}
