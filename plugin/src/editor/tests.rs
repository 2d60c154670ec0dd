//! The editor drawn and used without a window: egui takes the input and tessellates the frame.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2, pos2, vec2};
use nice_plug::prelude::Param;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::snapshot::{FIELD_MODES, FieldShapes, KitSnapshot};

use super::gesture::Gesture;
use super::panels::Page;
use super::*;
use crate::sound::Sound;
use crate::view::View;
use overhear_player::kit_document::KitDocument;
use overhear_player::parameters::{self, SlotParameter};
use overhear_player::strokes::Stroke;

mod build;
mod kits;
mod pages;
mod panics;

struct Window {
    context: egui::Context,
    panels: Panels,
    parameters: HostParameters,
    shapes: Arc<FieldShapes>,
    snapshot: KitSnapshot,
    /// The piece that is being built.
    building: Option<Slot>,
    size: Vec2,
    time: f64,
    modifiers: Modifiers,
    strokes: Vec<Stroke>,
    gestures: Vec<(usize, Gesture)>,
    sound: Sound,
    /// Every text of the latest frame, and where it was.
    texts: Vec<(String, Rect)>,
}

impl Window {
    fn new() -> Window {
        Window::with(no_presets())
    }

    /// A window with the presets of a library.
    fn with(library: Library) -> Window {
        let context = egui::Context::default();
        theme::apply(&context);
        let parameters = HostParameters::default();
        Window {
            context,
            panels: Panels::new(library, View::default(), parameters.document()),
            parameters,
            shapes: Arc::new(dish()),
            snapshot: KitSnapshot::default(),
            building: None,
            size: vec2(980.0, 640.0),
            time: 0.0,
            modifiers: Modifiers::NONE,
            strokes: Vec::new(),
            gestures: Vec::new(),
            sound: Sound::default(),
            texts: Vec::new(),
        }
    }

    /// One frame with some input; gives the triangles drawn.
    fn frame(&mut self, mut events: Vec<Event>) -> usize {
        events.insert(0, Event::ModifiersChanged(self.modifiers));
        self.time += 1.0 / 60.0;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let shapes = |_: Slot| Some(self.shapes.clone());
        let (gestures, strokes) = (&mut self.gestures, &mut self.strokes);
        let mut output = self.context.run_ui(input, |ui| {
            let mut set = |index, gesture| gestures.push((index, gesture));
            let mut play = |stroke| strokes.push(stroke);
            let (parameters, sound) = (&self.parameters, &self.sound);
            let past = std::slice::from_ref(&self.snapshot);
            let building = |slot: Slot| self.building == Some(slot);
            let snapshot = &self.snapshot;
            let inputs = Inputs { snapshot, past, shapes: &shapes, building: &building, parameters, sound };
            self.panels.show(ui, &inputs, &mut Hands { set: &mut set, play: &mut play });
        });
        output.textures_delta.clear();
        self.texts.clear();
        output.shapes.iter().for_each(|clipped| gather(&clipped.shape, &mut self.texts));
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        let triangles = shapes.iter().map(|shape| match &shape.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
            egui::epaint::Primitive::Callback(_) => 0,
        });
        triangles.sum()
    }

    /// Where a text was in the latest frame; of several, the last.
    fn find(&self, text: &str) -> Option<Pos2> {
        self.texts.iter().rev().find(|(found, _)| found == text).map(|(_, place)| place.center())
    }

    /// Clicks on a text.
    fn click_on(&mut self, text: &str) {
        let place = self.find(text);
        self.click(place.unwrap_or_else(|| panic!("there is no `{text}` in {:?}", self.texts)));
        self.frame(Vec::new());
    }

    /// Types into what has the focus.
    fn enter(&mut self, text: &str) {
        self.frame(vec![Event::Text(text.to_owned())]);
        self.key(Key::Enter);
        self.frame(Vec::new());
    }

    /// Types over the value of the first knob. Digits go into the field and strike nothing.
    fn type_value(&mut self, text: &str) {
        self.click(FIRST_VALUE);
        self.frame(Vec::new());
        self.modifiers = Modifiers::COMMAND;
        self.key(Key::A);
        self.modifiers = Modifiers::NONE;
        self.enter(text);
    }

    fn button(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        let event = Event::PointerButton { pos: at, button, pressed, modifiers: self.modifiers };
        self.frame(vec![Event::PointerMoved(at), event]);
    }

    fn press(&mut self, at: Pos2, pressed: bool) {
        self.button(at, PointerButton::Primary, pressed);
    }

    fn click(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        self.press(at, true);
        self.press(at, false);
        // Not a second click of the same hand.
        self.time += 1.0;
    }

    fn drag(&mut self, from: Pos2, by: Vec2, button: PointerButton) {
        self.button(from, button, true);
        for step in 1..=10 {
            self.frame(vec![Event::PointerMoved(from + by * (step as f32 / 10.0))]);
        }
        self.button(from + by, button, false);
        self.time += 1.0;
    }

    fn key(&mut self, key: Key) {
        let event = |pressed| Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: self.modifiers,
        };
        let events = vec![event(true), event(false)];
        self.frame(events);
    }

    /// Place on the screen of a place on a piece.
    fn place(&self, slot: Slot, radius: f32, angle: f32) -> Pos2 {
        let (sin, cos) = angle.sin_cos();
        let body = self.panels.kit_view().bodies()[slot.index()];
        let eye = self.panels.kit_view().eye(self.panels.picture(), false);
        eye.project(body.surface(radius * sin, -radius * cos, 0.0)).0
    }

    /// Gestures since the last call.
    fn gestures(&mut self) -> Vec<(usize, Gesture)> {
        std::mem::take(&mut self.gestures)
    }

    /// The same, after which the parameters are where a host would have put them.
    fn obey(&mut self) -> Vec<(usize, Gesture)> {
        use nice_plug::params::InternalParamMut;
        let gestures = self.gestures();
        for &(index, gesture) in &gestures {
            if let Gesture::Set(value) = gesture {
                // SAFETY: nobody else has this instance; a value is an atomic.
                #[allow(unsafe_code)]
                unsafe {
                    self.parameters.values()[index]._internal_set_plain_value(value)
                };
            }
        }
        gestures
    }
}

