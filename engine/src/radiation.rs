//! What is heard of a vibrating disc at a point: the Rayleigh integral, mode by mode.
//!
//! Model: the disc is flush in an infinite baffle; the pressure at a point is
//!
//! ```text
//! p = rho / (2 pi)  int  a(x) e^(-i k d) / d  dS
//! ```
//!
//! with `a` the acceleration toward the listener's side, `d` the distance, `k = omega / c`. Near and
//! far field are in it alike. The delay from the centre is taken out, `e^(i k D)`: whoever mixes
//! puts it back, exactly.
//!
//! Coordinates: radius of the disc 1 in `[r]`, `z` the disc's axis toward the listener, angles as
//! in [`Strike`](crate::strike::Strike).
//!
//! Limits: a baffle is right for a drum's struck side at short distance; a plate in free air
//! radiates less than this at low frequency.

pub(crate) mod rings;

use std::f64::consts::TAU;

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::cache::Shared;
use crate::math::quadrature::{self, GaussLegendre};
use crate::mode::Member;
use crate::receiver::ReceiverPosition;
use rings::Rings;

/// One pair of modes as it is heard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radiator<'a> {
    /// Nodal diameters.
    pub m: u32,
    /// Radial shape on the grid of [`Rayleigh::radii`], relative to the modal displacement.
    pub radial: &'a [f64],
    /// Angular frequency, rad/s.
    pub omega: f64,
}

/// Integrates modes of one disc to one point.
pub struct Rayleigh {
    radius: f64,
    point: ReceiverPosition,
    rule: Shared<GaussLegendre>,
}

impl Rayleigh {
    /// For a disc of `radius` (m). `nodes` along the radius: three a wavelength of the finest shape.
    pub fn new(radius: f64, point: ReceiverPosition, nodes: usize) -> Rayleigh {
        Rayleigh { radius, point, rule: quadrature::shared_unit(nodes) }
    }

    /// Where along the radius shapes are wanted, shares of the radius.
    pub fn radii(&self) -> &[f64] {
        &self.rule.nodes
    }

    /// Pressure over modal acceleration into the struck surface, `[re, im]` in Pa s2/m, for a mode
    /// whose shape is largest toward the point; see [`toward`](Self::toward) for others.
    pub fn transfer(&self, mode: &Radiator) -> [f64; 2] {
        let k = mode.omega / SPEED_OF_SOUND;
        let [height, offset] = self.point.height_and_offset();
        // Close by, places must resolve the ring right below the point.
        let close = 4.0 / (height / (2.0 * offset).max(1e-9)).asinh();
        let rings = Rings::new(&self.point, self.radius, mode.m, k, close.min(400.0));
        let means = rings.means(self.rule.nodes.iter().map(|r| r * self.radius));
        let (mut re, mut im) = (0.0, 0.0);
        let nodes = self.rule.nodes.iter().zip(&self.rule.weights).zip(mode.radial);
        for (((&r, &weight), &shape), [ring_re, ring_im]) in nodes.zip(means) {
            let area = TAU * weight * shape * r * self.radius * self.radius;
            re += area * ring_re;
            im += area * ring_im;
        }
        // Into the surface is away from the listener.
        let scale = -DENSITY / TAU;
        [scale * re, scale * im]
    }

    /// Share of [`transfer`](Self::transfer) for a member whose pair's axes lie at `axis` (rad).
    pub fn toward(&self, m: u32, member: Member, axis: f64) -> f64 {
        self.point.toward(m, member, axis)
    }
}

#[cfg(test)]
mod tests;
