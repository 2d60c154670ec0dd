//! `modes`: every mode of a piece.

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, Result};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::{BuildOptions, Member, ModeInfo, ModeKind};
use overhear_measure::hear::{self, ALONE};
use serde::Serialize;

use crate::settings::PieceSetting;

/// The modes of a piece. The fields are the keys of the JSON and stay.
#[derive(Debug, Clone, Serialize)]
pub struct Modes {
    /// Name of the piece.
    pub piece: String,
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Tension of each stretched body, N/m.
    pub tension_n_m: BTreeMap<&'static str, f64>,
    /// Every mode.
    pub modes: Vec<Mode>,
}

/// One mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mode {
    /// The vibrating body.
    pub body: &'static str,
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles.
    pub n: u32,
    /// `cosine` or `sine`.
    pub member: &'static str,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Decay time by 60 dB, s; null for a mode that does not decay.
    pub t60_s: Option<f64>,
    /// Modal mass, kg.
    pub modal_mass_kg: f64,
    /// Far-field volume acceleration per modal acceleration, m2.
    pub radiation: f64,
    /// `complete`, `sampled`, `cavity` or `rigid`.
    pub kind: &'static str,
}

impl From<ModeInfo> for Mode {
    fn from(info: ModeInfo) -> Mode {
        Mode {
            body: info.body,
            m: info.m,
            n: info.n,
            member: match info.member {
                Member::Cosine => "cosine",
                Member::Sine => "sine",
            },
            frequency_hz: info.frequency_hz,
            t60_s: Some(info.t60).filter(|t60| t60.is_finite()),
            modal_mass_kg: info.modal_mass,
            radiation: info.radiation,
            kind: match info.kind {
                ModeKind::Complete => "complete",
                ModeKind::Sampled => "sampled",
                ModeKind::Cavity => "cavity",
                ModeKind::Rigid => "rigid",
            },
        }
    }
}

/// Builds the only piece of a kit and lists its modes.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built so.
pub fn run(spec: &KitSpec, options: &BuildOptions, settings: &[PieceSetting]) -> Result<Modes> {
    let kit = hear::stand(spec, options, settings)?;
    let piece = kit.piece(ALONE).context("a kit without a piece")?;
    Ok(Modes {
        piece: spec.pieces.first().map(|piece| piece.name.clone()).unwrap_or_default(),
        sample_rate_hz: options.sample_rate,
        tension_n_m: piece.tensions().into_iter().collect(),
        modes: piece.modes().into_iter().map(Mode::from).collect(),
    })
}

impl fmt::Display for Modes {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{}: {} modes at {} Hz", self.piece, self.modes.len(), self.sample_rate_hz)?;
        for (body, tension) in &self.tension_n_m {
            writeln!(f, "tension of the {body}: {tension:.0} N/m")?;
        }
        writeln!(
            f,
            "\n{:<10} {:>3} {:>3} {:<6} {:>11} {:>9} {:>9} {:>11}  kind",
            "body", "m", "n", "member", "Hz", "T60 s", "mass kg", "radiation",
        )?;
        for mode in &self.modes {
            let t60 = mode.t60_s.map_or_else(|| "-".to_owned(), |t60| format!("{t60:.3}"));
            writeln!(
                f,
                "{:<10} {:>3} {:>3} {:<6} {:>11.3} {t60:>9} {:>9.5} {:>11.3e}  {}",
                mode.body,
                mode.m,
                mode.n,
                mode.member,
                mode.frequency_hz,
                mode.modal_mass_kg,
                mode.radiation,
                mode.kind,
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_without_losses_has_no_decay_time() {
        let info = ModeInfo {
            body: "plate",
            m: 2,
            n: 0,
            member: Member::Sine,
            frequency_hz: 22.9,
            t60: f64::INFINITY,
            modal_mass: 1.1,
            radiation: 0.0,
            kind: ModeKind::Complete,
        };
        let json = serde_json::to_value(Mode::from(info)).unwrap();
        assert!(json["t60_s"].is_null());
        assert_eq!((json["member"].as_str(), json["kind"].as_str()), (Some("sine"), Some("complete")));
    }
}
