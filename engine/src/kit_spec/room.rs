//! What the room about the kit is: its walls and how long it sounds.

use serde::{Deserialize, Serialize};

use crate::error::SpecError;
use crate::fitted;
use crate::layout::{FARTHEST, Point};

/// A room's description: a shoebox.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomSpec {
    /// Its inner corners, m: the least and the greatest of each coordinate, within 20 m of the origin and 2 m apart.
    #[serde(rename = "corners_m")]
    pub corners: [Point; 2],
    /// Share of the pressure that a surface sends back, 0 to 0.99: left and right wall, floor and ceiling, the walls behind
    /// the drummer and before the kit.
    pub reflected: [[f64; 2]; 3],
    /// Reverberation time at low frequency, s, 0.05 to 5.
    #[serde(rename = "reverberation_s")]
    pub time: f64,
    /// Above this the tail fades faster, Hz, 500 to 40,000.
    pub soft_hz: f64,
}

impl RoomSpec {
    /// The standard kit's: 7 x 3 x 6 m, the kit toward one end; reflections *by ear*: carpet, treated. Its `soft_hz` is *fitted*:
    /// with 5 kHz the octave of 8 kHz of drums is gone in half the time that recordings have; a room of this size and time
    /// loses little more to its air there.
    pub const STANDARD: RoomSpec = RoomSpec {
        corners: [[-3.3, 0.0, -2.0], [3.7, 3.0, 4.0]],
        reflected: [[0.75, 0.75], [fitted::ROOM_FLOOR, 0.65], [0.7, 0.75]],
        time: 0.5,
        soft_hz: fitted::ROOM_SOFT_HZ,
    };

    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the field.
    pub fn check(&self) -> Result<(), SpecError> {
        for (low, high) in self.corners[0].iter().zip(&self.corners[1]) {
            SpecError::check("corners_m", *low, -FARTHEST, FARTHEST - 2.0)?;
            SpecError::check("corners_m", *high, low + 2.0, FARTHEST)?;
        }
        for share in self.reflected.as_flattened() {
            SpecError::check("reflected", *share, 0.0, 0.99)?;
        }
        SpecError::check("reverberation_s", self.time, 0.05, 5.0)?;
        SpecError::check("soft_hz", self.soft_hz, 500.0, 40_000.0)?;
        Ok(())
    }

    /// Lengths of its sides, m.
    fn sides(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.corners[1][axis] - self.corners[0][axis])
    }

    /// Volume, m3.
    pub fn volume(&self) -> f64 {
        self.sides().iter().product()
    }

    /// Mean free way of sound between its surfaces, m.
    pub fn mean_way(&self) -> f64 {
        let [x, y, z] = self.sides();
        4.0 * self.volume() / (2.0 * (x * y + y * z + z * x))
    }
}
