//! Struck cymbals: energy, cascade, offset, drift.

use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::analysis::OneShot;
use overhear_measure::analysis::envelope;
use overhear_measure::report::cymbal::{self, largest_mean};
use overhear_measure::spectra::PowerSpectrum;
use overhear_measure::spectra::third_octaves::{mean_difference, third_octaves, worst_difference};
use overhear_tests::{Chance, build, reference, render_into, spec, stroke, total_energy};

const RATE: f64 = 44_100.0;

fn options() -> BuildOptions {
    BuildOptions::new(RATE)
}

fn hit(speed: f64, radius: f64, striker: Striker) -> Strike {
    stroke(striker, speed, radius, 0.3)
}

fn render(piece: &mut Piece, seconds: f64) -> Vec<f32> {
    overhear_tests::render(piece, seconds, RATE)
}

/// Mean frequency of the modes to `limit_hz`, weighted by their energy, Hz; rigid ones left out.
fn mean_frequency(piece: &mut Piece, limit_hz: f64) -> f64 {
    let body = piece.surface_mut().body();
    let (mut sum, mut weighted) = (0.0, 0.0);
    for (k, mode) in body.modes().iter().enumerate().skip(3) {
        let hz = mode.omega / std::f64::consts::TAU;
        if hz < limit_hz {
            let q = f64::from(body.displacement(k));
            let energy = 0.5 * mode.mass * (body.velocity(k).powi(2) + (mode.omega * q).powi(2));
            sum += energy;
            weighted += energy * hz;
        }
    }
    weighted / sum
}

/// The cymbals of the standard kit, and the same as caps as thick everywhere.
fn cymbals() -> [PieceSpec; 6] {
    let [[crash, cap_crash], [splash, cap_splash]] = [crashes(), splashes()];
    [crash, spec("ride"), splash, cap_crash, reference::cap_ride(), cap_splash]
}

/// The crash of the standard kit, and one that is a cap.
fn crashes() -> [PieceSpec; 2] {
    [spec("crash"), reference::cap_crash()]
}

/// The splash of the standard kit, and one that is a cap.
fn splashes() -> [PieceSpec; 2] {
    [spec("splash"), reference::cap_splash()]
}

/// One of them for a test that takes minutes with all, from a fresh seed that is printed.
fn drawn<const N: usize>(of: [PieceSpec; N]) -> PieceSpec {
    let drawn = Chance::new(Chance::seeds(&[])[0]).below(N);
    of.into_iter().nth(drawn).expect("one of them")
}

/// The crash of the standard kit.
fn crash() -> Piece {
    build(&spec("crash"), &options())
}

/// A crash struck hard at its edge, rendered.
fn crash_sound(crash: &PieceSpec, speed: f64, seconds: f64) -> Vec<f32> {
    let mut piece = build(crash, &options());
    piece.strike(&hit(speed, 0.92, Striker::Stick));
    render(&mut piece, seconds)
}

#[test]
fn a_lossless_plate_keeps_its_true_energy() {
    // Metal 1 mm thick: 0.3 m/s bends it by less than that, 25 m/s by more than three times.
    for (speed, tolerance) in [(0.3, 1e-3), (25.0, 5e-3)] {
        for crash in crashes() {
            let (name, drift) = (&crash.name, cymbal::energy_drift(&crash, speed));
            println!("{name}, {speed} m/s: {drift:.1e}");
            assert!(drift < tolerance, "{name}, {speed} m/s: {drift}");
        }
    }
}

#[test]
fn a_stroke_and_a_lossless_plate_keep_their_energy_together() {
    for cymbal in cymbals() {
        let name = &cymbal.name;
        for (speed, striker) in [(5.0, Striker::Stick), (25.0, Striker::Shoulder), (6.0, Striker::YarnMallet)]
        {
            let mut piece = build(&cymbal.clone().lossless(), &options());
            piece.strike(&hit(speed, 0.9, striker));
            let brought = piece.striker_energy();
            for _ in 0..10 {
                render(&mut piece, 0.01);
                let all = total_energy(&piece);
                assert!((all / brought - 1.0).abs() < 1e-3, "{name} {striker:?}: {all} of {brought}");
            }
        }
    }
}

