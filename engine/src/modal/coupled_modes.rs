//! The coupled modes of a body: its first modes, which a nonlinear force acts on.
//!
//! A force that depends on the deflection of the body needs the state of these modes at every sample. The other modes are
//! rendered in whole runs ([`ModalBody::ring`]).

use super::simd::LANES;
use super::simd::coupled_modes::{Along, FORCES, PushAndHear};
use super::simd::hear::Hear;
use super::{InputVector, ModalBody, Pressure, ReceiverWeights, Row, zero_row};

/// Coefficients of the coupled modes of one body, in whole SIMD lanes.
pub struct CoupledModes {
    /// Modes, padded.
    length: usize,
    /// Displacements saved by [`ModalBody::save`].
    kept: Row,
    /// Imaginary part of `e^(lambda t) z` is `ahead_re * im + ahead_im * re`.
    ahead_re: Row,
    ahead_im: Row,
    /// `M omega_d^2 / 2`: kinetic energy over the square of the real part, but for terms of the order
    /// of `sigma / omega`.
    kinetic: Row,
    /// `M omega_d / dt`: the force that changes the real part by one within a sample, N/m, and the forces that would give the
    /// present velocities, N.
    force_per_change: Row,
    forces: Row,
}

impl CoupledModes {
    /// The first `modes` of a body, rounded up to whole lanes. Allocates.
    pub fn new(modes: usize) -> CoupledModes {
        let row = || zero_row(modes);
        let length = modes.div_ceil(LANES) * LANES;
        CoupledModes {
            length,
            kept: row(),
            ahead_re: row(),
            ahead_im: row(),
            kinetic: row(),
            force_per_change: row(),
            forces: row(),
        }
    }

    /// Number of coupled modes, padded to whole lanes.
    pub fn length(&self) -> usize {
        self.length
    }

    /// The displacements saved last, m, `[mode]`.
    pub fn kept(&self) -> &[f32] {
        &self.kept
    }
}

impl ModalBody {
    /// Updates the coefficients of [`predict`](Self::predict), for a prediction `samples_ahead` (samples), and of
    /// [`rescale_velocity`](Self::rescale_velocity), after a change of modes.
    ///
    /// # Real-time
    /// Linear in the coupled modes, about 50 ns each.
    pub fn update(&self, coupled: &mut CoupledModes, samples_ahead: f64) {
        for (k, mode) in self.modes.iter().enumerate().take(coupled.length) {
            let (omega_d, time) = (mode.omega_d(), samples_ahead * self.dt);
            let (sin, cos) = (omega_d * time).sin_cos();
            let decay = (-mode.sigma * time).exp();
            coupled.ahead_re[k] = (decay * cos) as f32;
            coupled.ahead_im[k] = (decay * sin) as f32;
            coupled.force_per_change[k] = (mode.mass * omega_d / self.dt) as f32;
            coupled.kinetic[k] = (0.5 * mode.mass * omega_d * omega_d) as f32;
        }
    }

    /// Displacements of the coupled modes without forces, as many samples ahead as [`update`](Self::update) was called with, m.
    pub fn predict(&self, coupled: &CoupledModes, out: &mut [f32]) {
        let n = coupled.length.min(self.state.im.len());
        let (im, re) = (&self.state.im[..n], &self.state.re[..n]);
        self.kernels.combine(out, (&coupled.ahead_re, im), (&coupled.ahead_im, re));
    }

    /// Saves the present displacements of the coupled modes.
    pub fn save(&self, coupled: &mut CoupledModes) {
        let n = coupled.length.min(self.state.im.len());
        coupled.kept[..n].copy_from_slice(&self.state.im[..n]);
    }

    /// Movement of the coupled modes since they were [saved](Self::save), along an input vector:
    /// `sum shape * (q - kept)`, m.
    pub fn moved(&self, coupled: &CoupledModes, input: &InputVector) -> f64 {
        f64::from(self.kernels.dot_difference(&input.shape, &self.state.im, &coupled.kept))
    }

