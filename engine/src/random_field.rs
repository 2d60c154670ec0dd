//! Random fields over a disc: how what should be even is not.
//!
//! Model: a sum of the shapes `chi = J_l(kappa r) cos/sin(l theta)` whose slope is zero at the rim, with normally distributed
//! strengths that fall with the wavenumber `kappa` as `exp(-(kappa l)^2 / 4)` (in amplitude), `l` the correlation length.
//! Fields are drawn from a seed, and the same in every build.

use std::f64::consts::TAU;

use crate::math::bessel;
use crate::split::hash;

/// Components weaker than this, over the strongest possible one, are left out.
const WEAKEST: f64 = 0.02;

/// One shape of the field, `J_l(kappa r) (cos part cos(l theta) + sin part sin(l theta))`, `r` a share of the radius.
#[derive(Debug, Clone, Copy)]
pub struct Component {
    /// Periods around.
    pub l: u32,
    /// Wavenumber times the radius.
    pub kappa: f64,
    /// Strength of the cosine and of the sine part.
    pub parts: [f64; 2],
}

/// Cosine and sine part of a dimensionless field along the radius, `[cosine, sine][radius]`.
pub type Along = [Vec<f64>; 2];

/// A field and others of the same shapes at some radii (shares of the disc's), by the number of periods around: each shape counts by the
/// factor that `factors` gives for it. Allocates.
pub fn harmonics<const N: usize>(
    components: &[Component],
    radii: &[f64],
    factors: impl Fn(&Component) -> [f64; N],
) -> Vec<[Along; N]> {
    let most = components.iter().map(|component| component.l).max().unwrap_or(0);
    let empty = || std::array::from_fn(|_| [vec![0.0; radii.len()], vec![0.0; radii.len()]]);
    let mut harmonics: Vec<[Along; N]> = (0..=most).map(|_| empty()).collect();
    for component in components {
        let strengths = factors(component).map(|factor| component.parts.map(|part| factor * part));
        for (i, &r) in radii.iter().enumerate() {
            let shape = bessel::j(component.l, component.kappa * r);
            let fields = harmonics[component.l as usize].iter_mut().zip(&strengths);
            for (out, strength) in fields.flat_map(|(field, parts)| field.iter_mut().zip(parts)) {
                out[i] += strength * shape;
            }
        }
    }
    harmonics
}

/// Draws the components of a field of that root mean square (dimensionless) and correlation length (share of the radius).
/// `body` tells bodies of one seed apart.
pub fn components(rms: f64, correlation: f64, seed: u32, body: u32) -> Vec<Component> {
    let fall = |kappa: f64| (-0.25 * (kappa * correlation).powi(2)).exp();
    let highest = 2.0 * (-WEAKEST.ln()).sqrt() / correlation;
    let mut components = Vec::new();
    let mut square = 0.0;
    for l in 0.. {
        let zeros = bessel::zeros_prime(l, 2 + (highest / 2.8) as u32);
        let Some(first) = zeros.first().filter(|&&first| first <= highest || l == 0) else { break };
        debug_assert!(*first > 0.0);
        for (s, kappa) in zeros.into_iter().filter(|&kappa| kappa <= highest).enumerate() {
            // Mean square of J_l(kappa r) over the disc.
            let mean = (1.0 - (f64::from(l) / kappa).powi(2)) * bessel::j(l, kappa).powi(2);
            let around = if l == 0 { 1.0 } else { 0.5 };
            let draw = normal(seed, l, s as u32, body);
            let parts = draw.map(|draw| draw * fall(kappa) / (mean * around).sqrt());
            let parts = if l == 0 { [parts[0], 0.0] } else { parts };
            square += parts.map(|part| part * part * mean * around).iter().sum::<f64>();
            components.push(Component { l, kappa, parts });
        }
    }
    // The rms is of this body, not of all that could be drawn.
    let scale = if square > 0.0 { rms / square.sqrt() } else { 0.0 };
    for component in &mut components {
        component.parts = component.parts.map(|part| scale * part);
    }
    components
}

/// Two independent draws from the standard normal distribution, dimensionless (Box & Muller).
pub fn normal(seed: u32, l: u32, s: u32, body: u32) -> [f64; 2] {
    let [u, v] = [10, 11].map(|what| hash(seed, l, s, what + 16 * body));
    let (sin, cos) = (TAU * v).sin_cos();
    let size = (-2.0 * (1.0 - u).ln()).sqrt();
    [size * cos, size * sin]
}
