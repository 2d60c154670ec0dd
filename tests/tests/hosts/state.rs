//! What a project stores and gets back.

use overhear::parameters::{PARAMETERS, find};
use xtask::host::{Instance, parameter_id};
use xtask::player::Blocks;

use crate::score::{Sound, assert_same, notes, through_plugin};
use crate::{alone, instance};

const RATE: f64 = 48_000.0;

fn play(instance: &mut Instance) -> Sound {
    through_plugin(instance, &notes(RATE), RATE, Blocks::Fixed(512))
}

fn set(instance: &mut Instance, values: &[(&str, f32)]) {
    let values: Vec<_> = values
        .iter()
        .map(|&(name, value)| {
            let parameter = &PARAMETERS[find(name).unwrap().0];
            (parameter_id(parameter.id), f64::from(parameter.normalized(value)))
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
