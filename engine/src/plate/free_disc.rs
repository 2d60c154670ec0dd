//! The sound of a thin disc in free air: what it loses and what is heard of it at a point.
//!
//! Model: no baffle. Air flows around the rim, the faces short-circuit each other, and at low frequency
//! a plate radiates as the dipole it is. The pressure differs between the faces by a jump `mu` and
//! everywhere is the field of a double layer,
//!
//! ```text
//! p(x) = int mu(y) d/dn e^(-i k d) / (4 pi d) dS
//! ```
//!
//! In the wavenumber domain the acceleration it goes with is `rho a = (i k_z / 2) mu`,
//! `k_z = sqrt(k^2 - kappa^2)`, evanescent `-i sqrt(kappa^2 - k^2)`; it must be the plate's on the disc
//! and is free outside. That is solved by Galerkin's method in functions that vanish at the rim as
//! the jump does,
//!
//! ```text
//! phi_i = r^m sqrt(1 - r^2) P_i^(m, 1/2)(1 - 2 r^2)   with Hankel transforms   j_n(x) / x,  n = m + 2 i + 1
//! ```
//!
//! whose matrix at zero frequency is diagonal, `-i pi / (2 (2 n + 1))`. A rigid disc then has its
//! known `8/3 rho a^3` of air. The delay from the centre is taken out of what is heard.
//!
//! Coordinates and signs: as [`radiation`](crate::radiation); displacement is into the struck face.
//!
//! Sources: Bouwkamp, Diffraction Theory, Rep. Prog. Phys. 17, 1954; Abramowitz & Stegun 11.4.6; the
//! transforms are Sonine's integral for Jacobi polynomials.
//!
//! Limits: plane disc; the dome and the bell are neglected, as is the air's mass in the frequencies.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Complex, DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};

use serde::{Deserialize, Serialize};

use super::radial::angular_norm;
use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::cache::Shared;
use crate::math::bessel::lanes::LANES;
use crate::math::quadrature::{self, GaussLegendre};
use crate::math::{bessel, jacobi};
use crate::radiation::Radiator;
use crate::radiation::rings::Rings;
use crate::receiver::{POINTS, ReceiverPosition};

/// What a mode does to the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Radiated {
    /// Pressure at each point over modal acceleration, `[re, im]` in Pa s2/m, for a member whose shape
    /// is largest toward the point.
    pub transfers: [[f64; 2]; POINTS],
    /// Radiation resistance of both faces, kg/s.
    pub resistance: f64,
    /// Mass of air moved along, kg.
    pub air_mass: f64,
}

/// Directions of a [`FarPattern`]. *Derived*: lobes are `2 pi` of `k a sin(theta)` wide, which is at most 100 below 21 kHz.
pub const DIRECTIONS: usize = 129;

/// What is heard of a mode from far away as at a metre, over the cosine of the inclination: pressure over modal acceleration,
/// Pa s2/m, at sines of the inclination from 0 to 1 in even steps, `[direction]`. In proportion to the cosine it is the same from behind, as a
/// dipole's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FarPattern(pub Vec<[f32; 2]>);

/// A disc, its modes' shapes on a grid, and points.
pub struct FreeDisc {
    radius: f64,
    points: [ReceiverPosition; POINTS],
    rule: Shared<GaussLegendre>,
}

/// Functions beyond those that a shape of the mode's fineness needs. *Converged*: more change nothing by 1 %.
const MARGIN: f64 = 6.0;

impl FreeDisc {
    /// For a disc of `radius` (m). `nodes` along the radius: three a wavelength of the finest shape.
    pub fn new(radius: f64, points: [ReceiverPosition; POINTS], nodes: usize) -> FreeDisc {
        FreeDisc { radius, points, rule: quadrature::shared_unit(nodes) }
    }

    /// Where along the radius shapes are wanted, shares of the radius.
    pub fn radii(&self) -> &[f64] {
        &self.rule.nodes
    }

    /// What a mode does to the air; `root` is its wave number times the radius, dimensionless.
    pub fn radiate(&self, mode: &Radiator, root: f64) -> Radiated {
        self.solve(mode, root).0
    }

