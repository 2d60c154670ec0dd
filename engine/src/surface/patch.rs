//! A head right under a tip: what the modes above a drum's set do for a contact.
//!
//! A head is soft where it is touched. A set of modes cut off at some frequency is not: to what happens
//! faster it is a small rigid mass, off which a stick's bead would bounce several times before the head
//! begins to give. The modes left out yield too, all the more the smaller the tip, and they
//! carry what they take away for good.
//!
//! Model: a membrane of tension `T` and area density `s` has, on average over the place, `A omega /
//! (2 pi c^2)` modes per rad/s, `c^2 = T / s`, each of mass `s A` and unit mean square. All of a band together
//! move one point as a single oscillator of mass `s A / count` would,
//!
//! ```text
//! M_b = 4 pi c^2 s / ((omega_2^2 - omega_1^2) P^2 E)
//! ```
//!
//! with `P = 2 J_1(k b) / (k b)` of a tip that presses on a disc of radius `b`, and `E = 1 - J_0(2 k d)` at
//! the distance `d` from the rim. Its modes part within the inverse of its width: the band decays at half of it.
//! Without `P` the compliance would grow without bound, as that of a point on a membrane does.

use super::oscillator::Oscillator;

/// Bands above a set, at most; each half an octave.
pub const BANDS: usize = 6;

/// A head as its surroundings see it from near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Radius, m.
    pub radius: f64,
    /// Tension, N/m.
    pub tension: f64,
    /// Film and the air it carries, kg/m2.
    pub density: f64,
    /// Angular frequency the modes of the body reach, rad/s.
    pub reached: f64,
}

/// Share of a wave of wavenumber `k` that a tip of radius `b` feels, `x = k b`: `2 J_1(x) / x`.
pub fn pressed_share(x: f64) -> f64 {
    if x < 1e-3 { 1.0 - x * x / 8.0 } else { 2.0 * libm::j1(x) / x }
}

/// First zero of `J_1`: what is finer than this, a tip does not feel.
const FINEST: f64 = 3.832;

impl Film {
    /// The bands above the set, at `place` (share of the radius) under a tip of radius `tip` (m). How
    /// many there are is returned; without `lossy` they keep what they take.
    ///
    /// # Real-time
    /// No allocation; a few Bessel functions.
    pub fn bands(&self, place: f64, tip: f64, lossy: bool, dt: f64) -> ([Oscillator; BANDS], usize) {
        let mut bands = [Oscillator::free(1.0, dt); BANDS];
        let c = (self.tension / self.density).sqrt();
        let rim = (1.0 - place).max(0.0) * self.radius;
        let mut count = 0;
        for i in 0..BANDS {
            let from = self.reached * 2.0_f64.powf(0.5 * i as f64);
            let to = from * std::f64::consts::SQRT_2;
            let middle = (from * to).sqrt();
            let k = middle / c;
            if k * tip > FINEST {
                break;
            }
            let share = pressed_share(k * tip).powi(2) * (1.0 - libm::j0(2.0 * k * rim));
            if share < 1e-4 {
                continue;
            }
            let mass = 4.0 * std::f64::consts::PI * self.tension / ((to * to - from * from) * share);
            let sigma = if lossy { 0.5 * (to - from) } else { 0.0 };
            bands[count] = Oscillator::sprung(mass, middle, sigma, dt);
            count += 1;
        }
        (bands, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: Film = Film { radius: 0.15, tension: 2400.0, density: 0.5, reached: 18_850.0 };

    #[test]
    fn the_bands_yield_as_much_as_the_modes_they_stand_for() {
        // Static: sum over all modes above of P^2 / (M omega^2) = ln-like integral / (2 pi T).
        let (bands, count) = HEAD.bands(0.3, 0.002, false, 1.0);
        assert!(count >= 4);
        // With a hold far longer than their periods only the mean deflection is left; sum it directly.
        let c = (HEAD.tension / HEAD.density).sqrt();
        let (mut exact, mut omega) = (0.0, HEAD.reached);
        while omega * 0.002 / c < FINEST && omega < HEAD.reached * 8.0 {
            let step = 1e-3 * omega;
            let share = pressed_share((omega + 0.5 * step) * 0.002 / c).powi(2);
            exact += share * step / (omega + 0.5 * step) / (2.0 * std::f64::consts::PI * HEAD.tension);
            omega += step;
        }
        // Half-octave bands as single modes: within some percent of the integral.
        let dt = 1e-7;
        let (fine, _) = HEAD.bands(0.3, 0.002, true, dt);
        let mut total = 0.0;
        for mut band in fine.into_iter().take(count) {
            for _ in 0..20_000 {
                band.step();
                band.push(1.0);
            }
            total += band.q;
        }
        assert!((total / exact - 1.0).abs() < 0.1, "{total} {exact}");
        assert_eq!(bands.len(), BANDS);
    }

    #[test]
    fn a_broad_tip_and_the_rim_leave_nothing_to_yield() {
        assert_eq!(HEAD.bands(0.3, 0.02, true, 1e-5).1, 0);
        assert_eq!(HEAD.bands(1.0, 0.002, true, 1e-5).1, 0);
    }
}
