//! A drumstick as a beam: how it bends behind its tip.
//!
//! Model: a free Timoshenko beam of a stick's profile: an oval bead, a neck that tapers into the shaft, a round shaft. Wood is soft
//! in shear, so that high modes lie far lower than those of a beam that only bends. Modes are of unit mean square over the
//! mass. They are found by finite elements, linear in deflection and rotation, sheared evenly within an element.
//!
//! A tip on a stiff surface feels, for the first hundredths of a millisecond, no more than the bead's mass; the shaft follows by
//! the neck. What has gone into bending does not come back in time for the rebound.
//!
//! The mass that a tip feels when nothing bends is given: 16 g, of which the stick itself has ten and the hand the rest. Neglected: how the
//! hand turns the stick, and that it holds what bends.
//!
//! Source: Cowper, The shear coefficient in Timoshenko's beam theory, 1966; Wood Handbook (USDA), ch. 5.

use std::convert::Infallible;
use std::f64::consts::PI;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::cache::{Cache, Shared};
use crate::contact::Material;
use crate::fitted;
use crate::math::eigen;
use crate::schema::SCHEMA;

/// Bending modes carried: to 8.7 kHz. *Converged*: the tip then feels 0.53 g at once, with all others 0.45.
pub const BENDING: usize = 10;

/// Elements along the stick. *Converged*: twice as many move the carried modes by 0.3 %.
const ELEMENTS: usize = 64;

/// Modulus of shear over that along the grain. *Literature*: hardwoods 0.06 to 0.09 (Wood Handbook).
const SHEAR: f64 = 0.07;

/// Share of a round section that carries shear. *Literature*: Cowper.
const SHEARED: f64 = 0.9;

/// A stick and where along it something touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stick {
    /// Length, m.
    pub length: f64,
    /// Radius, m.
    pub radius: f64,
    /// What it is made of.
    pub material: Material,
    /// Quality factor of its bending in a hand. *By ear*.
    pub q: f64,
    /// Where it touches, share of the length from the tip.
    pub place: f64,
    /// How thick it is.
    pub profile: Profile,
}

/// One way to bend.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BendingMode {
    /// rad/s.
    pub omega: f64,
    /// Deflection at the nodes, from the tip on; one more than [`ELEMENTS`].
    shape: Vec<f64>,
}

/// What the profile's elements are.
struct Element {
    /// m2, m4.
    area: f64,
    moment: f64,
}

/// A stick as a rigid rod.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rod {
    /// Mass, kg.
    pub mass: f64,
    /// Its centre and the radius of gyration about it, shares of the length.
    pub centre: f64,
    /// See `centre`, a share of the length.
    pub gyration: f64,
}

/// A stick as what it does when it strikes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Beam {
    /// Where nothing bends.
    pub rod: Rod,
    /// How it bends, lowest first, each mode of the rod's mass; at most [`BENDING`].
    pub bending: Vec<BendingMode>,
}

/// How thick a stick is along its length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Profile {
    /// A bead, a neck, a taper, a shaft.
    Turned,
    /// A round rod, of which two modes are carried: as published contacts have it.
    Even,
}

/// What has been worked out.
static BEAMS: Cache<Beam> = Cache::new("stick", SCHEMA, 2);

/// The stick of every profile as a beam.
pub struct Beams {
    turned: Shared<Beam>,
    even: Shared<Beam>,
}

impl Beams {
    /// Allocates; the first time it solves for the modes.
    pub fn prepare() -> Beams {
        Beams { turned: Stick::at(Stick::BEAD).beam(), even: Stick::at(Stick::BEAD).even().beam() }
    }

    /// That of a stick.
    pub fn of(&self, stick: &Stick) -> &Beam {
        match stick.profile {
            Profile::Turned => &self.turned,
            Profile::Even => &self.even,
        }
    }
}

impl Stick {
    /// The bead, and the shoulder, shares of the length.
    pub const BEAD: f64 = 0.01;
    /// Where the taper ends, a share of the length.
    pub const SHOULDER: f64 = 0.12;

    /// A shaft on a steel edge: radius of curvature, m, and restitution.
    pub const SHAFT: (f64, f64) = (0.007, 0.6);

