//! Local compliance of a head under a tip: the modes above a drum's set, as a contact feels them.
//!
//! A head is soft at the point of contact. A set of modes that ends at some frequency is not: to faster motion it is a small
//! rigid mass, off which a stick's bead would bounce several times before the head begins to move. The modes above the set are
//! compliant too, the more the smaller the tip. The energy they take is carried away and lost.
//!
//! Model: a membrane of tension `T` and area density `s` has, averaged over all positions, `A omega / (2 pi c^2)` modes per
//! rad/s, `c^2 = T / s`, each of mass `s A` and unit mean square. The modes of a band together move one point as a single
//! oscillator of mass `s A / count`,
//!
//! ```text
//! M_b = 4 pi c^2 s / ((omega_2^2 - omega_1^2) P^2 E)
//! ```
//!
//! with `P = 2 J_1(k b) / (k b)` of a tip that presses on a disc of radius `b`, and `E = 1 - J_0(2 k d)` at
//! the distance `d` from the rim. The modes of a band dephase within the inverse of its width, so the band decays at half its
//! width. Without `P` the compliance would be infinite, as that of a point on a membrane is.
//!
//! The radius of the disc follows from the head if the [contact patch grows](LocalHeadCompliance::patch_grows). Flexural
//! rigidity `D` alone spreads the force of a point like a disc of
//!
//! ```text
//! b_bend = 2 exp(1/4 - gamma) sqrt(D / T),   gamma = 0.5772
//! ```
//!
//! (both deflections are equal: `ln(r / b) + 1/4` and `ln(r / 2 l) + gamma` with `l^2 = D / T`, both times
//! `F / (2 pi T)`). A head without rigidity touches a sphere of radius `R` under the pressure `2 T / R`, up to the radius
//! `sqrt(F R / (2 pi T))`. The squares of both radii add, within a tenth. The force is the largest of a mass `m` that meets the
//! head's static stiffness at the speed `v`:
//!
//! ```text
//! b^2 = b_bend^2 + F R / (2 pi T)      F = v sqrt(2 pi T m / (ln(a / b) + 1/4))
//! ```
//!
//! The disc has this radius from the first touch on. Beaters therefore keep their own: a head wraps around a ball of some
//! centimetres only in the course of a long contact. A hard stroke meets a stiffer head than a soft one, and is shorter and
//! brighter.
//!
//! Neglected: the additional stretch of the film around a hard stroke's dent, which would stiffen it more. By Foeppl's
//! equations for a point on an infinite film, a static dent under `F` is as stiff as a disc of
//! `0.45 F sqrt(E h / 2) / (2 pi T^1.5)`: 13 mm on a rack tom under a stroke of 3 m/s, where this law has 4.3 mm. Also neglected:
//! the tip of a stick across a rim is slower than its shaft.
//!
//! Source: static deflections of membrane and stiff membrane under a point as in Timoshenko & Woinowsky-Krieger, Theory of
//! Plates and Shells; the radii are derived here.

use std::f64::consts::PI;

use crate::contact::Tip;
use crate::patch_factors::pressed_share;
use crate::strike::StrikerSpec;

use super::oscillator::Oscillator;

/// Bands above a set, at most; each half an octave.
pub const BANDS: usize = 6;

/// Constants of a head for its local compliance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalHeadCompliance {
    /// Radius, m.
    pub radius: f64,
    /// Tension, N/m.
    pub tension: f64,
    /// Area density of the film with the air it carries, kg/m2.
    pub density: f64,
    /// Flexural rigidity under a tip, N m.
    pub rigidity: f64,
    /// Highest angular frequency of the body's modes, rad/s.
    pub reached: f64,
    /// Whether the contact patch grows with the force; otherwise every tip presses on [its own disc](StrikerSpec::patch).
    pub patch_grows: bool,
}

/// `2 exp(1/4 - gamma)`, dimensionless: a point force on a stiff head acts like a disc of so many `sqrt(D / T)`.
const SPREAD: f64 = 1.441_856;

/// First zero of `J_1`: a tip averages out shorter waves.
const FINEST: f64 = 3.832;

/// Iterations of patch and force; each changes the other little.
const ROUNDS: usize = 4;

impl LocalHeadCompliance {
    /// Radius of the contact patch of a stroke at `speed` (m/s), m.
    ///
    /// # Real-time
    /// No allocation; some logarithms.
    pub fn patch(&self, striker: &StrikerSpec, speed: f64) -> f64 {
        let (true, Some(_), Tip::Solid { radius, .. }) = (self.patch_grows, &striker.stick, striker.tip)
        else {
            return striker.patch;
        };
        let spread = SPREAD * SPREAD * self.rigidity / self.tension;
        let wrapped = radius / (2.0 * PI * self.tension);
        (0..ROUNDS).fold(striker.patch, |patch, _| {
            (spread + wrapped * self.largest_force(striker.mass, speed, patch)).sqrt()
        })
    }

    /// Largest force (N) of a mass (kg) that meets the middle of the head at a speed (m/s), from the static stiffness under a
    /// disc of radius `patch` (m).
    pub(super) fn largest_force(&self, mass: f64, speed: f64, patch: f64) -> f64 {
        let stiffness = 2.0 * PI * self.tension / ((self.radius / patch).ln().max(0.0) + 0.25);
        speed * (mass * stiffness).sqrt()
    }

    /// The bands above the set, at `place` (share of the radius) under a tip of radius `tip` (m), and their number. Without
    /// `lossy` they do not decay.
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
            let mass = 4.0 * PI * self.tension / ((to * to - from * from) * share);
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
    use crate::patch_factors::PatchFactors;
    use crate::strike::Striker;

