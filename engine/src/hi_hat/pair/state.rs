//! State of a pair of cymbals: its compliances, and the contacts at the rims.

use crate::contact::ContactLaw;
use crate::contact::solver::Compliances;
use crate::hi_hat::gap_air::GapAir;
use crate::hi_hat::near_points::{Near, NearCompliances};
use crate::hi_hat::rigid::{Rigid, Weights};
use crate::hi_hat::rigid_sound::{RigidHeard, RigidSound};
use crate::hi_hat::rim_points::{self, FineAmplitudes, POINTS};
use crate::modal::simd::rim_harmonics::{MAX_CLASSES, RimHarmonics};
use crate::modal::{ModalBody, Pressure, ReceiverWeights};

/// Compliances of a striker's point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StrikerPlace {
    pub(crate) weights: Weights,
    /// Compliance between it and the rim points, of the upper shell and of the whole upper cymbal, m/N.
    pub(crate) shell: [f64; POINTS],
    pub(crate) whole: [f64; POINTS],
}

/// Response to forces held over a sample.
pub(crate) struct Dynamics {
    /// Compliance between the rim points, of the shells and of shells and mounts, m/N.
    shells: Compliances<POINTS>,
    pub(crate) whole: Compliances<POINTS>,
    /// Those between the points solved for last.
    pub(crate) near: NearCompliances,
    /// `shells` times the preloads, m.
    pub(crate) preload_offset: [f64; POINTS],
    /// The preloads as forces on the amplitudes, N.
    pub(crate) preload_waves: FineAmplitudes,
    /// Pressure at each receiver proportional to the force, of both cymbals, per amplitude of the force that presses the lower one
    /// down, `[class][cosine, sine]`, Pa/N.
    pub(crate) direct: [[Pressure; 2]; MAX_CLASSES],
    /// Coupling of the rim points with the upper cymbal's nonlinear force, positive as a point presses.
    pub(crate) coupling: [f64; POINTS],
    /// How both cymbals are heard as rigid bodies.
    pub(crate) rigid_heard: RigidHeard,
    /// The air between them, if the rims shut it in.
    pub(crate) air: Option<GapAir>,
}

impl Dynamics {
    /// Of cymbals that are so heard as rigid bodies, and are yet to be [followed](Self::follow).
    pub(crate) fn new(sounds: [RigidSound; 2], air: Option<GapAir>) -> Dynamics {
        Dynamics {
            shells: Compliances::<POINTS>::default(),
            whole: Compliances::<POINTS>::default(),
            near: NearCompliances::default(),
            preload_offset: [0.0; POINTS],
            preload_waves: FineAmplitudes::default(),
            direct: [[Pressure::default(); 2]; MAX_CLASSES],
            coupling: [0.0; POINTS],
            rigid_heard: RigidHeard::new(sounds),
            air,
        }
    }

    /// Updates the response after a change of the modes or receiver weights of both cymbals.
    pub(crate) fn follow(
        &mut self,
        bodies: [(&ModalBody, &ReceiverWeights); 2],
        folded: &[RimHarmonics; 2],
        rigid: &[Rigid; 2],
        weights: &[[Weights; POINTS]; 2],
    ) {
        let [above, below] = [0, 1].map(|which: usize| {
            rim_points::between_points(&bodies[which].0.class_compliances(&folded[which]))
        });
        for i in 0..POINTS {
            for j in 0..POINTS {
                let mounts = rigid.iter().zip(weights);
                let mounts: f64 = mounts.map(|(rigid, at)| rigid.compliance(&at[i], &at[j])).sum();
                self.shells[i][j] = above[i][j] + below[i][j];
                self.whole[i][j] = self.shells[i][j] + mounts;
            }
        }
        self.near.forget();
        self.follow_receivers(bodies, folded);
    }

    /// Collects the compliances between points to be solved for.
    pub(crate) fn collect(&mut self, near: &Near) {
        self.near.collect(near, &self.whole);
    }

    /// Updates the pressure proportional to the forces after a change of the receiver weights alone.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(crate) fn follow_receivers(
        &mut self,
        bodies: [(&ModalBody, &ReceiverWeights); 2],
        folded: &[RimHarmonics; 2],
    ) {
        let [(top, near), (bottom, far)] = bodies;
        let [above, below] = [top.folded_direct(&folded[0], near), bottom.folded_direct(&folded[1], far)];
        for (class, direct) in self.direct.iter_mut().enumerate() {
            for (part, direct) in direct.iter_mut().enumerate() {
                *direct = std::array::from_fn(|receiver| {
                    below[receiver][class][part] - above[receiver][class][part]
                });
            }
        }
    }

    /// Updates what follows from the preloads (N).
    pub(crate) fn update_offset(&mut self, preload: &[f64; POINTS]) {
        self.preload_waves = rim_points::amplitudes(preload);
        self.preload_offset = self.shells.map(|row| row.iter().zip(preload).map(|(y, p)| y * p).sum());
    }
}

/// The contacts at the rims, `[point]`.
pub(crate) struct RimState {
    /// The law of every point.
    pub(crate) law: ContactLaw,
    /// Loss of a touch that lasts, s/m.
    pub(crate) lasting_loss: f64,
    /// `d` now, and at the end of the sample without any force, m.
    pub(crate) compression: [f64; POINTS],
    pub(crate) free: [f64; POINTS],
    /// N.
    pub(crate) force: [f64; POINTS],
    /// Loss of the present touch, s/m.
    pub(crate) lambda: [f64; POINTS],
    pub(crate) touching: [bool; POINTS],
    /// Since the latest stroke: landings, sample of the last lift.
    pub(crate) landings: u32,
    pub(crate) last_lift: u64,
    pub(crate) age: u64,
}

impl RimState {
    /// Rims that are so far (m) apart.
    pub(crate) fn new(law: ContactLaw, lasting_loss: f64, depth: [f64; POINTS]) -> RimState {
        RimState {
            law,
            lasting_loss,
            compression: depth.map(|depth| -depth),
            free: [0.0; POINTS],
            force: [0.0; POINTS],
            lambda: [0.0; POINTS],
            touching: [false; POINTS],
            landings: 0,
            last_lift: 0,
            age: 0,
        }
    }

    /// Restarts the counts at a stroke.
    pub(crate) fn begin_count(&mut self) {
        (self.landings, self.last_lift, self.age) = (0, 0, 0);
    }

    /// Counts landings and lifts of this sample.
    pub(crate) fn count(&mut self) {
        for (touching, compression) in self.touching.iter_mut().zip(&self.compression) {
            let touches = *compression > 0.0;
            match (*touching, touches) {
                (false, true) => self.landings = self.landings.saturating_add(1),
                (true, false) => self.last_lift = self.age,
                _ => {}
            }
            *touching = touches;
        }
    }
}
