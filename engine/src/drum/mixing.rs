//! The modes of a drum whose heads are not evenly stretched.
//!
//! Model: with the modes of the even drum as coordinates (unit modal mass), the [tension field](super::tension_field) of each
//! head adds `T int tau grad(i) grad(j) dA` to the stiffness. Where modes lie farther apart than that, each keeps its
//! shape; where they crowd, the new modes are mixtures of many orders, each of which a stroke excites a little and which radiates a little. All that is
//! known of the even modes goes through the same mixture: shapes, losses, pressures, so that the drum stays reciprocal and
//! passive.
//!
//! Scheme: modes from [`MIXED_FROM`](super::tension_field::MIXED_FROM) times the drum's pitch on are mixed, in order of frequency, in blocks of
//! 128, then once more in blocks that lie half a block further. Both passes are rotations, so no energy is gained, and
//! what remains between modes is weaker than their distance. The mixture is worked out in the middle of the range of pitches and
//! kept at all of them: tension moves all modes of a head alike. Frequencies, losses and masses follow the even modes' at every pitch.
//!
//! Limits: cavity modes, which do not move with the tension, are mixed as they lie in the middle of the range.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::drum::coupled::CoupledMode;
use crate::drum::heads::{MIDDLE, TunedHead};
use crate::drum::modes::DrumModes;
use crate::drum::tension_field::{Harmonic, TensionField, TensionFieldSpec};
use crate::drum::tuned::{Grid, ModeAtPitch, PitchPosition};
use crate::math::{eigen, quadrature};
use crate::mode::Member;
use crate::mode_mixture::ModeMixture;
use crate::split::Splitting;

/// Modes in a block.
const BLOCK: usize = 128;

/// What is left out of a mixed mode: coefficients at its ends whose squares sum to this. *Converged*: at most a
/// thousandth of a mode's energy.
const LEFT_OUT: f64 = 1e-3;

