//! One sample of a [`Pair`]: both cymbals step freely, then the rims' forces are found together with the strikers'
//! (see [the solver](crate::contact::solver)).
//!
//! Signs: a striker presses the upper cymbal down. A rim point presses it up and the lower one down. The coupling of a contact
//! with the upper cymbal's nonlinear force is positive in the direction in which that contact presses.

use crate::contact::solver::total;
use crate::fitted;
use crate::modal::simd::MAX_RUN;
use crate::modal::simd::rim_harmonics::Amplitudes;
use crate::modal::{InputVector, ModalBody, Pressure, RECEIVERS};
use crate::potential::NonlinearForce;
use crate::surface::body::add;

use super::gap_air::EVERY;
use super::pair::Pair;
use super::rigid::{Rigid, Weights};
use super::rim_points;
use super::rim_points::POINTS;

/// Time constant in which the loss of a contact becomes that of a lasting one, s. *By ear*.
const SETTLING: f64 = fitted::HAT_SETTLING;

impl Pair {
    /// Sets the position of a striker: `radius` as a share of the radius, `angle` in rad.
    pub(super) fn put_striker(&mut self, point: usize, radius: f64, angle: f64) {
        self.strikers[point].weights = Rigid::weights(radius, angle);
    }

    /// Updates the compliances of a striker after a change of its input vector.
    pub(super) fn connect_striker(&mut self, point: usize, top: &ModalBody, port: &InputVector) {
        let shell = rim_points::at_points(&rim_points::fine(&top.folded_compliance(&self.folded[0], port)));
        let place = &mut self.strikers[point];
        for (j, shell) in shell.into_iter().enumerate() {
            place.shell[j] = -shell;
            place.whole[j] = -shell - self.rigid[0].compliance(&place.weights, &self.statics.weights[0][j]);
        }
    }

    /// Offset of a striker's contact by the preloads, from which the upper shell's displacement is measured, m. `coupling` and
    /// `divisor` are those of the nonlinear force.
    pub(super) fn preload_offset_at(&self, point: usize, coupling: f64, divisor: f64) -> f64 {
        let place = &self.strikers[point];
        let shell: f64 = place.shell.iter().zip(&self.pedal.rest.preload).map(|(y, p)| y * p).sum();
        shell - coupling * self.preloads_coupled() / divisor
    }

