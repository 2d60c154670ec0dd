//! Snare wires: groups of strands that lie against the far head, fly off it and land again.
//!
//! Model: the twenty strands move as [`GROUPS`] masses, each on a soft spring with a little damping, pressed
//! against the head by its share of the strainer's force; steel on film, the law of every contact. Where the
//! head falls back faster than the preload can follow, a group flies, and each landing is an impact.
//!
//! Displacements are measured from where the preload alone holds head and wires, so that a drum at rest is
//! at rest exactly, whatever the preload.
//!
//! Neglected: motion of the strands against each other, their own bending waves, their weight.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::contact::{ContactLaw, Material, Tip};
use crate::fitted;
use crate::numbers::{Numbers, Visitor};
use crate::shapes::ShapeTable;
use crate::snapshot::WireSnapshot;

use super::oscillator::Oscillator;
use super::touch::{Side, TouchPoint, Toucher};
use super::{FIRST_WIRE, MAX_STRIKERS, Surface, owner};

/// Groups of strands.
pub const GROUPS: usize = 8;

/// Where they lie on the head, shares of its radius: two rows of four across it.
pub const PLACES: [[f64; 2]; GROUPS] = [
    [-0.56, -0.105],
    [-0.19, -0.105],
    [0.19, -0.105],
    [0.56, -0.105],
    [-0.56, 0.105],
    [-0.19, 0.105],
    [0.19, 0.105],
    [0.56, 0.105],
];

/// Least and greatest force of the strainer on all groups, N.
pub const PRELOAD: RangeInclusive<f64> = 0.03..=1.5;

/// A description of snare wires.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WiresSpec {
    /// Mass of all strands, kg, 0.001 to 0.03.
    #[serde(rename = "mass_kg")]
    pub mass: f64,
    /// Stiffness of the spring that a group of strands is on, N/m, 10 to 5000.
    #[serde(rename = "stiffness_n_m")]
    pub stiffness: f64,
    /// Quality factor of that spring, 0.6 to 100.
    pub q: f64,
    /// Radius of a wire, m, 0.0001 to 0.003.
    #[serde(rename = "wire_radius_m")]
    pub radius: f64,
    /// What a wire is made of.
    pub material: Material,
    /// Restitution of a landing, a ratio of speeds, 0.05 to 0.95.
    pub restitution: f64,
}

impl Numbers for WiresSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("mass_kg", &mut self.mass, 1e-3..=0.03);
        visitor.number("stiffness_n_m", &mut self.stiffness, 10.0..=5000.0);
        visitor.number("q", &mut self.q, 0.6..=100.0);
        visitor.number("wire_radius_m", &mut self.radius, 1e-4..=3e-3);
        self.material.visit_part("material", visitor);
        visitor.number("restitution", &mut self.restitution, 0.05..=0.95);
    }
}

/// Radius of the disc that a group falls on, m: what it moves of the head at once decides how hard a landing is.
/// *By ear*, between the 3 cm of a disc as large as a group's share of the wires and the 7 cm of its length.
pub const PATCH: f64 = fitted::WIRE_PATCH;
/// Radius of the disc on which a single turn of a strand strikes, m: as fine as that are the waves that landings
/// set going. *Derived*: some wire radii.
pub const TURN: f64 = 0.002;

/// The speed of landing that a touch without one, as of wires at rest, is as lossy as, m/s. *Derived*: what a
/// group falling back by the preload reaches in a millisecond.
const RESTING_SPEED: f64 = 0.02;

/// Energy of the drum under which the wires lie still, J: nothing is heard of them.
pub const STILL: f64 = 1e-10;

/// All groups of one drum.
pub struct SnareWires {
    /// Whether they lie against the head.
    pub on: bool,
    /// Whether they and the head lie still together.
    pub parked: bool,
    /// Force of the strainer, N.
    pub preload: f64,
    /// The law of every group.
    pub law: ContactLaw,
    /// Samples since the latest stroke.
    pub age: u64,
    spec: WiresSpec,
    landings: u32,
    last_lift: u64,
    dt: f64,
}

impl SnareWires {
    /// Wires against a head of that material, at rest; a sample lasts `dt` s.
    pub fn new(spec: &WiresSpec, head: &Material, lossless: bool, dt: f64) -> SnareWires {
        let tip = Tip::Solid { material: spec.material, radius: spec.radius };
        let law = ContactLaw::new(&tip, head, if lossless { 1.0 } else { spec.restitution });
        SnareWires {
            on: true,
            parked: true,
            preload: *PRELOAD.start(),
            law,
            age: 0,
            spec: *spec,
            landings: 0,
            last_lift: 0,
            dt,
        }
    }

    /// A group on its spring.
    pub fn group(&self, lossless: bool) -> Oscillator {
        let WiresSpec { mass, stiffness, q, .. } = self.spec;
        let mass = mass / GROUPS as f64;
        let omega = (stiffness / mass).sqrt();
        let sigma = if lossless { 0.0 } else { omega / (2.0 * q) };
        Oscillator::sprung(mass, omega, sigma, self.dt)
    }

    /// Each group's share of the preload (N), and the compression (m) it holds.
    pub fn seat(&self) -> (f64, f64) {
        let share = self.preload / GROUPS as f64;
        (share, (share / self.law.stiffness).powf(1.0 / self.law.exponent))
    }

    /// Loss of a touch that began at rest, s/m.
    pub fn resting_lambda(&self) -> f64 {
        self.law.lambda(RESTING_SPEED)
    }

