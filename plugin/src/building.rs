//! What the parameters ask of building: a plan for the whole kit, small enough to be compared and copied.

use overhear_crew::{Patience, Workers};
use overhear_engine::kit::{Crew, Post};
use overhear_engine::piece::{BuildOptions, PieceId, Quality};

use crate::parameters::{Construction, Drives, PARAMETERS};
use crate::performer::flushed;

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
    staff: Staff,
}

/// Who renders beside the audio thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Staff {
    /// How many.
    pub workers: usize,
    /// Whether somebody waits for them.
    pub pace: Pace,
}

impl Staff {
    /// Nobody.
    pub const NOBODY: Staff = Staff { workers: 0, pace: Pace::RealTime };

    /// Starts the threads; none if nobody is wanted.
    ///
    /// # Errors
    /// If the system starts no more threads.
    pub fn hire(self) -> std::io::Result<Option<Box<dyn Crew>>> {
        if self.workers == 0 {
            return Ok(None);
        }
        let patience = match self.pace {
            Pace::RealTime => Patience::RealTime,
            Pace::Offline => Patience::Offline,
        };
        // In the floating point mode of the audio thread, or the bits would differ.
        let render = |post: &mut Post| flushed(|| post.render());
        Ok(Some(Box::new(Workers::new(self.workers, patience, render)?)))
    }
}

impl BuildPlan {
    /// The plan that values in the parameters' units ask for, given by their place in [`PARAMETERS`].
    ///
    /// # Real-time
    /// No allocation; linear in the number of parameters.
    pub fn of(value: impl Fn(usize) -> f32, pace: Pace) -> BuildPlan {
        let mut plan =
            BuildPlan { quality: Quality::default(), resonant_ratios: [None; PIECES], staff: Staff::NOBODY };
        let mut offline = None;
        for (index, parameter) in PARAMETERS.iter().enumerate() {
            let Drives::Building(construction) = parameter.drives else { continue };
            let value = parameter.snap(value(index));
            let quality = |place: usize| Quality::ALL.get(place).copied();
            match construction {
                Construction::Quality => plan.quality = quality(value as usize).unwrap_or_default(),
                Construction::OfflineQuality => offline = (value as usize).checked_sub(1).and_then(quality),
                Construction::Workers => plan.staff.workers = value as usize,
                Construction::ResonantRatio(piece) => {
                    if let Some(slot) = piece.slot() {
                        // At the default the drum's own ratio, to its last bit.
                        let moved = value != parameter.default;
                        plan.resonant_ratios[slot] = moved.then_some(f64::from(value));
                    }
                }
            }
        }
        if plan.staff.workers > 0 {
            plan.staff.pace = pace;
        }
        if pace == Pace::Offline {
            plan.quality = offline.unwrap_or(plan.quality);
        }
        plan
    }

    /// Who renders beside the audio thread.
    pub fn staff(&self) -> Staff {
        self.staff
    }

    /// How a piece is built at a sample rate, Hz.
    pub fn options(&self, id: PieceId, sample_rate: f64) -> BuildOptions {
        let resonant_ratio = id.slot().and_then(|slot| self.resonant_ratios[slot]);
        BuildOptions { quality: self.quality, resonant_ratio, ..BuildOptions::in_kit(id, sample_rate) }
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
            assert_eq!(BuildPlan::default().options(id, 48e3), BuildOptions::in_kit(id, 48e3));
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
    fn workers_are_hired_as_many_as_are_wanted_and_nobody_by_default() {
        assert!(BuildPlan::default().staff().hire().unwrap().is_none());
        let wanted = plan(&[("workers", 2.0)], Pace::Offline);
        assert_eq!(wanted.staff(), Staff { workers: 2, pace: Pace::Offline });
        assert!(wanted.staff().hire().unwrap().is_some());
        // Whoever renders them, pieces are the same.
        assert_eq!(
            wanted.options(PieceId::Kick, 48e3),
            plan(&[], Pace::Offline).options(PieceId::Kick, 48e3)
        );
    }

    #[test]
    fn ratios_reach_their_own_drum() {
        let plan = plan(&[("snare_resonant_ratio", 1.25)], Pace::RealTime);
        assert_eq!(plan.options(PieceId::Snare, 48e3).resonant_ratio, Some(1.25));
        assert_eq!(plan.options(PieceId::Kick, 48e3).resonant_ratio, None);
    }
}
