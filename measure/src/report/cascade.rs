//! The cascade: energy of a crash moves from the modes that a stroke excites to higher ones.
//!
//! The crash of the standard kit and a cap are struck softly, at medium speed and hard, at each tier; along the way the mean
//! frequency of the modes to 2 kHz is taken, weighted by their energy, for that is the set every tier from `standard`
//! on couples; and of the sound, when the band above 3 kHz is strongest.

use std::f64::consts::TAU;

use crate::{build, reference, render, render_into, slot, spec};
use anyhow::Result;
use overhear::kit_document::KitDocument;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::strike::Strike;

use super::page::bodies::{CAP, PLAYED};
use super::page::sources::{EARLIER, MEASURED};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};
use crate::analysis::envelope;
use crate::analysis::one_shot::OneShot;
use crate::hear;

/// Sample rate, Hz.
const RATE: f64 = 44_100.0;

/// Speeds of the strokes, m/s.
const SPEEDS: [f64; 3] = [0.3, 1.5, 5.0];

/// Where the mean frequency is taken in the table, s after the stroke.
const TIMES: [f64; 6] = [0.003, 0.030, 0.080, 0.250, 0.500, 1.0];

/// Tiers, places and speeds at which the bloom is sought.
const BLOOMING: [Quality; 2] = [Quality::High, Quality::Offline];
const PLACES: [f64; 4] = [0.85, 0.92, 0.97, 1.0];
const HARD: [f64; 4] = [1.5, 5.0, 6.0, 8.0];

/// Time between two points of a line, s.
const STEP: f64 = 0.01;

/// Highest mode counted, Hz.
const COUNTED: f64 = 2000.0;

/// Modes of the stand come first and are not counted.
const RIGID: usize = 3;

/// Measurements of one stroke.
struct Course {
    on: &'static str,
    tier: &'static str,
    speed: f64,
    /// Mean frequency at [`TIMES`], Hz.
    at_times: Vec<f64>,
    /// The same along the way: s, Hz.
    line: Vec<(f64, f64)>,
    /// When the band above 3 kHz is strongest, ms.
    bloom_ms: f64,
}

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let bodies = [(spec("crash"), PLAYED), (reference::cap_crash(), CAP)];
    let (mut courses, mut blooms) = (Vec::new(), Vec::new());
    for (crash, on) in &bodies {
        courses.extend(self::courses(crash, on));
        blooms.extend(self::blooms(crash, on));
    }
    let mut sheet = Sheet::new("cascade", "The cascade", PLAYED, ABOUT);
    claims(&mut sheet, &courses, &blooms);
    sheet.plot(
        "mean",
        "Mean frequency of the standard kit's crash against time",
        &Plot {
            across: Axis::linear("s after the stroke", 0.0..1.0),
            up: Axis::linear("mean frequency, Hz", 200.0..1000.0),
            panels: SPEEDS.map(|speed| (format!("{speed} m/s"), lines(&courses, speed))).to_vec(),
        },
    )?;
    tables(&mut sheet, &courses, &blooms);
    Ok(sheet.finish())
}

const ABOUT: &str = "The 16 in crash of the standard kit, and the same crash as a cap of uniform thickness, for which mean frequencies were published.\n\
     Both are struck with a stick's shoulder near the edge, as by the ordinary note. The page shows the mean frequency of the modes to 2 kHz,\n\
     weighted by energy, and the time of the strongest sound above 3 kHz. The mean frequency of a linear plate only falls. When stretching\n\
     couples the modes, that of a hard stroke rises. `tests/tests/cymbals.rs` holds it.";

/// The stroke of the crash's ordinary note.
fn ordinary() -> Strike {
    hear::default_strike(&KitDocument::standard(), slot("crash"))
}

/// When the band above 3 kHz is strongest, ms, at each of the speeds [`HARD`].
struct Bloom {
    on: &'static str,
    quality: Quality,
    radius: f64,
    peaks_ms: [f64; HARD.len()],
}

