//! The snare's wires, and the air that carries a stroke to them.

use std::f64::consts::TAU;

use crate::spectra::PowerSpectrum;
use crate::{build, decibels, drum, reference, render, render_into, spec, stroke};
use anyhow::{Context, Result};
use overhear_engine::drum::modes::DrumModes;
use overhear_engine::kit::BLOCK;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::strike::Striker;
use overhear_engine::surface::wires::PRELOAD;

use super::page::bodies::{FIXED_DISC, PLAYED};
use super::page::sources::{EARLIER, EXACT};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Plot};
use crate::bad_input;

const RATE: f64 = 44_100.0;

/// The page.
///
/// # Errors
/// If the drum cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "snare",
        "Snare",
        PLAYED,
        "A snare alone, struck at .3 of its radius, 44.1 kHz: that of the standard kit, and one of 220 Hz with a fixed disc under\n\
         the stick and .15 N on its wires, for which landings were published. Those were counted of eight\n\
         masses on springs, here all sections of the strings count. `hear snare`\n\
         gives the same figures of the first; `tests/tests/strokes.rs` and `tests/tests/drums.rs` hold them.",
    );
    let (published, played) = (reference::fixed_disc_snare(), spec("snare"));
    air(&mut sheet, [(&published, FIXED_DISC), (&played, PLAYED)])?;
    landings(&mut sheet, &published, &played);
    wires(&mut sheet, &played, PLAYED);
    wires(&mut sheet, &published, FIXED_DISC);
    let lines = preloads(&played).map(|preload| (format!("{preload} N"), aloft(&played, preload))).into();
    sheet.plot(
        "wires",
        "Sections of the standard kit's wires off the head after a stroke of 4 m/s, for three preloads, means over 10 ms",
        &Plot {
            across: Axis::linear("s after the stroke", 0.0..0.3),
            up: Axis::linear("sections off the head", 0.0..8.5),
            panels: vec![("eight sections of wires".to_owned(), lines)],
        },
    )?;
    Ok(sheet.finish())
}

/// Settings of a snare's controls.
#[derive(Debug, Clone, Copy)]
struct Controls {
    /// Pitch, Hz.
    pitch: f64,
    /// Force that presses the wires on, N.
    preload: f64,
    /// Whether they lie against the head.
    on: bool,
}

impl Controls {
    /// As the snare has them.
    fn own(snare: &PieceSpec) -> Controls {
        let preload = snare.defaults.preload.unwrap_or(*PRELOAD.start());
        Controls { pitch: snare.instrument.tunings()[1], preload, on: true }
    }
}

/// Landings as published, of the snare they were published of; of the standard kit's with its controls where that one's
/// are, and where its own are.
fn landings(sheet: &mut Sheet, published: &PieceSpec, played: &PieceSpec) {
    let there = Controls::own(published);
    let Controls { pitch, preload, .. } = there;
    for (speed, figure) in [(0.8, 160.0), (2.0, 232.0), (4.0, 292.0)] {
        let count =
            |snare: &PieceSpec, controls| f64::from(struck(snare, speed, controls).0.wires().landings);
        for (snare, on) in [(published, FIXED_DISC), (played, PLAYED)] {
            let landings = count(snare, there);
            sheet.claim(Claim {
                what: format!("{pitch} Hz, {preload} N on the wires: landings in 1 s after {speed} m/s"),
                on,
                figure: format!("{landings}"),
                reference: format!("{figure}, 35 %"),
                source: EARLIER,
                met: Some((landings / figure - 1.0).abs() < 0.35),
            });
        }
        let own = Controls::own(played);
        sheet.claim(Claim::told(
            &format!(
                "{} Hz, {} N, as its kit has it: landings in 1 s after {speed} m/s",
                own.pitch, own.preload
            ),
            PLAYED,
            format!("{}", count(played, own)),
            &format!("{figure} published, of a tighter head and tighter wires"),
            EARLIER,
        ));
    }
}

/// Preloads of a snare's wires from loosest over its own to tightest, N.
fn preloads(snare: &PieceSpec) -> [f64; 3] {
    [*PRELOAD.start(), Controls::own(snare).preload, *PRELOAD.end()]
}

