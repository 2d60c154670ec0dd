//! A pair of cymbals: the lower one, the rigid motion of both, and the contacts of their rims.
//!
//! Displacements are positive downward. At [`POINTS`] points around the rim the upper cymbal overlaps the lower one by
//!
//! ```text
//! d_j = w_top(j) - w_bottom(j) + bend_j - depth_j
//! ```
//!
//! with `w` the sum of rigid motion and shell deflection, and `depth` the gap of the rims while the pedal is up. The force is
//! `F_j` by the law of every contact.
//!
//! The shells' displacements are measured from their static deflection under the clamping, as those of snare wires are from the
//! strainer's. Let `P_j` be the forces in [static equilibrium](crate::contact::static_equilibrium) at the present position of the
//! rod, and `bend` the deflection by them. A shell then moves under `F_j - P_j` only. Clamped cymbals at rest are exactly at rest,
//! and small motion keeps its precision. With a still pedal the energy is conserved to rounding. Under a moving pedal `P` and `bend`
//! are renewed once a block, and what the deflection gains is taken from the displacement: nothing moves by it, so that the sound
//! does not depend on what is measured from. The change of energy by it and by the rod is the [pedal's work](Pair::pedal_work).
//!
//! The loss of a lasting contact approaches that of rims at rest, which have dirt and air between them and rub. One number stands
//! for all of these losses.
//!
//! The [air between](super::gap_air) acts between samples.
//!
//! Contacts cost nothing while the largest possible motion of both rims is smaller than the gap.
//!
//! The upper cymbal's lobes [turn](crate::surface::swing) as it tilts, and with them what is heard of the rims' forces at once, once a block.
//!
//! Neglected: the stiffness of clutch and seat against deflection of the shells (they hold the mean displacement); motion along
//! the rims; that the lower cymbal's lobes turn, which leans on a stiffer seat.

pub(super) mod arrival;
mod pedal;
mod rest;
mod state;
mod statics;

use crate::contact::ContactLaw;
use crate::modal::simd::Kernels;
use crate::modal::simd::rim_harmonics::RimHarmonics;
use crate::modal::{ModalBody, Mode, ReceiverWeights};
use crate::snapshot::RimSnapshot;
use crate::surface::body::SoundingBody;
use crate::surface::contacts::STRIKER_PLACES;

use super::foot::Foot;
use super::gap_air::GapAir;
use super::rigid::{Rigid, Weights};
use super::rigid_sound::RigidSound;
use super::rim_points::{self, POINTS};

use pedal::Pedal;
use rest::Rest;
use state::{Dynamics, RimState, StrikerPlace};
use statics::{Balance, Statics};

/// Parts of a pair.
pub struct PairParts {
    /// The lower cymbal's modes.
    pub bottom: Vec<Mode>,
    /// Their transfers to each point, far away as at a metre, Pa s2/m of their acceleration, real and imaginary part.
    pub transfers: [Vec<[f64; 2]>; crate::receiver::POINTS],
    /// Shapes of the modes of the upper and the lower cymbal at the rim.
    pub folded: [RimHarmonics; 2],
    /// Both as rigid bodies.
    pub rigid: [Rigid; 2],
    /// How both are heard as such.
    pub rigid_sounds: [RigidSound; 2],
    /// The air between them, if the rims shut it in.
    pub air: Option<GapAir>,
    /// The law of every point.
    pub law: ContactLaw,
    /// Loss of a lasting contact, s/m.
    pub lasting_loss: f64,
    /// Gap of the rims while the pedal is up, m.
    pub depth: [f64; POINTS],
    /// Where they meet, shares of the radii of the upper and the lower cymbal.
    pub meeting: [f64; 2],
    /// Hz.
    pub sample_rate: f64,
}

