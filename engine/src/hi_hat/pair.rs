//! Two cymbals face to face: the lower one, how both move as a whole, and the places where their rims meet.
//!
//! Displacements are positive downward. At [`POINTS`] places around the rim the upper cymbal overlaps the lower one by
//!
//! ```text
//! d_j = w_top(j) - w_bottom(j) + bend_j - depth_j
//! ```
//!
//! with `w` both the cymbals' motion as a whole and their shells' bending, `depth` how far the lower rim is below the
//! upper one while the pedal is up, and presses with `F_j` by the law of every contact.
//!
//! Shells are measured from where the clamping has bent them, as snare wires are from where the strainer
//! holds them: with `P_j` the forces in [static equilibrium](static_equilibrium) at the present place of the rod and `bend` what
//! they bend, a shell moves by `F_j - P_j` only. Clamped cymbals that are still are exactly still, and nothing is
//! lost of the small in the large. Held by a still pedal, all of this keeps its energy to rounding. `P` and `bend`
//! follow a moving pedal over a block; what they and the rod change of the energy is the
//! [pedal's work](Pair::pedal_work).
//!
//! A touch that lasts becomes as lossy as one between rims at rest: pads of dirt and a film of air lie between them, and
//! they rub. What they lose in all is one number.
//!
//! Contacts cost nothing while the rims cannot meet: what both could reach at most is less than the way.
//!
//! Neglected: the clutch's and the seat's grip on the shells beyond their losses (they hold the mean
//! displacement); motion along the rims; the air between.

use crate::contact::ContactLaw;
use crate::contact::solver::Compliances;
use crate::fitted;
use crate::modal::simd::Kernels;
use crate::modal::simd::folded::{Amplitudes, Folded};
use crate::modal::{EARS, ModalBody, Mode, Pickup};
use crate::snapshot::RimSnapshot;
use crate::surface::contacts::STRIKER_PLACES;

use super::foot::Foot;
use super::rest::Rest;
use super::rigid::{Rigid, Weights};
use super::rim_points;
use super::rim_points::POINTS;
use super::static_equilibrium;

/// What a pair is made from.
pub struct PairParts {
    /// The lower cymbal's modes.
    pub bottom: Vec<Mode>,
    /// How they are heard from near and from far away, as at a metre, Pa s2/m of their acceleration, real and
    /// imaginary part.
    pub transfers: [Vec<[f64; 2]>; 2],
    /// What the rims feel of the modes of the upper and of the lower cymbal.
    pub folded: [Folded; 2],
    /// Both as stiff bodies.
    pub rigid: [Rigid; 2],
    /// The law of every place.
    pub law: ContactLaw,
    /// Loss of a touch that lasts, s/m.
    pub lasting_loss: f64,
    /// How far the lower rim is below the upper one while the pedal is up, m.
    pub depth: [f64; POINTS],
    /// Hz.
    pub sample_rate: f64,
}

/// Time in which a touch becomes as lossy as one that lasts, s. *By ear*.
pub(super) const SETTLING: f64 = fitted::HAT_SETTLING;

/// A place less open than this may close in a sample, m. *Derived*: what 5 m/s does in one.
pub(super) const MARGIN: f64 = 2e-4;

/// Way that a striker may push the rim within a block: at least, m, and of one that is fast, over its own. *Derived*: 5 m/s
/// for a millisecond; a light body leaves a heavy one at up to twice its speed.
const PUSHED: (f64, f64) = (5e-3, 2.0);

/// Energy under which cymbals that touch are at rest, J: 10 dB under what a piece sleeps at.
const STILL: f64 = 1e-11;

/// What the pair knows of a striker's point.
#[derive(Debug, Clone, Copy)]
pub(super) struct StrikerPlace {
    pub(super) weights: Weights,
    /// Compliance of the upper shell, and of the upper cymbal in all, between it and the rim's places, m/N.
    pub(super) shell: [f64; POINTS],
    pub(super) whole: [f64; POINTS],
}

