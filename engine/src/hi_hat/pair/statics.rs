//! How two cymbals rest on each other, at any place of the rod.

use crate::contact::ContactLaw;
use crate::contact::solver::Compliances;
use crate::contact::static_equilibrium;
use crate::hi_hat::rigid::{Rigid, Weights};
use crate::hi_hat::rim_points::{self, POINTS};
use crate::modal::ModalBody;
use crate::modal::simd::rim_harmonics::RimHarmonics;

use super::rest::Rest;

/// What steady forces do.
pub(crate) struct Statics {
    /// How far the lower rim is below the upper one while the pedal is up, m.
    pub(crate) depth: [f64; POINTS],
    /// What each place feels of the upper and of the lower cymbal as stiff bodies.
    pub(crate) weights: [[Weights; POINTS]; 2],
    /// The same as [amplitudes](Rigid::around).
    pub(crate) around: [Weights; 2],
    /// Steady compliance of shells, and of shells and mounts, between the places, m/N.
    shells: Compliances<POINTS>,
    whole: Compliances<POINTS>,
}

/// Forces while nothing moves, and where everything is then.
pub(crate) struct Balance {
    pub(crate) rest: Rest,
    /// Heave and tilts of upper and lower cymbal, m.
    pub(crate) places: [[f64; 3]; 2],
    /// m.
    pub(crate) compression: [f64; POINTS],
}

impl Statics {
    /// Of cymbals that are yet to be [followed](Self::follow), so far (m) apart where they meet, at shares of the radii of the upper and the lower one.
    pub(crate) fn new(depth: [f64; POINTS], radii: [f64; 2]) -> Statics {
        let weights =
            radii.map(|radius| std::array::from_fn(|j| Rigid::weights(radius, rim_points::angle(j))));
        let none = [[0.0; POINTS]; POINTS];
        Statics { depth, weights, around: radii.map(Rigid::around), shells: none, whole: none }
    }

    /// Follows the modes of the upper and the lower cymbal; whether that changes the balance.
    pub(crate) fn follow(
        &mut self,
        bodies: [&ModalBody; 2],
        folded: &[RimHarmonics; 2],
        rigid: &[Rigid; 2],
    ) -> bool {
        let before = self.whole;
        let [above, below] = [0, 1].map(|which: usize| {
            rim_points::between_points(&bodies[which].static_compliances(&folded[which]))
        });
        for i in 0..POINTS {
            for j in 0..POINTS {
                let mounts = rigid.iter().zip(&self.weights);
                let mounts: f64 = mounts.map(|(rigid, at)| rigid.steady_compliance(&at[i], &at[j])).sum();
                self.shells[i][j] = above[i][j] + below[i][j];
                self.whole[i][j] = self.shells[i][j] + mounts;
            }
        }
        self.whole != before
    }

    /// The least way that the rod has to go until rims meet, m.
    pub(crate) fn nearest(&self) -> f64 {
        self.depth.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The balance with the rod at `y`, found from forces near it, and where the cymbals are then.
    pub(crate) fn balance(
        &self,
        y: f64,
        near: &[f64; POINTS],
        law: &ContactLaw,
        rigid: &[Rigid; 2],
    ) -> Balance {
        let overlap = self.depth.map(|depth| y - depth);
        let mut preload = *near;
        static_equilibrium::settle(law, &self.whole, &overlap, &mut preload);
        let compression = static_equilibrium::compressions(&self.whole, &overlap, &preload);
        let bend = self.shells.map(|row| -row.iter().zip(&preload).map(|(s, p)| s * p).sum::<f64>());
        let mut resting = *rigid;
        let held = self.weights.iter().zip([(y, -1.0), (0.0, 1.0)]);
        for (rigid, (weights, (rest, sign))) in resting.iter_mut().zip(held) {
            let mut place = [rest, 0.0, 0.0];
            for (weights, force) in weights.iter().zip(&preload) {
                for (i, place) in place.iter_mut().enumerate() {
                    let mut along = [0.0; 3];
                    along[i] = 1.0;
                    *place += sign * force * rigid.steady_compliance(&along, weights);
                }
            }
            rigid.put(&place);
        }
        let held: f64 = compression.iter().map(|&d| law.potential(d)).sum();
        let energy = resting[0].energy(y) + resting[1].energy(0.0) + held;
        Balance {
            rest: Rest { preload, bend, energy },
            places: [resting[0].place(), resting[1].place()],
            compression,
        }
    }

    /// All forces at the rims together with the rod held at `y`, N.
    pub(crate) fn clamping(&self, y: f64, law: &ContactLaw, rigid: &[Rigid; 2]) -> f64 {
        // By small steps, each from the one before.
        let nearest = self.nearest();
        let mut near = [0.0; POINTS];
        for step in 1..=8 {
            let at = nearest + (y - nearest) * f64::from(step) / 8.0;
            near = self.balance(at, &near, law, rigid).rest.preload;
        }
        near.iter().sum()
    }
}