/// The lower cymbal and its contacts with the upper one.
pub struct Pair {
    /// The lower shell.
    pub(super) lower: SoundingBody,
    pub(super) folded: [RimHarmonics; 2],
    pub(super) rigid: [Rigid; 2],
    pub(super) statics: Statics,
    pub(super) dynamics: Dynamics,
    pub(super) rims: RimState,
    pub(super) pedal: Pedal,
    pub(super) strikers: [StrikerPlace; STRIKER_PLACES],
    /// Heave and tilts by which the upper cymbal was displaced together with the strikers at it, m.
    pub(super) carried: Weights,
    /// Whether both are at rest as rigid bodies.
    pub(super) still: bool,
    /// Whether rims may meet.
    pub(super) engaged: bool,
    /// Retunings of both shells when the balance last followed them.
    followed: Option<[u64; 2]>,
    pub(super) kernels: Kernels,
    pub(super) dt: f64,
}

impl Pair {
    /// A pair with the pedal up, at rest. Allocates.
    pub fn new(parts: PairParts) -> Pair {
        let [near, ..] = &parts.transfers;
        let mut lower = SoundingBody::new(parts.bottom, near.clone(), parts.sample_rate);
        for (point, transfers) in parts.transfers.iter().enumerate() {
            lower.receiver.transfer_mut(point).copy_from_slice(transfers);
        }
        Pair {
            lower,
            folded: parts.folded,
            rigid: parts.rigid,
            statics: Statics::new(parts.depth, parts.meeting),
            dynamics: Dynamics::new(parts.rigid_sounds, parts.air),
            rims: RimState::new(parts.law, parts.lasting_loss, parts.depth),
            pedal: Pedal::up(1.0 / parts.sample_rate),
            strikers: [StrikerPlace::default(); STRIKER_PLACES],
            carried: [0.0; 3],
            still: true,
            engaged: false,
            followed: None,
            kernels: Kernels::detect(),
            dt: 1.0 / parts.sample_rate,
        }
    }

    /// The lower cymbal's modes and their motion.
    pub fn bottom(&self) -> &ModalBody {
        &self.lower.modal
    }

    /// The lower cymbal's modes and their motion, to be set up by tests.
    pub fn bottom_mut(&mut self) -> &mut ModalBody {
        &mut self.lower.modal
    }

    /// Upper and lower cymbal as rigid bodies.
    pub fn rigid(&self) -> &[Rigid; 2] {
        &self.rigid
    }

    /// Upper and lower cymbal as rigid bodies, to be set up by tests.
    pub fn rigid_mut(&mut self) -> &mut [Rigid; 2] {
        &mut self.rigid
    }

    /// The foot on the pedal.
    pub fn foot(&self) -> &Foot {
        &self.pedal.foot
    }

    /// Whether the foot moves or will move.
    pub fn is_moved(&self) -> bool {
        self.pedal.foot.moves() || self.pedal.arrival.is_some()
    }

    /// The foot on the pedal, to be moved.
    pub fn foot_mut(&mut self) -> &mut Foot {
        &mut self.pedal.foot
    }

    /// Present forces at the rim points, N.
    pub fn forces(&self) -> &[f64; POINTS] {
        &self.rims.force
    }

    /// Static force that clamps the rims together, N.
    pub fn clamped(&self) -> f64 {
        self.pedal.rest.preload.iter().sum()
    }

    /// Energy of the air between them, J.
    pub fn air_energy(&self) -> f64 {
        self.dynamics.air.as_ref().map_or(0.0, GapAir::energy)
    }

    /// Work of the pedal since the last reset, less the change of the static energy, J.
    pub fn pedal_work(&self) -> f64 {
        self.pedal.work
    }

    /// Landings at the rims since the latest stroke, points open at present, and the time of the last lift.
    pub fn landings(&self) -> RimSnapshot {
        RimSnapshot {
            landings: self.rims.landings,
            apart: self.rims.touching.iter().filter(|&&touching| !touching).count() as u32,
            last_lift: (self.rims.last_lift as f64 * self.dt) as f32,
            clamped: self.clamped() as f32,
            pedal: self.pedal.foot.place() as f32,
        }
    }

