//! The stretch of displaced heads: tension that grows with the square of the displacement.
//!
//! Model: a head pushed out of its plane is longer; its tension rises, everywhere alike (Berger), by
//!
//! ```text
//! dT = E h / (4 (1 - nu)) S,   S = sum k^2 q^2
//! ```
//!
//! with `q` the displacements of the head's own modes, of unit mean square, `k` their wavenumbers. The mean strain
//! is `S / 4`; past the film's yield strain the tension grows no more. The potential is `A dT S / 4` up
//! to there and a straight line in `S` beyond: never negative, and its gradient continuous.
//!
//! About the tip that came last the struck head is tenser than that: see `dent.rs` beside.
//!
//! The struck head and the resonant head stretch alike, each by its own displacement. The drum's modes mix those of the heads,
//! within each order. Modes that are [mixed](super::mixing) of many orders stretch a head each by itself: what they are made of has
//! nearly one wavenumber, and the sum over all of them is the same. Shares are those of the default pitch.
//!
//! Modes above 1.5 kHz hold next to none of a stroke's energy: they do not stretch the heads, but their frequencies follow the
//! tension; [`StretchModel::above`] tells by how much.
//!
//! Source: Berger, J. Appl. Mech. 22, 1955; Avanzini & Marogna, IEEE TASLP 18, 2010.

use std::collections::BTreeMap;

use crate::drum::dent::Dent;
use crate::drum::heads::TunedHead;
use crate::drum::mixing::{self, MixedModes};
use crate::drum::modes::DrumModes;
use crate::drum::tuned::PitchPosition;
use crate::membrane::MembraneSpec;
use crate::modal::simd::blocks::{Block, BlockProduct};
use crate::modal::simd::{Kernels, LANES};
use crate::modal::{Row, zero_row};
use crate::potential::{Evaluation, HEADS, Potential};
use crate::split::Splitting;

/// Modes of the drum up to this stretch the heads, Hz. *Converged*: lower, and the dent around a hard
/// stroke holds too little of its tension; a kick at 6 m/s then glides by half of what it should.
const LIMIT_HZ: f64 = 1500.0;

/// Strain at which polyester film yields. *Literature*.
const YIELD_STRAIN: f64 = 0.03;

/// Rate of the evaluations, Hz. A force renewed so often has its images where nobody hears them. *Converged*: with half of it third octaves are
/// within 0.07 dB in the mean, but of what rings of a tom from 8 to 11 kHz 20 to 120 ms after a stroke images are only 7 dB under the high band.
const RATE: f64 = 22_000.0;

/// Samples between evaluations at a sample rate (Hz).
pub fn stride(sample_rate: f64) -> u32 {
    ((sample_rate / RATE) as u32).max(1)
}

/// The members of a mode among the body's, and by head its shares times the wavenumbers.
type BentMode = (Vec<u32>, [Vec<f64>; HEADS]);

/// The stretching energy of one head. `S` is a quadratic form in the drum's modes; only modes of one order
/// and member meet in it, so its matrix is made of blocks, alike for both members.
struct HeadStretch {
    /// m2.
    area: f64,
    /// `A E h / (16 (1 - nu))`: energy over `S^2`, J.
    stiffness: f64,
    /// The blocks' matrices, 1/m2, as [`Kernels::blocks`] wants them.
    matrix: Row,
    /// Displacements in the order of the blocks times the matrix.
    product: Row,
    /// `S` of each mixed mode by itself, 1/m2; they follow the modes of the blocks.
    mixed: Row,
    mixed_product: Row,
    /// Sum of the tensions of the evaluations since they were asked for, N/m.
    tension: f64,
}

impl HeadStretch {
    /// Of a head; `rows` in the order of the blocks.
    fn new(spec: &MembraneSpec, columns: &[f32], rows: usize, mixed: &[f64]) -> HeadStretch {
        let mut head = HeadStretch {
            area: spec.area(),
            stiffness: energy_factor(spec),
            matrix: zero_row(columns.len()),
            product: zero_row(rows),
            mixed: zero_row(mixed.len()),
            mixed_product: zero_row(mixed.len()),
            tension: 0.0,
        };
        head.matrix.copy_from_slice(columns);
        head.mixed.iter_mut().zip(mixed).for_each(|(row, square)| *row = *square as f32);
        head
    }

