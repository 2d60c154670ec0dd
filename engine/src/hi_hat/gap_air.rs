//! The air between the two cymbals of a hi-hat.
//!
//! ```text
//! upper shell, heave, tilts --(volume)--> springs C_m --> sectors of the outlet L, R --> ring of sound
//! lower shell, heave, tilts --(volume)-->     |
//!                                             +--> around inside
//! ```
//!
//! Model: rims all but close a lens of a litre of air. Its pressure, a sum of `p_m (r / a)^m cos(m theta)` and the sines, presses the two
//! cymbals apart and drives flows around inside and out between the rims:
//!
//! ```text
//! C_m p_m' = sum_k A_mk v_k - I_m - sum_s cos(m theta_s) U_s      M v_k' = ... - sum_m A_mk p_m
//! L_m I_m' = p_m                                                   L_s U_s' = sum_m cos(m theta_s) p_m - R_s U_s
//! ```
//!
//! with `A_mk` the integral of a mode's shape times that of a pressure and `v_k` the modes' speeds, positive as the gap closes. Even pressure and the
//! outlet are Helmholtz's resonator, at 300 to 600 Hz. Each sector is as wide as the gap is there: rims that are not flat make
//! flow of every order from each pressure, so that modes of all these orders sound through the gap.
//!
//! What leaves the gap does not go around the rim of a free disc, as the sound of either cymbal by itself has it: the
//! difference, `sum_s cos(m theta_s) U_s - sum_k A_mk v_k`, is a source of its own, a ring as wide as the rims, of the first orders.
//!
//! Each sample the exchanges of energy, between speeds and pressures, pressures and what goes around inside, and pressures and each sector's flow, are rotations:
//! energy is kept exactly but for the losses, whatever the gap does. Motion that [is not heard](super::rigid_sound::RigidHeard) moves the
//! flow along with it. Cymbals that are too far apart to meet do not feel the air, which changes third octaves of open ones by about 1 dB.
//!
//! Neglected: pressure with nodal circles (the lens has them from 1.2 kHz on: no modes above are coupled); that the lens is not as high all around;
//! the dipole's share of what the inner faces do not radiate, and what the outer ones lose as monopoles.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 9 (lumped elements).

mod order;
mod sectors;
mod waves;

use std::f64::consts::PI;

use crate::modal::field::ModalField;
use crate::modal::simd::Kernels;
use crate::modal::{ModalBody, Pressure, ReceiverWeights};
use crate::plate::PlateSpec;
use crate::receiver::Receivers;
use crate::surface::body::add;

use super::lobed_sound::{LobedSound, TO_FAST};
use super::outlet::{GapPosition, Lens, ORDERS, Outlet, Outlets};
use super::rigid::{Rigid, Weights};
use super::rim_points::POINTS;

use order::Order;
use sectors::Sectors;
use waves::{SOURCES, WAVES, dot, index_of, members, wave};

pub use sectors::EVERY;

/// Modes up to this are coupled with it, Hz.
pub const COUPLED_HZ: f64 = 1200.0;

/// Energy below which nobody hears it beside the cymbals, J. *Judgement*: some 40 dB below what a stroke of 0.5 m/s leaves in it.
const FAINT: f64 = 1e-10;

/// A mode with as many nodal diameters as a pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Which.
    pub mode: usize,
    /// Nodal diameters, of which there are pressures with 0 to 5.
    pub m: usize,
    /// Integral of its shape times `(r / a)^m cos(m theta)`, and times the sine, m2.
    pub areas: [f64; 2],
}

/// The air in the gap.
pub struct GapAir {
    orders: [Order; ORDERS],
    outlets: Outlets,
    sectors: Sectors,
    /// `p sqrt(C)`, and `I sqrt(L)` of what goes around inside: the squares are twice the energies.
    pressed: [f64; WAVES],
    inner: [f64; WAVES],
    /// Sources in the sample before, m3/s, and how they are heard.
    sources: [f64; SOURCES],
    sound: LobedSound<SOURCES>,
    /// What was added to the rigid speeds of both in the sample before, m/s.
    pushed: [Weights; 2],
    /// kg.
    masses: [f64; 2],
    lossless: bool,
    kernels: Kernels,
    dt: f64,
}

impl GapAir {
    /// The air between two cymbals, whose edges are rounded by a radius `edge` (m), a sample lasting `dt` (s). Allocates.
    pub fn new(
        plates: [&PlateSpec; 2],
        volumes: &[Vec<Volume>; 2],
        edge: f64,
        lossless: bool,
        receivers: &Receivers,
        dt: f64,
    ) -> GapAir {
        let radius = plates[0].radius();
        let height = |r: f64| plates.iter().map(|plate| plate.height(r)).sum::<f64>();
        let orders = std::array::from_fn(|m| {
            let shells = volumes.each_ref().map(|volumes| {
                let of = volumes.iter().filter(|volume| volume.m == m);
                ModalField::new(of.map(|volume| (volume.mode, volume.areas)))
            });
            Order::new(m, shells, PI * radius * radius)
        });
        let heard = |index, u| waves::heard(radius, receivers, index, u);
        let mut air = GapAir {
            orders,
            outlets: Outlets::new(&Lens { radius, height: &height, edge }),
            sectors: Sectors::new(radius, lossless, dt),
            pressed: [0.0; WAVES],
            inner: [0.0; WAVES],
            sources: [0.0; SOURCES],
            sound: LobedSound::new(radius, dt, &TO_FAST, heard),
            pushed: [[0.0; 3]; 2],
            masses: plates.map(|plate| plate.mass),
            lossless,
            kernels: Kernels::detect(),
            dt,
        };
        air.follow_gaps(&[1.0; POINTS], true);
        air
    }

