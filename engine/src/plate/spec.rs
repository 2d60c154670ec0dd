//! What a cymbal's plate is made of, and the numbers that follow from it.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::air_load;
use crate::error::SpecError;

/// A cymbal's plate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlateSpec {
    /// Diameter, m, 0.1 to 0.8.
    pub diameter: f64,
    /// Mass, kg, up to 20: that of a plate from 0.4 mm to a hundredth of the diameter thick.
    pub mass: f64,
    /// Rise of the bow's centre over its rim, without a bell, m, 0 (flat) to a quarter of the diameter.
    pub rise: f64,
    /// What rises over the bow in the middle, if anything does.
    pub bell: Option<Bell>,
    /// What turns up toward the rim, if anything does.
    pub flange: Option<Flange>,
    /// Thickness at the rim over that in the middle, 0.3 to 1 (as thick everywhere).
    pub taper: f64,
    /// Young's modulus, Pa, 1e9 to 1e12.
    pub youngs_modulus: f64,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson_ratio: f64,
    /// Density, kg/m3, 500 to 25000.
    pub density: f64,
}

/// A cymbal's bell: a hump about the middle, `rise (1 - (r / radius)^2)^3`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bell {
    /// Where it meets the bow, m, a twentieth to half of the plate's radius.
    #[serde(rename = "radius_m")]
    pub radius: f64,
    /// Rise over the bow, m, 0 to its radius.
    #[serde(rename = "rise_m")]
    pub rise: f64,
}

impl Bell {
    /// Rise over radius at most. *Derived*: its steepest slope, `1.72 rise / radius`, is 1 there; shells are taken as shallow. Real bells
    /// have a third.
    pub const HIGHEST: f64 = 0.58;

    /// Its slope over the bow at a distance from the middle, m; dimensionless.
    pub fn slope(&self, at: f64) -> f64 {
        let s = at / self.radius;
        6.0 * self.rise / self.radius * s * (1.0 - s * s).max(0.0).powi(2)
    }
}

/// A china's upturned rim: outside of `radius` it rises over the bow by `rise s^3`, `s` from 0 there to 1 at the rim.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flange {
    /// Where it begins, m, half to 0.95 of the plate's radius.
    #[serde(rename = "radius_m")]
    pub radius: f64,
    /// Rise of the rim over the bow as it would go on, m, 0 to a quarter of the plate's radius.
    #[serde(rename = "rise_m")]
    pub rise: f64,
}

impl PlateSpec {
    /// Thinnest plate, m: half of what thin splash cymbals are in the mean. Struck hard, thinner ones bend by so many
    /// times their thickness that the energy is not kept (`docs/limits.md`).
    pub const THINNEST: f64 = 4e-4;
    /// Thickest plate over its diameter: thicker than a fiftieth of its radius, a plate's upper modes shear (Mindlin).
    pub const THICKEST: f64 = 0.01;
    /// Heaviest plate, kg.
    pub const HEAVIEST: f64 = 20.0;

    /// Whether it is a cap as thick everywhere.
    pub fn is_even(&self) -> bool {
        self.bell.is_none() && self.flange.is_none() && self.taper == 1.0
    }

    /// Checks every field, and that the plate they make is thin.
    ///
    /// # Errors
    /// [`SpecError`] naming the first field out of range.
    pub fn check(&self) -> Result<(), SpecError> {
        SpecError::check("plate diameter (m)", self.diameter, 0.1, 0.8)?;
        SpecError::check("plate mass (kg)", self.mass, 0.0, Self::HEAVIEST)?;
        SpecError::check("plate rise (m)", self.rise, 0.0, 0.25 * self.diameter)?;
        if let Some(bell) = self.bell {
            let radius = self.radius();
            SpecError::check("bell radius (m)", bell.radius, 0.05 * radius, 0.5 * radius)?;
            SpecError::check("bell rise (m)", bell.rise, 0.0, Bell::HIGHEST * bell.radius)?;
        }
        if let Some(flange) = self.flange {
            let radius = self.radius();
            SpecError::check("flange radius (m)", flange.radius, 0.5 * radius, 0.95 * radius)?;
            SpecError::check("flange rise (m)", flange.rise, 0.0, 0.25 * radius)?;
        }
        SpecError::check("taper", self.taper, 0.3, 1.0)?;
        SpecError::check("Young's modulus (Pa)", self.youngs_modulus, 1e9, 1e12)?;
        SpecError::check("Poisson's ratio", self.poisson_ratio, 0.0, 0.49)?;
        SpecError::check("plate density (kg/m3)", self.density, 500.0, 25_000.0)?;
        // From a thickness to a mass and back, a rounding is lost.
        let (thinnest, thickest, slack) = (Self::THINNEST, Self::THICKEST * self.diameter, 1.0 + 1e-12);
        SpecError::check(
            "plate thickness by mass (m)",
            self.thickness(),
            thinnest / slack,
            thickest * slack,
        )?;
        Ok(())
    }

    /// Radius, m.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Thickness, m, from the mass; its mean over the area if it has a taper.
    pub fn thickness(&self) -> f64 {
        self.mass / (self.density * PI * self.radius().powi(2))
    }

