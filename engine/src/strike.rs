//! What a hit is: how fast, where, with what.
//!
//! A striker is a mass behind a tip that presses on a small disc. A stick also [bends](crate::stick). The hand
//! is what damps it, and what keeps a stick that has come off from falling back.

use crate::contact::{Material, Tip};
use crate::fitted;
use crate::stick::Stick;

/// One stroke on one piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Speed at first touch of the place that touches, m/s, above 0 to [`Strike::MAX_SPEED`].
    pub speed: f64,
    /// Distance from the centre as a share of the radius, 0 to 1.
    pub radius: f64,
    /// Direction of the place seen from the centre, rad; 0 is toward the player.
    pub angle: f64,
    /// What is swung.
    pub striker: Striker,
}

impl Strike {
    /// Fastest stroke accepted, m/s; faster ones are clamped.
    pub const MAX_SPEED: f64 = 25.0;

    /// Whether every number is one; a stroke that is not is not played.
    pub fn is_finite(&self) -> bool {
        self.speed.is_finite() && self.radius.is_finite() && self.angle.is_finite()
    }
}

/// What a drummer holds (or stands on).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Striker {
    /// The bead of a hickory stick.
    Stick,
    /// The shoulder of a hickory stick, laid across an edge or on a bell.
    Shoulder,
    /// A nylon-tipped stick.
    Nylon,
    /// A bass drum beater with a felt head.
    FeltBeater,
    /// A bass drum beater with a plastic head.
    PlasticBeater,
    /// A soft timpani mallet.
    TimpaniMallet,
    /// A hard felt mallet.
    HardMallet,
    /// A yarn-wound mallet.
    YarnMallet,
    /// A stick whose shaft meets the rim as its bead meets the head; where there is no rim, a stick.
    RimShot,
    /// A stick laid on the head and knocked on the rim; where there is no rim, a stick.
    CrossStick,
}

/// A striker as the contact sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrikerSpec {
    /// Mass that the tip carries, kg.
    pub mass: f64,
    /// The tip.
    pub tip: Tip,
    /// Restitution against a rigid wall, 0 to 1.
    pub restitution: f64,
    /// Radius of the disc that the tip presses on a head, m. *Derived*: a head wraps around a solid tip of
    /// radius `R` to `sqrt(F R / (2 pi T))`, felt that gives way by `d` is flat to `sqrt(2 R d)`; both at the
    /// force of a firm stroke. On a film that bends, a stick's is [smaller](Self::film_patch).
    pub patch: f64,
    /// What bends behind the tip.
    pub stick: Option<Stick>,
    /// How the shaft meets a rim, if it does.
    pub across: Option<Across>,
}

/// A stick that meets head and rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// Tip and shaft arrive together.
    RimShot,
    /// The tip lies on the head, beyond its centre; the shaft is brought down on the rim.
    CrossStick,
}

/// Radius of a stick's contact patch on a film, m: what it touches under 80 N, at 8 m/s. *Derived*
/// ([local compliance](crate::surface::local_compliance)); smaller ones move no wave that is heard more.
const STICK_ON_FILM: f64 = 0.5e-3;

/// Radius of the sphere that gives way as a stick's side, round by 6 mm, across an edge round by 0.4 mm, m. *Derived* (Hertz,
/// touching in an ellipse).
const SIDE_ACROSS_EDGE: f64 = 2.05e-3;

/// The same of its side on a bell, round by 45 mm (from 30 on 14 mm, to 60 on 22 mm), m.
const SIDE_ON_BELL: f64 = 18.5e-3;

impl StrikerSpec {
    const fn solid(
        grams: f64,
        material: Material,
        radius_mm: f64,
        restitution: f64,
        patch_mm: f64,
    ) -> StrikerSpec {
        StrikerSpec::new(grams, Tip::Solid { material, radius: radius_mm * 1e-3 }, restitution, patch_mm)
    }

    const fn felt(grams: f64, stiffness: f64, exponent: f64, restitution: f64, patch_mm: f64) -> StrikerSpec {
        StrikerSpec::new(grams, Tip::Felt { stiffness, exponent }, restitution, patch_mm)
    }

    const fn new(grams: f64, tip: Tip, restitution: f64, patch_mm: f64) -> StrikerSpec {
        let (mass, patch) = (grams * 1e-3, patch_mm * 1e-3);
        StrikerSpec { mass, tip, restitution, patch, stick: None, across: None }
    }

    const fn on(self, stick: Stick) -> StrikerSpec {
        StrikerSpec { stick: Some(stick), ..self }
    }

    const fn across(self, across: Across) -> StrikerSpec {
        StrikerSpec { across: Some(across), ..self }
    }

    /// Radius of the disc that the tip presses on a film that bends and is tenser where it is dented, m: of a stick less than
    /// [its own](Self::patch) ([derivation](crate::surface::local_compliance)).
    pub fn film_patch(&self) -> f64 {
        match (&self.stick, self.tip) {
            (Some(_), Tip::Solid { .. }) => STICK_ON_FILM,
            _ => self.patch,
        }
    }
}

