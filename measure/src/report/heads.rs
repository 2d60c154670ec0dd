//! Heads: effects of the outer air and of the air in the kettle on a timpani's modes.

use std::f64::consts::TAU;

use crate::{altered, build, cents, decibels, drum, render, round_piece, spec, stroke};
use anyhow::Result;
use overhear_engine::drum::DrumSpec;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::membrane::{Membrane, ModeRange, Surroundings};
use overhear_engine::piece::{BuildOptions, ModeInfo, Piece};
use overhear_engine::strike::Striker;

use super::page::bodies;
use super::page::sources::{EARLIER, EXACT, MEASURED};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot, comb};
use crate::bad_input;
use crate::spectra::OnsetSpectrum;

const RATE: f64 = 44_100.0;

/// The page.
///
/// # Errors
/// If the head cannot be or a plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "heads",
        "Heads",
        bodies::ROUND,
        "A timpani of 26 inches: its head alone in air, and over its kettle. Strokes in the centre of every round drum. Ratios of\n\
         real heads: T. D. Rossing, Science of Percussion Instruments. `tests/tests/acoustics.rs` and `tests/tests/drums.rs` hold them.",
    );
    let timpani = build(&timpani_head(), &BuildOptions::new(RATE));
    let principal = mode_of(&timpani, 1, 1).frequency_hz;
    for (m, computed, measured) in [(2, 1.470, 1.48), (3, 1.922, 1.92), (4, 2.363, 2.36), (5, 2.797, 2.78)] {
        let ratio = mode_of(&timpani, m, 1).frequency_hz / principal;
        let what = format!("head in air, no kettle: ({m},1) over (1,1)");
        sheet.claim(Claim::near(
            &what,
            bodies::NO_KETTLE,
            (ratio, ""),
            (computed, 0.01),
            "computed by others",
        ));
        sheet.claim(Claim::near(&what, bodies::NO_KETTLE, (ratio, ""), (measured, 0.01), MEASURED));
    }
    kettle(&mut sheet);
    centre(&mut sheet);
    sheet.plot(
        "timpani",
        "A stroke on a timpani, beside the modes its head has in vacuum and those it has in air over the kettle",
        &spectrum()?,
    )?;
    Ok(sheet.finish())
}

/// A timpani's head with air on both faces, perfectly round.
pub fn timpani_head() -> PieceSpec {
    PieceSpec { name: "timpani-head".to_owned(), ..altered(spec("timpani"), DrumSpec::opened).round() }
}

/// The mode `(m, n)` of a drum's struck head.
pub fn mode_of(piece: &Piece, m: u32, n: u32) -> ModeInfo {
    let of_batter = |mode: &ModeInfo| (mode.body, mode.m, mode.n) == ("batter", m, n);
    piece.modes().into_iter().find(of_batter).expect("a mode of those orders")
}

fn kettle(sheet: &mut Sheet) {
    let timpani = round_piece("timpani", RATE);
    let pitch = timpani.tunings()[1];
    let principal = mode_of(&timpani, 1, 1);
    let off = cents(principal.frequency_hz, pitch);
    sheet.claim(Claim {
        what: format!("over its kettle the pedal's {pitch} Hz is the (1,1)"),
        on: bodies::ROUND,
        figure: format!("{off:+.2} cents"),
        reference: "1 cent".to_owned(),
        source: EXACT,
        met: Some(off.abs() < 1.0),
    });
    for (m, seen) in [(2, 1.505), (3, 1.98), (4, 2.44)] {
        let ratio = mode_of(&timpani, m, 1).frequency_hz / principal.frequency_hz;
        let what = format!("over its kettle: ({m},1) over (1,1)");
        sheet.claim(Claim::near(&what, bodies::ROUND, (ratio, ""), (seen, 0.01), MEASURED));
    }
    let thud = mode_of(&timpani, 0, 1).t60;
    sheet.claim(Claim {
        what: "T60 of the (0,1)'s thud against the note's".to_owned(),
        on: bodies::ROUND,
        figure: format!("{thud:.2} s against {:.2} s", principal.t60),
        reference: ".49 s against 1.7 s: less than 30 %".to_owned(),
        source: EARLIER,
        met: Some(thud < 0.3 * principal.t60),
    });
}

fn centre(sheet: &mut Sheet) {
    for name in ["kick", "rack-tom", "floor-tom", "timpani"] {
        let down = centre_rejection(name);
        sheet.claim(Claim {
            what: format!("{name}, struck in the centre: asymmetric modes"),
            on: bodies::ROUND,
            figure: format!("{down:.0} dB down"),
            reference: "more than 90 dB".to_owned(),
            source: EARLIER,
            met: Some(down > 90.0),
        });
    }
}

/// How far below the largest round mode the largest other one is after a stroke in the centre, dB.
pub fn centre_rejection(name: &str) -> f64 {
    let mut drum = round_piece(name, RATE);
    drum.strike(&stroke(Striker::Stick, 4.0, 0.0, 0.7));
    render(&mut drum, 0.05, RATE);
    let modes = drum.modes();
    let body = drum.surface_mut().body();
    let largest = |round: bool| {
        let of_kind = modes.iter().take(body.len()).enumerate().filter(|(_, mode)| (mode.m == 0) == round);
        let size = |(k, mode): (usize, &ModeInfo)| {
            (body.velocity(k) / (TAU * mode.frequency_hz)).hypot(f64::from(body.displacement(k)))
        };
        of_kind.map(size).fold(0.0, f64::max)
    };
    decibels(largest(true), largest(false).max(1e-30))
}

/// Spectrum of a stroke, and the modes in vacuum and in air.
fn spectrum() -> Result<Plot<'static>> {
    let mut timpani = round_piece("timpani", RATE);
    timpani.strike(&stroke(Striker::TimpaniMallet, 2.0, 0.75, 0.0));
    let sound = render(&mut timpani, 2.0, RATE);
    let heard = OnsetSpectrum::of_onset(&sound, RATE, 1.0);
    let tension = timpani.tensions()[0].1;
    let range = ModeRange { reference_tension: tension, limit_hz: 600.0 };
    let timpani_spec = drum("timpani");
    let head = timpani_spec.membrane(&timpani_spec.batter);
    let vacuum = Membrane::new(head, Surroundings::Vacuum, &range).map_err(|error| bad_input!("{error}"))?;
    let in_vacuum: Vec<f64> =
        vacuum.modes().iter().map(|mode| vacuum.ringing(mode, tension).omega / TAU).collect();
    let loaded: Vec<f64> =
        timpani.modes().iter().filter(|mode| mode.body == "batter").map(|mode| mode.frequency_hz).collect();
    let levels: Vec<(f64, f64)> =
        (50..500).filter_map(|hz| Some((f64::from(hz), heard.level_db(f64::from(hz))?))).collect();
    let top = levels.iter().map(|level| level.1).fold(f64::NEG_INFINITY, f64::max);
    let below =
        |modes: &[f64]| modes.iter().copied().filter(|hz| (50.0..500.0).contains(hz)).collect::<Vec<_>>();
    let lines: Vec<Curve> = vec![
        comb("vacuum", &below(&in_vacuum), [-80.0, -68.0]),
        comb("air and kettle", &below(&loaded), [-66.0, -54.0]),
        ("heard".to_owned(), levels.iter().map(|&(hz, db)| (hz, (db - top).max(-80.0))).collect()),
    ];
    Ok(Plot {
        across: Axis::linear("Hz", 50.0..500.0),
        up: Axis::linear("dB", -80.0..3.0),
        panels: vec![("felt mallet, 2 m/s at .75".to_owned(), lines)],
    })
}
