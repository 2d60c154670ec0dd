//! How hard the plate shakes the rivets.

use crate::modal::{ModalBody, Row, zero_row};

use super::motion::GRAVITY;

/// The acceleration at the holes.
pub struct Shaking {
    /// Largest shape at any hole, dimensionless, `[mode]`.
    largest: Vec<f64>,
    /// What a mode's speed is multiplied by: the shape and the frequency, times those that make the speed, 1/s2, `[mode]`.
    by_omega: Row,
    by_sigma: Row,
    /// Whether the modes have changed since these were worked out.
    stale: bool,
}

impl Shaking {
    /// Of so many modes, no holes yet. Allocates.
    pub fn new(modes: usize) -> Shaking {
        let row = || zero_row(modes);
        Shaking { largest: vec![0.0; modes], by_omega: row(), by_sigma: row(), stale: true }
    }

    /// Adds a hole of these shapes, dimensionless.
    pub fn add(&mut self, shape: &[f32]) {
        for (largest, &shape) in self.largest.iter_mut().zip(shape) {
            *largest = largest.max(f64::from(shape).abs());
        }
    }

    /// The modes have changed.
    pub fn follow(&mut self) {
        self.stale = true;
    }

    /// Acceleration at the hole where it is largest, over `g`, or more: of its mean square what goes with the speeds now, so that a plate
    /// that is bent and at rest does not shake, though a mode at its turning point does not either.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn level(&mut self, modal: &ModalBody) -> f64 {
        if std::mem::take(&mut self.stale) {
            let rows = self.by_omega.iter_mut().zip(self.by_sigma.iter_mut());
            for ((by_omega, by_sigma), (largest, mode)) in rows.zip(self.largest.iter().zip(modal.modes())) {
                let weight = largest * mode.omega;
                (*by_omega, *by_sigma) = ((weight * mode.omega_d()) as f32, (weight * mode.sigma) as f32);
            }
        }
        modal.weighted_speeds(&self.by_omega, &self.by_sigma).sqrt() / GRAVITY
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::modal::{InputVector, Mode};

    fn shaking(sigma: f64) -> (Shaking, ModalBody) {
        let mode = |hz: f64| Mode { omega: TAU * hz, sigma, mass: 1.0 };
        let mut body = ModalBody::new(vec![mode(200.0), mode(500.0)], 48e3);
        let mut shaking = Shaking::new(2);
        shaking.add(&[1.0, 0.0]);
        shaking.add(&[-2.0, 0.5]);
        // Amplitudes of 3 and 1 um.
        body.set_displacements(&[3e-6, 1e-6]);
        (shaking, body)
    }

    #[test]
    fn the_level_is_that_of_the_acceleration_over_a_time() {
        let (mut shaking, mut body) = shaking(0.0);
        let mean_square = |hz: f64, amplitude: f64| 8.0 * PI.powi(4) * (hz * hz * amplitude).powi(2);
        let expected = (mean_square(200.0, 6e-6) + mean_square(500.0, 0.5e-6)).sqrt() / GRAVITY;
        // Whole periods of both.
        const STEPS: usize = 4800;
        let mut square = 0.0;
        for _ in 0..STEPS {
            body.step();
            square += shaking.level(&body).powi(2);
        }
        let level = (square / STEPS as f64).sqrt();
        assert!((level / expected - 1.0).abs() < 1e-4, "{level} {expected}");
    }

    #[test]
    fn a_plate_that_is_bent_and_at_rest_does_not_shake() {
        for sigma in [100.0, 1200.0] {
            let (mut shaking, mut body) = shaking(sigma);
            let mut port = InputVector::new(2);
            port.shape_mut()[..2].copy_from_slice(&[1.0, -0.5]);
            body.connect(&mut port);
            let moving = shaking.level(&body);
            for _ in 0..48_000 {
                body.step();
                body.push(&port, 10.0);
            }
            assert!(body.displacement_at(&port) > 1e-6);
            let level = shaking.level(&body);
            assert!(moving > 0.01 && level < 1e-4, "{sigma}: {moving} {level}");
        }
    }
}
