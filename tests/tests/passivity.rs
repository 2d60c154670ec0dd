//! Passivity: energy falls or stays, strikers leave no faster than they arrived, and numbers stay
//! finite for any input.

use std::cell::RefCell;

use overhear_engine::drum::HeadContact;
use overhear_engine::kit::Control;
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{
    Chance, build, kit, lossless_piece, names, piece, reference, render, render_into, spec, standard, stroke,
    total_energy,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

const RATE: f64 = 44_100.0;

#[test]
fn energy_falls_once_the_striker_has_left() {
    let mut worst = 0.0_f64;
    for name in names() {
        let mut piece = piece(&name, RATE);
        for striker in [Striker::Stick, Striker::YarnMallet] {
            piece.reset();
            piece.strike(&stroke(striker, 5.0, 0.55, 2.0));
            while piece.striker_energy() > 0.0 {
                render(&mut piece, 0.01, RATE);
            }
            let mut before = piece.energy();
            assert!(before > 0.0);
            for _ in 0..1500 {
                render(&mut piece, 32.0 / RATE, RATE);
                let after = piece.energy();
                worst = worst.max(after / before - 1.0);
                // A sample's rounding is 6e-8.
                assert!(after <= before * (1.0 + 1e-6), "{name}: {before} J, then {after} J");
                before = after;
            }
        }
    }
    println!("largest rise in a block: {worst:.1e}");
}

thread_local! {
    /// The reference bodies, then the pieces of the standard kit, and their names; building one for every case would take
    /// minutes.
    static PIECES: RefCell<Vec<(String, Piece)>> = RefCell::new({
        let specs = references().into_iter().chain(standard().pieces);
        specs.map(|spec| (spec.name.clone(), build(&spec, &BuildOptions::new(RATE)))).collect()
    });
}

/// Runs a property over cases that are the same every time.
fn check<T: std::fmt::Debug>(
    cases: u32,
    strategy: impl Strategy<Value = T>,
    property: impl Fn(T) -> Result<(), TestCaseError>,
) {
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 64, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    TestRunner::new_with_rng(config, rng).run(&strategy, property).unwrap_or_else(|error| panic!("{error}"));
}

fn any_stroke(fastest: f64) -> impl Strategy<Value = Strike> {
    // The very centre and the very rim too.
    let radius = prop_oneof![4 => 0.0..=1.0, 1 => Just(0.0), 1 => Just(1.0)];
    (0.01..=fastest, radius, 0.0..6.3, 0..Striker::ALL.len())
        .prop_map(|(speed, radius, angle, striker)| stroke(Striker::ALL[striker], speed, radius, angle))
}

/// Every reference body there is, in the order of the pieces they are of.
fn references() -> [PieceSpec; 9] {
    [
        reference::fixed_disc_kick(),
        reference::fixed_disc_snare(),
        reference::fixed_disc_rack_tom(),
        reference::fixed_disc_floor_tom(),
        reference::cap_crash(),
        reference::cap_ride(),
        reference::cap_splash(),
        reference::fixed_disc_timpani(),
        reference::cap_hi_hat(),
    ]
}

/// A piece, how far its tuning is along its range, and its muffling.
fn any_setting() -> impl Strategy<Value = (usize, f64, f64)> {
    (0..references().len() + standard().pieces.len(), 0.0..=1.0, prop_oneof![Just(0.0), 0.0..=1.0])
}

fn set(piece: &mut Piece, tuning: f64, muffling: f64) {
    let [low, _, high] = piece.tunings();
    piece.set_tuning(low * (high / low).powf(tuning));
    piece.set_muffling(muffling);
    piece.reset();
}

#[test]
fn no_strike_leaves_a_body_at_rest_faster_than_it_came() {
    let fastest = RefCell::new((0.0_f64, String::new()));
    check(600, (any_setting(), any_stroke(Strike::MAX_SPEED)), |((which, tuning, muffling), strike)| {
        PIECES.with_borrow_mut(|pieces| {
            let (name, piece) = &mut pieces[which];
            set(piece, tuning, muffling);
            piece.strike(&strike);
            let brought = piece.brought_energy();
            // A known fault (docs/limits.md): the stretching of a thin plate that a heavy beater bends by many times its thickness.
            let beaten = matches!(strike.striker, Striker::PlasticBeater | Striker::FeltBeater);
            let known = name == "splash" && beaten && strike.speed > 9.0;
            let most = if known { 2.5 } else { 1.0 + 1e-5 };
            let mut waited = 0;
            while piece.striker_energy() > 0.0 {
                render(piece, 0.002, RATE);
                waited += 1;
                prop_assert!(waited < 1000, "{name} {strike:?}: still there");
                prop_assert!(
                    total_energy(piece) <= brought * most,
                    "{name} {strike:?}: {} J of {brought}",
                    total_energy(piece)
                );
            }
            let ratio = f64::from(piece.last_strike().leaving_speed.abs()) / strike.speed;
            if ratio > fastest.borrow().0 {
                *fastest.borrow_mut() = (ratio, format!("{name} {strike:?}"));
            }
            prop_assert!(ratio <= 1.0, "{name} {strike:?}: {ratio}");
            prop_assert_eq!(piece.quarantines(), 0);
            Ok(())
        })
    });
    println!("leaving over arriving at most {:?}", fastest.borrow());
}

#[test]
fn a_roll_leaves_no_more_energy_than_it_brought() {
    let closest = RefCell::new(0.0_f64);
    let roll = proptest::collection::vec((any_stroke(12.0), 10_usize..3000), 12..24);
    check(48, (any_setting(), roll), |((which, tuning, muffling), roll)| {
        PIECES.with_borrow_mut(|pieces| {
            let (name, piece) = &mut pieces[which];
            set(piece, tuning, muffling);
            for (strike, wait) in roll {
                piece.strike(&strike);
                let brought = piece.brought_energy();
                let mut sound = [0.0; 64];
                for _ in 0..wait.div_ceil(64) {
                    render_into(piece, &mut sound);
                    let total = total_energy(piece);
                    let mut closest = closest.borrow_mut();
                    *closest = closest.max(total / brought);
                    prop_assert!(total <= brought * (1.0 + 1e-5), "{name}: {total} J of {brought}");
                }
            }
            prop_assert_eq!(piece.quarantines(), 0);
            Ok(())
        })
    });
    println!("energy about over energy brought, at most {:.7}", closest.borrow());
}

#[test]
fn several_strikers_at_once_keep_the_balance() {
    let mut worst = 0.0_f64;
    for (seed, name) in names().iter().enumerate() {
        let mut piece = lossless_piece(name, RATE);
        for round in 0..6 {
            let mut chance = Chance::new(1000 * seed as u64 + round);
            piece.reset();
            // More than there are places for, close to each other in place and time.
            for _ in 0..7 {
                let strike = Strike {
                    speed: chance.between(0.5, 8.0),
                    radius: chance.between(0.4, 0.6),
                    angle: chance.between(0.0, 0.3),
                    ..chance.stroke(1.0)
                };
                piece.strike(&strike);
                let brought = piece.brought_energy();
                let mut sound = [0.0; 4];
                for _ in 0..chance.below(12) {
                    render_into(&mut piece, &mut sound);
                    let off = (total_energy(&piece) / brought - 1.0).abs();
                    worst = worst.max(off);
                    assert!(off < 1e-4, "{name}: {off:.1e}");
                }
            }
            for _ in 0..138 {
                render(&mut piece, 32.0 / RATE, RATE);
                let off = (total_energy(&piece) / piece.brought_energy() - 1.0).abs();
                worst = worst.max(off);
                assert!(off < 1e-4, "{name}: {off:.1e}");
            }
        }
    }
    println!("worst: {worst:.1e}");
}

#[test]
fn a_lossless_drum_keeps_its_energy_for_a_second_from_1_to_25_m_s_centre_to_rim() {
    // The rounding of the `f32` state adds up, the more the more samples there are.
    for (rate, limit) in [(44_100.0, 3e-4), (96_000.0, 2e-3)] {
        let mut worst = (0.0_f64, String::new());
        for (slot, _) in standard().drums() {
            let name = &names()[slot.index()];
            let mut piece = lossless_piece(name, rate);
            let mut chance = Chance::new(slot.index() as u64);
            for speed in [1.0, 5.0, 25.0] {
                for radius in [0.0, 0.5, 1.0] {
                    let striker = chance.of(&Striker::ALL);
                    piece.reset();
                    let strike = stroke(striker, speed, radius, chance.between(0.0, 6.0));
                    piece.strike(&strike);
                    let brought = piece.brought_energy();
                    for _ in 0..20 {
                        render(&mut piece, 0.05, rate);
                        let off = (total_energy(&piece) / brought - 1.0).abs();
                        if off > worst.0 {
                            worst = (off, format!("{name} {strike:?}"));
                        }
                        assert!(off < limit, "{rate}: {off:.1e} off: {name} {strike:?}");
                    }
                }
            }
        }
        println!("{rate}: off by at most {worst:?}");
    }
}

/// The splash of the kit, and plates of 18 cm and 0.4 mm.
fn thin_plates() -> [PieceSpec; 3] {
    let splash = spec("splash");
    let thin = |hammering: bool| {
        let mut piece = splash.clone();
        let InstrumentSpec::Cymbal(cymbal) = &mut piece.instrument else { unreachable!() };
        (cymbal.diameter, cymbal.mass, cymbal.bell) = (0.18, 0.089, None);
        cymbal.hammering = cymbal.hammering.filter(|_| hammering);
        piece
    };
    [thin(false), thin(true), splash]
}

#[test]
fn heavy_beaters_on_thin_plates_leave_no_more_energy_than_they_brought() {
    let heavy = [Striker::FeltBeater, Striker::PlasticBeater, Striker::YarnMallet];
    for plate in thin_plates() {
        let mut piece = build(&plate, &BuildOptions::new(RATE));
        let mut chance = Chance::new(24);
        let mut most = 0.0_f64;
        for _ in 0..60 {
            let [low, _, high] = piece.tunings();
            piece.set_tuning(chance.between(low, high));
            piece.reset();
            let radius = if chance.happens(0.3) { 1.0 } else { chance.unit() };
            let strike = stroke(chance.of(&heavy), chance.between(2.0, 25.0), radius, 0.0);
            piece.strike(&strike);
            for _ in 0..100 {
                render(&mut piece, 0.002, RATE);
                let share = total_energy(&piece) / piece.brought_energy();
                most = most.max(share);
                assert!(share <= 1.0 + 1e-5, "{}: {share} of what was brought: {strike:?}", plate.name);
            }
        }
        println!("{}: at most {most} of what was brought", plate.name);
    }
}

#[test]
fn a_lossless_head_around_a_tip_keeps_the_energy_at_every_moment_of_the_contact() {
    // The slower a stroke, the smaller the patch that the head lies against the tip with.
    for (slot, drum) in standard().drums() {
        assert_eq!(drum.contact, HeadContact::Wraps);
        let name = &names()[slot.index()];
        let mut piece = lossless_piece(name, RATE);
        for (speed, striker) in [(0.5, Striker::Stick), (3.0, Striker::Stick), (12.0, Striker::PlasticBeater)]
        {
            piece.reset();
            piece.strike(&stroke(striker, speed, 0.3, 0.0));
            let brought = piece.brought_energy();
            let worst = (0..250).map(|_| {
                render(&mut piece, 4.0 / RATE, RATE);
                (total_energy(&piece) / brought - 1.0).abs()
            });
            let worst = worst.fold(0.0, f64::max);
            println!("{name}, {speed} m/s: off by at most {worst:.1e}");
            assert!(piece.last_strike().peak_force > 0.0 && worst < 1e-4, "{name}, {speed} m/s: {worst:.1e}");
        }
    }
}

#[test]
fn random_strikes_and_controls_leave_everything_finite() {
    let slots: Vec<Slot> = standard().slots().map(|(slot, _)| slot).collect();
    // A third of them at each rate.
    let mut chance = Chance::new(Chance::seeds(&[])[0]);
    for rate in [22_050.0, 44_100.0, 192_000.0] {
        let mut kit = kit(rate);
        let mut loudest = 0.0_f32;
        for _ in 0..500 {
            let slot = chance.of(&slots);
            match chance.below(4) {
                0 | 1 => kit.strike(slot, &chance.stroke(25.0)),
                2 => kit.set(Control::Muffling(slot), chance.between(-0.5, 1.5)),
                _ => {
                    let [low, _, high] = kit.piece(slot).expect("an installed piece").tunings();
                    kit.set(Control::Tuning(slot), chance.between(0.5 * low, 1.5 * high));
                }
            }
            let mut sound = [[0.0; 200]; 2];
            let frames = 1 + chance.below(200);
            let [left, right] = &mut sound;
            kit.render(&mut left[..frames], &mut right[..frames]);
            for &x in sound.as_flattened() {
                assert!(x.is_finite());
                loudest = loudest.max(x.abs());
            }
        }
        let mut seen = KitSnapshot::default();
        kit.snapshot(&mut seen);
        assert!(seen.pieces.iter().all(|piece| piece.quarantines == 0 && piece.energy.is_finite()));
        // Hundreds of strokes of up to 25 m/s: loud, but no run-away.
        println!("{rate}: peak {loudest}");
        assert!(loudest < 1000.0, "{loudest}");
    }
}
