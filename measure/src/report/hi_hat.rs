//! The hi-hat: energy, decay against the pedal, sizzle, and the foot alone.

use crate::spectra::PowerSpectrum;
use crate::{decibels, lossless_piece, piece, render, stroke, total_energy};
use anyhow::Result;
use overhear::midi_map::NoteTable;
use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::Piece;
use overhear_engine::strike::Striker;

use super::page::bodies::PLAYED;
use super::page::sources::{EXACT, GOAL};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Plot};
use crate::analysis::{OneShot, envelope, octave_decays};

const RATE: f64 = 44_100.0;

/// Places of the pedal, from 0 (open) to 1 (clamped).
pub const PLACES: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 0.9, 1.0];

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "hi-hat",
        "Hi-hat",
        PLAYED,
        "The hi-hat of the standard kit alone: two 14 in cymbals, 32 contacts around their rims, struck near the edge; the\n\
         pedal from 0 (open) to 1 (clamped). `tests/tests/hi_hat.rs` holds these figures.",
    );
    energy(&mut sheet);
    decays(&mut sheet)?;
    sizzle(&mut sheet);
    foot(&mut sheet);
    Ok(sheet.finish())
}

/// Brings the pedal there, a share of its way, and lets all rest.
pub fn hold(hat: &mut Piece, pedal: f64) {
    hat.press_pedal(pedal, SPEED.1);
    hat.finish_controls();
}

fn energy(sheet: &mut Sheet) {
    let mut hat = lossless_piece("hi-hat", RATE);
    for pedal in PLACES {
        hat.reset();
        hold(&mut hat, pedal);
        hat.strike(&stroke(Striker::Stick, 5.0, 0.97, 0.3));
        let brought = total_energy(&hat);
        let mut worst = 0.0_f64;
        for _ in 0..100 {
            render(&mut hat, 0.01, RATE);
            worst = worst.max((total_energy(&hat) / brought - 1.0).abs());
        }
        let landings = hat.rims().landings;
        sheet.claim(Claim {
            what: format!("lossless, pedal at {pedal}, 5 m/s: energy over 1 s"),
            on: PLAYED,
            figure: format!("{worst:.0e} off at most, {landings} landings of the rims"),
            reference: "1e-3".to_owned(),
            source: EXACT,
            met: Some(worst < 1e-3),
        });
    }
}

/// A stroke on the edge with the pedal held.
pub struct Struck {
    /// Four seconds of it.
    pub sound: Vec<f32>,
    /// Landings of the rims in the first.
    pub landings: u32,
}

/// Strikes the edge at a speed (m/s) with the pedal held at a share of its way.
pub fn struck(hat: &mut Piece, pedal: f64, speed: f64) -> Struck {
    hat.reset();
    hold(hat, pedal);
    hat.strike(&stroke(Striker::Stick, speed, 0.97, 0.3));
    let mut sound = render(hat, 1.0, RATE);
    let landings = hat.rims().landings;
    sound.extend(render(hat, 3.0, RATE));
    Struck { sound, landings }
}

/// Decay of a stroke with the pedal held.
#[derive(Debug, Clone)]
pub struct Decay {
    /// Of the octaves from 500 Hz to 8 kHz, s.
    pub octaves: Vec<f64>,
    /// Their geometric mean, s.
    pub mean: f64,
    /// Mean time, weighted by energy, ms.
    pub centroid_ms: f64,
    /// Landings of the rims in the first second.
    pub landings: u32,
}

/// Strikes at 5 m/s with the pedal held, and measures the decay.
pub fn decay(hat: &mut Piece, pedal: f64) -> Decay {
    let Struck { sound, landings } = struck(hat, pedal, 5.0);
    let octaves: Vec<f64> = octave_decays(&sound, RATE)[4..9].iter().flatten().copied().collect();
    let mean = (octaves.iter().map(|t60| t60.ln()).sum::<f64>() / octaves.len() as f64).exp();
    let shot = OneShot::new(&sound, RATE);
    let centroid_ms = shot.and_then(|shot| envelope::temporal_centroid_ms(&shot)).unwrap_or(f64::NAN);
    Decay { octaves, mean, centroid_ms, landings }
}

