//! What lies under the pointer: which piece, where on it, and which note plays that.

use egui::Pos2;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;

use super::bodies::Body;
use super::camera::Eye;
use super::vector::{V3, add, dot, scale, sub};
use overhear_player::kit_document::KitDocument;
use overhear_player::midi_map::{Meaning, NoteTable, Row, Stroke};

/// A place on a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The piece.
    pub slot: Slot,
    /// Whether it is the struck surface; otherwise it is what holds it.
    pub on_surface: bool,
    /// Distance from the centre as a share of the radius, 0 to 1.
    pub radius: f32,
    /// Direction seen from the centre, rad; 0 is toward the player.
    pub angle: f32,
}

impl Target {
    /// Piece, place and note in a line; nothing where the kit has no piece.
    pub fn text(&self, document: &KitDocument) -> String {
        let name = document.kit.piece(self.slot).map_or("", |piece| &piece.title);
        if !self.on_surface {
            return name.to_owned();
        }
        let place = format!("{name}, {:.2} of the radius", self.radius);
        match stroke_near(&document.notes, self.slot, f64::from(self.radius)) {
            Some((note, row, _)) => format!("{place} · note {note} {}", row.name),
            None => place,
        }
    }
}

/// The note that strikes a piece nearest to a distance from its centre (share of the radius), and how; of strokes with
/// the tip.
pub fn stroke_near(notes: &NoteTable, slot: Slot, radius: f64) -> Option<(u8, &Row, Stroke)> {
    let strokes = notes.rows().filter_map(|(note, row)| match row.meaning {
        Meaning::Strikes(stroke) if stroke.slot == slot => Some((note, row, stroke)),
        _ => None,
    });
    let tip = |stroke: &Stroke| !matches!(stroke.striker, Striker::CrossStick | Striker::RimShot);
    let away = |stroke: &Stroke| (stroke.radius - radius).abs();
    strokes.filter(|(_, _, stroke)| tip(stroke)).min_by(|a, b| away(&a.2).total_cmp(&away(&b.2)))
}

/// What is under a place of the screen: the nearest surface or shell there.
pub fn under(bodies: &[Body], eye: &Eye, at: Pos2) -> Option<Target> {
    let (from, ray) = (eye.place(), eye.ray(at));
    let hits = Slot::ALL.into_iter().zip(bodies).flat_map(|(slot, body)| {
        [on_surface(body, from, ray), on_shell(body, from, ray)].into_iter().flatten().map(
            move |(far, place)| {
                let (radius, angle) = place.unwrap_or_default();
                (far, Target { slot, on_surface: place.is_some(), radius, angle })
            },
        )
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, target)| target)
}

/// How far along the ray, and radius and angle there.
type Hit = (f32, Option<(f32, f32)>);

fn on_surface(body: &Body, from: V3, ray: V3) -> Option<Hit> {
    let frame = &body.frame;
    let cymbal = body.plate().is_some();
    // A head is struck from its front; a plate can be touched from below but is seen there only.
    let steep = dot(ray, frame.normal);
    if steep >= -1e-4 && !cymbal {
        return None;
    }
    let meets = |height: f32| {
        let far = dot(sub(frame.at(0.0, 0.0, height), from), frame.normal) / steep;
        let place = sub(add(from, scale(ray, far)), frame.centre);
        (far, dot(place, frame.right) / body.radius, dot(place, frame.away) / body.radius)
    };
    let height = if cymbal { on_plate(body, steep < 0.0, meets) } else { 0.0 };
    let (far, x, y) = meets(height);
    let radius = x.hypot(y);
    (far > 0.0 && far.is_finite() && radius <= 1.0).then(|| (far, Some((radius, x.atan2(-y)))))
}

