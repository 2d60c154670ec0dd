//! What a head does above its complete set of modes, where they crowd too closely to be told apart.
//!
//! Model: from the top of the complete set on, each slice of 1/300 octave (1/900 of a drum with wires) is one mode that stands for the
//! `count` real ones in it, on small heads less than one at first: a random plane wave and its mirror image at the rim, as a diffuse field at a clamped edge
//! is made of; their difference has unit mean square and is zero at the rim. It weighs `M / count`, so that
//! a force sets going as much energy as it would in all of them, and is heard by `sqrt(count)` less than
//! one mode so moved would be, for real modes do not add in step. Such modes lose their common phase in the inverse of the
//! slice's width, so the phase of the one that stands for them walks at random (`walk.rs`), which costs no energy. It listens to
//! the contact force and does not push back: the complete set does that. It does not stretch the head, and its frequencies follow the tension of the stretched head
//! as those of complete modes do ([`HighBand::glide`]).
//!
//! With `k` the wavenumber, `s` the film's mass per area, `z` the air on one face,
//!
//! ```text
//! omega^2 (s + 2 Re z) = T k^2 + D k^4      z = rho / sqrt(k^2 - (omega/c)^2 - i eta)
//! sigma = film(omega) + edge(omega) + A omega Im z / (2 (s + 2 Re z))      eta = 4 omega / (pi c a)
//! ```
//!
//! `z` is that of an endless head; `eta` gives it what a head of radius `a` radiates by its rim (below),
//! and keeps it finite where a wave on the head is as fast as sound. `A` is what a drum's head loses to the air more than that, on both sides and
//! to what lies behind it: the mean over the complete modes of the last third of an octave below
//! ([`HighBandSpec::losing_as`]). It is 2 and 6 of the toms, 6 of the snare drum and 30 of the kick, whose slack head by itself gives next to nothing to
//! the air.
//!
//! Count: `N(k) = (k a)^2 / 4 - k a / 2` (Weyl, clamped). What is heard: of the modes about `k` in a baffle the mean square
//! of `int W e^(i x) dA`, over all of them and all directions, is with `j = k a`, `u = (omega a / c) sin`
//!
//! ```text
//! 8 pi a^4 j / (j^2 - u^2)^2
//! ```
//!
//! which follows from their Hankel transforms (see [`air_load`](crate::air_load)), the density of Bessel zeros and
//! `J_0^2 + 2 sum J_m^2 = 1`. It is what the strip along the rim sends out; the point hears it from the rim's
//! distances, by chance in any phase.
//!
//! Contact: a tip presses evenly on the head, a soft one over a patch that grows with the force.
//! An even pressure moves a wave by `2 J_1(k b) / (k b)`; averaged over the areas a stroke goes through, up to its
//! largest patch of radius `b`, that is `4 (1 - J_0(k b)) / (k b)^2`.
//!
//! Direct sound: a force moves an endless sheet with the acceleration `F / s` under it, at once, and from a distance `d`
//! that is heard as `rho F / (2 pi s d)`: waves on the head are slower than sound, so that what radiates at some
//! frequency are modes that ring far below it and only weigh. Each mode's share belongs to the mode (see
//! [`ReceiverWeights`]); complete modes and slices share none, so nothing is counted twice, and the slices' adds up by
//! chance, some 16 dB below. The complete modes' shares are right where each rings, with the air it carries there and
//! with the sound going around the drum's body. Faster than about `omega a / c = sqrt 2` the air no longer rides along and the body
//! is a baffle: what they lack of the sheet (two thirds, of a drum that stands free; *converged*) follows the force through a
//! high-pass filter of first order from there.
//!
//! A head that stretches scatters some of its energy into the slices (`scattering.rs`).
//!
//! A [dot](crate::membrane::dot) takes its share of the losses by its area, weighs where it is struck directly, and gives way to a force as
//! an endless head of its thickness does; that waves on it are of another speed is neglected.
//!
//! Limits: a chance shape per slice is right for the mean over slices and places, not for one. All slices lose alike: of real modes at one frequency
//! those of low orders radiate more than others and are sooner over, as far as orders do not mix.
//!
//! Source: Weyl's law as in Rossing & Fletcher, Principles of Vibration and Sound, ch. 3; Cremer, Heckl &
//! Petersson, Structure-Borne Sound, ch. 6 (radiation of bending waves at an edge). The mean square is derived here.

mod force_sums;
mod muffling;
mod point_band;
mod scattering;
mod slices;
mod walk;

use std::f64::consts::{SQRT_2, TAU};

use crate::air_load::SPEED_OF_SOUND;
use crate::modal::inaudible_modes::InaudibleModes;
use crate::modal::simd::MAX_RUN;
use crate::modal::smoothing::Smoothing;
use crate::modal::{MAX_DRIVES, ModalBody, Mode, RECEIVERS, ReceiverWeights};

