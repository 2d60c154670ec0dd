//! The snare's wires, and the air that carries a stroke to them.

use std::f64::consts::TAU;

use anyhow::Result;
use overhear_engine::drum::DrumSpec;
use overhear_engine::drum::build::Blueprint;
use overhear_engine::kit::BLOCK;
use overhear_engine::piece::{Piece, PieceId};
use overhear_engine::strike::Striker;
use overhear_lab::{Spectrum, decibels, piece, render, stroke};

use super::page::sources::{EARLIER, EXACT};
use super::plot::{Axis, Plot};
use super::{Claim, Page, Sheet};
use crate::bad_input;

const RATE: f64 = 44_100.0;

/// Preloads of the wires from loose to tight, N; the middle one is the default.
const PRELOADS: [f64; 3] = [0.03, 0.15, 1.5];

/// The page.
///
/// # Errors
/// If the drum cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "snare",
        "Snare",
        "The snare by itself, struck at .3 of its radius, 44.1 kHz. Landings count every group of wires. `hear snare` gives the\n\
         same figures; `tests/tests/strokes.rs` and `tests/tests/drums.rs` hold them.",
    );
    air(&mut sheet)?;
    let mut claim = |what: String, figure: String, reference: &str, met: bool| {
        sheet.claim(Claim { what, figure, reference: reference.to_owned(), source: EARLIER, met: Some(met) });
    };
    for (speed, published) in [(0.8, 160.0), (2.0, 232.0), (4.0, 292.0)] {
        let landings = f64::from(struck(speed, PRELOADS[1], true).0.wires().landings);
        let within = (landings / published - 1.0).abs() < 0.35;
        claim(
            format!("landings in 1 s after {speed} m/s"),
            format!("{landings}"),
            &format!("{published}, 35 %"),
            within,
        );
    }
    let ghost = struck(0.3, PRELOADS[1], true).0.wires().landings;
    claim(
        "a ghost note at .3 m/s buzzes".to_owned(),
        format!("{ghost} landings"),
        "more than 20",
        ghost > 20,
    );
    let off = struck(4.0, PRELOADS[1], false).0.wires().landings;
    claim("with the wires thrown off, 4 m/s".to_owned(), format!("{off} landings"), "none", off == 0);
    let lasts = PRELOADS.map(|preload| struck(4.0, preload, true).0.wires().last_lift);
    claim(
        "last lift at .03, .15 and 1.5 N of preload".to_owned(),
        format!("{:.2}, {:.2}, {:.2} s", lasts[0], lasts[1], lasts[2]),
        "looser buzzes longer",
        lasts.windows(2).all(|pair| pair[0] > pair[1]),
    );
    let [on, off] = [true, false].map(|on| {
        let sound = struck(4.0, PRELOADS[1], on).1;
        Spectrum::new(&sound[..(0.05 * RATE) as usize], RATE).band(3000.0, 20_000.0).sqrt()
    });
    let gain = decibels(on, off);
    claim(
        "what the wires add above 3 kHz in the first 50 ms".to_owned(),
        format!("{gain:+.1} dB"),
        "+4 dB or more",
        gain >= 4.0,
    );
    let lines = PRELOADS.map(|preload| (format!("{preload} N"), aloft(preload))).into();
    sheet.plot(
        "wires",
        "Groups of wires off the head after a stroke of 4 m/s, for three preloads, means over 10 ms",
        &Plot {
            across: Axis::linear("s after the stroke", 0.0..0.3),
            up: Axis::linear("groups off the head", 0.0..8.5),
            panels: vec![("eight groups of wires".to_owned(), lines)],
        },
    )?;
    Ok(sheet.finish())
}

/// The snare with its wires set.
fn set(preload: f64, on: bool) -> Piece {
    let mut snare = piece(PieceId::Snare, RATE);
    snare.set_preload(preload);
    snare.throw_wires(on);
    snare.finish_controls();
    snare
}

/// A stroke on the snare with the wires set, and the second after it.
fn struck(speed: f64, preload: f64, on: bool) -> (Piece, Vec<f32>) {
    let mut snare = set(preload, on);
    snare.strike(&stroke(Striker::Stick, speed, 0.3, 0.0));
    let sound = render(&mut snare, 1.0, RATE);
    (snare, sound)
}

/// Groups off the head over time, s.
fn aloft(preload: f64) -> Vec<(f64, f64)> {
    let mut snare = set(preload, true);
    snare.strike(&stroke(Striker::Stick, 4.0, 0.3, 0.0));
    let blocks: Vec<f64> = (0..(0.3 * RATE) as usize / BLOCK)
        .map(|_| {
            snare.render(&mut [0.0; BLOCK]);
            f64::from(snare.wires().aloft)
        })
        .collect();
    let window = (0.01 * RATE) as usize / BLOCK;
    let means = blocks.chunks(window).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    means.enumerate().map(|(i, mean)| ((i as f64 + 0.5) * (window * BLOCK) as f64 / RATE, mean)).collect()
}

/// The first mode of the air across the drum, and what it takes to the snare side.
fn air(sheet: &mut Sheet) -> Result<()> {
    let spec = DrumSpec::snare();
    let cavity = spec.cavity.expect("air between its heads");
    let hz = cavity.order(1, &[], TAU * 2000.0).modes[0].omega / TAU;
    sheet.claim(Claim::near(
        "14 x 5.5 in: first transverse mode of the air",
        (hz, "Hz"),
        (565.0, 0.004),
        EXACT,
    ));
    let share = 100.0 * transverse_share()?;
    sheet.claim(Claim {
        what: "of the snare side's energy in modes of one nodal diameter, 50 ms after 4 m/s".to_owned(),
        figure: format!("{share:.1} %"),
        reference: "3 % or more".to_owned(),
        source: EARLIER,
        met: Some(share > 3.0),
    });
    Ok(())
}

/// Share of the snare side's energy that is in modes of one nodal diameter 50 ms after a stroke of 4 m/s.
///
/// # Errors
/// If the drum cannot be built.
pub fn transverse_share() -> Result<f64> {
    let blueprint = Blueprint::new(&DrumSpec::snare()).map_err(|error| bad_input!("{error}"))?;
    let mut snare = piece(PieceId::Snare, RATE);
    snare.strike(&stroke(Striker::Stick, 4.0, 0.3, 0.3));
    render(&mut snare, 0.05, RATE);
    let body = snare.surface_mut().body();
    let (mut transverse, mut all, mut k) = (0.0, 0.0, 0);
    for mode in &blueprint.modes {
        for _ in 0..if mode.m == 0 { 1 } else { 2 } {
            let own = body.modes()[k];
            let motion = body.velocity(k).powi(2) + (own.omega * f64::from(body.displacement(k))).powi(2);
            let energy = own.mass * motion * mode.reference.share[1];
            all += energy;
            transverse += if mode.m == 1 { energy } else { 0.0 };
            k += 1;
        }
    }
    Ok(transverse / all)
}
