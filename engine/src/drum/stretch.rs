//! The stretch of a displaced head: tension that grows with the square of the displacement.
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
//! The drum's modes mix the head's, within each order. Modes that are [mixed](super::mixing) of many orders stretch the head
//! each by itself: what they are made of has nearly one wavenumber, and the sum over all of them is the same. Shares are those of the
//! default pitch. Modes above 1.5 kHz hold next to none of a stroke's energy and are left out.
//!
//! Source: Berger, J. Appl. Mech. 22, 1955; Avanzini & Marogna, IEEE TASLP 18, 2010.

use std::collections::BTreeMap;

use crate::drum::mixing::{self, MixedModes};
use crate::drum::modes::DrumModes;
use crate::drum::tuned::PitchPosition;
use crate::membrane::MembraneSpec;
use crate::modal::simd::blocks::{Block, BlockProduct};
use crate::modal::simd::{Kernels, LANES};
use crate::modal::{Row, zero_row};
use crate::potential::{Evaluation, Potential};
use crate::split::Splitting;

/// Modes of the drum up to this stretch the head, Hz. *Converged*: lower, and the dent around a hard
/// stroke holds too little of its tension; a kick at 6 m/s then glides by half of what it should.
const LIMIT_HZ: f64 = 1500.0;

/// Strain at which polyester film yields. *Literature*.
const YIELD_STRAIN: f64 = 0.03;

/// Rate of the evaluations, Hz. A force renewed so often has its images where nobody hears them. *Converged*: of half
/// of it, with images about 11 kHz, the glide of a 6 m/s stroke is within 0.2 cents of 90 still, but the images are 15
/// dB under the high band.
const RATE: f64 = 22_000.0;

/// Samples between evaluations at a sample rate (Hz).
pub fn stride(sample_rate: f64) -> u32 {
    ((sample_rate / RATE) as u32).max(1)
}

/// The members of a mode among the body's, and its shares times the wavenumbers.
type BentMode = (Vec<u32>, Vec<f64>);

/// The stretching energy of one head. `S` is a quadratic form in the drum's modes; only modes of one order
/// and member meet in it, so its matrix is made of blocks, alike for both members.
pub struct Stretch {
    /// `A E h / (16 (1 - nu))`: energy over `S^2`, J.
    stiffness: f64,
    /// `S` at yield.
    yield_strain: f64,
    kernels: Kernels,
    blocks: Vec<Block>,
    /// The blocks' matrices, 1/m2, as [`Kernels::blocks`] wants them.
    matrix: Row,
    /// The rows of the body's first modes, `[mode]`.
    rows: Vec<u32>,
    /// Displacements in the order of the blocks, and their product with the matrix.
    sorted: Row,
    product: Row,
    /// `S` of each mixed mode by itself, 1/m2; they follow the modes of the blocks.
    mixed: Row,
    mixed_product: Row,
}

impl Stretch {
    /// The stretch of a drum's batter; the modes of the body are the drum's below the limit at that
    /// pitch (Hz), pairs as two. Returns it with their number. Allocates.
    pub fn new(
        spec: &MembraneSpec,
        drum: &DrumModes,
        mixed: Option<&MixedModes>,
        pitch_hz: f64,
    ) -> (Stretch, usize) {
        let place = drum.heads.scale.place(pitch_hz);
        let limit = std::f64::consts::TAU * LIMIT_HZ;
        // Modes with their shares times the wavenumbers, by order.
        let mut sorted: BTreeMap<u32, Vec<BentMode>> = BTreeMap::new();
        let mut count = 0;
        let kept = mixed.map_or(drum.modes.len(), |_| drum.kept);
        for mode in drum.modes[..kept].iter().take_while(|mode| mode.at(&place).omega < limit) {
            let (first, heads) = drum.heads.batter.order(mode.m);
            let wave = |i: usize| drum.heads.batter.membrane.modes()[first + i].zero / spec.radius;
            let bent: Vec<f64> = (0..heads).map(|i| wave(i) * mode.share(i, &place)).collect();
            let members = count..count + Splitting::ROUND.members(mode.m, 0).count() as u32;
            count = members.end;
            sorted.entry(mode.m).or_default().push((members.collect(), bent));
        }
        let (mut blocks, mut columns, mut modes, mut start) = (Vec::new(), Vec::new(), Vec::new(), 0);
        for (&m, bent) in &sorted {
            let block = Block { start, size: bent.len(), twice: m > 0 };
            start += block.rows();
            for (i, (members, a)) in bent.iter().enumerate() {
                let rows = members.iter().zip((block.start + i..).step_by(block.padded()));
                modes.extend(rows.map(|(&mode, row)| (mode, row as u32)));
                let column =
                    bent.iter().map(|(_, b)| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() as f32);
                columns.extend(column);
                columns.resize(columns.len().div_ceil(LANES) * LANES, 0.0);
            }
            blocks.push(block);
        }
        // In the order of the modes, so that their displacements are read in one go.
        modes.sort_unstable();
        let rows = modes.into_iter().map(|(_, row)| row).collect();
        let mut matrix = zero_row(columns.len());
        matrix.copy_from_slice(&columns);
        // The body's first modes are all kept ones, then the mixed.
        let all_kept = drum.modes[..drum.kept].iter().all(|mode| mode.at(&place).omega < limit);
        let mixed = mixed.filter(|_| all_kept);
        let bent = mixed.map_or_else(Vec::new, |mixed| alone(spec, drum, mixed, &place, limit));
        let mut alone = zero_row(bent.len());
        alone.iter_mut().zip(&bent).for_each(|(row, bent)| *row = *bent as f32);
        let stretch = Stretch {
            stiffness: energy_factor(spec),
            yield_strain: 4.0 * YIELD_STRAIN,
            kernels: Kernels::detect(),
            blocks,
            matrix,
            rows,
            sorted: zero_row(start),
            product: zero_row(start),
            mixed: alone,
            mixed_product: zero_row(bent.len()),
        };
        (stretch, count as usize + bent.len())
    }

