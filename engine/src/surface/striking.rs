//! Strikers about a surface: how they arrive, what is reported of them, how they leave.
//!
//! The hand is what keeps a stick that has come off from falling back: a striker that is far enough off, or that
//! has been about for long, is gone.

use crate::contact::{ContactLaw, Tip};
use crate::fitted;
use crate::snapshot::{ForceTrace, StrikeSnapshot};
use crate::stick::Stick;
use crate::strike::{Across, Strike, StrikerSpec};

use super::touch::{PARTS, Side, TouchPoint, Toucher};
use super::{MAX_STRIKERS, Surface, points_of};

/// A striker farther off than this has left for good, m. *By ear*: no head comes up so far.
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
        let speed = strike.speed.clamp(0.0, Strike::MAX_SPEED);
        let radius = strike.radius.clamp(0.0, 1.0);
        self.wake_wires();
        if let Some(wires) = &mut self.wires {
            wires.begin_count();
        }
        let i = self.free_place();
        if self.touchers[i].present {
            self.hurried = self.hurried.saturating_add(1);
            self.leave(i);
        }
        self.last = StrikeSnapshot {
            count: self.last.count.wrapping_add(1),
            speed: speed as f32,
            radius: radius as f32,
            angle: strike.angle as f32,
            force: ForceTrace { dt: self.dt as f32, ..ForceTrace::default() },
            ..StrikeSnapshot::default()
        };
        let spec = strike.striker.spec();
        (self.touchers[i].age, self.touchers[i].stroke) = (0, self.last.count);
        self.touchers[i].present = true;
        let weights = match (spec.across, &spec.stick) {
            (Some(across), Some(stick)) if self.rim.is_some() => {
                self.lay_across(i, (&spec, stick, across), speed, radius)
            }
            _ => self.touchers[i].take(&spec, speed, !self.lossless, self.dt),
        };
        self.brought_energy += self.touchers[i].arrived;
        let restitution = if self.lossless { 1.0 } else { spec.restitution };
        let law = ContactLaw::new(&spec.tip, &self.material, restitution);
        let tip = points_of(i).start;
        let point = &mut self.points[tip];
        point.arrive(Side::Surface, law, weights);
        let patch = self.film.map_or(spec.patch, |film| film.patch(&spec, speed));
        let disc = self.film.map_or(0.0, |film| patch / film.radius);
        self.shapes.fill_pressed(radius, strike.angle, disc, point.port.shape_mut());
        self.high.iter_mut().for_each(|high| high.put(tip, radius, strike.angle, patch));
        if let Some(film) = self.film {
            (point.bands, point.band_count) = film.bands(radius, patch, !self.lossless, self.dt);
        }
        point.origin = -self.body.displacement_at(&point.port);
        if let Some(pair) = &mut self.pair {
            pair.put_striker(tip, radius, strike.angle);
            pair.engage(&self.body);
            pair.begin_count();
            self.points[tip].origin -= pair.under_striker(tip);
        }
        self.list();
        self.connect(tip);
        if let Some(force) = &mut self.beyond {
            force.wake();
        }
    }

    /// Lets a stick come down on head and rim, from the player's side; returns what its tip feels of it.
    pub(super) fn lay_across(
        &mut self,
        i: usize,
        (spec, stick, across): (&StrikerSpec, &Stick, Across),
        speed: f64,
        radius: f64,
    ) -> [f64; PARTS] {
        let Some(rim) = &mut self.rim else {
            return [0.0; PARTS];
        };
        let reach = match across {
            Across::RimShot => 1.0 - radius,
            Across::CrossStick => 1.0 + radius,
        };
        let shaft = (stick.place + reach * rim.rim.radius / stick.length).clamp(0.1, 0.8);
        let lossy = !self.lossless;
        let [tip, side] = self.touchers[i].take_across((spec, stick, across), speed, shaft, lossy, self.dt);
        let (radius, restitution) = Stick::SHAFT;
        let edge = Tip::Solid { material: stick.material, radius };
        let law = ContactLaw::new(&edge, &rim.rim.material, if lossy { restitution } else { 1.0 });
        let at = points_of(i).start + 1;
        let point = &mut self.points[at];
        point.arrive(Side::Rim, law, side);
        rim.rim.shape(0.0, point.port.shape_mut());
        if across == Across::RimShot {
            point.compression = -speed * SHOT_LEAD;
        }
        point.origin = -rim.body.displacement_at(&point.port) - point.compression;
        self.list();
        self.connect(at);
        tip
    }

    /// An empty place, or that of the striker which has been about longest without touching, or,
    /// if all touch, of the oldest.
    pub(super) fn free_place(&self) -> usize {
        let rank = |&i: &usize| {
            let toucher = &self.touchers[i];
            let touching = self.points[points_of(i)].iter().any(|point| point.present && point.touching);
            (toucher.present, touching, std::cmp::Reverse(toucher.age))
        };
        (0..MAX_STRIKERS).min_by_key(rank).unwrap_or(0)
    }

    /// A striker leaves with what it holds.
    pub(super) fn leave(&mut self, i: usize) {
        self.departed_energy += self.energy_of(i);
        self.touchers[i].present = false;
        self.points[points_of(i)].iter_mut().for_each(|point| point.present = false);
    }

    /// Reports on the strikers, and lets go those that have left.
    pub(super) fn watch_strikers(&mut self) {
        let mut left = false;
        for i in 0..MAX_STRIKERS {
            if !self.touchers[i].present {
                continue;
            }
            self.touchers[i].age += 1;
            let age = self.touchers[i].age as f64 * self.dt;
            let points = &self.points[points_of(i)];
            if self.touchers[i].stroke == self.last.count {
                report(&mut self.last, &self.touchers[i], points, self.dt);
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
            self.list();
        }
    }
}