/// The lower cymbal and all that is between it and the upper one.
pub struct Pair {
    pub(super) bottom: ModalBody,
    pub(super) pickup: Pickup,
    pub(super) folded: [Folded; 2],
    pub(super) rigid: [Rigid; 2],
    pub(super) law: ContactLaw,
    pub(super) lasting_loss: f64,
    pub(super) depth: [f64; POINTS],
    pub(super) weights: [Weights; POINTS],
    pub(super) foot: Foot,
    /// Steady compliance of shells, and of shells and mounts, between the places, m/N.
    pub(super) steady_shells: Compliances<POINTS>,
    pub(super) steady: Compliances<POINTS>,
    /// One-sample compliances, the same, m/N.
    pub(super) shells: Compliances<POINTS>,
    pub(super) whole: Compliances<POINTS>,
    /// `shells` times the preloads, m.
    pub(super) eased: [f64; POINTS],
    /// Pressure at each ear at once per force amplitude, of both, Pa/N.
    pub(super) direct: [[Amplitudes; EARS]; 2],
    /// Coupling of the places with the force beyond the upper cymbal's modes, into it as a place presses.
    pub(super) coupling: [f64; POINTS],
    pub(super) strikers: [StrikerPlace; STRIKER_PLACES],
    /// Where the pair rests, where it will once the pedal has stopped, and what of the way is left, in samples.
    pub(super) rest: Rest,
    pub(super) goal: Rest,
    pub(super) goal_place: f64,
    pub(super) way: u32,
    /// Whether both are at rest as stiff bodies.
    pub(super) still: bool,
    /// Whether rims may meet.
    pub(super) engaged: bool,
    /// `d`, N and whether they touch, by place.
    pub(super) compression: [f64; POINTS],
    pub(super) force: [f64; POINTS],
    pub(super) lambda: [f64; POINTS],
    pub(super) touching: [bool; POINTS],
    pub(super) free: [f64; POINTS],
    /// Of the present sample: force of the clutch's damper, N, and where the upper cymbal was, m.
    pub(crate) kernels: Kernels,
    pub(super) damper: f64,
    pub(super) from: f64,
    pub(super) pedal_work: f64,
    pub(super) landings: u32,
    pub(super) last_lift: u64,
    pub(super) age: u64,
    pub(super) dt: f64,
}

/// Samples in which the rest follows the rod: a block.
const FOLLOWING: u32 = 32;

impl Pair {
    /// A pair with the pedal up, at rest. Allocates.
    pub fn new(parts: PairParts) -> Pair {
        let dt = 1.0 / parts.sample_rate;
        let [near, far] = parts.transfers;
        let mut pickup = Pickup::new(near);
        pickup.transfer_mut(1).copy_from_slice(&far);
        let nowhere = StrikerPlace { weights: [0.0; 3], shell: [0.0; POINTS], whole: [0.0; POINTS] };
        Pair {
            bottom: ModalBody::new(parts.bottom, parts.sample_rate),
            pickup,
            folded: parts.folded,
            rigid: parts.rigid,
            law: parts.law,
            lasting_loss: parts.lasting_loss,
            depth: parts.depth,
            weights: std::array::from_fn(|j| Rigid::weights(1.0, rim_points::angle(j))),
            foot: Foot::new(0.0),
            steady_shells: [[0.0; POINTS]; POINTS],
            steady: [[0.0; POINTS]; POINTS],
            shells: [[0.0; POINTS]; POINTS],
            whole: [[0.0; POINTS]; POINTS],
            eased: [0.0; POINTS],
            direct: [[Amplitudes::default(); EARS]; 2],
            coupling: [0.0; POINTS],
            strikers: [nowhere; STRIKER_PLACES],
            rest: Rest::OPEN,
            goal: Rest::OPEN,
            goal_place: 0.0,
            way: 0,
            still: true,
            engaged: false,
            compression: parts.depth.map(|depth| -depth),
            force: [0.0; POINTS],
            lambda: [0.0; POINTS],
            touching: [false; POINTS],
            free: [0.0; POINTS],
            kernels: Kernels::detect(),
            damper: 0.0,
            from: 0.0,
            pedal_work: 0.0,
            landings: 0,
            last_lift: 0,
            age: 0,
            dt,
        }
    }

    /// The lower cymbal's modes and their motion.
    pub fn bottom(&self) -> &ModalBody {
        &self.bottom
    }

    /// The lower cymbal's modes and their motion, to be set up by tests.
    pub fn bottom_mut(&mut self) -> &mut ModalBody {
        &mut self.bottom
    }

    /// Upper and lower cymbal as stiff bodies.
    pub fn rigid(&self) -> &[Rigid; 2] {
        &self.rigid
    }

    /// Upper and lower cymbal as stiff bodies, to be set up by tests.
    pub fn rigid_mut(&mut self) -> &mut [Rigid; 2] {
        &mut self.rigid
    }

    /// The foot on the pedal.
    pub fn foot(&self) -> &Foot {
        &self.foot
    }

    /// The foot on the pedal, to be sent somewhere.
    pub fn foot_mut(&mut self) -> &mut Foot {
        &mut self.foot
    }

    /// Forces at the places now, N.
    pub fn forces(&self) -> &[f64; POINTS] {
        &self.force
    }

    /// Force that clamps the rims together in balance, N.
    pub fn clamped(&self) -> f64 {
        self.rest.preload.iter().sum()
    }

    /// Work of the pedal since the last reset beyond what it takes to bring resting cymbals from one rest to another, J.
    pub fn pedal_work(&self) -> f64 {
        self.pedal_work
    }