    /// The same, and what is heard from far away in every direction: see [`FarPattern`]; `root` likewise, dimensionless.
    pub fn radiate_around(&self, mode: &Radiator, root: f64) -> (Radiated, FarPattern) {
        let (radiated, jump) = self.solve(mode, root);
        let pattern = self.pattern(mode, &jump);
        (radiated, pattern)
    }

    /// What a mode does to the air, and the coefficients of the jump per unit acceleration.
    fn solve(&self, mode: &Radiator, root: f64) -> (Radiated, DVector<Complex<f64>>) {
        let u = mode.omega * self.radius / SPEED_OF_SOUND;
        let m = mode.m as usize;
        let count = (0.5 * (root.max(u) - m as f64).max(0.0) + MARGIN) as usize;
        let basis = self.basis(m, count);
        let nodes = || self.rule.nodes.iter().zip(&self.rule.weights);
        let drive = DVector::from_iterator(
            count,
            basis.iter().map(|phi| {
                let terms = nodes().zip(mode.radial).zip(phi);
                Complex::from(terms.map(|(((r, w), shape), phi)| r * w * shape * phi).sum::<f64>())
            }),
        );
        let solved = impedance(m, count, u).lu().solve(&drive).unwrap_or_else(|| DVector::zeros(count));
        // Per unit acceleration into the face.
        let jump = solved * Complex::new(0.0, 2.0 * DENSITY * self.radius);
        let load: Complex<f64> = jump.iter().zip(drive.iter()).map(|(a, b)| a * b).sum();
        let load = load * angular_norm(mode.m) * self.radius * self.radius;
        let field: Vec<Complex<f64>> = (0..self.rule.nodes.len())
            .map(|r| jump.iter().zip(&basis).map(|(a, phi)| a * phi[r]).sum())
            .collect();
        let radiated = Radiated {
            transfers: self.points.map(|point| self.hear(&point, mode, &field)),
            resistance: (mode.omega * load.im).max(0.0),
            air_mass: -load.re,
        };
        (radiated, jump)
    }

    /// The far field of a jump: `i k / 2 i^m a^2 sum jump_i j_n(x) / x` at `x = k a sin(theta)`, times `cos(theta)`.
    fn pattern(&self, mode: &Radiator, jump: &DVector<Complex<f64>>) -> FarPattern {
        let (m, k) = (mode.m as usize, mode.omega / SPEED_OF_SOUND);
        let turn = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][m % 4];
        let unit = Complex::new(0.0, 0.5 * k * self.radius * self.radius) * Complex::new(turn.0, turn.1);
        let mut waves = vec![[0.0; LANES]; m + 2 * jump.len()];
        let mut pattern = Vec::with_capacity(DIRECTIONS);
        for first in (0..DIRECTIONS).step_by(LANES) {
            // On the axis itself the quotient has a limit, which it is next to.
            let sine = |lane: usize| ((first + lane) as f64 / (DIRECTIONS - 1) as f64).clamp(1e-4, 1.0);
            let x = std::array::from_fn(|lane| k * self.radius * sine(lane));
            bessel::lanes::spherical_orders(&x, &mut waves);
            for lane in 0..LANES.min(DIRECTIONS - first) {
                let orders = waves[m + 1..].iter().step_by(2);
                let sum: Complex<f64> = jump.iter().zip(orders).map(|(jump, wave)| jump * wave[lane]).sum();
                let heard = unit * sum / x[lane];
                pattern.push([heard.re as f32, heard.im as f32]);
            }
        }
        FarPattern(pattern)
    }

    /// The basis functions on the grid, `[function][r]`.
    fn basis(&self, m: usize, count: usize) -> Vec<Vec<f64>> {
        let mut out = vec![vec![0.0; self.rule.nodes.len()]; count];
        let mut polynomials = vec![0.0; count];
        for (at, &r) in self.rule.nodes.iter().enumerate() {
            let edge = r.powi(m as i32) * (1.0 - r * r).sqrt();
            jacobi::fill(m as f64, 0.5, 1.0 - 2.0 * r * r, &mut polynomials);
            // (i + 1/2)! over i! (1/2)!.
            let mut scale = 1.0;
            for ((i, row), polynomial) in out.iter_mut().enumerate().zip(&polynomials) {
                row[at] = edge * polynomial / scale;
                scale *= (i as f64 + 1.5) / (i as f64 + 1.0);
            }
        }
        out
    }

    /// Pressure at a point of a jump on the grid.
    fn hear(&self, point: &ReceiverPosition, mode: &Radiator, jump: &[Complex<f64>]) -> [f64; 2] {
        let k = mode.omega / SPEED_OF_SOUND;
        let [height, _] = point.height_and_offset();
        let rings = Rings::new(point, self.radius, mode.m, k, 0.0);
        let means = rings.steep_means(self.rule.nodes.iter().map(|r| r * self.radius));
        let mut sum = Complex::new(0.0, 0.0);
        let nodes = self.rule.nodes.iter().zip(&self.rule.weights).zip(jump);
        for (((&r, &weight), &jump), [[re, im], [steep_re, steep_im]]) in nodes.zip(means) {
            // (1 / d + i k) e^(i k (D - d)) / d^2
            let ring = Complex::new(steep_re - k * im, steep_im + k * re);
            sum += jump * ring * (TAU * weight * r * self.radius * self.radius * height);
        }
        let out = sum / (4.0 * PI);
        [out.re, out.im]
    }
}

