//! The contact system of a struck body: exciters, contact points, and their forces.
//!
//! An [exciter](Exciter) consists of a few oscillators with one or two contact points. Exciters and modes integrate a force held
//! over the sample exactly. A contact is therefore one scalar equation, and several contacts are a small system of such
//! equations, which the [solver] solves.
//!
//! Strikers come first; exciters of attachments follow, with [`ATTACHED_POINTS`] each.

use crate::contact::ContactStep;
use crate::contact::force::ContactLanes;
use crate::contact::solver::{self, Compliances};
use crate::modal::simd::Kernels;
use crate::stick::Beams;

use super::body::{FreeStep, StruckBody};
use super::exciter::{ContactPoint, Exciter, Ground};

/// Strikers that one body can have at a time; the one that has been away longest is replaced.
pub const MAX_STRIKERS: usize = 4;

/// Points a striker has: its tip and its shaft.
pub(super) const STRIKER_POINTS: usize = 2;

/// Points of all strikers, which come before all others.
pub const STRIKER_PLACES: usize = STRIKER_POINTS * MAX_STRIKERS;

/// Points of every exciter of an attachment.
pub const ATTACHED_POINTS: usize = 4;

/// Most points.
const MAX_POINTS: usize = solver::MAX_CONTACTS;

/// The exciter of a point.
pub(super) const fn owner(point: usize) -> usize {
    if point < STRIKER_PLACES {
        point / STRIKER_POINTS
    } else {
        MAX_STRIKERS + (point - STRIKER_PLACES) / ATTACHED_POINTS
    }
}

/// The points of an exciter.
pub(super) const fn points_of(exciter: usize) -> std::ops::Range<usize> {
    if exciter < MAX_STRIKERS {
        STRIKER_POINTS * exciter..STRIKER_POINTS * (exciter + 1)
    } else {
        let point = STRIKER_PLACES + ATTACHED_POINTS * (exciter - MAX_STRIKERS);
        point..point + ATTACHED_POINTS
    }
}

/// All contacts of one body.
pub struct Contacts {
    /// Strikers, then those of attachments.
    pub(super) exciters: Vec<Exciter>,
    /// Tip and shaft of every striker, then the points of every other exciter.
    pub(super) points: Vec<ContactPoint>,
    /// Points present.
    present: [usize; MAX_POINTS],
    count: usize,
    /// One-sample compliance between present points, of the modes and the exciters, m/N.
    pub(super) compliance: Compliances,
    /// Each point's coupling with the nonlinear force.
    pub(super) coupling: [f64; MAX_POINTS],
    /// The same, stiffened by the nonlinear force, m/N.
    stiffened: Compliances,
    /// How sticks bend, worked out beforehand.
    pub(super) beams: Beams,
    /// Whether all contacts are lossless.
    lossless: bool,
    /// Length of a sample, s.
    dt: f64,
}

impl Contacts {
    /// Changes the body's displacement; strikers move along, their compressions stay.
    pub fn carry_by<T>(&mut self, body: &mut StruckBody, change: impl FnOnce(&mut StruckBody) -> T) -> T {
        self.shift_origins(body, 1.0);
        let changed = change(body);
        self.shift_origins(body, -1.0);
        changed
    }

    /// Adds a share of the body's present displacement to the origins of the contacts with it.
    fn shift_origins(&mut self, body: &StruckBody, share: f64) {
        for n in 0..self.present().len() {
            let point = self.point_mut(self.present()[n]);
            if point.ground == Ground::Body {
                point.origin += share * body.modal().displacement_at(&point.port);
            }
        }
    }

    /// No contacts yet, on a body of so many modes; a sample lasts `dt` s. Allocates.
    pub fn new(modes: usize, lossless: bool, dt: f64) -> Contacts {
        Contacts {
            beams: Beams::prepare(),
            exciters: (0..MAX_STRIKERS).map(|_| Exciter::absent(dt)).collect(),
            points: (0..STRIKER_PLACES).map(|_| ContactPoint::absent(modes, dt)).collect(),
            present: [0; MAX_POINTS],
            count: 0,
            compliance: [[0.0; MAX_POINTS]; MAX_POINTS],
            coupling: [0.0; MAX_POINTS],
            stiffened: [[0.0; MAX_POINTS]; MAX_POINTS],
            lossless,
            dt,
        }
    }

    /// Whether all contacts are lossless.
    pub fn is_lossless(&self) -> bool {
        self.lossless
    }

    /// Length of a sample, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Adds an exciter with points of its own. Allocates.
    ///
    /// # Panics
    /// If there are more points than the solver takes (debug builds).
    pub fn add(&mut self, exciter: Exciter, points: [ContactPoint; ATTACHED_POINTS]) {
        debug_assert!(self.points.len() + ATTACHED_POINTS <= MAX_POINTS);
        self.exciters.push(exciter);
        self.points.extend(points);
    }

    /// Sets the number of modes of the body that the shafts of strikers meet. Allocates.
    pub fn set_shaft_modes(&mut self, modes: usize) {
        for shaft in self.points[..STRIKER_PLACES].iter_mut().skip(1).step_by(STRIKER_POINTS) {
            *shaft = ContactPoint::absent(modes, self.dt);
        }
    }

    /// The points present.
    pub fn present(&self) -> &[usize] {
        &self.present[..self.count]
    }

    /// Whether no point is present.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Lists the points present, after some have come or gone.
    pub fn list(&mut self) {
        self.count = 0;
        for (i, _) in self.points.iter().enumerate().filter(|(_, point)| point.present) {
            self.present[self.count] = i;
            self.count += 1;
        }
    }

