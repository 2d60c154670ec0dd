//! The gap of the rims in parts: what flows out of each, and what it loses.

use crate::hi_hat::outlet::{GapPosition, HEARD, Outlets, Outside};
use crate::hi_hat::rim_points::POINTS;

use super::waves::{SECTORS, SOURCES, WAVES, around, dot, turn, wave};

/// Samples in which the sectors follow the gaps.
pub const EVERY: u32 = 8;

/// Angular frequency from which on layers at the faces are thin, rad/s: below, the flow takes them along. *Derived*: at 100 Hz a layer is a fifth of a
/// millimetre thick, as the gap of closed rims is high.
const LAYERED: f64 = 600.0;

/// What the sectors are.
#[derive(Debug, Clone, Copy)]
struct Constants {
    /// Root of the inertance, kg1/2/m2.
    mass: [f64; SECTORS],
    /// Friction over inertance, per sample, of slow flow, and what thin boundary layers add to that of fast flow.
    slow: [f64; SECTORS],
    fast: [f64; SECTORS],
}

/// The sectors, and what flows.
pub struct Sectors {
    /// As they are, and as they will be after the samples left.
    now: Constants,
    goal: Constants,
    left: u32,
    /// Cosines and sines of each order at each sector.
    around: [[f64; WAVES]; SECTORS],
    /// The same over the roots of the compliances, of unit length; and that length.
    toward: [[f64; WAVES]; SECTORS],
    length: f64,
    /// What takes the sound of each order.
    outside: [Outside; HEARD],
    /// In the root of J: `U sqrt(L)` through each sector, of the layers along its faces, and of the mass outside that each source moves: the squares are twice the energies.
    flow: [f64; SECTORS],
    layers: [f64; SECTORS],
    outer: [f64; SOURCES],
    lossless: bool,
    dt: f64,
}

impl Sectors {
    /// Of a ring (radius in m), a sample lasting `dt` s; they have yet to follow gaps and springs.
    pub fn new(radius: f64, lossless: bool, dt: f64) -> Sectors {
        let constants = Constants { mass: [1.0; SECTORS], slow: [0.0; SECTORS], fast: [0.0; SECTORS] };
        Sectors {
            now: constants,
            goal: constants,
            left: 0,
            around: std::array::from_fn(around),
            toward: [[0.0; WAVES]; SECTORS],
            length: 1.0,
            outside: std::array::from_fn(|m| Outside::new(m as u32, radius)),
            flow: [0.0; SECTORS],
            layers: [0.0; SECTORS],
            outer: [0.0; SOURCES],
            lossless,
            dt,
        }
    }

    /// Follows the roots of the compliances (m3/Pa) of all orders.
    pub fn follow_springs(&mut self, springs: impl Iterator<Item = f64> + Clone) {
        self.length = springs.clone().map(|spring| (spring * spring).recip()).sum::<f64>().sqrt();
        let mut over = [0.0; WAVES];
        for (m, spring) in springs.enumerate() {
            for (index, over) in over.iter_mut().enumerate() {
                if wave(index).0 == m {
                    *over = (spring * self.length).recip();
                }
            }
        }
        for (toward, around) in self.toward.iter_mut().zip(&self.around) {
            *toward = std::array::from_fn(|index| around[index] * over[index]);
        }
    }

    /// Follows the gaps (m) over the next [`EVERY`] samples, or at once; what flows has the angular frequency `omega`, rad/s.
    pub fn follow_gaps(&mut self, gaps: &[f64; POINTS], outlets: &Outlets, omega: f64, at_once: bool) {
        for (s, gaps) in gaps.chunks_exact(POINTS / SECTORS).enumerate() {
            // Places side by side: their admittances add up, each that of a part of the whole ring.
            let (mut re, mut im, mut thin) = (0.0, 0.0, 0.0);
            for &gap in gaps {
                let (inertance, [slow, fast]) = outlets.leaving(GapPosition::of(gap));
                let (friction, moved) = (slow + fast, omega * inertance);
                let square = (friction * friction + moved * moved) * POINTS as f64;
                (re, im) = (re + friction / square, im + moved / square);
                thin += fast / square;
            }
            let square = re * re + im * im;
            self.goal.mass[s] = (im / square / omega).sqrt();
            let loss = if self.lossless { 0.0 } else { self.dt * omega / im };
            (self.goal.slow[s], self.goal.fast[s]) = (loss * (re - thin), loss * thin);
        }
        self.left = EVERY;
        if at_once {
            (self.now, self.left) = (self.goal, 0);
        }
    }