    /// Counts anew from a stroke on.
    pub fn begin_count(&mut self) {
        (self.age, self.landings, self.last_lift) = (0, 0, 0);
    }

    /// Counts a group that was or was not touching and now is or is not.
    pub fn count(&mut self, before: bool, now: bool) {
        match (before, now) {
            (false, true) => self.landings = self.landings.saturating_add(1),
            (true, false) => self.last_lift = self.age,
            _ => {}
        }
    }

    /// What is to be seen of them; `aloft` has a bit for each group off the head.
    pub fn snapshot(&self, aloft: u32) -> WireSnapshot {
        WireSnapshot { landings: self.landings, aloft, last_lift: (self.last_lift as f64 * self.dt) as f32 }
    }
}

impl Surface {
    /// Gives the drum snare wires; [`lay_wires`](Self::lay_wires) tells where. Allocates.
    pub fn set_wires(&mut self, spec: &WiresSpec, head: &Material) {
        let wires = SnareWires::new(spec, head, self.lossless, self.dt);
        let (preload, seat) = wires.seat();
        for _ in PLACES {
            let mut point = TouchPoint::absent(self.body.len(), self.dt);
            point.arrive(Side::Surface, wires.law, [1.0, 0.0, 0.0, 0.0, 0.0]);
            (point.present, point.preload, point.seat) = (false, preload, seat);
            let mut group = Toucher::absent(self.dt);
            (group.parts[0], group.part_count) = (wires.group(self.lossless), 1);
            self.points.push(point);
            self.touchers.push(group);
        }
        self.wires = Some(wires);
    }

    /// Lays the wires against the far head of these shapes (positive along the stroke).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn lay_wires(&mut self, far: &ShapeTable) {
        let disc = self.far_film.map_or(0.0, |film| PATCH / film.radius);
        for (point, [x, y]) in self.points.iter_mut().skip(FIRST_WIRE).zip(PLACES) {
            let shape = point.port.shape_mut();
            far.fill_pressed(x.hypot(y), x.atan2(-y), disc, shape);
            // They lie on the other side: their way into the head is against the stroke.
            shape.iter_mut().for_each(|shape| *shape = -*shape);
        }
        if let Some(high) = &mut self.far_high {
            for (i, [x, y]) in PLACES.into_iter().enumerate() {
                high.put(i, x.hypot(y), x.atan2(-y), TURN);
            }
        }
        for i in FIRST_WIRE..self.points.len() {
            let position = self.touchers[owner(i)].position(&self.points[i].weights);
            let moved = position - self.body.displacement_at(&self.points[i].port);
            // A head of another shape lies elsewhere under the wires; the contact must not notice.
            let point = &mut self.points[i];
            point.origin = moved - (point.compression - point.seat) - point.bands_bent();
            if point.present {
                self.connect(i);
            }
        }
    }

    /// Throws the wires on or off.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn throw_wires(&mut self, on: bool) {
        if let Some(wires) = self.wires.as_mut().filter(|wires| wires.on != on) {
            wires.on = on;
            self.park_wires();
            if on && !self.body.is_still() {
                self.wake_wires();
            }
        }
    }

    /// Sets the force of the strainer, N; live.
    pub fn set_preload(&mut self, preload: f64) {
        let Some(wires) = &mut self.wires else {
            return;
        };
        wires.preload = preload.clamp(*PRELOAD.start(), *PRELOAD.end());
        let (share, seat) = wires.seat();
        for point in &mut self.points[FIRST_WIRE..] {
            // What is measured from equilibrium stays; equilibrium itself moves.
            point.compression += seat - point.seat;
            (point.preload, point.seat) = (share, seat);
        }
    }

    /// What the wires have done since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        let groups = self.points.iter().skip(FIRST_WIRE).map(|point| point.present && !point.touching);
        let aloft = groups.enumerate().fold(0, |bits, (group, aloft)| bits | (u32::from(aloft) << group));
        self.wires.as_ref().map_or_else(WireSnapshot::default, |wires| wires.snapshot(aloft))
    }

    /// Lets the wires lie still where they are.
    pub(super) fn park_wires(&mut self) {
        if let Some(wires) = &mut self.wires {
            wires.parked = true;
            self.points[FIRST_WIRE..].iter_mut().for_each(|point| point.present = false);
            self.touchers[MAX_STRIKERS..].iter_mut().for_each(|group| group.present = false);
            self.list();
        }
    }

    /// Lets the wires move again, from the equilibrium they were left in.
    pub(super) fn wake_wires(&mut self) {
        let Some(wires) = self.wires.as_mut().filter(|wires| wires.on && wires.parked) else {
            return;
        };
        wires.parked = false;
        let lambda = wires.resting_lambda();
        for i in FIRST_WIRE..self.points.len() {
            let point = &mut self.points[i];
            (point.present, point.touching, point.lambda) = (true, true, lambda);
            (point.compression, point.force) = (point.seat, point.preload);
            if let Some(film) = self.far_film {
                let (x, y) = (PLACES[i - FIRST_WIRE][0], PLACES[i - FIRST_WIRE][1]);
                (point.bands, point.band_count) = film.bands(x.hypot(y), PATCH, !self.lossless, self.dt);
            }
            let group = &mut self.touchers[owner(i)];
            group.present = true;
            group.parts[0].rest();
            self.points[i].origin = -self.body.displacement_at(&self.points[i].port);
        }
        self.list();
        for i in FIRST_WIRE..self.points.len() {
            self.connect(i);
        }
    }
}
