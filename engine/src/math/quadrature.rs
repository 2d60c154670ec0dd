//! Gauss-Legendre quadrature.
//!
//! `n` nodes integrate polynomials of degree `2 n - 1` exactly. Nodes are the zeros of `P_n` by
//! Newton's iteration from Tricomi's estimate, weights `2 / ((1 - x^2) P_n'(x)^2)`.
//!
//! Source: Abramowitz & Stegun, 25.4.29 and 22.16.6. Checked up to 512 nodes.

use std::f64::consts::PI;

use crate::cache::{Numbered, Shared};

/// Nodes and weights on an interval.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    /// Nodes, ascending.
    pub nodes: Vec<f64>,
    /// Weights; their sum is the interval's length.
    pub weights: Vec<f64>,
}

impl GaussLegendre {
    /// The rule of `n` nodes on `0..1`.
    pub fn unit(n: usize) -> GaussLegendre {
        GaussLegendre::new(n, 0.0, 1.0)
    }

    /// The rule of `n` nodes on `a..b`.
    pub fn new(n: usize, a: f64, b: f64) -> GaussLegendre {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let (mut nodes, mut weights) = (vec![middle; n], vec![0.0; n]);
        for i in 0..n.div_ceil(2) {
            let (x, weight) = node(n, i);
            nodes[i] = middle - half * x;
            nodes[n - 1 - i] = middle + half * x;
            weights[i] = half * weight;
            weights[n - 1 - i] = half * weight;
        }
        GaussLegendre { nodes, weights }
    }

    /// Integral of `f` over the interval.
    pub fn integrate(&self, mut f: impl FnMut(f64) -> f64) -> f64 {
        let terms = self.nodes.iter().zip(&self.weights);
        terms.map(|(&x, &weight)| weight * f(x)).sum()
    }
}

/// The rule of `n` nodes on `0..1`, found once in a process: thousands of modes want the same few hundred rules, and
/// finding their nodes takes longer than what is integrated with them (*measured*: a tenth of building a kit).
pub fn shared_unit(n: usize) -> Shared<GaussLegendre> {
    static RULES: Numbered<GaussLegendre> = Numbered::new();
    RULES.get(n, || GaussLegendre::unit(n))
}

/// The `i`-th node of `n` from the right end of `-1..1`, and its weight.
fn node(n: usize, i: usize) -> (f64, f64) {
    let count = n as f64;
    let angle = PI * (i as f64 + 0.75) / (count + 0.5);
    let mut x = (1.0 - (count - 1.0) / (8.0 * count.powi(3))) * angle.cos();
    if 2 * i + 1 == n {
        // The middle node of an odd rule, exactly.
        x = 0.0;
    }
    // Two steps reach rounding from Tricomi's estimate; a third costs nothing worth saving.
    for _ in 0..3 {
        let (value, slope) = legendre(n, x);
        x -= value / slope;
    }
    let (_, slope) = legendre(n, x);
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// `P_n(x)` and `P_n'(x)`.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut below, mut value) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (below, value) = (value, ((2.0 * k + 1.0) * x * value - k * below) / (k + 1.0));
    }
    (value, n as f64 * (below - x * value) / (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn n_nodes_integrate_powers_up_to_2_n_minus_1_to_rounding() {
        for n in [1, 2, 3, 7, 16, 65, 512] {
            let rule = GaussLegendre::unit(n);
            for power in 0..2 * n as i32 {
                let got = rule.integrate(|x| x.powi(power));
                let want = 1.0 / f64::from(power + 1);
                assert!((got - want).abs() < 3e-15, "n {n}, x^{power}: {got} for {want}");
            }
        }
    }

    #[test]
    fn an_oscillation_is_integrated_to_rounding() {
        let rule = GaussLegendre::new(512, -1.0, 3.0);
        let want = (600.0_f64.sin() + 200.0_f64.sin()) / 200.0;
        assert!((rule.integrate(|x| (200.0 * x).cos()) - want).abs() < 1e-13);
    }

    #[test]
    fn nodes_ascend_and_weights_are_positive() {
        let rule = GaussLegendre::unit(301);
        assert!(rule.nodes.is_sorted() && rule.nodes[0] > 0.0 && rule.nodes[300] < 1.0);
        assert!(rule.weights.iter().all(|&weight| weight > 0.0));
    }
}
