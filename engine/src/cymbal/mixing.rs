//! The modes of a hammered cymbal.
//!
//! Model: [hammering](super::hammering) couples the modes of the turned plate. The lowest lie far apart, and each keeps its shape;
//! from [`MIXED_FROM_HZ`] on the modes are mixtures of many orders, each of which a stroke excites a little and which radiates a
//! little. All that is known of the plain modes goes through the same mixture: shapes, losses, pressures, stretching, so that the
//! cymbal stays reciprocal and passive.
//!
//! What mixed modes lose to the air is the mean of what the plain ones lose, weighted by their shares: what plain modes of
//! one order take from each other by radiating together is left out.

use std::cell::RefCell;
use std::ops::Range;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::math::quadrature;
use crate::math::sums::sum_of_products;
use crate::modal::simd::Kernels;
use crate::mode::Member;
use crate::mode_mixture::ModeMixture;
use crate::mode_mixture::blocks::{self, around, named};
use crate::plate::bent::Bent;
use crate::plate::{PlateModes, PlateTables};

use super::hammering::{HammeringSpec, ThicknessField};

/// Modes are mixed from here on, Hz. *Judgement* on what the eigenproblem says from 100 Hz on: of crash, ride and splash, modes from 300 to 500 Hz have 0 to 4 % of their energy in the shapes of
/// others than their pair, from 500 to 800 Hz 5 to 15, to 2 kHz 11 to 18, above 12 to 35. Below, only the two of a pair meet, which are
/// [split](crate::split) instead.
pub const MIXED_FROM_HZ: f64 = 300.0;

/// A mode of the turned plate.
#[derive(Debug, Clone, Copy)]
pub struct PlainMode {
    /// Which of the plate's shell modes.
    pub shell: usize,
    /// Nodal diameters.
    pub m: u32,
    /// Which member of the pair.
    pub member: Member,
    /// Direction of the pair's axes, rad.
    pub axis: f64,
    /// Angular frequency, rad/s.
    pub omega: f64,
}

/// What becomes of a cymbal's modes by hammering.
#[derive(Serialize, Deserialize)]
pub struct HammeredModes {
    /// From plain modes to mixed ones.
    pub mixture: ModeMixture,
    /// `[mixed mode]`: the plain mode that it is most of, counted from the first mixed one.
    pub names: Vec<u32>,
    /// `[mixed mode]`: angular frequency, rad/s.
    pub omegas: Vec<f64>,
}

impl HammeredModes {
    /// Mixes modes of a plate, by frequency; `kept` more come before them and stay as they are. Allocates; takes tenths of a
    /// second.
    pub fn new(
        plate: &PlateModes,
        tables: &PlateTables,
        spec: &HammeringSpec,
        kept: usize,
        plain: &[PlainMode],
    ) -> HammeredModes {
        let problem = Problem::new(plate, tables, spec, plain);
        let omegas: Vec<f64> = plain.iter().map(|mode| mode.omega).collect();
        let (omegas, rows) = blocks::solve(&omegas, |modes| problem.couplings(modes));
        let names = named(&rows).into_iter().map(|name| name as u32).collect();
        // All modal masses are the plate's: rotations need no scale.
        let rows: Vec<(usize, Vec<f64>)> = rows.into_iter().map(|(first, row)| (kept + first, row)).collect();
        HammeredModes { mixture: ModeMixture::new(kept, &rows), names, omegas }
    }

    /// The mean of a quantity (in any unit) of the plain modes, counted from the first mixed one, over mixed mode `k`.
    pub fn mean(&self, k: usize, of: impl Fn(usize) -> f64) -> f64 {
        let kept = self.mixture.kept();
        self.mixture.parts(k).map(|(plain, share)| share * share * of(plain - kept)).sum()
    }
}

/// The perturbed eigenproblem.
struct Problem<'a> {
    plain: &'a [PlainMode],
    field: ThicknessField,
    /// Of each node of the radius its weight times `3 t^3` and the squared frequency of the flat plate at wavenumber 1 (1/s2), and times `t`.
    bending: Vec<f64>,
    metal: Vec<f64>,
    /// `1 - nu`.
    rest: f64,
    /// `[shell]` of those that are mixed.
    bent: Vec<Option<Bent>>,
}

