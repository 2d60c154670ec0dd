//! The air a membrane carries and the sound it sends out: added mass and radiation resistance.
//!
//! Model: one face in an infinite baffle (the Rayleigh integral), in the wavenumber domain. With
//! `f(x)` the Hankel transform of the mode shape in units of the radius, `u = omega a / c`,
//! `C_m = 2 pi` for `m = 0` and `pi` otherwise:
//!
//! ```text
//! mass       = rho a^3 C_m        int_0^inf f(sqrt(u^2 + s^2))^2 ds
//! resistance = rho omega a^3 C_m  int_0^u   f(sqrt(u^2 - s^2))^2 ds
//! ```
//!
//! per face; `omega` is where the mode rings. The substitutions under the roots take the
//! singularity of `1 / sqrt(u^2 - x^2)` away. For a membrane `f` is known in closed form.
//!
//! Quadrature: `f^2` is an even entire function of `x`, so that the first integrand is one of `s`, of exponential type 2:
//! its spectrum ends at 2, and the trapezoidal rule over all `s` is exact for every step below pi (Poisson's
//! summation). Cut off at `s_N` with half a weight, a step of pi / 2 leaves of the tail's oscillation, which then changes sign
//! from point to point, nothing to first order, and its mean has a closed form. The second integral is Gauss's.
//!
//! Limits: modes of one order are coupled a little by the air; that coupling is neglected.
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 7; Christian et al., JASA 76 (1984).

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use crate::math::bessel::JTable;
use crate::math::quadrature;

/// Density of air, kg/m3.
pub const DENSITY: f64 = 1.2;
/// Speed of sound, m/s.
pub const SPEED_OF_SOUND: f64 = 343.0;

/// Chebyshev nodes of a mass curve. *Measured*: the mass is met within 1e-4, a fortieth of a cent; of modes of thirty
/// circles, whose air weighs next to nothing, within 2e-4.
const NODES: usize = 28;

/// Highest `omega a / c` over `j` that a mass curve follows. *Derived*: the peak at 1 is some `1 / sqrt(j)` wide.
const SUBSONIC: f64 = 0.8;

/// `C_m`: how the square of a shape integrates around the circle, rad.
pub fn circle(m: u32) -> f64 {
    if m == 0 { std::f64::consts::TAU } else { std::f64::consts::PI }
}

/// Load of one face by the air, in units of `rho a^3` (mass) and `rho omega a^3` (resistance).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirLoad {
    /// Added mass over `rho a^3`.
    pub mass: f64,
    /// Radiation resistance over `rho omega a^3`.
    pub resistance: f64,
}

/// Works out the loads of membrane modes of one order.
pub struct MembraneAir<'a> {
    m: u32,
    bessel: &'a JTable,
}

/// How far past the mode's own wavenumber the mass integral is carried; the rest has a closed form.
const BEYOND: f64 = 40.0;

/// Step of the mass integral: half the longest that is exact.
const STEP: f64 = FRAC_PI_2;

impl<'a> MembraneAir<'a> {
    /// For order `m`; `bessel` tabulates `J_m` to at least the largest zero used plus 45.
    pub fn new(m: u32, bessel: &'a JTable) -> Self {
        MembraneAir { m, bessel }
    }

    /// Argument (dimensionless) the Bessel table must reach for modes up to the zero `j`.
    pub fn reach(j: f64) -> f64 {
        j + BEYOND + 5.0
    }

    /// Load of the mode whose radial wavenumber is the zero `j` of `J_m`, at `u = omega a / c`, all dimensionless.
    pub fn load(&self, j: f64, u: f64) -> AirLoad {
        let shape = HankelShape::new(self.m, j, self.bessel);
        let square = |t: f64| shape.at(u * (1.0 - t * t).max(0.0).sqrt()).powi(2);
        // Half a node for each unit of the type resolves it, some more reach rounding.
        let rule = quadrature::shared_unit(u as usize + 12);
        AirLoad { mass: self.mass(j, u), resistance: circle(self.m) * u * rule.integrate(square) }
    }

    /// The mass of [`load`](Self::load) alone, the ratio to `rho a^3`.
    pub fn mass(&self, j: f64, u: f64) -> f64 {
        let shape = HankelShape::new(self.m, j, self.bessel);
        let far = ((j + BEYOND).powi(2) - u * u).max(0.0).sqrt();
        let last = (far / STEP).ceil().max(1.0);
        let square = |s: f64| shape.at((u * u + s * s).sqrt()).powi(2);
        let between: f64 = (1..last as usize).map(|i| square(STEP * i as f64)).sum();
        let near = STEP * (0.5 * (square(0.0) + square(STEP * last)) + between);
        // Past the end the squared cosine of J_m averages to a half: f^2 is 1 / (pi x^5) times this.
        let end = u.hypot(STEP * last);
        let tail = shape.scale * shape.scale / (4.0 * PI * end.powi(4));
        circle(self.m) * (near + tail)
    }

