//! Exciters of a struck body: their masses and springs, and their points of contact.
//!
//! A striker is a free mass behind a tip, a stick also bends and may meet the rim with its shaft; a
//! row of snare wires is a string that a preload presses on. All are a few
//! [oscillators](super::oscillator), of which every point feels a weighted sum, and all meet the
//! surface by the one [contact law](crate::contact).
//!
//! Preloaded points are measured from their static equilibrium under the preload. Only the difference of a force from the
//! preload acts.

use crate::contact::{ContactLaw, ContactStep, Material};
use crate::modal::{InputVector, Pressure};
use crate::stick::{BENDING, Beam, Beams, Stick};
use crate::strike::{Across, Striker, StrikerSpec};

use super::film_band::FilmBand;
use super::local_compliance::BANDS;
use super::oscillator::Oscillator;

/// Oscillators of one exciter, at most: two of a rigid stick with those of its bending; snare wires have fewer.
pub const PARTS: usize = 2 + BENDING;

/// What a point presses on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// The struck body itself.
    Body,
    /// The body of an attachment, counted in the order in which they were attached.
    Attachment(usize),
}

/// A point of contact.
///
/// More than fifteen fields: place, law, state and present sample of one point are read together in the same loop.
pub struct ContactPoint {
    /// Whether there is one.
    pub present: bool,
    /// The body it presses on.
    pub ground: Ground,
    /// By which law.
    pub law: ContactLaw,
    /// Where it touches.
    pub port: InputVector,
    /// Pressure at each receiver proportional to the force, per unit force, Pa/N.
    pub direct: Pressure,
    /// Weights of each part of its exciter.
    pub weights: [f64; PARTS],
    /// Bands of the head's local compliance.
    pub bands: [FilmBand; BANDS],
    /// Bands in use.
    pub band_count: usize,
    /// Displacement of its exciter at which it touches a surface at rest, m.
    pub origin: f64,
    /// Force that holds it in equilibrium, N.
    pub preload: f64,
    /// Compression in equilibrium, m.
    pub static_compression: f64,
    /// Overlap with the surface now, m.
    pub compression: f64,
    /// Loss of the present touch, s/m.
    pub lambda: f64,
    /// Whether it touches at the end of the latest sample, and whether it did at its start.
    pub touching: bool,
    /// See `touching`.
    pub touched: bool,
    /// Whether shape or body have changed since it was last connected.
    pub stale: bool,
    /// Force of the present sample, N, preload and all.
    pub force: f64,
    /// What the sample is solved from.
    pub step: ContactStep,
}

impl ContactPoint {
    /// No point yet, on a body of so many modes; a sample lasts `dt` s. Allocates.
    pub fn absent(modes: usize, dt: f64) -> ContactPoint {
        let spec = Striker::Stick.spec();
        ContactPoint {
            present: false,
            ground: Ground::Body,
            law: ContactLaw::new(&spec.tip, &Material::FILM, spec.restitution),
            port: InputVector::new(modes),
            direct: Pressure::default(),
            weights: [0.0; PARTS],
            bands: [FilmBand::linear(Oscillator::free(1.0, dt)); BANDS],
            band_count: 0,
            origin: 0.0,
            preload: 0.0,
            static_compression: 0.0,
            compression: 0.0,
            lambda: 0.0,
            touching: false,
            touched: false,
            stale: true,
            force: 0.0,
            step: ContactStep { before: 0.0, free: 0.0, compliance: 0.0, lambda: 0.0, dt },
        }
    }

    /// A point just about to touch.
    pub fn arrive(&mut self, ground: Ground, law: ContactLaw, weights: [f64; PARTS]) {
        self.present = true;
        (self.ground, self.law, self.weights) = (ground, law, weights);
        (self.preload, self.static_compression, self.compression, self.force) = (0.0, 0.0, 0.0, 0.0);
        // A point that others push into contact before it flies into it has no approach speed: it loses nothing.
        (self.touching, self.lambda) = (false, 0.0);
        self.band_count = 0;
    }

