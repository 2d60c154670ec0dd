//! A surface with another one underneath: the [pair](Pair) of a hi-hat.

use crate::contact::ContactStep;
use crate::hi_hat::foot::Foot;
use crate::hi_hat::pair::{Pair, Settled};
use crate::hi_hat::points::POINTS;
use crate::modal::simd::MAX_RUN;
use crate::modal::{Heard, Mode};
use crate::potential::NonlinearForce;

use super::together::{self, Compliances, Meeting};
use super::{MAX_STRIKERS, STRIKER_PLACES, Surface};

/// Contacts of strikers and of rims.
const MOST: usize = STRIKER_PLACES + POINTS;

/// A striker farther off than this does not meet the surface within a sample, m.
const APART: f64 = 1e-3;

impl Surface {
    /// Puts the other surface underneath. Allocates.
    pub fn set_pair(&mut self, mut pair: Pair) {
        pair.follow(&self.body, &self.pickup);
        pair.come_to_rest();
        self.pair = Some(Box::new(pair));
    }

    /// What is underneath, if anything is.
    pub fn pair(&self) -> Option<&Pair> {
        self.pair.as_deref()
    }

    /// What is underneath, if anything is, to be set up by tests.
    pub fn pair_mut(&mut self) -> Option<&mut Pair> {
        self.pair.as_deref_mut()
    }

    /// Sends the foot on the pedal somewhere.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn move_pedal(&mut self, send: impl FnOnce(&mut Foot)) {
        let Surface { pair, body, .. } = self;
        if let Some(pair) = pair {
            send(pair.foot_mut());
            if pair.foot().moves() {
                pair.engage(body);
            }
        }
    }

    /// Takes care of the rims from now on, after a change by hand; for tests.
    pub fn wake_pair(&mut self) {
        if let Surface { pair: Some(pair), body, .. } = self {
            pair.engage(body);
        }
    }

    /// Lets the pedal arrive and what it moves rest there.
    pub fn rest_pedal(&mut self) {
        if let Some(pair) = self.pair.as_mut().filter(|pair| pair.foot().moves()) {
            pair.come_to_rest();
        }
    }

    /// [`retune`](Self::retune) of both; `below(k, old)` gives the new modes underneath.
    ///
    /// # Real-time
    /// Linear in the number of modes, about 100 ns each.
    pub fn retune_pair(&mut self, mode: impl Fn(usize, &Mode) -> Mode, below: &dyn Fn(usize, &Mode) -> Mode) {
        if let Some(pair) = &mut self.pair {
            pair.retune(below);
        }
        self.retune(mode);
    }

    /// `2 + G` of the force beyond the modes; without one nothing is coupled and any number will do.
    pub(super) fn divisor(&self) -> f64 {
        self.beyond.as_ref().filter(|force| force.is_active()).map_or(1.0, NonlinearForce::divisor)
    }

    /// Lets what is underneath step freely. `mean` as [`step_free`](Self::step_free) returned it.
    pub(super) fn step_pair(&mut self, mean: f64) {
        let divisor = self.divisor();
        if let Surface { pair: Some(pair), body, .. } = self {
            pair.step_free(body, mean, divisor);
        }
    }

    /// Forces of all contacts for this sample, those of the rims among them.
    pub(super) fn solve_paired(&mut self) {
        let divisor = self.divisor();
        let Some(pair) = self.pair.as_mut() else {
            return;
        };
        if !pair.is_near() {
            pair.set_forces([0.0; POINTS]);
            return self.solve();
        }
        let live = &self.live[..self.live_count];
        let apart = |&i: &usize| {
            let step = &self.points[i].step;
            step.free.max(step.before) < -APART
        };
        if live.iter().all(apart) && pair.solve_alone(divisor) {
            for &i in live {
                self.points[i].force = 0.0;
            }
            return;
        }
        let n = live.len();
        let mut yielding: Compliances<MOST> = [[0.0; MOST]; MOST];
        let meetings: [Meeting; MOST] = std::array::from_fn(|k| {
            if let Some(&i) = live.get(k) {
                let point = &self.points[i];
                Meeting { law: point.law, step: point.step, force: point.force }
            } else if k < n + POINTS {
                pair.meeting(k - n, pair.yielding(k - n, k - n, divisor))
            } else {
                let step =
                    ContactStep { before: -1.0, free: -1.0, compliance: 0.0, lambda: 0.0, dt: self.dt };
                Meeting { law: self.points[0].law, step, force: 0.0 }
            }
        });
        for (a, &i) in live.iter().enumerate() {
            for (b, &j) in live.iter().enumerate() {
                yielding[a][b] = self.yielding[i][j];
            }
            for j in 0..POINTS {
                let mutual = pair.yielding_to(i, self.coupling[i], j, divisor);
                (yielding[a][n + j], yielding[n + j][a]) = (mutual, mutual);
            }
        }
        for i in 0..POINTS {
            for j in 0..POINTS {
                yielding[n + i][n + j] = pair.yielding(i, j, divisor);
            }
        }
        let mut meetings = meetings;
        pair.kernels.vectorized(
            #[inline(always)]
            || together::solve(&mut meetings[..n + POINTS], &yielding),
        );
        for (meeting, &i) in meetings.iter().zip(live) {
            self.points[i].force = meeting.force;
        }
        pair.set_forces(std::array::from_fn(|j| meetings[n + j].force));
    }

    /// Ends the sample underneath; what is heard of it, Pa.
    pub(super) fn finish_pair(&mut self, divisor: f64) -> Heard {
        let Surface { pair: Some(pair), points, live, live_count, coupling, .. } = self else {
            return Heard::default();
        };
        let live = live[..*live_count].iter();
        pair.finish(live.map(|&i| (i, points[i].force, coupling[i])), divisor)
    }

    /// Looks after what is underneath once a block; whether all is finite.
    pub(super) fn settle_pair(&mut self, strikers: bool) -> bool {
        let Surface { pair: Some(pair), body, beyond, touchers, dt, .. } = self else {
            return true;
        };
        let about = touchers[..MAX_STRIKERS].iter().filter(|striker| striker.present);
        let fastest = about.map(|striker| striker.speed).fold(0.0, f64::max);
        let way = strikers.then_some(fastest * MAX_RUN as f64 * *dt);
        match pair.settle(body, way, || body.energy()) {
            Settled::Moving => true,
            Settled::Parked => {
                body.reset();
                beyond.iter_mut().for_each(NonlinearForce::reset);
                true
            }
            Settled::Broken => false,
        }
    }
}
