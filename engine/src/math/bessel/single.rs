//! One order of a Bessel function at one argument, and its derivative.

use super::lanes::MILLER_LARGE;

/// Bessel function of the first kind `J_m(x)`.
pub fn j(m: u32, x: f64) -> f64 {
    match m {
        0 => libm::j0(x),
        1 => libm::j1(x),
        _ => j_pair(m, x).0,
    }
}

/// Derivative `J_m'(x)`.
pub fn j_prime(m: u32, x: f64) -> f64 {
    j_pair(m, x).1
}

/// `J_m(x)` and `J_m'(x)` at the cost of one.
pub fn j_pair(m: u32, x: f64) -> (f64, f64) {
    if m == 0 {
        return (libm::j0(x), -libm::j1(x));
    }
    if x == 0.0 {
        return (0.0, if m == 1 { 0.5 } else { 0.0 });
    }
    let (below, value) = if x < f64::from(m) {
        // Upward recurrence would amplify the second solution here.
        (libm::jn(m as i32 - 1, x), libm::jn(m as i32, x))
    } else {
        (1..m).fold((libm::j0(x), libm::j1(x)), |(below, value), k| {
            (value, f64::from(2 * k) / x * value - below)
        })
    };
    (value, below - f64::from(m) / x * value)
}

/// Scaled modified Bessel function `e^-x I_m(x)`.
pub fn i_scaled(m: u32, x: f64) -> f64 {
    i_scaled_pair(m, x).0
}

/// Scaled derivative `e^-x I_m'(x)` (the derivative scaled, not the derivative of the scaled).
pub fn i_prime_scaled(m: u32, x: f64) -> f64 {
    i_scaled_pair(m, x).1
}

/// `e^-x I_m(x)` and `e^-x I_m'(x)` at the cost of one.
pub fn i_scaled_pair(m: u32, x: f64) -> (f64, f64) {
    let mut kept = [0.0; 2];
    i_miller(m as usize, x, &mut kept);
    let [value, above] = kept;
    let slope = if x == 0.0 { if m == 1 { 0.5 } else { 0.0 } } else { above + f64::from(m) / x * value };
    (value, slope)
}

/// Fills `out` with `e^-x I_m(x)` for `m = first, first + 1, ...`.
fn i_miller(first: usize, x: f64, out: &mut [f64]) {
    out.fill(0.0);
    if x == 0.0 {
        if let (0, Some(value)) = (first, out.first_mut()) {
            *value = 1.0;
        }
        return;
    }
    // I_k falls as exp(-k^2 / 2x) at first and as (x / 2k)^k later.
    let top = (first + out.len()) as f64;
    let start = 20 + (top * top + 90.0 * x).sqrt() as usize;
    let (mut above, mut value) = (0.0, 1e-30);
    let mut norm = 0.0;
    for k in (0..=start).rev() {
        if (first..first + out.len()).contains(&k) {
            out[k - first] = value;
        }
        norm += if k == 0 { value } else { 2.0 * value };
        if k == 0 {
            break;
        }
        let below = 2.0 * k as f64 / x * value + above;
        (above, value) = (value, below);
        if value > MILLER_LARGE {
            for scaled in [&mut above, &mut value, &mut norm] {
                *scaled /= MILLER_LARGE;
            }
            for stored in out.iter_mut() {
                *stored /= MILLER_LARGE;
            }
        }
    }
    for stored in out {
        *stored /= norm;
    }
}

/// Logarithmic derivative `x I_m'(x) / I_m(x)`; `m` at `x = 0`.
///
/// By the continued fraction of `I_{m+1} / I_m`, run upward from where the bound of Amos (1974)
/// is close enough to start from.
pub fn i_log_derivative(m: u32, x: f64) -> f64 {
    let order = f64::from(m);
    let steps = 8 + ((order * order + 36.0 * x).sqrt() - order) as u32;
    let above = f64::from(m + steps + 1);
    let mut ratio = x / (above + (above * above + x * x).sqrt());
    for k in (m + 1..=m + steps).rev() {
        ratio = x / (f64::from(2 * k) + x * ratio);
    }
    order + x * ratio
}
