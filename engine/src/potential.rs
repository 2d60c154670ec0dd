//! Nonlinear force of a bent body, from a potential of its displacements. The energy is exact, there is no iteration, and the
//! force is solved together with the contacts.
//!
//! Model: a potential `U(q)` of the displacements of the first modes of a body, such as the stretching of
//! a cymbal or of a head. It acts through one number, the scalar auxiliary variable
//! `psi = sqrt(2 (U + C))`, with `C` some energy that keeps `U + C` above zero:
//!
//! ```text
//! F_k = -psi g_k,   g = grad U / sqrt(2 (U + C)),   psi' = g . q'
//! ```
//!
//! Scheme: over a sample the force is held at `-g psibar`, `psibar = (psi0 + psi1) / 2`, with `g`
//! known beforehand and `psi1 - psi0 = g . (q1 - q0)`. The modes integrate a held force exactly
//! (see [`modal`](crate::modal)), so its work on them is `-psibar g . (q1 - q0) =
//! -(psi1^2 - psi0^2) / 2` exactly: modes and `psi^2 / 2` together keep their energy, whatever `g` is.
//! The state after the sample is linear in the forces, `q1 = q_free - B g psibar + sum B phi_i F_i`, with
//! `B` the hold of each mode and `phi_i` the shapes where striker `i` presses with `F_i`. With
//! `G = g . B g` and `p_i = g . B phi_i`,
//!
//! ```text
//! psibar = psibar0 + sum p_i F_i / (2 + G),   psibar0 = (psi0 + g . (q_free - q0) / 2) / (1 + G / 2)
//! w_j    = w_free_j - p_j psibar0 + sum (C_ji - p_j p_i / (2 + G)) F_i
//! ```
//!
//! The strikers meet the same surface, displaced by `-p_j psibar0` and stiffened by a matrix of rank one. The contact solver
//! needs nothing else.
//!
//! `g` is evaluated once in `stride` samples, at the displacements that the modes would reach without it in the middle of that interval. This is
//! second-order accurate and has no phase lag. Where the potential's share of the energy is small, so are the errors: every other evaluation is
//! left out, and two of three where the share is very small. Where `psi` strays from the true energy, there are two or four in place of one.
//!
//! Drift: `psi` is integrated along the path, and its errors add up. Each evaluation gives `U`, hence the true `psi`. A share of the difference is
//! corrected. The energy this takes is exchanged with the kinetic energy of the same modes by scaling their velocities, so that the sum of both stays
//! the same to rounding; so is what `U` changes by when another tip presses. The change of velocity is part of the acceleration and sounds; without
//! it the sound would have an offset.
//!
//! `C` follows the motion. Raising it by `D` turns `psi` into `sqrt(psi^2 + 2 D)` and changes no energy.
//!
//! Rest: once the potential's share of the peaks of the energy is negligible, it is not evaluated until the next stroke.
//!
//! Inside out: a dome has a second equilibrium, where `U` is about as far below zero as the bending energy is above. A plate in that
//! state would hold its energy for ever. [`NonlinearForce::is_inside_out`] detects it.
//!
//! Source: Bilbao, Ducceschi, Zama, Explicit exactly energy-conserving methods for Hamiltonian
//! systems, J. Comput. Phys. 472, 2023. The exact hold, the contacts and the exchange are ours.

mod safety;
mod scalar;
mod schedule;
mod sound;

use crate::modal::coupled_modes::CoupledModes;
use crate::modal::simd::rim_harmonics::{Amplitudes, RimHarmonics};
use crate::modal::sway::Sway;
use crate::modal::{InputVector, ModalBody, Pressure, RECEIVERS, ReceiverWeights, Row, zero_row};

use safety::Safety;
use scalar::{LEAST_SHIFT, Scalar};
use schedule::Schedule;
use sound::Sound;

/// A potential's energy at one displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// `U`, J; may be negative.
    pub energy: f64,
    /// Lowest value of `U` for deflections of this size, below zero, J; 0 if `U` is never negative.
    pub depth: f64,
}

/// Heads of a drum at most: the struck one and the resonant one.
pub const HEADS: usize = 2;

/// An energy of the displacements of a body's first modes, in addition to their linear stiffness.
pub trait Potential: Send {
    /// The energy at `displacement` (m, `[mode]`, padded with more modes than the potential may
    /// know); writes its exact gradient (N), zero for modes it does not depend on.
    ///
    /// # Real-time
    /// Must not allocate, lock or fail.
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation;

