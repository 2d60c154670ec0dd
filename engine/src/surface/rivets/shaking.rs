//! How hard the plate shakes the rivets, whatever the phases of its modes.

use crate::modal::{ModalBody, Row, zero_row};

use super::motion::GRAVITY;

/// The acceleration at the holes.
pub struct Shaking {
    /// Square of the largest shape at any hole, dimensionless, `[mode]`.
    largest: Vec<f64>,
    /// Mean square of the acceleration by it, for a unit amplitude, 1/s4, `[mode]`.
    weights: Row,
    /// Whether the modes have changed since these were worked out.
    stale: bool,
}

impl Shaking {
    /// Of so many modes, no holes yet. Allocates.
    pub fn new(modes: usize) -> Shaking {
        Shaking { largest: vec![0.0; modes], weights: zero_row(modes), stale: true }
    }

    /// Adds a hole of these shapes, dimensionless.
    pub fn add(&mut self, shape: &[f32]) {
        for (largest, &shape) in self.largest.iter_mut().zip(shape) {
            *largest = largest.max(f64::from(shape).powi(2));
        }
    }

    /// The modes have changed.
    pub fn follow(&mut self) {
        self.stale = true;
    }

    /// Root mean square of the acceleration at the hole where it is largest, over `g`, or more.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn level(&mut self, modal: &ModalBody) -> f64 {
        if std::mem::take(&mut self.stale) {
            for ((weight, largest), mode) in self.weights.iter_mut().zip(&self.largest).zip(modal.modes()) {
                *weight = (0.5 * largest * mode.omega.powi(4)) as f32;
            }
        }
        modal.weighted_square(&self.weights).sqrt() / GRAVITY
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::modal::Mode;

    #[test]
    fn the_level_is_that_of_the_acceleration() {
        let mode = |hz: f64| Mode { omega: TAU * hz, sigma: 0.0, mass: 1.0 };
        let mut body = ModalBody::new(vec![mode(200.0), mode(500.0)], 48e3);
        let mut shaking = Shaking::new(2);
        shaking.add(&[1.0, 0.0]);
        shaking.add(&[-2.0, 0.5]);
        // Amplitudes of 3 and 1 um.
        body.set_displacements(&[3e-6, 1e-6]);
        let mean_square = |hz: f64, amplitude: f64| 8.0 * PI.powi(4) * (hz * hz * amplitude).powi(2);
        let expected = (mean_square(200.0, 6e-6) + mean_square(500.0, 0.5e-6)).sqrt() / GRAVITY;
        let level = shaking.level(&body);
        assert!((level / expected - 1.0).abs() < 1e-5, "{level} {expected}");
        (0..100).for_each(|_| body.step());
        assert!((shaking.level(&body) / expected - 1.0).abs() < 1e-4);
    }
}