    const HEAD: LocalHeadCompliance = LocalHeadCompliance {
        radius: 0.15,
        tension: 2400.0,
        density: 0.5,
        rigidity: 0.02,
        reached: 18_850.0,
        patch_grows: true,
    };

    #[test]
    fn the_bands_yield_as_much_as_the_modes_they_stand_for() {
        // Static: sum over all modes above of P^2 / (M omega^2) = ln-like integral / (2 pi T).
        let (bands, count) = HEAD.bands(0.3, 0.002, false, 1.0);
        assert!(count >= 4);
        // A force held far longer than the periods leaves only the mean deflection. Sum it directly.
        let c = (HEAD.tension / HEAD.density).sqrt();
        let (mut exact, mut omega) = (0.0, HEAD.reached);
        while omega * 0.002 / c < FINEST && omega < HEAD.reached * 8.0 {
            let step = 1e-3 * omega;
            let share = pressed_share((omega + 0.5 * step) * 0.002 / c).powi(2);
            exact += share * step / (omega + 0.5 * step) / (2.0 * PI * HEAD.tension);
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

    /// `T` times the deflection per unit force by waves from `from` to `to` (1/m) under a disc, with or without rigidity: the
    /// sum over the modes of a large head.
    fn gives(disc: f64, stiffness_length: f64, [from, to]: [f64; 2]) -> f64 {
        let steps = 200_000;
        let ratio = (to / from).ln() / f64::from(steps);
        let share = |i: i32| {
            let k = from * (ratio * (f64::from(i) + 0.5)).exp();
            let pressed = if disc > 0.0 { pressed_share(k * disc).powi(2) } else { 1.0 };
            pressed / (1.0 + (k * stiffness_length).powi(2))
        };
        (0..steps).map(share).sum::<f64>() * ratio / (2.0 * PI)
    }

    #[test]
    fn a_point_on_a_stiff_head_gives_way_like_the_disc_that_stands_for_it() {
        let length = (HEAD.rigidity / HEAD.tension).sqrt();
        let waves = [1.0, 1e6];
        let [point, disc] = [gives(0.0, length, waves), gives(SPREAD * length, 0.0, waves)];
        assert!((point / disc - 1.0).abs() < 1e-4, "{point} {disc}");
        // Where both count, the sum of squares stands for them within a tenth.
        for (wrapped, within) in [(0.25, 0.05), (0.5, 0.08), (1.0, 0.1), (2.0, 0.06), (4.0, 0.03)] {
            let both = gives(wrapped * SPREAD * length, length, waves);
            let one = gives(SPREAD * length, 0.0, waves);
            let exact = (2.0 * PI * (one - both)).exp();
            let ratio = exact / f64::hypot(1.0, wrapped);
            assert!((ratio - 1.0).abs() < within, "{wrapped}: {ratio}");
        }
    }

    #[test]
    fn a_sticks_tip_presses_what_its_force_wraps_and_a_beater_its_own_disc() {
        let [stick, felt] = [Striker::Stick, Striker::FeltBeater].map(Striker::spec);
        let ball = Striker::PlasticBeater.spec();
        let spread = SPREAD * (HEAD.rigidity / HEAD.tension).sqrt();
        assert!((HEAD.patch(&stick, 1e-9) / spread - 1.0).abs() < 1e-3);
        for speed in [1.0, 5.0, 25.0] {
            let patch = HEAD.patch(&stick, speed);
            // Pressed with 2 T / R all over what is wrapped.
            let Tip::Solid { radius, .. } = stick.tip else { panic!("a stick is solid") };
            let pressed = 2.0 * HEAD.tension / radius * PI * (patch * patch - spread * spread);
            let force = HEAD.largest_force(stick.mass, speed, patch);
            assert!((pressed / force - 1.0).abs() < 1e-3, "{speed}: {pressed} {force}");
            assert_eq!(HEAD.patch(&felt, speed), felt.patch);
            assert_eq!(HEAD.patch(&ball, speed), ball.patch);
            assert_eq!(LocalHeadCompliance { patch_grows: false, ..HEAD }.patch(&stick, speed), stick.patch);
        }
    }

    #[test]
    fn a_disc_between_two_known_ones_feels_what_it_would_by_itself() {
        let waves: Vec<f64> = (0..40).map(|i| 25.0 * f64::from(i)).collect();
        let share = |disc: f64| waves.iter().map(|k| pressed_share(k * disc)).collect();
        let discs = PatchFactors::new(1.0, share);
        for i in 0..200 {
            let disc = 0.5e-3 * 1.02_f64.powi(i);
            let known = discs.of(disc).unwrap();
            for (k, exact) in share(disc).iter().enumerate() {
                let within = if waves[k] * disc < 4.0 { 0.01 } else { 0.03 };
                assert!((known.get(k) - exact).abs() < within, "{disc} {k}: {} {exact}", known.get(k));
            }
        }
        assert!(discs.of(0.0).is_none() && discs.of(1.0).is_none());
        let own = Striker::Stick.spec().patch;
        assert_eq!(discs.of(own).unwrap().get(20), pressed_share(waves[20] * own));
    }

    #[test]
    fn a_broad_tip_and_the_rim_leave_nothing_to_yield() {
        assert_eq!(HEAD.bands(0.3, 0.02, true, 1e-5).1, 0);
        assert_eq!(HEAD.bands(1.0, 0.002, true, 1e-5).1, 0);
    }
}
