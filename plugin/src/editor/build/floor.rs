//! The kit from above: pieces are moved by dragging them, or by the arrow keys.

use egui::{Align2, Color32, Key, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, pos2, vec2};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceSpec};
use overhear_engine::slot::Slot;

use super::super::theme;
use super::wish::Wish;

/// How far an arrow key moves a piece, m; with Shift.
const STEP: (f64, f64) = (0.02, 0.1);

/// Points around a disc.
const AROUND: usize = 40;

/// The floor of one window.
#[derive(Default)]
pub struct Floor {
    /// The piece in the hand, and how far it was dragged, points.
    held: Option<(Slot, Vec2)>,
}

/// From the floor to the screen.
#[derive(Clone, Copy)]
struct Plan {
    centre: Pos2,
    /// The place of the floor that is there, m.
    middle: [f64; 2],
    /// Points for a metre.
    scale: f32,
}

impl Plan {
    fn of(rect: Rect, kit: &KitSpec) -> Plan {
        let mut bounds = [[f64::MAX, f64::MIN]; 2];
        for piece in &kit.pieces {
            let radius = piece.instrument.radius();
            let [x, _, z] = piece.place.centre;
            for (bound, at) in bounds.iter_mut().zip([x, z]) {
                *bound = [bound[0].min(at - radius), bound[1].max(at + radius)];
            }
        }
        let [wide, deep] = bounds.map(|[from, to]| (to - from + 0.3).max(1.6) as f32);
        let middle = bounds.map(|[from, to]| 0.5 * (from + to));
        Plan { centre: rect.center(), middle, scale: (rect.width() / wide).min(rect.height() / deep) }
    }

    fn at(&self, x: f64, z: f64) -> Pos2 {
        let (right, up) = ((x - self.middle[0]) as f32, (z - self.middle[1]) as f32);
        self.centre + self.scale * vec2(right, -up)
    }
}

impl Floor {
    /// Draws it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        kit: &KitSpec,
        selected: &mut Slot,
        wish: &mut Option<Wish>,
    ) {
        let palette = theme::of(ui);
        let inner = rect.shrink2(vec2(8.0, 14.0));
        let plan = Plan::of(inner, kit);
        let painter = ui.painter_at(rect);
        let at = pos2(rect.center().x, rect.max.y - 8.0);
        painter.text(at, Align2::CENTER_CENTER, "Drummer", theme::small(), palette.faint);
        let at = pos2(rect.center().x, rect.min.y + 8.0);
        painter.text(at, Align2::CENTER_CENTER, "Audience", theme::small(), palette.faint);
        let mut titles: Vec<(&str, Rect)> = Vec::new();
        let mut slots: Vec<(Slot, &PieceSpec)> = kit.slots().collect();
        // What hangs higher lies over what stands below.
        slots.sort_by(|(_, a), (_, b)| a.place.centre[1].total_cmp(&b.place.centre[1]));
        for (slot, piece) in slots {
            let moved = self.held.filter(|(held, _)| *held == slot).map_or(Vec2::ZERO, |(_, by)| by);
            let outline: Vec<Pos2> = outline(piece, &plan).into_iter().map(|at| at + moved).collect();
            let bounds = Rect::from_points(&outline).expand(2.0).intersect(rect);
            let id = ui.scope_id().with(("floor", slot));
            let response = ui.interact(bounds, id, Sense::click_and_drag());
            if response.clicked() || response.drag_started() {
                *selected = slot;
                response.request_focus();
            }
            if response.dragged() {
                let by = self.held.filter(|(held, _)| *held == slot).map_or(Vec2::ZERO, |(_, by)| by);
                self.held = Some((slot, by + response.drag_delta()));
            }
            if response.drag_stopped()
                && let Some((_, by)) = self.held.take()
            {
                let [x, _, z] = piece.place.centre;
                let [right, back] = [by.x, by.y].map(|by| f64::from(by / plan.scale));
                *wish = Some(Wish::Move(slot, [x + right, z - back]));
            }
            if response.has_focus()
                && let Some([right, forward]) = arrows(ui)
            {
                let [x, _, z] = piece.place.centre;
                *wish = Some(Wish::Move(slot, [x + right, z + forward]));
            }
            let accent = palette.pieces[slot.index()];
            let chosen = *selected == slot;
            let fill = accent.gamma_multiply(if chosen { 0.55 } else { 0.28 });
            let width = if response.has_focus() {
                3.0
            } else if chosen {
                2.0
            } else {
                1.0
            };
            painter.add(Shape::convex_polygon(outline.clone(), fill, Stroke::new(width, accent)));
            titles.push((&piece.title, Rect::from_points(&outline)));
            response.on_hover_text(format!("{}: drag it, or move it with the arrow keys", piece.title));
        }
        titled(&painter, &titles, palette.text);
    }
}

