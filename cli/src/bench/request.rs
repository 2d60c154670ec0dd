//! What is measured, and what building costs.

use std::path::PathBuf;

use overhear_engine::modal::simd::level::InstructionSet;
use overhear_engine::piece::Quality;
use serde::Serialize;

use super::limit::Limit;

/// Sample rate of everything measured, if not given, Hz.
pub const RATE: f64 = 44_100.0;

/// Request for a measurement.
#[derive(Debug, Clone)]
pub struct Request {
    /// A file of the kit; the standard kit if none is named.
    pub kit: Option<PathBuf>,
    /// Runs of everything, at least 1.
    pub runs: usize,
    /// Tier of the kit's cymbals in the groove and struck all at once.
    pub quality: Quality,
    /// Sample rate, Hz.
    pub rate: f64,
    /// The instruction set to keep to; the machine's widest if none.
    pub simd: Option<InstructionSet>,
    /// A report to set this one beside.
    pub compare: Option<PathBuf>,
    /// Count instructions, too.
    pub callgrind: bool,
}

/// Costs of building a kit.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Builds {
    /// All that makes sound of an instance, without pieces, s.
    pub instance_s: f64,
    /// Nothing is known yet, s.
    pub build_cold_s: f64,
    /// All is in the cache folder, s.
    pub build_from_disk_s: f64,
    /// All is in memory, s.
    pub build_warm_s: f64,
    /// CPU seconds of all processors for these three, in their order: what other work on the machine adds least to.
    pub build_cpu_s: [f64; 3],
    /// A kit that fills every slot, read from a project's text and built, all in the cache folder, s.
    pub reopen_16_s: f64,
    /// Memory of the process after the first, in MB.
    pub memory_mb: f64,
    /// The machine's limit, and the demand of a ringing kit.
    pub limit: Option<Limit>,
}
