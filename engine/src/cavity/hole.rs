//! Holes of a drum, each with the plug of air that moves in it: a port in the other head, a vent in the shell.
//!
//! Model: the air of a hole of the radius `b` and the length `l` is a mass `rho l / (pi b^2)` per volume squared. Both ends of a vent add
//! to its length what moves at a flanged end, `8 b / (3 pi)` (Rayleigh). A port in a thin head is `pi b / 2` long.
//!
//! Losses, as qualities whose reciprocals add:
//!
//! ```text
//! jet        see PORT_Q; an energy that goes with the amplitude, as a linear loss
//! viscosity  b / delta ... delta = sqrt(2 nu / omega), in a vent
//! ```
//!
//! *Derived*: the plug of a wide tube has the impedance `i omega rho l / S (1 + (1 - i) delta / b)` (Kirchhoff 1868). At the ends, where air
//! passes over the wall around the hole, as much is lost as in `2 b` of tube (Ingard 1953), next to the `1.7 b` that they are long: taken
//! as that. Heat is lost where air is compressed, and a plug is not.
//!
//! *Judgement*: the jet of a vent takes as much as that of a port. Driven by heads, its air moves by `X = (V' / V) (c / omega)^2 / l`, `V'` what the
//! heads displace, whatever its radius: after a hard stroke on a 14 in snare 30 mm at 200 Hz, a quality of .5, after a soft one 2; and over
//! the 40 dB of a decay that the heads hold up, five times that: 2.5 and 10.
//!
//! Neglected: the share `delta / b` by which viscosity adds to the mass (3 % of half an inch, a fifth of the smallest hole at 100 Hz).

use std::f64::consts::PI;

use crate::air_load::DENSITY;

/// A hole of a drum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hole {
    /// Its radius, m.
    pub radius: f64,
    /// What it is in.
    pub through: Through,
}

/// What a hole is in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Through {
    /// The far head: a port.
    Head,
    /// The wall of a cylinder, half way along.
    Wall {
        /// Thickness, m.
        thickness: f64,
    },
    /// The bottom of a kettle.
    Bottom {
        /// Thickness, m.
        thickness: f64,
    },
}

/// The air of a hole against the modes without nodal diameters of the enclosed air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoleAir {
    /// The hole.
    pub hole: Hole,
    /// Mass of its air, kg, where its displacement is the volume that leaves over the head's area.
    pub mass: f64,
}

/// Quality factor of a port's air: it leaves as a jet, and the jet's energy is lost. *Derived*: air that moves by `X` in a sharp hole of
/// the effective length `l = pi b / 2` has `q = 3 pi l / (4 K X)`, with `K` 2.4 (*literature*: Idelchik, Handbook of Hydraulic Resistance,
/// ch. 4), so that it falls as `1 / (1 + w t / (2 q))`: a hard stroke on a kick (`q` 0.75) to a 26th in 0.3 s, a soft one (1.5) to a 14th. A
/// linear loss that does the same has a quality of `w t / (2 ln(1 + w t / (2 q)))`, 5.8 and 7.2 at 20 Hz.
pub const PORT_Q: f64 = 6.0;

/// Kinematic viscosity of air, m2/s.
const VISCOSITY: f64 = 1.5e-5;

/// Length of air that moves beyond a flanged end, over the radius (Rayleigh, Theory of Sound, sec. 312).
const FLANGED_END: f64 = 8.0 / (3.0 * PI);

impl Hole {
    /// The hole before a head of that area, m2.
    pub(super) fn air(self, area: f64) -> HoleAir {
        let mass = match self.through {
            Through::Head => 0.5 * DENSITY * area * area / self.radius,
            Through::Wall { thickness } | Through::Bottom { thickness } => {
                let length = thickness + 2.0 * FLANGED_END * self.radius;
                DENSITY * length * area * area / (PI * self.radius * self.radius)
            }
        };
        HoleAir { hole: self, mass }
    }

    /// Pressure at the hole of a mode that does not vary across the drum, over the pressure at the batter; `half_waves` along it.
    pub(super) fn pressure(self, half_waves: u32) -> f64 {
        match (self.through, half_waves % 4) {
            (Through::Wall { .. }, 1 | 3) => 0.0,
            (Through::Wall { .. }, 2) | (Through::Head | Through::Bottom { .. }, 1 | 3) => -1.0,
            _ => 1.0,
        }
    }

    /// Quality factor of its air at an angular frequency, rad/s.
    pub fn quality(self, omega: f64) -> f64 {
        match self.through {
            Through::Head => PORT_Q,
            Through::Wall { .. } | Through::Bottom { .. } => {
                let layer = (2.0 * VISCOSITY / omega).sqrt();
                1.0 / (1.0 / PORT_Q + layer / self.radius)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vent_without_a_wall_is_as_heavy_as_a_port() {
        // Two flanged ends against Rayleigh's hole in a thin wall: 16 / (3 pi^2) of a density over a radius against a half.
        let of = |through| Hole { radius: 0.01, through }.air(0.1).mass;
        let ratio = of(Through::Wall { thickness: 0.0 }) / of(Through::Head);
        assert!((ratio - 32.0 / (3.0 * PI * PI)).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn narrow_holes_lose_by_viscosity_and_wide_ones_by_their_jet() {
        // A tube's exact impedance, from its series of Bessel functions, where the wide tube is a good approximation.
        let (radius, omega) = (6.35e-3, std::f64::consts::TAU * 100.0);
        let hole = Hole { radius, through: Through::Wall { thickness: 6e-3 } };
        let viscous = 1.0 / (1.0 / hole.quality(omega) - 1.0 / PORT_Q);
        assert!((viscous / tube_quality(radius, omega) - 1.0).abs() < 0.06, "{viscous}");
        let narrow = Hole { radius: 1e-3, ..hole };
        assert!(narrow.quality(omega) < 0.6 * hole.quality(omega));
        assert_eq!(Hole { radius, through: Through::Head }.quality(omega), PORT_Q);
    }

    /// Quality of the air in a long tube: `rho d u / dt = -p' + mu (u'' + u' / r)` in rings.
    fn tube_quality(radius: f64, omega: f64) -> f64 {
        use nalgebra::Complex;
        const RINGS: usize = 4000;
        let step = radius / RINGS as f64;
        // i omega u - nu (r u')' / r = 1, u = 0 at the wall: a tridiagonal system, swept once each way.
        let diffusion = VISCOSITY / (step * step);
        let (mut upper, mut right) =
            (vec![Complex::new(0.0, 0.0); RINGS], vec![Complex::new(0.0, 0.0); RINGS]);
        for i in 0..RINGS {
            let r = i as f64 + 0.5;
            let (inner, outer) = (diffusion * i as f64 / r, diffusion * (i + 1) as f64 / r);
            // The wall is half a ring away.
            let outer = if i + 1 == RINGS { 2.0 * outer } else { outer };
            let (before, known) = if i == 0 {
                (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0))
            } else {
                (upper[i - 1], right[i - 1])
            };
            let pivot = Complex::new(inner + outer, omega) - before * inner;
            upper[i] = Complex::new(outer, 0.0) / pivot;
            right[i] = (known * inner + 1.0) / pivot;
        }
        let (mut next, mut flow) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
        for i in (0..RINGS).rev() {
            next = right[i] + if i + 1 == RINGS { Complex::new(0.0, 0.0) } else { upper[i] * next };
            flow += next * (2.0 * (i as f64 + 0.5) / (RINGS * RINGS) as f64);
        }
        let impedance = Complex::new(1.0, 0.0) / flow;
        impedance.im / impedance.re
    }
}
