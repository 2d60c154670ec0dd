//! What muffling takes from a drum's modes.

use crate::damping::Muffler;
use crate::mode::Member;

use super::body::BodyMode;
use super::heads::MIDDLE;
use super::mixing::{self, EvenMode, MixedModes};
use super::modes::DrumModes;
use super::spec::DrumSpec;
use super::tuned::{ModeAtPitch, PitchPosition, TunedMode};
use crate::high_band::HighMuffling;
use crate::math::cubic::Stencil;

/// Places along the width of a ring that stand for it. *Derived*: a mode at 3 kHz has a wave and a half under one.
const RING_PLACES: usize = 6;

/// What muffling takes from the modes.
#[derive(Debug, Clone, PartialEq)]
pub enum MufflerCoefs {
    /// A pillow.
    Pillow {
        /// Decay rate of the heads' own motion far above the corner at full amount, 1/s.
        sigma: f64,
        /// Corner, rad/s.
        corner: f64,
        /// Decay rate of the air's motion along the drum at full amount, 1/s.
        flow: f64,
    },
    /// A pad.
    Gel {
        /// Decay rate of a mode of unit square there at full amount, 1/s.
        sigma: f64,
        /// Where it lies, share of the radius.
        radius: f64,
        /// The dashpot that is at full amount, kg/s.
        dashpot: f64,
        /// Shapes of the kept modes there, along their diameters.
        kept: PadShapes,
        /// Squared shape of the mixed modes there, in the middle of the range of pitches.
        mixed: Vec<f64>,
    },
    /// A ring.
    Ring {
        /// Decay rate of a mode of unit mean square under it at full amount, 1/s.
        sigma: f64,
        /// The dashpot that is at full amount, kg/s.
        dashpot: f64,
        /// Its middle, share of the radius.
        radius: f64,
        /// Shapes of the kept modes under it, at places of equal area.
        kept: PadShapes,
        /// Mean square of the mixed modes under it, in the middle of the range of pitches.
        mixed: Vec<f64>,
    },
}

impl MufflerCoefs {
    /// Worked out for a drum. Allocates.
    pub fn new(spec: &DrumSpec, drum: &DrumModes, mixed: Option<&MixedModes>) -> MufflerCoefs {
        let membrane = spec.membrane(&spec.batter);
        let even = mixing::even_modes(drum);
        let kept = mixed.map_or(drum.modes.len(), |_| drum.kept);
        let middle = drum.heads.scale.place(drum.heads.scale.pitches()[MIDDLE]);
        let batter = |pair: usize, of: &dyn Fn(usize) -> f64| -> f64 {
            let (first, count) = drum.heads.batter.order(drum.modes[pair].m);
            (0..count).map(|i| drum.modes[pair].share(i, &middle) * of(first + i)).sum()
        };
        match spec.muffler {
            Muffler::Pillow { sigma, corner_hz, flow } => {
                MufflerCoefs::Pillow { sigma, corner: std::f64::consts::TAU * corner_hz, flow }
            }
            Muffler::Gel { sigma, radius, angle } => {
                let film = membrane.area_density() * membrane.area();
                let radial = drum.heads.batter.membrane.radial_shapes(&[radius]);
                let shape = |k: usize| {
                    let EvenMode { pair, member } = even[k];
                    let m = drum.modes[pair].m;
                    let (sin, cos) = (f64::from(m) * (angle - spec.evenness.axis(m, 0))).sin_cos();
                    let around = if member == Member::Cosine { cos } else { sin };
                    around * batter(pair, &|i| radial[i])
                };
                let square = |parts: &mut dyn Iterator<Item = (usize, f64)>| {
                    parts.map(|(part, share)| share * shape(part)).sum::<f64>().powi(2)
                };
                let mixed = of_mixed(mixed, square);
                let kept = PadShapes::new(drum, kept, &radial);
                MufflerCoefs::Gel { sigma, radius, dashpot: 2.0 * film * sigma, kept, mixed }
            }
            Muffler::Ring { sigma, inner } => {
                let film = membrane.area_density() * membrane.area();
                let part = |i: usize| (i as f64 + 0.5) / RING_PLACES as f64;
                let places: Vec<f64> = (0..RING_PLACES)
                    .map(|i| (inner * inner + part(i) * (1.0 - inner * inner)).sqrt())
                    .collect();
                let radial = drum.heads.batter.membrane.radial_shapes(&places);
                // All the way around, modes of different orders do not meet, and a pair's square is half of its largest.
                let mean = |k: usize| {
                    let pair = even[k].pair;
                    let around = if drum.modes[pair].m == 0 { 1.0 } else { 0.5 };
                    let at = |at: usize| batter(pair, &|i| radial[i * RING_PLACES + at]).powi(2);
                    around * (0..RING_PLACES).map(at).sum::<f64>() / RING_PLACES as f64
                };
                let mixed =
                    of_mixed(mixed, |parts| parts.map(|(part, share)| share * share * mean(part)).sum());
                let radius = 0.5 * (1.0 + inner);
                let kept = PadShapes::new(drum, kept, &radial);
                MufflerCoefs::Ring { sigma, dashpot: 2.0 * film * sigma, radius, kept, mixed }
            }
        }
    }

