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

use std::ops::{Range, RangeInclusive};

use serde::{Deserialize, Serialize};

use crate::contact::{ContactLaw, Material, Tip};
use crate::fitted;
use crate::modal::Pressure;
use crate::numbers::{Numbers, Visitor};
use crate::shapes::ShapeTable;
use crate::snapshot::WireSnapshot;

use super::attachment::{Attachment, Site};
use super::body::FreeStep;
use super::contacts::{Contacts, owner};
use super::exciter::{ContactPoint, Exciter, Ground};
use super::local_compliance::LocalHeadCompliance;
use super::oscillator::Oscillator;

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
    on: bool,
    /// Whether they and the head lie still together.
    parked: bool,
    /// Force of the strainer, N.
    preload: f64,
    /// The law of every group.
    law: ContactLaw,
    /// The head right under a group.
    head: Option<LocalHeadCompliance>,
    /// Place of the first group's point among the contacts.
    first: usize,
    spec: WiresSpec,
    count: Landings,
    lossless: bool,
    dt: f64,
}

/// What the groups have done since the latest stroke.
#[derive(Default)]
struct Landings {
    /// Samples since the stroke.
    age: u64,
    landings: u32,
    last_lift: u64,
}

impl SnareWires {
    /// Wires against a head of that material, at rest; a sample lasts `dt` s. [`lay`](Self::lay) tells where.
    pub fn new(spec: &WiresSpec, head: &Material, lossless: bool, dt: f64) -> SnareWires {
        let tip = Tip::Solid { material: spec.material, radius: spec.radius };
        let law = ContactLaw::new(&tip, head, if lossless { 1.0 } else { spec.restitution });
        SnareWires {
            on: true,
            parked: true,
            preload: *PRELOAD.start(),
            law,
            head: None,
            first: 0,
            spec: *spec,
            count: Landings::default(),
            lossless,
            dt,
        }
    }

    /// A group on its spring.
    fn group(&self) -> Oscillator {
        let WiresSpec { mass, stiffness, q, .. } = self.spec;
        let mass = mass / GROUPS as f64;
        let omega = (stiffness / mass).sqrt();
        let sigma = if self.lossless { 0.0 } else { omega / (2.0 * q) };
        Oscillator::sprung(mass, omega, sigma, self.dt)
    }

    /// Each group's share of the preload (N), and the compression (m) it holds.
    fn static_compression(&self) -> (f64, f64) {
        let share = self.preload / GROUPS as f64;
        (share, (share / self.law.stiffness).powf(1.0 / self.law.exponent))
    }

    /// The points of all groups.
    fn points(&self) -> Range<usize> {
        self.first..self.first + GROUPS
    }

    /// The exciters of all groups.
    fn exciters(&self) -> Range<usize> {
        owner(self.first)..owner(self.first) + GROUPS
    }

    /// Lays the wires against the far head of these shapes (positive along the stroke), which yields right under them
    /// as `head` says.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn lay(&mut self, head: Option<LocalHeadCompliance>, far: &ShapeTable, site: Site<'_>) {
        let Site { body, contacts, observers } = site;
        self.head = head;
        let disc = head.map_or(0.0, |film| PATCH / film.radius);
        for (i, [x, y]) in self.points().zip(PLACES) {
            let shape = contacts.points[i].port.shape_mut();
            far.fill_pressed(x.hypot(y), x.atan2(-y), disc, shape);
            // They lie on the other side: their way into the head is against the stroke.
            shape.iter_mut().for_each(|shape| *shape = -*shape);
            observers.put(i, x.hypot(y), x.atan2(-y), TURN);
        }
        for i in self.points() {
            let position = contacts.exciter(i).position(&contacts.points[i].weights);
            let moved = position - body.modal().displacement_at(&contacts.points[i].port);
            // A head of another shape lies elsewhere under the wires; the contact must not notice.
            let point = &mut contacts.points[i];
            point.origin = moved - (point.compression - point.static_compression) - point.bands_bent();
            point.stale = true;
        }
    }

    /// Throws the wires on or off.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn throw(&mut self, on: bool, site: Site<'_>) {
        if self.on != on {
            self.on = on;
            self.park(site.contacts);
            if on && !site.body.modal().is_still() {
                self.wake(site);
            }
        }
    }

    /// Sets the force of the strainer, N; live.
    pub fn set_preload(&mut self, preload: f64, site: Site<'_>) {
        self.preload = preload.clamp(*PRELOAD.start(), *PRELOAD.end());
        let (share, compression) = self.static_compression();
        for point in &mut site.contacts.points[self.points()] {
            // What is measured from equilibrium stays; equilibrium itself moves.
            point.compression += compression - point.static_compression;
            (point.preload, point.static_compression) = (share, compression);
        }
    }

    /// What the wires have done since the latest stroke.
    pub fn snapshot(&self, contacts: &Contacts) -> WireSnapshot {
        let groups = contacts.points[self.points()].iter().map(|point| point.present && !point.touching);
        let aloft = groups.enumerate().fold(0, |bits, (group, aloft)| bits | (u32::from(aloft) << group));
        let Landings { landings, last_lift, .. } = self.count;
        WireSnapshot { landings, aloft, last_lift: (last_lift as f64 * self.dt) as f32 }
    }
}