use crate::receiver::POINTS;

use force_sums::{ForceSums, interleaved};
pub use muffling::HighMuffling;
use muffling::UnderPad;
use point_band::PointBand;
use scattering::Scattering;
pub use slices::{HighBandSpec, Receiver, SLICES, SLICES_UNDER_WIRES};
use slices::{
    Slice, SliceTable, TunedSlice, Waves, away, endless_sheet, lies_on_dot, rim_strip, slices, taken,
    tension_share, top_hz, walk_rate,
};
use walk::Walk;

/// The slow part of a force below this is nothing, N: 200 dB under a soft stroke.
const FAINT: f32 = 1e-10;

/// A slice fades from full to nothing over this ratio above the top, so that tuning takes it out softly.
const FADE: f64 = 1.03;

/// A slice as the present tension has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceInfo {
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate, 1/s.
    pub sigma: f64,
    /// Modal mass, kg.
    pub mass: f64,
    /// Area of the monopole in a baffle that would be heard as loud, m2.
    pub monopole_area: f64,
}

/// What the slices last followed.
struct Laid {
    /// The slices at every tension, without muffling.
    table: SliceTable,
    /// N/m.
    tension: f64,
    muffling: HighMuffling,
    under: UnderPad,
    /// The modes at that tension, without muffling.
    modes: Vec<Mode>,
    inaudible: InaudibleModes,
}

/// Places that forces can act on.
struct Places {
    all: Vec<PointBand>,
    /// What the slices take if the places are far apart.
    sums: Option<ForceSums>,
}

impl Places {
    /// The places of a band of so many slices. Allocates.
    fn new(spec: &HighBandSpec, slices: usize) -> Places {
        let most = if spec.apart { force_sums::MOST } else { MAX_DRIVES };
        Places {
            all: (0..spec.places.min(most)).map(|_| PointBand::new(slices)).collect(),
            sums: spec.apart.then(|| ForceSums::new(slices)),
        }
    }

    /// Follows the slices.
    fn connect(&mut self, body: &ModalBody, pickup: &ReceiverWeights) {
        match &mut self.sums {
            Some(sums) => sums.stale = true,
            None => self.all.iter_mut().for_each(|place| place.connect(body, pickup)),
        }
    }

    /// Follows the shapes at place `i`.
    fn connect_one(&mut self, i: usize, body: &ModalBody, pickup: &ReceiverWeights) {
        match &mut self.sums {
            Some(sums) => sums.stale = true,
            None => self.all[i].connect(body, pickup),
        }
    }

    /// Advances the slices through a run under the forces at the places, and listens.
    fn ring(&mut self, body: &mut ModalBody, pickup: &ReceiverWeights, heard: &mut [&mut [f32]; RECEIVERS]) {
        let mut pressed = self.all.iter().filter(|place| place.pressed).peekable();
        match &mut self.sums {
            Some(sums) if pressed.peek().is_some() => sums.ring(&self.all, (body, pickup), heard),
            _ => {
                let drives = pressed.map(|place| (&place.port, &place.forces[..]));
                body.ring_driven(0, drives, pickup, heard.each_mut().map(|row| &mut **row));
            }
        }
    }
}

/// The high band of one head.
pub struct HighBand {
    spec: HighBandSpec,
    body: ModalBody,
    pickup: ReceiverWeights,
    slices: Vec<Slice>,
    waves: Waves,
    laid: Laid,
    places: Places,
    /// How far the slow part of a force follows it in a sample.
    follow: f32,
    /// Loudness at each point over that at the near one: far away, as at a metre.
    gains: [f32; POINTS],
    /// Steps of the sound by retuning.
    smoothing: Smoothing,
    /// What a stretched head hands to it.
    scattering: Scattering,
    /// How their frequencies move: the phases' random walk, and the tension.
    walk: Walk,
    /// Whether anything moves.
    rings: bool,
    /// Whether a force has acted in the present block.
    loaded: bool,
}

impl HighBand {
    /// The band at rest, at the tension it is laid out for. Allocates.
    pub fn new(spec: &HighBandSpec) -> HighBand {
        let slices = if spec.apart { interleaved(slices(spec)) } else { slices(spec) };
        let table = SliceTable::new(spec, &slices);
        let modes: Vec<Mode> = table.at(spec.tensions[1]).map(|slice| slice.mode).collect();
        let count = modes.len();
        let corner = SQRT_2 * SPEED_OF_SOUND / spec.head.radius;
        let away = away(spec, &slices);
        let body = ModalBody::new(modes.clone(), spec.sample_rate);
        let mut band = HighBand {
            gains: std::array::from_fn(|point| if point == 0 { 1.0 } else { away[point - 1] }),
            spec: *spec,
            scattering: Scattering::new(spec, &slices, &body),
            body,
            pickup: ReceiverWeights::new(vec![[0.0; 2]; count]),
            laid: Laid {
                table,
                tension: 0.0,
                muffling: HighMuffling::NONE,
                under: UnderPad::new(count),
                modes,
                inaudible: InaudibleModes::new(count),
            },
            waves: Waves::new(spec, &slices),
            slices,
            places: Places::new(spec, count),
            follow: (1.0 - (-corner / spec.sample_rate).exp()) as f32,
            smoothing: Smoothing::default(),
            walk: Walk::new(count, spec.seed, spec.sample_rate),
            rings: false,
            loaded: false,
        };
        band.body.allow_detuning();
        band.retune(spec.tensions[1], &HighMuffling::NONE);
        band
    }

