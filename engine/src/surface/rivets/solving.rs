//! The forces of a sample: strikers and the ends of rivets that may touch, solved together.

use crate::contact::ContactStep;
use crate::contact::force::ContactLanes;
use crate::contact::solver;
use crate::surface::body::{FreeStep, StruckBody};
use crate::surface::contacts::{Contacts, STRIKER_PLACES};

use super::motion::{ENDS, Rivet};
use super::{MOST, Rivets};

/// An end farther from the plate than this, before and after the sample without forces, is left out at first, m. *Derived*: in
/// a sample the hardest stroke moves the plate at another place by a hundredth of it.
const NEAR: f64 = 1e-4;

/// Most contacts: both ends of all rivets, all points of strikers.
const LANES: usize = 2 * MOST + STRIKER_PLACES;

/// Which end of which rivet is in a lane.
#[derive(Clone, Copy, Default)]
struct Lane {
    rivet: usize,
    end: usize,
}

/// The ends to be solved for.
struct Lanes {
    all: [Lane; 2 * MOST],
    count: usize,
}

impl Lanes {
    /// Those of the rivets that are near the plate, or all.
    fn of(rivets: &Rivets, all: bool) -> Lanes {
        let mut lanes = Lanes { all: [Lane::default(); 2 * MOST], count: 0 };
        #[cfg(test)]
        let all = all || rivets.solves_all;
        for (i, rivet) in rivets.rivets.iter().enumerate() {
            let play = rivets.built.spec.play;
            let reach = rivet.overlaps(play).into_iter().zip(Rivet::overlaps_at(rivet.free, play));
            for (end, (before, free)) in reach.enumerate() {
                if all || before.max(free) > -NEAR {
                    lanes.all[lanes.count] = Lane { rivet: i, end };
                    lanes.count += 1;
                }
            }
        }
        lanes
    }

    fn listed(&self) -> &[Lane] {
        &self.all[..self.count]
    }
}

impl Rivets {
    /// Compliance between a striker's point of that coupling and a rivet in this sample, m/N.
    pub(super) fn to_striker(&self, point: usize, coupling: f64, rivet: usize, free: &FreeStep) -> f64 {
        self.mutual.strikers[point][rivet] - coupling * self.rivets[rivet].coupling / free.divisor
    }

    /// Compliance between two rivets in this sample, m/N.
    fn between(&self, i: usize, j: usize, free: &FreeStep) -> f64 {
        self.mutual.rivets[i][j] - self.rivets[i].coupling * self.rivets[j].coupling / free.divisor
    }

    /// Steps all without forces but the weight; the plate has stepped.
    pub(super) fn fly(&mut self, body: &StruckBody, free: &FreeStep) {
        let coupled: f64 = self.rivets.iter().map(|rivet| rivet.coupling).sum();
        for (rivet, summed) in self.rivets.iter_mut().zip(self.mutual.summed) {
            rivet.mass.step();
            let ground = body.modal().displacement_at(&rivet.port) - rivet.coupling * free.mean;
            // The law gives whole forces, so the effect of all weights is added.
            let relieved = (summed - rivet.coupling * coupled / free.divisor) * self.built.weight;
            rivet.free = rivet.mass.q - ground - rivet.origin + self.built.static_compression + relieved;
            let overlaps = rivet.overlaps(self.built.spec.play);
            let reached = Rivet::overlaps_at(rivet.free, self.built.spec.play);
            for ((end, before), reached) in rivet.ends.iter_mut().zip(overlaps).zip(reached) {
                end.force = 0.0;
                if !end.touching && reached > 0.0 {
                    end.lambda = self.built.law.lambda((reached - before) / self.built.dt);
                }
            }
        }
    }

