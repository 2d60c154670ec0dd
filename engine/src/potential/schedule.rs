//! Schedule of a nonlinear force: when it is evaluated, and whether it acts at all.

/// Window of the peaks that decide about rest, s: some periods of the slowest coupled mode.
const WINDOW: f64 = 0.05;

/// Share of the energy under which a potential rests. *Converged* on the crash: 2e-4 moves no third
/// octave of a soft stroke by 0.1 dB, 3e-4 one by 0.11 dB, 1e-3 some by 0.2 dB.
const NEGLIGIBLE: f64 = 2e-4;

/// Share of the energy under which a potential is weak. *Converged* on the crash: no third octave moves by
/// 0.09 dB.
const WEAK: f64 = 0.05;

/// Share of `WEAK` under which it is very weak. *Converged* on the crash: no third octave moves by 0.04 dB.
const VERY_WEAK: f64 = 0.2;

/// Peaks over this window and the one before.
#[derive(Debug, Clone, Copy, Default)]
struct Peaks {
    potential: [f64; 2],
    kinetic: [f64; 2],
    /// Smallest amount by which the potential was below zero throughout, J.
    below: [f64; 2],
}

/// Result of the peaks of two windows.
pub(super) struct Window {
    /// Smallest amount by which the potential was below zero throughout, J.
    pub(super) turned: f64,
    /// Largest size of the potential, J.
    pub(super) most: f64,
    /// Largest kinetic energy, J.
    pub(super) moving: f64,
    /// Whether the force has become negligible and rests.
    pub(super) rests: bool,
}

/// Phase of the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Not evaluated until it wakes.
    Resting,
    /// Acts, but no evaluation since it woke.
    Fresh,
    /// Acts.
    Acting,
}

/// The clock of the evaluations.
pub(super) struct Schedule {
    /// Samples between evaluations: while it is strong, at least 1, and at present.
    strong_stride: u32,
    stride: u32,
    /// Share of the energy under which it is weak.
    pub(super) weak: f64,
    /// Share of the energy under which it rests.
    pub(super) negligible: f64,
    phase: Phase,
    /// It has become negligible, and rests from the next [`takes_rest`](Self::takes_rest) on.
    done: bool,
    /// Samples until the next evaluation, and since the window began.
    countdown: u32,
    window: u32,
    peaks: Peaks,
    /// Share of the energy over the last windows.
    share: f64,
}

impl Schedule {
    /// At rest; evaluated once in `stride` samples while it is strong.
    pub(super) fn new(stride: u32) -> Schedule {
        Schedule {
            strong_stride: stride.max(1),
            stride: stride.max(1),
            weak: WEAK,
            negligible: NEGLIGIBLE,
            phase: Phase::Resting,
            done: false,
            countdown: 0,
            window: 0,
            peaks: Peaks::default(),
            share: f64::INFINITY,
        }
    }

    /// Evaluates once in `stride` samples from now on.
    pub(super) fn set_stride(&mut self, stride: u32) {
        self.strong_stride = stride.max(1);
        self.stride = self.strong_stride;
        self.countdown = 0;
    }

    /// Samples from the latest evaluation to the next one.
    pub(super) fn stride(&self) -> u32 {
        self.stride
    }

    /// Samples from an evaluation to the middle of the interval it is used in.
    pub(super) fn ahead(&self) -> f64 {
        0.5 * f64::from(self.stride)
    }

    /// Time between two evaluations, s.
    pub(super) fn stretch(&self, dt: f64) -> f64 {
        f64::from(self.stride) * dt
    }

    /// Whether it acts; otherwise it rests.
    pub(super) fn is_active(&self) -> bool {
        self.phase != Phase::Resting
    }

    /// Whether it acts and has been evaluated.
    pub(super) fn is_evaluated(&self) -> bool {
        self.phase == Phase::Acting
    }

    /// Acts from now on. Returns whether it begins anew.
    pub(super) fn wake(&mut self) -> bool {
        let anew = !self.is_active() || self.done;
        if anew {
            (self.phase, self.done) = (Phase::Fresh, false);
            (self.countdown, self.window) = (0, 0);
            self.peaks = Peaks::default();
        }
        self.share = f64::INFINITY;
        anew
    }

    /// Rests.
    pub(super) fn rest(&mut self) {
        (self.phase, self.done) = (Phase::Resting, false);
    }

    /// Whether it has become negligible since the last call.
    pub(super) fn takes_rest(&mut self) -> bool {
        std::mem::take(&mut self.done)
    }

    /// Whether an evaluation is due.
    pub(super) fn is_due(&self) -> bool {
        self.countdown == 0 && !self.done
    }

    /// Schedules the next evaluation, so many times as early as usual. Returns whether the stride has changed.
    pub(super) fn set_out(&mut self, stiffness: f64, times_as_often: u32) -> bool {
        let stride = self.judge(stiffness, times_as_often);
        let changed = stride != self.stride;
        self.stride = stride;
        self.countdown = stride;
        changed
    }

    /// A sample has passed.
    pub(super) fn tick(&mut self) {
        self.countdown = self.countdown.saturating_sub(1);
    }

    /// Whether this is the first evaluation since it woke.
    pub(super) fn begins(&mut self) -> bool {
        let fresh = self.phase == Phase::Fresh;
        if fresh {
            self.phase = Phase::Acting;
        }
        fresh
    }

    /// Records the energies of an evaluation, J. Returns the result of the window at its end.
    pub(super) fn count(&mut self, potential: f64, kinetic: f64, dt: f64) -> Option<Window> {
        let Peaks { potential: p, kinetic: t, below } = &mut self.peaks;
        p[1] = p[1].max(potential.abs());
        t[1] = t[1].max(kinetic);
        below[1] = below[1].min(-potential);
        self.window += self.stride;
        if f64::from(self.window) * dt < WINDOW {
            return None;
        }
        let known = t[0] > 0.0;
        let [turned, most, moving] = [below[0].min(below[1]), p[0].max(p[1]), t[0].max(t[1])];
        let share = most / moving.max(f64::MIN_POSITIVE);
        (p[0], t[0], below[0]) = (p[1], t[1], below[1]);
        (p[1], t[1], below[1]) = (0.0, 0.0, f64::INFINITY);
        self.window = 0;
        self.share = if known { share } else { f64::INFINITY };
        let rests = self.share < self.negligible;
        self.done |= rests;
        Some(Window { turned, most, moving, rests })
    }

    /// Samples until the next evaluation. They depend on the share of the energy over the last windows, which a stroke raises
    /// at once, and on how far `psi` strays between two evaluations.
    fn judge(&mut self, stiffness: f64, times_as_often: u32) -> u32 {
        let (p, t) = (self.peaks.potential[1], self.peaks.kinetic[1]);
        if p > self.weak * t {
            self.share = self.share.max(self.weak);
        }
        // A stiffer material moves faster by the square root.
        let strong = ((f64::from(self.strong_stride) / stiffness.max(1.0).sqrt()) as u32).max(1);
        if times_as_often > 1 {
            (strong / times_as_often).max(1)
        } else if self.share < VERY_WEAK * self.weak {
            3 * strong
        } else if self.share < self.weak {
            2 * strong
        } else {
            strong
        }
    }
}
