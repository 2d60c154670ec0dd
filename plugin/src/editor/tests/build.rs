//! The page Build used by clicks, drags and keys alone.

use super::*;
use overhear_player::kit_edits::sizes::Size;

impl Window {
    /// A window with the page open, whose files are in a folder of its own.
    fn building(folder: &std::path::Path) -> Window {
        let mut window = Window::with(Library::at(&folder.join("presets")));
        window.panels.open(Page::Build);
        window.frame(Vec::new());
        window.frame(Vec::new());
        window
    }

    /// One with a kit that is built.
    fn here() -> Window {
        let mut window = Window::building(std::path::Path::new("no-such-folder"));
        window.snapshot.pieces.iter_mut().for_each(|piece| piece.ready = true);
        window.frame(Vec::new());
        window
    }

    /// Looks an instrument up and chooses it.
    fn look_up(&mut self, name: &str) {
        let search = self.find("Search").expect("the field of the search");
        self.click(search);
        self.frame(vec![Event::Text(name.to_owned())]);
        self.frame(Vec::new());
        // The field has the name as well, and is drawn first.
        self.click_on(name);
    }

    fn kit(&self) -> KitSpec {
        self.parameters.document().kit.clone()
    }

    fn says(&self, part: &str) -> bool {
        self.texts.iter().any(|(text, _)| text.contains(part))
    }
}

#[test]
fn a_kit_is_built_by_clicks_alone_and_each_of_them_can_be_undone() {
    let mut window = Window::here();
    let before = window.parameters.document();
    window.look_up("crash-18-thin");
    window.click_on("Add");
    let added = window.parameters.document();
    assert_eq!(added.kit.pieces.len(), 10);
    assert_eq!(usize::from(window.panels.view().piece), 9, "the new piece is selected");
    assert!(added.notes.ordinary(Slot::ALL[9]).is_some(), "it has a note");
    window.obey();
    window.click_on("Duplicate");
    assert_eq!(window.kit().pieces.len(), 11);
    window.click_on("Remove");
    window.click_on("Remove");
    assert_eq!(window.kit().pieces.len(), 9);
    for _ in 0..4 {
        window.click_on("Undo");
        window.obey();
    }
    assert_eq!(*window.parameters.document(), *before);
    window.click_on("Redo");
    assert_eq!(*window.parameters.document(), *added);
    // A strip of its own in the mixer.
    window.panels.open(Page::Mix);
    window.frame(Vec::new());
    assert!(window.find("Crash 18 thin").is_some(), "{:?}", window.texts);
}

#[test]
fn a_piece_is_swapped_and_keeps_its_level() {
    let mut window = Window::here();
    window.click_on("Snare");
    let snare = slot_of("snare");
    let level = parameters::slot_index(snare, SlotParameter::Level);
    let tune = parameters::slot_index(snare, SlotParameter::Tune);
    window.gestures =
        [(level, -9.0), (tune, 3.0)].into_iter().map(|(index, value)| (index, Gesture::Set(value))).collect();
    window.obey();
    window.look_up("piccolo-13");
    window.click_on("Swap");
    window.obey();
    let kit = window.kit();
    assert_eq!((kit.pieces.len(), kit.piece(snare).unwrap().name.as_str()), (9, "snare"));
    assert!((kit.piece(snare).unwrap().drum().unwrap().diameter - 0.3302).abs() < 1e-9);
    let plain = |index: usize| window.parameters.values()[index].unmodulated_plain_value();
    assert_eq!((plain(level), plain(tune)), (-9.0, 0.0));
    window.click_on("Undo");
    window.obey();
    assert_eq!(window.kit(), KitSpec::standard());
    assert_eq!(window.parameters.values()[tune].unmodulated_plain_value(), 3.0);
}

#[test]
fn whole_kits_are_compared_by_a_and_b() {
    let mut window = Window::here();
    window.click_on("A");
    window.click_on("Whole kits");
    window.click_on("bebop");
    let bebop = window.parameters.document();
    assert_ne!(bebop.kit, KitSpec::standard());
    window.obey();
    window.click_on("B");
    assert_eq!(window.kit(), KitSpec::standard());
    window.click_on("A");
    assert_eq!(*window.parameters.document(), *bebop);
}

