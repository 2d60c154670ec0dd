//! What some struck bodies have and others have not: a rim, snare wires, a second cymbal.
//!
//! A sample goes through an attachment in this order; what it does not override leaves it out:
//!
//! 1. [`step`](Attachment::step): moves freely, as the body just has;
//! 2. [`displacement`](Attachment::displacement) and [`preload_offset`](Attachment::preload_offset): moves the places
//!    where strikers meet the body; with it, [`compliance`](Attachment::compliance) between them;
//! 3. [`solve`](Attachment::solve): may find the forces of all contacts with those of its own;
//! 4. [`push`](Attachment::push) for each striker's force, then [`press`](Attachment::press) for its own forces;
//! 5. [`displaced`](Attachment::displaced): how its own forces have moved a striker's contact;
//! 6. [`finish`](Attachment::finish) and [`listen`](Attachment::listen): ends the sample and is heard.
//!
//! Positive along the stroke, as everywhere. A point is the place of a contact point among the [`Contacts`].

use std::any::Any;

use crate::modal::{InputVector, Pressure, RECEIVERS};

use super::body::{FreeStep, SoundingBody, StruckBody};
use super::contacts::Contacts;
use super::observer::ForceObservers;

/// What an attachment is attached to.
pub struct Site<'a> {
    /// The body that is struck.
    pub body: &'a mut StruckBody,
    /// What touches it.
    pub contacts: &'a mut Contacts,
    /// What observes the contacts' forces.
    pub observers: &'a mut ForceObservers,
}

/// Something attached to a struck body.
///
/// # Real-time
/// Nothing but [`attached`](Self::attached) may allocate; nothing may lock or fail.
pub trait Attachment: Any + Send {
    /// Has been attached. May allocate.
    fn attached(&mut self, site: Site<'_>);

    /// Follows a change of the body's modes, or of how they are heard.
    fn follow(&mut self, _body: &StruckBody) {}

    /// Moves from now on: there is a stroke, or sound that may set it going.
    fn wake(&mut self, _site: Site<'_>) {}

    /// Counts anew from a stroke on.
    fn begin_count(&mut self) {}

    /// Its body that contact points may press on ([`Ground::Attachment`](super::exciter::Ground::Attachment)).
    fn ground(&self) -> Option<&SoundingBody> {
        None
    }

    /// Its body that contact points may press on, to be pushed.
    fn ground_mut(&mut self) -> Option<&mut SoundingBody> {
        None
    }

    /// A striker's point comes down at `radius` (share of it) in direction `angle` (rad).
    fn put(&mut self, _point: usize, _radius: f64, _angle: f64) {}

    /// Follows a change of a striker's port, of the body or of what the point belongs to.
    fn connect(&mut self, _point: usize, _port: &InputVector, _body: &StruckBody) {}

    /// What it adds to the compliance between two strikers' points, m/N.
    fn compliance(&self, _a: usize, _b: usize) -> f64 {
        0.0
    }

    /// Follows a change of the nonlinear force; called at every sample while that does not act.
    fn couple(&mut self, _body: &StruckBody) {}

    /// Steps without force; the body has stepped.
    fn step(&mut self, _body: &StruckBody, _free: &FreeStep) {}

    /// What it adds to the body's displacement under a striker's point, m.
    fn displacement(&self, _point: usize) -> f64 {
        0.0
    }

    /// How far preloads that the body is measured from ease a striker's contact, m; `coupling` is the point's with the
    /// nonlinear force.
    fn preload_offset(&self, _point: usize, _coupling: f64, _free: &FreeStep) -> f64 {
        0.0
    }

    /// Finds the forces of all contacts together with those of its own, if it has any that may touch; false if all
    /// others are still to be solved.
    fn solve(&mut self, _contacts: &mut Contacts, _free: &FreeStep) -> bool {
        false
    }

    /// A striker's force (N) at a point of the body.
    fn push(&mut self, _point: usize, _force: f64) {}

    /// Applies its own forces to the body and to itself; what they press the nonlinear force with (N times coupling),
    /// and the pressure that follows at once, Pa.
    fn press(&mut self, _body: &mut StruckBody) -> (f64, Pressure) {
        (0.0, Pressure::default())
    }

    /// How far its own forces have parted a striker from the body, m.
    fn displaced(&self, _point: usize, _coupling: f64, _free: &FreeStep) -> f64 {
        0.0
    }

    /// Ends the sample, all forces being known; what is heard of what moves under its own forces, Pa.
    fn finish(&mut self, _contacts: &Contacts, _free: &FreeStep) -> Pressure {
        Pressure::default()
    }

    /// What is heard of the body that contact points press on, Pa.
    fn listen(&self) -> Pressure {
        Pressure::default()
    }

    /// Renders while nothing touches from sample `from` on, adding what is heard of it, Pa; before, it has stepped.
    fn ring(&mut self, _out: [&mut [f32]; RECEIVERS], _from: usize) {}

    /// Whether every sample must be solved although no exciter is about.
    fn is_engaged(&self) -> bool {
        false
    }

    /// Whether it may drive the body although no exciter is about.
    fn drives_body(&self) -> bool {
        false
    }

    /// Energy of it and its contacts, J.
    fn energy(&self, _contacts: &Contacts) -> f64 {
        0.0
    }

    /// Energy of its motion, J: not of what is held bent for good.
    fn motion(&self, _contacts: &Contacts) -> f64 {
        0.0
    }

    /// Once a block: zeroes what has decayed; false if a value is not a finite number.
    fn settle(&mut self, _body: &mut StruckBody, _contacts: &Contacts) -> bool {
        true
    }

    /// Energy of body and attachments (J) under which it may be [parked](Self::park) while no striker is about; none if
    /// it has nothing to park.
    fn parks_below(&self) -> Option<f64> {
        None
    }

    /// Lies still where it is, until it is [woken](Self::wake).
    fn park(&mut self, _contacts: &mut Contacts) {}

    /// Whether it lies still and could be [woken](Self::wake).
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
