//! Local compliance of a head under a tip: the modes above a drum's set, as a contact feels them.
//!
//! A head is soft at the point of contact. A set of modes that ends at some frequency is not: to faster motion it is a small
//! rigid mass, off which a stick's bead would bounce several times before the head begins to move. The modes above the set are
//! compliant too, the more the smaller the tip. The energy they take is carried away and lost.
//!
//! Model: a head of tension `T`, flexural rigidity `D` and area density `s` has, averaged over all positions, `A k / (2 pi)` modes
//! per unit of wavenumber `k`, each of mass `s A` and unit mean square, with
//!
//! ```text
//! omega^2 = (T k^2 + D k^4) / s
//! ```
//!
//! The modes of a band together move one point as a single oscillator of mass `s A / count`,
//!
//! ```text
//! M_b = 4 pi s / ((k_2^2 - k_1^2) P^2 E)
//! ```
//!
//! with `P = 2 J_1(k b) / (k b)` of a tip that presses on a disc of radius `b`, and `E = 1 - J_0(2 k d)` at
//! the distance `d` from the rim. The modes of a band dephase within the inverse of its width, so the band decays at half its
//! width. Without `D` and `P` the compliance would be infinite, as that of a point on a membrane is. To the fastest motion a film is
//! a plate, which resists a point by `8 sqrt(D s)` newtons per metre a second, some two newtons at the speed of a firm
//! stroke: it moves at once, and a bead stays on it.
//!
//! A dent stretches the film around it, more than the whole head is stretched, so that a point in it is moved less by every wave: each
//! band is a [`FilmBand`]. Far from the dent waves are as they were: bands keep their frequencies, and begin where the set ends.
//!
//! A stick lies on the film over less than half a millimetre: a film of the tension `N` and the rigidity `D` touches a ball of radius `R`
//! up to `b` under
//!
//! ```text
//! F = (2 pi N / R) (b^2 + 2 b l K_1(b / l) / K_0(b / l)),   l^2 = D / N
//! ```
//!
//! which is 80 N for half a millimetre. No wave that is heard is so short: a stick's disc is that large under every stroke. Beaters and
//! mallets keep discs of their own: a head wraps around a ball of some centimetres only in the course of a long contact.
//!
//! The force of a soft stroke is that of all modes of the film, one by one, within 1.2 dB from 1.4 to 11 kHz (test
//! `a_soft_stroke_meets_a_film_as_all_its_modes_one_by_one_would`).
//!
//! Limits, against Foeppl's equations with a stick on them (EXPERIMENTS.md): what the film is given from 1 to 8 kHz is within 3 dB up to strokes
//! of 5 m/s, within 6 dB at 8 m/s; below 1 kHz hard strokes give it 4 to 9 dB too little, as the set's own modes feel of a dent only what it
//! adds to the tension of the whole head ([`stretch`](crate::drum::stretch)).
//!
//! Neglected: the tip of a stick across a rim is slower than its shaft.
//!
//! Source: Morse & Ingard, Theoretical Acoustics, ch. 5 (a point force on a membrane); Cremer, Heckl & Petersson, Structure-Borne Sound,
//! ch. 4 (on a plate); the patch is derived here.

use std::f64::consts::PI;

use crate::patch_factors::pressed_share;
use crate::strike::StrikerSpec;

use super::film_band::FilmBand;
use super::oscillator::Oscillator;

/// Bands above a set, at most; each half an octave of wavenumber.
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
    /// Young's modulus times the thickness of the film, N/m.
    pub stretching: f64,
    /// Highest angular frequency of the body's modes, rad/s.
    pub reached: f64,
    /// Whether tips dent the film and a stick lies on it as it would; otherwise every tip presses on [its own disc](StrikerSpec::patch).
    pub dents: bool,
    /// A dot in its middle.
    pub dot: Option<LocalDot>,
}

/// A dot as a tip on it feels it: waves as short as these know no other film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalDot {
    /// Its radius, share of the head's.
    pub reach: f64,
    /// Mass per area that it adds, kg/m2.
    pub density: f64,
    /// Flexural rigidity of film and dot under a tip, N m.
    pub rigidity: f64,
    /// Young's modulus times the thickness of film and dot, N/m.
    pub stretching: f64,
}

/// First zero of `J_1`: a tip averages out shorter waves.
const FINEST: f64 = 3.832;

impl LocalHeadCompliance {
    /// The head as a tip at a distance from its centre (share of the radius) feels it.
    pub fn at(self, place: f64) -> LocalHeadCompliance {
        let Some(dot) = self.dot.filter(|dot| place < dot.reach) else { return self };
        let LocalDot { density, rigidity, stretching, .. } = dot;
        LocalHeadCompliance { density: self.density + density, rigidity, stretching, ..self }
    }

