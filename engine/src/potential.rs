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
//! The jolt is part of the true acceleration and is heard; left out, its mean would be an offset.
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

use crate::modal::front::Front;
use crate::modal::simd::folded::{Amplitudes, Folded};
use crate::modal::{EARS, Heard, ModalBody, Pickup, Port, Row, zero_row};

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

/// Window of the peaks the rest is judged on, s: some periods of the slowest mode that stretches.
const WINDOW: f64 = 0.05;

/// Time constant below which a force is slow, s: 100 Hz, under all that is heard of a cymbal's
/// stretching and far over the sway of its mean. *Derived*.
const SLOW_TIME: f64 = 1.6e-3;

/// Share of the energy under which a potential rests. *Converged* on the crash: 3e-4 moves no third
/// octave of a soft stroke by 0.06 dB, 1e-3 some by 0.2 dB.
const NEGLIGIBLE: f64 = 3e-4;

/// Share of the energy under which a potential is weak. *Converged* on the crash: no third octave moves by
/// 0.09 dB.
const WEAK: f64 = 0.05;

/// Share of that under which it is faint. *Converged* on the crash: no third octave moves by 0.04 dB.
const FAINT: f64 = 0.2;

/// Error of the energy held, over the kinetic energy, from which it is evaluated three times as often, and the
/// time in which one is forgotten, s. *Converged*: a crash at 6 m/s stays below, evaluated seven times a period; a
/// stick at 25 m/s on a splash goes from three times this to a runaway within half a millisecond.
const ASTRAY: f64 = 0.01;
const CALM_TIME: f64 = 0.005;

/// Error from which `psi` is lost, and what share of its velocity the plate keeps then, at each evaluation, until
/// so little of the depth that it yields at is held that it may be found anew. *Derived*: nothing below abuse
/// comes near a tenth.
const LOST: f64 = 0.5;
const COLLAPSING: f32 = 0.7;
const FOUND: f64 = 1e-3;

/// Depth beyond which the body yields, J/kg, and what share of its velocity it keeps at each evaluation then.
/// *Derived*: a hundred strokes at 25 m/s within a second would turn a cymbal inside out, where a true
/// one would crack; the hardest single stroke, a beater of 34 J on a crash's centre, stays below.
const YIELD: f64 = 560.0;
const YIELDING: f32 = 0.98;

/// Share of the depth it yields at that a body turned inside out holds at least, and what share of what it holds
/// changes at most once it lies there. *Converged*: a splash, turned, holds nearly all of that depth, and a fourth
/// at its lowest tuning; yielding and exchanges, which take a plate held bent for one that moves, keep 3 % trembling.
const INSIDE_OUT: f64 = 0.05;
const LYING: f64 = 0.05;

/// Peaks over this window and the one before.
#[derive(Debug, Clone, Copy, Default)]
struct Peaks {
    potential: [f64; 2],
    kinetic: [f64; 2],
    /// Least that the potential was below zero throughout.
    below: [f64; 2],
}

/// A potential acting on the first modes of a body.
pub struct NonlinearForce {
    potential: Box<dyn Potential>,
    front: Front,
    /// Samples between evaluations while it is strong, at least 1, and now.
    strong_stride: u32,
    stride: u32,
    /// Share of the energy under which it is weak.
    weak: f64,
    /// Factor on the potential.
    stiffness: f64,
    dt: f64,
    /// Share of the energy under which it rests.
    negligible: f64,
    active: bool,
    /// No evaluation since it woke.
    fresh: bool,
    /// Has found itself negligible; rests from the next [`settle`](Self::settle) on.
    done: bool,
    /// Lies inside out.
    inside_out: bool,
    /// Samples until the next evaluation, and evaluations until the window ends.
    countdown: u32,
    window: u32,
    psi: f64,
    /// `C`, J.
    shift: f64,
    /// `g` as a port, and `1 + G / 2`.
    port: Port,
    stiffening: f64,
    /// Pressure at the pickup at once per unit of `psibar`, Pa.
    direct: Heard,
    /// The present sample's `psibar` without strikers.
    mean: f64,
    /// Pressure per unit rate of change of `psibar`, Pa s, and the force's slow part heard by it, Pa s.
    slow: Heard,
    lag: Heard,
    /// Pressure of the latest exchange with the velocities, Pa, for one sample.
    jolt: Heard,
    predicted: Row,
    gradient: Row,
    peaks: Peaks,
    /// Share of the energy over the last windows.
    share: f64,
    /// Depth beyond which it yields, J.
    yields_at: f64,
    /// Largest error of the energy held of late, over the kinetic energy.
    astray: f64,
    /// All that was exchanged between `psi` and the modes since it was built, J, without sign.
    exchanged: f64,
}