    /// Follows a change of the modes of the upper and the lower shell, or of how they are heard.
    ///
    /// # Real-time
    /// Linear in the number of modes that it acts on.
    pub fn follow(&mut self, shells: [(&ModalBody, &ReceiverWeights); 2]) {
        for order in &mut self.orders {
            order.follow(shells, &self.masses, self.dt);
        }
    }

    /// Follows the gaps at the places around the rims, m, where what is negative is closed: over the next [`EVERY`] samples, or at once.
    ///
    /// # Real-time
    /// Some microseconds.
    pub fn follow_gaps(&mut self, gaps: &[f64; POINTS], at_once: bool) {
        let mean = gaps.iter().map(|gap| gap.max(0.0)).sum::<f64>() / POINTS as f64;
        let Outlet { compliance, inside, slowed, inertance, .. } = self.outlets.at(GapPosition::of(mean));
        for (m, order) in self.orders.iter_mut().enumerate() {
            let slowed = if self.lossless { 0.0 } else { slowed[m] };
            order.become_like(compliance[m], [inside[m], slowed], self.dt);
        }
        self.sectors.follow_springs(self.orders.iter().map(|order| order.spring));
        let omega = (inertance * compliance[0]).sqrt().recip();
        let before = self.sectors.leaving();
        self.sectors.follow_gaps(gaps, &self.outlets, omega, at_once);
        // What flows through another gap at once is not heard as a step.
        let after = self.sectors.leaving();
        for (source, (after, before)) in self.sources.iter_mut().zip(after.iter().zip(&before)) {
            *source += after - before;
        }
    }

    /// Exchanges energy with both shells and rigid bodies. Returns the pressure at each receiver by it, Pa.
    pub fn step(&mut self, [top, bottom]: [&mut ModalBody; 2], rigid: &mut [Rigid; 2]) -> Pressure {
        let pressures = self.pressed;
        let mut heard = Pressure::default();
        let before = rigid.each_ref().map(Rigid::speeds);
        let mut speeds = before;
        for (m, order) in self.orders.iter().enumerate() {
            let pressed = &mut self.pressed[index_of(m, 0)..];
            add(&mut heard, order.press(pressed, [&mut *top, &mut *bottom], &mut speeds, &self.masses));
        }
        for (which, rigid) in rigid.iter_mut().enumerate() {
            rigid.set_speed(speeds[which]);
            self.pushed[which] = std::array::from_fn(|part| speeds[which][part] - before[which][part]);
        }
        add(&mut heard, self.flow_on(&pressures));
        heard
    }

    /// Rings by itself, while the cymbals are too far apart to feel it. Returns the pressure at each receiver, Pa.
    pub fn ring_out(&mut self) -> Pressure {
        self.pushed = [[0.0; 3]; 2];
        if self.is_over() {
            return self.sound.ring_out();
        }
        let heard = self.flow_on(&{ self.pressed });
        if self.energy() < FAINT {
            self.stop();
        }
        heard
    }

    /// Whether nothing moves.
    pub fn is_over(&self) -> bool {
        self.energy() == 0.0
    }

    /// All that happens in the air in a sample, at the beginning of which the pressures were `before`. Returns what is heard of it, Pa.
    fn flow_on(&mut self, before: &[f64; WAVES]) -> Pressure {
        let inner = self.inner;
        let kernels = self.kernels;
        kernels.vectorized(
            #[inline(always)]
            || {
                for index in 1..WAVES - 1 {
                    let order = &self.orders[wave(index).0];
                    order.go_around(&mut self.pressed[index], &mut self.inner[index]);
                }
                self.sectors.leave(&mut self.pressed);
            },
        );
        let mut rates = [0.0; SOURCES];
        for (index, rate) in rates.iter_mut().enumerate() {
            let order = &self.orders[wave(index).0];
            // What leaves less what the faces displace is what expands less what goes around inside.
            let around = 0.5 * (inner[index] + self.inner[index]) / order.mass;
            let source = -order.spring * (self.pressed[index] - before[index]) / self.dt - around;
            *rate = (source - self.sources[index]) / self.dt;
            self.sources[index] = source;
        }
        self.sound.hear(&rates)
    }

    /// What it added to the speeds of heaves and tilts in the sample before, m/s.
    pub fn pushed(&self) -> &[Weights; 2] {
        &self.pushed
    }

    /// Lets the flow follow a change of the rigid speeds (m/s) that is not heard. Returns the energy that it gains, J.
    pub fn carry(&mut self, gained: &[Weights; 2]) -> f64 {
        if *gained == [[0.0; 3]; 2] {
            return 0.0;
        }
        let before = self.energy();
        for (m, order) in self.orders.iter().enumerate() {
            let Some((parts, area)) = order.rigid else { continue };
            for (part, &motion) in parts.iter().take(members(m)).enumerate() {
                self.sectors.gain(index_of(m, part), area * (gained[0][motion] - gained[1][motion]));
            }
        }
        self.energy() - before
    }

    /// Its energy, J.
    pub fn energy(&self) -> f64 {
        let inside = dot(&self.pressed, &self.pressed) + dot(&self.inner, &self.inner);
        0.5 * inside + self.sectors.energy()
    }

    /// Stops at once. What is under way to the receivers is still heard.
    pub fn stop(&mut self) {
        (self.pressed, self.inner) = ([0.0; WAVES], [0.0; WAVES]);
        self.sectors.reset();
        self.sources = [0.0; SOURCES];
        self.pushed = [[0.0; 3]; 2];
    }

    /// As if nothing had moved.
    pub fn reset(&mut self) {
        self.stop();
        self.sound.reset();
    }
}

#[cfg(test)]
mod tests;