/// Height over the edge at which a ray that `meets` each height somewhere goes through a plate, m; at its edge's if it misses.
fn on_plate(body: &Body, from_above: bool, meets: impl Fn(f32) -> (f32, f32, f32)) -> f32 {
    /// Heights looked at. A bell is a few of them tall even in a ray that grazes it.
    const STEPS: usize = 32;
    let over = |height: f32| {
        let (_, x, y) = meets(height);
        height - body.profile(x.hypot(y))
    };
    let top = body.profile(0.0);
    let height = |step: usize| {
        let share = step as f32 / STEPS as f32;
        top * if from_above { 1.0 - share } else { share }
    };
    let crossing = (0..STEPS).find(|&step| (over(height(step)) >= 0.0) != (over(height(step + 1)) >= 0.0));
    let Some(step) = crossing else { return 0.0 };
    let (mut near, mut beyond) = (height(step), height(step + 1));
    for _ in 0..12 {
        let middle = 0.5 * (near + beyond);
        let same = (over(middle) >= 0.0) == (over(near) >= 0.0);
        *(if same { &mut near } else { &mut beyond }) = middle;
    }
    beyond
}

/// The nearer side of the shell, as a cylinder.
fn on_shell(body: &Body, from: V3, ray: V3) -> Option<Hit> {
    let depth = body.kind.depth();
    let normal = body.frame.normal;
    let flat = |x: V3| sub(x, scale(normal, dot(x, normal)));
    let (start, along) = (flat(sub(from, body.frame.centre)), flat(ray));
    let (a, b) = (dot(along, along), dot(start, along));
    let c = dot(start, start) - body.radius * body.radius;
    let inside = b * b - a * c;
    if depth <= 0.0 || a < 1e-6 || inside < 0.0 {
        return None;
    }
    let far = (-b - inside.sqrt()) / a;
    let height = dot(sub(add(from, scale(ray, far)), body.frame.centre), normal);
    (far > 0.0 && (-depth..=0.0).contains(&height)).then_some((far, None))
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Aim, Camera};
    use super::*;
    use egui::{Rect, vec2};
    use overhear_engine::kit_spec::KitSpec;

    #[test]
    fn every_piece_is_found_where_it_is_seen() {
        let kit = KitSpec::standard();
        let bodies = Body::all(&kit);
        let window = Rect::from_min_size(Pos2::ZERO, vec2(900.0, 600.0));
        let eye = Camera::default().through(window, &Aim::STANDARD);
        for ((slot, piece), body) in kit.slots().zip(&bodies) {
            let mut found = 0;
            for (radius, angle) in
                [(0.0_f32, 0.0_f32), (0.5, 0.0), (0.5, 1.6), (0.5, -1.6), (0.8, 2.6), (0.7, -2.4)]
            {
                let (sin, cos) = angle.sin_cos();
                let (at, _) = eye.project(body.surface(radius * sin, -radius * cos, 0.0));
                let Some(target) = under(&bodies, &eye, at).filter(|target| target.slot == slot) else {
                    continue;
                };
                assert!(target.on_surface);
                let away = (target.radius * target.angle.sin() - radius * sin)
                    .hypot(target.radius * target.angle.cos() - radius * cos);
                assert!(away < 0.01, "{}: {away}", piece.name);
                found += 1;
            }
            assert!(found >= 2, "{} is hidden", piece.name);
        }
    }

    #[test]
    fn what_is_struck_has_a_note() {
        let document = KitDocument::standard();
        for (slot, _) in document.kit.slots() {
            for radius in [0.0, 0.3, 0.6, 0.95] {
                let near = stroke_near(&document.notes, slot, radius);
                assert!(near.is_some_and(|(_, _, stroke)| stroke.slot == slot));
            }
        }
        let (slot, _) = document.kit.find("ride").unwrap();
        let ride = |radius| stroke_near(&document.notes, slot, radius).unwrap().0;
        assert_eq!((ride(0.05), ride(0.6)), (53, 51));
        let target = Target { slot, on_surface: true, radius: 0.05, angle: 0.0 };
        assert_eq!(target.text(&document), "Ride, 0.05 of the radius · note 53 Ride Bell");
    }
}
