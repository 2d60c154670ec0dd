//! The editor drawn and used without a window: egui takes the input and tessellates the frame.

use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2, pos2};
use nice_plug::prelude::Param;
use overhear_engine::snapshot::{FIELD_MODES, FieldShapes, KitSnapshot};

use super::knob::Gesture;
use super::*;

struct Window {
    context: egui::Context,
    panels: Panels,
    parameters: HostParameters,
    shapes: Arc<FieldShapes>,
    snapshot: KitSnapshot,
    size: Vec2,
    time: f64,
}

impl Window {
    fn new() -> Window {
        let context = egui::Context::default();
        theme::apply(&context);
        Window {
            context,
            panels: Panels::default(),
            parameters: HostParameters::default(),
            shapes: Arc::new(dish()),
            snapshot: KitSnapshot::default(),
            size: Vec2::new(980.0, 640.0),
            time: 0.0,
        }
    }

    /// One frame with some input: what was done to which parameter, and the triangles drawn.
    fn frame(&mut self, events: Vec<Event>) -> (Vec<(usize, Gesture)>, usize) {
        self.time += 1.0 / 60.0;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let shapes = |_: usize| Some(self.shapes.clone());
        let mut gestures = Vec::new();
        let mut output = self.context.run_ui(input, |ui| {
            let mut set = |index, gesture| gestures.push((index, gesture));
            let values = self.parameters.values();
            self.panels.show(ui, &self.snapshot, &shapes, values, &mut set);
        });
        output.textures_delta.clear();
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        let triangles = shapes.iter().map(|shape| match &shape.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
            egui::epaint::Primitive::Callback(_) => 0,
        });
        (gestures, triangles.sum())
    }

    fn press(&mut self, at: Pos2, pressed: bool) -> Vec<(usize, Gesture)> {
        let button = PointerButton::Primary;
        let event = Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE };
        self.frame(vec![Event::PointerMoved(at), event]).0
    }
}

/// Shapes of a surface whose first mode is a dish.
fn dish() -> FieldShapes {
    let points = FieldShapes::grid();
    let shapes = points.iter().map(|[x, y]| {
        let mut shape = [0.0; FIELD_MODES];
        shape[0] = 1.0 - x * x - y * y;
        shape
    });
    FieldShapes { shapes: shapes.collect(), points }
}

/// Middle of the first knob, the selected piece's tuning.
const FIRST_KNOB: Pos2 = pos2(70.0, 574.0);

#[test]
fn a_frame_draws_the_surface_and_the_panels() {
    let mut window = Window::new();
    let (gestures, triangles) = window.frame(Vec::new());
    assert!(gestures.is_empty());
    assert!(triangles > 3_000, "{triangles} triangles");
}

#[test]
fn any_size_and_any_snapshot_can_be_drawn() {
    let mut window = Window::new();
    window.snapshot.peak = [f32::NAN, f32::INFINITY];
    for piece in &mut window.snapshot.pieces {
        piece.displacement = [f32::NAN; 32];
        piece.strike.count = 1;
        piece.strike.angle = f32::INFINITY;
        piece.peak = -1.0;
    }
    for size in [Vec2::new(1.0, 1.0), Vec2::new(760.0, 500.0), Vec2::new(4000.0, 300.0)] {
        window.size = size;
        window.frame(Vec::new());
    }
}

#[test]
fn meters_fall_when_the_host_stops() {
    let mut window = Window::new();
    window.snapshot.clock = 1;
    window.snapshot.peak = [1.0, 0.5];
    window.frame(Vec::new());
    let (left, right) = window.panels.main_levels();
    assert!((left - 0.0).abs() < 0.01 && (right + 6.02).abs() < 0.01, "{left} {right}");
    for _ in 0..240 {
        window.frame(Vec::new());
    }
    assert_eq!(window.panels.main_levels(), (-60.0, -60.0));
}

#[test]
fn dragging_a_knob_is_one_gesture_upwards() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let mut gestures = window.press(FIRST_KNOB, true);
    for step in 1..=10 {
        let at = FIRST_KNOB - Vec2::new(0.0, 4.0 * step as f32);
        gestures.extend(window.frame(vec![Event::PointerMoved(at)]).0);
    }
    gestures.extend(window.press(FIRST_KNOB - Vec2::new(0.0, 40.0), false));

    // The snare, which is selected at first, is the second piece of the table.
    assert!(gestures.iter().all(|&(index, _)| index == 3), "{gestures:?}");
    assert_eq!(gestures.first(), Some(&(3, Gesture::Begin)));
    assert_eq!(gestures.last(), Some(&(3, Gesture::End)));
    let values: Vec<f32> = gestures
        .iter()
        .filter_map(|(_, gesture)| match gesture {
            Gesture::Set(value) => Some(*value),
            _ => None,
        })
        .collect();
    assert!(values.is_sorted() && values.len() >= 8, "{values:?}");
    let default = window.parameters.values()[3].default_plain_value();
    assert!(*values.last().unwrap() > default);
}

#[test]
fn a_double_click_resets() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let mut gestures = Vec::new();
    for pressed in [true, false, true, false] {
        gestures.extend(window.press(FIRST_KNOB, pressed));
    }
    let default = window.parameters.values()[3].default_plain_value();
    assert_eq!(gestures, [Gesture::Begin, Gesture::Set(default), Gesture::End].map(|g| (3, g)));
}

#[test]
fn clicking_a_piece_shows_its_parameters() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let kick = pos2(100.0, 60.0);
    window.press(kick, true);
    window.press(kick, false);
    // Not a third click of the same hand.
    window.time += 1.0;
    let gestures = [true, false, true, false].map(|pressed| window.press(FIRST_KNOB, pressed));
    assert!(gestures.iter().flatten().all(|&(index, _)| index == 0));
    assert_eq!(gestures.iter().flatten().count(), 3);
}