    /// Follows the head's tension (N/m) and muffling.
    ///
    /// # Real-time
    /// No allocation; some 60 ns a slice if the tension has changed, 20 ns if not.
    pub fn retune(&mut self, tension: f64, muffling: &HighMuffling) {
        if (tension, *muffling) == (self.laid.tension, self.laid.muffling) {
            return;
        }
        let before = self.body.listen(&self.pickup);
        if tension != self.laid.tension {
            self.lay(tension);
        }
        self.laid.muffling = *muffling;
        let HighBand { spec, body, pickup, slices, smoothing, laid, places, scattering, .. } = self;
        let Laid { under, modes, inaudible, .. } = laid;
        let under = under.of(muffling, slices);
        let held = |k: usize| if spec.lossless { 0.0 } else { muffling.sigma(under[k]) };
        body.set_modes(|k, _| Mode { sigma: modes[k].sigma + held(k), ..modes[k] });
        body.tune(pickup);
        scattering.follow();
        body.update_thresholds(inaudible, pickup, 0, None);
        smoothing.step(before, body.listen(pickup));
        places.connect(body, pickup);
    }

    /// Brings what follows from the head's tension (N/m) to it.
    fn lay(&mut self, tension: f64) {
        let HighBand { spec, pickup, slices, walk, gains, laid, .. } = self;
        let Laid { table, modes, .. } = laid;
        laid.tension = tension;
        let top = top_hz(spec.sample_rate);
        for (k, (slice, TunedSlice { mode, loudness })) in slices.iter().zip(table.at(tension)).enumerate() {
            modes[k] = mode;
            let rise = mode.omega * tension_share(spec, slice, tension) / (2.0 * tension);
            walk.set(k, walk_rate(spec, slice, mode.omega), rise);
            let fade = 1.0 - ((mode.omega / (TAU * top) - 1.0) / (FADE - 1.0)).clamp(0.0, 1.0);
            let loud = fade * loudness;
            for (receiver, ([cos, sin], gain)) in slice.heard.into_iter().zip(&*gains).enumerate() {
                let loud = f64::from(*gain) * loud;
                pickup.transfer_mut(receiver)[k] = [loud * cos, loud * sin];
            }
        }
    }

    /// Places that forces can act on.
    pub fn places(&self) -> usize {
        self.places.all.len()
    }

    /// Puts place `i` somewhere: distance from the centre as a share of the radius, direction in rad, and the
    /// radius (m) of the largest patch that is pressed on.
    ///
    /// # Real-time
    /// No allocation; some 5 ns a slice.
    pub fn put(&mut self, i: usize, radius: f64, angle: f64, patch: f64) {
        let HighBand { spec, body, pickup, slices, waves, places, scattering, .. } = self;
        body.end_detuning();
        scattering.meet(patch);
        let place = &mut places.all[i];
        place.sheet = endless_sheet(spec, slices, radius, angle) as f32;
        let known = waves.pressed.of(patch);
        let shape = place.port.shape_mut();
        body.kernels().vectorized(
            #[inline(always)]
            || waves.fill(radius, angle, shape),
        );
        for (k, (shape, slice)) in shape.iter_mut().zip(&*slices).enumerate() {
            *shape *= known.map_or_else(|| taken(spec, slice, patch), |known| known[k]) as f32;
        }
        if lies_on_dot(&spec.head, radius) {
            shape.iter_mut().zip(&*slices).for_each(|(shape, slice)| *shape *= slice.on_dot as f32);
        }
        places.connect_one(i, body, pickup);
    }

    /// Tells place `i` what the complete set's pressure is at once per unit force there, Pa/N.
    pub fn complete(&mut self, i: usize, direct: f32) {
        let place = &mut self.places.all[i];
        place.lacking = place.sheet - direct;
    }

    /// A force (N) on place `i`, held over a sample of the present run.
    ///
    /// # Panics
    /// If the sample is not below [`MAX_RUN`].
    pub fn push(&mut self, i: usize, sample: usize, force: f32) {
        self.places.all[i].forces[sample] = force;
        self.places.all[i].pressed |= force != 0.0;
        self.loaded |= force != 0.0;
    }

