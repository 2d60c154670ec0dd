//! How the rims of two cymbals miss being flat.
//!
//! Model: what hammering leaves of curvature along a rim is random and as large in every order; the height is its double integral, so
//! that the order `m` has a strength in proportion to `1 / m^2`. Orders 0 and 1 are a distance and a lean. The rims of a pair
//! differ by one such wave, which stands for both.

use serde::{Deserialize, Serialize};

use super::rim_points::{self, POINTS};
use crate::numbers::{Numbers, Visitor};
use crate::random_field;

/// Orders that the points around a rim tell apart, and that are no lean.
const ORDERS: std::ops::Range<u32> = 2..(POINTS / 2) as u32;

/// How far the rims of a pair are from flat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WarpSpec {
    /// Root mean square around the rim, m, 0 (flat) to 0.005.
    #[serde(rename = "rms_m")]
    pub rms: f64,
    /// Tells one pair's rims from another's.
    pub seed: u32,
}

impl Numbers for WarpSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("rms_m", &mut self.rms, 0.0..=5e-3);
    }
}

impl WarpSpec {
    /// By how much the gap of the rims is wider than its mean at each point, m.
    pub fn heights(&self) -> [f64; POINTS] {
        let mut heights = [0.0; POINTS];
        for m in ORDERS {
            let strength = f64::from(m).powi(-2);
            let [cosine, sine] = random_field::normal(self.seed, m, 0, 0);
            for (place, height) in heights.iter_mut().enumerate() {
                let (sin, cos) = (f64::from(m) * rim_points::angle(place)).sin_cos();
                *height += strength * (cosine * cos + sine * sin);
            }
        }
        let mean_square = heights.iter().map(|height| height * height).sum::<f64>() / POINTS as f64;
        // The root mean square is of this pair, not of all that could be drawn.
        heights.map(|height| self.rms * height / mean_square.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rim_is_as_far_from_flat_as_it_is_said_to_be_and_does_not_lean() {
        for seed in 0..50 {
            let heights = WarpSpec { rms: 1e-3, seed }.heights();
            let of = |wave: &dyn Fn(f64) -> f64| -> f64 {
                heights.iter().enumerate().map(|(j, h)| h * wave(rim_points::angle(j))).sum::<f64>()
                    / POINTS as f64
            };
            for (order, found) in [of(&|_| 1.0), of(&f64::cos), of(&f64::sin)].into_iter().enumerate() {
                assert!(found.abs() < 1e-15, "seed {seed}, wave {order}: {found} m");
            }
            let square = heights.iter().map(|height| height * height).sum::<f64>() / POINTS as f64;
            assert!((square.sqrt() / 1e-3 - 1.0).abs() < 1e-12);
        }
        assert_eq!(WarpSpec { rms: 0.0, seed: 1 }.heights(), [0.0; POINTS]);
    }

    #[test]
    fn curvature_is_as_large_in_every_order() {
        let mut squares = [0.0; ORDERS.end as usize];
        for seed in 0..400 {
            let heights = WarpSpec { rms: 1.0, seed }.heights();
            for m in ORDERS {
                let part = |wave: fn(f64) -> f64| -> f64 {
                    let turned = |j| wave(f64::from(m) * rim_points::angle(j));
                    (0..POINTS).map(|j| heights[j] * turned(j)).sum()
                };
                let curvature = f64::from(m).powi(2);
                squares[m as usize] +=
                    (curvature * part(f64::cos)).powi(2) + (curvature * part(f64::sin)).powi(2);
            }
        }
        // Rims of one root mean square: what one order has more, the others have less. Order 2 is therefore less random.
        for m in 3..squares.len() {
            let ratio: f64 = squares[m] / squares[3];
            assert!((0.6..1.7).contains(&ratio), "order {m}: {ratio}");
        }
    }
}
