//! Mesh: a head that lets air through.
//!
//! Model: the air on the faces follows the weave as far as the flow between its threads lets it. Per area the flow has the impedance
//! `Z = R + i omega u`, with `u = rho l / o` the inertia of the air between the threads, `o` the open share of the area and `l` half as long again
//! as the weave is thick. With `X = i omega M` that of the air that a mode moves on both faces,
//!
//! ```text
//! air velocity / weave velocity = Z / (Z + X)      impedance felt = Z X / (Z + X)
//! ```
//!
//! A tight film is `Z` without end. Woven heads are far on the other side: they weigh next to no air, lose `R / (2 s)` to the flow (`s` the mass
//! of the weave per area) and sound 15 dB softer in the highs and 40 in the lows.
//!
//! Neglected: what the radiation resistance, small against all of these, does to the flow; its turbulence, which makes `R` grow with the
//! velocity on hard strokes; and that threads themselves sound.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 6 (thin porous screens).

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::air_load::DENSITY;
use crate::numbers::{Numbers, Visitor};

/// How air passes a woven head.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSpec {
    /// Pressure over the velocity of air through it, Pa s/m, 0.5 to 1000.
    #[serde(rename = "flow_resistance_pa_s_m")]
    pub flow_resistance: f64,
    /// Share of its area that threads leave open, 0.05 to 0.9.
    pub open: f64,
}

impl Numbers for MeshSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("flow_resistance_pa_s_m", &mut self.flow_resistance, 0.5..=1000.0);
        visitor.number("open", &mut self.open, 0.05..=0.9);
    }
}

/// Length of the air that moves between threads over the thickness of the weave. *Judgement*: it bends around them on both sides.
const PASSAGE: f64 = 1.5;

/// How the air follows a mode of a head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// Share of the air's mass that the mode feels, 0 to 1.
    pub mass: f64,
    /// Resistance that the mode feels, per area, Pa s/m.
    pub resistance: f64,
    /// Velocity of the air over that of the head, 0 to 1.
    pub velocity: f64,
    /// By how much the air is late, rad.
    pub lag: f64,
}

impl Slip {
    /// Of a tight film.
    pub const NONE: Slip = Slip { mass: 1.0, resistance: 0.0, velocity: 1.0, lag: 0.0 };

    /// Of a weave so thick (m), under air of that mass per area (kg/m2), at an angular frequency.
    pub fn new(mesh: &MeshSpec, thickness: f64, air: f64, omega: f64) -> Slip {
        let inertia = DENSITY * PASSAGE * thickness / mesh.open;
        let through = Complex::new(mesh.flow_resistance, omega * inertia);
        let outside = Complex::new(0.0, omega * air);
        let follows = through / (through + outside);
        let felt = follows * outside;
        Slip {
            mass: felt.im / outside.im,
            resistance: felt.re,
            velocity: follows.norm(),
            lag: -follows.arg(),
        }
    }
}
