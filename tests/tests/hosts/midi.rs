//! Notes, controllers and chokes through the built plugin.

use std::sync::Arc;

use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::midi::maps::NoteMap;
use overhear::midi_map::Meaning;
use overhear::parameters::{COUNT, default_value, find, parameters};
use overhear::performer::Performer;
use overhear::presets::{FACTORY, Preset};
use overhear_cli::host::{Event, Instance, What};
use overhear_engine::kit_spec::KitSpec;

use crate::score::{Sound, assert_same, peak};
use crate::{alone, as_hosts_have_it, instance, setting};

const RATE: f64 = 48_000.0;

const FRAMES: usize = 12_000;

/// Plays events in one long buffer.
fn play(instance: &mut Instance, events: &[(u32, What)]) -> Sound {
    play_and_tell(instance, events).0
}

/// And the parameters that the instance said it has moved.
fn play_and_tell(instance: &mut Instance, events: &[(u32, What)]) -> (Sound, Vec<(u32, f64)>) {
    let events: Vec<_> = events.iter().map(|&(offset, what)| Event { offset, what }).collect();
    instance
        .run(RATE, 1..=FRAMES as u32, |processor| {
            let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
            processor.process(&events, &mut left, &mut right)?;
            Ok(([left, right], processor.moved()))
        })
        .unwrap()
}

fn on(key: u8) -> What {
    What::NoteOn { channel: 9, key, velocity: 0.8 }
}

fn set(instance: &mut Instance, name: &str, value: f32) {
    let index = find(name, &KitSpec::standard()).unwrap();
    instance.set_parameters(&[as_hosts_have_it((index, value))]).unwrap();
}

fn energy(sound: &Sound, from: usize) -> f32 {
    sound.iter().flat_map(|channel| &channel[from..]).map(|sample| sample * sample).sum()
}

#[test]
fn every_note_of_every_map_sounds_or_is_silent_as_the_tables_say() {
    let _turn = alone();
    let (mut instance, table) = (instance(), KitDocument::standard().notes);
    for (place, map) in NoteMap::ALL.into_iter().enumerate() {
        set(&mut instance, "note_map", place as f32);
        instance
            .run(RATE, 1..=64, |processor| {
                let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
                for key in 0..128 {
                    processor.reset();
                    let event = Event { offset: 0, what: on(key) };
                    processor.process(&[event], &mut left, &mut right)?;
                    // A felt beater gets going late; any motion of the surface is heard.
                    processor.process(&[], &mut left, &mut right)?;
                    let sounds = left.iter().any(|sample| *sample != 0.0);
                    let row = map.plays(key).and_then(|note| table.row(note));
                    // What a foot presses out between the cymbals may be heard before their rims meet.
                    if row.is_some_and(|row| matches!(row.meaning, Meaning::Steps(..))) {
                        continue;
                    }
                    assert_eq!(sounds, map.stroke(key, &table).is_some(), "{map:?}, note {key}");
                }
                Ok(())
            })
            .unwrap();
    }
}

#[test]
fn notes_of_a_module_are_the_reference_notes_they_play() {
    let _turn = alone();
    let (mut instance, table) = (instance(), KitDocument::standard().notes);
    for (place, map) in NoteMap::ALL.into_iter().enumerate().skip(1) {
        for pad in map.pads().unwrap().iter().filter(|pad| table.stroke(pad.plays).is_some()).step_by(5) {
            set(&mut instance, "note_map", 0.0);
            let expected = play(&mut instance, &[(7, on(pad.plays))]);
            set(&mut instance, "note_map", place as f32);
            let found = play(&mut instance, &[(7, on(pad.note))]);
            assert_same(&found, &expected, &format!("{map:?}: {}", pad.name));
        }
    }
}

#[test]
fn midi_bytes_play_as_notes_do() {
    let _turn = alone();
    let mut instance = instance();
    let note = What::NoteOn { channel: 9, key: 38, velocity: 100.0 / 127.0 };
    let sound = play(&mut instance, &[(7, note)]);
    assert!(peak(&sound) > 0.0);
    assert_same(&play(&mut instance, &[(7, What::Midi([0x99, 38, 100]))]), &sound, "as bytes");
    for silent in [
        What::Midi([0x99, 38, 0]),
        What::Midi([0x89, 38, 100]),
        What::Midi([0xB9, 38, 100]),
        What::NoteOff { channel: 9, key: 38 },
        What::Choke { channel: 9, key: 38 },
        What::NoteOn { channel: 9, key: 38, velocity: 0.0 },
        What::NoteOn { channel: 9, key: 39, velocity: 1.0 },
        What::NoteOn { channel: 9, key: 127, velocity: 1.0 },
    ] {
        assert_eq!(peak(&play(&mut instance, &[(7, silent)])), 0.0, "{silent:?}");
    }
}

