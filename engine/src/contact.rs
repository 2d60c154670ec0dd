//! The contact between two bodies: one force law, solved once a sample, exact in energy.
//!
//! Model (Hunt & Crossley 1975, Flores et al. 2011): bodies that overlap by a compression `d`
//! press on each other with
//!
//! ```text
//! F = K d^alpha (1 + lambda d')   for d > 0, else 0; never negative (nothing sticks)
//! ```
//!
//! `K`, `alpha` describe the material and shape (Hertz: 3/2 for solids), `lambda` the loss, chosen
//! when a touch begins so that the relative speed comes back times the restitution `e`:
//! `lambda = r / v_in`, with `r` the non-zero root of `ln((1 + r) / (1 - e r)) = r (1 + e)`, exact for
//! this law and every `alpha` (the first integral of the motion against a rigid wall).
//!
//! Scheme: both bodies are linear in a force held over the sample, so the compression at its end
//! is `d1 = d_free - C F`, with `C` the sum of their one-sample compliances. The force is the
//! discrete gradient of the potential `V = K d^(alpha+1) / (alpha+1)` times the loss factor at the
//! mean speed,
//!
//! ```text
//! F = (V(d1) - V(d0)) / (d1 - d0) * (1 + lambda (d1 - d0) / dt)
//! ```
//!
//! so that without loss the work `F (d1 - d0)` is the change of `V` to rounding, at any rate; with
//! loss it is more when closing and less when opening. `F` grows with `d1`, hence one root.
//!
//! [`force`] computes this for the contacts of a body side by side; [`solver`] finds their compressions.
//!
//! Neglected: adhesion, friction, and the mass of the deformed material.

pub mod force;
pub mod solver;
pub mod static_equilibrium;

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::numbers::{Numbers, Visitor};

/// Slowest approach that still sets the loss, m/s. Below it a touch is as lossy as at it; keeps
/// `lambda` finite. *Derived*: far below any audible landing.
const SLOWEST_APPROACH: f64 = 1e-3;

/// Poisson's ratios of solids, and densities, kg/m3.
const POISSON: RangeInclusive<f64> = 0.0..=0.495;
const DENSITY: RangeInclusive<f64> = 100.0..=25_000.0;

/// Elastic constants of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus, Pa, 1e6 to 1e12.
    #[serde(rename = "youngs_modulus_pa")]
    pub youngs_modulus: f64,
    /// Poisson's ratio, 0 to 0.495.
    pub poisson_ratio: f64,
    /// Density, kg/m3, 100 to 25,000.
    #[serde(rename = "density_kg_m3")]
    pub density: f64,
}

impl Numbers for Material {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("youngs_modulus_pa", &mut self.youngs_modulus, 1e6..=1e12);
        visitor.number("poisson_ratio", &mut self.poisson_ratio, POISSON);
        visitor.number("density_kg_m3", &mut self.density, DENSITY);
    }
}

impl Material {
    /// Shows the numbers of the `material` of a shell or hoop, which bears the pull of a head: 1 GPa at least, as soft as plastics are.
    pub fn visit_bearing(&mut self, visitor: &mut dyn Visitor) {
        visitor.enter("material");
        visitor.number("youngs_modulus_pa", &mut self.youngs_modulus, 1e9..=1e12);
        visitor.number("poisson_ratio", &mut self.poisson_ratio, POISSON);
        visitor.number("density_kg_m3", &mut self.density, DENSITY);
        visitor.leave();
    }

    const fn new(gigapascal: f64, poisson_ratio: f64, density: f64) -> Material {
        Material { youngs_modulus: gigapascal * 1e9, poisson_ratio, density }
    }

