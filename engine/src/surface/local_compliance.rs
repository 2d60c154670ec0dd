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
//! The radius of the disc follows from the head if the [contact patch grows](LocalHeadCompliance::patch_grows): a head touches a
//! sphere of radius `R` under the pressure `2 T / R`, up to the radius `sqrt(F R / (2 pi T))`. The force is the largest of a
//! mass `m` that meets the head's static stiffness at the speed `v`, where the flexural rigidity spreads the force of a point
//! like a disc of
//!
//! ```text
//! b_bend = 2 exp(1/4 - gamma) sqrt(D / T),   gamma = 0.5772
//! ```
//!
//! (both deflections are equal: `ln(r / b) + 1/4` and `ln(r / 2 l) + gamma` with `l^2 = D / T`, both times
//! `F / (2 pi T)`), and the squares of both radii add, within a tenth:
//!
//! ```text
//! b^2 = F R / (2 pi T)      F = v sqrt(2 pi T m / (ln(a / sqrt(b^2 + b_bend^2)) + 1/4))
//! ```
//!
//! A dent stretches the film around it, more than the whole head is stretched. By Foeppl's equations for a point on an endless
//! film of the stretching stiffness `E h`, the radial tension at the distance `r` is, within a tenth,
//!
//! ```text
//! N = T (1 + 9/8 (s / r)^2)^(1/3)   s = F sqrt(E h / 2) / (2 pi T^1.5)
//! ```
//!
//! and the dent is as deep as under a disc of `0.45 s`, whose square adds to the others for the force of this: 13 mm on a rack tom
//! under a stroke of 3 m/s. Waves of wavenumber `k`
//! have the tension at `r = 1 / k` under the force that has built up when they have gone through a period, if the force rises
//! as a quarter of a sine.
//!
//! Disc and tension are as they are from the first touch on. Beaters therefore keep their own discs: a head wraps around a ball of
//! some centimetres only in the course of a long contact. A hard stroke meets a stiffer head than a soft one, and is shorter and
//! brighter.
//!
//! The set's own modes stay at their frequencies, so the first band begins where they end: with its lower edge raised as well, a
//! hard stroke would meet a gap in which nothing but the head's mass yields, and its force would ring there.
//!
//! Limits: the patch is that of a film without rigidity and of the tension of the whole head. With both it would stay under half a
//! millimetre up to 80 N; as it is, the force of the first touch is too high and the highs of hard strokes too weak (see EXPERIMENTS.md).
//!
//! Neglected: the set's own modes feel of the dent what it adds to the tension of the whole head
//! ([`stretch`](crate::drum::stretch)), not that it is tenser about the tip; a film that the force has not yet made tense resists as one
//! that is; the tip of a stick across a rim is slower than its shaft.
//!
//! Source: static deflections of membrane and stiff membrane under a point as in Timoshenko & Woinowsky-Krieger, Theory of
//! Plates and Shells; the radii are derived here.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::contact::Tip;
use crate::patch_factors::pressed_share;
use crate::strike::StrikerSpec;

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
    /// Whether the contact patch grows with the force; otherwise every tip presses on [its own disc](StrikerSpec::patch).
    pub patch_grows: bool,
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

/// `2 exp(1/4 - gamma)`, dimensionless: a point force on a stiff head acts like a disc of so many `sqrt(D / T)`.
const SPREAD: f64 = 1.441_856;

/// First zero of `J_1`: a tip averages out shorter waves.
const FINEST: f64 = 3.832;

/// How a striker presses on a head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Radius of the disc, m.
    pub disc: f64,
    /// Largest force, N.
    pub largest: f64,
    /// Time in which that would be reached if the force rose on as fast as at first, s.
    pub rise: f64,
}

impl Press {
    /// So softly that no film is stretched, on a disc of some radius, m.
    pub const fn lightly(disc: f64) -> Press {
        Press { disc, largest: 0.0, rise: 1.0 }
    }

    /// Force after a time (s), N: a quarter of a sine.
    fn after(&self, time: f64) -> f64 {
        self.largest * (time / self.rise.max(f64::MIN_POSITIVE)).min(FRAC_PI_2).sin()
    }
}

/// Smallest radius of a contact patch, m: of what a bead presses flat under a soft stroke. *Judgement*: no audible wave on a film is
/// so short.
const SMALLEST: f64 = 0.5e-3;

/// Radius of the disc that is as stiff as a dent over the dent's `s`, dimensionless.
const DENT: f64 = 0.45;

