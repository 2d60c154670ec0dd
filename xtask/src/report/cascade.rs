//! The cascade: how a crash's energy climbs from the modes a stroke excites to those above.
//!
//! Each tier is struck softly, at medium speed and hard; along the way the mean frequency of the modes to
//! 2 kHz is taken, weighted by their energy, for that is the set every tier from `standard` on couples; and
//! of the sound, when the band above 3 kHz is strongest, also of the crash with the bell it has in the kit.

use std::f64::consts::TAU;

use anyhow::Result;
use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::Strike;

use super::page::sources::{EARLIER, MEASURED};
use super::plot::{Axis, Line, Plot};
use super::{Claim, Page, Sheet};
use crate::analysis::envelope;
use crate::analysis::one_shot::OneShot;
use crate::bad_input;
use crate::hear;
use crate::progress::Progress;

/// Sample rate, Hz.
const RATE: f64 = 44_100.0;

/// Speeds of the strokes, m/s.
const SPEEDS: [f64; 3] = [0.3, 1.5, 5.0];

/// Where the mean frequency is taken in the table, s after the stroke.
const TIMES: [f64; 6] = [0.003, 0.030, 0.080, 0.250, 0.500, 1.0];

/// Shapes, tiers, places and speeds at which the bloom is sought: a cap, and with a bell.
const SHAPED: [bool; 2] = [false, true];
const BLOOMING: [Quality; 2] = [Quality::High, Quality::Offline];
const PLACES: [f64; 4] = [0.85, 0.92, 0.97, 1.0];
const HARD: [f64; 4] = [1.5, 5.0, 6.0, 8.0];

/// Time between two points of a line, s.
const STEP: f64 = 0.01;

/// Highest mode counted, Hz.
const COUNTED: f64 = 2000.0;

/// Modes of the stand come first and are not counted.
const RIGID: usize = 3;

/// What one stroke does.
struct Course {
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
/// If the crash cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let linear = BuildOptions { linear: true, ..BuildOptions::new(RATE) };
    let mut tiers = vec![("linear", linear)];
    tiers.extend(
        Quality::ALL.map(|quality| (quality.name(), BuildOptions { quality, ..BuildOptions::new(RATE) })),
    );
    let steps = tiers.len() * SPEEDS.len() + SHAPED.len() * BLOOMING.len() * PLACES.len();
    let mut progress = Progress::new("cascade", steps as u64);
    let mut courses = Vec::new();
    for (tier, options) in tiers {
        let mut piece = Piece::new(PieceId::Crash, &options).map_err(|error| bad_input!("{error}"))?;
        for speed in SPEEDS {
            courses.push(follow(&mut piece, tier, speed));
            progress.advance(1);
        }
    }
    let blooms = blooms(&mut progress)?;
    let mut sheet = Sheet::new("cascade", "The cascade", ABOUT);
    claims(&mut sheet, &courses, &blooms);
    sheet.plot(
        "mean",
        "Mean frequency against time",
        &Plot {
            across: Axis::linear("s after the stroke", 0.0..1.0),
            up: Axis::linear("mean frequency, Hz", 200.0..900.0),
            panels: SPEEDS.map(|speed| (format!("{speed} m/s"), lines(&courses, speed))).to_vec(),
        },
    )?;
    tables(&mut sheet, &courses, &blooms);
    Ok(sheet.finish())
}

const ABOUT: &str = "A 16 in crash, a cap as thick everywhere if nothing else is said, struck where it is played, with a stick's shoulder near its edge: mean frequency of its modes to 2 kHz,\n\
     weighted by their energy, and when the sound above 3 kHz is strongest. A linear plate only fades; coupled by its\n\
     stretching, a hard stroke climbs. `tests/tests/cymbals.rs` holds it.";

/// When the band above 3 kHz is strongest, ms, at each of the speeds [`HARD`].
struct Bloom {
    shaped: bool,
    quality: Quality,
    radius: f64,
    peaks_ms: [f64; HARD.len()],
}

/// Strikes the crash all along its edge.
fn blooms(progress: &mut Progress) -> Result<Vec<Bloom>> {
    let mut out = Vec::new();
    for (shaped, quality) in SHAPED.into_iter().flat_map(|shaped| BLOOMING.map(|quality| (shaped, quality))) {
        let options = BuildOptions { shaped, quality, ..BuildOptions::new(RATE) };
        let mut piece = Piece::new(PieceId::Crash, &options).map_err(|error| bad_input!("{error}"))?;
        for radius in PLACES {
            let peaks_ms = HARD.map(|speed| {
                piece.reset();
                piece.strike(&Strike { speed, radius, ..hear::default_strike(PieceId::Crash) });
                let mut sound = vec![0.0; RATE as usize];
                piece.render(&mut sound);
                bloom_ms(&sound)
            });
            out.push(Bloom { shaped, quality, radius, peaks_ms });
            progress.advance(1);
        }
    }
    Ok(out)
}

/// What a shape is called.
fn shape(shaped: bool) -> &'static str {
    if shaped { "with the kit's bell" } else { "cap" }
}

fn bloom_ms(sound: &[f32]) -> f64 {
    OneShot::new(sound, RATE).and_then(|shot| envelope::bloom_ms(&shot)).unwrap_or(f64::NAN)
}

