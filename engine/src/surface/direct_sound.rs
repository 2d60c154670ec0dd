//! Direct sound of a plate: what a force on it sends out at once.
//!
//! Below coincidence waves on a plate are slower than sound. What it radiates at a frequency about the place of a force comes from modes
//! that ring far below that frequency and only weigh. Each mode's transfer is known where it rings, where slow waves radiate
//! next to nothing; the sum over the modes therefore lacks this sound. Of an endless sheet of the area density `s` it is, at
//! the distance `d`,
//!
//! ```text
//! p = -rho F / (2 pi s d)
//! ```
//!
//! at every frequency and in every direction. On a disc in free air the other face sends the same with the other sign around the rim,
//! where its waves are late by some `tau`, so that the slow part of the force is not heard: a high-pass filter of first order,
//!
//! ```text
//! tau = R e cos(i) / c      e: distance from the place to the rim;   i: inclination of the receiver, seen from the place
//! ```
//!
//! From coincidence on waves radiate wherever they are, which the modes' transfers contain, and the sheet no longer only weighs:
//! a low-pass filter of first order from there.
//!
//! Limits: 2 dB below the exact sum in the mean, single receivers and places within some 3 dB more (a test); a sheet is flat and
//! as thick as it is at the place: in a bell it is right in size only, from some kilohertz on. Where the plate swings to is
//! neglected, as are the delays between places. Nothing is taken from the plate for it: a thousandth of a stroke's energy.
//!
//! Source: Junger & Feit, Sound, Structures, and Their Interaction, ch. 8 (a point force on a plate); Cremer, Heckl & Petersson,
//! Structure-Borne Sound, ch. 6. `R` is found here.

use std::f64::consts::TAU;

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::modal::RECEIVERS;
use crate::modal::simd::MAX_RUN;
use crate::plate::PlateSpec;
use crate::receiver::{POINTS, ReceiverPosition, Receivers};

/// `R`: how far sound goes around the rim, in units of the way to it, foreshortened. *Fitted* to the exact sum of the modes
/// of the standard ride and splash, struck at 0.3 to 0.93 of the radius; 1.2 to 2.5 tried (test
/// `the_direct_sound_is_what_the_modes_lack`).
const AROUND: f64 = 2.0;

/// Rim distances below this share of the radius act as this share, so that a filter stays one.
const NEAREST: f64 = 0.01;

/// The slow part of a pressure below this is nothing, Pa: 200 dB under a soft stroke's.
const FAINT: f32 = 1e-12;

/// A place that is pressed on.
#[derive(Clone)]
struct PressedPoint {
    /// Pressure over force at each point, Pa/N, and what of a step its slow part follows in a sample.
    weights: [f32; POINTS],
    follow: [f32; POINTS],
    /// The force below coincidence, N, and its slow part at each point.
    even: f32,
    slow: [f32; POINTS],
    forces: [f32; MAX_RUN],
    pressed: bool,
}

impl PressedPoint {
    const FREE: PressedPoint = PressedPoint {
        weights: [0.0; POINTS],
        follow: [1.0; POINTS],
        even: 0.0,
        slow: [0.0; POINTS],
        forces: [0.0; MAX_RUN],
        pressed: false,
    };

    fn rings(&self) -> bool {
        self.even != 0.0 || self.slow.iter().any(|slow| *slow != 0.0)
    }
}

/// The direct sound of the forces at some places of a plate.
pub struct DirectSound {
    plate: PlateSpec,
    points: [ReceiverPosition; POINTS],
    /// Factors on the pressure at the points: far away, as at a metre.
    scales: [f64; POINTS],
    /// s.
    dt: f64,
    /// What of a step the force below coincidence follows in a sample.
    below: f32,
    places: Vec<PressedPoint>,
    rings: bool,
}

impl DirectSound {
    /// Of a plate with so many places, heard by receivers, at a sample rate (Hz). Allocates.
    pub fn new(plate: &PlateSpec, places: usize, receivers: &Receivers, sample_rate: f64) -> DirectSound {
        let dt = 1.0 / sample_rate;
        DirectSound {
            plate: *plate,
            points: receivers.points(),
            scales: receivers.scales(),
            dt,
            below: -(-plate.coincidence() * dt).exp_m1() as f32,
            places: vec![PressedPoint::FREE; places],
            rings: false,
        }
    }

