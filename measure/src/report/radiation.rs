//! Radiation: air load of vibrating discs, and their sound near and far.

use std::f64::consts::PI;

use crate::{round_piece, spec};
use anyhow::Result;
use overhear_engine::air_load::{DENSITY, SPEED_OF_SOUND};
use overhear_engine::plate::free_disc::{FreeDisc, Radiated};
use overhear_engine::radiation::Radiator;
use overhear_engine::receiver::{POINTS, ReceiverPosition};

use super::heads::mode_of;
use super::page::bodies::{EQUATION, ROUND};
use super::page::sources::{EXACT, GOAL, MEASURED};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};

pub mod microphones;

use microphones::{CLOSE, Farther, OVERHEADS, ROOM};

const RATE: f64 = 44_100.0;

/// A rate at which ways of a broken number of samples hardly matter, Hz.
const FINE_RATE: f64 = 96_000.0;

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "radiation",
        "Radiation and microphones",
        ROUND,
        "Closed forms of a rigid disc in free air; radiation losses of drums; sound at the microphones. The drums are those of the\n\
         standard kit; where single modes are distinguished, without mode splitting.\n\
         `engine/src/plate/free_disc.rs`, `engine/src/radiation/tests.rs`, `tests/tests/damping.rs` and `tests/tests/microphones.rs`\n\
         hold these figures.",
    );
    rigid_disc(&mut sheet);
    toms(&mut sheet);
    distances(&mut sheet);
    near_fields(&mut sheet);
    sheet.plot(
        "drums",
        "Area of the point source that would radiate as much as each mode of the struck head does",
        &Plot {
            across: Axis::log("Hz", 50.0..3000.0),
            up: Axis::log("m²", 1e-4..1.0),
            panels: ["rack-tom", "timpani"].map(|name| (name.to_owned(), areas(name))).into(),
        },
    )?;
    Ok(sheet.finish())
}

/// Radius of the rigid disc, m.
const RADIUS: f64 = 0.2;

/// A rigid disc in free air, its circumference so many waves.
fn rigid(waves: f64) -> Radiated {
    let point = ReceiverPosition { distance: 1.0, inclination: 0.3, azimuth: 0.0 };
    let disc = FreeDisc::new(RADIUS, [point; POINTS], 48);
    let radial = vec![1.0; 48];
    disc.radiate(&Radiator { m: 0, radial: &radial, omega: waves * SPEED_OF_SOUND / RADIUS }, 0.0)
}

fn rigid_disc(sheet: &mut Sheet) {
    let (slow, fast) = (rigid(0.05), rigid(30.0));
    let moment = 8.0 / 3.0 * DENSITY * RADIUS.powi(3);
    sheet.claim(Claim::near(
        "rigid disc, slow: added mass of air over (8/3) rho a³",
        EQUATION,
        (slow.air_mass / moment, ""),
        (1.0, 0.01),
        "Lamb, Hydrodynamics, 102",
    ));
    let dipole = moment * moment * (0.05 / RADIUS).powi(4) * SPEED_OF_SOUND / (12.0 * PI * DENSITY);
    sheet.claim(Claim::near(
        "its resistance over that of the dipole of the same moment",
        EQUATION,
        (slow.resistance / dipole, ""),
        (1.0, 0.02),
        EXACT,
    ));
    let plane = 2.0 * DENSITY * SPEED_OF_SOUND * PI * RADIUS * RADIUS;
    sheet.claim(Claim::near(
        "rigid disc, fast: resistance over that of plane waves from both faces",
        EQUATION,
        (fast.resistance / plane, ""),
        (1.0, 0.03),
        EXACT,
    ));
}

fn toms(sheet: &mut Sheet) {
    for name in ["rack-tom", "floor-tom"] {
        let piece = round_piece(name, RATE);
        let together = mode_of(&piece, 0, 1);
        // The lowest round mode that is mostly the other head's.
        let modes = piece.modes().into_iter().filter(|mode| mode.body == "resonant" && mode.m == 0);
        let Some(apart) = modes.min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz)) else { continue };
        sheet.claim(Claim {
            what: format!("{name}: heads in phase, and in antiphase ({:.0} Hz), T60", apart.frequency_hz),
            on: ROUND,
            figure: format!("{:.2} s, {:.2} s", together.t60, apart.t60),
            reference: "more than 1 s, less than a quarter of it".to_owned(),
            source: MEASURED,
            met: Some(together.t60 > 1.0 && apart.t60 < 0.25 * together.t60),
        });
    }
}

fn distances(sheet: &mut Sheet) {
    for (tom, on) in microphones::rack_toms() {
        for (output, name, at) in FARTHER {
            let [off, fine] = [RATE, FINE_RATE].map(|rate| microphones::farther(&tom, output, at, rate));
            let percent = |Farther { later, doubled, .. }| {
                format!("{:.2} % and {:.2} %", 100.0 * later, 100.0 * doubled)
            };
            sheet.claim(Claim {
                what: format!(
                    "rack tom, {name}, from {} m: error when moved 34.3 cm away (1 ms later), and to twice the distance (half)",
                    at.0
                ),
                on,
                figure: format!("{} of the sound off; at 96 kHz {}", percent(off), percent(fine)),
                reference: "3 % at 44.1 kHz".to_owned(),
                source: EXACT,
                met: Some(off.later < 0.03 && off.doubled < 0.03),
            });
        }
    }
    sheet.text(
        "A microphone that is moved away also loses high frequencies of the attack when the path is a fractional number of samples, most at\n\
         44.1 kHz. Besides, a drum is not a point source. The standard kit's heads wrap around the tip, which makes the stroke brighter.",
    );
}

/// Outputs, their names, the distance (m) from which a microphone is moved away and the time (s) that is compared: the
/// pairs until the room's first echoes, of the floor, arrive. A drum is no point, and its other head is farther: a close
/// microphone hears that up to some metres.
const FARTHER: [(usize, &str, (f64, f64)); 3] =
    [(CLOSE, "close", (4.0, 0.03)), (OVERHEADS, "overheads", (0.6, 0.005)), (ROOM, "room", (0.6, 0.005))];

fn near_fields(sheet: &mut Sheet) {
    for name in ["rack-tom", "floor-tom"] {
        for ((m, least), [close, overheads, room]) in
            [(2, 6.0), (3, 15.0)].into_iter().zip(microphones::near_field(&spec(name), RATE))
        {
            let hz = mode_of(&round_piece(name, RATE), m, 1).frequency_hz;
            sheet.claim(Claim {
                what: format!("{name}, ({m},1) at {hz:.0} Hz: of the whole, close, overheads, room"),
                on: ROUND,
                figure: format!("{close:.1}, {overheads:.1}, {room:.1} dB"),
                reference: format!("close {least} dB more than the others"),
                source: GOAL,
                met: Some(close > overheads + least && close > room + least),
            });
        }
    }
}

/// Radiated area of the modes of a drum's struck head against frequency, by nodal diameters.
fn areas(name: &str) -> Vec<Curve> {
    let modes = round_piece(name, RATE).modes();
    let of = |m: u32| {
        let of_order = modes.iter().filter(move |mode| mode.body == "batter" && mode.m == m);
        let points = of_order.map(|mode| (mode.frequency_hz, mode.radiation.max(1e-4)));
        let mut points: Vec<(f64, f64)> = points.filter(|point| (50.0..3000.0).contains(&point.0)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (format!("m = {m}"), points)
    };
    (0..5).map(of).collect()
}
