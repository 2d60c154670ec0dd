//! Realism: every piece beside recordings, as `realism` measures it.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use crate::spec;
use anyhow::Result;
use overhear::building::Pace;
use overhear::kit_document::KitDocument;

use super::page::bodies::PLAYED;
use super::page::sources::GOAL;
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};
use crate::analysis::{OneShot, line_share};
use crate::picture;
use crate::realism::reference::{BLOOM_WITHIN, CRASH_BLOOM_MS, SLOPE_WITHIN};
use crate::realism::{self, Count, PieceReport, RATE, RecordingChain, Report, SPEEDS, SUBJECTS, Subject};

/// Source of the figures of recordings.
const RECORDINGS: &str = "3,123 recorded strokes";

/// The page.
///
/// # Errors
/// If a piece cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "realism",
        "Compared with recordings",
        PLAYED,
        "Every piece in the kit with the plugin's defaults, struck from soft to hard at three positions, at its close microphone and in the full\n\
         mix, compared with 3,123 one-shots of 36 acoustic kits: `cargo xtask realism`. Tables and pictures show the bounce, with cymbals coupled to 8 kHz;\n\
         played live, they are coupled to 2 kHz (`--live`; drums differ only by the sound of the cymbals). A range is that of 10 to 90 % of the\n\
         recordings; where only the median is known, the range near it is our choice. [realism.md](../realism.md) discusses what lies outside;\n\
         [commands.md](../commands.md#realism) defines each figure.",
    );
    let request = |subjects: Vec<Subject>, pace| realism::Request {
        subjects,
        speeds: SPEEDS.to_vec(),
        kit: KitDocument::standard(),
        settings: Vec::new(),
        pace,
    };
    // Sound of the mix at the middle position, by piece and speed.
    let heard: Mutex<BTreeMap<(&str, u64), Vec<f32>>> = Mutex::default();
    // Share of energy in lines there, by piece, recording chain and speed.
    let lines: Mutex<LineShares> = Mutex::default();
    let report =
        realism::run_and_show(&request(realism::subjects(&[])?, Pace::Offline), &|job, [close, mix]| {
            if job.place == job.subject.places[1] {
                let key = (job.subject.name, job.speed.to_bits());
                for (chain, sound) in [("close", close), ("mix", mix)] {
                    let shot = OneShot::new(sound, f64::from(RATE));
                    if let Some(share) = shot.as_ref().and_then(line_share) {
                        let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                        lines.insert((key.0, chain, key.1), share);
                    }
                }
                heard.lock().unwrap_or_else(PoisonError::into_inner).insert(key, mix.clone());
            }
            Ok(())
        })?;
    let heard = heard.into_inner().unwrap_or_else(PoisonError::into_inner);
    let cymbals = SUBJECTS.into_iter().filter(|subject| !is_drum(subject)).collect();
    let live = realism::run(&request(cymbals, Pace::RealTime))?;
    for (report, how) in [(&report, "bounced"), (&live, "played live")] {
        shares(&mut sheet, report, how);
    }
    for (report, how) in [(&report, "bounced"), (&live, "played live")] {
        brightening(&mut sheet, report, how);
    }
    in_lines(&mut sheet, &lines.into_inner().unwrap_or_else(PoisonError::into_inner));
    for heard in RecordingChain::ALL {
        let [ranges, medians] =
            [report.all(heard, |piece| piece.ranges), report.all(heard, |piece| piece.medians)];
        for (what, count) in [("in the range of recordings", ranges), ("near their median", medians)] {
            let what = format!("all pieces, {}: figures {what}", heard.name());
            sheet.claim(Claim::told(&what, PLAYED, counted(count), "as many as possible", RECORDINGS));
        }
    }
    sheet.plot(
        "decays",
        "Decay time of each octave in the mix, and in recordings (median)",
        &Plot {
            across: Axis::log("Hz", 100.0..10_000.0),
            up: Axis::log("T60, s", 0.05..30.0),
            panels: ["kick", "rack-tom", "floor-tom", "crash"]
                .map(|name| (name.to_owned(), decays(&report, name)))
                .into(),
        },
    )?;
    spectrograms(&mut sheet, &heard)?;
    report.pieces.iter().for_each(|piece| table(&mut sheet, piece, &report.speeds_m_s));
    Ok(sheet.finish())
}

