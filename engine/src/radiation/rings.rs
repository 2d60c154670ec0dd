//! Waves from the rings of a disc to a point: the innermost sums of all that is heard, taken side by side.
//!
//! Model: a ring of radius `x` in the plane of the disc, `m` nodal diameters around it, a wave number `k`. With `d` the
//! distance of a place on it from the point, `D` that of the centre,
//!
//! ```text
//! S_p(x) = (1 / n) sum_i cos(m theta_i) d_i^-p e^(i k (D - d_i)),   theta_i = pi (i + 1/2) / n
//! ```
//!
//! is the mean around the ring. A drum takes millions of its terms, a kit tens of millions: their sines and cosines are
//! polynomials and lanes of eight go together, in whatever registers the machine has. No product is
//! fused with a sum and lanes are added in one order, so that every machine finds the same bits.

use std::f64::consts::PI;

use pulp::{Arch, Simd, WithSimd};

use crate::math::trigonometry::sin_cos;
use crate::receiver::ReceiverPosition;

/// Places that go side by side.
const LANES: usize = 8;

/// Some values side by side.
type Lanes = [f64; LANES];

/// Places around half a circle, as one order of modes wants them at one frequency.
pub(crate) struct Rings {
    /// Wave number, 1/m.
    k: f64,
    /// Distance of the point from the centre, m.
    distance: f64,
    /// Square of that distance, and twice the point's distance from the axis, m2 and m.
    square: f64,
    twice_offset: f64,
    /// `cos theta` and `cos(m theta)` over the number of places, which is 0 where a lane is to spare.
    around: Vec<[Lanes; 2]>,
}

impl Rings {
    /// For `m` nodal diameters and a wave number (1/m) on a disc of `radius` (m). As many places as waves ask for, and
    /// `close` more if that is more than the usual reserve.
    pub fn new(point: &ReceiverPosition, radius: f64, m: u32, k: f64, close: f64) -> Rings {
        let [height, offset] = point.height_and_offset();
        // Midpoints around half the circle: exact once they outnumber the waves around it.
        let waves = f64::from(m) + k * radius * point.inclination.sin();
        let count = 8 + (0.6 * waves) as usize + (3.0 * waves.cbrt()).max(close) as usize;
        let mut around = vec![[[0.0; LANES]; 2]; count.div_ceil(LANES)];
        let step = PI / count as f64;
        let places = turned(step).zip(turned(f64::from(m) * step)).take(count);
        for (place, (cos, cos_m)) in places.enumerate() {
            let [into, turn] = &mut around[place / LANES];
            (into[place % LANES], turn[place % LANES]) = (cos, cos_m / count as f64);
        }
        let square = height * height + offset * offset;
        Rings { k, distance: point.distance, square, twice_offset: 2.0 * offset, around }
    }

    /// `S_1` of rings of those radii (m), `[re, im]`, 1/m.
    pub fn means(&self, radii: impl Iterator<Item = f64>) -> impl Iterator<Item = [f64; 2]> {
        self.all::<1>(radii).into_iter().map(|[mean, _]| mean)
    }

    /// `S_2` and `S_3` of rings of those radii (m), `[re, im]`, 1/m2 and 1/m3.
    pub fn steep_means(&self, radii: impl Iterator<Item = f64>) -> Vec<[[f64; 2]; 2]> {
        self.all::<2>(radii)
    }

    fn all<const FIRST: usize>(&self, radii: impl Iterator<Item = f64>) -> Vec<[[f64; 2]; 2]> {
        let mut sums: Vec<_> = radii.map(|x| [[x; 2]; 2]).collect();
        Arch::new().dispatch(EachRing::<FIRST> { rings: self, sums: &mut sums });
        sums
    }

    /// Of one ring: `S_1` for `FIRST` of 1, `S_2` and `S_3` for 2.
    #[inline(always)]
    fn ring<const FIRST: usize>(&self, x: f64) -> [[f64; 2]; 2] {
        let (still, across) = (self.square + x * x, self.twice_offset * x);
        let mut sums = [[[0.0; LANES]; 2]; 2];
        for [cos, turn] in &self.around {
            for lane in 0..LANES {
                let d = (still - across * cos[lane]).sqrt();
                let (sin_kd, cos_kd) = sin_cos(self.k * (self.distance - d));
                let near = 1.0 / d;
                let size = if FIRST == 1 { turn[lane] * near } else { turn[lane] * near * near };
                sums[0][0][lane] += size * cos_kd;
                sums[0][1][lane] += size * sin_kd;
                if FIRST == 2 {
                    sums[1][0][lane] += size * near * cos_kd;
                    sums[1][1][lane] += size * near * sin_kd;
                }
            }
        }
        sums.map(|parts| parts.map(|lanes| lanes.iter().sum()))
    }
}

/// Cosines of an angle's half, one and a half, two and a half ..., each from the one before.
fn turned(angle: f64) -> impl Iterator<Item = f64> {
    let (turn_sin, turn_cos) = angle.sin_cos();
    let rotate = move |&(cos, sin): &(f64, f64)| {
        Some((cos * turn_cos - sin * turn_sin, sin * turn_cos + cos * turn_sin))
    };
    std::iter::successors(Some(((0.5 * angle).cos(), (0.5 * angle).sin())), rotate).map(|(cos, _)| cos)
}

/// The sums of many rings, whose radii stand in their places.
struct EachRing<'a, const FIRST: usize> {
    rings: &'a Rings,
    sums: &'a mut [[[f64; 2]; 2]],
}

impl<const FIRST: usize> WithSimd for EachRing<'_, FIRST> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        // A plain loop: what an iterator calls would be compiled for the baseline.
        for sums in self.sums {
            *sums = self.rings.ring::<FIRST>(sums[0][0]);
        }
    }
}
