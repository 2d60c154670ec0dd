//! Random events, presets and songs.
//!
//! The sequences come from fixed seeds, so that what fails once fails again. Short runs are part of every test run; the
//! long ones are ignored: `cargo test --package overhear-tests --features traps --test fuzz -- --ignored`. An allocator
//! counts allocations during playback.

use std::sync::Arc;

use assert_no_alloc::{AllocDisabler, assert_no_alloc, violation_count};
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::parameters::{COUNT, SlotParameter, default_value, parameters, slot_parameter};
use overhear::performer::Performer;
use overhear::presets::{FACTORY, Preset};
use overhear_cli::song::Song;
use overhear_engine::snapshot::KitSnapshot;
use overhear_tests::Chance;
use rayon::prelude::*;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Sample rates that hosts use, Hz.
const RATES: [f64; 6] = [22_050.0, 44_100.0, 48_000.0, 88_200.0, 96_000.0, 192_000.0];

/// Loudest sample that is believed, full scale 1: every level at its top and every piece struck as hard as can be.
const LOUDEST: f32 = 1e4;

/// A value a host may send: within the range, at its ends, or out of all bounds.
fn value(chance: &mut Chance, index: usize) -> f32 {
    let (min, max) = parameters().get(index).map_or((0.0, 1.0), |parameter| (parameter.min, parameter.max));
    match chance.below(10) {
        0 => chance.of(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, 1e30, -1e30, 1e-40]),
        1 => chance.of(&[min, max]),
        _ => chance.between(f64::from(min), f64::from(max)) as f32,
    }
}

/// One event of any kind.
fn act(chance: &mut Chance, performer: &mut Performer) {
    let (number, channel) = (chance.below(256) as u8, chance.below(20) as u8);
    let odd = chance.of(&[f32::NAN, -1.0, 0.0, 0.01, 0.3, 0.7, 1.0, 1.0, 9.0]);
    match chance.below(1000) {
        0..450 => {
            performer.note_on(35 + number % 62, odd, channel);
        }
        450..500 => {
            performer.note_on(number, odd, channel);
        }
        500..550 => performer.note_off(number, channel),
        550..570 => performer.choke(number, channel),
        570..620 => performer.pressure(number, odd, channel),
        620..700 => performer.control_change(number % 128, odd, channel),
        700..990 => {
            let index = chance.below(COUNT + 1);
            performer.set_parameter(index, value(chance, index));
        }
        990..993 => performer.aim(Some(odd)),
        993..997 => performer.bend(number, 40.0 * odd, channel),
        997..999 => performer.snapshot(&mut KitSnapshot::default()),
        _ => performer.reset(),
    }
}

/// A performer at the standard kit, without its pieces.
fn performer(rate: f64) -> Performer {
    Performer::new(rate, &KitDocument::standard(), Arc::default())
}

/// Plays random events at one rate, so many to a buffer on average, then lets everything ring out.
fn play(seed: u64, rate: f64, events: usize, to_a_buffer: usize) {
    let mut chance = Chance::new(seed);
    let mut performer = performer(rate);
    performer.install_kit(rate, Pace::RealTime).unwrap();
    let mut sound = [vec![0.0; 1024], vec![0.0; 1024]];
    for event in 0..events {
        assert_no_alloc(|| act(&mut chance, &mut performer));
        if chance.below(to_a_buffer) > 0 {
            continue;
        }
        let longest = chance.of(&[1, 8, 33, 64, 257, 1024]);
        let frames = 1 + chance.below(longest);
        let [left, right] = &mut sound;
        assert_no_alloc(|| performer.render(&mut left[..frames], &mut right[..frames]));
        assert_eq!(violation_count(), 0, "seed {seed}, {rate} Hz, event {event}: allocated");
        let sane = |sample: &f32| sample.is_finite() && sample.abs() < LOUDEST;
        assert!(left.iter().chain(&*right).all(sane), "seed {seed}, {rate} Hz, event {event}");
    }
    ring_out(&mut performer, rate, &format!("seed {seed}, {rate} Hz"));
}

