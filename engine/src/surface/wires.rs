//! Snare wires: strands stretched across the far head that lie against it, fly off it and slap back.
//!
//! Model: the strands of each of [`ROWS`] rows move together, as one string between the end plates of which the first
//! [`MODES`] transverse modes are kept. A string of mass `m`, length `L` and tension `T` has
//!
//! ```text
//! omega_n = n pi / L sqrt(T L / m)      modal mass m / 2      sigma_n = omega_n / (2 Q)
//! ```
//!
//! It touches the head along its whole length, in four sections. The force on a section is spread evenly along it and over the
//! strands of the row, side by side, so it moves mode `n` by the mean of the mode's shape along the section, and the head as a
//! uniform load on a strip does. The mean deflection by that is that of a disc of radius `exp(-5/4) (L + B)` on a strip as long as `L`
//! and as wide as `B` (the mean logarithm of distance of two points on a segment is `ln L - 3/2`, on a disc `ln b - 1/4`; of two in
//! a rectangle that of a segment as long as both its sides, within 0.5 %: Maxwell, A Treatise on Electricity and Magnetism, sec. 692).
//! Steel on film, the law of every contact.
//!
//! What presses the wires on is their tension: the snare bed bends them over the head by a small angle, `T` times which is the
//! preload. Tightening the strainer thus raises both. The head is bent next to the bed: a dip of width `w` in its edge flattens
//! out as `exp(-pi d / w)` (Laplace's equation), so the outer sections are pressed on more than the inner ones, as this at the distance
//! `d` from the rim. The rows are not equally tight. Where the head falls back faster than the preload can follow, a section flies, and each landing is
//! an impact.
//!
//! Displacements are measured from where the preload alone holds head and wires, so that a drum at rest is
//! at rest exactly, whatever the preload.
//!
//! Neglected: motion of a row's strands against each other, the stiffness of the coils, stretching by large deflection, the
//! weight, the motion of the end plates.

use std::f64::consts::PI;
use std::ops::{Range, RangeInclusive};

use serde::{Deserialize, Serialize};

use crate::contact::{ContactLaw, Material, Tip};
use crate::modal::Pressure;
use crate::numbers::{Numbers, Visitor};
use crate::shapes::ShapeTable;
use crate::snapshot::WireSnapshot;

use super::attachment::{Attachment, Site};
use super::body::FreeStep;
use super::contacts::{ATTACHED_POINTS, Contacts, owner, points_of};
use super::exciter::{ContactPoint, Exciter, Ground};
use super::local_compliance::LocalHeadCompliance;
use super::oscillator::Oscillator;

/// Rows of strands.
pub const ROWS: usize = 2;

/// Modes of each row. *Derived*: those by which four sections can move apart, and half as many again.
pub const MODES: usize = 6;

/// Sections of all rows.
pub const SECTIONS: usize = ROWS * ATTACHED_POINTS;

/// Length between the end plates as a share of the head's diameter. *Measured*: 27 cm on a 14-inch drum.
const LENGTH: f64 = 0.76;

/// Distance of each row from the middle, a share of the radius: twenty strands are some 6 cm wide.
const ROW: f64 = 0.105;

/// Mass of a strand, kg/m. *Derived*: steel wire of half a millimetre in coils of 2.3 mm, 2.4 mm apart.
const STRAND: f64 = 3.7e-3;

/// Distance of neighbouring strands, m. *Judgement*: sets of twenty are 5 to 6 cm wide.
const SPACING: f64 = 3e-3;

/// Middles of the sections on the head, shares of its radius: one row after the other.
pub const PLACES: [[f64; 2]; SECTIONS] = {
    let mut places = [[0.0; 2]; SECTIONS];
    let mut i = 0;
    while i < SECTIONS {
        places[i] =
            [(2.0 * along(i % ATTACHED_POINTS) - 1.0) * LENGTH, if i < ATTACHED_POINTS { -ROW } else { ROW }];
        i += 1;
    }
    places
};

/// The middle of a section, a share of the length.
const fn along(section: usize) -> f64 {
    (section as f64 + 0.5) / ATTACHED_POINTS as f64
}

