//! The pressures of one order, and what they act on.

use crate::hi_hat::rigid::Weights;
use crate::modal::field::ModalField;
use crate::modal::{ModalBody, Pressure, ReceiverWeights};
use crate::surface::body::add;

use super::waves::{members, turn};

/// Both cymbals count downward: the gap closes as the upper one moves.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// How speeds and a pressure exchange energy.
#[derive(Debug, Clone, Copy, Default)]
struct Exchange {
    /// Root of the sum of `A^2 / M`, m2 over the root of kg.
    strength: f64,
    /// Sine and cosine of a sample's turn.
    turn: (f64, f64),
}

/// What the pressures of one order act on.
pub struct Order {
    m: usize,
    /// The shells' modes.
    pub shells: [ModalField; 2],
    /// The rigid motions of cosine and sine, and their area, m2.
    pub rigid: Option<([usize; 2], f64)>,
    /// Pressure heard of an impulse over the area in a sample, through the shells' own sound, Pa m2/(N s).
    direct: [Pressure; 2],
    /// Of cosine and sine.
    exchanges: [Exchange; 2],
    /// Sine and cosine of the turn by which pressure and what goes around inside exchange energy in a sample, and what is left of the latter.
    inside: (f64, f64),
    kept: f64,
    /// Root of the compliance (m3/Pa).
    pub spring: f64,
    /// Root of the inertance inside (kg/m4).
    pub mass: f64,
}

impl Order {
    /// Pressures with `m` nodal diameters over such modes and a disc of an area (m2).
    pub fn new(m: usize, shells: [ModalField; 2], disc: f64) -> Order {
        Order {
            m,
            shells,
            // A tilt is `2 r cos(theta)`.
            rigid: match m {
                0 => Some(([0, 0], disc)),
                1 => Some(([1, 2], disc / 2.0)),
                _ => None,
            },
            direct: [Pressure::default(); 2],
            exchanges: [Exchange::default(); 2],
            inside: (0.0, 1.0),
            kept: 1.0,
            spring: 1.0,
            mass: 1.0,
        }
    }

    /// Follows a change of both shells' modes, or of how they are heard; masses of the cymbals in kg, a sample lasting `dt` s.
    pub fn follow(&mut self, shells: [(&ModalBody, &ReceiverWeights); 2], masses: &[f64; 2], dt: f64) {
        let rigid = self.rigid.map_or(0.0, |(_, area)| area * area);
        let mut squares = [masses.iter().map(|mass| rigid / mass).sum::<f64>(); 2];
        self.direct = [Pressure::default(); 2];
        for (which, (shell, receiver)) in shells.into_iter().enumerate() {
            let field = &mut self.shells[which];
            shell.connect_field(field);
            let sign = (SIGNS[which] / dt) as f32;
            for (part, heard) in receiver.direct_along(field).into_iter().enumerate() {
                squares[part] += field.mobility()[part];
                add(&mut self.direct[part], heard.map(|heard| sign * heard));
            }
        }
        for (exchange, square) in self.exchanges.iter_mut().zip(squares) {
            exchange.strength = square.sqrt();
        }
        self.turn(dt);
    }

    /// Takes compliance (m3/Pa), inertance inside (kg/m4) and friction over it (1/s), a sample lasting `dt` s.
    pub fn become_like(&mut self, compliance: f64, [inertance, slowed]: [f64; 2], dt: f64) {
        (self.spring, self.mass) = (compliance.sqrt(), inertance.sqrt());
        self.kept = 1.0 - (slowed * dt).min(1.0);
        self.turn(dt);
    }

    fn turn(&mut self, dt: f64) {
        for exchange in &mut self.exchanges {
            exchange.turn = turn(exchange.strength * dt / self.spring);
        }
        self.inside = turn(dt / (self.spring * self.mass));
    }

    /// Exchanges energy between the pressures and both cymbals, whose speeds as rigid bodies (m/s) and masses (kg) are given. Pressures are in the root of J.
    /// Returns what is heard of it, Pa.
    pub fn press(
        &self,
        pressed: &mut [f64],
        [top, bottom]: [&mut ModalBody; 2],
        speeds: &mut [Weights; 2],
        masses: &[f64; 2],
    ) -> Pressure {
        let (above, below) = (top.speeds_along(&self.shells[0]), bottom.speeds_along(&self.shells[1]));
        let mut closing = [above[0] - below[0], above[1] - below[1]];
        if let Some((parts, area)) = self.rigid {
            for (closing, part) in closing.iter_mut().zip(parts) {
                *closing += area * (speeds[0][part] - speeds[1][part]);
            }
        }
        // The impulse on a mode, over its area.
        let mut push = [0.0; 2];
        let mut heard = Pressure::default();
        for (part, pressed) in pressed.iter_mut().take(members(self.m)).enumerate() {
            let Exchange { strength, turn: (sin, cos) } = self.exchanges[part];
            if strength == 0.0 {
                continue;
            }
            let speed = closing[part] / strength;
            push[part] = ((cos - 1.0) * speed - sin * *pressed) / strength;
            *pressed = sin * speed + cos * *pressed;
            add(&mut heard, self.direct[part].map(|direct| push[part] as f32 * direct));
        }
        top.impart(&self.shells[0], push);
        bottom.impart(&self.shells[1], push.map(|push| -push));
        if let Some((parts, area)) = self.rigid {
            for (push, part) in push.into_iter().zip(parts).take(members(self.m)) {
                speeds[0][part] += push * area / masses[0];
                speeds[1][part] -= push * area / masses[1];
            }
        }
        heard
    }

    /// Exchanges energy between a pressure and what it drives around inside, each in the root of J.
    #[inline(always)]
    pub fn go_around(&self, pressed: &mut f64, inner: &mut f64) {
        let (sin, cos) = self.inside;
        (*pressed, *inner) = (cos * *pressed - sin * *inner, self.kept * (sin * *pressed + cos * *inner));
    }
}
