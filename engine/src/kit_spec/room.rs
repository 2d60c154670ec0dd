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
    /// Reverberation time, s, 0.05 to 5: of the octaves whose factor is 1.
    #[serde(rename = "reverberation_s")]
    pub time: f64,
    /// How much longer or shorter each of the [octaves](OCTAVE_HZ) lasts, factors, 0.1 to 4.
    pub octaves: [f64; OCTAVES],
}

/// Octaves in which a room's reverberation is described, and their middles, Hz.
pub const OCTAVES: usize = 9;
/// See [`OCTAVES`].
pub const OCTAVE_HZ: [f64; OCTAVES] = [62.5, 125.0, 250.0, 500.0, 1e3, 2e3, 4e3, 8e3, 16e3];

impl RoomSpec {
    /// The standard kit's: 7 x 3 x 6 m, the kit toward one end; reflections *by ear*: carpet, treated. Its time is
    /// *literature*: studios for popular music have 0.4 to 0.7 s, rooms for drums 0.2 to 0.5 s, small ones the shorter times, within
    /// 10 % the same in all octaves but for a slight rise in the bass (Audio Engineering: Know It All, Newnes 2009, p. 855; EBU Tech. 3276,
    /// 1998: 0.27 s for listening in a room of this volume). The factors are *derived*: surfaces as absorbent in all octaves from
    /// 250 Hz on, which last a tenth longer at 125 Hz and three tenths at 63 Hz, and air of 20 degrees and 50 % humidity
    /// (ISO 9613-1: 9.9, 30, 105 and 365 dB/km from 2 kHz on): `1 / T = 1 / T_surfaces + c alpha / 60`.
    pub const STANDARD: RoomSpec = RoomSpec {
        corners: [[-3.3, 0.0, -2.0], [3.7, 3.0, 4.0]],
        reflected: [[0.75, 0.75], [fitted::ROOM_FLOOR, 0.65], [0.7, 0.75]],
        time: 0.4,
        octaves: [1.3, 1.1, 1.0, 0.99, 0.99, 0.98, 0.94, 0.81, 0.55],
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
        for factor in &self.octaves {
            SpecError::check("octaves", *factor, 0.1, 4.0)?;
        }
        Ok(())
    }

    /// Reverberation time of each octave, s.
    pub fn times(&self) -> [f64; OCTAVES] {
        self.octaves.map(|factor| factor * self.time)
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
