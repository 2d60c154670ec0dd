//! Windows of other kits than the standard one: many pieces, one piece, another one while the window is open.

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::strike::Striker;

use super::*;
use overhear_player::midi_map::{Meaning, Row, Stroke as NoteStroke};

impl Window {
    /// A window of a kit.
    fn of(document: KitDocument) -> Window {
        let mut window = Window::new();
        window.load(document);
        window.frame(Vec::new());
        window
    }

    /// Another kit, as a state brings it.
    fn load(&mut self, document: KitDocument) {
        self.parameters.set_document(Arc::new(document)).unwrap();
    }

    /// The first stroke of a hand that clicks on some places of a piece, if one strikes it.
    fn strike(&mut self, slot: Slot) -> Option<Stroke> {
        self.strokes.clear();
        PLACES.into_iter().find_map(|(radius, angle)| {
            let at = self.place(slot, radius, angle);
            self.click(at);
            // What stands before it is struck in its stead.
            self.strokes.pop().filter(|stroke| stroke.slot == slot)
        })
    }
}

/// A piece like one of the standard kit under another name, elsewhere, its diameter changed by a factor.
fn like(name: &str, called: (&str, &str), centre: [f64; 3], factor: f64) -> PieceSpec {
    let mut piece = KitSpec::standard().find(name).unwrap().1.clone();
    (piece.name, piece.title) = (called.0.to_owned(), called.1.to_owned());
    piece.place.centre = centre;
    let widen = |cymbal: &mut CymbalSpec| {
        cymbal.diameter *= factor;
        cymbal.mass *= factor * factor;
    };
    match &mut piece.instrument {
        InstrumentSpec::Drum(drum) => drum.diameter *= factor,
        InstrumentSpec::Cymbal(cymbal) => widen(cymbal),
        InstrumentSpec::HiHat(hat) => [&mut hat.top, &mut hat.bottom].into_iter().for_each(widen),
    }
    piece
}

/// Two kicks, two snares, four toms, two crashes, ride, splash, small hats, timpani; of those that the standard notes do not
/// know only the second kick has a note of its own.
fn fourteen() -> KitDocument {
    let standard = KitSpec::standard();
    let pieces = vec![
        like("kick", ("kick", "Kick"), [-0.32, 0.30, -0.13], 1.0),
        like("kick", ("left-kick", "Left kick"), [0.32, 0.28, -0.13], 20.0 / 22.0),
        like("snare", ("snare", "Snare"), [-0.30, 0.66, -0.62], 1.0),
        like("snare", ("piccolo", "Piccolo"), [-0.80, 0.70, -0.62], 13.0 / 14.0),
        like("rack-tom", ("high-tom", "High tom"), [-0.42, 0.92, -0.12], 10.0 / 12.0),
        like("rack-tom", ("rack-tom", "Rack tom"), [-0.04, 0.92, -0.06], 1.0),
        like("rack-tom", ("low-tom", "Low tom"), [0.36, 0.90, -0.10], 13.0 / 12.0),
        like("floor-tom", ("floor-tom", "Floor tom"), [0.52, 0.62, -0.56], 1.0),
        like("crash", ("crash", "Crash"), [-0.74, 1.24, 0.10], 1.0),
        like("crash", ("right-crash", "Right crash"), [0.34, 1.30, 0.26], 18.0 / 16.0),
        like("ride", ("ride", "Ride"), [0.84, 1.06, -0.02], 1.0),
        like("splash", ("splash", "Splash"), [-0.20, 1.28, 0.16], 1.0),
        like("hi-hat", ("hats", "Hats"), [-1.06, 0.90, -0.36], 13.0 / 14.0),
        like("timpani", ("timpani", "Timpani"), [1.06, 0.78, -0.96], 1.0),
    ];
    let kit = KitSpec { pieces, ..standard };
    let (left_kick, _) = kit.find("left-kick").unwrap();
    let mut notes = overhear_player::midi_map::NoteTable::standard(&kit);
    let stroke = NoteStroke { slot: left_kick, radius: 0.2, angle: 0.0, striker: Striker::PlasticBeater };
    let row = Row::new("Left Kick", Meaning::Strikes(stroke));
    notes.set(33, Some(row));
    notes.set_ordinary(left_kick, Some(33));
    KitDocument { kit, notes }
}

/// One piece of the standard kit.
fn alone(name: &str) -> KitDocument {
    let kit = KitSpec::standard().alone(slot_of(name)).unwrap();
    KitDocument { notes: overhear_player::midi_map::NoteTable::standard(&kit), kit }
}

