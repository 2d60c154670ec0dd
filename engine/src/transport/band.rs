//! A band of modes: what it conducts, and what its modes get.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::ops::Range;

use fastrand::Rng;

use crate::fitted;
use crate::modal::bands::{BandEnergy, BandWeights};
use crate::modal::{ModalBody, Mode};

/// Bands in an octave, and the least number of modes of one. *Converged*: wide enough for some modes at 2 kHz, narrow enough
/// for the fall of the spectrum.
const BANDS_PER_OCTAVE: f64 = 6.0;
const LEAST_MODES: usize = 4;

/// The lowest of the top of the coupled modes over the highest.
const TOP: f64 = FRAC_1_SQRT_2;

/// `a`: distance of modes against which the exchange between bands counts, and that within a band, over the distance of
/// neighbours.
const BETWEEN: f64 = fitted::TRANSPORT_BETWEEN;
const WITHIN: f64 = fitted::TRANSPORT_WITHIN;

/// Share of what a band's modes get evenly that comes as kicks. *Judgement*: more would be heard as noise below the band.
const KICKED: f64 = 0.1;

/// Largest share of its kinetic energy that a band loses in a block, and gains by scaling.
const LARGEST_LOSS: f64 = 0.5;
const LARGEST_GAIN: f64 = 1.0;

/// Share of a band's energy below which modes exchange none in a block: single precision cannot tell it.
const LEAST_EXCHANGED: f64 = 1e-9;

/// Energies below this are nothing, J: 20 decades under a soft stroke. *Derived*.
pub(super) const FAINT: f64 = 1e-24;

/// Share of what is due that a band with nothing to scale gets by kicks in a block.
const SEEDED: f64 = 0.125;

/// A band of modes.
#[derive(Default)]
pub(super) struct Band {
    pub(super) modes: Range<usize>,
    /// Modes per hertz at the lower edge over the logarithm of the ratio to the middle of the band below, as built, s.
    conductance: f64,
    /// Distance of neighbouring modes as built, rad/s.
    spacing: f64,
    /// Mean decay rate of the modes, 1/s.
    pub(super) sigma: f64,
    /// Waiting, J.
    pub(super) pending: f64,
    /// Of the modes.
    pub(super) energy: BandEnergy,
    /// Energy that passes the lower edge upward in this block, J, and that over the difference of the energies per mode, dimensionless.
    pub(super) flux: f64,
    pub(super) through: f64,
    /// Share of its energy that a mode exchanges within the band in this block, and share of what the band gets that all modes
    /// get evenly, dimensionless.
    exchanged: f64,
    shared: f64,
    /// Of the implicit step: energy per mode at the end of the block, J, and how it depends on that of the band above, dimensionless.
    pub(super) mean: f64,
    pub(super) share: f64,
}

/// `Gamma / (Gamma + a delta)` of a rate and a distance in the same unit, dimensionless.
fn gate(gamma: f64, distance: f64) -> f64 {
    gamma / (gamma + distance).max(f64::MIN_POSITIVE)
}

impl Band {
    /// The top of the coupled modes, and bands of all modes above; none if no mode is coupled, or all are. Allocates.
    pub(super) fn all(coupled: Range<usize>, modes: &[Mode]) -> Option<Vec<Band>> {
        let hz = |k: usize| modes[k].omega / TAU;
        if coupled.is_empty() || coupled.end >= modes.len() {
            return None;
        }
        let from =
            |least: f64, first: usize, end: usize| (first..end).find(|&k| hz(k) >= least).unwrap_or(end);
        let lowest = TOP * hz(coupled.end - 1);
        let mut edges = vec![(from(lowest, coupled.start, coupled.end - 1), lowest)];
        let mut next = coupled.end;
        while next < modes.len() {
            edges.push((next, hz(next)));
            let end = from(hz(next) * (1.0 / BANDS_PER_OCTAVE).exp2(), next, modes.len());
            next = end.max(next + LEAST_MODES);
            if next + LEAST_MODES > modes.len() {
                next = modes.len();
            }
        }
        edges.push((modes.len(), hz(modes.len() - 1)));
        Some(Band::between(&edges))
    }

