//! The [`Pair`] as an attachment of the upper cymbal: the contacts at the rims are solved together with the strikers'.

use crate::modal::simd::MAX_RUN;
use crate::modal::{InputVector, Pressure, RECEIVERS};
use crate::surface::attachment::{Attachment, Site};
use crate::surface::body::{FreeStep, StruckBody, add};
use crate::surface::contacts::Contacts;

use super::pair::Pair;
use super::rim_points::POINTS;
use super::settling::Settled;
use super::solving::pressing;

/// A striker farther away than this does not reach the surface within a sample, m.
const APART: f64 = 1e-3;

impl Attachment for Pair {
    fn attached(&mut self, site: Site<'_>) {
        self.follow_modes(site.body.modal(), site.body.receiver());
        self.come_to_rest();
    }

    fn follow(&mut self, body: &StruckBody) {
        self.follow_modes(body.modal(), body.receiver());
    }

    fn wake(&mut self, site: Site<'_>) {
        self.engage(site.body.modal());
    }

    fn begin_count(&mut self) {
        self.rims.begin_count();
    }

    fn put(&mut self, point: usize, radius: f64, angle: f64) {
        self.put_striker(point, radius, angle);
    }

    fn connect(&mut self, point: usize, port: &InputVector, body: &StruckBody) {
        self.connect_striker(point, body.modal(), port);
    }

    fn compliance(&self, a: usize, b: usize) -> f64 {
        self.rigid[0].compliance(&self.strikers[a].weights, &self.strikers[b].weights)
    }

    fn couple(&mut self, body: &StruckBody) {
        self.couple_with(body.modal(), body.acting_force());
    }

    fn step(&mut self, body: &StruckBody, free: &FreeStep) {
        self.step_free(body.modal(), free.mean, free.divisor);
    }

    fn displacement(&self, point: usize) -> f64 {
        let weights = &self.strikers[point].weights;
        let carried: f64 = self.carried.iter().zip(weights).map(|(carried, weight)| carried * weight).sum();
        self.rigid[0].at(weights) - carried
    }

    fn preload_offset(&self, point: usize, coupling: f64, free: &FreeStep) -> f64 {
        self.preload_offset_at(point, coupling, free.divisor)
    }

    fn solve(&mut self, contacts: &mut Contacts, free: &FreeStep) -> bool {
        if !self.is_near() {
            self.rims.force = [0.0; POINTS];
            return false;
        }
        let apart = |&i: &usize| {
            let step = &contacts.point(i).step;
            step.free.max(step.before) < -APART
        };
        if contacts.present().iter().all(apart) {
            self.solve_rims(None, free.divisor);
            for k in 0..contacts.present().len() {
                let i = contacts.present()[k];
                contacts.point_mut(i).force = 0.0;
            }
            return true;
        }
        self.solve_rims(Some(contacts), free.divisor);
        true
    }

    fn push(&mut self, point: usize, force: f64) {
        self.rigid[0].push(&self.strikers[point].weights, force);
    }

    fn press(&mut self, body: &mut StruckBody) -> (f64, Pressure) {
        self.press_rims(body.modal_mut())
    }

    fn displaced(&self, point: usize, coupling: f64, free: &FreeStep) -> f64 {
        if !self.engaged {
            return 0.0;
        }
        (0..POINTS).map(|j| self.stiffened_to(point, coupling, j, free.divisor) * self.rims.force[j]).sum()
    }

    fn finish(&mut self, contacts: &Contacts, free: &FreeStep) -> Pressure {
        let mut heard = self.finish_sample(pressing(contacts), free.divisor);
        add(&mut heard, self.pedal.fading.next());
        heard
    }

    fn impart(&mut self, body: &mut StruckBody) -> Pressure {
        if self.still {
            return Pressure::default();
        }
        let shells = self.engaged.then(|| body.modal_mut());
        self.press_air(shells)
    }

    fn ring(&mut self, mut out: [&mut [f32]; RECEIVERS], from: usize) {
        self.pedal.fading.add_to(&mut out.each_mut().map(|out| &mut out[from..]));
        if !self.engaged {
            self.ring_apart(out, from);
        }
    }

    fn is_engaged(&self) -> bool {
        self.engaged
    }

    fn drives_body(&self) -> bool {
        true
    }

    fn energy(&self, _contacts: &Contacts) -> f64 {
        self.held_energy()
    }

    /// A rock that nobody hears keeps nothing awake, as of a cymbal on a stand.
    fn motion(&self, _contacts: &Contacts) -> f64 {
        let rock = if self.is_touching() { 0.0 } else { self.rigid[0].rock_energy() };
        self.held_energy() - rock
    }

