//! Where the microphones stand: the close ones at their pieces, the overheads, the room's pair.

use egui::{Align2, Color32, Painter, vec2};
use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::DrumSpec;
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::layout::Layout;
use overhear_engine::listening::ListeningPoint;
use overhear_engine::microphones::over_rim;
use overhear_engine::piece::PieceId;

use super::bodies::Body;
use super::camera::Eye;
use super::light::shade;
use super::scene::Scene;
use super::vector::{V3, add, between, scale, sub, unit};
use crate::editor::theme::{self, Palette};

/// A microphone: its place, what it points at, its name and colour.
pub struct Microphone {
    place: V3,
    target: V3,
    name: &'static str,
    colour: Color32,
    /// Length of what is drawn, m.
    size: f32,
}

/// Every microphone of the default set-up.
pub fn all(bodies: &[Body], palette: &Palette) -> Vec<Microphone> {
    let single = |x: [f64; 3]| x.map(|x| x as f32);
    let close = bodies.iter().enumerate().map(|(slot, body)| {
        let place = seen_from(body, &close_of(body.piece));
        let target = body.frame.centre;
        Microphone { place, target, name: "", colour: palette.pieces[slot], size: 0.075 }
    });
    let layout = Layout::default();
    let pair = |places: [[f64; 3]; 2], names: [&'static str; 2], target: V3| {
        std::array::from_fn::<_, 2, _>(|side| Microphone {
            place: single(places[side]),
            target,
            name: names[side],
            colour: palette.accent,
            size: 0.15,
        })
    };
    let overheads = pair(layout.overheads, ["overhead left", "overhead right"], [0.0, 0.7, -0.2]);
    let room = pair(layout.room, ["room left", "room right"], [0.0, 0.9, -0.2]);
    close.chain(overheads).chain(room).collect()
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
pub fn draw(scene: &mut Scene, microphones: &[Microphone], palette: &Palette) {
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
pub fn names(painter: &Painter, eye: &Eye, microphones: &[Microphone], palette: &Palette) {
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
    use crate::editor::theme::DARK;
    use overhear_engine::layout::Placement;

    #[test]
    fn close_microphones_hang_where_the_engine_listens() {
        let bodies = Body::kit();
        let microphones = all(&bodies, &DARK);
        assert_eq!(microphones.len(), bodies.len() + 4);
        for (body, microphone) in bodies.iter().zip(&microphones) {
            let seen = Placement::of(body.piece).sees(&microphone.place.map(f64::from));
            let wanted = close_of(body.piece);
            assert!((seen.distance - wanted.distance).abs() < 1e-3, "{:?}", body.piece);
            assert!((seen.inclination - wanted.inclination).abs() < 1e-2, "{:?}", body.piece);
        }
    }
}
