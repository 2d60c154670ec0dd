//! Rigid motion of a cymbal on its rod or seat: heave and two tilts.
//!
//! Model: three masses on springs. In units of the tilt's displacement `q`, of unit mean square over the disc,
//! the disc moves by `2 r q cos(theta)` at the share `r` of its radius, and `q` has the mass of the cymbal. The state is
//! `f64`, as the distance to the other cymbal is ten thousand times a compression of their contacts.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::numbers::{Numbers, Visitor};
use crate::surface::oscillator::Oscillator;

/// Weights of heave and both tilts at a point.
pub type Weights = [f64; 3];

/// Mount of a cymbal at its centre: felts, as springs and dampers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mount {
    /// Frequency at which the cymbal bounces on it, Hz, 1 to 200.
    pub bounce_hz: f64,
    /// Frequency at which it rocks, Hz, 0.5 to 100.
    pub rock_hz: f64,
    /// Quality factor of the bounce, and of the rock unless it has its own, 0.6 to 100.
    pub q: f64,
    /// Quality factor of the rock, 0.6 to 100.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rock_q: Option<f64>,
    /// Decay rate that the felts add to a mode of unit mean square under them, 1/s, 0 to 100.
    #[serde(rename = "damping_1_s")]
    pub damping: f64,
    /// How far out they reach, share of the radius, 0 to 0.5.
    pub reach: f64,
}

impl Numbers for Mount {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("bounce_hz", &mut self.bounce_hz, 1.0..=200.0);
        visitor.number("rock_hz", &mut self.rock_hz, 0.5..=100.0);
        visitor.number("q", &mut self.q, 0.6..=100.0);
        if let Some(q) = &mut self.rock_q {
            visitor.number("rock_q", q, 0.6..=100.0);
        }
        visitor.number("damping_1_s", &mut self.damping, 0.0..=100.0);
        visitor.number("reach", &mut self.reach, 0.0..=0.5);
    }
}

/// A cymbal as a rigid body on its mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid {
    parts: [Oscillator; 3],
    stiffness: [f64; 3],
    /// Force per speed of the mount, N s/m.
    damping: f64,
    /// m.
    radius: f64,
}

impl Rigid {
    /// A cymbal of that mass (kg) and radius (m), at rest.
    pub fn new((mass, radius): (f64, f64), mount: &Mount, lossless: bool, dt: f64) -> Rigid {
        let rock = (TAU * mount.rock_hz, mount.rock_q.unwrap_or(mount.q));
        let motions = [(TAU * mount.bounce_hz, mount.q), rock, rock];
        let sigma = |(omega, q): (f64, f64)| if lossless { 0.0 } else { omega / (2.0 * q) };
        Rigid {
            parts: motions.map(|motion| Oscillator::sprung(mass, motion.0, sigma(motion), dt)),
            stiffness: motions.map(|(omega, _)| mass * omega * omega),
            damping: 2.0 * sigma(motions[0]) * mass,
            radius,
        }
    }

    /// Weights of the point at `radius` (share of it) in direction `angle` (rad).
    pub fn weights(radius: f64, angle: f64) -> Weights {
        let (sin, cos) = angle.sin_cos();
        let [heave, x, z] = Rigid::around(radius);
        [heave, x * cos, z * sin]
    }

    /// Amplitudes of what the heave, the one and the other tilt do at `radius` (share of it): the first is the same all around, the second goes as the
    /// cosine and the third as the sine of the angle.
    pub fn around(radius: f64) -> Weights {
        [1.0, 2.0 * radius, 2.0 * radius]
    }

    /// Displacement of a point, m.
    pub fn at(&self, weights: &Weights) -> f64 {
        self.parts.iter().zip(weights).map(|(part, weight)| part.q * weight).sum()
    }

    /// Heave and tilts, m.
    pub fn place(&self) -> [f64; 3] {
        self.parts.map(|part| part.q)
    }

