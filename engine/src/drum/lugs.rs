//! Lugs: a head is pulled at some places of its hoop, by rods that are not tuned alike.
//!
//! Model: `N` rods at even distances pull with `2 pi a T / N (1 + d_j)` each, `d_j` drawn from a normal distribution, of mean zero over
//! the rods: that is the pitch. As a load on the hoop (N/m) the pull has, in `l` periods around, the amplitude
//!
//! ```text
//! f_l = 2 T / N sum_j (1 + d_j) e^(i l theta_j)
//! ```
//!
//! The hoop, a [ring](crate::rim) that bends and twists, yields to it against its own stiffness `K_l` and that of the film `k_l`, so that the film
//! gets the share `H_l = k_l / (k_l + K_l)`. What a film at rest has of its tension in plane stress (the mean of its two principal tensions) is
//! harmonic, and goes as `r^l`. With the edge held along the hoop and drawn outward by `u cos(l theta)`, shear modulus `mu`, thickness `h` and
//! `kappa = (3 - nu) / (1 + nu)`,
//!
//! ```text
//! k_l = mu h / a ((l + 1) / kappa + l - 1),    tau_l = 2 (l + 1) / kappa / ((l + 1) / kappa + l - 1) H_l f_l / T
//! ```
//!
//! So a hoop carries the rods' pull well where it is stiff and they are many: six rods on a 12 in hoop of bent steel leave 5 % in six periods, ten
//! on a 14 in one half a percent. Uneven tuning passes in its lowest periods.
//!
//! Limits: the difference of the two principal tensions is left out, and the collar's own give; rods pull the hoop straight down, and the
//! film moves outward over the bearing edge by as much without friction. Only modes that are [mixed](super::mixing) feel it: pairs below are split by
//! their own number.
//!
//! Source: Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity (the disc in plane stress); Worland, J. Acoust. Soc. Am.
//! 127, 2010 (drum heads whose tension goes as `r^l cos(l theta)`).

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::membrane::MembraneSpec;
use crate::numbers::{Numbers, Visitor};
use crate::random_field;
use crate::rim::HoopSpec;

/// The lugs of a drum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LugsSpec {
    /// Rods of each head, 3 to 24.
    pub count: u32,
    /// Root mean square by which the rods' pulls differ from their mean, relative to it, 0 to 0.3. *Literature*: heads tuned by ear have lugs 1 to 3 % apart in pitch,
    /// twice that in tension.
    pub rms: f64,
    /// Tells the tuning of one drum's lugs from another's.
    pub seed: u32,
}

impl LugsSpec {
    /// Accepted numbers of rods.
    pub const COUNT: [u32; 2] = [3, 24];
    /// [`rms`](Self::rms) that a drummer leaves who tunes by ear, dimensionless. *Literature*, see there.
    pub const BY_EAR: f64 = 0.04;
}

impl Numbers for LugsSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("rms", &mut self.rms, 0.0..=0.3);
    }
}

/// Weaker periods are left out, relative to the tension.
const WEAKEST: f64 = 1e-4;

/// Tells draws of rods from those of other fields of the same seed.
const DRAW: u32 = 0x6c75;

/// Relative tension at the rim by its number of periods around, cosine and sine part; `head` tells the heads of a drum apart. Allocates.
pub fn rim_tension(spec: &LugsSpec, hoop: &HoopSpec, film: &MembraneSpec, head: u32) -> Vec<[f64; 2]> {
    let pulls = pulls(spec, head);
    let amplitude = |l: u32| {
        let share = rim_share(hoop, film, l) * 2.0 / f64::from(spec.count);
        pulls.iter().fold([0.0; 2], |[re, im], (angle, pull)| {
            let (sin, cos) = (f64::from(l) * angle).sin_cos();
            [re + share * pull * cos, im + share * pull * sin]
        })
    };
    let mut tension = vec![[0.0; 2]];
    tension.extend((1..=2 * spec.count).map(amplitude));
    while tension.last().is_some_and(|parts| parts.iter().all(|part| part.abs() < WEAKEST)) {
        tension.pop();
    }
    tension
}

