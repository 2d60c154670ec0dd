//! The stretching of a bent plate: what couples a cymbal's modes when it is struck hard.
//!
//! Model (von Karman, with the dome of Marguerre): bending a plate by more than its thickness
//! stretches it. With Airy functions `Psi_k` (see [`airy`]) the stretching energy is
//! `sum c_k (P_k + l_k)^2`, `P_k = int Psi_k L(w, w) dA` quadratic in the displacement, `l_k` linear.
//! The `l^2` part is the dome's stiffness and is in the shell modes already (see
//! [`plate::dome`](crate::plate::dome)). What is left,
//!
//! ```text
//! U = sum c_k (P_k^2 + 2 P_k l_k)
//! dU/dq_p = sum f_k dP_k/dq_p + 2 c_k P_k dl_k/dq_p,   f_k = 2 c_k (P_k + l_k)
//! ```
//!
//! can be negative, but never by more than `sum c_k l_k^2` ([`dome_share`]).
//!
//! Evaluation: by transform. Displacements become the three curvatures of the surface on a polar
//! grid (radii of Gauss's rule along the SIMD lanes, a discrete Fourier sum around), the bracket is
//! a product point by point (see [`bent`](crate::plate::bent)), back to orders, projected on the Airy functions; the
//! stress they make goes the same way back. Energy and gradient use one quadrature, whose rule is
//! exactly transposed: the gradient is that of the energy to rounding, whatever the grid.
//!
//! *Measured* for a 16 in crash's modes to 2 kHz, 132 amplitudes and 94 Airy functions: `16 x 60` grid
//! points integrate a cap's gradient within 6e-4, in 1.9 us; to 4 kHz 6.5 us, to 8 kHz 12 us (AVX-512). The Fourier
//! sums are half of that. The inner loops of dense tables alone take 19 us, 54 us and 165 us (the example `coupling`):
//! their blocks are shorter than the lanes are wide.
//!
//! Airy functions are taken up to the largest wave number of the modes, at most 16 of one order, as many as there may be modes
//! of it: twice as many change the gradient of a random state by under 1 %.
//!
//! Sources: Touze, Thomas, Chaigne, J. Sound Vib. 258, 2002; Thomas, Touze, Chaigne, Int. J. Solids
//! Struct. 42, 2005; Ducceschi & Touze, J. Sound Vib. 344, 2015 (modal, conserving schemes).

pub mod airy;
pub mod dome_share;
#[cfg(test)]
mod oracle;
#[cfg(test)]
mod reference;

use std::f64::consts::TAU;

use crate::math::negligible::drop_negligible;
use crate::math::quadrature::GaussLegendre;
use crate::modal::simd::polar::{BLOCK, Circle, Radials, SLOTS};
use crate::modal::simd::{Kernels, LANES};
use crate::modal::{Row, zero_row};
use crate::plate::bent::Bent;
use crate::plate::{PlateModes, PlateTables};
use crate::potential::{Evaluation, Potential};

use airy::AiryOrder;
use dome_share::Domed;

/// Radii per unit of the largest wave number. *Converged*: 0.66 leaves 1.3e-3 of a cap's gradient. Where it comes to 16 lanes for plates with
/// bells, to 2 kHz, it leaves 3 % (crash) and 4 to 7 % (ride) in a state that rings everywhere; to 4 kHz 5e-6. The next 16 would make them half as
/// dear again and move no band of a hard stroke by more than 0.2 dB (crash) and 0.4 (ride; 0.1 in the mean).
const RADII: f64 = 0.66;

/// A frequency just below one that is out of reach, over that.
const SHORT_OF: f64 = 1.0 - 1e-9;

/// A pair of modes of the body that stretch the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledPair {
    /// Which of the plate's shell modes.
    pub shell: usize,
    /// Index of the cosine member among the body's modes; the sine one follows if there is one.
    pub mode: usize,
    /// Direction of the pair's axes, rad.
    pub axis: f64,
}

/// Where a pair's amplitudes are, and how its axes are turned.
#[derive(Debug, Clone, Copy)]
struct PairIndex {
    /// In the body; the sine member follows unless `m` is 0.
    mode: usize,
    m: u32,
    /// In the amplitudes `[row][cos, sin][SLOTS]`.
    cos_at: usize,
    cos: f32,
    sin: f32,
}

/// The stretching energy of a plate and its gradient.
pub struct VonKarman {
    kernels: Kernels,
    places: Vec<PairIndex>,
    /// Transforms of the displacement's and of the Airy functions' orders.
    bends: Circle,
    airys: Circle,
    /// Radii, lanes of one field.
    lanes: usize,
    /// `B^k_p` and `A`, `B`, `D` of the shell modes; Airy functions times the rule's weights.
    curvatures: Radials,
    stresses: Radials,
    /// `c_k`, `[airy row][SLOTS]`.
    stiffness: Vec<f32>,
    /// Rows of each order that has Airy functions: theirs, and the displacement's.
    rows: Vec<(usize, usize)>,
    work: Work,
}

