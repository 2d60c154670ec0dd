//! Losses of drums, and their sound at every tuning.

use std::f64::consts::{SQRT_2, TAU};

use overhear_engine::damping::SIGMA_T60;
use overhear_engine::drum::DrumSpec;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::{BuildOptions, ModeInfo};
use overhear_engine::strike::Striker;
use overhear_measure::spectra::Transform;
use overhear_tests::{altered, build, drum, render, render_everywhere, round_piece, spec, stroke};

const RATE: f64 = 48_000.0;

/// The lowest mode of an order.
fn lowest(modes: &[ModeInfo], m: u32) -> ModeInfo {
    let of_order = modes.iter().filter(|mode| mode.m == m && mode.body == "batter");
    *of_order.min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz)).unwrap()
}

#[test]
fn a_pillow_takes_the_boom_before_the_rest() {
    let mut kick = round_piece("kick", RATE);
    kick.set_muffling(0.0);
    kick.finish_controls();
    let open = kick.modes();
    kick.set_muffling(1.0);
    kick.finish_controls();
    let muffled = kick.modes();
    let added = |m| SIGMA_T60 / lowest(&muffled, m).t60 - SIGMA_T60 / lowest(&open, m).t60;
    let [boom, edge] = [added(0), added(1)];
    println!("adds {boom:.1} 1/s to the boom, {edge:.1} to (1,1)");
    // The heads' own loss is shared by the resonant head; what the air between them loses comes on top.
    assert!(boom > 1.5 * edge, "{boom} {edge}");
}

#[test]
fn toms_sing_for_more_than_a_second_and_their_heads_apart_thud() {
    for (name, apart) in [("rack-tom", 261.0), ("floor-tom", 169.0)] {
        let modes = round_piece(name, RATE).modes();
        let together = lowest(&modes, 0);
        let thud = modes
            .iter()
            .filter(|mode| mode.m == 0)
            .min_by(|a, b| (a.frequency_hz - apart).abs().total_cmp(&(b.frequency_hz - apart).abs()))
            .unwrap();
        println!("{name}: {:.2} s, {:.2} s at {:.0} Hz", together.t60, thud.t60, thud.frequency_hz);
        assert!(together.t60 > 1.0 && thud.t60 < 0.25 * together.t60, "{together:?} {thud:?}");
        // Radiation is less than what a monopole of its volume would send out.
        assert!(together.frequency_hz < 0.7 * thud.frequency_hz);
        assert!(together.radiation * TAU < thud.radiation * TAU);
    }
}

/// Energy of the octaves from 63 Hz to 1 kHz of half a second of sound, dB.
fn octaves(sound: &[f32]) -> Vec<f64> {
    let spectrum = Transform::new(sound, RATE).unwrap();
    let octave = |k: i32| 62.5 * 2.0_f64.powi(k);
    (0..5).map(|k| 10.0 * spectrum.energy(octave(k) / SQRT_2..octave(k) * SQRT_2).log10()).collect()
}

#[test]
fn a_drum_tuned_live_is_heard_as_the_drum_rebuilt_at_that_pitch() {
    for (name, pitch) in [("kick", 43.0), ("rack-tom", 112.0), ("floor-tom", 110.0)] {
        let tuned_to = |pitch_hz: f64| -> PieceSpec {
            altered(spec(name), |drum| DrumSpec { pitch_hz, high_band: false, ..drum }).linear()
        };
        let mut live = build(&tuned_to(drum(name).pitch_hz), &BuildOptions::new(RATE));
        live.set_tuning(pitch);
        live.finish_controls();
        let rebuilt = build(&tuned_to(pitch), &BuildOptions::new(RATE));
        let [live, rebuilt] = [live, rebuilt].map(|mut drum| {
            drum.strike(&stroke(Striker::Stick, 3.0, 0.3, 0.2));
            octaves(&render(&mut drum, 0.5, RATE))
        });
        println!("{pitch} Hz: {live:.1?} dB for {rebuilt:.1?}");
        // To 500 Hz: above, the modes of a kick are heard by their size only.
        for (a, b) in live.iter().zip(&rebuilt).take(4) {
            assert!((a - b).abs() < 1.0, "{pitch} Hz: {live:.1?} dB for {rebuilt:.1?}");
        }
    }
}

#[test]
fn a_hard_stroke_on_a_tuned_drum_is_heard_as_on_one_built_at_that_pitch() {
    let drums = [
        ("kick", Striker::FeltBeater, [35.0, 65.0, 90.0]),
        ("snare", Striker::Stick, [140.0, 250.0, 360.0]),
        ("rack-tom", Striker::Stick, [80.0, 150.0, 225.0]),
        ("floor-tom", Striker::Stick, [55.0, 90.0, 132.0]),
    ];
    let mut worst = 0.0_f64;
    for (name, striker, pitches) in drums {
        for pitch in pitches {
            let built_at = |pitch_hz| {
                build(&altered(spec(name), |drum| DrumSpec { pitch_hz, ..drum }), &BuildOptions::new(RATE))
            };
            let mut live = built_at(drum(name).pitch_hz);
            live.set_tuning(pitch);
            live.finish_controls();
            let [live, rebuilt] = [live, built_at(pitch)].map(|mut drum| {
                drum.strike(&stroke(striker, 8.0, 0.2, 0.2));
                render_everywhere(&mut drum, 0.5, RATE).map(|sound| octaves(&sound))
            });
            // Nearby and far away.
            for (live, rebuilt) in live.iter().zip(&rebuilt) {
                let off = live.iter().zip(rebuilt).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                println!("{name}, {pitch} Hz: {live:.1?} dB for {rebuilt:.1?}, {off:.2} apart");
                worst = worst.max(off);
            }
        }
    }
    assert!(worst < 1.5, "{worst} dB");
}
