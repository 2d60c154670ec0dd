//! Airy functions of a plate's stretching: the clamped plate's modes.
//!
//! Model: the membrane forces of a stretched plate derive from a stress function `F` with
//! `grad^4 F = -(E h / 2) (L(w, w) + (2/R) lap(w))`, `F = F' = 0` at a rim that is free in its plane.
//! Expanded in clamped modes `Psi_k` (unit mean square, wave number `zeta_k`) the stretching energy is
//!
//! ```text
//! U = sum c_k (P_k + l_k)^2,   c_k = E h a^2 / (8 pi zeta_k^4)
//! P_k = int Psi_k L(w, w) dA,  l_k = (2/R) int Psi_k lap(w) dA
//! ```
//!
//! Source: Thomas, Touze, Chaigne, Int. J. Solids Struct. 42, 2005.

use crate::plate::dome::{curvature_overlap, stretching_coefficient};
use crate::plate::edges::clamped_modes;
use crate::plate::radial::RadialMode;
use crate::plate::{PlateModes, PlateTables, ShellMode};

/// Airy functions of one order.
pub struct AiryOrder {
    /// Ascending by wave number, which may be none.
    pub modes: Vec<RadialMode>,
    /// `c_k`, J.
    pub stiffness: Vec<f64>,
}

impl AiryOrder {
    /// Every Airy function of order `m` with a wave number up to `limit`.
    pub fn new(plate: &PlateModes, m: u32, limit: f64) -> AiryOrder {
        let modes = clamped_modes(m, limit);
        let stiffness = modes.iter().map(|mode| stretching_coefficient(&plate.spec, mode.root)).collect();
        AiryOrder { modes, stiffness }
    }

    /// Radial shapes at `radii` (shares of the radius), dimensionless, `[airy][r]`.
    ///
    /// # Panics
    /// If the tables do not reach the order.
    pub fn shapes(&self, tables: &PlateTables, radii: &[f64]) -> Vec<Vec<f64>> {
        let sample = |mode: &RadialMode| {
            let mut row = vec![0.0; radii.len()];
            mode.sample(&tables.j[mode.m as usize], &tables.i[mode.m as usize], radii, &mut row);
            row
        };
        self.modes.iter().map(sample).collect()
    }

    /// `B^k_p` with a shell mode of the same order, `[airy]`: `l_k` per unit of its displacement, 1/m.
    pub fn curvature(&self, plate: &PlateModes, shell: &ShellMode) -> Vec<f64> {
        let scale = 2.0 * plate.spec.curvature();
        let overlap = |airy: &RadialMode| {
            let terms = plate.flat_of(shell).iter().zip(&shell.expansion);
            scale * terms.map(|(flat, share)| share * curvature_overlap(airy, flat)).sum::<f64>()
        };
        self.modes.iter().map(overlap).collect()
    }
}
