//! How a head misses being evenly stretched: a field of relative tension over its area.
//!
//! Model: the tension is `T (1 + tau)` with a random field `tau` of mean square `rms^2`, whose components fall with
//! their wavenumber `kappa` as `exp(-(kappa l)^2 / 4)` (in amplitude), `l` the correlation length. The field is a sum of
//! the shapes `chi = J_l(kappa r) cos/sin(l theta)` whose slope is zero at the rim, so that it may be uneven there, where the lugs
//! pull. An even part is removed so that the mode `(0, 1)` keeps its pitch: that is what a drummer tunes.
//!
//! Matrix elements: for two shapes of a clamped head with wavenumbers `k_i`, `k_j`,
//!
//! ```text
//! int tau grad(i) grad(j) dA = 1/2 int [tau (k_i^2 + k_j^2) + laplace(tau)] i j dA
//! ```
//!
//! exactly, by Green's identity, since both shapes are zero at the rim; and `laplace(chi) = -kappa^2 chi`.
//!
//! Limits: a field of wave speed, not a state of stress in equilibrium: it stands for uneven film as well. The film's own
//! stiffness and the air stay even.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 5 (perturbed membranes); Worland, J. Acoust. Soc. Am. 127, 2010
//! (drum heads of uneven tension).

use serde::{Deserialize, Serialize};

use crate::drum::lugs::{self, LugsSpec};
use crate::math::bessel;
use crate::membrane::MembraneSpec;
use crate::numbers::{Numbers, Visitor};
use crate::random_field::{self, Along, Component};
use crate::rim::HoopSpec;

/// How uneven the tension of a drum's heads is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TensionFieldSpec {
    /// Root mean square of the relative tension over the head, 0 to 0.2.
    pub rms: f64,
    /// Correlation length, share of the radius, 0.1 to 2.
    pub correlation: f64,
    /// Tells the unevenness of one drum from another's.
    pub seed: u32,
}

impl Numbers for TensionFieldSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("rms", &mut self.rms, 0.0..=0.2);
        visitor.number("correlation", &mut self.correlation, 0.1..=2.0);
    }
}

/// All that stretches the heads of a drum unevenly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Unevenness {
    /// What is drawn over the area, if anything is.
    pub field: Option<TensionFieldSpec>,
    /// Lugs and the hoop that they pull down, if they are counted.
    pub lugs: Option<(LugsSpec, HoopSpec)>,
}

/// Modes are mixed from so many times the pitch on, in the middle of the range of pitches, dimensionless. *Judgement*: below, a head has so few modes
/// that they lie far apart and only the two of a pair meet, which are [split](crate::split) instead.
pub const MIXED_FROM: f64 = 2.2;

/// The field along the radius, for one number of periods around.
#[derive(Debug, Clone)]
pub struct Harmonic {
    /// Relative tension.
    pub tension: Along,
    /// Its negative Laplacian times the squared radius of the head, dimensionless.
    pub curvature: Along,
}

/// The field at given radii, by its number of periods around.
#[derive(Debug, Clone)]
pub struct TensionField {
    /// `[periods around]`.
    pub harmonics: Vec<Harmonic>,
}

impl Unevenness {
    /// Length over which the field changes, share of the radius.
    pub fn correlation(&self) -> f64 {
        let field = self.field.map_or(f64::INFINITY, |field| field.correlation);
        // `r^l` falls to a seventh within `2 / l` of the rim.
        self.lugs.map_or(field, |(lugs, _)| field.min(1.0 / f64::from(lugs.count)))
    }
}

impl TensionField {
    /// Draws the field of one head (`head` tells the heads of a drum apart) at radii (shares of the head's) with weights (dimensionless) such that
    /// `sum weight f = int f 2 r dr`. Allocates.
    pub fn new(spec: &TensionFieldSpec, head: u32, radii: &[f64], weights: &[f64]) -> TensionField {
        let mut components = random_field::components(spec.rms, spec.correlation, spec.seed, head);
        components.push(Component { l: 0, kappa: 0.0, parts: [-pull(&components, radii, weights), 0.0] });
        let fields = random_field::harmonics(&components, radii, |component| [1.0, component.kappa.powi(2)]);
        let harmonics =
            fields.into_iter().map(|[tension, curvature]| Harmonic { tension, curvature }).collect();
        TensionField { harmonics }
    }

