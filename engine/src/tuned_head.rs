//! A head over its whole range of pitches, worked out beforehand, so that it can be tuned while it rings.
//!
//! With air the modes do not move together: the added mass depends on frequency. Where every mode
//! rings is solved at a few pitches when the head is built and interpolated between (cubic, in
//! logarithms): what a rebuild at that pitch would give, within a hundredth of a cent.

use crate::membrane::{Membrane, Ringing};

/// Pitches worked out over the range.
const PITCHES: usize = 17;

/// `ln` of what is interpolated.
#[derive(Debug, Clone, Copy)]
struct Entry {
    omega: f64,
    sigma: f64,
    mass: f64,
}

/// Frequencies, losses and masses of a head's modes against its pitch.
#[derive(Debug, Clone)]
pub struct TunedHead {
    low: f64,
    high: f64,
    /// `ln` of the tension, `[pitch]`.
    tensions: [f64; PITCHES],
    /// `[mode][pitch]`.
    table: Vec<[Entry; PITCHES]>,
}

/// Keeps the logarithm of a vanishing loss finite, 1/s.
const NO_LOSS: f64 = 1e-30;

impl TunedHead {
    /// Solves the head at every pitch of the table. `tension` gives the tension of a pitch (Hz).
    pub fn new(membrane: &Membrane, [low_hz, high_hz]: [f64; 2], tension: impl Fn(f64) -> f64) -> TunedHead {
        let (low, high) = (low_hz.ln(), high_hz.ln());
        let tensions =
            std::array::from_fn(|i| tension((low + (high - low) * i as f64 / (PITCHES - 1) as f64).exp()));
        let table = membrane
            .modes()
            .iter()
            .map(|mode| {
                tensions.map(|tension: f64| {
                    let Ringing { omega, sigma, mass } = membrane.ringing(mode, tension);
                    Entry { omega: omega.ln(), sigma: sigma.max(NO_LOSS).ln(), mass: mass.ln() }
                })
            })
            .collect();
        TunedHead { low, high, tensions: tensions.map(f64::ln), table }
    }

    /// Where in the table a pitch (Hz) lies; made once, used for every mode.
    pub fn place(&self, pitch_hz: f64) -> Place {
        let x = ((pitch_hz.ln() - self.low) / (self.high - self.low)).clamp(0.0, 1.0) * (PITCHES - 1) as f64;
        let first = (x.floor() as usize).saturating_sub(1).min(PITCHES - 4);
        let t = x - first as f64;
        let weights = [
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        ];
        Place { first, weights }
    }

    /// Where mode `mode` rings.
    ///
    /// # Real-time
    /// Three exponentials.
    pub fn ringing(&self, mode: usize, place: &Place) -> Ringing {
        let row = &self.table[mode];
        Ringing {
            omega: place.blend(|i| row[i].omega).exp(),
            sigma: place.blend(|i| row[i].sigma).exp(),
            mass: place.blend(|i| row[i].mass).exp(),
        }
    }

    /// Tension, N/m.
    pub fn tension(&self, place: &Place) -> f64 {
        place.blend(|i| self.tensions[i]).exp()
    }
}

/// Four neighbours in the table and their weights.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    first: usize,
    weights: [f64; 4],
}

impl Place {
    fn blend(&self, value: impl Fn(usize) -> f64) -> f64 {
        (0..4).map(|i| self.weights[i] * value(self.first + i)).sum()
    }
}
