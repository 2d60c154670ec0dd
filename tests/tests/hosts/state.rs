//! What a project stores and gets back.

use overhear::parameters::{PARAMETERS, find, host_id};
use xtask::host::Instance;
use xtask::player::Blocks;

use crate::score::{Sound, assert_same, notes, through_plugin};
use crate::{alone, here, instance};

const RATE: f64 = 48_000.0;

fn play(instance: &mut Instance) -> Sound {
    through_plugin(instance, &notes(RATE), RATE, Blocks::Fixed(512))
}

fn set(instance: &mut Instance, values: &[(&str, f32)]) {
    let values: Vec<_> = values
        .iter()
        .map(|&(name, value)| {
            let parameter = &PARAMETERS[find(name).unwrap().0];
            (host_id(parameter.id), f64::from(parameter.normalized(value)))
        })
        .collect();
    instance.set_parameters(&values).unwrap();
}

fn changed() -> Instance {
    let mut instance = instance();
    let values = [("kick_tune", 61.5), ("snare_muffle", 0.7), ("ride_tune", 2.0), ("dynamics", 4.0)];
    set(&mut instance, &values);
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

/// States as earlier versions stored them, each with the values it was given.
const EARLIER: [(&str, &[(&str, f32)]); 1] = [(
    "state-23-parameters.bin",
    &[
        ("kktune", 62.38),
        ("snmuff", 0.7),
        ("rdtune", 6.0),
        ("dynam", 4.6),
        ("crlevl", -31.92),
        ("kkmuff", 0.3),
    ],
)];

#[test]
fn states_of_earlier_versions_bring_their_values_and_defaults_for_what_they_lack() {
    let _turn = alone();
    for (file, stored) in EARLIER {
        let bytes = std::fs::read(here("fixtures").join(file)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        // Something else before: a parameter that the state lacks must not stay.
        let mut instance = instance();
        set(
            &mut instance,
            &[("snare_preload", 1.0), ("crash_pan", 90.0), ("note_map", 2.0), ("kick_tune", 40.0)],
        );
        instance.load_state(&bytes).unwrap();
        for (parameter, found) in PARAMETERS.iter().zip(instance.parameters().unwrap()) {
            let known = stored.iter().find(|(id, _)| *id == parameter.id).map(|(_, value)| *value);
            let lacks = !text.contains(&format!("\"{}\"", parameter.id));
            if let Some(expected) = known.or(lacks.then_some(parameter.default)) {
                let expected = f64::from(parameter.normalized(expected));
                assert!(
                    (found.value - expected).abs() < 1e-5,
                    "{file}: {} is {}",
                    parameter.name,
                    found.value
                );
            }
        }
        // Stored again it is a state of this version and comes back to the byte.
        let again = instance.save_state().unwrap();
        instance.load_state(&again).unwrap();
        assert_eq!(instance.save_state().unwrap(), again);
    }
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
