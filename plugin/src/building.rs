//! What the parameters ask of building: a plan for the whole kit, small enough to be compared and copied.

use overhear_engine::piece::{BuildOptions, PieceId, Quality};

use crate::parameters::{Construction, Drives, PARAMETERS};

/// Pieces of the kit.
const PIECES: usize = PieceId::KIT.len();

/// Whether somebody waits for every buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// The host plays.
    RealTime,
    /// The host renders to a file.
    Offline,
}

/// How every piece is built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildPlan {
    quality: Quality,
    /// `[piece]`; none where the drum's own is wanted.
    resonant_ratios: [Option<f64>; PIECES],
}

impl BuildPlan {
    /// The plan that plain values ask for, given by their place in [`PARAMETERS`].
    ///
    /// # Real-time
    /// No allocation; linear in the number of parameters.
    pub fn of(value: impl Fn(usize) -> f32, pace: Pace) -> BuildPlan {
        let mut plan = BuildPlan { quality: Quality::default(), resonant_ratios: [None; PIECES] };
        let mut offline = None;
        for (index, parameter) in PARAMETERS.iter().enumerate() {
            let Drives::Building(construction) = parameter.drives else { continue };
            let value = parameter.snap(value(index));
            let quality = |place: usize| Quality::ALL.get(place).copied();
            match construction {
                Construction::Quality => plan.quality = quality(value as usize).unwrap_or_default(),
                Construction::OfflineQuality => offline = (value as usize).checked_sub(1).and_then(quality),
                Construction::ResonantRatio(piece) => {
                    if let Some(slot) = piece.slot() {
                        // At the default the drum's own ratio, to its last bit.
                        let moved = value != parameter.default;
                        plan.resonant_ratios[slot] = moved.then_some(f64::from(value));
                    }
                }
            }
        }
        if pace == Pace::Offline {
            plan.quality = offline.unwrap_or(plan.quality);
        }
        plan
    }

    /// How a piece is built at a sample rate, Hz.
    pub fn options(&self, id: PieceId, sample_rate: f64) -> BuildOptions {
        let resonant_ratio = id.slot().and_then(|slot| self.resonant_ratios[slot]);
        BuildOptions { quality: self.quality, resonant_ratio, ..BuildOptions::new(sample_rate) }
    }
}

impl Default for BuildPlan {
    fn default() -> Self {
        BuildPlan::of(|index| PARAMETERS[index].default, Pace::RealTime)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::find;

    fn plan(moved: &[(&str, f32)], pace: Pace) -> BuildPlan {
        let mut values = PARAMETERS.map(|parameter| parameter.default);
        for (name, value) in moved {
            values[find(name).unwrap().0] = *value;
        }
        BuildPlan::of(|index| values[index], pace)
    }

    #[test]
    fn the_default_plan_is_the_instrument_as_it_is_played() {
        for id in PieceId::KIT {
            assert_eq!(BuildPlan::default().options(id, 48e3), BuildOptions::new(48e3));
        }
    }

    #[test]
    fn offline_has_a_quality_of_its_own_or_that_of_playing() {
        let quality = |moved: &[_], pace| plan(moved, pace).options(PieceId::Ride, 48e3).quality;
        assert_eq!(quality(&[], Pace::RealTime), Quality::Standard);
        assert_eq!(quality(&[], Pace::Offline), Quality::Offline);
        assert_eq!(quality(&[("quality", 2.0), ("offline_quality", 0.0)], Pace::Offline), Quality::High);
        assert_eq!(quality(&[("quality", 2.0), ("offline_quality", 1.0)], Pace::Offline), Quality::Eco);
    }

    #[test]
    fn ratios_reach_their_own_drum() {
        let plan = plan(&[("snare_resonant_ratio", 1.25)], Pace::RealTime);
        assert_eq!(plan.options(PieceId::Snare, 48e3).resonant_ratio, Some(1.25));
        assert_eq!(plan.options(PieceId::Kick, 48e3).resonant_ratio, None);
    }
}