    /// A tip comes to press so far from the centre (share of the radius); it meets the modes with these shapes, `[mode]`. Returns by how
    /// much that raises the energy at `displacement` (m, `[mode]`), J.
    ///
    /// # Real-time
    /// Must not allocate, lock or fail.
    fn press(&mut self, _radius: f64, _shapes: &[f32], _displacement: &[f32]) -> f64 {
        0.0
    }

    /// The body is tuned to a pitch, Hz. Returns by how much that raises the energy at `displacement` (m, `[mode]`), J.
    ///
    /// # Real-time
    /// Must not allocate, lock or fail.
    fn retune(&mut self, _pitch_hz: f64, _displacement: &[f32]) -> f64 {
        0.0
    }

    /// Whether the energy is never negative and rises from rest in every direction. The error of the energy then counts
    /// against all the energy there is: a head that sticks hold down hardly moves, however much it is stretched.
    fn is_convex(&self) -> bool {
        false
    }

    /// Tension that it has added to each head, N/m: the mean over the evaluations since this was last asked for. Modes that it does
    /// not act on follow it.
    fn take_tensions(&mut self) -> [f64; HEADS] {
        [0.0; HEADS]
    }
}

/// Share of the error of `psi` that each evaluation corrects. *Converged*: fast enough that a roll of hard strokes leaves no
/// drift, slow enough that single errors cause no noise.
const PULL: f64 = 1.0 / 16.0;

/// Largest share of the kinetic energy exchanged at once. At turning points the modes have little.
const LARGEST_EXCHANGE: f64 = 0.01;

/// A potential acting on the first modes of a body.
pub struct NonlinearForce {
    potential: Box<dyn Potential>,
    coupled: CoupledModes,
    /// When to evaluate, and whether to act at all.
    schedule: Schedule,
    /// Guards against divergence.
    safety: Safety,
    /// Factor on the potential.
    stiffness: f64,
    dt: f64,
    scalar: Scalar,
    /// `g` as an input vector, and `1 + G / 2`.
    input: InputVector,
    stiffening: f64,
    /// The present sample's `psibar` without strikers.
    mean: f64,
    sound: Sound,
    predicted: Row,
    gradient: Row,
    /// Sum of the absolute energies exchanged between `psi` and the modes since it was built, J.
    exchanged: f64,
}

impl NonlinearForce {
    /// Acts on the first `modes` of `body`, evaluated once in `stride` samples. Allocates.
    pub fn new(
        potential: Box<dyn Potential>,
        modes: usize,
        stride: u32,
        body: &ModalBody,
        sample_rate: f64,
    ) -> NonlinearForce {
        let mut force = NonlinearForce {
            potential,
            coupled: CoupledModes::new(modes),
            schedule: Schedule::new(stride),
            safety: Safety::new(body.modes().first().map_or(0.0, |mode| mode.mass)),
            stiffness: 1.0,
            dt: 1.0 / sample_rate,
            scalar: Scalar::REST,
            input: InputVector::new(modes),
            stiffening: 1.0,
            mean: 0.0,
            sound: Sound::default(),
            predicted: zero_row(modes),
            gradient: zero_row(modes),
            exchanged: 0.0,
        };
        force.follow(body);
        force
    }

    /// Sets the share of the energy below which it rests; below 0 it never does. For comparisons.
    pub fn set_negligible(&mut self, share: f64) {
        self.schedule.negligible = share;
    }

    /// Scales the potential by a factor, as a stiffer material would, from the next evaluation on.
    ///
    /// The change of the energy held is the work of the caller.
    pub fn set_stiffness(&mut self, stiffness: f64) {
        if stiffness > 0.0 && self.stiffness > 0.0 {
            let ratio = stiffness / self.stiffness;
            self.scalar.psi *= ratio.sqrt();
            self.scalar.shift *= ratio;
        }
        self.stiffness = stiffness;
    }

    /// Evaluates once in `stride` samples from now on; [`follow`](Self::follow) must be called after.
    pub fn set_stride(&mut self, stride: u32) {
        self.schedule.set_stride(stride);
    }

    /// Sets the share of the energy below which it is weak; below 0 it never is. For comparisons.
    pub fn set_weak(&mut self, share: f64) {
        self.schedule.weak = share;
    }

