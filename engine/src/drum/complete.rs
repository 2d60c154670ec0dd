//! The complete modes of a drum: where they ring, and what they tell about what lies above them.

use crate::drum::heads::MIDDLE;
use crate::drum::mixing::MixedModes;
use crate::drum::modes::DrumModes;
use crate::drum::tuned::{ModeAtPitch, PitchPosition};
use crate::high_band::HighBandSpec;

/// Where the kept pairs and then the mixed modes ring at a pitch.
pub fn at_pitch<'a>(
    built: &'a DrumModes,
    mixed: Option<&'a MixedModes>,
    place: &'a PitchPosition,
) -> impl Iterator<Item = ModeAtPitch> + 'a {
    let kept = mixed.map_or(built.modes.len(), |_| built.kept);
    let kept = built.modes[..kept].iter().map(|mode| mode.at(place));
    kept.chain(mixed.into_iter().flat_map(|mixed| (0..mixed.len()).map(|k| mixed.at(k, place))))
}

/// A third of an octave down, dimensionless. *Chosen*: a snare drum's batter has some 60 modes there, its other head 20.
const THIRD_DOWN: f64 = 0.794;

/// A high band of a drum that loses as much to the air as the complete modes of the last third of an octave below it, in the middle of the range
/// of pitches. Allocates.
pub fn continued(built: &DrumModes, mixed: Option<&MixedModes>, band: HighBandSpec) -> HighBandSpec {
    let far = band.ear.far;
    let head = if far { built.heads.resonant.as_ref() } else { Some(&built.heads.batter) };
    let Some(head) = head else { return band };
    let place = built.heads.scale.place(built.heads.scale.pitches()[MIDDLE]);
    let top = head.top(&place);
    let last = at_pitch(built, mixed, &place).filter(|mode| {
        // Others share their motion with the air or the other head.
        let share = if far { mode.resonant } else { mode.batter };
        share > 0.5 && (top * THIRD_DOWN..=top).contains(&mode.omega)
    });
    band.losing_as(last.map(|mode| (mode.omega, mode.sigma)), head.tension(&place))
}
