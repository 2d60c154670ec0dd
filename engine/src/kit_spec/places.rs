//! Which pieces stand inside one another, and the nearest place where one does not.
//!
//! A drum takes a cylinder of the room, a cymbal a flat disc: its plate without bell and bow. Both are convex: going from one to
//! the nearest point of the other and back leads to where the two are nearest (alternating projections: Cheney & Goldstein 1959),
//! and the plane across that way says how far they are apart at least.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use crate::drum::spec::ShellSpec;
use crate::layout::{FARTHEST, Placement, Point, distance};

use super::piece::{InstrumentSpec, PieceSpec};

/// How far a cymbal may reach into another piece, m: descriptions are no plans, and cymbals hang over one another.
const TOLERANCE: f64 = 0.02;

/// Plates that are nearer to each other lie in one another, m: about twice as thick as they are.
const NEAREST: f64 = 0.005;

/// Nearest that the middles of two drums can be, over the sum of their radii: shells that touch are a whole apart, and
/// a tom hangs over a kick.
const OVERLAP: f64 = 0.5;

/// Whether two pieces stand inside one another: cymbals by more than 2 cm, drums by about half.
pub fn inside(a: &PieceSpec, b: &PieceSpec) -> bool {
    let reach = |piece: &PieceSpec| Body::of(piece).reach();
    if distance(&a.place.centre, &b.place.centre) > reach(a) + reach(b) + NEAREST {
        return false;
    }
    let bodies = [Body::of(a), Body::of(b)];
    if a.drum().is_some() && b.drum().is_some() {
        let (own, other) = (a.placement(), b.placement());
        let apart = distance(&own.source(), &other.source());
        let [one, another] = &bodies;
        return apart < OVERLAP * (own.radius + other.radius)
            || one.holds(&another.middle())
            || another.holds(&one.middle());
    }
    let [one, other] = &bodies;
    let [less_of_one, less_of_other] = bodies.map(|body| body.without(TOLERANCE + NEAREST));
    less_of_one.meets(other) && less_of_other.meets(one)
}

/// The nearest place, m, to the centimetre, where a piece stands in none of the others; none within 2 m.
pub fn free_place<'a>(
    piece: &PieceSpec,
    others: impl Iterator<Item = &'a PieceSpec> + Clone,
) -> Option<Point> {
    const STEP: f64 = 0.01;
    let mut moved = piece.clone();
    let directions = directions();
    for step in 0..200 {
        for direction in &directions {
            let away = |i: usize| piece.place.centre[i] + STEP * f64::from(step) * direction[i];
            moved.place.centre = std::array::from_fn(|i| hundredths(away(i)));
            let within = moved.place.centre.iter().all(|x| x.abs() <= FARTHEST);
            if within && !others.clone().any(|other| inside(&moved, other)) {
                return Some(moved.place.centre);
            }
        }
    }
    None
}

/// The number that is nearest to one with two decimals.
fn hundredths(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

/// Straight up and down, and in circles level and halfway up and down.
fn directions() -> Vec<Point> {
    const AROUND: usize = 24;
    let mut directions = vec![[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
    for height in [0.0, FRAC_1_SQRT_2, -FRAC_1_SQRT_2] {
        let flat = (1.0 - height * height).sqrt();
        let angles = (0..AROUND).map(|at| TAU * at as f64 / AROUND as f64);
        directions.extend(angles.map(|angle| [flat * angle.cos(), height, flat * angle.sin()]));
    }
    directions
}

/// What a piece takes of the room: all that is within a radius of its axis, from its struck surface so far behind it, m.
#[derive(Debug, Clone, Copy)]
struct Body {
    centre: Point,
    normal: Point,
    radius: f64,
    depth: f64,
}

impl Body {
    fn of(piece: &PieceSpec) -> Body {
        let Placement { centre, normal, .. } = piece.placement();
        let radius = piece.instrument.radius();
        let depth = match &piece.instrument {
            InstrumentSpec::Drum(drum) => match drum.shell {
                // A bowl takes as much as a cylinder of its volume.
                Some(ShellSpec::Kettle { volume, .. }) => volume / (PI * radius * radius),
                _ => drum.body_depth(),
            },
            InstrumentSpec::Cymbal(_) | InstrumentSpec::HiHat(_) => 0.0,
        };
        Body { centre, normal, radius, depth }
    }

    /// From the centre nothing of it is farther, m.
    fn reach(&self) -> f64 {
        self.radius.hypot(self.depth)
    }

    /// A point on the axis, so far behind the surface, m.
    fn behind(&self, depth: f64) -> Point {
        std::array::from_fn(|i| self.centre[i] - depth * self.normal[i])
    }

    fn middle(&self) -> Point {
        self.behind(0.5 * self.depth)
    }

    /// What is left without so much of it all around, m.
    fn without(&self, by: f64) -> Body {
        let end = by.min(0.5 * self.depth);
        let (radius, depth) = ((self.radius - by).max(0.0), self.depth - 2.0 * end);
        Body { centre: self.behind(end), radius, depth, ..*self }
    }

    /// The point of the body that is nearest to one.
    fn nearest(&self, to: &Point) -> Point {
        let from: Point = std::array::from_fn(|i| to[i] - self.centre[i]);
        let height = dot(&from, &self.normal);
        let flat: Point = std::array::from_fn(|i| from[i] - height * self.normal[i]);
        let out = dot(&flat, &flat).sqrt();
        let inward = if out > self.radius { self.radius / out } else { 1.0 };
        let height = height.clamp(-self.depth, 0.0);
        std::array::from_fn(|i| self.centre[i] + inward * flat[i] + height * self.normal[i])
    }

    fn holds(&self, point: &Point) -> bool {
        distance(&self.nearest(point), point) < 1e-9
    }

    /// How far the body reaches in a direction of length one, m.
    fn extent(&self, direction: &Point) -> f64 {
        let along = dot(direction, &self.normal);
        let across = (1.0 - along * along).max(0.0).sqrt();
        dot(direction, &self.centre) + self.radius * across + (-self.depth * along).max(0.0)
    }

    /// Whether two bodies are nearer to each other than plates can be.
    fn meets(&self, other: &Body) -> bool {
        // Bodies that nearly touch take longest; after so many ways they are taken to be apart.
        const WAYS: usize = 1000;
        let mut here = self.middle();
        for _ in 0..WAYS {
            let there = other.nearest(&here);
            here = self.nearest(&there);
            let apart = distance(&here, &there);
            if apart < NEAREST {
                return true;
            }
            let across: Point = std::array::from_fn(|i| (there[i] - here[i]) / apart);
            let between = -self.extent(&across) - other.extent(&across.map(|x| -x));
            if between >= NEAREST {
                return false;
            }
        }
        false
    }
}

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