    /// Energy, J, and its derivative by `S`, J, at displacements in the order of the blocks and of the mixed modes; leaves half the
    /// gradient of `S` in the products.
    fn evaluate(&mut self, kernels: Kernels, blocks: &[Block], sorted: &[f32], mixed: &[f32]) -> (f64, f64) {
        let HeadStretch { matrix, product, .. } = self;
        kernels.blocks(BlockProduct { blocks, matrix, x: sorted, y: product });
        let kept = f64::from(kernels.dot(sorted, product));
        let rows = self.mixed_product.iter_mut().zip(&*self.mixed).zip(mixed);
        rows.for_each(|((out, square), q)| *out = square * q);
        let s = kept + f64::from(kernels.dot(&self.mixed_product, mixed));
        let most = 4.0 * YIELD_STRAIN;
        let slope = 2.0 * self.stiffness * s.min(most);
        self.tension += 2.0 * slope / self.area;
        let energy = if s <= most { 0.5 * slope * s } else { slope * (s - 0.5 * most) };
        (energy, slope)
    }
}

/// The stretching energy of a drum's heads.
pub struct Stretch {
    kernels: Kernels,
    blocks: Vec<Block>,
    /// The rows of the body's first modes, `[mode]`.
    rows: Vec<u32>,
    /// Displacements in the order of the blocks.
    sorted: Row,
    /// The struck one first.
    heads: Vec<HeadStretch>,
    /// What the tip that came last stretches the struck one more, unless all of it stretches alike.
    dent: Option<Dent>,
    /// Evaluations since the tensions were asked for.
    evaluations: u32,
}

impl Stretch {
    /// Lets the struck head stretch everywhere alike, however it is dented.
    pub fn evenly(self) -> Stretch {
        Stretch { dent: None, ..self }
    }
}

/// The stretch of a drum, and what it means for modes that do not take part in it.
pub struct StretchModel {
    /// Acts on the body's first modes.
    pub potential: Stretch,
    /// How many.
    pub modes: usize,
    /// Of each further mode of the body: its stiffness per tension that is added to each head, dimensionless, `[mode][head]`.
    pub above: Vec<[f64; HEADS]>,
}

impl StretchModel {
    /// The stretch of a drum's heads; the modes of the body are the drum's below the limit at that
    /// pitch (Hz), pairs as two. Allocates.
    pub fn new(drum: &DrumModes, mixed: Option<&MixedModes>, pitch_hz: f64) -> StretchModel {
        let place = drum.heads.scale.place(pitch_hz);
        let limit = std::f64::consts::TAU * LIMIT_HZ;
        let heads = heads(drum);
        // Modes with their shares times the wavenumbers, by order.
        let mut sorted: BTreeMap<u32, Vec<BentMode>> = BTreeMap::new();
        let mut count = 0;
        let kept = mixed.map_or(drum.modes.len(), |_| drum.kept);
        for (index, mode) in drum.modes[..kept].iter().enumerate() {
            if mode.at(&place).omega >= limit {
                break;
            }
            let members = count..count + Splitting::ROUND.members(mode.m, 0).count() as u32;
            count = members.end;
            sorted.entry(mode.m).or_default().push((members.collect(), bent(drum, index, &place)));
        }
        let (mut blocks, mut modes, mut start) = (Vec::new(), Vec::new(), 0);
        let mut columns = [const { Vec::new() }; HEADS];
        for (&m, mode) in &sorted {
            let block = Block { start, size: mode.len(), twice: m > 0 };
            start += block.rows();
            for (i, (members, a)) in mode.iter().enumerate() {
                let rows = members.iter().zip((block.start + i..).step_by(block.padded()));
                modes.extend(rows.map(|(&mode, row)| (mode, row as u32)));
                for (head, columns) in columns.iter_mut().enumerate() {
                    let along = |b: &[f64]| a[head].iter().zip(b).map(|(a, b)| a * b).sum::<f64>() as f32;
                    columns.extend(mode.iter().map(|(_, b)| along(&b[head])));
                    columns.resize(columns.len().div_ceil(LANES) * LANES, 0.0);
                }
            }
            blocks.push(block);
        }
        // In the order of the modes, so that their displacements are read in one go.
        modes.sort_unstable();
        let rows = modes.into_iter().map(|(_, row)| row).collect();
        // The body's first modes are all kept ones, then the mixed.
        let all_kept = drum.modes[..drum.kept].iter().all(|mode| mode.at(&place).omega < limit);
        let below = mixed
            .filter(|_| all_kept)
            .map_or(0, |mixed| (0..mixed.len()).take_while(|&k| mixed.at(k, &place).omega < limit).count());
        let alone = alone(drum, mixed, &place);
        let (first, modes) = (count as usize, count as usize + below);
        let waves = waves(drum, mixed, &place, &alone);
        let heads = heads.into_iter().enumerate().map(|(head, spec)| {
            let squares: Vec<f64> = alone[first..modes].iter().map(|squares| squares[head]).collect();
            HeadStretch::new(spec, &columns[head], start, &squares)
        });
        let potential = Stretch {
            kernels: Kernels::detect(),
            blocks,
            rows,
            sorted: zero_row(start),
            heads: heads.collect(),
            dent: Some(Dent::new(drum.heads.batter.membrane.spec(), &waves[..modes])),
            evaluations: 0,
        };
        let above = alone[modes..].iter().map(|squares| {
            std::array::from_fn(|head| potential.heads.get(head).map_or(0.0, |it| it.area * squares[head]))
        });
        let above = above.collect();
        StretchModel { above, potential, modes }
    }
}