fn lines(courses: &[Course], speed: f64) -> Vec<Line> {
    let of_speed = courses.iter().filter(|course| course.speed == speed);
    of_speed.map(|course| (course.tier.to_owned(), course.line.clone())).collect()
}

/// Strikes a crash where it is played and follows it for a second.
fn follow(piece: &mut Piece, tier: &'static str, speed: f64) -> Course {
    piece.reset();
    piece.strike(&Strike { speed, ..hear::default_strike(PieceId::Crash) });
    let end = TIMES[TIMES.len() - 1];
    let mut stops: Vec<f64> = (1..=(end / STEP).round() as usize).map(|i| i as f64 * STEP).collect();
    stops.extend(TIMES);
    stops.sort_by(f64::total_cmp);
    stops.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let (mut sound, mut line, mut at_times) = (Vec::new(), Vec::new(), Vec::new());
    for stop in stops {
        let samples = (stop * RATE).round() as usize;
        let mut part = vec![0.0; samples.saturating_sub(sound.len())];
        piece.render(&mut part);
        sound.extend(part);
        let mean = mean_frequency(piece);
        line.push((stop, mean));
        if TIMES.iter().any(|time| (time - stop).abs() < 1e-9) {
            at_times.push(mean);
        }
    }
    Course { tier, speed, at_times, line, bloom_ms: bloom_ms(&sound) }
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

/// What a hard stroke has to do, and a soft or a linear one must not.
fn claims(sheet: &mut Sheet, courses: &[Course], blooms: &[Bloom]) {
    let course = |tier: &str, speed: f64| {
        let found = courses.iter().find(|course| course.tier == tier && course.speed == speed);
        found.map_or(&[][..], |course| &course.at_times)
    };
    let hz = |course: &[f64]| course.iter().map(|hz| format!("{hz:.0}")).collect::<Vec<_>>().join(" ");
    let linear = course("linear", 5.0);
    sheet.claim(Claim {
        what: "linear, 5 m/s, at 3, 30, 80, 250, 500 ms, 1 s".to_owned(),
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
            figure: format!("{} Hz, climbs {climb:.0} % within 100 ms", hz(hard)),
            reference: "571 646 714 702 614 435 Hz; 10 % or more".to_owned(),
            source: EARLIER,
            met: Some(climb > 10.0),
        });
        let apart =
            soft.iter().zip(course("linear", 0.3)).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        sheet.claim(Claim {
            what: format!("{tier}, 0.3 m/s against linear"),
            figure: format!("{:.1} % apart at most", 100.0 * apart),
            reference: "6 %".to_owned(),
            source: EARLIER,
            met: Some(apart < 0.06),
        });
    }
    // Where the MIDI map has the crash played.
    for Bloom { shaped, quality, peaks_ms, .. } in blooms.iter().filter(|bloom| bloom.radius == 0.97) {
        let [soft, hard, harder, _] = peaks_ms;
        sheet.claim(Claim {
            what: format!(
                "{}, {}, at .97: sound above 3 kHz strongest, at 1.5, 5, 6 m/s",
                quality.name(),
                shape(*shaped)
            ),
            figure: format!("{soft:.0}, {hard:.0}, {harder:.0} ms"),
            reference: "at once when soft, after more than 30 ms when hard (recordings 83 ms)".to_owned(),
            source: MEASURED,
            met: Some(*soft < 15.0 && *hard > 30.0 && *harder > 30.0),
        });
    }
}

fn tables(sheet: &mut Sheet, courses: &[Course], blooms: &[Bloom]) {
    sheet.table(
        &["tier", "m/s", "3 ms", "30 ms", "80 ms", "250 ms", "500 ms", "1 s", "above 3 kHz, ms"],
        courses.iter().map(|Course { tier, speed, at_times, bloom_ms, .. }| {
            let times = at_times.iter().map(|hz| format!("{hz:.0}"));
            let first = [(*tier).to_owned(), format!("{speed}")];
            first.into_iter().chain(times).chain([format!("{bloom_ms:.0}")]).collect()
        }),
    );
    sheet.text(
        "The stretching hands energy upward from mode to mode. Where the coupled set ends it cannot go on and gathers:\n\
         `standard`, whose set ends where the modes counted here do, stays highest for that reason. From `high` on it leaves\n\
         them for those above.",
    );
    sheet.heading("When the sound above 3 kHz is strongest, ms");
    sheet.text(
        "Sound there is pumped only by modes that are coupled: `eco` and `standard` end below, and what is heard of them above\n\
         3 kHz is the stroke itself, at once. Where the stroke and what is pumped are equally strong the later one may come\n\
         second: that depends on the place.",
    );
    let speeds = HARD.map(|speed| format!("{speed} m/s"));
    let head =
        ["tier", "shape", "at"].into_iter().chain(speeds.iter().map(String::as_str)).collect::<Vec<_>>();
    sheet.table(
        &head,
        blooms.iter().map(|Bloom { shaped, quality, radius, peaks_ms }| {
            let peaks = peaks_ms.iter().map(|ms| format!("{ms:.0}"));
            let first = [quality.name().to_owned(), shape(*shaped).to_owned(), format!("{radius}")];
            first.into_iter().chain(peaks).collect()
        }),
    );
}