    /// The bands between edges: first mode and lowest frequency, Hz.
    fn between(edges: &[(usize, f64)]) -> Vec<Band> {
        let middle = |at: usize| (edges[at].1 * edges[at + 1].1).sqrt();
        let count = |from: usize, to: usize| (edges[to].0 - edges[from].0) as f64;
        let band = |at: usize| {
            let (first, low) = edges[at];
            let (end, high) = edges[at + 1];
            let spacing = TAU * (high - low) / count(at, at + 1);
            let conductance = match at {
                0 => 0.0,
                _ => count(at - 1, at + 1) / (high - edges[at - 1].1) / (middle(at) / middle(at - 1)).ln(),
            };
            Band { modes: first..end, conductance, spacing, ..Band::default() }
        };
        (0..edges.len() - 1).map(band).collect()
    }

    /// Follows a change of the modes.
    pub(super) fn follow(&mut self, modes: &[Mode]) {
        let sum: f64 = modes[self.modes.clone()].iter().map(|mode| mode.sigma).sum();
        self.sigma = sum / self.modes.len() as f64;
    }

    /// Opens the lower edge at a rate (per block and second), between bands of `count` modes in the mean. `delta` times the
    /// spacing is the distance of modes times a block, dimensionless.
    pub(super) fn open(&mut self, rate: f64, count: usize, delta: f64) {
        let through = rate * self.conductance;
        self.through = through * gate(2.0 * through / count as f64, BETWEEN * self.spacing * delta);
    }

    /// Works out how the modes exchange within the band, given what passes the upper edge.
    pub(super) fn mingle(&mut self, above: f64, delta: f64) {
        let gamma = (self.through + above) / self.modes.len() as f64;
        self.shared = gate(gamma, WITHIN * self.spacing * delta);
        let exchanged = gamma * self.shared / (1.0 + gamma * self.shared);
        self.exchanged = if exchanged < LEAST_EXCHANGED { 0.0 } else { exchanged };
    }

    /// The most that it can give in a block, J.
    pub(super) fn can_pay(&self) -> f64 {
        (self.pending + LARGEST_LOSS * self.energy.kinetic).max(0.0)
    }

    /// Gives the modes what is due (J), or takes it if below zero, as far as they can. Returns what was given, J.
    pub(super) fn give(
        &self,
        due: f64,
        body: &mut ModalBody,
        (weights, signs): (&BandWeights, &mut Rng),
    ) -> f64 {
        let (kinetic, modes) = (self.energy.kinetic, self.modes.len() as f64);
        let most = LARGEST_GAIN * kinetic;
        let wanted = due.clamp(-LARGEST_LOSS * kinetic, most + SEEDED * due.max(0.0));
        if wanted == 0.0 && self.exchanged == 0.0 {
            return 0.0;
        }
        let evenly = (self.exchanged * self.energy.whole + self.shared * wanted) / modes;
        let evenly = if evenly < FAINT { 0.0 } else { evenly };
        if self.exchanged > 0.0 {
            body.equalize_band(self.modes.clone(), (1.0 - self.exchanged) as f32, evenly as f32, weights);
        }
        if wanted > 0.0 {
            let kicked = KICKED * self.shared * wanted + (wanted - most).max(0.0);
            body.kick_band(self.modes.clone(), kicked / modes, weights, signs);
        }
        // What the band has got is exact, whatever its modes have.
        let now = body.band_energy(self.modes.clone(), weights).kinetic;
        if now <= 0.0 {
            return now - kinetic;
        }
        // Rounded down, so that no band ever waits to pay.
        let factor = (((kinetic + wanted).max(0.0) / now).sqrt() as f32).next_down();
        body.scale_band(self.modes.clone(), factor);
        now * f64::from(factor).powi(2) - kinetic
    }
}
