//! What takes the energy out of drums, and how they are heard wherever they are tuned.

use std::f64::consts::{SQRT_2, TAU};

use overhear_engine::damping::SIGMA_T60;
use overhear_engine::drum::{Drum, DrumSpec};
use overhear_engine::piece::{BuildOptions, ModeInfo, PieceId};
use overhear_engine::strike::Striker;
use overhear_tests::{round_piece, stroke};
use xtask::analysis::Transform;

const RATE: f64 = 48_000.0;

/// The lowest mode of an order.
fn lowest(modes: &[ModeInfo], m: u32) -> ModeInfo {
    let of_order = modes.iter().filter(|mode| mode.m == m && mode.body == "batter");
    *of_order.min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz)).unwrap()
}

#[test]
fn a_pillow_takes_the_boom_before_the_rest() {
    let mut kick = round_piece(PieceId::Kick, RATE);
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
    for (id, apart) in [(PieceId::RackTom, 261.0), (PieceId::FloorTom, 169.0)] {
        let modes = round_piece(id, RATE).modes();
        let together = lowest(&modes, 0);
        let thud = modes
            .iter()
            .filter(|mode| mode.m == 0)
            .min_by(|a, b| (a.frequency_hz - apart).abs().total_cmp(&(b.frequency_hz - apart).abs()))
            .unwrap();
        println!("{id:?}: {:.2} s, {:.2} s at {:.0} Hz", together.t60, thud.t60, thud.frequency_hz);
        assert!(together.t60 > 1.0 && thud.t60 < 0.25 * together.t60, "{together:?} {thud:?}");
        // Radiation is less than what a monopole of its volume would send out.
        assert!(together.frequency_hz < 0.7 * thud.frequency_hz);
        assert!(together.radiation * TAU < thud.radiation * TAU);
    }
}

/// Energy of the octaves from 63 Hz to 1 kHz of a struck drum's first half second, dB.
fn octaves(drum: &mut Drum) -> Vec<f64> {
    drum.strike(&stroke(Striker::Stick, 3.0, 0.3, 0.2));
    let mut sound = vec![0.0; RATE as usize / 2];
    sound.chunks_mut(32).for_each(|block| drum.surface_mut().render(block));
    let spectrum = Transform::new(&sound, RATE).unwrap();
    let octave = |k: i32| 62.5 * 2.0_f64.powi(k);
    (0..5).map(|k| 10.0 * spectrum.energy(octave(k) / SQRT_2..octave(k) * SQRT_2).log10()).collect()
}

#[test]
fn a_drum_tuned_live_is_heard_as_the_drum_rebuilt_at_that_pitch() {
    let options = BuildOptions { linear: true, high_band: false, ..BuildOptions::new(RATE) };
    for (spec, pitch) in
        [(DrumSpec::kick(), 43.0), (DrumSpec::rack_tom(), 112.0), (DrumSpec::floor_tom(), 110.0)]
    {
        let mut live = Drum::new(&spec, &options).unwrap();
        live.set_tuning(pitch);
        live.finish_controls();
        let (low, _, high) = spec.pitch_hz;
        let mut rebuilt = Drum::new(&DrumSpec { pitch_hz: (low, pitch, high), ..spec }, &options).unwrap();
        let (live, rebuilt) = (octaves(&mut live), octaves(&mut rebuilt));
        let loudest = rebuilt.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (a, b) in live.iter().zip(&rebuilt) {
            println!("{pitch} Hz: {a:.1} dB for {b:.1}");
            assert!(
                (a - b).abs() < 1.0 || *b < loudest - 50.0,
                "{pitch} Hz: {live:.1?} dB for {rebuilt:.1?}"
            );
        }
    }
}
