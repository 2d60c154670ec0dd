//! Stacks of two cymbals: what presses them together, their energy, how they sound beside one cymbal.

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::kit_spec::{InstrumentSpec, Kind, PieceSpec};
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{build, render, spec, stroke, total_energy};

const RATE: f64 = 44_100.0;
const INCH: f64 = 0.0254;

/// A cymbal of the hi-hat at that diameter, of the same thickness and form, m.
fn cut(like: CymbalSpec, diameter: f64) -> CymbalSpec {
    let by = diameter / like.diameter;
    let bell =
        like.bell.map(|bell| overhear_engine::plate::Bell { radius: by * bell.radius, rise: by * bell.rise });
    CymbalSpec { diameter, mass: by * by * like.mass, bow: by * like.bow, bell, ..like }
}

/// A stack of the hi-hat's cymbals cut to those diameters (in), pressed by a force (N).
fn stack(inches: [f64; 2], pressed: f64) -> PieceSpec {
    let hat = match spec("hi-hat").instrument {
        InstrumentSpec::HiHat(hat) => hat,
        other => panic!("{other:?}"),
    };
    let [top, bottom] = [(hat.top, inches[0]), (hat.bottom, inches[1])].map(|(c, d)| cut(c, d * INCH));
    let instrument = InstrumentSpec::HiHat(HiHatSpec { top, bottom, pressed: Some(pressed), ..hat });
    let piece = PieceSpec { instrument, ..spec("hi-hat") };
    assert_eq!(piece.check(), Ok(()));
    assert_eq!(piece.instrument.kind(), Kind::Cymbal, "it is played as a cymbal");
    piece
}

fn built(spec: &PieceSpec) -> Piece {
    build(spec, &BuildOptions::new(RATE))
}

fn strikes() -> [Strike; 3] {
    [
        stroke(Striker::Stick, 5.0, 0.97, 0.3),
        stroke(Striker::Shoulder, 3.0, 1.0, 2.0),
        stroke(Striker::Stick, 6.0, 0.1, 0.0),
    ]
}

/// Time after which a hundredth of a stroke's sound is left, s.
fn fall(piece: &mut Piece) -> f64 {
    piece.strike(&strikes()[0]);
    let sound = render(piece, 8.0, RATE);
    let all: f64 = sound.iter().map(|x| f64::from(x * x)).sum();
    let mut left = all;
    let ended = sound.iter().position(|x| {
        left -= f64::from(x * x);
        left < 0.01 * all
    });
    ended.expect("it ends") as f64 / RATE
}

#[test]
fn a_nut_presses_with_the_force_that_is_asked_for_whatever_the_sizes() {
    for inches in [[14.0, 14.0], [10.0, 14.0], [8.0, 16.0]] {
        for pressed in [2.0, 20.0, 150.0] {
            let mut piece = built(&stack(inches, pressed));
            let clamped = f64::from(piece.rims().clamped);
            assert!((clamped / pressed - 1.0).abs() < 1e-3, "{inches:?}: {clamped} of {pressed} N");
            // At rest it is still and silent.
            assert!(render(&mut piece, 0.2, RATE).iter().all(|x| *x == 0.0), "{inches:?}");
        }
    }
}

#[test]
fn without_losses_a_stack_keeps_its_energy_within_a_thousandth_over_a_second() {
    for inches in [[14.0, 14.0], [10.0, 14.0]] {
        let mut piece = built(&stack(inches, 20.0).lossless());
        for strike in strikes() {
            piece.reset();
            piece.strike(&strike);
            let brought = total_energy(&piece);
            for _ in 0..100 {
                render(&mut piece, 0.01, RATE);
                let kept = total_energy(&piece) / brought - 1.0;
                assert!(kept.abs() < 1e-3, "{inches:?}, {:?}: {kept:e}", strike.striker);
            }
            let landings = piece.rims().landings;
            assert!(landings > 50, "{inches:?}, {:?}: {landings} landings", strike.striker);
        }
    }
}

#[test]
fn a_stack_loses_energy_only_and_sleeps() {
    let mut piece = built(&stack([10.0, 13.0], 8.0));
    for strike in strikes() {
        piece.strike(&strike);
        let mut held = total_energy(&piece);
        for _ in 0..400 {
            render(&mut piece, 0.005, RATE);
            let now = total_energy(&piece);
            assert!(now <= held * (1.0 + 1e-6) + 1e-12, "{now} after {held} J");
            held = now;
        }
    }
    let mut waited = 0.0;
    while !piece.is_asleep() {
        render(&mut piece, 0.1, RATE);
        waited += 0.1;
        assert!(waited < 30.0, "awake");
    }
}

#[test]
fn a_stack_is_shorter_than_its_cymbals_apart_and_the_harder_pressed_the_shorter() {
    let falls = [1.0, 10.0, 100.0].map(|pressed| fall(&mut built(&stack([10.0, 14.0], pressed))));
    let mut apart = built(&PieceSpec { instrument: open(stack([10.0, 10.0], 10.0)), ..spec("hi-hat") });
    let alone = fall(&mut apart);
    println!("99 % of the sound within {falls:.3?} s pressed by 1, 10, 100 N, {alone:.3} s apart");
    assert!(alone > 1.5 * falls[0] && alone > 4.0 * falls[1], "{alone} {falls:?}");
    assert!(falls[0] > 1.2 * falls[1] && falls[1] > 1.2 * falls[2], "{falls:?}");
}

/// The same cymbals as a hi-hat, whose pedal is up.
fn open(stack: PieceSpec) -> InstrumentSpec {
    match stack.instrument {
        InstrumentSpec::HiHat(hat) => InstrumentSpec::HiHat(HiHatSpec { pressed: None, ..hat }),
        other => other,
    }
}

#[test]
fn pedals_do_not_move_a_stack() {
    let play = |step: &dyn Fn(&mut Piece)| {
        let mut piece = built(&stack([10.0, 14.0], 20.0));
        step(&mut piece);
        piece.strike(&strikes()[0]);
        render(&mut piece, 0.2, RATE)
    };
    let still = play(&|_| ());
    assert!(still.iter().any(|x| *x != 0.0));
    assert_eq!(still, play(&|piece| piece.press_pedal(0.0, 1.0)));
    assert_eq!(still, play(&|piece| piece.stamp_pedal(2.0)));
    assert_eq!(still, play(&|piece| piece.arrive_pedal(1.0)));
}

#[test]
fn a_lower_cymbal_that_the_upper_one_cannot_stand_on_is_refused() {
    let hat = |inches: [f64; 2]| match stack([10.0, 12.0], 20.0).instrument {
        InstrumentSpec::HiHat(hat) => HiHatSpec {
            top: cut(hat.top, inches[0] * INCH),
            bottom: cut(hat.bottom, inches[1] * INCH),
            ..hat
        },
        other => panic!("{other:?}"),
    };
    for inches in [[14.0, 10.0], [8.0, 18.0]] {
        let refused = hat(inches).check().unwrap_err().to_string();
        assert!(refused.contains("bottom.diameter_m"), "{refused}");
    }
    let refused = HiHatSpec { pressed: Some(500.0), ..hat([10.0, 12.0]) }.check().unwrap_err().to_string();
    assert!(refused.contains("pressed_n is 500") && refused.contains("200"), "{refused}");
}