    /// The field of one head of a drum: as drawn, and what its lugs leave. Allocates.
    pub fn of_head(
        uneven: &Unevenness,
        film: &MembraneSpec,
        head: u32,
        radii: &[f64],
        weights: &[f64],
    ) -> TensionField {
        let mut field = match &uneven.field {
            Some(spec) => TensionField::new(spec, head, radii, weights),
            None => TensionField { harmonics: Vec::new() },
        };
        if let Some((lugs, hoop)) = &uneven.lugs {
            field.add_harmonic(&lugs::rim_tension(lugs, hoop, film, head), radii);
        }
        field
    }

    /// Adds a tension that is harmonic inside, of which the parts at the rim are given by the periods around.
    fn add_harmonic(&mut self, rim: &[[f64; 2]], radii: &[f64]) {
        let empty = || [vec![0.0; radii.len()], vec![0.0; radii.len()]];
        let orders = self.harmonics.len().max(rim.len());
        self.harmonics.resize_with(orders, || Harmonic { tension: empty(), curvature: empty() });
        for ((l, parts), harmonic) in rim.iter().enumerate().zip(&mut self.harmonics) {
            for (along, part) in harmonic.tension.iter_mut().zip(parts) {
                for (value, r) in along.iter_mut().zip(radii) {
                    *value += part * r.powi(l as i32);
                }
            }
        }
    }

    /// Relative tension at a radius of those given and a direction (rad).
    #[cfg(test)]
    fn at(&self, radius: usize, angle: f64) -> f64 {
        let harmonics = self.harmonics.iter().enumerate();
        harmonics
            .map(|(l, harmonic)| {
                let (sin, cos) = (l as f64 * angle).sin_cos();
                harmonic.tension[0][radius] * cos + harmonic.tension[1][radius] * sin
            })
            .sum()
    }
}

/// Relative tension that the mode `(0, 1)` feels.
fn pull(components: &[Component], radii: &[f64], weights: &[f64]) -> f64 {
    let zero = bessel::zero(0, 1);
    let norm = bessel::j(1, zero).powi(-2);
    let felt = |component: &Component| {
        let share = 1.0 - 0.5 * (component.kappa / zero).powi(2);
        let product = |r: f64| bessel::j(0, component.kappa * r) * bessel::j(0, zero * r).powi(2);
        let mean: f64 = radii.iter().zip(weights).map(|(&r, weight)| weight * product(r)).sum();
        component.parts[0] * share * norm * mean
    };
    components.iter().filter(|component| component.l == 0).map(felt).sum()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::math::quadrature::GaussLegendre;

    fn rule(n: usize) -> (Vec<f64>, Vec<f64>) {
        let rule = GaussLegendre::unit(n);
        let weights = rule.nodes.iter().zip(&rule.weights).map(|(r, weight)| 2.0 * r * weight).collect();
        (rule.nodes, weights)
    }

    #[test]
    fn the_field_has_the_rms_that_is_asked_for() {
        let (radii, weights) = rule(40);
        for seed in 0..8 {
            let spec = TensionFieldSpec { rms: 0.04, correlation: 0.3, seed };
            let field = TensionField::new(&spec, 0, &radii, &weights);
            let (mut mean, mut square) = (0.0, 0.0);
            for (i, weight) in weights.iter().enumerate() {
                for step in 0..120 {
                    let value = field.at(i, TAU * f64::from(step) / 120.0);
                    mean += weight * value / 120.0;
                    square += weight * value * value / 120.0;
                }
            }
            // All but the even part, which keeps the pitch.
            let rms = (square - mean * mean).sqrt();
            assert!((rms / 0.04 - 1.0).abs() < 1e-3, "seed {seed}: {rms}");
            assert!(mean.abs() < 0.04, "seed {seed}: {mean}");
        }
    }

    #[test]
    fn a_shorter_correlation_has_more_components() {
        let (radii, weights) = rule(40);
        let orders = |correlation| {
            let spec = TensionFieldSpec { rms: 0.04, correlation, seed: 1 };
            TensionField::new(&spec, 0, &radii, &weights).harmonics.len()
        };
        assert!(orders(0.2) > orders(0.4) && orders(0.4) > orders(1.0), "{}", orders(1.0));
    }
}
