//! Forces of a bent body beyond its own modes' stiffness, from a potential: energy exact, no
//! iteration, solved together with the strikers.
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
//! The strikers thus meet the same surface, displaced by `-p_j psibar0` and stiffened by a matrix
//! of rank one; the contact solver needs to know nothing else.
//!
//! `g` is evaluated once in `stride` samples, at the displacements that the modes would reach by
//! themselves in the middle of the stretch: second order, and no phase lag. Where the potential's share of
//! the energy has become weak, the errors are too, and every other evaluation is left out, where it is faint two of three; where the energy held
//! strays from the true one, the plate moves faster than was foreseen, and three are made for one.
//!
//! Drift: `psi` follows the path, not the true energy, and errors add up. At each evaluation `U` is
//! known, hence where `psi` ought to be; a share of the difference is made up, and the energy that
//! takes is exchanged with the kinetic energy of the same modes by scaling their velocities. The
//! sum of both stays what it was to rounding: nothing is added, and it is the *true* energy that is kept.
//! That change of velocity is part of the true acceleration and is heard; left out, its mean would be an offset.
//!
//! `C` follows the motion: raising it by `D` turns `psi` into `sqrt(psi^2 + 2 D)` and changes no
//! energy.
//!
//! Rest: where the potential's share of the energy has become negligible it is no longer evaluated,
//! until the next stroke; judged on the peaks over a window, for `U` crosses zero all the time.
//!
//! Inside out: a dome has a second place to rest at, turned inside out, where `U` is about as far below zero as the
//! bending is above. Beaten there a plate would hold its energy for ever; once it lies there it
//! [tells](NonlinearForce::is_inside_out).
//!
//! Source: Bilbao, Ducceschi, Zama, Explicit exactly energy-conserving methods for Hamiltonian
//! systems, J. Comput. Phys. 472, 2023. The exact hold, the contacts and the exchange are ours.

mod safety;
mod schedule;
mod sound;

use crate::modal::coupled_modes::CoupledModes;
use crate::modal::simd::rim_harmonics::{Amplitudes, RimHarmonics};
use crate::modal::{InputVector, ModalBody, Pressure, RECEIVERS, ReceiverWeights, Row, zero_row};

use safety::Safety;
use schedule::Schedule;
use sound::Sound;

/// A potential's energy at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// `U`, J; may be negative.
    pub energy: f64,
    /// How far below zero `U` could be with modes bent as much as now, J: 0 if it never is.
    pub depth: f64,
}

/// An energy of the displacements of a body's first modes, beyond their own.
pub trait Potential: Send {
    /// The energy at `displacement` (m, `[mode]`, padded with more modes than the potential may
    /// know); writes its exact gradient (N), zero for modes it does not depend on.
    ///
    /// # Real-time
    /// Must not allocate, lock or fail.
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation;
}

/// Share of what `psi` is off that is made up at each evaluation. *Converged*: fast enough that a
/// roll of hard strokes leaves no drift, slow enough that single errors are not passed on as noise.
const PULL: f64 = 1.0 / 16.0;

/// Largest share of the kinetic energy exchanged at once: where the modes turn they have none to give.
const LARGEST_EXCHANGE: f64 = 0.01;

/// `C` over the largest depth met. *Converged*: under 8, a heavy beater on a cymbal's centre at 13 m/s takes
/// `psi` to zero, and the plate then throws it back faster than it came; ordinary strokes sound alike from 1.5 up.
const HEADROOM: f64 = 12.0;

/// Smallest `C`, J: under the energy of anything that can be heard.
const LEAST_SHIFT: f64 = 1e-14;

/// Time in which an unneeded `C` falls by `e`, s.
const SHIFT_TIME: f64 = 0.05;

/// `psi` and `C`.
struct Scalar {
    /// The root of J.
    psi: f64,
    /// `C`, J.
    shift: f64,
}

impl Scalar {
    const REST: Scalar = Scalar { psi: 0.0, shift: LEAST_SHIFT };

    /// Energy held, J.
    fn energy(&self) -> f64 {
        0.5 * self.psi * self.psi - self.shift
    }