/// A library without a preset of its own.
fn no_presets() -> Library {
    Library::at(std::path::Path::new("no-such-folder"))
}

/// The piece of a name in the standard kit.
fn slot_of(name: &str) -> Slot {
    KitSpec::standard().find(name).unwrap().0
}

/// Places on a surface where a hand may find it: distances from the middle (radii) and directions (rad).
const PLACES: [(f32, f32); 5] = [(0.0, 0.0), (0.5, 0.4), (0.6, 1.7), (0.6, -1.8), (0.7, 2.8)];

/// Texts of a shape and of those in it.
fn gather(shape: &egui::Shape, into: &mut Vec<(String, Rect)>) {
    match shape {
        egui::Shape::Text(text) => into.push((text.galley.text().to_owned(), text.visual_bounding_rect())),
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| gather(shape, into)),
        _ => {}
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
    FieldShapes { shapes: shapes.collect(), points, orders: vec![[0, 1]], tension: 2_000.0 }
}

/// Middle of the first knob, the selected piece's tuning, and of its value, in a window of the tests' size.
const FIRST_KNOB: Pos2 = pos2(235.0, 558.0);
const FIRST_VALUE: Pos2 = pos2(235.0, 595.0);

/// The snare, which is selected at first, is the second piece of the kit.
const SNARE_TUNE: usize = parameters::slot_index(Slot::ALL[1], SlotParameter::Tune);

#[test]
fn a_frame_draws_the_kit_and_the_panels() {
    let mut window = Window::new();
    let triangles = window.frame(Vec::new());
    assert!(window.gestures.is_empty() && window.strokes.is_empty());
    assert!(triangles > 9_000, "{triangles} triangles");
}

#[test]
fn any_size_any_page_and_any_snapshot_can_be_drawn() {
    let mut window = Window::new();
    window.snapshot.peak = [f32::NAN, f32::INFINITY];
    for piece in &mut window.snapshot.pieces {
        piece.displacement = [f32::NAN; 32];
        piece.strike.count = 1;
        piece.strike.angle = f32::INFINITY;
        piece.strike.contact_time = f32::NAN;
        piece.peak = -1.0;
        piece.energy = f32::NAN;
        piece.rims.pedal = f32::NAN;
    }
    for page in Page::ALL {
        window.panels.open(page.0);
        for size in [vec2(1.0, 1.0), vec2(800.0, 500.0), vec2(4000.0, 300.0)] {
            window.size = size;
            window.frame(Vec::new());
            window.frame(Vec::new());
        }
    }
}

