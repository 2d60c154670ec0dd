//! Displacement and forces of a body at all points around its rim at once; see [`RimHarmonics`].

use super::simd::rim_harmonics::{Amplitudes, MAX_CLASSES, RimHarmonics, Spread};
use super::{InputVector, ModalBody, RECEIVERS, ReceiverWeights};

/// Compliances of each class between its cosine and its sine, `[class][cosine, sine][cosine, sine]`, m/N.
pub type ClassCompliances = [[[f64; 2]; 2]; MAX_CLASSES];

impl ModalBody {
    /// Displacement around the rim, m.
    pub fn folded_displacement(&self, folded: &RimHarmonics) -> Amplitudes {
        self.kernels.gather_folded(folded, &self.state.im)
    }

    /// Adds the effect of forces around the rim (N) held over the sample just stepped.
    pub fn push_folded(&mut self, folded: &RimHarmonics, forces: &Amplitudes) {
        let body = Spread {
            re: &mut self.state.re,
            im: &mut self.state.im,
            hold_re: &self.coefs.hold_re,
            hold_im: &self.coefs.hold_im,
        };
        self.kernels.spread_folded(folded, forces, body);
    }

    /// Displaces the body as steady forces around the rim (N) would in time; velocities stay.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn displace_folded(&mut self, folded: &RimHarmonics, forces: &Amplitudes) {
        for (k, class, share) in folded.shares() {
            let force = share[0] * f64::from(forces[class][0]) + share[1] * f64::from(forces[class][1]);
            let (mode, by) = (&self.modes[k], force * self.steady_compliance(k));
            self.state.im[k] += by as f32;
            self.state.re[k] += (mode.sigma / mode.omega_d() * by) as f32;
        }
    }

    /// One-sample compliance of the rim to a force at an input vector, m/N.
    pub fn folded_compliance(&self, folded: &RimHarmonics, from: &InputVector) -> Amplitudes {
        self.kernels.gather_folded(folded, &from.gain_im)
    }

    /// Pressure at each receiver proportional to the force, per unit force on each amplitude, Pa/N.
    pub fn folded_direct(&self, folded: &RimHarmonics, weights: &ReceiverWeights) -> [Amplitudes; RECEIVERS] {
        weights.receivers.each_ref().map(|receiver| self.kernels.gather_folded(folded, &receiver.direct))
    }

    /// One-sample compliances of the rim, m/N.
    pub fn class_compliances(&self, folded: &RimHarmonics) -> ClassCompliances {
        self.sum_classes(folded, |k| f64::from(self.coefs.hold_im[k]))
    }

    /// Static compliances of the rim, m/N.
    pub fn static_compliances(&self, folded: &RimHarmonics) -> ClassCompliances {
        self.sum_classes(folded, |k| self.steady_compliance(k))
    }

    /// `1 / (M omega^2)`, m/N; 0 for a silent mode.
    fn steady_compliance(&self, k: usize) -> f64 {
        let mode = &self.modes[k];
        if self.coefs.hold_im[k] == 0.0 { 0.0 } else { 1.0 / (mode.mass * mode.omega * mode.omega) }
    }

    fn sum_classes(&self, folded: &RimHarmonics, of_mode: impl Fn(usize) -> f64) -> ClassCompliances {
        let mut out = ClassCompliances::default();
        for (k, class, share) in folded.shares() {
            let compliance = of_mode(k);
            for i in 0..2 {
                for j in 0..2 {
                    out[class][i][j] += compliance * share[i] * share[j];
                }
            }
        }
        out
    }

    /// Upper bound of the displacement of any point on the rim, m: the sum of the modes' amplitudes, each times its largest
    /// share of the rim.
    pub fn folded_reach(&self, folded: &RimHarmonics) -> f64 {
        // In double precision, where squares of the smallest states are no denormal numbers.
        let far = |k: usize| f64::from(self.state.re[k]).powi(2) + f64::from(self.state.im[k]).powi(2);
        folded.sizes().map(|(k, square)| (f64::from(square) * far(k)).sqrt()).sum()
    }
}