    /// [`step_coupled`](Self::step_coupled) that returns the movement of the coupled modes along an input vector, m.
    pub fn step_coupled_along(&mut self, coupled: &CoupledModes, input: &InputVector) -> f64 {
        let n = coupled.length.min(self.state.im.len());
        let along = Along {
            re: &mut self.state.re[..n],
            im: &mut self.state.im[..n],
            turn_re: &self.coefs.turn_re[..n],
            turn_im: &self.coefs.turn_im[..n],
            shape: &input.shape[..n],
        };
        f64::from(self.kernels.rotate_along(along))
    }

    /// [`push_coupled`](Self::push_coupled) at two input vectors at once, then [`listen_coupled`](Self::listen_coupled).
    pub fn push_coupled_and_listen(
        &mut self,
        coupled: &CoupledModes,
        forces: [(f32, &InputVector); FORCES],
        weights: &ReceiverWeights,
    ) -> Pressure {
        let n = coupled.length.min(self.state.im.len());
        let few = |row| <[f32]>::len(row).min(n);
        self.kernels.push_and_hear(PushAndHear {
            re: &mut self.state.re[..n],
            im: &mut self.state.im[..n],
            forces: forces.map(|(force, input)| (force, [&input.gain_re[..n], &input.gain_im[..n]])),
            weights: weights.receivers.each_ref().map(|receiver| {
                [
                    &receiver.weight_re[..few(&receiver.weight_re)],
                    &receiver.weight_im[..few(&receiver.weight_im)],
                ]
            }),
        })
    }

    /// Advances only the coupled modes by one sample without force.
    pub fn step_coupled(&mut self, coupled: &CoupledModes) {
        let n = coupled.length.min(self.state.im.len());
        let (re, im) = (&mut self.state.re[..n], &mut self.state.im[..n]);
        self.kernels.rotate(re, im, &self.coefs.turn_re[..n], &self.coefs.turn_im[..n]);
    }

    /// Pressure of the coupled modes alone at each receiver; see [`listen`](Self::listen).
    pub fn listen_coupled(&self, coupled: &CoupledModes, weights: &ReceiverWeights) -> Pressure {
        let n = coupled.length.min(self.state.im.len());
        self.kernels.hear(Hear { re: &self.state.re[..n], im: &self.state.im[..n], weights: weights.rows() })
    }

    /// [`push`](Self::push) of the coupled modes alone, by a force in N.
    pub fn push_coupled(&mut self, coupled: &CoupledModes, input: &InputVector, force: f32) {
        let n = coupled.length.min(self.state.im.len());
        self.kernels.axpy(&mut self.state.re[..n], &input.gain_re[..n], force);
        self.kernels.axpy(&mut self.state.im[..n], &input.gain_im[..n], force);
    }

    /// Kinetic energy of the coupled modes, J.
    pub fn kinetic_energy(&self, coupled: &CoupledModes) -> f64 {
        f64::from(self.kernels.dot_square(&coupled.kinetic, &self.state.re))
    }

    /// Scales the velocities of the coupled modes. Returns the pressure of that change of velocity over the next sample, Pa.
    pub fn rescale_velocity(
        &mut self,
        coupled: &mut CoupledModes,
        weights: &ReceiverWeights,
        factor: f32,
    ) -> Pressure {
        let n = coupled.length.min(self.state.re.len());
        let forces = &mut coupled.forces[..n];
        self.kernels.multiply(forces, &coupled.force_per_change[..n], &self.state.re[..n]);
        let heard = weights.receivers.each_ref().map(|receiver| {
            let n = n.min(receiver.direct.len());
            (factor - 1.0) * self.kernels.dot(&receiver.direct[..n], &forces[..n])
        });
        self.kernels.scale(&mut self.state.re[..n], factor);
        heard
    }

    /// Displacements of all modes, m, `[mode]`, padded.
    pub fn displacements(&self) -> &[f32] {
        &self.state.im
    }

    /// Sets the displacements of the first modes, m, and leaves their velocities; for tests and tools.
    pub fn set_displacements(&mut self, displacements: &[f32]) {
        for (q, &new) in self.state.im.iter_mut().zip(displacements) {
            *q = new;
        }
    }
}