    /// A hickory stick of the usual size (5A to 5B) that touches at `place`, a share of the length from the tip.
    pub const fn at(place: f64) -> Stick {
        Stick {
            length: 0.406,
            radius: 0.00735,
            material: Material::HICKORY,
            q: fitted::STICK_Q,
            place,
            profile: Profile::Turned,
        }
    }

    /// The same as a round rod.
    pub const fn even(self) -> Stick {
        Stick { profile: Profile::Even, ..self }
    }

    /// Its radius at a distance (m) from the tip, m. *Trade sizes*: an acorn 11.5 mm long and 9.6 mm thick, a neck of 6 mm, a taper of
    /// three inches.
    pub fn radius_at(&self, x: f64) -> f64 {
        const BEAD: f64 = 0.0115;
        const NECK: f64 = 0.003;
        const TAPERED: f64 = 0.088;
        if self.profile == Profile::Even {
            self.radius
        } else if x < BEAD {
            let oval = 1.0 - ((x - 0.0058) / 0.0062).powi(2);
            (0.0048 * oval.max(0.0).sqrt()).max(NECK)
        } else {
            let along = ((x - BEAD) / (TAPERED - BEAD)).min(1.0);
            NECK + (self.radius - NECK) * along
        }
    }

    /// The elements of the profile.
    fn elements(&self) -> impl Iterator<Item = Element> {
        // Gauss's three points.
        const POINTS: [(f64, f64); 3] = [(0.112_701_665, 5.0), (0.5, 8.0), (0.887_298_335, 5.0)];
        let step = self.length / ELEMENTS as f64;
        (0..ELEMENTS).map(move |element| {
            let mean = |of: &dyn Fn(f64) -> f64| {
                let at = |&(place, weight): &(f64, f64)| {
                    weight / 18.0 * of(self.radius_at((element as f64 + place) * step))
                };
                POINTS.iter().map(at).sum::<f64>()
            };
            Element { area: mean(&|r| PI * r * r), moment: mean(&|r| PI * r.powi(4) / 4.0) }
        })
    }

    /// It as a rigid rod.
    fn rod(&self) -> Rod {
        let middle = |element: usize| (element as f64 + 0.5) / ELEMENTS as f64;
        let sum = |of: &dyn Fn(f64) -> f64| {
            let elements = self.elements().enumerate();
            elements.map(|(i, element)| element.area * of(middle(i))).sum::<f64>()
        };
        let all = sum(&|_| 1.0);
        let centre = sum(&|x| x) / all;
        Rod {
            mass: self.material.density * self.length / ELEMENTS as f64 * all,
            centre,
            gyration: (sum(&|x| (x - centre).powi(2)) / all).sqrt(),
        }
    }

    /// It as what strikes. Allocates.
    pub fn beam(&self) -> Shared<Beam> {
        let modes = match self.profile {
            Profile::Turned => BENDING,
            Profile::Even => 2,
        };
        let make = || Ok::<_, Infallible>(Beam { rod: self.rod(), bending: self.bent(modes) });
        let Material { youngs_modulus, density, .. } = self.material;
        BEAMS
            .get(&(self.length, self.radius, youngs_modulus, density, self.profile), make)
            .unwrap_or_else(|never| match never {})
    }

    /// Solves for the modes. Allocates.
    fn bent(&self, modes: usize) -> Vec<BendingMode> {
        const FREEDOMS: usize = 2 * (ELEMENTS + 1);
        let step = self.length / ELEMENTS as f64;
        let modulus = self.material.youngs_modulus;
        let mut stiffness: DMatrix<f64> = DMatrix::zeros(FREEDOMS, FREEDOMS);
        let mut masses = [0.0; FREEDOMS];
        for (element, Element { area, moment }) in self.elements().enumerate() {
            let rows = [([0.0, -1.0, 0.0, 1.0], modulus * moment / step), {
                let sheared = [-1.0 / step, -0.5, 1.0 / step, -0.5];
                (sheared, SHEARED * SHEAR * modulus * area * step)
            }];
            let first = 2 * element;
            for (row, factor) in rows {
                for i in 0..4 {
                    masses[first + i] +=
                        0.25 * self.material.density * step * if i % 2 == 0 { area } else { moment };
                    for j in 0..4 {
                        stiffness[(first + i, first + j)] += factor * row[i] * row[j];
                    }
                }
            }
        }
        let scales = masses.map(|mass| mass.sqrt().recip());
        let scaled = DMatrix::from_fn(FREEDOMS, FREEDOMS, |i, j| scales[i] * stiffness[(i, j)] * scales[j]);
        let solved = eigen::symmetric(scaled);
        let unit = self.rod().mass.sqrt();
        // The first two are motions of the stick as a whole.
        (2..2 + modes)
            .map(|mode| BendingMode {
                omega: solved.values[mode].sqrt(),
                shape: (0..=ELEMENTS)
                    .map(|node| unit * scales[2 * node] * solved.vectors[(2 * node, mode)])
                    .collect(),
            })
            .collect()
    }
}

