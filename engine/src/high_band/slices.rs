//! The slices of a high band: where each lies, what it weighs, what a force moves of it, how it is heard.
//!
//! The equations are in the docs of the [high band](crate::high_band).

use std::f64::consts::{PI, TAU};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::diffraction::{self, Outside};
use crate::math::cubic::Stencil;
use crate::math::trigonometry::sin_cos;
use crate::membrane::MembraneSpec;
use crate::membrane::mesh::Slip;
use crate::modal::Mode;
use crate::patch_factors::PatchFactors;
use crate::receiver::{DIRECTIONS, POINTS, ReceiverPosition};
use crate::split::hash;

/// Slices in an octave. *Judgement*: a sum of modes that lose 60 dB in 0.2 s is heard as noise from some 0.1 modes per hertz
/// on, which these have at 4 kHz; a head has four times as many.
pub const SLICES: f64 = 300.0;

/// Slices in an octave of a drum with wires, which keep on setting its heads going. *Chosen* between 300 and 900: while forces act, phases do
/// not walk, and slices so far apart are heard at several microphones as a comb. The snare's mix has a spread of 5.5 dB from 5 to 12 kHz with
/// 300 and 5.3 with 900; recordings, and noise, have 5.0. More were not tried, for their cost.
pub const SLICES_UNDER_WIRES: f64 = 900.0;

/// Highest frequency, Hz, and its largest share of the sample rate.
const TOP_HZ: f64 = 16_000.0;
const TOP_OF_RATE: f64 = 0.45;

/// Where the head is heard from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    /// The point, seen from the head's centre.
    pub point: ReceiverPosition,
    /// Points far away, one in each direction.
    pub away: [ReceiverPosition; DIRECTIONS],
    /// What surrounds the drum.
    pub outside: Outside,
    /// Whether the head is on the far side of the drum.
    pub far: bool,
}

/// What a high band is made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighBandSpec {
    /// The head.
    pub head: MembraneSpec,
    /// Lowest tension it will be asked for, the one at which slices are laid out, and the highest, N/m.
    pub tensions: [f64; 3],
    /// Modes (pairs as two) of the complete set, all below the slices.
    pub complete: usize,
    /// Slices in an octave.
    pub density: f64,
    /// Where it is heard from.
    pub ear: Receiver,
    /// Nothing is lost.
    pub lossless: bool,
    /// Hz.
    pub sample_rate: f64,
    /// Tells the chance of one head from another's.
    pub seed: u32,
    /// Places that forces can act on at once, at most [`MAX_DRIVES`](crate::modal::MAX_DRIVES).
    pub places: usize,
    /// Whether these are more than half a wave apart.
    pub apart: bool,
    /// Decay rate by the air over that of waves on an endless head with air on one side, dimensionless.
    pub air_loss: f64,
}

impl HighBandSpec {
    /// With the mean loss to the air of some of the head's complete modes, given as angular frequency (rad/s) and decay rate (1/s), at a
    /// tension (N/m); as it is if there are none.
    pub fn losing_as(self, modes: impl Iterator<Item = (f64, f64)>, tension: f64) -> HighBandSpec {
        let (mut sum, mut count) = (0.0, 0.0);
        for (omega, sigma) in modes {
            let zero = wavenumber(&self.head, omega, tension);
            let (_, air, mass) = wave(&self.head, zero, tension);
            sum += (sigma - by_solids(&self.head, zero, (omega, mass), tension)) / air;
            count += 1.0;
        }
        let air_loss = if count > 0.0 { (sum / count).max(0.0) } else { self.air_loss };
        HighBandSpec { air_loss, ..self }
    }
}

/// One slice: a chance wave.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slice {
    /// `k a`.
    pub(super) zero: f64,
    /// Modes it stands for.
    pub(super) count: f64,
    /// Where the wave runs, as cosine and sine, and its phase, rad.
    pub(super) direction: [f64; 2],
    pub(super) phase: f64,
    /// Phases in which it is heard at each point, as cosine and sine, and how loud for what the drum's body does
    /// to it.
    pub(super) heard: [[f64; 2]; POINTS],
    pub(super) gain: f64,
    /// How much more it moves on a dot than beside it.
    pub(super) on_dot: f64,
}

/// The slices' waves side by side, `[slice]`.
pub(super) struct Waves {
    /// `k a`.
    zero: Vec<f64>,
    /// Cosine and sine of the direction.
    along: [Vec<f64>; 2],
    /// rad.
    phase: Vec<f64>,
    /// What every wave takes from patches (m).
    pub(super) pressed: PatchFactors,
}

