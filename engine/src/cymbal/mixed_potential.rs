//! A potential of plain modes for a body whose modes are mixtures of them.
//!
//! With `C` the mixture, the plain modes' displacements are `C^T q`, and the mixed modes' forces `C` times the plain ones': the gradient
//! of the same energy.
//!
//! Limits: parts of the mixed modes above the highest plain mode of the potential are left out.

use crate::modal::simd::Kernels;
use crate::modal::{Row, zero_row};
use crate::mode_mixture::ModeMixture;
use crate::potential::{Evaluation, Potential};

/// A potential behind a mixture.
pub struct MixedPotential<P> {
    plain: P,
    mixture: ModeMixture,
    /// The same, transposed.
    transposed: ModeMixture,
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
            transposed: mixture.transposed(),
            mixture,
            kernels: Kernels::detect(),
            displacement: zero_row(modes),
            gradient: zero_row(modes),
        }
    }
}

impl<P: Potential> Potential for MixedPotential<P> {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let MixedPotential { plain, mixture, transposed, kernels, displacement: unmixed, gradient: forces } =
            self;
        kernels.vectorized(
            #[inline(always)]
            || transposed.apply(displacement, unmixed),
        );
        let found = plain.evaluate(unmixed, forces);
        gradient[mixture.modes()..].fill(0.0);
        kernels.vectorized(
            #[inline(always)]
            || mixture.apply(forces, gradient),
        );
        found
    }

    fn is_convex(&self) -> bool {
        self.plain.is_convex()
    }
}
