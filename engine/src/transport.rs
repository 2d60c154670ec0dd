//! Transport of energy through the modes above the coupled ones: the cascade of a cymbal, at any quality.
//!
//! The [nonlinear force](crate::potential) couples a body's modes up to some frequency. The modes above it are linear; here
//! energy is carried from band to band of them, and in and out of the top of the coupled modes.
//!
//! Model: a cymbal that is struck hard moves in its lowest modes by more than its thickness. Their stress is a slowly
//! varying field for all higher modes, and scatters each into its neighbours in frequency. What remains of many such exchanges
//! with random phases is a diffusion of the energy per mode `e` along the frequency `f`,
//!
//! ```text
//! n de/dt = d/df (n kappa g de/df) - 2 n sigma e,   kappa = C f E / (M h^2),   g = Gamma / (Gamma + a delta)
//! ```
//!
//! with `n` the modes per hertz, `sigma` their losses, `E` the energy of all modes, `M` the mass, `h` the thickness (the root of
//! `E / (M h^2)` is a mean speed over the thickness, 1/s), and one dimensionless constant `C`,
//! [fitted](crate::fitted::ENERGY_TRANSPORT) to the exact coupling. It rests where all modes have the same energy, as the
//! coupled modes do. `g` closes the exchange after soft strokes: where the rate `Gamma` at which a mode exchanges its energy with a band a
//! sixth of an octave away is small against the distance `delta` of neighbouring modes (rad/s), few modes find others that are near enough. The
//! modes of a band become equal in the same way, more slowly: with `delta` itself instead of `a delta`.
//!
//! The exact coupling to 8 kHz decided for this law: in it the transport through a frequency depends on the energy of
//! the whole, not on the energy there as in weak turbulence (`kappa` in proportion to `e` or `e^2`).
//!
//! Scheme: once a block, the energies of the bands are taken from the states of their modes. The lowest band is the top half octave of
//! the coupled modes. An implicit step gives the energy that passes each edge; no band pays more than it has. Then impulses change the
//! velocities of each band's modes until its kinetic energy has changed by what it got. So all energy that comes to a band has left
//! another. Displacements stay, and with them the contacts and the energy of the nonlinear force. What a band cannot take at once
//! waits, and decays as its modes do.
//!
//! The impulses sound as accelerations that last for a block, so that no slow part of the sound is left over.
//!
//! The same scattering lets phases wander: a line at any frequency becomes a Lorentzian whose coherence falls at the rate
//!
//! ```text
//! D = kappa / (f L) / (1 + E / (M h^2 S^2))
//! ```
//!
//! Waves whose frequencies go with the square of their wave number, scattered by a field of the length of the lowest modes, hop by
//! frequencies in proportion to the root of their own; so `kappa` is in proportion to `f`, and `D` the same for all.
//! It grows no more where the lowest modes move by about the thickness. `L` and `S` are fitted to the exact coupling as well. Phases
//! wander by [detuning](crate::modal::ModalBody::detune), which costs no energy.
//!
//! Limits: hi-hats have no transport.
//!
//! Sources: Nazarenko, Wave Turbulence, Springer 2011 (diffusion by scattering at large scales; grids of modes too coarse for
//! exchange); Humbert, Josserand, Touze, Cadot, Physica D 316, 2016 (spectra of vibrating plates by nonlinear diffusion); Cirio,
//! Qu, Drettakis, Grinspun, Zheng, ACM Trans. Graph. 37, 2018 (modes above the coupled ones that follow an energy). That the rate
//! depends on the energy of the whole, and its dimensionless form, are ours.

mod band;

use fastrand::Rng;

use crate::fitted;
use crate::modal::bands::BandWeights;
use crate::modal::{ModalBody, Pressure, RECEIVERS, ReceiverWeights};

use band::{Band, FAINT};

/// Time over which the energy of all modes is averaged, s: longer than a period of the slowest, with which the modes exchange
/// energy with the stretching, and shorter than the swell.
const AVERAGE: f64 = 0.01;

/// Rate of exchange below which there is none, 1/s: in a second it moves no band by a tenth of a decibel.
const NEGLIGIBLE: f64 = 0.01;

/// Rate below which phases stay, 1/s: a line becomes wider by a sixth of a hertz, and decays sooner than its phase is lost.
const SLOWEST: f64 = 0.5;

/// Of the random signs: the same in every run.
const SEED: u64 = 1;

/// Time for which a mode is detuned to one side, s: a block of 44.1 kHz. At its multiples the phases take the same course.
const WALK: f64 = 32.0 / 44_100.0;

/// Largest change of a phase in that time, rad: no stroke comes near.
const LARGEST_STEP: f64 = 0.5;

