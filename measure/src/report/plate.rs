//! Plates: wave numbers of the free disc, and the effect of doming on its frequencies.

use std::f64::consts::TAU;

use crate::{plate, reference, spec};
use anyhow::Result;
use overhear_engine::plate::{PlateModes, PlateSpec, edges};

use super::page::bodies;
use super::page::sources::{EARLIER, EXACT};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Plot};
use crate::bad_input;

/// `lambda²` of a free disc of Poisson's ratio .33: nodal diameters, circles. Leissa, Vibration of Plates (1969), table 2.5.
const WAVE_NUMBERS: [(u32, u32, f64); 13] = [
    (2, 0, 5.2620),
    (0, 1, 9.0689),
    (3, 0, 12.2439),
    (1, 1, 20.5131),
    (4, 0, 21.5272),
    (5, 0, 33.0618),
    (2, 1, 35.2425),
    (0, 2, 38.5070),
    (6, 0, 46.8087),
    (3, 1, 52.9210),
    (1, 2, 59.8591),
    (10, 0, 123.4428),
    (10, 4, 699.7988),
];

/// The page.
///
/// # Errors
/// If a plate cannot be or the plot not be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "plate",
        "Plates",
        bodies::CAP,
        "The free disc and the shallow dome, before losses and air. `engine/src/plate/edges.rs`, `engine/src/plate/tests.rs` and\n\
         `tests/tests/acoustics.rs` hold them.",
    );
    for (m, n, published) in WAVE_NUMBERS {
        let modes = edges::free_modes(m, 0.33, published.sqrt() + 1.0);
        let got = modes.iter().find(|mode| mode.n == n).map_or(f64::NAN, |mode| mode.root * mode.root);
        sheet.claim(Claim {
            what: format!("free disc, nu .33, ({m},{n}): lambda²"),
            on: bodies::EQUATION,
            figure: format!("{got:.4}"),
            reference: format!("{published:.4}, 0.01 %"),
            source: "Leissa 1969",
            met: Some((got / published - 1.0).abs() < 1e-4),
        });
    }
    domes(&mut sheet)?;
    Ok(sheet.finish())
}

fn domes(sheet: &mut Sheet) -> Result<()> {
    let modes = |spec: &PlateSpec| PlateModes::new(spec, 1200.0).map_err(|error| bad_input!("{error}"));
    let cap = plate(&reference::cap_crash());
    let ring = cap.ring_omega() / TAU;
    let what = "16 in crash: ring frequency";
    sheet.claim(Claim::near(what, bodies::CAP, (ring, "Hz"), (546.0, 0.005), EXACT));
    for (name, reference, (m, n), hz) in [
        ("crash", reference::cap_crash(), (2, 0), 22.9),
        ("crash", reference::cap_crash(), (3, 0), 54.4),
        ("crash", reference::cap_crash(), (10, 0), 530.0),
        ("crash", reference::cap_crash(), (0, 1), 547.4),
        ("ride", reference::cap_ride(), (0, 1), 489.4),
        ("splash", reference::cap_splash(), (0, 1), 841.4),
    ] {
        let of = |spec: &PlateSpec| -> Result<(f64, PlateModes)> {
            let modes = modes(spec)?;
            let shell = modes.shells.iter().find(|shell| (shell.m, shell.n) == (m, n));
            Ok((shell.map_or(f64::NAN, |shell| shell.omega / TAU), modes))
        };
        let cap = plate(&reference);
        let (got, modes) = of(&cap)?;
        let flat = modes.flat[m as usize].iter().find(|flat| flat.n == n);
        let flat = flat.map_or(f64::NAN, |flat| cap.flat_omega() * flat.root * flat.root / TAU);
        let what = format!("{name}, ({m},{n}): flat {flat:.1} Hz, domed");
        sheet.claim(Claim::near(&what, bodies::CAP, (got, "Hz"), (hz, 0.005), EARLIER));
        let (played, _) = of(&plate(&spec(name)))?;
        let what = format!("{name}, ({m},{n}), with its bell and its taper");
        let figure = format!("{played:.1} Hz");
        sheet.claim(Claim::told(&what, bodies::PLAYED, figure, "no closed form", EXACT));
    }
    let crash = modes(&cap)?;
    let flat = |n: u32| {
        let of_circle = crash.flat.iter().flatten().filter(move |mode| mode.n == n);
        let hz = |root: f64| cap.flat_omega() * root * root / TAU;
        of_circle.map(|mode| (f64::from(mode.m), hz(mode.root))).filter(|point| point.1 < 1200.0).collect()
    };
    let domed = |n: u32| {
        let mut points: Vec<(f64, f64)> = crash
            .shells
            .iter()
            .filter(|shell| shell.n == n)
            .map(|shell| (f64::from(shell.m), shell.omega / TAU))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let lines =
        (0..3).flat_map(|n| [(format!("flat, n = {n}"), flat(n)), (format!("dome, n = {n}"), domed(n))]);
    sheet.plot(
        "dome",
        "Frequencies of the cap crash's modes against their nodal diameters, as a flat plate and as the dome it is",
        &Plot {
            across: Axis::linear("nodal diameters", 0.0..16.0),
            up: Axis::log("Hz", 10.0..1300.0),
            panels: vec![(format!("16 in crash, ring frequency {ring:.0} Hz"), lines.collect())],
        },
    )
}
