//! The cascade of cymbals above the modes that their stretching couples: what is played beside what is bounced.

use std::f64::consts::TAU;

use nalgebra::Complex;
use overhear_engine::block::BLOCK;
use overhear_engine::fitted::ENERGY_TRANSPORT;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::modal::Mode;
use overhear_engine::piece::{BuildOptions, Quality};
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::spectra::third_octaves::{third_octaves, worst_difference};
use overhear_tests::{build, render_into, spec, stroke};

const RATE: f64 = 44_100.0;

fn options() -> BuildOptions {
    BuildOptions::new(RATE)
}

fn hit(speed: f64, radius: f64, striker: Striker) -> Strike {
    stroke(striker, speed, radius, 0.3)
}

/// The strokes of the ordinary notes: piece, radius, striker.
const ORDINARY: [(&str, f64, Striker); 3] =
    [("crash", 0.97, Striker::Shoulder), ("ride", 0.60, Striker::Stick), ("splash", 0.95, Striker::Stick)];

/// Third octaves from 25 Hz to 16 kHz of the first second of a stroke, dB, with a share of the transport's constant.
fn second(cymbal: &PieceSpec, strike: &Strike, quality: Quality, transport: f64) -> Vec<f64> {
    let mut piece = build(cymbal, &BuildOptions { quality, ..options() });
    piece.surface_mut().transport_mut().unwrap().set_rate(transport * ENERGY_TRANSPORT);
    piece.strike(strike);
    third_octaves(&overhear_tests::render(&mut piece, 1.0, RATE), RATE)
}

/// Third octaves from the one of 2 kHz, where the coupled modes end during playback.
const ABOVE_COUPLED: usize = 19;

#[test]
fn what_is_played_is_within_4_5_db_of_what_is_bounced_in_every_third_octave_from_2_to_16_khz() {
    // Root mean squares of the differences with and without the transport, over all bands and strokes.
    let (mut with, mut without) = (0.0, 0.0);
    let mut count = 0.0;
    for (name, radius, striker) in ORDINARY {
        let cymbal = spec(name);
        for speed in [1.5, 3.0, 6.0] {
            let strike = hit(speed, radius, striker);
            let bounced = second(&cymbal, &strike, Quality::Offline, 1.0);
            let apart = |transport: f64| -> Vec<f64> {
                let played = second(&cymbal, &strike, Quality::Standard, transport);
                played[ABOVE_COUPLED..].iter().zip(&bounced[ABOVE_COUPLED..]).map(|(a, b)| a - b).collect()
            };
            let (now, before) = (apart(1.0), apart(0.0));
            println!("{name}, {speed} m/s: {now:.1?} dB, without the transport {before:.1?} dB");
            assert!(now.iter().all(|apart| apart.abs() < 4.5), "{name}, {speed} m/s: {now:.1?} dB");
            with += now.iter().map(|apart| apart * apart).sum::<f64>();
            without += before.iter().map(|apart| apart * apart).sum::<f64>();
            count += now.len() as f64;
        }
    }
    let [with, without] = [with, without].map(|sum: f64| (sum / count).sqrt());
    println!("{with:.2} dB, without the transport {without:.2} dB");
    assert!(with < 1.4, "{with} dB");
    assert!(without > 4.0, "{without} dB");
}

#[test]
fn the_transport_moves_no_band_of_a_soft_stroke_by_a_tenth_of_a_decibel() {
    for (name, radius, striker) in ORDINARY {
        let strike = hit(0.3, radius, striker);
        let [with, without] = [1.0, 0.0].map(|share| second(&spec(name), &strike, Quality::Standard, share));
        let worst = worst_difference(&with, &without);
        println!("{name}: {worst:.3} dB");
        assert!(worst < 0.1, "{name}: {worst} dB");
    }
}

