//! What muffling takes from a drum's modes.

use crate::damping::Muffler;
use crate::mode::Member;

use super::body::BodyMode;
use super::heads::MIDDLE;
use super::mixing::{self, EvenMode, MixedModes};
use super::modes::DrumModes;
use super::spec::DrumSpec;
use super::tuned::{ModeAtPitch, PitchPosition};
use crate::high_band::HighMuffling;

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
        /// The batter's radial functions there, `[batter mode]`.
        radial: Vec<f64>,
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
        /// The batter's radial functions under it, `[batter mode][place]`, at places of equal area.
        radial: Vec<f64>,
        /// Mean square of the mixed modes under it, in the middle of the range of pitches.
        mixed: Vec<f64>,
    },
}

impl MufflerCoefs {
    /// Worked out for a drum. Allocates.
    pub fn new(spec: &DrumSpec, drum: &DrumModes, mixed: Option<&MixedModes>) -> MufflerCoefs {
        let membrane = spec.membrane(&spec.batter);
        let even = mixing::even_modes(drum);
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
                MufflerCoefs::Gel { sigma, radius, dashpot: 2.0 * film * sigma, radial, mixed }
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
                MufflerCoefs::Ring { sigma, dashpot: 2.0 * film * sigma, radius, radial, mixed }
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
            (MufflerCoefs::Gel { dashpot, radial, .. }, None) => {
                let tuned = &drum.modes[mode.pair];
                let (first, count) = drum.heads.batter.order(tuned.m);
                let shape: f64 = (0..count).map(|i| tuned.share(i, place) * radial[first + i]).sum();
                dashpot * (shape * mode.gel_turn).powi(2) / (2.0 * rung.mass)
            }
            (MufflerCoefs::Ring { dashpot, radial, .. }, None) => {
                let tuned = &drum.modes[mode.pair];
                let (first, count) = drum.heads.batter.order(tuned.m);
                let shape = |at: usize| -> f64 {
                    let of = |i: usize| tuned.share(i, place) * radial[(first + i) * RING_PLACES + at];
                    (0..count).map(of).sum()
                };
                // All the way around, a pair's square is half of its largest.
                let around = if tuned.m == 0 { 1.0 } else { 0.5 };
                let square = (0..RING_PLACES).map(|at| shape(at).powi(2)).sum::<f64>() / RING_PLACES as f64;
                dashpot * around * square / (2.0 * rung.mass)
            }
        }
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
