//! Attachments of struck bodies: a rim, snare wires, a second cymbal, rivets.
//!
//! A sample calls the methods of an attachment in this order. The defaults do nothing:
//!
//! 1. [`step`](Attachment::step): steps without contact forces, after the body;
//! 2. [`displacement`](Attachment::displacement) and [`preload_offset`](Attachment::preload_offset): its share of the
//!    displacement under strikers, with the [`compliance`](Attachment::compliance) between them;
//! 3. [`solve`](Attachment::solve): may solve all contacts together with its own;
//! 4. [`push`](Attachment::push) for each striker's force, then [`press`](Attachment::press) for its own forces;
//! 5. [`displaced`](Attachment::displaced): displacement of a striker's contact by its own forces;
//! 6. [`finish`](Attachment::finish) and [`listen`](Attachment::listen): ends the sample and returns its pressure;
//! 7. [`impart`](Attachment::impart): momentum that it gives and takes before the next one.
//!
//! Displacement and force are positive along the stroke. A point is the index of a contact point in [`Contacts`].

use std::any::Any;

use crate::modal::{InputVector, Pressure, RECEIVERS};

use super::body::{FreeStep, SoundingBody, StruckBody};
use super::contacts::Contacts;
use super::observer::ForceObservers;

/// The parts of a surface that an attachment acts on.
pub struct Site<'a> {
    /// The struck body.
    pub body: &'a mut StruckBody,
    /// Its contacts.
    pub contacts: &'a mut Contacts,
    /// Observers of the contact forces.
    pub observers: &'a mut ForceObservers,
}

/// Something attached to a struck body.
///
/// # Real-time
/// Only [`attached`](Self::attached) may allocate. Nothing may lock or fail.
pub trait Attachment: Any + Send {
    /// Called once, when it is attached. May allocate.
    fn attached(&mut self, site: Site<'_>);

    /// Follows a change of the body's modes or receiver weights.
    fn follow(&mut self, _body: &StruckBody) {}

    /// Wakes it: there is a stroke, or sound that may move it.
    fn wake(&mut self, _site: Site<'_>) {}

    /// Restarts its counts at a stroke.
    fn begin_count(&mut self) {}

    /// Its body that contact points may press on ([`Ground::Attachment`](super::exciter::Ground::Attachment)).
    fn ground(&self) -> Option<&SoundingBody> {
        None
    }

    /// Its body that contact points may press on, to be pushed.
    fn ground_mut(&mut self) -> Option<&mut SoundingBody> {
        None
    }

    /// Sets the position of a striker's point: `radius` as a share of the radius, `angle` in rad.
    fn put(&mut self, _point: usize, _radius: f64, _angle: f64) {}

    /// Follows a change of a striker's input vector, of the body or of the striker.
    fn connect(&mut self, _point: usize, _port: &InputVector, _body: &StruckBody) {}

    /// Its share of the compliance between two strikers' points, m/N.
    fn compliance(&self, _a: usize, _b: usize) -> f64 {
        0.0
    }

    /// Follows a change of the nonlinear force; called at every sample while there is no such force.
    fn couple(&mut self, _body: &StruckBody) {}

    /// Steps without force; the body has stepped.
    fn step(&mut self, _body: &StruckBody, _free: &FreeStep) {}

    /// Its share of the displacement under a striker's point, m.
    fn displacement(&self, _point: usize) -> f64 {
        0.0
    }

    /// Offset of a striker's contact by preloads from which the body is measured, m; `coupling` is the point's with the
    /// nonlinear force.
    fn preload_offset(&self, _point: usize, _coupling: f64, _free: &FreeStep) -> f64 {
        0.0
    }

    /// Solves all contacts together with its own, if any of its own may touch; false if the contacts are still to be
    /// solved.
    fn solve(&mut self, _contacts: &mut Contacts, _free: &FreeStep) -> bool {
        false
    }

    /// Applies a striker's force (N) at a point.
    fn push(&mut self, _point: usize, _force: f64) {}

    /// Applies its own forces to the body and to itself. Returns the sum of the forces times their couplings with the nonlinear
    /// force, and the pressure proportional to them, Pa.
    fn press(&mut self, _body: &mut StruckBody) -> (f64, Pressure) {
        (0.0, Pressure::default())
    }

    /// Displacement between a striker and the body by its own forces, m.
    fn displaced(&self, _point: usize, _coupling: f64, _free: &FreeStep) -> f64 {
        0.0
    }

    /// Ends the sample, all forces being known. Returns the pressure of its own body, Pa.
    fn finish(&mut self, _contacts: &Contacts, _free: &FreeStep) -> Pressure {
        Pressure::default()
    }

    /// Exchanges momentum with the body between this sample and the next. Returns the pressure by it, Pa.
    fn impart(&mut self, _body: &mut StruckBody) -> Pressure {
        Pressure::default()
    }

    /// Pressure of its [ground](Self::ground), Pa.
    fn listen(&self) -> Pressure {
        Pressure::default()
    }

    /// Renders from sample `from` on without contacts, and adds its pressure, Pa. It has stepped for the samples before.
    fn ring(&mut self, _out: [&mut [f32]; RECEIVERS], _from: usize) {}

    /// Whether every sample must be solved without any exciter present.
    fn is_engaged(&self) -> bool {
        false
    }

    /// Whether it may drive the body without any exciter present.
    fn drives_body(&self) -> bool {
        false
    }

    /// Energy of it and its contacts, J.
    fn energy(&self, _contacts: &Contacts) -> f64 {
        0.0
    }

    /// Energy of its motion, J, without that of static deflection.
    fn motion(&self, _contacts: &Contacts) -> f64 {
        0.0
    }

    /// By how much it tilts the body, rad: of the side at angle 0 into the surface, and of that at a right angle to it. None if it does not
    /// hold it.
    fn tilt(&self) -> Option<[f64; 2]> {
        None
    }

    /// Called once a block: zeroes what has decayed. False if a value is not finite.
    fn settle(&mut self, _body: &mut StruckBody, _contacts: &mut Contacts) -> bool {
        true
    }

    /// Energy of body and attachments (J) below which it may be [parked](Self::park) while no striker is present; `None` if
    /// it has nothing to park.
    fn parks_below(&self) -> Option<f64> {
        None
    }

    /// Stops all motion until it is [woken](Self::wake).
    fn park(&mut self, _contacts: &mut Contacts) {}

    /// Whether it is parked and can be [woken](Self::wake).
    fn is_parked(&self) -> bool {
        false
    }

    /// Whether nothing of it moves.
    fn is_still(&self) -> bool {
        true
    }

    /// Everything at rest.
    fn reset(&mut self, _contacts: &mut Contacts) {}
}
