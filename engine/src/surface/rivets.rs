//! Rivets: loose masses in holes near the rim of a cymbal, which its motion throws and gravity brings back.
//!
//! Model: each rivet is a point mass `m` that moves along its hole. Its head lies on the upper face; its lower end is wider than
//! the hole, so that it can rise by the play `p` and no more. Both ends meet the plate by the
//! [one contact law](crate::contact), head and lower end each on its side: with `d` the compression under the head,
//!
//! ```text
//! m q'' = m g - F      F = F_head(d) - F_end(-p - d)      d = q - w(hole)
//! ```
//!
//! `q` the way of the rivet and `w` that of the plate, both into the surface. The plate throws a rivet where it falls away faster
//! than `g`; each landing is an impact that sets all modes going.
//!
//! Displacements are measured from where the rivets lie on the plate at rest, so that a cymbal at rest is at rest exactly. Only what a
//! force differs from the weight by acts: a rivet that flies relieves the plate of its weight.
//!
//! Scheme: forces of strikers and rivets are found together, each a discrete gradient of its potential. Only contacts that may
//! close within the sample are solved for; that no other closes is checked, and if one does, all are solved. While rivets fly, every sample
//! is computed by itself. Once they have come to lie and the plate moves too little to throw any, the
//! plate rings in blocks, as if it had none, until its motion or a stroke can throw them.
//!
//! Neglected: that rivets turn and rattle in their holes sideways, the size of a head (a point at the hole's middle), the holes,
//! the inertia of rivets that lie, some grams on some kilograms, and the wandering of phases above the coupled modes
//! ([`transport`](crate::transport)) while rivets are not at rest: with it forces would do other work than the plate gets.

mod motion;
mod mutual;
mod shaking;
mod solving;
mod spec;
#[cfg(test)]
mod tests;

use crate::contact::{ContactLaw, Material, Tip};
use crate::modal::simd::Kernels;
use crate::modal::{InputVector, Pressure};

use super::attachment::{Attachment, Site};
use super::body::{FreeStep, StruckBody, add};
use super::contacts::Contacts;

use motion::{GRAVITY, Rivet};
use mutual::Mutual;
use shaking::Shaking;
pub use spec::{MOST, RivetsSpec};

/// Radius of curvature at which a head meets the plate, m. *Judgement*: the flat underside of a head 8 to 10 mm wide on the bow and on the
/// edge of its hole. A fifth of it and five times as much change third octaves up to 11 kHz by less than 1 dB, up to 18 kHz by less
/// than 3 dB: contacts last as short as a sample.
const HEAD_CURVATURE: f64 = 0.02;

/// Restitution of a landing beside what the plate carries away as waves, a ratio of speeds. *Judgement*: brass yields at slow blows
/// already (Johnson, Contact Mechanics, 1985, ch. 11). 0.5 and 0.9 change the sound by 1 dB over the first second; a ride that is struck
/// at 3 m/s sizzles for 2.2 and 2.6 s instead of 2.4.
const RESTITUTION: f64 = 0.7;

/// Speed of a landing that a touch without one, of a rivet at rest, is as lossy as, m/s. *Derived*: what a rivet reaches by gravity
/// in a millisecond.
const RESTING_SPEED: f64 = 0.01;

/// Acceleration at the hole where it is largest below which rivets that lie stay so, and that from which
/// they may be thrown, in the root mean square and as shares of `g`. *Derived*: five times the root mean square, which a sum of many modes does not exceed, is `g` at the
/// latter; the former is 6 dB lower, so that beats do not throw them at once.
const LIES_BELOW: f64 = 0.1;
const THROWS_FROM: f64 = 0.2;

/// Time without a lift or a shake after which a rivet has come to lie, s. *Judgement*: longer than a hop over the static compression lasts, and than
/// half a period of what bends.
const SETTLED: f64 = 0.02;

/// What stays as it is built.
struct Constants {
    spec: RivetsSpec,
    law: ContactLaw,
    /// Weight of one, N.
    weight: f64,
    /// The compression that it holds, m.
    static_compression: f64,
    lossless: bool,
    /// Length of a sample, s.
    dt: f64,
}

/// All rivets of a cymbal.
pub struct Rivets {
    built: Constants,
    rivets: Vec<Rivet>,
    /// One-sample compliance of the modes and the rivets' own masses.
    mutual: Mutual,
    /// The sum of all holes' shapes, where the plate is relieved of their weight.
    relief: InputVector,
    shaking: Shaking,
    kernels: Kernels,
    /// Whether every sample is computed.
    engaged: bool,
    /// Whether the nonlinear force acts.
    stiffened: bool,
    /// Whether modes have changed since the holes were connected.
    stale: bool,
    /// Samples since any was off the plate or the plate shook.
    lain: u64,
    /// The rivet whose sound was last looked at.
    looked_at: usize,
    landings: u32,
    /// Solves for all ends in every sample, for a comparison.
    #[cfg(test)]
    solves_all: bool,
}