    /// `S` at displacements `q`; leaves half its gradient in `product`, in the order of the blocks.
    fn form(&mut self, q: &[f32]) -> f64 {
        for (&row, &q) in self.rows.iter().zip(q) {
            self.sorted[row as usize] = q;
        }
        let Stretch { kernels, blocks, matrix, sorted, product, .. } = self;
        kernels.blocks(BlockProduct { blocks, matrix, x: sorted, y: product });
        let kept = f64::from(self.kernels.dot(&self.sorted, &self.product));
        let rest = &q[self.rows.len()..];
        self.mixed_product.iter_mut().zip(&*self.mixed).zip(rest).for_each(|((out, a), q)| *out = a * q);
        kept + f64::from(self.kernels.dot(&self.mixed_product[..self.mixed.len()], rest))
    }
}

/// `S` of each mixed mode by itself up to a limit (rad/s), 1/m2, lowest first.
fn alone(
    spec: &MembraneSpec,
    drum: &DrumModes,
    mixed: &MixedModes,
    place: &PitchPosition,
    limit: f64,
) -> Vec<f64> {
    let even = mixing::even_modes(drum);
    let square = |k: usize| -> f64 {
        let mode = &drum.modes[even[k].pair];
        let (first, heads) = drum.heads.batter.order(mode.m);
        let wave = |i: usize| drum.heads.batter.membrane.modes()[first + i].zero / spec.radius;
        (0..heads).map(|i| (wave(i) * mode.share(i, place)).powi(2)).sum()
    };
    let modes = (0..mixed.len()).take_while(|&k| mixed.at(k, place).omega < limit);
    modes.map(|k| mixed.mixture.parts(k).map(|(part, share)| share * share * square(part)).sum()).collect()
}

/// `A E h / (16 (1 - nu))`, J.
fn energy_factor(spec: &MembraneSpec) -> f64 {
    spec.area() * spec.material.youngs_modulus * spec.thickness / (16.0 * (1.0 - spec.material.poisson_ratio))
}

impl Potential for Stretch {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let s = self.form(displacement);
        let (energy, slope) = if s <= self.yield_strain {
            (self.stiffness * s * s, 2.0 * self.stiffness * s)
        } else {
            let slope = 2.0 * self.stiffness * self.yield_strain;
            (self.stiffness * self.yield_strain * self.yield_strain + slope * (s - self.yield_strain), slope)
        };
        let factor = 2.0 * slope as f32;
        for (gradient, &row) in gradient.iter_mut().zip(&self.rows) {
            *gradient = factor * self.product[row as usize];
        }
        let rest = gradient[self.rows.len()..].iter_mut();
        rest.zip(&*self.mixed_product).for_each(|(gradient, product)| *gradient = factor * product);
        Evaluation { energy, depth: 0.0 }
    }

    fn is_convex(&self) -> bool {
        true
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
        let mixed = MixedModes::new(&drum, &spec.tension_field.unwrap(), |_| 0.0);
        for mixed in [None, Some(&mixed)] {
            check(&spec, &drum, mixed);
        }
    }

    fn check(spec: &crate::drum::DrumSpec, drum: &DrumModes, mixed: Option<&MixedModes>) {
        let (mut stretch, modes) = Stretch::new(&spec.membrane(&spec.batter), drum, mixed, spec.pitch_hz);
        let mut gradient = zero_row(modes);
        let mut scratch = zero_row(modes);
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
                assert!(error < 2e-3 * f64::from(gradient[0].abs()), "{size} {k}: {slope} {}", gradient[k]);
            }
        }
    }
    #[test]
    fn the_gradient_holds_every_mode_and_the_energy_too() {
        // Below yield the energy goes with the fourth power of the displacement: by Euler's theorem `grad E . q = 4 E`.
        let spec = reference::drum("rack-tom");
        let drum = DrumModes::new(&spec).unwrap();
        let mixed = MixedModes::new(&drum, &spec.tension_field.unwrap(), |_| 0.0);
        let (mut stretch, modes) =
            Stretch::new(&spec.membrane(&spec.batter), &drum, Some(&mixed), spec.pitch_hz);
        let (mut q, mut gradient) = (zero_row(modes), zero_row(modes));
        for k in 0..modes {
            q[k] = 1e-4;
            let energy = stretch.evaluate(&q[..modes], &mut gradient).energy;
            let work = f64::from(gradient[k]) * f64::from(q[k]);
            assert!(energy > 0.0 && (work / (4.0 * energy) - 1.0).abs() < 1e-5, "mode {k}: {work} {energy}");
            q[k] = 0.0;
        }
    }
}