    /// Whether it acts; otherwise it rests.
    pub fn is_active(&self) -> bool {
        self.schedule.is_active()
    }

    /// The modes it acts on.
    pub fn coupled_modes(&self) -> &CoupledModes {
        &self.coupled
    }

    /// Energy it holds as the scheme has it, `psi^2 / 2 - C`, and owes, J; zero at rest.
    pub fn energy(&self) -> f64 {
        if self.schedule.is_evaluated() { self.scalar.energy() } else { 0.0 }
    }

    /// Energy that the modes are still to give, J.
    pub fn debt(&self) -> f64 {
        (-self.scalar.owed).max(0.0)
    }

    /// Kinetic energy of the modes it acts on, J.
    pub fn kinetic_energy(&self, body: &ModalBody) -> f64 {
        body.kinetic_energy(&self.coupled)
    }

    /// True energy it holds, J, and the relative error of `psi`.
    pub fn true_energy(&mut self, body: &ModalBody) -> (f64, f64) {
        let n = self.coupled.length();
        let truth = self.potential.evaluate(&body.displacements()[..n], &mut self.gradient);
        let energy = self.stiffness * truth.energy;
        let psi = (2.0 * (energy + self.scalar.shift).max(0.0)).sqrt();
        (energy, self.scalar.psi / psi - 1.0)
    }

    /// Sum of the absolute energies exchanged between `psi` and the modes to correct drift, J.
    pub fn exchanged(&self) -> f64 {
        self.exchanged
    }

    /// Follows a change of the modes.
    ///
    /// # Real-time
    /// Linear in the modes it acts on.
    pub fn follow(&mut self, body: &ModalBody) {
        body.update(&mut self.coupled, self.schedule.ahead());
        body.connect(&mut self.input);
        self.stiffening = 1.0 + 0.5 * body.compliance(&self.input, &self.input);
    }

    /// Follows receiver weights that have moved by a step.
    pub fn sway(&mut self, body: &ModalBody, sway: &Sway) {
        for (receiver, [direct, rate]) in sway.step_along(body, &self.input).into_iter().enumerate() {
            self.sound.sway(receiver, direct, rate);
        }
    }

    /// Acts from now on, until it becomes negligible.
    pub fn wake(&mut self) {
        if self.schedule.wake() {
            self.safety.forget();
        }
    }

    /// See [`Potential::press`], `radius` a share of the body's; acts from now on. What it then holds more, at the displacements of `body`, it
    /// owes to the modes.
    ///
    /// # Real-time
    /// Linear in the modes it acts on.
    pub fn press(&mut self, radius: f64, shapes: &[f32], body: &ModalBody) {
        let more = self.potential.press(radius, shapes, &body.displacements()[..self.coupled.length()]);
        self.owe(more);
        self.wake();
    }

    /// See [`Potential::retune`], Hz. What it then holds more, at the displacements of `body`, it owes to the modes.
    ///
    /// # Real-time
    /// As [`Potential::retune`].
    pub fn retune(&mut self, pitch_hz: f64, body: &ModalBody) {
        let more = self.potential.retune(pitch_hz, &body.displacements()[..self.coupled.length()]);
        self.owe(more);
    }

    /// Takes an energy (J) from the modes, within the next evaluations.
    pub fn take(&mut self, energy: f64) {
        self.scalar.owed -= energy;
    }

    /// Takes up that the potential holds more (J), without the factor on it, and owes it.
    fn owe(&mut self, more: f64) {
        if self.schedule.is_evaluated() && more != 0.0 {
            self.scalar.rise_by(self.stiffness * more);
        }
    }

    /// Whether the body rests inside out, where it would hold energy for ever.
    pub fn is_inside_out(&self) -> bool {
        self.safety.is_inside_out()
    }

    /// See [`Potential::take_tensions`], N/m; none while it rests.
    pub fn take_tensions(&mut self) -> [f64; HEADS] {
        let tensions = self.potential.take_tensions();
        tensions.map(|tension| if self.is_active() { self.stiffness * tension } else { 0.0 })
    }

    /// Rests if it has become negligible. Called once a block, so that no sample depends on the size of the host's buffers.
    pub fn settle(&mut self) {
        if self.schedule.takes_rest() {
            self.reset();
        }
    }