impl Waves {
    pub(super) fn new(spec: &HighBandSpec, slices: &[Slice]) -> Waves {
        let takes = |patch: f64| slices.iter().map(|slice| taken(spec, slice, patch)).collect();
        let each = |of: fn(&Slice) -> f64| slices.iter().map(of).collect();
        Waves {
            zero: each(|slice| slice.zero),
            along: [each(|slice| slice.direction[0]), each(|slice| slice.direction[1])],
            phase: each(|slice| slice.phase),
            pressed: PatchFactors::new(1.0, takes),
        }
    }

    /// Every wave and its image in the rim at a place, `cos(j r c + phase) - cos(j (2 - r) c + phase)` with `c` the cosine of the
    /// angle between, dimensionless, into as many of `out`.
    #[inline(always)]
    pub(super) fn fill(&self, radius: f64, angle: f64, out: &mut [f32]) {
        let (sin, cos) = angle.sin_cos();
        let [along_cos, along_sin] = &self.along;
        let count = self.zero.len();
        let (zero, phase, out) = (&self.zero[..count], &self.phase[..count], &mut out[..count]);
        let (along_cos, along_sin) = (&along_cos[..count], &along_sin[..count]);
        // A plain loop: what an iterator calls would be compiled for the baseline.
        for k in 0..count {
            let around = zero[k] * (cos * along_cos[k] + sin * along_sin[k]);
            // The difference of two cosines is twice the product of two sines.
            out[k] = (2.0 * sin_cos(around + phase[k]).0 * sin_cos((1.0 - radius) * around).0) as f32;
        }
    }
}

/// Share of a point's force that a slice's wave takes from a patch (m).
pub(super) fn taken(spec: &HighBandSpec, slice: &Slice, patch: f64) -> f64 {
    pressed(slice.zero * patch / spec.head.radius)
}

/// Share of a point's force that a wave takes from a patch of `k b`.
pub(super) fn pressed(kb: f64) -> f64 {
    // The series where the difference would cancel.
    if kb < 0.1 { 1.0 - kb * kb / 16.0 } else { 4.0 * (1.0 - libm::j0(kb)) / (kb * kb) }
}

/// Amplitude (ratio) of a diffuse field of waves on a dot over that beside it: the square goes with the modes per area and mass,
/// `k dk/domega / s`, which is how much a point takes of a force.
fn on_dot(head: &MembraneSpec, omega: f64, tension: f64) -> f64 {
    let Some(dot) = head.added_by_dot() else { return 1.0 };
    let mobility = |density: f64, rigidity: f64| {
        let root = (tension * tension + 4.0 * rigidity * density * omega * omega).sqrt();
        // `k^2 = 2 s omega^2 / (T + root)`, and `d(k^2)/domega / s` is this.
        2.0 * omega / root
    };
    let (film, rigidity) = (head.area_density(), head.flexural_rigidity());
    (mobility(film + dot.density, rigidity + dot.rigidity) / mobility(film, rigidity)).sqrt()
}

/// Whether a place (share of the radius) lies on the dot.
pub(super) fn lies_on_dot(head: &MembraneSpec, place: f64) -> bool {
    head.added_by_dot().is_some_and(|dot| place < dot.reach)
}

/// Highest frequency heard at a sample rate, Hz.
pub(super) fn top_hz(sample_rate: f64) -> f64 {
    TOP_HZ.min(TOP_OF_RATE * sample_rate)
}

/// `N(k)`.
fn modes_below(zero: f64) -> f64 {
    0.25 * zero * zero - 0.5 * zero
}