/// Where a title may lie on its piece, shares of the way from the middle to an edge: the nearest first.
const ASIDE: [f32; 7] = [0.0, 0.4, -0.4, 0.8, -0.8, 1.0, -1.0];

/// Titles where their pieces are, as far as they fit and none lies on another: what hangs highest comes first, and what is below that
/// has its title where it is seen, if there is room.
fn titled(painter: &egui::Painter, titles: &[(&str, Rect)], colour: Color32) {
    let (mut taken, mut above): (Vec<Rect>, Vec<Rect>) = (Vec::new(), Vec::new());
    for (title, bounds) in titles.iter().rev() {
        let galley = painter.layout_no_wrap((*title).to_owned(), theme::small(), colour);
        if galley.size().x <= bounds.width() + 8.0 {
            let free = 0.5 * (bounds.size() - galley.size()).max(Vec2::ZERO);
            let places = ASIDE.iter().flat_map(|x| ASIDE.map(|y| vec2(*x, y)));
            let places = places
                .map(|share| Rect::from_center_size(bounds.center() + share * free, galley.size()))
                .filter(|place| !taken.iter().any(|other| other.intersects(*place)));
            let seen = places.clone().find(|place| !above.iter().any(|other| other.intersects(*place)));
            if let Some(place) = seen.or_else(|| places.clone().next()) {
                painter.galley(place.min, galley, colour);
                taken.push(place);
            }
        }
        above.push(*bounds);
    }
}

/// How far arrow keys that have just been pressed move a piece, to the right and toward the audience, m.
fn arrows(ui: &Ui) -> Option<[f64; 2]> {
    let (step, pressed) = ui.input(|input| {
        let pressed =
            [Key::ArrowRight, Key::ArrowLeft, Key::ArrowUp, Key::ArrowDown].map(|key| input.key_pressed(key));
        (if input.modifiers.shift { STEP.1 } else { STEP.0 }, pressed)
    });
    let way = |plus: bool, minus: bool| step * (f64::from(u8::from(plus)) - f64::from(u8::from(minus)));
    let by = [way(pressed[0], pressed[1]), way(pressed[2], pressed[3])];
    (by != [0.0, 0.0]).then_some(by)
}

/// A piece from above: its surface, and what is behind it.
fn outline(piece: &PieceSpec, plan: &Plan) -> Vec<Pos2> {
    let length = piece.place.facing.iter().map(|x| x * x).sum::<f64>().sqrt();
    let normal = piece.place.facing.map(|x| x / length);
    // Two directions in the plane of the surface.
    let flat = (normal[0].powi(2) + normal[2].powi(2)).sqrt();
    let along = if flat < 1e-6 { [1.0, 0.0, 0.0] } else { [normal[2] / flat, 0.0, -normal[0] / flat] };
    let across = [
        normal[1] * along[2] - normal[2] * along[1],
        normal[2] * along[0] - normal[0] * along[2],
        normal[0] * along[1] - normal[1] * along[0],
    ];
    let depth = match &piece.instrument {
        InstrumentSpec::Drum(drum) => drum.body_depth(),
        _ => 0.0,
    };
    let radius = piece.instrument.radius();
    let point = |place: usize, behind: f64| {
        let (sin, cos) = (std::f64::consts::TAU * place as f64 / AROUND as f64).sin_cos();
        let of = |axis: usize| {
            piece.place.centre[axis] - behind * normal[axis]
                + radius * (cos * along[axis] + sin * across[axis])
        };
        plan.at(of(0), of(2))
    };
    hull((0..AROUND).flat_map(|place| [point(place, 0.0), point(place, depth)]).collect())
}

/// The convex hull of points (Andrew's monotone chain).
fn hull(mut points: Vec<Pos2>) -> Vec<Pos2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = Pos2>| {
        let mut chain: Vec<Pos2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                let turn = (b - a).x * (point - a).y - (b - a).y * (point - a).x;
                if turn > 1e-4 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut whole = half(&mut points.iter().copied());
    whole.extend(half(&mut points.iter().rev().copied()));
    whole
}
