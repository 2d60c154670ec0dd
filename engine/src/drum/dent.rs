//! The dent of a tip: what it stretches the film about it more than the rest of the head.
//!
//! Model: [Berger's tension](super::stretch) is the mean over a head. About a tip that presses, the film is steeper and so tenser. Of the
//! part of the displacement that is alike in all directions about the tip, Foeppl's equations (thin film, held at the rim, its motion
//! in its own plane without inertia) add to Berger's tension, exactly,
//!
//! ```text
//! N(r) = E h / 4 int (1 / max(r, s)^2 - 1 / a^2) w'(s)^2 s ds,
//! U = pi E h / 8 int int (1 / max(r, s)^2 - 1 / a^2) w'(r)^2 w'(s)^2 r s dr ds
//! ```
//!
//! On a circle of radius `b` about the tip a wave of wavenumber `k` has the mean `J_0(k b)` of what it has at the tip. Between two circles,
//! of radii `b` and `c`, the slope of a dent goes as `w' = -A / r`; the difference of the means is `A ln(c / b)`. With `A` of some rings the
//! energy is a polynomial, never negative, and its gradient exact. A mode that is made of several waves counts as one of their mean
//! `k^2`, weighted by its shares.
//!
//! Rings reach from a fiftieth of the radius to 0.7 of it; those that would reach over the rim are left out. What lies within them is
//! carried by waves above the computed modes ([film bands](crate::surface::film_band)), what lies beyond is left to Berger's mean.
//!
//! The dent stays where a tip came last, also while the head rings on. When the next tip comes elsewhere, the energy of the old one goes back
//! to the modes, and that of the new one is taken from them.
//!
//! Limits: what is not alike in all directions about the tip is left to Berger's mean; of two tips at once only the later one has a dent;
//! the film does not yield about it.
//!
//! Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, ch. 13 (large deflections); the kernel is derived here.

use std::f64::consts::PI;

use crate::math::bessel::JTable;
use crate::membrane::MembraneSpec;
use crate::modal::simd::Kernels;
use crate::modal::{Row, zero_row};

/// Rings about a tip.
const RINGS: usize = 6;

/// Radii of the circles between which they lie, shares of the head's.
const CIRCLES: [f64; RINGS + 1] = [1.0 / 48.0, 1.0 / 24.0, 1.0 / 12.0, 1.0 / 6.0, 1.0 / 3.0, 0.5, 0.7];

/// The dent of the tip that came last.
pub(super) struct Dent {
    kernels: Kernels,
    /// Of the head, m.
    radius: f64,
    /// Mean over a circle of a wave that is one at its centre, by wavenumber times radius.
    means: JTable,
    /// `pi E h / 8` times the kernel's integral over two rings, N/m3.
    stiffness: [[f64; RINGS]; RINGS],
    /// `A` of each ring, m, by a displacement of a mode that is 1 m at the tip: `[ring]`, `[mode]`.
    slopes: [Row; RINGS],
    /// The same by 1 m of the mode itself, about the tip.
    rings: [Row; RINGS],
    /// How many rings lie on the head; none before the first tip has come.
    present: usize,
}

impl Dent {
    /// Of a head without tips and so many modes, whose wavenumbers are still to be set; none is above `finest`, 1/m. Allocates.
    pub(super) fn new(spec: &MembraneSpec, modes: usize, finest: f64) -> Dent {
        let factor = PI * spec.material.youngs_modulus * spec.thickness / 8.0;
        Dent {
            kernels: Kernels::detect(),
            radius: spec.radius,
            means: JTable::new(0, finest * spec.radius * CIRCLES[RINGS]),
            stiffness: kernel(spec.radius).map(|row| row.map(|it| factor * it)),
            slopes: std::array::from_fn(|_| zero_row(modes)),
            rings: std::array::from_fn(|_| zero_row(modes)),
            present: 0,
        }
    }

    /// Sets the wavenumber of a mode, 1/m, of which the next tip knows.
    ///
    /// # Real-time
    /// Some look-ups.
    pub(super) fn set_wave(&mut self, mode: usize, wave: f64) {
        let means = CIRCLES.map(|circle| self.means.value(wave * self.radius * circle));
        for (ring, slopes) in self.slopes.iter_mut().enumerate() {
            slopes[mode] = ((means[ring] - means[ring + 1]) / width(ring)) as f32;
        }
    }

    /// A tip comes, so far from the centre (share of the radius); it meets the modes with these shapes, `[mode]`.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn press(&mut self, radius: f64, shapes: &[f32]) {
        self.present = CIRCLES[1..].iter().take_while(|&&circle| radius + circle < 1.0 + 1e-9).count();
        for (ring, slopes) in self.rings.iter_mut().zip(&self.slopes).take(self.present) {
            let modes = ring.iter_mut().zip(slopes.iter().zip(shapes));
            modes.for_each(|(ring, (slope, shape))| *ring = slope * shape);
        }
    }

    /// Energy, J, at displacements (m, `[mode]`).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn energy(&self, displacement: &[f32]) -> f64 {
        self.bent(displacement).into_iter().map(|[bent, slope]| 0.25 * slope * bent).sum()
    }

    /// Energy, J, at displacements (m, `[mode]`); adds its gradient (N).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn evaluate(&self, displacement: &[f32], gradient: &mut [f32]) -> f64 {
        let bent = self.bent(displacement);
        for (ring, [_, slope]) in self.rings[..self.present].iter().zip(bent) {
            self.kernels.axpy(gradient, ring, slope as f32);
        }
        bent.into_iter().map(|[bent, slope]| 0.25 * slope * bent).sum()
    }

    /// `A` of each ring, m, and the energy's derivative by it, N; it is of fourth degree.
    fn bent(&self, displacement: &[f32]) -> [[f64; 2]; RINGS] {
        let mut bent = [0.0; RINGS];
        for (bent, ring) in bent.iter_mut().zip(&self.rings[..self.present]) {
            *bent = f64::from(self.kernels.dot(ring, displacement));
        }
        std::array::from_fn(|i| {
            let tension: f64 = self.stiffness[i].iter().zip(bent).map(|(k, a)| k * a * a).sum();
            [bent[i], 4.0 * tension * bent[i]]
        })
    }
}