    /// Keeps `C` above the depth (J), lets it sink where it need not be so high, after a stretch of time (s).
    fn shift_to(&mut self, depth: f64, stretch: f64) {
        let sunk = self.shift * (1.0 - stretch / SHIFT_TIME).max(0.0);
        // Not so far that psi would vanish.
        let least = self.shift - 0.25 * self.psi * self.psi;
        let shift = sunk.max(least).max(HEADROOM * depth).max(LEAST_SHIFT);
        self.psi = self.psi.signum() * (self.psi * self.psi + 2.0 * (shift - self.shift)).max(0.0).sqrt();
        self.shift = shift;
    }
}

/// A potential acting on the first modes of a body.
pub struct NonlinearForce {
    potential: Box<dyn Potential>,
    front: CoupledModes,
    /// When to evaluate, and whether to act at all.
    schedule: Schedule,
    /// What keeps it from running away.
    safety: Safety,
    /// Factor on the potential.
    stiffness: f64,
    dt: f64,
    scalar: Scalar,
    /// `g` as a port, and `1 + G / 2`.
    port: InputVector,
    stiffening: f64,
    /// The present sample's `psibar` without strikers.
    mean: f64,
    sound: Sound,
    predicted: Row,
    gradient: Row,
    /// All that was exchanged between `psi` and the modes since it was built, J, without sign.
    exchanged: f64,
}

impl NonlinearForce {
    /// Acts on the first `modes` of `body`, evaluated once in `stride` samples. Allocates.
    pub fn new(
        potential: Box<dyn Potential>,
        modes: usize,
        stride: u32,
        (body, pickup): (&ModalBody, &ReceiverWeights),
        sample_rate: f64,
    ) -> NonlinearForce {
        let mut force = NonlinearForce {
            potential,
            front: CoupledModes::new(modes),
            schedule: Schedule::new(stride),
            safety: Safety::new(body.modes().first().map_or(0.0, |mode| mode.mass)),
            stiffness: 1.0,
            dt: 1.0 / sample_rate,
            scalar: Scalar::REST,
            port: InputVector::new(modes),
            stiffening: 1.0,
            mean: 0.0,
            sound: Sound::default(),
            predicted: zero_row(modes),
            gradient: zero_row(modes),
            exchanged: 0.0,
        };
        force.follow(body, pickup);
        force
    }

    /// Rests under another share of the energy; under 0 never. For comparisons.
    pub fn set_negligible(&mut self, share: f64) {
        self.schedule.negligible = share;
    }

    /// Scales the potential by a factor, as a stiffer material would; from the next evaluation on.
    ///
    /// What that changes of the energy held is the work of whoever changes it.
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

    /// Is weak under another share of the energy; under 0 never. For comparisons.
    pub fn set_weak(&mut self, share: f64) {
        self.schedule.weak = share;
    }

    /// Whether it acts; otherwise it rests.
    pub fn is_active(&self) -> bool {
        self.schedule.is_active()
    }

    /// The modes it acts on.
    pub fn front(&self) -> &CoupledModes {
        &self.front
    }

    /// Energy it holds as the scheme has it, `psi^2 / 2 - C`, J; zero at rest.
    pub fn energy(&self) -> f64 {
        if self.schedule.is_evaluated() { self.scalar.energy() } else { 0.0 }
    }

    /// True energy it holds, J, and how far `psi` is off, relative.
    pub fn true_energy(&mut self, body: &ModalBody) -> (f64, f64) {
        let n = self.front.length();
        let truth = self.potential.evaluate(&body.displacements()[..n], &mut self.gradient);
        let energy = self.stiffness * truth.energy;
        let psi = (2.0 * (energy + self.scalar.shift).max(0.0)).sqrt();
        (energy, self.scalar.psi / psi - 1.0)
    }

    /// All that was exchanged between `psi` and the modes to hold the drift, J, without sign.
    pub fn exchanged(&self) -> f64 {
        self.exchanged
    }

    /// Follows a change of the modes.
    ///
    /// # Real-time
    /// Linear in the modes it acts on.
    pub fn follow(&mut self, body: &ModalBody, pickup: &ReceiverWeights) {
        body.update(&mut self.front, pickup, self.schedule.ahead());
        body.connect(&mut self.port);
        self.stiffening = 1.0 + 0.5 * body.compliance(&self.port, &self.port);
    }