    /// Its tilts, the side at angle 0 down and that at a right angle to it, rad.
    pub fn tilt(&self) -> [f64; 2] {
        [1, 2].map(|part| 2.0 * self.parts[part].q / self.radius)
    }

    /// Speeds of heave and tilts, m/s.
    pub fn speeds(&self) -> Weights {
        self.parts.map(|part| part.v)
    }

    /// Puts it to rest at this heave and these tilts, m.
    pub fn put(&mut self, place: &[f64; 3]) {
        for (part, &q) in self.parts.iter_mut().zip(place) {
            (part.q, part.v) = (q, 0.0);
        }
    }

    /// Displaces it by this heave and these tilts, m; its speed stays.
    pub fn displace(&mut self, by: &Weights) {
        self.parts.iter_mut().zip(by).for_each(|(part, by)| part.q += by);
    }

    /// Sets the speeds of heave and tilts, m/s.
    pub fn set_speed(&mut self, speed: [f64; 3]) {
        self.parts.iter_mut().zip(speed).for_each(|(part, v)| part.v = v);
    }

    /// One-sample compliance between two points, m/N.
    pub fn compliance(&self, a: &Weights, b: &Weights) -> f64 {
        self.parts.iter().zip(a.iter().zip(b)).map(|(part, (a, b))| a * b * part.compliance()).sum()
    }

    /// Static compliance between two points, m/N.
    pub fn steady_compliance(&self, a: &Weights, b: &Weights) -> f64 {
        self.stiffness.iter().zip(a.iter().zip(b)).map(|(stiffness, (a, b))| a * b / stiffness).sum()
    }

    /// Advances a sample without force.
    pub fn step(&mut self) {
        self.parts.iter_mut().for_each(Oscillator::step);
    }

    /// Adds the effect of a force (N) held over the sample just stepped.
    pub fn push(&mut self, weights: &Weights, force: f64) {
        self.parts.iter_mut().zip(weights).for_each(|(part, weight)| part.push(weight * force));
    }

    /// Force of the mount on the heave, N, with the mount at `y` moving at `v`, in addition to the body's own spring to zero; and
    /// the damper's share of it.
    pub fn drawn(&self, y: f64, v: f64) -> (f64, f64) {
        let damper = self.damping * v;
        (self.stiffness[0] * y + damper, damper)
    }

    /// Adds the effect of several forces, summed with the weights of each part, N.
    pub fn push_parts(&mut self, forces: &Weights) {
        self.parts.iter_mut().zip(forces).for_each(|(part, force)| part.push(*force));
    }

    /// Energy with the mount held at `y`, J.
    pub fn energy(&self, y: f64) -> f64 {
        let absolute: f64 = self.parts.iter().map(Oscillator::energy).sum();
        absolute + self.stiffness[0] * y * (0.5 * y - self.parts[0].q)
    }

    /// Energy of its motion alone, J.
    pub fn motion(&self) -> f64 {
        self.parts.iter().map(Oscillator::motion).sum()
    }

    /// Energy of the tilts, J.
    pub fn rock_energy(&self) -> f64 {
        self.parts[1..].iter().map(Oscillator::energy).sum()
    }

    /// Largest distance, m, of any point on the rim from its rest position with the mount at `y`, if nothing else acts.
    pub fn reach(&self, y: f64) -> f64 {
        let far = |part: &Oscillator, stiffness: f64, rest: f64| {
            let spring = stiffness * (0.5 * rest * rest - rest * part.q);
            (2.0 * (part.energy() + spring).max(0.0) / stiffness).sqrt()
        };
        let [heave, x, z] = &self.parts;
        let [k_heave, k_x, k_z] = self.stiffness;
        far(heave, k_heave, y) + 2.0 * far(x, k_x, 0.0).hypot(far(z, k_z, 0.0))
    }

    /// Whether all values are finite.
    pub fn is_finite(&self) -> bool {
        self.parts.iter().all(|part| part.q.is_finite() && part.v.is_finite())
    }
}