/// Least tension of a head under its lugs, relative to the mean. What is harmonic is least at the rim. Allocates.
pub fn least_tension(spec: &LugsSpec, hoop: &HoopSpec, film: &MembraneSpec, head: u32) -> f64 {
    let tension = rim_tension(spec, hoop, film, head);
    // Eight directions to a period of the finest part.
    let directions = 16 * spec.count;
    let at = |direction: u32| {
        let angle = TAU * f64::from(direction) / f64::from(directions);
        let parts = tension.iter().enumerate().map(|(l, [re, im])| {
            let (sin, cos) = (l as f64 * angle).sin_cos();
            re * cos + im * sin
        });
        1.0 + parts.sum::<f64>()
    };
    (0..directions).map(at).fold(f64::INFINITY, f64::min)
}

/// Directions of the rods, rad, and how each pulls relative to their mean.
fn pulls(spec: &LugsSpec, head: u32) -> Vec<(f64, f64)> {
    let drawn: Vec<f64> =
        (0..spec.count).map(|rod| random_field::normal(spec.seed, rod, DRAW, head)[0]).collect();
    let count = f64::from(spec.count);
    let mean = drawn.iter().sum::<f64>() / count;
    let square = drawn.iter().map(|draw| (draw - mean).powi(2)).sum::<f64>() / count;
    // The root mean square is of these rods, not of all that could be drawn.
    let scale = if square > 0.0 { spec.rms / square.sqrt() } else { 0.0 };
    let rods = drawn.iter().enumerate();
    rods.map(|(rod, draw)| (TAU * (rod as f64 + 0.5) / count, 1.0 + scale * (draw - mean))).collect()
}