    /// Acts from now on, until it no longer matters.
    pub fn wake(&mut self) {
        if self.schedule.wake() {
            self.safety.forget();
        }
    }

    /// Whether the body has come to lie inside out, where it would hold energy for ever.
    pub fn is_inside_out(&self) -> bool {
        self.safety.is_inside_out()
    }

    /// Lets it rest if it has found itself negligible; on the clock that blocks are cut by, so that
    /// no sample depends on how time is cut.
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
    }

    /// Before the body steps: evaluates if it is time. True if `g` is another one now.
    pub fn begin(&mut self, body: &mut ModalBody, pickup: &ReceiverWeights) -> bool {
        body.save(&mut self.front);
        self.prepare(body, pickup)
    }

    /// Evaluates if it is time.
    fn prepare(&mut self, body: &mut ModalBody, pickup: &ReceiverWeights) -> bool {
        let due = self.schedule.is_due();
        if due {
            if self.schedule.set_out(self.stiffness, self.safety.is_astray()) {
                body.update(&mut self.front, pickup, self.schedule.ahead());
            }
            body.save(&mut self.front);
            self.evaluate(body);
            body.connect(&mut self.port);
            self.stiffening = 1.0 + 0.5 * body.compliance(&self.port, &self.port);
            self.sound.follow(body, pickup, &self.port);
            // The exchange scales velocities only: what was kept still holds.
        }
        self.schedule.tick();
        due
    }

    /// Advances the modes in front through a run with no striker about, under what `air` presses (a port and the
    /// pressures of the run), and adds what is heard of them.
    ///
    /// # Real-time
    /// As so many samples of [`begin`](Self::begin) to [`finish`](Self::finish), in fewer passes over the modes.
    pub fn ring(
        &mut self,
        body: &mut ModalBody,
        pickup: &ReceiverWeights,
        air: Option<(&InputVector, &[f32])>,
        out: &mut [&mut [f32]; RECEIVERS],
    ) {
        let mut felt = air.map_or(0.0, |(port, _)| body.compliance(&self.port, port));
        for i in 0..out[0].len() {
            if self.prepare(body, pickup) {
                felt = air.map_or(0.0, |(port, _)| body.compliance(&self.port, port));
            }
            let pressure = air.map_or(0.0, |(_, pressures)| pressures[i]);
            let moved = body.step_front_along(&self.front, &self.port) + felt * f64::from(pressure);
            self.mean = (self.scalar.psi + 0.5 * moved) / self.stiffening;
            let (force, mut heard) = self.hold(0.0);
            let forces = [(force, &self.port), (pressure, air.map_or(&self.port, |(port, _)| port))];
            let rung = body.push_front_and_listen(&self.front, forces, pickup);
            heard.iter_mut().zip(rung).for_each(|(heard, rung)| *heard += rung);
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[i] += heard);
        }
    }

    /// After the body's free step: `psibar` if no striker pressed, in the unit of `psi` (the root of J).
    pub fn free(&mut self, body: &ModalBody) -> f64 {
        self.mean = (self.scalar.psi + 0.5 * body.moved(&self.front, &self.port)) / self.stiffening;
        self.mean
    }

    /// `p` of a port: how far `psi` is moved by a unit force there, and a point there by `psi`.
    pub fn coupling(&self, body: &ModalBody, port: &InputVector) -> f64 {
        body.compliance(&self.port, port)
    }

    /// [`coupling`](Self::coupling) of all places around the rim.
    pub fn folded_coupling(&self, body: &ModalBody, folded: &RimHarmonics) -> Amplitudes {
        body.folded_compliance(folded, &self.port)
    }

    /// `2 + G`, dimensionless.
    pub fn divisor(&self) -> f64 {
        2.0 * self.stiffening
    }

    /// Applies the force, given `sum p_i F_i` (N) of the strikers; the pressure that follows at once.
    pub fn finish(&mut self, body: &mut ModalBody, strikers: f64) -> Pressure {
        let (force, heard) = self.hold(strikers);
        body.push(&self.port, force);
        heard
    }

    /// The force held over the sample, and the pressure that follows at once.
    fn hold(&mut self, strikers: f64) -> (f32, Pressure) {
        let mean = self.mean + strikers / self.divisor();
        self.scalar.psi = 2.0 * mean - self.scalar.psi;
        let force = -mean as f32;
        (force, self.sound.heard(force, self.dt))
    }

    fn evaluate(&mut self, body: &mut ModalBody) {
        body.predict(&self.front, &mut self.predicted);
        let found = self.potential.evaluate(&self.predicted, &mut self.gradient);
        let (energy, depth) = (self.stiffness * found.energy, self.stiffness * found.depth);
        let lost = self.safety.is_lost();
        if let Some(kept) = self.safety.slows(depth) {
            // Only of the velocities: a dome half turned inside out gains by being bent less.
            self.sound.rescale_velocity(body.rescale_velocity(&self.front, kept));
        }
        let stretch = self.schedule.stretch(self.dt);
        self.scalar.shift_to(depth, stretch);
        // Beyond the depth foretold only by rounding.
        let psi = (2.0 * (energy + self.scalar.shift)).max(LEAST_SHIFT).sqrt();
        let kernels = body.kernels();
        let scale = (self.stiffness / psi) as f32;
        kernels.vectorized(
            #[inline(always)]
            || {
                let rows = self.port.shape_mut().iter_mut().zip(self.gradient.iter());
                rows.for_each(|(g, &gradient)| *g = scale * gradient);
            },
        );
        let ahead = f64::from(kernels.dot_difference(self.port.shape(), &self.predicted, self.front.kept()));
        let kinetic = body.kinetic_energy(&self.front);
        let found_anew = lost && self.safety.is_found(energy);
        if self.schedule.begins() {
            self.scalar.psi = psi - ahead;
            self.safety.forget();
        } else if found_anew {
            self.find_anew(body, psi - ahead, kinetic);
        } else {
            let held = self.scalar.psi * self.scalar.psi;
            let error = 0.5 * (held - (psi - ahead).powi(2)).abs() / kinetic.max(f64::MIN_POSITIVE);
            self.safety.strays(error, stretch);
            self.exchange(body, psi - ahead, kinetic);
        }
        if let Some(window) = self.schedule.count(energy, kinetic, self.dt) {
            self.safety.look(&window);
            if window.rests {
                self.scalar.psi = 0.0;
                self.port.shape_mut().fill(0.0);
            }
        }
    }

    /// Puts a `psi` that was lost where it ought to be. What it holds more then is taken from the velocities: lost, it may
    /// hold as little as `-C`, and the body moves all the faster.
    fn find_anew(&mut self, body: &mut ModalBody, target: f64, kinetic: f64) {
        let missing = 0.5 * (target * target - self.scalar.psi * self.scalar.psi);
        if missing > 0.0 && kinetic > 0.0 {
            let factor = (1.0 - missing / kinetic).max(0.0).sqrt() as f32;
            self.sound.rescale_velocity(body.rescale_velocity(&self.front, factor));
        }
        self.scalar.psi = target;
        self.safety.forget();
    }

    /// Moves `psi` toward where it ought to be, at the expense or to the gain of the velocities.
    fn exchange(&mut self, body: &mut ModalBody, target: f64, kinetic: f64) {
        if kinetic <= 0.0 || !target.is_finite() {
            return;
        }
        let psi = self.scalar.psi;
        let aim = psi + PULL * (target - psi);
        let limit = LARGEST_EXCHANGE * kinetic;
        let cost = (0.5 * (aim * aim - psi * psi)).clamp(-limit, limit);
        let factor = (1.0 - cost / kinetic).sqrt() as f32;
        // What the rounded factor really gives is what psi gets.
        let given = kinetic * (1.0 - f64::from(factor) * f64::from(factor));
        let square = psi * psi + 2.0 * given;
        if factor != 1.0 && square > 0.0 {
            self.sound.rescale_velocity(body.rescale_velocity(&self.front, factor));
            self.scalar.psi = square.sqrt();
            self.exchanged += given.abs();
        }
    }
}

#[cfg(test)]
mod tests;