fn decays(sheet: &mut Sheet) -> Result<()> {
    let mut hat = piece("hi-hat", RATE);
    let decays = PLACES.map(|pedal| (pedal, decay(&mut hat, pedal)));
    let means: Vec<String> = decays.iter().map(|(_, decay)| format!("{:.2}", decay.mean)).collect();
    sheet.claim(Claim {
        what: "T60 against the position of the pedal, mean of the octaves from 500 Hz to 8 kHz".to_owned(),
        on: PLAYED,
        figure: format!("{} s", means.join(", ")),
        reference: "falls; open 2 to 5 s".to_owned(),
        source: GOAL,
        met: Some(
            decays.windows(2).all(|pair| pair[1].1.mean < pair[0].1.mean)
                && (2.0..5.0).contains(&decays[0].1.mean),
        ),
    });
    let closed = &decays[PLACES.len() - 1].1;
    sheet.claim(Claim {
        what: "clamped: T60 and mean time".to_owned(),
        on: PLAYED,
        figure: format!("{:.2} s, {:.0} ms", closed.mean, closed.centroid_ms),
        reference: ".25 to .5 s, less than 51 ms (half as much again as the 34 of recordings)".to_owned(),
        source: GOAL,
        met: Some((0.25..0.5).contains(&closed.mean) && closed.centroid_ms < 51.0),
    });
    let octaves = [500, 1000, 2000, 4000, 8000];
    let line = |octave: usize| {
        let points = decays.iter().filter_map(|(pedal, decay)| Some((*pedal, *decay.octaves.get(octave)?)));
        (format!("{} Hz", octaves[octave]), points.collect())
    };
    sheet.plot(
        "pedal",
        "Decay time of each octave against the pedal",
        &Plot {
            across: Axis::linear("pedal", 0.0..1.0),
            up: Axis::log("T60, s", 0.1..10.0),
            panels: vec![("stick, 5 m/s at .97".to_owned(), (0..octaves.len()).map(line).collect())],
        },
    )?;
    sheet.table(
        &["pedal", "T60, s", "mean time, ms", "landings in 1 s"],
        decays.iter().map(|(pedal, decay)| {
            let Decay { mean, centroid_ms, landings, .. } = decay;
            vec![format!("{pedal}"), format!("{mean:.2}"), format!("{centroid_ms:.0}"), format!("{landings}")]
        }),
    );
    Ok(())
}

/// How much more there is above 5 kHz half open than open and than closed, in the half second after the stroke, dB;
/// and the landings.
///
/// # Panics
/// If the standard kit has no half-open note.
pub fn sizzle_db(hat: &mut Piece) -> ([f64; 2], [u32; 3]) {
    let mut bright = |pedal: f64| {
        let Struck { sound, landings } = struck(hat, pedal, 4.0);
        // After the stroke itself.
        let spectrum = PowerSpectrum::hann(&sound[4410..4410 + 22_050], RATE);
        (spectrum.band(5000.0, 20_000.0).sqrt(), landings)
    };
    let notes = NoteTable::standard(&KitSpec::standard());
    let half_open = notes.row(100).and_then(|row| row.pedal).expect("a half-open note");
    let [open, half, closed] = [0.0, half_open, 1.0].map(&mut bright);
    ([open, closed].map(|other| decibels(half.0, other.0)), [open.1, half.1, closed.1])
}

fn sizzle(sheet: &mut Sheet) {
    let ([open, closed], landings) = sizzle_db(&mut piece("hi-hat", RATE));
    sheet.claim(Claim {
        what: "half open against open and closed, above 5 kHz after the stroke".to_owned(),
        on: PLAYED,
        figure: format!("{open:+.1} and {closed:+.1} dB, {} landings", landings[1]),
        reference: "+3 dB both, more than 200 landings; open none".to_owned(),
        source: GOAL,
        met: Some(open > 3.0 && closed > 3.0 && landings[1] > 200 && landings[0] == 0),
    });
}

/// What the pedal alone sounds like: root mean square of the loudest tenth of a second, Pa, and how long after its peak
/// it is above a thousandth of it, s.
pub fn by_foot(hat: &mut Piece, act: impl Fn(&mut Piece)) -> (f64, f64) {
    hat.press_pedal(0.0, SPEED.1);
    hat.reset();
    act(hat);
    let sound = render(hat, 3.0, RATE);
    let peak = sound.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    let at = |level: f32| sound.iter().rposition(|x| x.abs() >= level).unwrap_or(0);
    let tenth = (0.1 * RATE) as usize;
    let power = sound.chunks(tenth).map(|part| part.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>());
    let loudest = (power.fold(0.0, f64::max) / tenth as f64).sqrt();
    (loudest, (at(1e-3 * peak) - at(peak)) as f64 / RATE)
}

fn foot(sheet: &mut Sheet) {
    let mut hat = piece("hi-hat", RATE);
    let mut before = [0.0; 2];
    for speed in [0.2, 0.5, 1.0, 2.0] {
        let (chick, held) = by_foot(&mut hat, |hat| hat.stamp_pedal(speed));
        let (splash, rings) = by_foot(&mut hat, |hat| hat.splash_pedal(speed));
        sheet.claim(Claim {
            what: format!("the foot alone, {speed} m/s: chick and splash"),
            on: PLAYED,
            figure: format!("{chick:.2} Pa for {held:.2} s, {splash:.2} Pa for {rings:.2} s"),
            reference: "each a fifth louder than the slower one; under .3 s, over .8 s".to_owned(),
            source: GOAL,
            met: Some(chick > 1.2 * before[0] && splash > 1.2 * before[1] && held < 0.3 && rings > 0.8),
        });
        before = [chick, splash];
    }
}
