//! Drums: contacts, what a stroke's speed and striker change, the pillow, the band above the modes.

use anyhow::Result;
use overhear_engine::cavity::{CavitySpec, HeadShape};
use overhear_engine::drum::DrumSpec;
use overhear_engine::piece::{BuildOptions, PieceId};
use overhear_engine::snapshot::StrikeSnapshot;
use overhear_engine::strike::{Strike, Striker};
use overhear_lab::{Chance, Spectrum, build, decibels, piece, render, stroke};

use super::page::sources::{EARLIER, EXACT, GOAL, MEASURED};
use super::plot::{Axis, Plot};
use super::{Claim, Page, Sheet};
use crate::hear;

const RATE: f64 = 44_100.0;

/// Strokes on every piece of which none may come back faster than it came.
const STROKES: usize = 60;

/// The page.
///
/// # Errors
/// If a drum cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "drums",
        "Drums",
        "Each drum by itself at its listening point, 44.1 kHz. `hear` gives the same figures;\n\
         `tests/tests/strokes.rs`, `tests/tests/drums.rs` and `tests/tests/passivity.rs` hold them.",
    );
    contacts(&mut sheet);
    leaving(&mut sheet);
    let pillow = pillow_db();
    sheet.claim(Claim {
        what: "a pillow takes from a kick's boom, 30 to 120 Hz".to_owned(),
        figure: format!("{pillow:.1} dB"),
        reference: "6 dB or more".to_owned(),
        source: EARLIER,
        met: Some(pillow >= 6.0),
    });
    let plastic = plastic_db();
    sheet.claim(Claim {
        what: "a plastic beater over felt, above 4 kHz".to_owned(),
        figure: format!("{plastic:+.1} dB"),
        reference: "+6 dB or more (10)".to_owned(),
        source: EARLIER,
        met: Some(plastic >= 6.0),
    });
    speeds(&mut sheet)?;
    volume(&mut sheet);
    high_band(&mut sheet)?;
    Ok(sheet.finish())
}

/// What the contact of one stroke measures.
pub fn measured(id: PieceId, strike: &Strike) -> StrikeSnapshot {
    let mut piece = piece(id, RATE);
    piece.strike(strike);
    render(&mut piece, 0.1, RATE);
    piece.last_strike()
}

/// Strokes and what was published of them: contact (ms), peak force (N), speed away (m/s; not a number where it was not).
pub fn published() -> [(PieceId, Strike, [f64; 3]); 5] {
    let stick = stroke(Striker::Stick, 4.0, 0.4, 0.0);
    [
        (PieceId::RackTom, stick, [5.8, 31.0, 3.5]),
        (PieceId::FloorTom, stick, [7.1, 26.0, 3.1]),
        (PieceId::Snare, stick, [3.8, 46.0, 3.4]),
        (PieceId::Kick, stroke(Striker::FeltBeater, 3.0, 0.2, 0.0), [19.0, 57.0, 2.6]),
        (PieceId::Timpani, stroke(Striker::TimpaniMallet, 2.0, 0.75, 0.0), [8.2, 19.0, f64::NAN]),
    ]
}

/// Contact (ms), peak force (N) and speed away (m/s).
pub fn contact_figures(strike: &StrikeSnapshot) -> [f64; 3] {
    [1e3 * strike.contact_time, strike.peak_force, strike.leaving_speed].map(f64::from)
}

fn contacts(sheet: &mut Sheet) {
    for (id, strike, wanted) in published() {
        let got = contact_figures(&measured(id, &strike));
        let what = ["contact", "peak force", "leaves at"].into_iter().zip(["ms", "N", "m/s"]);
        for ((what, unit), (got, wanted)) in what.zip(got.into_iter().zip(wanted)) {
            if !wanted.is_nan() {
                let Strike { speed, radius, striker, .. } = strike;
                let what = format!("{}, {} {speed} m/s at {radius}: {what}", id.name(), striker.name());
                sheet.claim(Claim::near(&what, (got, unit), (wanted, 0.15), EARLIER));
            }
        }
    }
    for id in [PieceId::Snare, PieceId::RackTom, PieceId::FloorTom] {
        let time =
            |speed| 1e3 * f64::from(measured(id, &stroke(Striker::Stick, speed, 0.35, 0.0)).contact_time);
        let [soft, hard] = [0.5, 10.0].map(time);
        sheet.claim(Claim {
            what: format!("{}: a stick touches, at .5 and 10 m/s", id.name()),
            figure: format!("{soft:.2} and {hard:.2} ms"),
            reference: "3 to 9 ms (real sticks 3 to 6), no longer when harder".to_owned(),
            source: MEASURED,
            met: Some((3.0..9.0).contains(&soft) && hard <= 1.001 * soft),
        });
    }
}