/// `int phi_i phi_j k_z x dx` of order `m` at `u = omega a / c`, in units of the radius.
fn impedance(m: usize, count: usize, u: f64) -> DMatrix<Complex<f64>> {
    let highest = m + 2 * count;
    // What differs from zero frequency: below u, x = u sin(phi) ...
    let below = quadrature::shared_unit(u as usize + 12);
    let places = below.nodes.iter().zip(&below.weights).map(|(t, w)| {
        let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
        let weight = FRAC_PI_2 * u * w * cos / sin;
        SamplePoint { x: u * sin, weights: [weight * cos, weight * sin] }
    });
    // ... and above, x = sqrt(u^2 + s^2), until the difference has died away.
    let reach = 1.5 * (highest as f64).max(u) + 12.0;
    let above = quadrature::shared_unit((0.8 * reach) as usize + 8);
    let beyond = above.nodes.iter().zip(&above.weights).map(|(t, w)| {
        let s = reach * t;
        let x = u.hypot(s);
        SamplePoint { x, weights: [0.0, (x - s) * s / (x * x) * reach * w] }
    });
    let places: Vec<SamplePoint> = places.chain(beyond).collect();
    let mut waves = vec![[0.0; LANES]; highest + 1];
    let mut row = vec![0.0; count];
    let mut parts = [vec![0.0; count * count], vec![0.0; count * count]];
    for places in places.chunks(LANES) {
        // What is to spare repeats the last.
        bessel::lanes::spherical_orders(
            &std::array::from_fn(|lane| places[lane.min(places.len() - 1)].x),
            &mut waves,
        );
        for (lane, place) in places.iter().enumerate() {
            row.iter_mut().zip(waves[m + 1..].iter().step_by(2)).for_each(|(to, from)| *to = from[lane]);
            Arch::new().dispatch(Products { parts: &mut parts, weights: place.weights, values: &row });
        }
    }
    let [re, im] = parts;
    DMatrix::from_fn(count, count, |i, j| {
        let at = i.max(j) * count + i.min(j);
        let still = if i == j { -PI / (2.0 * (2.0 * (m + 2 * i + 1) as f64 + 1.0)) } else { 0.0 };
        Complex::new(re[at], im[at] + still)
    })
}

/// A node of the impedance's integrals: the wave number, and the weight's two parts.
struct SamplePoint {
    x: f64,
    weights: [f64; 2],
}

/// Adds the products of all values with all, weighted, to the lower triangles of matrices, row by row.
struct Products<'a> {
    parts: &'a mut [Vec<f64>; 2],
    weights: [f64; 2],
    values: &'a [f64],
}