#[test]
fn pieces_are_moved_by_hand_and_by_arrow_keys_and_not_into_one_another() {
    let mut window = Window::here();
    // It is not the selected one, so that the last text of its name is the one on the floor.
    let crash = window.find("Crash").unwrap();
    let place = |window: &Window| window.kit().find("crash").unwrap().1.place.centre;
    let before = place(&window);
    window.drag(crash, vec2(-12.0, -9.0), PointerButton::Primary);
    let after = place(&window);
    assert!(after[0] < before[0] && after[2] > before[2] && after[1] == before[1], "{before:?} {after:?}");
    window.key(Key::ArrowRight);
    assert!((place(&window)[0] - after[0] - 0.02).abs() < 1e-9);
    // The floor tom into the snare.
    window.frame(Vec::new());
    let tom = window.find("Floor tom").unwrap();
    let snare = window.find("Snare").unwrap();
    let kit = window.kit();
    window.drag(tom, snare - tom, PointerButton::Primary);
    window.frame(Vec::new());
    assert_eq!(window.kit(), kit, "the kit that sounds is untouched");
    assert!(window.says("inside `snare`, accepted:"), "{:?}", window.texts);
}

#[test]
fn sizes_are_typed_or_dragged_in_inches_and_millimetres_and_parts_come_from_lists() {
    let mut window = Window::here();
    window.click_on("Rack tom");
    let tom = |window: &Window| window.kit().find("rack-tom").unwrap().1.clone();
    let enter = |window: &mut Window, shown: &str, text: &str| {
        window.click_on(shown);
        window.modifiers = Modifiers::COMMAND;
        window.key(Key::A);
        window.modifiers = Modifiers::NONE;
        window.enter(text);
    };
    enter(&mut window, "12 in", "13");
    assert!((Size::Diameter.of(&tom(&window)).unwrap() - 0.3302).abs() < 1e-9);
    window.click_on("mm");
    window.frame(Vec::new());
    assert!(window.find("330.2 mm").is_some(), "{:?}", window.texts);
    enter(&mut window, "330.2 mm", "2000");
    assert!(window.says("accepted:") && window.says("Take "), "{:?}", window.texts);
    assert!((Size::Diameter.of(&tom(&window)).unwrap() - 0.3302).abs() < 1e-9);
    let (take, _) = window.texts.iter().find(|(text, _)| text.starts_with("Take ")).unwrap().clone();
    window.click_on(&take);
    assert!(Size::Diameter.of(&tom(&window)).unwrap() > 0.35);
    window.click_on("Undo");
    // The list of heads.
    window.click_on("Clear, two plies of 0.18 mm");
    window.click_on("Coated, one ply of 0.25 mm");
    assert_eq!(tom(&window).drum().unwrap().batter.plies, 1);
}

#[test]
fn kits_and_pieces_are_saved_and_opened_again() {
    let folder = std::env::temp_dir().join(format!("overhear-build-{}", std::process::id()));
    let mut window = Window::building(&folder);
    window.snapshot.pieces.iter_mut().for_each(|piece| piece.ready = true);
    let name = |window: &mut Window, old: &str, name: &str| {
        window.click_on(old);
        window.modifiers = Modifiers::COMMAND;
        window.key(Key::A);
        window.modifiers = Modifiers::NONE;
        window.frame(vec![Event::Text(name.to_owned())]);
        window.frame(Vec::new());
    };
    let hint = "Name of a kit file, or its path";
    window.click_on("Ride");
    window.click_on("Remove");
    window.obey();
    let without = window.parameters.document();
    name(&mut window, hint, "mine");
    window.click_on("Save kit");
    assert!(window.says("Saved as"), "{:?}", window.texts);
    // In the list beside the page: on the floor the tom hangs over it.
    let (_, listed) = window.texts.iter().find(|(text, _)| text == "Kick").unwrap().clone();
    window.click(listed.center());
    name(&mut window, "mine", "my-kick");
    window.click_on("Save piece");
    window.click_on("Add pieces");
    assert_eq!(window.kit().pieces.len(), 9);
    assert!(window.kit().find("kick-2").is_some());
    name(&mut window, "my-kick", "mine");
    window.click_on("Open kit");
    assert_eq!(*window.parameters.document(), *without);
    name(&mut window, "mine", "nobody");
    window.click_on("Open kit");
    assert!(window.says("cannot be read"), "{:?}", window.texts);
    let _ = std::fs::remove_dir_all(folder);
}

#[test]
fn a_seventeenth_piece_is_refused_in_words() {
    let mut window = Window::here();
    window.click_on("Splash");
    for _ in 9..16 {
        window.click_on("Duplicate");
        window.obey();
    }
    assert_eq!(window.kit().pieces.len(), 16);
    window.click_on("Duplicate");
    assert_eq!(window.kit().pieces.len(), 16);
    assert!(window.says("pieces would be 17, accepted: 1 to 16"), "{:?}", window.texts);
    // All pages have room for them.
    for (page, _) in Page::ALL {
        window.panels.open(page);
        window.frame(Vec::new());
    }
}

