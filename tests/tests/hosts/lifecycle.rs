//! The host's calls around playback: activating, resetting, making and removing instances.

use std::thread;

use overhear::parameters::{BYPASS_ID, host_id};
use overhear_cli::host::{Event, What};
use overhear_cli::player::Blocks;

use crate::score::{assert_same, notes, peak, through_engine, through_plugin};
use crate::{alone, instance};

const RATE: f64 = 48_000.0;

#[test]
fn activated_anew_it_plays_as_if_it_were_new() {
    let _turn = alone();
    let mut instance = instance();
    for rate in [44_100.0, 96_000.0, 44_100.0, 22_050.0, 192_000.0, 48_000.0] {
        let score = notes(rate);
        let found = through_plugin(&mut instance, &score, rate, Blocks::Fixed(512));
        assert_same(&found, &through_engine(&score, rate), &format!("{rate} Hz"));
    }
    assert_eq!(instance.restarts(), 0);
}

#[test]
fn a_rate_below_the_engine_s_is_played_by_a_multiple_and_one_far_below_refused() {
    let _turn = alone();
    let mut instance = instance();
    for rate in [500.0, 2e6] {
        assert!(instance.run(rate, 1..=64, |_| Ok(())).is_err(), "{rate} Hz is activated");
    }
    for rate in [8000.0, 1234.5678] {
        let score = notes(rate);
        let sound = through_plugin(&mut instance, &score, rate, Blocks::Fixed(64));
        assert!(peak(&sound) > 0.01, "{rate} Hz is silent");
        assert_same(
            &through_plugin(&mut instance, &score, rate, Blocks::Random),
            &sound,
            &format!("{rate} Hz"),
        );
    }
    let score = notes(RATE);
    let sound = through_plugin(&mut instance, &score, RATE, Blocks::Fixed(64));
    assert_same(&sound, &through_engine(&score, RATE), "a good rate after that");
}

#[test]
fn instances_do_not_hear_each_other() {
    let _turn = alone();
    let score = notes(RATE);
    let expected = through_engine(&score, RATE);
    let threads: Vec<_> = [Blocks::Fixed(64), Blocks::Random, Blocks::Fixed(333)]
        .into_iter()
        .map(|blocks| {
            let score = score.clone();
            thread::spawn(move || through_plugin(&mut instance(), &score, RATE, blocks))
        })
        .collect();
    for thread in threads {
        assert_same(&thread.join().unwrap(), &expected, "one of three");
    }
    let (mut one, mut other) = (instance(), instance());
    let silence = through_plugin(&mut other, &Vec::new(), RATE, Blocks::Fixed(64));
    assert_eq!(peak(&silence), 0.0);
    assert_same(&through_plugin(&mut one, &score, RATE, Blocks::Fixed(64)), &expected, "one of two");
    drop(one);
    assert_same(&through_plugin(&mut other, &score, RATE, Blocks::Fixed(64)), &expected, "the other");
}

#[test]
fn instances_go_at_any_time() {
    let _turn = alone();
    for _ in 0..20 {
        drop(instance());
    }
    // Activated and gone at once, several at a time, while others still build.
    let threads: Vec<_> = (0..3)
        .map(|number| {
            thread::spawn(move || {
                for round in 0..2 {
                    let mut instance = instance();
                    let rate = [44_100.0, 48_000.0, 88_200.0, 96_000.0][(number + round) % 4];
                    instance.run(rate, 1..=64, |_| Ok(())).unwrap();
                    if round == 1 {
                        instance.run(rate / 2.0, 1..=64, |_| Ok(())).unwrap();
                    }
                }
            })
        })
        .collect();
    for thread in threads {
        thread.join().unwrap();
    }
}

#[test]
fn a_reset_silences_what_rings() {
    let _turn = alone();
    let struck =
        [49, 36].map(|key| Event { offset: 0, what: What::NoteOn { channel: 9, key, velocity: 1.0 } });
    let (rang, silent) = instance()
        .run(RATE, 1..=4096, |processor| {
            let (mut left, mut right) = (vec![0.0; 4096], vec![0.0; 4096]);
            processor.process(&struck, &mut left, &mut right)?;
            let rang = left.iter().any(|sample| *sample != 0.0);
            processor.reset();
            processor.process(&[], &mut left, &mut right)?;
            Ok((rang, left.iter().chain(&right).all(|sample| *sample == 0.0)))
        })
        .unwrap();
    assert!(rang && silent, "rang: {rang}, silent after the reset: {silent}");
}

#[test]
fn more_events_than_any_song_has_are_survived() {
    let _turn = alone();
    let events: Vec<_> = (0..6000)
        .map(|number| Event {
            offset: number / 4,
            what: What::NoteOn { channel: 9, key: 35 + (number % 47) as u8, velocity: 0.7 },
        })
        .collect();
    let finite = instance()
        .run(RATE, 1..=2048, |processor| {
            let (mut left, mut right) = (vec![0.0; 2048], vec![0.0; 2048]);
            processor.process(&events, &mut left, &mut right)?;
            Ok(left.iter().chain(&right).all(|sample| sample.is_finite()))
        })
        .unwrap();
    assert!(finite);
}

#[test]
fn bypassed_it_fades_out_strikes_nothing_and_comes_back() {
    const FRAMES: usize = 9_600;
    const ON: usize = 2_400;
    const OFF: usize = 7_200;
    let _turn = alone();
    let (first, lost, last) = (0, ON + 1_000, OFF + 1_000);
    let strike = |offset: usize| (offset, What::NoteOn { channel: 9, key: 38, velocity: 0.8 });
    let bypass = |offset: usize, value: f64| (offset, What::Parameter { id: host_id(BYPASS_ID), value });
    let play = |score: &[(usize, What)], block: usize| {
        let mut sound = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
        instance()
            .run(RATE, 1..=block as u32, |processor| {
                for from in (0..FRAMES).step_by(block) {
                    let to = (from + block).min(FRAMES);
                    let within = score.iter().filter(|(at, _)| (from..to).contains(at));
                    let events: Vec<_> =
                        within.map(|&(at, what)| Event { offset: (at - from) as u32, what }).collect();
                    let [left, right] = &mut sound;
                    processor.process(&events, &mut left[from..to], &mut right[from..to])?;
                }
                Ok(())
            })
            .unwrap();
        sound
    };
    let score = [strike(first), bypass(ON, 1.0), strike(lost), bypass(OFF, 0.0), strike(last)];
    let sound = play(&score, FRAMES);
    for block in [64, 777] {
        assert_same(&play(&score, block), &sound, &format!("buffers of {block}"));
    }
    // As the kit is without the lost stroke, but for the silence and the fades.
    let plain = play(&[strike(first), strike(last)], FRAMES);
    let fade = 480;
    for (found, plain) in sound.iter().zip(&plain) {
        assert!(found[..ON] == plain[..ON] && found[OFF + fade..] == plain[OFF + fade..]);
        assert!(found[ON + fade..OFF].iter().all(|sample| *sample == 0.0));
        let fades = [ON..ON + fade, OFF..OFF + fade].into_iter().flatten();
        assert!(fades.into_iter().all(|at| found[at].abs() <= plain[at].abs()));
    }
    assert!(
        peak(&[plain[0][ON..OFF].to_vec(), plain[1][ON..OFF].to_vec()]) > 1e-3,
        "there was something to hide"
    );
}
