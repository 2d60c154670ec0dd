//! A round surface that is struck and heard: a modal body, its shapes, and the strikers about it.
//!
//! Displacement and force are positive along the stroke, into the surface. Each striker is a
//! point mass; both it and the body integrate a force held over the sample exactly, so a contact
//! is one scalar equation, and several at once a few sweeps of it (Gauss-Seidel: each contact is
//! solved with the others' forces held; it converges because a place yields more to its own force
//! than to another's).

use crate::contact::{ContactLaw, ContactStep, Material};
use crate::drum::high_band::HighBand;
use crate::modal::{ModalBody, Mode, Pickup, Port};
use crate::potential::{NonlinearForce, Potential};
use crate::shapes::ShapeTable;
use crate::snapshot::StrikeSnapshot;
use crate::strike::{Strike, StrikerSpec};

/// Strikers that can be about one surface at a time; the one that has been away longest gives way.
pub const MAX_STRIKERS: usize = 4;

/// A striker farther off than this has left for good, m. *By ear*: no head comes up so far.
const AWAY: f64 = 0.010;

/// A striker that neither leaves nor falls silent is lifted after this, s. *By ear*.
const LIFTED_AFTER: f64 = 0.3;

/// Sweeps over simultaneous contacts; they stop as soon as nothing changes.
const MAX_SWEEPS: usize = 40;

/// Relative change of a force below which it counts as found.
const SETTLED: f64 = 1e-12;

/// A striker at or near the surface.
struct StrikerState {
    /// Whether there is one.
    present: bool,
    spec: StrikerSpec,
    law: ContactLaw,
    port: Port,
    /// Pressure at the pickup at once per unit force, Pa/N.
    direct: f32,
    /// Position along the stroke, m; velocity, m/s.
    position: f64,
    velocity: f64,
    /// Overlap with the surface now, m.
    compression: f64,
    /// Loss of the present touch, s/m.
    lambda: f64,
    touching: bool,
    /// Samples since the stroke.
    age: u64,
    force: f64,
    step: ContactStep,
    /// Which stroke of the surface this was.
    stroke: u32,
}

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
    strikers: [StrikerState; MAX_STRIKERS],
    /// What the body does beyond its modes.
    beyond: Option<NonlinearForce>,
    /// What it does above its modes; a place for each striker.
    high: Option<HighBand>,
    /// Between present strikers: one-sample compliance of the body's modes, m/N.
    compliance: [[f64; MAX_STRIKERS]; MAX_STRIKERS],
    /// Each present striker's coupling with the force beyond the modes.
    coupling: [f64; MAX_STRIKERS],
    /// The compliance the strikers meet: the modes', stiffened by the force beyond them, m/N.
    yielding: [[f64; MAX_STRIKERS]; MAX_STRIKERS],
    any_present: bool,
    /// Kinetic energy that strikers have taken with them, J.
    departed_energy: f64,
    last: StrikeSnapshot,
    dt: f64,
}

impl Surface {
    /// A surface at rest. Allocates.
    pub fn new(parts: SurfaceParts) -> Surface {
        let count = parts.modes.len();
        let body = ModalBody::new(parts.modes, parts.sample_rate);
        let mut pickup = Pickup::new(parts.transfer);
        body.tune(&mut pickup);
        Surface {
            body,
            shapes: parts.shapes,
            pickup,
            material: parts.material,
            lossless: parts.lossless,
            strikers: std::array::from_fn(|_| StrikerState::absent(count)),
            beyond: None,
            high: None,
            compliance: [[0.0; MAX_STRIKERS]; MAX_STRIKERS],
            coupling: [0.0; MAX_STRIKERS],
            yielding: [[0.0; MAX_STRIKERS]; MAX_STRIKERS],
            any_present: false,
            departed_energy: 0.0,
            last: StrikeSnapshot::default(),
            dt: 1.0 / parts.sample_rate,
        }
    }

    /// Lets a potential act on the first `modes`, evaluated once in `stride` samples. Allocates.
    pub fn set_potential(&mut self, potential: Box<dyn Potential>, modes: usize, stride: u32) {
        let force = NonlinearForce::new(potential, modes, stride, (&self.body, &self.pickup), 1.0 / self.dt);
        self.beyond = Some(force);
    }