/// Cosine and sine of an angle (rad).
fn cos_sin(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// Modes that a slice stands for at least. *Judgement*: next to none. Of some large heads drawn at random the wave at the end of a slice is found
/// no shorter than that at its beginning, why has not been looked into.
const LEAST_COUNT: f64 = 0.01;

/// Cuts the band.
pub(super) fn slices(spec: &HighBandSpec) -> Vec<Slice> {
    let [slackest, tension, _] = spec.tensions;
    let step = (1.0 / spec.density).exp2();
    let mut slices: Vec<Slice> = Vec::new();
    let gain = gain(spec);
    // Where the complete set ends: N(k) solved for k.
    let mut low = 1.0 + (1.0 + 4.0 * spec.complete as f64).sqrt();
    let mut omega = wave(&spec.head, low, tension).0;
    while wave(&spec.head, low, slackest).0 < TAU * top_hz(spec.sample_rate) {
        omega *= step;
        let high = wavenumber(&spec.head, omega, tension);
        let draw = |what| hash(spec.seed, slices.len() as u32, 0, what);
        // Anywhere in its slice: an even ladder of frequencies would be heard as one.
        let zero = low * (high / low).powf(draw(0));
        slices.push(Slice {
            zero,
            count: (modes_below(high) - modes_below(low)).max(LEAST_COUNT),
            direction: cos_sin(TAU * draw(1)),
            phase: TAU * draw(2),
            heard: std::array::from_fn(|i| cos_sin(TAU * draw(3 + i as u32))),
            gain: gain(omega),
            on_dot: on_dot(&spec.head, omega, tension),
        });
        low = high;
    }
    slices
}

/// Share of a slice's stiffness that is the head's tension (N/m), dimensionless; the rest is the film's.
pub(super) fn tension_share(spec: &HighBandSpec, slice: &Slice, tension: f64) -> f64 {
    let k2 = (slice.zero / spec.head.radius).powi(2);
    tension / (tension + spec.head.flexural_rigidity() * k2)
}

/// Rate at which the modes of a slice lose their common phase, 1/s: the half width in rad/s of a line as wide as the slice
/// (half power), less the share that each mode has with itself; none of a slice narrower than the distance of modes.
pub(super) fn walk_rate(spec: &HighBandSpec, slice: &Slice, omega: f64) -> f64 {
    0.5 * std::f64::consts::LN_2 / spec.density * omega * (1.0 - 1.0 / slice.count).max(0.0)
}

/// Undamped angular frequency (rad/s), decay rate by radiation and by the flow through a mesh (1/s) and mass per area with its air
/// (kg/m2) of waves on an endless head, `zero` being `k a`.
pub(super) fn wave(head: &MembraneSpec, zero: f64, tension: f64) -> (f64, f64, f64) {
    let k2 = (zero / head.radius).powi(2);
    let stiffness = (tension + head.flexural_rigidity() * k2) * k2;
    let film = head.area_density();
    // Far slower than sound, to begin with.
    let (mut sigma, mut mass) = (0.0, film + 2.0 * DENSITY / k2.sqrt());
    let mut omega = (stiffness / mass).sqrt();
    // The air weighs less, the higher: each round gains a digit or two.
    for _ in 0..12 {
        let sound = omega / SPEED_OF_SOUND;
        let (gap, eta) = (k2 - sound * sound, 4.0 * sound / (PI * head.radius));
        // 1 / sqrt(gap - i eta)
        let size = (gap * gap + eta * eta).sqrt();
        let (re, im) = ((0.5 * (size + gap)).sqrt() / size, (0.5 * (size - gap)).max(0.0).sqrt() / size);
        let slip = slip(head, 2.0 * DENSITY * re, omega);
        mass = film + 2.0 * DENSITY * re * slip.mass;
        sigma = (omega * DENSITY * im * slip.velocity.powi(2) + slip.resistance) / (2.0 * mass);
        let next = (stiffness / mass).sqrt();
        let settled = (next / omega - 1.0).abs() < 1e-7;
        omega = next;
        if settled {
            break;
        }
    }
    (omega, sigma, mass)
}

/// `k a` of the wave at an angular frequency.
fn wavenumber(head: &MembraneSpec, omega: f64, tension: f64) -> f64 {
    let mut zero = omega * head.radius * (head.area_density() / tension).sqrt();
    for _ in 0..20 {
        // Frequency goes as its first power where tension rules and as its second where stiffness does; what the air weighs changes
        // that by some percent, so that each round gains a digit or more.
        let stiff = head.flexural_rigidity() * (zero / head.radius).powi(2);
        let power = (tension + stiff) / (tension + 2.0 * stiff);
        let change = (omega / wave(head, zero, tension).0).powf(power);
        zero *= change;
        if (change - 1.0).abs() < 1e-9 {
            break;
        }
    }
    zero
}

/// Tensions at which modes are worked out. *Converged*: between, frequencies over two octaves of pitch are met within 1e-5.
const TENSIONS: usize = 13;

/// A slice at a tension, without muffling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TunedSlice {
    pub(super) mode: Mode,
    /// Pressure at the point over the acceleration of all its modes, Pa s2/m.
    pub(super) loudness: f64,
}

