//! Where the microphones stand: the close ones at their pieces, the overheads, the room's pair; and what a hand that drags
//! one of a pair asks for.

use egui::{Align2, Color32, Painter, Pos2, Vec2, vec2};
use overhear_engine::kit::Microphone;
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::layout::Pair;

use super::bodies::{Body, Frame};
use super::camera::Eye;
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, between, length, scale, sub, unit};
use crate::editor::theme::{self, Palette};
use overhear_player::parameters::Stand;
use overhear_player::placing;

/// A microphone: its place, what it points at, its colour.
pub struct Shown {
    place: V3,
    target: V3,
    colour: Color32,
    /// Length of what is drawn, m.
    size: f32,
    /// Which of a pair it is; a close one can be neither named nor moved.
    end: Option<End>,
}

/// One of a pair of microphones.
#[derive(Clone, Copy)]
struct End {
    pair: Microphone,
    right: bool,
    name: &'static str,
    /// From the left one to the right one as the kit has them, m.
    axis: V3,
}

/// How near a pointer must come to take hold of one, points.
const REACH: f32 = 18.0;

/// Every microphone of a kit; `value` gives a parameter's value in its unit, by its index.
pub fn all(
    kit: &KitSpec,
    bodies: &[Body],
    value: &dyn Fn(usize) -> Option<f32>,
    palette: &Palette,
) -> Vec<Shown> {
    let close = kit.pieces.iter().zip(bodies).zip(palette.pieces).map(|((piece, body), colour)| Shown {
        place: close_place(piece, &body.frame),
        target: body.frame.centre,
        colour,
        size: 0.075,
        end: None,
    });
    let pair = |pair: Microphone, usual: Pair, names: [&'static str; 2], target: V3| {
        let places = placing::places(usual, pair, value);
        let axis = std::array::from_fn(|i| (usual[1][i] - usual[0][i]) as f32);
        [0, 1].map(|side| Shown {
            place: places[side].map(|x| x as f32),
            target,
            colour: palette.accent,
            size: 0.15,
            end: Some(End { pair, right: side == 1, name: names[side], axis }),
        })
    };
    let names = ["overhead left", "overhead right"];
    let overheads = pair(Microphone::Overheads, kit.microphones.overheads, names, [0.0, 0.7, -0.2]);
    let names = ["room left", "room right"];
    let room = pair(Microphone::Room, kit.microphones.room, names, [0.0, 0.9, -0.2]);
    close.chain(overheads).chain(room).collect()
}

/// A microphone of a pair in a hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    pub pair: Microphone,
    right: bool,
    /// Where it is, m.
    place: V3,
    /// From the left one of the pair to the right one, m.
    axis: V3,
}

/// The microphone of a pair that is at a place of the screen.
pub fn under(shown: &[Shown], eye: &Eye, at: Pos2) -> Option<Held> {
    let pairs = shown.iter().filter_map(|shown| Some((shown.place, shown.end?)));
    let away = |(place, _): &(V3, End)| eye.project(*place).0.distance(at);
    let nearest = pairs.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|one| away(one) < REACH);
    nearest.map(|(place, End { pair, right, axis, .. })| Held { pair, right, place, axis })
}

impl Held {
    /// What a drag (points) asks for: how much a parameter of the pair moves, in its own unit. Across draws the two apart;
    /// up and down lifts them or, `deep`, takes them away from the drummer.
    pub fn dragged(&self, eye: &Eye, drag: Vec2, deep: bool) -> [(Stand, f32); 2] {
        let (_, depth) = eye.project(self.place);
        let metre = eye.points(1.0, depth).max(1.0);
        let (across, up) = (100.0 * drag.x / metre, -100.0 * drag.y / metre);
        // What is seen from the audience is drawn apart the other way round.
        let outward = if self.right { 1.0 } else { -1.0 } * eye.along([1.0, 0.0, 0.0]).signum();
        // Both move by as much, so that the distance grows by twice that. Two in one place cannot be drawn apart.
        let wider = 2.0 * outward * across / length(self.axis).max(1e-2);
        let stand = if deep { Stand::Depth } else { Stand::Height };
        let lifted = if deep { up * eye.ahead([0.0, 0.0, 1.0]).signum() } else { up };
        [(stand, lifted), (Stand::Width, wider)]
    }
}

