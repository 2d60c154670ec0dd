//! Pages used by hand: strokes that are heard, notes that are learned, presets that are saved, windows of every size.

use std::collections::BTreeMap;

use overhear_engine::slot::SLOTS;

use super::*;
use overhear_player::building::Pace;
use overhear_player::midi::assignments::Assignment;
use overhear_player::performer::Performer;
use overhear_player::strokes::strokes;

/// Sample rate, Hz.
const RATE: f64 = 48_000.0;

/// What became of a stroke.
struct Recorded {
    strikes: [u32; SLOTS],
    snapshot: KitSnapshot,
    loudest: f32,
}

/// Plays a stroke as the audio thread does, for a tenth of a second.
fn hear(performer: &mut Performer, stroke: Stroke) -> Recorded {
    let counts = |performer: &mut Performer| {
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        (snapshot.pieces.map(|piece| piece.strike.count), snapshot)
    };
    let (before, _) = counts(performer);
    let (strokes, mut waiting) = strokes();
    strokes.play(stroke);
    waiting.deliver(performer);
    let (mut left, mut right) = (vec![0.0; 4_800], vec![0.0; 4_800]);
    performer.render(&mut left, &mut right);
    let (after, snapshot) = counts(performer);
    let loudest = left.iter().chain(&right).fold(0.0_f32, |most, sample| most.max(sample.abs()));
    Recorded { strikes: std::array::from_fn(|slot| after[slot] - before[slot]), snapshot, loudest }
}

#[test]
fn what_is_clicked_is_heard_from_that_piece_at_that_place() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let (document, assignments) = (KitDocument::standard(), window.parameters.assignments());
    let mut performer = Performer::new(RATE, &document, assignments);
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    for (slot, piece) in KitSpec::standard().slots() {
        let (at, piece) = (slot.index(), &piece.name);
        let stroke = PLACES.into_iter().find_map(|(radius, angle)| {
            window.click(window.place(slot, radius, angle));
            // What stands before it is struck in its stead.
            window.strokes.pop().filter(|stroke| stroke.slot == slot)
        });
        let stroke = stroke.unwrap_or_else(|| panic!("{piece} cannot be clicked"));
        let heard = hear(&mut performer, stroke);
        let only: [u32; SLOTS] = std::array::from_fn(|other| u32::from(other == at));
        assert_eq!(heard.strikes, only, "{piece}");
        let strike = heard.snapshot.pieces[at].strike;
        let asked = (stroke.strike.radius as f32, stroke.strike.angle as f32);
        assert_eq!((strike.radius, strike.angle), asked, "{piece}");
        assert!(heard.loudest > 1e-3, "{piece} is not heard: {}", heard.loudest);
        let peaks = heard.snapshot.pieces.map(|piece| piece.peak);
        let most = peaks.iter().copied().fold(0.0, f32::max);
        assert_eq!(peaks[at], most, "{piece} is softer than what only hears it: {peaks:?}");
        performer.reset();
    }
}

#[test]
fn a_note_is_learned_by_clicks_and_given_back_by_one() {
    let mut window = Window::new();
    window.panels.open(Page::Midi);
    window.frame(Vec::new());
    window.click_on("Ride Bell");
    window.click_on("Learn");
    assert_eq!(window.parameters.assignments().learning(), Some(53));
    assert!(window.find("Strike the pad that should play Ride Bell").is_some());
    // A pad is struck: the audio thread takes its note, the page shows it.
    window.parameters.assignments().heard(20);
    window.frame(Vec::new());
    let learned = BTreeMap::from([(20, Assignment::Plays(53))]);
    assert_eq!(window.parameters.assignments().changed(), learned);
    assert!(window.find("20").is_some() && window.find("learned").is_some());
    window.click_on("learned");
    assert!(window.parameters.assignments().changed().is_empty());
    // What is begun can be given up.
    window.click_on("Learn");
    window.click_on("Cancel");
    assert_eq!(window.parameters.assignments().learning(), None);
    assert!(window.gestures.is_empty() && window.strokes.is_empty());
}

