//! What keeps a nonlinear force from running away, and a plate from staying inside out.

use super::schedule::Window;

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

/// How far `psi` strays, and how deep the body is bent.
pub(super) struct Safety {
    /// Depth beyond which it yields, J.
    yields_at: f64,
    /// Largest error of the energy held of late, over the kinetic energy.
    astray: f64,
    /// Lies inside out.
    inside_out: bool,
}

impl Safety {
    /// For a body of that mass, kg.
    pub(super) fn new(mass: f64) -> Safety {
        Safety { yields_at: YIELD * mass, astray: 0.0, inside_out: false }
    }

    /// Whether the energy held strays so far that it must be evaluated more often.
    pub(super) fn is_astray(&self) -> bool {
        self.astray > ASTRAY
    }

    /// Whether `psi` is lost.
    pub(super) fn is_lost(&self) -> bool {
        self.astray > LOST
    }

    /// Whether a potential (J) is so low that a `psi` that was lost may be found anew.
    pub(super) fn is_found(&self, energy: f64) -> bool {
        energy < FOUND * self.yields_at
    }

    /// Share of its velocity that the body keeps at an evaluation, if not all of it; the depth in J.
    pub(super) fn slows(&self, depth: f64) -> Option<f32> {
        let lost = self.is_lost();
        (lost || depth > self.yields_at).then_some(if lost { COLLAPSING } else { YIELDING })
    }

    /// An evaluation has found an error, over the kinetic energy; the one before was a stretch of time (s) ago.
    pub(super) fn strays(&mut self, error: f64, stretch: f64) {
        let kept = (1.0 - stretch / CALM_TIME).max(0.0);
        self.astray = error.max(kept * self.astray);
    }

    /// `psi` has been found anew.
    pub(super) fn forget(&mut self) {
        self.astray = 0.0;
    }

    /// Judges from the peaks of a window whether the body lies inside out.
    pub(super) fn look(&mut self, window: &Window) {
        let Window { turned, most, .. } = *window;
        self.inside_out = turned > INSIDE_OUT * self.yields_at && turned > (1.0 - LYING) * most;
    }

    /// Whether the body lies inside out.
    pub(super) fn is_inside_out(&self) -> bool {
        self.inside_out
    }

    /// At rest.
    pub(super) fn reset(&mut self) {
        (self.astray, self.inside_out) = (0.0, false);
    }
}