#[test]
fn controllers_reach_the_stroke_and_only_its_own() {
    let _turn = alone();
    let mut instance = instance();
    let plain = play(&mut instance, &[(9, on(38))]);
    for (bytes, changes) in [
        ([0xB9, 16, 127], true),
        ([0xB9, 88, 64], true),
        ([0xB0, 88, 64], false),
        ([0xB9, 17, 127], false),
        ([0xB9, 1, 127], false),
    ] {
        let moved = play(&mut instance, &[(3, What::Midi(bytes)), (9, on(38))]);
        assert_eq!(moved != plain, changes, "{bytes:?}");
    }
    // What was said to the performer directly sounds the same, to the sample.
    let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    let mut expected = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
    let [left, right] = &mut expected;
    performer.control_change(16, 100.0 / 127.0, 9);
    performer.render(&mut left[..9], &mut right[..9]);
    performer.note_on(38, 0.8, 9);
    performer.render(&mut left[9..], &mut right[9..]);
    let found = play(&mut instance, &[(9, What::Midi([0xB9, 16, 100])), (9, on(38))]);
    assert_same(&found, &expected, "position 100");
}

#[test]
fn the_channel_filter_hears_one_channel() {
    let _turn = alone();
    let mut instance = instance();
    set(&mut instance, "midi_channel", 10.0);
    assert!(peak(&play(&mut instance, &[(0, on(38))])) > 0.0);
    let other = What::NoteOn { channel: 3, key: 38, velocity: 0.8 };
    assert_eq!(peak(&play(&mut instance, &[(0, other)])), 0.0);
}

#[test]
fn cymbals_are_choked_as_the_rule_says_and_heads_damped_by_pressure() {
    let _turn = alone();
    let mut instance = instance();
    let pressure = What::Midi([0xA9, 49, 127]);
    let off = What::NoteOff { channel: 9, key: 49 };
    let choke = What::Choke { channel: 9, key: 49 };
    let ringing = energy(&play(&mut instance, &[(0, on(49))]), 8_000);
    for (rule, message, chokes) in [
        (1.0, pressure, true),
        (1.0, off, false),
        (1.0, choke, true),
        (2.0, pressure, false),
        (2.0, off, true),
        (3.0, pressure, true),
        (3.0, off, true),
        (0.0, pressure, false),
        (0.0, off, false),
    ] {
        set(&mut instance, "chokes", rule);
        let left = energy(&play(&mut instance, &[(0, on(49)), (2_400, message)]), 8_000);
        assert_eq!(left < 0.05 * ringing, chokes, "rule {rule}, {message:?}: {left} of {ringing}");
    }
    set(&mut instance, "chokes", 3.0);
    let drum = play(&mut instance, &[(0, on(48))]);
    let ended = play(&mut instance, &[(0, on(48)), (2_400, What::NoteOff { channel: 9, key: 48 })]);
    assert_same(&ended, &drum, "a drum whose note has ended");
    // The firmer a hand lies on its head, the less is left.
    let left = [0, 40, 127].map(|pressure| {
        let damped = play(&mut instance, &[(0, on(48)), (2_400, What::Midi([0xA9, 48, pressure]))]);
        // A hand closes in some 25 ms.
        energy(&damped, 7_200)
    });
    println!("a tom under a hand: {left:?}");
    assert!(left[0] > 2.0 * left[1] && left[1] > 2.0 * left[2], "{left:?}");
}

#[test]
fn a_choke_of_any_note_chokes_every_cymbal() {
    let _turn = alone();
    let mut instance = instance();
    let strokes = [49, 51, 55, 46].map(|key| (0, on(key)));
    let ringing = energy(&play(&mut instance, &strokes), 9_000);
    let choked = energy(&play(&mut instance, &[&strokes[..], &[(2_400, What::ChokeAll)]].concat()), 9_000);
    assert!(choked < 0.05 * ringing, "{choked} of {ringing}");
    set(&mut instance, "midi_channel", 10.0);
    let choked = energy(&play(&mut instance, &[&strokes[..], &[(2_400, What::ChokeAll)]].concat()), 9_000);
    assert!(choked < 0.05 * ringing, "on one channel: {choked} of {ringing}");
}

