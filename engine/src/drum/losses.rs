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

/// Resistance of a palm that is pressed on a head, kg/s, spread over it. *Assumed*: no measurement is known. A film of 30 g by itself
/// loses 67 1/s to it.
const PALM: f64 = 4.0;

/// How firm a hand that lies under a cross-stick is, beside one that is pressed on the head, 0 to 1.
pub const LYING: f64 = fitted::LYING_HAND / PALM;

/// Decay rate that a palm adds to a drum's batter head by itself, 1/s. *Derived*: half of the resistance over the film's mass.
pub fn palm(spec: &DrumSpec) -> f64 {
    let membrane = spec.membrane(&spec.batter);
    0.5 * PALM / (membrane.area_density() * membrane.area())
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