/// Other measurements of the wires.
fn wires(sheet: &mut Sheet, snare: &PieceSpec, on: &'static str) {
    let mut claim = |what: String, figure: String, reference: &str, met: bool| {
        let reference = reference.to_owned();
        sheet.claim(Claim { what, on, figure, reference, source: EARLIER, met: Some(met) });
    };
    let (own, off) = (Controls::own(snare), Controls { on: false, ..Controls::own(snare) });
    let ghost = struck(snare, 0.3, own).0.wires().landings;
    claim(
        "a ghost note at .3 m/s buzzes".to_owned(),
        format!("{ghost} landings"),
        "more than 20",
        ghost > 20,
    );
    let landings = struck(snare, 4.0, off).0.wires().landings;
    claim(
        "with the wires thrown off, 4 m/s".to_owned(),
        format!("{landings} landings"),
        "none",
        landings == 0,
    );
    let [loose, default, tight] = preloads(snare);
    let lasts = [loose, default, tight]
        .map(|preload| struck(snare, 4.0, Controls { preload, ..own }).0.wires().last_lift);
    claim(
        format!("last lift at {loose}, {default} and {tight} N of preload"),
        format!("{:.2}, {:.2}, {:.2} s", lasts[0], lasts[1], lasts[2]),
        "looser buzzes longer",
        lasts.windows(2).all(|pair| pair[0] > pair[1]),
    );
    let [with, without] = [own, off].map(|controls| {
        let sound = struck(snare, 4.0, controls).1;
        PowerSpectrum::new(&sound[..(0.05 * RATE) as usize], RATE).band(3000.0, 20_000.0).sqrt()
    });
    let gain = decibels(with, without);
    claim(
        "level that the wires add above 3 kHz in the first 50 ms".to_owned(),
        format!("{gain:+.1} dB"),
        "+4 dB or more",
        gain >= 4.0,
    );
}

/// A snare with its controls set.
fn set(snare: &PieceSpec, controls: Controls) -> Piece {
    let mut snare = build(snare, &BuildOptions::new(RATE));
    snare.set_tuning(controls.pitch);
    snare.set_preload(controls.preload);
    snare.throw_wires(controls.on);
    snare.finish_controls();
    snare
}

/// A stroke on a snare with its controls set, and the second after it.
fn struck(snare: &PieceSpec, speed: f64, controls: Controls) -> (Piece, Vec<f32>) {
    let mut snare = set(snare, controls);
    snare.strike(&stroke(Striker::Stick, speed, 0.3, 0.0));
    let sound = render(&mut snare, 1.0, RATE);
    (snare, sound)
}

/// Sections off the head over time, s, the wires pressed on with so many N.
fn aloft(snare: &PieceSpec, preload: f64) -> Vec<(f64, f64)> {
    let mut snare = set(snare, Controls { preload, ..Controls::own(snare) });
    snare.strike(&stroke(Striker::Stick, 4.0, 0.3, 0.0));
    let blocks: Vec<f64> = (0..(0.3 * RATE) as usize / BLOCK)
        .map(|_| {
            render_into(&mut snare, &mut [0.0; BLOCK]);
            f64::from(snare.wires().aloft.count_ones())
        })
        .collect();
    let window = (0.01 * RATE) as usize / BLOCK;
    let means = blocks.chunks(window).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    means.enumerate().map(|(i, mean)| ((i as f64 + 0.5) * (window * BLOCK) as f64 / RATE, mean)).collect()
}

/// The first mode of the air across the drum, and what it takes to the snare side.
fn air(sheet: &mut Sheet, snares: [(&PieceSpec, &'static str); 2]) -> Result<()> {
    let cavity = drum("snare").cavity().context("the snare has no air between its heads")?;
    let hz = cavity.order(1, &[], TAU * 2000.0).modes[0].omega / TAU;
    sheet.claim(Claim::near(
        "14 x 5.5 in: first transverse mode of the air",
        PLAYED,
        (hz, "Hz"),
        (565.0, 0.004),
        EXACT,
    ));
    for (snare, on) in snares {
        let share = 100.0 * transverse_share(snare)?;
        sheet.claim(Claim {
            what: "share of the snare side's energy in modes of one nodal diameter, 50 ms after 4 m/s"
                .to_owned(),
            on,
            figure: format!("{share:.1} %"),
            reference: "3 % or more".to_owned(),
            source: EARLIER,
            met: Some(share > 3.0),
        });
    }
    Ok(())
}

/// Share of the snare side's energy that is in modes of one nodal diameter 50 ms after a stroke of 4 m/s.
///
/// # Errors
/// If the piece is no drum, or cannot be built.
pub fn transverse_share(snare: &PieceSpec) -> Result<f64> {
    let drum = snare.drum().with_context(|| format!("the {} is no drum", snare.name))?;
    let built = DrumModes::new(drum).map_err(|error| bad_input!("{error}"))?;
    let mut snare = build(snare, &BuildOptions::new(RATE));
    snare.strike(&stroke(Striker::Stick, 4.0, 0.3, 0.3));
    render(&mut snare, 0.05, RATE);
    let body = snare.surface_mut().body();
    let (mut transverse, mut all, mut k) = (0.0, 0.0, 0);
    for mode in &built.modes {
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