    /// Places that forces can act on.
    pub fn places(&self) -> usize {
        self.places.len()
    }

    /// Puts place `i` somewhere: distance from the centre as a share of the radius, and direction in rad.
    ///
    /// # Real-time
    /// No allocation; some roots.
    pub fn put(&mut self, i: usize, radius: f64, angle: f64) {
        let DirectSound { plate, points, scales, dt, places, .. } = self;
        let place = &mut places[i];
        for at in 0..POINTS {
            let heard = SheetSound::new(plate, (radius, angle), &points[at]);
            place.weights[at] = (scales[at] * heard.pressure) as f32;
            place.follow[at] = -(-*dt / heard.late).exp_m1() as f32;
        }
    }

    /// A force (N) on place `i`, held over a sample of the present run.
    ///
    /// # Panics
    /// If the sample is not below [`MAX_RUN`].
    pub fn push(&mut self, i: usize, sample: usize, force: f32) {
        self.places[i].forces[sample] = force;
        self.places[i].pressed |= force != 0.0;
    }

    /// Ends the run: adds its sound to what is heard at each point, Pa, at most [`MAX_RUN`] samples.
    ///
    /// # Real-time
    /// Linear in samples times places pressed of late; nothing at rest.
    pub fn render(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        let below = self.below;
        for place in self.places.iter_mut().filter(|place| place.pressed || place.rings()) {
            self.rings = true;
            let PressedPoint { weights, follow, even, slow, forces, pressed } = place;
            for (sample, force) in forces.iter().enumerate().take(out[0].len()) {
                *even = unless_faint(*even + below * (force - *even));
                for at in 0..POINTS {
                    slow[at] = unless_faint(slow[at] + follow[at] * (*even - slow[at]));
                    out[at][sample] += weights[at] * (*even - slow[at]);
                }
            }
            if std::mem::take(pressed) {
                forces.fill(0.0);
            }
        }
    }

    /// Reports whether all is finite, and notes what rings. Meant for once a block.
    pub fn settle(&mut self) -> bool {
        if !self.rings {
            return true;
        }
        let mut finite = true;
        self.rings = false;
        for place in &mut self.places {
            for value in place.slow.iter().chain([&place.even]) {
                finite &= value.is_finite();
            }
            self.rings |= place.rings();
        }
        finite
    }

    /// Whether nothing is to be heard.
    pub fn is_still(&self) -> bool {
        !self.rings
    }

    /// As if nothing had ever pressed.
    pub fn reset(&mut self) {
        for place in &mut self.places {
            place.forces.fill(0.0);
            (place.even, place.slow, place.pressed) = (0.0, [0.0; POINTS], false);
        }
        self.rings = false;
    }
}

/// A force or the slow part of a pressure, nothing if [`FAINT`]: what fades would become denormal within a run.
#[inline(always)]
fn unless_faint(value: f32) -> f32 {
    if value.abs() < FAINT { 0.0 } else { value }
}

/// How a point hears a force at a place.
struct SheetSound {
    /// Pressure over force of an endless sheet, Pa/N.
    pressure: f64,
    /// How late the other face's sound is, s.
    late: f64,
}

impl SheetSound {
    /// From a place: distance from the centre as a share of the radius, direction in rad.
    fn new(plate: &PlateSpec, (radius, angle): (f64, f64), point: &ReceiverPosition) -> SheetSound {
        let [height, _] = point.height_and_offset();
        let distance = point.distance_to(radius * plate.radius(), angle);
        let density = plate.density * plate.thickness() * plate.relative_thickness(radius);
        let rim = (1.0 - radius).max(NEAREST) * plate.radius();
        // Into the plate is away from the point.
        SheetSound {
            pressure: -DENSITY / (TAU * distance * density),
            late: AROUND * rim * height / (distance * SPEED_OF_SOUND),
        }
    }
}