impl NonlinearForce {
    /// Acts on the first `modes` of `body`, evaluated once in `stride` samples. Allocates.
    pub fn new(
        potential: Box<dyn Potential>,
        modes: usize,
        stride: u32,
        (body, pickup): (&ModalBody, &Pickup),
        sample_rate: f64,
    ) -> NonlinearForce {
        let mut force = NonlinearForce {
            potential,
            front: Front::new(modes),
            strong_stride: stride.max(1),
            stride: stride.max(1),
            weak: WEAK,
            stiffness: 1.0,
            dt: 1.0 / sample_rate,
            negligible: NEGLIGIBLE,
            active: false,
            fresh: true,
            done: false,
            inside_out: false,
            countdown: 0,
            window: 0,
            psi: 0.0,
            shift: LEAST_SHIFT,
            port: Port::new(modes),
            stiffening: 1.0,
            direct: [0.0; EARS],
            mean: 0.0,
            slow: [0.0; EARS],
            lag: [0.0; EARS],
            jolt: [0.0; EARS],
            predicted: zero_row(modes),
            gradient: zero_row(modes),
            peaks: Peaks::default(),
            share: f64::INFINITY,
            yields_at: YIELD * body.modes().first().map_or(0.0, |mode| mode.mass),
            astray: 0.0,
            exchanged: 0.0,
        };
        force.follow(body, pickup);
        force
    }

    /// Rests under another share of the energy; under 0 never. For comparisons.
    pub fn set_negligible(&mut self, share: f64) {
        self.negligible = share;
    }

    /// Scales the potential by a factor, as a stiffer material would; from the next evaluation on.
    ///
    /// What that changes of the energy held is the work of whoever changes it.
    pub fn set_stiffness(&mut self, stiffness: f64) {
        if stiffness > 0.0 && self.stiffness > 0.0 {
            let ratio = stiffness / self.stiffness;
            self.psi *= ratio.sqrt();
            self.shift *= ratio;
        }
        self.stiffness = stiffness;
    }

    /// Evaluates once in `stride` samples from now on; [`follow`](Self::follow) must be called after.
    pub fn set_stride(&mut self, stride: u32) {
        self.strong_stride = stride.max(1);
        self.stride = self.strong_stride;
        self.countdown = 0;
    }

    /// Is weak under another share of the energy; under 0 never. For comparisons.
    pub fn set_weak(&mut self, share: f64) {
        self.weak = share;
    }

    /// Whether it acts; otherwise it rests.
    pub fn is_active(&self) -> bool {
        self.active
    }

    /// The modes it acts on.
    pub fn front(&self) -> &Front {
        &self.front
    }

    /// Energy it holds as the scheme has it, `psi^2 / 2 - C`, J; zero at rest.
    pub fn energy(&self) -> f64 {
        if self.active && !self.fresh { 0.5 * self.psi * self.psi - self.shift } else { 0.0 }
    }

    /// True energy it holds, J, and how far `psi` is off, relative.
    pub fn true_energy(&mut self, body: &ModalBody) -> (f64, f64) {
        let n = self.front.length();
        let truth = self.potential.evaluate(&body.displacements()[..n], &mut self.gradient);
        let energy = self.stiffness * truth.energy;
        let psi = (2.0 * (energy + self.shift).max(0.0)).sqrt();
        (energy, self.psi / psi - 1.0)
    }

    /// All that was exchanged between `psi` and the modes to hold the drift, J, without sign.
    pub fn exchanged(&self) -> f64 {
        self.exchanged
    }

    /// Follows a change of the modes.
    ///
    /// # Real-time
    /// Linear in the modes it acts on.
    pub fn follow(&mut self, body: &ModalBody, pickup: &Pickup) {
        body.face(&mut self.front, pickup, 0.5 * f64::from(self.stride));
        body.connect(&mut self.port);
        self.stiffening = 1.0 + 0.5 * body.compliance(&self.port, &self.port);
    }

    /// Acts from now on, until it no longer matters.
    pub fn wake(&mut self) {
        if !self.active || self.done {
            self.active = true;
            self.done = false;
            self.fresh = true;
            self.countdown = 0;
            self.peaks = Peaks::default();
            self.astray = 0.0;
            self.window = 0;
        }
        self.share = f64::INFINITY;
    }

    /// Whether the body has come to lie inside out, where it would hold energy for ever.
    pub fn is_inside_out(&self) -> bool {
        self.inside_out
    }

    /// Lets it rest if it has found itself negligible; on the clock that blocks are cut by, so that
    /// no sample depends on how time is cut.
    pub fn settle(&mut self) {
        if std::mem::take(&mut self.done) {
            self.reset();
        }
    }

