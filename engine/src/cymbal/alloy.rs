//! Metals that cymbals are made of: how stiff and heavy, how they conduct heat, how much they lose inside.
//!
//! Brass rings shorter and darker than bronze for two reasons: heat flows through it more than twice as fast, and it has
//! several times the internal friction.

use serde::{Deserialize, Serialize};

use crate::contact::Material;
use crate::damping::Heat;
use crate::fitted;
use crate::numbers::{Numbers, Visitor};

/// A metal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Alloy {
    /// Young's modulus, Pa, 1e9 to 1e12.
    #[serde(rename = "youngs_modulus_pa")]
    pub youngs_modulus: f64,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson_ratio: f64,
    /// Density, kg/m3, 500 to 25,000.
    #[serde(rename = "density_kg_m3")]
    pub density: f64,
    /// Loss factor by internal friction, 0 to 0.05: energy lost in a radian over the energy there, alike at all frequencies.
    /// None in files older than this field, whose `loss` has it.
    #[serde(default)]
    pub loss_factor: f64,
    /// Linear expansion, dimensionless for each kelvin (1/K), 0 to 1e-4.
    #[serde(rename = "expansion_1_k", default = "bronze_expansion")]
    pub expansion: f64,
    /// Heat capacity by mass, J/(kg K), 50 to 5000.
    #[serde(rename = "heat_capacity_j_kg_k", default = "bronze_capacity")]
    pub heat_capacity: f64,
    /// Thermal conductivity, W/(m K), 0.1 to 1000.
    #[serde(rename = "conductivity_w_m_k", default = "bronze_conductivity")]
    pub conductivity: f64,
}

fn bronze_expansion() -> f64 {
    Alloy::BRONZE.expansion
}

fn bronze_capacity() -> f64 {
    Alloy::BRONZE.heat_capacity
}

fn bronze_conductivity() -> f64 {
    Alloy::BRONZE.conductivity
}

impl Numbers for Alloy {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("youngs_modulus_pa", &mut self.youngs_modulus, 1e9..=1e12);
        visitor.number("poisson_ratio", &mut self.poisson_ratio, 0.0..=0.49);
        visitor.number("density_kg_m3", &mut self.density, 500.0..=25_000.0);
        visitor.number("loss_factor", &mut self.loss_factor, 0.0..=0.05);
        visitor.number("expansion_1_k", &mut self.expansion, 0.0..=1e-4);
        visitor.number("heat_capacity_j_kg_k", &mut self.heat_capacity, 50.0..=5000.0);
        visitor.number("conductivity_w_m_k", &mut self.conductivity, 0.1..=1000.0);
    }
}

impl Alloy {
    /// Cymbal bronze (B20). *Literature*, but for its loss factor, which is *fitted*.
    pub const BRONZE: Alloy = Alloy {
        youngs_modulus: Material::BRONZE.youngs_modulus,
        poisson_ratio: Material::BRONZE.poisson_ratio,
        density: Material::BRONZE.density,
        loss_factor: fitted::BRONZE_LOSS_FACTOR,
        expansion: 17.5e-6,
        heat_capacity: 380.0,
        conductivity: 52.0,
    };

    /// Its elastic constants.
    pub fn material(&self) -> Material {
        Material {
            youngs_modulus: self.youngs_modulus,
            poisson_ratio: self.poisson_ratio,
            density: self.density,
        }
    }

    /// How it warms, expands and conducts.
    pub fn heat(&self) -> Heat {
        Heat {
            expansion: self.expansion,
            by_volume: self.density * self.heat_capacity,
            conductivity: self.conductivity,
        }
    }

    /// Decay rate by internal friction at `omega` rad/s, 1/s.
    pub fn friction(&self, omega: f64) -> f64 {
        0.5 * self.loss_factor * omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_loss_factor_is_what_is_lost_in_a_radian() {
        let alloy = Alloy { loss_factor: 1e-3, ..Alloy::BRONZE };
        let (omega, radian) = (TAU * 1000.0, 1.0 / (TAU * 1000.0));
        // Energy falls twice as fast as the amplitude.
        let lost = 1.0 - (-2.0 * alloy.friction(omega) * radian).exp();
        assert!((lost - 1e-3).abs() < 1e-6, "{lost}");
    }
}
