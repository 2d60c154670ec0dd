//! Arrival of a foot that a note calls for.
//!
//! A note names a finished sound: "closed hi-hat" means cymbals that a foot has closed before the stick lands. Nothing announces
//! the note, so the foot moves after it, faster than any foot.
//!
//! Model: a foot that closes open cymbals in time takes their ringing before the stick lands. Both cymbals take the closed
//! equilibrium at once and at rest, and what rang [fades](super::fading). A stroke is then that on cymbals that were closed.
//!
//! A foot that opens, or presses closed cymbals harder, leads them through static equilibria: over each step the rod, both
//! cymbals as rigid bodies, and the static deflection of the shells move from one to the next. A landing or a release at the
//! speed of such a foot would be louder than the stroke; cymbals that are led have no momentum. Through the air, on the part of
//! the way on which the rims do not touch, the rod and the upper cymbal are displaced at once, which no force resists and which
//! makes no sound. Cymbals at rest take the last equilibrium at once.
//!
//! A foot that steps on the pedal has lifted before: it is led to where it comes from, and from there it goes at full speed, the
//! upper cymbal with it.
//!
//! Energy: the change by the displacements is part of the [pedal's work](Pair::pedal_work). What rang is only taken.
//! Strikers are carried with the upper cymbal, so that its displacement changes no contact with them.

use crate::surface::attachment::Site;

use super::foot::Step;
use super::gap_air::GapAir;
use super::pair::Pair;
use super::pair::arrival::Arrival;
use super::rigid::Weights;
use super::rim_points::POINTS;
use super::settling::STILL;

/// Gap that the rims keep when they are displaced through the air, m. *Derived*: the way of 5 m/s in a sample.
const CLEARANCE: f64 = 2e-4;

/// Rims that are pressed together by less than this, N, ring as open ones do. *Derived*: a ninth of the upper cymbal's weight;
/// half-open ones are pressed by twice as much.
const LEANING: f64 = 1.0;