impl TunedSlice {
    fn new(spec: &HighBandSpec, slice: &Slice, tension: f64) -> TunedSlice {
        let mode = mode(spec, slice, tension);
        TunedSlice { mode, loudness: loudness(spec, slice, mode.omega) / slice.count.sqrt() }
    }
}

/// All slices over the range of tensions, worked out beforehand.
pub(super) struct SliceTable {
    /// Logarithms of the lowest and the highest tension.
    range: [f64; 2],
    /// `[slice][tension]`.
    slices: Vec<[TunedSlice; TENSIONS]>,
}

impl SliceTable {
    /// Of slices. Allocates.
    pub(super) fn new(spec: &HighBandSpec, slices: &[Slice]) -> SliceTable {
        let [low, _, high] = spec.tensions.map(f64::ln);
        let at = |i: usize| (low + (high - low) * i as f64 / (TENSIONS - 1) as f64).exp();
        let over = |slice: &Slice| std::array::from_fn(|i| TunedSlice::new(spec, slice, at(i)));
        SliceTable { range: [low, high], slices: slices.iter().map(over).collect() }
    }

    /// Every slice at a tension (N/m) within the range.
    pub(super) fn at(&self, tension: f64) -> impl Iterator<Item = TunedSlice> + '_ {
        let [low, high] = self.range;
        let share = if high > low { (tension.ln() - low) / (high - low) } else { 0.0 };
        let stencil = Stencil::at(share * (TENSIONS - 1) as f64, TENSIONS);
        self.slices.iter().map(move |slices| {
            let between = |of: fn(&TunedSlice) -> f64| {
                let values: [f64; 4] = std::array::from_fn(|i| of(&slices[stencil.first + i]));
                // Where a wave becomes as fast as sound, its losses have a peak that a cubic would undershoot about.
                let [least, most] = [f64::min, f64::max].map(|of| values.into_iter().fold(values[0], of));
                stencil.blend_all(values).clamp(least, most)
            };
            TunedSlice {
                mode: Mode {
                    omega: between(|slice| slice.mode.omega),
                    sigma: between(|slice| slice.mode.sigma),
                    mass: between(|slice| slice.mode.mass),
                },
                loudness: between(|slice| slice.loudness),
            }
        })
    }
}

pub(super) fn mode(spec: &HighBandSpec, slice: &Slice, tension: f64) -> Mode {
    let (omega, air, mass) = wave(&spec.head, slice.zero, tension);
    let solids = by_solids(&spec.head, slice.zero, (omega, mass), tension);
    let sigma = if spec.lossless { 0.0 } else { solids + spec.air_loss * air };
    Mode { omega, sigma, mass: mass * spec.head.area() / slice.count }
}

/// Decay rate by the film, its edge and what is glued to it of waves of `k a`, of that angular frequency (rad/s) and mass with its air
/// (kg/m2), 1/s.
fn by_solids(head: &MembraneSpec, zero: f64, (omega, mass): (f64, f64), tension: f64) -> f64 {
    let edge = head.edge_sigma(tension, zero / head.radius, mass, omega);
    // Waves are on the dot for its share of the area.
    let glue = head.added_by_dot().map_or(0.0, |dot| dot.reach.powi(2) * dot.loss.sigma(omega));
    head.loss.sigma(omega) + edge + glue
}

/// Root mean square of `int W e^(i x) dA` over the real modes, m2.
pub(super) fn rim_strip(spec: &HighBandSpec, slice: &Slice, omega: f64) -> f64 {
    let (a, j) = (spec.head.radius, slice.zero);
    let u = omega * a / SPEED_OF_SOUND * spec.ear.point.inclination.sin();
    // A wave as fast as sound meets the rim only so long.
    let apart = (j * j - u * u).hypot(2.0 * j);
    a * a * (8.0 * PI * j).sqrt() / apart
}

/// Pressure at once per unit force on an endless sheet at a place, Pa/N; nothing at the rim, which does not move.
pub(super) fn endless_sheet(spec: &HighBandSpec, slices: &[Slice], radius: f64, angle: f64) -> f64 {
    let Some(first) = slices.first() else { return 0.0 };
    let gain = slices.iter().map(|slice| slice.gain).sum::<f64>() / slices.len() as f64;
    let free = 1.0 - libm::j0(2.0 * first.zero * (1.0 - radius));
    let distance = spec.ear.point.distance_to(radius * spec.head.radius, angle);
    let dot =
        spec.head.added_by_dot().filter(|_| lies_on_dot(&spec.head, radius)).map_or(0.0, |dot| dot.density);
    // Into the head is away from the point.
    let followed = followed(&spec.head, first.zero, wave(&spec.head, first.zero, spec.tensions[1]).0);
    -free * gain * followed * DENSITY / (TAU * distance * (spec.head.area_density() + dot))
}

