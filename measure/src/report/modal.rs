//! Modes: errors of frequency, decay and static deflection.
//!
//! The usual two-pole recurrence `y[n+1] = 2 cos(omega dt) y[n] - y[n-1]` is shown for comparison: in single
//! precision its coefficient cannot represent a low frequency.

use std::f64::consts::TAU;

use crate::spectra::PowerSpectrum;
use crate::{cents, names, piece, render_into, render_surface, stroke};
use anyhow::Result;
use overhear_engine::contact::Material;
use overhear_engine::damping::LossLaw;
use overhear_engine::membrane::{Membrane, MembraneSpec, ModeRange, Surroundings, vacuum_tension};
use overhear_engine::modal::{InputVector, ModalBody, Mode};
use overhear_engine::piece::{Member, ModeInfo, ModeKind, Piece};
use overhear_engine::shapes::{ShapeIndex, ShapeTable};
use overhear_engine::strike::Striker;
use overhear_engine::surface::{Surface, SurfaceParts};

use super::page::bodies;
use super::page::sources::EXACT;
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Plot};

const RATE: f64 = 44_100.0;

/// Time for which modes are followed, s.
const SECONDS: f64 = 8.0;

/// Zeros `j_mn` (dimensionless), of which a head's lowest modes in vacuum are multiples. Abramowitz & Stegun, table
/// 9.5.
pub const ZEROS: [f64; 8] = [
    2.404_825_557_695_773,
    3.831_705_970_207_512,
    5.135_622_301_840_683,
    5.520_078_110_286_311,
    6.380_161_895_923_984,
    7.015_586_669_815_619,
    7.588_342_434_503_804,
    8.417_244_140_399_865,
];

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "modal",
        "Modes",
        bodies::PLAYED,
        "Every mode of every piece, 44.1 kHz, single precision: frequency and decay over 8 s, from the phase and amplitude of the mode's\n\
         motion, and deflection under a force that is applied slowly and held. `tests/tests/acoustics.rs` holds them.",
    );
    let (off, decay) = worst_ringing();
    sheet.claim(Claim {
        what: "a mode rings at its frequency".to_owned(),
        on: bodies::PLAYED,
        figure: format!("{off:.5} cents at most"),
        reference: "0.05 cents".to_owned(),
        source: EXACT,
        met: Some(off < 0.05),
    });
    sheet.claim(Claim {
        what: "a mode decays at its rate".to_owned(),
        on: bodies::PLAYED,
        figure: format!("{:.5} % at most", 100.0 * decay),
        reference: "0.1 %".to_owned(),
        source: EXACT,
        met: Some(decay < 1e-3),
    });
    let bent = names().iter().map(|name| worst_deflection(name)).fold(0.0, f64::max);
    sheet.claim(Claim {
        what: "a held force bends a piece, and each of its modes, by F / (M omega²)".to_owned(),
        on: bodies::PLAYED,
        figure: format!("{:.4} % off at most", 100.0 * bent),
        reference: "0.1 %".to_owned(),
        source: EXACT,
        met: Some(bent < 1e-3),
    });
    let ratios = bessel_ratios().into_iter().map(|(_, off)| off.abs()).fold(0.0, f64::max);
    sheet.claim(Claim {
        what: "eight modes of a head in vacuum, struck and heard: ratios to the lowest".to_owned(),
        on: bodies::MEMBRANE,
        figure: format!("{ratios:.4} cents off at most"),
        reference: "1 cent of j_mn / j_01".to_owned(),
        source: EXACT,
        met: Some(ratios < 1.0),
    });
    let frequencies: Vec<f64> =
        (0..120).map(|i| 10.0 * (0.45 * RATE / 10.0).powf(f64::from(i) / 119.0)).collect();
    let ours = tuning(&frequencies);
    let two_pole = frequencies.iter().map(|&hz| (hz, two_pole_error(hz).abs().max(1e-6))).collect();
    sheet.plot(
        "tuning",
        "Tuning error against frequency, beside a two-pole recurrence with the same precision",
        &Plot {
            across: Axis::log("Hz", 10.0..20_000.0),
            up: Axis::log("cents off", 1e-6..100.0),
            panels: vec![(
                "44.1 kHz, f32".to_owned(),
                vec![("two-pole recurrence".to_owned(), two_pole), ("here".to_owned(), ours)],
            )],
        },
    )?;
    Ok(sheet.finish())
}

