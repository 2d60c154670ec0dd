//! Pitch glide: a struck head stretches, and falls back to its pitch as it comes to rest.

use crate::{alone, altered, cents, reference, spec, stroke};
use anyhow::Result;
use overhear_engine::drum::DrumSpec;
use overhear_engine::kit::Control;
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::BuildOptions;
use overhear_engine::strike::Striker;

use super::page::bodies::{FIXED_DISC, PLAYED};
use super::page::sources::{EARLIER, EXACT};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};
use crate::analysis::glide::{frequency, strongest_mode};
use crate::hear::{self, ALONE, Measurement, Request, Sound};
use crate::settings::PieceSetting;

const RATE: f64 = 44_100.0;

/// Speeds of the strokes, m/s, and those whose course over time is drawn.
const SPEEDS: [f64; 7] = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
const DRAWN: [f64; 3] = [1.0, 3.0, 6.0];

/// How far drums are let down, a share of their own pitch: the 82 Hz of the published one to 65.
const SLACK: f64 = 65.0 / 82.0;

/// The page.
///
/// # Errors
/// If a drum cannot be built or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "glide",
        "Pitch glide",
        PLAYED,
        "Floor toms struck at half their radius: how much higher the strongest partial is from 5 to 85 ms than from 400 to 480 ms,\n\
         measured on the motion of that mode. The floor tom of the standard kit has two heads. Published glides are those of a drum of 82 Hz\n\
         without its lower head and with a contact disc of fixed size. `hear floor-tom --at 0.5` gives the figures of the\n\
         first; `tests/tests/drums.rs` holds them.",
    );
    let (published, played) = (Glides::of(&one_headed())?, Glides::of(&spec("floor-tom"))?);
    for (speed, cents) in [(3.0, 25.0), (6.0, 91.0)] {
        let what = format!("one head, 82 Hz, at {speed} m/s");
        let got = (published.at(speed), "cents");
        sheet.claim(Claim::near(&what, FIXED_DISC, got, (cents, 0.25), EARLIER));
    }
    // The stretch grows as the square of the stroke: 25 cents at 3 m/s are 0.7 at 0.5.
    let soft = published.at(0.5);
    sheet.claim(Claim {
        what: "one head, 82 Hz, at 0.5 m/s".to_owned(),
        on: FIXED_DISC,
        figure: format!("{soft:.2} cents"),
        reference: "0.4 published; the square of the stroke gives 0.7: 0.3 to 1.1".to_owned(),
        source: EARLIER,
        met: Some((0.3..1.1).contains(&soft)),
    });
    let [soft, firm, hard] = [0.5, 3.0, 6.0].map(|speed| played.at(speed));
    let by_square = |firm: f64| firm * (0.5_f64 / 3.0).powi(2);
    sheet.claim(Claim {
        what: "two heads, at 0.5, 3 and 6 m/s".to_owned(),
        on: PLAYED,
        figure: format!("{soft:.2}, {firm:.1}, {hard:.1} cents"),
        reference: format!(
            "as the square of the stroke: {:.2} for the soft one within half; more for each harder one",
            by_square(firm)
        ),
        source: EXACT,
        met: Some((soft / by_square(firm) - 1.0).abs() < 0.5 && soft < firm && firm < hard),
    });
    for (on, heads, glides) in [(FIXED_DISC, "one head", &published), (PLAYED, "two heads", &played)] {
        glides.claims(&mut sheet, on, heads);
    }
    plot(&mut sheet, [&published, &played])?;
    sheet.table(
        &["m/s", "two heads, cents", "one head, 82 Hz, cents"],
        SPEEDS.map(|speed| {
            let [two, one] = [&played, &published].map(|glides| format!("{:.1}", glides.at(speed)));
            vec![format!("{speed}"), two, one]
        }),
    );
    Ok(sheet.finish())
}

/// The floor tom of published glides: 82 Hz, no lower head, a fixed disc under the stick.
pub fn one_headed() -> PieceSpec {
    altered(reference::fixed_disc_floor_tom(), DrumSpec::opened)
}

/// Pitch glide of a drum.
struct Glides {
    /// Its own pitch, Hz.
    pitch: f64,
    /// Speeds of strokes, m/s, and the glides of each, cents.
    by_speed: Vec<(f64, f64)>,
    /// At 4 m/s, let down by [`SLACK`], cents.
    slack: f64,
    /// At 4 m/s, without stretch, cents.
    linear: f64,
    /// The strongest partial over time after strokes of [`DRAWN`] speeds.
    courses: Vec<Curve>,
}