/// The even modes of a drum, members of pairs one by one, and what becomes of them.
#[derive(Serialize, Deserialize)]
pub struct MixedModes {
    /// From even modes to mixed ones.
    pub mixture: ModeMixture,
    /// `[mixed mode]`: the even mode that it is most of.
    pub names: Vec<u32>,
    /// `[mixed mode]`: share of its energy in modes without nodal diameters.
    pub without_diameters: Vec<f32>,
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
}

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
    pub fn new(drum: &DrumModes, spec: &TensionFieldSpec, axis: impl Fn(u32) -> f64) -> MixedModes {
        let even = even_modes(drum);
        let kept = even.iter().filter(|mode| mode.pair < drum.kept).count();
        let mixed = &even[kept..];
        let problem = Problem::new(drum, spec, mixed, axis);
        let (omegas, rows) = problem.solve();
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
        ModeAtPitch {
            omega: blend(|entry| entry.omega).exp(),
            sigma: blend(|entry| entry.sigma).exp(),
            mass: blend(|entry| entry.mass).exp(),
            batter: blend(|entry| entry.batter),
            resonant: blend(|entry| entry.resonant),
            flow: blend(|entry| entry.flow),
        }
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
        let tables: Vec<Vec<ModeAtPitch>> = Grid::Coarse.pitches().map(at).collect();
        let mut entries = Vec::with_capacity(rows.len() * tables.len());
        let mut coefs = Vec::with_capacity(rows.len());
        for ((first, row), omega) in rows.iter().zip(omegas) {
            let parts = || row.iter().enumerate().map(|(i, coef)| (even[kept + first + i].pair, coef * coef));
            let sum = |table: &[ModeAtPitch], value: &dyn Fn(&ModeAtPitch) -> f64| -> f64 {
                parts().map(|(pair, share)| share * value(&table[pair])).sum()
            };
            let square = |mode: &ModeAtPitch| mode.omega * mode.omega;
            let now = sum(&reference, &square);
            for table in &tables {
                entries.push(Entry {
                    omega: (omega * (sum(table, &square) / now).sqrt()).ln() as f32,
                    sigma: sum(table, &|mode| mode.sigma).max(1e-9).ln() as f32,
                    mass: -sum(table, &|mode| mode.mass.recip()).ln() as f32,
                    batter: sum(table, &|mode| mode.batter) as f32,
                    resonant: sum(table, &|mode| mode.resonant) as f32,
                    flow: sum(table, &|mode| mode.flow) as f32,
                });
            }
            // Shapes of even modes have the modal masses of the middle pitch.
            let mass = 1.0 / sum(&reference, &|mode| mode.mass.recip());
            let scaled = row
                .iter()
                .enumerate()
                .map(|(i, coef)| coef * (mass / reference[even[kept + first + i].pair].mass).sqrt());
            coefs.push((kept + first, scaled.collect()));
        }
        let without = |(first, row): &(usize, Vec<f64>)| -> f32 {
            let parts = row.iter().enumerate();
            let round = parts.filter(|(i, _)| drum.modes[even[kept + first + i].pair].m == 0);
            round.map(|(_, coef)| (coef * coef) as f32).sum()
        };
        let without_diameters = rows.iter().map(without).collect();
        let names = named(&rows).into_iter().map(|name| (kept + name) as u32).collect();
        MixedModes { mixture: ModeMixture::new(kept, &coefs), names, without_diameters, entries }
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
        spec: &TensionFieldSpec,
        mixed: &'a [EvenMode],
        axis: impl Fn(u32) -> f64,
    ) -> Problem<'a> {
        let batter = &drum.heads.batter;
        let both = [Some(batter), drum.heads.resonant.as_ref()].into_iter().flatten();
        let zeros = both.flat_map(|head| head.membrane.modes()).map(|mode| mode.zero);
        let finest = zeros.fold(0.0, f64::max);
        // Two shapes and the field: a node for every radian and some.
        let rule = quadrature::shared_unit((0.8 * finest + 12.0 / spec.correlation) as usize + 16);
        let weights: Vec<f64> =
            rule.nodes.iter().zip(&rule.weights).map(|(r, weight)| 2.0 * r * weight).collect();
        let pairs: Vec<usize> = mixed.iter().map(|mode| mode.pair).collect();
        let first = pairs.first().copied().unwrap_or(drum.modes.len());
        let part = |head: &TunedHead, far: bool| HeadPart {
            field: TensionField::new(spec, u32::from(far), &rule.nodes, &weights),
            radial: radial(drum, head, far, first, &rule.nodes),
            tension: PI * head.tensions[MIDDLE],
        };
        let mut heads = vec![part(batter, false)];
        heads.extend(drum.heads.resonant.as_ref().map(|head| part(head, true)));
        let around = mixed.iter().map(|mode| {
            let m = drum.modes[mode.pair].m;
            let (sin, cos) = (f64::from(m) * axis(m)).sin_cos();
            match mode.member {
                Member::Cosine => [cos, sin],
                Member::Sine => [-sin, cos],
            }
        });
        Problem { drum, mixed, heads, weights, around: around.collect() }
    }

    fn mode(&self, i: usize) -> &CoupledMode {
        &self.drum.modes[self.mixed[i].pair].reference
    }

    /// What the fields add to the stiffness between two modes, 1/s2.
    fn coupling(&self, i: usize, j: usize) -> f64 {
        let [m, n] = [i, j].map(|k| self.drum.modes[self.mixed[k].pair].m);
        let first = self.mixed[0].pair;
        let pairs = [i, j].map(|k| self.mixed[k].pair - first);
        let [a, b] = [i, j].map(|k| self.around[k]);
        let mut sum = 0.0;
        for head in &self.heads {
            let [p, q] = pairs.map(|pair| &head.radial[pair]);
            for (l, [of_cos, of_sin]) in around((m, a), (n, b)) {
                let Some(harmonic) = head.field.harmonics.get(l as usize) else { continue };
                for (part, mean) in [of_cos, of_sin].into_iter().enumerate() {
                    if mean != 0.0 {
                        sum += head.tension * mean * self.overlap(harmonic, part, p, q);
                    }
                }
            }
        }
        sum
    }

    /// `1/2 int [tau (k_i^2 + k_j^2) + laplace(tau)] i j 2 r dr`.
    fn overlap(&self, harmonic: &Harmonic, part: usize, p: &Radial, q: &Radial) -> f64 {
        let (tension, curvature) = (&harmonic.tension[part], &harmonic.curvature[part]);
        let mut sum = 0.0;
        for (i, weight) in self.weights.iter().enumerate() {
            let bent = p.bent[i] * q.displacement[i] + p.displacement[i] * q.bent[i];
            let product = p.displacement[i] * q.displacement[i];
            sum += weight * (tension[i] * bent - curvature[i] * product);
        }
        0.5 * sum
    }

    /// Angular frequencies, ascending, and each mode's coefficients over the even modes from a first one on.
    fn solve(&self) -> (Vec<f64>, Vec<(usize, Vec<f64>)>) {
        let count = self.mixed.len();
        let mut squares: Vec<f64> = (0..count).map(|i| self.mode(i).omega.powi(2)).collect();
        let mut rows: Vec<(usize, Vec<f64>)> = (0..count).map(|i| (i, vec![1.0])).collect();
        for offset in [0, BLOCK / 2] {
            for start in (offset..count).step_by(BLOCK) {
                self.rotate(start..(start + BLOCK).min(count), offset == 0, &mut squares, &mut rows);
            }
        }
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| squares[a].total_cmp(&squares[b]));
        let omegas = order.iter().map(|&i| squares[i].max(0.0).sqrt()).collect();
        let rows = order.iter().map(|&i| trimmed(&rows[i])).collect();
        (omegas, rows)
    }

    /// Solves one block in terms of what the modes are by now.
    fn rotate(
        &self,
        block: std::ops::Range<usize>,
        first_pass: bool,
        squares: &mut [f64],
        rows: &mut [(usize, Vec<f64>)],
    ) {
        let (start, size) = (block.start, block.len());
        let low = block.clone().map(|i| rows[i].0).min().unwrap_or(start);
        let high = block.clone().map(|i| rows[i].0 + rows[i].1.len()).max().unwrap_or(block.end);
        let width = high - low;
        // Coefficients of the block's modes over the even ones they are made of, `[even mode][mode]`.
        let mut basis = DMatrix::zeros(width, size);
        for (column, (first, row)) in rows[block.clone()].iter().enumerate() {
            for (i, coef) in row.iter().enumerate() {
                basis[(first - low + i, column)] = *coef;
            }
        }
        let mut stiffness = DMatrix::zeros(width, width);
        for i in 0..width {
            for j in 0..=i {
                let coupling = self.coupling(low + i, low + j);
                stiffness[(i, j)] = coupling;
                stiffness[(j, i)] = coupling;
            }
            stiffness[(i, i)] += self.mode(low + i).omega.powi(2);
        }
        let matrix = if first_pass { stiffness } else { basis.transpose() * stiffness * &basis };
        let solved = eigen::symmetric(matrix);
        let vectors = basis * &solved.vectors;
        for k in 0..size {
            squares[start + k] = solved.values[k];
            rows[start + k] = (low, vectors.column(k).iter().copied().collect());
        }
    }
}

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

