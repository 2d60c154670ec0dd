//! A modal body: the state of `N` modes, advanced one sample at a time. It does not know what it models.
//!
//! Model: each mode obeys `M (q'' + 2 sigma q' + omega^2 q) = F`, with `M` the modal mass, `F` the
//! modal force (the force times the mode's shape where it acts), `omega` the undamped frequency.
//!
//! State: one complex number a mode, `z = (q' + sigma q) / omega_d + i q` with
//! `omega_d = sqrt(omega^2 - sigma^2)`. It obeys `z' = lambda z + F / (M omega_d)`,
//! `lambda = -sigma + i omega_d`, so a sample rotates and shrinks it, and a force held over the
//! sample adds its exact integral:
//!
//! ```text
//! z <- e^(lambda dt) z + b F,   b = (e^(lambda dt) - 1) / (lambda M omega_d)
//! ```
//!
//! The work done in a sample is therefore exactly `F (q_after - q_before)`, and a force held for
//! long gives exactly the static deflection `F / (M omega^2)`, at every frequency.
//!
//! Precision: the loop is `f32`. It adds `(e^(lambda dt) - 1) z` to `z` instead of multiplying by
//! a number next to one, whose rounding would change decays of a second by a percent.
//!
//! Modes at or above half the sample rate are silent: they do not move and have no compliance.

pub mod bands;
mod coefs;
mod detuning;
mod direct;
mod energy;
pub mod inaudible_modes;
pub mod field;
pub mod rim_harmonics;
pub mod coupled_modes;
mod receiver_weights;
mod retuning;
mod input_vector;
mod row;
pub mod smoothing;
pub mod sway;
pub mod simd;

use simd::Kernels;
use simd::hear::Hear;
use simd::ring::Drive;

pub use coefs::Mode;
use coefs::{Constants, DetunedTurns, ModalCoefs, TOGETHER};
pub use input_vector::InputVector;
pub use receiver_weights::{Pressure, ReceiverWeights};
pub use row::{Row, zero_row};
pub use simd::{MAX_DRIVES, RECEIVERS};

/// `z` of every mode.
struct ModalState {
    re: Row,
    im: Row,
}

/// `N` modes and their motion.
///
/// ```
/// use overhear_engine::modal::{ModalBody, Mode, InputVector};
///
/// let mode = Mode { omega: std::f64::consts::TAU * 200.0, sigma: 5.0, mass: 0.1 };
/// let mut body = ModalBody::new(vec![mode], 48_000.0);
/// // A point where the mode shape is one.
/// let mut input = InputVector::new(body.len());
/// input.shape_mut()[0] = 1.0;
/// body.connect(&mut input);
///
/// // A blow: 10 N for a millisecond.
/// for _ in 0..48 {
///     body.step();
///     body.push(&input, 10.0);
/// }
/// let struck = body.energy();
/// // Half a second later e^(-2 sigma t) of its energy is left.
/// (0..24_000).for_each(|_| body.step());
/// let left = body.energy() / struck;
/// assert!((left / (-2.0 * 5.0 * 0.5_f64).exp() - 1.0).abs() < 0.02, "{left}");
/// ```
pub struct ModalBody {
    modes: Vec<Mode>,
    dt: f64,
    kernels: Kernels,
    coefs: ModalCoefs,
    state: ModalState,
    detuning: Option<DetunedTurns>,
    /// Times that a frequency or a mass has changed.
    retunings: u64,
}

impl ModalBody {
    /// A body at rest, at a sample rate in Hz. Allocates.
    ///
    /// # Panics
    /// If a mode's frequency or mass is not above zero (debug builds).
    pub fn new(modes: Vec<Mode>, sample_rate: f64) -> ModalBody {
        debug_assert!(modes.iter().all(|mode| mode.omega > 0.0 && mode.mass > 0.0 && mode.sigma >= 0.0));
        let n = modes.len();
        let state = ModalState { re: zero_row(n), im: zero_row(n) };
        let dt = 1.0 / sample_rate;
        let coefs = ModalCoefs::new(&modes, dt);
        ModalBody { modes, dt, kernels: Kernels::detect(), coefs, state, detuning: None, retunings: 0 }
    }

