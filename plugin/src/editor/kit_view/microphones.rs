//! Where the microphones stand: the close ones at their pieces, the overheads, the room's pair; and what a hand that drags
//! one of a pair asks for.

use egui::{Align2, Color32, Painter, Pos2, Vec2, vec2};
use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::DrumSpec;
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::kit::Microphone;
use overhear_engine::layout::{Layout, Pair};
use overhear_engine::listening::ListeningPoint;
use overhear_engine::microphones::over_rim;
use overhear_engine::piece::PieceId;

use super::bodies::Body;
use super::camera::Eye;
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, between, length, scale, sub, unit};
use crate::editor::theme::{self, Palette};
use crate::parameters::Stand;
use crate::placing;

/// A microphone: its place, what it points at, its name and colour.
pub struct Shown {
    place: V3,
    target: V3,
    name: &'static str,
    colour: Color32,
    /// Length of what is drawn, m.
    size: f32,
    /// What it is, and whether it is the right one of a pair.
    what: Microphone,
    right: bool,
}

/// How near a pointer must come to take hold of one, points.
const REACH: f32 = 18.0;

/// Every microphone; `value` gives a parameter's value in its unit, by its index.
pub fn all(bodies: &[Body], value: &dyn Fn(usize) -> Option<f32>, palette: &Palette) -> Vec<Shown> {
    let single = |x: [f64; 3]| x.map(|x| x as f32);
    let close = bodies.iter().enumerate().map(|(slot, body)| {
        let place = seen_from(body, &close_of(body.piece));
        let (target, what) = (body.frame.centre, Microphone::Close(body.piece));
        Shown { place, target, name: "", colour: palette.pieces[slot], size: 0.075, what, right: false }
    });
    let layout = Layout::default();
    let pair = |what: Microphone, usual: Pair, names: [&'static str; 2], target: V3| {
        let places = placing::places(usual, what, value);
        [0, 1].map(|side| Shown {
            place: single(places[side]),
            target,
            name: names[side],
            colour: palette.accent,
            size: 0.15,
            what,
            right: side == 1,
        })
    };
    let names = ["overhead left", "overhead right"];
    let overheads = pair(Microphone::Overheads, layout.overheads, names, [0.0, 0.7, -0.2]);
    let room = pair(Microphone::Room, layout.room, ["room left", "room right"], [0.0, 0.9, -0.2]);
    close.chain(overheads).chain(room).collect()
}

/// A microphone of a pair in a hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    pub pair: Microphone,
    right: bool,
    /// Where it is, m.
    place: V3,
}

/// The microphone of a pair that is at a place of the screen.
pub fn under(shown: &[Shown], eye: &Eye, at: Pos2) -> Option<Held> {
    let pairs = shown.iter().filter(|shown| !shown.name.is_empty());
    let away = |shown: &Shown| eye.project(shown.place).0.distance(at);
    let nearest = pairs.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|shown| away(shown) < REACH)?;
    Some(Held { pair: nearest.what, right: nearest.right, place: nearest.place })
}

impl Held {
    /// What a drag (points) asks for: how much a parameter of the pair moves, in its own unit. Across draws the two apart;
    /// up and down lifts them or, `deep`, takes them away from the drummer.
    pub fn dragged(&self, eye: &Eye, drag: Vec2, deep: bool) -> [(Stand, f32); 2] {
        let (_, depth) = eye.project(self.place);
        let metre = eye.points(1.0, depth).max(1.0);
        let (across, up) = (100.0 * drag.x / metre, -100.0 * drag.y / metre);
        let layout = Layout::default();
        let pair = if self.pair == Microphone::Room { layout.room } else { layout.overheads };
        let axis: V3 = std::array::from_fn(|i| (pair[1][i] - pair[0][i]) as f32);
        // What is seen from the audience is drawn apart the other way round.
        let outward = if self.right { 1.0 } else { -1.0 } * eye.along([1.0, 0.0, 0.0]).signum();
        // Both move by as much, so that the distance grows by twice that.
        let wider = 2.0 * outward * across / length(axis);
        let stand = if deep { Stand::Depth } else { Stand::Height };
        let lifted = if deep { up * eye.ahead([0.0, 0.0, 1.0]).signum() } else { up };
        [(stand, lifted), (Stand::Width, wider)]
    }
}

/// Where a piece's close microphone hears it from.
fn close_of(piece: PieceId) -> ListeningPoint {
    over_rim(piece).unwrap_or_else(|| match piece {
        PieceId::Crash => CymbalSpec::crash().listening_point,
        PieceId::Ride => CymbalSpec::ride().listening_point,
        PieceId::Splash => CymbalSpec::splash().listening_point,
        PieceId::HiHat => HiHatSpec::default().top.listening_point,
        _ => DrumSpec::timpani().listening_point,
    })
}

