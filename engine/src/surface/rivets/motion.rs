//! One rivet: its mass, its two ends, what becomes of them in a sample.

use crate::modal::{InputVector, Pressure};
use crate::surface::oscillator::Oscillator;

/// Acceleration by gravity: what falls gains 9.81 m/s in a second.
pub const GRAVITY: f64 = 9.806_65;

/// Which way head and lower end press the plate, 1 into the surface, -1 out of it.
pub const ENDS: [f64; 2] = [1.0, -1.0];

/// One end of a rivet against the plate.
#[derive(Debug, Clone, Copy, Default)]
pub struct End {
    /// Whether it touches at the end of the latest sample.
    pub touching: bool,
    /// Loss of the present touch, s/m.
    pub lambda: f64,
    /// Force of the present sample, N, never negative.
    pub force: f64,
}

/// A rivet in its hole.
pub struct Rivet {
    /// The plate at the hole.
    pub port: InputVector,
    /// Pressure at each receiver proportional to the force, per unit force, Pa/N.
    pub direct: Pressure,
    /// Coupling with the nonlinear force, m over the root of J.
    pub coupling: f64,
    /// The rivet itself.
    pub mass: Oscillator,
    /// Its displacement at which it lies on a plate at rest, m.
    pub origin: f64,
    /// Overlap of head and plate, m; negative: how far it is above.
    pub compression: f64,
    /// The same at the end of the sample if nothing touched, m.
    pub free: f64,
    /// The same at the end of the sample, m.
    pub becomes: f64,
    /// Head and lower end.
    pub ends: [End; 2],
}

impl Rivet {
    /// A rivet of that mass (kg) in a plate of so many modes; a sample lasts `dt` s. Allocates.
    pub fn new(modes: usize, mass: f64, dt: f64) -> Rivet {
        Rivet {
            port: InputVector::new(modes),
            direct: Pressure::default(),
            coupling: 0.0,
            mass: Oscillator::free(mass, dt),
            origin: 0.0,
            compression: 0.0,
            free: 0.0,
            becomes: 0.0,
            ends: [End::default(); 2],
        }
    }

    /// Lies still on the plate, whose place (m) gives the origin, under its weight (N).
    pub fn lie(&mut self, origin: f64, compression: f64, lambda: f64, weight: f64) {
        self.mass.rest();
        (self.origin, self.compression) = (origin, compression);
        self.ends = [End { touching: true, lambda, force: weight }, End::default()];
    }

    /// Overlap of head and lower end with the plate at a compression, m.
    pub fn overlaps_at(compression: f64, play: f64) -> [f64; 2] {
        [compression, -play - compression]
    }

    /// Overlap of head and lower end with the plate, m.
    pub fn overlaps(&self, play: f64) -> [f64; 2] {
        Rivet::overlaps_at(self.compression, play)
    }

    /// Force on the plate, into the surface, N.
    pub fn force(&self) -> f64 {
        self.ends[0].force - self.ends[1].force
    }

    /// Whether neither end touches.
    pub fn is_aloft(&self) -> bool {
        self.ends.iter().all(|end| !end.touching)
    }

    /// Whether its head is on the plate.
    pub fn lies(&self) -> bool {
        self.ends[0].touching
    }

    /// Ends the sample. Returns how many ends have landed.
    pub fn finish(&mut self, play: f64) -> u32 {
        self.compression = self.becomes;
        let mut landed = 0;
        for (end, overlap) in self.ends.iter_mut().zip(Rivet::overlaps_at(self.compression, play)) {
            let touched = std::mem::replace(&mut end.touching, overlap > 0.0);
            landed += u32::from(end.touching && !touched);
        }
        landed
    }
}