/// Moves the focus by the Tab key until it is on a text, and presses Space.
fn press(window: &mut Window, text: &str) {
    let place = window.find(text).unwrap_or_else(|| panic!("there is no `{text}`"));
    for _ in 0..200 {
        window.key(Key::Tab);
        window.frame(Vec::new());
        let focused = window.context.memory(|memory| memory.focused());
        let rect = focused.and_then(|id| window.context.read_response(id)).map(|response| response.rect);
        if rect.is_some_and(|rect| rect.contains(place)) {
            window.key(Key::Space);
            window.frame(Vec::new());
            return;
        }
    }
    panic!("no key leads to `{text}`");
}

#[test]
fn pads_and_a_pedal_are_calibrated_by_the_keyboard_alone_and_it_is_undone() {
    use overhear_player::midi::calibration::Learned;
    use overhear_player::midi::learning::MidiMessage;

    let mut window = Window::new();
    window.panels.open(Page::Midi);
    window.frame(Vec::new());
    press(&mut window, "Calibration");
    press(&mut window, "Learn a pad");
    assert!(window.find("0 strokes so far, of at least 4 that differ").is_some());
    let monitor = |window: &Window, message| {
        window.parameters.monitor().write(0, 9, message);
        window.parameters.monitor().advance(24_000);
    };
    for velocity in [12, 60, 100, 62, 20] {
        monitor(&window, MidiMessage::Note(38, velocity));
    }
    window.frame(Vec::new());
    window.frame(Vec::new());
    assert!(window.find("note 38 velocity 100").is_some(), "the monitor shows what arrives");
    press(&mut window, "Keep");
    let learned = |window: &Window| window.parameters.assignments().calibration().learned();
    let pad = learned(&window).pads[&38];
    assert_eq!((pad.low, pad.high), (12, 100));

    press(&mut window, "Learn the pedal");
    for value in [120, 120, 80, 30, 10, 10, 60, 120, 50, 10, 90, 120] {
        monitor(&window, MidiMessage::Controller(4, value));
    }
    window.frame(Vec::new());
    window.frame(Vec::new());
    press(&mut window, "Keep");
    let pedal = learned(&window).pedal.unwrap();
    assert_eq!((pedal.up, pedal.down), (120, 10), "inverted");
    // What a project stores brings it back.
    let fields = nice_plug::params::Params::serialize_fields(&window.parameters);
    let restored = HostParameters::default();
    nice_plug::params::Params::deserialize_fields(&restored, &fields);
    assert_eq!(restored.assignments().calibration().learned(), learned(&window));
    // Undone one by one, and done again.
    window.frame(Vec::new());
    press(&mut window, "Undo");
    assert_eq!(learned(&window).pedal, None);
    press(&mut window, "Undo");
    assert_eq!(learned(&window), Learned::default());
    press(&mut window, "Redo");
    assert_eq!(learned(&window).pads[&38], pad);
}