impl Rod {
    /// How much of its turning, of unit mean square, a place (share of the length from the tip) moves.
    pub fn turning(&self, place: f64) -> f64 {
        (self.centre - place) / self.gyration
    }
}

impl BendingMode {
    /// Shape at a place (share of the length from the tip).
    pub fn shape(&self, place: f64) -> f64 {
        let at = place.clamp(0.0, 1.0) * ELEMENTS as f64;
        let from = (at as usize).min(ELEMENTS - 1);
        self.shape[from] + (at - from as f64) * (self.shape[from + 1] - self.shape[from])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn shapes_are_of_unit_mean_square_over_the_mass_and_orthogonal_to_motions_as_a_whole() {
        let stick = Stick::at(Stick::BEAD);
        let mass: Vec<f64> = stick.elements().map(|element| element.area).collect();
        let total: f64 = mass.iter().sum();
        for mode in &stick.beam().bending {
            let mean = |of: &dyn Fn(f64) -> f64| {
                let ends = |i: usize| 0.5 * (of(mode.shape[i]) + of(mode.shape[i + 1]));
                mass.iter().enumerate().map(|(i, mass)| mass * ends(i)).sum::<f64>() / total
            };
            // The rest is the sections' turning.
            let square = mean(&|w| w * w);
            assert!((0.75..1.0).contains(&square), "{square}");
            assert!(mean(&|w| w).abs() < 1e-9);
        }
    }

    #[test]
    fn slender_rods_ring_as_beams_that_only_bend() {
        // Euler's and Bernoulli's free beam: `omega = beta^2 r / 2 sqrt(E / rho) / L^2`.
        let rod = Stick { radius: 0.001, ..Stick::at(Stick::BEAD).even() };
        let speed = (rod.material.youngs_modulus / rod.material.density).sqrt();
        let unit = 0.5 * rod.radius * speed / (rod.length * rod.length);
        for (mode, beta) in rod.bent(3).iter().zip([4.730_041_f64, 7.853_205, 10.995_608]) {
            let ratio = mode.omega / (beta * beta * unit);
            assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
        }
    }

    #[test]
    fn a_stick_rings_where_published_ones_do() {
        // Sticks of this size: 300 to 450 Hz and 2.4 to 2.8 times that.
        let [first, second] = [0, 1].map(|mode| Stick::at(Stick::BEAD).beam().bending[mode].omega / TAU);
        assert!((300.0..450.0).contains(&first), "{first}");
        assert!((2.4..2.8).contains(&(second / first)), "{second}");
        let mass = Stick::at(Stick::BEAD).beam().rod.mass;
        assert!((0.045..0.06).contains(&mass), "{mass}");
    }

    #[test]
    fn the_tip_of_a_stick_by_itself_feels_a_fifth_of_its_mass_in_flight_and_about_a_hand() {
        let rod = Stick::at(Stick::BEAD).beam().rod;
        let Rod { mass, centre, gyration } = rod;
        let tip = Stick::BEAD;
        let in_flight = mass / (1.0 + rod.turning(tip).powi(2));
        // About a pivot: `(I + M p^2) / d^2`.
        let pivot = 2.0 / 3.0;
        let about = mass * (gyration.powi(2) + (pivot - centre).powi(2)) / (pivot - tip).powi(2);
        for felt in [in_flight, about] {
            assert!((0.008..0.012).contains(&felt), "{felt} kg");
        }
    }
}