impl Pair {
    /// Brings the rod to `end` (m), within [`ARRIVAL`](super::ARRIVAL); there a step may follow.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn arrive(&mut self, end: f64, step: Option<Step>, mut site: Site<'_>) {
        self.engage(site.body.modal());
        let before = self.held();
        let touching = self.statics.depth.iter().sum::<f64>() / POINTS as f64;
        let mut quiet = self.held_energy() + site.body.modal().energy() < STILL;
        if !quiet && self.clamped() < LEANING && end > touching {
            self.pedal.fading.take(&mut site, &mut self.lower);
            quiet = true;
        }
        let top = site.body.modal();
        self.pedal.arrival = None;
        self.pedal.foot.stop_for(end);
        self.rigid.iter_mut().for_each(|rigid| rigid.set_speed([0.0; 3]));
        self.dynamics.air.iter_mut().for_each(GapAir::stop);
        if quiet {
            let from = self.rigid[0].place();
            self.come_to_rest();
            let to = self.rigid[0].place();
            self.carried = std::array::from_fn(|i| self.carried[i] + to[i] - from[i]);
            self.engage(top);
            self.follow_gaps(true);
            step.into_iter().for_each(|step| self.set_off(step));
        } else {
            self.pedal.arrival = Some(Arrival::new((end, step), self.dt));
            self.set_out_for(end);
        }
        self.pedal.work += self.held() - before;
    }

    /// Steps on the pedal, on which foot and upper cymbal are on their way already.
    fn set_off(&mut self, step: Step) {
        self.pedal.foot.take(step);
        let (from, to) = (self.rigid[0].speeds(), [self.pedal.foot.speed(), 0.0, 0.0]);
        self.rigid[0].set_speed(to);
        let gained = std::array::from_fn(|part| to[part] - from[part]);
        if let Some(air) = &mut self.dynamics.air {
            air.carry(&[gained, [0.0; 3]]);
        }
    }

    /// Forgets a step that has not begun.
    pub fn forget_step(&mut self) {
        self.pedal.arrival.iter_mut().for_each(|arrival| arrival.step = None);
    }

    /// Displaces rod and cymbals to where the rims are about to touch, or to `end` (m) if they do not touch there. Rims that
    /// touch stay where they are.
    fn cross_air(&mut self, end: f64) {
        if self.rims.compression.iter().any(|&d| d > -CLEARANCE) {
            return;
        }
        let [above, below] = [0, 1].map(|which: usize| self.rigid[which].place());
        // Rims that a pedal moves are equally wide.
        let [places, _] = &self.statics.weights;
        let y = places.iter().zip(&self.rims.compression).fold(end, |y, (weights, d)| {
            let rigid: f64 =
                weights.iter().zip(above.iter().zip(&below)).map(|(w, (a, b))| w * (a - b)).sum();
            y.min(rigid - d - CLEARANCE)
        });
        self.pedal.foot.put(y);
        self.displace(&[[y - above[0], -above[1], -above[2]], below.map(|place| -place)]);
    }

    /// Displaces both cymbals by heave and tilts (m), and the strikers with the upper one.
    fn displace(&mut self, by: &[Weights; 2]) {
        self.rigid.iter_mut().zip(by).for_each(|(rigid, by)| rigid.displace(by));
        self.carried.iter_mut().zip(&by[0]).for_each(|(carried, by)| *carried += by);
        for (d, weights) in self.rims.compression.iter_mut().zip(&self.statics.weights[0]) {
            *d += weights.iter().zip(by[0].iter().zip(&by[1])).map(|(w, (a, b))| w * (a - b)).sum::<f64>();
        }
    }

    /// Starts the way to `end` (m), through the air at once.
    fn set_out_for(&mut self, end: f64) {
        self.cross_air(end);
        let y = self.pedal.foot.place();
        let places = self.statics.balance(y, &self.pedal.goal.preload, &self.rims.law, &self.rigid).places;
        let deviation = [0, 1].map(|which: usize| {
            let present = self.rigid[which].place();
            std::array::from_fn(|i| present[i] - places[which][i])
        });
        self.follow_gaps(true);
        if let Some(arrival) = &mut self.pedal.arrival {
            (arrival.places, arrival.deviation) = (places, deviation);
        }
    }

    /// Advances an arrival by a sample; false if there is none.
    pub(super) fn step_arrival(&mut self) -> bool {
        let Some(mut arrival) = self.pedal.arrival else { return false };
        if arrival.left == 0 {
            self.begin_step(&mut arrival);
        }
        arrival.left -= 1;
        let over = arrival.left == 0 && arrival.steps == 0;
        self.pedal.foot.put(if over { arrival.end } else { self.pedal.foot.place() + arrival.rod });
        self.displace(&arrival.shift);
        if arrival.left == 0 && !self.pedal.goal_place.is_nan() {
            // To rounding the rod is where the goal is: nothing has to be led there again.
            self.pedal.goal_place = self.pedal.foot.place();
        }
        self.pedal.arrival = Some(arrival).filter(|_| !over);
        if over {
            self.follow_gaps(true);
            self.take_air_along(1.0);
        }
        arrival.step.filter(|_| over).into_iter().for_each(|step| self.set_off(step));
        true
    }

    /// Finds the next equilibrium on the way, and sets out for it.
    fn begin_step(&mut self, arrival: &mut Arrival) {
        let y = self.pedal.foot.place();
        let goal = y + (arrival.end - y) / f64::from(arrival.steps);
        let next = self.statics.balance(goal, &self.pedal.goal.preload, &self.rims.law, &self.rigid);
        let (samples, whole) = (f64::from(arrival.samples), f64::from(arrival.whole));
        arrival.rod = (goal - y) / samples;
        for (which, shift) in arrival.shift.iter_mut().enumerate() {
            for (i, shift) in shift.iter_mut().enumerate() {
                let led = next.places[which][i] - arrival.places[which][i];
                *shift = (led - arrival.deviation[which][i] / whole) / samples;
            }
        }
        arrival.places = next.places;
        arrival.left = arrival.samples;
        arrival.steps -= 1;
        self.pedal.goal_place = goal;
        self.pedal.lead_to(next.rest, arrival.samples);
    }
}
