//! How a cymbal misses being turned: hammers and lathes leave it thicker here and thinner there.
//!
//! Model: the thickness is `h(r) (1 + eta)` with a [random field](crate::random_field) `eta` whose mean over the metal is zero.
//! To the first order it adds between two modes of unit modal mass, with `A`, `B`, `D` the [curvatures](crate::plate::bent) and
//! `t` the thickness over its mean,
//!
//! ```text
//! W^2 int 3 eta t^3 [lap i lap j - (1 - nu) (A_i B_j + B_i A_j - 2 D_i D_j)] dA    bending goes with the thickness cubed,
//! - omega_i omega_j int eta t i j dA                                               inertia with the thickness,
//! ```
//!
//! `W` the frequency of the flat plate at wavenumber 1. Of two modes `omega_i omega_j` stands for the mean of their squares, which is
//! the same where they are near each other; of modes far apart the mean would take from the lower one, whose motion next to
//! nothing of the higher one belongs to, more stiffness than it has.
//!
//! Limits: what hammering does to the curvature, and with it to the stress of the shell, is left out. It would mix the lowest modes
//! more.

use serde::{Deserialize, Serialize};

use crate::numbers::{Numbers, Visitor};
use crate::random_field::{self, Along};

/// How uneven a cymbal's thickness is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HammeringSpec {
    /// Root mean square of the relative thickness, 0 to 0.1: the stiffness `1 + 3 eta` of the first order then stays positive up to
    /// 3.3 of them. From 0.2 some mixed modes had none left.
    pub rms: f64,
    /// Correlation length, share of the radius, 0.05 to 2.
    pub correlation: f64,
    /// Tells the hammering of one cymbal from another's.
    pub seed: u32,
}

impl Numbers for HammeringSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("rms", &mut self.rms, 0.0..=0.1);
        visitor.number("correlation", &mut self.correlation, 0.05..=2.0);
    }
}

/// The relative thickness at given radii.
#[derive(Debug, Clone)]
pub struct ThicknessField {
    /// By the number of periods around.
    pub harmonics: Vec<Along>,
}

impl ThicknessField {
    /// Draws the field of a cymbal at radii (shares of its radius) with weights such that `sum weight f` is the mean of `f(r)`
    /// over the metal. Allocates.
    pub fn new(spec: &HammeringSpec, radii: &[f64], weights: &[f64]) -> ThicknessField {
        let components = random_field::components(spec.rms, spec.correlation, spec.seed, 0);
        let fields = random_field::harmonics(&components, radii, |_| [1.0]);
        let mut harmonics: Vec<Along> = fields.into_iter().map(|[thickness]| thickness).collect();
        // Hammers move metal and take none away.
        let total: f64 = weights.iter().sum();
        let mean = harmonics[0][0].iter().zip(weights).map(|(eta, weight)| eta * weight).sum::<f64>() / total;
        harmonics[0][0].iter_mut().for_each(|eta| *eta -= mean);
        ThicknessField { harmonics }
    }
}