/// The logarithm of the ratio of a ring's radii.
fn width(ring: usize) -> f64 {
    (CIRCLES[ring + 1] / CIRCLES[ring]).ln()
}

/// The kernel's integral over pairs of rings of a head of some radius (m), with `w' = 1 / r` in them, 1/m2.
fn kernel(radius: f64) -> [[f64; RINGS]; RINGS] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let (inner, outer) = (i.min(j), i.max(j));
            let [b, c] = [outer, outer + 1].map(|circle| (CIRCLES[circle] * radius).powi(-2));
            // `int 1 / r^3 dr` over the outer ring, times what lies within.
            let nearest = if i == j { 0.5 * (b - c) - width(i) * c } else { 0.5 * (b - c) * width(inner) };
            nearest - width(i) * width(j) / (radius * radius)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Material;
    use crate::damping::LossLaw;
    use crate::math::bessel;

    const HEAD: MembraneSpec = MembraneSpec {
        radius: 0.28,
        thickness: 0.36e-3,
        plies: 2,
        material: Material::FILM,
        loss: LossLaw::NONE,
        edge: None,
        dot: None,
        mesh: None,
    };

    /// The head with modes of these wavenumbers times the radius.
    fn dented(waves: &[f64]) -> Dent {
        let mut dent = Dent::new(&HEAD, waves.len(), waves[waves.len() - 1] / HEAD.radius);
        waves.iter().enumerate().for_each(|(mode, wave)| dent.set_wave(mode, wave / HEAD.radius));
        dent
    }

    /// Foeppl's energy less Berger's, J, of what lies within the rings of waves about the centre, each of so much displacement (m) there,
    /// by quadrature.
    fn energy_by_quadrature(waves: &[f64], displacements: &[f32]) -> f64 {
        const STEPS: usize = 20_000;
        let step = CIRCLES[RINGS] * HEAD.radius / STEPS as f64;
        let (mut within, mut sum) = (0.0, 0.0);
        for i in 0..STEPS {
            let r = (i as f64 + 0.5) * step;
            let slope: f64 = waves
                .iter()
                .zip(displacements)
                .map(|(wave, &q)| -f64::from(q) * wave / HEAD.radius * libm::j1(wave * r / HEAD.radius))
                .sum();
            let part = slope * slope * r * step;
            // Pairs of radii within `r`, twice, and the pair of one.
            sum += part * (2.0 * within + part) * (r.powi(-2) - HEAD.radius.powi(-2));
            within += part;
        }
        PI * HEAD.material.youngs_modulus * HEAD.thickness / 8.0 * sum
    }

    #[test]
    fn the_energy_is_that_of_foeppls_equations_beyond_bergers() {
        let waves: Vec<f64> = bessel::zeros(0, 18);
        let mut dent = dented(&waves);
        dent.press(0.0, &vec![1.0; waves.len()]);
        // Under a point: every wave in proportion to the square of its shape there over its stiffness.
        let point = |&wave: &f64| (4e-3 / (wave * libm::j1(wave)).powi(2)) as f32;
        let pressed: Vec<f32> = waves.iter().map(point).collect();
        // The low modes by themselves, as the head rings on.
        let low = |k: usize| move |(i, _): (usize, &f64)| if i == k { 2e-3_f32 } else { 0.0 };
        let low: Vec<Vec<f32>> = (0..3).map(|k| waves.iter().enumerate().map(low(k)).collect()).collect();
        for displacements in [&pressed].into_iter().chain(&low) {
            let (ours, exact) = (dent.energy(displacements), energy_by_quadrature(&waves, displacements));
            assert!((ours / exact - 1.0).abs() < 0.1, "{ours} J, by quadrature {exact} J");
        }
    }

    #[test]
    fn a_tip_near_the_rim_has_the_rings_that_lie_on_the_head() {
        let waves: Vec<f64> = bessel::zeros(0, 18);
        let shapes = vec![1.0; waves.len()];
        let displacements = vec![1e-4; waves.len()];
        let mut dent = dented(&waves);
        assert_eq!(dent.energy(&displacements), 0.0);
        let mut before = f64::INFINITY;
        for (radius, rings) in [(0.0, 6), (0.3, 6), (0.4, 5), (0.85, 2), (0.97, 0)] {
            dent.press(radius, &shapes);
            let energy = dent.energy(&displacements);
            assert_eq!(dent.present, rings, "{radius}");
            assert!(energy <= before && (energy > 0.0) == (rings > 0), "{radius}: {energy}");
            before = energy;
        }
    }
}