    /// The mass (over `rho a^3`) as a function of the dimensionless `u = omega a / c`, for solving and retuning.
    ///
    /// Held from where waves on the head come near the speed of sound: there its load turns from a mass into a
    /// resistance within a few percent, which no curve follows and no mode survives long enough to show.
    pub fn curve(&self, j: f64) -> MassCurve {
        let most = SUBSONIC * j;
        let logarithms = CHEBYSHEV.map(|place| self.mass(j, most * place).ln());
        MassCurve { most, logarithms }
    }
}

/// Mass curves worked out so far: they are the same for every head, whatever its size.
#[derive(Debug, Clone, Default)]
pub struct MassCurves(BTreeMap<(u32, u64), MassCurve>);

impl MassCurves {
    /// That of the mode whose radial wavenumber is the (dimensionless) zero `j`.
    pub fn get(&mut self, air: &MembraneAir, j: f64) -> MassCurve {
        *self.0.entry((air.m, j.to_bits())).or_insert_with(|| air.curve(j))
    }
}

/// Hankel transform `f(x) = N j J_m'(j) J_m(x) / (x^2 - j^2)` of a membrane's shape.
pub struct HankelShape<'a> {
    j: f64,
    /// `N j J_m'(j)`, of size `j` or `sqrt 2 j`.
    scale: f64,
    slope: f64,
    bessel: &'a JTable,
}

impl<'a> HankelShape<'a> {
    /// For the zero `j` of `J_m` (dimensionless).
    pub fn new(m: u32, j: f64, bessel: &'a JTable) -> Self {
        let slope = bessel.pair(j).1;
        HankelShape { j, scale: shape_norm(m, slope) * j * slope, slope, bessel }
    }

    /// `f(x)`, both dimensionless.
    pub fn at(&self, x: f64) -> f64 {
        self.of_bessel(x, self.bessel.value(x))
    }

    /// `f(x)`, given `J_m(x)`, which all shapes of an order share.
    pub fn of_bessel(&self, x: f64, value: f64) -> f64 {
        let gap = x * x - self.j * self.j;
        if gap.abs() < 1e-3 * self.j {
            // J_m is a straight line this close to its zero, to 1e-6.
            return self.scale * self.slope / (x + self.j);
        }
        self.scale * value / gap
    }
}

/// `N` of a membrane's shape `N J_m(j r) cos(m theta)` for a mean square of one, from `J_m'(j)`.
pub fn shape_norm(m: u32, slope: f64) -> f64 {
    (if m == 0 { 1.0 } else { std::f64::consts::SQRT_2 }) / slope.abs()
}

/// Area (m2) of the monopole in a baffle that radiates, at the same acceleration, the power of a mode
/// with this resistance (over `rho omega a^3`): `R = rho omega^2 S^2 / (2 pi c)`.
pub fn monopole_area(radius: f64, resistance: f64, omega: f64) -> f64 {
    (std::f64::consts::TAU * SPEED_OF_SOUND * radius.powi(3) * resistance / omega).sqrt()
}

/// Added mass of a mode against frequency, by Chebyshev interpolation of `ln mass` in `u`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MassCurve {
    /// The greatest `u`; infinity in vacuum.
    most: f64,
    /// Logarithms at the nodes; minus infinity in vacuum.
    logarithms: [f64; NODES],
}

/// Chebyshev nodes of the second kind on `0..1`, `(1 - cos(pi i / (n - 1))) / 2`.
const CHEBYSHEV: [f64; NODES] = [
    0.0,
    0.003_380_821_129_028_488_4,
    0.013_477_564_710_088_097,
    0.030_153_689_607_045_786,
    0.053_183_679_838_293_86,
    0.082_256_094_293_531_76,
    0.116_977_778_440_511,
    0.156_879_181_065_633_2,
    0.201_420_704_148_606_9,
    0.249_999_999_999_999_94,
    0.301_960_116_980_421_6,
    0.356_598_383_644_454_84,
    0.413_175_911_166_534_8,
    0.470_927_585_544_762_16,
    0.529_072_414_455_237_9,
    0.586_824_088_833_465,
    0.643_401_616_355_545_2,
    0.698_039_883_019_578_4,
    0.749_999_999_999_999_9,
    0.798_579_295_851_393,
    0.843_120_818_934_366_7,
    0.883_022_221_559_489_2,
    0.917_743_905_706_468_1,
    0.946_816_320_161_706_1,
    0.969_846_310_392_954_2,
    0.986_522_435_289_911_9,
    0.996_619_178_870_971_5,
    1.0,
];

