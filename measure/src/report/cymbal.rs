//! Cymbals: energy, drift of the scalar auxiliary variable, offset, and permissible simplifications.

use std::f64::consts::TAU;

use crate::{build, cents, reference, render, render_into, spec, stroke};
use anyhow::Result;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::strike::{Strike, Striker};

use super::page::bodies::{CAP, PLAYED};
use super::page::sources::{EARLIER, EXACT, GOAL};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};

use crate::spectra::third_octaves::{centre, mean_difference, third_octaves, worst_difference};

const RATE: f64 = 44_100.0;

/// Strokes in a row, ten a second, and the mode whose pitch is compared before and after.
const STROKES: usize = 1000;
const MODE: usize = 7;

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "cymbal",
        "Cymbals",
        PLAYED,
        "The crash (and the splash, where stated) of the standard kit alone, and both as caps of uniform thickness, for which\n\
         figures were published: at their close microphones, 44.1 kHz, coupled to 2 kHz. [The page on the cascade](cascade.md)\n\
         shows how a hard stroke brightens. `tests/tests/cymbals.rs` checks these figures; the gradient is checked against\n\
         finite differences (1e-6) by `engine/src/von_karman/tests.rs`.",
    );
    let crashes = [Body(spec("crash"), PLAYED), Body(reference::cap_crash(), CAP)];
    let splashes = [Body(spec("splash"), PLAYED), Body(reference::cap_splash(), CAP)];
    crashes.iter().for_each(|crash| energy(&mut sheet, crash));
    splashes.iter().for_each(|splash| endurance(&mut sheet, splash));
    crashes.iter().for_each(|crash| offset(&mut sheet, crash));
    crashes.iter().for_each(|crash| shortcuts(&mut sheet, crash));
    plot(&mut sheet, &crashes[0])?;
    Ok(sheet.finish())
}

