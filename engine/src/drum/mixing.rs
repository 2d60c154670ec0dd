//! The modes of a drum whose heads are not evenly stretched.
//!
//! Model: with the modes of the even drum as coordinates (unit modal mass), the [tension field](super::tension_field) of each
//! head adds `T int tau grad(i) grad(j) dA` to the stiffness. Where modes lie farther apart than that, each keeps its
//! shape; where they crowd, the new modes are mixtures of many orders, each of which a stroke excites a little and which radiates a little. All that is
//! known of the even modes goes through the same mixture: shapes, losses, pressures, so that the drum stays reciprocal and
//! passive.
//!
//! Scheme: modes from [`MIXED_FROM`](super::tension_field::MIXED_FROM) times the drum's pitch on are mixed, in
//! [blocks]. The mixture is worked out in the middle of the range of pitches and
//! kept at all of them: tension moves all modes of a head alike. Frequencies, losses and masses follow the even modes' at every pitch.
//!
//! Limits: cavity modes, which do not move with the tension, are mixed as they lie in the middle of the range. Between two pitches of the table,
//! where a mode of the air passes one of a head, how a mixture bends the heads is up to a sixth off, by two hundredths in the sum over all.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::drum::bending::Bending;
use crate::drum::coupled::CoupledMode;
use crate::drum::heads::{MIDDLE, TunedHead};
use crate::drum::modes::DrumModes;
use crate::drum::tension_field::{TensionField, Unevenness};
use crate::drum::tuned::{Grid, ModeAtPitch, PitchPosition};
use crate::math::quadrature;
use crate::math::sums::sum_of_products;
use crate::modal::simd::Kernels;
use crate::mode::Member;
use crate::mode_mixture::ModeMixture;
use crate::mode_mixture::blocks::{self, around, named};
use crate::potential::HEADS;
use crate::split::Splitting;

/// The even modes of a drum, members of pairs one by one, and what becomes of them.
#[derive(Serialize, Deserialize)]
pub struct MixedModes {
    /// From even modes to mixed ones.
    pub mixture: ModeMixture,
    /// `[mixed mode]`: the even mode that it is most of.
    pub names: Vec<u32>,
    /// `[mixed mode][pitch of the coarse grid]`.
    entries: Vec<Entry>,
}

/// A mixed mode at one pitch; logarithms but for the shares.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Entry {
    omega: f32,
    sigma: f32,
    mass: f32,
    batter: f32,
    resonant: f32,
    flow: f32,
    /// [`Bending`]: its squares, 1/m2, and what the struck head holds.
    bending: [f32; HEADS + 1],
}

/// What adds up over the parts of a mixture: six numbers of [`ModeAtPitch`] and those of [`Bending`].
const SUMS: usize = 6 + HEADS + 1;

/// An even mode: which pair, and which member.
#[derive(Debug, Clone, Copy)]
pub struct EvenMode {
    /// Which of the drum's.
    pub pair: usize,
    /// Which member.
    pub member: Member,
}

/// All even modes in the order of the pairs.
pub fn even_modes(drum: &DrumModes) -> Vec<EvenMode> {
    let members = |(pair, m): (usize, u32)| {
        Splitting::ROUND.members(m, 0).map(move |(member, _)| EvenMode { pair, member })
    };
    drum.modes.iter().enumerate().flat_map(|(pair, mode)| members((pair, mode.m))).collect()
}

/// Radial motion of an even mode on one head at the nodes of the quadrature: displacement, and the sum of the head modes'
/// displacements times their squared `k a`.
struct Radial {
    displacement: Vec<f64>,
    bent: Vec<f64>,
}

/// One head's part in the matrix.
struct HeadPart {
    field: TensionField,
    /// `[pair]`.
    radial: Vec<Radial>,
    /// Tension times pi, N/m.
    tension: f64,
}

