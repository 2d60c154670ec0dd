//! What muffling takes from a drum's modes.

use crate::damping::Muffler;

use super::body::BodyMode;
use super::modes::DrumModes;
use super::spec::DrumSpec;
use super::tuned::{ModeAtPitch, PitchPosition};
use crate::high_band::HighMuffling;

/// Places along the width of a ring that stand for it. *Derived*: a mode at 3 kHz has a wave and a half under one.
const RING_PLACES: usize = 6;

/// What muffling takes from the modes.
#[derive(Debug, Clone, PartialEq)]
pub enum MufflerCoefs {
    /// Decay rates of the heads' own motion and of the air's along the drum at full amount, 1/s.
    Pillow(f64, f64),
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
    },
}

impl MufflerCoefs {
    /// Worked out for a drum. Allocates.
    pub fn new(spec: &DrumSpec, drum: &DrumModes) -> MufflerCoefs {
        let membrane = spec.membrane(&spec.batter);
        match spec.muffler {
            Muffler::Pillow { sigma, flow } => MufflerCoefs::Pillow(sigma, flow),
            Muffler::Gel { sigma, radius, .. } => {
                let film = membrane.area_density() * membrane.area();
                let radial = drum.heads.batter.membrane.radial_shapes(&[radius]);
                MufflerCoefs::Gel { sigma, radius, dashpot: 2.0 * film * sigma, radial }
            }
            Muffler::Ring { sigma, inner } => {
                let film = membrane.area_density() * membrane.area();
                let part = |i: usize| (i as f64 + 0.5) / RING_PLACES as f64;
                let places: Vec<f64> = (0..RING_PLACES)
                    .map(|i| (inner * inner + part(i) * (1.0 - inner * inner)).sqrt())
                    .collect();
                let radial = drum.heads.batter.membrane.radial_shapes(&places);
                MufflerCoefs::Ring { sigma, dashpot: 2.0 * film * sigma, radius: 0.5 * (1.0 + inner), radial }
            }
        }
    }

    /// What so much of it, 0 to 1, takes from the high band.
    pub fn above(&self, amount: f64) -> HighMuffling {
        match *self {
            MufflerCoefs::Pillow(sigma, _) => HighMuffling { even: amount * sigma, ..HighMuffling::NONE },
            MufflerCoefs::Gel { sigma, radius, .. } | MufflerCoefs::Ring { sigma, radius, .. } => {
                HighMuffling { pad: (amount * sigma, radius), ..HighMuffling::NONE }
            }
        }
    }

    /// Decay rate that full muffling adds to a mode, 1/s.
    pub fn sigma(&self, mode: &BodyMode, rung: &ModeAtPitch, drum: &DrumModes, place: &PitchPosition) -> f64 {
        match self {
            MufflerCoefs::Pillow(sigma, flow) => sigma * (rung.batter + rung.resonant) + flow * rung.flow,
            MufflerCoefs::Gel { dashpot, radial, .. } => {
                let tuned = &drum.modes[mode.pair];
                let (first, count) = drum.heads.batter.order(tuned.m);
                let shape: f64 = (0..count).map(|i| tuned.share(i, place) * radial[first + i]).sum();
                dashpot * (shape * mode.gel_turn).powi(2) / (2.0 * rung.mass)
            }
            MufflerCoefs::Ring { dashpot, radial, .. } => {
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