    fn tilt(&self) -> Option<[f64; 2]> {
        Some(self.rigid[0].tilt())
    }

    fn settle(&mut self, body: &mut StruckBody, contacts: &mut Contacts) -> bool {
        let way = contacts.fastest_striker().map(|speed| speed * MAX_RUN as f64 * contacts.dt());
        match contacts.carry_by(body, |body| self.look(body.modal_mut(), way)) {
            Settled::Moving => {
                if self.engaged {
                    self.follow_swing(body.modal(), body.receiver());
                }
                true
            }
            Settled::Parked => {
                body.reset();
                true
            }
            Settled::Broken => false,
        }
    }

    fn is_still(&self) -> bool {
        self.still && !self.engaged && self.lower.modal.is_still() && self.pedal.fading.is_over()
    }

    /// With the pedal where it is to go.
    fn reset(&mut self, _contacts: &mut Contacts) {
        self.lower.modal.reset();
        self.pedal.fading.reset();
        self.come_to_rest();
        self.begin_count();
        self.carried = [0.0; 3];
        self.pedal.work = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::BLOCK;
    use crate::build_context::BuildOptions;
    use crate::hi_hat::HiHat;
    use crate::hi_hat::foot::SPEED;
    use crate::hi_hat::rigid::Rigid;
    use crate::instrument::{Instrument as _, Pedal as _};
    use crate::receiver::POINTS as RECEIVER_POINTS;
    use crate::reference;
    use crate::surface::Surface;

    fn transfers(surface: &mut Surface) -> Vec<[f64; 2]> {
        let mut all = Vec::new();
        surface.with(|_: &mut Pair, site| {
            let receiver = &mut site.body.sound_mut().receiver;
            all.extend((0..RECEIVER_POINTS).flat_map(|point| receiver.transfer_mut(point).to_vec()));
        });
        all
    }

    /// Squares of the differences between pressures that follow the rims' forces.
    fn apart(some: &[[Pressure; 2]], others: &[[Pressure; 2]]) -> f32 {
        let flat = |all: &[[Pressure; 2]]| all.as_flattened().as_flattened().to_vec();
        flat(some).into_iter().zip(flat(others)).map(|(one, other)| (one - other).powi(2)).sum()
    }

    #[test]
    fn the_upper_cymbal_is_heard_from_where_it_looks_while_it_rocks() {
        let context = reference::standard("hi-hat").context(BuildOptions::new(44_100.0));
        let mut hat = HiHat::new(&reference::hi_hat(), &context).unwrap();
        // So open that a rim which rocks comes near the other one.
        hat.press(0.3, SPEED.1);
        hat.finish_controls();
        let surface = hat.surface_mut();
        let (at_rest, heard_at_rest) =
            (transfers(surface), surface.attachment::<Pair>().unwrap().dynamics.direct);
        let run = |surface: &mut Surface, blocks: usize| {
            for _ in 0..blocks {
                let mut sound = [[0.0; BLOCK]; RECEIVERS];
                surface.settle();
                surface.render_in_air(sound.each_mut().map(|row| &mut row[..]), None);
            }
        };
        // The side at angle 0 down by a tenth of the radius.
        let radius = reference::hi_hat().top.plate().radius();
        surface.with(|pair: &mut Pair, site| {
            pair.engage(site.body.modal());
            pair.rigid_mut()[0].put(&[0.0, 0.05 * radius, 0.0]);
            assert_eq!(pair.rigid()[0].at(&Rigid::weights(1.0, 0.0)), 0.1 * radius);
            let tilt = pair.tilt().unwrap();
            assert!((tilt[0] - 0.1).abs() < 1e-12 && tilt[1] == 0.0, "{tilt:?}");
        });
        run(surface, 20);
        let rocking = transfers(surface);
        let (mut moved, mut all) = (0.0, 0.0);
        for (now, rest) in rocking.iter().zip(&at_rest) {
            moved += (now[0] - rest[0]).powi(2) + (now[1] - rest[1]).powi(2);
            all += rest[0].powi(2) + rest[1].powi(2);
        }
        assert!(moved > 0.01 * all, "{moved:.1e} of {all:.1e}");
        // What is heard of the rims' forces at once is what the weights of now say.
        surface.with(|pair: &mut Pair, site| {
            let heard = pair.dynamics.direct;
            pair.follow_swing(site.body.modal(), site.body.receiver());
            // The weights have moved on by four steps since the block began.
            let (late, none) =
                (apart(&heard, &pair.dynamics.direct), apart(&heard_at_rest, &pair.dynamics.direct));
            assert!(late < 0.1 * none, "{late:.1e}, not following at all {none:.1e}");
        });
        surface.reset();
        assert_eq!(transfers(surface), at_rest);
    }
}
