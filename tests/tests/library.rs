//! The library: its instruments sound and fall silent, and its whole kits play without a clipped sample; some of each in a run.

use overhear::library::{self, Instrument, WholeKit};
use overhear_engine::kit_spec::Kind;
use overhear_engine::piece::BuildOptions;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use overhear_measure::hear::default_strike;
use overhear_tests::{Chance, build, kit_of, render, stroke};

const RATE: f64 = 44_100.0;

/// A few of a list: every fixed one, and some that are new in every run.
fn sampled<T: Clone>(all: &[T], fixed: &[usize], fresh: usize) -> Vec<T> {
    let mut chosen: Vec<usize> = fixed.to_vec();
    let seed = *Chance::seeds(&[]).last().expect("a seed");
    let mut chance = Chance::new(seed);
    chosen.extend((0..fresh).map(|_| chance.below(all.len())));
    chosen.into_iter().map(|i| all[i].clone()).collect()
}

#[test]
fn instruments_sound_and_decay() {
    let all: Vec<Instrument> = library::instruments().collect();
    for instrument in sampled(&all, &[0, all.len() - 1], 6) {
        let spec = instrument.piece().expect("a piece");
        let (striker, radius) = match spec.instrument.kind() {
            Kind::Drum => (Striker::Stick, 0.3),
            _ => (Striker::Shoulder, 0.9),
        };
        let mut piece = build(&spec, &BuildOptions::new(RATE));
        piece.strike(&stroke(striker, 3.0, radius, 0.3));
        let sound = render(&mut piece, 2.0, RATE);
        let energy = |of: &[f32]| of.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>();
        let (first, last) = (energy(&sound[..22_050]), energy(&sound[66_150..]));
        println!("{}: {:.1} dB after 1.5 s", instrument.name, 10.0 * (last / first).log10());
        assert!(sound.iter().all(|x| x.is_finite()), "{}", instrument.name);
        assert!(first > 0.0 && last < 0.5 * first, "{}: {first:e} J, then {last:e}", instrument.name);
    }
}

#[test]
fn whole_kits_sound_on_every_piece_and_do_not_clip() {
    let mut clipping = Vec::new();
    // `cargo xtask demo --all-kits` plays all.
    let all: Vec<WholeKit> = library::kits().collect();
    for kit in sampled(&all, &[0, all.len() - 1], 3) {
        let document = kit.document().expect("a kit");
        let mut playing = kit_of(&document.kit, RATE);
        let struck: Vec<Slot> = document.kit.slots().map(|(slot, _)| slot).collect();
        let mut loudest = 0.0_f32;
        for &slot in &struck {
            let strike = default_strike(&document, slot);
            playing.strike(slot, &overhear_engine::strike::Strike { speed: 4.0, ..strike });
            let [mut left, mut right] = [vec![0.0_f32; 11_025], vec![0.0_f32; 11_025]];
            playing.render(&mut left, &mut right);
            let own = left.iter().chain(&right).fold(0.0_f32, |most, x| most.max(x.abs()));
            assert!(own > 1e-3, "{}: the piece in {slot:?} is silent", kit.name);
            loudest = loudest.max(own);
        }
        println!("{}: {} pieces, at most {loudest:.2} of full scale", kit.name, struck.len());
        clipping.extend((loudest >= 1.0).then(|| format!("{}: {loudest:.2}", kit.name)));
    }
    assert!(clipping.is_empty(), "{clipping:?}");
}