/// How tight each row is, relative to the mean. *By judgement*: coils soldered between two plates are uneven by some percent.
const TIGHTNESS: [f64; ROWS] = [0.96, 1.04];

/// Least and greatest force that presses all wires on, N.
pub const PRELOAD: RangeInclusive<f64> = 0.03..=1.5;

/// A description of snare wires.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WiresSpec {
    /// Mass of all strands, kg, 0.001 to 0.03.
    #[serde(rename = "mass_kg")]
    pub mass: f64,
    /// Angle by which the snare bed bends them over the head, rad, 0.0005 to 0.1: the force that presses them on over their
    /// tension.
    #[serde(rename = "bend_rad")]
    pub bend: f64,
    /// Width of the snare bed, m, 0.02 to 0.4: what it presses on falls by `e` within a third of it from the rim.
    #[serde(rename = "bed_m")]
    pub bed: f64,
    /// Quality factor of their modes, 0.6 to 2000.
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
        visitor.number("bend_rad", &mut self.bend, 5e-4..=0.1);
        visitor.number("bed_m", &mut self.bed, 0.02..=0.4);
        visitor.number("q", &mut self.q, 0.6..=2000.0);
        visitor.number("wire_radius_m", &mut self.radius, 1e-4..=3e-3);
        self.material.visit_part("material", visitor);
        visitor.number("restitution", &mut self.restitution, 0.05..=0.95);
    }
}

/// Radius of the disc that gives way as a section's strip does, a share of its length and width together: `exp(-5/4)`.
const SPREAD: f64 = 0.286_505;

/// Radius of the disc on which a single turn of a strand strikes, m: as fine as that are the waves that landings
/// set going. *Derived*: some wire radii.
pub const TURN: f64 = 0.002;

/// The speed of landing that a touch without one, as of wires at rest, is as lossy as, m/s. *Derived*: what a
/// section falling back by the preload reaches in a millisecond.
const RESTING_SPEED: f64 = 0.02;

/// Energy of the drum under which the wires lie still, J: nothing is heard of them.
pub const STILL: f64 = 1e-10;

/// All wires of one drum.
pub struct SnareWires {
    /// Whether they lie against the head.
    on: bool,
    /// Whether they and the head lie still together.
    parked: bool,
    /// Force that presses them on, N.
    preload: f64,
    /// The law of every section.
    law: ContactLaw,
    /// The head right under a section.
    head: Option<LocalHeadCompliance>,
    /// The first point among the contacts.
    first: usize,
    /// Radius of the head, m.
    radius: f64,
    spec: WiresSpec,
    count: Landings,
    lossless: bool,
    dt: f64,
}

/// What the sections have done since the latest stroke.
#[derive(Default)]
struct Landings {
    /// Samples since the stroke.
    age: u64,
    landings: u32,
    last_lift: u64,
}

impl SnareWires {
    /// Wires against a head of that material and radius (m), at rest; a sample lasts `dt` s. [`lay`](Self::lay) tells where.
    pub fn new(spec: &WiresSpec, head: (&Material, f64), lossless: bool, dt: f64) -> SnareWires {
        let tip = Tip::Solid { material: spec.material, radius: spec.radius };
        let law = ContactLaw::new(&tip, head.0, if lossless { 1.0 } else { spec.restitution });
        SnareWires {
            on: true,
            parked: true,
            preload: *PRELOAD.start(),
            law,
            head: None,
            first: 0,
            radius: head.1,
            spec: *spec,
            count: Landings::default(),
            lossless,
            dt,
        }
    }

    /// A mode of a string under the present preload.
    fn mode(&self, row: usize, n: usize) -> Oscillator {
        let WiresSpec { mass, bend, q, .. } = self.spec;
        let mass = mass / ROWS as f64;
        let tension = self.share(row) / bend;
        let omega = n as f64 * PI * (tension / (mass * self.length())).sqrt();
        let sigma = if self.lossless { 0.0 } else { omega / (2.0 * q) };
        Oscillator::sprung(0.5 * mass, omega, sigma, self.dt)
    }