impl MassCurve {
    /// A mode in vacuum: no mass, whatever its unit.
    pub const VACUUM: MassCurve = MassCurve { most: f64::INFINITY, logarithms: [f64::NEG_INFINITY; NODES] };

    /// Ratio of the mass to `rho a^3` at `u = omega a / c`; held beyond the greatest.
    pub fn at(&self, u: f64) -> f64 {
        if self.most == f64::INFINITY {
            return 0.0;
        }
        let t = (u / self.most).clamp(0.0, 1.0);
        let (mut sum, mut total) = (0.0, 0.0);
        for (i, (logarithm, node)) in self.logarithms.iter().zip(&CHEBYSHEV).enumerate() {
            let gap = t - node;
            if gap == 0.0 {
                return logarithm.exp();
            }
            let end = if i == 0 || i == NODES - 1 { 0.5 } else { 1.0 };
            let weight = if i % 2 == 0 { end / gap } else { -end / gap };
            sum += weight * logarithm;
            total += weight;
        }
        (sum / total).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bessel;

    #[test]
    fn slow_piston_like_mode_radiates_its_volume_velocity() {
        // For u -> 0 the resistance is rho omega^2 (int W dA)^2 / (2 pi c).
        let j = bessel::zero(0, 1);
        let table = JTable::new(0, MembraneAir::reach(j));
        let u = 0.01;
        let load = MembraneAir::new(0, &table).load(j, u);
        let volume = 2.0 * std::f64::consts::PI / j;
        let monopole = u * volume * volume / std::f64::consts::TAU;
        assert!((load.resistance / monopole - 1.0).abs() < 1e-3, "{} {monopole}", load.resistance);
    }

    #[test]
    fn loads_agree_with_a_fine_direct_integral() {
        for (m, n, u) in [(0, 1, 0.4), (1, 1, 1.0), (2, 3, 5.0), (7, 2, 9.0)] {
            let j = bessel::zero(m, n);
            let table = JTable::new(m, 400.0);
            let load = MembraneAir::new(m, &table).load(j, u);
            let norm = shape_norm(m, bessel::j_prime(m, j)) * j * bessel::j_prime(m, j);
            let f2 = |x: f64| (norm * bessel::j(m, x) / (x * x - j * j)).powi(2);
            let sum = |end: f64, steps: u32, f: &dyn Fn(f64) -> f64| {
                (0..steps).map(|i| f((f64::from(i) + 0.5) * end / f64::from(steps))).sum::<f64>() * end
                    / f64::from(steps)
            };
            let mass = circle(m) * sum(300.0, 300_000, &|s| f2((u * u + s * s).sqrt()));
            let resistance = circle(m) * sum(u, 20_000, &|s| f2((u * u - s * s).sqrt()));
            assert!((load.mass / mass - 1.0).abs() < 1e-5, "({m},{n}) {} {mass}", load.mass);
            assert!((load.resistance / resistance - 1.0).abs() < 1e-4, "({m},{n})");
        }
    }

    #[test]
    fn the_nodes_are_chebyshevs() {
        for (i, node) in CHEBYSHEV.into_iter().enumerate() {
            assert!(
                (node - 0.5 + 0.5 * (PI * i as f64 / (NODES - 1) as f64).cos()).abs() < 1e-15,
                "{i}: {node}"
            );
        }
    }

    #[test]
    fn the_curve_meets_the_integral_between_its_nodes() {
        for (m, n) in [(0, 1), (1, 2), (9, 4), (3, 6)] {
            let j = bessel::zero(m, n);
            let table = JTable::new(m, MembraneAir::reach(j));
            let air = MembraneAir::new(m, &table);
            let curve = air.curve(j);
            for share in [0.001, 0.02, 0.05, 0.071, 0.13, 0.29, 0.43, 0.5, 0.7, 0.79] {
                let (got, want) = (curve.at(share * j), air.mass(j, share * j));
                assert!((got / want - 1.0).abs() < 1e-4, "({m},{n}) {share}: {got} {want}");
            }
        }
    }
}