impl Rivets {
    /// Rivets in a plate of that material, at rest; a sample lasts `dt` s. Allocates.
    pub fn new(spec: &RivetsSpec, plate: &Material, lossless: bool, dt: f64) -> Rivets {
        let tip = Tip::Solid { material: Material::BRASS, radius: HEAD_CURVATURE };
        let law = ContactLaw::new(&tip, plate, if lossless { 1.0 } else { RESTITUTION });
        let weight = spec.mass * GRAVITY;
        let static_compression = (weight / law.stiffness).powf(1.0 / law.exponent);
        Rivets {
            built: Constants { spec: *spec, law, weight, static_compression, lossless, dt },
            rivets: Vec::new(),
            mutual: Mutual::NONE,
            relief: InputVector::new(0),
            shaking: Shaking::new(0),
            kernels: Kernels::detect(),
            engaged: false,
            stiffened: false,
            stale: true,
            lain: 0,
            looked_at: 0,
            landings: 0,
            #[cfg(test)]
            solves_all: false,
        }
    }

    /// Landings of all heads and lower ends since the latest stroke.
    pub fn landings(&self) -> u32 {
        self.landings
    }

    /// Rivets that touch the plate at neither end now.
    pub fn aloft(&self) -> usize {
        self.rivets.iter().filter(|rivet| rivet.is_aloft()).count()
    }

    /// How far each head is above where it lies, m.
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.rivets.iter().map(|rivet| self.built.static_compression - rivet.compression)
    }

    /// Energy of the motion of all, J.
    fn kinetic(&self) -> f64 {
        self.rivets.iter().map(|rivet| rivet.mass.energy()).sum()
    }

    /// Energy of one rivet and its contacts above that at rest, J.
    fn energy_of(&self, rivet: &Rivet) -> f64 {
        let held: f64 = rivet
            .overlaps(self.built.spec.play)
            .map(|overlap| self.built.law.potential(overlap))
            .iter()
            .sum();
        let resting = self.built.law.potential(self.built.static_compression);
        rivet.mass.energy() + held
            - resting
            - self.built.weight * (rivet.compression - self.built.static_compression)
    }

    /// Follows the modes of the body.
    fn connect_all(&mut self, body: &StruckBody) {
        self.stale = false;
        let modal = body.modal();
        modal.connect(&mut self.relief);
        for rivet in &mut self.rivets {
            modal.connect(&mut rivet.port);
            rivet.direct = body.receiver().direct_at(modal, &rivet.port);
        }
        self.mutual.connect(&self.rivets, modal);
    }

    /// Lets every sample be computed; the rivets lie on the plate as it is.
    fn engage(&mut self, body: &StruckBody) {
        if std::mem::replace(&mut self.engaged, true) {
            return;
        }
        if self.stale {
            self.connect_all(body);
        }
        (self.lain, self.looked_at) = (0, 0);
        let lambda = self.built.law.lambda(RESTING_SPEED);
        for rivet in &mut self.rivets {
            rivet.lie(
                -body.modal().displacement_at(&rivet.port),
                self.built.static_compression,
                lambda,
                self.built.weight,
            );
        }
        self.couple_all(body);
    }

    /// Updates the couplings with the nonlinear force.
    fn couple_all(&mut self, body: &StruckBody) {
        self.stiffened = body.acting_force().is_some();
        for rivet in &mut self.rivets {
            rivet.coupling = if self.stiffened { body.coupling(&rivet.port) } else { 0.0 };
        }
    }
}

impl Attachment for Rivets {
    fn attached(&mut self, site: Site<'_>) {
        let modal = site.body.modal();
        let modes = modal.len();
        self.kernels = modal.kernels();
        self.relief = InputVector::new(modes);
        self.shaking = Shaking::new(modes);
        for angle in self.built.spec.angles() {
            let mut rivet = Rivet::new(modes, self.built.spec.mass, self.built.dt);
            site.body.shapes().fill(self.built.spec.radius, angle, rivet.port.shape_mut());
            for (sum, shape) in self.relief.shape_mut().iter_mut().zip(rivet.port.shape()) {
                *sum += shape;
            }
            self.shaking.add(rivet.port.shape());
            self.rivets.push(rivet);
        }
    }

    fn follow(&mut self, body: &StruckBody) {
        self.stale = true;
        self.shaking.follow();
        if self.engaged {
            self.connect_all(body);
            self.couple_all(body);
        }
    }

