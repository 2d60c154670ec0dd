//! What a pair of cymbals knows from sample to sample: its compliances, and the contacts at the rims.

use crate::contact::ContactLaw;
use crate::contact::solver::Compliances;
use crate::hi_hat::rigid::{Rigid, Weights};
use crate::hi_hat::rim_points::{self, POINTS};
use crate::modal::simd::rim_harmonics::{Amplitudes, RimHarmonics};
use crate::modal::{ModalBody, RECEIVERS, ReceiverWeights};

/// What the pair knows of a striker's point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StrikerPlace {
    pub(crate) weights: Weights,
    /// Compliance of the upper shell, and of the upper cymbal in all, between it and the rim's places, m/N.
    pub(crate) shell: [f64; POINTS],
    pub(crate) whole: [f64; POINTS],
}

/// What a force held over a sample does.
#[derive(Default)]
pub(crate) struct Dynamics {
    /// Compliance of shells, and of shells and mounts, between the places, m/N.
    shells: Compliances<POINTS>,
    pub(crate) whole: Compliances<POINTS>,
    /// `shells` times the preloads, m.
    pub(crate) preload_offset: [f64; POINTS],
    /// Pressure at each ear at once per force amplitude, of both, Pa/N.
    pub(crate) direct: [[Amplitudes; RECEIVERS]; 2],
    /// Coupling of the places with the force beyond the upper cymbal's modes, into it as a place presses.
    pub(crate) coupling: [f64; POINTS],
}

impl Dynamics {
    /// Follows the modes of the upper and the lower cymbal, and how they are heard.
    pub(crate) fn follow(
        &mut self,
        bodies: [(&ModalBody, &ReceiverWeights); 2],
        folded: &[RimHarmonics; 2],
        rigid: &[Rigid; 2],
        weights: &[Weights; POINTS],
    ) {
        let [above, below] = [0, 1].map(|which: usize| {
            rim_points::between_points(&bodies[which].0.class_compliances(&folded[which]))
        });
        for i in 0..POINTS {
            for j in 0..POINTS {
                let mounts: f64 = rigid.iter().map(|rigid| rigid.compliance(&weights[i], &weights[j])).sum();
                self.shells[i][j] = above[i][j] + below[i][j];
                self.whole[i][j] = self.shells[i][j] + mounts;
            }
        }
        let [(top, near), (bottom, far)] = bodies;
        self.direct = [top.folded_direct(&folded[0], near), bottom.folded_direct(&folded[1], far)];
    }

    /// Works out what hangs on the preloads (N).
    pub(crate) fn ease(&mut self, preload: &[f64; POINTS]) {
        self.preload_offset = self.shells.map(|row| row.iter().zip(preload).map(|(y, p)| y * p).sum());
    }
}

/// The contacts at the rims, `[place]`.
pub(crate) struct RimState {
    /// The law of every place.
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
    /// Since the latest stroke: landings, when a place last lifted off, samples.
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

    /// Counts anew from a stroke on.
    pub(crate) fn begin_count(&mut self) {
        (self.landings, self.last_lift, self.age) = (0, 0, 0);
    }

    /// Places whose compression the sample has changed count as landings or lifts.
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
