//! A round surface that is struck and heard: a modal body, its shapes, and what touches it.
//!
//! Displacement and force are positive along the stroke, into the surface. Whatever touches is a few
//! oscillators ([`touch`]); both they and the body integrate a force held over the sample exactly, so a contact
//! is one scalar equation, and several at once ([`together`]) a small system of them.
//!
//! ```text
//! strikers (tip, shaft) --\                      /--> modes --> pickup --> pressure
//! wires (8 groups) --------+--> contacts, solved -+--> rim ---> pickup --/
//! stretch, coupling -------/    together
//! ```

pub mod oscillator;
pub mod patch;
mod together;
pub mod touch;
pub mod wires;

use crate::contact::{ContactLaw, ContactStep, Material, Tip};
use crate::drum::high_band::HighBand;
use crate::modal::simd::MAX_RUN;
use crate::modal::{ModalBody, Mode, Pickup};
use crate::potential::{NonlinearForce, Potential};
use crate::rim::Rim;
use crate::shapes::ShapeTable;
use crate::snapshot::{StrikeSnapshot, WireSnapshot};
use crate::stick::Stick;
use crate::strike::{Across, Strike, StrikerSpec};

use patch::Film;
use together::{Compliances, Meeting};
use touch::{PARTS, Side, TouchPoint, Toucher};
use wires::SnareWires;

/// Strikers that can be about one surface at a time; the one that has been away longest gives way.
pub const MAX_STRIKERS: usize = 4;

/// Points a striker has: its tip and its shaft.
const STRIKER_POINTS: usize = 2;

/// Points of all strikers: the places of the [high band](HighBand) that listens to them.
pub const STRIKER_PLACES: usize = STRIKER_POINTS * MAX_STRIKERS;

/// Where the wires' points begin, and how many points there are at most.
const FIRST_WIRE: usize = STRIKER_PLACES;
const MAX_POINTS: usize = together::MOST;
const _: () = assert!(FIRST_WIRE + wires::GROUPS <= MAX_POINTS);

/// A striker farther off than this has left for good, m. *By ear*: no head comes up so far.
const AWAY: f64 = 0.010;

/// A striker that does not leave is lifted after this, s; after twice as long also if it still touches. *By ear*.
const LIFTED_AFTER: f64 = 0.3;

/// In a rimshot the bead meets the head so long before the shaft meets the rim, s: a head gives way by some
/// millimetres, and drummers aim for the rim below it. *By ear*.
const SHOT_LEAD: f64 = 0.8e-3;

/// What a surface is made from.
pub struct SurfaceParts {
    /// `[mode]`.
    pub modes: Vec<Mode>,
    /// Shapes of the modes.
    pub shapes: ShapeTable,
    /// How each mode is heard, `[mode]`; see [`Pickup::new`].
    pub transfer: Vec<[f64; 2]>,
    /// What the tip meets.
    pub material: Material,
    /// Whether contacts give back all they take, whatever the striker.
    pub lossless: bool,
    /// Hz.
    pub sample_rate: f64,
}

/// The surface and everything that touches it.
pub struct Surface {
    body: ModalBody,
    shapes: ShapeTable,
    pickup: Pickup,
    material: Material,
    lossless: bool,
    /// The head right under a tip, if the surface is one.
    film: Option<Film>,
    far_film: Option<Film>,
    /// Strikers, then groups of wires.
    touchers: Vec<Toucher>,
    /// Tip and shaft of every striker, then one point of every group.
    points: Vec<TouchPoint>,
    wires: Option<SnareWires>,
    rim: Option<RimBody>,
    /// Points present.
    live: [usize; MAX_POINTS],
    live_count: usize,
    /// What the body does beyond its modes.
    beyond: Option<NonlinearForce>,
    /// What it and the far head do above their modes; a place for each striker's point and each wire's.
    high: Option<HighBand>,
    far_high: Option<HighBand>,
    /// Between present points: one-sample compliance of the modes and of what touches, m/N.
    compliance: Compliances,
    /// Each present point's coupling with the force beyond the modes.
    coupling: [f64; MAX_POINTS],
    /// The compliance the points meet: the modes', stiffened by the force beyond them, m/N.
    yielding: Compliances,
    /// Energy that strikers have come with, and taken with them, J.
    brought_energy: f64,
    departed_energy: f64,
    last: StrikeSnapshot,
    dt: f64,
}