    /// A point.
    pub fn point(&self, i: usize) -> &ContactPoint {
        &self.points[i]
    }

    /// A point, to be set.
    pub fn point_mut(&mut self, i: usize) -> &mut ContactPoint {
        &mut self.points[i]
    }

    /// The exciter that a point belongs to.
    pub fn exciter(&self, point: usize) -> &Exciter {
        &self.exciters[owner(point)]
    }

    /// The exciter that a point belongs to, to be set.
    pub fn exciter_mut(&mut self, point: usize) -> &mut Exciter {
        &mut self.exciters[owner(point)]
    }

    /// Compliance between two present points in this sample, m/N.
    pub fn stiffened(&self, i: usize, j: usize) -> f64 {
        self.stiffened[i][j]
    }

    /// A point's coupling with the nonlinear force, m over the root of J, as [`NonlinearForce::coupling`] has it.
    ///
    /// [`NonlinearForce::coupling`]: crate::potential::NonlinearForce::coupling
    pub fn coupling(&self, i: usize) -> f64 {
        self.coupling[i]
    }

    /// Whether strikers are present.
    pub fn is_struck(&self) -> bool {
        self.exciters[..MAX_STRIKERS].iter().any(|striker| striker.present)
    }

    /// Speed of arrival of the fastest striker present, m/s.
    pub fn fastest_striker(&self) -> Option<f64> {
        let about = self.exciters[..MAX_STRIKERS].iter().filter(|striker| striker.present);
        self.is_struck().then(|| about.map(|striker| striker.speed).fold(0.0, f64::max))
    }

    /// Energy of an exciter and its contacts, J.
    pub(super) fn energy_of(&self, exciter: usize) -> f64 {
        let points = self.points[points_of(exciter)].iter().filter(|point| point.present);
        self.exciters[exciter].energy() + points.map(ContactPoint::energy).sum::<f64>()
    }

    /// Energy of those exciters that are present and of their contacts, J.
    pub(super) fn energy(&self, which: std::ops::Range<usize>) -> f64 {
        which.filter(|&i| self.exciters[i].present).map(|i| self.energy_of(i)).sum()
    }

    /// Energy of the motion of those exciters that are present, J.
    pub(super) fn motion(&self, which: std::ops::Range<usize>) -> f64 {
        self.exciters[which].iter().filter(|exciter| exciter.present).map(Exciter::motion).sum()
    }

    /// Whether every present compression is a finite number.
    pub(super) fn is_finite(&self) -> bool {
        self.present().iter().all(|&i| self.points[i].compression.is_finite())
    }

    /// Removes all.
    pub(super) fn reset(&mut self) {
        for exciter in &mut self.exciters {
            // The exciter that the next stroke takes depends on all of these.
            (exciter.present, exciter.age) = (false, 0);
        }
        for point in &mut self.points {
            (point.present, point.touching) = (false, false);
        }
        self.list();
    }

    /// Updates the stiffened compliance of a sample: the nonlinear force subtracts a matrix of rank one.
    pub(super) fn stiffen(&mut self, body: &StruckBody, free: &FreeStep) {
        if self.count == 0 {
            return;
        }
        let present = &self.present[..self.count];
        for &i in present {
            for &j in present {
                self.stiffened[i][j] = self.compliance[i][j];
            }
        }
        if body.acting_force().is_none() {
            return;
        }
        if free.recoupled {
            for &i in present.iter().filter(|&&i| self.points[i].ground == Ground::Body) {
                self.coupling[i] = body.coupling(&self.points[i].port);
            }
        }
        for &i in present {
            for &j in present {
                self.stiffened[i][j] -= self.coupling[i] * self.coupling[j] / free.divisor;
            }
        }
    }

    /// Lets all exciters step without force.
    pub(super) fn step(&mut self) {
        self.exciters.iter_mut().filter(|exciter| exciter.present).for_each(Exciter::step);
    }

    /// Displacement of point `i` out of the body by the forces of all other points, m.
    pub(super) fn moved_by_others(&self, i: usize) -> f64 {
        let others = self.present().iter().filter(|&&j| j != i);
        others.map(|&j| self.stiffened[i][j] * self.points[j].pressing()).sum()
    }

    /// Finds the forces of all points for this sample.
    ///
    /// # Real-time
    /// See [`solver::solve`].
    pub fn solve(&mut self, kernels: Kernels) {
        match self.count {
            0 => {}
            1 => self.solve_in::<1>(kernels),
            2 => self.solve_in::<2>(kernels),
            3..=4 => self.solve_in::<4>(kernels),
            5..=8 => self.solve_in::<8>(kernels),
            _ => self.solve_in::<MAX_POINTS>(kernels),
        }
    }

    /// [`solve`](Self::solve) of at most `N` points.
    fn solve_in<const N: usize>(&mut self, kernels: Kernels) {
        let (mut lanes, mut compliances) = (ContactLanes::<N>::APART, [[0.0; N]; N]);
        let present = &self.present[..self.count];
        for (n, &i) in present.iter().enumerate() {
            let point = &self.points[i];
            // The preloads of the others are part of equilibrium: what they would push is put back.
            let mut free = point.step.free - self.stiffened[i][i] * point.preload;
            for (compliance, &j) in compliances[n].iter_mut().zip(present) {
                *compliance = self.stiffened[i][j];
                free += *compliance * self.points[j].preload;
            }
            compliances[n][n] = point.step.compliance;
            lanes.set(n, &point.law, &ContactStep { free, ..point.step }, point.force);
        }
        solver::solve(kernels, &mut lanes, &compliances);
        present.iter().zip(lanes.force).for_each(|(&i, force)| self.points[i].force = force);
    }
}
