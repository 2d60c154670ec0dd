//! The kit as it stands, seen in perspective.
//!
//! Heads and plates move as their fields do, magnified; sticks replay each stroke; a press on a head or plate
//! strikes it there. Dragging the floor, or anything with another button, turns the view, the wheel comes nearer.

use std::sync::Arc;

use egui::{Color32, PointerButton, Pos2, Rect, Sense, Shape, Ui, vec2};
use overhear_engine::kit::Microphone;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::plate::PlateSpec;
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::{FieldShapes, KitSnapshot, PieceSnapshot, StrikeSnapshot};

use super::field::{self, Magnifier, Refined};
use super::theme::{self, Palette};
use overhear_player::kit_document::KitDocument;
use overhear_player::parameters::Stand;

pub mod bodies;
pub mod camera;
pub mod light;
mod microphones;
pub mod scene;
mod shells;
mod stands;
mod sticks;
pub mod surfaces;
mod target;
pub mod vector;

use bodies::{Body, Frame, Kind};
use camera::{Aim, Camera, Eye};
use microphones::{Held, Shown};
use scene::Scene;
use sticks::Replay;
use surfaces::{Motion, Tint};
pub use target::{Target, stroke_near};

/// Room at the right of a picture that something else lies over, points.
const BESIDE: f32 = 44.0;

/// Where a bass drum's beater rests, m from the head.
const READY: f32 = 0.09;

/// Point of view from which every microphone is seen: turn and height, rad, and distance, m.
const WIDE: [f32; 3] = [-0.42, 0.30, 4.5];

/// How long a stroke's mark stays, s.
const MARK_TIME: f64 = 1.0;

/// Gap between the two cymbals of the hi-hat when they touch, m: as much as is seen.
const CLOSED: f32 = 0.004;

/// What the kit is drawn from.
pub struct Seen<'a> {
    pub snapshot: &'a KitSnapshot,
    /// The kit that the view was [made for](KitView::adopt), and its notes.
    pub document: &'a KitDocument,
    /// A piece's mode shapes once it is built.
    pub shapes: &'a dyn Fn(Slot) -> Option<Arc<FieldShapes>>,
    /// The piece that the panels are about.
    pub selected: Slot,
    /// A parameter's value in its unit, by its index, if microphones are shown.
    pub microphones: Option<&'a dyn Fn(usize) -> Option<f32>>,
}

/// When a frame is drawn, and in which colours.
#[derive(Clone, Copy)]
struct Now {
    /// s of the editor's time.
    time: f64,
    /// Since the frame before, s.
    elapsed: f32,
    palette: &'static Palette,
}

/// A piece and the latest stroke on it.
struct Struck<'a> {
    slot: Slot,
    body: Body,
    strike: &'a StrikeSnapshot,
    heights: &'a Refined,
}

/// What a hand did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Done {
    /// The piece that was pressed on.
    pub chosen: Option<Slot>,
    /// Where it was struck, if it can be struck there.
    pub struck: Option<Target>,
    /// What it did with a pair of microphones.
    pub moved: Option<Moved>,
}

/// What a hand does with a pair of microphones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Moved {
    /// It takes hold of it.
    Taken(Microphone),
    /// It drags it: by how much parameters move.
    Dragged(Microphone, [(Stand, f32); 2]),
    /// It lets go.
    Released(Microphone),
}

/// The view of one window.
pub struct KitView {
    /// `[slot]`, as many as the kit has pieces.
    bodies: Vec<Body>,
    aim: Aim,
    pub camera: Camera,
    /// The point of view from which the microphones are seen.
    wide: Camera,
    pub tint: Tint,
    /// `[slot]`.
    magnifiers: [Magnifier; SLOTS],
    /// `[slot]`.
    replays: [Replay; SLOTS],
    /// What is under the pointer.
    hovered: Option<Target>,
    /// The microphone in the hand.
    held: Option<Held>,
    /// Whether the button that is down has struck something: then it does not turn the view.
    striking: bool,
}

