//! Audible physics: frequencies, decays, deflections and tuning of built pieces.

use std::f64::consts::TAU;

use overhear_engine::drum::{Drum, DrumSpec, ResonantSpec};
use overhear_engine::instrument::Instrument as _;
use overhear_engine::kit_spec::{Kind, PieceSpec};
use overhear_engine::piece::{BuildOptions, ModeInfo, ModeKind, Piece};
use overhear_engine::strike::Striker;
use overhear_measure::report::{heads, modal};
use overhear_tests::{
    build, cents, context, decibels, names, piece, reference, render, round_piece, standard, stroke,
};

const RATE: f64 = 44_100.0;

/// The mode `(m, n)` of a round piece.
fn mode_of(piece: &Piece, m: u32, n: u32) -> ModeInfo {
    let modes = piece.modes();
    let found = modes.iter().find(|mode| (mode.m, mode.n) == (m, n) && mode.body != "stand");
    *found.expect("a mode of those orders")
}

/// The drums of the standard kit.
fn drums() -> impl Iterator<Item = (PieceSpec, DrumSpec)> {
    standard().pieces.into_iter().filter_map(|piece| {
        let drum = *piece.drum()?;
        Some((piece, drum))
    })
}

#[test]
fn a_struck_head_in_vacuum_sounds_the_ratios_of_the_bessel_zeros() {
    for (ratio, off) in modal::bessel_ratios() {
        println!("{ratio:.6}: {off:+.4} cents");
        assert!(off.abs() < 1.0, "{off} cents for {ratio}");
    }
}

#[test]
fn every_mode_of_every_piece_rings_at_its_frequency_and_decays_at_its_rate() {
    let mut worst = (0.0_f64, 0.0_f64);
    for name in names() {
        let mut piece = piece(&name, RATE);
        let modes = modal::body_modes(&piece).len();
        let motions = modal::follow(&mut piece, 8.0);
        assert_eq!(motions.len(), modes, "{name}: some do not move");
        for (mode, motion) in motions {
            if mode.frequency_hz >= 0.5 * RATE {
                continue;
            }
            let decay = modal::decay_error(&mode, &motion);
            assert!(motion.turns > 5.0, "{name} {mode:?}: {motion:?}");
            assert!(motion.off.abs() < 0.05, "{name} {mode:?}: {motion:?}");
            assert!(decay.abs() < 1e-3, "{name} {mode:?}: {motion:?}");
            worst = (worst.0.max(motion.off.abs()), worst.1.max(decay.abs()));
        }
    }
    println!("worst: {:.5} cents, decay {:.2e}", worst.0, worst.1);
}

#[test]
fn a_held_force_bends_every_piece_by_its_static_deflection() {
    for name in names() {
        let worst = modal::worst_deflection(&name);
        println!("{name}: {worst:.2e}");
        assert!(worst < 1e-3, "{name}: {worst}");
    }
}

#[test]
fn the_dome_raises_a_cap_cymbals_modes_to_those_of_a_shell() {
    for (cap, (m, n), hz) in [
        (reference::cap_crash(), (2, 0), 22.9),
        (reference::cap_crash(), (3, 0), 54.4),
        (reference::cap_crash(), (10, 0), 530.0),
        (reference::cap_crash(), (0, 1), 547.4),
        (reference::cap_ride(), (0, 1), 489.4),
        (reference::cap_splash(), (0, 1), 841.4),
    ] {
        let name = cap.name.clone();
        let got = mode_of(&build(&cap.round(), &BuildOptions::new(RATE)), m, n).frequency_hz;
        println!("{name} ({m},{n}): {got:.3} Hz, {:+.3} %", 100.0 * (got / hz - 1.0));
        assert!((got / hz - 1.0).abs() < 0.005, "{name} ({m},{n}): {got} Hz for {hz}");
    }
}

#[test]
fn a_timpani_head_without_its_kettle_has_the_measured_ratios() {
    let timpani = build(&heads::timpani_head(), &BuildOptions::new(RATE));
    let principal = mode_of(&timpani, 1, 1).frequency_hz;
    for (m, computed, measured) in [(2, 1.470, 1.48), (3, 1.922, 1.92), (4, 2.363, 2.36), (5, 2.797, 2.78)] {
        let ratio = mode_of(&timpani, m, 1).frequency_hz / principal;
        println!("({m},1): {ratio:.4} for {computed} computed, {measured} measured");
        assert!((ratio / computed - 1.0).abs() < 0.01, "({m},1): {ratio} for {computed}");
        assert!((ratio / measured - 1.0).abs() < 0.01, "({m},1): {ratio} for {measured}");
    }
}