    /// Thickness at the share `r` of the radius over the mean: it falls straight toward the rim.
    pub fn relative_thickness(&self, r: f64) -> f64 {
        let lost = 1.0 - self.taper;
        (1.0 - lost * r) / (1.0 - 2.0 / 3.0 * lost)
    }

    /// Curvatures along the radius and around, 1/m, at the share `r` of the radius: `w0''` and `w0'/r` of the profile.
    pub fn curvatures(&self, r: f64) -> [f64; 2] {
        let mut sum = [self.curvature(); 2];
        let at = r * self.radius();
        if let Some(bell) = self.bell {
            let s = (at / bell.radius).powi(2);
            let edge = (1.0 - s).max(0.0);
            let unit = 6.0 * bell.rise / bell.radius.powi(2) * edge;
            sum[0] += unit * (1.0 - 5.0 * s);
            sum[1] += unit * edge;
        }
        if let Some(flange) = self.flange.filter(|flange| at > flange.radius) {
            let width = self.radius() - flange.radius;
            let s = (at - flange.radius) / width;
            sum[0] -= 6.0 * flange.rise * s / (width * width);
            sum[1] -= 3.0 * flange.rise * s * s / (width * at);
        }
        sum
    }

    /// Height over the bow's rim at the share `r` of the radius, m.
    pub fn height(&self, r: f64) -> f64 {
        let hump = |bell: Bell| {
            let s = (r * self.radius() / bell.radius).powi(2);
            bell.rise * (1.0 - s).max(0.0).powi(3)
        };
        let turned = |flange: Flange| {
            let s = (r * self.radius() - flange.radius) / (self.radius() - flange.radius);
            flange.rise * s.max(0.0).powi(3)
        };
        self.rise * (1.0 - r * r) + self.bell.map_or(0.0, hump) + self.flange.map_or(0.0, turned)
    }

    /// Flexural rigidity D = E h^3 / (12 (1 - nu^2)) where it is as thick as in the mean, N m.
    pub fn flexural_rigidity(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.youngs_modulus * self.thickness().powi(3) / (12.0 * (1.0 - nu * nu))
    }

    /// Angular frequency from which its waves are as fast as sound and faster, `c^2 sqrt(s / D)`, where it is as thick as in the
    /// mean, rad/s.
    pub fn coincidence(&self) -> f64 {
        let area_density = self.density * self.thickness();
        air_load::SPEED_OF_SOUND.powi(2) * (area_density / self.flexural_rigidity()).sqrt()
    }

    /// Curvature 1 / R of the bow, a cap, 1/m; R = (a^2 + H^2) / (2 H).
    pub fn curvature(&self) -> f64 {
        let (a, rise) = (self.radius(), self.rise);
        2.0 * rise / (a * a + rise * rise)
    }

    /// Ring frequency sqrt(E / rho) / R, rad/s: where a shell begins to bend as a plate.
    pub fn ring_omega(&self) -> f64 {
        (self.youngs_modulus / self.density).sqrt() * self.curvature()
    }

    /// Frequency of the flat plate at wave number 1, rad/s; a mode's is its root squared times this.
    pub fn flat_omega(&self) -> f64 {
        let area_density = self.density * self.thickness();
        (self.flexural_rigidity() / area_density).sqrt() / self.radius().powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;
    use crate::reference;

    #[test]
    fn a_plate_that_cannot_be_is_refused_by_name() {
        let crash = reference::cap_crash();
        let refused = |spec: PlateSpec| spec.check().unwrap_err().to_string();
        assert!(refused(PlateSpec { rise: 0.3, ..crash }).starts_with("plate rise (m) is 0.3"));
        assert!(refused(PlateSpec { diameter: f64::NAN, ..crash }).contains("diameter"));
        assert!(refused(PlateSpec { mass: 15.0, ..crash }).contains("thickness"));
    }

    #[test]
    fn a_taper_leaves_the_mass_and_curvatures_are_those_of_the_profile() {
        let bell = Some(Bell { radius: 0.06, rise: 0.02 });
        let flange = Some(Flange { radius: 0.15, rise: 0.02 });
        let spec = PlateSpec { rise: 0.010, bell, flange, taper: 0.5, ..reference::cap_crash() };
        let rule = GaussLegendre::unit(20);
        let mean = rule.integrate(|r| 2.0 * r * spec.relative_thickness(r));
        assert!((mean - 1.0).abs() < 1e-12, "{mean}");
        let depth = |x: f64| -spec.height(x / spec.radius());
        for x in [0.01, 0.03, 0.05, 0.08, 0.19] {
            let step = 1e-5;
            let slope = (depth(x + step) - depth(x - step)) / (2.0 * step);
            let second = (depth(x + step) - 2.0 * depth(x) + depth(x - step)) / (step * step);
            let [radial, around] = spec.curvatures(x / spec.radius());
            // A cap's radius counts its rise, which a parabola does not: half a percent.
            assert!((radial - second).abs() < 5e-3 * second.abs() + 1e-3, "{x}: {radial} {second}");
            assert!(
                (around - slope / x).abs() < 5e-3 * slope.abs() / x + 1e-3,
                "{x}: {around} {}",
                slope / x
            );
        }
    }

    #[test]
    fn every_reference_cap_can_be() {
        for spec in [reference::cap_crash(), reference::cap_ride(), reference::cap_splash()] {
            assert_eq!(spec.check(), Ok(()));
        }
    }
}
