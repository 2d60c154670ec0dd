//! How a drum's modes are heard at a point, over its range of pitches.
//!
//! Model: the struck head is heard as in a baffle from near, as from a body in free air from far; the other head from
//! behind the body, in free air (see [`radiation`](crate::radiation) and [`diffraction`]).
//!
//! What a mode shows of itself follows the pitch: its frequency does, and where it passes a mode of the air the
//! two heads' shares in it change places, which decides between much and nothing. Modes that are heard one by one are
//! worked out at the pitches of their own [grid](super::tuned::Grid). Of all others the phase is that of the default
//! pitch, where among so many it does not count, and the size goes straight in logarithms from the lowest pitch over the
//! default to the highest.
//!
//! Limits: *converged* against a rebuild, octaves of modes heard one by one are met within 0.2 dB; those above within
//! 0.6 dB at any pitch, by their sizes. For their sum phases do count a little: a kick by itself, tuned from 45 to 55 Hz, is
//! 1.1 dB off in the octave of 2 kHz.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::air_load::SPEED_OF_SOUND;
use crate::diffraction;
use crate::diffraction::Outside;
use crate::drum::modes::DrumModes;
use crate::drum::spec::DrumSpec;
use crate::drum::tuned::{PitchPosition, TunedMode};
use crate::radiation::{Radiator, Rayleigh};
use crate::receiver::{DIRECTIONS, ReceiverPosition, Receivers};
use crate::split::Splitting;

/// Modes up to so many times the default pitch are heard one by one: of a kick at 45 Hz all of the octave of 1 kHz, which
/// ends at 1.4 kHz. *Converged*: tuned to 55 Hz it is heard there within 0.1 dB as with all of its modes; with 17 it is 0.4
/// dB off.
const SINGLY: f64 = 30.0;

/// The least size that is told from nothing, over that at the default pitch.
const LEAST: f32 = 1e-3;

/// Pressure over modal acceleration of the member of a pair that points at the listener, Pa s2/m.
#[derive(Serialize, Deserialize)]
enum PairTransfer {
    /// `[pitch of the mode's grid]`.
    Singly(Vec<[f32; 2]>),
    /// Among many.
    Together {
        /// At the default pitch.
        default: [f32; 2],
        /// Logarithm of the size at the lowest and the highest pitch over that at the default.
        ends: [f32; 2],
    },
}

/// How a drum's modes are heard from near and from each direction far away.
pub type ModeTransfers = (ModeTransfer, [ModeTransfer; DIRECTIONS]);

/// Works it out for all receivers, each by itself: a mode that shows next to nothing here may show much there. Allocates.
pub fn heard_by(drum: &DrumModes, spec: &DrumSpec, receivers: &Receivers) -> ModeTransfers {
    let from = |point| ModeTransfer::new(drum, spec, point);
    (from(receivers.near), receivers.far.map(from))
}

/// Everything needed to hear a drum at any of its pitches.
#[derive(Serialize, Deserialize)]
pub struct ModeTransfer {
    /// `[pair]`.
    pairs: Vec<PairTransfer>,
    /// `[mode of the body]`: its pair, and what it shows of itself toward the listener.
    members: Vec<(u32, f32)>,
    /// Logarithms of the lowest, the default and the highest pitch (Hz).
    pitches: [f64; 3],
}

