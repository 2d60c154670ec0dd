//! Expressions of notes while they sound, and the ends of notes.

use clap_sys::events::{
    CLAP_EVENT_NOTE_END, CLAP_EVENT_NOTE_EXPRESSION, CLAP_NOTE_EXPRESSION_BRIGHTNESS,
    CLAP_NOTE_EXPRESSION_PAN, CLAP_NOTE_EXPRESSION_PRESSURE, CLAP_NOTE_EXPRESSION_TUNING,
    CLAP_NOTE_EXPRESSION_VOLUME, clap_event_note_expression,
};

use super::calls::process;
use super::sweep::Sent;
use super::*;

/// Sample of an expression that comes while the note sounds.
pub(in crate::entry) const LATER: u32 = 64;

/// An id that a host gives a note.
pub(in crate::entry) const ID: i32 = 7;

/// What is told to a note: the format's number, the value in its range, and the sample.
pub(in crate::entry) type Told = (i32, f64, u32);

/// Everything that the tests tell a note.
pub(in crate::entry) const ALL: [Told; 5] = [
    (CLAP_NOTE_EXPRESSION_VOLUME, 0.25, LATER),
    (CLAP_NOTE_EXPRESSION_PAN, 1.0, LATER),
    (CLAP_NOTE_EXPRESSION_TUNING, 6.0, LATER),
    (CLAP_NOTE_EXPRESSION_BRIGHTNESS, 1.0, 0),
    (CLAP_NOTE_EXPRESSION_PRESSURE, 1.0, LATER),
];

pub(super) fn note(time: u32, note_id: i32) -> clap_event_note {
    let header = header::<clap_event_note>(CLAP_EVENT_NOTE_ON, time);
    clap_event_note { header, note_id, port_index: 0, channel: 9, key: 38, velocity: 0.8 }
}

fn expression((expression_id, value, time): Told, by_id: bool) -> clap_event_note_expression {
    clap_event_note_expression {
        header: header::<clap_event_note_expression>(CLAP_EVENT_NOTE_EXPRESSION, time),
        expression_id,
        note_id: ID,
        port_index: 0,
        channel: if by_id { -1 } else { 9 },
        key: if by_id { -1 } else { 38 },
        value,
    }
}

/// Plays events in one buffer: both sides of the main output, and the ids of notes that the plugin says have ended.
pub(super) fn played(instance: &Instance, events: Vec<Sent>) -> ([Vec<f32>; CHANNELS], Vec<i32>) {
    unsafe extern "C" fn take(list: *const clap_output_events, event: *const clap_event_header) -> bool {
        // SAFETY: the list's context is where ids go; an event of a type is of its form.
        unsafe {
            if (*event).type_ == CLAP_EVENT_NOTE_END {
                let id = (*event.cast::<clap_event_note>()).note_id;
                (&mut *(*list).ctx.cast::<Vec<i32>>()).push(id);
            }
        }
        true
    }
    let mut ended: Vec<i32> = Vec::with_capacity(64);
    let output = clap_output_events { ctx: (&raw mut ended).cast(), try_push: Some(take) };
    let (_, sound) = process(instance, FRAMES, &events, &output);
    (sound, ended)
}

/// The main output of a note on the snare with something told to it, by its number or by its id.
pub(in crate::entry) fn expressed(told: Option<Told>, by_id: bool) -> [Vec<f32>; CHANNELS] {
    let told = told.map(|told| Sent { expression: expression(told, by_id) });
    let events = [Sent { note: note(0, ID) }].into_iter().chain(told).collect();
    played(&Instance::new(overhear_player::CLAP_ID), events).0
}

/// Energy of a side from a sample on.
pub(in crate::entry) fn energy(side: &[f32], from: usize) -> f32 {
    side[from..].iter().map(|sample| sample * sample).sum()
}

