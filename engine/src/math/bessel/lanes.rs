//! All orders of a Bessel function, cylindrical or spherical, at several arguments, side by side.
//!
//! Miller's descending recurrence as in the [parent](super), `k` from where the functions are nothing at the largest of
//! the arguments. A recurrence waits for itself at every order; eight of them in the lanes of one register, or of a few,
//! wait together. No product is fused with a sum, so that every machine finds the same bits.

use pulp::{Arch, Simd, WithSimd};

/// Values above this are scaled down during Miller's recurrence, long before they overflow.
pub(super) const MILLER_LARGE: f64 = 1e200;

/// Arguments that go side by side.
pub(crate) const LANES: usize = 8;

/// One value for each argument.
pub(crate) type Lanes = [f64; LANES];

/// Orders from one look at the size of values to the next: none grows by more than `2 k / x` an order, and what
/// [`MILLER_LARGE`] leaves to the largest number is a hundred decades.
const LOOK: usize = 4;

/// Fills `out` with `J_0(x)`, `J_1(x)`, ... for every argument, all above 0.01.
pub(super) fn j_orders(x: &Lanes, out: &mut [Lanes]) {
    // From max(m, x) on, J falls by at least exp(-(2/3) sqrt(2) d^1.5 / sqrt(m)) over d orders.
    let top = x.iter().fold(out.len() as f64, |top, &x| top.max(x));
    let start = (top + 20.0 + (60.0 * top).sqrt()) as usize;
    Arch::new().dispatch(Descent::<J> { x, start, out });
}

/// Fills `out` with `e^-x I_0(x)`, `e^-x I_1(x)`, ... for every argument, all above 0.01.
pub(super) fn i_scaled_orders(x: &Lanes, out: &mut [Lanes]) {
    // I_k falls as exp(-k^2 / 2x) at first and as (x / 2k)^k later.
    let (top, largest) = (out.len() as f64, x.iter().copied().fold(0.0, f64::max));
    let start = 20 + (top * top + 90.0 * largest).sqrt() as usize;
    Arch::new().dispatch(Descent::<I> { x, start, out });
}

/// Fills `out` with the spherical `j_0(x)`, `j_1(x)`, ... for every argument, all above 1e-9.
pub(crate) fn spherical_orders(x: &Lanes, out: &mut [Lanes]) {
    // Above x the functions fall off; so far above, they are nothing.
    let largest = x.iter().copied().fold(0.0, f64::max);
    let start = (largest + 12.0 * largest.cbrt() + 26.0) as usize;
    out.fill([0.0; LANES]);
    Arch::new().dispatch(Descent::<SPHERICAL> { x, start, out });
}

/// Whose recurrence it is.
const J: u8 = 0;
const I: u8 = 1;
const SPHERICAL: u8 = 2;

/// From order `start` down to 0.
struct Descent<'a, const KIND: u8> {
    x: &'a Lanes,
    start: usize,
    out: &'a mut [Lanes],
}

impl<const KIND: u8> WithSimd for Descent<'_, KIND> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Descent { x, start, out } = self;
        let twice: Lanes = std::array::from_fn(|lane| 2.0 / x[lane]);
        let (mut above, mut value, mut sum) = ([0.0; LANES], [1e-30; LANES], [0.0; LANES]);
        for k in (1..=start).rev() {
            if k < out.len() {
                out[k] = value;
            }
            let counts = KIND == I || k % 2 == 0;
            let order = if KIND == SPHERICAL { k as f64 + 0.5 } else { k as f64 };
            for lane in 0..LANES {
                // `value` is the function of order k up to a common factor.
                let now = value[lane];
                let below = order * twice[lane] * now;
                value[lane] = if KIND == I { below + above[lane] } else { below - above[lane] };
                above[lane] = now;
                sum[lane] += if counts { now } else { 0.0 };
            }
            if k % LOOK == 0 && value.iter().any(|value| value.abs() > MILLER_LARGE) {
                let factor =
                    value.map(|value| if value.abs() > MILLER_LARGE { 1.0 / MILLER_LARGE } else { 1.0 });
                let stored = out.iter_mut().skip(k);
                for row in stored.chain([&mut above, &mut value, &mut sum]) {
                    row.iter_mut().zip(&factor).for_each(|(value, factor)| *value *= factor);
                }
            }
        }
        if let Some(first) = out.first_mut() {
            *first = value;
        }
        let scale: Lanes = std::array::from_fn(|lane| {
            if KIND == SPHERICAL {
                // Of order 0, sin(x) / x, and order -1, cos(x) / x, one is never small.
                let (x, order_minus_1) = (x[lane], 0.5 * twice[lane] * value[lane] - above[lane]);
                let (sin, cos) = x.sin_cos();
                if sin.abs() > cos.abs() { sin / x / value[lane] } else { cos / x / order_minus_1 }
            } else {
                // J_0 + 2 sum J_2k = 1, I_0 + 2 sum I_k = e^x.
                1.0 / (value[lane] + 2.0 * sum[lane])
            }
        });
        for row in out {
            for lane in 0..LANES {
                row[lane] *= scale[lane];
            }
        }
    }
}