impl ModeTransfer {
    /// Works it out for a point. Allocates; takes hundredths of a second.
    pub fn new(drum: &DrumModes, spec: &DrumSpec, point: ReceiverPosition) -> ModeTransfer {
        let [lowest, default, highest] = spec.pitches();
        let place = drum.heads.scale.place(default);
        let ends = [lowest, highest].map(|pitch| drum.heads.scale.place(pitch));
        let limit = TAU * SINGLY * default;
        let few = HeadTransfers::new(drum, spec, point, 2.5 * limit);
        let all = HeadTransfers::new(drum, spec, point, TAU * spec.batter.modes_to_hz);
        let pitches = drum.heads.scale.pitches();
        let hear = |mode: &TunedMode| {
            if mode.at(&place).omega > limit {
                let default = all.transfer(mode, &place);
                let size = |[re, im]: [f32; 2]| re.hypot(im);
                let least = LEAST * size(default);
                let end = |place| (size(all.transfer(mode, place)).max(least) / size(default)).ln();
                let ends = [end(&ends[0]), end(&ends[1])].map(|x| if x.is_finite() { x } else { 0.0 });
                return PairTransfer::Together { default, ends };
            }
            let at = |pitch: usize| few.transfer(mode, &drum.heads.scale.place(pitches[pitch]));
            PairTransfer::Singly(mode.grid().pitches().map(at).collect())
        };
        let pairs = drum.modes.iter().map(hear).collect();
        let mut members = Vec::new();
        for (pair, mode) in drum.modes.iter().enumerate() {
            let axis = spec.evenness.axis(mode.m, 0);
            for (member, _) in Splitting::ROUND.members(mode.m, 0) {
                members.push((pair as u32, point.toward(mode.m, member, axis) as f32));
            }
        }
        ModeTransfer { pairs, members, pitches: [lowest, default, highest].map(f64::ln) }
    }

    /// How every mode of the body is heard at a pitch (Hz): told one by one, pressure over modal acceleration, real and
    /// imaginary part, Pa s2/m.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn transfers<'a>(
        &'a self,
        modes: &'a [TunedMode],
        place: &'a PitchPosition,
        pitch_hz: f64,
    ) -> impl Iterator<Item = [f64; 2]> + 'a {
        let [low, default, high] = self.pitches;
        let up = pitch_hz.ln() - default;
        let (end, way) = if up < 0.0 { (0, low - default) } else { (1, high - default) };
        // A drum's own pitch may be an end of its range.
        let share = if way == 0.0 { 0.0 } else { up / way };
        self.members.iter().map(move |&(pair, shown)| {
            let (pair, shown) = (pair as usize, f64::from(shown));
            match &self.pairs[pair] {
                PairTransfer::Singly(row) => {
                    let stencil = place.of(modes[pair].grid());
                    [0, 1].map(|i| shown * stencil.blend(|pitch| f64::from(row[pitch][i])))
                }
                PairTransfer::Together { default, ends } => {
                    let size = shown * (share * f64::from(ends[end])).exp();
                    default.map(|part| size * f64::from(part))
                }
            }
        })
    }
}

/// The listening point as each head sees it.
struct HeadTransfers<'a> {
    drum: &'a DrumModes,
    spec: &'a DrumSpec,
    near: Rayleigh,
    far: Rayleigh,
    /// Radial functions of the heads' modes where the integrals want them, `[mode][radius]`.
    near_shapes: Vec<f64>,
    far_shapes: Option<Vec<f64>>,
    /// What the far head is later by, s.
    lag: f64,
    /// How much of the half-space the struck head fills, seen from the point.
    fills: f64,
}