/// Mean frequencies of a crash's modes to 2 kHz at 3, 30, 80, 250, 500 ms and 1 s after a stroke.
fn course(crash: &PieceSpec, quality: Quality, speed: f64) -> Vec<f64> {
    let mut piece = build(crash, &BuildOptions { quality, ..options() });
    piece.strike(&hit(speed, 0.92, Striker::Shoulder));
    let spans = [0.003, 0.027, 0.05, 0.17, 0.25, 0.5];
    spans
        .into_iter()
        .map(|span| {
            render(&mut piece, span);
            mean_frequency(&mut piece, 2000.0)
        })
        .collect()
}

/// Checks that a hard stroke swells, and that a soft one does as on a linear plate within a share; what a linear one does
/// after a hard stroke.
fn swelling(crash: &PieceSpec, within: f64) -> Vec<f64> {
    let (name, linear) = (&crash.name, crash.clone().linear());
    let faded = course(&linear, Quality::Standard, 5.0);
    // The felts take what is lowest first: by half a percent.
    assert!(faded[1..].windows(2).all(|pair| pair[1] < 1.01 * pair[0]), "{name}: {faded:?}");
    let faintly = course(&linear, Quality::Standard, 0.3);
    for quality in [Quality::Eco, Quality::Standard, Quality::High] {
        let (hard, soft) = (course(crash, quality, 5.0), course(crash, quality, 0.3));
        println!("{name}, {quality:?} {hard:.0?}, linear {faded:.0?}; {soft:.0?}, linear {faintly:.0?}");
        assert!(hard[1].max(hard[2]) > 1.1 * hard[0], "{name}, {quality:?}: {hard:?}");
        for (soft, linear) in soft.iter().zip(&faintly) {
            assert!((soft / linear - 1.0).abs() < within, "{name}, {quality:?}: {soft} {linear}");
        }
    }
    faded
}

#[test]
fn a_hard_stroke_swells_and_a_linear_plate_only_fades_once_the_stick_has_left() {
    // The felt takes what is lowest, so that after a second even a soft stroke's little exchange shows.
    swelling(&spec("crash"), 0.1);
}

#[test]
fn a_hard_stroke_swells_and_a_linear_plate_only_fades_of_a_cap_crash() {
    let faded = swelling(&reference::cap_crash(), 0.09);
    // Until it has left, the shoulder touches again and again.
    assert!(faded[1] < 1.02 * faded[0], "{faded:?}");
}

#[test]
fn above_3_khz_a_hard_crash_peaks_later_than_30_ms_and_a_soft_one_before_60() {
    let ways = [Quality::Standard, Quality::High, Quality::Offline];
    for (quality, crash) in ways.into_iter().flat_map(|quality| crashes().map(|crash| (quality, crash))) {
        let name = &crash.name;
        // Where the MIDI map has the crash played.
        let bloom = |speed| {
            let mut piece = build(&crash, &BuildOptions { quality, ..options() });
            piece.strike(&hit(speed, 0.97, Striker::Shoulder));
            let shot = OneShot::new(&render(&mut piece, 0.8), RATE).unwrap();
            envelope::bloom_ms(&shot).unwrap()
        };
        let (soft, medium, hard) = (bloom(1.5), bloom(5.0), bloom(6.0));
        println!("{name}, {quality:?}: {soft} ms, {medium} ms, {hard} ms");
        assert!(soft < 60.0, "{name}, {quality:?}: {soft} ms");
        assert!(medium > 30.0 && hard > 30.0, "{name}, {quality:?}: {medium} ms, {hard} ms");
    }
}