/// No stroke leaves faster than it came: each piece, any place, any striker, to 25 m/s.
fn leaving(sheet: &mut Sheet) {
    let (mut fastest, mut which) = (0.0_f64, String::new());
    for id in PieceId::ALL {
        let mut piece = piece(id, RATE);
        let mut chance = Chance::new(id as u64);
        for _ in 0..STROKES {
            let strike = Strike { speed: chance.between(0.05, 25.0), ..chance.stroke(25.0) };
            piece.reset();
            piece.strike(&strike);
            for _ in 0..1000 {
                if piece.striker_energy() == 0.0 {
                    break;
                }
                render(&mut piece, 0.002, RATE);
            }
            let ratio = f64::from(piece.last_strike().leaving_speed.abs()) / strike.speed;
            if ratio > fastest {
                which = format!("{}, {} at {:.2}", id.name(), strike.striker.name(), strike.radius);
                fastest = ratio;
            }
        }
    }
    sheet.claim(Claim {
        what: format!("{STROKES} strokes on each piece, any place, striker and speed to 25 m/s: speed away over speed in"),
        figure: format!("{fastest:.3} at most ({which})"),
        reference: "1 (the earlier engine gains 32 % at a floor tom's rim)".to_owned(),
        source: EXACT,
        met: Some(fastest <= 1.0),
    });
}

/// What a pillow takes from a kick's boom, dB.
pub fn pillow_db() -> f64 {
    let boom = |muffling: f64| {
        let mut kick = piece(PieceId::Kick, RATE);
        kick.set_muffling(muffling);
        kick.finish_controls();
        kick.strike(&stroke(Striker::FeltBeater, 4.0, 0.2, 0.0));
        let sound = render(&mut kick, 0.6, RATE);
        Spectrum::hann(&sound[(0.1 * RATE) as usize..], RATE).band(30.0, 120.0).sqrt()
    };
    decibels(boom(0.0), boom(1.0))
}

/// How much more a plastic beater sounds above 4 kHz than one of felt, dB.
pub fn plastic_db() -> f64 {
    let click = |striker| {
        let mut kick = piece(PieceId::Kick, RATE);
        kick.strike(&stroke(striker, 3.0, 0.2, 0.0));
        Spectrum::new(&render(&mut kick, 1.0, RATE), RATE).band(4000.0, 20_000.0).sqrt()
    };
    decibels(click(Striker::PlasticBeater), click(Striker::FeltBeater))
}

/// How much louder a stick at 5 m/s is than at 1 m/s, and how much more of it is above 2 kHz, dB.
pub fn harder_db(id: PieceId, at: f64) -> [f64; 2] {
    let [soft, hard] = [1.0, 5.0].map(|speed| {
        let mut drum = piece(id, RATE);
        drum.strike(&stroke(Striker::Stick, speed, at, 0.2));
        let spectrum = Spectrum::new(&render(&mut drum, 1.0, RATE), RATE);
        let all = spectrum.band(20.0, 20_000.0).sqrt();
        (all, spectrum.band(2000.0, 20_000.0).sqrt() / all)
    });
    [decibels(hard.0, soft.0), decibels(hard.1, soft.1)]
}

fn speeds(sheet: &mut Sheet) -> Result<()> {
    for (id, at, published) in [(PieceId::Snare, 0.3, 14.0), (PieceId::RackTom, 0.4, 15.0)] {
        let [louder, brighter] = harder_db(id, at);
        sheet.claim(Claim {
            what: format!("{}, stick at 5 against 1 m/s: louder, and more of it above 2 kHz", id.name()),
            figure: format!("{louder:.1} dB, {brighter:+.1} dB"),
            reference: format!("{published} dB within 2, less than 3 dB"),
            source: EARLIER,
            met: Some((louder - published).abs() < 2.0 && brighter.abs() < 3.0),
        });
    }
    let mut centroids = [0.0; 2];
    for (striker, centroid) in [Striker::TimpaniMallet, Striker::HardMallet].into_iter().zip(&mut centroids) {
        let (piece, strike) = (PieceId::Timpani, stroke(striker, 2.0, 0.75, 0.0));
        let options = BuildOptions::new(RATE);
        let request = hear::Request { piece, strike, settings: Vec::new(), options, seconds: 1.0, wav: None };
        *centroid = hear::run(&request)?.centroid_hz.unwrap_or(f64::NAN);
    }
    let [felt, hard] = centroids;
    sheet.claim(Claim {
        what: "timpani, felt against hard mallet: centroid".to_owned(),
        figure: format!("{felt:.0} against {hard:.0} Hz"),
        reference: "436 against 1122 Hz: half as high again or more".to_owned(),
        source: EARLIER,
        met: Some(hard > 1.5 * felt),
    });
    Ok(())
}