/// The heads, the struck one first.
fn heads(drum: &DrumModes) -> Vec<&MembraneSpec> {
    let resonant = drum.heads.resonant.as_ref();
    [Some(&drum.heads.batter), resonant].into_iter().flatten().map(|head| head.membrane.spec()).collect()
}

/// Shares of a drum's mode in those of the heads, `[head]`, and the wavenumbers of these, 1/m.
fn shares(drum: &DrumModes, mode: usize, place: &PitchPosition) -> [Vec<(f64, f64)>; HEADS] {
    let mode = &drum.modes[mode];
    let (_, near) = drum.heads.batter.order(mode.m);
    let shares = |head: &TunedHead, before: usize| -> Vec<(f64, f64)> {
        let (first, count) = head.order(mode.m);
        let modes = &head.membrane.modes()[first..first + count];
        let wave = |zero: f64| zero / head.membrane.spec().radius;
        modes.iter().enumerate().map(|(i, bare)| (mode.share(before + i, place), wave(bare.zero))).collect()
    };
    let resonant = drum.heads.resonant.as_ref().map_or_else(Vec::new, |head| shares(head, near));
    [shares(&drum.heads.batter, 0), resonant]
}

/// Shares of a drum's mode times the wavenumbers, 1/m, by head.
fn bent(drum: &DrumModes, mode: usize, place: &PitchPosition) -> [Vec<f64>; HEADS] {
    shares(drum, mode, place).map(|shares| shares.into_iter().map(|(share, wave)| share * wave).collect())
}

/// `S` of each mode of the body by itself, 1/m2, `[mode][head]`.
fn alone(drum: &DrumModes, mixed: Option<&MixedModes>, place: &PitchPosition) -> Vec<[f64; HEADS]> {
    of_body(drum, mixed, |mode| bent(drum, mode, place).map(|bent| bent.iter().map(|a| a * a).sum::<f64>()))
}

/// The wavenumber of each mode of the body on the struck head, times its radius; `alone` as [`alone`] gives it.
fn waves(
    drum: &DrumModes,
    mixed: Option<&MixedModes>,
    place: &PitchPosition,
    alone: &[[f64; HEADS]],
) -> Vec<f64> {
    let squares = |shares: Vec<(f64, f64)>| shares.iter().map(|(share, _)| share * share).sum::<f64>();
    let held = of_body(drum, mixed, |mode| shares(drum, mode, place).map(squares));
    let radius = drum.heads.batter.membrane.spec().radius;
    let wave =
        |(s, held): (&[f64; HEADS], [f64; HEADS])| if held[0] > 0.0 { (s[0] / held[0]).sqrt() } else { 0.0 };
    alone.iter().zip(held).map(|both| radius * wave(both)).collect()
}