#[test]
fn the_thud_of_a_timpani_dies_before_its_note() {
    let mut timpani = round_piece("timpani", RATE);
    let modes = timpani.modes();
    timpani.strike(&stroke(Striker::TimpaniMallet, 2.0, 0.75, 0.0));
    let level = |timpani: &mut Piece, n: u32| {
        let body = timpani.surface_mut().body();
        let orders = modes.iter().enumerate().filter(|(_, mode)| (mode.m, mode.n) == (n, 1));
        let motion = orders.map(|(k, mode)| {
            let omega = TAU * mode.frequency_hz;
            (body.velocity(k) / omega).powi(2) + f64::from(body.displacement(k)).powi(2)
        });
        motion.sum::<f64>().sqrt()
    };
    render(&mut timpani, 0.05, RATE);
    let early = [level(&mut timpani, 0), level(&mut timpani, 1)];
    render(&mut timpani, 0.25, RATE);
    let late = [level(&mut timpani, 0), level(&mut timpani, 1)];
    let lost = [0, 1].map(|n| decibels(early[n], late[n]));
    let t60 = [0, 1].map(|m| mode_of(&timpani, m, 1).t60);
    println!("T60 {t60:.3?} s; in 0.25 s the thud loses {:.1} dB, the note {:.1}", lost[0], lost[1]);
    assert!(lost[0] > lost[1] + 10.0, "{lost:?}");
}

#[test]
fn a_head_by_itself_rings_at_the_pitch_its_drum_is_asked_for() {
    for (piece, spec) in drums() {
        let context = context(&piece.round().lossless(), RATE);
        let mut drum = Drum::new(&spec.head_alone(), &context).unwrap();
        let DrumSpec { lowest_pitch_hz: low, pitch_hz: default, highest_pitch_hz: high, .. } = spec;
        for asked in [low, (low * default).sqrt(), default, (default * high).sqrt(), high] {
            drum.set_tuning(asked);
            drum.finish_controls();
            let named =
                drum.modes().into_iter().find(|mode| (mode.m, mode.n) == spec.pitch_of.mode()).unwrap();
            assert!(cents(named.frequency_hz, asked).abs() < 0.1, "{} Hz for {asked}", named.frequency_hz);
        }
    }
}

#[test]
fn a_cymbals_frequencies_scale_with_its_tuning() {
    for spec in standard().pieces.into_iter().filter(|piece| piece.instrument.kind() == Kind::Cymbal) {
        let name = spec.name.clone();
        let mut cymbal = build(&spec.round(), &BuildOptions::new(RATE));
        let before = mode_of(&cymbal, 3, 0).frequency_hz;
        for ratio in [0.5, 0.9, 1.3, 2.0] {
            cymbal.set_tuning(ratio);
            cymbal.finish_controls();
            let got = mode_of(&cymbal, 3, 0).frequency_hz / before;
            assert!(cents(got, ratio).abs() < 0.2, "{name}: {got} for {ratio}");
        }
    }
}

/// The drum with a narrow range about a pitch, so that its tables are of its own making; its modes as far up, and farther.
fn built_at(drum: &DrumSpec, pitch: f64) -> DrumSpec {
    // No head may have more than these, Hz.
    let farther = |hz: f64| (hz * 1.4 * pitch / drum.pitch_hz).min(4000.0);
    let mut built =
        DrumSpec { lowest_pitch_hz: 0.97 * pitch, pitch_hz: pitch, highest_pitch_hz: 1.03 * pitch, ..*drum };
    built.batter.modes_to_hz = farther(built.batter.modes_to_hz);
    built.resonant =
        built.resonant.map(|head| ResonantSpec { modes_to_hz: farther(head.modes_to_hz), ..head });
    built
}

