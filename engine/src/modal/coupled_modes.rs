//! The first modes of a body, apart from the rest: those that a nonlinear force acts on.
//!
//! A force that depends on how the body is bent needs the state of its modes at every sample; the
//! other modes can ring on in long stretches meanwhile ([`ModalBody::ring`]).

use super::simd::LANES;
use super::simd::coupled_modes::{Along, FORCES, PushAndHear};
use super::{InputVector, ModalBody, Pressure, RECEIVERS, ReceiverWeights, Row, zero_row};

/// Rows about the first modes of one body, whole SIMD lanes of them.
pub struct CoupledModes {
    /// Modes, padded.
    length: usize,
    /// Displacements kept by [`ModalBody::keep`].
    kept: Row,
    /// Imaginary part of `e^(lambda t) z` is `ahead_re * im + ahead_im * re`.
    ahead_re: Row,
    ahead_im: Row,
    /// `M omega_d^2 / 2`: kinetic energy over the square of the real part, but for terms of the order
    /// of `sigma / omega`.
    kinetic: Row,
    /// Pressure per change of the real part within a sample, `[ear]`: what a rescale_velocity is heard as.
    rescale_velocity: [Row; RECEIVERS],
}

impl CoupledModes {
    /// For the first `modes` of a body; those that fill the last lanes come along. Allocates.
    pub fn new(modes: usize) -> CoupledModes {
        let row = || zero_row(modes);
        let length = modes.div_ceil(LANES) * LANES;
        CoupledModes {
            length,
            kept: row(),
            ahead_re: row(),
            ahead_im: row(),
            kinetic: row(),
            rescale_velocity: std::array::from_fn(|_| row()),
        }
    }

    /// Modes in front, padded to whole lanes.
    pub fn length(&self) -> usize {
        self.length
    }

    /// The displacements kept last, m, `[mode]`.
    pub fn kept(&self) -> &[f32] {
        &self.kept
    }
}

impl ModalBody {
    /// Works out what [`predict`](Self::predict), so many samples on, and [`rescale_velocity`](Self::rescale_velocity) need, after a
    /// change of modes and of the pickup.
    ///
    /// # Real-time
    /// Linear in the modes in front, about 50 ns each.
    pub fn update(&self, front: &mut CoupledModes, pickup: &ReceiverWeights, samples_ahead: f64) {
        for (k, mode) in self.modes.iter().enumerate().take(front.length) {
            let (omega_d, time) = (mode.omega_d(), samples_ahead * self.dt);
            let (sin, cos) = (omega_d * time).sin_cos();
            let decay = (-mode.sigma * time).exp();
            front.ahead_re[k] = (decay * cos) as f32;
            front.ahead_im[k] = (decay * sin) as f32;
            for (rescale_velocity, ear) in front.rescale_velocity.iter_mut().zip(&pickup.ears) {
                let direct = ear.direct.get(k).copied().unwrap_or(0.0);
                rescale_velocity[k] = (f64::from(direct) * mode.mass * omega_d / self.dt) as f32;
            }
            front.kinetic[k] = (0.5 * mode.mass * omega_d * omega_d) as f32;
        }
    }

    /// Displacements the modes in front would have, left alone, so many samples on as
    /// [`update`](Self::update) was told.
    pub fn predict(&self, front: &CoupledModes, out: &mut [f32]) {
        let n = front.length.min(self.state.im.len());
        let (im, re) = (&self.state.im[..n], &self.state.re[..n]);
        self.kernels.combine(out, (&front.ahead_re, im), (&front.ahead_im, re));
    }

    /// Keeps the displacements of the modes in front as they are now.
    pub fn save(&self, front: &mut CoupledModes) {
        let n = front.length.min(self.state.im.len());
        front.kept[..n].copy_from_slice(&self.state.im[..n]);
    }

    /// How far, m, the modes in front have moved since they were [kept](Self::save), in the direction of
    /// a port: `sum shape * (q - kept)`.
    pub fn moved(&self, front: &CoupledModes, port: &InputVector) -> f64 {
        f64::from(self.kernels.dot_difference(&port.shape, &self.state.im, &front.kept))
    }