/// Relative tension at the rim over the relative load on the hoop, both in `l` periods around, dimensionless.
fn rim_share(hoop: &HoopSpec, film: &MembraneSpec, l: u32) -> f64 {
    let nu = film.material.poisson_ratio;
    let shear = film.material.youngs_modulus / (2.0 * (1.0 + nu));
    let order = f64::from(l);
    let across = (order + 1.0) * (1.0 + nu) / (3.0 - nu);
    let yields = shear * film.thickness / film.radius * (across + order - 1.0);
    let passed = yields / (yields + hoop.stiffness(film.radius, l));
    2.0 * across / (across + order - 1.0) * passed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;

    fn tom() -> (HoopSpec, MembraneSpec) {
        let spec = reference::drum("rack-tom");
        (spec.hoop.unwrap(), spec.membrane(&spec.batter))
    }

    fn size([re, im]: [f64; 2]) -> f64 {
        re.hypot(im)
    }

    #[test]
    fn rods_that_pull_alike_leave_their_own_number_of_periods_only() {
        let (hoop, film) = tom();
        for count in [5, 6, 8, 10] {
            let lugs = LugsSpec { count, rms: 0.0, seed: 1 };
            let tension = rim_tension(&lugs, &hoop, &film, 0);
            for (l, parts) in tension.iter().enumerate() {
                let rods = l > 0 && l % count as usize == 0;
                assert_eq!(size(*parts) > 1e-9, rods, "{l} of {count}: {parts:?}");
            }
        }
    }

    #[test]
    fn more_rods_and_stiffer_hoops_stretch_a_head_more_evenly() {
        let (hoop, film) = tom();
        let ripple = |count, hoop: &HoopSpec| {
            let tension = rim_tension(&LugsSpec { count, rms: 0.0, seed: 1 }, hoop, &film, 0);
            tension.get(count as usize).map_or(0.0, |&parts| size(parts))
        };
        let thin = HoopSpec { wall: 1.6e-3, ..hoop };
        assert!(ripple(5, &hoop) > 1.5 * ripple(6, &hoop) && ripple(6, &hoop) > 2.0 * ripple(8, &hoop));
        assert!(ripple(6, &thin) > 1.3 * ripple(6, &hoop));
        // The module's figure: 5 %.
        assert!((ripple(6, &hoop) - 0.05).abs() < 0.01, "{}", ripple(6, &hoop));
    }

    #[test]
    fn what_one_rod_pulls_more_is_felt_beside_it_as_the_hoop_spreads_it() {
        // A hoop that does not resist passes the load on; a rigid one passes no more than its tilt.
        let (hoop, film) = tom();
        let with = |youngs_modulus| HoopSpec {
            material: crate::contact::Material { youngs_modulus, ..hoop.material },
            ..hoop
        };
        let (soft, rigid) = (with(1.0), with(1e18));
        for l in 1..12 {
            let nu = film.material.poisson_ratio;
            let across = f64::from(l + 1) * (1.0 + nu) / (3.0 - nu);
            let all = 2.0 * across / (across + f64::from(l) - 1.0);
            assert!((rim_share(&soft, &film, l) / all - 1.0).abs() < 1e-6);
            assert_eq!(rim_share(&rigid, &film, l) < 1e-4, l > 1);
        }
        // In one period around the load is a moment: stress as in a beam, `sigma_theta = 3 sigma_r`, twice the load in the mean.
        assert!((rim_share(&rigid, &film, 1) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_head_is_slackest_between_few_lugs_that_are_tuned_far_apart() {
        let (hoop, film) = tom();
        let least = |count, rms| least_tension(&LugsSpec { count, rms, seed: 4 }, &hoop, &film, 0);
        // One wave of 5 % alone.
        assert!((least(6, 0.0) - 0.95).abs() < 0.01, "{}", least(6, 0.0));
        assert!(least(3, 0.0) < least(4, 0.0) && least(4, 0.0) < least(6, 0.0));
        assert!(least(6, 0.3) < least(6, 0.1) && least(6, 0.1) < least(6, 0.0));
    }

    #[test]
    fn lugs_that_leave_a_head_slack_are_refused_with_what_works() {
        let spec = reference::drum("rack-tom");
        let lugs = |count, rms| Some(LugsSpec { count, rms, seed: 4 });
        let thin = HoopSpec { wall: 5e-4, ..spec.hoop.unwrap() };
        let with = |hoop, lugs| crate::drum::DrumSpec { hoop: Some(hoop), lugs, ..spec };
        let nearest = |refused: &crate::drum::DrumSpec| -> f64 {
            let words = refused.check().unwrap_err().to_string();
            words.rsplit(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("{words}"))
        };
        assert_eq!(with(spec.hoop.unwrap(), lugs(6, 0.04)).check(), Ok(()));
        // Too far apart.
        let rms = nearest(&with(spec.hoop.unwrap(), lugs(6, 0.3)));
        assert!(rms > 0.04 && rms < 0.3, "{rms}");
        assert_eq!(with(spec.hoop.unwrap(), lugs(6, rms)).check(), Ok(()));
        // Too few for the hoop.
        let count = nearest(&with(thin, lugs(3, 0.02)));
        assert!(count > 3.0 && count < 12.0, "{count}");
        assert_eq!(with(thin, lugs(count as u32, 0.02)).check(), Ok(()));
    }

    #[test]
    fn unevenness_of_tuning_has_the_size_that_is_asked_for_and_no_mean() {
        for head in 0..2 {
            let pulls = pulls(&LugsSpec { count: 8, rms: 0.05, seed: 3 }, head);
            let mean = pulls.iter().map(|(_, pull)| pull).sum::<f64>() / 8.0;
            let square = pulls.iter().map(|(_, pull)| (pull - 1.0).powi(2)).sum::<f64>() / 8.0;
            assert!((mean - 1.0).abs() < 1e-12 && (square.sqrt() - 0.05).abs() < 1e-12);
        }
    }
}
