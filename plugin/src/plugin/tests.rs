use overhear_engine::snapshot::KitSnapshot;

use super::*;
use crate::outputs::Used;
use overhear_player::kit_document::KitDocument;

const RATE: f64 = 48_000.0;

fn note(timing: u32) -> NoteEvent<()> {
    NoteEvent::NoteOn {
        timing,
        voice_id: nice_plug::midi::VoiceID::Wildcard,
        channel: nice_plug::midi::Channel::Number(9),
        key: nice_plug::midi::Key::Number(38),
        velocity: 0.8,
    }
}

fn other(timing: u32) -> NoteEvent<()> {
    NoteEvent::NoteOff {
        timing,
        voice_id: nice_plug::midi::VoiceID::Wildcard,
        channel: nice_plug::midi::Channel::Wildcard,
        key: nice_plug::midi::Key::Wildcard,
        velocity: 0.0,
    }
}

fn expression(timing: u32, place: Option<f32>, tuning: f32) -> NoteEvent<()> {
    let (voice_id, channel) = (nice_plug::midi::VoiceID::Wildcard, nice_plug::midi::Channel::Number(9));
    let key = nice_plug::midi::Key::Number(38);
    match place {
        Some(brightness) => NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness },
        None => NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning },
    }
}

/// Plays events through an instance's own glue: a stretch for each slice length.
fn played(slices: &[(usize, Vec<NoteEvent<()>>)]) -> Vec<f32> {
    let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    let (mut sound, mut sounding) = (Vec::new(), Sounding::default());
    for (samples, events) in slices {
        let (mut left, mut right) = (vec![f32::NAN; *samples], vec![f32::NAN; *samples]);
        let mut events = events.iter().copied();
        let mut main = [left.as_mut_slice(), right.as_mut_slice()];
        let mut buffers = Buffers::new(&mut main, &mut [], Used::ALL).unwrap();
        play(&mut performer, &mut sounding, None, &mut buffers, &HostParameters::default(), || events.next());
        sound.extend(left);
    }
    sound
}

#[test]
fn a_note_right_behind_a_slice_is_the_first_of_the_next() {
    let behind = played(&[(100, vec![note(100)]), (1_000, vec![])]);
    let next = played(&[(100, vec![]), (1_000, vec![note(0)])]);
    assert!(behind == next);
}

#[test]
fn notes_are_met_at_their_sample_among_other_events() {
    let whole = played(&[(1_000, vec![other(10), note(333), other(500), note(700)])]);
    let cut = played(&[(333, vec![]), (367, vec![note(0)]), (300, vec![note(0)])]);
    assert!(whole == cut);
    assert!(whole.iter().all(|sample| sample.is_finite()));
}

#[test]
fn a_note_takes_the_place_and_the_pitch_that_come_with_it() {
    let plain = played(&[(4_000, vec![note(10), note(2_000)])]);
    let controlled = |value: f32| NoteEvent::MidiCC { timing: 5, channel: 9, cc: 16, value };
    let moved = played(&[(4_000, vec![note(10), expression(10, Some(0.9), 0.0), note(2_000)])]);
    assert!(moved[..10] == plain[..10] && moved[10..2_000] != plain[10..2_000]);
    let by_controller = played(&[(4_000, vec![controlled(0.9), note(10), note(2_000)])]);
    assert!(moved[..2_000] == by_controller[..2_000]);
    assert!(moved[2_000..] != by_controller[2_000..], "the next note is where the map says");
    let late = played(&[(4_000, vec![note(10), expression(11, Some(0.9), 0.0), note(2_000)])]);
    assert!(late[..2_000] == plain[..2_000], "it has landed");
    assert!(late[2_000..] != plain[2_000..], "but the hand has moved");
    let ended = played(&[(4_000, vec![note(10), expression(11, Some(0.9), 0.0), other(500), note(2_000)])]);
    assert!(ended == plain, "until the note ends");

    let bent = played(&[(4_000, vec![note(10), expression(10, None, 3.0), expression(3_000, None, 1.0)])]);
    assert!(bent[..10] == plain[..10] && bent[10..2_000] != plain[10..2_000]);
    let later = played(&[(4_000, vec![note(10), expression(10, None, 3.0)])]);
    assert!(bent[..3_000] == later[..3_000] && bent[3_000..] != later[3_000..]);
    let odd = played(&[(4_000, vec![note(10), expression(10, None, f32::NAN), note(2_000)])]);
    assert!(odd == plain);
}

#[test]
fn a_program_change_that_moved_no_parameter_changes_nothing() {
    let parameters = HostParameters::default();
    parameters.read_programs();
    let sound = |program: Option<u8>| {
        let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
        performer.install_kit(RATE, Pace::RealTime).unwrap();
        let change = program.map(|program| NoteEvent::MidiProgramChange { timing: 0, channel: 9, program });
        let mut events = change.into_iter().chain([note(0)]);
        let (mut left, mut right) = (vec![0.0; 2_000], vec![0.0; 2_000]);
        let mut main = [left.as_mut_slice(), right.as_mut_slice()];
        let mut buffers = Buffers::new(&mut main, &mut [], Used::ALL).unwrap();
        play(&mut performer, &mut Sounding::default(), None, &mut buffers, &parameters, || events.next());
        left
    };
    let is_at = |program| parameters.with_program(program, 9, |program| parameters.are_at(program));
    assert_eq!((is_at(0), is_at(2), is_at(127)), (Some(true), Some(false), None));
    assert!(sound(Some(2)) == sound(None));
}