impl KitView {
    /// A kit from a point of view.
    pub fn seen_from(camera: Camera, kit: &KitSpec) -> KitView {
        let bodies = Body::all(kit);
        KitView {
            aim: Aim::of(&bodies),
            bodies,
            camera,
            wide: Camera::of(WIDE),
            tint: Tint::default(),
            magnifiers: Default::default(),
            replays: Default::default(),
            hovered: None,
            held: None,
            striking: false,
        }
    }

    /// Shows another kit from the same point of view. Strokes that the snapshot tells of are old news.
    pub fn adopt(&mut self, kit: &KitSpec, snapshot: &KitSnapshot) {
        self.bodies = Body::all(kit);
        self.aim = Aim::of(&self.bodies);
        self.magnifiers = Default::default();
        self.replays = Default::default();
        self.hovered = None;
        self.forget_strokes(snapshot);
    }

    /// Draws the kit into `rect` and says what a hand did with it.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, seen: &Seen<'_>) -> Done {
        let palette = theme::of(ui);
        let wide = seen.microphones.is_some();
        let all = |value| microphones::all(&seen.document.kit, &self.bodies, value, palette);
        let microphones = seen.microphones.map(all).unwrap_or_default();
        let done = self.answer(ui, rect, &microphones);
        let now = ui.input(|input| Now { time: input.time, elapsed: input.unstable_dt, palette });
        let eye = self.eye(rect, wide);
        let mut scene = Scene::new(eye);
        let painter = ui.painter_at(rect);
        painter.add(backdrop(rect, palette));
        painter.add(stands::floor(&scene, &self.bodies, &self.aim, palette));
        for (slot, body) in Slot::ALL.into_iter().zip(self.bodies.clone()) {
            self.piece(&mut scene, (slot, body), seen, now);
        }
        microphones::draw(&mut scene, &microphones, palette);
        painter.add(scene.finish());
        microphones::names(&painter, &eye, &microphones, palette);
        self.caption(ui, rect, seen.document, palette);
        done
    }

    /// What is seen through a rectangle: the kit, or all the microphones too.
    pub fn eye(&self, rect: Rect, wide: bool) -> Eye {
        // The strip of speeds lies over the right.
        let free = Rect::from_min_max(rect.min, rect.max - vec2(BESIDE.min(0.5 * rect.width()), 0.0));
        if wide {
            self.wide.through(free, &self.aim.in_the_room())
        } else {
            self.camera.through(free, &self.aim)
        }
    }

    fn camera_mut(&mut self, wide: bool) -> &mut Camera {
        if wide { &mut self.wide } else { &mut self.camera }
    }

    /// The kit's bodies where they stand.
    #[cfg(test)]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Whether a stick or a mark is still to be seen.
    pub fn replays(&self, snapshot: &KitSnapshot, now: f64) -> bool {
        self.replays.iter().zip(&snapshot.pieces).any(|(replay, piece)| {
            replay.is_on(&piece.strike, now) || (replay.count > 0 && replay.since_touch(now) < MARK_TIME)
        })
    }

    /// Lets strokes from before the window was opened rest.
    pub fn forget_strokes(&mut self, snapshot: &KitSnapshot) {
        for (replay, piece) in self.replays.iter_mut().zip(&snapshot.pieces) {
            replay.count = piece.strike.count;
        }
    }

    /// Turns, zooms, strikes.
    fn answer(&mut self, ui: &mut Ui, rect: Rect, shown: &[Shown]) -> Done {
        let wide = !shown.is_empty();
        let response = ui.interact(rect, ui.scope_id().with("kit"), Sense::click_and_drag());
        let eye = self.eye(rect, wide);
        let pointer = response.hover_pos().filter(|at| rect.contains(*at));
        self.hovered = pointer.and_then(|at| target::under(&self.bodies, &eye, at));
        let mut done = Done::default();
        let pressed = |button| ui.input(|input| input.pointer.button_pressed(button));
        let near = pointer.and_then(|at| microphones::under(shown, &eye, at));
        if near.is_some() || self.held.is_some() {
            self.hovered = None;
            ui.set_cursor_icon(egui::CursorIcon::Move);
        }
        done.moved = self.move_pair(ui, &response, near, &eye);
        if response.contains_pointer() && pressed(PointerButton::Primary) {
            // What holds a microphone does not turn the view either.
            self.striking = near.is_some() || self.hovered.is_some_and(|target| target.on_surface);
            done.chosen = self.hovered.map(|target| target.slot);
            done.struck = self.hovered.filter(|target| target.on_surface);
        }
        let turns = response.dragged_by(PointerButton::Primary) && !self.striking;
        let other = [PointerButton::Secondary, PointerButton::Middle];
        if turns || other.into_iter().any(|button| response.dragged_by(button)) {
            let drag = response.drag_delta();
            self.camera_mut(wide).orbit(drag.x, drag.y);
        }
        if response.contains_pointer() {
            let (wheel, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            self.camera_mut(wide).zoom((wheel * 0.003).exp() * pinch);
        }
        if self.hovered.is_some_and(|target| target.on_surface) {
            ui.set_cursor_icon(egui::CursorIcon::Crosshair);
        }
        done
    }

    /// Takes hold of a microphone, drags it, lets it go.
    fn move_pair(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        near: Option<Held>,
        eye: &Eye,
    ) -> Option<Moved> {
        if response.drag_started_by(PointerButton::Primary) && self.held.is_none() {
            // A drag is one once the pointer has left where it pressed.
            let pressed = ui.input(|input| input.pointer.press_origin());
            self.held = near.filter(|_| pressed.is_some_and(|at| response.rect.contains(at)));
            return self.held.map(|held| Moved::Taken(held.pair));
        }
        let held = self.held?;
        if response.drag_stopped() || !response.dragged() {
            self.held = None;
            return Some(Moved::Released(held.pair));
        }
        let deep = ui.input(|input| input.modifiers.shift);
        Some(Moved::Dragged(held.pair, held.dragged(eye, response.drag_delta(), deep)))
    }

    fn piece(&mut self, scene: &mut Scene, (slot, mut body): (Slot, Body), seen: &Seen<'_>, now: Now) {
        let state = &seen.snapshot.pieces[slot.index()];
        let palette = now.palette;
        stands::stand(scene, &body, &self.bodies, palette);
        if let Kind::HiHat { bottom, .. } = body.kind {
            close(scene, &mut body, bottom, state, palette);
        }
        if let Kind::Stack { bottom, .. } = body.kind {
            below(scene, &body, body.frame.at(0.0, 0.0, -CLOSED), bottom, palette);
        }
        let accent = palette.pieces[slot.index()];
        let heights = self.heights(slot, &body, seen, now.elapsed);
        let replay = &mut self.replays[slot.index()];
        replay.follow(&state.strike, now.time);
        let since = replay.since_touch(now.time);
        let hovered = self.hovered.is_some_and(|target| target.slot == slot);
        let flash = if since < 0.0 { 0.0 } else { (1.0 - since / 0.25).max(0.0) as f32 };
        let glow = flash.max(if hovered { 0.6 } else { 0.0 });
        let motion = Motion { heights: &heights, tint: self.tint, accent, glow };
        let ring = if hovered || seen.selected == slot { accent } else { Color32::TRANSPARENT };
        shells::shell(scene, &body, ring, palette);
        surfaces::moving(scene, &body, &motion, palette);
        if ring != Color32::TRANSPARENT && body.plate().is_some() {
            shells::circle(scene, &body.frame, 1.005 * body.radius, 0.0, 2.0, ring);
        }
        let struck = Struck { slot, body, strike: &state.strike, heights: &heights };
        self.stroke(scene, &struck, now);
    }

    /// Heights of a surface as they are drawn, m.
    fn heights(&mut self, slot: Slot, body: &Body, seen: &Seen<'_>, elapsed: f32) -> Refined {
        let modes = &seen.snapshot.pieces[slot.index()].displacement;
        let field = (seen.shapes)(slot).map(|shapes| field::displacement(&shapes, modes));
        let field = field.unwrap_or_else(|| vec![0.0; overhear_engine::snapshot::FIELD_POINTS]);
        let magnifier = &mut self.magnifiers[slot.index()];
        magnifier.follow(&field, elapsed);
        let factor = magnifier.factor(body.tallest());
        field::refined(&field.iter().map(|z| z * factor).collect::<Vec<_>>())
    }

    /// The stick of the latest stroke and the mark it leaves.
    fn stroke(&self, scene: &mut Scene, struck: &Struck<'_>, now: Now) {
        let Struck { slot, body, strike, heights } = struck;
        let replay = &self.replays[slot.index()];
        if !(strike.radius.is_finite() && strike.angle.is_finite()) {
            return;
        }
        let (sin, cos) = strike.angle.sin_cos();
        let (x, y) = (strike.radius * sin, -strike.radius * cos);
        let landing = body.surface(x, y, field::height_at(heights, x, y));
        // A beater rests where it is ready.
        let ready = body.has_beater().then_some(READY);
        if let Some(height) = replay.height(strike, now.time).or(ready) {
            sticks::draw(scene, body, landing, height, now.palette);
        }
        let age = (replay.since_touch(now.time) / MARK_TIME) as f32;
        if strike.count > 0 && (0.0..1.0).contains(&age) {
            let colour = now.palette.pieces[slot.index()].gamma_multiply(1.0 - age);
            let frame = Frame { centre: landing, ..body.frame };
            let radius = (0.008 + 0.6 * age * body.radius).min(body.radius);
            shells::circle(scene, &frame, radius, 0.004, 2.0, colour);
        }
    }

    /// Names what is under the pointer.
    fn caption(&self, ui: &Ui, rect: Rect, document: &KitDocument, palette: &Palette) {
        let Some((target, at)) = self.hovered.zip(ui.input(|input| input.pointer.hover_pos())) else {
            return;
        };
        let text = target.text(document);
        let font = theme::caption();
        let galley = ui.painter().layout_no_wrap(text, font, palette.text);
        let size = galley.size() + vec2(16.0, 8.0);
        let left = (at.x + 14.0).min(rect.max.x - size.x - 4.0).max(rect.min.x);
        let top = (at.y + 16.0).min(rect.max.y - size.y - 4.0).max(rect.min.y);
        let frame = Rect::from_min_size(Pos2::new(left, top), size);
        let painter = ui.painter_at(rect);
        painter.rect_filled(frame, 4.0, palette.panel.gamma_multiply(0.94));
        let edge = Rect::from_min_size(frame.min, vec2(3.0, size.y));
        painter.rect_filled(edge, 2.0, palette.pieces[target.slot.index()]);
        painter.galley(frame.min + vec2(9.0, 4.0), galley, palette.text);
    }
}

