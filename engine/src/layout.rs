//! Where the pieces stand: the one table for sound and picture.
//!
//! Coordinates (m): `x` to the drummer's right, `y` up, `z` toward the audience; the origin is on the
//! floor under the middle of the kit.

use crate::piece::PieceId;

/// Where a piece is and which way its struck side faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Centre of the struck surface, m.
    pub centre: [f64; 3],
    /// Unit normal of the struck side.
    pub normal: [f64; 3],
}

impl Placement {
    /// Where the piece stands by default.
    pub fn of(id: PieceId) -> Placement {
        let (centre, normal) = match id {
            PieceId::Kick => ([0.0, 0.30, -0.23], [0.0, 0.0, -1.0]),
            PieceId::Snare => ([-0.40, 0.66, -0.40], [0.0, 0.97, -0.24]),
            PieceId::RackTom => ([-0.14, 0.88, -0.12], [0.15, 0.85, -0.5]),
            PieceId::FloorTom => ([0.47, 0.62, -0.34], [0.0, 1.0, 0.0]),
            PieceId::Crash => ([-0.64, 1.20, 0.0], [0.22, 0.95, -0.25]),
            PieceId::Ride => ([0.68, 1.06, -0.04], [-0.16, 0.96, -0.22]),
            PieceId::Splash => ([0.16, 1.22, 0.08], [0.0, 0.97, -0.25]),
            // Beyond the floor tom, a turn of the stool away.
            PieceId::Timpani => ([0.86, 0.78, -0.86], [-0.1, 0.99, -0.05]),
        };
        let length = normal.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        Placement { centre, normal: normal.map(|x| x / length) }
    }

    /// Where the piece lies in the stereo as the drummer hears it, -1 (left) to 1 (right).
    pub fn side(&self) -> f64 {
        /// Half the width of the kit, m.
        const HALF_WIDTH: f64 = 0.8;
        /// How far to the side the outermost pieces go, 0 to 1. *By ear*.
        const SPREAD: f64 = 0.7;
        (self.centre[0] / HALF_WIDTH).clamp(-1.0, 1.0) * SPREAD
    }
}