    /// Landings at the rims since the latest stroke, places apart now, and when one last lifted off.
    pub fn landings(&self) -> RimSnapshot {
        RimSnapshot {
            landings: self.landings,
            apart: self.touching.iter().filter(|&&touching| !touching).count() as u32,
            last_lift: (self.last_lift as f64 * self.dt) as f32,
            clamped: self.clamped() as f32,
            pedal: self.foot.place() as f32,
        }
    }

    /// Changes the lower cymbal's modes; `mode(k)` gives the new one. The upper one's must be changed after, and the pair
    /// follows that.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn retune(&mut self, mode: impl Fn(usize) -> Mode) {
        for k in 0..self.bottom.len() {
            self.bottom.set_mode(k, mode(k));
        }
    }

    /// Follows a change of either cymbal's modes.
    ///
    /// # Real-time
    /// Linear in the number of modes, and some microseconds.
    pub(super) fn follow_modes(&mut self, top: &ModalBody, heard: &Pickup) {
        self.bottom.tune(&mut self.pickup);
        let steady_before = self.steady;
        let bodies = [(top, &self.folded[0]), (&self.bottom, &self.folded[1])];
        let [a, b] = bodies.map(|(body, folded)| rim_points::between_points(&body.class_compliances(folded)));
        let [c, d] =
            bodies.map(|(body, folded)| rim_points::between_points(&body.static_compliances(folded)));
        for i in 0..POINTS {
            for j in 0..POINTS {
                let (wi, wj) = (&self.weights[i], &self.weights[j]);
                let steady: f64 = self.rigid.iter().map(|rigid| rigid.steady_compliance(wi, wj)).sum();
                let whole: f64 = self.rigid.iter().map(|rigid| rigid.compliance(wi, wj)).sum();
                self.shells[i][j] = a[i][j] + b[i][j];
                self.whole[i][j] = self.shells[i][j] + whole;
                self.steady_shells[i][j] = c[i][j] + d[i][j];
                self.steady[i][j] = self.steady_shells[i][j] + steady;
            }
        }
        self.direct = [
            top.folded_direct(&self.folded[0], heard),
            self.bottom.folded_direct(&self.folded[1], &self.pickup),
        ];
        self.ease();
        if self.steady == steady_before {
            return;
        }
        // The balance is another one too: what rests is there at once, what moves is led there.
        if self.still {
            self.come_to_rest();
        } else {
            self.goal_place = f64::NAN;
        }
    }

    /// Works out what hangs on the preloads.
    pub(super) fn ease(&mut self) {
        let preload = &self.rest.preload;
        self.eased = self.shells.map(|row| row.iter().zip(preload).map(|(y, p)| y * p).sum());
    }

    /// The balance with the rod at `y`, found from forces near it, and where the cymbals are then.
    fn balance(&self, y: f64, near: &[f64; POINTS]) -> (Rest, [[f64; 3]; 2], [f64; POINTS]) {
        let overlap = self.depth.map(|depth| y - depth);
        let mut preload = *near;
        static_equilibrium::settle(&self.law, &self.steady, &overlap, &mut preload);
        let compression = static_equilibrium::compressions(&self.steady, &overlap, &preload);
        let bend = self.steady_shells.map(|row| -row.iter().zip(&preload).map(|(s, p)| s * p).sum::<f64>());
        let mut resting = self.rigid;
        for (rigid, (rest, sign)) in resting.iter_mut().zip([(y, -1.0), (0.0, 1.0)]) {
            let mut place = [rest, 0.0, 0.0];
            for (weights, force) in self.weights.iter().zip(&preload) {
                for (i, place) in place.iter_mut().enumerate() {
                    let mut along = [0.0; 3];
                    along[i] = 1.0;
                    *place += sign * force * rigid.steady_compliance(&along, weights);
                }
            }
            rigid.put(&place);
        }
        let held: f64 = compression.iter().map(|&d| self.law.potential(d)).sum();
        let energy = resting[0].energy(y) + resting[1].energy(0.0) + held;
        (Rest { preload, bend, energy }, [resting[0].place(), resting[1].place()], compression)
    }

    /// All forces at the rims together with the rod held at `y`, N.
    pub fn clamping(&self, y: f64) -> f64 {
        // By small steps, each from the one before.
        let nearest = self.depth.iter().copied().fold(f64::INFINITY, f64::min);
        let mut near = [0.0; POINTS];
        for step in 1..=8 {
            let at = nearest + (y - nearest) * f64::from(step) / 8.0;
            near = self.balance(at, &near).0.preload;
        }
        near.iter().sum()
    }

    /// Comes to rest with the foot where it is to go; shells as they are.
    pub fn come_to_rest(&mut self) {
        self.foot.jump();
        let (rest, places, compression) = self.balance(self.foot.place(), &self.goal.preload);
        (self.rest, self.goal, self.goal_place, self.way) = (rest, rest, self.foot.place(), 0);
        self.rigid.iter_mut().zip(&places).for_each(|(rigid, place)| rigid.put(place));
        (self.compression, self.force) = (compression, rest.preload);
        self.touching = compression.map(|d| d > 0.0);
        self.lambda = [self.lasting_loss; POINTS];
        (self.engaged, self.still) = (false, true);
        self.ease();
    }

    /// Overlap at the places with both shells as they are, m.
    pub(super) fn overlaps(&self, top: &ModalBody) -> [f64; POINTS] {
        let mut shells = top.folded_displacement(&self.folded[0]);
        let below = self.bottom.folded_displacement(&self.folded[1]);
        shells.as_flattened_mut().iter_mut().zip(below.as_flattened()).for_each(|(a, b)| *a -= b);
        let shells = self.kernels.vectorized(
            #[inline(always)]
            || rim_points::at_points(&shells),
        );
        std::array::from_fn(|j| shells[j] + self.apart(j))
    }

    /// What of the overlap is not the shells' motion, m.
    fn apart(&self, j: usize) -> f64 {
        let weights = &self.weights[j];
        self.rigid[0].at(weights) - self.rigid[1].at(weights) + self.rest.bend[j] - self.depth[j]
    }

    /// Takes care of the rims from now on, until the next [look](Self::look) says otherwise.
    pub fn engage(&mut self, top: &ModalBody) {
        self.still = false;
        if !self.engaged {
            self.engaged = true;
            self.compression = self.overlaps(top);
        }
    }

    /// Whether any place touches.
    pub fn is_touching(&self) -> bool {
        self.touching.contains(&true)
    }

    /// Energy beyond that of rest, J: of the lower shell, of both cymbals as a whole and of the contacts.
    pub(super) fn held_energy(&self) -> f64 {
        self.bottom.energy() + self.held()
    }

    /// The part of it that the pedal can change.
    pub(super) fn held(&self) -> f64 {
        let contacts: f64 = (0..POINTS)
            .filter(|&j| self.touching[j] || self.rest.preload[j] != 0.0)
            .map(|j| {
                let shells = self.compression[j] - self.apart(j);
                self.law.potential(self.compression[j]) - self.rest.preload[j] * shells
            })
            .sum();
        self.rigid[0].energy(self.foot.place()) + self.rigid[1].energy(0.0) + contacts - self.rest.energy
    }

    /// Once a block: follows the rod, zeroes what has decayed, looks whether rims may meet. The fastest of the strikers
    /// about the upper cymbal, if there are any, comes so far (m) in a block.
    ///
    /// # Real-time
    /// Linear in the number of modes, and some microseconds while the pedal moves.
    pub(super) fn look(&mut self, top: &ModalBody, strikers: Option<f64>) -> Settled {
        let pushed = strikers.map_or(0.0, |way| PUSHED.0.max(PUSHED.1 * way));
        let strikers = strikers.is_some();
        self.bottom.flush_quiet();
        let finite = self.bottom.is_finite()
            && self.rigid.iter().all(Rigid::is_finite)
            && self.compression.iter().all(|d| d.is_finite());
        if !finite {
            return Settled::Broken;
        }
        if self.goal_place != self.foot.place() {
            self.goal = self.balance(self.foot.place(), &self.goal.preload).0;
            (self.goal_place, self.way) = (self.foot.place(), FOLLOWING);
        }
        if self.foot.moves() || self.way > 0 {
            self.engage(top);
            return Settled::Moving;
        }
        let touching = self.is_touching();
        if !strikers && touching && self.held() < STILL && self.held_energy() + top.energy() < STILL {
            self.bottom.reset();
            self.come_to_rest();
            return Settled::Parked;
        }
        if touching || self.may_meet(top, pushed) {
            self.engage(top);
        } else {
            self.engaged = false;
            if !strikers && !self.still && self.held() < STILL * 1e-3 {
                self.come_to_rest();
            }
        }
        Settled::Moving
    }

    /// Whether the rims might meet if left alone, or brought nearer by so much (m).
    fn may_meet(&self, top: &ModalBody, nearer: f64) -> bool {
        let y = self.foot.place();
        let nearest = self.depth.iter().copied().fold(f64::INFINITY, f64::min) - y - nearer;
        let stiff = self.rigid[0].reach(y) + self.rigid[1].reach(0.0);
        nearest < stiff
            || nearest < stiff + top.folded_reach(&self.folded[0]) + self.bottom.folded_reach(&self.folded[1])
    }
}

/// What a block's look has found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Settled {
    /// Something moves.
    Moving,
    /// The cymbals rest on each other; the upper shell is to be put to rest too.
    Parked,
    /// A value is not a number.
    Broken,
}