/// Brings the upper cymbal of a hi-hat to where the pedal has it, and draws the lower, upside down.
fn close(scene: &mut Scene, body: &mut Body, bottom: PlateSpec, state: &PieceSnapshot, palette: &Palette) {
    let gap = overhear_engine::hi_hat::GAP as f32;
    let down = state.rims.pedal.clamp(0.0, gap);
    let turned = Frame { normal: vector::scale(body.frame.normal, -1.0), ..body.frame };
    let centre = body.frame.at(0.0, 0.0, -gap - CLOSED);
    below(scene, &Body { frame: turned, ..*body }, centre, bottom, palette);
    body.frame.centre = body.frame.at(0.0, 0.0, -down);
}

/// Draws the lower cymbal of two, its rim about a point.
fn below(scene: &mut Scene, body: &Body, centre: vector::V3, bottom: PlateSpec, palette: &Palette) {
    let frame = Frame { centre, ..body.frame };
    let radius = bottom.radius() as f32;
    surfaces::still(scene, &Body { frame, radius, kind: Kind::Cymbal { plate: bottom }, ..*body }, palette);
}

/// The room behind the kit.
fn backdrop(rect: Rect, palette: &Palette) -> Shape {
    let mut mesh = egui::epaint::Mesh::default();
    let [top, bottom] = palette.stage;
    for (at, colour) in [
        (rect.left_top(), top),
        (rect.right_top(), top),
        (rect.left_bottom(), bottom),
        (rect.right_bottom(), bottom),
    ] {
        mesh.colored_vertex(at, colour);
    }
    mesh.add_triangle(0, 1, 2);
    mesh.add_triangle(1, 2, 3);
    Shape::mesh(mesh)
}