    /// Chooses the kernels, for comparing them; [`new`](Self::new) takes the best the machine has.
    pub fn set_kernels(&mut self, kernels: Kernels) {
        self.kernels = kernels;
    }

    /// The kernels in use.
    pub fn kernels(&self) -> Kernels {
        self.kernels
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    /// Whether the body has no modes.
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// The modes as they are now.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Displacement of mode `k`, m.
    pub fn displacement(&self, k: usize) -> f32 {
        self.state.im[k]
    }

    /// Velocity of mode `k`, m/s.
    pub fn velocity(&self, k: usize) -> f64 {
        let mode = &self.modes[k];
        mode.omega_d() * f64::from(self.state.re[k]) - mode.sigma * f64::from(self.state.im[k])
    }

    /// Scales every frequency by a factor; see [`set_mode`](Self::set_mode).
    ///
    /// # Real-time
    /// No allocation; as [`set_modes`](Self::set_modes).
    pub fn retune(&mut self, scale: f64) {
        self.set_modes(|_, mode| Mode { omega: mode.omega * scale, ..*mode });
    }

    /// Updates the gains of an input vector from its shapes, after a change of shapes or modes.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn connect(&self, input: &mut InputVector) {
        self.kernels.multiply(&mut input.gain_re, &self.coefs.hold_re, &input.shape);
        self.kernels.multiply(&mut input.gain_im, &self.coefs.hold_im, &input.shape);
    }

