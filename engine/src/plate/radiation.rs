//! Radiation resistance of a plate's modes.
//!
//! Model: a plane disc in a baffle, each face on its own: Rayleigh's integral in the wavenumber
//! domain. With `H` the Hankel transform of the radial shape, `u = omega a / c` and `C_m` 2 pi for
//! `m = 0`, else pi, each face has
//!
//! ```text
//! R = rho omega a^3 C_m int_0^u H(sqrt(u^2 - s^2))^2 ds
//!   = rho omega a^3 C_m u int_0^(pi/2) H(u sin(phi))^2 sin(phi) dphi
//! ```
//!
//! The second form has a smooth integrand; Gauss's rule with `u + 16` nodes integrates it to 1e-6.
//! Both faces together radiate twice that, and a mode of mass `M` decays by `2 R / (2 M)`.
//!
//! Source: Williams, Fourier Acoustics, 2.11; Morse & Ingard, Theoretical Acoustics, 7.4.
//!
//! Limits: no flow around the rim. Below `u` of about 2 a real plate, whose faces short-circuit
//! each other, radiates less than this; its modes are damped by their metal there. The air's mass, about
//! `2 rho a / k` per area, is neglected: 2.5 % of the plate's at a crash's lowest mode, less above.

use std::f64::consts::FRAC_PI_2;

use super::radial::{RadialMode, Rim, angular_norm};
use crate::air;
use crate::math::bessel::JTable;
use crate::math::quadrature::GaussLegendre;

/// Distance from a flat mode's wave number within which its transform is read from a Taylor series.
/// *Derived*: balances the tables' error over the distance with the series' own, both about 1e-6.
const GUARD: f64 = 1e-3;

/// Rules are made for multiples of so many nodes, and kept.
const RULE_STEP: usize = 8;

/// Radiation resistance of any mode of a plate at any frequency.
pub struct Radiator<'a> {
    /// `[order]`, reaching the largest `omega a / c` asked for.
    tables: &'a [JTable],
    radius: f64,
    /// `[nodes / RULE_STEP]`
    rules: Vec<Option<GaussLegendre>>,
}

impl<'a> Radiator<'a> {
    /// For a plate of that `radius` (m), with tables of `J_m` for each of its orders.
    pub fn new(tables: &'a [JTable], radius: f64) -> Radiator<'a> {
        Radiator { tables, radius, rules: Vec::new() }
    }

    /// Radiation resistance of both faces together, kg/s, at `omega` (rad/s), of the mode that is
    /// the sum of `flat` modes of one order weighted by `expansion`.
    pub fn resistance(&mut self, flat: &[RadialMode], expansion: &[f64], omega: f64) -> f64 {
        let Some(first) = flat.first() else {
            return 0.0;
        };
        let m = first.m;
        let table = &self.tables[m as usize];
        let u = omega * self.radius / air::SPEED_OF_SOUND;
        let integrand = |phi: f64| {
            let sine = phi.sin();
            let x = u * sine;
            let (value, slope) = table.pair(x);
            let wave = Rim { value, slope: x * slope };
            let terms = flat.iter().zip(expansion);
            let transform: f64 = terms.map(|(mode, share)| share * mode.hankel_of(x, wave, GUARD)).sum();
            transform * transform * sine
        };
        let integral = u * self.rule(u).integrate(integrand);
        2.0 * air::DENSITY * omega * self.radius.powi(3) * angular_norm(m) * integral
    }

    /// The rule on a quarter turn that resolves a transform up to `u`.
    fn rule(&mut self, u: f64) -> &GaussLegendre {
        let index = (u as usize + 16).div_ceil(RULE_STEP);
        if self.rules.len() <= index {
            self.rules.resize(index + 1, None);
        }
        let make = || GaussLegendre::new(index * RULE_STEP, 0.0, FRAC_PI_2);
        self.rules[index].get_or_insert_with(make)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plate::edges::free_modes;
    use std::f64::consts::PI;

    const RADIUS: f64 = 0.2032;

    #[test]
    fn the_resistance_is_rayleighs_integral() {
        let tables = JTable::orders(40, 120.0);
        let mut radiator = Radiator::new(&tables, RADIUS);
        let fine = GaussLegendre::new(500, 0.0, 1.0);
        for (m, u) in [(0, 0.3), (0, 9.0), (2, 2.5), (7, 30.0), (7, 88.0), (40, 50.0), (40, 110.0)] {
            let flat = free_modes(m, 0.34, 75.0);
            for p in [0, flat.len() / 2, flat.len() - 1] {
                let mut expansion = vec![0.0; flat.len()];
                expansion[p] = 1.0;
                let omega = u * air::SPEED_OF_SOUND / RADIUS;
                let got = radiator.resistance(&flat, &expansion, omega);
                let integrand = |share: f64| {
                    let s = u * share;
                    u * flat[p].hankel((u * u - s * s).sqrt()).powi(2)
                };
                let scale = 2.0 * air::DENSITY * omega * RADIUS.powi(3) * angular_norm(m);
                let want = scale * fine.integrate(integrand);
                let floor = 1e-9 * air::DENSITY * air::SPEED_OF_SOUND * PI * RADIUS * RADIUS;
                assert!((got - want).abs() < 1e-5 * want + floor, "({m}, {p}) {u}: {got} {want}");
            }
        }
    }

    #[test]
    fn far_above_coincidence_a_mode_radiates_as_a_plane_wave_from_its_whole_area() {
        let tables = JTable::orders(3, 400.0);
        let mut radiator = Radiator::new(&tables, RADIUS);
        let flat = free_modes(3, 0.34, 12.0);
        let expansion = vec![1.0 / (flat.len() as f64).sqrt(); flat.len()];
        let got = radiator.resistance(&flat, &expansion, 380.0 * air::SPEED_OF_SOUND / RADIUS);
        let want = 2.0 * air::DENSITY * air::SPEED_OF_SOUND * PI * RADIUS * RADIUS;
        assert!((got / want - 1.0).abs() < 0.01, "{got} for {want}");
    }

    #[test]
    fn more_nodes_would_not_change_a_resistance() {
        let tables = JTable::orders(12, 120.0);
        let flat = free_modes(12, 0.34, 75.0);
        let expansion: Vec<f64> = (0..flat.len()).map(|p| 0.5 / (1.0 + p as f64)).collect();
        for u in [5.0, 20.0, 45.0, 70.0, 100.0] {
            let omega = u * air::SPEED_OF_SOUND / RADIUS;
            let coarse = Radiator::new(&tables, RADIUS).resistance(&flat, &expansion, omega);
            let mut twice = Radiator::new(&tables, RADIUS);
            let index = (u as usize + 16).div_ceil(RULE_STEP);
            twice.rules = vec![None; index + 1];
            twice.rules[index] = Some(GaussLegendre::new(2 * index * RULE_STEP, 0.0, FRAC_PI_2));
            let fine = twice.resistance(&flat, &expansion, omega);
            assert!((coarse / fine - 1.0).abs() < 1e-5, "u {u}: {coarse}, {fine}");
        }
    }
}