/// Pressure at the point over the acceleration of one real mode, root mean square, Pa s2/m.
pub(super) fn loudness(spec: &HighBandSpec, slice: &Slice, omega: f64) -> f64 {
    let near = spec.ear.point.rim_nearness(spec.head.radius);
    slice.gain * followed(&spec.head, slice.zero, omega) * DENSITY / TAU
        * rim_strip(spec, slice, omega)
        * near
}

/// Velocity of the air over that of a head in waves of `k a` shorter than sound's, 1 on a tight film.
fn followed(head: &MembraneSpec, zero: f64, omega: f64) -> f64 {
    let gap = (zero / head.radius).powi(2) - (omega / SPEED_OF_SOUND).powi(2);
    // At the speed of sound the air's mass has no end; the rim makes one.
    let length = gap.max((zero / head.radius).powi(2) / 16.0).sqrt().recip();
    slip(head, 2.0 * DENSITY * length, omega).velocity
}

/// How air of that mass (kg/m2) follows a head.
fn slip(head: &MembraneSpec, air: f64, omega: f64) -> Slip {
    head.mesh.map_or(Slip::NONE, |mesh| Slip::new(&mesh, head.thickness, air, omega))
}

/// How much louder the slices are far away, as at a metre, in each direction, than at the point, in the mean: they come by chance
/// in any phase here and there.
pub(super) fn away(spec: &HighBandSpec, slices: &[Slice]) -> [f32; DIRECTIONS] {
    spec.ear.away.map(|point| away_at(spec, slices, point))
}

/// The same at one point.
fn away_at(spec: &HighBandSpec, slices: &[Slice], point: ReceiverPosition) -> f32 {
    let from_away = HighBandSpec { ear: Receiver { point, ..spec.ear }, ..*spec };
    let gain = gain(&from_away);
    let ratio = |slice: &Slice| {
        let (omega, _, _) = wave(&spec.head, slice.zero, spec.tensions[1]);
        let there = loudness(&from_away, &Slice { gain: gain(omega), ..*slice }, omega);
        (there * point.distance / loudness(spec, slice, omega)).ln()
    };
    (slices.iter().map(ratio).sum::<f64>() / slices.len().max(1) as f64).exp() as f32
}

/// Amplitude at the point over that of the same head in a baffle, by angular frequency (rad/s).
fn gain(spec: &HighBandSpec) -> impl Fn(f64) -> f64 {
    let Receiver { point, outside, far, .. } = spec.ear;
    let radius = spec.head.radius;
    let fills = point.fills(radius);
    move |omega| match outside {
        Outside::Baffle => 1.0,
        Outside::Free { .. } if far => {
            0.5 * diffraction::toward(omega * radius / SPEED_OF_SOUND, -point.inclination.cos())
        }
        Outside::Free { .. } => diffraction::near_gain(omega * radius / SPEED_OF_SOUND, fills),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Material;
    use crate::damping::LossLaw;
    use crate::membrane::dot::DotSpec;

    #[test]
    fn a_dot_holds_back_where_heads_bend_and_not_where_they_are_only_stretched() {
        let dot = DotSpec { diameter: 0.127, thickness: 0.25e-3, loss: LossLaw::NONE };
        let head = MembraneSpec {
            radius: 0.1778,
            thickness: 0.25e-3,
            plies: 1,
            material: Material::FILM,
            loss: LossLaw::NONE,
            edge: None,
            dot: Some(dot),
            mesh: None,
        };
        let share = |hz: f64, tension: f64| on_dot(&head, TAU * hz, tension);
        assert!((share(100.0, 1e6) - 1.0).abs() < 1e-3);
        // Twice the mass, eight times the rigidity: the mobility of a plate, `1 / (8 sqrt(D s))`, is a quarter.
        assert!((share(10_000.0, 1e-3) - 0.5).abs() < 1e-6, "{}", share(10_000.0, 1e-3));
        assert_eq!(on_dot(&MembraneSpec { dot: None, ..head }, 1.0, 1.0), 1.0);
        assert!(lies_on_dot(&head, 0.3) && !lies_on_dot(&head, 0.4));
    }
}