    /// Rests.
    pub fn reset(&mut self) {
        self.schedule.rest();
        self.safety.reset();
        self.scalar = Scalar::REST;
        self.sound.reset();
        self.potential.take_tensions();
    }

    /// Before the body steps: evaluates if an evaluation is due. True if `g` has changed.
    pub fn begin(&mut self, body: &mut ModalBody, weights: &ReceiverWeights) -> bool {
        body.save(&mut self.coupled);
        self.prepare(body, weights)
    }

    /// Evaluates if an evaluation is due.
    fn prepare(&mut self, body: &mut ModalBody, weights: &ReceiverWeights) -> bool {
        let due = self.schedule.is_due();
        if due {
            if self.schedule.set_out(self.stiffness, self.safety.times_as_often()) {
                body.update(&mut self.coupled, self.schedule.ahead());
            }
            body.save(&mut self.coupled);
            self.evaluate(body, weights);
            body.connect(&mut self.input);
            self.stiffening = 1.0 + 0.5 * body.compliance(&self.input, &self.input);
            self.sound.follow(body, weights, &self.input, self.schedule.stride());
            // The exchange scales velocities only, so the saved displacements stay valid.
        }
        self.schedule.tick();
        due
    }

    /// Advances the coupled modes through a run without strikers, under the pressures of `air` (an input vector and the
    /// pressures of the run), and adds their sound.
    ///
    /// # Real-time
    /// The same as [`begin`](Self::begin) to [`finish`](Self::finish) for each sample, in fewer passes over the modes.
    pub fn ring(
        &mut self,
        body: &mut ModalBody,
        weights: &ReceiverWeights,
        air: Option<(&InputVector, &[f32])>,
        out: &mut [&mut [f32]; RECEIVERS],
    ) {
        let mut felt = air.map_or(0.0, |(input, _)| body.compliance(&self.input, input));
        for i in 0..out[0].len() {
            if self.prepare(body, weights) {
                felt = air.map_or(0.0, |(input, _)| body.compliance(&self.input, input));
            }
            let pressure = air.map_or(0.0, |(_, pressures)| pressures[i]);
            let moved = body.step_coupled_along(&self.coupled, &self.input) + felt * f64::from(pressure);
            self.mean = (self.scalar.psi + 0.5 * moved) / self.stiffening;
            let (force, mut heard) = self.hold(0.0);
            let forces = [(force, &self.input), (pressure, air.map_or(&self.input, |(input, _)| input))];
            let modes = body.push_coupled_and_listen(&self.coupled, forces, weights);
            heard.iter_mut().zip(modes).for_each(|(heard, modes)| *heard += modes);
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[i] += heard);
        }
    }

    /// After the body's free step: `psibar` if no striker pressed, in the unit of `psi` (the root of J).
    pub fn free(&mut self, body: &ModalBody) -> f64 {
        self.mean = (self.scalar.psi + 0.5 * body.moved(&self.coupled, &self.input)) / self.stiffening;
        self.mean
    }

    /// `p` of an input vector: the change of `psi` by a unit force there, and the displacement there by a unit `psi`.
    pub fn coupling(&self, body: &ModalBody, input: &InputVector) -> f64 {
        body.compliance(&self.input, input)
    }

    /// [`coupling`](Self::coupling) of all points around the rim.
    pub fn folded_coupling(&self, body: &ModalBody, folded: &RimHarmonics) -> Amplitudes {
        body.folded_compliance(folded, &self.input)
    }

    /// `2 + G`, dimensionless.
    pub fn divisor(&self) -> f64 {
        2.0 * self.stiffening
    }

    /// Applies the force, given `sum p_i F_i` (N) of the strikers. Returns the pressure proportional to it, Pa.
    pub fn finish(&mut self, body: &mut ModalBody, strikers: f64) -> Pressure {
        let (force, heard) = self.hold(strikers);
        body.push(&self.input, force);
        heard
    }

    /// The force held over the sample, N, and the pressure proportional to it, Pa.
    fn hold(&mut self, strikers: f64) -> (f32, Pressure) {
        let mean = self.mean + strikers / self.divisor();
        self.scalar.psi = 2.0 * mean - self.scalar.psi;
        let force = -mean as f32;
        (force, self.sound.heard(force, self.dt))
    }

    fn evaluate(&mut self, body: &mut ModalBody, weights: &ReceiverWeights) {
        body.predict(&self.coupled, &mut self.predicted);
        let found = self.potential.evaluate(&self.predicted, &mut self.gradient);
        let (energy, depth) = (self.stiffness * found.energy, self.stiffness * found.depth);
        let lost = self.safety.is_lost();
        if let Some(kept) = self.safety.slows(depth) {
            // Only velocities: a dome that is half inside out gains energy by a smaller deflection.
            self.sound.rescale_velocity(body.rescale_velocity(&mut self.coupled, weights, kept));
        }
        let stretch = self.schedule.stretch(self.dt);
        let held = self.scalar.psi;
        self.scalar.shift_to(depth, stretch);
        if held != 0.0 && self.scalar.psi != 0.0 {
            self.sound.rescale((self.scalar.psi / held) as f32);
        }
        // Below the predicted depth by rounding only.
        let psi = (2.0 * (energy + self.scalar.shift)).max(LEAST_SHIFT).sqrt();
        let kernels = body.kernels();
        let scale = (self.stiffness / psi) as f32;
        kernels.vectorized(
            #[inline(always)]
            || {
                let rows = self.input.shape_mut().iter_mut().zip(self.gradient.iter());
                rows.for_each(|(g, &gradient)| *g = scale * gradient);
            },
        );
        let ahead =
            f64::from(kernels.dot_difference(self.input.shape(), &self.predicted, self.coupled.kept()));
        let kinetic = body.kinetic_energy(&self.coupled);
        let found_anew = lost && self.safety.is_found(energy);
        if self.schedule.begins() {
            self.scalar.psi = psi - ahead;
            self.safety.forget();
        } else if found_anew {
            self.find_anew((body, weights), psi - ahead, kinetic);
        } else {
            let held = self.scalar.psi * self.scalar.psi;
            let whole = if self.potential.is_convex() { kinetic + energy } else { kinetic };
            let error = 0.5 * (held - (psi - ahead).powi(2)).abs() / whole.max(f64::MIN_POSITIVE);
            self.safety.strays(error, stretch);
            self.exchange((body, weights), psi - ahead, kinetic);
        }
        if let Some(window) = self.schedule.count(energy, kinetic, self.dt) {
            self.safety.look(&window);
            if window.rests {
                // With `C`, which would count as missing until the block ends.
                self.scalar = Scalar::REST;
                self.input.shape_mut().fill(0.0);
            }
        }
    }

    /// Sets a `psi` that was lost to its true value. The energy it gains is taken from the velocities, and what they have not is owed: a lost
    /// `psi` may hold as little as `-C`, and the body then moves too fast.
    fn find_anew(&mut self, (body, weights): (&mut ModalBody, &ReceiverWeights), target: f64, kinetic: f64) {
        let missing = 0.5 * (target * target - self.scalar.psi * self.scalar.psi);
        let paid = missing.min(kinetic).max(0.0);
        self.scalar.owed -= missing.max(0.0) - paid;
        if paid > 0.0 {
            let factor = (1.0 - paid / kinetic).sqrt() as f32;
            self.sound.rescale_velocity(body.rescale_velocity(&mut self.coupled, weights, factor));
        }
        self.scalar.psi = target;
        self.safety.forget();
    }

    /// Moves `psi` toward its true value, exchanges the energy with the velocities, and pays some of what it owes them.
    fn exchange(&mut self, (body, weights): (&mut ModalBody, &ReceiverWeights), target: f64, kinetic: f64) {
        if kinetic <= 0.0 || !target.is_finite() {
            return;
        }
        let psi = self.scalar.psi;
        let aim = psi + PULL * (target - psi);
        let limit = LARGEST_EXCHANGE * kinetic;
        let cost = (0.5 * (aim * aim - psi * psi)).clamp(-limit, limit);
        let paid = self.scalar.owed.clamp(-limit, limit);
        let factor = (1.0 - (cost - paid) / kinetic).sqrt() as f32;
        // psi gets exactly what the rounded factor takes.
        let given = kinetic * (1.0 - f64::from(factor) * f64::from(factor));
        let square = psi * psi + 2.0 * (given + paid);
        if (factor != 1.0 || paid != 0.0) && square > 0.0 {
            self.sound.rescale_velocity(body.rescale_velocity(&mut self.coupled, weights, factor));
            self.scalar.psi = square.sqrt();
            self.exchanged += given.abs();
            self.scalar.owed -= paid;
        }
    }
}

#[cfg(test)]
mod tests;
