//! Fixed-size plain data for whoever draws: what the editor may know of the engine.

use crate::piece::PieceId;

/// Lowest modes of a piece whose displacement is published.
pub const FIELD_MODES: usize = 32;

/// Points of the displacement field: the centre and 6 rings of 24 spokes.
pub const FIELD_POINTS: usize = 1 + 6 * 24;

/// What a stroke's contact measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrikeSnapshot {
    /// Strokes on this piece so far; a change means that the rest is about a new one.
    pub count: u32,
    /// Speed asked for, m/s.
    pub speed: f32,
    /// Place, share of the radius.
    pub radius: f32,
    /// Direction, rad.
    pub angle: f32,
    /// Time from the first touch to the last, s; grows while the tip still touches.
    pub contact_time: f32,
    /// Largest force so far, N.
    pub peak_force: f32,
    /// Force integrated over time, N s.
    pub impulse: f32,
    /// Speed away from the surface after the last touch, m/s.
    pub leaving_speed: f32,
    /// Separate touches.
    pub touches: u32,
}

/// What snare wires have done since the latest stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WireSnapshot {
    /// Landings of all groups.
    pub landings: u32,
    /// Groups off the head now.
    pub aloft: u32,
    /// When a group last lifted off, s after the stroke; 0 if none has.
    pub last_lift: f32,
}

/// What a hi-hat's rims have done since the latest stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RimSnapshot {
    /// Landings of all places on each other.
    pub landings: u32,
    /// Places apart now.
    pub apart: u32,
    /// When a place last lifted off, s after the stroke; 0 if none has.
    pub last_lift: f32,
    /// Force that clamps them together at rest, N.
    pub clamped: f32,
}

/// One piece, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceSnapshot {
    /// Whether the piece has been built and plays.
    pub ready: bool,
    /// Peak of the piece's share of the mix since the last snapshot, full scale 1.
    pub peak: f32,
    /// Vibration energy, J.
    pub energy: f32,
    /// Displacement of the lowest modes, m; see [`FieldShapes`] for their shapes.
    pub displacement: [f32; FIELD_MODES],
    /// The latest stroke.
    pub strike: StrikeSnapshot,
    /// Its snare wires.
    pub wires: WireSnapshot,
    /// Its rims, of a hi-hat.
    pub rims: RimSnapshot,
    /// Times the piece was put back to rest because a value was not finite.
    pub quarantines: u32,
    /// Strikers taken away early, to make room for others: in rolls denser than four at a time.
    pub hurried_strikers: u32,
}

impl Default for PieceSnapshot {
    fn default() -> Self {
        PieceSnapshot {
            ready: false,
            peak: 0.0,
            energy: 0.0,
            displacement: [0.0; FIELD_MODES],
            strike: StrikeSnapshot::default(),
            wires: WireSnapshot::default(),
            rims: RimSnapshot::default(),
            quarantines: 0,
            hurried_strikers: 0,
        }
    }
}

/// The kit, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KitSnapshot {
    /// Samples rendered since construction or reset.
    pub clock: u64,
    /// Pieces in the order of [`PieceId::KIT`].
    pub pieces: [PieceSnapshot; PieceId::KIT.len()],
    /// Peak of the two outputs since the last snapshot, full scale 1.
    pub peak: [f32; 2],
    /// Strokes that came before their piece was built.
    pub dropped_strikes: u32,
    /// Runs in which a piece was silent because whoever renders it had not brought it back.
    pub missed_runs: u32,
    /// Samples that the safety clip has bent.
    pub clipped_samples: u64,
    /// Buffers that were ready too late. Filled in by whoever has a clock; the engine has none.
    pub late_buffers: u64,
}

/// Shapes of a piece's lowest modes at the points of its displacement field.
///
/// Computed where the piece is built and handed to whoever draws: the displacement at point `i`
/// is the dot product of `shapes[i]` and [`PieceSnapshot::displacement`].
#[derive(Debug, Clone, PartialEq)]
pub struct FieldShapes {
    /// `[point]`: place on the unit disc, x to the right and y away from the player.
    pub points: Vec<[f32; 2]>,
    /// `[point][mode]`: mode shape, of unit mean square over the surface.
    pub shapes: Vec<[f32; FIELD_MODES]>,
}

impl FieldShapes {
    /// The points: centre first, then ring by ring from the inside, spoke by spoke.
    pub fn grid() -> Vec<[f32; 2]> {
        let mut points = vec![[0.0, 0.0]];
        for ring in 1..=6 {
            for spoke in 0..24 {
                let (sin, cos) = (spoke as f32 * std::f32::consts::TAU / 24.0).sin_cos();
                let radius = ring as f32 / 6.0;
                points.push([radius * cos, radius * sin]);
            }
        }
        points
    }
}