    /// Force less the preload, N.
    pub fn pressing(&self) -> f64 {
        self.force - self.preload
    }

    /// Prepares the sample's contact. `apart` is the overlap (m) of exciter and surface without contact forces, measured from
    /// equilibrium; `compliance` that of the surface's modes and the exciter.
    pub fn free_flight(&mut self, apart: f64, compliance: f64, dt: f64) {
        let mut compliance = compliance;
        let mut gap = apart;
        for band in &mut self.bands[..self.band_count] {
            band.step();
            gap -= band.moved();
            compliance += band.compliance();
        }
        // The law gives the whole force, so the effect of the preload is added.
        let free = self.static_compression + gap + compliance * self.preload;
        if !self.touching && free > 0.0 {
            self.lambda = self.law.lambda((free - self.compression) / dt);
        }
        self.step = ContactStep { before: self.compression, free, compliance, lambda: self.lambda, dt };
    }

    /// Applies the force of the sample; `others` is the displacement by the forces of all other points, m.
    pub fn finish(&mut self, others: f64) {
        self.compression = self.step.free - others - self.step.compliance * self.force;
        self.touched = std::mem::replace(&mut self.touching, self.compression > 0.0);
        let pressing = self.force - self.preload;
        for band in &mut self.bands[..self.band_count] {
            band.push(pressing);
        }
    }

    /// Deflection of the head's local compliance, m.
    pub fn bands_bent(&self) -> f64 {
        self.bands[..self.band_count].iter().map(FilmBand::moved).sum()
    }

    /// Energy of the contact and the local compliance above that of equilibrium, J.
    pub fn energy(&self) -> f64 {
        let bands: f64 = self.bands[..self.band_count].iter().map(FilmBand::energy).sum();
        let held = self.law.potential(self.compression) - self.law.potential(self.static_compression);
        bands + held - self.preload * (self.compression - self.static_compression)
    }
}

/// A striker with one or two points of contact, or a row of snare wires with four.
pub struct Exciter {
    /// Whether there is one.
    pub present: bool,
    /// Its oscillators.
    pub parts: [Oscillator; PARTS],
    /// Parts in use.
    pub part_count: usize,
    /// Parts that do not bend: the first ones.
    pub rigid: usize,
    /// Speed it came with, m/s.
    pub speed: f64,
    /// Energy it came with, J.
    pub arrived: f64,
    /// Samples since it arrived.
    pub age: u64,
    /// Which stroke of the surface this was.
    pub stroke: u32,
}

impl Exciter {
    /// None yet; a sample lasts `dt` s.
    pub fn absent(dt: f64) -> Exciter {
        Exciter {
            present: false,
            parts: [Oscillator::free(1.0, dt); PARTS],
            part_count: 0,
            rigid: 1,
            speed: 0.0,
            arrived: 0.0,
            age: 0,
            stroke: 0,
        }
    }

    /// Becomes a striker at `speed` (m/s); returns what its tip feels of its parts. One that is not
    /// `lossy` bends without loss.
    pub fn take(
        &mut self,
        spec: &StrikerSpec,
        speed: f64,
        beams: &Beams,
        (lossy, dt): (bool, f64),
    ) -> [f64; PARTS] {
        let mut weights = [0.0; PARTS];
        (self.parts[0], weights[0]) = (Oscillator::free(spec.mass, dt), 1.0);
        self.parts[0].v = speed;
        (self.part_count, self.speed, self.rigid) = (1, speed, 1);
        if let Some(stick) = spec.stick {
            self.bend(&stick, beams.of(&stick), &mut [(stick.place, &mut weights)], (lossy, dt));
        }
        self.arrived = self.energy();
        weights
    }