    /// Lets a high band listen to the strikers; it has [`MAX_STRIKERS`] places.
    pub fn set_high_band(&mut self, high: HighBand) {
        self.high = Some(high);
    }

    /// What the body does above its modes.
    pub fn high_band(&self) -> Option<&HighBand> {
        self.high.as_ref()
    }

    /// What the body does above its modes, to be retuned with them.
    pub fn high_band_mut(&mut self) -> Option<&mut HighBand> {
        self.high.as_mut()
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

    /// Energy of the body, J: of its modes and what it holds beyond them.
    pub fn energy(&self) -> f64 {
        self.body.energy() + self.beyond.as_ref().map_or(0.0, NonlinearForce::energy)
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
        for i in 0..MAX_STRIKERS {
            if self.strikers[i].present {
                self.connect(i);
            }
        }
    }

    /// Strikes at the next sample: the tip is just touching and moves at the stroke's speed.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn strike(&mut self, strike: &Strike) {
        let speed = strike.speed.clamp(0.0, Strike::MAX_SPEED);
        let radius = strike.radius.clamp(0.0, 1.0);
        let i = self.free_place();
        if self.strikers[i].present {
            self.departed_energy += self.strikers[i].energy();
        }
        self.last = StrikeSnapshot {
            count: self.last.count.wrapping_add(1),
            speed: speed as f32,
            radius: radius as f32,
            angle: strike.angle as f32,
            ..StrikeSnapshot::default()
        };
        let striker = &mut self.strikers[i];
        striker.spec = strike.striker.spec();
        let restitution = if self.lossless { 1.0 } else { striker.spec.restitution };
        striker.law = ContactLaw::new(&striker.spec.tip, &self.material, restitution);
        self.shapes.fill(radius, strike.angle, striker.port.shape_mut());
        if let Some(high) = &mut self.high {
            let patch = high.patch(striker.spec.mass, speed, striker.spec.tip.radius());
            high.put(i, radius, strike.angle, patch);
        }
        striker.present = true;
        striker.touching = false;
        striker.age = 0;
        striker.force = 0.0;
        striker.velocity = speed;
        striker.stroke = self.last.count;
        self.any_present = true;
        self.connect(i);
        let striker = &mut self.strikers[i];
        striker.position = self.body.displacement_at(&striker.port);
        striker.compression = 0.0;
        if let Some(force) = &mut self.beyond {
            force.wake();
        }
    }

    /// An empty place, or that of the striker which has been about longest without touching, or,
    /// if all touch, of the oldest.
    fn free_place(&self) -> usize {
        let rank =
            |striker: &StrikerState| (striker.present, striker.touching, std::cmp::Reverse(striker.age));
        (0..MAX_STRIKERS).min_by_key(|&i| rank(&self.strikers[i])).unwrap_or(0)
    }

    /// Works out what the body tells striker `i` and the others of each other.
    fn connect(&mut self, i: usize) {
        self.body.connect(&mut self.strikers[i].port);
        let port = &self.strikers[i].port;
        self.coupling[i] = self.beyond.as_ref().map_or(0.0, |force| force.coupling(&self.body, port));
        self.strikers[i].direct = self.pickup.direct_at(&self.body, &self.strikers[i].port);
        for j in 0..MAX_STRIKERS {
            if self.strikers[j].present {
                let mutual = self.body.compliance(&self.strikers[j].port, &self.strikers[i].port);
                self.compliance[i][j] = mutual;
                self.compliance[j][i] = mutual;
            }
        }
    }