/// Mutes everything and waits for silence.
fn ring_out(performer: &mut Performer, rate: f64, what: &str) {
    for (index, parameter) in parameters().iter().enumerate() {
        let is_muffling = matches!(slot_parameter(index), Some((_, SlotParameter::Muffle)));
        let default = default_value(index, &performer.document().kit);
        performer.set_parameter(index, if is_muffling { parameter.max } else { default });
    }
    for note in 35..=96 {
        performer.choke(note, 9);
    }
    let mut sound = [vec![0.0; 8192], vec![0.0; 8192]];
    let [left, right] = &mut sound;
    for _ in 0..(60.0 * rate / 8192.0) as usize {
        performer.render(left, right);
        if left.iter().chain(&*right).all(|sample| *sample == 0.0) {
            let mut snapshot = KitSnapshot::default();
            performer.snapshot(&mut snapshot);
            assert!(snapshot.pieces.iter().all(|piece| piece.quarantines == 0), "{what}: quarantined");
            return;
        }
    }
    let mut snapshot = KitSnapshot::default();
    performer.snapshot(&mut snapshot);
    let energies = snapshot.pieces.map(|piece| piece.energy);
    panic!("{what}: still sounding after a minute, energies {energies:?} J");
}

#[test]
fn twelve_thousand_random_events_at_every_rate_stay_finite_and_fall_asleep() {
    for (seed, rate) in RATES.into_iter().enumerate() {
        play(1 + seed as u64, rate, 2_000, 4);
    }
}

#[test]
#[ignore = "takes half an hour on two cores; run before a release"]
fn a_million_random_events_stay_finite_and_fall_asleep() {
    (0..100).into_par_iter().with_max_len(1).for_each(|seed: usize| {
        play(1_000 + seed as u64, RATES[seed % RATES.len()], 10_000, 16);
        println!("seed {seed} of 100, 10,000 events each");
    });
}

/// A few bytes of something changed, cut out, doubled or made up.
fn mutate(chance: &mut Chance, bytes: &mut Vec<u8>) {
    for _ in 0..=chance.below(4) {
        let at = chance.below(bytes.len() + 1);
        let end = (at + chance.below(16)).min(bytes.len());
        match chance.below(6) {
            0 => bytes.truncate(at),
            1 => {
                bytes.drain(at..end);
            }
            2 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            3 => bytes.insert(at, chance.below(256) as u8),
            4 => bytes.insert(at, chance.of(b"\n\"[]=.#-09e\0")),
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << chance.below(8);
                }
            }
        }
    }
}

#[test]
fn a_hundred_thousand_mutated_presets_are_read_or_refused_with_a_line() {
    let mut chance = Chance::new(7);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..100_000 {
        let (name, text) = chance.of(&FACTORY);
        let mut bytes = text.as_bytes().to_vec();
        mutate(&mut chance, &mut bytes);
        match Preset::parse(name, &String::from_utf8_lossy(&bytes)) {
            Ok(preset) => {
                read += 1;
                for (&index, &value) in &preset.values {
                    let parameter = &parameters()[index];
                    assert!((parameter.min..=parameter.max).contains(&value), "{}", parameter.name);
                }
            }
            Err(error) => {
                refused += 1;
                let said = error.to_string();
                assert!(said.starts_with(&format!("{name}, line ")) && !said.contains('\n'), "{said}");
            }
        }
    }
    assert!(read > 1_000 && refused > 1_000, "{read} read, {refused} refused");
}

#[test]
fn ten_thousand_mutated_songs_are_read_or_refused() {
    let groove = include_bytes!("../../assets/groove.mid").to_vec();
    let mut chance = Chance::new(8);
    let mut refused = 0;
    for _ in 0..10_000 {
        let mut bytes = groove.clone();
        for _ in 0..=chance.below(3) {
            mutate(&mut chance, &mut bytes);
        }
        match Song::parse(&bytes) {
            Ok(song) => assert!(song.notes().all(|note| note.key < 128 && note.velocity < 128)),
            Err(reason) => {
                refused += 1;
                assert!(!reason.is_empty());
            }
        }
    }
    assert!(refused > 100, "{refused} refused");
}

#[test]
fn every_piece_is_among_what_random_notes_strike() {
    let performer = performer(48_000.0);
    for (slot, piece) in performer.document().kit.slots() {
        assert!((35..97).any(|note| performer.slot_of(note) == Some(slot)), "{}", piece.name);
    }
}

#[test]
fn the_snare_falls_asleep_with_its_wires_on() {
    play(5, 96_000.0, 2_000, 4);
}
