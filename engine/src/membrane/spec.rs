//! What a head is: its size, film, losses, edge and dot.

use serde::{Deserialize, Serialize};

use crate::air_load;
use crate::contact::Material;
use crate::damping::{EdgeSpec, LossLaw};
use crate::error::SpecError;
use crate::fitted;
use crate::math::bessel;
use crate::membrane::dot::{self, Added, AtEdge, DotSpec};
use crate::membrane::mesh::MeshSpec;

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
    /// What is glued to its middle.
    pub dot: Option<DotSpec>,
    /// How it lets air through; `None` of a tight film.
    pub mesh: Option<MeshSpec>,
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

    /// What its dot adds to it, if it has one.
    pub fn added_by_dot(&self) -> Option<Added> {
        let DotSpec { diameter, thickness, loss } = self.dot?;
        let both = MembraneSpec { thickness: self.thickness + thickness, ..*self };
        Some(Added {
            reach: 0.5 * diameter / self.radius,
            density: self.material.density * thickness,
            rigidity: both.flexural_rigidity() - self.flexural_rigidity(),
            stretching: self.material.youngs_modulus * thickness,
            loss,
        })
    }

    /// A mode of the order `m` and the zero `j` at the edge of the dot.
    pub(super) fn at_dot(&self, m: u32, j: f64) -> AtEdge {
        let Some(Added { reach, .. }) = self.added_by_dot() else { return [j, 0.0, 0.0] };
        let norm = air_load::shape_norm(m, bessel::j_prime(m, j));
        let (value, slope) = bessel::j_pair(m, j * reach);
        [j, norm * value, norm * j * slope]
    }

    /// Mass (kg/m2) and flexural rigidity (N m), in the mean over the head, that move in the shape of the order `m` and the zero `j`.
    pub fn moved(&self, m: u32, j: f64) -> (f64, f64) {
        let (film, rigidity) = (self.area_density(), self.flexural_rigidity());
        let Some(dot) = self.added_by_dot() else { return (film, rigidity) };
        let at = self.at_dot(m, j);
        let share = dot::overlap(m, dot.reach, at, at);
        (film + share * dot.density, rigidity + share * dot.rigidity)
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
