//! What a drum's modes lose to its muffler and to a hand.

use crate::fitted;

use super::body::BodyMode;
use super::modes::DrumModes;
use super::muffler::MufflerCoefs;
use super::spec::DrumSpec;
use super::tuned::{ModeAtPitch, PitchPosition};

/// What the modes lose.
pub struct Losses {
    /// Of the muffler, at full amount.
    pub muffler: MufflerCoefs,
    /// What a firm hand takes from a mode of the batter head alone, 1/s.
    pub palm: f64,
    /// What full muffling takes from each mode at the present pitch, 1/s.
    pub muffled: Vec<f64>,
    /// Whether that is known: nobody asks while it is off.
    pub is_known: bool,
    /// Nothing is lost.
    pub lossless: bool,
}

/// Decay rate that a palm pressed on it adds to a drum's batter head by itself, 1/s. *Derived*: half of its resistance, spread over the head, over the
/// film's mass: a film of 30 g loses 25 1/s.
pub fn palm(spec: &DrumSpec) -> f64 {
    let membrane = spec.membrane(&spec.batter);
    0.5 * fitted::PALM / (membrane.area_density() * membrane.area())
}

impl Losses {
    /// Works out what full muffling takes where the pitch is.
    pub fn follow_pitch(
        &mut self,
        modes: &[BodyMode],
        at_pitch: &[ModeAtPitch],
        built: &DrumModes,
        place: &PitchPosition,
    ) {
        self.is_known = true;
        for (muffled, mode) in self.muffled.iter_mut().zip(modes) {
            *muffled = self.muffler.sigma(mode, &at_pitch[mode.row], built, place);
        }
    }
}
