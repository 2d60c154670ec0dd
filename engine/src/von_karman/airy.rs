//! Airy functions of a plate's stretching: the clamped plate's modes, or what they become if it is not even.
//!
//! Model: the membrane forces of a stretched plate derive from a stress function `F` with
//! `grad^4 F = -(E h / 2) (L(w, w) + (2/R) lap(w))`, `F = F' = 0` at a rim that is free in its plane.
//! Expanded in clamped modes `Psi_k` (unit mean square, wave number `zeta_k`) the stretching energy is
//!
//! ```text
//! U = sum c_k (P_k + l_k)^2,   c_k = E h a^2 / (8 pi zeta_k^4)
//! P_k = int Psi_k L(w, w) dA,  l_k = (2/R) int Psi_k lap(w) dA
//! ```
//!
//! Where the thickness is `h t(r)`, `grad^4 F` becomes the compliance of the metal and the functions its own
//! ([`StressModes`]); where the rise `w0` is no cap, `(1/R) lap(w)` becomes `L(w0, w)`.
//!
//! Source: Thomas, Touze, Chaigne, Int. J. Solids Struct. 42, 2005.

use std::convert::Infallible;

use crate::cache::{Cache, Shared};
use crate::modal::simd::polar::SLOTS;
use crate::plate::dome::curvature_overlap;
use crate::plate::edges::clamped_modes;
use crate::plate::radial::RadialMode;
use crate::plate::thickness_taper::{Section, StressModes, stiffness_unit};
use crate::plate::{PlateModes, PlateTables, ShellMode};
use crate::schema::SCHEMA;

/// Airy functions of one order, ascending by wave number, which may be none.
pub struct AiryOrder {
    /// Nodal diameters.
    m: u32,
    /// `c_k`, J.
    pub stiffness: Vec<f64>,
    functions: Functions,
}

enum Functions {
    Clamped(Vec<RadialMode>),
    /// Those of every order.
    Uneven(Shared<Vec<StressModes>>),
}

/// Stress functions that have been worked out of late, `[order]`.
static STRESSES: Cache<Vec<StressModes>> = Cache::new("stress", SCHEMA, 24);

impl AiryOrder {
    /// Every Airy function with a wave number up to `limit` (dimensionless: times the radius), at most [`SLOTS`] of one order,
    /// `[order]`, up to order `highest`.
    ///
    /// # Panics
    /// If the tables do not reach the orders.
    pub fn all(plate: &PlateModes, tables: &PlateTables, highest: u32, limit: f64) -> Vec<AiryOrder> {
        let unit = stiffness_unit(&plate.spec);
        let uneven = (!plate.spec.is_even()).then(|| stresses(plate, tables, highest, limit));
        let order = |m: u32| match &uneven {
            None => {
                let mut modes = clamped_modes(m, limit);
                modes.truncate(SLOTS);
                let stiffness = modes.iter().map(|mode| unit / mode.root.powi(4)).collect();
                AiryOrder { m, stiffness, functions: Functions::Clamped(modes) }
            }
            Some(orders) => {
                let stiffness = orders[m as usize].compliance.iter().map(|compliance| unit / compliance);
                AiryOrder { m, stiffness: stiffness.collect(), functions: Functions::Uneven(orders.clone()) }
            }
        };
        (0..=highest).map(order).collect()
    }

    /// Radial shapes at `radii` (shares of the radius), dimensionless, `[airy][r]`.
    ///
    /// # Panics
    /// If the tables do not reach the order.
    pub fn shapes(&self, tables: &PlateTables, radii: &[f64]) -> Vec<Vec<f64>> {
        let sample = |mode: &RadialMode| {
            let mut row = vec![0.0; radii.len()];
            let (j, i) = tables.order(mode.m);
            mode.sample(j, i, radii, &mut row);
            row
        };
        match &self.functions {
            Functions::Clamped(modes) => modes.iter().map(sample).collect(),
            Functions::Uneven(orders) => orders[self.m as usize].shapes(radii),
        }
    }

    /// `B^k_p` with a shell mode of the same order, `[airy]`: `l_k` per unit of its displacement, 1/m.
    pub fn curvature(&self, plate: &PlateModes, shell: &ShellMode) -> Vec<f64> {
        let scale = 2.0 * plate.spec.curvature();
        let sum = |of: &dyn Fn(usize, &RadialMode) -> f64| {
            let terms = plate.flat_of(shell).iter().zip(&shell.expansion).enumerate();
            terms.map(|(p, (flat, share))| share * of(p, flat)).sum::<f64>()
        };
        match &self.functions {
            Functions::Clamped(modes) => {
                modes.iter().map(|airy| scale * sum(&|_, flat| curvature_overlap(airy, flat))).collect()
            }
            Functions::Uneven(orders) => {
                orders[self.m as usize].doming.iter().map(|row| sum(&|p, _| row[p])).collect()
            }
        }
    }
}

/// Stress functions of an uneven plate, `[order]`.
fn stresses(plate: &PlateModes, tables: &PlateTables, highest: u32, limit: f64) -> Shared<Vec<StressModes>> {
    let reach = plate.flat.iter().flatten().map(|flat| flat.root).fold(0.0, f64::max);
    // The flat modes follow from the plate and from how far they reach.
    let Ok(stresses) = STRESSES.get(&(plate.spec, reach, highest, limit), || {
        let section = Section::new(&plate.spec, reach);
        let order =
            |m: u32| StressModes::new(&section, &plate.flat[m as usize], m, tables.order(m), (limit, SLOTS));
        Ok::<_, Infallible>((0..=highest).map(order).collect())
    });
    stresses
}