/// A cymbal, and what it is called.
struct Body(PieceSpec, &'static str);

/// Energy conservation without losses.
fn energy(sheet: &mut Sheet, Body(crash, on): &Body) {
    for (speed, tolerance) in [(0.3, 1e-3), (25.0, 5e-3)] {
        let drift = energy_drift(crash, speed);
        sheet.claim(Claim {
            what: format!("lossless, {speed} m/s: modal and stretching energy (the true U) over 1 s"),
            on,
            figure: format!("{:.4} % off at most", 100.0 * drift),
            reference: format!("{} %", 100.0 * tolerance),
            source: EXACT,
            met: Some(drift < tolerance),
        });
    }
}

/// Drift after a thousand hard strokes.
fn endurance(sheet: &mut Sheet, Body(splash, on): &Body) {
    let (off, drift) = many_hard_strokes(splash, STROKES);
    sheet.claim(Claim {
        what: format!("splash, {STROKES} hard strokes, ten a second: psi against sqrt(2 (U + C))"),
        on,
        figure: format!("{:.3} % off at most", 100.0 * off),
        reference: "1 %".to_owned(),
        source: EARLIER,
        met: Some(off < 0.01),
    });
    sheet.claim(Claim {
        what: "pitch of a soft stroke after them".to_owned(),
        on,
        figure: format!("{drift:+.3} cents"),
        reference: "1 cent".to_owned(),
        source: EARLIER,
        met: Some(drift.abs() < 1.0),
    });
}

/// Third octaves of strokes on a crash.
fn plot(sheet: &mut Sheet, Body(crash, _): &Body) -> Result<()> {
    let linear = crash.clone().linear();
    let line = |name: &str, crash: &PieceSpec, speed: f64, quality: Quality| {
        let levels = shoulder_bands(crash, speed, quality);
        let top = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let points = levels.iter().zip(0..).map(|(db, band)| (centre(band), (db - top).max(-60.0)));
        let line: Curve = (name.to_owned(), points.collect());
        line
    };
    let (standard, offline) = (Quality::Standard, Quality::Offline);
    let soft = vec![line("linear", &linear, 0.3, standard), line("coupled", crash, 0.3, standard)];
    let hard = vec![
        line("linear", &linear, 5.0, standard),
        line("coupled", crash, 5.0, standard),
        line("coupled to 8 kHz", crash, 5.0, offline),
    ];
    sheet.plot(
        "third-octaves",
        "Third octaves of the standard kit's crash in the first second, over the loudest",
        &Plot {
            across: Axis::log("Hz", 25.0..17_000.0),
            up: Axis::linear("dB", -60.0..15.0),
            panels: vec![("0.3 m/s".to_owned(), soft), ("5 m/s".to_owned(), hard)],
        },
    )
}

fn options() -> BuildOptions {
    BuildOptions::new(RATE)
}

/// Share by which the energy of a cymbal without losses struck at a speed (m/s), its true stretching included, strays in a
/// second at most.
pub fn energy_drift(cymbal: &PieceSpec, speed: f64) -> f64 {
    let mut piece = build(&cymbal.clone().lossless(), &options());
    piece.strike(&stroke(Striker::Stick, speed, 0.92, 0.3));
    render(&mut piece, 0.4, RATE);
    assert_eq!(piece.striker_energy(), 0.0, "the stick has left");
    let mut energy = || {
        let beyond = piece.surface_mut().true_potential().0;
        let all = piece.surface_mut().body().energy() + beyond;
        render(&mut piece, 0.1, RATE);
        all
    };
    let start = energy();
    (0..10).map(|_| (energy() / start - 1.0).abs()).fold(0.0, f64::max)
}

/// Frequency of a mode that rings on, by its crossings of zero over two seconds, Hz.
fn pitch(piece: &mut Piece, mode: usize) -> f64 {
    let (mut last, mut first_at, mut last_at, mut count) = (0.0_f64, f64::NAN, 0.0, 0);
    for sample in 0..2 * RATE as u32 {
        render_into(piece, &mut [0.0]);
        let now = f64::from(piece.surface_mut().body().displacement(mode));
        if last < 0.0 && now >= 0.0 {
            last_at = f64::from(sample) - now / (now - last);
            if first_at.is_nan() {
                first_at = last_at;
            } else {
                count += 1;
            }
        }
        last = now;
    }
    f64::from(count) * RATE / (last_at - first_at)
}

/// Strikes a cymbal hard again and again, ten a second: by what share `psi` strays at most, and by how many cents a soft
/// stroke's pitch is off afterwards.
pub fn many_hard_strokes(cymbal: &PieceSpec, strokes: usize) -> (f64, f64) {
    let mut piece = build(cymbal, &options());
    let soft = stroke(Striker::Stick, 0.2, 0.9, 0.3);
    piece.strike(&soft);
    let before = pitch(&mut piece, MODE);
    piece.reset();
    let mut worst = 0.0_f64;
    for i in 0..strokes {
        piece.strike(&stroke(Striker::Stick, 8.0, 0.9, 0.01 * i as f64));
        render(&mut piece, 0.1, RATE);
        worst = worst.max(piece.surface_mut().true_potential().1.abs());
    }
    piece.choke(1.0);
    render(&mut piece, 3.0, RATE);
    piece.choke(0.0);
    render(&mut piece, 0.5, RATE);
    piece.strike(&soft);
    (worst, cents(pitch(&mut piece, MODE), before))
}

/// Largest mean of a tenth of a second under a raised cosine, whose mean is one: it has no corners, and passes nothing from
/// 30 Hz up by more than 1/100, from 100 Hz by 1/1000.
pub fn largest_mean(sound: &[f32]) -> f64 {
    let length = (0.1 * RATE) as usize;
    let window: Vec<f64> = (0..length).map(|i| 1.0 - (TAU * i as f64 / length as f64).cos()).collect();
    let means = sound.windows(length).step_by(length / 10).map(|part| {
        part.iter().zip(&window).map(|(&x, weight)| f64::from(x) * weight).sum::<f64>() / length as f64
    });
    means.fold(0.0, |largest, mean| largest.max(mean.abs()))
}

/// Largest plain mean of a tenth of a second: of a steady tone it passes up to one over pi times its periods in there.
fn largest_plain_mean(sound: &[f32]) -> f64 {
    let length = (0.1 * RATE) as usize;
    let mean = |part: &[f32]| part.iter().map(|&x| f64::from(x)).sum::<f64>() / length as f64;
    sound.windows(length).step_by(length / 100).fold(0.0, |largest, part| mean(part).abs().max(largest))
}

/// A hard stroke on a cymbal, its first second and a half.
fn hard(cymbal: &PieceSpec, quality: Quality, strike: &Strike) -> Vec<f32> {
    let mut piece = build(cymbal, &BuildOptions { quality, ..options() });
    piece.strike(strike);
    render(&mut piece, 1.5, RATE)
}

/// Largest sample, Pa.
fn peak(sound: &[f32]) -> f64 {
    sound.iter().fold(0.0, |peak, &x| f64::from(x).abs().max(peak))
}

fn offset(sheet: &mut Sheet, Body(crash, on): &Body) {
    let strokes = [(0.92, Striker::Stick), (0.97, Striker::Shoulder)];
    for (quality, (radius, striker)) in
        [Quality::Standard, Quality::Offline].into_iter().flat_map(|quality| strokes.map(|at| (quality, at)))
    {
        let sound = hard(crash, quality, &stroke(striker, 5.0, radius, 0.3));
        let mean = largest_mean(&sound) / peak(&sound);
        sheet.claim(Claim {
            what: format!(
                "{}, {} 5 m/s at {radius}: mean of any 100 ms, under a raised cosine",
                quality.name(),
                striker.name()
            ),
            on,
            figure: format!("{mean:.0e} of the peak"),
            reference: "1e-4 (the earlier engine .216)".to_owned(),
            source: GOAL,
            met: Some(mean < 1e-4),
        });
    }
    let both = [crash.clone(), crash.clone().linear()];
    for (radius, striker) in strokes {
        let [coupled, linear] = both.each_ref().map(|crash| {
            let sound = hard(crash, Quality::Standard, &stroke(striker, 5.0, radius, 0.3));
            largest_plain_mean(&sound) / peak(&sound)
        });
        sheet.claim(Claim::told(
            &format!("the same, {} at {radius}, plain: what the window's corners pass too", striker.name()),
            on,
            format!("{coupled:.1e}, linear {linear:.1e}"),
            "1e-4, which no sound that has 100 to 700 Hz at its level can have",
            GOAL,
        ));
    }
    let [coupled, linear] = both.each_ref().map(|crash| {
        let sound = hard(crash, Quality::Standard, &stroke(Striker::Stick, 5.0, 0.92, 0.3));
        let low: f64 = (1..30).map(|i| power(&sound, f64::from(i) / 1.5)).sum();
        let high: f64 = (0..300).map(|i| power(&sound, 100.0 + f64::from(i) / 0.75)).sum();
        10.0 * (low / high).log10()
    });
    sheet.claim(Claim {
        what: "stick 5 m/s at .92: below 20 Hz against 100 to 500 Hz".to_owned(),
        on,
        figure: format!("{coupled:.1} dB, linear {linear:.1} dB"),
        reference: "the linear plate's + 6 dB".to_owned(),
        source: GOAL,
        met: Some(coupled < linear + 6.0),
    });
}

/// Power of a sound at a frequency (Hz).
fn power(sound: &[f32], hz: f64) -> f64 {
    let step = TAU * hz / RATE;
    let (re, im) = sound.iter().enumerate().fold((0.0, 0.0), |(re, im), (i, &x)| {
        let (sin, cos) = (step * i as f64).sin_cos();
        (re + cos * f64::from(x), im + sin * f64::from(x))
    });
    re * re + im * im
}

/// Third octaves of a stroke on a cymbal after something was done to it.
pub fn bands(cymbal: &PieceSpec, strike: &Strike, seconds: f64, set: impl FnOnce(&mut Piece)) -> Vec<f64> {
    let mut piece = build(cymbal, &options());
    set(&mut piece);
    piece.strike(strike);
    third_octaves(&render(&mut piece, seconds, RATE), RATE)
}

fn shortcuts(sheet: &mut Sheet, Body(crash, on): &Body) {
    let shoulder = |radius| stroke(Striker::Shoulder, 5.0, radius, 0.3);
    let strided =
        |stride, radius| bands(crash, &shoulder(radius), 1.0, |piece| piece.surface_mut().set_stride(stride));
    let every = strided(1, 0.92);
    for (stride, name) in [(2, "second"), (3, "third"), (4, "fourth")] {
        let mean = mean_difference(&every, &strided(stride, 0.92));
        sheet.claim(Claim {
            what: format!(
                "stretching evaluated every {name} sample against every sample, 5 m/s: third octaves"
            ),
            on,
            figure: format!("{mean:.2} dB in the mean"),
            reference: ".5 dB".to_owned(),
            source: EARLIER,
            met: Some(mean < 0.5),
        });
    }
    let beside = mean_difference(&every, &strided(1, 0.925));
    sheet.claim(Claim::told(
        "the same stroke moved by a millimetre",
        on,
        format!("{beside:.2} dB in the mean"),
        "more than any",
        GOAL,
    ));
    let mut left_out = |what: &str, seconds: f64, speeds: [f64; 3], never: fn(&mut Piece)| {
        let worst = speeds.map(|speed| {
            let stick = stroke(Striker::Stick, speed, 0.92, 0.3);
            let [never, ever] = [never, |_: &mut Piece| ()].map(|set| bands(crash, &stick, seconds, set));
            worst_difference(&never, &ever)
        });
        let worst = worst.into_iter().fold(0.0, f64::max);
        sheet.claim(Claim {
            what: format!("{what}: any third octave"),
            on,
            figure: format!("{worst:.3} dB"),
            reference: ".1 dB".to_owned(),
            source: EARLIER,
            met: Some(worst < 0.1),
        });
    };
    left_out("resting the coupling against never resting, .02 to .3 m/s", 3.0, [0.02, 0.1, 0.3], |piece| {
        piece.surface_mut().nonlinear_force_mut().into_iter().for_each(|force| force.set_negligible(0.0));
    });
    left_out(
        "one evaluation for two while the stretching is weak, .3 to 2 m/s",
        1.5,
        [0.3, 1.0, 2.0],
        |piece| piece.surface_mut().nonlinear_force_mut().into_iter().for_each(|force| force.set_weak(0.0)),
    );
}

/// Third octaves of the first second of a stroke with a stick's shoulder on a cymbal of a tier.
fn shoulder_bands(cymbal: &PieceSpec, speed: f64, quality: Quality) -> Vec<f64> {
    let mut piece = build(cymbal, &BuildOptions { quality, ..options() });
    piece.strike(&stroke(Striker::Shoulder, speed, 0.92, 0.3));
    third_octaves(&render(&mut piece, 1.0, RATE), RATE)
}