#[test]
fn a_thousand_strokes_drain_as_much_from_the_coupled_modes_as_comes_above_them() {
    let mut piece = build(&spec("crash"), &options());
    let mut brought = 0.0;
    for number in 0..1000 {
        piece.strike(&hit(4.0, 0.9, if number % 2 == 0 { Striker::Stick } else { Striker::Shoulder }));
        overhear_tests::render(&mut piece, 0.05, RATE);
        brought = piece.brought_energy();
        let balance = piece.surface_mut().transport().unwrap().balance();
        assert!(balance.surplus().abs() <= 1e-6 * balance.drained.abs(), "stroke {number}: {balance:?}");
        assert!(balance.injected <= brought && balance.pending >= 0.0, "{balance:?} of {brought} J");
    }
    let balance = piece.surface_mut().transport().unwrap().balance();
    println!("{balance:?} of {brought} J, surplus {:.1e} J", balance.surplus());
    assert!(balance.drained > 0.01 * brought, "{balance:?} of {brought} J");
    // Nearly nothing has to wait.
    assert!(balance.spent < 0.01 * balance.drained, "{balance:?}");
    assert_eq!(piece.quarantines(), 0);
}

/// How much of their phase the modes from 2.4 to 8 kHz lose in 16 ms, from 0.15 to 0.35 s after a stroke: one less the median of
/// their coherence.
fn incoherence(cymbal: &PieceSpec, strike: &Strike, quality: Quality) -> f64 {
    let mut piece = build(cymbal, &BuildOptions { quality, ..options() });
    let modes = piece.surface_mut().body().modes().to_vec();
    let within: Vec<usize> =
        (0..modes.len()).filter(|&k| (2400.0..8000.0).contains(&(modes[k].omega / TAU))).collect();
    piece.strike(strike);
    overhear_tests::render(&mut piece, 0.15, RATE);
    let (mut course, block) = (Vec::new(), BLOCK as f64 / RATE);
    for step in 0..(0.2 / block) as usize {
        let mut out = [0.0; BLOCK];
        render_into(&mut piece, &mut out);
        let body = piece.surface_mut().body();
        let time = step as f64 * block;
        // What is left of each mode if it is turned back and its decay is made good.
        course.push(
            within
                .iter()
                .map(|&k| {
                    let Mode { sigma, .. } = modes[k];
                    let omega_d = modes[k].omega_d();
                    let displacement = f64::from(body.displacement(k));
                    let state =
                        Complex::new((body.velocity(k) + sigma * displacement) / omega_d, displacement);
                    state * Complex::new(sigma * time, -omega_d * time).exp()
                })
                .collect::<Vec<_>>(),
        );
    }
    let lag = (0.016 / block).round() as usize;
    let mut lost: Vec<f64> = (0..within.len())
        .map(|k| {
            let (early, late) = (&course[..course.len() - lag], &course[lag..]);
            let common: Complex<f64> = early.iter().zip(late).map(|(a, b)| b[k] * a[k].conj()).sum();
            let size =
                |states: &[Vec<Complex<f64>>]| states.iter().map(|state| state[k].norm_sqr()).sum::<f64>();
            1.0 - common.norm() / (size(early) * size(late)).sqrt()
        })
        .collect();
    lost.sort_by(f64::total_cmp);
    lost[lost.len() / 2]
}

#[test]
fn modes_above_the_coupled_ones_lose_their_phases_as_fast_as_if_they_were_coupled() {
    // Softer ones of a ride lose less than the transport counts.
    let speeds: [&[f64]; 3] = [&[3.0, 6.0], &[16.0], &[3.0, 6.0]];
    let strokes = ORDINARY
        .into_iter()
        .zip(speeds)
        .flat_map(|(of, speeds)| speeds.iter().map(move |&speed| (of, speed)));
    for ((name, radius, striker), speed) in strokes {
        let strike = hit(speed, radius, striker);
        let [played, exact] =
            [Quality::Standard, Quality::Offline].map(|quality| incoherence(&spec(name), &strike, quality));
        println!("{name}, {speed} m/s: {played:.4}, coupled {exact:.4}");
        assert!((0.4..2.5).contains(&(played / exact)), "{name}, {speed} m/s: {played} for {exact}");
    }
}