impl Striker {
    /// Mass, tip and restitution. *Literature* for the materials; masses are those that the tip
    /// feels, not the whole stick.
    pub const fn spec(self) -> StrikerSpec {
        match self {
            // A bead is met from its side: sticks come down by a few tenths of a radian.
            Striker::Stick => {
                StrikerSpec::solid(16.0, Material::HICKORY_ACROSS, 5.0, 0.7, 2.5).on(Stick::at(Stick::BEAD))
            }
            Striker::Shoulder => {
                StrikerSpec::solid(20.0, Material::HICKORY_ACROSS, 1e3 * SIDE_ACROSS_EDGE, 0.6, 5.0)
                    .on(Stick::at(Stick::SHOULDER))
            }
            Striker::Nylon => {
                StrikerSpec::solid(16.0, Material::NYLON, 4.0, 0.7, 2.3).on(Stick::at(Stick::BEAD))
            }
            // Hardens as dense felt does. *Literature*: exponents of hammers and mallets, 2.2 to 3.5; its other numbers are
            // *fitted*.
            Striker::FeltBeater => {
                StrikerSpec::felt(110.0, fitted::FELT_STIFFNESS, fitted::FELT_EXPONENT, 0.5, 4.5)
            }
            Striker::PlasticBeater => StrikerSpec::solid(110.0, Material::PLASTIC, 25.0, 0.5, 8.0),
            Striker::TimpaniMallet => StrikerSpec::felt(25.0, 3e8, 2.5, 0.6, 7.0),
            Striker::HardMallet => StrikerSpec::felt(25.0, 1e10, 2.5, 0.6, 4.5),
            Striker::YarnMallet => StrikerSpec::felt(30.0, 5e7, 2.2, 0.5, 6.0),
            Striker::RimShot => Striker::Stick.spec().across(Across::RimShot),
            Striker::CrossStick => Striker::Stick.spec().across(Across::CrossStick),
        }
    }

    /// The same where it meets a cymbal's bell: a side does not cross an edge there.
    pub const fn spec_on_bell(self) -> StrikerSpec {
        let spec = self.spec();
        match self {
            Striker::Shoulder => StrikerSpec {
                tip: Tip::Solid { material: Material::HICKORY_ACROSS, radius: SIDE_ON_BELL },
                ..spec
            },
            _ => spec,
        }
    }

    /// Every striker, in the order of the manual.
    pub const ALL: [Striker; 10] = [
        Striker::Stick,
        Striker::Shoulder,
        Striker::Nylon,
        Striker::FeltBeater,
        Striker::PlasticBeater,
        Striker::TimpaniMallet,
        Striker::HardMallet,
        Striker::YarnMallet,
        Striker::RimShot,
        Striker::CrossStick,
    ];

    /// The name used on command lines and in presets.
    pub fn name(self) -> &'static str {
        match self {
            Striker::Stick => "stick",
            Striker::Shoulder => "shoulder",
            Striker::Nylon => "nylon",
            Striker::FeltBeater => "felt-beater",
            Striker::PlasticBeater => "plastic-beater",
            Striker::TimpaniMallet => "timpani-mallet",
            Striker::HardMallet => "hard-mallet",
            Striker::YarnMallet => "yarn-mallet",
            Striker::RimShot => "rimshot",
            Striker::CrossStick => "cross-stick",
        }
    }

    /// Radii of the discs that strikers' tips press, m, each once: what bodies work out beforehand for each.
    pub fn patches() -> impl Iterator<Item = f64> {
        let patch = |i: usize| Striker::ALL[i].spec().patch;
        let own = (0..Striker::ALL.len()).filter(move |&i| (0..i).all(|k| patch(k) != patch(i))).map(patch);
        std::iter::once(STICK_ON_FILM).chain(own)
    }

    /// The striker of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<Striker> {
        Striker::ALL.into_iter().find(|striker| striker.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    /// Complete elliptic integrals of the first and second kind of a parameter.
    fn elliptic(parameter: f64) -> [f64; 2] {
        const STEPS: usize = 1000;
        let roots = (0..STEPS).map(|i| {
            let angle = (i as f64 + 0.5) / STEPS as f64 * FRAC_PI_2;
            (1.0 - parameter * angle.sin().powi(2)).sqrt()
        });
        roots
            .fold([0.0; 2], |[first, second], root| [first + 1.0 / root, second + root])
            .map(|sum| sum * FRAC_PI_2 / STEPS as f64)
    }

    /// Radius of the sphere that gives way on a flat as two solids do whose gap has these radii of curvature, the greater first, in any unit.
    /// Johnson, Contact Mechanics, 1985, ch. 4.2.
    fn sphere_of([greater, less]: [f64; 2]) -> f64 {
        let (mut from, mut to) = (1.0 + 1e-9, 1e3_f64);
        for _ in 0..60 {
            let axes = (from * to).sqrt();
            let [k, e] = elliptic(1.0 - axes.powi(-2));
            if (axes * axes * e - k) / (k - e) < greater / less { from = axes } else { to = axes }
        }
        let [k, e] = elliptic(1.0 - from.powi(-2));
        let size = 4.0 / (PI * (1.0 - from.powi(-2)) * from.powf(1.5));
        let f1 = (size * ((from * from * e - k) * (k - e)).sqrt()).cbrt();
        let f2 = 2.0 / PI / from.sqrt() / f1 * k;
        (greater * less).sqrt() / f2.powi(3)
    }

    #[test]
    fn sides_of_sticks_give_way_as_hertz_has_it_for_ellipses() {
        assert!((sphere_of([1.0 + 1e-6, 1.0]) - 1.0).abs() < 1e-4);
        let near = |found: f64, said: f64| assert!((found / said - 1.0).abs() < 0.01, "{found} m for {said}");
        near(sphere_of([6e-3, 0.4e-3]), SIDE_ACROSS_EDGE);
        near(sphere_of([45e-3, 1.0 / (1.0 / 6e-3 + 1.0 / 45e-3)]), SIDE_ON_BELL);
    }
}
