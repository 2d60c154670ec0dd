//! What sticks sound like: they bend where they strike, and what bends pushes air.
//!
//! Model: each [bending mode](crate::stick) is driven by the contact forces as that of the [exciter](super::exciter) is, and rings on
//! after the stick has left. A thin round rod that is accelerated by `a` across its axis, as a piece of the length `dx`, is a dipole along
//! its motion; at the distance `d`, in a direction of the angle `psi` from it,
//!
//! ```text
//! p = 2 rho pi r^2 a dx cos(psi) (1 / d + i omega / c) e^(-i omega d / c) / (4 pi d)
//! ```
//!
//! at the mode's frequency, summed along the stick. It lies over the surface from the tip toward the player, and is raised to its butt.
//! The delay from the surface's centre is taken out of what is heard.
//!
//! Neglected: that pieces farther away are heard to begin later; its motion as a whole, whose sound is as low as the stroke is
//! long; what the surface reflects; what it takes from the stick, a thousandth of its loss in the hand.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, sec. 7.1; of a rod the air that it pushes aside and the air that it carries
//! along are as much each.

use std::f64::consts::PI;

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::math::trigonometry::sin_cos;
use crate::modal::RECEIVERS;
use crate::modal::simd::{Kernels, MAX_RUN};
use crate::receiver::{POINTS, ReceiverPosition, Receivers};
use crate::stick::{BENDING, Beam, Stick};

use super::contacts::{MAX_STRIKERS, STRIKER_POINTS};
use super::exciter::PARTS;
use super::oscillator::Oscillator;

/// How far a stick is raised from the surface, rad. *By ear*: the butt is some 10 cm over the tip.
const RAISED: f64 = 0.25;

/// Pieces of a stick that are dipoles by themselves. *Converged*.
const PIECES: usize = 24;

/// No piece is nearer to a point than this, m: the thickness of a stick and of a microphone.
const NEAREST: f64 = 0.04;

/// Energy below which a mode is still, J: 200 dB under a soft stroke's.
const FAINT: f64 = 1e-24;

/// Bending modes filled up to whole vectors; those filled in are still.
const LANES: usize = 16;

/// A value of each bending mode.
type PerMode = [f64; LANES];

/// How the bending modes of every stick move and are heard in a sample.
struct Bent {
    /// What displacement (m) and speed (m/s) become of either: `[q, v] <- [[a, b], [c, d]] [q, v]`.
    turn: [[PerMode; 2]; 2],
    /// What a newton adds to both.
    hold: [PerMode; 2],
    /// Of a displacement of a metre and of a metre a second, what the acceleration lacks: 1/s2, 1/s.
    drawn: [PerMode; 2],
    /// Of each mode, kg.
    mass: f64,
}

impl Bent {
    /// Of a stick's beam, with a quality factor, at a time step, s.
    fn new(beam: &Beam, q: f64, dt: f64) -> Bent {
        let none = [0.0; LANES];
        let mass = beam.rod.mass;
        let mut bent = Bent { turn: [[none; 2]; 2], hold: [none; 2], drawn: [none; 2], mass };
        for (k, mode) in beam.bending.iter().enumerate() {
            let sigma = mode.omega / (2.0 * q);
            let moved = |displaced: [f64; 2], force: f64| {
                let mut motion = Oscillator::sprung(mass, mode.omega, sigma, dt);
                (motion.q, motion.v) = (displaced[0], displaced[1]);
                motion.step();
                motion.push(force);
                [motion.q, motion.v]
            };
            let (by_place, by_speed) = (moved([1.0, 0.0], 0.0), moved([0.0, 1.0], 0.0));
            for part in 0..2 {
                (bent.turn[part][0][k], bent.turn[part][1][k]) = (by_place[part], by_speed[part]);
                bent.hold[part][k] = moved([0.0; 2], 1.0)[part];
            }
            (bent.drawn[0][k], bent.drawn[1][k]) = (mode.omega * mode.omega, 2.0 * sigma);
        }
        bent
    }
}

