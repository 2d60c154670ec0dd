//! How a piece is built.

use super::PieceId;
use crate::damping::Muffler;
use crate::listening::ListeningPoint;
use crate::microphones;

/// How far up a cymbal's modes are coupled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Quality {
    /// To 1 kHz.
    Eco,
    /// To 2 kHz.
    #[default]
    Standard,
    /// To 4 kHz.
    High,
    /// To 8 kHz; not meant for real time.
    Offline,
}

impl Quality {
    /// Every quality, lowest first.
    pub const ALL: [Quality; 4] = [Quality::Eco, Quality::Standard, Quality::High, Quality::Offline];

    /// Highest mode of a cymbal that hard strokes couple with others, Hz.
    pub fn coupled_hz(self) -> f64 {
        match self {
            Quality::Eco => 1000.0,
            Quality::Standard => 2000.0,
            Quality::High => 4000.0,
            Quality::Offline => 8000.0,
        }
    }

    /// The name used on command lines and in presets.
    pub fn name(self) -> &'static str {
        match self {
            Quality::Eco => "eco",
            Quality::Standard => "standard",
            Quality::High => "high",
            Quality::Offline => "offline",
        }
    }

    /// The quality of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<Quality> {
        Quality::ALL.into_iter().find(|quality| quality.name() == name)
    }
}

/// How a piece is built, beyond what it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildOptions {
    /// Sample rate, Hz, 22,050 to 768,000.
    pub sample_rate: f64,
    /// All damping and radiation off: energy stays.
    pub lossless: bool,
    /// Perfectly round bodies: the two members of every pair share one frequency.
    pub unsplit: bool,
    /// Bending stays small: no stretch of heads, no coupling of modes.
    pub linear: bool,
    /// How far up a cymbal's modes are coupled.
    pub quality: Quality,
    /// Heads sound above their complete sets of modes; see [`high_band`](crate::drum::high_band).
    pub high_band: bool,
    /// Drums without what closes them: see [`DrumSpec::opened`](crate::drum::DrumSpec::opened).
    pub open: bool,
    /// Cymbals with the bell and the taper they have in the kit; else caps as thick everywhere, whose modes
    /// are known in closed form.
    pub shaped: bool,
    /// Heads wrap themselves around a stick's tip, the farther the harder the stroke, and spread its force by their
    /// stiffness; else every stroke presses on the same disc, as published contacts and glides have it. See
    /// [`patch`](crate::surface::patch).
    pub wraps: bool,
    /// Ratio of the pitches of a drum's other head and the struck one, if not its own.
    pub resonant_ratio: Option<f64>,
    /// Mean relative difference of the two members of a drum's pairs, if not its own: how uneven its tension is.
    pub unevenness: Option<f64>,
    /// What muffles a drum, if not its own.
    pub muffler: Option<Muffler>,
    /// Where the close microphone stands, if not at the piece's own listening point; see
    /// [`microphones`](crate::microphones) for where it stands in the kit.
    pub close: Option<ListeningPoint>,
}

impl BuildOptions {
    /// The piece by itself, at a sample rate in Hz.
    pub fn new(sample_rate: f64) -> Self {
        BuildOptions {
            sample_rate,
            lossless: false,
            unsplit: false,
            linear: false,
            quality: Quality::Standard,
            high_band: true,
            open: false,
            shaped: false,
            wraps: false,
            resonant_ratio: None,
            unevenness: None,
            muffler: None,
            close: None,
        }
    }

    /// The piece as it stands in the kit, at a sample rate in Hz: heard by its close microphone, cymbals with their bells,
    /// heads that wrap themselves around tips.
    pub fn in_kit(id: PieceId, sample_rate: f64) -> Self {
        let close = microphones::over_rim(id);
        BuildOptions { close, shaped: true, wraps: true, ..BuildOptions::new(sample_rate) }
    }
}
