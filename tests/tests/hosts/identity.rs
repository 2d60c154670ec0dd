//! The same samples from the engine and the plugin, for any buffer sizes of the host.

use overhear_cli::player::Blocks;
use overhear_tests::Chance;

use crate::score::{Happening, assert_same, automated, notes, peak, through_engine, through_plugin};
use crate::{alone, instance};

const RATES: [f64; 3] = [44_100.0, 48_000.0, 96_000.0];

const BLOCKS: [Blocks; 6] = [
    Blocks::Fixed(1),
    Blocks::Fixed(17),
    Blocks::Fixed(64),
    Blocks::Fixed(512),
    Blocks::Fixed(8192),
    Blocks::Random,
];

#[test]
fn notes_give_the_engine_s_samples_at_every_rate_and_buffer_size() {
    let _turn = alone();
    let mut instance = instance();
    // Every buffer size at one rate, drawn anew in every run, and one of them at the others.
    let mut chance = Chance::new(Chance::seeds(&[])[0]);
    let swept = chance.of(&RATES);
    for rate in RATES {
        let score = notes(rate);
        let expected = through_engine(&score, rate);
        assert!(peak(&expected) > 0.01, "the engine is silent");
        let sizes = if rate == swept { BLOCKS.to_vec() } else { vec![chance.of(&BLOCKS)] };
        for blocks in sizes {
            let found = through_plugin(&mut instance, &score, rate, blocks);
            assert_same(&found, &expected, &format!("{rate} Hz, {blocks:?}"));
        }
    }
}

#[test]
fn automation_acts_at_its_sample_at_every_buffer_size() {
    let _turn = alone();
    let rate = 48_000.0;
    let score = automated(rate);
    let expected = through_engine(&score, rate);
    assert!(expected != through_engine(&notes(rate), rate), "automation does nothing");
    for blocks in BLOCKS {
        // Knobs stay where they were turned to: a fresh instance each.
        let found = through_plugin(&mut instance(), &score, rate, blocks);
        assert_same(&found, &expected, &format!("{blocks:?}"));
    }
}

#[test]
fn every_piece_is_heard_and_nothing_is_clipped() {
    let _turn = alone();
    let mut instance = instance();
    for key in [36, 38, 48, 43, 49, 51, 55] {
        let score = vec![(100, Happening::Note(key, 127))];
        let sound = through_plugin(&mut instance, &score, 48_000.0, Blocks::Fixed(256));
        let peak = peak(&sound);
        assert!(sound.iter().flatten().all(|sample| sample.is_finite()));
        assert!((0.001..1.0).contains(&peak), "note {key} peaks at {peak}");
        assert!(sound[0][..100].iter().all(|sample| *sample == 0.0), "note {key} comes early");
    }
}
