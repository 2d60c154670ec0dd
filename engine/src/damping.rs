//! Loss laws: how fast a mode of a material decays by itself, and what is laid on it to muffle it.
//!
//! Decay rates `sigma` are of the amplitude, 1/s: T60 = 6.9078 / sigma.

/// Losses inside a material, `sigma = constant + per_khz * f / 1 kHz`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossLaw {
    /// Decay rate at low frequency, 1/s.
    pub constant: f64,
    /// Growth of the decay rate with frequency, 1/s per kHz.
    pub per_khz: f64,
}

impl LossLaw {
    /// Single-ply 0.19 mm polyester film. *Measured* (literature value for drum heads).
    pub const SINGLE_PLY: LossLaw = LossLaw { constant: 1.2, per_khz: 2.0 };
    /// Cast bronze. *Literature*.
    pub const BRONZE: LossLaw = LossLaw { constant: 0.5, per_khz: 0.7 };
    /// Nothing is lost.
    pub const NONE: LossLaw = LossLaw { constant: 0.0, per_khz: 0.0 };

    /// Decay rate of a mode at `omega` rad/s, 1/s.
    pub fn sigma(&self, omega: f64) -> f64 {
        self.constant + self.per_khz * omega / (std::f64::consts::TAU * 1000.0)
    }
}

/// Something soft laid on a surface, that takes energy where it lies.
///
/// All act live, by their amount. A dashpot at a place damps a mode in proportion to its shape squared there; a pillow that
/// touches the whole head damps all modes alike, and those more whose air has to get past it: when both heads
/// move the same way, what is between them goes to and fro through the pillow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Muffler {
    /// A pillow against the whole head.
    Pillow {
        /// Decay rate added to every mode at full amount, 1/s.
        sigma: f64,
        /// Decay rate added at full amount to a motion of nothing but the air along the drum, 1/s.
        flow: f64,
    },
    /// A piece of gel or tape at a place.
    Gel {
        /// Decay rate added to a mode of unit squared shape there at full amount, 1/s.
        sigma: f64,
        /// Distance from the centre, share of the radius.
        radius: f64,
        /// Direction, rad.
        angle: f64,
    },
    /// A ring of film or foam along the rim.
    Ring {
        /// Decay rate added to a mode of unit mean square under it at full amount, 1/s.
        sigma: f64,
        /// Where it begins, share of the radius; it ends at the rim.
        inner: f64,
    },
}

impl Muffler {
    /// A gel pad as drummers place it, near the rim. *By ear*.
    pub const GEL: Muffler = Muffler::Gel { sigma: 30.0, radius: 0.8, angle: 2.3 };
    /// A ring as they are sold, an inch and a half wide on a 14 in head. *By ear*.
    pub const RING: Muffler = Muffler::Ring { sigma: 60.0, inner: 0.79 };
}

/// Amplitude decay rate of a given time to fall by 60 dB, and the reverse: `sigma * t60 = ln 1000`.
pub const SIGMA_T60: f64 = 6.907_755_278_982_137;