/// Strikes a crash without stretching and at every tier, softly to hard.
fn courses(crash: &PieceSpec, on: &'static str) -> Vec<Course> {
    let mut tiers = vec![("linear", crash.clone().linear(), Quality::Standard)];
    tiers.extend(Quality::ALL.map(|quality| (quality.name(), crash.clone(), quality)));
    let mut courses = Vec::new();
    for (tier, crash, quality) in tiers {
        let mut piece = build(&crash, &BuildOptions { quality, ..BuildOptions::new(RATE) });
        for speed in SPEEDS {
            courses.push(follow(&mut piece, (on, tier), speed));
        }
    }
    courses
}

/// Strikes a crash all along its edge.
fn blooms(crash: &PieceSpec, on: &'static str) -> Vec<Bloom> {
    let mut blooms = Vec::new();
    for quality in BLOOMING {
        let mut piece = build(crash, &BuildOptions { quality, ..BuildOptions::new(RATE) });
        for radius in PLACES {
            let peaks_ms = HARD.map(|speed| {
                piece.reset();
                piece.strike(&Strike { speed, radius, ..ordinary() });
                bloom_ms(&render(&mut piece, 1.0, RATE))
            });
            blooms.push(Bloom { on, quality, radius, peaks_ms });
        }
    }
    blooms
}

fn bloom_ms(sound: &[f32]) -> f64 {
    OneShot::new(sound, RATE).and_then(|shot| envelope::bloom_ms(&shot)).unwrap_or(f64::NAN)
}

fn lines(courses: &[Course], speed: f64) -> Vec<Curve> {
    let of_speed = courses.iter().filter(|course| course.on == PLAYED && course.speed == speed);
    of_speed.map(|course| (course.tier.to_owned(), course.line.clone())).collect()
}

/// Strikes a crash as its ordinary note does and follows it for a second.
fn follow(piece: &mut Piece, (on, tier): (&'static str, &'static str), speed: f64) -> Course {
    piece.reset();
    piece.strike(&Strike { speed, ..ordinary() });
    let end = TIMES[TIMES.len() - 1];
    let mut stops: Vec<f64> = (1..=(end / STEP).round() as usize).map(|i| i as f64 * STEP).collect();
    stops.extend(TIMES);
    stops.sort_by(f64::total_cmp);
    stops.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let (mut sound, mut line, mut at_times) = (Vec::new(), Vec::new(), Vec::new());
    for stop in stops {
        let samples = (stop * RATE).round() as usize;
        let mut part = vec![0.0; samples.saturating_sub(sound.len())];
        render_into(piece, &mut part);
        sound.extend(part);
        let mean = mean_frequency(piece);
        line.push((stop, mean));
        if TIMES.iter().any(|time| (time - stop).abs() < 1e-9) {
            at_times.push(mean);
        }
    }
    Course { on, tier, speed, at_times, line, bloom_ms: bloom_ms(&sound) }
}

/// Mean frequency of the modes to [`COUNTED`], weighted by their energy, Hz.
fn mean_frequency(piece: &mut Piece) -> f64 {
    let body = piece.surface_mut().body();
    let (mut sum, mut weighted) = (0.0, 0.0);
    for (k, mode) in
        body.modes().iter().enumerate().skip(RIGID).filter(|(_, mode)| mode.omega < TAU * COUNTED)
    {
        let q = f64::from(body.displacement(k));
        let energy = 0.5 * mode.mass * (body.velocity(k).powi(2) + (mode.omega * q).powi(2));
        sum += energy;
        weighted += energy * mode.omega / TAU;
    }
    weighted / sum
}

/// Requirements for hard strokes, and for soft and linear ones.
fn claims(sheet: &mut Sheet, courses: &[Course], blooms: &[Bloom]) {
    for on in [PLAYED, CAP] {
        let of_body: Vec<&Course> = courses.iter().filter(|course| course.on == on).collect();
        climbs(sheet, on, &of_body);
    }
    // Where the crash's ordinary note strikes it.
    let radius = ordinary().radius;
    for Bloom { on, quality, peaks_ms, .. } in blooms.iter().filter(|bloom| bloom.radius == radius) {
        let [soft, hard, harder, _] = peaks_ms;
        sheet.claim(Claim {
            what: format!("{}, at {radius}: sound above 3 kHz strongest, at 1.5, 5, 6 m/s", quality.name()),
            on,
            figure: format!("{soft:.0}, {hard:.0}, {harder:.0} ms"),
            reference: "immediately for soft strokes, after more than 30 ms for hard ones (recordings 83 ms)"
                .to_owned(),
            source: MEASURED,
            met: Some(*soft < 15.0 && *hard > 30.0 && *harder > 30.0),
        });
    }
}