    /// Renders sound pressure at the pickup, Pa, overwriting `out`. At most
    /// [`MAX_RUN`](crate::modal::simd::MAX_RUN) samples.
    ///
    /// # Real-time
    /// Linear in modes times samples; a few times dearer while a striker is about, and by the cost
    /// of the potential while that acts.
    pub fn render(&mut self, out: &mut [f32]) {
        let mut done = 0;
        while self.any_present && done < out.len() {
            out[done] = self.step(done);
            done += 1;
        }
        let rest = &mut out[done..];
        let Surface { body, pickup, beyond, .. } = self;
        match beyond {
            Some(force) if force.is_active() => {
                body.ring(force.front().length(), pickup, rest);
                for sample in rest {
                    force.begin(body, pickup);
                    body.step_front(force.front());
                    force.free(body);
                    *sample += force.finish(body, 0.0) + body.listen_front(force.front(), pickup);
                }
            }
            _ => body.ring(0, pickup, rest),
        }
        self.high.iter_mut().for_each(|high| high.render(out));
    }

    /// One sample with strikers about; which of the run.
    fn step(&mut self, sample: usize) -> f32 {
        let mean = self.step_free();
        let dt = self.dt;
        for (i, striker) in self.strikers.iter_mut().enumerate().filter(|(_, striker)| striker.present) {
            let surface = self.body.displacement_at(&striker.port) - self.coupling[i] * mean;
            striker.free_flight(surface, self.yielding[i][i], dt);
        }
        self.solve();
        let mut direct = 0.0;
        let mut forces = [0.0; MAX_STRIKERS];
        for (i, (force, striker)) in forces.iter_mut().zip(&self.strikers).enumerate() {
            if striker.present && striker.force > 0.0 {
                *force = striker.force;
                self.body.push(&striker.port, striker.force as f32);
                direct += striker.force as f32 * striker.direct;
                self.high.iter_mut().for_each(|high| high.push(i, sample, striker.force as f32));
            }
        }
        if let Some(beyond) = self.beyond.as_mut().filter(|beyond| beyond.is_active()) {
            let pressed = forces.iter().zip(&self.coupling).map(|(force, p)| force * p).sum();
            direct += beyond.finish(&mut self.body, pressed);
        }
        self.any_present = false;
        for (i, striker) in self.strikers.iter_mut().enumerate().filter(|(_, striker)| striker.present) {
            // Where the others' forces and its own have taken the surface.
            let yielded: f64 = forces.iter().zip(&self.yielding[i]).map(|(force, c)| force * c).sum();
            striker.advance(yielded, dt);
            if striker.stroke == self.last.count {
                striker.report(&mut self.last, dt);
            }
            self.any_present |= striker.present;
            if !striker.present {
                self.departed_energy += striker.energy();
            }
        }
        self.body.listen(&self.pickup) + direct
    }

    /// Lets the body step without strikers; works out how it meets them. Returns what multiplies their
    /// coupling to give how far the force beyond the modes has moved the surface by itself.
    fn step_free(&mut self) -> f64 {
        self.yielding = self.compliance;
        let Some(force) = self.beyond.as_mut().filter(|force| force.is_active()) else {
            self.body.step();
            return 0.0;
        };
        if force.begin(&mut self.body, &self.pickup) {
            for (coupling, striker) in self.coupling.iter_mut().zip(&self.strikers) {
                *coupling = if striker.present { force.coupling(&self.body, &striker.port) } else { 0.0 };
            }
        }
        self.body.step();
        for (row, a) in self.yielding.iter_mut().zip(self.coupling) {
            for (c, b) in row.iter_mut().zip(self.coupling) {
                *c -= a * b / force.divisor();
            }
        }
        force.free(&self.body)
    }

    /// Forces of all contacts for this sample: sweeps until none changes any more. A striker alone
    /// is done in one.
    fn solve(&mut self) {
        let present = self.strikers.iter().filter(|striker| striker.present).count();
        for _ in 0..if present > 1 { MAX_SWEEPS } else { 1 } {
            let mut changed = false;
            for i in 0..MAX_STRIKERS {
                if !self.strikers[i].present {
                    continue;
                }
                // A force of zero, as of those not present, pushes nothing.
                let others: f64 = (0..MAX_STRIKERS)
                    .filter(|&j| j != i && self.strikers[j].present)
                    .map(|j| self.yielding[i][j] * self.strikers[j].force)
                    .sum();
                let striker = &mut self.strikers[i];
                let step = ContactStep { free: striker.step.free - others, ..striker.step };
                let force = striker.law.force(&step);
                changed |= (force - striker.force).abs() > SETTLED * force;
                striker.force = force;
            }
            if !changed {
                break;
            }
        }
    }