    fn preloads_coupled(&self) -> f64 {
        let (coupling, preload) = (&self.dynamics.coupling, &self.pedal.rest.preload);
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let mut coupled = [0.0; POINTS];
                for j in 0..POINTS {
                    coupled[j] = coupling[j] * preload[j];
                }
                total(&coupled)
            },
        )
    }

    /// Updates the coupling with the upper cymbal's nonlinear force; without one it is zero.
    pub(super) fn couple_with(&mut self, top: &ModalBody, force: Option<&NonlinearForce>) {
        self.dynamics.coupling = force.map_or([0.0; POINTS], |force| {
            let coupling = rim_points::fine(&force.folded_coupling(top, &self.folded[0]));
            let mut coupling = self.kernels.vectorized(
                #[inline(always)]
                || rim_points::at_points(&coupling),
            );
            coupling.iter_mut().for_each(|q| *q = -*q);
            coupling
        });
    }

    /// Advances the pedal: the rod, the preloads and the static deflection.
    fn follow_pedal(&mut self) {
        if !self.pedal.moves() {
            return;
        }
        let (before, old) = (self.held(), self.pedal.rest.bend);
        if !self.step_arrival() {
            self.pedal.foot.step(self.dt);
        }
        if self.pedal.lead() {
            for (j, d) in self.rims.compression.iter_mut().enumerate() {
                *d += self.pedal.rest.bend[j] - old[j];
            }
            self.dynamics.update_offset(&self.pedal.rest.preload);
        }
        self.pedal.work += self.held() - before;
    }

    /// Steps both cymbals as rigid bodies, the rod moving at a speed (m/s). Returns the force of the clutch's damper, N.
    fn step_rigid(&mut self, speed: f64) -> f64 {
        let (drawn, damper) = self.rigid[0].drawn(self.pedal.foot.place(), speed);
        let before = self.rigid.each_ref().map(Rigid::speeds);
        self.rigid.iter_mut().for_each(Rigid::step);
        self.rigid[0].push(&[1.0, 0.0, 0.0], drawn);
        // Notes send the foot off at once, where a drummer's sets out earlier and gently: its way is not heard.
        let flies = self.pedal.foot.moves() && !self.is_touching() || self.pedal.arrival.is_some();
        let heard_from = if flies { self.rigid.each_ref().map(Rigid::speeds) } else { before };
        let pushed = self.dynamics.air.as_ref().map_or([[0.0; 3]; 2], |air| *air.pushed());
        let heard = &mut self.dynamics.rigid_heard;
        for (which, (from, before)) in heard_from.iter().zip(&before).enumerate() {
            heard.quiet[which] = std::array::from_fn(|part| from[part] - before[part]);
            // What the air has added since is heard.
            heard.from[which] = std::array::from_fn(|part| from[part] - pushed[which][part]);
        }
        damper
    }

    /// Pressure of both cymbals as rigid bodies at the end of a sample, Pa.
    fn hear_rigid(&mut self) -> Pressure {
        let mut sum = Pressure::default();
        if self.still {
            return sum;
        }
        let cymbals = self
            .dynamics
            .rigid_heard
            .sounds
            .iter_mut()
            .zip(self.rigid.iter().zip(&self.dynamics.rigid_heard.from));
        for (sound, (rigid, before)) in cymbals {
            let after = rigid.speeds();
            add(&mut sum, sound.hear(&std::array::from_fn(|part| (after[part] - before[part]) / self.dt)));
        }
        sum
    }

    /// Steps both cymbals as rigid bodies, and the lower shell if the rims may meet. The upper shell has stepped before; `mean`
    /// (m) and the dimensionless `divisor` are those of its nonlinear force.
    pub(super) fn step_free(&mut self, top: &ModalBody, mean: f64, divisor: f64) {
        self.follow_pedal();
        self.pedal.from = self.rigid[0].place()[0];
        self.pedal.damper = self.step_rigid(self.pedal.foot.speed());
        self.rims.age += 1;
        if !self.engaged {
            return;
        }
        self.lower.modal.step();
        let overlaps = self.overlaps(top);
        let nonlinear = mean - self.preloads_coupled() / divisor;
        for (j, overlap) in overlaps.into_iter().enumerate() {
            let free = overlap + self.dynamics.preload_offset[j] + self.dynamics.coupling[j] * nonlinear;
            if !self.rims.touching[j] && free > 0.0 {
                self.rims.lambda[j] = self.rims.law.lambda((free - self.rims.compression[j]) / self.dt);
            } else if self.rims.touching[j] {
                self.rims.lambda[j] +=
                    (self.rims.lasting_loss - self.rims.lambda[j]) * (self.dt / SETTLING).min(1.0);
            }
            self.rims.free[j] = free;
        }
    }

    /// Applies the forces at the rims. Returns their force on the nonlinear variable, and the pressure proportional to
    /// them, Pa.
    pub(super) fn press_rims(&mut self, top: &mut ModalBody) -> (f64, Pressure) {
        if !self.engaged {
            return (0.0, Pressure::default());
        }
        let (force, preload) = (&self.rims.force, &self.pedal.rest.preload);
        if *preload == [0.0; POINTS] && *force == [0.0; POINTS] {
            return (0.0, Pressure::default());
        }
        let direct = &self.dynamics.direct;
        let (whole, down, heard, pressed) = self.kernels.vectorized(
            #[inline(always)]
            || {
                let whole = rim_points::amplitudes(force);
                let mut dynamic = whole;
                let preloads = self.dynamics.preload_waves.as_flattened();
                for (dynamic, preload) in dynamic.as_flattened_mut().iter_mut().zip(preloads) {
                    *dynamic -= preload;
                }
                let (down, mut heard) = (rim_points::rounded(&dynamic), Pressure::default());
                for (force, direct) in down.as_flattened().iter().zip(direct.as_flattened()) {
                    heard.iter_mut().zip(direct).for_each(|(heard, direct)| *heard += force * direct);
                }
                let mut pressed = [0.0; POINTS];
                for (j, pressed) in pressed.iter_mut().enumerate() {
                    *pressed = (force[j] - preload[j]) * self.dynamics.coupling[j];
                }
                (whole, down, heard, total(&pressed))
            },
        );
        let felt: [Weights; 2] =
            self.statics.around.map(|[heave, x, z]| [heave * whole[0][0], x * whole[1][0], z * whole[1][1]]);
        let before = self.rigid.each_ref().map(Rigid::speeds);
        self.rigid[0].push_parts(&felt[0].map(|force| -force));
        self.rigid[1].push_parts(&felt[1]);
        if self.pedal.arrival.is_some() {
            // Rims that are led to another equilibrium are not heard as they let go.
            for ((heard_from, rigid), before) in
                self.dynamics.rigid_heard.from.iter_mut().zip(&self.rigid).zip(&before)
            {
                let now = rigid.speeds();
                (0..now.len()).for_each(|part| heard_from[part] += now[part] - before[part]);
            }
        }
        let up: Amplitudes = down.map(|pair| pair.map(|x| -x));
        top.push_folded(&self.folded[0], &up);
        self.lower.modal.push_folded(&self.folded[1], &down);
        (pressed, heard)
    }

    /// Ends the sample; `strikers` are the points present, their forces (N) and their coupling. Returns the pressure of the
    /// lower shell, Pa.
    pub(super) fn finish_sample(
        &mut self,
        strikers: impl Iterator<Item = (usize, f64, f64)> + Clone,
        divisor: f64,
    ) -> Pressure {
        self.pedal.work += self.pedal.damper * (self.rigid[0].place()[0] - self.pedal.from);
        let mut heard = self.hear_rigid();
        if !self.engaged {
            return heard;
        }
        self.rims.compression = self.reached(strikers, divisor);
        self.rims.count();
        add(&mut heard, self.lower.listen());
        heard
    }

    /// Lets the air follow the gap, but not the shells' own motion, which is faster and smaller.
    pub(super) fn follow_gaps(&mut self, at_once: bool) {
        let gaps = std::array::from_fn(|j| -self.apart(j));
        self.dynamics.air.iter_mut().for_each(|air| air.follow_gaps(&gaps, at_once));
    }

    /// Lets the air in the gap act, on the cymbals too if the upper one is given. Returns the pressure by it, Pa.
    pub(super) fn press_air(&mut self, top: Option<&mut ModalBody>) -> Pressure {
        // Cymbals that are led do not press on it.
        let top = top.filter(|_| self.pedal.arrival.is_none());
        if top.is_some() && self.rims.age.is_multiple_of(u64::from(EVERY)) {
            self.follow_gaps(false);
        }
        let Some(air) = &mut self.dynamics.air else { return Pressure::default() };
        match top {
            Some(top) => {
                self.pedal.work += air.carry(&self.dynamics.rigid_heard.quiet);
                air.step([top, &mut self.lower.modal], &mut self.rigid)
            }
            None => air.ring_out(),
        }
    }

    /// Renders samples in which the rims do not touch, and adds the pressure of the lower shell, Pa. As rigid bodies both
    /// cymbals have stepped for the first `stiff` samples already.
    pub(super) fn ring_apart(&mut self, mut out: [&mut [f32]; RECEIVERS], stiff: usize) {
        let samples = out[0].len();
        // At rest the rims' forces hold them, which nothing solves then.
        let moving = if self.still { samples } else { stiff };
        for sample in moving..samples {
            self.step_rigid(0.0);
            let mut heard = self.hear_rigid();
            add(&mut heard, self.press_air(None));
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[sample] += heard);
            self.rims.age += 1;
        }
        if !self.lower.modal.is_still() {
            let mut lower = [[0.0; MAX_RUN]; RECEIVERS];
            self.lower.modal.ring(0, &self.lower.receiver, lower.each_mut().map(|row| &mut row[..samples]));
            for (out, lower) in out.into_iter().zip(&lower) {
                out.iter_mut().zip(lower).for_each(|(sum, x)| *sum += x);
            }
        }
    }
}
