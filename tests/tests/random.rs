//! Properties of random pieces within the accepted ranges: no energy is gained, numbers stay finite, and a drum that is
//! tuned while it plays equals a drum built at that pitch.
//!
//! Seeds are fixed, except for one that is new in every run and printed; `OVERHEAR_SEED` repeats it. Properties that are
//! known to fail for other seeds, docs/limits.md, keep to fixed ones.

use std::cell::Cell;

use overhear_engine::drum::{Drum, DrumSpec, HeadSpec, ResonantSpec};
use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::hi_hat::pair::Pair;
use overhear_engine::instrument::Instrument as _;
use overhear_engine::kit_spec::{Kind, PieceSpec};
use overhear_engine::piece::{BuildOptions, ModeInfo, ModeKind, Piece};
use overhear_engine::strike::Strike;
use overhear_tests::random::{self, RATE};
use overhear_tests::{Chance, build, cents, context, render, total_energy};

/// Runs a property over so many random bodies of every seed; a failure says which it was.
fn over(
    seeds: &[u64],
    bodies: usize,
    draw: fn(&mut Chance) -> PieceSpec,
    property: impl Fn(&PieceSpec, &mut Chance),
) {
    over_seeds(Chance::seeds(seeds), bodies, draw, property);
}

/// The same over these seeds and no other.
fn over_seeds(
    seeds: Vec<u64>,
    bodies: usize,
    draw: fn(&mut Chance) -> PieceSpec,
    property: impl Fn(&PieceSpec, &mut Chance),
) {
    for seed in seeds {
        let mut chance = Chance::new(seed);
        for body in 0..bodies {
            let spec = draw(&mut chance);
            let said =
                std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| property(&spec, &mut chance)));
            if let Err(panic) = said {
                println!("OVERHEAR_SEED={seed}, body {body}: {spec:#?}");
                std::panic::resume_unwind(panic);
            }
        }
    }
}

/// Any tuning, muffling and place of the pedal, at rest. Plates keep their own tuning where no mode may be lost: tuned up, their
/// highest are beyond the sample rate, and what strokes give to those is not counted.
fn set(piece: &mut Piece, chance: &mut Chance, all_modes: bool) {
    let [low, own, high] = piece.tunings();
    let any = low * (high / low).powf(chance.unit());
    piece.set_tuning(if all_modes && piece.kind() != Kind::Drum { own } else { any });
    if chance.happens(0.5) {
        piece.set_muffling(chance.unit());
    }
    piece.press_pedal(chance.unit(), SPEED.1);
    piece.reset();
}

/// Fastest strokes by which nothing may be gained, on a drum and on a plate, m/s: players reach 9 to 12. Faster ones have
/// thrown plates of unheard-of shape back with more than they brought, about one in a thousand.
fn fastest(spec: &PieceSpec) -> f64 {
    if spec.drum().is_some() { Strike::MAX_SPEED } else { 12.0 }
}

/// A stroke of any kind, the centre and the rim too.
fn stroke(chance: &mut Chance, fastest: f64) -> Strike {
    let radius = match chance.below(6) {
        0 => 0.0,
        1 => 1.0,
        _ => chance.unit(),
    };
    Strike { speed: chance.between(0.05, fastest), radius, ..chance.stroke(fastest) }
}

/// Energy that is there and has left over what was brought by strikers and, of a hi-hat, by the pedal and what the clamped
/// rims hold.
fn balance(piece: &mut Piece, at_rest: f64) -> f64 {
    let work = piece.surface_mut().attachment().map_or(0.0, Pair::pedal_work);
    (total_energy(piece) - at_rest - work) / piece.brought_energy()
}

/// Largest gain and largest loss of energy over 0.4 s of a stroke, shares of what was brought.
fn drift(piece: &mut Piece, strike: &Strike) -> [f64; 2] {
    let at_rest = piece.energy();
    piece.strike(strike);
    (0..20).fold([0.0, 0.0], |[gain, loss], _| {
        render(piece, 0.02, RATE);
        let off = balance(piece, at_rest) - 1.0;
        assert!(off.is_finite(), "{strike:?}");
        [off.max(gain), (-off).max(loss)]
    })
}

#[test]
fn without_losses_linear_random_pieces_keep_their_energy() {
    over_seeds(Chance::chosen(&[101, 102, 1007, 1008, 1009]), 15, random::piece, keeps_its_energy);
    over_seeds(Chance::chosen(&[301, 302]), 10, random::dotted, keeps_its_energy);
}