#[test]
fn all_notes_off_and_all_sound_off_leave_nothing_ringing() {
    let _turn = alone();
    let mut instance = instance();
    let strokes = [36, 38, 49, 51, 55, 46].map(|key| (0, on(key)));
    for controller in [120, 123] {
        let off = (2_400, What::Midi([0xB9, controller, 0]));
        let sound = play(&mut instance, &[&strokes[..], &[off]].concat());
        assert!(peak(&sound) > 0.01 && energy(&sound, 2_400 + 480) == 0.0, "controller {controller}");
    }
}

#[test]
fn nothing_is_louder_than_the_ceiling_and_music_is_not_touched() {
    let _turn = alone();
    let mut instance = instance();
    for name in ["master_level", "crash_level", "ride_level", "snare_level", "kick_level"] {
        set(&mut instance, name, 12.0);
    }
    let strokes: Vec<_> = (0..20).flat_map(|at| [36, 38, 49, 51].map(|key| (at * 500, on(key)))).collect();
    let loudest = peak(&play(&mut instance, &strokes));
    assert!(loudest > 2.0 && loudest <= 4.0, "{loudest}");
}

#[test]
fn a_program_change_loads_its_preset_at_its_sample_and_tells_the_host() {
    let _turn = alone();
    let number = FACTORY.iter().position(|(name, _)| *name == "jazz").unwrap();
    let preset = Preset::parse("jazz", FACTORY[number].1).unwrap();
    let change = |channel: u8| What::Midi([0xC0 | channel, number as u8, 0]);
    let strokes = [(0, on(38)), (6_000, on(38))];
    let plain = play(&mut instance(), &strokes);

    let mut changed = instance();
    let (sound, moved) = play_and_tell(&mut changed, &[strokes[0], (5_000, change(9)), strokes[1]]);
    assert!(sound[0][..5_000] == plain[0][..5_000] && sound[0][6_000..] != plain[0][6_000..]);
    let found = changed.parameters().unwrap();
    let kit = KitSpec::standard();
    for (index, found) in found.iter().take(COUNT).enumerate() {
        let wanted = preset.value(index, &kit).unwrap_or_else(|| default_value(index, &kit));
        let (_, wanted) = as_hosts_have_it((index, wanted));
        assert!((found.value - wanted).abs() < 1e-6, "{}", found.name);
    }
    let asked = preset.values_at(&kit).into_iter().map(as_hosts_have_it);
    assert_eq!(moved, asked.collect::<Vec<_>>());

    // As a host that moves the same parameters itself.
    let mut by_hand = vec![strokes[0]];
    by_hand.extend(moved.iter().map(|&(id, value)| (5_000, What::Parameter { id, value })));
    by_hand.push(strokes[1]);
    assert_same(&play(&mut instance(), &by_hand), &sound, "moved by the host");

    let ignored = |settings: &[(&str, f32)], what: What| {
        let mut instance = instance();
        settings.iter().for_each(|&(name, value)| set(&mut instance, name, value));
        let (sound, moved) = play_and_tell(&mut instance, &[strokes[0], (5_000, what), strokes[1]]);
        assert_same(&sound, &plain, &format!("{what:?} with {settings:?}"));
        assert!(moved.is_empty());
    };
    ignored(&[("program_changes", 0.0)], change(9));
    ignored(&[("midi_channel", 10.0)], change(8));
    ignored(&[], What::Midi([0xC9, 127, 0]));
}

#[test]
fn modulation_moves_a_parameter_away_and_leaves_its_value() {
    let _turn = alone();
    let (index, higher) = setting("rack_tom_tune=3 st");
    let (id, moved) = as_hosts_have_it((index, higher));
    let (_, rest) = as_hosts_have_it((index, parameters()[index].default));
    let strokes = [(0, on(48)), (8_000, on(48))];
    let with = |what: What| [strokes[0], (5_000, what), strokes[1]];
    let mut modulated = instance();
    let sound = play(&mut modulated, &with(What::Modulation { id, amount: moved - rest }));
    let value = modulated.parameters().unwrap()[index].value;
    assert!((value - rest).abs() < 1e-6, "{value} for {rest}");
    assert_eq!(
        modulated.save_state().unwrap(),
        instance().save_state().unwrap(),
        "what is stored is not modulated"
    );
    let automated = play(&mut instance(), &with(What::Parameter { id, value: moved }));
    assert_same(&sound, &automated, "modulated as far as automated");
    assert!(sound != play(&mut instance(), &strokes));
}
