//! The share of a dome in a plate's stiffness, which must stay below the whole.
//!
//! Model: what stretching adds to the modes' own energies can be as low as `-sum c_k l_k^2` (see [`von_karman`](super)). The modes'
//! stiffness holds that much for the dome, and what bending resists besides: of the plate that was computed, both together are never
//! negative. Chance splitting and hammering change the stiffness of modes and not the dome's share in it. In directions in which
//! next to nothing but the dome resists, that share may come out as larger than the whole; of plates drawn at random, by up to 6 %;
//! such a plate would fall into a bend without end. Its dome is taken as flatter by what leaves a whole.
//!
//! Limits: flatter in all directions alike, by 3 % at most of those drawn.

use nalgebra::{Cholesky, DMatrix};

use crate::modal::zero_row;

/// Largest share in any direction. *Judgement*: less than one, and more than the standard kit's, 0.995.
const MOST: f64 = 0.998;

/// A stretching energy with a part by a dome.
pub trait Domed {
    /// `sqrt(c_k) l_k` at a displacement, m, `[mode]`: the dome's energy is the sum of their squares, J. Allocates.
    fn dome_terms(&mut self, displacement: &[f32]) -> Vec<f64>;

    /// Takes the dome as flatter: multiplies every `l_k` by a factor.
    fn flatten(&mut self, factor: f64);
}

/// The same of modes of that stiffness (N/m, `[mode]`), with a flatter dome if its share is larger than it can be. Allocates.
pub fn kept_below_the_whole<D: Domed>(mut domed: D, stiffness: &[f64]) -> D {
    let shares = shares(&mut domed, stiffness);
    let left = DMatrix::identity(stiffness.len(), stiffness.len()) * MOST - &shares;
    if Cholesky::new(left).is_none() {
        domed.flatten((MOST / shares.symmetric_eigenvalues().max()).sqrt());
    }
    domed
}

/// Energy of the dome by two modes, each displaced by as much as takes a joule, J, `(mode, mode)`.
fn shares(domed: &mut impl Domed, stiffness: &[f64]) -> DMatrix<f64> {
    let mut displacement = zero_row(stiffness.len());
    let mut terms = Vec::new();
    for (k, &stiffness) in stiffness.iter().enumerate() {
        displacement[k] = if stiffness > 0.0 { (2.0 / stiffness).sqrt() as f32 } else { 0.0 };
        terms.push(domed.dome_terms(&displacement));
        displacement[k] = 0.0;
    }
    let rows = terms.first().map_or(0, Vec::len);
    let terms = DMatrix::from_iterator(rows, terms.len(), terms.into_iter().flatten());
    terms.transpose() * terms
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two modes whose dome resists one combination of them only.
    struct Combined {
        along: [f64; 2],
    }

    impl Domed for Combined {
        fn dome_terms(&mut self, displacement: &[f32]) -> Vec<f64> {
            vec![self.along.iter().zip(displacement).map(|(l, &q)| l * f64::from(q)).sum(), 0.0]
        }

        fn flatten(&mut self, factor: f64) {
            self.along = self.along.map(|l| factor * l);
        }
    }

    #[test]
    fn a_dome_with_more_than_the_whole_stiffness_is_flattened_to_it_and_no_other() {
        let stiffness = [2.0e4, 5.0e4];
        // `(l . q)^2` over `sum K q^2 / 2` is largest along `l / K`: twice `sum l^2 / K`.
        let share = |along: [f64; 2]| along.iter().zip(&stiffness).map(|(l, k)| 2.0 * l * l / k).sum::<f64>();
        let unit = [60.0, 130.0];
        for wanted in [0.5, 0.99, 1.01, 1.2] {
            let by = (wanted / share(unit)).sqrt();
            let domed = Combined { along: unit.map(|l| by * l) };
            let before = domed.along;
            let domed = kept_below_the_whole(domed, &stiffness);
            if wanted < MOST {
                assert_eq!(domed.along, before);
            } else {
                assert!((share(domed.along) - MOST).abs() < 1e-6, "{wanted}: {}", share(domed.along));
            }
        }
    }
}
