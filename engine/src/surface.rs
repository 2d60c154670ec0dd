//! A round surface that is struck and heard: a modal body, its shapes, and what touches it.
//!
//! Displacement and force are positive along the stroke, into the surface. Whatever touches is a few
//! oscillators ([`touch`]); both they and the body integrate a force held over the sample exactly, so a contact
//! is one scalar equation, and several at once (`together`) a small system of them.
//!
//! ```text
//! strikers (tip, shaft) --\                      /--> modes --> pickup --> pressure
//! wires (8 groups) --------+--> contacts, solved -+--> rim ---> pickup --/
//! stretch, coupling -------/    together
//! ```

pub mod air;
pub mod oscillator;
mod paired;
pub mod patch;
mod sample;
mod striking;
pub mod together;
pub mod touch;
pub mod wires;

use crate::contact::Material;
use crate::hi_hat::pair::Pair;
use crate::high_band::HighBand;
use crate::modal::faint::Faint;
use crate::modal::simd::MAX_RUN;
use crate::modal::{EARS, ModalBody, Mode, Pickup};
use crate::potential::{NonlinearForce, Potential};
use crate::rim::Rim;
use crate::shapes::ShapeTable;
use crate::snapshot::StrikeSnapshot;

use air::{Incident, Listener};
use patch::Film;
use together::Compliances;
use touch::{TouchPoint, Toucher};
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

