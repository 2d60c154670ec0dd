//! What building an instrument depends on beside its description: sample rate, quality, receivers, what is left out.

use serde::{Deserialize, Serialize};

use crate::receiver::Receivers;

/// Highest coupled cymbal mode.
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

/// How a piece is built; what it is, its [description](crate::kit_spec::PieceSpec) says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildOptions {
    /// Sample rate, Hz, within [`SAMPLE_RATES`](crate::piece::SAMPLE_RATES).
    pub sample_rate: f64,
    /// How far up a cymbal's modes are coupled.
    pub quality: Quality,
}

impl BuildOptions {
    /// For playing at a sample rate, Hz.
    pub const fn new(sample_rate: f64) -> Self {
        BuildOptions { sample_rate, quality: Quality::Standard }
    }
}

/// What is left out of a piece: for measuring one part of the physics without the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Idealization {
    /// All damping and radiation off: energy stays.
    #[serde(default)]
    pub lossless: bool,
    /// Bending stays small: no stretch of heads, no coupling of modes.
    #[serde(default)]
    pub linear: bool,
    /// Perfectly round bodies: the two members of every pair share one frequency.
    #[serde(default)]
    pub round: bool,
}

impl Idealization {
    /// Nothing is left out: the piece as it is played.
    pub const NONE: Idealization = Idealization { lossless: false, linear: false, round: false };

    /// Whether nothing is left out.
    pub fn is_none(&self) -> bool {
        *self == Idealization::NONE
    }
}

/// All that building an instrument depends on beside its description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildContext {
    /// How it is built.
    pub options: BuildOptions,
    /// From where it is heard.
    pub receivers: Receivers,
    /// What is left out of it.
    pub ideal: Idealization,
}