/// The spring of the enclosed air over a head that moves all one way: stiffness, and spring times volume, Pa.
pub fn cavity_stiffness(share: f64) -> (f64, f64) {
    let whole = DrumSpec::timpani().cavity.expect("a kettle");
    let cavity = CavitySpec { volume: share * whole.volume, ..whole };
    let heads = [HeadShape { zero: super::modal::ZEROS[0], norm: 1.926, far: false }];
    let uniform = cavity.order(0, &heads, std::f64::consts::TAU * 2500.0).modes[0].clone();
    (uniform.spring * uniform.volume[0].powi(2), uniform.spring * cavity.volume)
}

fn volume(sheet: &mut Sheet) {
    let (whole, half) = (cavity_stiffness(1.0), cavity_stiffness(0.5));
    let ratio = half.0 / whole.0;
    sheet.claim(Claim {
        what: "half the volume of the enclosed air: its spring".to_owned(),
        figure: format!("{ratio:.9} times"),
        reference: "2 (the earlier engine ignores the volume)".to_owned(),
        source: EXACT,
        met: Some((ratio - 2.0).abs() < 1e-9),
    });
}

fn high_band(sheet: &mut Sheet) -> Result<()> {
    let [with, without] = [true, false].map(|high_band| {
        let mut tom = build(PieceId::RackTom, &BuildOptions { high_band, ..BuildOptions::new(RATE) });
        tom.strike(&stroke(Striker::Stick, 4.0, 0.4, 0.2));
        let sound = render(&mut tom, 1.0, RATE);
        (Spectrum::new(&sound, RATE), contact_figures(&tom.last_strike()))
    });
    let above = |spectrum: &Spectrum| spectrum.band(4000.0, 20_000.0).sqrt();
    let gain = decibels(above(&with.0), above(&without.0));
    sheet.claim(Claim {
        what: "rack tom, 4 m/s: what the high band adds above 4 kHz".to_owned(),
        figure: format!("{gain:+.1} dB"),
        reference: "+10 dB or more".to_owned(),
        source: EARLIER,
        met: Some(gain >= 10.0),
    });
    let moved = with.1.iter().zip(without.1).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    sheet.claim(Claim {
        what: "what it changes of the contact".to_owned(),
        figure: format!("{:.2} %", 100.0 * moved),
        reference: "3 %".to_owned(),
        source: EARLIER,
        met: Some(moved < 0.03),
    });
    let top = decibels(with.0.band(14_000.0, 16_000.0).sqrt(), without.0.band(14_000.0, 16_000.0).sqrt());
    sheet.claim(Claim {
        what: "what it adds from 14 to 16 kHz".to_owned(),
        figure: format!("{top:+.1} dB"),
        reference: "more than 0 (the earlier engine is silent above 10.8 kHz)".to_owned(),
        source: GOAL,
        met: Some(top > 0.0),
    });
    let levels = |spectrum: &Spectrum| {
        let centres = (0..).map(|i| 100.0 * 2.0_f64.powf(f64::from(i) / 6.0)).take_while(|hz| *hz < 18_000.0);
        let level = |hz: f64| 10.0 * spectrum.band(hz / 1.06, hz * 1.06).max(1e-30).log10();
        centres.map(|hz| (hz, level(hz))).collect::<Vec<_>>()
    };
    let lines = [("with", levels(&with.0)), ("without", levels(&without.0))];
    let top = lines[0].1.iter().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max);
    let under = |(name, points): (&str, Vec<(f64, f64)>)| {
        (name.to_owned(), points.into_iter().map(|(hz, db)| (hz, (db - top).max(-90.0))).collect())
    };
    sheet.plot(
        "high-band",
        "A stroke on the rack tom with its high band and without, sixth octaves",
        &Plot {
            across: Axis::log("Hz", 100.0..18_000.0),
            up: Axis::linear("dB", -90.0..3.0),
            panels: vec![("stick, 4 m/s at .4".to_owned(), lines.into_iter().map(under).collect())],
        },
    )
}