    /// Finds the forces of strikers and rivets together, and where the rivets are after the sample.
    pub(super) fn solve_with(&mut self, contacts: &mut Contacts, free: &FreeStep) {
        for all in [false, true] {
            let lanes = Lanes::of(self, all);
            match contacts.present().len() + lanes.count {
                0 => {}
                1 => self.solve_in::<1>(&lanes, contacts, free),
                2 => self.solve_in::<2>(&lanes, contacts, free),
                3..=4 => self.solve_in::<4>(&lanes, contacts, free),
                5..=8 => self.solve_in::<8>(&lanes, contacts, free),
                9..=16 => self.solve_in::<16>(&lanes, contacts, free),
                _ => self.solve_in::<LANES>(&lanes, contacts, free),
            }
            self.arrive(contacts, free);
            if all || !self.has_missed(&lanes) {
                return;
            }
        }
    }

    /// [`solve_with`](Self::solve_with) of at most `N` contacts: strikers first, then these ends.
    fn solve_in<const N: usize>(&mut self, listed: &Lanes, contacts: &mut Contacts, free: &FreeStep) {
        let (mut lanes, mut compliances) = (ContactLanes::<N>::APART, [[0.0; N]; N]);
        let n = contacts.present().len();
        for (a, &i) in contacts.present().iter().enumerate() {
            let point = contacts.point(i);
            lanes.set(a, &point.law, &point.step, point.force);
            for (b, &j) in contacts.present().iter().enumerate() {
                compliances[a][b] = contacts.stiffened(i, j);
            }
            compliances[a][a] = point.step.compliance;
            for (b, lane) in (n..).zip(listed.listed()) {
                let mutual = ENDS[lane.end] * self.to_striker(i, contacts.coupling(i), lane.rivet, free);
                (compliances[a][b], compliances[b][a]) = (mutual, mutual);
            }
        }
        for (a, lane) in (n..).zip(listed.listed()) {
            let rivet = &self.rivets[lane.rivet];
            let end = &rivet.ends[lane.end];
            let step = ContactStep {
                before: rivet.overlaps(self.built.spec.play)[lane.end],
                free: Rivet::overlaps_at(rivet.free, self.built.spec.play)[lane.end],
                compliance: self.between(lane.rivet, lane.rivet, free),
                lambda: end.lambda,
                dt: self.built.dt,
            };
            let guess = if end.touching { self.built.weight } else { 0.0 };
            lanes.set(a, &self.built.law, &step, guess);
            for (b, other) in (n..).zip(listed.listed()) {
                compliances[a][b] =
                    ENDS[lane.end] * ENDS[other.end] * self.between(lane.rivet, other.rivet, free);
            }
        }
        solver::solve(self.kernels, &mut lanes, &compliances);
        for k in 0..n {
            let i = contacts.present()[k];
            contacts.point_mut(i).force = lanes.force[k];
        }
        for (a, lane) in (n..).zip(listed.listed()) {
            self.rivets[lane.rivet].ends[lane.end].force = lanes.force[a];
        }
    }

    /// Where all rivets are after the sample.
    fn arrive(&mut self, contacts: &Contacts, free: &FreeStep) {
        for i in 0..self.rivets.len() {
            let mut moved = 0.0;
            for (j, other) in self.rivets.iter().enumerate() {
                let force = other.force();
                if force != 0.0 {
                    moved += self.between(i, j, free) * force;
                }
            }
            for &point in contacts.present() {
                moved +=
                    self.to_striker(point, contacts.coupling(point), i, free) * contacts.point(point).force;
            }
            self.rivets[i].becomes = self.rivets[i].free - moved;
        }
    }

    /// Whether an end that was left out touches after all.
    fn has_missed(&self, listed: &Lanes) -> bool {
        let mut solved = [[false; 2]; MOST];
        listed.listed().iter().for_each(|lane| solved[lane.rivet][lane.end] = true);
        self.rivets.iter().zip(solved).any(|(rivet, solved)| {
            let overlaps = Rivet::overlaps_at(rivet.becomes, self.built.spec.play);
            overlaps.into_iter().zip(solved).any(|(overlap, solved)| overlap > 0.0 && !solved)
        })
    }
}