/// What one evaluation writes.
struct Work {
    /// Amplitudes, `[row][cos, sin][SLOTS]`.
    amplitudes: Row,
    quadratic: Row,
    forces: Row,
    /// Spectrum of the three curvatures, `l_k` before them; fields, of the three curvatures and of one.
    bend_spectrum: Row,
    bend_field: Row,
    airy_spectrum: Row,
    airy_field: Row,
}

impl VonKarman {
    /// Frequency up to which a plate's modes can be coupled, at most `hz`, Hz: one order has room for [`SLOTS`] modes. Large thin
    /// plates have more below 8 kHz.
    pub fn reach(plate: &PlateModes, hz: f64) -> f64 {
        let mut held = vec![0; plate.flat.len()];
        let beyond = plate.shells.iter().find(|shell| {
            let held = &mut held[shell.m as usize];
            *held += 1;
            *held > SLOTS
        });
        beyond.map_or(hz, |shell| hz.min(SHORT_OF * shell.omega / TAU))
    }

    /// For these pairs of a plate's modes. Allocates; takes some tens of milliseconds.
    ///
    /// # Panics
    /// If the tables do not reach the pairs' orders, or if the modes go beyond what [can be coupled](Self::reach).
    pub fn new(plate: &PlateModes, tables: &PlateTables, pairs: &[CoupledPair]) -> VonKarman {
        let shell = |pair: &CoupledPair| &plate.shells[pair.shell];
        let finest = pairs.iter().map(|pair| plate.wave_number(shell(pair))).fold(0.0, f64::max);
        let highest = pairs.iter().map(|pair| shell(pair).m).max().unwrap_or(0) as usize;
        let mut airy = AiryOrder::all(plate, tables, highest as u32, finest);
        let used = airy.iter().rposition(|order| !order.stiffness.is_empty()).unwrap_or(0);
        airy.truncate(used + 1);
        // Enough angles that no product of two displacements and an Airy function folds over.
        let quarter = (2 * highest + used + 1).div_ceil(4).next_multiple_of(BLOCK);
        let (bends, airys) = (Circle::new(highest, quarter), Circle::new(used, quarter));
        let lanes = ((RADII * finest) as usize).next_multiple_of(LANES);
        let rule = GaussLegendre::unit(lanes);

        let mut curvatures = vec![Vec::new(); bends.rows()];
        let mut places = Vec::new();
        for pair in pairs {
            let m = shell(pair).m;
            let row = bends.row(m as usize);
            let Bent { mut radial, mut around, mut twist, .. } = plate.bent(tables, shell(pair), &rule.nodes);
            let (sin, cos) = (f64::from(m) * pair.axis).sin_cos();
            let cos_at = row * 2 * SLOTS + curvatures[row].len();
            places.push(PairIndex { mode: pair.mode, m, cos_at, cos: cos as f32, sin: sin as f32 });
            let mut overlap =
                airy.get(m as usize).map_or(vec![], |order| order.curvature(plate, shell(pair)));
            overlap.resize(SLOTS, 0.0);
            [&mut radial, &mut around, &mut twist].into_iter().for_each(|function| drop_negligible(function));
            curvatures[row].push([overlap, radial, around, twist].concat());
        }
        let area = TAU / airys.angles() as f64 / plate.spec.radius().powi(2);
        let mut stresses = vec![Vec::new(); airys.rows()];
        let mut stiffness = vec![0.0; airys.rows() * SLOTS];
        let rows = (0..airy.len()).map(|m| (airys.row(m), bends.row(m))).collect();
        for (m, order) in airy.iter().enumerate() {
            let row = airys.row(m);
            for mut shape in order.shapes(tables, &rule.nodes) {
                let weights = rule.nodes.iter().zip(&rule.weights).map(|(r, weight)| r * weight * area);
                shape.iter_mut().zip(weights).for_each(|(shape, weight)| *shape *= weight);
                drop_negligible(&mut shape);
                stresses[row].push(shape);
            }
            for (to, &c) in stiffness[row * SLOTS..].iter_mut().zip(&order.stiffness) {
                *to = c as f32;
            }
        }
        let work = Work {
            amplitudes: zero_row(bends.rows() * 2 * SLOTS),
            quadratic: zero_row(airys.rows() * 2 * SLOTS),
            forces: zero_row(airys.rows() * 2 * SLOTS),
            bend_spectrum: zero_row(bends.rows() * 2 * (SLOTS + 3 * lanes)),
            bend_field: zero_row(bends.angles() * 3 * lanes),
            airy_spectrum: zero_row(airys.rows() * 2 * lanes),
            airy_field: zero_row(airys.angles() * lanes),
        };
        VonKarman {
            kernels: Kernels::detect(),
            places,
            curvatures: Radials::new(&curvatures, SLOTS + 3 * lanes, SLOTS + 2 * lanes),
            stresses: Radials::new(&stresses, lanes, lanes),
            bends,
            airys,
            lanes,
            stiffness,
            rows,
            work,
        }
    }