    fn wake(&mut self, site: Site<'_>) {
        self.engage(site.body);
    }

    fn begin_count(&mut self) {
        self.landings = 0;
    }

    fn connect(&mut self, point: usize, port: &InputVector, body: &StruckBody) {
        self.mutual.connect_striker(point, &self.rivets, body.modal(), port);
    }

    fn couple(&mut self, body: &StruckBody) {
        if self.engaged && (self.stiffened || body.acting_force().is_some()) {
            self.couple_all(body);
        }
    }

    fn step(&mut self, body: &StruckBody, free: &FreeStep) {
        if self.engaged {
            self.fly(body, free);
        }
    }

    fn preload_offset(&self, point: usize, coupling: f64, free: &FreeStep) -> f64 {
        let moved = |rivet| self.to_striker(point, coupling, rivet, free) * self.built.weight;
        if self.engaged { (0..self.rivets.len()).map(moved).sum() } else { 0.0 }
    }

    fn solve(&mut self, contacts: &mut Contacts, free: &FreeStep) -> bool {
        if self.engaged {
            self.solve_with(contacts, free);
        }
        self.engaged
    }

    fn press(&mut self, body: &mut StruckBody) -> (f64, Pressure) {
        let (mut pressed, mut heard) = (0.0, Pressure::default());
        if !self.engaged {
            return (pressed, heard);
        }
        let modal = body.modal_mut();
        // Where all lie, their weights are taken from the forces one by one, so that a cymbal at rest stays so.
        let all_lie = self.rivets.iter().all(|rivet| rivet.ends[0].force > 0.0);
        if !all_lie {
            modal.push(&self.relief, -self.built.weight as f32);
        }
        for rivet in &mut self.rivets {
            let force = rivet.force() - self.built.weight;
            let pushes = if all_lie { force } else { rivet.force() };
            if pushes != 0.0 {
                modal.push(&rivet.port, pushes as f32);
            }
            rivet.mass.push(-force);
            pressed += force * rivet.coupling;
            add(&mut heard, rivet.direct.map(|direct| force as f32 * direct));
        }
        (pressed, heard)
    }

    fn displaced(&self, point: usize, coupling: f64, free: &FreeStep) -> f64 {
        let moved = |rivet: usize| self.to_striker(point, coupling, rivet, free) * self.rivets[rivet].force();
        if self.engaged { (0..self.rivets.len()).map(moved).sum() } else { 0.0 }
    }

    fn finish(&mut self, _contacts: &Contacts, _free: &FreeStep) -> Pressure {
        if self.engaged {
            let mut all_lie = true;
            for rivet in &mut self.rivets {
                self.landings = self.landings.saturating_add(rivet.finish(self.built.spec.play));
                all_lie &= rivet.lies();
            }
            self.lain = if all_lie { self.lain + 1 } else { 0 };
        }
        Pressure::default()
    }

    fn is_engaged(&self) -> bool {
        self.engaged
    }

    fn drives_body(&self) -> bool {
        self.engaged
    }

    fn energy(&self, _contacts: &Contacts) -> f64 {
        if self.engaged { self.rivets.iter().map(|rivet| self.energy_of(rivet)).sum() } else { 0.0 }
    }

    fn motion(&self, _contacts: &Contacts) -> f64 {
        if self.engaged { self.kinetic() } else { 0.0 }
    }

    fn settle(&mut self, body: &mut StruckBody, contacts: &mut Contacts) -> bool {
        if !self.engaged {
            if self.shaking.level(body.modal()) > THROWS_FROM {
                self.engage(body);
            }
            return true;
        }
        // The lobes of a cymbal that swings turn meanwhile: what is heard of the forces at once follows, hole by hole.
        self.looked_at = (self.looked_at + 1) % self.rivets.len().max(1);
        if let Some(rivet) = self.rivets.get_mut(self.looked_at) {
            rivet.direct = body.receiver().direct_at(body.modal(), &rivet.port);
        }
        if self.shaking.level(body.modal()) > LIES_BELOW {
            self.lain = 0;
        }
        let settled = self.lain as f64 * self.built.dt > SETTLED;
        if settled && !self.built.lossless && !contacts.is_struck() {
            self.park(contacts);
        }
        self.rivets.iter().all(|rivet| rivet.compression.is_finite())
    }

    fn park(&mut self, _contacts: &mut Contacts) {
        self.engaged = false;
    }

    fn is_still(&self) -> bool {
        !self.engaged
    }

    fn reset(&mut self, contacts: &mut Contacts) {
        self.park(contacts);
    }
}