impl Attachment for SnareWires {
    fn attached(&mut self, site: Site<'_>) {
        let (preload, compression) = self.static_compression();
        self.first = site.contacts.points.len();
        for _ in PLACES {
            let mut point = ContactPoint::absent(site.body.modal().len(), self.dt);
            point.arrive(Ground::Body, self.law, [1.0, 0.0, 0.0, 0.0, 0.0]);
            (point.present, point.preload, point.static_compression) = (false, preload, compression);
            let mut group = Exciter::absent(self.dt);
            (group.parts[0], group.part_count) = (self.group(), 1);
            site.contacts.add(group, point);
        }
    }

    /// From the equilibrium they were left in.
    fn wake(&mut self, site: Site<'_>) {
        if !self.on || !std::mem::take(&mut self.parked) {
            return;
        }
        let lambda = self.law.lambda(RESTING_SPEED);
        for (i, [x, y]) in self.points().zip(PLACES) {
            let point = &mut site.contacts.points[i];
            (point.present, point.touching, point.lambda) = (true, true, lambda);
            (point.compression, point.force) = (point.static_compression, point.preload);
            if let Some(head) = self.head {
                (point.bands, point.band_count) = head.bands(x.hypot(y), PATCH, !self.lossless, self.dt);
            }
            point.origin = -site.body.modal().displacement_at(&point.port);
            point.stale = true;
            let group = site.contacts.exciter_mut(i);
            group.present = true;
            group.parts[0].rest();
        }
        site.contacts.list();
    }

    fn begin_count(&mut self) {
        self.count = Landings::default();
    }

    fn finish(&mut self, contacts: &Contacts, _free: &FreeStep) -> Pressure {
        for point in contacts.points[self.points()].iter().filter(|point| point.present) {
            match (point.touched, point.touching) {
                (false, true) => self.count.landings = self.count.landings.saturating_add(1),
                (true, false) => self.count.last_lift = self.count.age,
                _ => {}
            }
        }
        self.count.age += 1;
        Pressure::default()
    }

    fn energy(&self, contacts: &Contacts) -> f64 {
        contacts.energy(self.exciters())
    }

    /// Wires against a head that was tuned meanwhile may hold it bent for good, which nothing is heard of.
    fn motion(&self, contacts: &Contacts) -> f64 {
        contacts.motion(self.exciters())
    }

    fn parks_below(&self) -> Option<f64> {
        (self.on && !self.parked).then_some(STILL)
    }

    fn park(&mut self, contacts: &mut Contacts) {
        self.parked = true;
        contacts.points[self.points()].iter_mut().for_each(|point| point.present = false);
        contacts.exciters[self.exciters()].iter_mut().for_each(|group| group.present = false);
        contacts.list();
    }

    fn is_parked(&self) -> bool {
        self.on && self.parked
    }

    fn reset(&mut self, contacts: &mut Contacts) {
        self.park(contacts);
    }
}
