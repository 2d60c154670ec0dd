//! Guards of a nonlinear force: against divergence, and against a plate that stays inside out.

use super::schedule::Window;

/// Errors of the energy, over the kinetic energy (of a head, over all its energy), from which the potential is evaluated twice and four times as
/// often, and the time constant in which an error is forgotten, s. *Converged*: strokes on a
/// splash, which often goes astray, are as near to those with an evaluation at every sample as if it were evaluated four times as often at once. A stick at 25 m/s on a splash goes from an error of 0.03 to divergence within
/// half a millisecond.
const ASTRAY: f64 = 0.01;
const FAR_ASTRAY: f64 = 0.015;
const CALM_TIME: f64 = 0.005;

/// Error from which `psi` is lost. The plate then keeps the share `COLLAPSING` of its velocity at each evaluation, until the
/// potential has fallen below the share `FOUND` of the largest depth, where `psi` is set anew. *Derived*: ordinary strokes do
/// not reach a tenth.
const LOST: f64 = 0.5;
const COLLAPSING: f32 = 0.7;
const FOUND: f64 = 1e-3;

/// Largest depth, J/kg, and the share of its velocity that a body keeps at each evaluation beyond it. *Derived*: a hundred
/// strokes at 25 m/s within a second would turn a cymbal inside out, where a true one would crack. The hardest single stroke, a
/// beater of 34 J on a crash's centre, stays below.
const LARGEST_DEPTH: f64 = 560.0;
const SLOWED: f32 = 0.98;

/// Largest share of the potential that changes while a body rests inside out. *Converged*: slowing and exchanges, which take its deflection
/// for motion, keep 3 % of it moving in a splash.
const LYING: f64 = 0.05;

/// State of the guards.
pub(super) struct Safety {
    /// Depth beyond which the body is slowed, J.
    largest_depth: f64,
    /// Largest recent error of the energy, over the kinetic energy.
    astray: f64,
    /// Whether the body rests inside out.
    inside_out: bool,
}

impl Safety {
    /// Guards of a body of that mass, kg.
    pub(super) fn new(mass: f64) -> Safety {
        Safety { largest_depth: LARGEST_DEPTH * mass, astray: 0.0, inside_out: false }
    }

    /// How many times as often as usual the potential must be evaluated, by the error.
    pub(super) fn times_as_often(&self) -> u32 {
        match self.astray {
            error if error > FAR_ASTRAY => 4,
            error if error > ASTRAY => 2,
            _ => 1,
        }
    }

    /// Whether `psi` is lost.
    pub(super) fn is_lost(&self) -> bool {
        self.astray > LOST
    }

    /// Whether a potential (J) is so low that a lost `psi` can be set anew.
    pub(super) fn is_found(&self, energy: f64) -> bool {
        energy < FOUND * self.largest_depth
    }

    /// Share of its velocity that the body keeps at an evaluation, if not all of it; `depth` in J.
    pub(super) fn slows(&self, depth: f64) -> Option<f32> {
        let lost = self.is_lost();
        (lost || depth > self.largest_depth).then_some(if lost { COLLAPSING } else { SLOWED })
    }

    /// Records the error of an evaluation, over the kinetic energy; `stretch` is the time since the one before, s.
    pub(super) fn strays(&mut self, error: f64, stretch: f64) {
        let kept = (1.0 - stretch / CALM_TIME).max(0.0);
        self.astray = error.max(kept * self.astray);
    }

    /// `psi` has been set anew.
    pub(super) fn forget(&mut self) {
        self.astray = 0.0;
    }

    /// Decides from the peaks of a window whether the body rests inside out. About its own rest a body moves with more energy than its
    /// potential ever holds below zero; inside out it hardly moves.
    pub(super) fn look(&mut self, window: &Window) {
        let Window { turned, most, moving, .. } = *window;
        self.inside_out = turned > moving && turned > (1.0 - LYING) * most;
    }

    /// Whether the body rests inside out.
    pub(super) fn is_inside_out(&self) -> bool {
        self.inside_out
    }

    /// At rest.
    pub(super) fn reset(&mut self) {
        (self.astray, self.inside_out) = (0.0, false);
    }
}
