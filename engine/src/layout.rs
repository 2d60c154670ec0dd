//! Where pieces and microphones stand: the one table for sound, microphones and picture.
//!
//! Coordinates (m): `x` to the drummer's right, `y` up, `z` toward the audience; the origin is on the
//! floor under the middle of the kit.

use crate::receiver::ReceiverPosition;
use crate::slot::{SLOTS, Slot};

/// A place, m.
pub type Point = [f64; 3];

/// Sound is never taken to come from nearer than this, m: a point source would be infinitely loud.
pub const NEAREST: f64 = 0.25;

/// From farther than this nothing is heard, m; bounds what is kept of the past.
pub const FARTHEST: f64 = 20.0;

/// Distance of a close microphone from its piece, m. It is time zero of the mix: what stands farther is later by
/// the difference.
pub const CLOSE: f64 = 0.5;

/// Distance between two places, m.
pub fn distance(a: &Point, b: &Point) -> f64 {
    length(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

fn length(x: &Point) -> f64 {
    dot(x, x).sqrt()
}

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Where a piece is and which way its struck side faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Centre of the struck surface, m.
    pub centre: Point,
    /// Unit normal of the struck side.
    pub normal: Point,
    /// Depth of the body behind it, as far as sound comes from its other end too, m.
    pub depth: f64,
    /// Radius within which no other drum can stand, m: a drum's own; 0 of a cymbal, which hangs above.
    pub radius: f64,
}

impl Placement {
    /// A piece whose struck surface has that centre (m) and faces that way, with a body of that depth and radius, m.
    pub fn new(centre: Point, facing: Point, depth: f64, radius: f64) -> Placement {
        let length = length(&facing);
        Placement { centre, normal: facing.map(|x| x / length), depth, radius }
    }

    /// A place on the axis, so far behind the struck surface, m.
    fn behind(&self, depth: f64) -> Point {
        std::array::from_fn(|i| self.centre[i] - depth * self.normal[i])
    }

    /// Where the sound of the whole body comes from: its middle, m.
    pub fn source(&self) -> Point {
        self.behind(0.5 * self.depth)
    }

    /// A point as it is seen from the struck surface; angles as in [`Strike`](crate::strike::Strike), 0 toward the player.
    pub fn sees(&self, point: &Point) -> ReceiverPosition {
        let to: Point = std::array::from_fn(|i| point[i] - self.centre[i]);
        let distance = length(&to).max(1e-3);
        let height = dot(&to, &self.normal);
        // The player's direction in the disc's plane; below, of a disc that faces the player.
        let flat = |x: Point| -> Point {
            let out = dot(&x, &self.normal);
            std::array::from_fn(|i| x[i] - out * self.normal[i])
        };
        let back = flat([0.0, 0.0, -1.0]);
        let back = if length(&back) > 0.3 { back } else { flat([0.0, -1.0, 0.0]) };
        let (n, b) = (&self.normal, &back);
        let right = [n[1] * b[2] - n[2] * b[1], n[2] * b[0] - n[0] * b[2], n[0] * b[1] - n[1] * b[0]];
        ReceiverPosition {
            distance,
            inclination: (height / distance).clamp(-1.0, 1.0).acos(),
            // The drummer's right is against `n x b` of a disc that faces up.
            azimuth: (-dot(&to, &right)).atan2(dot(&to, &back)),
        }
    }

    /// Where the piece lies in the stereo as the drummer hears it, a share of the width: -1 (left) to 1 (right).
    pub fn side(&self) -> f64 {
        /// Half the width of the kit, m.
        const HALF_WIDTH: f64 = 0.8;
        /// How far to the side the outermost pieces go, 0 to 1. *By ear*.
        const SPREAD: f64 = 0.7;
        (self.centre[0] / HALF_WIDTH).clamp(-1.0, 1.0) * SPREAD
    }
}

/// A pair of microphones, left and right.
pub type Pair = [Point; 2];

/// Where everything stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// `[slot]`.
    pub pieces: [Option<Placement>; SLOTS],
    /// The pair above the kit.
    pub overheads: Pair,
    /// The pair in the room.
    pub room: Pair,
}

impl Layout {
    /// The way of sound between the pieces of two slots, m: from the middle of one to the struck head
    /// of the other, the shorter of the two. The same both ways: if it were not, the air between them would do
    /// work. Nor is it less than the radii of both: what each sends out and feels as a point, with no account of how its own
    /// modes move the air for each other, would do work in the other's place. None if a slot is empty.
    pub fn path_length(&self, a: Slot, b: Slot) -> Option<f64> {
        let (a, b) = (self.pieces[a.index()]?, self.pieces[b.index()]?);
        let ways = [distance(&a.source(), &b.centre), distance(&b.source(), &a.centre)];
        Some(ways[0].min(ways[1]).clamp(NEAREST.max(a.radius + b.radius), FARTHEST))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit_spec::KitSpec;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_disc_that_faces_up_sees_the_player_at_angle_0_and_the_right_at_a_quarter() {
        let disc = Placement { centre: [0.0; 3], normal: [0.0, 1.0, 0.0], depth: 0.0, radius: 0.0 };
        let above = disc.sees(&[0.0, 2.0, 0.0]);
        assert!((above.distance - 2.0).abs() < 1e-12 && above.inclination.abs() < 1e-6);
        let player = disc.sees(&[0.0, 0.0, -1.0]);
        assert!((player.inclination - FRAC_PI_2).abs() < 1e-9 && player.azimuth.abs() < 1e-9);
        let right = disc.sees(&[1.0, 1.0, 0.0]);
        assert!((right.azimuth - FRAC_PI_2).abs() < 1e-9, "{}", right.azimuth);
    }

    #[test]
    fn drums_keep_as_far_apart_as_their_shells_do_and_stand_so_by_default() {
        let kit = KitSpec::standard();
        let layout = kit.layout();
        let mut crowded = layout;
        crowded.pieces.iter_mut().flatten().for_each(|piece| piece.centre = [0.0, 0.7, 0.0]);
        let drums: Vec<Slot> = kit.drums().map(|(slot, _)| slot).collect();
        for (&a, &b) in drums.iter().flat_map(|a| drums.iter().filter(move |b| *b != a).map(move |b| (a, b)))
        {
            let [from, to] = [a, b].map(|slot| layout.pieces[slot.index()].unwrap());
            let shells = from.radius + to.radius;
            assert!(shells > NEAREST && crowded.path_length(a, b).unwrap() >= shells, "{a:?} {b:?}");
            // By default it is the places that decide.
            let placed = distance(&from.source(), &to.centre).min(distance(&to.source(), &from.centre));
            assert_eq!(layout.path_length(a, b), Some(placed), "{a:?} {b:?}");
        }
        assert_eq!(layout.path_length(drums[0], Slot::ALL[SLOTS - 1]), None);
    }

    #[test]
    fn the_overheads_stand_as_far_from_the_snare_and_above_every_piece() {
        let kit = KitSpec::standard();
        let layout = kit.layout();
        let snare = kit.find("snare").unwrap().1.place.centre;
        let [left, right] = layout.overheads.map(|place| distance(&place, &snare));
        assert!((left - right).abs() < 0.02, "{left} {right}");
        for piece in layout.pieces.iter().flatten() {
            assert!(layout.overheads.iter().all(|place| place[1] > piece.centre[1] + 0.3));
        }
    }
}