/// A place that a piece sees as a listening point.
fn seen_from(body: &Body, point: &ListeningPoint) -> V3 {
    let [distance, inclination, azimuth] =
        [point.distance, point.inclination, point.azimuth].map(|number| number as f32);
    let ((sin, cos), (side, toward)) = (inclination.sin_cos(), azimuth.sin_cos());
    let out = body.frame.direction(sin * side, -sin * toward, cos);
    add(body.frame.centre, scale(out, distance))
}

/// Draws them into the world.
pub fn draw(scene: &mut Scene, microphones: &[Shown], palette: &Palette) {
    for microphone in microphones {
        let back = unit(sub(microphone.place, microphone.target));
        let at = |distance: f32| add(microphone.place, scale(back, distance));
        let metal = [shade(palette.chrome, 0.35, 0.0), shade(palette.chrome, 0.75, 0.0)];
        let size = microphone.size;
        scene.taper(
            at(0.0),
            at(0.3 * size),
            [0.10 * size, 0.13 * size],
            [shade(microphone.colour, 0.6, 0.0), microphone.colour],
        );
        scene.rod(at(0.3 * size), at(size), 0.10 * size, metal);
        if !microphone.name.is_empty() {
            // Down to the floor, on a stand that is hardly seen.
            let top = at(size);
            let faint = palette.faint.gamma_multiply(0.35);
            for part in 0..8 {
                let [from, to] =
                    [part, part + 1].map(|part| between(top, [top[0], 0.0, top[2]], part as f32 / 8.0));
                scene.line(from, to, 1.0, faint, 0.0);
            }
        }
    }
}

/// Writes their names.
pub fn names(painter: &Painter, eye: &Eye, microphones: &[Shown], palette: &Palette) {
    for microphone in microphones.iter().filter(|microphone| !microphone.name.is_empty()) {
        let (at, _) = eye.project(microphone.place);
        let galley = painter.layout_no_wrap(microphone.name.to_owned(), theme::caption(), palette.text);
        let rect = Align2::CENTER_BOTTOM.anchor_size(at - vec2(0.0, 12.0), galley.size());
        painter.rect_filled(rect.expand2(vec2(5.0, 2.0)), 3.0, palette.panel.gamma_multiply(0.85));
        painter.galley(rect.min, galley, palette.text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::kit_view::camera::Camera;
    use crate::editor::theme::DARK;
    use crate::parameters::PARAMETERS;
    use egui::Rect;
    use overhear_engine::layout::Placement;

    fn default(index: usize) -> Option<f32> {
        Some(PARAMETERS.get(index)?.default)
    }

    #[test]
    fn a_dragged_microphone_follows_the_hand_and_its_twin_mirrors_it() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(900.0, 600.0));
        // From behind the drummer and from the audience.
        for yaw in [0.0, std::f32::consts::PI] {
            let eye = Camera::of([yaw, 0.3, 4.5]).through(rect);
            let shown = all(&Body::kit(), &default, &DARK);
            let one = shown.iter().find(|one| one.name == "room right").unwrap();
            let (at, _) = eye.project(one.place);
            let held = under(&shown, &eye, at + vec2(3.0, 2.0)).expect("it is there");
            assert_eq!((held.pair, held.right), (Microphone::Room, true));
            let drag = vec2(20.0, -12.0);
            let changes = held.dragged(&eye, drag, false);
            let value = |index: usize| {
                let moved =
                    changes.iter().find(|(stand, _)| placing::index_of(held.pair, *stand) == Some(index));
                Some(PARAMETERS[index].default + moved.map_or(0.0, |(_, change)| *change))
            };
            let moved = all(&Body::kit(), &value, &DARK);
            let there = moved.iter().find(|one| one.name == "room right").unwrap();
            let (now, _) = eye.project(there.place);
            // Near the eye a hand's way bends.
            assert!((now - at - drag).length() < 0.2 * drag.length(), "{yaw}: {now} from {at}");
            // Up the screen is away from who looks.
            let [(stand, deeper), _] = held.dragged(&eye, vec2(0.0, -12.0), true);
            assert_eq!((stand, deeper > 0.0), (Stand::Depth, yaw == 0.0));
        }
        assert_eq!(under(&[], &Camera::default().through(rect), Pos2::ZERO), None);
    }

    #[test]
    fn close_microphones_hang_where_the_engine_listens() {
        let bodies = Body::kit();
        let microphones = all(&bodies, &default, &DARK);
        assert_eq!(microphones.len(), bodies.len() + 4);
        for (body, microphone) in bodies.iter().zip(&microphones) {
            let seen = Placement::of(body.piece).sees(&microphone.place.map(f64::from));
            let wanted = close_of(body.piece);
            assert!((seen.distance - wanted.distance).abs() < 1e-3, "{:?}", body.piece);
            assert!((seen.inclination - wanted.inclination).abs() < 1e-2, "{:?}", body.piece);
        }
    }
}