/// A folder that is gone in the end.
struct Folder(std::path::PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let folder = std::env::temp_dir().join(format!("overhear-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_preset_is_saved_loaded_renamed_and_deleted_by_clicks() {
    let folder = Folder::new("presets-by-clicks");
    let library = Library::at(&folder.0);
    let mut window = Window::with(library.clone());
    // Wide enough for every button of the bar.
    window.size = vec2(1200.0, 700.0);
    window.frame(Vec::new());
    let knob = pos2(235.0, window.size.y - 82.0);
    window.drag(knob, vec2(0.0, -40.0), PointerButton::Primary);
    let Some((index, Gesture::Set(tuned))) = window.obey().into_iter().rev().nth(1) else {
        panic!("no drag")
    };
    window.click_on("Save");
    window.enter("my kit 1");
    assert!(window.strokes.is_empty(), "what is typed strikes nothing");
    let saved = library.load("my kit 1").expect("it is saved");
    assert_eq!(saved.value(index, &KitSpec::standard()), Some(tuned));

    // Another is chosen: what it has elsewhere moves, each by a gesture of the host's.
    window.click_on("my kit 1");
    window.click_on("jazz");
    let moved = window.obey();
    let whole = moved.chunks(3).all(|gesture| {
        let [(a, Gesture::Begin), (b, Gesture::Set(_)), (c, Gesture::End)] = gesture else { return false };
        a == b && b == c
    });
    assert!(!moved.is_empty() && whole, "{moved:?}");

    // Back to the saved one.
    window.click_on("jazz");
    window.click_on("my kit 1");
    let moved = window.obey();
    assert!(moved.contains(&(index, Gesture::Set(tuned))), "{moved:?}");
    assert_eq!(window.parameters.values()[index].unmodulated_plain_value(), tuned);

    window.click_on("Rename");
    window.enter(" of mine");
    let names = || library.list().into_iter().map(|entry| entry.name).collect::<Vec<_>>();
    assert!(names().iter().any(|name| name.contains("of mine")) && !names().contains(&"my kit 1".to_owned()));
    window.click_on("Delete");
    assert!(names().iter().all(|name| !name.contains("mine")), "{:?}", names());
}

#[test]
fn everything_stays_in_its_window_at_every_size() {
    for size in [vec2(800.0, 500.0), vec2(1080.0, 700.0), vec2(1920.0, 1080.0)] {
        for page in Page::ALL {
            let mut window = Window::new();
            window.size = size;
            window.panels.open(page.0);
            window.frame(Vec::new());
            window.frame(Vec::new());
            let whole = Rect::from_min_size(Pos2::ZERO, size);
            for name in ["Kit", "Physics", "Mix", "MIDI", "Settings", "Save", "Undo", "Main"] {
                let place = window.find(name).unwrap_or_else(|| panic!("{name} is gone at {size}"));
                assert!(whole.contains(place), "{name} is at {place} of {size} on {:?}", page.0);
            }
            // Pages are reached by a click at every size.
            window.click_on("Settings");
            assert_eq!(window.panels.view().page, 5);
        }
    }
}

/// Tests in hosts click there: a window is all they have.
#[test]
fn the_snare_is_where_hands_of_other_tests_find_it() {
    let mut window = Window::new();
    window.frame(Vec::new());
    let (found, known) = (window.place(slot_of("snare"), 0.0, 0.0), pos2(437.0, 286.0));
    assert!((found - known).length() < 12.0, "it is at {found}");
}

#[test]
fn a_microphone_that_is_dragged_moves_its_pair_by_gestures_of_the_host() {
    use overhear_engine::kit::Microphone;
    use overhear_player::parameters::{Stand, find, parameters};
    use overhear_player::placing::index_of;

    let mut window = Window::new();
    window.size = vec2(1080.0, 700.0);
    window.panels.open(Page::Microphones);
    window.frame(Vec::new());
    let before = window.panels.kit_view().camera;
    // It stands under its name.
    let at = window.find("overhead right").expect("its name") + vec2(0.0, 19.0);
    window.drag(at, vec2(24.0, -30.0), PointerButton::Primary);
    let gestures = window.obey();
    let of = |stand| index_of(Microphone::Overheads, stand).unwrap();
    let (height, depth, width) = (of(Stand::Height), of(Stand::Depth), of(Stand::Width));
    assert_eq!(height, find("overheads_height", &KitSpec::standard()).unwrap());
    let last = |index: usize| window.parameters.values()[index].unmodulated_plain_value();
    assert!(last(height) > 5.0 && last(width) > 102.0, "{} cm, {} %", last(height), last(width));
    assert_eq!(last(depth), parameters()[depth].default);
    for index in [height, depth, width] {
        let own: Vec<_> =
            gestures.iter().filter(|(of, _)| *of == index).map(|(_, gesture)| *gesture).collect();
        assert_eq!((own.first(), own.last()), (Some(&Gesture::Begin), Some(&Gesture::End)), "{own:?}");
        let middle = &own[1..own.len() - 1];
        assert!(middle.iter().all(|gesture| matches!(gesture, Gesture::Set(_))), "{own:?}");
    }
    assert!(gestures.iter().all(|(index, _)| [height, depth, width].contains(index)));
    assert!(window.strokes.is_empty() && window.panels.kit_view().camera == before, "it strikes or turns");
    // Undone in one step.
    window.modifiers = Modifiers::COMMAND;
    window.key(Key::Z);
    window.obey();
    let (up, wide) = (&window.parameters.values()[height], &window.parameters.values()[width]);
    assert_eq!((up.unmodulated_plain_value(), wide.unmodulated_plain_value()), (0.0, 100.0));
}