/// How the mean frequency of one crash moves.
fn climbs(sheet: &mut Sheet, on: &'static str, courses: &[&Course]) {
    let course = |tier: &str, speed: f64| {
        let found = courses.iter().find(|course| course.tier == tier && course.speed == speed);
        found.map_or(&[][..], |course| &course.at_times)
    };
    let hz = |course: &[f64]| course.iter().map(|hz| format!("{hz:.0}")).collect::<Vec<_>>().join(" ");
    let linear = course("linear", 5.0);
    sheet.claim(Claim {
        what: "linear, 5 m/s, at 3, 30, 80, 250, 500 ms, 1 s".to_owned(),
        on,
        figure: format!("{} Hz", hz(linear)),
        reference: "only falls once the stick has left".to_owned(),
        source: EARLIER,
        met: Some(linear[1] < 1.02 * linear[0] && linear[1..].windows(2).all(|pair| pair[1] < pair[0])),
    });
    for tier in Quality::ALL.map(Quality::name) {
        let (hard, soft) = (course(tier, 5.0), course(tier, 0.3));
        let climb = 100.0 * (hard[1].max(hard[2]) / hard[0] - 1.0);
        sheet.claim(Claim {
            what: format!("{tier}, 5 m/s, the same times"),
            on,
            figure: format!("{} Hz, climbs {climb:.0} % within 100 ms", hz(hard)),
            reference: "571 646 714 702 614 435 Hz of a cap; 10 % or more".to_owned(),
            source: EARLIER,
            met: Some(climb > 10.0),
        });
        let apart =
            soft.iter().zip(course("linear", 0.3)).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        sheet.claim(Claim {
            what: format!("{tier}, 0.3 m/s against linear"),
            on,
            figure: format!("{:.1} % apart at most", 100.0 * apart),
            reference: "6 %".to_owned(),
            source: EARLIER,
            met: Some(apart < 0.06),
        });
    }
}

fn tables(sheet: &mut Sheet, courses: &[Course], blooms: &[Bloom]) {
    sheet.table(
        &[
            "measured on",
            "tier",
            "m/s",
            "3 ms",
            "30 ms",
            "80 ms",
            "250 ms",
            "500 ms",
            "1 s",
            "above 3 kHz, ms",
        ],
        courses.iter().map(|Course { on, tier, speed, at_times, bloom_ms, .. }| {
            let times = at_times.iter().map(|hz| format!("{hz:.0}"));
            let first = [(*on).to_owned(), (*tier).to_owned(), format!("{speed}")];
            first.into_iter().chain(times).chain([format!("{bloom_ms:.0}")]).collect()
        }),
    );
    sheet.text(
        "The stretching passes energy upward from mode to mode. At the end of the coupled set the energy accumulates. The set of\n\
         `standard` ends where the modes counted here end, so its mean frequency stays highest. At `high` and `offline` the energy\n\
         moves on to modes above.",
    );
    sheet.heading("Time of the strongest sound above 3 kHz, ms");
    sheet.text(
        "Only coupled modes receive energy from others. The sets of `eco` and `standard` end below 3 kHz, so their sound above\n\
         3 kHz is that of the stroke itself, without delay. Where the stroke and the cascade are equally strong, the strike position\n\
         decides which of them is the maximum.",
    );
    let speeds = HARD.map(|speed| format!("{speed} m/s"));
    let head = ["measured on", "tier", "at"]
        .into_iter()
        .chain(speeds.iter().map(String::as_str))
        .collect::<Vec<_>>();
    sheet.table(
        &head,
        blooms.iter().map(|Bloom { on, quality, radius, peaks_ms }| {
            let peaks = peaks_ms.iter().map(|ms| format!("{ms:.0}"));
            let first = [(*on).to_owned(), quality.name().to_owned(), format!("{radius}")];
            first.into_iter().chain(peaks).collect()
        }),
    );
}