/// What a surface is made from.
pub struct SurfaceParts {
    /// `[mode]`.
    pub modes: Vec<Mode>,
    /// Shapes of the modes.
    pub shapes: ShapeTable,
    /// How each mode is heard, Pa s2/m of its acceleration, `[mode]`; see [`Pickup::new`].
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
    /// Below what its modes may sleep.
    faint: Faint,
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
    /// What the surrounding air presses on.
    listener: Option<Listener>,
    /// Points present.
    live: [usize; MAX_POINTS],
    live_count: usize,
    /// What the body does beyond its modes.
    beyond: Option<NonlinearForce>,
    /// What it and the far head do above their modes; a place for each striker's point and each wire's.
    high: Option<HighBand>,
    far_high: Option<HighBand>,
    /// Another surface underneath.
    pair: Option<Box<Pair>>,
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
    /// Strikers that had to make room for others before they had left.
    hurried: u32,
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
            faint: Faint::new(body.len()),
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
            listener: None,
            live: [0; MAX_POINTS],
            live_count: 0,
            beyond: None,
            high: None,
            far_high: None,
            pair: None,
            compliance: [[0.0; MAX_POINTS]; MAX_POINTS],
            coupling: [0.0; MAX_POINTS],
            yielding: [[0.0; MAX_POINTS]; MAX_POINTS],
            brought_energy: 0.0,
            departed_energy: 0.0,
            last: StrikeSnapshot::default(),
            hurried: 0,
            dt,
        }
    }

    /// Lets a potential act on the first `modes`, evaluated once in `stride` samples. Allocates.
    pub fn set_potential(&mut self, potential: Box<dyn Potential>, modes: usize, stride: u32) {
        let force = NonlinearForce::new(potential, modes, stride, (&self.body, &self.pickup), 1.0 / self.dt);
        self.beyond = Some(force);
        self.learn_faint();
    }

    /// Works out below what modes may sleep: those that neither the air nor what is beyond the modes drives.
    fn learn_faint(&mut self) {
        let coupled = self.beyond.as_ref().map_or(0, |force| force.front().length());
        let driven = self.listener.as_ref().map(Listener::port);
        self.body.learn_faint(&mut self.faint, &self.pickup, coupled, driven);
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

    /// Gives the drum a rim that sticks can meet. Allocates.
    pub fn set_rim(&mut self, rim: Rim) {
        let modes: Vec<Mode> = rim.modes.iter().map(|mode| mode.mode).collect();
        for shaft in self.points[..FIRST_WIRE].iter_mut().skip(1).step_by(STRIKER_POINTS) {
            *shaft = TouchPoint::absent(modes.len(), self.dt);
        }
        let body = ModalBody::new(modes, 1.0 / self.dt);
        let mut pickup = Pickup::new(rim.modes.iter().map(|mode| mode.transfer).collect());
        for (far, mode) in pickup.transfer_mut(1).iter_mut().zip(&rim.modes) {
            *far = mode.far_transfer;
        }
        body.tune(&mut pickup);
        self.rim = Some(RimBody { rim, body, pickup });
    }

    /// The rim and its modes as they are, if there is one.
    pub fn rim(&self) -> Option<&Rim> {
        self.rim.as_ref().map(|rim| &rim.rim)
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
        let rim = rim + self.pair.as_ref().map_or(0.0, |pair| pair.energy());
        self.body.energy() + self.beyond.as_ref().map_or(0.0, NonlinearForce::energy) + wires + rim
    }

    /// Energy of the motion, J. Wires against a head that was tuned meanwhile may hold it bent for good, which nothing is
    /// heard of.
    pub fn motion(&self) -> f64 {
        let wires: f64 =
            self.touchers[MAX_STRIKERS..].iter().filter(|group| group.present).map(Toucher::motion).sum();
        let rim = self.rim.as_ref().map_or(0.0, |rim| rim.body.motion());
        let pair = self.pair.as_ref().map_or(0.0, |pair| pair.energy());
        self.body.motion()
            + self.beyond.as_ref().map_or(0.0, |force| force.energy().abs())
            + wires
            + rim
            + pair
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

    /// Strikers that were taken away before they had left, for there are places for [`MAX_STRIKERS`] at a time.
    pub fn hurried_strikers(&self) -> u32 {
        self.hurried
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
        self.follow_modes();
    }

    /// Changes how each mode is heard from near, as in [`SurfaceParts::transfer`], and from far away, as at a metre;
    /// what rings is heard so at once.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn set_transfers(
        &mut self,
        near: impl Iterator<Item = [f64; 2]>,
        far: impl Iterator<Item = [f64; 2]>,
    ) {
        self.pickup.transfer_mut(0).iter_mut().zip(near).for_each(|(place, transfer)| *place = transfer);
        self.pickup.transfer_mut(1).iter_mut().zip(far).for_each(|(place, transfer)| *place = transfer);
        self.follow_volumes();
        self.follow_modes();
    }

    /// Tells everything that hangs on the modes, or on how they are heard, that they have changed.
    fn follow_modes(&mut self) {
        self.body.tune(&mut self.pickup);
        self.learn_faint();
        if let Some(force) = &mut self.beyond {
            force.follow(&self.body, &self.pickup);
        }
        if let Some(pair) = &mut self.pair {
            pair.follow(&self.body, &self.pickup);
        }
        if let Some(listener) = &mut self.listener {
            listener.connect(&self.body, &self.pickup);
        }
        for n in 0..self.live_count {
            self.connect(self.live[n]);
        }
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

    /// Renders sound pressure at each ear, Pa, overwriting `out`, while sound from elsewhere arrives: at the listening
    /// point, far away as at a metre, and as far as it goes all around, what other pieces hear. At most
    /// [`MAX_RUN`] samples.
    ///
    /// # Real-time
    /// Linear in modes times samples; a few times dearer while something touches, and by the cost
    /// of the potential while that acts.
    pub fn render_in_air(&mut self, mut out: [&mut [f32]; EARS], incident: Option<Incident<'_>>) {
        let mut done = 0;
        let together = self.pair.as_ref().is_some_and(|pair| pair.is_engaged());
        while (self.live_count > 0 || together) && done < out[0].len() {
            let heard = self.step(done, incident);
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[done] = heard);
            done += 1;
        }
        self.ring(out.each_mut().map(|out| &mut out[done..]), incident, done);
        if let Some(pair) = self.pair.as_mut().filter(|_| !together) {
            pair.ring(&mut out, done);
        }
        let [near, far, _] = out;
        self.high.iter_mut().chain(&mut self.far_high).for_each(|high| high.render(near, far));
    }

    /// Renders while nothing touches, from sample `from` of what arrives on.
    fn ring(&mut self, mut out: [&mut [f32]; EARS], incident: Option<Incident<'_>>, from: usize) {
        let samples = out[0].len();
        let Surface { body, pickup, beyond, rim, listener, .. } = self;
        let pressed = listener.as_ref().zip(incident);
        let drive = pressed.and_then(|(listener, incident)| listener.drive(incident, from));
        match beyond {
            Some(force) if force.is_active() => {
                let first = force.front().length();
                body.ring_driven(first, drive.into_iter(), pickup, out.each_mut().map(|out| &mut **out));
                force.ring(body, pickup, drive, &mut out);
            }
            _ => body.ring_driven(0, drive.into_iter(), pickup, out.each_mut().map(|out| &mut **out)),
        }
        if let Some((listener, incident)) = pressed {
            for (i, &pressure) in incident[from..].iter().enumerate() {
                out.iter_mut().zip(listener.echo(pressure)).for_each(|(out, echo)| out[i] += echo);
            }
        }
        if let Some(rim) = rim.as_mut().filter(|rim| !rim.body.is_still()) {
            let mut heard = [[0.0; MAX_RUN]; EARS];
            rim.body.ring(0, &rim.pickup, heard.each_mut().map(|row| &mut row[..samples]));
            for (out, heard) in out.iter_mut().zip(&heard) {
                out.iter_mut().zip(heard).for_each(|(sum, x)| *sum += x);
            }
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
        // What touches may drive modes, by less in a block than what could be forgotten.
        match self.live_count == 0 && self.pair.is_none() && !self.lossless {
            true => self.body.flush_faint(&self.faint),
            false => self.body.flush_quiet(),
        }
        self.rim.iter_mut().for_each(|rim| rim.body.flush_quiet());
        self.beyond.iter_mut().for_each(NonlinearForce::settle);
        let high = self.high.iter_mut().chain(&mut self.far_high).all(HighBand::settle);
        let finite = high
            && self.body.is_finite()
            && self.rim.as_ref().is_none_or(|rim| rim.body.is_finite())
            && self.live[..self.live_count].iter().all(|&i| self.points[i].compression.is_finite());
        let strikers = self.is_struck();
        let finite = finite && self.settle_pair(strikers);
        if !finite {
            self.reset();
        }
        if !strikers && self.beyond.as_ref().is_some_and(NonlinearForce::is_inside_out) {
            // Turned back, as a drummer would; what it still trembles by is cut off.
            self.rest();
        }
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
        let pair = self.pair.as_ref().is_none_or(|pair| pair.is_still());
        high && rim && pair && self.live_count == 0 && self.body.is_still()
    }

    /// Whether strikers are about.
    pub fn is_struck(&self) -> bool {
        self.touchers[..MAX_STRIKERS].iter().any(|striker| striker.present)
    }

    /// Puts everything to rest as [`reset`](Self::reset) does; what was counted stays.
    pub fn rest(&mut self) {
        let counted = (self.brought_energy, self.departed_energy);
        self.reset();
        (self.brought_energy, self.departed_energy) = counted;
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
        self.pair.iter_mut().for_each(|pair| pair.reset());
        (self.brought_energy, self.departed_energy) = (0.0, 0.0);
    }
}
