//! The sound of a cymbal's motion as a whole: its heave and its tilts.
//!
//! Model: a thin rigid disc in free air ([`FreeDisc`]) is a dipole at low frequency, and a quadrupole if it tilts. Its pressure over its
//! acceleration, `H`, is a real number close by where it is slow, grows with the frequency, and falls where the disc is wider than the
//! waves, in lobes. What drives it (strokes, rims that land, felts) has every frequency, so that one number does not do as it does for a mode.
//! Each `H` is the filter
//!
//! ```text
//! H(s) = (slow + middle y + fast y^2) / (1 + y)^3,   y = s a / (2 c)
//! ```
//!
//! with `slow` the limit at zero frequency; `middle` and `fast` such that the squares of the relative errors are least from
//! `k a = 0.2` to 1.6. *Derived*.
//!
//! Limits: what it takes from the motion is neglected beside the loss of the felts. Of the lobes it has
//! a mean fall only; heave is within 2.5 dB from 40 to 300 Hz, the softer tilts within 10: the shells' modes are louder there.

use nalgebra::Complex;

use crate::air_load::SPEED_OF_SOUND;
use crate::modal::Pressure;
use crate::mode::Member;
use crate::plate::free_disc::FreeDisc;
use crate::radiation::Radiator;
use crate::receiver::{POINTS, Receivers};

use super::rigid::Weights;

/// Nodes along the radius: shapes are a constant and a line. *Converged*.
const NODES: usize = 48;

/// Pole of the filters, in units of the speed of sound over the radius: where a disc is as wide as a third of a wave. *Judgement*.
const POLE: f64 = 2.0;

/// Where the filters are matched, `k a`: 60 to 500 Hz for a hi-hat.
const MATCHED: [f64; 5] = [0.2, 0.4, 0.7, 1.0, 1.6];

/// How a cymbal is heard as a rigid body.
#[derive(Debug, Clone, Copy, Default)]
pub struct RigidSound {
    /// Of heave and tilts at each receiver, Pa s2/m.
    slow: [Weights; POINTS],
    middle: [Weights; POINTS],
    fast: [Weights; POINTS],
    /// Share of the distance to the present acceleration that the filters go in a sample.
    share: f64,
    /// Accelerations behind one, two and three poles, m/s2.
    smoothed: [Weights; 3],
}

/// How both cymbals of a pair are heard as rigid bodies.
#[derive(Default)]
pub struct RigidHeard {
    /// Of the upper and the lower one.
    pub sounds: [RigidSound; 2],
    /// Speeds of their heaves and tilts from which the accelerations of the present sample are heard, m/s.
    pub from: [Weights; 2],
}

/// The parts of a rigid motion: nodal diameters and member.
const PARTS: [(u32, Member); 3] = [(0, Member::Cosine), (1, Member::Cosine), (1, Member::Sine)];

impl RigidSound {
    /// A cymbal of a radius (m), heard by these receivers, at a sample time of `dt` (s). Allocates.
    pub fn new(radius: f64, receivers: &Receivers, dt: f64) -> RigidSound {
        let unit = SPEED_OF_SOUND / radius;
        let disc = FreeDisc::new(radius, receivers.points(), NODES);
        let none = [[0.0; 3]; POINTS];
        let share = -(-POLE * unit * dt).exp_m1();
        let mut sound = RigidSound { slow: none, middle: none, fast: none, share, smoothed: [[0.0; 3]; 3] };
        for (part, (m, member)) in PARTS.into_iter().enumerate() {
            let shape = |&r: &f64| if m == 0 { 1.0 } else { 2.0 * r };
            let radial: Vec<f64> = disc.radii().iter().map(shape).collect();
            let heard =
                |u: f64| disc.radiate(&Radiator { m, radial: &radial, omega: u * unit }, 0.0).transfers;
            let points = receivers.points().into_iter().zip(receivers.scales());
            let (still, moving) = (heard(1e-3), MATCHED.map(heard));
            for (at, (point, scale)) in points.enumerate() {
                let share = scale * point.toward(m, member, 0.0);
                let slow = still[at][0];
                // H (1 + i x)^3 = slow + i x middle - x^2 fast: the real and the imaginary part are each linear in one of them.
                let (mut middle, mut fast) = ([0.0; 2], [0.0; 2]);
                for (u, moving) in MATCHED.iter().zip(&moving) {
                    let (x, [re, im]) = (u / POLE, moving[at]);
                    let whole = Complex::new(re, im) * Complex::new(1.0, x).powi(3);
                    let weight = whole.norm_sqr().recip();
                    middle = [middle[0] + weight * x * whole.im, middle[1] + weight * x * x];
                    fast = [fast[0] + weight * x * x * (slow - whole.re), fast[1] + weight * x.powi(4)];
                }
                sound.slow[at][part] = share * slow;
                sound.middle[at][part] = share * middle[0] / middle[1];
                sound.fast[at][part] = share * fast[0] / fast[1];
            }
        }
        sound
    }

