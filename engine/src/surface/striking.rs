//! Strikers of a surface: arrival, report, departure.
//!
//! The hand keeps a stick that has rebounded from falling back: a striker that is far enough away, or has been present for long,
//! is removed.

use std::any::Any;

use crate::contact::{ContactLaw, Tip};
use crate::fitted;
use crate::snapshot::{ForceTrace, StrikeSnapshot};
use crate::stick::{Profile, Stick};
use crate::strike::{Across, Strike};

use super::Surface;
use super::attachment::Attachment;
use super::contacts::{Contacts, MAX_STRIKERS, points_of};
use super::exciter::{Ground, PARTS};
use super::rim::AttachedRim;

/// A striker farther away than this has left, m. *By ear*: no head comes up so far.
const AWAY: f64 = fitted::STRIKER_AWAY;

/// A striker that does not leave is lifted after this, s; after twice as long also if it still touches. *By ear*.
const LIFTED_AFTER: f64 = fitted::STRIKER_LIFTED_AFTER;

/// In a rimshot the bead meets the head so long before the shaft meets the rim, s: a head gives way by some
/// millimetres, and drummers aim for the rim below it. *By ear*.
const SHOT_LEAD: f64 = fitted::SHOT_LEAD;

impl Surface {
    /// Strikes at the next sample: the tip is just touching and moves at the stroke's speed.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn strike(&mut self, strike: &Strike) {
        let radius = strike.radius.clamp(0.0, 1.0);
        let slope = self.bell.and_then(|(bell, own)| {
            let at = radius * own;
            (at < bell.radius).then(|| bell.slope(at))
        });
        let given = strike.speed.clamp(0.0, Strike::MAX_SPEED);
        // A flank that leans by `t` is met by `cos t` of the speed, and passes `cos t` of the force on across the plate.
        let speed = given * slope.map_or(1.0, |slope| 1.0 / (1.0 + slope * slope));
        self.wake();
        self.attachments.iter_mut().for_each(|attachment| attachment.begin_count());
        let (dt, lossless) = (self.contacts.dt(), self.contacts.is_lossless());
        let i = self.free_place();
        if self.contacts.exciters[i].present {
            self.log.hurried = self.log.hurried.saturating_add(1);
            self.leave(i);
        }
        self.log.last = StrikeSnapshot {
            count: self.log.last.count.wrapping_add(1),
            speed: given as f32,
            radius: radius as f32,
            angle: strike.angle as f32,
            force: ForceTrace { dt: dt as f32, ..ForceTrace::default() },
            ..StrikeSnapshot::default()
        };
        let mut spec = if slope.is_some() { strike.striker.spec_on_bell() } else { strike.striker.spec() };
        if self.local_compliance.is_some_and(|head| !head.dents) {
            spec.stick = spec.stick.map(Stick::even);
        }
        let striker = &mut self.contacts.exciters[i];
        (striker.age, striker.stroke) = (0, self.log.last.count);
        striker.present = true;
        let across = match (spec.across, &spec.stick) {
            (Some(across), Some(stick)) => self.lay_across(i, (stick, across), speed, radius),
            _ => None,
        };
        let Contacts { exciters, beams, .. } = &mut self.contacts;
        let striker = &mut exciters[i];
        let weights = across.unwrap_or_else(|| striker.take(&spec, speed, beams, (!lossless, dt)));
        self.log.brought += striker.arrived;
        let restitution = if lossless { 1.0 } else { spec.restitution };
        let law = ContactLaw::new(&spec.tip, &self.material, restitution);
        let tip = points_of(i).start;
        let point = &mut self.contacts.points[tip];
        point.arrive(Ground::Body, law, weights);
        let local = self.local_compliance.map(|head| head.at(radius));
        let patch = local.map_or(spec.patch, |head| head.patch(&spec));
        let disc = local.map_or(0.0, |head| patch / head.radius);
        self.body.shapes().fill_pressed(radius, strike.angle, disc, point.port.shape_mut());
        self.observers.put(tip, radius, strike.angle, patch);
        if let Some(head) = local {
            (point.bands, point.band_count) = head.bands(radius, patch, !lossless, dt);
        }
        point.origin = -self.body.modal().displacement_at(&point.port);
        for attachment in &mut self.attachments {
            attachment.put(tip, radius, strike.angle);
            point.origin -= attachment.displacement(tip);
        }
        let [felt, felt_beside] = [tip, tip + 1].map(|point| &self.contacts.points[point].weights);
        let rigid = self.contacts.exciters[i].rigid;
        let sounding = spec.stick.filter(|stick| stick.profile == Profile::Turned);
        self.observers.arrive(i, (radius, strike.angle), sounding.as_ref(), [felt, felt_beside], rigid);
        self.contacts.list();
        self.connect(tip);
        self.body.meet(radius, self.contacts.points[tip].port.shape());
    }

    /// Lets a stick strike head and rim, from the player's side. Returns the weights of its parts at the tip, or `None` without
    /// a rim.
    fn lay_across(
        &mut self,
        i: usize,
        (stick, across): (&Stick, Across),
        speed: f64,
        radius: f64,
    ) -> Option<[f64; PARTS]> {
        let index = self.index_of::<AttachedRim>()?;
        let Surface { contacts, attachments, .. } = self;
        let attached = (&*attachments[index] as &dyn Any).downcast_ref::<AttachedRim>()?;
        let (rim, sound) = (attached.rim(), attached.ground()?);
        let reach = match across {
            Across::RimShot => 1.0 - radius,
            Across::CrossStick => 1.0 + radius,
        };
        let shaft = (stick.place + reach * rim.radius / stick.length).clamp(0.1, 0.8);
        let (lossy, dt) = (!contacts.is_lossless(), contacts.dt());
        let Contacts { exciters, beams, .. } = &mut *contacts;
        let [tip, side] = exciters[i].take_across((stick, across), speed, shaft, beams, (lossy, dt));
        let (radius, restitution) = Stick::SHAFT;
        let edge = Tip::Solid { material: stick.material, radius };
        let law = ContactLaw::new(&edge, &rim.material, if lossy { restitution } else { 1.0 });
        let at = points_of(i).start + 1;
        let point = &mut contacts.points[at];
        point.arrive(Ground::Attachment(index), law, side);
        rim.shape(0.0, point.port.shape_mut());
        if across == Across::RimShot {
            point.compression = -speed * SHOT_LEAD;
        }
        point.origin = -sound.modal.displacement_at(&point.port) - point.compression;
        contacts.list();
        self.connect(at);
        Some(tip)
    }

    /// An unused exciter, or that of the striker which has been present longest without touching, or, if all touch, the
    /// oldest.
    fn free_place(&self) -> usize {
        let rank = |&i: &usize| {
            let striker = &self.contacts.exciters[i];
            let mut points = self.contacts.points[points_of(i)].iter();
            let touching = points.any(|point| point.present && point.touching);
            (striker.present, touching, std::cmp::Reverse(striker.age))
        };
        (0..MAX_STRIKERS).min_by_key(rank).unwrap_or(0)
    }

    /// Removes a striker and counts its energy.
    fn leave(&mut self, i: usize) {
        self.log.departed += self.contacts.energy_of(i);
        self.contacts.exciters[i].present = false;
        self.contacts.points[points_of(i)].iter_mut().for_each(|point| point.present = false);
    }

    /// Updates the report of the strikers, and removes those that have left.
    pub(super) fn watch_strikers(&mut self) {
        let (dt, mut left) = (self.contacts.dt(), false);
        for i in 0..MAX_STRIKERS {
            let Contacts { exciters, points, .. } = &mut self.contacts;
            let striker = &mut exciters[i];
            if !striker.present {
                continue;
            }
            striker.age += 1;
            let age = striker.age as f64 * dt;
            let points = &points[points_of(i)];
            if striker.stroke == self.log.last.count {
                self.log.report(striker, points, dt);
            }
            let mut present = points.iter().filter(|point| point.present);
            let touching = present.clone().any(|point| point.touching);
            let lifted = age > if touching { 2.0 * LIFTED_AFTER } else { LIFTED_AFTER };
            if lifted || present.all(|point| point.compression < -AWAY) {
                self.leave(i);
                left = true;
            }
        }
        if left {
            self.contacts.list();
        }
    }
}

#[cfg(test)]
mod tests;
