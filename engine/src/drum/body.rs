//! A drum's pairs as modes of one body: members, names, and what each sends all around.

use std::f64::consts::TAU;

use crate::air_load::SPEED_OF_SOUND;
use crate::damping::{Muffler, SIGMA_T60};
use crate::mode::{Member, ModeInfo, ModeKind};
use crate::split::Splitting;

use super::mixing::{self, MixedModes};
use super::modes::DrumModes;
use super::spec::DrumSpec;
use super::tuned::{PitchPosition, TunedMode};
use crate::high_band::SliceInfo;

/// One mode of the body: which of the drum's, and which member of a pair.
#[derive(Debug, Clone, Copy)]
pub struct BodyMode {
    /// Which of the drum's; of a mixed mode, the one that it is most of.
    pub pair: usize,
    /// Where it is among the [modes at the present pitch](super::tuned::ModeAtPitch): kept pairs, then mixed modes.
    pub row: usize,
    /// Which mixed mode, if it is one.
    pub mixed: Option<usize>,
    /// Which member.
    pub member: Member,
    /// Factor on the pair's frequency.
    pub detuning: f64,
    /// How it goes around at the muffler's direction, a factor from -1 to 1.
    pub gel_turn: f64,
}

/// The pairs as modes of a body, `[mode]`.
pub fn assemble(spec: &DrumSpec, drum: &DrumModes, mixed: Option<&MixedModes>, round: bool) -> Vec<BodyMode> {
    let splitting = if round { Splitting::ROUND } else { spec.evenness };
    let angle = match spec.muffler {
        Muffler::Gel { angle, .. } => angle,
        Muffler::Pillow { .. } | Muffler::Ring { .. } => 0.0,
    };
    let mut modes = Vec::new();
    let kept = mixed.map_or(drum.modes.len(), |_| drum.kept);
    for (pair, mode) in drum.modes[..kept].iter().enumerate() {
        let turn = f64::from(mode.m) * (angle - spec.evenness.axis(mode.m, 0));
        let (body, n, _) = describe(drum, mode);
        // A pair is split by what it is, not by where it stands, so that a rebuild splits it alike.
        let which = n + 1000 * body.len() as u32;
        for (member, detuning) in splitting.members(mode.m, which) {
            let gel_turn = match member {
                Member::Cosine => turn.cos(),
                Member::Sine => turn.sin(),
            };
            modes.push(BodyMode { pair, row: pair, mixed: None, member, detuning, gel_turn });
        }
    }
    let even = mixing::even_modes(drum);
    let names = mixed.into_iter().flat_map(|mixed| &mixed.names).enumerate();
    modes.extend(names.map(|(k, &name)| {
        let mixing::EvenMode { pair, member } = even[name as usize];
        BodyMode { pair, row: drum.kept + k, mixed: Some(k), member, detuning: 1.0, gel_turn: 0.0 }
    }));
    modes
}

/// What a mode mostly is: body, nodal circles, kind.
pub fn describe(drum: &DrumModes, mode: &TunedMode) -> (&'static str, u32, ModeKind) {
    let (_, near) = drum.heads.batter.order(mode.m);
    let name = mode.name;
    if name < near {
        ("batter", name as u32 + 1, ModeKind::Complete)
    } else if name < mode.heads() {
        ("resonant", (name - near) as u32 + 1, ModeKind::Complete)
    } else {
        ("cavity", (name - mode.heads()) as u32, ModeKind::Cavity)
    }
}

/// A slice of the high band as a mode of the batter; it has no nodes of its own.
pub fn sampled(slice: SliceInfo) -> ModeInfo {
    ModeInfo {
        body: "batter",
        m: 0,
        n: 0,
        member: Member::Cosine,
        frequency_hz: slice.omega / TAU,
        t60: SIGMA_T60 / slice.sigma,
        modal_mass: slice.mass,
        radiation: slice.monopole_area,
        kind: ModeKind::Sampled,
    }
}

/// Share of a mode's volume that sends sound all around and feels it: none of modes with nodal diameters, and none where
/// the wave is shorter than the drum.
pub fn all_around(drum: &DrumModes, mode: &TunedMode, place: &PitchPosition) -> f64 {
    if mode.m != 0 {
        return 0.0;
    }
    long_wave(drum, mode.at(place).omega)
}

/// How much of a motion of volume at an angular frequency (rad/s) goes all around, 0 to 1.
fn long_wave(drum: &DrumModes, omega: f64) -> f64 {
    let u = omega * drum.heads.batter.membrane.spec().radius / SPEED_OF_SOUND;
    (LONG_WAVE[1] - u).clamp(0.0, LONG_WAVE[1] - LONG_WAVE[0]) / (LONG_WAVE[1] - LONG_WAVE[0])
}

/// `omega a / c` up to which a drum is felt and heard as a volume, and from which on not at all. *Derived*: at 3 a
/// disc's own directions differ by 6 dB.
const LONG_WAVE: [f64; 2] = [2.0, 3.0];
