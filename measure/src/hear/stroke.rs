//! One stroke: as asked for, and as rendered.

use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::BuildOptions;
use overhear_engine::snapshot::{RimSnapshot, StrikeSnapshot, WireSnapshot};
use overhear_engine::strike::Strike;

use crate::analysis::Motion;
use crate::settings::PieceSetting;

/// One stroke as asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// A kit of the one piece that is struck; see [`KitSpec::alone`].
    pub kit: KitSpec,
    /// The stroke.
    pub strike: Strike,
    /// Controls that are not where the piece has them.
    pub settings: Vec<PieceSetting>,
    /// How the piece is built.
    pub options: BuildOptions,
    /// Length of the sound, s.
    pub seconds: f64,
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
    /// Measurements of the contact.
    pub contact: StrikeSnapshot,
    /// Motion of the snare wires.
    pub wires: WireSnapshot,
    /// Motion of a hi-hat's rims.
    pub rims: RimSnapshot,
}