impl MixedModes {
    /// Mixes a drum's modes. `axis(m)` is the direction of the axes of pairs with `m` nodal diameters, rad. Allocates; takes
    /// tenths of a second.
    pub fn new(drum: &DrumModes, spec: &Unevenness, axis: impl Fn(u32) -> f64) -> MixedModes {
        let even = even_modes(drum);
        let kept = even.iter().filter(|mode| mode.pair < drum.kept).count();
        let mixed = &even[kept..];
        let problem = Problem::new(drum, spec, mixed, axis);
        let even_omegas: Vec<f64> = (0..mixed.len()).map(|i| problem.mode(i).omega).collect();
        let (omegas, rows) = blocks::solve(&even_omegas, |modes| problem.couplings(modes));
        MixedModes::tabulate(drum, &even, kept, &omegas, rows)
    }

    /// Where mixed mode `k` rings.
    ///
    /// # Real-time
    /// Three exponentials.
    pub fn at(&self, k: usize, place: &PitchPosition) -> ModeAtPitch {
        let stencil = place.of(Grid::Coarse);
        let pitches = Grid::Coarse.pitches().len();
        let row = &self.entries[k * pitches..][..pitches];
        let blend = |value: fn(&Entry) -> f32| stencil.blend(|i| f64::from(value(&row[i])));
        let share = |value: fn(&Entry) -> f32| stencil.blend_shares(|i| f64::from(value(&row[i])));
        ModeAtPitch {
            omega: blend(|entry| entry.omega).exp(),
            sigma: blend(|entry| entry.sigma).exp(),
            mass: blend(|entry| entry.mass).exp(),
            batter: share(|entry| entry.batter),
            resonant: share(|entry| entry.resonant),
            flow: share(|entry| entry.flow),
        }
    }

    /// How mixed mode `k` bends the heads.
    ///
    /// # Real-time
    /// Three interpolations.
    pub fn bending(&self, k: usize, place: &PitchPosition) -> Bending {
        let stencil = place.of(Grid::Coarse);
        let pitches = Grid::Coarse.pitches().len();
        let row = &self.entries[k * pitches..][..pitches];
        let [near, far, held] =
            std::array::from_fn(|i| stencil.blend(|pitch| f64::from(row[pitch].bending[i])).max(0.0));
        Bending { squares: [near, far], held }
    }

    /// Number of mixed modes.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether nothing is mixed.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The table over the pitches: `rows` are rotations of unit modal masses, `[mixed mode](first even mode, coefficients)`.
    fn tabulate(
        drum: &DrumModes,
        even: &[EvenMode],
        kept: usize,
        omegas: &[f64],
        rows: Vec<(usize, Vec<f64>)>,
    ) -> MixedModes {
        let scale = drum.heads.scale;
        let pitches = scale.pitches();
        let at = |pitch: usize| -> Vec<ModeAtPitch> {
            let place = scale.place(pitches[pitch]);
            drum.modes.iter().map(|mode| mode.at(&place)).collect()
        };
        let reference = at(MIDDLE);
        // What adds up over the parts of a mixture, `[pitch][pair]`: shapes of even modes have the modal masses of the middle pitch.
        let table = |pitch: usize| -> Vec<[f64; SUMS]> {
            let place = scale.place(pitches[pitch]);
            let rows = drum.modes.iter().zip(at(pitch)).zip(&reference);
            rows.map(|((mode, now), middle)| {
                let Bending { squares: [near, far], held } = Bending::of(drum, mode, &place);
                let ModeAtPitch { omega, sigma, mass, batter, resonant, flow } = now;
                let bent = [near, far, held].map(|it| it / middle.mass);
                [omega * omega, sigma, mass.recip(), batter, resonant, flow, bent[0], bent[1], bent[2]]
            })
            .collect()
        };
        let tables: Vec<Vec<[f64; SUMS]>> = Grid::Coarse.pitches().map(table).collect();
        let mut entries = Vec::with_capacity(rows.len() * tables.len());
        let mut coefs = Vec::with_capacity(rows.len());
        for ((first, row), omega) in rows.iter().zip(omegas) {
            let parts = || row.iter().enumerate().map(|(i, coef)| (even[kept + first + i].pair, coef * coef));
            let now: f64 = parts().map(|(pair, share)| share * reference[pair].omega.powi(2)).sum();
            let mass = parts().map(|(pair, share)| share / reference[pair].mass).sum::<f64>().recip();
            for table in &tables {
                let mut sums = [0.0; SUMS];
                for (pair, share) in parts() {
                    sums.iter_mut().zip(&table[pair]).for_each(|(sum, value)| *sum += share * value);
                }
                let [square, sigma, inverse_mass, batter, resonant, flow, bent @ ..] = sums;
                entries.push(Entry {
                    omega: (omega * (square / now).sqrt()).ln() as f32,
                    sigma: sigma.max(1e-9).ln() as f32,
                    mass: -inverse_mass.ln() as f32,
                    batter: batter as f32,
                    resonant: resonant as f32,
                    flow: flow as f32,
                    bending: bent.map(|it| (mass * it) as f32),
                });
            }
            let scaled = row
                .iter()
                .enumerate()
                .map(|(i, coef)| coef * (mass / reference[even[kept + first + i].pair].mass).sqrt());
            coefs.push((kept + first, scaled.collect()));
        }
        let names = named(&rows).into_iter().map(|name| (kept + name) as u32).collect();
        MixedModes { mixture: ModeMixture::new(kept, &coefs), names, entries }
    }
}

