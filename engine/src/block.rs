//! How time is cut: the engine's block.

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;

/// A run of silence, Pa.
pub const SILENT_RUN: [f32; BLOCK] = [0.0; BLOCK];
