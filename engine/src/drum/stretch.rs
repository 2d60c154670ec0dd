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
//! nearly one wavenumber, and the sum over all of them is the same. Shares follow the pitch; what that adds to the energy of heads that are
//! displaced is taken from the modes.
//!
//! Modes above 1.5 kHz (in the middle of the range) hold next to none of a stroke's energy: they do not stretch the heads, but their frequencies follow the
//! tension; [`StretchModel::above`] tells by how much.
//!
//! Source: Berger, J. Appl. Mech. 22, 1955; Avanzini & Marogna, IEEE TASLP 18, 2010.

use std::collections::BTreeMap;

use crate::cache::Shared;
use crate::drum::bending::{self, Bending};
use crate::drum::dent::Dent;
use crate::drum::heads::{MIDDLE, TunedHead};
use crate::drum::mixing::MixedModes;
use crate::drum::modes::DrumModes;
use crate::drum::tuned::PitchPosition;
use crate::membrane::MembraneSpec;
use crate::modal::simd::Kernels;
use crate::modal::simd::blocks::{Block, BlockProduct};
use crate::modal::{Row, zero_row};
use crate::potential::{Evaluation, HEADS, Potential};
use crate::split::Splitting;

/// Modes of the drum up to this in the middle of its range of pitches stretch the heads, Hz. Lower, and the dent around a hard
/// stroke holds too little of its tension; a kick at 6 m/s then glides by half of what it should. *Converged* for toms, which have no more, and
/// the snare; not for hard strokes on the kick (EXPERIMENTS.md).
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

/// The modes of one order that are not mixed, among the drum's and among the body's; of a pair the first member.
struct Order {
    m: u32,
    modes: Vec<[usize; 2]>,
}

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
    squares: Row,
    mixed_product: Row,
    /// Sum of the tensions of the evaluations since they were asked for, N/m.
    tension: f64,
}

impl HeadStretch {
    /// Of a head, for blocks of so many entries in so many rows and so many mixed modes, all still to be written.
    fn new(spec: &MembraneSpec, [entries, rows, mixed]: [usize; 3]) -> HeadStretch {
        HeadStretch {
            area: spec.area(),
            stiffness: energy_factor(spec),
            matrix: zero_row(entries),
            product: zero_row(rows),
            squares: zero_row(mixed),
            mixed_product: zero_row(mixed),
            tension: 0.0,
        }
    }

    /// Energy, J, and its derivative by `S`, J, at displacements in the order of the blocks and of the mixed modes; leaves half the
    /// gradient of `S` in the products.
    fn energy(&mut self, kernels: Kernels, blocks: &[Block], sorted: &[f32], mixed: &[f32]) -> (f64, f64) {
        let HeadStretch { matrix, product, .. } = self;
        kernels.blocks(BlockProduct { blocks, matrix, x: sorted, y: product });
        let kept = f64::from(kernels.dot(sorted, product));
        let rows = self.mixed_product.iter_mut().zip(&*self.squares).zip(mixed);
        rows.for_each(|((out, square), q)| *out = square * q);
        let s = kept + f64::from(kernels.dot(&self.mixed_product, mixed));
        let most = 4.0 * YIELD_STRAIN;
        let slope = 2.0 * self.stiffness * s.min(most);
        let energy = if s <= most { 0.5 * slope * s } else { slope * (s - 0.5 * most) };
        (energy, slope)
    }
}

/// The stretching energy of a drum's heads.
pub struct Stretch {
    kernels: Kernels,
    drum: Shared<DrumModes>,
    /// The mixed modes, and how many of the first of them stretch the heads.
    mixed: Option<(Shared<MixedModes>, usize)>,
    /// What each block holds.
    orders: Vec<Order>,
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
    /// Where shares times wavenumbers of one order are worked out, 1/m.
    bent: Vec<f64>,
}