#[test]
fn a_press_on_each_head_and_plate_strikes_that_piece_at_that_place() {
    let mut window = Window::new();
    window.frame(Vec::new());
    for (slot, piece) in KitSpec::standard().slots() {
        let mut struck = 0;
        for (radius, angle) in PLACES {
            let at = window.place(slot, radius, angle);
            window.click(at);
            let Some(stroke) = window.strokes.pop() else { continue };
            // What stands before it is struck in its stead.
            if stroke.slot != slot {
                continue;
            }
            let strike = stroke.strike;
            let place = |radius: f64, angle: f64| (radius * angle.sin(), -radius * angle.cos());
            let (x, y) = place(strike.radius, strike.angle);
            let (u, v) = place(f64::from(radius), f64::from(angle));
            let away = (x - u).hypot(y - v);
            assert!(away < 0.02, "{}: {away} off", piece.name);
            assert!((0.4..=6.0).contains(&strike.speed), "{} m/s", strike.speed);
            struck += 1;
        }
        assert!(struck >= 2, "{} was struck {struck} times", piece.name);
    }
    assert!(window.gestures.is_empty());
}

#[test]
fn shift_strikes_hardest_alt_softly_and_the_strip_between() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let tom = window.place(slot_of("rack-tom"), 0.3, 0.0);
    let speed = |window: &mut Window, modifiers| {
        window.modifiers = modifiers;
        window.click(tom);
        window.strokes.pop().unwrap().strike.speed
    };
    let usual = speed(&mut window, Modifiers::NONE);
    let hard = speed(&mut window, Modifiers::SHIFT);
    let soft = speed(&mut window, Modifiers::ALT);
    assert!((hard - 10.0).abs() < 1e-3, "the dynamics' fastest, not {hard}");
    assert!(soft < 0.5 * usual && usual < hard, "{soft} {usual} {hard}");
    // The strip's upper end is the fastest stroke, its lower end the slowest.
    let strip = window.panels.picture().right_top() + vec2(-25.0, 33.0);
    window.modifiers = Modifiers::NONE;
    window.click(strip);
    assert!((speed(&mut window, Modifiers::NONE) - 10.0).abs() < 0.1);
    window.click(window.panels.picture().right_bottom() + vec2(-25.0, -33.0));
    assert!(speed(&mut window, Modifiers::NONE) < 0.45);
}

#[test]
fn keys_play_the_pieces_in_the_order_of_the_list() {
    let mut window = Window::new();
    window.frame(Vec::new());
    // Nobody is in the tenth place.
    for key in [Key::Num1, Key::Num5, Key::Num9, Key::Num0] {
        window.key(key);
    }
    let pieces: Vec<_> = window.strokes.iter().map(|stroke| stroke.slot).collect();
    assert_eq!(pieces, ["kick", "crash", "hi-hat"].map(slot_of));
    // Each as its ordinary note does.
    let notes = window.parameters.document().notes.clone();
    for stroke in &window.strokes {
        let ordinary = notes.ordinary(stroke.slot).and_then(|note| notes.stroke(note)).unwrap();
        assert_eq!((stroke.strike.radius, stroke.strike.striker), (ordinary.radius, ordinary.striker));
    }
}

#[test]
fn dragging_the_floor_turns_the_view_and_dragging_a_head_does_not() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let camera = |window: &Window| window.panels.kit_view().camera;
    let before = camera(&window);
    let floor = window.panels.picture().left_bottom() + vec2(30.0, -30.0);
    window.drag(floor, vec2(60.0, -20.0), PointerButton::Primary);
    let turned = camera(&window);
    assert!(turned != before && window.strokes.is_empty());
    let snare = window.place(slot_of("snare"), 0.0, 0.0);
    window.drag(snare, vec2(60.0, 0.0), PointerButton::Primary);
    assert_eq!(camera(&window), turned);
    assert_eq!(window.strokes.len(), 1);
    window.drag(snare, vec2(60.0, 0.0), PointerButton::Secondary);
    assert!(camera(&window) != turned && window.strokes.len() == 1);
    // What is seen is what a project stores.
    assert_eq!(window.panels.view().camera, camera(&window).numbers());
}

#[test]
fn meters_fall_when_the_host_stops() {
    let mut window = Window::new();
    window.snapshot.clock = 1;
    window.snapshot.peak = [1.0, 0.5];
    window.frame(Vec::new());
    let [left, right] = window.panels.main_levels();
    assert!((left - 0.0).abs() < 0.01 && (right + 6.02).abs() < 0.01, "{left} {right}");
    for _ in 0..240 {
        window.frame(Vec::new());
    }
    assert_eq!(window.panels.main_levels(), [-60.0, -60.0]);
}

