//! A dot: a disc of film glued to the middle of a head.
//!
//! Model: within the radius `b` the head weighs more, by the dot's own mass per area `s_d`, and resists bending more, by
//! `D_d = D(h + h_d) - D(h)`, as one film of both thicknesses would. With the shapes of the head without it as coordinates and
//!
//! ```text
//! G_ij = int_(r < b) phi_i phi_j dA
//! ```
//!
//! it adds `s_d G_ij` to the mass and `D_d k_i^2 k_j^2 G_ij` to the stiffness of the modes of one order: `laplace(phi) = -k^2 phi`.
//! `G` is a Gram matrix, so that both are positive, whatever is left out of the set. It has a closed form (Lommel's integrals): with
//! `x = b / a`, `f = N J_m(j x)`, `g = j N J_m'(j x)`
//!
//! ```text
//! G_ij = C_m a^2 x (f_i g_j - g_i f_j) / (j_i^2 - j_j^2)      G_ii = C_m a^2 x^2 / 2 [(g_i / j_i)^2 + (1 - (m / (j_i x))^2) f_i^2]
//! ```
//!
//! Neglected: the dot bears none of the head's tension (its glue creeps; one that did not would stretch the middle by a fifth more than the
//! rest); the part of bending that depends on Poisson's ratio at the dot's edge.
//!
//! Source: Watson, Theory of Bessel Functions, 5.11 (the integrals).

use serde::{Deserialize, Serialize};

use crate::air_load;
use crate::damping::LossLaw;
use crate::numbers::{Numbers, Visitor};

/// A disc of the head's own film glued to its middle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DotSpec {
    /// Diameter, m, 0.02 to nine tenths of the head's.
    #[serde(rename = "diameter_m")]
    pub diameter: f64,
    /// Thickness, m, 0.00002 to 0.001.
    #[serde(rename = "thickness_m")]
    pub thickness: f64,
    /// What the head loses more where it lies: the glue.
    pub loss: LossLaw,
}

impl DotSpec {
    /// Shows its numbers to a visitor; `head` is the diameter of the head it lies on, m.
    pub fn visit_numbers(&mut self, head: f64, visitor: &mut dyn Visitor) {
        visitor.number("diameter_m", &mut self.diameter, 0.02..=0.9 * head);
        visitor.number("thickness_m", &mut self.thickness, 2e-5..=1e-3);
        self.loss.visit_part("loss", visitor);
    }
}

/// What a dot adds to a head, per area that it covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Added {
    /// Its radius, share of the head's.
    pub reach: f64,
    /// Mass, kg/m2.
    pub density: f64,
    /// Flexural rigidity, N m.
    pub rigidity: f64,
    /// Stretching stiffness, N/m.
    pub stretching: f64,
    /// Losses.
    pub loss: LossLaw,
}

/// A mode's zero `j`, its shape and `j` times its slope at the edge of the dot, dimensionless: `j`, `f`, `g`.
pub type AtEdge = [f64; 3];

/// `G_ij` over the head's area (dimensionless) of two modes of order `m`, with a dot that reaches so far (share of the radius).
pub fn overlap(m: u32, reach: f64, one: AtEdge, other: AtEdge) -> f64 {
    let ([j, f, g], [other_j, other_f, other_g]) = (one, other);
    let integral = if j == other_j {
        let (slope, turns) = (g / j, f64::from(m) / (j * reach));
        0.5 * reach * reach * (slope * slope + (1.0 - turns * turns) * f * f)
    } else {
        reach * (f * other_g - g * other_f) / (j * j - other_j * other_j)
    };
    air_load::circle(m) / std::f64::consts::PI * integral
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bessel;
    use crate::math::quadrature::GaussLegendre;

    #[test]
    fn overlaps_are_integrals_of_products_of_shapes() {
        let rule = GaussLegendre::unit(60);
        for (m, reach) in [(0, 0.36), (1, 0.36), (4, 0.2), (2, 0.9)] {
            let mode = |n| {
                let j = bessel::zero(m, n);
                (j, air_load::shape_norm(m, bessel::j_prime(m, j)))
            };
            let edge = |n| {
                let (j, norm) = mode(n);
                let (value, slope) = bessel::j_pair(m, j * reach);
                [j, norm * value, norm * j * slope]
            };
            for (n, other) in [(1, 1), (1, 2), (3, 7), (5, 5)] {
                let ((j, norm), (k, other_norm)) = (mode(n), mode(other));
                let product = |r: f64| norm * bessel::j(m, j * r) * other_norm * bessel::j(m, k * r) * r;
                let nodes = rule.nodes.iter().zip(&rule.weights);
                let sum: f64 = nodes.map(|(x, weight)| weight * reach * product(x * reach)).sum();
                let exact = air_load::circle(m) / std::f64::consts::PI * sum;
                let closed = overlap(m, reach, edge(n), edge(other));
                assert!((closed - exact).abs() < 1e-11, "({m}, {n}), ({m}, {other}): {closed} {exact}");
            }
        }
    }
}
