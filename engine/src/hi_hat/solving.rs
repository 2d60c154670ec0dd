//! The forces of a sample: rim points that may touch, and strikers, solved together (see [the solver](crate::contact::solver)).

use crate::contact::ContactStep;
use crate::contact::force::ContactLanes;
use crate::contact::solver;
use crate::surface::contacts::{Contacts, STRIKER_PLACES};

use super::near_points::Near;
use super::pair::Pair;
use super::rim_points::POINTS;

/// Most contacts of strikers and of rims.
const MOST: usize = STRIKER_PLACES + POINTS;

/// A gap smaller than this may close within a sample, m, whether or not forces act. *Derived*: the way of 5 m/s in a sample.
const MARGIN: f64 = 2e-4;

/// Points farther apart than this without forces are left out at first, m. *Judgement*: forces at the other points move a rim by
/// less in nearly every sample, and in the others [all are solved for](Pair::solve_rims).
const NEAR: f64 = 1e-5;

impl Pair {
    /// Whether any point may touch by the end of the sample; both cymbals have stepped freely.
    pub(super) fn is_near(&self) -> bool {
        self.engaged && (0..POINTS).any(|j| self.gap(j) < MARGIN)
    }

    /// Gap at a point during the sample if no force acts, m.
    fn gap(&self, j: usize) -> f64 {
        -self.rims.free[j].max(self.rims.compression[j])
    }

    /// Points whose gaps are smaller than this, m.
    fn nearer_than(&self, gap: f64) -> Near {
        let mut near = Near::default();
        for j in 0..POINTS {
            if self.gap(j) < gap {
                near.add(j);
            }
        }
        near
    }

    /// Finds the forces at the rims, and those of strikers if they may touch. `divisor` is the dimensionless `2 + G` of the upper
    /// cymbal's nonlinear force.
    pub(super) fn solve_rims(&mut self, mut strikers: Option<&mut Contacts>, divisor: f64) {
        for gap in [NEAR, f64::INFINITY] {
            let near = self.nearer_than(gap);
            let present = strikers.as_ref().map_or(0, |contacts| contacts.present().len());
            match near.count + present {
                0..=4 => self.solve_in::<4>(&near, strikers.as_deref_mut(), divisor),
                5..=8 => self.solve_in::<8>(&near, strikers.as_deref_mut(), divisor),
                9..=16 => self.solve_in::<16>(&near, strikers.as_deref_mut(), divisor),
                17..=24 => self.solve_in::<24>(&near, strikers.as_deref_mut(), divisor),
                _ => self.solve_in::<MOST>(&near, strikers.as_deref_mut(), divisor),
            }
            let reached = match strikers.as_deref() {
                Some(contacts) => self.reached(pressing(contacts), divisor),
                None => self.reached(std::iter::empty(), divisor),
            };
            if (0..POINTS).all(|j| self.gap(j) < gap || reached[j] <= 0.0) {
                return;
            }
        }
    }