    /// Updates receiver weights, after a change of modes.
    ///
    /// The acceleration of a mode is the imaginary part of `z'' = lambda^2 z + lambda F / (M omega_d)`:
    /// the true one, with the force in it, so that a body bent but still radiates nothing.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn tune(&self, weights: &mut ReceiverWeights) {
        let dt = self.dt;
        for first in (0..self.modes.len()).step_by(TOGETHER) {
            let modes = Constants::of(&self.modes[first..]);
            let receivers = weights.receivers.iter_mut();
            let reached = receivers.filter(|receiver| receiver.transfer.len() > first);
            reached.for_each(|receiver| {
                self.kernels.vectorized(
                    #[inline(always)]
                    || receiver.tune(first, &modes, dt),
                );
            });
        }
    }

    /// One-sample compliance between two input vectors, m/N: the displacement along `at` at the end of a sample over which a
    /// unit force was held at `from`.
    pub fn compliance(&self, at: &InputVector, from: &InputVector) -> f64 {
        f64::from(self.kernels.dot(&at.shape, &from.gain_im))
    }

    /// Displacement along an input vector, m.
    pub fn displacement_at(&self, input: &InputVector) -> f64 {
        f64::from(self.kernels.dot(&input.shape, &self.state.im))
    }

    /// Velocity along an input vector, m/s.
    pub fn velocity_at(&self, input: &InputVector) -> f64 {
        (0..self.modes.len()).map(|k| f64::from(input.shape[k]) * self.velocity(k)).sum()
    }

    /// Advances one sample without force.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn step(&mut self) {
        let ModalCoefs { turn_re, turn_im, .. } = &self.coefs;
        self.kernels.rotate(&mut self.state.re, &mut self.state.im, turn_re, turn_im);
    }

    /// Adds the effect of a force (N) that was held over the sample just stepped.
    pub fn push(&mut self, input: &InputVector, force: f32) {
        self.kernels.axpy(&mut self.state.re, &input.gain_re, force);
        self.kernels.axpy(&mut self.state.im, &input.gain_im, force);
    }

    /// Present pressure at each receiver, without the part proportional to the force, Pa.
    pub fn listen(&self, weights: &ReceiverWeights) -> Pressure {
        self.kernels.hear(Hear { re: &self.state.re, im: &self.state.im, weights: weights.rows() })
    }

    /// Advances without force and listens after each sample: [`step`](Self::step) and
    /// [`listen`](Self::listen) at once, for all modes from `first` on (a multiple of
    /// [`simd::LANES`]; the others stay as they are). The motion is bit-equal to theirs unless modes are
    /// [detuned](Self::detune), what is heard equal but for the order of a sum.
    ///
    /// # Real-time
    /// Linear in modes times samples; the fastest way. At most [`simd::MAX_RUN`] samples.
    pub fn ring(&mut self, first: usize, weights: &ReceiverWeights, out: [&mut [f32]; RECEIVERS]) {
        self.ring_driven(first, std::iter::empty(), weights, out);
    }

    /// [`ring`](Self::ring) under forces at input vectors, each held over its sample (N, as many as
    /// `out` has). `out` lacks the part proportional to the force.
    ///
    /// # Real-time
    /// Linear in modes times samples times forces. At most [`simd::MAX_RUN`] samples and [`MAX_DRIVES`] forces.
    pub fn ring_driven<'a>(
        &mut self,
        first: usize,
        drives: impl Iterator<Item = (&'a InputVector, &'a [f32])>,
        weights: &ReceiverWeights,
        out: [&mut [f32]; RECEIVERS],
    ) {
        let mut held = [Drive { gain_re: &[], gain_im: &[], forces: &[], turns: 1 }; MAX_DRIVES];
        let mut count = 0;
        for (held, (input, forces)) in held.iter_mut().zip(drives) {
            *held = input.drive(first, forces, 1);
            count += 1;
        }
        self.ring_under(first, &held[..count], weights, out);
    }

    /// [`ring`](Self::ring) of all modes under forces at an input vector (N, `[turn][sample]`, as many samples in each as `out` has): [`simd::REST`]
    /// modes after [`simd::REST`] modes take the forces of the turns one after the other.
    ///
    /// # Real-time
    /// As [`ring_driven`](Self::ring_driven) with one force.
    pub fn ring_in_turns(
        &mut self,
        (input, forces, turns): (&InputVector, &[f32], usize),
        weights: &ReceiverWeights,
        out: [&mut [f32]; RECEIVERS],
    ) {
        self.ring_under(0, &[input.drive(0, forces, turns)], weights, out);
    }

    /// Advances the modes from `first` on under forces.
    fn ring_under(
        &mut self,
        first: usize,
        drives: &[Drive<'_>],
        weights: &ReceiverWeights,
        mut out: [&mut [f32]; RECEIVERS],
    ) {
        let detuning = self.detuning.as_ref().filter(|detuning| detuning.is_active);
        let (turn_re, turn_im) = match detuning {
            Some(detuning) => (&detuning.turn_re, &detuning.turn_im),
            None => (&self.coefs.turn_re, &self.coefs.turn_im),
        };
        let mut ring = simd::ring::Ring {
            re: &mut self.state.re[first..],
            im: &mut self.state.im[first..],
            turn_re: &turn_re[first..],
            turn_im: &turn_im[first..],
            heard: std::array::from_fn(|i| weights.receivers[i].from(first, std::mem::take(&mut out[i]))),
        };
        match drives {
            [] => self.kernels.ring(&mut ring),
            drives => self.kernels.ring_driven(&mut ring, drives),
        }
    }

    /// Sets modes too quiet to matter to exactly zero, so that no denormal number arises.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn flush_quiet(&mut self) {
        self.kernels.flush(&mut self.state.re, &mut self.state.im, None);
    }

    /// Whether nothing moves at all.
    pub fn is_still(&self) -> bool {
        self.kernels.is_zero(&self.state.re) && self.kernels.is_zero(&self.state.im)
    }

    /// Whether every state is a finite number.
    pub fn is_finite(&self) -> bool {
        self.kernels.is_finite(&self.state.re) && self.kernels.is_finite(&self.state.im)
    }

    /// Puts the body to rest.
    pub fn reset(&mut self) {
        self.state.re.fill(0.0);
        self.state.im.fill(0.0);
        self.end_detuning();
    }
}

#[cfg(test)]
mod tests;