/// A plain mean lets through what the window's corners cut: of a steady tone of 550 Hz up to 1/170, offset or
/// not. A raised cosine has no corners, and passes nothing from 30 Hz up by more than 1/100, from 100 Hz by 1/1000.
#[test]
fn no_tenth_of_a_second_of_a_hard_crash_has_an_offset_of_1e_4_of_the_peak() {
    let strokes = [(0.92, Striker::Stick), (0.97, Striker::Shoulder)];
    let ways = [Quality::Standard, Quality::Offline]
        .into_iter()
        .flat_map(|quality| strokes.map(|stroke| (quality, stroke)));
    for (crash, (quality, (radius, striker))) in ways.flat_map(|way| crashes().map(|crash| (crash, way))) {
        let name = &crash.name;
        let mut piece = build(&crash, &BuildOptions { quality, ..options() });
        piece.strike(&hit(5.0, radius, striker));
        let coupled = render(&mut piece, 1.5);
        let peak = coupled.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        let largest = largest_mean(&coupled) / f64::from(peak);
        println!("{name}, {quality:?}, {striker:?}: {largest:e}");
        // The domed reference, which is not hammered, swings about an offset that its stretch holds.
        let most = if name == "crash" { 1e-4 } else { 2e-4 };
        assert!(largest < most, "{name}, {quality:?}, {striker:?}: {largest}");
    }
    // What an offset of a hundredth would look like, so that the window is known to see one.
    let offset = vec![0.01_f32; 4410];
    assert!((largest_mean(&offset) - 0.01).abs() < 1e-8);
}

/// Of a linear plate, too, a plain mean passes more than 1e-4; the stretching adds no more than its brighter sound does.
#[test]
fn plain_means_of_a_hard_crash_are_what_a_tone_of_its_level_leaks() {
    let sound = crash_sound(&spec("crash"), 5.0, 1.5);
    let length = (0.1 * RATE) as usize;
    for part in sound.windows(length).step_by(length / 10) {
        let mean = part.iter().map(|&x| f64::from(x)).sum::<f64>() / length as f64;
        let level = (part.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>() / length as f64).sqrt();
        // A tone of 100 Hz, among the lowest that is heard of a crash, leaks up to sqrt(2) level / (10 pi).
        assert!(mean.abs() < level * 2.0_f64.sqrt() / (10.0 * std::f64::consts::PI), "{mean} {level}");
    }
}

#[test]
fn below_20_hz_a_hard_stroke_has_no_6_db_more_than_on_a_linear_plate_of_a_cap_crash() {
    let coupled = crash_sound(&reference::cap_crash(), 5.0, 1.5);
    let linear = crash_sound(&reference::cap_crash().linear(), 5.0, 1.5);
    let power = |sound: &[f32], hz: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (i, &x) in sound.iter().enumerate() {
            let (sin, cos) = (std::f64::consts::TAU * hz * i as f64 / RATE).sin_cos();
            re += cos * f64::from(x);
            im += sin * f64::from(x);
        }
        re * re + im * im
    };
    // Over the power from 100 to 500 Hz.
    let share = |sound: &[f32]| {
        let low: f64 = (1..30).map(|i| power(sound, f64::from(i) / 1.5)).sum();
        let high: f64 = (0..300).map(|i| power(sound, 100.0 + f64::from(i) / 0.75)).sum();
        10.0 * (low / high).log10()
    };
    let (with, without) = (share(&coupled), share(&linear));
    println!("below 20 Hz {with} dB, linear {without} dB");
    assert!(with < without + 6.0, "{with} dB against {without} dB");
}

#[test]
fn evaluating_every_second_third_or_fourth_sample_is_as_good_as_every_sample() {
    let bands = |stride, radius| {
        let strike = hit(5.0, radius, Striker::Shoulder);
        cymbal::bands(&spec("crash"), &strike, 1.0, |piece| piece.surface_mut().set_stride(stride))
    };
    let every = bands(1, 0.92);
    let means = [2, 3, 4].map(|stride| mean_difference(&every, &bands(stride, 0.92)));
    println!("every second, third, fourth sample: {means:?} dB in the mean");
    assert!(means.iter().all(|mean| *mean < 0.5), "{means:?} dB");
    // What a stroke four millimetres beside changes, for comparison.
    let beside = mean_difference(&every, &bands(1, 0.94));
    assert!(means[..2].iter().all(|mean| *mean < beside), "{means:?} dB, {beside} dB");
}

