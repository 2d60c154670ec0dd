//! The hi-hat: energy balance of the two cymbals and the pedal, and its sounds.

use std::cell::RefCell;

use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::hi_hat::pair::Pair;
use overhear_engine::hi_hat::rigid::Mount;
use overhear_engine::hi_hat::{HiHat, HiHatSpec, POINTS};
use overhear_engine::instrument::{Instrument as _, Pedal as _};
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::report::hi_hat::{Decay, PLACES, by_foot, decay, hold, sizzle_db};
use overhear_measure::spectra::PowerSpectrum;
use overhear_tests::{
    Chance, build, context, decibels, lossless_piece, piece, reference, render, render_into, render_surface,
    spec, stroke, total_energy,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

const RATE: f64 = 44_100.0;

fn pedal_work(hat: &mut Piece) -> f64 {
    hat.surface_mut().attachment::<Pair>().expect("a hi-hat").pedal_work()
}

/// The hi-hat of the standard kit, and one of caps as thick everywhere.
fn hats() -> [PieceSpec; 2] {
    [spec("hi-hat"), reference::cap_hi_hat()]
}

/// What the hi-hat of the standard kit is.
fn played() -> HiHatSpec {
    match spec("hi-hat").instrument {
        InstrumentSpec::HiHat(hat) => hat,
        other => panic!("{other:?}"),
    }
}

fn peak(sound: &[f32]) -> f64 {
    sound.iter().fold(0.0, |most, x| f64::from(x.abs()).max(most))
}

fn energy(sound: &[f32]) -> f64 {
    sound.iter().map(|x| f64::from(x * x)).sum()
}

fn edge(speed: f64) -> Strike {
    stroke(Striker::Stick, speed, 0.97, 0.3)
}

#[test]
fn without_losses_the_whole_keeps_its_energy_within_a_thousandth_over_a_second() {
    let strikes =
        [edge(4.0), stroke(Striker::Shoulder, 3.0, 1.0, 2.0), stroke(Striker::Stick, 6.0, 0.1, 0.0)];
    for hat in hats() {
        let (name, hat) = (&hat.name, &mut build(&hat.clone().lossless(), &BuildOptions::new(RATE)));
        for (pedal, strike) in PLACES.into_iter().flat_map(|pedal| strikes.map(|strike| (pedal, strike))) {
            hat.reset();
            hold(hat, pedal);
            hat.strike(&strike);
            let brought = total_energy(hat);
            let mut worst = 0.0_f64;
            for _ in 0..100 {
                render(hat, 0.01, RATE);
                worst = worst.max((total_energy(hat) / brought - 1.0).abs());
            }
            let landings = hat.rims().landings;
            println!("{name}, pedal {pedal}, {:?}: {worst:.1e}, {landings} landings", strike.striker);
            assert!(worst < 1e-3, "{name}, pedal {pedal}: {worst:e}");
            match pedal {
                0.0 => assert_eq!(landings, 0),
                p if p < 0.5 => {}
                _ => assert!(landings > 50, "pedal {pedal}: {landings} landings"),
            }
        }
    }
}

#[derive(Debug, Clone)]
enum Event {
    Strike(Strike),
    Press(f64, f64),
    Stamp(f64),
    Splash(f64),
    Arrive(f64),
}

fn any_event() -> impl Strategy<Value = Event> {
    let striker = prop::sample::select(&Striker::ALL[..8]);
    prop_oneof![
        4 => (0.1..12.0, 0.0..=1.0, 0.0..6.3, striker).prop_map(|(speed, radius, angle, striker)| {
            Event::Strike(Strike { speed, radius, angle, striker })
        }),
        3 => (0.0..=1.0, 0.05..2.5).prop_map(|(pedal, speed)| Event::Press(pedal, speed)),
        1 => (0.05..2.5).prop_map(Event::Stamp),
        1 => (0.05..2.5).prop_map(Event::Splash),
        3 => (0.0..=1.0).prop_map(Event::Arrive),
    ]
}

/// Energy that is there and has left, less what strikers and the pedal brought, J.
fn unpaid(hat: &mut Piece) -> f64 {
    let brought = hat.surface_mut().brought_energy();
    total_energy(hat) - brought - pedal_work(hat)
}

fn play(hat: &mut Piece, event: &Event) {
    match *event {
        Event::Strike(ref strike) => hat.strike(strike),
        Event::Press(pedal, speed) => hat.press_pedal(pedal, speed),
        Event::Stamp(speed) => hat.stamp_pedal(speed),
        Event::Splash(speed) => hat.splash_pedal(speed),
        Event::Arrive(pedal) => hat.arrive_pedal(pedal),
    }
}

#[test]
fn energy_never_rises_but_by_the_work_of_strikers_and_pedal() {
    let hats = hats().map(|hat| RefCell::new(build(&hat, &BuildOptions::new(RATE))));
    let events = (prop::collection::vec((any_event(), 1_usize..60), 1..10), any::<bool>());
    let config = Config { cases: 24, failure_persistence: None, max_shrink_iters: 32, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let run = |(events, cap): (Vec<(Event, usize)>, bool)| {
        let mut hat = hats[usize::from(cap)].borrow_mut();
        hat.press_pedal(0.0, SPEED.1);
        hat.reset();
        let mut before = unpaid(&mut hat);
        let mut largest = 0.0_f64;
        for (event, blocks) in &events {
            play(&mut hat, event);
            for _ in 0..*blocks {
                let out = render(&mut hat, 32.0 / RATE, RATE);
                prop_assert!(out.iter().all(|x| x.is_finite()));
                if hat.is_asleep() {
                    // All accounts begin anew.
                    prop_assert!(hat.energy() < 1e-9);
                    before = unpaid(&mut hat);
                    continue;
                }
                let after = unpaid(&mut hat);
                largest = largest.max(hat.energy() + hat.surface_mut().brought_energy());
                // Of single precision, over what has gone through it.
                prop_assert!(
                    after - before < 1e-6 * largest + 1e-12,
                    "{event:?}: {before} J, then {after} J"
                );
                before = after;
            }
        }
        prop_assert_eq!(hat.quarantines(), 0);
        Ok(())
    };
    TestRunner::new_with_rng(config, rng).run(&events, run).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn without_losses_the_pedal_s_work_is_all_that_is_gained() {
    let mut hat = lossless_piece("hi-hat", RATE);
    let mut chance = Chance::new(8);
    for _ in 0..6 {
        hat.press_pedal(0.0, SPEED.1);
        hat.reset();
        hat.strike(&edge(4.0));
        let mut largest = 0.0_f64;
        for _ in 0..8 {
            hat.press_pedal(chance.unit(), chance.between(0.1, 2.0));
            render(&mut hat, 0.05, RATE);
            largest = largest.max(hat.energy());
        }
        let (error, work) = (unpaid(&mut hat), pedal_work(&mut hat));
        println!("pedal's work {work:.4} J of {largest:.4} J, unexplained {error:.1e} J");
        assert!(error.abs() < 1e-3 * largest, "{error} J of {largest} J");
        assert!(work.abs() > 1e-3, "the pedal has worked: {work} J");
    }
}

#[test]
fn swapped_and_upside_down_two_equal_cymbals_move_the_same() {
    let context = context(&spec("hi-hat").lossless().linear().round(), RATE);
    let spec = HiHatSpec { bottom: played().top, seat: played().clutch, ..played() };
    // As far below the touching place as the tilt: one side is pressed.
    let motion = |swapped: bool| {
        let mut hat = HiHat::new(&spec, &context).expect("a hi-hat");
        hat.press(0.62, SPEED.1);
        hat.finish_controls();
        let surface = hat.surface_mut();
        let count = surface.body().len();
        let bent: Vec<f32> =
            (0..count).map(|k| 2e-5 * ((k * k % 13) as f32 - 6.0) / (1.0 + k as f32)).collect();
        let pair = surface.attachment_mut::<Pair>().expect("a pair");
        if swapped {
            let mirrored: Vec<f32> = bent.iter().map(|q| -q).collect();
            pair.bottom_mut().set_displacements(&mirrored);
            pair.rigid_mut()[1].set_speed([-0.1, 0.05, -0.02]);
        } else {
            surface.body_mut().set_displacements(&bent);
            surface.attachment_mut::<Pair>().expect("a pair").rigid_mut()[0].set_speed([0.1, -0.05, 0.02]);
        }
        surface.wake();
        render_surface(surface, 560);
        let pair = surface.attachment::<Pair>().expect("a pair");
        let [top, bottom] = [surface.body(), pair.bottom()]
            .map(|body| (0..count).map(|k| f64::from(body.displacement(k))).collect::<Vec<f64>>());
        let rest = pair.foot().place();
        let [a, b] = [pair.rigid()[0].place(), pair.rigid()[1].place()];
        (top, bottom, [a[0] - rest, a[1], a[2]], b, *pair.forces(), pair.landings().landings)
    };
    let (top, bottom, stiff_top, stiff_bottom, forces, landings) = motion(false);
    let (other_top, other_bottom, other_stiff_top, other_stiff_bottom, other_forces, _) = motion(true);
    assert!(landings > 5 && forces.iter().any(|&force| force > 0.0), "{landings} landings, {forces:?}");
    let largest = top.iter().chain(&bottom).fold(0.0_f64, |most, q| most.max(q.abs()));
    for k in 0..top.len() {
        assert!(
            (top[k] + other_bottom[k]).abs() < 1e-4 * largest,
            "mode {k}: {} {}",
            top[k],
            other_bottom[k]
        );
        assert!(
            (bottom[k] + other_top[k]).abs() < 1e-4 * largest,
            "mode {k}: {} {}",
            bottom[k],
            other_top[k]
        );
    }
    for i in 0..3 {
        assert!((stiff_top[i] + other_stiff_bottom[i]).abs() < 1e-7, "{stiff_top:?} {other_stiff_bottom:?}");
        assert!((stiff_bottom[i] + other_stiff_top[i]).abs() < 1e-7, "{stiff_bottom:?} {other_stiff_top:?}");
    }
    let most = forces.iter().fold(0.0_f64, |most, x| most.max(*x));
    for j in 0..POINTS {
        assert!((forces[j] - other_forces[j]).abs() < 1e-3 * most, "place {j}");
    }
}

#[test]
fn the_farther_down_the_pedal_the_shorter_the_sound() {
    let mut hat = piece("hi-hat", RATE);
    let mut before = f64::INFINITY;
    for pedal in PLACES {
        let Decay { octaves: decays, mean, centroid_ms: centroid, landings } = decay(&mut hat, pedal);
        assert_eq!(decays.len(), 5);
        println!(
            "pedal {pedal:.2}: T60 {decays:.2?} s, mean {mean:.3} s, centroid {centroid:.0} ms, {landings} landings"
        );
        // As long as rims hardly meet, the pedal hardly changes anything; what swings does not fall evenly.
        let apart = pedal < 0.3 && landings < 100 && (mean / before - 1.0).abs() < 0.05;
        // Nor does it much once they are firmly pressed.
        let firm = pedal > 0.9 && mean < 1.1 * before;
        assert!(mean < before || apart || firm, "pedal {pedal}: {mean} s after {before} s");
        before = mean;
        match pedal {
            p if p < 0.3 => {
                assert!((2.0..5.0).contains(&mean) && centroid > 90.0, "open: {mean} s, {centroid} ms")
            }
            p if p > 0.8 => assert!((0.25..0.5).contains(&mean) && centroid < 51.0, "closed: {mean} s"),
            _ => {}
        }
    }
}

/// What two public sets of recorded closed hi-hats have from 300 Hz to 1 kHz, 5 to 80 ms after a stroke, is -10 to -1 dB of all.
#[test]
fn the_air_between_closed_cymbals_gives_them_a_body() {
    let mut hat = piece("hi-hat", RATE);
    let (mut body, mut all) = (0.0, 0.0);
    for (speed, angle) in
        [2.0, 4.0, 7.0].into_iter().flat_map(|speed| [0.0, 1.0, 2.0].map(|angle| (speed, angle)))
    {
        hat.reset();
        hold(&mut hat, 0.75);
        hat.strike(&stroke(Striker::Shoulder, speed, 0.97, angle));
        render(&mut hat, 0.005, RATE);
        let heard = PowerSpectrum::new(&render(&mut hat, 0.075, RATE), RATE);
        // Each stroke counts as much as any.
        let whole = heard.band(100.0, 16_000.0);
        (body, all) = (body + heard.band(300.0, 1000.0) / whole, all + 1.0);
    }
    let body = 10.0 * f64::log10(body / all);
    println!("{body:.1} dB from 300 Hz to 1 kHz");
    assert!((-12.0..0.0).contains(&body), "{body} dB");
}

#[test]
fn half_open_it_sizzles() {
    let ([over_open, over_closed], [silent, landings, few]) = sizzle_db(&mut piece("hi-hat", RATE));
    println!("{landings} landings; above 5 kHz {over_open:.1} dB over open, {over_closed:.1} dB over closed");
    assert!(silent == 0 && landings > 200, "{silent} {landings} {few}");
    assert!(over_open > 3.0 && over_closed > 3.0, "{over_open} dB, {over_closed} dB");
}

/// Stamps and splashes ever faster, each this many times louder than the slower one at least.
fn by_foot_alone(hat: &PieceSpec, louder: f64) {
    let (name, mut hat) = (&hat.name, build(hat, &BuildOptions::new(RATE)));
    let mut quieter = [0.0; 2];
    for speed in [0.2, 0.5, 1.0, 2.0] {
        let (chick, held) = by_foot(&mut hat, |hat| hat.stamp_pedal(speed));
        let (splash, rings) = by_foot(&mut hat, |hat| hat.splash_pedal(speed));
        println!(
            "{name}, {speed} m/s: chick {chick:.2} Pa, {held:.2} s; splash {splash:.2} Pa, {rings:.2} s"
        );
        assert!(chick > louder * quieter[0] && splash > louder * quieter[1], "{name}, {speed} m/s");
        assert!(held < 0.3, "{name}: a held chick lasts {held} s");
        assert!(rings > 0.8, "{name}: a splash rings {rings} s");
        quieter = [chick, splash];
    }
}

#[test]
fn chick_and_splash_sound_from_the_pedal_alone_and_louder_when_faster() {
    by_foot_alone(&spec("hi-hat"), 1.2);
}

#[test]
fn chick_and_splash_of_a_cap_hi_hat_are_a_fifth_louder_when_faster() {
    by_foot_alone(&reference::cap_hi_hat(), 1.2);
}

/// Without the cymbals' motion as a whole it is -44 dB, and recorded ones have -21 to -4.
#[test]
fn a_chick_has_a_body_below_300_hz_and_of_the_foot_s_way_only_the_air_is_heard() {
    let mut hat = piece("hi-hat", RATE);
    for speed in [0.5, 1.0, 2.0] {
        hat.reset();
        hold(&mut hat, 0.0);
        hat.stamp_pedal(speed);
        let mut way = 0.0_f64;
        while hat.rims().landings == 0 {
            let heard = render(&mut hat, 1e-4, RATE);
            if hat.rims().landings == 0 {
                way = way.max(peak(&heard));
            }
        }
        let chick = render(&mut hat, 0.5, RATE);
        let way = way / peak(&chick);
        let chick = PowerSpectrum::new(&chick, RATE);
        let share = 10.0 * (chick.band(100.0, 300.0) / chick.band(20.0, 20_000.0)).log10();
        println!("{speed} m/s: {share:.1} dB from 100 to 300 Hz, the way {way:.3} as loud");
        assert!(share > -38.0 && share < -10.0, "{speed} m/s: {share} dB");
        // What is pressed out of the gap is heard, the cymbals and the foot are not.
        assert!(way < 0.1, "{speed} m/s: {way} of it on the way");
    }
}

#[test]
fn an_upper_cymbal_that_hangs_loosely_meets_the_lower_one_more_often() {
    // Landings within a second of a stroke that leaves the rims apart.
    let landings = |clutch| {
        let instrument = InstrumentSpec::HiHat(HiHatSpec { clutch, ..played() });
        let mut hat = build(&PieceSpec { instrument, ..spec("hi-hat") }, &BuildOptions::new(RATE));
        hold(&mut hat, 0.4);
        hat.strike(&edge(5.0));
        render(&mut hat, 1.0, RATE);
        hat.rims().landings
    };
    let loose = played().clutch;
    let tight = Mount { rock_hz: 6.0, rock_q: None, ..loose };
    let [loose, tight] = [loose, tight].map(landings);
    println!("{loose} landings, clamped {tight}");
    assert!(loose > 100 && 2 * loose > 3 * tight, "{loose}, {tight}");
}

#[test]
fn a_foot_that_a_note_calls_for_ends_the_ringing_without_a_click_and_leaves_closed_cymbals_at_rest() {
    let steepest =
        |sound: &[f32]| sound.windows(2).fold(0.0_f32, |most, two| most.max((two[1] - two[0]).abs()));
    let shoulder = |speed| stroke(Striker::Shoulder, speed, 0.97, 0.0);
    for speed in [0.8, 1.4, 2.7, 5.2] {
        let mut hat = piece("hi-hat", RATE);
        hat.arrive_pedal(0.8);
        hat.strike(&shoulder(speed));
        let struck = energy(&render(&mut hat, 0.02, RATE));
        hat.press_pedal(0.4, SPEED.1);
        hat.reset();
        hat.strike(&shoulder(speed));
        render(&mut hat, 0.15, RATE);
        let before = render(&mut hat, 0.04, RATE);
        hat.arrive_pedal(0.8);
        let fade = render(&mut hat, 0.00025, RATE);
        let after = render(&mut hat, 0.04, RATE);
        let click = f64::from(steepest(&fade) / steepest(&before));
        let left = 10.0 * (energy(&after) / struck).log10();
        println!("{speed} m/s: fade {click:.2} as steep, {left:.0} dB of a stroke left");
        assert!(click < 1.0 && click > 0.01, "{speed} m/s: {click} times as steep as the ringing");
        assert!(left < -60.0, "{speed} m/s: {left} dB of a stroke sound after the fade");
        hat.strike(&shoulder(speed));
        let ratio = energy(&render(&mut hat, 0.02, RATE)) / struck;
        assert!((ratio - 1.0).abs() < 0.05, "{speed} m/s: {ratio} of a stroke on closed cymbals");
    }
}

#[test]
fn a_still_pedal_is_still_and_silent_wherever_it_is() {
    let mut hat = piece("hi-hat", RATE);
    for pedal in PLACES {
        hat.reset();
        hold(&mut hat, pedal);
        assert!(hat.energy().abs() < 1e-12, "pedal {pedal}: {} J", hat.energy());
        assert!(render(&mut hat, 0.1, RATE).iter().all(|&x| x == 0.0), "pedal {pedal}");
        if pedal < 0.6 {
            // Open cymbals ring for as long as single precision tells them from silence.
            continue;
        }
        hat.strike(&edge(3.0));
        render(&mut hat, 4.0, RATE);
        assert!(render(&mut hat, 0.1, RATE).iter().all(|&x| x == 0.0), "pedal {pedal} after a stroke");
    }
}

#[test]
fn a_pedal_moved_slowly_makes_no_click() {
    let mut hat = piece("hi-hat", RATE);
    hold(&mut hat, 0.75);
    let mut loudest = 0.0_f32;
    for step in 0..60 {
        hat.press_pedal(0.75 + 0.25 * f64::from(step) / 60.0, SPEED.1);
        let out = render(&mut hat, 0.02, RATE);
        loudest = out.iter().fold(loudest, |most, x| most.max(x.abs()));
    }
    let mut struck = piece("hi-hat", RATE);
    hold(&mut struck, 0.75);
    struck.strike(&edge(0.5));
    let soft = render(&mut struck, 0.2, RATE).iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    let under = decibels(f64::from(loudest), f64::from(soft));
    println!("from light to full clamping within 1.2 s: {under:.0} dB under a soft stroke");
    assert!(under < -30.0, "{under} dB");
}

#[test]
fn time_may_be_cut_anywhere_while_the_pedal_moves() {
    let mut whole = piece("hi-hat", RATE);
    let mut cut = piece("hi-hat", RATE);
    let act = |hat: &mut Piece, at: usize| match at {
        1000 => hat.strike(&edge(4.0)),
        3333 => hat.press_pedal(0.9, 1.5),
        7001 => hat.strike(&edge(2.0)),
        9100 => hat.splash_pedal(1.0),
        10_015 => {
            hat.arrive_pedal(0.8);
            hat.strike(&edge(3.0));
        }
        10_050 => hat.press_pedal(0.7, 1.0),
        11_111 => hat.arrive_pedal(0.3),
        12_500 => hat.stamp_pedal(0.8),
        _ => {}
    };
    let moments = [0, 1000, 3333, 7001, 9100, 10_015, 10_050, 11_111, 12_500, 20_000];
    let mut chance = Chance::new(3);
    let (mut a, mut b) = (vec![0.0; 20_000], vec![0.0; 20_000]);
    for window in moments.windows(2) {
        act(&mut whole, window[0]);
        render_into(&mut whole, &mut a[window[0]..window[1]]);
        act(&mut cut, window[0]);
        let mut at = window[0];
        while at < window[1] {
            let to = (at + 1 + chance.below(50)).min(window[1]);
            render_into(&mut cut, &mut b[at..to]);
            at = to;
        }
    }
    assert!(a == b, "differs first at {:?}", a.iter().zip(&b).position(|(a, b)| a != b));
    assert!(a.iter().any(|x| x.abs() > 0.1));
}

#[test]
fn a_tiny_rim_or_a_huge_tilt_is_refused_by_name() {
    let context = context(&spec("hi-hat"), RATE);
    let refused = |spec: HiHatSpec| HiHat::new(&spec, &context).err().expect("refused").to_string();
    assert!(refused(HiHatSpec { edge: 0.0, ..played() }).contains("rim"));
    assert!(refused(HiHatSpec { tilt: 1.0, ..played() }).contains("tilt"));
}