    /// Displacements as amplitudes about a common axis.
    fn align(&mut self, displacement: &[f32]) {
        for place in &self.places {
            let (c, s) =
                (displacement[place.mode], if place.m > 0 { displacement[place.mode + 1] } else { 0.0 });
            self.work.amplitudes[place.cos_at] = c * place.cos - s * place.sin;
            self.work.amplitudes[place.cos_at + SLOTS] = c * place.sin + s * place.cos;
        }
    }

    /// `P_k` into `quadratic`, `l_k` into `bend_spectrum`; leaves the curvatures in `bend_field`.
    fn bend(&mut self) {
        let Work { amplitudes, quadratic, bend_spectrum, bend_field, airy_spectrum, airy_field, .. } =
            &mut self.work;
        let kernels = self.kernels;
        kernels.spread(&self.curvatures, amplitudes, bend_spectrum);
        kernels.unfold(&self.bends, bend_spectrum, bend_field);
        kernels.bracket(self.lanes, bend_field, airy_field);
        kernels.fold(&self.airys, airy_field, airy_spectrum);
        quadratic.fill(0.0);
        kernels.gather(&self.stresses, airy_spectrum, quadratic);
    }

    /// Energies; `f_k` into `forces`, and turns `l_k` into `2 c_k P_k`.
    #[inline(always)]
    fn stretch(&mut self) -> Evaluation {
        let Work { bend_spectrum, quadratic, forces, .. } = &mut self.work;
        let length = SLOTS + 3 * self.lanes;
        // A sum for each lane, so that the compiler may use them all.
        let (mut energy, mut depth) = ([0.0; SLOTS], [0.0; SLOTS]);
        for &(row, bend_row) in &self.rows {
            let stiffness = &self.stiffness.as_chunks::<SLOTS>().0[row];
            for member in 0..2 {
                let p = &quadratic.as_chunks::<SLOTS>().0[2 * row + member];
                let spectrum = &mut bend_spectrum[(2 * bend_row + member) * length..][..length];
                let l = &mut spectrum.as_chunks_mut::<SLOTS>().0[0];
                let f = &mut forces.as_chunks_mut::<SLOTS>().0[2 * row + member];
                for i in 0..SLOTS {
                    let (quadratic, linear) = (p[i], l[i]);
                    let bent = stiffness[i] * linear;
                    let pressed = stiffness[i] * quadratic;
                    f[i] = 2.0 * (pressed + bent);
                    l[i] = 2.0 * pressed;
                    // Of the fourth power of a displacement: in single precision denormal where a plate hardly moves.
                    energy[i] += f64::from(quadratic) * (f64::from(pressed) + 2.0 * f64::from(bent));
                    depth[i] += f64::from(bent) * f64::from(linear);
                }
            }
        }
        Evaluation { energy: energy.into_iter().sum(), depth: depth.into_iter().sum() }
    }

    /// What the stresses press each amplitude with, into `amplitudes`.
    fn press(&mut self) {
        let Work { amplitudes, forces, bend_spectrum, bend_field, airy_spectrum, airy_field, .. } =
            &mut self.work;
        let kernels = self.kernels;
        kernels.spread(&self.stresses, forces, airy_spectrum);
        kernels.unfold(&self.airys, airy_spectrum, airy_field);
        kernels.stress(self.lanes, airy_field, bend_field);
        kernels.fold(&self.bends, bend_field, bend_spectrum);
        amplitudes.fill(0.0);
        kernels.gather(&self.curvatures, bend_spectrum, amplitudes);
    }
}

impl Potential for VonKarman {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        self.align(displacement);
        self.bend();
        let kernels = self.kernels;
        let found = kernels.vectorized(
            #[inline(always)]
            || self.stretch(),
        );
        self.press();
        gradient.fill(0.0);
        for place in &self.places {
            let (c, s) = (self.work.amplitudes[place.cos_at], self.work.amplitudes[place.cos_at + SLOTS]);
            gradient[place.mode] = c * place.cos + s * place.sin;
            if place.m > 0 {
                gradient[place.mode + 1] = s * place.cos - c * place.sin;
            }
        }
        found
    }
}

impl Domed for VonKarman {
    fn dome_terms(&mut self, displacement: &[f32]) -> Vec<f64> {
        self.align(displacement);
        let Work { amplitudes, bend_spectrum, .. } = &mut self.work;
        self.kernels.spread(&self.curvatures, amplitudes, bend_spectrum);
        let (length, mut terms) = (SLOTS + 3 * self.lanes, Vec::new());
        for &(row, bend_row) in &self.rows {
            for member in 0..2 {
                let l = &bend_spectrum[(2 * bend_row + member) * length..][..SLOTS];
                let stiffness = &self.stiffness[row * SLOTS..][..SLOTS];
                let present = l.iter().zip(stiffness).filter(|(_, c)| **c > 0.0);
                terms.extend(present.map(|(l, c)| f64::from(*l) * f64::from(*c).sqrt()));
            }
        }
        terms
    }

    fn flatten(&mut self, factor: f64) {
        self.curvatures.scale(SLOTS, factor);
    }
}

#[cfg(test)]
mod tests;
