//! Loss laws: how fast a mode of a material decays by itself, and what is laid on it to muffle it.
//!
//! Decay rates `sigma` are of the amplitude, 1/s: T60 = 6.9078 / sigma.
//!
//! A bent plate is warm where it is pressed and cold where it is drawn, and heat that flows between
//! its faces is lost to the motion ([`Thermoelastic`]); it goes as one over the thickness squared, which is why a
//! splash dies sooner than a ride. What else a metal loses has no theory and is a [`LossLaw`].
//!
//! Sources: Zener, Phys. Rev. 53, 1938; Norris & Photiadis, Q. J. Mech. Appl. Math. 58, 2005 (plates).

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::fitted;
use crate::numbers::{Numbers, Visitor};
use crate::plate::PlateSpec;

/// Losses inside a material, `sigma = constant + per_khz * f / 1 kHz`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LossLaw {
    /// Decay rate at low frequency, 1/s, 0 to 1000.
    #[serde(rename = "constant_1_s")]
    pub constant: f64,
    /// Growth of the decay rate with frequency, 1/s per kHz, 0 to 200.
    #[serde(rename = "per_khz_1_s")]
    pub per_khz: f64,
}

impl Numbers for LossLaw {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("constant_1_s", &mut self.constant, 0.0..=1000.0);
        visitor.number("per_khz_1_s", &mut self.per_khz, 0.0..=200.0);
    }
}

impl LossLaw {
    /// Single-ply 0.19 mm polyester film. *Literature*.
    pub const SINGLE_PLY: LossLaw = LossLaw { constant: 1.2, per_khz: 2.0 };
    /// Cast bronze, beside heat and internal friction. *Fitted*: recorded crashes, rides and splashes
    /// lose 60 dB in 5.0, 8.4, 4.0 s at 500 Hz and in 3.2, 2.8, 1.9 s at 8 kHz; this and the friction, with the heat and the
    /// radiation, both computed, come nearest.
    pub const BRONZE: LossLaw = LossLaw { constant: fitted::BRONZE_LOSS, per_khz: 0.0 };
    /// Nothing is lost.
    pub const NONE: LossLaw = LossLaw { constant: 0.0, per_khz: 0.0 };

    /// Decay rate of a mode at `omega` rad/s, 1/s.
    pub fn sigma(&self, omega: f64) -> f64 {
        self.constant + self.per_khz * omega / (std::f64::consts::TAU * 1000.0)
    }
}

/// What carries a head at its rim: collar, bearing edge, hoop and shell, which yield to the head's pull.
///
/// Model: per length of the rim a spring `k` beside a dashpot `R`, both between the head and a drum that stands
/// still. A mode pulls with `T dw/dn`, the edge yields at the velocity `Y T dw/dn`,
///
/// ```text
/// Re Y = f^2 / (f^2 + f_c^2) / R,   f_c = k / (2 pi R)
/// ```
///
/// and the power lost is `T^2 Re Y int (dw/dn)^2 ds`. For every mode of a round clamped head the integral is
/// `2 k^2 A / a` (Rellich's identity), so all modes lose at the rate `sigma = T Re Y / a` where tension rules and the air
/// weighs what it does: nothing at low frequency, the same for all high ones.
///
/// Modes of the orders 0 and 1 also pull on the drum as a whole, by a force and by a moment; those of higher orders do not. What its body
/// and mount take from these is a decay rate of its own.
///
/// Limits: the edge is alike all around; it does not detune the modes (by `T / (k a)`, a quarter of a percent). What the mount takes is the same at all
/// frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgeSpec {
    /// `R`, N s/m2, 10 to 1e6.
    #[serde(rename = "resistance_n_s_m2")]
    pub resistance: f64,
    /// `f_c`, where the dashpot takes over from the spring, Hz, 10 to 20,000.
    pub corner_hz: f64,
    /// Decay rate by the drum's body and mount, of modes of the orders 0 and 1, 1/s, 0 to 1000.
    #[serde(default, rename = "mount_1_s")]
    pub mount: f64,
}

