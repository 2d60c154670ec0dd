//! State that a project stores and restores.

use overhear::parameters::{COUNT, SlotParameter, parameters, slot_parameter};
use overhear_cli::host::Instance;
use overhear_cli::player::Blocks;

use crate::score::{Sound, assert_same, notes, through_plugin};
use crate::{alone, as_hosts_have_it, here, instance, setting};

const RATE: f64 = 48_000.0;

fn play(instance: &mut Instance) -> Sound {
    through_plugin(instance, &notes(RATE), RATE, Blocks::Fixed(512))
}

fn set(instance: &mut Instance, values: &[&str]) {
    let values: Vec<_> = values.iter().map(|text| as_hosts_have_it(setting(text))).collect();
    instance.set_parameters(&values).unwrap();
}

fn changed() -> Instance {
    let mut instance = instance();
    set(&mut instance, &["kick_tune=61.5", "snare_muffle=0.7", "ride_tune=2", "dynamics=4"]);
    instance
}

#[test]
fn a_saved_state_brings_back_every_value_and_sample() {
    let _turn = alone();
    let mut saved = changed();
    let state = saved.save_state().unwrap();
    let mut restored = instance();
    restored.load_state(&state).unwrap();
    assert_eq!(restored.parameters().unwrap(), saved.parameters().unwrap());
    let sound = play(&mut saved);
    assert!(sound != play(&mut instance()), "the values are not heard");
    assert_same(&play(&mut restored), &sound, "restored");
    assert_eq!(restored.save_state().unwrap(), state, "saved again");
}

#[test]
fn a_state_loaded_between_two_takes_acts_in_the_second() {
    let _turn = alone();
    let state = changed().save_state().unwrap();
    let expected = play(&mut changed());
    let mut instance = instance();
    play(&mut instance);
    instance.load_state(&state).unwrap();
    assert_same(&play(&mut instance), &expected, "the second take");
}

#[test]
fn a_broken_state_is_refused_and_nothing_is_lost() {
    let _turn = alone();
    let mut instance = changed();
    let state = instance.save_state().unwrap();
    let expected = play(&mut instance);
    let before = instance.parameters().unwrap();
    let broken: [&[u8]; 6] = [
        b"",
        b"\0",
        b"not a state at all, but some bytes of text",
        &[0xFF; 4096],
        &state[..state.len() / 2],
        &state[1..],
    ];
    for bytes in broken {
        assert!(instance.load_state(bytes).is_err(), "{} bytes are taken", bytes.len());
        assert_eq!(instance.parameters().unwrap(), before);
    }
    assert_same(&play(&mut instance), &expected, "after six broken states");
    instance.load_state(&state).unwrap();
}

/// A state of the first schema, in which drums were tuned in Hz and every piece had ids of its own.
const EARLIER: &str = "state-23-parameters.bin";

/// What it was given, as it is called now. Its other parameters were where they stood then.
const STORED: [&str; 12] = [
    "kick_tune=62.38 Hz",
    "kick_muffle=0.3",
    "snare_tune=220 Hz",
    "snare_muffle=0.7",
    "snare_level=-7",
    "rack_tom_tune=140 Hz",
    "floor_tom_tune=82 Hz",
    "floor_tom_level=0",
    "crash_level=-31.92",
    "ride_tune=6 st",
    "master_level=-5",
    "dynamics=4.6",
];

/// The pieces that it knows; the parameters of each are these three.
const PIECES_STORED: usize = 7;
const KINDS_STORED: [SlotParameter; 3] = [SlotParameter::Tune, SlotParameter::Muffle, SlotParameter::Level];

#[test]
fn a_state_of_an_earlier_version_brings_its_values_and_defaults_for_what_it_lacks() {
    let _turn = alone();
    let bytes = std::fs::read(here("fixtures").join(EARLIER)).unwrap();
    // Something else before: a parameter that the state lacks must not stay.
    let mut instance = instance();
    set(&mut instance, &["snare_preload=1", "crash_pan=90", "note_map=yamaha", "kick_tune=40"]);
    instance.load_state(&bytes).unwrap();
    let stored = STORED.map(setting);
    let mut lacking = 0;
    for (index, found) in instance.parameters().unwrap()[..COUNT].iter().enumerate() {
        let known = stored.iter().find(|(known, _)| *known == index).copied();
        let lacks = !slot_parameter(index)
            .is_some_and(|(slot, what)| slot.index() < PIECES_STORED && KINDS_STORED.contains(&what));
        let default = (index, parameters()[index].default);
        lacking += usize::from(lacks && known.is_none());
        if let Some(expected) = known.or(lacks.then_some(default)) {
            let (_, expected) = as_hosts_have_it(expected);
            assert!((found.value - expected).abs() < 1e-5, "{} is {}", found.name, found.value);
        }
    }
    assert_eq!(lacking, COUNT - 23);
    // Stored again it is a state of this version and comes back to the byte.
    let again = instance.save_state().unwrap();
    instance.load_state(&again).unwrap();
    assert_eq!(instance.save_state().unwrap(), again);
}

#[test]
fn assignments_of_notes_travel_with_the_state() {
    let _turn = alone();
    let mut instance = instance();
    let state = String::from_utf8(instance.save_state().unwrap()[8..].to_vec()).unwrap();
    let json = state.replace("\"notes\":\"\"", "\"notes\":\"60=silent 61=36\"");
    assert!(json != state, "{state}");
    let bytes = [&(json.len() as u64).to_le_bytes()[..], json.as_bytes()].concat();
    instance.load_state(&bytes).unwrap();
    assert_eq!(instance.save_state().unwrap(), bytes);
    let sound = |instance: &mut Instance, key| {
        let score = vec![(0, crate::score::Happening::Note(key, 100))];
        through_plugin(instance, &score, RATE, Blocks::Fixed(512))
    };
    assert_eq!(crate::score::peak(&sound(&mut instance, 60)), 0.0);
    let kick = sound(&mut instance, 36);
    assert_same(&sound(&mut instance, 61), &kick, "an assigned kick");
}