impl WithSimd for Products<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let count = self.values.len();
        for (matrix, weight) in self.parts.iter_mut().zip(self.weights) {
            for i in 0..count {
                let share = weight * self.values[i];
                // Far above x, and of one of the parts, there is nothing.
                if share != 0.0 {
                    for (sum, other) in matrix[i * count..][..i + 1].iter_mut().zip(self.values) {
                        *sum += share * other;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: f64 = 0.2;
    const POINT: ReceiverPosition = ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.0 };

    fn rigid(u: f64) -> Radiated {
        let disc = FreeDisc::new(A, [POINT; POINTS], 48);
        let radial = vec![1.0; 48];
        disc.radiate(&Radiator { m: 0, radial: &radial, omega: u * SPEED_OF_SOUND / A }, 0.0)
    }

    #[test]
    fn a_rigid_disc_moves_8_3_rho_a_cubed_of_air_and_radiates_as_a_dipole() {
        let slow = rigid(0.05);
        assert!((slow.air_mass / (8.0 / 3.0 * DENSITY * A.powi(3)) - 1.0).abs() < 0.01, "{slow:?}");
        // Dipole: R = 16/(27 pi) rho c A (ka)^4 ... by the sphere of the same moment.
        let moment = 8.0 / 3.0 * DENSITY * A.powi(3);
        let k: f64 = 0.05 / A;
        let want = moment * moment * k.powi(4) * SPEED_OF_SOUND / (12.0 * PI * DENSITY);
        assert!((slow.resistance / want - 1.0).abs() < 0.02, "{} {want}", slow.resistance);
    }

    #[test]
    fn what_is_heard_far_away_all_around_is_what_is_lost() {
        use crate::plate::{PlateModes, PlateTables};
        let plate = PlateModes::new(&crate::reference::cap_crash(), 21_000.0).unwrap();
        let (orders, extent) = plate.table_extent(21_000.0);
        let tables = PlateTables::new(orders, extent);
        let nodes = 140;
        let (a, distance) = (plate.spec.radius(), 40.0);
        let rule = GaussLegendre::new(120, 0.0, FRAC_PI_2);
        let disc = |inclination| {
            FreeDisc::new(a, [ReceiverPosition { distance, inclination, azimuth: 0.0 }; POINTS], nodes)
        };
        let shapes = plate.radial_shapes(&tables, disc(0.0).radii());
        for (m, n) in [(0, 1), (1, 1), (4, 5), (0, 8), (10, 9), (5, 18)] {
            let i = plate.shells.iter().position(|s| (s.m, s.n) == (m, n)).unwrap();
            let shell = &plate.shells[i];
            let root = plate.flat_of(shell).iter().find(|f| f.n == n).unwrap().root;
            let mode = Radiator { m, radial: &shapes[i * nodes..][..nodes], omega: shell.omega };
            let square = |theta: f64| {
                let [re, im] = disc(theta).radiate(&mode, root).transfers[0];
                (re * re + im * im) * theta.sin()
            };
            let sides = 2.0 * angular_norm(m) * distance * distance;
            let power = sides * rule.integrate(square) / (2.0 * DENSITY * SPEED_OF_SOUND);
            let lost = 0.5 * disc(0.0).radiate(&mode, root).resistance / shell.omega.powi(2);
            assert!((power / lost - 1.0).abs() < 1e-3, "({m}, {n}): {power:e} heard, {lost:e} lost");
        }
    }

    #[test]
    fn the_pattern_is_what_is_heard_far_away() {
        use crate::plate::{PlateModes, PlateTables};
        let plate = PlateModes::new(&crate::reference::cap_crash(), 9_000.0).unwrap();
        let (orders, extent) = plate.table_extent(9_000.0);
        let tables = PlateTables::new(orders, extent);
        let (nodes, distance) = (120, 400.0);
        for (m, n) in [(0, 1), (1, 1), (4, 5), (10, 4), (0, 6)] {
            let i = plate.shells.iter().position(|s| (s.m, s.n) == (m, n)).unwrap();
            let root = plate.wave_number(&plate.shells[i]);
            for at in [0_usize, 20, 64, 101] {
                let inclination = (at as f64 / (DIRECTIONS - 1) as f64).asin();
                let point = ReceiverPosition { distance, inclination, azimuth: 0.0 };
                let disc = FreeDisc::new(plate.spec.radius(), [point; POINTS], nodes);
                let shapes = plate.radial_shapes(&tables, disc.radii());
                let radial = &shapes[i * nodes..][..nodes];
                let mode = Radiator { m, radial, omega: plate.shells[i].omega };
                let (radiated, FarPattern(pattern)) = disc.radiate_around(&mode, root);
                let largest = pattern.iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f32::max);
                for (heard, shown) in radiated.transfers[0].into_iter().zip(pattern[at]) {
                    let want = distance * heard;
                    let found = f64::from(shown) * inclination.cos();
                    let error = (found - want).abs() / f64::from(largest);
                    assert!(error < 0.01, "({m}, {n}) {at}: {found:e} {want:e}");
                }
            }
        }
    }

    #[test]
    fn a_fast_rigid_disc_radiates_a_plane_wave_from_both_faces() {
        let fast = rigid(30.0);
        let want = 2.0 * DENSITY * SPEED_OF_SOUND * PI * A * A;
        assert!((fast.resistance / want - 1.0).abs() < 0.03, "{} {want}", fast.resistance);
    }

    #[test]
    fn a_fast_rigid_disc_sounds_as_in_a_baffle_on_its_axis_and_a_slow_one_far_softer() {
        let point = ReceiverPosition { inclination: 0.0, ..POINT };
        let radial = vec![1.0; 64];
        let ratio = |u: f64| {
            let mode = Radiator { m: 0, radial: &radial, omega: u * SPEED_OF_SOUND / A };
            let [a, b] = FreeDisc::new(A, [point; POINTS], 64).radiate(&mode, 0.0).transfers[0];
            let [c, d] = crate::radiation::Rayleigh::new(A, point, 64).transfer(&mode);
            (Complex::new(a, b) / Complex::new(c, d)).to_polar()
        };
        let (size, phase) = ratio(40.0);
        assert!((size - 1.0).abs() < 0.2 && phase.abs() < 0.2, "{size} {phase}");
        let (size, _) = ratio(0.1);
        assert!(size < 0.3, "{size}");
    }

    #[test]
    fn a_mode_that_is_forced_below_its_frequency_sounds_by_the_rate_of_its_acceleration() {
        use crate::plate::{PlateModes, PlateTables};
        for (name, n) in [("crash", 1), ("crash", 2), ("splash", 1), ("splash", 2)] {
            let plate = PlateModes::new(&crate::reference::cymbal(name).plate(), 3_000.0).unwrap();
            let (orders, extent) = plate.table_extent(3_000.0);
            let tables = PlateTables::new(orders, extent);
            let nodes = 60;
            let point = |distance, inclination| ReceiverPosition { distance, inclination, azimuth: 0.0 };
            let disc = FreeDisc::new(
                plate.spec.radius(),
                [point(0.5, 1.1), point(1.4, 0.5), point(1.4, 0.5)],
                nodes,
            );
            let shapes = plate.radial_shapes(&tables, disc.radii());
            let at = plate.shells.iter().position(|shell| (shell.m, shell.n) == (0, n)).unwrap();
            let shell = &plate.shells[at];
            let radial = &shapes[at * nodes..][..nodes];
            let heard =
                |omega| disc.radiate(&Radiator { m: 0, radial, omega }, plate.wave_number(shell)).transfers;
            let own = heard(shell.omega);
            for share in [0.3, 0.5, 0.7] {
                for (own, forced) in own.into_iter().zip(heard(share * shell.omega)) {
                    let level = |[re, im]: [f64; 2]| 20.0 * re.hypot(im).log10();
                    // The imaginary part acts on the velocity alone, or on the acceleration's rate.
                    let [by_velocity, by_rate] =
                        [1.0 / share, share].map(|factor| level([own[0], own[1] * factor]) - level(forced));
                    // Shapes whose middle and rim cancel fall faster still.
                    assert!((0.0..0.7 * by_velocity).contains(&by_rate), "{by_rate} {by_velocity}");
                    assert!(share > 0.3 || by_velocity > 15.0, "{by_velocity}");
                }
            }
        }
    }
}