    /// Changes the lower cymbal's modes; `mode(k)` gives the new one. The upper one's must be changed after, and the pair
    /// follows that.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn retune(&mut self, mode: impl Fn(usize) -> Mode) {
        self.lower.modal.set_modes(|k, _| mode(k));
    }

    /// Follows a change of either cymbal's modes.
    ///
    /// # Real-time
    /// Linear in the number of modes, and some microseconds.
    pub(super) fn follow_modes(&mut self, top: &ModalBody, receiver: &ReceiverWeights) {
        self.lower.follow();
        let bodies = [(top, receiver), (&self.lower.modal, &self.lower.receiver)];
        // Losses do not move the balance, and a hand or rubbing rims change them while sound plays.
        let retunings = bodies.map(|(body, _)| body.retunings());
        let changed = self.followed != Some(retunings)
            && self.statics.follow(bodies.map(|(body, _)| body), &self.folded, &self.rigid);
        self.followed = Some(retunings);
        self.dynamics.follow(bodies, &self.folded, &self.rigid, &self.statics.weights);
        self.dynamics.update_offset(&self.pedal.rest.preload);
        if let Some(air) = &mut self.dynamics.air {
            air.follow([(top, receiver), (&self.lower.modal, &self.lower.receiver)]);
        }
        if !changed {
            return;
        }
        // The equilibrium changes too. Cymbals at rest take it at once; moving ones are led there.
        if self.still {
            self.come_to_rest();
        } else {
            self.pedal.goal_place = f64::NAN;
        }
    }

    /// Follows the upper cymbal's receiver weights, which move while it swings.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn follow_swing(&mut self, top: &ModalBody, receiver: &ReceiverWeights) {
        let bodies = [(top, receiver), (&self.lower.modal, &self.lower.receiver)];
        self.dynamics.follow_receivers(bodies, &self.folded);
        self.dynamics.air.iter_mut().for_each(|air| air.follow(bodies));
    }

    /// Measures the shells' displacements from another equilibrium. Nothing moves by that: what the static deflection gains is taken
    /// from the displacement. The energy above that at rest changes, which is part of the pedal's work.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn measure_from(&mut self, rest: Rest, top: &mut ModalBody) {
        let before = self.held_energy() + top.energy();
        let gained = std::array::from_fn(|j| rest.preload[j] - self.pedal.rest.preload[j]);
        let down = rim_points::rounded(&rim_points::amplitudes(&gained));
        top.displace_folded(&self.folded[0], &down);
        self.lower.modal.displace_folded(&self.folded[1], &down.map(|pair| pair.map(|x| -x)));
        self.pedal.arrive(rest);
        self.dynamics.update_offset(&rest.preload);
        self.pedal.work += self.held_energy() + top.energy() - before;
    }

    /// All forces at the rims together with the rod held at `y`, N.
    pub fn clamping(&self, y: f64) -> f64 {
        self.statics.clamping(y, &self.rims.law, &self.rigid)
    }

    /// Comes to rest with the foot at its goal; the shells stay as they are.
    ///
    /// # Real-time
    /// Linear in the number of modes, and some ten microseconds if rims touch.
    pub fn come_to_rest(&mut self) {
        self.pedal.arrival = None;
        self.pedal.foot.jump();
        // From no estimate: what is found depends, to the last bit, on the rod's place and the tuning, and not on what was played before.
        let Balance { rest, places, compression } =
            self.statics.balance(self.pedal.foot.place(), &[0.0; POINTS], &self.rims.law, &self.rigid);
        self.pedal.arrive(rest);
        self.rigid.iter_mut().zip(&places).for_each(|(rigid, place)| rigid.put(place));
        (self.rims.compression, self.rims.force) = (compression, rest.preload);
        self.rims.touching = compression.map(|d| d > 0.0);
        self.rims.lambda = [self.rims.lasting_loss; POINTS];
        (self.engaged, self.still) = (false, true);
        self.dynamics.rigid_heard.sounds.iter_mut().for_each(RigidSound::reset);
        self.dynamics.air.iter_mut().for_each(GapAir::reset);
        self.dynamics.update_offset(&rest.preload);
    }

    /// Overlap at the rim points with the present deflection of both shells, m.
    pub(super) fn overlaps(&self, top: &ModalBody) -> [f64; POINTS] {
        let above = top.folded_displacement(&self.folded[0]);
        let below = self.lower.modal.folded_displacement(&self.folded[1]);
        let Pair { pedal, statics, .. } = self;
        let [upper, lower]: [Weights; 2] = [0, 1].map(|which: usize| {
            let (place, around) = (self.rigid[which].place(), &statics.around[which]);
            std::array::from_fn(|part| place[part] * around[part])
        });
        let rigid: Weights = std::array::from_fn(|part| upper[part] - lower[part]);
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let mut apart = rim_points::fine(&above);
                for (apart, below) in apart.as_flattened_mut().iter_mut().zip(below.as_flattened()) {
                    *apart -= f64::from(*below);
                }
                apart[0][0] += rigid[0];
                apart[1][0] += rigid[1];
                apart[1][1] += rigid[2];
                let mut overlaps = rim_points::at_points(&apart);
                let still = pedal.rest.bend.iter().zip(&statics.depth);
                for (overlap, (bend, depth)) in overlaps.iter_mut().zip(still) {
                    *overlap += bend - depth;
                }
                overlaps
            },
        )
    }

    /// Overlap without the shells' motion, m.
    pub(super) fn apart(&self, j: usize) -> f64 {
        let [above, below] = &self.statics.weights;
        self.rigid[0].at(&above[j]) - self.rigid[1].at(&below[j]) + self.pedal.rest.bend[j]
            - self.statics.depth[j]
    }

    /// Solves the rims' contacts from now on, until the check of a block finds them apart.
    pub fn engage(&mut self, top: &ModalBody) {
        self.still = false;
        if !self.engaged {
            self.engaged = true;
            self.rims.compression = self.overlaps(top);
            self.follow_gaps(true);
            self.take_air_along(1.0);
        }
    }

    /// Lets the air move along with both cymbals as rigid bodies (a share of 1), or no more (-1). They bring the energy and take it back; nothing of it is heard.
    pub(super) fn take_air_along(&mut self, share: f64) {
        let Some(air) = &mut self.dynamics.air else { return };
        let of = |by: f64| self.rigid.each_ref().map(|rigid| rigid.speeds().map(|speed| by * speed));
        let moving: f64 = self.rigid.iter().map(Rigid::motion).sum();
        if moving == 0.0 {
            return;
        }
        let gained = air.carry(&of(share));
        // Both slow down by what the air takes, and the air moves as they do then.
        let kept = (moving / (moving + gained.max(0.0))).sqrt();
        let gained = gained + air.carry(&of(share * (kept - 1.0)));
        let left = moving - gained;
        if left < 0.0 {
            air.carry(&of(-share * kept));
            return;
        }
        let scale = (left / moving).sqrt();
        for rigid in &mut self.rigid {
            rigid.set_speed(rigid.speeds().map(|speed| scale * speed));
        }
    }

    /// Whether any rim point touches.
    pub fn is_touching(&self) -> bool {
        self.rims.touching.contains(&true)
    }

    /// Energy above that at rest, J: of the lower shell, of the rigid motion of both cymbals, and of the contacts.
    pub(super) fn held_energy(&self) -> f64 {
        self.lower.modal.energy() + self.held()
    }

    /// The part of it that the pedal can change.
    pub(super) fn held(&self) -> f64 {
        let contacts: f64 = (0..POINTS)
            .filter(|&j| self.rims.compression[j] > 0.0 || self.pedal.rest.preload[j] != 0.0)
            .map(|j| {
                let shells = self.rims.compression[j] - self.apart(j);
                self.rims.law.potential(self.rims.compression[j]) - self.pedal.rest.preload[j] * shells
            })
            .sum();
        self.rigid[0].energy(self.pedal.foot.place())
            + self.rigid[1].energy(0.0)
            + contacts
            + self.air_energy()
            - self.pedal.rest.energy
    }
}