/// Cents by which the frequency of a two-pole recurrence is off whose coefficient is an `f32`.
fn two_pole_error(hz: f64) -> f64 {
    let coefficient = (2.0 * (TAU * hz / RATE).cos()) as f32;
    let heard = (0.5 * f64::from(coefficient)).clamp(-1.0, 1.0).acos() * RATE / TAU;
    // A mode that does not measurably move has the largest error of the plot.
    if heard > 0.0 { cents(heard, hz) } else { 100.0 }
}

/// Modes of some frequencies (Hz) in one body, over [`SECONDS`]: frequency, and cents by which it is off.
fn tuning(frequencies: &[f64]) -> Vec<(f64, f64)> {
    let mode = |&hz: &f64| Mode { omega: TAU * hz, sigma: 0.0, mass: 1.0 };
    let mut body = ModalBody::new(frequencies.iter().map(mode).collect(), RATE);
    push_all(&mut body);
    let mut phases: Vec<Phase> =
        frequencies.iter().enumerate().filter_map(|(k, &hz)| Phase::new(&body, k, hz)).collect();
    for sample in 1..=(SECONDS * RATE) as usize {
        body.step();
        if sample % LOOK == 0 {
            phases.iter_mut().for_each(|phase| phase.look(&body, sample as f64 / RATE));
        }
    }
    phases.iter().map(|phase| (phase.hz, phase.motion.off.abs().max(1e-6))).collect()
}

/// Samples between two looks: often enough that a mode half a cent off is followed without losing a turn.
const LOOK: usize = 2048;

/// Motion of a ringing mode, compared with the data of the mode.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModeMotion {
    /// Frequency error, cents.
    pub off: f64,
    /// Error of the decay rate, 1/s.
    pub sigma: f64,
    /// Periods over which it was followed, dimensionless.
    pub turns: f64,
}

/// A mode whose phase is followed.
struct Phase {
    mode: usize,
    hz: f64,
    start: (f64, f64),
    gained: f64,
    motion: ModeMotion,
}

impl Phase {
    /// Follows a mode from now on; `None` for a mode at rest.
    fn new(body: &ModalBody, mode: usize, hz: f64) -> Option<Phase> {
        state(body, mode).map(|start| Phase { mode, hz, start, gained: 0.0, motion: ModeMotion::default() })
    }

    /// Updates the phase after `time` s.
    fn look(&mut self, body: &ModalBody, time: f64) {
        let (p0, q0) = self.start;
        let Some((p, q)) = state(body, self.mode) else { return };
        let angle = TAU * self.hz * time;
        let off = q.atan2(p) - q0.atan2(p0) - angle - self.gained;
        self.gained += off - TAU * (off / TAU).round();
        self.motion = ModeMotion {
            off: cents(1.0 + self.gained / angle, 1.0),
            sigma: (p0.hypot(q0) / p.hypot(q)).ln() / time,
            turns: angle / TAU,
        };
    }
}

/// `(q' + sigma q) / omega_d` and `q` of a mode; `None` at rest.
fn state(body: &ModalBody, k: usize) -> Option<(f64, f64)> {
    let (mode, q) = (body.modes()[k], f64::from(body.displacement(k)));
    let p = (body.velocity(k) + mode.sigma * q) / mode.omega_d();
    (p.hypot(q) > 1e-15).then_some((p, q))
}

/// Sets every mode in motion, about equally strongly.
fn push_all(body: &mut ModalBody) {
    let count = body.len();
    let mut input = InputVector::new(count);
    input.shape_mut()[..count].fill(1.0);
    body.connect(&mut input);
    body.push(&input, 100.0);
}

/// Modes of a piece's struck body. Left out are the sampled modes above them, and the modes of other bodies: a rim, a
/// hi-hat's lower cymbal.
pub fn body_modes(piece: &Piece) -> Vec<ModeInfo> {
    let of_body =
        |mode: &ModeInfo| mode.kind != ModeKind::Sampled && !["rim", "shell", "bottom"].contains(&mode.body);
    piece.modes().into_iter().filter(of_body).collect()
}

/// Strikes every mode of a piece and follows its phase and amplitude while the piece renders for `seconds`. Returns the modes
/// that moved, with their motion.
pub fn follow(piece: &mut Piece, seconds: f64) -> Vec<(ModeInfo, ModeMotion)> {
    let modes = body_modes(piece);
    let body = piece.surface_mut().body_mut();
    push_all(body);
    let mut phases: Vec<Phase> =
        modes.iter().enumerate().filter_map(|(k, mode)| Phase::new(body, k, mode.frequency_hz)).collect();
    let mut sound = vec![0.0; LOOK];
    for look in 1..=(seconds * RATE) as usize / LOOK {
        render_into(piece, &mut sound);
        let time = (look * LOOK) as f64 / RATE;
        let body = piece.surface_mut().body();
        phases.iter_mut().for_each(|phase| phase.look(body, time));
    }
    phases.into_iter().map(|phase| (modes[phase.mode], phase.motion)).collect()
}