/// The rim and its motion.
struct RimBody {
    rim: Rim,
    body: ModalBody,
    pickup: Pickup,
}

/// Whose point it is.
const fn owner(point: usize) -> usize {
    if point < FIRST_WIRE { point / STRIKER_POINTS } else { MAX_STRIKERS + point - FIRST_WIRE }
}

/// The high band that listens to a point, of the near and the far one, and the point's place in it.
fn above<'a>(
    point: usize,
    near: &'a mut Option<HighBand>,
    far: &'a mut Option<HighBand>,
) -> (&'a mut Option<HighBand>, usize) {
    if point < FIRST_WIRE { (near, point) } else { (far, point - FIRST_WIRE) }
}

/// The points of a toucher.
const fn points_of(toucher: usize) -> std::ops::Range<usize> {
    if toucher < MAX_STRIKERS {
        STRIKER_POINTS * toucher..STRIKER_POINTS * (toucher + 1)
    } else {
        let point = FIRST_WIRE + toucher - MAX_STRIKERS;
        point..point + 1
    }
}

impl Surface {
    /// A surface at rest. Allocates.
    pub fn new(parts: SurfaceParts) -> Surface {
        let (count, dt) = (parts.modes.len(), 1.0 / parts.sample_rate);
        let body = ModalBody::new(parts.modes, parts.sample_rate);
        let mut pickup = Pickup::new(parts.transfer);
        body.tune(&mut pickup);
        Surface {
            body,
            shapes: parts.shapes,
            pickup,
            material: parts.material,
            lossless: parts.lossless,
            film: None,
            far_film: None,
            touchers: (0..MAX_STRIKERS).map(|_| Toucher::absent(dt)).collect(),
            points: (0..FIRST_WIRE).map(|_| TouchPoint::absent(count, dt)).collect(),
            wires: None,
            rim: None,
            live: [0; MAX_POINTS],
            live_count: 0,
            beyond: None,
            high: None,
            far_high: None,
            compliance: [[0.0; MAX_POINTS]; MAX_POINTS],
            coupling: [0.0; MAX_POINTS],
            yielding: [[0.0; MAX_POINTS]; MAX_POINTS],
            brought_energy: 0.0,
            departed_energy: 0.0,
            last: StrikeSnapshot::default(),
            dt,
        }
    }

    /// Lets a potential act on the first `modes`, evaluated once in `stride` samples. Allocates.
    pub fn set_potential(&mut self, potential: Box<dyn Potential>, modes: usize, stride: u32) {
        let force = NonlinearForce::new(potential, modes, stride, (&self.body, &self.pickup), 1.0 / self.dt);
        self.beyond = Some(force);
    }

    /// Lets high bands listen: the near one to strikers, the far one to wires.
    pub fn set_high_bands(&mut self, near: HighBand, far: Option<HighBand>) {
        (self.high, self.far_high) = (Some(near), far);
    }

    /// What the body does above its modes.
    pub fn high_band(&self) -> Option<&HighBand> {
        self.high.as_ref()
    }

    /// What the body and the far head do above their modes, to be retuned with them.
    pub fn high_bands_mut(&mut self) -> [Option<&mut HighBand>; 2] {
        [self.high.as_mut(), self.far_high.as_mut()]
    }

    /// Makes the surface a head that yields under a tip beyond its modes, and so the far one under wires;
    /// acts on whatever touches from now on.
    pub fn set_films(&mut self, near: Film, far: Option<Film>) {
        (self.film, self.far_film) = (Some(near), far);
    }

    /// Gives the drum snare wires; [`lay_wires`](Self::lay_wires) tells where. Allocates.
    pub fn set_wires(&mut self, head: &Material) {
        let wires = SnareWires::new(head, self.lossless, self.dt);
        let (preload, seat) = wires.seat();
        for _ in wires::PLACES {
            let mut point = TouchPoint::absent(self.body.len(), self.dt);
            point.arrive(Side::Surface, wires.law, [1.0, 0.0, 0.0, 0.0, 0.0]);
            (point.present, point.preload, point.seat) = (false, preload, seat);
            let mut group = Toucher::absent(self.dt);
            (group.parts[0], group.part_count) = (wires.group(self.lossless), 1);
            self.points.push(point);
            self.touchers.push(group);
        }
        self.wires = Some(wires);
    }

