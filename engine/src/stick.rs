//! A drumstick as a beam: how it bends behind its tip.
//!
//! Model: a free, uniform, round Euler-Bernoulli beam. Its modes have the shapes
//!
//! ```text
//! phi(x) = cosh(beta x) + cos(beta x) - s (sinh(beta x) + sin(beta x)),   omega = beta^2 r / 2 sqrt(E / rho) / L^2
//! ```
//!
//! of unit mean square, 2 at the ends, with `x` the place along the length, 0 at the tip. A tip on a stiff
//! surface so feels, for the first tenths of a millisecond, much less than the mass it arrives with, and what has
//! gone into bending does not come back in time for the rebound.
//!
//! Neglected: the taper, and how the hand turns the stick: the mass that the tip feels is given.
//!
//! Source: Fletcher & Rossing, The Physics of Musical Instruments, sec. 2.14.

use crate::contact::Material;
use crate::fitted;

/// Bending modes carried.
pub const BENDING: usize = 2;

/// Roots and shape factors of the free beam.
const ROOTS: [(f64, f64); BENDING] = [(4.730_040_745, 0.982_502_215), (7.853_204_624, 1.000_777_312)];

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
}

/// One way to bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendingMode {
    /// rad/s.
    pub omega: f64,
    beta: f64,
    factor: f64,
}

impl Stick {
    /// The bead, and the shoulder, shares of the length.
    pub const BEAD: f64 = 0.01;
    /// Where the taper ends, a share of the length.
    pub const SHOULDER: f64 = 0.12;

    /// A shaft on a steel edge: radius of curvature, m, and restitution.
    pub const SHAFT: (f64, f64) = (0.007, 0.6);

    /// How much of a rigid rod's turning (of unit mean square) its place moves.
    pub fn turning(place: f64) -> f64 {
        3.0_f64.sqrt() * (1.0 - 2.0 * place)
    }

    /// A hickory stick of the usual size (5A to 5B) that touches at `place`, a share of the length from the tip.
    pub const fn at(place: f64) -> Stick {
        Stick { length: 0.406, radius: 0.00735, material: Material::HICKORY, q: fitted::STICK_Q, place }
    }

    /// Mass, kg.
    pub fn mass(&self) -> f64 {
        self.material.density * std::f64::consts::PI * self.radius * self.radius * self.length
    }

    /// Its modes, lowest first.
    pub fn bending(&self) -> impl Iterator<Item = BendingMode> {
        let speed = (self.material.youngs_modulus / self.material.density).sqrt();
        let unit = 0.5 * self.radius * speed / (self.length * self.length);
        ROOTS.into_iter().map(move |(beta, factor)| BendingMode { omega: beta * beta * unit, beta, factor })
    }
}

impl BendingMode {
    /// Shape at a place (share of the length from the tip).
    pub fn shape(&self, place: f64) -> f64 {
        let x = self.beta * place;
        x.cosh() + x.cos() - self.factor * (x.sinh() + x.sin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_of_unit_mean_square_and_frequencies_those_of_a_free_beam() {
        let stick = Stick::at(Stick::BEAD);
        let modes: Vec<BendingMode> = stick.bending().collect();
        let hz = modes[0].omega / std::f64::consts::TAU;
        assert!((300.0..400.0).contains(&hz), "{hz}");
        assert!((modes[1].omega / modes[0].omega - 2.756).abs() < 1e-3);
        for mode in modes {
            let square: f64 =
                (0..2000).map(|i| mode.shape((f64::from(i) + 0.5) / 2000.0).powi(2)).sum::<f64>() / 2000.0;
            assert!((square - 1.0).abs() < 1e-4, "{square}");
            assert!((mode.shape(0.0) - 2.0).abs() < 1e-9);
        }
    }
}
