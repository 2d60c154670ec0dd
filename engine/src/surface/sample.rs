//! One sample with something touching: everything steps freely, then all forces are found together.

use crate::contact::ContactStep;
use crate::modal::Heard;

use super::air::Incident;
use super::together::hertz::Hertz;
use super::together::{self, Meeting};
use super::touch::Side;
use super::{FIRST_WIRE, MAX_POINTS, Surface, above, owner};

/// Adds at every ear.
pub(super) fn add(sum: &mut Heard, more: Heard) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

impl Surface {
    /// Works out what the body tells point `i` and the others of each other.
    pub(super) fn connect(&mut self, i: usize) {
        let side = self.points[i].side;
        let (body, pickup, beyond) = match (&self.rim, side) {
            (Some(rim), Side::Rim) => (&rim.body, &rim.pickup, None),
            _ => (&self.body, &self.pickup, self.beyond.as_ref()),
        };
        let point = &mut self.points[i];
        body.connect(&mut point.port);
        point.direct = pickup.direct_at(body, &point.port);
        self.coupling[i] = beyond.map_or(0.0, |force| force.coupling(body, &point.port));
        if side == Side::Surface {
            let (high, place) = above(i, &mut self.high, &mut self.far_high);
            high.iter_mut().for_each(|high| high.complete(place, self.points[i].direct[0]));
        }
        if let Some(pair) = &mut self.pair {
            pair.connect_striker(i, &self.body, &self.points[i].port);
        }
        for &j in &self.live[..self.live_count] {
            let mut mutual = 0.0;
            if self.points[j].side == side {
                mutual = body.compliance(&self.points[j].port, &self.points[i].port);
            }
            if let Some(pair) = self.pair.as_ref().filter(|_| i < FIRST_WIRE && j < FIRST_WIRE) {
                mutual += pair.between_strikers(i, j);
            }
            if owner(i) == owner(j) {
                mutual +=
                    self.touchers[owner(i)].compliance(&self.points[i].weights, &self.points[j].weights);
            }
            self.compliance[i][j] = mutual;
            self.compliance[j][i] = mutual;
        }
    }

    /// One sample with something about; which of the run, and what arrives over it.
    pub(super) fn step(&mut self, sample: usize, incident: Option<Incident<'_>>) -> Heard {
        let (mean, mut direct) = self.step_free(sample, incident);
        let divisor = self.divisor();
        self.step_pair(mean);
        let dt = self.dt;
        for toucher in self.touchers.iter_mut().filter(|toucher| toucher.present) {
            toucher.step();
        }
        if let Some(rim) = &mut self.rim {
            rim.body.step();
        }
        for &i in &self.live[..self.live_count] {
            let point = &mut self.points[i];
            let surface = match (&self.rim, point.side) {
                (Some(rim), Side::Rim) => rim.body.displacement_at(&point.port),
                _ => self.body.displacement_at(&point.port) - self.coupling[i] * mean,
            };
            let mut position = self.touchers[owner(i)].position(&point.weights);
            if let Some(pair) = &self.pair {
                position += pair.eases_striker(i, self.coupling[i], divisor) - pair.under_striker(i);
            }
            point.free_flight(position - surface - point.origin, self.yielding[i][i], dt);
        }
        match self.pair {
            Some(_) => self.solve_paired(),
            None => self.solve(),
        }
        let mut pressed = 0.0;
        for &i in &self.live[..self.live_count] {
            let point = &self.points[i];
            let force = point.pressing();
            if force != 0.0 {
                match (&mut self.rim, point.side) {
                    (Some(rim), Side::Rim) => rim.body.push(&point.port, force as f32),
                    _ => self.body.push(&point.port, force as f32),
                }
                self.touchers[owner(i)].push(&point.weights, force);
                if let Some(pair) = &mut self.pair {
                    pair.push_striker(i, force);
                }
                add(&mut direct, point.direct.map(|direct| force as f32 * direct));
                pressed += force * self.coupling[i];
                if point.side == Side::Surface {
                    let (high, place) = above(i, &mut self.high, &mut self.far_high);
                    high.iter_mut().for_each(|high| high.push(place, sample, force as f32));
                }
            }
        }
        if let Some(pair) = &mut self.pair {
            let (of_rims, at_once) = pair.press(&mut self.body);
            pressed += of_rims;
            add(&mut direct, at_once);
        }
        if let Some(beyond) = self.beyond.as_mut().filter(|beyond| beyond.is_active()) {
            add(&mut direct, beyond.finish(&mut self.body, pressed));
        }
        for &i in &self.live[..self.live_count] {
            let mut others = self.moved_by_others(i);
            if let Some(pair) = &self.pair {
                others += pair.moves_striker(i, self.coupling[i], divisor);
            }
            let before = self.points[i].touching;
            self.points[i].finish(others);
            if let Some(wires) = self.wires.as_mut().filter(|_| i >= FIRST_WIRE) {
                wires.count(before, self.points[i].touching);
            }
        }
        if let Some(wires) = &mut self.wires {
            wires.age += 1;
        }
        let below = self.finish_pair(divisor);
        self.watch_strikers();
        let rim = self.rim.as_ref().map_or(Heard::default(), |rim| rim.body.listen(&rim.pickup));
        let mut heard = self.body.listen(&self.pickup);
        add(&mut heard, rim);
        add(&mut heard, direct);
        add(&mut heard, below);
        heard
    }