/// What the transport of a body depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransportSpec {
    /// Number of modes that move the body as a whole; they stand before all others.
    pub rigid: usize,
    /// Number of modes up to the last coupled one.
    pub coupled: usize,
    /// Mass times the square of the thickness, kg m2.
    pub inertia: f64,
    /// Time between two exchanges, s.
    pub interval: f64,
}

/// Energies that have been moved since the last reset, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TransportBalance {
    /// Taken from the coupled modes, less what they got, J.
    pub drained: f64,
    /// Given to the modes above, less what was taken from them, J.
    pub injected: f64,
    /// Lost while waiting, J.
    pub spent: f64,
    /// Waiting now, J.
    pub pending: f64,
}

impl TransportBalance {
    /// What came from nowhere, J; zero to rounding.
    pub fn surplus(&self) -> f64 {
        self.injected + self.spent + self.pending - self.drained
    }
}

/// Transport of energy above the coupled modes of a body.
pub struct Transport {
    spec: TransportSpec,
    weights: BandWeights,
    /// The top of the coupled modes, and all modes above.
    bands: Vec<Band>,
    /// Highest mode as built, rad/s, and frequencies over those as built, dimensionless.
    highest: f64,
    tuning: f64,
    /// Mean energy of all modes, J.
    level: f64,
    /// The constant `C`, dimensionless.
    rate: f64,
    /// Give each block the seed of its kicks, and each walk of the phases its signs: the same whatever acted before.
    kicks: Rng,
    walks: Rng,
    /// Seed of the present walk, the blocks that it lasts, and those of it that have begun.
    walk: u64,
    walk_blocks: u32,
    walked: u32,
    balance: TransportBalance,
}

impl Transport {
    /// Of a body whose modes stand in the order of their frequency; none if no mode is coupled, or all are. Allocates.
    pub fn new(spec: TransportSpec, body: &ModalBody, receivers: &ReceiverWeights) -> Option<Transport> {
        let bands = Band::all(spec.rigid..spec.coupled, body.modes());
        let highest = body.modes().last()?.omega;
        let mut transport = Transport {
            spec,
            weights: BandWeights::new(body, receivers),
            bands: bands?,
            highest,
            tuning: 1.0,
            level: 0.0,
            rate: fitted::ENERGY_TRANSPORT,
            kicks: Rng::with_seed(SEED),
            walks: Rng::with_seed(SEED),
            walk: 0,
            walk_blocks: ((WALK / spec.interval).round() as u32).max(1),
            walked: 0,
            balance: TransportBalance::default(),
        };
        transport.follow(body, receivers);
        Some(transport)
    }

    /// Sets the constant `C`, dimensionless; 0 for none. For comparisons.
    pub fn set_rate(&mut self, rate: f64) {
        self.rate = rate;
    }

    /// What has been moved since the last reset.
    pub fn balance(&self) -> TransportBalance {
        TransportBalance { pending: self.pending(), ..self.balance }
    }

    /// Energy that waits, J.
    pub fn pending(&self) -> f64 {
        self.bands.iter().map(|band| band.pending).sum()
    }