    /// Length between the end plates, m.
    fn length(&self) -> f64 {
        2.0 * LENGTH * self.radius
    }

    /// Radius of the disc on which a section presses, m.
    fn patch(&self) -> f64 {
        SPREAD * (self.length() / ATTACHED_POINTS as f64 + self.width())
    }

    /// Width of a row, m: that of its strands side by side, and no more than keeps it off the other.
    fn width(&self) -> f64 {
        let strands = self.spec.mass / ROWS as f64 / (STRAND * self.length());
        (strands * SPACING).min(2.0 * ROW * self.radius)
    }

    /// A string's share of the preload, N.
    fn share(&self, row: usize) -> f64 {
        self.preload * TIGHTNESS[row] / ROWS as f64
    }

    /// The preload of a section of a string (N), and the compression (m) it holds.
    fn static_compression(&self, row: usize, section: usize) -> (f64, f64) {
        let bent = |section: usize| {
            let [x, y] = PLACES[section];
            (-(1.0 - x.hypot(y)) * self.radius * PI / self.spec.bed).exp()
        };
        let all: f64 = (0..ATTACHED_POINTS).map(bent).sum();
        let share = self.share(row) * bent(section) / all;
        (share, (share / self.law.stiffness).powf(1.0 / self.law.exponent))
    }

    /// All points.
    fn points(&self) -> Range<usize> {
        self.first..self.first + SECTIONS
    }

    /// All strings.
    fn exciters(&self) -> Range<usize> {
        owner(self.first)..owner(self.first) + ROWS
    }

    /// Lays the wires against the far head of these shapes (positive along the stroke), which yields right under them
    /// as `head` says.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn lay(&mut self, head: Option<LocalHeadCompliance>, far: &ShapeTable, site: Site<'_>) {
        let Site { body, contacts, observers } = site;
        self.head = head;
        let disc = head.map_or(0.0, |film| self.patch() / film.radius);
        for (i, [x, y]) in (self.first..).zip(PLACES) {
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

    /// Sets the force that presses them on, N, and with it their tension; live. The strainer does work on wires that are bent.
    pub fn set_preload(&mut self, preload: f64, site: Site<'_>) {
        self.preload = preload.clamp(*PRELOAD.start(), *PRELOAD.end());
        for (row, exciter) in self.exciters().enumerate() {
            for (section, point) in site.contacts.points[points_of(exciter)].iter_mut().enumerate() {
                let (share, compression) = self.static_compression(row, section);
                // What is measured from equilibrium stays; equilibrium itself moves.
                point.compression += compression - point.static_compression;
                (point.preload, point.static_compression) = (share, compression);
                point.stale = true;
            }
            for (n, part) in (1..).zip(&mut site.contacts.exciters[exciter].parts[..MODES]) {
                part.become_like(self.mode(row, n));
            }
        }
    }

    /// What the wires have done since the latest stroke.
    pub fn snapshot(&self, contacts: &Contacts) -> WireSnapshot {
        let points = contacts.points[self.points()].iter().map(|point| point.present && !point.touching);
        let aloft = points.enumerate().fold(0, |bits, (i, aloft)| bits | (u32::from(aloft) << i));
        let Landings { landings, last_lift, .. } = self.count;
        WireSnapshot { landings, aloft, last_lift: (last_lift as f64 * self.dt) as f32 }
    }
}

impl Attachment for SnareWires {
    fn attached(&mut self, site: Site<'_>) {
        self.first = site.contacts.points.len();
        for row in 0..ROWS {
            let points = std::array::from_fn(|section| {
                let (preload, compression) = self.static_compression(row, section);
                let mut point = ContactPoint::absent(site.body.modal().len(), self.dt);
                let weights = std::array::from_fn(|i| mean_shape(i + 1, section));
                point.arrive(Ground::Body, self.law, weights);
                (point.present, point.preload, point.static_compression) = (false, preload, compression);
                point
            });
            let mut exciter = Exciter::absent(self.dt);
            exciter.parts = std::array::from_fn(|i| self.mode(row, i + 1));
            exciter.part_count = MODES;
            site.contacts.add(exciter, points);
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
                let place = x.hypot(y);
                // Wires press too softly to stretch the film.
                let slack = LocalHeadCompliance { stretching: 0.0, ..head.at(place) };
                (point.bands, point.band_count) = slack.bands(place, self.patch(), !self.lossless, self.dt);
            }
            point.origin = -site.body.modal().displacement_at(&point.port);
            point.stale = true;
            let row = site.contacts.exciter_mut(i);
            row.present = true;
            row.parts.iter_mut().for_each(Oscillator::rest);
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
        contacts.exciters[self.exciters()].iter_mut().for_each(|row| row.present = false);
        contacts.list();
    }