    /// Becomes a stick that meets head and rim at `speed` (m/s), its shaft at `shaft` (share of the length from
    /// the tip); returns what its tip and its shaft feel of its parts.
    ///
    /// A rigid rod moves along and turns, each with all of its mass, which is the stick's alone.
    pub fn take_across(
        &mut self,
        (stick, across): (&Stick, Across),
        speed: f64,
        shaft: f64,
        beams: &Beams,
        (lossy, dt): (bool, f64),
    ) -> [[f64; PARTS]; 2] {
        let mut weights = [[0.0; PARTS]; 2];
        let beam = beams.of(stick);
        let rod = beam.rod;
        let [tip, side] = [stick.place, shaft].map(|place| rod.turning(place));
        (self.parts[0], self.parts[1]) = (Oscillator::free(rod.mass, dt), Oscillator::free(rod.mass, dt));
        (weights[0][0], weights[0][1], weights[1][0], weights[1][1]) = (1.0, tip, 1.0, side);
        (self.parts[0].v, self.parts[1].v) = match across {
            Across::RimShot => (speed, 0.0),
            // The tip stays where it is.
            Across::CrossStick => (-tip * speed / (side - tip), speed / (side - tip)),
        };
        (self.part_count, self.speed, self.rigid) = (2, speed, 2);
        let [at_tip, at_side] = &mut weights;
        self.bend(stick, beam, &mut [(stick.place, at_tip), (shaft, at_side)], (lossy, dt));
        self.arrived = self.energy();
        weights
    }

    /// Adds a stick's bending; writes what each place feels of it.
    fn bend(
        &mut self,
        stick: &Stick,
        Beam { rod, bending }: &Beam,
        places: &mut [(f64, &mut [f64; PARTS])],
        (lossy, dt): (bool, f64),
    ) {
        for mode in bending {
            let sigma = if lossy { mode.omega / (2.0 * stick.q) } else { 0.0 };
            self.parts[self.part_count] = Oscillator::sprung(rod.mass, mode.omega, sigma, dt);
            for (place, weights) in places.iter_mut() {
                weights[self.part_count] = mode.shape(*place);
            }
            self.part_count += 1;
        }
    }

    /// Speed away from the surface, m/s: of a free mass its own, of a stick across the rim that with which what
    /// it still has of its motion would arrive.
    pub fn leaving_speed(&self) -> f64 {
        let rigid = &self.parts[..self.rigid];
        if self.rigid == 1 {
            return -rigid[0].v;
        }
        let left: f64 = rigid.iter().map(Oscillator::energy).sum();
        self.speed * (left / self.arrived.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Advances a sample without force.
    pub fn step(&mut self) {
        self.parts[..self.part_count].iter_mut().for_each(Oscillator::step);
    }

    /// Where a point of it is, m.
    pub fn position(&self, weights: &[f64; PARTS]) -> f64 {
        self.parts[..self.part_count].iter().zip(weights).map(|(part, weight)| weight * part.q).sum()
    }

    /// How far a unit force held at one point moves another by the end of the sample, m/N.
    pub fn compliance(&self, a: &[f64; PARTS], b: &[f64; PARTS]) -> f64 {
        let parts = self.parts[..self.part_count].iter().zip(a).zip(b);
        parts.map(|((part, a), b)| a * b * part.compliance()).sum()
    }

    /// Applies the force (N, against it) held over the sample at a point.
    pub fn push(&mut self, weights: &[f64; PARTS], force: f64) {
        for (part, weight) in self.parts[..self.part_count].iter_mut().zip(weights) {
            part.push(-weight * force);
        }
    }

    /// Energy of its motion and of what is bent, J.
    pub fn energy(&self) -> f64 {
        self.parts[..self.part_count].iter().map(Oscillator::energy).sum()
    }

    /// Energy of its motion alone, J.
    pub fn motion(&self) -> f64 {
        self.parts[..self.part_count].iter().map(Oscillator::motion).sum()
    }
}
