//! Drums as they are heard: what a reviewer would measure on them.

use overhear_engine::piece::{BuildOptions, ModeKind, Piece, PieceId};
use overhear_engine::strike::Striker;
use overhear_tests::{Spectrum, build, decibels, render, stroke};

const RATE: f64 = 44_100.0;

/// A piece with its high band or without.
fn with_high_band(id: PieceId, high_band: bool) -> Piece {
    build(id, &BuildOptions { high_band, ..BuildOptions::new(RATE) })
}

/// Amplitude of a sound between two frequencies, Hz.
fn loudness(spectrum: &Spectrum, low: f64, high: f64) -> f64 {
    spectrum.band(low, high).sqrt()
}

#[test]
fn the_high_band_adds_ten_decibels_to_a_tom_above_4_khz_up_to_16_khz_and_leaves_its_contact() {
    let [with, without] = [true, false].map(|high_band| {
        let mut tom = with_high_band(PieceId::RackTom, high_band);
        tom.strike(&stroke(Striker::Stick, 4.0, 0.4, 0.2));
        let sound = render(&mut tom, 1.0, RATE);
        // From when the stick has left: what rings.
        let ringing = Spectrum::hann(&sound[(0.02 * RATE) as usize..(0.12 * RATE) as usize], RATE);
        (Spectrum::new(&sound, RATE), ringing, tom.last_strike())
    });
    let gain = |low, high| decibels(loudness(&with.0, low, high), loudness(&without.0, low, high));
    println!("above 4 kHz: {:+.1} dB", gain(4000.0, 20_000.0));
    assert!(gain(4000.0, 20_000.0) >= 10.0);
    for octave in [4000.0, 8000.0, 14_000.0] {
        let high = (octave * 1.4_f64).min(16_000.0);
        let still = decibels(loudness(&with.1, octave, high), loudness(&without.1, octave, high));
        println!("ringing from {octave} to {high:.0} Hz: {still:+.1} dB");
        assert!(still > 20.0, "{octave}: {still}");
    }
    for (a, b) in [
        (with.2.contact_time, without.2.contact_time),
        (with.2.impulse, without.2.impulse),
        (with.2.peak_force, without.2.peak_force),
    ] {
        assert!((a / b - 1.0).abs() < 0.03, "{a} {b}");
    }
}

#[test]
fn modes_of_the_high_band_run_on_from_the_complete_set_to_16_khz() {
    for id in [PieceId::Kick, PieceId::Snare, PieceId::RackTom, PieceId::FloorTom, PieceId::Timpani] {
        let modes = with_high_band(id, true).modes();
        let hz = |kind| {
            let of_kind = modes.iter().filter(move |mode| mode.kind == kind && mode.body == "batter");
            of_kind.map(|mode| mode.frequency_hz).collect::<Vec<_>>()
        };
        let (complete, sampled) = (hz(ModeKind::Complete), hz(ModeKind::Sampled));
        let top = complete.iter().copied().fold(0.0, f64::max);
        assert!((0.9..1.1).contains(&(sampled[0] / top)), "{id:?}: {top}, then {}", sampled[0]);
        assert!(*sampled.last().unwrap() > 15_500.0 && *sampled.last().unwrap() <= 16_000.0);
        let widest = sampled.windows(2).map(|pair| pair[1] / pair[0]).fold(0.0, f64::max);
        // Two slices of a fortieth of an octave.
        assert!(widest < 2.0_f64.powf(0.05), "{id:?}: {widest}");
        assert!(with_high_band(id, false).modes().iter().all(|mode| mode.kind != ModeKind::Sampled));
    }
}