#[test]
fn dragging_a_knob_is_one_gesture_upwards() {
    let mut window = Window::new();
    window.frame(Vec::new());
    window.drag(FIRST_KNOB, vec2(0.0, -40.0), PointerButton::Primary);
    let gestures = window.gestures();
    assert!(gestures.iter().all(|&(index, _)| index == SNARE_TUNE), "{gestures:?}");
    assert_eq!(gestures.first(), Some(&(SNARE_TUNE, Gesture::Begin)));
    assert_eq!(gestures.last(), Some(&(SNARE_TUNE, Gesture::End)));
    let values: Vec<f32> = gestures
        .iter()
        .filter_map(|(_, gesture)| match gesture {
            Gesture::Set(value) => Some(*value),
            _ => None,
        })
        .collect();
    assert!(values.is_sorted() && values.len() >= 8, "{values:?}");
    let default = window.parameters.values()[SNARE_TUNE].default_plain_value();
    assert!(*values.last().unwrap() > default);

    // The same with Shift goes a tenth as far.
    window.modifiers = Modifiers::SHIFT;
    window.drag(FIRST_KNOB, vec2(0.0, -40.0), PointerButton::Primary);
    let fine = window.gestures().into_iter().rev().find_map(|(_, gesture)| match gesture {
        Gesture::Set(value) => Some(value),
        _ => None,
    });
    assert!(fine.unwrap() - default < 0.2 * (values.last().unwrap() - default));
}

#[test]
fn an_edit_is_undone_and_redone() {
    let mut window = Window::new();
    window.frame(Vec::new());
    window.drag(FIRST_KNOB, vec2(0.0, -40.0), PointerButton::Primary);
    let moved = window.gestures();
    let default = window.parameters.values()[SNARE_TUNE].default_plain_value();
    window.modifiers = Modifiers::COMMAND;
    window.key(Key::Z);
    assert_eq!(
        window.gestures(),
        [Gesture::Begin, Gesture::Set(default), Gesture::End].map(|gesture| (SNARE_TUNE, gesture))
    );
    window.modifiers = Modifiers::COMMAND | Modifiers::SHIFT;
    window.key(Key::Z);
    let last = moved[moved.len() - 2].1;
    assert_eq!(window.gestures()[1], (SNARE_TUNE, last));
}

#[test]
fn a_double_click_resets() {
    let mut window = Window::new();
    window.frame(Vec::new());
    for pressed in [true, false, true, false] {
        window.press(FIRST_KNOB, pressed);
    }
    let default = window.parameters.values()[SNARE_TUNE].default_plain_value();
    let reset = [Gesture::Begin, Gesture::Set(default), Gesture::End].map(|g| (SNARE_TUNE, g));
    assert_eq!(window.gestures(), reset);
}

#[test]
fn a_value_can_be_typed() {
    let mut window = Window::new();
    window.frame(Vec::new());
    window.type_value("250");
    assert!(window.strokes.is_empty());
    // Typed in Hz, stored in semitones.
    let tuned = parameters::parse_value(SNARE_TUNE, "250 Hz", &KitSpec::standard()).unwrap();
    assert_eq!(
        window.gestures(),
        [Gesture::Begin, Gesture::Set(tuned), Gesture::End].map(|gesture| (SNARE_TUNE, gesture))
    );
}

#[test]
fn what_is_typed_beyond_the_range_is_refused_and_can_be_given_up() {
    let mut window = Window::new();
    window.frame(Vec::new());
    window.type_value("9");
    assert!(window.gestures().is_empty(), "no snare is tuned to that");
    assert!(window.find("9").is_some(), "it is still there to be changed");
    window.key(Key::Escape);
    window.frame(Vec::new());
    let own = parameters::text(SNARE_TUNE, 0.0, &KitSpec::standard());
    assert!(window.find(&own).is_some(), "{:?}", window.texts);
}

#[test]
fn clicking_a_piece_in_the_list_shows_its_parameters() {
    let mut window = Window::new();
    window.frame(Vec::new());
    window.click(pos2(80.0, 60.0));
    window.gestures();
    for pressed in [true, false, true, false] {
        window.press(FIRST_KNOB, pressed);
    }
    let gestures = window.gestures();
    let kick_tune = parameters::slot_index(slot_of("kick"), SlotParameter::Tune);
    assert!(gestures.len() == 3 && gestures.iter().all(|&(index, _)| index == kick_tune), "{gestures:?}");
}

#[test]
fn a_window_opens_as_the_project_remembers_it() {
    let view = View { page: 1, light: true, piece: 6, camera: [1.0, 0.4, 2.0], zoom: 1.5 };
    let document = Arc::new(KitDocument::standard());
    let panels = Panels::new(no_presets(), view, document.clone());
    assert_eq!(panels.view(), view);
    let odd = View { page: 99, piece: 99, ..view };
    let panels = Panels::new(no_presets(), odd, document);
    assert_eq!((panels.view().page, panels.view().piece), (0, 8));
}