#[test]
fn what_is_being_built_is_told_until_it_is() {
    let mut window = Window::here();
    assert!(!window.says("Building"), "{:?}", window.texts);
    window.building = Some(slot_of("crash"));
    window.frame(Vec::new());
    assert!(window.find("Building Crash").is_some(), "{:?}", window.texts);
    window.building = None;
    window.frame(Vec::new());
    assert!(!window.says("Building"), "{:?}", window.texts);
}

#[test]
fn bells_rims_hammering_and_uneven_lugs_are_switched_and_drawn_again() {
    let mut window = Window::here();
    window.click_on("Crash");
    let crash = |window: &Window| match window.kit().find("crash").unwrap().1.instrument {
        overhear_engine::kit_spec::InstrumentSpec::Cymbal(cymbal) => cymbal,
        _ => unreachable!("a crash is a cymbal"),
    };
    let before = crash(&window);
    // The box beside the name.
    let switch = |window: &mut Window, name: &str| {
        let (_, name) = window.texts.iter().find(|(text, _)| text == name).expect("a switch").clone();
        window.click(pos2(name.min.x + 118.0, name.center().y));
        window.frame(Vec::new());
    };
    switch(&mut window, "With a bell");
    assert_eq!((crash(&window).bell, window.find("Bell height")), (None, None));
    switch(&mut window, "With a bell");
    assert_eq!(crash(&window), before);
    switch(&mut window, "China rim");
    assert!(crash(&window).flange.is_some() && window.find("Rim turns up").is_some());
    window.click_on("Another one");
    let seed = |cymbal: overhear_engine::cymbal::CymbalSpec| cymbal.hammering.unwrap().seed;
    assert_eq!(seed(crash(&window)), seed(before) + 1);
    window.click_on("Undo");
    window.click_on("Undo");
    assert_eq!(crash(&window), before);
}

#[test]
fn a_size_is_refused_below_its_field_and_not_elsewhere() {
    let mut window = Window::here();
    window.click_on("Crash");
    window.click_on("16 in");
    window.modifiers = Modifiers::COMMAND;
    window.key(Key::A);
    window.modifiers = Modifiers::NONE;
    window.enter("80");
    let place = |text: &str| window.texts.iter().find(|(found, _)| found.contains(text)).map(|found| found.1);
    let (name, words, next) = (place("Diameter"), place("accepted:"), place("Weight"));
    let [name, words, next] = [name, words, next].map(|place| place.expect("it is shown"));
    assert!(name.max.y < words.min.y && words.max.y < next.min.y, "{name:?} {words:?} {next:?}");
}

/// What the hosts' test does with the pointer, and so what it comes to.
#[test]
fn the_clicks_of_the_hosts_test_build_the_kit_that_it_expects() {
    let clicks = include_str!("../../../../tests/tests/hosts/clicks.txt");
    let mut window = Window::new();
    window.snapshot.pieces.iter_mut().for_each(|piece| piece.ready = true);
    window.frame(Vec::new());
    for line in clicks.lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers: Vec<f32> = words[1..].iter().map(|word| word.parse().unwrap()).collect();
        match (words[0], &numbers[..]) {
            ("click", &[x, y]) => window.click(pos2(x, y)),
            ("drag", &[x, y, right, down]) => {
                window.drag(pos2(x, y), vec2(right, down), PointerButton::Primary);
            }
            _ => panic!("{line}"),
        }
        window.obey();
        window.frame(Vec::new());
        window.frame(Vec::new());
    }
    let kit = window.kit();
    let names: Vec<&str> = kit.pieces.iter().map(|piece| piece.name.as_str()).collect();
    let expected =
        ["kick", "snare", "rack-tom", "floor-tom", "crash", "ride", "splash", "hi-hat", "kick-16x14"];
    assert_eq!(names, expected, "{:?}", window.texts);
    let drum = |name: &str| kit.find(name).unwrap().1.drum().unwrap();
    let inches = |name: &str| (drum(name).diameter / 0.0254 * 10.0).round() / 10.0;
    assert_eq!([inches("kick"), inches("rack-tom"), inches("kick-16x14")], [20.0, 13.0, 16.0]);
    assert_eq!(drum("rack-tom").batter.plies, 1);
    let splash = |kit: &KitSpec| kit.find("splash").unwrap().1.place.centre;
    assert!(splash(&kit)[0] > splash(&KitSpec::standard())[0] + 0.02);
}