/// What each mode of the body has by head, in any unit, from what the drum's pairs have: of mixed ones the mean by their shares.
fn of_body(
    drum: &DrumModes,
    mixed: Option<&MixedModes>,
    of_pair: impl Fn(usize) -> [f64; HEADS],
) -> Vec<[f64; HEADS]> {
    let kept = mixed.map_or(drum.modes.len(), |_| drum.kept);
    let pairs: Vec<[f64; HEADS]> = (0..drum.modes.len()).map(of_pair).collect();
    let simple = (0..kept).flat_map(|pair| {
        std::iter::repeat_n(pairs[pair], Splitting::ROUND.members(drum.modes[pair].m, 0).count())
    });
    let even = mixing::even_modes(drum);
    let mixture = |mixed: &MixedModes, k: usize| {
        let mut sum = [0.0; HEADS];
        for (part, share) in mixed.mixture.parts(k) {
            let of_pair = pairs[even[part].pair];
            sum.iter_mut().zip(of_pair).for_each(|(sum, of_pair)| *sum += share * share * of_pair);
        }
        sum
    };
    let mixed = mixed.into_iter().flat_map(|mixed| (0..mixed.len()).map(move |k| mixture(mixed, k)));
    simple.chain(mixed).collect()
}

/// `A E h / (16 (1 - nu))`, J.
fn energy_factor(spec: &MembraneSpec) -> f64 {
    spec.area() * spec.material.youngs_modulus * spec.thickness / (16.0 * (1.0 - spec.material.poisson_ratio))
}

