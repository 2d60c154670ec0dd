//! The pressures in the gap: orders, cosines and sines, and how what they press out is heard.

use std::f64::consts::PI;

use crate::air_load::DENSITY;
use crate::hi_hat::outlet::{HEARD, ORDERS};
use crate::hi_hat::rim_points::{self, POINTS};
use crate::mode::Member;
use crate::radiation::rings::Rings;
use crate::receiver::{POINTS as RECEIVER_POINTS, Receivers};

/// Pressures: a cosine and a sine of each order, but the first has no sine; and one that stays zero, to fill vectors.
pub const WAVES: usize = 2 * ORDERS;

/// Pressures whose flow is heard.
pub const SOURCES: usize = 2 * HEARD - 1;

/// Parts of the rims that are outlets by themselves, each of some of the [places](POINTS).
pub const SECTORS: usize = POINTS / 2;

/// The order and the member of a pressure.
pub fn wave(index: usize) -> (usize, Member) {
    let is_sine = index > 0 && index.is_multiple_of(2);
    (index.div_ceil(2).min(ORDERS - 1), if is_sine { Member::Sine } else { Member::Cosine })
}

/// The index of a pressure: the cosine (0) or the sine (1) of an order.
pub fn index_of(order: usize, part: usize) -> usize {
    if order == 0 { 0 } else { 2 * order - 1 + part }
}

/// Cosine and sine, or the cosine alone.
pub fn members(order: usize) -> usize {
    if order == 0 { 1 } else { 2 }
}

/// Cosines and sines of all orders at the middle of a sector, dimensionless.
pub fn around(sector: usize) -> [f64; WAVES] {
    let each = POINTS / SECTORS;
    let angles = (0..each).map(|i| rim_points::angle(each * sector + i));
    let middle = angles.sum::<f64>() / each as f64;
    std::array::from_fn(|index| {
        let (order, member) = wave(index);
        let (sin, cos) = (order as f64 * middle).sin_cos();
        match member {
            _ if index == WAVES - 1 => 0.0,
            Member::Cosine => cos,
            Member::Sine => sin,
        }
    })
}

/// Pressure at each receiver over the acceleration of a flow around a ring (radius in m), at `k a = u`, Pa s2/m3, `[re, im]`.
pub fn heard(radius: f64, receivers: &Receivers, index: usize, u: f64) -> [[f64; 2]; RECEIVER_POINTS] {
    let (order, member) = wave(index);
    // The flow's amplitude is twice its moment over the ring.
    let amplitude = if order == 0 { 1.0 } else { 2.0 };
    let mut heard = [[0.0; 2]; RECEIVER_POINTS];
    let points = receivers.points().into_iter().zip(receivers.scales());
    for (heard, (point, scale)) in heard.iter_mut().zip(points) {
        let share = DENSITY / (4.0 * PI) * amplitude * scale * point.toward(order as u32, member, 0.0);
        let rings = Rings::new(&point, radius, order as u32, u / radius, 0.0);
        if let Some(mean) = rings.means(std::iter::once(radius)).next() {
            *heard = mean.map(|x| share * x);
        }
    }
    heard
}

/// Sum of products; its unit is the product of both.
#[inline(always)]
pub fn dot<const N: usize>(one: &[f64; N], other: &[f64; N]) -> f64 {
    const LANES: usize = 4;
    let mut sums = [0.0; LANES];
    for (one, other) in one.chunks_exact(LANES).zip(other.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += one[lane] * other[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Sine and cosine of a turn of about `angle` (rad): that whose half has the tangent `angle / 2`.
#[inline(always)]
pub fn turn(angle: f64) -> (f64, f64) {
    // A turn that changes no sum, and whose square would be a denormal number.
    let half = if angle.abs() < 1e-100 { 0.0 } else { 0.5 * angle };
    let over = (1.0 + half * half).recip();
    (2.0 * half * over, (1.0 - half * half) * over)
}