#[test]
fn a_retuned_drum_is_the_drum_rebuilt_at_that_pitch() {
    for (piece, spec) in drums() {
        let context = context(&piece.round(), RATE);
        let DrumSpec { lowest_pitch_hz: low, pitch_hz: default, highest_pitch_hz: high, .. } = spec;
        let mut live = Drum::new(&spec, &context).unwrap();
        let mut worst = (0.0_f64, 0.0_f64);
        for pitch in [low, 0.47 * low + 0.53 * default, 0.55 * default + 0.45 * high, high] {
            live.set_tuning(pitch);
            live.finish_controls();
            let rebuilt = Drum::new(&built_at(&spec, pitch), &context).unwrap().modes();
            let live = live.modes();
            // Names can change hands where two modes of an order share their motion; frequencies cannot.
            // The rebuild's tables and head modes are its own. Higher up modes of heads and air pass each
            // other so closely that no table follows: by up to 25 cents at ten to twenty times the pitch.
            let audible =
                |mode: &&ModeInfo| mode.frequency_hz < 8.0 * pitch && mode.kind != ModeKind::Sampled;
            for a in live.iter().filter(audible) {
                let of_order = rebuilt.iter().filter(|b| b.m == a.m);
                let off = |b: &&ModeInfo| cents(a.frequency_hz, b.frequency_hz).abs();
                let b = of_order.min_by(|b, c| off(b).total_cmp(&off(c))).unwrap();
                worst = (worst.0.max(off(&b)), worst.1.max((a.t60 / b.t60 - 1.0).abs()));
                assert!(off(&b) < 2.0, "{pitch} Hz, {} ({}, {}): {} cents", a.body, a.m, a.n, off(&b));
            }
        }
        println!("{default} Hz drum, worst: {:.4} cents, T60 {:.2e}", worst.0, worst.1);
    }
}

/// Largest difference of neighbours.
fn steepest(sound: &[f32]) -> f64 {
    sound.windows(2).map(|pair| f64::from((pair[1] - pair[0]).abs())).fold(0.0, f64::max)
}

/// A step from one sample to the next that nobody hears, Pa: 86 dB under full scale.
const INAUDIBLE: f64 = 1e-3;

/// Tuning and muffling.
#[derive(Debug, Clone, Copy)]
struct Setting {
    tuning: f64,
    muffling: f64,
}

/// How much steeper a ringing piece becomes in the 50 ms after its controls are moved than it would
/// have been without, dB.
fn steepening(piece: &mut Piece, wait: f64, from: Setting, to: Setting) -> f64 {
    let mut ring = |then: Setting| {
        piece.set_tuning(from.tuning);
        piece.set_muffling(from.muffling);
        piece.reset();
        piece.strike(&stroke(Striker::Stick, 4.0, 0.4, 1.0));
        let before = render(piece, wait, RATE);
        piece.set_tuning(then.tuning);
        piece.set_muffling(then.muffling);
        let mut sound = render(piece, 0.05, RATE);
        sound.insert(0, before[before.len() - 1]);
        steepest(&sound)
    };
    let (moved, left) = (ring(to), ring(from));
    // A snare of 360 Hz sleeps within half a second: what is inaudible has not become steeper.
    if moved < INAUDIBLE { f64::NEG_INFINITY } else { decibels(moved, left) }
}

#[test]
fn tuning_and_muffling_moved_while_a_piece_rings_do_not_click() {
    for name in names() {
        let mut piece = piece(&name, RATE);
        let [low, default, high] = piece.tunings();
        let mut worst = f64::NEG_INFINITY;
        let open = Setting { tuning: default, muffling: 0.0 };
        let muffled = Setting { muffling: 1.0, ..open };
        let tuned = |tuning: f64| Setting { tuning, ..open };
        for wait in [0.1, 0.5] {
            for (from, to) in [
                (open, tuned(default * 1.06)),
                (open, tuned((default * 1.333).min(high))),
                (open, tuned(high)),
                (open, tuned(low)),
                (tuned(high), tuned(low)),
                (tuned(low), tuned(high)),
                (open, muffled),
                (muffled, open),
            ] {
                let steeper = steepening(&mut piece, wait, from, to);
                // Displacements do not jump; what is heard is their acceleration, in proportion to
                // the square of the frequency, and its slope to the cube.
                let owed = 60.0 * (to.tuning / from.tuning).log10().max(0.0);
                worst = worst.max(steeper - owed);
                assert!(steeper < owed + 6.0, "{name} after {wait} s, {from:?} to {to:?}: {steeper} dB");
            }
        }
        println!("{name}: {worst:+.1} dB");
    }
}