/// Share of energy in lines by piece, recording chain and speed (bits of m/s).
type LineShares = BTreeMap<(&'static str, &'static str, u64), f64>;

/// More of a drum's energy from 1 to 10 kHz than this must not be in lines.
const MOST_IN_LINES: f64 = 0.35;

/// Claims: drums are noise over a few partials.
fn in_lines(sheet: &mut Sheet, shares: &LineShares) {
    for subject in SUBJECTS.iter().filter(|subject| is_drum(subject)) {
        for chain in ["close", "mix"] {
            let of = |speed: &f64| shares.get(&(subject.name, chain, speed.to_bits())).copied();
            let Some(found) = SPEEDS.iter().map(of).collect::<Option<Vec<f64>>>() else { continue };
            let figures: Vec<String> = found.iter().map(|share| format!("{share:.2}")).collect();
            sheet.claim(Claim {
                what: format!(
                    "{}, {chain}: share of the energy from 1 to 10 kHz in lines, soft to hard",
                    subject.name
                ),
                on: PLAYED,
                figure: figures.join(", "),
                reference: format!("below {MOST_IN_LINES} (0.17 to 0.22)"),
                source: RECORDINGS,
                met: Some(found.iter().all(|&share| share < MOST_IN_LINES)),
            });
        }
    }
}

/// Claims: how many figures lie where recordings have them.
fn shares(sheet: &mut Sheet, report: &Report, how: &str) {
    for heard in RecordingChain::ALL {
        for piece in report.pieces.iter().filter(|piece| piece.heard == heard) {
            let (share, goal) = (piece.firm.share(), heard.goal());
            sheet.claim(Claim {
                what: format!(
                    "{}, {how}, {}: figures of strokes of 3 m/s and more within the recordings",
                    piece.piece,
                    heard.name()
                ),
                on: PLAYED,
                figure: counted(piece.firm),
                reference: format!("{:.0} %", 100.0 * goal),
                source: GOAL,
                met: Some(share >= goal),
            });
        }
    }
}

/// Claims: how pieces change with the stroke.
fn brightening(sheet: &mut Sheet, report: &Report, how: &str) {
    for piece in &report.pieces {
        let who = format!("{}, {how}, {}", piece.piece, piece.heard.name());
        if let Some(slope) = &piece.slope {
            sheet.claim(Claim {
                what: format!("{who}: growth of {} with the level, octaves per 20 dB", slope.feature),
                on: PLAYED,
                figure: slope.value.map_or("-".to_owned(), |value| format!("{value:.2}")),
                reference: format!("{} within {SLOPE_WITHIN}", slope.median),
                source: RECORDINGS,
                met: Some(slope.inside),
            });
        }
        if let Some(bloom) = piece.bloom().filter(|_| piece.piece == "crash") {
            let listed = |ms: &[f64]| ms.iter().map(|ms| format!("{ms:.0}")).collect::<Vec<_>>().join(", ");
            let is_near = |(ms, recorded): (&f64, f64)| {
                (recorded / BLOOM_WITHIN..=recorded * BLOOM_WITHIN).contains(ms)
            };
            let rises = bloom.is_sorted_by(|soft, hard| soft < hard);
            sheet.claim(Claim {
                what: format!("{who}: when the band above 3 kHz peaks, soft to hard, ms"),
                on: PLAYED,
                figure: listed(&bloom),
                reference: format!("rising; {} within a factor of {BLOOM_WITHIN}", listed(&CRASH_BLOOM_MS)),
                source: RECORDINGS,
                met: Some(rises && bloom.iter().zip(CRASH_BLOOM_MS).all(is_near)),
            });
        }
    }
}