impl Potential for Stretch {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        for (&row, &q) in self.rows.iter().zip(displacement) {
            self.sorted[row as usize] = q;
        }
        let count = self.rows.len();
        let rest = &displacement[count..];
        gradient.fill(0.0);
        self.evaluations += 1;
        let mut sum = 0.0;
        for head in &mut self.heads {
            let (energy, slope) = head.evaluate(self.kernels, &self.blocks, &self.sorted, rest);
            sum += energy;
            let factor = 2.0 * slope as f32;
            for (gradient, &row) in gradient.iter_mut().zip(&self.rows) {
                *gradient += factor * head.product[row as usize];
            }
            let mixed = gradient[count..].iter_mut().zip(&*head.mixed_product);
            mixed.for_each(|(gradient, product)| *gradient += factor * product);
        }
        sum += self.dent.as_ref().map_or(0.0, |dent| dent.evaluate(displacement, gradient));
        Evaluation { energy: sum, depth: 0.0 }
    }

    fn press(&mut self, radius: f64, shapes: &[f32], displacement: &[f32]) -> f64 {
        self.dent.as_mut().map_or(0.0, |dent| {
            let before = dent.energy(displacement);
            dent.press(radius, shapes);
            dent.energy(displacement) - before
        })
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn take_tensions(&mut self) -> [f64; HEADS] {
        let evaluations = f64::from(std::mem::take(&mut self.evaluations).max(1));
        let mut means = [0.0; HEADS];
        for (mean, head) in means.iter_mut().zip(&mut self.heads) {
            *mean = std::mem::take(&mut head.tension) / evaluations;
        }
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;

    #[test]
    fn the_gradient_is_that_of_the_energy_below_and_beyond_yield() {
        let spec = reference::drum("rack-tom");
        let drum = DrumModes::new(&spec).unwrap();
        let mixed = MixedModes::new(&drum, &spec.unevenness().unwrap(), |_| 0.0);
        for mixed in [None, Some(&mixed)] {
            check(&spec, &drum, mixed);
        }
    }

    fn check(spec: &crate::drum::DrumSpec, drum: &DrumModes, mixed: Option<&MixedModes>) {
        let StretchModel { potential: mut stretch, modes, .. } =
            StretchModel::new(drum, mixed, spec.pitch_hz);
        let mut gradient = zero_row(modes);
        let mut scratch = zero_row(modes);
        let shapes: Vec<f32> = (0..modes).map(|k| (2.3 * k as f32).cos()).collect();
        stretch.press(0.3, &shapes, &scratch);
        for size in [1e-4_f32, 3e-3, 3e-2] {
            let mut q: Vec<f32> =
                (0..modes).map(|k| size * (1.7 * k as f32).sin() / (1.0 + k as f32)).collect();
            stretch.evaluate(&q, &mut gradient);
            for k in [0, 1, 5, modes / 2] {
                let (at, step) = (q[k], 3e-3 * size);
                q[k] = at + step;
                let up = stretch.evaluate(&q, &mut scratch).energy;
                q[k] = at - step;
                let down = stretch.evaluate(&q, &mut scratch).energy;
                q[k] = at;
                let slope = (up - down) / f64::from(2.0 * step);
                let error = (slope - f64::from(gradient[k])).abs();
                let scale = f64::from(gradient[0].abs().max(gradient[k].abs()));
                assert!(error < 2e-3 * scale, "{size} {k}: {slope} {}", gradient[k]);
            }
        }
    }

    #[test]
    fn the_gradient_holds_every_mode_and_the_energy_too() {
        // Below yield the energy goes with the fourth power of the displacement: by Euler's theorem `grad E . q = 4 E`.
        let spec = reference::drum("rack-tom");
        let drum = DrumModes::new(&spec).unwrap();
        let mixed = MixedModes::new(&drum, &spec.unevenness().unwrap(), |_| 0.0);
        let StretchModel { potential: mut stretch, modes, .. } =
            StretchModel::new(&drum, Some(&mixed), spec.pitch_hz);
        let (mut q, mut gradient) = (zero_row(modes), zero_row(modes));
        stretch.press(0.2, &vec![1.0; modes], &q);
        for k in 0..modes {
            q[k] = 1e-4;
            let energy = stretch.evaluate(&q[..modes], &mut gradient).energy;
            let work = f64::from(gradient[k]) * f64::from(q[k]);
            assert!(energy > 0.0 && (work / (4.0 * energy) - 1.0).abs() < 1e-5, "mode {k}: {work} {energy}");
            q[k] = 0.0;
        }
    }

    #[test]
    fn modes_that_do_not_stretch_the_heads_stiffen_by_the_whole_of_an_added_tension() {
        // Of a mode that is a head's alone, tension and the film's bending are all the stiffness there is.
        let mut spec = reference::drum("rack-tom");
        spec.batter.modes_to_hz = 3000.0;
        let drum = DrumModes::new(&spec).unwrap();
        // Where the drum is worked out: between, shares are blended by themselves.
        let pitch = drum.heads.scale.pitches()[crate::drum::heads::MIDDLE];
        let place = drum.heads.scale.place(pitch);
        let StretchModel { modes: first, above, .. } = StretchModel::new(&drum, None, pitch);
        let heads = [Some(&drum.heads.batter), drum.heads.resonant.as_ref()].map(Option::unwrap);
        let members = drum.modes.iter().flat_map(|mode| {
            let at = mode.at(&place);
            std::iter::repeat_n(at, Splitting::ROUND.members(mode.m, 0).count())
        });
        let mut compared = [0; HEADS];
        for (mode, above) in members.skip(first).zip(above) {
            let shares = [mode.batter, mode.resonant];
            let Some(of) = (0..HEADS).find(|&of| shares[of] > 0.9 && shares[1 - of].abs() < 1e-6) else {
                continue;
            };
            let (head, spec) = (heads[of], heads[of].membrane.spec());
            let by_tension = above[of] * head.tension(&place);
            let by_bending = above[of].powi(2) / spec.area() * spec.flexural_rigidity();
            let stiffness = mode.mass * mode.omega * mode.omega;
            let off = (by_tension + by_bending) / stiffness - 1.0;
            assert!(off.abs() < 2e-3, "{off} {mode:?}");
            compared[of] += 1;
        }
        assert!(compared.iter().all(|&modes| modes > 50), "{compared:?}");
    }
}