    /// Exchanges energy between the pressures and what leaves, and takes the losses of a sample.
    #[inline(always)]
    pub fn leave(&mut self, pressed: &mut [f64; WAVES]) {
        if self.left > 0 {
            let share = 1.0 / f64::from(self.left);
            for s in 0..SECTORS {
                self.now.mass[s] += share * (self.goal.mass[s] - self.now.mass[s]);
                self.now.slow[s] += share * (self.goal.slow[s] - self.now.slow[s]);
                self.now.fast[s] += share * (self.goal.fast[s] - self.now.fast[s]);
            }
            self.left -= 1;
        }
        let turns = self.now.mass.map(
            #[inline(always)]
            |mass| turn(self.dt * self.length / mass),
        );
        for ((toward, flow), (sin, cos)) in self.toward.iter().zip(&mut self.flow).zip(turns) {
            let along = dot(toward, pressed);
            let gained = (cos - 1.0) * along - sin * *flow;
            *flow = sin * along + cos * *flow;
            pressed.iter_mut().zip(toward).for_each(|(pressed, toward)| *pressed += gained * toward);
        }
        if !self.lossless {
            self.rub();
            self.sound_outside();
        }
    }

    /// What leaves and the faces: thick layers as a dashpot, thin ones as a dashpot beside a mass, which slow flow takes along.
    #[inline(always)]
    fn rub(&mut self) {
        let corner = LAYERED * self.dt;
        for s in 0..SECTORS {
            let (slow, fast) = (0.5 * self.now.slow[s].min(2.0), self.now.fast[s].max(f64::EPSILON));
            let flow = self.flow[s] * (1.0 - slow) / (1.0 + slow);
            let lighter = (corner / fast).sqrt();
            let gone = fast * (flow - lighter * self.layers[s]) / (1.0 + 0.5 * (fast + corner));
            self.flow[s] = flow - gone;
            self.layers[s] += gone * lighter;
        }
    }

    /// What leaves and the air outside.
    #[inline(always)]
    fn sound_outside(&mut self) {
        let over = self.now.mass.map(f64::recip);
        for index in 0..SOURCES {
            let Outside { resistance, inertance } = self.outside[wave(index).0];
            let weights: [f64; SECTORS] = std::array::from_fn(|s| self.around[s][index] * over[s]);
            let outer = inertance.sqrt().recip();
            let moved = dot(&weights, &self.flow) - outer * self.outer[index];
            // What a dashpot takes in a sample, to second order, and never more than there is.
            let taken = resistance * self.dt;
            let gone = taken * moved / (1.0 + 0.5 * taken * (dot(&weights, &weights) + outer * outer));
            self.outer[index] += gone * outer;
            self.flow.iter_mut().zip(&weights).for_each(|(flow, weight)| *flow -= gone * weight);
        }
    }

    /// Flow through the rims in the shape of each source, m3/s.
    pub fn leaving(&self) -> [f64; SOURCES] {
        let flow: [f64; SECTORS] = std::array::from_fn(|s| self.flow[s] / self.now.mass[s]);
        std::array::from_fn(|index| (0..SECTORS).map(|s| self.around[s][index] * flow[s]).sum())
    }

    /// Adds to the flow of a pressure's shape through all sectors, m3/s.
    pub fn gain(&mut self, index: usize, gained: f64) {
        let (m, _) = wave(index);
        let each = gained * if m == 0 { 1.0 } else { 2.0 } / SECTORS as f64;
        for s in 0..SECTORS {
            self.flow[s] += each * self.around[s][index] * self.now.mass[s];
        }
        self.outer[index] += gained * self.outside[m].inertance.sqrt();
    }

    /// Their energy, J.
    pub fn energy(&self) -> f64 {
        let outer: f64 = self.outer.iter().map(|outer| outer * outer).sum();
        0.5 * (dot(&self.flow, &self.flow) + dot(&self.layers, &self.layers) + outer)
    }

    /// Nothing flows.
    pub fn reset(&mut self) {
        (self.flow, self.layers) = ([0.0; SECTORS], [0.0; SECTORS]);
        self.outer = [0.0; SOURCES];
    }
}