impl Stretch {
    /// Sorts displacements, `[mode]`, into the blocks; returns those of the mixed modes.
    fn sort<'a>(&mut self, displacement: &'a [f32]) -> &'a [f32] {
        for (&row, &q) in self.rows.iter().zip(displacement) {
            self.sorted[row as usize] = q;
        }
        &displacement[self.rows.len()..]
    }

    /// Energy of the heads at displacements, `[mode]`, without that of a dent, J.
    fn energy(&mut self, displacement: &[f32]) -> f64 {
        let rest = self.sort(displacement);
        let Stretch { kernels, blocks, sorted, heads, .. } = self;
        heads.iter_mut().map(|head| head.energy(*kernels, blocks, sorted, rest).0).sum()
    }

    /// Takes over the shares of the modes at a pitch.
    ///
    /// # Real-time
    /// Some interpolations of each share of a mode that is not mixed, some of each mode that is.
    fn follow(&mut self, place: &PitchPosition) {
        let Stretch { drum, mixed, orders, blocks, rows, heads, dent, bent, .. } = self;
        for (far, (head, stretch)) in bending::heads(drum).zip(&mut *heads).enumerate() {
            let mut columns = &mut stretch.matrix[..];
            for (order, block) in orders.iter().zip(&*blocks) {
                let count = head.order(order.m).1;
                bent.clear();
                for &[mode, _] in &order.modes {
                    let shares = bending::shares(drum, (head, far > 0), &drum.modes[mode], place);
                    bent.extend(shares.map(|(share, wave)| share * wave));
                }
                for i in 0..block.size {
                    let (column, rest) = columns.split_at_mut(block.padded());
                    columns = rest;
                    for (k, out) in column[..block.size].iter_mut().enumerate() {
                        let [a, b] = [i, k].map(|mode| &bent[mode * count..][..count]);
                        *out = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() as f32;
                    }
                }
            }
        }
        let first = rows.len();
        if let Some((mixed, count)) = mixed {
            for k in 0..*count {
                let bending = mixed.bending(k, place);
                heads.iter_mut().zip(bending.squares).for_each(|(head, s)| head.squares[k] = s as f32);
                dent.iter_mut().for_each(|dent| dent.set_wave(first + k, bending.wave()));
            }
        }
        for (m, &[mode, body]) in orders.iter().flat_map(|order| order.modes.iter().map(|it| (order.m, it))) {
            let Some(dent) = dent else { break };
            let wave = Bending::of(drum, &drum.modes[mode], place).wave();
            let members = Splitting::ROUND.members(m, 0).count();
            (body..body + members).for_each(|member| dent.set_wave(member, wave));
        }
    }

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
    /// The stretch of a drum's heads at a pitch, Hz; the modes of the body are the drum's below the limit, pairs as two. Allocates.
    pub fn new(drum: &Shared<DrumModes>, mixed: Option<&Shared<MixedModes>>, pitch_hz: f64) -> StretchModel {
        let scale = drum.heads.scale;
        let [middle, place] = [scale.pitches()[MIDDLE], pitch_hz].map(|hz| scale.place(hz));
        let limit = std::f64::consts::TAU * LIMIT_HZ;
        let members = |m: u32| Splitting::ROUND.members(m, 0).count();
        // Modes that are not mixed, in the order of the body.
        let kept = &drum.modes[..if mixed.is_some() { drum.kept } else { drum.modes.len() }];
        let below = kept.iter().take_while(|mode| mode.at(&middle).omega < limit).count();
        let mut by_order: BTreeMap<u32, Vec<[usize; 2]>> = BTreeMap::new();
        let mut count = 0;
        for (index, mode) in kept[..below].iter().enumerate() {
            by_order.entry(mode.m).or_default().push([index, count]);
            count += members(mode.m);
        }
        let orders: Vec<Order> = by_order.into_iter().map(|(m, modes)| Order { m, modes }).collect();
        let (mut blocks, mut rows, mut start) = (Vec::new(), vec![0; count], 0);
        for Order { m, modes } in &orders {
            let block = Block { start, size: modes.len(), twice: *m > 0 };
            for (i, &[_, body]) in modes.iter().enumerate() {
                let members = (block.start + i..block.start + block.rows()).step_by(block.padded());
                rows[body..].iter_mut().zip(members).for_each(|(row, member)| *row = member as u32);
            }
            start += block.rows();
            blocks.push(block);
        }
        // The body's first modes are all kept ones, then the mixed.
        let mixed_below = mixed
            .filter(|_| below == kept.len())
            .map_or(0, |mixed| (0..mixed.len()).take_while(|&k| mixed.at(k, &middle).omega < limit).count());
        let entries = blocks.iter().map(|block| block.size * block.padded()).sum();
        let specs = || bending::heads(drum).map(|head| head.membrane.spec());
        let longest = |head: &TunedHead| {
            let shares = orders.iter().map(|order| order.modes.len() * head.order(order.m).1);
            shares.max().unwrap_or(0)
        };
        let bent = Vec::with_capacity(bending::heads(drum).map(longest).max().unwrap_or(0));
        let struck = &drum.heads.batter.membrane;
        let finest = struck.modes().iter().map(|mode| mode.zero).fold(0.0, f64::max);
        let modes = count + mixed_below;
        let mut potential = Stretch {
            kernels: Kernels::detect(),
            drum: drum.clone(),
            mixed: mixed.map(|mixed| (mixed.clone(), mixed_below)),
            orders,
            blocks,
            rows,
            sorted: zero_row(start),
            heads: specs().map(|spec| HeadStretch::new(spec, [entries, start, mixed_below])).collect(),
            dent: Some(Dent::new(struck.spec(), modes, finest / struck.spec().radius)),
            evaluations: 0,
            bent,
        };
        potential.follow(&place);
        let simple = kept[below..]
            .iter()
            .flat_map(|mode| std::iter::repeat_n(Bending::of(drum, mode, &place), members(mode.m)));
        let mixtures =
            mixed.into_iter().flat_map(|mixed| (mixed_below..mixed.len()).map(|k| mixed.bending(k, &place)));
        let areas: Vec<f64> = specs().map(MembraneSpec::area).collect();
        let by_tension = |bending: Bending| {
            std::array::from_fn(|head| areas.get(head).map_or(0.0, |area| area * bending.squares[head]))
        };
        StretchModel { above: simple.chain(mixtures).map(by_tension).collect(), potential, modes }
    }
}

/// `A E h / (16 (1 - nu))`, J.
fn energy_factor(spec: &MembraneSpec) -> f64 {
    spec.area() * spec.material.youngs_modulus * spec.thickness / (16.0 * (1.0 - spec.material.poisson_ratio))
}

impl Potential for Stretch {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let count = self.rows.len();
        let rest = self.sort(displacement);
        gradient.fill(0.0);
        self.evaluations += 1;
        let mut sum = 0.0;
        for head in &mut self.heads {
            let (energy, slope) = head.energy(self.kernels, &self.blocks, &self.sorted, rest);
            sum += energy;
            head.tension += 2.0 * slope / head.area;
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

    fn retune(&mut self, pitch_hz: f64, displacement: &[f32]) -> f64 {
        let before = self.energy(displacement);
        self.follow(&self.drum.heads.scale.place(pitch_hz));
        self.energy(displacement) - before
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
mod tests;