    /// Pressure at each receiver under the accelerations (m/s2) of a sample, Pa.
    pub fn hear(&mut self, accelerations: &Weights) -> Pressure {
        let mut heard = Pressure::default();
        for (part, &now) in accelerations.iter().enumerate() {
            let mut behind = now;
            for smoothed in &mut self.smoothed {
                smoothed[part] += self.share * (behind - smoothed[part]);
                behind = smoothed[part];
            }
            let [once, twice, thrice] = self.smoothed.map(|smoothed| smoothed[part]);
            let (middle, high) = (twice - thrice, once - 2.0 * twice + thrice);
            for (at, heard) in heard.iter_mut().take(POINTS).enumerate() {
                let low = self.slow[at][part] * thrice;
                *heard += (low + self.middle[at][part] * middle + self.fast[at][part] * high) as f32;
            }
        }
        heard
    }

    /// As if it had never moved.
    pub fn reset(&mut self) {
        self.smoothed = [[0.0; 3]; 3];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::receiver::ReceiverPosition;
    use std::f64::consts::TAU;

    #[test]
    fn slow_or_fast_it_sounds_as_the_rigid_disc_does() {
        let (radius, rate) = (0.178, 48_000.0);
        let near = ReceiverPosition { distance: 0.5, inclination: 1.1, azimuth: 0.4 };
        let receivers =
            Receivers { near, far: [0.5, 0.7].map(|inclination| ReceiverPosition::far(inclination, 1.0)) };
        let disc = FreeDisc::new(radius, receivers.points(), NODES);
        for (part, (m, member)) in PARTS.into_iter().enumerate() {
            let radial: Vec<f64> = disc.radii().iter().map(|&r| if m == 0 { 1.0 } else { 2.0 * r }).collect();
            for hz in [40.0, 80.0, 150.0, 300.0] {
                let omega = TAU * hz;
                let exact = disc.radiate(&Radiator { m, radial: &radial, omega }, 0.0).transfers;
                let mut sound = RigidSound::new(radius, &receivers, 1.0 / rate);
                let mut sums = [[0.0; 2]; POINTS];
                for sample in 0..48_000 {
                    let phase = omega * f64::from(sample) / rate;
                    let mut moved = [0.0; 3];
                    moved[part] = phase.cos();
                    let heard = sound.hear(&moved);
                    if sample >= 24_000 {
                        for (sum, &heard) in sums.iter_mut().zip(&heard) {
                            sum[0] += f64::from(heard) * phase.cos() / 12_000.0;
                            sum[1] -= f64::from(heard) * phase.sin() / 12_000.0;
                        }
                    }
                }
                for (at, (point, scale)) in receivers.points().into_iter().zip(receivers.scales()).enumerate()
                {
                    let share = (scale * point.toward(m, member, 0.0)).abs();
                    let want = share * exact[at][0].hypot(exact[at][1]);
                    let db = 20.0 * (sums[at][0].hypot(sums[at][1]) / want).log10();
                    // Heave is what is heard: the tilts, of opposite halves, are softer and less exact.
                    let most = if m == 0 { 3.0 } else { 10.0 };
                    assert!(db.abs() < most, "part {part}, receiver {at}, {hz} Hz: {db} dB");
                }
            }
        }
    }
}