    /// Follows a change of the modes or the receiver weights.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn follow(&mut self, body: &ModalBody, receivers: &ReceiverWeights) {
        let modes = body.modes();
        body.weigh(&mut self.weights, receivers);
        self.tuning = modes.last().map_or(1.0, |mode| mode.omega / self.highest);
        self.bands.iter_mut().for_each(|band| band.follow(modes));
    }

    /// Moves the energy of a block. Returns the sound of the impulses if they last for a block, Pa at each receiver, if there are
    /// any.
    ///
    /// # Real-time
    /// Linear in the number of modes; once a block.
    pub fn carry(&mut self, body: &mut ModalBody) -> Option<Pressure> {
        let kicks = Rng::with_seed(self.kicks.u64(..));
        if self.walked == 0 {
            self.walk = self.walks.u64(..);
        }
        self.walked = (self.walked + 1) % self.walk_blocks;
        self.measure(body);
        // How often a mode exchanges its energy in a block, if it had neighbours at every hertz of a ratio of e.
        let rate = self.rate * self.level / self.spec.inertia * self.spec.interval / self.tuning;
        self.wander(rate, body);
        let fastest = self.conduct(rate);
        let sound = (fastest > NEGLIGIBLE * self.spec.interval).then(|| {
            self.solve();
            self.limit();
            self.kick(body, kicks)
        });
        self.wait();
        sound
    }

    /// Lets the phases of the modes above the coupled ones wander.
    fn wander(&self, rate: f64, body: &mut ModalBody) {
        let strength = self.level / self.spec.inertia / (fitted::TRANSPORT_STRONG * self.tuning).powi(2);
        let diffused = rate / (fitted::TRANSPORT_HOP * (1.0 + strength));
        if diffused <= SLOWEST * self.spec.interval {
            return body.end_detuning();
        }
        let walk = f64::from(self.walk_blocks);
        let step = (2.0 * diffused * walk).sqrt().min(LARGEST_STEP);
        let shift = step / (walk * self.spec.interval);
        body.detune(self.spec.coupled, shift, &mut Rng::with_seed(self.walk));
    }

    /// Changes the velocities. Returns what [`carry`](Self::carry) does.
    fn kick(&mut self, body: &mut ModalBody, signs: Rng) -> Pressure {
        let first = self.bands.first().map_or(0, |top| top.modes.start);
        let before = body.momentum(first, &self.weights);
        self.apply(body, signs);
        let after = body.momentum(first, &self.weights);
        let per_second = self.spec.interval.recip() as f32;
        std::array::from_fn::<f32, RECEIVERS, _>(|receiver| per_second * (after[receiver] - before[receiver]))
    }

    /// Gives up what waits, as there is no force any more that scatters.
    pub fn rest(&mut self, body: &mut ModalBody) {
        body.end_detuning();
        self.balance.spent += self.pending();
        self.bands.iter_mut().for_each(|band| band.pending = 0.0);
        self.level = 0.0;
    }

    /// As new.
    pub fn reset(&mut self) {
        self.bands.iter_mut().for_each(|band| band.pending = 0.0);
        (self.level, self.balance) = (0.0, TransportBalance::default());
        (self.kicks, self.walks, self.walked) = (Rng::with_seed(SEED), Rng::with_seed(SEED), 0);
    }

    /// Takes the energies from the modes.
    fn measure(&mut self, body: &ModalBody) {
        let below = self.bands.first().map_or(self.spec.coupled, |top| top.modes.start);
        let mut sum = body.band_energy(self.spec.rigid..below, &self.weights).whole;
        for band in &mut self.bands {
            band.energy = body.band_energy(band.modes.clone(), &self.weights);
            sum += band.energy.whole + band.pending;
        }
        self.level += (self.spec.interval / AVERAGE).min(1.0) * (sum - self.level);
    }

    /// Opens the edges at a rate. Returns the largest share of its energy that a mode exchanges in a block.
    fn conduct(&mut self, rate: f64) -> f64 {
        let mut fastest = 0.0_f64;
        let delta = self.tuning * self.spec.interval;
        for at in 1..self.bands.len() {
            let below = self.bands[at - 1].modes.len();
            let band = &mut self.bands[at];
            let count = if at == 1 { band.modes.len() } else { band.modes.len().midpoint(below) };
            band.open(rate, count, delta);
            fastest = fastest.max(band.through / count as f64);
        }
        for at in 1..self.bands.len() {
            let above = self.bands.get(at + 1).map_or(0.0, |above| above.through);
            self.bands[at].mingle(above, delta);
        }
        fastest
    }

    /// What passes each edge in a block: an implicit step, by elimination from below.
    fn solve(&mut self) {
        let (mut share, mut below) = (0.0, 0.0);
        for at in 0..self.bands.len() {
            let above = self.bands.get(at + 1).map_or(0.0, |above| above.through);
            let band = &mut self.bands[at];
            let pivot = band.modes.len() as f64 + above + band.through * (1.0 - share);
            band.share = above / pivot;
            band.mean = (band.energy.whole + band.pending + band.through * below) / pivot;
            (share, below) = (band.share, band.mean);
        }
        let mut above = 0.0;
        for band in self.bands.iter_mut().rev() {
            band.mean += band.share * above;
            above = band.mean;
        }
        for at in 1..self.bands.len() {
            let below = self.bands[at - 1].mean;
            let band = &mut self.bands[at];
            band.flux = band.through * (below - band.mean);
        }
    }

    /// Lets no band pay more than it has.
    fn limit(&mut self) {
        let Some((first, above)) = self.bands.split_first_mut() else { return };
        let mut below = first.can_pay();
        for band in above {
            let here = band.can_pay();
            band.flux = band.flux.clamp(-here, below);
            below = here + band.flux;
        }
    }

    /// Changes the velocities by what the bands got.
    fn apply(&mut self, body: &mut ModalBody, mut signs: Rng) {
        for at in 0..self.bands.len() {
            let out = self.bands.get(at + 1).map_or(0.0, |above| above.flux);
            let band = &mut self.bands[at];
            let due = band.pending + band.flux - out;
            let given = band.give(due, body, (&self.weights, &mut signs));
            band.pending = due - given;
            match at {
                0 => self.balance.drained -= given,
                _ => self.balance.injected += given,
            }
        }
    }

    /// What waits decays.
    fn wait(&mut self) {
        for band in &mut self.bands {
            let share = 2.0 * band.sigma * self.spec.interval;
            let share = if share > 0.0 && band.pending.abs() < FAINT { 1.0 } else { share };
            let lost = band.pending * share.min(1.0);
            band.pending -= lost;
            self.balance.spent += lost;
        }
    }
}

#[cfg(test)]
mod tests;
