//! `hear`: one stroke on one piece by itself, measured.
//!
//! The piece is a kit of its own and is rendered like every kit. The output is the sound pressure at its close
//! microphone; full scale is 20 Pa. The gain of that microphone and the mix are not applied.

mod measure;
mod stroke;
mod table;

use anyhow::{Context, Result};
use overhear::kit_document::KitDocument;
use overhear_engine::kit::{BLOCK, Control, Kit, Microphone};
use overhear_engine::kit_spec::{Kind, KitSpec, PieceSpec};
use overhear_engine::microphones::CloseSpec;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{FIELD_MODES, PieceSnapshot};
use overhear_engine::strike::{Strike, Striker};

use crate::analysis::Motion;
use crate::bad_input;
use crate::settings::PieceSetting;

pub use measure::Measurement;
pub use stroke::{Request, Sound};

/// Default speed of a stroke, m/s: firm but ordinary.
pub const DEFAULT_SPEED: f64 = 4.0;

/// The slot of a piece that is a kit by itself.
pub const ALONE: Slot = Slot::ALL[0];

/// Time for controls to settle before the stroke, s.
const SETTLING: f64 = 0.5;

/// The stroke a piece gets unless told otherwise: the place and the striker of its ordinary note, at
/// [`DEFAULT_SPEED`]. A piece that no note strikes is struck with a stick, a cymbal near its edge.
pub fn default_strike(document: &KitDocument, slot: Slot) -> Strike {
    let KitDocument { kit, notes } = document;
    let ordinary = notes.ordinary(slot).and_then(|note| notes.stroke(note));
    let is_drum = kit.piece(slot).is_some_and(|piece| piece.instrument.kind() == Kind::Drum);
    let (radius, angle, striker) = match ordinary {
        Some(stroke) => (stroke.radius, stroke.angle, stroke.striker),
        None if is_drum => (0.3, 0.0, Striker::Stick),
        None => (0.9, 0.0, Striker::Shoulder),
    };
    Strike { speed: DEFAULT_SPEED, radius, angle, striker }
}

/// The striker of that name.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming every striker.
pub fn striker(name: &str) -> Result<Striker> {
    Striker::from_name(name).ok_or_else(|| {
        let names = Striker::ALL.map(Striker::name).join(", ");
        bad_input!("no striker is called `{name}`, accepted: {names}")
    })
}

/// A kit with its pieces, its controls at rest where they were set.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if a piece cannot be built so.
pub fn stand(spec: &KitSpec, options: &BuildOptions, settings: &[PieceSetting]) -> Result<Kit> {
    let mut kit = Kit::new(options.sample_rate, spec);
    for slot in Slot::ALL {
        let Some(build) = spec.build(slot) else { continue };
        let piece = Piece::new(slot, &build, options).map_err(|error| bad_input!("{error}"))?;
        kit.install(Box::new(piece));
    }
    for setting in settings {
        setting.apply(&mut kit);
    }
    kit.finish_controls();
    Ok(kit)
}

/// The kit with nothing between the first piece's close microphone and the left side of its output.
fn unmixed(mut spec: KitSpec) -> KitSpec {
    if let Some(piece) = spec.pieces.first_mut() {
        let PieceSpec { close, defaults, .. } = piece;
        *close = match *close {
            CloseSpec::OverRim { height, azimuth, contour, .. } => {
                CloseSpec::OverRim { height, azimuth, gain: 1.0, contour }
            }
            CloseSpec::Beside { distance, inclination, azimuth, contour, .. } => {
                CloseSpec::Beside { distance, inclination, azimuth, time_zero: distance, gain: 1.0, contour }
            }
        };
        // A pan all the way to one side is a factor of 1 there.
        (defaults.level_db, defaults.pan) = (0.0, -1.0);
    }
    spec
}

/// Strikes and renders, block by block.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built so.
pub fn render(request: &Request) -> Result<Sound> {
    render_prepared(request, |_| ())
}

