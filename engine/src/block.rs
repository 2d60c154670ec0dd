//! How time is cut: the engine's block.

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;
