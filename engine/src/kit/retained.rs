//! Values of a slot's controls, for any piece that is installed there.

use crate::kit_spec::PieceSpec;
use crate::surface::wires::PRELOAD;

/// Values that a piece takes over when it is installed.
#[derive(Debug, Clone, Copy)]
pub(super) struct RetainedControls {
    pub(super) tuning: f64,
    pub(super) muffling: f64,
    pub(super) preload: f64,
    pub(super) wires: bool,
    pub(super) pedal: f64,
}

impl RetainedControls {
    /// Default values of a piece of that description.
    pub(super) fn of(piece: Option<&PieceSpec>) -> RetainedControls {
        RetainedControls {
            tuning: piece.map_or(1.0, |piece| piece.instrument.tunings()[1]),
            muffling: piece.map_or(0.0, |piece| piece.defaults.muffle),
            preload: piece.and_then(|piece| piece.defaults.preload).unwrap_or(*PRELOAD.start()),
            wires: true,
            pedal: 0.0,
        }
    }
}