    fn is_parked(&self) -> bool {
        self.on && self.parked
    }

    fn reset(&mut self, contacts: &mut Contacts) {
        self.park(contacts);
    }
}

/// Mean over a section of the shape of mode `n`.
fn mean_shape(n: usize, section: usize) -> f64 {
    let half = 0.5 * n as f64 * PI / ATTACHED_POINTS as f64;
    (n as f64 * PI * along(section)).sin() * half.sin() / half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_along_a_section_moves_it_as_the_mass_of_the_section() {
        // All modes: sum 2 <shape>^2 / m is the inverse of a section's mass.
        for section in 0..ATTACHED_POINTS {
            let all: f64 = (1..20_000).map(|n| 2.0 * mean_shape(n, section).powi(2)).sum();
            assert!((all / ATTACHED_POINTS as f64 - 1.0).abs() < 1e-3, "{all}");
            let kept: f64 = (1..=MODES).map(|n| 2.0 * mean_shape(n, section).powi(2)).sum();
            assert!((0.75..1.0).contains(&(kept / all)), "{}", kept / all);
        }
    }

    #[test]
    fn a_strip_gives_way_as_the_disc_that_stands_for_it() {
        // Mean of the logarithm of the distance of two points in a rectangle: along each side they are `t` of it apart with the
        // weight `2 (1 - t)`.
        const STEPS: usize = 1000;
        let apart: Vec<f64> = (0..STEPS).map(|i| (i as f64 + 0.5) / STEPS as f64).collect();
        let mean = |long: f64, wide: f64| {
            let sum: f64 = apart
                .iter()
                .flat_map(|&x| {
                    apart.iter().map(move |&y| 4.0 * (1.0 - x) * (1.0 - y) * (long * x).hypot(wide * y).ln())
                })
                .sum();
            sum / (STEPS * STEPS) as f64
        };
        for (long, wide) in [(0.068, 0.0), (0.068, 0.018), (0.068, 0.03), (0.05, 0.05)] {
            let disc = (mean(long, wide) + 0.25).exp();
            assert!((SPREAD * (long + wide) / disc - 1.0).abs() < 5e-3, "{disc}");
        }
    }

    #[test]
    fn the_bed_presses_on_the_outer_sections_and_the_whole_preload_is_shared_out() {
        let spec = WiresSpec {
            mass: 0.02,
            bend: 0.002,
            bed: 0.1,
            q: 100.0,
            radius: 8e-4,
            material: Material::STEEL,
            restitution: 0.35,
        };
        let mut wires = SnareWires::new(&spec, (&Material::FILM, 0.178), false, 1.0 / 48e3);
        wires.preload = 0.08;
        let shares: Vec<f64> = (0..ROWS)
            .flat_map(|row| (0..ATTACHED_POINTS).map(move |section| (row, section)))
            .map(|(row, section)| wires.static_compression(row, section).0)
            .collect();
        assert!((shares.iter().sum::<f64>() / 0.08 - 1.0).abs() < 1e-9, "{shares:?}");
        // A step inward is .38 of the radius nearly: exp(-pi .0676 / .1).
        assert!((shares[1] / shares[0] / 0.12 - 1.0).abs() < 0.1, "{shares:?}");
        // Tightened, they are stiffer.
        let slack = wires.mode(0, 1).compliance();
        wires.preload = 0.32;
        assert!(wires.mode(0, 1).compliance() < slack);
    }
}
