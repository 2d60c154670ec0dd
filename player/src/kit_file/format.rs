//! What every kit file has in common.

/// Number of the format that is written and read.
pub const FORMAT: i64 = 1;

/// Largest file that is read, bytes.
pub const LARGEST: usize = 1 << 20;
