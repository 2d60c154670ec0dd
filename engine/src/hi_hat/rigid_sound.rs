//! The sound of a cymbal's motion as a whole: its heave and its tilts.
//!
//! Model: a thin rigid disc in free air ([`FreeDisc`]) is a dipole at low frequency, and a quadrupole if it tilts. Its pressure over its
//! acceleration is a filter (`lobed_sound`).
//!
//! Limits: what it takes from the motion is neglected beside the loss of the felts. Heave is within 2.5 dB from 40 to 300 Hz, the softer
//! tilts within 10: the shells' modes are louder there.

use crate::air_load::SPEED_OF_SOUND;
use crate::mode::Member;
use crate::plate::free_disc::FreeDisc;
use crate::radiation::Radiator;
use crate::receiver::Receivers;

use super::lobed_sound::{LobedSound, TO_SLOW};
use super::rigid::Weights;

/// Nodes along the radius: shapes are a constant and a line. *Converged*.
const NODES: usize = 48;

/// How a cymbal is heard as a rigid body: its heave and its tilts, m/s2.
pub type RigidSound = LobedSound<3>;

/// How both cymbals of a pair are heard as rigid bodies.
pub struct RigidHeard {
    /// Of the upper and the lower one.
    pub sounds: [RigidSound; 2],
    /// Speeds of their heaves and tilts from which the accelerations of the present sample are heard, m/s.
    pub from: [Weights; 2],
    /// The part of the present sample's change of these speeds that is not heard, m/s.
    pub quiet: [Weights; 2],
}

/// The parts of a rigid motion: nodal diameters and member.
const PARTS: [(u32, Member); 3] = [(0, Member::Cosine), (1, Member::Cosine), (1, Member::Sine)];

/// A cymbal of a radius (m), heard as a rigid body by these receivers, at a sample time of `dt` (s). Allocates.
pub fn rigid_sound(radius: f64, receivers: &Receivers, dt: f64) -> RigidSound {
    let unit = SPEED_OF_SOUND / radius;
    let disc = FreeDisc::new(radius, receivers.points(), NODES);
    LobedSound::new(radius, dt, &TO_SLOW, |part, u| {
        let (m, member) = PARTS[part];
        let shape = |&r: &f64| if m == 0 { 1.0 } else { 2.0 * r };
        let radial: Vec<f64> = disc.radii().iter().map(shape).collect();
        let heard = disc.radiate(&Radiator { m, radial: &radial, omega: u * unit }, 0.0).transfers;
        let points = receivers.points().into_iter().zip(receivers.scales()).zip(heard);
        let mut out = heard;
        for (out, ((point, scale), heard)) in out.iter_mut().zip(points) {
            *out = heard.map(|x| scale * point.toward(m, member, 0.0) * x);
        }
        out
    })
}

impl RigidHeard {
    /// Of cymbals at rest, heard so.
    pub fn new(sounds: [RigidSound; 2]) -> RigidHeard {
        RigidHeard { sounds, from: [[0.0; 3]; 2], quiet: [[0.0; 3]; 2] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::receiver::{POINTS, ReceiverPosition};
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
                let mut sound = rigid_sound(radius, &receivers, 1.0 / rate);
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