    /// Lays the wires against the far head of these shapes (positive along the stroke).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn lay_wires(&mut self, far: &ShapeTable) {
        let disc = self.far_film.map_or(0.0, |film| wires::PATCH / film.radius);
        for (point, [x, y]) in self.points.iter_mut().skip(FIRST_WIRE).zip(wires::PLACES) {
            let shape = point.port.shape_mut();
            far.fill_pressed(x.hypot(y), x.atan2(-y), disc, shape);
            // They lie on the other side: their way into the head is against the stroke.
            shape.iter_mut().for_each(|shape| *shape = -*shape);
        }
        if let Some(high) = &mut self.far_high {
            for (i, [x, y]) in wires::PLACES.into_iter().enumerate() {
                high.put(i, x.hypot(y), x.atan2(-y), wires::TURN);
            }
        }
        for i in FIRST_WIRE..self.points.len() {
            let position = self.touchers[owner(i)].position(&self.points[i].weights);
            let moved = position - self.body.displacement_at(&self.points[i].port);
            // A head of another shape lies elsewhere under the wires; the contact must not notice.
            let point = &mut self.points[i];
            point.origin = moved - (point.compression - point.seat) - point.bands_bent();
            if point.present {
                self.connect(i);
            }
        }
    }

    /// Gives the drum a rim that sticks can meet. Allocates.
    pub fn set_rim(&mut self, rim: Rim) {
        let modes: Vec<Mode> = rim.modes.iter().map(|mode| mode.mode).collect();
        for shaft in self.points[..FIRST_WIRE].iter_mut().skip(1).step_by(STRIKER_POINTS) {
            *shaft = TouchPoint::absent(modes.len(), self.dt);
        }
        let body = ModalBody::new(modes, 1.0 / self.dt);
        let mut pickup = Pickup::new(rim.modes.iter().map(|mode| mode.transfer).collect());
        body.tune(&mut pickup);
        self.rim = Some(RimBody { rim, body, pickup });
    }

    /// Throws the wires on or off.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn throw_wires(&mut self, on: bool) {
        if let Some(wires) = self.wires.as_mut().filter(|wires| wires.on != on) {
            wires.on = on;
            self.park_wires();
            if on && !self.body.is_still() {
                self.wake_wires();
            }
        }
    }

    /// Sets the force of the strainer, N; live.
    pub fn set_preload(&mut self, preload: f64) {
        let Some(wires) = &mut self.wires else {
            return;
        };
        wires.preload = preload.clamp(wires::PRELOAD.0, wires::PRELOAD.2);
        let (share, seat) = wires.seat();
        for point in &mut self.points[FIRST_WIRE..] {
            // What is measured from equilibrium stays; equilibrium itself moves.
            point.compression += seat - point.seat;
            (point.preload, point.seat) = (share, seat);
        }
    }

    /// Whether there are wires and they lie against the head.
    pub fn wires_on(&self) -> bool {
        self.wires.as_ref().is_some_and(|wires| wires.on)
    }

    /// The rim and its modes as they are, if there is one.
    pub fn rim(&self) -> Option<&Rim> {
        self.rim.as_ref().map(|rim| &rim.rim)
    }

    /// What the wires have done since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        let aloft = self.points.iter().skip(FIRST_WIRE).filter(|point| point.present && !point.touching);
        self.wires.as_ref().map_or_else(WireSnapshot::default, |wires| wires.snapshot(aloft.count() as u32))
    }

    /// Lets the wires lie still where they are.
    fn park_wires(&mut self) {
        if let Some(wires) = &mut self.wires {
            wires.parked = true;
            self.points[FIRST_WIRE..].iter_mut().for_each(|point| point.present = false);
            self.touchers[MAX_STRIKERS..].iter_mut().for_each(|group| group.present = false);
            self.list();
        }
    }

    /// Lets the wires move again, from the equilibrium they were left in.
    fn wake_wires(&mut self) {
        let Some(wires) = self.wires.as_mut().filter(|wires| wires.on && wires.parked) else {
            return;
        };
        wires.parked = false;
        let lambda = wires.resting_lambda();
        for i in FIRST_WIRE..self.points.len() {
            let point = &mut self.points[i];
            (point.present, point.touching, point.lambda) = (true, true, lambda);
            (point.compression, point.force) = (point.seat, point.preload);
            if let Some(film) = self.far_film {
                let (x, y) = (wires::PLACES[i - FIRST_WIRE][0], wires::PLACES[i - FIRST_WIRE][1]);
                (point.bands, point.band_count) =
                    film.bands(x.hypot(y), wires::PATCH, !self.lossless, self.dt);
            }
            let group = &mut self.touchers[owner(i)];
            group.present = true;
            group.parts[0].rest();
            self.points[i].origin = -self.body.displacement_at(&self.points[i].port);
        }
        self.list();
        for i in FIRST_WIRE..self.points.len() {
            self.connect(i);
        }
    }

    /// What the body does beyond its modes, if it does.
    pub fn beyond(&self) -> Option<&NonlinearForce> {
        self.beyond.as_ref()
    }

    /// Evaluates what the body does beyond its modes once in `stride` samples; for comparisons.
    pub fn set_stride(&mut self, stride: u32) {
        if let Some(force) = &mut self.beyond {
            force.set_stride(stride);
            force.follow(&self.body, &self.pickup);
        }
    }

    /// What the body does beyond its modes, to be set.
    pub fn beyond_mut(&mut self) -> Option<&mut NonlinearForce> {
        self.beyond.as_mut()
    }

    /// Energy of the body, J: of its modes, what it holds beyond them, its wires and its rim.
    pub fn energy(&self) -> f64 {
        let wires: f64 = self.present(MAX_STRIKERS..self.touchers.len());
        let rim = self.rim.as_ref().map_or(0.0, |rim| rim.body.energy());
        self.body.energy() + self.beyond.as_ref().map_or(0.0, NonlinearForce::energy) + wires + rim
    }

    /// True energy of the body beyond its modes, J, and the relative error of the variable that
    /// stands for it; slow, for tests.
    pub fn true_potential(&mut self) -> (f64, f64) {
        self.beyond.as_mut().map_or((0.0, 0.0), |force| force.true_energy(&self.body))
    }

    /// The modes and their motion.
    pub fn body(&self) -> &ModalBody {
        &self.body
    }

    /// The modes and their motion, to be looked at or set up by tests and tools.
    pub fn body_mut(&mut self) -> &mut ModalBody {
        &mut self.body
    }

    /// Shapes of the modes.
    pub fn shapes(&self) -> &ShapeTable {
        &self.shapes
    }

    /// Shapes of the modes, to be changed with them.
    pub fn shapes_mut(&mut self) -> &mut ShapeTable {
        &mut self.shapes
    }

    /// What the latest stroke's contact measured.
    pub fn last_strike(&self) -> StrikeSnapshot {
        self.last
    }

    /// Changes the modes while they ring; `mode(k, old)` gives the new one.
    ///
    /// # Real-time
    /// Linear in the number of modes, about 100 ns each.
    pub fn retune(&mut self, mode: impl Fn(usize, &Mode) -> Mode) {
        for k in 0..self.body.len() {
            let new = mode(k, &self.body.modes()[k]);
            self.body.set_mode(k, new);
        }
        self.body.tune(&mut self.pickup);
        if let Some(force) = &mut self.beyond {
            force.follow(&self.body, &self.pickup);
        }
        for n in 0..self.live_count {
            self.connect(self.live[n]);
        }
    }

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
            self.leave(i);
        }
        self.last = StrikeSnapshot {
            count: self.last.count.wrapping_add(1),
            speed: speed as f32,
            radius: radius as f32,
            angle: strike.angle as f32,
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
        let disc = self.film.map_or(0.0, |film| spec.patch / film.radius);
        self.shapes.fill_pressed(radius, strike.angle, disc, point.port.shape_mut());
        self.high.iter_mut().for_each(|high| high.put(tip, radius, strike.angle, spec.patch));
        if let Some(film) = self.film {
            (point.bands, point.band_count) = film.bands(radius, spec.patch, !self.lossless, self.dt);
        }
        point.origin = -self.body.displacement_at(&point.port);
        self.list();
        self.connect(tip);
        if let Some(force) = &mut self.beyond {
            force.wake();
        }
    }

    /// Lets a stick come down on head and rim, from the player's side; returns what its tip feels of it.
    fn lay_across(
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
    fn free_place(&self) -> usize {
        let rank = |&i: &usize| {
            let toucher = &self.touchers[i];
            let touching = self.points[points_of(i)].iter().any(|point| point.present && point.touching);
            (toucher.present, touching, std::cmp::Reverse(toucher.age))
        };
        (0..MAX_STRIKERS).min_by_key(rank).unwrap_or(0)
    }

    /// A striker leaves with what it holds.
    fn leave(&mut self, i: usize) {
        self.departed_energy += self.energy_of(i);
        self.touchers[i].present = false;
        self.points[points_of(i)].iter_mut().for_each(|point| point.present = false);
    }

    /// Energy of a toucher and its contacts, J.
    fn energy_of(&self, toucher: usize) -> f64 {
        let points = self.points[points_of(toucher)].iter().filter(|point| point.present);
        self.touchers[toucher].energy() + points.map(TouchPoint::energy).sum::<f64>()
    }

    /// Lists the points present.
    fn list(&mut self) {
        self.live_count = 0;
        for (i, _) in self.points.iter().enumerate().filter(|(_, point)| point.present) {
            self.live[self.live_count] = i;
            self.live_count += 1;
        }
    }

    /// Works out what the body tells point `i` and the others of each other.
    fn connect(&mut self, i: usize) {
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
            high.iter_mut().for_each(|high| high.complete(place, self.points[i].direct));
        }
        for &j in &self.live[..self.live_count] {
            let mut mutual = 0.0;
            if self.points[j].side == side {
                mutual = body.compliance(&self.points[j].port, &self.points[i].port);
            }
            if owner(i) == owner(j) {
                mutual +=
                    self.touchers[owner(i)].compliance(&self.points[i].weights, &self.points[j].weights);
            }
            self.compliance[i][j] = mutual;
            self.compliance[j][i] = mutual;
        }
    }

    /// Renders sound pressure at the pickup, Pa, overwriting `out`. At most
    /// [`MAX_RUN`](crate::modal::simd::MAX_RUN) samples.
    ///
    /// # Real-time
    /// Linear in modes times samples; a few times dearer while something touches, and by the cost
    /// of the potential while that acts.
    pub fn render(&mut self, out: &mut [f32]) {
        let mut done = 0;
        while self.live_count > 0 && done < out.len() {
            out[done] = self.step(done);
            done += 1;
        }
        let rest = &mut out[done..];
        let Surface { body, pickup, beyond, rim, .. } = self;
        match beyond {
            Some(force) if force.is_active() => {
                body.ring(force.front().length(), pickup, &mut *rest);
                for sample in rest.iter_mut() {
                    force.begin(body, pickup);
                    body.step_front(force.front());
                    force.free(body);
                    *sample += force.finish(body, 0.0) + body.listen_front(force.front(), pickup);
                }
            }
            _ => body.ring(0, pickup, &mut *rest),
        }
        if let Some(rim) = rim.as_mut().filter(|rim| !rim.body.is_still()) {
            let mut heard = [0.0; MAX_RUN];
            let heard = &mut heard[..rest.len()];
            rim.body.ring(0, &rim.pickup, heard);
            rest.iter_mut().zip(heard).for_each(|(sum, x)| *sum += *x);
        }
        self.high.iter_mut().chain(&mut self.far_high).for_each(|high| high.render(out));
    }

    /// One sample with something about; which of the run.
    fn step(&mut self, sample: usize) -> f32 {
        let mean = self.step_free();
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
            let position = self.touchers[owner(i)].position(&point.weights);
            point.free_flight(position - surface - point.origin, self.yielding[i][i], dt);
        }
        self.solve();
        let mut direct = 0.0;
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
                direct += force as f32 * point.direct;
                pressed += force * self.coupling[i];
                if point.side == Side::Surface {
                    let (high, place) = above(i, &mut self.high, &mut self.far_high);
                    high.iter_mut().for_each(|high| high.push(place, sample, force as f32));
                }
            }
        }
        if let Some(beyond) = self.beyond.as_mut().filter(|beyond| beyond.is_active()) {
            direct += beyond.finish(&mut self.body, pressed);
        }
        for &i in &self.live[..self.live_count] {
            let others = self.moved_by_others(i);
            let before = self.points[i].touching;
            self.points[i].finish(others);
            if let Some(wires) = self.wires.as_mut().filter(|_| i >= FIRST_WIRE) {
                wires.count(before, self.points[i].touching);
            }
        }
        if let Some(wires) = &mut self.wires {
            wires.age += 1;
        }
        self.watch_strikers();
        let rim = self.rim.as_ref().map_or(0.0, |rim| rim.body.listen(&rim.pickup));
        self.body.listen(&self.pickup) + rim + direct
    }

    /// How far the forces of all other points have brought point `i` out of the surface, m.
    fn moved_by_others(&self, i: usize) -> f64 {
        let others = self.live[..self.live_count].iter().filter(|&&j| j != i);
        others.map(|&j| self.yielding[i][j] * self.points[j].pressing()).sum()
    }

    /// Reports on the strikers, and lets go those that have left.
    fn watch_strikers(&mut self) {
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

    /// Lets the body step by itself; works out how what touches meets it. Returns what multiplies their
    /// coupling to give how far the force beyond the modes has moved the surface by itself.
    fn step_free(&mut self) -> f64 {
        self.yielding = self.compliance;
        let Some(force) = self.beyond.as_mut().filter(|force| force.is_active()) else {
            self.body.step();
            return 0.0;
        };
        let live = &self.live[..self.live_count];
        if force.begin(&mut self.body, &self.pickup) {
            for &i in live {
                if self.points[i].side == Side::Surface {
                    self.coupling[i] = force.coupling(&self.body, &self.points[i].port);
                }
            }
        }
        self.body.step();
        for &i in live {
            for &j in live {
                self.yielding[i][j] -= self.coupling[i] * self.coupling[j] / force.divisor();
            }
        }
        force.free(&self.body)
    }

    /// Forces of all contacts for this sample.
    fn solve(&mut self) {
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

    /// Energy of the strikers and of what their contacts hold, J.
    pub fn striker_energy(&self) -> f64 {
        self.present(0..MAX_STRIKERS)
    }

    /// Energy of those touchers that are there, J.
    fn present(&self, which: std::ops::Range<usize>) -> f64 {
        which.filter(|&i| self.touchers[i].present).map(|i| self.energy_of(i)).sum()
    }

    /// Kinetic energy that strikers have come with since the last reset, J.
    pub fn brought_energy(&self) -> f64 {
        self.brought_energy
    }

    /// Energy that strikers have taken away with them since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.departed_energy
    }

    /// Zeroes what has decayed to nothing; reports whether all is finite, and rests it if not.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn settle(&mut self) -> bool {
        self.body.flush_quiet();
        self.rim.iter_mut().for_each(|rim| rim.body.flush_quiet());
        self.beyond.iter_mut().for_each(NonlinearForce::settle);
        let high = self.high.iter_mut().chain(&mut self.far_high).all(HighBand::settle);
        let finite = high
            && self.body.is_finite()
            && self.rim.as_ref().is_none_or(|rim| rim.body.is_finite())
            && self.live[..self.live_count].iter().all(|&i| self.points[i].compression.is_finite());
        if !finite {
            self.reset();
        }
        let strikers = self.touchers[..MAX_STRIKERS].iter().any(|striker| striker.present);
        let moving = self.wires.as_ref().is_some_and(|wires| wires.on && !wires.parked);
        if moving && !strikers && self.energy() < wires::STILL {
            self.park_wires();
        }
        finite
    }

    /// Whether nothing moves and nothing is about.
    pub fn is_still(&self) -> bool {
        let high = self.high.iter().chain(&self.far_high).all(HighBand::is_still);
        let rim = self.rim.as_ref().is_none_or(|rim| rim.body.is_still());
        high && rim && self.live_count == 0 && self.body.is_still()
    }

    /// Puts everything to rest; strikers are gone.
    pub fn reset(&mut self) {
        self.body.reset();
        self.rim.iter_mut().for_each(|rim| rim.body.reset());
        self.beyond.iter_mut().for_each(NonlinearForce::reset);
        self.high.iter_mut().chain(&mut self.far_high).for_each(HighBand::reset);
        for toucher in &mut self.touchers {
            // Which place the next stroke takes hangs on all of these.
            (toucher.present, toucher.age) = (false, 0);
        }
        for point in &mut self.points {
            (point.present, point.touching) = (false, false);
        }
        self.list();
        self.park_wires();
        (self.brought_energy, self.departed_energy) = (0.0, 0.0);
    }
}

/// Adds this sample to what a stroke's contacts have measured.
fn report(last: &mut StrikeSnapshot, toucher: &Toucher, points: &[TouchPoint], dt: f64) {
    for point in points.iter().filter(|point| point.present && point.force > 0.0) {
        if point.step.before <= 0.0 {
            last.touches += 1;
        }
        last.contact_time = (toucher.age as f64 * dt) as f32;
        last.peak_force = last.peak_force.max(point.force as f32);
        last.impulse += (point.force * dt) as f32;
    }
    last.leaving_speed = toucher.leaving_speed() as f32;
}