/// A stick that strikes or has struck of late.
#[derive(Clone)]
struct SoundingStick {
    /// Displacement, m, and speed, m/s.
    place: PerMode,
    speed: PerMode,
    /// Pressure at each point over acceleration, and over speed, Pa s2/m and Pa s/m.
    heard: [[PerMode; 2]; POINTS],
    /// What each of its points feels of the modes, and its force in the present run, N.
    weights: [PerMode; STRIKER_POINTS],
    forces: [[f32; MAX_RUN]; STRIKER_POINTS],
    pressed: bool,
    rings: bool,
}

/// The sound of the sticks on a surface.
pub struct StickSound {
    radius: f64,
    points: [ReceiverPosition; POINTS],
    scales: [f64; POINTS],
    sticks: Vec<SoundingStick>,
    /// What a mode of unit mean square of a piece shows: volume of air pushed and carried, `[piece]`, m3.
    volumes: [f64; PIECES],
    bent: Bent,
    /// rad/s.
    omegas: [f64; BENDING],
    /// Shape of each mode in the middle of each piece, of unit mean square.
    shapes: [[f64; PIECES]; BENDING],
    kernels: Kernels,
}

/// What the pieces of a stick are to a point.
struct Pieces {
    /// Of the point from where delays are counted, m.
    from: f64,
    /// m, and its reciprocal.
    distance: [f64; PIECES],
    near: [f64; PIECES],
    /// Pressure over acceleration, times the distance, Pa s2.
    dipole: [f64; PIECES],
}

impl Pieces {
    /// Pressure over acceleration (Pa s2/m), real and imaginary part, of a mode with that shape and wave number (1/m).
    #[inline(always)]
    fn heard(&self, shape: &[f64; PIECES], wave: f64) -> [f64; 2] {
        // By piece first: so a loop of them goes side by side.
        let (mut re, mut im) = ([0.0; PIECES], [0.0; PIECES]);
        for i in 0..PIECES {
            let (sin, cos) = sin_cos(wave * (self.from - self.distance[i]));
            let share = shape[i] * self.dipole[i];
            re[i] = share * (self.near[i] * cos - wave * sin);
            im[i] = share * (self.near[i] * sin + wave * cos);
        }
        [re.iter().sum(), im.iter().sum()]
    }
}

impl StickSound {
    /// On a surface of a radius (m), heard by receivers, at a sample rate (Hz). Allocates.
    pub fn new(radius: f64, receivers: &Receivers, sample_rate: f64) -> StickSound {
        let dt = 1.0 / sample_rate;
        let stick = Stick::at(Stick::BEAD);
        let beam = stick.beam();
        let bending = &beam.bending;
        let step = stick.length / PIECES as f64;
        let middle = |i: usize| (i as f64 + 0.5) / PIECES as f64;
        StickSound {
            bent: Bent::new(&beam, stick.q, dt),
            omegas: std::array::from_fn(|k| bending[k].omega),
            shapes: std::array::from_fn(|k| std::array::from_fn(|i| bending[k].shape(middle(i)))),
            kernels: Kernels::detect(),
            radius,
            points: receivers.points(),
            scales: receivers.scales(),
            sticks: vec![SoundingStick::SILENT; MAX_STRIKERS],
            volumes: std::array::from_fn(|i| {
                2.0 * PI * stick.radius_at((i as f64 + 0.5) * step).powi(2) * step
            }),
        }
    }