#[test]
fn any_kit_is_drawn_on_every_page_with_its_own_names() {
    for document in [fourteen(), alone("snare"), alone("timpani"), alone("hi-hat"), alone("crash")] {
        let mut window = Window::of(document.clone());
        for size in [vec2(800.0, 500.0), vec2(980.0, 640.0), vec2(1920.0, 1080.0)] {
            window.size = size;
            for (page, _) in Page::ALL {
                window.panels.open(page);
                window.frame(Vec::new());
                assert!(window.frame(Vec::new()) > 500, "{page:?} is empty");
                for piece in &document.kit.pieces {
                    assert!(window.find(&piece.title).is_some(), "{} is not listed on {page:?}", piece.title);
                }
                assert!(window.find("Timpani").is_some() == document.kit.find("timpani").is_some());
            }
        }
    }
}

#[test]
fn a_click_on_each_of_fourteen_pieces_strikes_its_slot() {
    let document = fourteen();
    let mut window = Window::of(document.clone());
    for (slot, piece) in document.kit.slots() {
        let stroke = window.strike(slot).unwrap_or_else(|| panic!("{} cannot be struck", piece.name));
        // The panel below is about it.
        assert_eq!(usize::from(window.panels.view().piece), slot.index());
        let wanted = match &*piece.name {
            "kick" => Striker::FeltBeater,
            "left-kick" => Striker::PlasticBeater,
            "timpani" => Striker::TimpaniMallet,
            // Without a note of its own it is struck with a stick.
            "piccolo" | "high-tom" | "low-tom" => Striker::Stick,
            _ => continue,
        };
        assert_eq!(stroke.strike.striker, wanted, "{}", piece.name);
    }
    assert!(window.gestures.is_empty());
    // Every one has its knobs: the second snare wires, the hats a pedal.
    for (name, label) in [("piccolo", "Wires"), ("hats", "Pedal")] {
        let title = &document.kit.find(name).unwrap().1.title;
        window.click_on(title);
        assert!(window.find(label).is_some(), "{name} has no {label}");
    }
    window.click_on("High tom");
    assert!(window.find("Wires").is_none() && window.find("Pedal").is_none());
}

#[test]
fn a_piece_alone_is_large_and_can_be_struck() {
    for (slot, piece) in KitSpec::standard().slots() {
        let mut window = Window::of(alone(&piece.name));
        let only = Slot::ALL[0];
        let stroke = window.strike(only).unwrap_or_else(|| panic!("{} cannot be struck", piece.name));
        assert_eq!(stroke.slot, only);
        let [left, right] = [-1.57, 1.57].map(|angle| window.place(only, 1.0, angle));
        let mut whole = Window::new();
        whole.frame(Vec::new());
        let [from, to] = [-1.57, 1.57].map(|angle| whole.place(slot, 1.0, angle));
        assert!(left.distance(right) > 1.3 * from.distance(to), "{} is small", piece.name);
    }
}

#[test]
fn another_kit_may_come_while_the_window_is_open() {
    let mut window = Window::of(fourteen());
    window.click_on("Timpani");
    window.drag(FIRST_KNOB, vec2(0.0, -40.0), PointerButton::Primary);
    assert!(!window.gestures().is_empty());
    for piece in &mut window.snapshot.pieces {
        (piece.ready, piece.strike.count) = (true, 3);
    }
    window.snapshot.clock = 1;
    window.panels.open(Page::Physics);
    window.frame(Vec::new());
    window.load(alone("snare"));
    window.frame(Vec::new());
    assert_eq!(window.panels.view().piece, 0, "the piece that was looked at is gone");
    assert!(window.find("Snare").is_some() && window.find("Timpani").is_none());
    // Steps of another kit are not taken back, and its strokes are no news.
    window.modifiers = Modifiers::COMMAND;
    window.key(Key::Z);
    window.modifiers = Modifiers::NONE;
    assert!(window.gestures().is_empty());
    assert!(window.find("No stroke yet. Click a head or a cymbal").is_some(), "{:?}", window.texts);
    window.panels.open(Page::Kit);
    window.frame(Vec::new());
    assert!(window.strike(Slot::ALL[0]).is_some());
    // And back to many.
    window.load(fourteen());
    for (page, _) in Page::ALL {
        window.panels.open(page);
        window.frame(Vec::new());
    }
    assert!(window.find("Left kick").is_some());
}