impl<'a> HeadTransfers<'a> {
    /// For modes up to an angular frequency `top` (rad/s) at any pitch.
    fn new(drum: &'a DrumModes, spec: &'a DrumSpec, point: ReceiverPosition, top: f64) -> HeadTransfers<'a> {
        let radius = spec.radius();
        let head = &drum.heads.batter.membrane;
        let slackest = drum.heads.batter.tensions.iter().copied().fold(f64::INFINITY, f64::min);
        let reached = head.modes().iter().filter(|mode| head.ringing(mode, slackest).omega <= top);
        let finest = reached.map(|mode| mode.zero).fold(0.0, f64::max);
        let nodes = 12 + (0.7 * (finest + top * radius / SPEED_OF_SOUND)) as usize;
        let behind = point.from_behind(spec.cavity().map_or(0.0, |cavity| cavity.depth));
        let (near, far) = (Rayleigh::new(radius, point, nodes), Rayleigh::new(radius, behind, nodes));
        let near_shapes = head.radial_shapes(near.radii());
        let far_shapes = drum.heads.resonant.as_ref().map(|head| head.membrane.radial_shapes(far.radii()));
        let lag = (behind.distance - point.distance) / SPEED_OF_SOUND;
        let fills = point.fills(radius);
        HeadTransfers { drum, spec, near, far, near_shapes, far_shapes, lag, fills }
    }

    /// A head's motion in a mode as the air follows it, along the radius: head modes `first..first + count` of the head, `skip..` of the
    /// mode's shares, each followed by so much.
    fn radial(
        &self,
        mode: &TunedMode,
        place: &PitchPosition,
        shapes: &[f64],
        head: [usize; 3],
        followed: impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let nodes = self.near.radii().len();
        let [first, count, skip] = head;
        let shares: Vec<f64> = (0..count).map(|i| mode.share(skip + i, place) * followed(i)).collect();
        let mut radial = vec![0.0; nodes];
        for (i, share) in shares.iter().enumerate() {
            let row = &shapes[(first + i) * nodes..][..nodes];
            radial.iter_mut().zip(row).for_each(|(sum, shape)| *sum += share * shape);
        }
        radial
    }

    /// Transfer of a member of a pair that points at the listener.
    fn transfer(&self, mode: &TunedMode, place: &PitchPosition) -> [f32; 2] {
        let omega = mode.at(place).omega;
        let (first, count) = self.drum.heads.batter.order(mode.m);
        let head = &self.drum.heads.batter.membrane;
        let slip = |i: usize| head.slip(&head.modes()[first + i], omega);
        let followed = |i| slip(i).velocity;
        let radial = self.radial(mode, place, &self.near_shapes, [first, count, 0], followed);
        let [mut re, mut im] = self.near.transfer(&Radiator { m: mode.m, radial: &radial, omega });
        if let Outside::Free { .. } = self.spec.outside() {
            let radius = self.spec.radius();
            let ka = omega * radius / SPEED_OF_SOUND;
            let space = 0.5 * diffraction::baffling(ka);
            let gain = diffraction::near_gain(ka, self.fills);
            (re, im) = (re * gain, im * gain);
            let radial = match (&self.drum.heads.resonant, &self.far_shapes) {
                (Some(head), Some(shapes)) => {
                    let (far_first, far_count) = head.order(mode.m);
                    let mut radial = self.radial(mode, place, shapes, [far_first, far_count, count], |_| 1.0);
                    if mode.m == 0 {
                        let port = mode.outlet(place);
                        radial.iter_mut().for_each(|moved| *moved += port);
                    }
                    Some(radial)
                }
                // An open end moves as a piston.
                _ if mode.m == 0 => Some(vec![mode.outlet(place); self.far.radii().len()]),
                _ => None,
            };
            if let Some(radial) = radial {
                let [far_re, far_im] = self.far.transfer(&Radiator { m: mode.m, radial: &radial, omega });
                // Outward is toward the point for the one head and away for the other; the body
                // hides the far one as it becomes a baffle.
                let gain = -(1.0 - space);
                let (sin, cos) = (omega * self.lag).sin_cos();
                re += gain * (far_re * cos + far_im * sin);
                im += gain * (far_im * cos - far_re * sin);
            }
        }
        // The air on a mesh is late, by what it is in the part that moves most.
        let size = |i: usize| mode.share(i, place).abs();
        let most = (0..count).max_by(|&i, &k| size(i).total_cmp(&size(k)));
        let lag = most.map_or(0.0, |i| slip(i).lag);
        let (sin, cos) = lag.sin_cos();
        [(re * cos + im * sin) as f32, (im * cos - re * sin) as f32]
    }
}

#[cfg(test)]
mod tests;