#[test]
fn more_notes_at_a_sample_than_can_wait_are_all_struck() {
    let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
    let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
    let mut events = (0..40).map(|_| note(3));
    let mut main = [left.as_mut_slice(), right.as_mut_slice()];
    let mut buffers = Buffers::new(&mut main, &mut [], Used::ALL).unwrap();
    play(&mut performer, &mut Sounding::default(), None, &mut buffers, &HostParameters::default(), || {
        events.next()
    });
    let mut snapshot = KitSnapshot::default();
    performer.snapshot(&mut snapshot);
    assert_eq!(snapshot.dropped_strikes, 40);
}

#[test]
fn notes_out_of_order_and_beyond_the_slice_are_not_lost() {
    let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
    let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
    let mut events = [note(60), note(10), note(u32::MAX)].into_iter();
    let mut main = [left.as_mut_slice(), right.as_mut_slice()];
    let mut buffers = Buffers::new(&mut main, &mut [], Used::ALL).unwrap();
    play(&mut performer, &mut Sounding::default(), None, &mut buffers, &HostParameters::default(), || {
        events.next()
    });
    let mut snapshot = KitSnapshot::default();
    performer.snapshot(&mut snapshot);
    assert_eq!((snapshot.dropped_strikes, snapshot.clock), (3, 64));
}

#[test]
fn an_instance_is_made_without_a_kit_and_prepared_with_one() {
    let mut instance = Overhear::default();
    assert!(instance.stage.is_none());
    instance.prepare(48_000.0, false);
    assert!(instance.stage.as_ref().is_some_and(|stage| stage.performer.is_complete()));
}

#[test]
fn the_same_rate_keeps_the_kit_and_another_rebuilds_it() {
    let clock = |instance: &mut Overhear| {
        let mut snapshot = KitSnapshot::default();
        instance.stage.as_mut().unwrap().performer.snapshot(&mut snapshot);
        snapshot.clock
    };
    let mut instance = Overhear::default();
    instance.prepare(44_100.0, false);
    instance.stage.as_mut().unwrap().performer.render(&mut [0.0; 50], &mut [0.0; 50]);
    instance.prepare(44_100.0, false);
    assert_eq!(clock(&mut instance), 50);
    instance.prepare(96_000.0, false);
    assert_eq!(clock(&mut instance), 0);
    assert!(instance.stage.as_ref().is_some_and(|stage| stage.performer.is_complete()));
}

#[test]
fn a_bounce_and_who_plays_after_it_wait_for_their_own_kit() {
    let done = |instance: &Overhear| instance.builder.wait(Duration::ZERO) == Outcome::Finished;
    let mut instance = Overhear::default();
    instance.prepare(48_000.0, false);
    for offline in [true, false] {
        instance.prepare(48_000.0, offline);
        assert!(done(&instance), "offline {offline}");
    }
}

#[test]
fn a_rate_that_nothing_can_be_played_at_is_refused_and_the_next_good_one_plays() {
    let mut instance = Overhear::default();
    for rate in [999.0, 1.6e6, 0.0, -48_000.0, f32::INFINITY] {
        assert!(!instance.prepare(rate, false) && instance.stage.is_none(), "{rate} Hz");
        assert_eq!(instance.parameters.refused_rate(), Some(rate), "the window says so");
    }
    assert!(!instance.prepare(f32::NAN, false) && instance.parameters.refused_rate().is_some());
    for (rate, decimated) in [(8_000.0, true), (48_000.0, false)] {
        assert!(instance.prepare(rate, false), "{rate} Hz");
        let stage = instance.stage.as_ref().unwrap();
        assert_eq!(
            (stage.decimation.is_some(), stage.performer.is_complete()),
            (decimated, true),
            "{rate} Hz"
        );
        assert_eq!(instance.parameters.refused_rate(), None);
    }
}

#[test]
fn a_panic_in_the_engine_silences_the_stage_until_it_is_prepared_again() {
    let mut instance = Overhear::default();
    instance.prepare(48_000.0, false);
    let stage = instance.stage.as_mut().unwrap();
    assert!(!stage.guarded(|_| panic!("on purpose")));
    assert!(!stage.guarded(|_| {}), "it stays silent");
    instance.prepare(48_000.0, false);
    assert!(instance.stage.as_mut().unwrap().guarded(|_| {}));
}

#[test]
fn another_kit_is_there_before_it_is_played() {
    let mut instance = Overhear::default();
    instance.prepare(48_000.0, false);
    let mut other = KitDocument::standard();
    other.kit.pieces.truncate(2);
    other.notes = overhear_player::midi_map::NoteTable::standard(&other.kit);
    instance.parameters.set_document(Arc::new(other.clone())).unwrap();
    instance.prepare(48_000.0, false);
    let performer = &mut instance.stage.as_mut().unwrap().performer;
    assert!(*performer.document() == other && performer.is_complete());
    let slots = [36, 38, 49].map(|note| performer.slot_of(note).map(|slot| slot.index()));
    assert_eq!(slots, [Some(0), Some(1), None]);
}