impl Numbers for EdgeSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("resistance_n_s_m2", &mut self.resistance, 10.0..=1e6);
        visitor.number("corner_hz", &mut self.corner_hz, 10.0..=20_000.0);
        visitor.number("mount_1_s", &mut self.mount, 0.0..=1000.0);
    }
}

impl EdgeSpec {
    /// `Re Y` at `omega` rad/s, m2/(N s).
    pub fn mobility(&self, omega: f64) -> f64 {
        let ratio = (TAU * self.corner_hz / omega).powi(2);
        1.0 / (self.resistance * (1.0 + ratio))
    }

    /// Decay rate by the drum's body and mount of a mode of order `m`, 1/s.
    pub fn mount_sigma(&self, m: u32) -> f64 {
        if m <= 1 { self.mount } else { 0.0 }
    }
}

/// How a metal expands and conducts heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heat {
    /// Linear expansion, dimensionless for each kelvin (1/K).
    pub expansion: f64,
    /// Heat capacity by volume, J/(m3 K).
    pub by_volume: f64,
    /// Thermal conductivity, W/(m K).
    pub conductivity: f64,
}

/// Loss by heat flowing through a bent plate, `sigma = delta / 2 * omega^2 tau / (1 + omega^2 tau^2)`.
///
/// Above some 30 Hz, where cymbals begin to sound, it is the same for every mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermoelastic {
    /// Relative difference of the stiffness with and without time for the heat to flow.
    pub delta: f64,
    /// Time for the heat to flow, s.
    pub tau: f64,
}

impl Thermoelastic {
    /// Of the air around, K.
    const TEMPERATURE: f64 = 293.0;

    /// Of a plate of a metal; short waves, bent one way.
    pub fn new(plate: &PlateSpec, heat: &Heat) -> Thermoelastic {
        let nu = plate.poisson_ratio;
        let bent_one_way = (1.0 + nu) / (1.0 - nu);
        let delta =
            plate.youngs_modulus * heat.expansion.powi(2) * Self::TEMPERATURE / heat.by_volume * bent_one_way;
        let diffusivity = heat.conductivity / heat.by_volume;
        Thermoelastic { delta, tau: (plate.thickness() / std::f64::consts::PI).powi(2) / diffusivity }
    }

    /// Decay rate of a mode at `omega` rad/s, 1/s.
    pub fn sigma(&self, omega: f64) -> f64 {
        let turn = omega * self.tau;
        0.5 * self.delta * omega * turn / (1.0 + turn * turn)
    }
}

/// Something soft laid on a surface, that takes energy where it lies.
///
/// All act live, by their amount. A dashpot at a place damps a mode in proportion to its shape squared there; a pillow that
/// touches both heads damps all modes alike, and those more whose air has to get past it: when both heads
/// move the same way, what is between them goes to and fro through the pillow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Muffler {
    /// A pillow against both heads: filling so deep that a wave that enters it does not come back, above the frequency at
    /// which it is a quarter wave deep. Below, it only follows the head as a spring:
    /// `sigma(f) = sigma f^2 / (f^2 + f_c^2)`.
    Pillow {
        /// Decay rate added to modes far above the corner at full amount, 1/s, 0 to 1000.
        #[serde(rename = "sigma_1_s")]
        sigma: f64,
        /// Corner `f_c`, Hz, 0 to 2000.
        corner_hz: f64,
        /// Decay rate added at full amount to a motion of nothing but the air along the drum, 1/s, 0 to 10,000.
        #[serde(rename = "flow_1_s")]
        flow: f64,
    },
    /// A piece of gel or tape at a place.
    Gel {
        /// Decay rate added to a mode of unit squared shape there at full amount, 1/s, 0 to 1000.
        #[serde(rename = "sigma_1_s")]
        sigma: f64,
        /// Distance from the centre, share of the radius, 0 to 0.99.
        #[serde(rename = "at")]
        radius: f64,
        /// Direction, rad, -2 pi to 2 pi.
        #[serde(rename = "angle_rad")]
        angle: f64,
    },
    /// A ring of film or foam along the rim.
    Ring {
        /// Decay rate added to a mode of unit mean square under it at full amount, 1/s, 0 to 1000.
        #[serde(rename = "sigma_1_s")]
        sigma: f64,
        /// Where it begins, share of the radius, 0 to 0.99; it ends at the rim.
        inner: f64,
    },
}