    /// [`step_front`](Self::step_front), and how far (m) the modes in front have moved in the direction of a port
    /// of theirs.
    pub fn step_front_along(&mut self, front: &CoupledModes, port: &InputVector) -> f64 {
        let n = front.length.min(self.state.im.len());
        let along = Along {
            re: &mut self.state.re[..n],
            im: &mut self.state.im[..n],
            turn_re: &self.coefs.turn_re[..n],
            turn_im: &self.coefs.turn_im[..n],
            shape: &port.shape[..n],
        };
        f64::from(self.kernels.rotate_along(along))
    }

    /// [`push_front`](Self::push_front) at two ports at once, and [`listen_front`](Self::listen_front).
    pub fn push_front_and_listen(
        &mut self,
        front: &CoupledModes,
        forces: [(f32, &InputVector); FORCES],
        pickup: &ReceiverWeights,
    ) -> Pressure {
        let n = front.length.min(self.state.im.len());
        let few = |row| <[f32]>::len(row).min(n);
        self.kernels.push_and_hear(PushAndHear {
            re: &mut self.state.re[..n],
            im: &mut self.state.im[..n],
            forces: forces.map(|(force, port)| (force, [&port.gain_re[..n], &port.gain_im[..n]])),
            weights: pickup
                .ears
                .each_ref()
                .map(|ear| [&ear.weight_re[..few(&ear.weight_re)], &ear.weight_im[..few(&ear.weight_im)]]),
        })
    }

    /// Advances the modes in front by one sample without force, and no others.
    pub fn step_front(&mut self, front: &CoupledModes) {
        let n = front.length.min(self.state.im.len());
        let (re, im) = (&mut self.state.re[..n], &mut self.state.im[..n]);
        self.kernels.rotate(re, im, &self.coefs.turn_re[..n], &self.coefs.turn_im[..n]);
    }

    /// Pressure at a pickup from the modes in front alone; see [`listen`](Self::listen).
    pub fn listen_front(&self, front: &CoupledModes, pickup: &ReceiverWeights) -> Pressure {
        let n = front.length.min(self.state.im.len());
        let dot =
            |weights: &[f32], state: &[f32]| self.kernels.dot(&weights[..n.min(weights.len())], &state[..n]);
        pickup
            .ears
            .each_ref()
            .map(|ear| dot(&ear.weight_re, &self.state.re) + dot(&ear.weight_im, &self.state.im))
    }

    /// [`push`](Self::push) of the modes in front alone, by a force in N.
    pub fn push_front(&mut self, front: &CoupledModes, port: &InputVector, force: f32) {
        let n = front.length.min(self.state.im.len());
        self.kernels.axpy(&mut self.state.re[..n], &port.gain_re[..n], force);
        self.kernels.axpy(&mut self.state.im[..n], &port.gain_im[..n], force);
    }

    /// Kinetic energy of the modes in front, J.
    pub fn kinetic_energy(&self, front: &CoupledModes) -> f64 {
        f64::from(self.kernels.dot_square(&front.kinetic, &self.state.re))
    }

    /// Scales the velocities of the modes in front; returns the pressure of that change of velocity, heard over
    /// the sample that follows.
    pub fn rescale_velocity(&mut self, front: &CoupledModes, factor: f32) -> Pressure {
        let heard = front
            .rescale_velocity
            .each_ref()
            .map(|rescale_velocity| (factor - 1.0) * self.kernels.dot(rescale_velocity, &self.state.re));
        let n = front.length.min(self.state.re.len());
        self.kernels.scale(&mut self.state.re[..n], factor);
        heard
    }

    /// Displacements of all modes, m, `[mode]`, padded.
    pub fn displacements(&self) -> &[f32] {
        &self.state.im
    }

    /// Bends the first modes, velocities left as they are, m; for tests and tools.
    pub fn set_displacements(&mut self, displacements: &[f32]) {
        for (q, &new) in self.state.im.iter_mut().zip(displacements) {
            *q = new;
        }
    }
}