    /// How far the forces of all other points have brought point `i` out of the surface, m.
    pub(super) fn moved_by_others(&self, i: usize) -> f64 {
        let others = self.live[..self.live_count].iter().filter(|&&j| j != i);
        others.map(|&j| self.yielding[i][j] * self.points[j].pressing()).sum()
    }

    /// Lets the body step under nothing but the air; works out how what touches meets it. Returns what multiplies their
    /// coupling to give how far the force beyond the modes has moved the surface by itself, and what is heard at
    /// once.
    pub(super) fn step_free(&mut self, sample: usize, incident: Option<Incident<'_>>) -> (f64, Heard) {
        if self.live_count > 0 {
            self.yielding = self.compliance;
        }
        let Some(force) = self.beyond.as_mut().filter(|force| force.is_active()) else {
            self.pair.iter_mut().for_each(|pair| pair.couple(&self.body, None));
            self.body.step();
            return (0.0, self.press(incident, sample));
        };
        let live = &self.live[..self.live_count];
        if force.begin(&mut self.body, &self.pickup) {
            self.pair.iter_mut().for_each(|pair| pair.couple(&self.body, Some(force)));
            for &i in live {
                if self.points[i].side == Side::Surface {
                    self.coupling[i] = force.coupling(&self.body, &self.points[i].port);
                }
            }
        }
        self.body.step();
        let echo = self.press(incident, sample);
        let (Some(force), live) = (&mut self.beyond, &self.live[..self.live_count]) else {
            return (0.0, echo);
        };
        for &i in live {
            for &j in live {
                self.yielding[i][j] -= self.coupling[i] * self.coupling[j] / force.divisor();
            }
        }
        (force.free(&self.body), echo)
    }

    /// Forces of all contacts for this sample.
    pub(super) fn solve(&mut self) {
        let live = &self.live[..self.live_count];
        let hertz = live.iter().all(|&i| Hertz::<MAX_POINTS>::knows(&self.points[i].law));
        let solved = match live.len() {
            2..=8 if hertz => self.solve_hertz::<8>(),
            9..=MAX_POINTS if hertz => self.solve_hertz::<MAX_POINTS>(),
            _ => false,
        };
        if !solved {
            self.solve_any();
        }
    }

    /// [`solve`](Self::solve) of at most `N` contacts of Hertz's law; false if they were not found.
    fn solve_hertz<const N: usize>(&mut self) -> bool {
        let live = &self.live[..self.live_count];
        let mut hertz = Hertz::<N>::APART;
        for (n, &i) in live.iter().enumerate() {
            let point = &self.points[i];
            // The preloads of the others are part of equilibrium: what they would push is put back.
            let mut free = point.step.free - self.yielding[i][i] * point.preload;
            for (yielding, &j) in hertz.yielding[n].iter_mut().zip(live) {
                *yielding = self.yielding[i][j];
                free += *yielding * self.points[j].preload;
            }
            hertz.yielding[n][n] = point.step.compliance;
            (hertz.stiffness[n], hertz.before[n]) = (point.law.stiffness, point.step.before);
            (hertz.free[n], hertz.loss[n]) = (free, point.step.lambda / point.step.dt);
            hertz.force[n] = point.force;
        }
        let solved = hertz.solve(self.body.kernels());
        if solved {
            live.iter().zip(hertz.force).for_each(|(&i, force)| self.points[i].force = force);
        }
        solved
    }

    /// [`solve`](Self::solve) of contacts of any law.
    fn solve_any(&mut self) {
        let live = &self.live[..self.live_count];
        let absent = Meeting { law: self.points[0].law, step: self.points[0].step, force: 0.0 };
        let (mut meetings, mut yielding) = ([absent; MAX_POINTS], [[0.0; MAX_POINTS]; MAX_POINTS]);
        for (n, &i) in live.iter().enumerate() {
            let point = &self.points[i];
            // The preloads of the others are part of equilibrium: what they would push is put back.
            let mut free = point.step.free;
            for (k, &j) in live.iter().enumerate().filter(|&(k, _)| k != n) {
                yielding[n][k] = self.yielding[i][j];
                free += self.yielding[i][j] * self.points[j].preload;
            }
            meetings[n] =
                Meeting { law: point.law, step: ContactStep { free, ..point.step }, force: point.force };
        }
        together::solve(&mut meetings[..live.len()], &yielding);
        for (meeting, &i) in meetings.iter().zip(live) {
            self.points[i].force = meeting.force;
        }
    }
}