fn keeps_its_energy(spec: &PieceSpec, chance: &mut Chance) {
    let spec = spec.clone().lossless().linear();
    let mut piece = build(&spec, &BuildOptions::new(RATE));
    for _ in 0..3 {
        set(&mut piece, chance, true);
        let strike = stroke(chance, fastest(&spec));
        let [gain, loss] = drift(&mut piece, &strike);
        assert!(gain < 1e-3 && loss < 1e-3, "{strike:?}: gains {gain:.1e}, loses {loss:.1e}");
    }
}

/// What bends far yields, what its stretching holds is left when that rests, and where its scheme strays it is brought
/// back: all three take energy, of drums up to a sixth (`OVERHEAR_SEED=1`, body 3; docs/limits.md).
#[test]
fn without_losses_random_pieces_that_stretch_gain_nothing() {
    // Of 14 and 35, drums scatter more than their modes keep once the striker has left; of 53, a dome is stiffer than its plate.
    over_seeds(
        Chance::chosen(&[101, 102, 1007, 1008, 1009, 14, 35, 53]),
        15,
        random::piece,
        |spec, chance| {
            let mut piece = build(&spec.clone().lossless(), &BuildOptions::new(RATE));
            for _ in 0..3 {
                set(&mut piece, chance, true);
                let strike = stroke(chance, if spec.drum().is_some() { Strike::MAX_SPEED } else { 6.0 });
                let [gain, _] = drift(&mut piece, &strike);
                assert!(gain < 1e-3, "{strike:?}: gains {gain:.1e}");
            }
        },
    );
}

#[test]
fn no_strike_leaves_a_random_piece_faster_than_it_came() {
    // Of 36, a mallet throws one so far that its scheme is lost.
    over_seeds(Chance::chosen(&[3, 5, 6, 36]), 15, random::piece, lets_strikers_go);
    over_seeds(Chance::chosen(&[303, 304]), 10, random::dotted, lets_strikers_go);
}

fn lets_strikers_go(spec: &PieceSpec, chance: &mut Chance) {
    let mut piece = build(spec, &BuildOptions::new(RATE));
    for _ in 0..6 {
        set(&mut piece, chance, false);
        let strike = stroke(chance, fastest(spec));
        let at_rest = piece.energy();
        piece.strike(&strike);
        for waited in 0.. {
            render(&mut piece, 0.002, RATE);
            if piece.striker_energy() == 0.0 {
                break;
            }
            assert!(waited < 1000, "{strike:?}: still there");
            let share = balance(&mut piece, at_rest);
            assert!(share <= 1.0 + 1e-5, "{strike:?}: {share} of what was brought");
        }
        let ratio = f64::from(piece.last_strike().leaving_speed.abs()) / strike.speed;
        assert!(ratio <= 1.0, "{strike:?}: leaves {ratio} times as fast");
        assert_eq!(piece.quarantines(), 0);
    }
}

#[test]
fn a_roll_on_a_random_piece_leaves_no_more_energy_than_it_brought() {
    // Of 35, a dome is stiffer than its plate.
    over_seeds(Chance::chosen(&[105, 106, 6, 35]), 12, random::piece, |spec, chance| {
        let mut piece = build(spec, &BuildOptions::new(RATE));
        set(&mut piece, chance, false);
        let at_rest = piece.energy();
        for _ in 0..16 {
            piece.strike(&stroke(chance, 12.0));
            for _ in 0..1 + chance.below(20) {
                render(&mut piece, 64.0 / RATE, RATE);
                let share = balance(&mut piece, at_rest);
                assert!(share <= 1.0 + 1e-5, "{share} of what was brought");
            }
        }
        assert_eq!(piece.quarantines(), 0);
    });
}

/// Anything that can be asked of a piece.
fn act(piece: &mut Piece, chance: &mut Chance) {
    let [low, _, high] = piece.tunings();
    match chance.below(12) {
        0..5 => piece.strike(&stroke(chance, 25.0)),
        5 => piece.set_tuning(chance.between(0.5 * low, 1.5 * high)),
        6 => piece.set_muffling(chance.between(-0.5, 1.5)),
        7 => piece.set_preload(chance.between(0.0, 2.0)),
        8 => piece.throw_wires(chance.happens(0.5)),
        9 => piece.choke(chance.unit()),
        10 => piece.press_pedal(chance.unit(), chance.between(0.05, 2.5)),
        _ if chance.happens(0.5) => piece.stamp_pedal(chance.between(0.05, 2.5)),
        _ => piece.splash_pedal(chance.between(0.05, 2.5)),
    }
}

