//! What full scale is.

/// Sound pressure of full scale before the levels, Pa.
pub const FULL_SCALE: f32 = 20.0;
