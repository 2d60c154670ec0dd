//! One piece of the kit: a drum or a cymbal, and what can be asked of it.

use crate::error::SpecError;
use crate::snapshot::{FieldShapes, PieceSnapshot, StrikeSnapshot};
use crate::strike::Strike;

/// Which piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PieceId {
    /// 22 x 18 in bass drum.
    Kick,
    /// 14 x 5.5 in snare drum.
    Snare,
    /// 12 x 9 in rack tom.
    RackTom,
    /// 16 x 16 in floor tom.
    FloorTom,
    /// 16 in crash cymbal.
    Crash,
    /// 20 in ride cymbal.
    Ride,
    /// 10 in splash cymbal.
    Splash,
    /// 26 in timpani; not part of the kit.
    Timpani,
}

impl PieceId {
    /// The pieces of the kit, in the order of every per-piece table.
    pub const KIT: [PieceId; 7] = [
        PieceId::Kick,
        PieceId::Snare,
        PieceId::RackTom,
        PieceId::FloorTom,
        PieceId::Crash,
        PieceId::Ride,
        PieceId::Splash,
    ];

    /// Every piece that can be built.
    pub const ALL: [PieceId; 8] = [
        PieceId::Kick,
        PieceId::Snare,
        PieceId::RackTom,
        PieceId::FloorTom,
        PieceId::Crash,
        PieceId::Ride,
        PieceId::Splash,
        PieceId::Timpani,
    ];

    /// Place in [`PieceId::KIT`], if the piece belongs to the kit.
    pub fn slot(self) -> Option<usize> {
        PieceId::KIT.iter().position(|&id| id == self)
    }

    /// The name used on command lines, in presets and on screen.
    pub fn name(self) -> &'static str {
        match self {
            PieceId::Kick => "kick",
            PieceId::Snare => "snare",
            PieceId::RackTom => "rack-tom",
            PieceId::FloorTom => "floor-tom",
            PieceId::Crash => "crash",
            PieceId::Ride => "ride",
            PieceId::Splash => "splash",
            PieceId::Timpani => "timpani",
        }
    }

    /// The piece of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<PieceId> {
        PieceId::ALL.into_iter().find(|id| id.name() == name)
    }

    /// Whether the piece is a drum (it has a pitch to tune); the others are cymbals.
    pub fn is_drum(self) -> bool {
        !matches!(self, PieceId::Crash | PieceId::Ride | PieceId::Splash)
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
}

impl BuildOptions {
    /// The instrument as it is played.
    pub fn new(sample_rate: f64) -> Self {
        BuildOptions { sample_rate, lossless: false, unsplit: false }
    }
}

/// What kind of mode a row of [`Piece::modes`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeKind {
    /// A mode of the surface itself.
    Complete,
    /// One mode that stands for a slice of many.
    Sampled,
    /// A mode of the enclosed air.
    Cavity,
    /// The body moving as a whole on its stand.
    Rigid,
}

/// Which of the two modes of one order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// Shape proportional to `cos(m theta)`; the only one for `m = 0`.
    Cosine,
    /// Shape proportional to `sin(m theta)`.
    Sine,
}

/// One mode of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeInfo {
    /// What vibrates: `batter`, `plate`, `stand`, ...
    pub body: &'static str,
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles; a membrane's rim counts, a plate's does not.
    pub n: u32,
    /// Member of the pair.
    pub member: Member,
    /// Damped frequency, Hz.
    pub frequency_hz: f64,
    /// Time to decay by 60 dB, s; infinite without losses.
    pub t60: f64,
    /// Modal mass with the air it carries, kg.
    pub modal_mass: f64,
    /// Radiated weight: far-field volume acceleration per modal acceleration, m2.
    pub radiation: f64,
    /// Kind of mode.
    pub kind: ModeKind,
}

/// A built piece that can be struck and heard.
pub struct Piece {
    id: PieceId,
}

impl Piece {
    /// Builds the default piece of that name. Allocates and takes up to a second.
    ///
    /// # Errors
    /// [`SpecError`] if the options are out of range.
    pub fn new(id: PieceId, options: &BuildOptions) -> Result<Piece, SpecError> {
        SpecError::check("sample rate (Hz)", options.sample_rate, 22_050.0, 768_000.0)?;
        Ok(Piece { id })
    }

    /// Which piece this is.
    pub fn id(&self) -> PieceId {
        self.id
    }

    /// Range and default of [`set_tuning`](Self::set_tuning): Hz for drums, ratio for cymbals.
    pub fn tuning_range(id: PieceId) -> (f64, f64, f64) {
        match id {
            PieceId::Kick => (35.0, 55.0, 90.0),
            PieceId::Snare => (140.0, 220.0, 360.0),
            PieceId::RackTom => (90.0, 140.0, 260.0),
            PieceId::FloorTom => (55.0, 82.0, 160.0),
            PieceId::Timpani => (87.3, 130.8, 196.0),
            PieceId::Crash | PieceId::Ride | PieceId::Splash => (0.5, 1.0, 2.0),
        }
    }

    /// Asks for a pitch: of the named mode of a drum, Hz; of a cymbal, a ratio to its own.
    ///
    /// Acts while it rings, gliding over a few milliseconds; clamped to the range.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_tuning(&mut self, _tuning: f64) {}

    /// Asks for muffling, 0 (none) to 1 (all there is). Acts while it rings.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_muffling(&mut self, _amount: f64) {}

    /// Strikes at the next sample.
    ///
    /// # Real-time
    /// No allocation, no lock; cost is linear in the number of modes.
    pub fn strike(&mut self, _strike: &Strike) {}

    /// Renders up to [`BLOCK`](crate::kit::BLOCK) samples of sound pressure at the piece's
    /// listening point, Pa, overwriting `out`.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, out: &mut [f32]) {
        out.fill(0.0);
    }

    /// Puts the piece to rest.
    pub fn reset(&mut self) {}

    /// What the latest stroke's contact measured.
    pub fn last_strike(&self) -> StrikeSnapshot {
        StrikeSnapshot::default()
    }

    /// Vibration energy of the piece itself, J.
    pub fn energy(&self) -> f64 {
        0.0
    }

    /// Kinetic energy of the strikers about and energy held in their contacts, J.
    pub fn striker_energy(&self) -> f64 {
        0.0
    }

    /// Every mode with the present tuning and muffling, by body, then frequency. Allocates.
    pub fn modes(&self) -> Vec<ModeInfo> {
        Vec::new()
    }

    /// Tension of each stretched body, N/m: `("batter", 2729.0)`. Empty for cymbals. Allocates.
    pub fn tensions(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Mode shapes for the displacement field. Allocates.
    pub fn field_shapes(&self) -> FieldShapes {
        let points = FieldShapes::grid();
        let shapes = vec![[0.0; crate::snapshot::FIELD_MODES]; points.len()];
        FieldShapes { points, shapes }
    }

    /// Fills in what is known of the piece but for its peak, which the mix measures.
    pub fn snapshot(&self, into: &mut PieceSnapshot) {
        into.ready = true;
    }
}
