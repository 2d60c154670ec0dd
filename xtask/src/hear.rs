//! `hear`: one stroke on one piece by itself, measured.
//!
//! The piece is built as the kit builds it but stands alone: what is heard is its sound pressure
//! at its listening point, 20 Pa being full scale, without microphones, mix or neighbours.

mod measure;
mod table;

use std::path::PathBuf;

use anyhow::Result;
use overhear::midi_map;
use overhear_engine::kit::BLOCK;
use overhear_engine::piece::{BuildOptions, Piece, PieceId};
use overhear_engine::snapshot::{FIELD_MODES, PieceSnapshot, StrikeSnapshot, WireSnapshot};
use overhear_engine::strike::{Strike, Striker};

use crate::analysis::Motion;
use crate::bad_input;
use crate::settings::PieceSetting;
use crate::wav::{Bits, WavFile};

pub use measure::Measurement;

/// Sound pressure that is full scale, Pa.
pub const FULL_SCALE_PA: f32 = 20.0;

/// Speed of a stroke that is not told otherwise, m/s: a firm but ordinary one.
pub const DEFAULT_SPEED: f64 = 4.0;

/// One stroke as asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// What is struck.
    pub piece: PieceId,
    /// The stroke.
    pub strike: Strike,
    /// Tuning and muffling.
    pub settings: Vec<PieceSetting>,
    /// How the piece is built.
    pub options: BuildOptions,
    /// Length of the sound, s.
    pub seconds: f64,
    /// A WAV file for the sound.
    pub wav: Option<PathBuf>,
}

/// The stroke a piece gets unless told otherwise: the place and the striker that the MIDI map has
/// for its ordinary note, at [`DEFAULT_SPEED`].
pub fn default_strike(piece: PieceId) -> Strike {
    let note = match piece {
        PieceId::Kick => 36,
        PieceId::Snare => 38,
        PieceId::RackTom => 48,
        PieceId::FloorTom => 43,
        PieceId::Crash => 49,
        PieceId::Ride => 51,
        PieceId::Splash => 55,
        PieceId::Timpani => 88,
        PieceId::HiHat => 42,
    };
    let mapped = midi_map::stroke(note).filter(|stroke| stroke.piece == piece);
    let (radius, angle, striker) =
        mapped.map_or((0.3, 0.0, Striker::Stick), |stroke| (stroke.radius, stroke.angle, stroke.striker));
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

/// A rendered stroke.
#[derive(Debug, Clone)]
pub struct Sound {
    /// Samples, full scale 1.
    pub samples: Vec<f32>,
    /// Motion of the lowest modes.
    pub motion: Motion,
    /// Energy of the striker as it arrives, J.
    pub striker_energy: f64,
    /// Energy that strikers have taken away, their bending and all, J.
    pub striker_energy_out: f64,
    /// Greatest energy of the piece, J.
    pub energy_peak: f64,
    /// Energy of the piece at the end, J.
    pub energy_end: f64,
    /// What the contact measured.
    pub contact: StrikeSnapshot,
    /// What the snare wires did.
    pub wires: WireSnapshot,
}

/// Strikes and renders, block by block.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built so.
pub fn render(request: &Request) -> Result<Sound> {
    let mut piece = Piece::new(request.piece, &request.options).map_err(|error| bad_input!("{error}"))?;
    for setting in &request.settings {
        setting.apply(&mut piece);
    }
    if !request.settings.is_empty() {
        settle(&mut piece, request.options.sample_rate);
    }
    piece.strike(&request.strike);
    let striker_energy = piece.striker_energy();
    let length = (request.seconds * request.options.sample_rate).round() as usize;
    let mut samples = vec![0.0; length];
    let mut energy_peak = piece.energy();
    let rate = request.options.sample_rate / BLOCK as f64;
    let mut motion = Motion { modes: vec![Vec::new(); FIELD_MODES], rate };
    let mut seen = PieceSnapshot::default();
    for block in samples.chunks_mut(BLOCK) {
        piece.render(block);
        energy_peak = energy_peak.max(piece.energy());
        piece.snapshot(&mut seen);
        for (mode, &displacement) in motion.modes.iter_mut().zip(&seen.displacement) {
            mode.push(displacement);
        }
    }
    for sample in &mut samples {
        *sample /= FULL_SCALE_PA;
    }
    let striker_energy_out = piece.departed_energy() + piece.striker_energy();
    let (energy_end, contact, wires) = (piece.energy(), piece.last_strike(), piece.wires());
    Ok(Sound { samples, motion, striker_energy, striker_energy_out, energy_peak, energy_end, contact, wires })
}

/// Lets the tuning and the muffling glide to where they were set, at rest.
pub(crate) fn settle(piece: &mut Piece, rate: f64) {
    let mut silence = [0.0; BLOCK];
    for _ in 0..(0.5 * rate) as usize / BLOCK {
        piece.render(&mut silence);
    }
}

/// Strikes, measures, writes the sound if asked to, and returns the measurement.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built or the file not be written.
pub fn run(request: &Request) -> Result<Measurement> {
    let rate = request.options.sample_rate;
    let frames = (request.seconds * rate).round() as u64;
    let file = match &request.wav {
        Some(path) => Some(WavFile::create(path, Bits::Float32, rate as u32, 1, frames)?),
        None => None,
    };
    let sound = render(request)?;
    if let Some(mut file) = file {
        file.write(&[&sound.samples])?;
        file.finish()?;
    }
    Ok(Measurement::new(request, &sound))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_has_a_stroke_of_its_own() {
        for piece in PieceId::ALL {
            let strike = default_strike(piece);
            assert!((0.0..=1.0).contains(&strike.radius));
        }
        assert_eq!(default_strike(PieceId::Kick).striker, Striker::FeltBeater);
        assert_eq!(default_strike(PieceId::Crash).striker, Striker::Shoulder);
        assert_eq!(default_strike(PieceId::Timpani).striker, Striker::TimpaniMallet);
    }

    #[test]
    fn an_unknown_striker_is_answered_with_all_of_them() {
        let error = striker("spoon").unwrap_err().to_string();
        assert!(Striker::ALL.iter().all(|striker| error.contains(striker.name())), "{error}");
    }
}