impl Numbers for Muffler {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        match self {
            Muffler::Pillow { sigma, corner_hz, flow } => {
                visitor.number("sigma_1_s", sigma, 0.0..=1000.0);
                visitor.number("corner_hz", corner_hz, 0.0..=2000.0);
                visitor.number("flow_1_s", flow, 0.0..=10_000.0);
            }
            Muffler::Gel { sigma, radius, angle } => {
                visitor.number("sigma_1_s", sigma, 0.0..=1000.0);
                visitor.number("at", radius, 0.0..=0.99);
                visitor.number("angle_rad", angle, -TAU..=TAU);
            }
            Muffler::Ring { sigma, inner } => {
                visitor.number("sigma_1_s", sigma, 0.0..=1000.0);
                visitor.number("inner", inner, 0.0..=0.99);
            }
        }
    }
}

impl Muffler {
    /// A gel pad as drummers place it, near the rim. *By ear*.
    pub const GEL: Muffler = Muffler::Gel { sigma: fitted::GEL_SIGMA, radius: 0.8, angle: 2.3 };
    /// A ring as they are sold, an inch and a half wide on a 14 in head. *By ear*.
    pub const RING: Muffler = Muffler::Ring { sigma: fitted::RING_SIGMA, inner: 0.79 };
}

/// Amplitude decay rate of a given time to fall by 60 dB, and the reverse: `sigma * t60 = ln 1000`.
pub const SIGMA_T60: f64 = 6.907_755_278_982_137;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;

    /// B20.
    const BRONZE: Heat = Heat { expansion: 17.5e-6, by_volume: 8600.0 * 380.0, conductivity: 52.0 };

    #[test]
    fn heat_takes_three_times_as_much_from_brass_as_from_bronze() {
        let brass = Heat { expansion: 20.2e-6, by_volume: 8500.0 * 377.0, conductivity: 120.0 };
        let plate = reference::cymbal("crash").plate();
        let sigma = |heat| Thermoelastic::new(&plate, &heat).sigma(1000.0 * TAU);
        let ratio = sigma(brass) / sigma(BRONZE);
        // Far above the flow's own time it goes as stiffness times expansion squared times conductivity.
        let expected =
            (20.2_f64 / 17.5).powi(2) * (8600.0_f64 * 380.0 / (8500.0 * 377.0)).powi(2) * (120.0 / 52.0);
        assert!((ratio / expected - 1.0).abs() < 0.02 && ratio > 3.0, "{ratio} for {expected}");
    }

    #[test]
    fn heat_takes_more_from_a_thin_cymbal_than_from_a_thick_one() {
        let plate = |name| reference::cymbal(name).plate();
        let at_1_khz = |name| Thermoelastic::new(&plate(name), &BRONZE).sigma(1000.0 * std::f64::consts::TAU);
        let [crash, ride, splash] = ["crash", "ride", "splash"].map(at_1_khz);
        assert!((crash - 0.48).abs() < 0.05 && (ride - 0.30).abs() < 0.03, "{crash} {ride}");
        // As one over the thickness squared.
        let ratio = (plate("crash").thickness() / plate("splash").thickness()).powi(2);
        assert!((splash / crash / ratio - 1.0).abs() < 0.01, "{splash}");
    }

    #[test]
    fn heat_takes_most_where_it_has_half_a_period_to_flow() {
        let heat = Thermoelastic::new(&reference::cymbal("crash").plate(), &BRONZE);
        let share = |omega: f64| heat.sigma(omega) / omega;
        let most = share(1.0 / heat.tau);
        assert!((most - 0.25 * heat.delta).abs() < 1e-12);
        assert!(share(0.5 / heat.tau) < most && share(2.0 / heat.tau) < most);
    }
}