/// Means around the circle of two shapes `a cos(m theta) + b sin(m theta)` with `cos(l theta)` and `sin(l theta)`, for the
/// `l` for which they are not zero.
fn around((m, a): (u32, [f64; 2]), (n, b): (u32, [f64; 2])) -> impl Iterator<Item = (u32, [f64; 2])> {
    let together = a[0] * b[0] + a[1] * b[1];
    let apart = a[0] * b[0] - a[1] * b[1];
    // sin(m) cos(n) and cos(m) sin(n).
    let (up, down) = (a[1] * b[0], a[0] * b[1]);
    let difference = if m == n {
        [if m == 0 { together } else { 0.5 * together }, 0.0]
    } else {
        let sign = if m > n { 0.25 } else { -0.25 };
        [0.25 * together, sign * (up - down)]
    };
    let sum = if m + n == 0 { [0.0; 2] } else { [0.25 * apart, 0.25 * (up + down)] };
    [(m.abs_diff(n), difference), (m + n, sum)].into_iter()
}

/// A row without the weak coefficients at its ends, and again of unit length.
fn trimmed((first, row): &(usize, Vec<f64>)) -> (usize, Vec<f64>) {
    let cut = |from_end: bool| {
        let mut sum = 0.0;
        let squares = row.iter().map(|coef| coef * coef);
        let weak = |square: f64, sum: &mut f64| {
            *sum += square;
            *sum <= 0.5 * LEFT_OUT
        };
        if from_end {
            squares.rev().take_while(|&square| weak(square, &mut sum)).count()
        } else {
            squares.take_while(|&square| weak(square, &mut sum)).count()
        }
    };
    let (head, tail) = (cut(false), cut(true));
    let kept = &row[head..row.len() - tail];
    let length = kept.iter().map(|coef| coef * coef).sum::<f64>().sqrt();
    (first + head, kept.iter().map(|coef| coef / length).collect())
}

/// For each row the even mode it is most of, no two the same.
fn named(rows: &[(usize, Vec<f64>)]) -> Vec<usize> {
    let mut claims: Vec<(f64, usize, usize)> = Vec::new();
    for (k, (first, row)) in rows.iter().enumerate() {
        claims.extend(row.iter().enumerate().map(|(i, coef)| (coef * coef, k, first + i)));
    }
    claims.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let (mut names, mut taken) = (vec![None; rows.len()], vec![false; rows.len()]);
    for (_, k, part) in claims {
        if names[k].is_none() && !taken[part] {
            names[k] = Some(part);
            taken[part] = true;
        }
    }
    let mut free = (0..rows.len()).filter(|&part| !taken[part]).collect::<Vec<_>>().into_iter();
    names.into_iter().map(|name| name.or_else(|| free.next()).unwrap_or(0)).collect()
}

#[cfg(test)]
mod tests;