/// The perturbed eigenproblem.
struct Problem<'a> {
    drum: &'a DrumModes,
    mixed: &'a [EvenMode],
    heads: Vec<HeadPart>,
    weights: Vec<f64>,
    /// `[mixed mode]`: cosine and sine part of how it goes around.
    around: Vec<[f64; 2]>,
}

impl<'a> Problem<'a> {
    fn new(
        drum: &'a DrumModes,
        spec: &Unevenness,
        mixed: &'a [EvenMode],
        axis: impl Fn(u32) -> f64,
    ) -> Problem<'a> {
        let batter = &drum.heads.batter;
        let both = [Some(batter), drum.heads.resonant.as_ref()].into_iter().flatten();
        let zeros = both.flat_map(|head| head.membrane.modes()).map(|mode| mode.zero);
        let finest = zeros.fold(0.0, f64::max);
        // Two shapes and the field: a node for every radian and some.
        let rule = quadrature::shared_unit((0.8 * finest + 12.0 / spec.correlation()) as usize + 16);
        let weights: Vec<f64> =
            rule.nodes.iter().zip(&rule.weights).map(|(r, weight)| 2.0 * r * weight).collect();
        let pairs: Vec<usize> = mixed.iter().map(|mode| mode.pair).collect();
        let first = pairs.first().copied().unwrap_or(drum.modes.len());
        let part = |head: &TunedHead, far: bool| HeadPart {
            field: TensionField::of_head(spec, head.membrane.spec(), u32::from(far), &rule.nodes, &weights),
            radial: radial(drum, head, far, first, &rule.nodes),
            tension: PI * head.tensions[MIDDLE],
        };
        let mut heads = vec![part(batter, false)];
        heads.extend(drum.heads.resonant.as_ref().map(|head| part(head, true)));
        let around = mixed.iter().map(|mode| {
            let m = drum.modes[mode.pair].m;
            mode.member.around(m, axis(m))
        });
        Problem { drum, mixed, heads, weights, around: around.collect() }
    }

    fn mode(&self, i: usize) -> &CoupledMode {
        &self.drum.modes[self.mixed[i].pair].reference
    }

    /// What the fields add to the stiffness between two modes, 1/s2, given the overlaps of their pairs.
    fn coupling(&self, i: usize, j: usize, overlaps: &Overlaps) -> f64 {
        let [m, n] = [i, j].map(|k| self.drum.modes[self.mixed[k].pair].m);
        let [a, b] = [i, j].map(|k| self.around[k]);
        let mut sum = 0.0;
        for (head, overlaps) in self.heads.iter().zip(&overlaps.0) {
            for ((_, means), overlaps) in around((m, a), (n, b)).zip(overlaps) {
                let parts = means.into_iter().zip(overlaps);
                sum += head.tension * parts.map(|(mean, overlap)| mean * overlap).sum::<f64>();
            }
        }
        sum
    }

    /// The overlaps of the pairs of two modes; the rows, a number for each node, are for its own use.
    fn overlaps(&self, i: usize, j: usize, [product, bent]: &mut [Vec<f64>; 2]) -> Overlaps {
        let first = self.mixed[0].pair;
        let pairs = [i, j].map(|k| self.mixed[k].pair);
        let [m, n] = pairs.map(|pair| self.drum.modes[pair].m);
        let orders = [m.abs_diff(n), m + n].map(|l| l as usize);
        let mut overlaps = Overlaps::default();
        for (head, overlaps) in self.heads.iter().zip(&mut overlaps.0) {
            let [p, q] = pairs.map(|pair| &head.radial[pair - first]);
            Kernels::detect().vectorized(
                #[inline(always)]
                || {
                    let nodes = product.len();
                    let weights = &self.weights[..nodes];
                    let [[p, p_bent], [q, q_bent]] =
                        [p, q].map(|radial| [&radial.displacement[..nodes], &radial.bent[..nodes]]);
                    let (product, bent) = (&mut product[..nodes], &mut bent[..nodes]);
                    // A plain loop: what an iterator calls would be compiled for the baseline.
                    for at in 0..nodes {
                        product[at] = 0.5 * weights[at] * p[at] * q[at];
                        bent[at] = 0.5 * weights[at] * (p_bent[at] * q[at] + p[at] * q_bent[at]);
                    }
                    for (l, overlaps) in orders.into_iter().zip(overlaps) {
                        let Some(harmonic) = head.field.harmonics.get(l) else { continue };
                        for (part, overlap) in overlaps.iter_mut().enumerate() {
                            *overlap = sum_of_products(bent, &harmonic.tension[part])
                                - sum_of_products(product, &harmonic.curvature[part]);
                        }
                    }
                },
            );
        }
        overlaps
    }

    /// What the fields add to the stiffness among some modes, 1/s2.
    fn couplings(&self, modes: Range<usize>) -> DMatrix<f64> {
        let pair_of = |k: usize| self.mixed[k].pair;
        let rows = RefCell::new([vec![0.0; self.weights.len()], vec![0.0; self.weights.len()]]);
        let overlaps = |i, j| self.overlaps(i, j, &mut rows.borrow_mut());
        blocks::among(modes, pair_of, overlaps, |i, j, overlaps| self.coupling(i, j, overlaps))
    }
}