/// Iterations of patch and force; each changes the other little.
const ROUNDS: usize = 4;

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
        LocalHeadCompliance { rigidity: 0.0, stretching: 0.0, patch_grows: false, dot, ..self }
    }

    /// How a stroke at `speed` (m/s) presses.
    ///
    /// # Real-time
    /// No allocation; some logarithms.
    pub fn press(&self, striker: &StrikerSpec, speed: f64) -> Press {
        let disc = self.patch(striker, speed);
        let largest = self.dented_force(striker.mass, speed, disc);
        // A mass on a spring: `F = v sqrt(k m)` after a quarter of the period `2 pi sqrt(m / k)`.
        Press { disc, largest, rise: striker.mass * speed / largest.max(f64::MIN_POSITIVE) }
    }

    /// Radius of the contact patch of a stroke at `speed` (m/s), m.
    ///
    /// # Real-time
    /// No allocation; some logarithms.
    pub fn patch(&self, striker: &StrikerSpec, speed: f64) -> f64 {
        let (true, Some(_), Tip::Solid { radius, .. }) = (self.patch_grows, &striker.stick, striker.tip)
        else {
            return striker.patch;
        };
        let wrapped = radius / (2.0 * PI * self.tension);
        (0..ROUNDS).fold(striker.patch, |patch, _| {
            (wrapped * self.largest_force(striker.mass, speed, patch)).sqrt().max(SMALLEST)
        })
    }

    /// Largest force (N) of a mass (kg) that meets the middle of the head at a speed (m/s), from the static stiffness under a
    /// disc of radius `patch` (m).
    pub(super) fn largest_force(&self, mass: f64, speed: f64, patch: f64) -> f64 {
        self.meets(mass, speed, self.spread(patch))
    }

    /// The same where the film is stretched about the dent, N.
    fn dented_force(&self, mass: f64, speed: f64, patch: f64) -> f64 {
        let spread = self.spread(patch);
        let first = self.meets(mass, speed, spread);
        (0..ROUNDS)
            .fold(first, |force, _| self.meets(mass, speed, spread.hypot(DENT * self.dent_length(force))))
    }

    /// Radius (m) of the disc that is as stiff as a patch of some radius (m) on a film with rigidity.
    fn spread(&self, patch: f64) -> f64 {
        patch.hypot(SPREAD * (self.rigidity / self.tension).sqrt())
    }

    /// Largest force (N) of a mass (kg) at a speed (m/s) on a disc of some radius (m) in the middle of a head without rigidity.
    fn meets(&self, mass: f64, speed: f64, disc: f64) -> f64 {
        let stiffness = 2.0 * PI * self.tension / ((self.radius / disc).ln().max(0.0) + 0.25);
        speed * (mass * stiffness).sqrt()
    }

    /// `s` of a point that is pressed with a force (N), m.
    fn dent_length(&self, force: f64) -> f64 {
        force * (0.5 * self.stretching).sqrt() / (2.0 * PI * self.tension.powf(1.5))
    }

    /// The head as waves of wavenumber `k` (1/m) have it about a point that is pressed with a force, N.
    fn dented(&self, force: f64, k: f64) -> LocalHeadCompliance {
        let over = 1.125 * (self.dent_length(force) * k).powi(2);
        LocalHeadCompliance { tension: self.tension * (1.0 + over).cbrt(), ..*self }
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

    /// The bands above the set, at `place` (share of the radius) under a tip, and their number. Without `lossy` they do not
    /// decay.
    ///
    /// # Real-time
    /// No allocation; a few Bessel functions.
    pub fn bands(&self, place: f64, press: &Press, lossy: bool, dt: f64) -> ([Oscillator; BANDS], usize) {
        let mut bands = [Oscillator::free(1.0, dt); BANDS];
        let rim = (1.0 - place).max(0.0) * self.radius;
        let lowest = self.wavenumber(self.reached);
        let mut count = 0;
        for i in 0..BANDS {
            let from = lowest * 2.0_f64.powf(0.5 * i as f64);
            let to = from * std::f64::consts::SQRT_2;
            let k = (from * to).sqrt();
            if k * press.disc > FINEST {
                break;
            }
            let share = pressed_share(k * press.disc).powi(2) * (1.0 - libm::j0(2.0 * k * rim));
            if share < 1e-4 {
                continue;
            }
            let mass = 4.0 * PI * self.density / ((to * to - from * from) * share);
            let dented = |k| self.dented(press.after(TAU / self.omega(k)), k).omega(k);
            // The set's own modes stay where they are: the first band begins where they end, dented or not.
            let from = if i == 0 { self.reached } else { dented(from) };
            let to = dented(to);
            let sigma = if lossy { 0.5 * (to - from) } else { 0.0 };
            bands[count] = Oscillator::sprung(mass, (from * to).sqrt(), sigma, dt);
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
        stretching: 0.0,
        reached: 18_850.0,
        patch_grows: true,
        dot: None,
    };

    #[test]
    fn the_bands_yield_as_much_as_the_modes_they_stand_for() {
        // Static: sum over all modes above of P^2 / (M omega^2).
        let (bands, count) = HEAD.bands(0.3, &Press::lightly(0.002), false, 1.0);
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
        let (fine, _) = HEAD.bands(0.3, &Press::lightly(0.002), true, dt);
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
    fn the_tension_about_a_dent_is_that_of_foeppls_equations_and_its_depth_that_of_the_disc() {
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
        let far = x.iter().position(|&x| x > 100.0).unwrap();
        let depth: f64 = (0..far).map(|i| 0.5 * step * (n[i].recip() + n[i + 1].recip())).sum();
        let disc = x[far] * (0.25 - depth).exp();
        assert!((disc / DENT - 1.0).abs() < 0.05, "{disc}");
    }

    #[test]
    fn a_tip_on_a_dot_meets_film_and_dot_and_beside_it_the_film() {
        let dot = LocalDot { reach: 0.36, density: 0.35, rigidity: 0.16, stretching: 0.0 };
        let head = LocalHeadCompliance { dot: Some(dot), ..HEAD };
        assert_eq!(LocalHeadCompliance { dot: None, ..head.at(0.4) }, HEAD);
        let on_it = head.at(0.1);
        assert_eq!((on_it.density, on_it.rigidity), (HEAD.density + dot.density, dot.rigidity));
        let yields = |head: LocalHeadCompliance| -> f64 {
            let (bands, count) = head.bands(0.1, &Press::lightly(0.002), false, 1e-4);
            bands[..count].iter().map(Oscillator::compliance).sum()
        };
        assert!(yields(on_it) < yields(HEAD), "{} {}", yields(on_it), yields(HEAD));
    }

    #[test]
    fn a_hard_stroke_meets_a_stiffer_head() {
        let head = LocalHeadCompliance { stretching: 1.6e6, ..HEAD };
        let yields = |force: f64| -> f64 {
            let press = Press { disc: 0.002, largest: force, rise: 1e-3 };
            let (bands, count) = head.bands(0.3, &press, false, 1e-4);
            bands[..count].iter().map(Oscillator::compliance).sum()
        };
        let [soft, firm, hard] = [0.0, 10.0, 50.0].map(yields);
        assert!(soft > 1.05 * firm && firm > 1.05 * hard, "{soft} {firm} {hard}");
        let stick = Striker::Stick.spec();
        let force = |head: &LocalHeadCompliance, speed| head.press(&stick, speed).largest / speed;
        assert!(force(&head, 8.0) > 1.2 * force(&head, 1.0));
        // A stroke of no speed, of either sign, stretches nothing.
        let nothing = head.press(&stick, -0.0);
        assert_eq!(nothing.after(1e-4), 0.0);
    }

    #[test]
    fn a_dented_head_yields_at_every_frequency_from_where_its_set_ends() {
        // Of the film of a tom: the power that waves take from a newton just above its set, under strokes that dent it ever deeper.
        let head = LocalHeadCompliance { stretching: 1.2e6, ..HEAD };
        let stick = Striker::Stick.spec();
        let dt = 1e-6;
        let takes = |speed: f64, omega: f64| -> f64 {
            let press = Press { disc: 0.002, ..head.press(&stick, speed) };
            let (mut bands, count) = head.bands(0.3, &press, true, dt);
            let period = (TAU / (omega * dt)) as usize;
            let mut work = 0.0;
            for i in 0..40 * period {
                let force = (omega * dt * i as f64).sin();
                for band in &mut bands[..count] {
                    let before = band.q;
                    band.step();
                    band.push(force);
                    // Once it swings evenly.
                    work += if i < 30 * period { 0.0 } else { force * (band.q - before) };
                }
            }
            work / (10 * period) as f64 / dt
        };
        for over in [1.02, 1.1, 1.2, 1.4] {
            let omega = over * head.reached;
            let soft = takes(1e-3, omega);
            for speed in [2.0, 5.0, 10.0] {
                let hard = takes(speed, omega);
                assert!(hard > 0.2 * soft, "{over} {speed} m/s: {hard} of {soft}");
            }
        }
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
        assert_eq!(HEAD.patch(&stick, 1e-9), SMALLEST);
        for speed in [1.0, 5.0, 25.0] {
            let patch = HEAD.patch(&stick, speed);
            // Pressed with 2 T / R all over the disc.
            let Tip::Solid { radius, .. } = stick.tip else { panic!("a stick is solid") };
            let pressed = 2.0 * HEAD.tension / radius * PI * patch * patch;
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
        assert_eq!(HEAD.bands(0.3, &Press::lightly(0.02), true, 1e-5).1, 0);
        assert_eq!(HEAD.bands(1.0, &Press::lightly(0.002), true, 1e-5).1, 0);
    }
}
