//! Radiation: what vibrating discs do to the air, and what is heard of them near and far.

use std::f64::consts::PI;

use anyhow::Result;
use overhear_engine::air::{DENSITY, SPEED_OF_SOUND};
use overhear_engine::listening::{ListeningPoint, Radiator};
use overhear_engine::piece::PieceId;
use overhear_engine::plate::free_disc::{FreeDisc, Radiated};
use overhear_lab::round_piece;

use super::heads::mode_of;
use super::page::sources::{EXACT, GOAL, MEASURED};
use super::plot::{Axis, Line, Plot};
use super::{Claim, Page, Sheet};

pub mod microphones;

use microphones::{Farther, OVERHEADS, RACK_TOM, ROOM};

const RATE: f64 = 44_100.0;

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "radiation",
        "Radiation and microphones",
        "Closed forms of a rigid disc in free air; what drums lose to the air; what microphones hear from where they stand.\n\
         `engine/src/plate/free_disc.rs`, `engine/src/listening/tests.rs`, `tests/tests/damping.rs` and `tests/tests/microphones.rs`\n\
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
            panels: [PieceId::RackTom, PieceId::Timpani].map(|id| (id.name().to_owned(), areas(id))).into(),
        },
    )?;
    Ok(sheet.finish())
}

/// Radius of the rigid disc, m.
const RADIUS: f64 = 0.2;

/// A rigid disc in free air, its circumference so many waves.
fn rigid(waves: f64) -> Radiated {
    let point = ListeningPoint { distance: 1.0, inclination: 0.3, azimuth: 0.0 };
    let disc = FreeDisc::new(RADIUS, [point; 2], 48);
    let radial = vec![1.0; 48];
    disc.radiate(&Radiator { m: 0, radial: &radial, omega: waves * SPEED_OF_SOUND / RADIUS }, 0.0)
}

fn rigid_disc(sheet: &mut Sheet) {
    let (slow, fast) = (rigid(0.05), rigid(30.0));
    let moment = 8.0 / 3.0 * DENSITY * RADIUS.powi(3);
    sheet.claim(Claim::near(
        "rigid disc, slow: air moved along over (8/3) rho a³",
        (slow.air_mass / moment, ""),
        (1.0, 0.01),
        "Lamb, Hydrodynamics, 102",
    ));
    let dipole = moment * moment * (0.05 / RADIUS).powi(4) * SPEED_OF_SOUND / (12.0 * PI * DENSITY);
    sheet.claim(Claim::near(
        "its resistance over that of the dipole of the same moment",
        (slow.resistance / dipole, ""),
        (1.0, 0.02),
        EXACT,
    ));
    let plane = 2.0 * DENSITY * SPEED_OF_SOUND * PI * RADIUS * RADIUS;
    sheet.claim(Claim::near(
        "rigid disc, fast: resistance over that of plane waves from both faces",
        (fast.resistance / plane, ""),
        (1.0, 0.03),
        EXACT,
    ));
}

fn toms(sheet: &mut Sheet) {
    for (id, apart) in [(PieceId::RackTom, 261.0), (PieceId::FloorTom, 169.0)] {
        let modes = round_piece(id, RATE).modes();
        let round = || modes.iter().filter(|mode| mode.m == 0);
        let together = round()
            .filter(|mode| mode.body == "batter")
            .min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let thud =
            round().min_by(|a, b| (a.frequency_hz - apart).abs().total_cmp(&(b.frequency_hz - apart).abs()));
        let (Some(together), Some(thud)) = (together, thud) else { continue };
        sheet.claim(Claim {
            what: format!("{}: heads together, and apart ({:.0} Hz), T60", id.name(), thud.frequency_hz),
            figure: format!("{:.2} s, {:.2} s", together.t60, thud.t60),
            reference: "more than 1 s, less than a quarter of it".to_owned(),
            source: MEASURED,
            met: Some(together.t60 > 1.0 && thud.t60 < 0.25 * together.t60),
        });
    }
}

fn distances(sheet: &mut Sheet) {
    // The pairs until the room's first echoes, of the floor, arrive. A drum is no point, and its other head is farther: a
    // close microphone hears that up to some metres.
    for (output, name, distance, seconds) in
        [(RACK_TOM, "close", 4.0, 0.03), (OVERHEADS, "overheads", 0.6, 0.005), (ROOM, "room", 0.6, 0.005)]
    {
        let Farther { later, doubled, .. } = microphones::farther(output, distance, seconds, RATE);
        sheet.claim(Claim {
            what: format!(
                "{name}, from {distance} m: 34.3 cm farther, a millisecond later; twice as far, half"
            ),
            figure: format!("{:.2} % and {:.2} % of the sound off", 100.0 * later, 100.0 * doubled),
            reference: "3 %".to_owned(),
            source: EXACT,
            met: Some(later < 0.03 && doubled < 0.03),
        });
    }
}

fn near_fields(sheet: &mut Sheet) {
    for id in [PieceId::RackTom, PieceId::FloorTom] {
        for ((m, least), [close, overheads, room]) in
            [(2, 6.0), (3, 15.0)].into_iter().zip(microphones::near_field(id, RATE))
        {
            let hz = mode_of(&round_piece(id, RATE), m, 1).frequency_hz;
            sheet.claim(Claim {
                what: format!("{}, ({m},1) at {hz:.0} Hz: of the whole, close, overheads, room", id.name()),
                figure: format!("{close:.1}, {overheads:.1}, {room:.1} dB"),
                reference: format!("close {least} dB more than the others"),
                source: GOAL,
                met: Some(close > overheads + least && close > room + least),
            });
        }
    }
}

/// Radiated area of the modes of a drum's struck head against frequency, by nodal diameters.
fn areas(id: PieceId) -> Vec<Line> {
    let modes = round_piece(id, RATE).modes();
    let of = |m: u32| {
        let of_order = modes.iter().filter(move |mode| mode.body == "batter" && mode.m == m);
        let points = of_order.map(|mode| (mode.frequency_hz, mode.radiation.max(1e-4)));
        let mut points: Vec<(f64, f64)> = points.filter(|point| (50.0..3000.0).contains(&point.0)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (format!("m = {m}"), points)
    };
    (0..5).map(of).collect()
}