impl Glides {
    fn of(drum: &PieceSpec) -> Result<Glides> {
        let pitch = drum.instrument.tunings()[1];
        let (mut by_speed, mut courses) = (Vec::new(), Vec::new());
        for speed in SPEEDS {
            let request = request(drum.clone(), speed, pitch);
            let sound = hear::render(&request)?;
            by_speed.push((speed, Measurement::new(&request, &sound).glide_cents.unwrap_or(f64::NAN)));
            if DRAWN.contains(&speed) {
                courses.push((format!("{speed} m/s"), course(&sound)));
            }
        }
        let glide = |drum: PieceSpec, pitch: f64| -> Result<f64> {
            Ok(hear::run(&request(drum, 4.0, pitch))?.glide_cents.unwrap_or(f64::NAN))
        };
        let (slack, linear) = (glide(drum.clone(), SLACK * pitch)?, glide(drum.clone().linear(), pitch)?);
        Ok(Glides { pitch, by_speed, slack, linear, courses })
    }

    /// Of a stroke of one of [`SPEEDS`], cents.
    fn at(&self, speed: f64) -> f64 {
        self.by_speed.iter().find(|(other, _)| *other == speed).map_or(f64::NAN, |(_, cents)| *cents)
    }

    /// Claims for every drum.
    fn claims(&self, sheet: &mut Sheet, on: &'static str, heads: &str) {
        let (pitch, own) = (self.pitch, self.at(4.0));
        sheet.claim(Claim {
            what: format!("{heads}, at 4 m/s, let down to {:.0} Hz", SLACK * pitch),
            on,
            figure: format!("{:.1} cents", self.slack),
            reference: format!("more than the {own:.1} cents at {pitch} Hz"),
            source: EARLIER,
            met: Some(self.slack > own),
        });
        sheet.claim(Claim {
            what: format!("{heads}, at 4 m/s, without stretch (`--linear`)"),
            on,
            figure: format!("{:.3} cents", self.linear),
            reference: "0.05 cents: what the method itself sees".to_owned(),
            source: "analysis/glide.rs",
            met: Some(self.linear.abs() < 0.05),
        });
    }
}

/// The courses of both drums.
fn plot(sheet: &mut Sheet, [published, played]: [&Glides; 2]) -> Result<()> {
    let lines = || played.courses.iter().chain(&published.courses);
    let most = lines().flat_map(|(_, points)| points).map(|point| point.1).fold(1.0, f64::max);
    let panels = [
        ("standard kit, two heads".to_owned(), played.courses.clone()),
        ("fixed disc, one head, 82 Hz".to_owned(), published.courses.clone()),
    ];
    sheet.plot(
        "time",
        "The strongest partial over time, above where it ends: the standard kit's floor tom, and one with one head",
        &Plot {
            across: Axis::linear("s after the stroke", 0.0..0.5),
            up: Axis::linear("cents", -5.0..1.1 * most),
            panels: panels.into(),
        },
    )
}

fn request(drum: PieceSpec, speed: f64, pitch: f64) -> Request {
    let own = drum.instrument.tunings()[1];
    let tuned = PieceSetting { control: Control::Tuning(ALONE), value: pitch };
    Request {
        kit: alone(&drum),
        strike: stroke(Striker::Stick, speed, 0.5, 0.0),
        settings: if pitch == own { Vec::new() } else { vec![tuned] },
        options: BuildOptions::new(RATE),
        seconds: 1.0,
    }
}

/// Cents above the end, every 5 ms over windows of 40.
fn course(sound: &Sound) -> Points {
    let motion = &sound.motion;
    let Some(mode) = strongest_mode(motion) else { return Vec::new() };
    let samples = |seconds: f64| (seconds * motion.rate) as usize;
    let at = |start: f64| frequency(mode.get(samples(start)..samples(start + 0.04))?, motion.rate);
    let Some(end) = at(0.46) else { return Vec::new() };
    let free = f64::from(sound.contact.contact_time).max(0.005);
    let starts = (0..100).map(|i| 0.005 * f64::from(i)).filter(|start| *start >= free);
    starts.filter_map(|start| Some((start + 0.02, cents(at(start)?, end)))).collect()
}

/// Points of a line.
type Points = Vec<(f64, f64)>;