/// Adds this sample to what a stroke's contacts have measured.
fn report(last: &mut StrikeSnapshot, toucher: &Toucher, points: &[TouchPoint], dt: f64) {
    let mut force = 0.0;
    for point in points.iter().filter(|point| point.present && point.force > 0.0) {
        force += point.force;
        if point.step.before <= 0.0 {
            last.touches += 1;
        }
        last.contact_time = (toucher.age as f64 * dt) as f32;
        last.peak_force = last.peak_force.max(point.force as f32);
        last.impulse += (point.force * dt) as f32;
    }
    if force > 0.0 {
        // The first sample of a touch is the first of its age.
        last.force.add(toucher.age.saturating_sub(1), force as f32);
    }
    last.leaving_speed = toucher.leaving_speed() as f32;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build_context::BuildOptions;
    use crate::drum::Drum;
    use crate::instrument::Instrument as _;
    use crate::modal::EARS;
    use crate::reference;
    use crate::strike::Striker;

    #[test]
    fn the_force_a_head_is_thought_to_wrap_itself_by_is_the_strokes() {
        let stick = Striker::Stick.spec();
        for name in ["snare", "rack-tom", "floor-tom"] {
            let build = reference::standard(name);
            let context = build.context(BuildOptions::new(48e3));
            let mut drum = Drum::new(build.spec.drum().unwrap(), &context).unwrap();
            for speed in [1.5, 3.0, 5.0] {
                drum.strike(&Strike { speed, radius: 0.3, angle: 0.0, striker: Striker::Stick });
                let mut out = [[0.0; 32]; EARS];
                (0..32).for_each(|_| {
                    let ears = out.each_mut().map(|ear| &mut ear[..]);
                    drum.surface_mut().render_in_air(ears, None);
                });
                let film = drum.surface().film.unwrap();
                let thought = film.largest_force(stick.mass, speed, film.patch(&stick, speed));
                let measured = f64::from(drum.surface().last_strike().peak_force);
                assert!((thought / measured - 1.0).abs() < 0.2, "{name} {speed}: {thought} N, {measured} N");
                drum.surface_mut().reset();
            }
        }
    }
}