    /// Rests.
    pub fn reset(&mut self) {
        self.active = false;
        self.done = false;
        self.inside_out = false;
        self.psi = 0.0;
        self.lag = [0.0; EARS];
        self.astray = 0.0;
        self.shift = LEAST_SHIFT;
    }

    /// Before the body steps: evaluates if it is time. True if `g` is another one now.
    pub fn begin(&mut self, body: &mut ModalBody, pickup: &Pickup) -> bool {
        body.keep(&mut self.front);
        self.prepare(body, pickup)
    }

    /// Evaluates if it is time.
    fn prepare(&mut self, body: &mut ModalBody, pickup: &Pickup) -> bool {
        let due = self.countdown == 0 && !self.done;
        if due {
            let stride = self.judge();
            if stride != self.stride {
                self.stride = stride;
                body.face(&mut self.front, pickup, 0.5 * f64::from(stride));
            }
            self.countdown = self.stride;
            body.keep(&mut self.front);
            self.evaluate(body);
            body.connect(&mut self.port);
            self.stiffening = 1.0 + 0.5 * body.compliance(&self.port, &self.port);
            self.direct = pickup.direct_at(body, &self.port);
            self.slow = pickup.slow_at(body, &self.port);
            // The exchange scales velocities only: what was kept still holds.
        }
        self.countdown = self.countdown.saturating_sub(1);
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
        pickup: &Pickup,
        air: Option<(&Port, &[f32])>,
        out: &mut [&mut [f32]; EARS],
    ) {
        let mut felt = air.map_or(0.0, |(port, _)| body.compliance(&self.port, port));
        for i in 0..out[0].len() {
            if self.prepare(body, pickup) {
                felt = air.map_or(0.0, |(port, _)| body.compliance(&self.port, port));
            }
            let pressure = air.map_or(0.0, |(_, pressures)| pressures[i]);
            let moved = body.step_front_along(&self.front, &self.port) + felt * f64::from(pressure);
            self.mean = (self.psi + 0.5 * moved) / self.stiffening;
            let (force, mut heard) = self.hold(0.0);
            let forces = [(force, &self.port), (pressure, air.map_or(&self.port, |(port, _)| port))];
            let rung = body.push_front_and_listen(&self.front, forces, pickup);
            heard.iter_mut().zip(rung).for_each(|(heard, rung)| *heard += rung);
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[i] += heard);
        }
    }

    /// After the body's free step: `psibar` if no striker pressed, in the unit of `psi` (the root of J).
    pub fn free(&mut self, body: &ModalBody) -> f64 {
        self.mean = (self.psi + 0.5 * body.moved(&self.front, &self.port)) / self.stiffening;
        self.mean
    }

    /// `p` of a port: how far `psi` is moved by a unit force there, and a point there by `psi`.
    pub fn coupling(&self, body: &ModalBody, port: &Port) -> f64 {
        body.compliance(&self.port, port)
    }

    /// [`coupling`](Self::coupling) of all places around the rim.
    pub fn folded_coupling(&self, body: &ModalBody, folded: &Folded) -> Amplitudes {
        body.folded_compliance(folded, &self.port)
    }

    /// `2 + G`, dimensionless.
    pub fn divisor(&self) -> f64 {
        2.0 * self.stiffening
    }

    /// Applies the force, given `sum p_i F_i` (N) of the strikers; the pressure that follows at once.
    pub fn finish(&mut self, body: &mut ModalBody, strikers: f64) -> Heard {
        let (force, heard) = self.hold(strikers);
        body.push(&self.port, force);
        heard
    }

    /// The force held over the sample, and the pressure that follows at once.
    fn hold(&mut self, strikers: f64) -> (f32, Heard) {
        let mean = self.mean + strikers / self.divisor();
        self.psi = 2.0 * mean - self.psi;
        let force = -mean as f32;
        let heard = std::array::from_fn(|ear| {
            // The rate of the slow part: of what changes faster the velocity is right.
            let rate = (force * self.slow[ear] - self.lag[ear]) * (1.0 / SLOW_TIME) as f32;
            self.lag[ear] += rate * self.dt as f32;
            force * self.direct[ear] + rate + std::mem::take(&mut self.jolt[ear])
        });
        (force, heard)
    }

    /// The velocities were scaled: that is heard.
    fn jolted(&mut self, heard: Heard) {
        self.jolt.iter_mut().zip(heard).for_each(|(sum, jolt)| *sum += jolt);
    }

    fn evaluate(&mut self, body: &mut ModalBody) {
        body.look_ahead(&self.front, &mut self.predicted);
        let found = self.potential.evaluate(&self.predicted, &mut self.gradient);
        let (energy, depth) = (self.stiffness * found.energy, self.stiffness * found.depth);
        let lost = self.astray > LOST;
        if lost || depth > self.yields_at {
            // Only of the velocities: a dome half turned inside out gains by being bent less.
            self.jolted(body.jolt(&self.front, if lost { COLLAPSING } else { YIELDING }));
        }
        self.shift_to(depth);
        // Beyond the depth foretold only by rounding.
        let psi = (2.0 * (energy + self.shift)).max(LEAST_SHIFT).sqrt();
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
        let found_anew = lost && energy < FOUND * self.yields_at;
        if std::mem::take(&mut self.fresh) || found_anew {
            self.psi = psi - ahead;
            self.astray = 0.0;
        } else {
            let kept = (1.0 - f64::from(self.stride) * self.dt / CALM_TIME).max(0.0);
            let error =
                0.5 * (self.psi * self.psi - (psi - ahead).powi(2)).abs() / kinetic.max(f64::MIN_POSITIVE);
            self.astray = error.max(kept * self.astray);
            self.exchange(body, psi - ahead, kinetic);
        }
        self.count(energy, kinetic);
    }

    /// Keeps `C` above the depth, lets it sink where it need not be so high.
    fn shift_to(&mut self, depth: f64) {
        let stretch = f64::from(self.stride) * self.dt;
        let sunk = self.shift * (1.0 - stretch / SHIFT_TIME).max(0.0);
        // Not so far that psi would vanish.
        let least = self.shift - 0.25 * self.psi * self.psi;
        let shift = sunk.max(least).max(HEADROOM * depth).max(LEAST_SHIFT);
        self.psi = self.psi.signum() * (self.psi * self.psi + 2.0 * (shift - self.shift)).max(0.0).sqrt();
        self.shift = shift;
    }

    /// Moves `psi` toward where it ought to be, at the expense or to the gain of the velocities.
    fn exchange(&mut self, body: &mut ModalBody, target: f64, kinetic: f64) {
        if kinetic <= 0.0 || !target.is_finite() {
            return;
        }
        let aim = self.psi + PULL * (target - self.psi);
        let limit = LARGEST_EXCHANGE * kinetic;
        let cost = (0.5 * (aim * aim - self.psi * self.psi)).clamp(-limit, limit);
        let factor = (1.0 - cost / kinetic).sqrt() as f32;
        // What the rounded factor really gives is what psi gets.
        let given = kinetic * (1.0 - f64::from(factor) * f64::from(factor));
        let square = self.psi * self.psi + 2.0 * given;
        if factor != 1.0 && square > 0.0 {
            self.jolted(body.jolt(&self.front, factor));
            self.psi = square.sqrt();
            self.exchanged += given.abs();
        }
    }

    /// Counts what an evaluation found; rests where the peaks say that nothing is left to do.
    fn count(&mut self, potential: f64, kinetic: f64) {
        let Peaks { potential: p, kinetic: t, below } = &mut self.peaks;
        p[1] = p[1].max(potential.abs());
        t[1] = t[1].max(kinetic);
        below[1] = below[1].min(-potential);
        self.window += self.stride;
        if f64::from(self.window) * self.dt < WINDOW {
            return;
        }
        let known = t[0] > 0.0;
        let share = p[0].max(p[1]) / t[0].max(t[1]).max(f64::MIN_POSITIVE);
        let (turned, most) = (below[0].min(below[1]), p[0].max(p[1]));
        self.inside_out = turned > INSIDE_OUT * self.yields_at && turned > (1.0 - LYING) * most;
        (p[0], t[0], below[0]) = (p[1], t[1], below[1]);
        (p[1], t[1], below[1]) = (0.0, 0.0, f64::INFINITY);
        self.window = 0;
        self.share = if known { share } else { f64::INFINITY };
        if self.share < self.negligible {
            self.done = true;
            self.psi = 0.0;
            self.port.shape_mut().fill(0.0);
        }
    }

    /// Samples until the next evaluation: by how weak it is, judged by the windows, though a blow
    /// counts at once; and by how far `psi` strays between two.
    fn judge(&mut self) -> u32 {
        let (p, t) = (self.peaks.potential[1], self.peaks.kinetic[1]);
        if p > self.weak * t {
            self.share = self.share.max(self.weak);
        }
        // A stiffer material moves faster by the square root.
        let strong = ((f64::from(self.strong_stride) / self.stiffness.max(1.0).sqrt()) as u32).max(1);
        if self.astray > ASTRAY {
            (strong / 3).max(1)
        } else if self.share < FAINT * self.weak {
            3 * strong
        } else if self.share < self.weak {
            2 * strong
        } else {
            strong
        }
    }
}

#[cfg(test)]
mod tests;