/// Where a piece's close microphone stands, m.
fn close_place(piece: &PieceSpec, frame: &Frame) -> V3 {
    let point = piece.close.point(piece.instrument.radius());
    let [distance, inclination, azimuth] =
        [point.distance, point.inclination, point.azimuth].map(|number| number as f32);
    let ((sin, cos), (side, toward)) = (inclination.sin_cos(), azimuth.sin_cos());
    add(frame.centre, scale(frame.direction(sin * side, -sin * toward, cos), distance))
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
        if microphone.end.is_some() {
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
    for microphone in microphones {
        let Some(End { name, .. }) = microphone.end else { continue };
        let (at, _) = eye.project(microphone.place);
        let galley = painter.layout_no_wrap(name.to_owned(), theme::caption(), palette.text);
        let rect = Align2::CENTER_BOTTOM.anchor_size(at - vec2(0.0, 12.0), galley.size());
        painter.rect_filled(rect.expand2(vec2(5.0, 2.0)), 3.0, palette.panel.gamma_multiply(0.85));
        painter.galley(rect.min, galley, palette.text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::kit_view::camera::{Aim, Camera};
    use crate::editor::theme::DARK;
    use egui::Rect;
    use overhear_player::parameters::parameters;

    fn default(index: usize) -> Option<f32> {
        Some(parameters().get(index)?.default)
    }

    fn shown(value: &dyn Fn(usize) -> Option<f32>) -> Vec<Shown> {
        let kit = KitSpec::standard();
        all(&kit, &Body::all(&kit), value, &DARK)
    }

    fn right_of_room(shown: &[Shown]) -> &Shown {
        shown.iter().find(|one| one.end.is_some_and(|end| end.name == "room right")).unwrap()
    }

    #[test]
    fn a_dragged_microphone_follows_the_hand_and_its_twin_mirrors_it() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(900.0, 600.0));
        // From behind the drummer and from the audience.
        for yaw in [0.0, std::f32::consts::PI] {
            let eye = Camera::of([yaw, 0.3, 4.5]).through(rect, &Aim::STANDARD);
            let shown_now = shown(&default);
            let (at, _) = eye.project(right_of_room(&shown_now).place);
            let held = under(&shown_now, &eye, at + vec2(3.0, 2.0)).expect("it is there");
            assert_eq!((held.pair, held.right), (Microphone::Room, true));
            let drag = vec2(20.0, -12.0);
            let changes = held.dragged(&eye, drag, false);
            let value = |index: usize| {
                let moved =
                    changes.iter().find(|(stand, _)| placing::index_of(held.pair, *stand) == Some(index));
                Some(parameters()[index].default + moved.map_or(0.0, |(_, change)| *change))
            };
            let (now, _) = eye.project(right_of_room(&shown(&value)).place);
            // Near the eye a hand's way bends.
            assert!((now - at - drag).length() < 0.2 * drag.length(), "{yaw}: {now} from {at}");
            // Up the screen is away from who looks.
            let [(stand, deeper), _] = held.dragged(&eye, vec2(0.0, -12.0), true);
            assert_eq!((stand, deeper > 0.0), (Stand::Depth, yaw == 0.0));
        }
        let eye = Camera::default().through(rect, &Aim::STANDARD);
        assert_eq!(under(&[], &eye, Pos2::ZERO), None);
    }

    #[test]
    fn close_microphones_hang_where_the_engine_listens() {
        let kit = KitSpec::standard();
        let microphones = shown(&default);
        assert_eq!(microphones.len(), kit.pieces.len() + 4);
        for (piece, microphone) in kit.pieces.iter().zip(&microphones) {
            let seen = piece.placement().sees(&microphone.place.map(f64::from));
            let wanted = piece.close.point(piece.instrument.radius());
            assert!((seen.distance - wanted.distance).abs() < 1e-3, "{}", piece.name);
            assert!((seen.inclination - wanted.inclination).abs() < 1e-2, "{}", piece.name);
        }
    }
}