#[test]
fn random_events_on_random_pieces_leave_everything_finite() {
    over(&[7, 8], 15, random::piece, stays_finite);
    over(&[305], 10, random::dotted, stays_finite);
}

fn stays_finite(spec: &PieceSpec, chance: &mut Chance) {
    let mut piece = build(spec, &BuildOptions::new(RATE));
    for _ in 0..100 {
        act(&mut piece, chance);
        let sound = render(&mut piece, chance.between(1e-4, 0.01), RATE);
        assert!(sound.iter().all(|x| x.is_finite()));
        assert!(piece.energy().is_finite());
    }
    assert_eq!(piece.quarantines(), 0);
}

/// The drum with another range of pitches inside its own, and its own pitch in there; its heads' modes end as far above.
fn within(drum: &DrumSpec, [lowest, pitch, highest]: [f64; 3]) -> DrumSpec {
    let farther = (lowest * highest / (drum.lowest_pitch_hz * drum.highest_pitch_hz)).sqrt();
    let to = |hz: f64| (hz * farther).clamp(100.0, 4000.0);
    let batter = HeadSpec { modes_to_hz: to(drum.batter.modes_to_hz), ..drum.batter };
    let resonant = drum.resonant.map(|head| ResonantSpec { modes_to_hz: to(head.modes_to_hz), ..head });
    DrumSpec {
        lowest_pitch_hz: lowest,
        pitch_hz: pitch,
        highest_pitch_hz: highest,
        batter,
        resonant,
        ..*drum
    }
}

/// Half of what its heads' modes go up to, Hz: the highest have neighbours that are left out, in no two drums the same.
fn surely_to(drum: &DrumSpec) -> f64 {
    0.5 * drum.batter.modes_to_hz.min(drum.resonant.map_or(f64::INFINITY, |head| head.modes_to_hz))
}

/// Within a fifth: over two octaves the modes of some very wide and shallow drums pass each other so closely that the
/// tables take one for the other, one in some hundreds (the eighth of seed 10: docs/limits.md). So close to each other, a mode of a head and one of the air are
/// followed by some cents.
#[test]
fn a_random_drum_tuned_while_it_plays_within_a_fifth_is_the_drum_built_at_that_pitch() {
    let (close, compared) = (Cell::new(0), Cell::new(0));
    let one = |spec: &PieceSpec, chance: &mut Chance| {
        let spec = spec.clone().round();
        let drum = spec.drum().expect("a drum");
        let context = context(&spec, RATE);
        let [low, _, high] = drum.pitches();
        let ratio = (high / low).min(1.5);
        let lowest = low * (high / low / ratio).powf(chance.unit());
        let pitch = lowest * ratio.powf(chance.unit());
        let live = within(drum, [lowest, lowest * ratio.sqrt(), lowest * ratio]);
        let built = within(drum, [(0.985 * pitch).max(low), pitch, (1.015 * pitch).min(high)]);
        let highest = surely_to(&live).min(surely_to(&built)).min(4.0 * pitch);
        let modes = |drum: &DrumSpec| -> Vec<ModeInfo> {
            let mut drum = Drum::new(drum, &context).expect("a drum that can be");
            drum.set_tuning(pitch);
            drum.finish_controls();
            let of_drum =
                |mode: &ModeInfo| mode.kind != ModeKind::Sampled && !["rim", "shell"].contains(&mode.body);
            drum.modes().into_iter().filter(of_drum).collect()
        };
        let (live, built) = (modes(&live), modes(&built));
        for a in live.iter().filter(|mode| mode.frequency_hz < highest) {
            let off = |b: &ModeInfo| cents(a.frequency_hz, b.frequency_hz).abs();
            let off = built.iter().filter(|b| b.m == a.m).map(off).fold(f64::INFINITY, f64::min);
            assert!(off < 30.0, "{pitch} Hz, {} ({}, {}): {off} cents off", a.body, a.m, a.n);
            close.set(close.get() + u32::from(off < 2.0));
            compared.set(compared.get() + 1);
        }
    };
    over(&[9, 11], 8, random::drum, one);
    over_seeds(Chance::chosen(&[306]), 8, random::dotted, one);
    let (close, compared) = (close.get(), compared.get());
    println!("{close} of {compared} modes within 2 cents");
    assert!(compared > 50 && f64::from(close) > 0.97 * f64::from(compared), "{close} of {compared}");
}