    /// Kinetic energy of the strikers and energy held in their contacts, J.
    pub fn striker_energy(&self) -> f64 {
        self.strikers.iter().filter(|striker| striker.present).map(StrikerState::energy).sum()
    }

    /// Kinetic energy that strikers have taken away with them since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.departed_energy
    }

    /// Zeroes what has decayed to nothing; reports whether all is finite, and rests it if not.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn settle(&mut self) -> bool {
        self.body.flush_quiet();
        self.beyond.iter_mut().for_each(NonlinearForce::settle);
        let high = self.high.as_mut().is_none_or(HighBand::settle);
        let finite = high
            && self.body.is_finite()
            && self.strikers.iter().all(|striker| !striker.present || striker.position.is_finite());
        if !finite {
            self.reset();
        }
        finite
    }

    /// Whether nothing moves and nothing is about.
    pub fn is_still(&self) -> bool {
        !self.any_present && self.body.is_still() && self.high.as_ref().is_none_or(HighBand::is_still)
    }

    /// Puts everything to rest; strikers are gone.
    pub fn reset(&mut self) {
        self.body.reset();
        self.beyond.iter_mut().for_each(NonlinearForce::reset);
        self.high.iter_mut().for_each(HighBand::reset);
        for striker in &mut self.strikers {
            // Which place the next stroke takes hangs on all of these.
            (striker.present, striker.touching, striker.age) = (false, false, 0);
        }
        self.any_present = false;
        self.departed_energy = 0.0;
    }
}

impl StrikerState {
    /// Kinetic energy and energy held in the contact, J.
    fn energy(&self) -> f64 {
        0.5 * self.spec.mass * self.velocity.powi(2) + self.law.potential(self.compression)
    }

    fn absent(modes: usize) -> StrikerState {
        let spec = crate::strike::Striker::Stick.spec();
        StrikerState {
            present: false,
            spec,
            law: ContactLaw::new(&spec.tip, &Material::FILM, spec.restitution),
            port: Port::new(modes),
            direct: 0.0,
            position: 0.0,
            velocity: 0.0,
            compression: 0.0,
            lambda: 0.0,
            touching: false,
            age: 0,
            force: 0.0,
            step: ContactStep { before: 0.0, free: 0.0, compliance: 0.0, lambda: 0.0, dt: 1.0 },
            stroke: 0,
        }
    }

    /// Prepares the sample's contact: where the striker and the surface would be without a force.
    fn free_flight(&mut self, surface: f64, body_compliance: f64, dt: f64) {
        self.position += self.velocity * dt;
        let free = self.position - surface;
        if !self.touching && free > 0.0 {
            let approach = (free - self.compression) / dt;
            self.lambda = self.law.lambda(approach);
        }
        let compliance = body_compliance + dt * dt / (2.0 * self.spec.mass);
        self.step = ContactStep { before: self.compression, free, compliance, lambda: self.lambda, dt };
        self.force = 0.0;
    }

    /// Applies the force; `yielded` is how far all forces have moved the surface here.
    fn advance(&mut self, yielded: f64, dt: f64) {
        let own = dt * dt / (2.0 * self.spec.mass);
        self.position -= own * self.force;
        self.velocity -= self.force * dt / self.spec.mass;
        self.compression = self.step.free - yielded - own * self.force;
        self.touching = self.compression > 0.0;
        self.age += 1;
        let gone = self.compression < -AWAY;
        let lifted = !self.touching && self.age as f64 * dt > LIFTED_AFTER;
        self.present = !(gone || lifted);
    }

    /// Adds this sample to what the stroke's contact has measured.
    fn report(&self, last: &mut StrikeSnapshot, dt: f64) {
        if self.force > 0.0 {
            if self.step.before <= 0.0 {
                last.touches += 1;
            }
            last.contact_time = (self.age as f64 * dt) as f32;
            last.peak_force = last.peak_force.max(self.force as f32);
            last.impulse += (self.force * dt) as f32;
        }
        last.leaving_speed = -self.velocity as f32;
    }
}