    /// As published contacts have it: every tip presses on [its own disc](StrikerSpec::patch), about which the film has no
    /// flexural rigidity and is not stretched.
    pub fn under_fixed_discs(self) -> LocalHeadCompliance {
        let dot = self.dot.map(|dot| LocalDot { rigidity: 0.0, stretching: 0.0, ..dot });
        LocalHeadCompliance { rigidity: 0.0, stretching: 0.0, dents: false, dot, ..self }
    }

    /// Radius of the disc that a striker's tip presses on, m.
    pub fn patch(&self, striker: &StrikerSpec) -> f64 {
        if self.dents { striker.film_patch() } else { striker.patch }
    }

    /// Angular frequency (rad/s) of waves of wavenumber `k`, 1/m.
    fn omega(&self, k: f64) -> f64 {
        k * ((self.tension + self.rigidity * k * k) / self.density).sqrt()
    }

    /// Wavenumber (1/m) of waves of the angular frequency `omega`, rad/s.
    fn wavenumber(&self, omega: f64) -> f64 {
        // The positive root of `D k^4 + T k^2 = s omega^2`, without cancellation where `D` is small.
        let inertia = self.density * omega * omega;
        let root = (self.tension * self.tension + 4.0 * self.rigidity * inertia).sqrt();
        (2.0 * inertia / (self.tension + root)).sqrt()
    }

    /// The bands above the set, at `place` (share of the radius) under a tip that presses on a disc (radius in m), and their number. Without
    /// `lossy` they do not decay.
    ///
    /// # Real-time
    /// No allocation; a few Bessel functions.
    pub fn bands(&self, place: f64, disc: f64, lossy: bool, dt: f64) -> ([FilmBand; BANDS], usize) {
        let mut bands = [FilmBand::linear(Oscillator::free(1.0, dt)); BANDS];
        let rim = (1.0 - place).max(0.0) * self.radius;
        let lowest = self.wavenumber(self.reached);
        let mut count = 0;
        for i in 0..BANDS {
            let from = lowest * 2.0_f64.powf(0.5 * i as f64);
            let to = from * std::f64::consts::SQRT_2;
            let k = (from * to).sqrt();
            if k * disc > FINEST {
                break;
            }
            let share = pressed_share(k * disc).powi(2) * (1.0 - libm::j0(2.0 * k * rim));
            if share < 1e-4 {
                continue;
            }
            let mass = 4.0 * PI * self.density / ((to * to - from * from) * share);
            let [from, to] = [from, to].map(|k| self.omega(k));
            let sigma = if lossy { 0.5 * (to - from) } else { 0.0 };
            let linear = Oscillator::sprung(mass, (from * to).sqrt(), sigma, dt);
            let bent = self.rigidity * k * k / self.tension;
            bands[count] = FilmBand::new(linear, self.dent_length() * k, bent, dt);
            count += 1;
        }
        (bands, count)
    }