#[test]
fn every_expression_acts_while_the_note_sounds_and_by_its_id_alone() {
    let plain = expressed(None, false);
    for told in ALL {
        let sound = expressed(Some(told), false);
        let since = told.2 as usize;
        assert!(sound[0][..since] == plain[0][..since], "{told:?}: before it is told");
        assert!(sound[0][since..] != plain[0][since..], "{told:?}: does nothing");
        assert!(sound == expressed(Some(told), true), "{told:?}: by its id");
    }
    let [volume, pan, ..] = ALL.map(|told| expressed(Some(told), false));
    let louder = |a: &[f32], b: &[f32]| 10.0 * (energy(a, 256) / energy(b, 256)).log10();
    // On its way to -12 dB, smoothly.
    let softer = louder(&volume[0], &plain[0]);
    assert!((-13.0..-6.0).contains(&softer), "{softer} dB");
    let moved = louder(&pan[1], &pan[0]) - louder(&plain[1], &plain[0]);
    assert!(moved > 3.0, "{moved} dB to the right");
}

/// Both sides' sum of half a second of the rack tom, with something told to its note.
fn half_a_second(told: Option<Told>) -> Vec<f32> {
    let instance = Instance::new(overhear_player::CLAP_ID);
    let told = told
        .map(|told| Sent { expression: clap_event_note_expression { key: 48, ..expression(told, false) } });
    let stroke = Sent { note: clap_event_note { key: 48, ..note(0, ID) } };
    let mut events: Vec<_> = [stroke].into_iter().chain(told).collect();
    let mut sound = Vec::new();
    for _ in 0..24_000 / FRAMES {
        let ([left, right], _) = played(&instance, std::mem::take(&mut events));
        sound.extend(left.iter().zip(&right).map(|(left, right)| left + right));
    }
    sound
}

/// Level of a sound from 50 ms on at a frequency, dB.
fn level_at(sound: &[f32], hz: f64) -> f64 {
    let turn = std::f64::consts::TAU * hz / 48e3;
    let [re, im] = sound[2_400..].iter().enumerate().fold([0.0; 2], |[re, im], (at, x)| {
        let phase = turn * at as f64;
        [re + f64::from(*x) * phase.cos(), im + f64::from(*x) * phase.sin()]
    });
    20.0 * re.hypot(im).log10()
}

#[test]
fn pressure_damps_tuning_bends_and_brightness_moves_the_stroke_outward() {
    let [.., tuning, brightness, pressure] = ALL;
    let plain = half_a_second(None);
    let level = |sound: &[f32]| 10.0 * energy(sound, 4_800).log10();
    let damped = level(&half_a_second(Some(pressure))) - level(&plain);
    let loudest = |sound: &[f32]| {
        let hz = (60..=400).map(f64::from);
        hz.max_by(|a, b| level_at(sound, *a).total_cmp(&level_at(sound, *b))).unwrap()
    };
    let [low, high] = [loudest(&plain), loudest(&half_a_second(Some(tuning)))];
    let semitones = 12.0 * (high / low).log2();
    // The lowest mode hardly moves at the rim.
    let outward = level_at(&half_a_second(Some(brightness)), low) - level_at(&plain, low);
    let rim = level(&half_a_second(Some(brightness))) - level(&plain);
    println!(
        "the rim {rim} dB, damped by {damped:.1} dB, {low} to {high} Hz, lowest mode {outward:.1} dB at the rim"
    );
    assert!(damped < -6.0, "{damped} dB after 100 ms under pressure");
    assert!((4.0..8.0).contains(&semitones), "{low} to {high} Hz: {semitones} semitones");
    assert!((-30.0..-3.0).contains(&outward), "{outward} dB");
}

#[test]
fn a_note_ends_with_the_next_stroke_on_its_piece_and_with_silence() {
    let instance = Instance::new(overhear_player::CLAP_ID);
    let [first, second] = [note(0, 1), note(256, 2)].map(|note| Sent { note });
    let (_, ended) = played(&instance, vec![first, second]);
    assert_eq!(ended, [1]);
    let silent = clap_event_note { key: 39, note_id: 3, ..note(0, 3) };
    assert_eq!(played(&instance, vec![Sent { note: silent }]).1, [3], "a note that plays nothing");
    let mut ended = Vec::new();
    for _ in 0..12 * 48_000 / FRAMES {
        ended.extend(played(&instance, Vec::new()).1);
    }
    assert_eq!(ended, [2], "a snare is silent after some seconds");
}
