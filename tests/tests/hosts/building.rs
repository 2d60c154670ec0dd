//! A kit built on the page *Build* of a window in a host, by the pointer alone.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::thread;
use std::time::{Duration, Instant};

use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear_cli::host::{Instance, with_fields};
use overhear_cli::player::Blocks;
use overhear_engine::kit_spec::KitSpec;

use crate::hand::{Hand, Met, listen};
use crate::score::{assert_same, notes, on_a_kit, peak, through_engine, through_plugin};
use crate::window::{PATIENCE, Parent};
use crate::{Stop, alone, instance};

const RATE: f64 = 48_000.0;

/// What the pointer does, line by line; a test of the editor does the same without a window.
const CLICKS: &str = include_str!("clicks.txt");

/// Longer than from one frame of a window that the processor draws to the next.
const FRAME: Duration = Duration::from_millis(450);

/// The kit of an instance's project.
fn kit_of(instance: &mut Instance) -> KitDocument {
    let mut kit = None;
    let state = instance.save_state().unwrap();
    let read = |fields: &mut serde_json::Map<String, serde_json::Value>| {
        kit = fields.get("kit").and_then(|text| text.as_str()).map(str::to_owned);
        Ok(())
    };
    with_fields(&state, read).unwrap();
    kit.map_or_else(KitDocument::standard, |text| kit_file::read("the project's kit", &text).unwrap())
}

/// Does one line.
fn act(hand: &Hand<'_>, line: &str) {
    let mut words = line.split_whitespace();
    let what = words.next();
    let numbers: Vec<i16> = words.map(|word| word.parse().unwrap()).collect();
    let (x, y) = (numbers[0], numbers[1]);
    hand.move_to((x, y));
    thread::sleep(FRAME);
    hand.press();
    thread::sleep(FRAME);
    if what == Some("drag") {
        for step in 1..=4 {
            hand.move_to((x + numbers[2] * step / 4, y + numbers[3] * step / 4));
            thread::sleep(FRAME / 2);
        }
        thread::sleep(FRAME);
    }
    hand.release();
    thread::sleep(FRAME);
}

#[test]
fn a_kit_is_built_by_clicks_alone_and_is_the_one_that_sounds() {
    let _turn = alone();
    let mut instance = instance();
    let (met, stop) = (Mutex::<Met>::default(), AtomicBool::new(false));
    let work = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let parent = Parent::around(instance);
        parent.wait_for_text(instance, "at first");
        let hand = Hand { parent: &parent };
        for line in CLICKS.lines().filter(|line| !line.starts_with('#')) {
            act(&hand, line);
            instance.answer();
        }
        let begun = Instant::now();
        while kit_of(instance).kit.find("kick-16x14").is_none() {
            assert!(begun.elapsed() < PATIENCE, "{:?}", kit_of(instance).kit.pieces);
            instance.answer();
            thread::sleep(Duration::from_millis(50));
        }
        instance.close_editor()
    };
    instance
        .run_beside(RATE, 1..=256, |processor| listen(processor, &met, &stop), work)
        .expect("it plays with a window");

    let document = kit_of(&mut instance);
    let kit = &document.kit;
    let names: Vec<&str> = kit.pieces.iter().map(|piece| piece.name.as_str()).collect();
    let expected =
        ["kick", "snare", "rack-tom", "floor-tom", "crash", "ride", "splash", "hi-hat", "kick-16x14"];
    assert_eq!(names, expected);
    let inches = |name: &str| {
        let drum = kit.find(name).unwrap().1.drum().unwrap();
        (drum.diameter / 0.0254 * 10.0).round() / 10.0
    };
    assert_eq!([inches("kick"), inches("kick-16x14"), inches("rack-tom")], [20.0, 16.0, 13.0]);
    assert_eq!(kit.find("rack-tom").unwrap().1.drum().unwrap().batter.plies, 1);
    let splash = |kit: &KitSpec| kit.find("splash").unwrap().1.place.centre;
    assert!(splash(kit)[0] > splash(&KitSpec::standard())[0] + 0.02);
    // What it says is what is heard, to the bit.
    let score = notes(RATE);
    let sound = through_plugin(&mut instance, &score, RATE, Blocks::Fixed(512));
    assert!(peak(&sound) > 0.01);
    assert_same(&sound, &on_a_kit(&document, &score, RATE), "the kit that was built");
    assert!(sound != through_engine(&score, RATE), "it is the standard kit that sounds");
}
