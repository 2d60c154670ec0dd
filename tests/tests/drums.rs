//! Drums as they are heard: what a reviewer would measure on them.

use overhear_engine::drum::{Drum, DrumSpec};
use overhear_engine::piece::{BuildOptions, ModeInfo, ModeKind, Piece, PieceId};
use overhear_engine::strike::Striker;
use overhear_tests::{Spectrum, build, cents, decibels, render, stroke};

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

/// The drums of the kit and the timpani.
fn drums() -> [(PieceId, DrumSpec); 5] {
    [
        (PieceId::Kick, DrumSpec::kick()),
        (PieceId::Snare, DrumSpec::snare()),
        (PieceId::RackTom, DrumSpec::rack_tom()),
        (PieceId::FloorTom, DrumSpec::floor_tom()),
        (PieceId::Timpani, DrumSpec::timpani()),
    ]
}

/// Largest difference of neighbours.
fn steepest(sound: &[f32]) -> f64 {
    sound.windows(2).map(|pair| f64::from((pair[1] - pair[0]).abs())).fold(0.0, f64::max)
}

#[test]
fn a_drum_swept_through_its_range_ends_as_one_built_there_with_that_muffling_and_does_not_click() {
    const BLOCK: usize = 32;
    let options = BuildOptions::new(RATE);
    for (id, spec) in drums() {
        let (low, _, high) = spec.pitch_hz;
        for (from, to, muffling) in [(low, high, 0.0), (high, low, 0.4), (low, (low * high).sqrt(), 1.0)] {
            let mut drum = Drum::new(&spec, &options).unwrap();
            let mut play = |swept: bool| {
                drum.surface_mut().reset();
                drum.set_tuning(from);
                drum.set_muffling(0.0);
                drum.finish_controls();
                drum.strike(&stroke(Striker::Stick, 4.0, 0.4, 1.0));
                let mut sound = Vec::new();
                let (wait, sweep) = (0.1 * RATE, 0.05 * RATE);
                while (sound.len() as f64) < 0.4 * RATE {
                    // Asked for anew every block, as a host's automation does.
                    let share = ((sound.len() as f64 - wait) / sweep).clamp(0.0, 1.0);
                    if swept && share > 0.0 {
                        drum.set_tuning(from * (to / from).powf(share));
                        drum.set_muffling(muffling * share);
                    }
                    drum.advance_controls(BLOCK as f64 / RATE);
                    drum.follow_controls();
                    let mut block = [0.0; BLOCK];
                    drum.surface_mut().render(&mut block);
                    sound.extend(block);
                }
                steepest(&sound[wait as usize..])
            };
            // What is heard of a displacement is its acceleration, and its slope goes as the cube.
            let owed = 60.0 * (to / from).log10().max(0.0);
            let steeper = decibels(play(true), play(false)) - owed;
            assert!(steeper < 6.0, "{id:?} from {from} to {to}: {steeper:+.1} dB");
            play(true);
            let mut built = Drum::new(&DrumSpec { pitch_hz: (low, to, high), ..spec }, &options).unwrap();
            built.set_muffling(muffling);
            built.finish_controls();
            let mut worst = (0.0_f64, 0.0_f64);
            let (mut live, mut fresh) = (drum.modes(), built.modes());
            let by = |a: &ModeInfo, b: &ModeInfo| a.frequency_hz.total_cmp(&b.frequency_hz);
            live.sort_by(by);
            fresh.sort_by(by);
            assert_eq!(live.len(), fresh.len());
            for (a, b) in live.iter().zip(&fresh) {
                worst.0 = worst.0.max(cents(a.frequency_hz, b.frequency_hz).abs());
                worst.1 = worst.1.max((a.t60 / b.t60 - 1.0).abs());
            }
            println!("{id:?} to {to:.1} Hz: {steeper:+.1} dB, {:.1e} cents, T60 {:.1e}", worst.0, worst.1);
            assert!(worst.0 < 2.0 && worst.1 < 0.01, "{id:?} to {to}: {worst:?}");
        }
    }
}
