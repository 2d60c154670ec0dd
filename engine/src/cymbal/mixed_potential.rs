//! A potential of plain modes for a body whose modes are mixtures of them.
//!
//! With `C` the mixture, the plain modes' displacements are `C^T q`, and the mixed modes' forces `C` times the plain ones': the gradient
//! of the same energy.
//!
//! Limits: parts of the mixed modes above the highest plain mode of the potential are left out.

use crate::modal::simd::Kernels;
use crate::modal::simd::row_products::RowProducts;
use crate::modal::{Row, zero_row};
use crate::mode_mixture::ModeMixture;
use crate::potential::{Evaluation, Potential};
use crate::von_karman::dome_share::Domed;

/// A potential behind a mixture.
pub struct MixedPotential<P> {
    plain: P,
    modes: usize,
    mixing: RowProducts,
    /// The same, transposed.
    unmixing: RowProducts,
    kernels: Kernels,
    displacement: Row,
    gradient: Row,
}

impl<P: Potential> MixedPotential<P> {
    /// A potential of the first `modes` plain modes. Allocates.
    pub fn new(plain: P, mixture: &ModeMixture, modes: usize) -> MixedPotential<P> {
        let mixture = mixture.first(modes);
        MixedPotential {
            plain,
            modes,
            mixing: mixture.products(),
            unmixing: mixture.transposed().products(),
            kernels: Kernels::detect(),
            displacement: zero_row(modes),
            gradient: zero_row(modes),
        }
    }
}

impl<P: Potential> Potential for MixedPotential<P> {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        self.kernels.row_products(&self.unmixing, displacement, &mut self.displacement);
        let found = self.plain.evaluate(&self.displacement, &mut self.gradient);
        gradient[self.modes..].fill(0.0);
        self.kernels.row_products(&self.mixing, &self.gradient, gradient);
        found
    }

    fn is_convex(&self) -> bool {
        self.plain.is_convex()
    }
}

impl<P: Domed> Domed for MixedPotential<P> {
    fn dome_terms(&mut self, displacement: &[f32]) -> Vec<f64> {
        self.kernels.row_products(&self.unmixing, displacement, &mut self.displacement);
        self.plain.dome_terms(&self.displacement)
    }

    fn flatten(&mut self, factor: f64) {
        self.plain.flatten(factor);
    }
}