    /// Ends the run: adds its sound to what is heard at each point, Pa, at most [`MAX_RUN`] samples.
    ///
    /// # Real-time
    /// Linear in slices times samples times places pressed; nothing at rest.
    pub fn render(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        let HighBand { body, pickup, places, follow, rings, gains, smoothing, .. } = self;
        *rings |= places.all.iter().any(|place| place.pressed);
        if !*rings {
            return;
        }
        let mut sounds = [[0.0; MAX_RUN]; RECEIVERS];
        let mut heard = sounds.each_mut().map(|row| &mut row[..out[0].len()]);
        places.ring(body, pickup, &mut heard);
        smoothing.add_to(&mut heard);
        for place in places.all.iter_mut().filter(|place| place.pressed || place.slow != 0.0) {
            place.add_direct(*follow, gains, &mut heard);
            if std::mem::take(&mut place.pressed) {
                place.forces.fill(0.0);
            }
        }
        for (out, heard) in out.iter_mut().zip(&heard).take(POINTS) {
            out.iter_mut().zip(&**heard).for_each(|(out, heard)| *out += heard);
        }
    }

    /// Zeroes what has decayed to nothing; reports whether all is finite.
    ///
    /// # Real-time
    /// Linear in the number of slices; meant for once a block.
    pub fn settle(&mut self) -> bool {
        if self.rings {
            self.body.flush_inaudible(&self.laid.inaudible);
            for place in self.places.all.iter_mut().filter(|place| place.slow.abs() < FAINT) {
                place.slow = 0.0;
            }
            self.rings = !self.body.is_still()
                || !self.smoothing.is_over()
                || self.places.all.iter().any(|place| place.slow != 0.0);
            if !self.rings {
                self.body.end_detuning();
                self.walk.reset();
                self.scattering.rewind();
            }
        }
        self.body.is_finite() && self.places.all.iter().all(|place| place.slow.is_finite())
    }

    /// Lets the slices follow a tension (N/m) that is added to the head's for the next block, and their phases take a step. While a force acts they
    /// turn by their equation: what it holds bent must not be turned into motion.
    ///
    /// # Real-time
    /// Linear in the number of slices; nothing at rest.
    pub fn glide(&mut self, added: f64) {
        if std::mem::take(&mut self.loaded) || !self.rings {
            return self.body.end_detuning();
        }
        let shifts = self.walk.step(self.body.kernels(), added as f32);
        self.body.shift_frequencies(0, &shifts[..self.slices.len()]);
    }

    /// Takes what the head, stretched by an energy (J), scatters into it in a block of the kinetic energy (J) of its modes.
    /// Returns it, J.
    ///
    /// # Real-time
    /// Linear in the number of slices; nothing if it is next to nothing.
    pub fn scatter(&mut self, stretched: f64, kinetic: f64) -> f64 {
        let given = self.scattering.scatter((stretched, kinetic), self.laid.tension, &mut self.body);
        self.rings |= given > 0.0;
        given
    }

    /// Energy that the head has scattered into it since the last reset, J.
    pub fn scattered(&self) -> f64 {
        self.scattering.given()
    }

    /// Sets `R` of what the head scatters, dimensionless; 0 for nothing. For comparisons.
    pub fn set_scattering(&mut self, rate: f64) {
        self.scattering.set_rate(rate);
    }

    /// Whether nothing moves.
    pub fn is_still(&self) -> bool {
        !self.rings
    }

    /// Puts it to rest.
    pub fn reset(&mut self) {
        self.body.reset();
        self.body.end_detuning();
        self.walk.reset();
        self.scattering.reset();
        self.smoothing = Smoothing::default();
        (self.rings, self.loaded) = (false, false);
        for place in &mut self.places.all {
            place.forces.fill(0.0);
            (place.pressed, place.slow) = (false, 0.0);
        }
    }

    /// Vibration energy, J. What was not [scattered](Self::scattered) was not taken from the striker either, which the complete set alone slows down.
    pub fn energy(&self) -> f64 {
        self.body.energy()
    }

    /// The slices that are heard, as they are now; lowest first, unless places are far [apart](HighBandSpec::apart).
    pub fn slices(&self) -> impl Iterator<Item = SliceInfo> + '_ {
        let top = TAU * top_hz(self.spec.sample_rate);
        let rows = self.body.modes().iter().zip(&self.slices);
        rows.filter(move |(mode, _)| mode.omega <= top).map(|(mode, slice)| SliceInfo {
            omega: mode.omega,
            sigma: mode.sigma,
            mass: mode.mass,
            monopole_area: rim_strip(&self.spec, slice, mode.omega) / slice.count.sqrt(),
        })
    }
}

#[cfg(test)]
mod tests;