impl<'a> Problem<'a> {
    fn new(
        plate: &PlateModes,
        tables: &PlateTables,
        spec: &HammeringSpec,
        plain: &'a [PlainMode],
    ) -> Problem<'a> {
        let shells = || plain.iter().map(|mode| mode.shell);
        let finest = shells().map(|shell| plate.wave_number(&plate.shells[shell])).fold(0.0, f64::max);
        // Two shapes and the field: a node for every radian and some.
        let rule = quadrature::shared_unit((0.8 * finest + 12.0 / spec.correlation) as usize + 16);
        let weights: Vec<f64> =
            rule.nodes.iter().zip(&rule.weights).map(|(r, weight)| 2.0 * r * weight).collect();
        let thickness = || rule.nodes.iter().map(|&r| plate.spec.relative_thickness(r));
        let metal: Vec<f64> = weights.iter().zip(thickness()).map(|(weight, t)| weight * t).collect();
        let unit = plate.spec.flat_omega().powi(2);
        let bending =
            weights.iter().zip(thickness()).map(|(weight, t)| 3.0 * unit * weight * t.powi(3)).collect();
        let mut bent: Vec<Option<Bent>> = vec![None; plate.shells.len()];
        for shell in shells() {
            bent[shell].get_or_insert_with(|| plate.bent(tables, &plate.shells[shell], &rule.nodes));
        }
        Problem {
            plain,
            field: ThicknessField::new(spec, &rule.nodes, &metal),
            bending,
            metal,
            rest: 1.0 - plate.spec.poisson_ratio,
            bent,
        }
    }

    /// How mode `i` goes around, and how its slope does: shares of cosine and sine.
    fn angular(&self, i: usize) -> [[f64; 2]; 2] {
        let mode = &self.plain[i];
        let [a, b] = mode.member.around(mode.m, mode.axis);
        [[a, b], [b, -a]]
    }

    /// What hammering adds to the stiffness among some modes, 1/s2.
    fn couplings(&self, modes: Range<usize>) -> DMatrix<f64> {
        let pair_of = |k: usize| self.plain[k].shell;
        let rows = RefCell::new([vec![0.0; self.bending.len()], vec![0.0; self.bending.len()]]);
        let integrals = |i, j| self.pair(i, j, &mut rows.borrow_mut());
        blocks::among(modes, pair_of, integrals, |i, j, integrals| self.coupling(i, j, integrals))
    }

    /// The radial integrals of the pairs of two modes; the rows, a number for each node, are for its own use.
    fn pair(&self, i: usize, j: usize, [even, twisted]: &mut [Vec<f64>; 2]) -> PairIntegrals {
        let [one, other] = [i, j].map(|k| &self.plain[k]);
        let (Some(p), Some(q)) = (&self.bent[one.shell], &self.bent[other.shell]) else {
            return PairIntegrals::default();
        };
        let mass = one.omega * other.omega;
        let (rest, harmonics) = (self.rest, &self.field.harmonics);
        let orders = [one.m.abs_diff(other.m), one.m + other.m].map(|l| l as usize);
        Kernels::detect().vectorized(
            #[inline(always)]
            || {
                let nodes = even.len();
                let [p, q] = [p, q].map(|bent| {
                    let Bent { value, radial, around, twist } = bent;
                    [&value[..nodes], &radial[..nodes], &around[..nodes], &twist[..nodes]]
                });
                let ([value, radial, around, twist], [other_value, other_radial, other_around, other_twist]) =
                    (p, q);
                let (bending, metal) = (&self.bending[..nodes], &self.metal[..nodes]);
                let (even, twisted) = (&mut even[..nodes], &mut twisted[..nodes]);
                // A plain loop: what an iterator calls would be compiled for the baseline.
                for at in 0..nodes {
                    let crossed = radial[at] * other_around[at] + around[at] * other_radial[at];
                    let spread = (radial[at] + around[at]) * (other_radial[at] + other_around[at]);
                    even[at] = bending[at] * (spread - rest * crossed)
                        - mass * metal[at] * value[at] * other_value[at];
                    twisted[at] = bending[at] * 2.0 * rest * twist[at] * other_twist[at];
                }
                let mut integrals = PairIntegrals::default();
                for (l, sums) in orders.into_iter().zip(&mut integrals.0) {
                    let Some(harmonic) = harmonics.get(l) else { continue };
                    for (part, sums) in sums.iter_mut().enumerate() {
                        let along = &harmonic[part];
                        *sums = [sum_of_products(even, along), sum_of_products(twisted, along)];
                    }
                }
                integrals
            },
        )
    }

    /// What hammering adds to the stiffness between two modes, 1/s2.
    fn coupling(&self, i: usize, j: usize, integrals: &PairIntegrals) -> f64 {
        let [m, n] = [i, j].map(|k| self.plain[k].m);
        let [[a, a_slope], [b, b_slope]] = [i, j].map(|k| self.angular(k));
        let even = around((m, a), (n, b));
        let twisted = around((m, a_slope), (n, b_slope));
        let mut sum = 0.0;
        for (sums, ((_, even), (_, twisted))) in integrals.0.iter().zip(even.zip(twisted)) {
            for (part, sums) in sums.iter().enumerate() {
                sum += even[part] * sums[0] + twisted[part] * sums[1];
            }
        }
        sum
    }
}

/// `[difference, sum of the orders][cosine, sine of the field][even, twisted]`.
#[derive(Debug, Clone, Copy, Default)]
struct PairIntegrals([[[f64; 2]; 2]; 2]);

#[cfg(test)]
mod tests;