    /// A stick arrives that touches at a place (distance from the centre as a share of the radius, direction in rad) with what is at
    /// `place`, a share of its length; its points feel so much of the parts of its exciter, of which the first do not bend.
    ///
    /// # Real-time
    /// No allocation; some thousand sines.
    pub fn arrive(
        &mut self,
        striker: usize,
        (radius, angle): (f64, f64),
        place: f64,
        felt: [&[f64; PARTS]; STRIKER_POINTS],
        rigid: usize,
    ) {
        let StickSound { points, scales, sticks, volumes, shapes, omegas, kernels, .. } = self;
        let stick = Stick::at(place);
        let [across, along] = [radius * self.radius * angle.sin(), radius * self.radius * angle.cos()];
        let (raised, lying) = (RAISED.sin(), RAISED.cos());
        let sounding = &mut sticks[striker];
        let all_heard = &mut sounding.heard;
        kernels.vectorized(
            #[inline(always)]
            || {
                for (at, point) in points.iter().enumerate() {
                    let [height, offset] = point.height_and_offset();
                    let (aside, ahead) = (offset * point.azimuth.sin(), offset * point.azimuth.cos());
                    let none = [0.0; PIECES];
                    let mut pieces =
                        Pieces { from: point.distance, distance: none, near: none, dipole: none };
                    for (i, volume) in volumes.iter().enumerate() {
                        let behind = ((i as f64 + 0.5) / PIECES as f64 - place) * stick.length;
                        let up = height - behind * raised;
                        let beside = ahead - along - behind * lying;
                        let square = (aside - across) * (aside - across) + beside * beside + up * up;
                        let distance = square.sqrt().max(NEAREST);
                        pieces.distance[i] = distance;
                        pieces.near[i] = distance.recip();
                        // Into the surface is away from the point.
                        pieces.dipole[i] = -DENSITY * volume * up / (4.0 * PI * distance * distance);
                    }
                    let [accelerated, moved] = &mut all_heard[at];
                    for (k, (shape, omega)) in shapes.iter().zip(&*omegas).enumerate() {
                        let [re, im] = pieces.heard(shape, omega / SPEED_OF_SOUND);
                        // A quarter of a period before the acceleration is the speed, `i a = -omega v`.
                        (accelerated[k], moved[k]) = (scales[at] * re, -scales[at] * im * omega);
                    }
                }
            },
        );
        for (weights, felt) in sounding.weights.iter_mut().zip(felt) {
            weights[..BENDING].copy_from_slice(&felt[rigid..][..BENDING]);
        }
    }

    /// A striker arrives that does not bend.
    pub fn hush(&mut self, striker: usize) {
        self.sticks[striker].weights = [[0.0; LANES]; STRIKER_POINTS];
    }

    /// A force (N) on a striker's point, held over a sample of the present run.
    ///
    /// # Panics
    /// If the sample is not below [`MAX_RUN`].
    pub fn push(&mut self, point: usize, sample: usize, force: f32) {
        let (stick, point) = (&mut self.sticks[point / STRIKER_POINTS], point % STRIKER_POINTS);
        if stick.weights[point] == [0.0; LANES] {
            return;
        }
        stick.forces[point][sample] = force;
        (stick.pressed, stick.rings) = (true, true);
    }

    /// Ends the run: adds its sound to what is heard at each point, Pa, at most [`MAX_RUN`] samples.
    ///
    /// # Real-time
    /// Linear in samples times sticks that ring; nothing at rest.
    pub fn render(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        let StickSound { sticks, bent, kernels, .. } = self;
        for stick in sticks.iter_mut().filter(|stick| stick.rings) {
            kernels.vectorized(
                #[inline(always)]
                || stick.render(bent, out),
            );
            if std::mem::take(&mut stick.pressed) {
                stick.forces.as_flattened_mut().fill(0.0);
            }
        }
    }

    /// Puts modes and sticks to rest that no longer ring; reports whether all is finite. Meant for once a block.
    pub fn settle(&mut self) -> bool {
        let mut finite = true;
        for stick in self.sticks.iter_mut().filter(|stick| stick.rings) {
            stick.rings = false;
            for k in 0..BENDING {
                let (q, v) = (&mut stick.place[k], &mut stick.speed[k]);
                let energy = 0.5 * self.bent.mass * (*v * *v + self.bent.drawn[0][k] * *q * *q);
                finite &= energy.is_finite();
                if energy < FAINT {
                    (*q, *v) = (0.0, 0.0);
                } else {
                    stick.rings = true;
                }
            }
        }
        finite
    }

    /// Whether nothing rings.
    pub fn is_still(&self) -> bool {
        self.sticks.iter().all(|stick| !stick.rings)
    }

    /// As if none had ever struck.
    pub fn reset(&mut self) {
        self.sticks.iter_mut().for_each(SoundingStick::rest);
    }
}