/// A picture of every piece at every speed.
fn spectrograms(sheet: &mut Sheet, heard: &BTreeMap<(&str, u64), Vec<f32>>) -> Result<()> {
    for subject in &SUBJECTS {
        let length = (shown(subject) * f64::from(RATE)) as usize;
        let panel = |speed: &f64| {
            let sound = heard.get(&(subject.name, speed.to_bits()))?;
            Some((format!("{} {speed} m/s", subject.name), sound.get(..length).unwrap_or(sound)))
        };
        let panels: Vec<(String, &[f32])> = SPEEDS.iter().filter_map(panel).collect();
        sheet.picture(
            subject.name,
            &format!("{} in the mix at three speeds, each from its loudest down to -90 dB", subject.name),
            picture::spectrograms(&panels, f64::from(RATE))?,
        );
    }
    Ok(())
}

/// How much of a stroke is shown, s: what is heard of it.
fn shown(subject: &Subject) -> f64 {
    if is_drum(subject) || subject.name == "hi-hat-closed" { 1.5 } else { 4.0 }
}

fn is_drum(subject: &Subject) -> bool {
    spec(subject.piece).drum().is_some()
}

fn table(sheet: &mut Sheet, piece: &PieceReport, speeds: &[f64]) {
    let places = piece.at.map(|place| place.to_string()).join(", ");
    sheet.heading(&format!("{}, {}: {} at {places}", piece.piece, piece.heard.name(), piece.striker));
    let speeds: Vec<String> = speeds.iter().map(|speed| format!("{speed} m/s")).collect();
    let mut head = vec!["figure", "recordings", "from", "to"];
    head.extend(speeds.iter().map(String::as_str));
    let row = |row: &realism::Row| {
        let (open, close) = if row.ranged { ("", "") } else { ("(", ")") };
        let bound = |value: f64| format!("{open}{}{close}", short(value));
        let cell = |(value, inside): (&Option<f64>, &bool)| match (value, inside) {
            (None, _) => "-".to_owned(),
            (Some(value), true) => short(*value),
            (Some(value), false) => format!("**{}**", short(*value)),
        };
        let values = row.values.iter().zip(&row.inside).map(cell);
        let first = [row.feature.to_owned(), short(row.median), bound(row.low), bound(row.high)];
        first.into_iter().chain(values).collect()
    };
    sheet.table(&head, piece.features.iter().map(row));
    if let Some(slope) = &piece.slope {
        let value = slope.value.map_or("-".to_owned(), short);
        sheet.text(&format!(
            "{} grows by {value} octaves per +20 dB; recordings: {}.",
            slope.feature,
            short(slope.median)
        ));
    }
}

fn counted(count: Count) -> String {
    format!("{} of {} ({:.0} %)", count.inside, count.of, 100.0 * count.share())
}

/// Two or three figures.
fn short(value: f64) -> String {
    let decimals = if value.abs() < 9.95 { 2 } else { usize::from(value.abs() < 99.5) };
    format!("{value:.decimals$}")
}

/// Decay times at the first and the last speed and of recordings, by octave.
fn decays(report: &Report, name: &str) -> Vec<Curve> {
    let in_mix = |piece: &&PieceReport| piece.piece == name && piece.heard == RecordingChain::Mix;
    let Some(piece) = report.pieces.iter().find(in_mix) else { return Vec::new() };
    let octaves = [125.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
    let row = |hz: f64| piece.features.iter().find(|row| row.feature == format!("t60_{hz}_hz_s"));
    let line = |name: &str, value: &dyn Fn(&realism::Row) -> Option<f64>| {
        let points = octaves.iter().filter_map(|&hz| Some((hz, value(row(hz)?)?)));
        (name.to_owned(), points.collect())
    };
    vec![
        line("recordings", &|row| Some(row.median)),
        line("here, soft", &|row| row.values.first().copied().flatten()),
        line("here, hard", &|row| row.values.last().copied().flatten()),
    ]
}