/// As [`render`], but `prepare` changes the piece before it is struck.
///
/// # Errors
/// As [`render`].
pub fn render_prepared(request: &Request, prepare: impl FnOnce(&mut Piece)) -> Result<Sound> {
    let rate = request.options.sample_rate;
    let mut kit = stand(&unmixed(request.kit.clone()), &request.options, &request.settings)?;
    for pair in [Microphone::Overheads, Microphone::Room] {
        kit.set(Control::Mute(pair), 1.0);
    }
    kit.finish_controls();
    if !request.settings.is_empty() {
        for _ in 0..(SETTLING * rate) as usize / BLOCK {
            hear_close(&mut kit, &mut [0.0; BLOCK]);
        }
    }
    if let Some(piece) = kit.piece_mut(ALONE) {
        prepare(piece);
    }
    kit.strike(ALONE, &request.strike);
    let piece = |kit: &Kit| kit.piece(ALONE).map_or(0.0, Piece::energy);
    let striker_energy = kit.piece(ALONE).context("a kit without a piece")?.striker_energy();
    let mut samples = vec![0.0; (request.seconds * rate).round() as usize];
    let mut energy_peak = piece(&kit);
    let mut motion = Motion { modes: vec![Vec::new(); FIELD_MODES], rate: rate / BLOCK as f64 };
    let mut seen = PieceSnapshot::default();
    for block in samples.chunks_mut(BLOCK) {
        hear_close(&mut kit, block);
        energy_peak = energy_peak.max(piece(&kit));
        kit.piece(ALONE).into_iter().for_each(|piece| piece.snapshot(&mut seen));
        for (mode, &displacement) in motion.modes.iter_mut().zip(&seen.displacement) {
            mode.push(displacement);
        }
    }
    let piece = kit.piece(ALONE).context("a kit without a piece")?;
    Ok(Sound {
        samples,
        motion,
        striker_energy,
        striker_energy_out: piece.departed_energy() + piece.striker_energy(),
        energy_peak,
        energy_end: piece.energy(),
        contact: piece.last_strike(),
        wires: piece.wires(),
        rims: piece.rims(),
    })
}

/// Renders what the close microphone of an [unmixed] kit's piece hears, full scale 1, at most a block.
fn hear_close(kit: &mut Kit, out: &mut [f32]) {
    let (mut main, samples) = ([[0.0; BLOCK]; 2], out.len());
    kit.render_outputs(main.each_mut().map(|side| &mut side[..samples]), &mut [[out, &mut []]]);
}

/// Strikes and measures.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built so.
pub fn run(request: &Request) -> Result<Measurement> {
    Ok(Measurement::new(request, &render(request)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit::FULL_SCALE;

    #[test]
    fn every_piece_has_a_stroke_of_its_own() {
        let document = KitDocument::standard();
        let strike = |name: &str| {
            let (slot, _) = document.kit.find(name).unwrap();
            default_strike(&document, slot)
        };
        for (slot, piece) in document.kit.slots() {
            assert!(document.notes.ordinary(slot).is_some(), "{}", piece.name);
            assert!((0.0..=1.0).contains(&default_strike(&document, slot).radius), "{}", piece.name);
        }
        assert_eq!(strike("kick").striker, Striker::FeltBeater);
        assert_eq!(strike("crash").striker, Striker::Shoulder);
        assert_eq!(strike("timpani").striker, Striker::TimpaniMallet);
    }

    #[test]
    fn an_unknown_striker_is_answered_with_all_of_them() {
        let error = striker("spoon").unwrap_err().to_string();
        assert!(Striker::ALL.iter().all(|striker| error.contains(striker.name())), "{error}");
    }

    #[test]
    fn what_is_heard_is_the_pressure_at_the_close_microphone() {
        let document = KitDocument::standard();
        let (slot, _) = document.kit.find("rack-tom").unwrap();
        let kit = document.kit.alone(slot).unwrap();
        let options = BuildOptions::new(48_000.0);
        let strike = default_strike(&document, slot);
        let heard =
            render(&Request { kit: kit.clone(), strike, settings: Vec::new(), options, seconds: 0.05 });
        let heard = heard.unwrap().samples;
        let mut piece = Piece::new(ALONE, &kit.build(ALONE).unwrap(), &options).unwrap();
        piece.set_muffling(kit.pieces[0].defaults.muffle);
        piece.finish_controls();
        piece.strike(&strike);
        let mut pressure = vec![0.0; heard.len()];
        crate::render_into(&mut piece, &mut pressure);
        let loudest = pressure.iter().fold(0.0_f32, |loudest, x| loudest.max(x.abs()));
        assert!(loudest > 1.0);
        for (heard, pressure) in heard.iter().zip(&pressure) {
            assert!((heard * FULL_SCALE - pressure).abs() < 1e-5 * loudest, "{heard} {pressure}");
        }
    }
}