impl SoundingStick {
    const SILENT: SoundingStick = SoundingStick {
        place: [0.0; LANES],
        speed: [0.0; LANES],
        heard: [[[0.0; LANES]; 2]; POINTS],
        weights: [[0.0; LANES]; STRIKER_POINTS],
        forces: [[0.0; MAX_RUN]; STRIKER_POINTS],
        pressed: false,
        rings: false,
    };

    /// Adds its sound to what is heard at each point, Pa.
    #[inline(always)]
    fn render(&mut self, bent: &Bent, out: &mut [&mut [f32]; RECEIVERS]) {
        let SoundingStick { place, speed, heard, weights, forces, .. } = self;
        let [[a, b], [c, d]] = &bent.turn;
        for sample in 0..out[0].len() {
            let pressed: [f64; STRIKER_POINTS] = std::array::from_fn(|i| f64::from(forces[i][sample]));
            let mut acceleration = [0.0; LANES];
            for k in 0..LANES {
                let force: f64 = (0..STRIKER_POINTS).map(|i| -weights[i][k] * pressed[i]).sum();
                let (q, v) = (place[k], speed[k]);
                place[k] = a[k] * q + b[k] * v + bent.hold[0][k] * force;
                speed[k] = c[k] * q + d[k] * v + bent.hold[1][k] * force;
                acceleration[k] =
                    force / bent.mass - bent.drawn[0][k] * place[k] - bent.drawn[1][k] * speed[k];
            }
            for (out, [accelerated, moved]) in out.iter_mut().zip(&*heard) {
                let mut parts = [0.0; LANES];
                for k in 0..LANES {
                    parts[k] = accelerated[k] * acceleration[k] + moved[k] * speed[k];
                }
                out[sample] += parts.iter().sum::<f64>() as f32;
            }
        }
    }