    /// Hickory, along the stick. *Literature*, as the others.
    pub const HICKORY: Material = Material::new(15.0, 0.30, 820.0);
    /// Hickory pressed on its side, as an isotropic solid that gives as much. *Derived*: grain carries a small load along,
    /// so that it gives less than its 0.9 to 2 GPa across and more than its 15 GPa along the grain: half-spaces with 0.065 to 0.1 of
    /// the modulus across, and sheared by 0.08 to 0.1 of it (Wood Handbook, ch. 5), have an indentation modulus of 2.7 to 3.5 GPa
    /// (Delafargue & Ulm 2004, across the axis).
    pub const HICKORY_ACROSS: Material = Material::new(2.8, 0.30, 820.0);
    /// Maple along the grain.
    pub const MAPLE: Material = Material::new(11.0, 0.30, 680.0);
    /// Nylon.
    pub const NYLON: Material = Material::new(3.0, 0.39, 1150.0);
    /// Polyester film of drum heads.
    pub const FILM: Material = Material::new(4.5, 0.38, 1390.0);
    /// Hard plastic of beaters.
    pub const PLASTIC: Material = Material::new(2.3, 0.35, 1050.0);
    /// Rubber.
    pub const RUBBER: Material = Material::new(0.01, 0.49, 1100.0);
    /// Steel.
    pub const STEEL: Material = Material::new(200.0, 0.29, 7850.0);
    /// Brass.
    pub const BRASS: Material = Material::new(100.0, 0.34, 8500.0);
    /// Cymbal bronze (B20).
    pub const BRONZE: Material = Material::new(110.0, 0.34, 8600.0);
    /// Glass.
    pub const GLASS: Material = Material::new(70.0, 0.22, 2500.0);

    /// This body's share of `1 / E*`, 1/Pa.
    fn surface_compliance(&self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.youngs_modulus
    }
}

/// How a tip resists being compressed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tip {
    /// A solid sphere; Hertz with the surface it meets.
    Solid {
        /// What it is made of.
        material: Material,
        /// Radius of curvature, m.
        radius: f64,
    },
    /// Felt or yarn, so soft that only it gives: `K d^alpha`.
    Felt {
        /// `K`, N/m^alpha.
        stiffness: f64,
        /// `alpha`.
        exponent: f64,
    },
}

/// The force law of one pair of bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// `K`, N/m^alpha.
    pub stiffness: f64,
    /// `alpha`, dimensionless, at least 1.
    pub exponent: f64,
    /// `lambda v_in`, dimensionless, from the restitution; 0 is lossless.
    pub loss: f64,
}

impl ContactLaw {
    /// The law of a tip on a surface, with the ratio `e` of leaving to arriving speed in 0.01 to 1 (clamped).
    pub fn new(tip: &Tip, surface: &Material, restitution: f64) -> ContactLaw {
        let loss = loss_of_restitution(restitution);
        match *tip {
            Tip::Solid { material, radius } => {
                let effective = 1.0 / (material.surface_compliance() + surface.surface_compliance());
                ContactLaw { stiffness: 4.0 / 3.0 * effective * radius.sqrt(), exponent: 1.5, loss }
            }
            Tip::Felt { stiffness, exponent } => ContactLaw { stiffness, exponent, loss },
        }
    }

    /// `lambda` (s/m) of a touch that begins at the closing speed `approach` (m/s).
    pub fn lambda(&self, approach: f64) -> f64 {
        self.loss / approach.max(SLOWEST_APPROACH)
    }

    /// Energy held at compression `d`, J.
    pub fn potential(&self, d: f64) -> f64 {
        if d > 0.0 { self.stiffness * self.power(d) * d / (self.exponent + 1.0) } else { 0.0 }
    }

    /// Static force at compression `d`, N, and its slope, N/m.
    pub fn elastic(&self, d: f64) -> (f64, f64) {
        if d <= 0.0 {
            return (0.0, 0.0);
        }
        let force = self.stiffness * self.power(d);
        (force, self.exponent * force / d)
    }

    /// `d^alpha`; the Hertz exponent without the general power.
    fn power(&self, d: f64) -> f64 {
        if self.exponent == 1.5 { d * d.sqrt() } else { d.powf(self.exponent) }
    }
}

/// What one sample's contact is solved from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactStep {
    /// Compression at the start of the sample, m; negative: a gap.
    pub before: f64,
    /// Compression at its end if no force acted, m.
    pub free: f64,
    /// How much a force held over the sample opens the bodies by its end, m/N.
    pub compliance: f64,
    /// Loss of this touch, s/m.
    pub lambda: f64,
    /// Length of the sample, s.
    pub dt: f64,
}

/// The non-zero root `r` of `ln((1 + r) / (1 - e r)) = r (1 + e)`; 0 for `e = 1`. Both are ratios.
pub fn loss_of_restitution(restitution: f64) -> f64 {
    let e = restitution.clamp(0.01, 1.0);
    if e > 1.0 - 1e-9 {
        return 0.0;
    }
    // Negative just above 0 (it starts as -(1 - e^2) r^2 / 2), without bound at 1/e: one root.
    let g = |r: f64| r.ln_1p() - (-e * r).ln_1p() - r * (1.0 + e);
    let (mut low, mut high) = (1e-12, 1.0 / e);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        if g(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests;
