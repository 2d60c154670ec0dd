//! Where the two rims of a hi-hat may touch.

/// Places around the rims where they may touch.
pub const POINTS: usize = 16;