/// Of two pairs, `1/2 int [tau (k_i^2 + k_j^2) + laplace(tau)] i j 2 r dr` on each head, dimensionless:
/// `[head][difference, sum of the orders][cosine, sine of the field]`.
#[derive(Debug, Clone, Copy, Default)]
struct Overlaps([[[f64; 2]; 2]; HEADS]);

/// The radial motion of every pair from `first` on, on one head.
fn radial(drum: &DrumModes, head: &TunedHead, far: bool, first: usize, radii: &[f64]) -> Vec<Radial> {
    let shapes = head.membrane.radial_shapes(radii);
    let nodes = radii.len();
    let pairs = drum.modes[first.min(drum.modes.len())..].iter();
    pairs
        .map(|mode| {
            let (from, count) = head.order(mode.m);
            let skip = if far { drum.heads.batter.order(mode.m).1 } else { 0 };
            let mut radial = Radial { displacement: vec![0.0; nodes], bent: vec![0.0; nodes] };
            for i in 0..count {
                let share = mode.reference.vector[skip + i];
                let square = head.membrane.modes()[from + i].zero.powi(2);
                for (k, shape) in shapes[(from + i) * nodes..][..nodes].iter().enumerate() {
                    radial.displacement[k] += share * shape;
                    radial.bent[k] += share * shape * square;
                }
            }
            radial
        })
        .collect()
}

#[cfg(test)]
mod tests;