    /// What so much of it, 0 to 1, takes from the high band.
    pub fn above(&self, amount: f64) -> HighMuffling {
        match *self {
            MufflerCoefs::Pillow { sigma, .. } => HighMuffling { even: amount * sigma, ..HighMuffling::NONE },
            MufflerCoefs::Gel { sigma, radius, .. } | MufflerCoefs::Ring { sigma, radius, .. } => {
                HighMuffling { pad: (amount * sigma, radius), ..HighMuffling::NONE }
            }
        }
    }

    /// Decay rate that full muffling adds to a mode, 1/s.
    pub fn sigma(&self, mode: &BodyMode, rung: &ModeAtPitch, drum: &DrumModes, place: &PitchPosition) -> f64 {
        match (self, mode.mixed) {
            (
                MufflerCoefs::Gel { dashpot, mixed, .. } | MufflerCoefs::Ring { dashpot, mixed, .. },
                Some(k),
            ) => dashpot * mixed[k] / (2.0 * rung.mass),
            (MufflerCoefs::Pillow { sigma, corner, flow }, _) => {
                let square = rung.omega * rung.omega;
                let absorbed = sigma * square / (square + corner * corner);
                absorbed * (rung.batter + rung.resonant) + flow * rung.flow
            }
            (MufflerCoefs::Gel { dashpot, kept, .. }, None) => {
                let square = kept.mean_square(mode.pair, place.of(drum.modes[mode.pair].grid()));
                dashpot * mode.gel_turn.powi(2) * square / (2.0 * rung.mass)
            }
            (MufflerCoefs::Ring { dashpot, kept, .. }, None) => {
                let tuned = &drum.modes[mode.pair];
                // All the way around, a pair's square is half of its largest.
                let around = if tuned.m == 0 { 1.0 } else { 0.5 };
                let square = kept.mean_square(mode.pair, place.of(tuned.grid()));
                dashpot * around * square / (2.0 * rung.mass)
            }
        }
    }
}

/// Shapes of modes on the batter head at some places along a radius, dimensionless.
#[derive(Debug, Clone, PartialEq)]
pub struct PadShapes {
    places: usize,
    /// `[mode][pitch of its grid][place]`.
    modes: Vec<Vec<f64>>,
}

impl PadShapes {
    /// Of the first `count` modes of a drum; `radial` are the batter's radial functions, `[batter mode][place]`. Allocates.
    fn new(drum: &DrumModes, count: usize, radial: &[f64]) -> PadShapes {
        let places = radial.len() / drum.heads.batter.membrane.modes().len().max(1);
        let shapes = |tuned: &TunedMode| -> Vec<f64> {
            let (first, heads) = drum.heads.batter.order(tuned.m);
            let shape = |pitch: usize, at: usize| {
                (0..heads).map(|i| tuned.share_at(i, pitch) * radial[(first + i) * places + at]).sum()
            };
            let pitches = 0..tuned.grid().pitches().len();
            pitches
                .flat_map(|pitch| (0..places).map(move |at| (pitch, at)))
                .map(|(i, at)| shape(i, at))
                .collect()
        };
        PadShapes { places, modes: drum.modes[..count].iter().map(shapes).collect() }
    }

    /// Mean square of a mode over the places, between pitches of its grid.
    fn mean_square(&self, mode: usize, between: &Stencil) -> f64 {
        let (places, shapes) = (self.places, &self.modes[mode]);
        let shape = |at: usize| between.blend(|pitch| shapes[pitch * places + at]);
        (0..places).map(|at| shape(at).powi(2)).sum::<f64>() / places as f64
    }
}

/// A value for every mixed mode, from the even modes it is made of.
fn of_mixed(
    mixed: Option<&MixedModes>,
    value: impl Fn(&mut dyn Iterator<Item = (usize, f64)>) -> f64,
) -> Vec<f64> {
    let modes = mixed.into_iter().flat_map(|mixed| (0..mixed.len()).map(|k| mixed.mixture.parts(k)));
    modes.map(|mut parts| value(&mut parts)).collect()
}