    /// `s` of a point that is pressed with a newton, m.
    fn dent_length(&self) -> f64 {
        (0.5 * self.stretching).sqrt() / (2.0 * PI * self.tension.powf(1.5))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::contact::Tip;
    use crate::patch_factors::PatchFactors;
    use crate::strike::Striker;

    const HEAD: LocalHeadCompliance = LocalHeadCompliance {
        radius: 0.15,
        tension: 2400.0,
        density: 0.5,
        rigidity: 0.02,
        stretching: 0.0,
        reached: 18_850.0,
        dents: true,
        dot: None,
    };

    #[test]
    fn the_bands_yield_as_much_as_the_modes_they_stand_for() {
        // Static: sum over all modes above of P^2 / (M omega^2).
        let (bands, count) = HEAD.bands(0.3, 0.002, false, 1.0);
        assert!(count >= 4);
        // A force held far longer than the periods leaves only the mean deflection. Sum it directly.
        let (mut exact, mut from) = (0.0, HEAD.wavenumber(HEAD.reached));
        let end = 8.0 * from;
        while from * 0.002 < FINEST && from < end {
            let step = 1e-3 * from;
            let k = from + 0.5 * step;
            let share = pressed_share(k * 0.002).powi(2);
            exact += share * step / (k * (HEAD.tension + HEAD.rigidity * k * k)) / (2.0 * PI);
            from += step;
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
            total += band.moved();
        }
        assert!((total / exact - 1.0).abs() < 0.1, "{total} {exact}");
        assert_eq!(bands.len(), BANDS);
    }

    #[test]
    fn the_tension_about_a_dent_is_that_of_foeppls_equations() {
        // In units of T and s: n = 1 + 1/2 int (1 / max(x, y)^2 - 1 / X^2) dy / (y n^2), by iteration.
        const NODES: usize = 1400;
        let step = (1e7_f64).ln() / NODES as f64;
        let x: Vec<f64> = (0..=NODES).map(|i| 1e-4 * (step * i as f64).exp()).collect();
        let approximate = |x: f64| (1.0 + 1.125 / (x * x)).cbrt();
        let mut n: Vec<f64> = x.iter().map(|&x| approximate(x)).collect();
        for _ in 0..200 {
            let mean = |of: &dyn Fn(usize) -> f64, i: usize| 0.5 * step * (of(i) + of(i + 1));
            let slope = |i: usize| n[i].powi(-2);
            // Below the first node the slope grows as x^(4/3).
            let mut within = vec![0.75 * slope(0)];
            (0..NODES).for_each(|i| within.push(within[i] + mean(&slope, i)));
            let mut beyond = vec![0.0; NODES + 1];
            (0..NODES).rev().for_each(|i| beyond[i] = beyond[i + 1] + mean(&|i| slope(i) / x[i].powi(2), i));
            let end = within[NODES] / x[NODES].powi(2);
            n = (0..=NODES)
                .map(|i| {
                    let new: f64 = 1.0 + 0.5 * (within[i] / x[i].powi(2) + beyond[i] - end);
                    n[i].powf(0.6) * new.powf(0.4)
                })
                .collect();
        }
        for (x, n) in x.iter().zip(&n) {
            assert!((approximate(*x) / n - 1.0).abs() < 0.1, "{x}: {n}");
        }
    }

    #[test]
    fn a_tip_on_a_dot_meets_film_and_dot_and_beside_it_the_film() {
        let dot = LocalDot { reach: 0.36, density: 0.35, rigidity: 0.16, stretching: 0.0 };
        let head = LocalHeadCompliance { dot: Some(dot), ..HEAD };
        assert_eq!(LocalHeadCompliance { dot: None, ..head.at(0.4) }, HEAD);
        let on_it = head.at(0.1);
        assert_eq!((on_it.density, on_it.rigidity), (HEAD.density + dot.density, dot.rigidity));
        let yields = |head: LocalHeadCompliance| -> f64 {
            let (bands, count) = head.bands(0.1, 0.002, false, 1e-4);
            bands[..count].iter().map(FilmBand::compliance).sum()
        };
        assert!(yields(on_it) < yields(HEAD), "{} {}", yields(on_it), yields(HEAD));
    }

    #[test]
    fn a_film_touches_a_stick_within_the_patch_and_beaters_keep_their_own_disc() {
        let [stick, felt, ball] =
            [Striker::Stick, Striker::FeltBeater, Striker::PlasticBeater].map(Striker::spec);
        let patch = HEAD.patch(&stick);
        assert!(patch < stick.patch);
        assert_eq!(HEAD.patch(&felt), felt.patch);
        assert_eq!(HEAD.patch(&ball), ball.patch);
        assert_eq!(LocalHeadCompliance { dents: false, ..HEAD }.patch(&stick), stick.patch);
        // What presses a rack tom's film onto a bead to that radius: outside its slope goes as `K_1`, at the edge it is the bead's, and the
        // tension is that at the edge of the patch.
        let Tip::Solid { radius, .. } = stick.tip else { panic!("a stick is solid") };
        let tom = LocalHeadCompliance { tension: 1607.0, rigidity: 0.0123, stretching: 1.62e6, ..HEAD };
        let stretched = 80.0 * tom.dent_length() / patch;
        let (tension, rigidity) = (tom.tension * (1.0 + 1.125 * stretched * stretched).cbrt(), tom.rigidity);
        let length = (rigidity / tension).sqrt();
        let x = patch / length;
        // Modified Bessel functions by their integrals.
        let k = |nu: f64| -> f64 {
            (0..40_000)
                .map(|i| 2.5e-4 * (f64::from(i) + 0.5))
                .map(|t| (-x * t.cosh()).exp() * (nu * t).cosh())
                .sum::<f64>()
                * 2.5e-4
        };
        let force = TAU * tension / radius * patch * (patch + 2.0 * length * k(1.0) / k(0.0));
        assert!((70.0..90.0).contains(&force), "{force} N");
    }

    #[test]
    fn what_strikers_discs_feel_is_known_beforehand() {
        let waves: Vec<f64> = (0..40).map(|i| 25.0 * f64::from(i)).collect();
        let share = |disc: f64| waves.iter().map(|k| pressed_share(k * disc)).collect();
        let discs = PatchFactors::new(1.0, share);
        for striker in Striker::ALL.map(Striker::spec) {
            for disc in [striker.patch, striker.film_patch()] {
                assert_eq!(discs.of(disc).unwrap(), share(disc));
            }
        }
        assert!(discs.of(0.0).is_none() && discs.of(1.0).is_none());
    }

    #[test]
    fn a_broad_tip_and_the_rim_leave_nothing_to_yield() {
        assert_eq!(HEAD.bands(0.3, 0.02, true, 1e-5).1, 0);
        assert_eq!(HEAD.bands(1.0, 0.002, true, 1e-5).1, 0);
    }
}