#[test]
fn the_rate_of_evaluation_is_not_heard() {
    // The stretching acts in steps. Heard as it acts, a hard crash has images of its lows at the rate of the evaluations: near by 5.6 and 2.2 dB more than without.
    let about = |stride: u32, every: u32| -> f64 {
        let mut piece = crash();
        piece.surface_mut().set_stride(every);
        piece.strike(&hit(4.0, 0.97, Striker::Shoulder));
        let middle = RATE / f64::from(stride);
        PowerSpectrum::hann(&render(&mut piece, 1.0), RATE).band(middle - 700.0, middle + 700.0)
    };
    for stride in [3, 4] {
        let over = 10.0 * (about(stride, stride) / about(stride, 1)).log10();
        println!("every {stride}: {over} dB");
        assert!(over.abs() < 0.3, "every {stride}: {over} dB");
    }
}

#[test]
fn leaving_out_evaluations_while_the_stretching_is_weak_moves_no_band_by_a_tenth_of_a_decibel() {
    for speed in [0.3, 1.0, 2.0] {
        let strike = hit(speed, 0.92, Striker::Stick);
        let bands = |set: fn(&mut Piece)| cymbal::bands(&spec("crash"), &strike, 1.5, set);
        let never = bands(|piece| piece.surface_mut().nonlinear_force_mut().unwrap().set_weak(0.0));
        let worst = worst_difference(&never, &bands(|_| ()));
        println!("{speed} m/s: {worst} dB");
        assert!(worst < 0.1, "{speed} m/s: {worst} dB");
    }
}

#[test]
fn resting_the_coupling_moves_no_band_by_a_tenth_of_a_decibel() {
    let mut rests = 0;
    for speed in [0.02, 0.1, 0.3] {
        let mut bands = |negligible: Option<f64>| {
            let mut piece = crash();
            let force = piece.surface_mut().nonlinear_force_mut().unwrap();
            negligible.into_iter().for_each(|share| force.set_negligible(share));
            piece.strike(&hit(speed, 0.92, Striker::Stick));
            let sound = render(&mut piece, 3.0);
            rests += u32::from(!piece.surface_mut().nonlinear_force().unwrap().is_active());
            third_octaves(&sound, RATE)
        };
        let worst = worst_difference(&bands(Some(0.0)), &bands(None));
        assert!(worst < 0.1, "{speed} m/s: {worst} dB");
    }
    assert!(rests > 0, "nothing ever rested");
}

#[test]
fn two_25_m_s_hits_50_ms_apart_stay_finite_and_fade() {
    for name in ["crash", "ride", "splash"] {
        let mut piece = build(&spec(name), &options());
        let strike = hit(25.0, 0.9, Striker::Shoulder);
        piece.strike(&strike);
        render(&mut piece, 0.05);
        piece.strike(&strike);
        let brought = 2.0 * 0.5 * 0.020 * 25.0 * 25.0;
        let sound = render(&mut piece, 1.0);
        assert!(sound.iter().all(|x| x.is_finite()));
        assert_eq!(piece.quarantines(), 0);
        let mut before = piece.energy();
        assert!(before < brought);
        piece.choke(1.0);
        for _ in 0..8 {
            render(&mut piece, 0.25);
            let now = piece.energy();
            // What cannot be heard any more falls asleep, and has none. A stretch that was lost, at twice the speed of any stroke, may
            // hold less than nothing until it is found anew.
            assert!(
                now < before || before == 0.0 || before < 0.0 && now < 1e-4 * brought,
                "{name}: {now} J after {before} J"
            );
            before = now;
        }
        assert!(before < 1e-6, "{name}: {before} J left");
    }
}