    /// Silences it.
    fn rest(&mut self) {
        *self = SoundingStick { heard: self.heard, ..SoundingStick::SILENT };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 192_000.0;

    /// Force of a tap in a sample, N: a third of a millisecond.
    fn force(sample: usize) -> f64 {
        if sample < 64 { 40.0 * (PI * (sample as f64 + 0.5) / 64.0).sin().powi(2) } else { 0.0 }
    }

    /// What each point hears of a tap on the bead, `[sample]`.
    fn tapped(sound: &mut StickSound, place: (f64, f64), samples: usize) -> Vec<[f32; POINTS]> {
        let mut felt = [[0.0; PARTS]; STRIKER_POINTS];
        for (felt, mode) in felt[0][1..].iter_mut().zip(&Stick::at(Stick::BEAD).beam().bending) {
            *felt = mode.shape(Stick::BEAD);
        }
        sound.arrive(0, place, Stick::BEAD, [&felt[0], &felt[1]], 1);
        let mut heard = Vec::new();
        while heard.len() < samples {
            if heard.len() < 64 {
                (0..MAX_RUN).for_each(|i| sound.push(0, i, force(heard.len() + i) as f32));
            }
            let mut out = [[0.0; MAX_RUN]; RECEIVERS];
            sound.render(&mut out.each_mut().map(|out| &mut out[..]));
            assert!(sound.settle());
            heard.extend((0..MAX_RUN).map(|i| std::array::from_fn::<_, POINTS, _>(|point| out[point][i])));
        }
        heard
    }

    fn receivers() -> Receivers {
        let near = ReceiverPosition { distance: 0.5, inclination: 0.85, azimuth: 2.0 };
        Receivers { near, far: [0.4, 0.9].map(|inclination| ReceiverPosition::far(inclination, -1.0)) }
    }

    #[test]
    fn a_tapped_stick_is_heard_as_its_pieces_are_each_at_its_time() {
        let (radius, place) = (0.25, (0.6, 0.3));
        let mut sound = StickSound::new(radius, &receivers(), RATE);
        let samples = 4000;
        let heard = tapped(&mut sound, place, samples);
        // The oracle: dipoles of accelerations that are late by their distance, all by a constant.
        let stick = Stick::at(Stick::BEAD);
        let lead = (0.6 / SPEED_OF_SOUND * RATE) as usize;
        let beam = stick.beam();
        let Beam { rod, bending } = &*beam;
        let accelerations: Vec<Vec<f64>> = bending
            .iter()
            .map(|mode| {
                let sigma = mode.omega / (2.0 * stick.q);
                let mut motion = Oscillator::sprung(rod.mass, mode.omega, sigma, 1.0 / RATE);
                let mut past = vec![0.0; lead];
                past.extend((0..samples + lead).map(|i| {
                    let force = -force(i) * mode.shape(Stick::BEAD);
                    motion.step();
                    motion.push(force);
                    -mode.omega.powi(2) * motion.q - 2.0 * sigma * motion.v + force / rod.mass
                }));
                past
            })
            .collect();
        for (at, point) in receivers().points().iter().enumerate() {
            let [height, offset] = point.height_and_offset();
            let (aside, ahead) = (offset * point.azimuth.sin(), offset * point.azimuth.cos());
            let mut oracle = vec![0.0; samples];
            for piece in 0..200 {
                let x = (f64::from(piece) + 0.5) / 200.0;
                let behind = (x - Stick::BEAD) * stick.length;
                let here = [
                    place.0 * radius * place.1.sin() - aside,
                    place.0 * radius * place.1.cos() + behind * RAISED.cos() - ahead,
                    height - behind * RAISED.sin(),
                ];
                let distance = here.iter().map(|x| x * x).sum::<f64>().sqrt();
                let volume = 2.0 * PI * stick.radius_at(x * stick.length).powi(2) * stick.length / 200.0;
                let dipole = -DENSITY * volume * here[2] / (4.0 * PI * distance * distance);
                let late = (distance - point.distance) / SPEED_OF_SOUND * RATE + lead as f64;
                for (k, mode) in bending.iter().enumerate() {
                    let shape = mode.shape(x);
                    for (i, oracle) in oracle.iter_mut().enumerate() {
                        let time = i as f64 + 2.0 * lead as f64 - late;
                        let at = time as usize;
                        let step = accelerations[k][at + 1] - accelerations[k][at];
                        let now = accelerations[k][at] + (time - at as f64) * step;
                        *oracle += shape * dipole * (now / distance + step * RATE / SPEED_OF_SOUND);
                    }
                }
            }
            let scale = receivers().scales()[at];
            let compared = |from: usize| {
                let pairs = heard.iter().zip(&oracle).skip(from);
                pairs.fold([0.0; 3], |[own, other, both], (heard, oracle)| {
                    let (heard, oracle) = (f64::from(heard[at]), scale * oracle);
                    [own + heard * heard, other + oracle * oracle, both + heard * oracle]
                })
            };
            let [own, other, _] = compared(0);
            let level = 10.0 * (own / other).log10();
            // Once sound of every piece has come.
            let [own, other, both] = compared((0.0015 * RATE) as usize);
            let alike = both / (own * other).sqrt();
            assert!(level.abs() < 2.0 && alike > 0.9, "{at}: {level} dB, {alike}");
        }
    }

    #[test]
    fn it_falls_still_and_one_that_does_not_bend_is_silent() {
        let mut sound = StickSound::new(0.25, &receivers(), RATE);
        assert!(sound.is_still());
        tapped(&mut sound, (0.6, 0.0), 1000);
        assert!(!sound.is_still());
        let later = tapped(&mut sound, (0.6, 0.0), 2 * RATE as usize);
        assert!(sound.is_still() && later[later.len() - 1] == [0.0; POINTS]);
        sound.hush(0);
        (0..MAX_RUN).for_each(|i| sound.push(0, i, 100.0));
        assert!(sound.is_still());
        // Nothing is left of a mallet's forces when a stick takes its place.
        let [after, new] = [sound, StickSound::new(0.25, &receivers(), RATE)].map(|mut sound| {
            let mut felt = [0.0; PARTS];
            felt[1] = 1.0;
            sound.arrive(0, (0.6, 0.0), Stick::BEAD, [&felt, &[0.0; PARTS]], 1);
            sound.push(0, 3, 1.0);
            let mut out = [[0.0; MAX_RUN]; RECEIVERS];
            sound.render(&mut out.each_mut().map(|out| &mut out[..]));
            out
        });
        assert_eq!(after, new);
    }
}