/// Largest errors of all modes of all pieces: of the frequency, cents, and of the decay rate, relative.
fn worst_ringing() -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for name in names() {
        for (mode, motion) in follow(&mut piece(&name, RATE), SECONDS) {
            if mode.frequency_hz < 0.5 * RATE {
                worst = (worst.0.max(motion.off.abs()), worst.1.max(decay_error(&mode, &motion).abs()));
            }
        }
    }
    worst
}

/// Relative error of a mode's decay rate.
pub fn decay_error(mode: &ModeInfo, motion: &ModeMotion) -> f64 {
    motion.sigma * mode.t60 / 1000.0_f64.ln() - 1.0
}

/// Holds 3 N on a piece and tells by what share its deflection there, or one of a mode's, is off at most.
pub fn worst_deflection(name: &str) -> f64 {
    const FORCE: f64 = 3.0;
    let mut piece = piece(name, RATE);
    let surface = piece.surface_mut();
    let mut port = InputVector::new(surface.body().len());
    surface.shapes().fill(0.37, 0.8, port.shape_mut());
    let body = surface.body_mut();
    body.connect(&mut port);
    // Applied slowly, so that little ringing remains.
    let (ramp, hold) = (4 * RATE as usize, 2 * RATE as usize);
    for sample in 0..ramp + hold {
        let share = (sample as f64 / ramp as f64).min(1.0);
        let force = FORCE * (0.5 - 0.5 * (0.5 * TAU * share).cos());
        body.step();
        body.push(&port, force as f32);
    }
    let (mut worst, mut exact) = (0.0_f64, 0.0);
    for (k, mode) in body.modes().iter().enumerate() {
        let shape = f64::from(port.shape()[k]);
        let own = shape * FORCE / (mode.mass * mode.omega.powi(2));
        exact += shape * own;
        // A mode with a node there cannot be measured.
        if shape.abs() > 0.01 {
            worst = worst.max((f64::from(body.displacement(k)) / own - 1.0).abs());
        }
    }
    worst.max((body.displacement_at(&port) / exact - 1.0).abs())
}

/// A head in vacuum without losses, `(0,1)` at 100 Hz, and so thin that its bending is nothing.
fn ideal_head() -> Surface {
    let spec = MembraneSpec {
        radius: 0.3,
        thickness: 0.02e-3,
        plies: 1,
        material: Material::FILM,
        loss: LossLaw::NONE,
        edge: None,
        dot: None,
        mesh: None,
    };
    let tension = vacuum_tension(&spec, (0, ZEROS[0]), 100.0);
    let range = ModeRange { reference_tension: tension, limit_hz: 1500.0 };
    let membrane = Membrane::new(spec, Surroundings::Vacuum, &range).expect("a head that can be");
    let (mut modes, mut index) = (Vec::new(), Vec::new());
    for (radial, mode) in membrane.modes().iter().enumerate() {
        let ringing = membrane.ringing(mode, tension);
        modes.push(Mode { omega: ringing.omega, sigma: ringing.sigma, mass: ringing.mass });
        index.push(ShapeIndex { radial, rows: 1, m: mode.m, member: Member::Cosine, axis: 0.0 });
    }
    Surface::new(SurfaceParts {
        transfer: vec![[1.0, 0.0]; modes.len()],
        modes,
        shapes: ShapeTable::new(&membrane.radial_shapes(&ShapeTable::radii()), index),
        material: Material::FILM,
        lossless: true,
        sample_rate: RATE,
    })
}

/// Strikes a head in vacuum and listens: each ratio there should be, and cents by which it is off.
pub fn bessel_ratios() -> Vec<(f64, f64)> {
    let mut head = ideal_head();
    head.strike(&stroke(Striker::TimpaniMallet, 1.0, 0.43, 0.1));
    let sound = render_surface(&mut head, 10 * RATE as usize);
    // From when the mallet has left.
    let spectrum = PowerSpectrum::hann(&sound[RATE as usize..], RATE);
    let lowest = spectrum.line(100.0, 5.0);
    let ratios = ZEROS.iter().map(|zero| zero / ZEROS[0]);
    ratios.map(|ratio| (ratio, cents(spectrum.line(100.0 * ratio, 5.0) / lowest, ratio))).collect()
}