/// Strikes hard a thousand times, ten a second; whether `psi` stays true and a soft stroke's pitch the same.
fn a_thousand_hard_strokes(cymbal: &PieceSpec) {
    let (name, (worst, cents)) = (&cymbal.name, cymbal::many_hard_strokes(cymbal, 1000));
    println!("{name}: psi off by {worst:.1e} at most, {cents:.3} cents");
    assert!(worst < 0.01, "{name}: psi off by {worst}");
    assert!(cents.abs() < 1.0, "{name}: {cents} cents");
}

#[test]
fn after_a_thousand_hard_strokes_psi_is_true_and_the_pitch_the_same() {
    splashes().iter().for_each(a_thousand_hard_strokes);
}

#[test]
#[ignore = "half a minute; the whole suite runs it"]
fn after_a_thousand_hard_strokes_on_a_crash_psi_is_true_and_the_pitch_the_same() {
    a_thousand_hard_strokes(&drawn(crashes()));
}

/// Rolls for a minute, twenty strokes a second; whether `psi` stays true and the energy bounded.
fn a_roll_of_a_minute(crash: &PieceSpec, quality: Quality) {
    let (name, mut piece) = (&crash.name, build(crash, &BuildOptions { quality, ..options() }));
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    for stroke in 0..1200 {
        piece.strike(&hit(4.0, 0.85, Striker::YarnMallet));
        render(&mut piece, 0.05);
        let (_, off) = piece.surface_mut().true_potential();
        assert!(off.abs() < 0.01, "{name}, stroke {stroke}: psi off by {off}");
        worst = worst.max(off.abs());
        largest = largest.max(piece.energy());
    }
    println!("{name}, {quality:?}: psi off by {worst:.1e} at most, {largest} J");
    assert!(largest < 20.0 * 0.5 * 0.030 * 16.0, "{name}: {largest} J");
    assert_eq!(piece.quarantines(), 0);
}

#[test]
fn a_roll_of_a_minute_stays_bounded_and_true() {
    crashes().iter().for_each(|crash| a_roll_of_a_minute(crash, Quality::Eco));
}

#[test]
#[ignore = "half a minute; the whole suite runs it"]
fn a_roll_of_a_minute_at_standard_stays_bounded_and_true() {
    a_roll_of_a_minute(&drawn(crashes()), Quality::Standard);
}

#[test]
#[ignore = "half a minute; the whole suite runs it"]
fn two_25_m_s_hits_50_ms_apart_decay_to_silence_by_themselves() {
    for cymbal in cymbals() {
        let mut piece = build(&cymbal, &options());
        piece.strike(&hit(25.0, 0.9, Striker::Shoulder));
        render(&mut piece, 0.05);
        piece.strike(&hit(25.0, 0.9, Striker::Shoulder));
        render(&mut piece, 40.0);
        assert!(piece.energy() < 1e-10, "{}: {} J left", cymbal.name, piece.energy());
        assert_eq!(piece.quarantines(), 0);
    }
}

#[test]
fn a_choked_crash_falls_by_20_db_in_a_fifth_of_a_second() {
    let mut piece = crash();
    piece.strike(&hit(5.0, 0.92, Striker::Stick));
    render(&mut piece, 0.5);
    let before = piece.energy();
    piece.choke(1.0);
    render(&mut piece, 0.2);
    assert!(piece.energy() < 1e-2 * before, "{} of {before}", piece.energy());
    piece.choke(0.0);
    render(&mut piece, 0.3);
    let rest = piece.energy();
    render(&mut piece, 0.1);
    assert!(piece.energy() <= rest);
}

#[test]
fn a_crash_is_bit_identical_however_time_is_cut() {
    let strike = hit(5.0, 0.92, Striker::Stick);
    let (mut whole, mut cut) = (crash(), crash());
    whole.strike(&strike);
    cut.strike(&strike);
    let a = render(&mut whole, 0.5);
    let mut b = vec![0.0; a.len()];
    for part in b.chunks_mut(17) {
        render_into(&mut cut, part);
    }
    assert_eq!(a, b);
}
