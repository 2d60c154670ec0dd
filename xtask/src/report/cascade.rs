//! The cascade: how a crash's energy climbs from the modes a stroke excites to those above.
//!
//! Each tier is struck softly, at medium speed and hard; along the way the mean frequency of the modes to
//! 2 kHz is taken, weighted by their energy, for that is the set every tier from `standard` on couples; and
//! of the sound, when the band above 3 kHz is strongest.

use std::f64::consts::TAU;
use std::fmt::Write;

use anyhow::Result;
use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::Strike;

use super::Page;
use super::plot::{Line, Plot};
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
    let steps = tiers.len() * SPEEDS.len() + BLOOMING.len() * PLACES.len();
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
    let plot = Plot {
        across: "s after the stroke",
        up: "mean frequency, Hz",
        range: 200.0..900.0,
        panels: SPEEDS.map(|speed| (format!("{speed} m/s"), lines(&courses, speed))).to_vec(),
    };
    Ok(Page {
        markdown: markdown(&courses, &blooms),
        pictures: vec![("cascade.png".to_owned(), plot.png()?)],
    })
}

/// When the band above 3 kHz is strongest, ms, at each of the speeds [`HARD`].
struct Bloom {
    quality: Quality,
    radius: f64,
    peaks_ms: [f64; HARD.len()],
}

/// Strikes the crash all along its edge.
fn blooms(progress: &mut Progress) -> Result<Vec<Bloom>> {
    let mut out = Vec::new();
    for quality in BLOOMING {
        let options = BuildOptions { quality, ..BuildOptions::new(RATE) };
        let mut piece = Piece::new(PieceId::Crash, &options).map_err(|error| bad_input!("{error}"))?;
        for radius in PLACES {
            let peaks_ms = HARD.map(|speed| {
                piece.reset();
                piece.strike(&Strike { speed, radius, ..hear::default_strike(PieceId::Crash) });
                let mut sound = vec![0.0; RATE as usize];
                piece.render(&mut sound);
                bloom_ms(&sound)
            });
            out.push(Bloom { quality, radius, peaks_ms });
            progress.advance(1);
        }
    }
    Ok(out)
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

fn markdown(courses: &[Course], blooms: &[Bloom]) -> String {
    let mut out = String::from(
        "# The cascade\n\n\
         A 16 in crash struck where it is played, with a stick's shoulder near its edge: mean frequency of its modes to 2 kHz,\n\
         weighted by their energy, and when the sound above 3 kHz is strongest. A linear plate only fades; coupled by its\n\
         stretching, a hard stroke climbs. `cargo xtask report cascade` writes this page.\n\n\
         ![Mean frequency against time](cascade.png)\n\n\
         | tier | m/s | 3 ms | 30 ms | 80 ms | 250 ms | 500 ms | 1 s | above 3 kHz, ms |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for Course { tier, speed, at_times, bloom_ms, .. } in courses {
        let _ = write!(out, "| {tier} | {speed} ");
        for hz in at_times {
            let _ = write!(out, "| {hz:.0} ");
        }
        let _ = writeln!(out, "| {bloom_ms:.0} |");
    }
    out.push_str(
        "\nThe stretching hands energy upward from mode to mode. Where the coupled set ends it cannot go on and gathers:\n\
         `standard`, whose set ends where the modes counted here do, stays highest for that reason. From `high` on it leaves\n\
         them for those above.\n\n\
         ## When the sound above 3 kHz is strongest, ms\n\n\
         Sound there is pumped only by modes that are coupled: `eco` and `standard` end below, and what is heard of them above\n\
         3 kHz is the stroke itself, at once. Where the stroke and what is pumped are equally strong the later one may come\n\
         second: at 5 m/s that depends on the place.\n\n\
         | tier | at |",
    );
    for speed in HARD {
        let _ = write!(out, " {speed} m/s |");
    }
    out.push_str("\n|---|---|");
    out.push_str(&"---|".repeat(HARD.len()));
    for Bloom { quality, radius, peaks_ms } in blooms {
        let _ = write!(out, "\n| {} | {radius} |", quality.name());
        for ms in peaks_ms {
            let _ = write!(out, " {ms:.0} |");
        }
    }
    out.push('\n');
    out
}
