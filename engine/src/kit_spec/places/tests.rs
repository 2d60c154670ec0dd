use super::*;
use crate::kit_spec::{KitSpec, PlaceSpec};
use crate::split::hash;

fn piece(name: &str, centre: Point, facing: Point) -> PieceSpec {
    let standard = KitSpec::standard();
    let piece = standard.find(name).unwrap().1.clone();
    PieceSpec { place: PlaceSpec { centre, facing }, ..piece }
}

const UP: Point = [0.0, 1.0, 0.0];

#[test]
fn plates_lie_in_one_another_side_by_side_above_or_across() {
    let crash = piece("crash", [0.0, 1.0, 0.0], UP);
    let radius = crash.instrument.radius();
    let other = |centre, facing| inside(&crash, &piece("crash", centre, facing));
    assert!(other([0.0, 1.0, 0.0], UP) && other([0.05, 1.003, 0.0], UP));
    // One hangs over the other.
    assert!(!other([0.05, 1.007, 0.0], UP) && !other([0.0, 1.1, 0.2], [0.1, 1.0, 0.0]));
    // Rims that reach over one another.
    assert!(!other([2.0 * radius - 0.015, 1.0, 0.0], UP) && other([2.0 * radius - 0.025, 1.0, 0.0], UP));
    // A plate across the middle of the other, and one that stands on it with its rim.
    let upright = |height| other([0.0, 1.0 + height, 0.0], [1.0, 0.0, 0.0]);
    assert!(upright(0.0) && upright(radius - 0.04) && !upright(radius - 0.01) && !upright(radius + 0.01));
    // One that leans meets the other's rim.
    assert!(other([0.2, 1.05, 0.0], [-0.5, 0.8, 0.0]));
    assert!(!other([0.2, 1.2, 0.0], [-0.5, 0.8, 0.0]));
}

#[test]
fn cymbals_stand_in_no_drum_and_may_lie_on_its_head() {
    let snare = piece("snare", [0.0, 0.7, 0.0], UP);
    let splash = |centre| inside(&snare, &piece("splash", centre, [0.1, 1.0, 0.0]));
    assert!(splash([0.0, 0.65, 0.0]) && splash([0.2, 0.64, 0.0]));
    assert!(!splash([0.0, 0.72, 0.0]) && !splash([0.4, 0.65, 0.0]));
    // A kettle is as deep as its air.
    let kettle = piece("timpani", [0.0, 0.8, 0.0], UP);
    assert!(inside(&kettle, &piece("splash", [0.0, 0.6, 0.0], UP)));
    assert!(!inside(&kettle, &piece("splash", [0.0, 0.3, 0.0], UP)));
}

#[test]
fn no_drum_stands_in_the_far_end_of_a_longer_one() {
    let kick = piece("kick", [0.0, 0.3, 0.0], [0.0, 0.0, -1.0]);
    let depth = kick.placement().depth;
    let tom = |z| inside(&kick, &piece("rack-tom", [0.0, 0.3, z], [0.0, 0.0, -1.0]));
    assert!(tom(0.0) && tom(depth - 0.15));
    assert!(!tom(depth + 0.15));
}

#[test]
fn bodies_meet_where_any_two_of_their_points_do() {
    /// Points along a radius and around it.
    const ALONG: usize = 40;
    let mut drawn = 0;
    let mut between = |low: f64, high: f64| {
        drawn += 1;
        low + (high - low) * hash(5, drawn, 0, 0)
    };
    let (mut met, mut apart) = (0, 0);
    for _ in 0..400 {
        let mut body = || {
            let facing: Point = [between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)];
            let placement = Placement::new(
                [between(-0.2, 0.2), between(-0.2, 0.2), between(-0.2, 0.2)],
                facing,
                0.0,
                0.0,
            );
            let depth = if between(0.0, 1.0) < 0.5 { 0.0 } else { between(0.05, 0.3) };
            Body { centre: placement.centre, normal: placement.normal, radius: between(0.1, 0.3), depth }
        };
        let (one, other) = (body(), body());
        // Every point of the other's cube is as near to the one as its nearest point in it.
        let mut least = f64::MAX;
        for at in 0..ALONG.pow(3) {
            let share = |i: usize| 2.0 * ((i % ALONG) as f64 + 0.5) / ALONG as f64 - 1.0;
            let reach = other.reach();
            let [x, y, z] = [at, at / ALONG, at / ALONG / ALONG].map(|i| reach * share(i));
            let in_cube = [other.centre[0] + x, other.centre[1] + y, other.centre[2] + z];
            let point = other.nearest(&in_cube);
            least = least.min(distance(&one.nearest(&point), &point));
        }
        let spacing = 2.0 * other.reach() / ALONG as f64;
        if one.meets(&other) {
            met += 1;
            assert!(least < NEAREST + spacing, "{least} {one:?} {other:?}");
        } else {
            apart += 1;
            assert!(least > NEAREST - 1e-3, "{least} {one:?} {other:?}");
        }
        assert_eq!(one.meets(&other), other.meets(&one), "{one:?} {other:?}");
    }
    assert!(met > 50 && apart > 50, "{met} {apart}");
}

#[test]
fn what_stands_inside_is_refused_with_the_nearest_place_that_is_free() {
    for (name, into, shift) in [
        ("crash", "ride", [0.02, 0.0, 0.0]),
        ("splash", "crash", [0.0; 3]),
        ("splash", "kick", [0.0, -0.1, 0.1]),
        ("hi-hat", "snare", [0.0, -0.05, 0.0]),
        ("floor-tom", "snare", [0.05, 0.0, 0.0]),
        ("rack-tom", "kick", [0.0, 0.0, 0.3]),
    ] {
        let mut kit = KitSpec::standard();
        let there = kit.find(into).unwrap().1.place;
        let slot = kit.find(name).unwrap().0.index();
        kit.pieces[slot].place =
            PlaceSpec { centre: std::array::from_fn(|i| there.centre[i] + shift[i]), ..there };
        let error = kit.check().expect_err(name);
        // It is told of the one that comes later in the kit.
        let told = error.field().split('.').nth(1).unwrap().to_owned();
        assert_eq!(error.field(), format!("pieces.{told}.place.centre_m"));
        let words = error.to_string();
        let accepted = words.split_once("accepted: [").expect(&words).1.split_once(']').unwrap().0;
        let place: Vec<f64> = accepted.split(", ").map(|x| x.parse().unwrap()).collect();
        let moved = kit.find(&told).unwrap().0.index();
        let before = kit.pieces[moved].place.centre;
        kit.pieces[moved].place.centre = place.try_into().unwrap();
        assert_eq!(kit.check(), Ok(()), "{words}");
        // A plate comes out of another one the short way.
        let way = distance(&before, &kit.pieces[moved].place.centre);
        assert!(into == "kick" || into == "snare" || way < 0.03, "{words}");
    }
}