    /// Compressions at the end of the sample with the present forces, m. `strikers` are points, their forces (N) and their coupling with
    /// the nonlinear force.
    pub(super) fn reached(
        &self,
        strikers: impl Iterator<Item = (usize, f64, f64)> + Clone,
        divisor: f64,
    ) -> [f64; POINTS] {
        let (rims, dynamics) = (&self.rims, &self.dynamics);
        let of_strikers: f64 = strikers.clone().map(|(_, force, u)| force * u).sum();
        let of_rims: f64 = rims.force.iter().zip(&dynamics.coupling).map(|(force, u)| force * u).sum();
        let coupled = (of_strikers + of_rims) / divisor;
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let mut reached = rims.free;
                // Of a symmetric matrix rows are columns.
                for (row, force) in dynamics.whole.iter().zip(&rims.force).filter(|(_, force)| **force != 0.0)
                {
                    reached.iter_mut().zip(row).for_each(|(reached, y)| *reached -= y * force);
                }
                for (point, force, _) in strikers {
                    let row = &self.strikers[point].whole;
                    reached.iter_mut().zip(row).for_each(|(reached, y)| *reached -= y * force);
                }
                reached.iter_mut().zip(&dynamics.coupling).for_each(|(reached, u)| *reached += u * coupled);
                reached
            },
        )
    }

    /// [`solve_rims`](Self::solve_rims) of at most `N` contacts: the rims' first.
    fn solve_in<const N: usize>(&mut self, near: &Near, strikers: Option<&mut Contacts>, divisor: f64) {
        self.dynamics.collect(near);
        let mut compliances = self.kernels.vectorized(
            #[inline(always)]
            || self.dynamics.near.less::<N>(&self.dynamics.coupling, divisor),
        );
        let mut lanes = ContactLanes::<N>::APART;
        for (lane, &i) in near.listed().iter().enumerate() {
            let step = ContactStep {
                before: self.rims.compression[i],
                free: self.rims.free[i],
                compliance: self.dynamics.whole[i][i],
                lambda: self.rims.lambda[i],
                dt: self.dt,
            };
            lanes.set(lane, &self.rims.law, &step, self.rims.force[i]);
        }
        let Some(contacts) = strikers else {
            solver::solve(self.kernels, &mut lanes, &compliances);
            self.take(near, &lanes.force);
            return;
        };
        for (k, &i) in contacts.present().iter().enumerate() {
            let (lane, point) = (near.count + k, contacts.point(i));
            lanes.set(lane, &point.law, &point.step, point.force);
            for (compliance, &j) in compliances[lane][near.count..].iter_mut().zip(contacts.present()) {
                *compliance = contacts.stiffened(i, j);
            }
            compliances[lane][lane] = point.step.compliance;
            for (rim, &j) in near.listed().iter().enumerate() {
                let mutual = self.stiffened_to(i, contacts.coupling(i), j, divisor);
                (compliances[lane][rim], compliances[rim][lane]) = (mutual, mutual);
            }
        }
        solver::solve(self.kernels, &mut lanes, &compliances);
        self.take(near, &lanes.force);
        for k in 0..contacts.present().len() {
            let i = contacts.present()[k];
            contacts.point_mut(i).force = lanes.force[near.count + k];
        }
    }

    /// Takes the forces (N) found at these points; there are none at the others.
    fn take(&mut self, near: &Near, found: &[f64]) {
        self.rims.force = [0.0; POINTS];
        for (&j, force) in near.listed().iter().zip(found) {
            self.rims.force[j] = *force;
        }
    }

    /// Compliance between a striker of that coupling and a rim point, m/N.
    pub(super) fn stiffened_to(&self, point: usize, coupling: f64, j: usize, divisor: f64) -> f64 {
        self.strikers[point].whole[j] - coupling * self.dynamics.coupling[j] / divisor
    }
}

/// Strikers' points present, their forces (N) and their coupling with the nonlinear force.
pub(super) fn pressing(contacts: &Contacts) -> impl Iterator<Item = (usize, f64, f64)> + Clone + '_ {
    contacts.present().iter().map(|&i| (i, contacts.point(i).force, contacts.coupling(i)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::BLOCK;
    use crate::build_context::BuildOptions;
    use crate::hi_hat::HiHat;
    use crate::instrument::{Instrument as _, Pedal as _};
    use crate::modal::RECEIVERS;
    use crate::reference;
    use crate::strike::{Strike, Striker};

    #[test]
    fn points_that_are_left_out_would_not_have_touched() {
        let context = reference::standard("hi-hat").context(BuildOptions::new(44_100.0));
        let mut hat = HiHat::new(&reference::hi_hat(), &context).unwrap();
        let mut fewer = 0;
        for pedal in [0.46, 0.48, 0.8, 1.0] {
            hat.press(pedal, crate::hi_hat::foot::SPEED.1);
            hat.finish_controls();
            let surface = hat.surface_mut();
            surface.reset();
            surface.strike(&Strike { striker: Striker::Shoulder, speed: 5.0, radius: 0.97, angle: 0.0 });
            for _ in 0..60 {
                let mut sound = [[0.0; BLOCK]; RECEIVERS];
                surface.settle();
                surface.render_in_air(sound.each_mut().map(|row| &mut row[..]), None);
                let pair = surface.attachment_mut::<Pair>().unwrap();
                if !pair.is_near() {
                    continue;
                }
                // The last sample's start, or one like it.
                fewer += usize::from(pair.nearer_than(NEAR).count < POINTS);
                pair.solve_rims(None, 2.1);
                let few = pair.rims.force;
                pair.solve_in::<MOST>(&pair.nearer_than(f64::INFINITY), None, 2.1);
                let largest = few.iter().fold(0.0_f64, |most, force| most.max(*force));
                for (j, (few, all)) in few.iter().zip(&pair.rims.force).enumerate() {
                    assert!((few - all).abs() <= 1e-8 * largest, "pedal {pedal}, point {j}: {few} {all} N");
                }
            }
        }
        assert!(fewer > 60, "{fewer}");
    }
}
