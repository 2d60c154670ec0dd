//! `cargo xtask bench`: what the instrument costs.
//!
//! A cost is the CPU time a second of sound takes over the CPU time of a fixed loop (`calibration`), both cut into slices
//! that take turns: what else the machine does then hits both alike. Every run does exactly the same work, for the
//! engine is deterministic; what differs between runs is the machine, and the median and the spread say by how much.

mod calibration;
mod callgrind;
mod compare;
mod measure;
mod report;
mod workload;

use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result};
use overhear_engine::modal::simd::Kernels;
use overhear_engine::modal::simd::level::{self, InstructionSet};
use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};

use crate::bad_input;
use crate::progress::Progress;
use crate::workspace;
use measure::Blocks;
use report::Report;
use workload::{Scene, Workload};

pub use callgrind::count_this;

/// Sample rate of everything measured, Hz.
pub const RATE: f64 = 44_100.0;

/// Threads that build a kit at once, at most, as in the plugin.
const MOST_BUILDERS: usize = 4;

/// Runs if not given.
pub const RUNS: usize = 7;

/// What to measure.
#[derive(Debug, Clone)]
pub struct Request {
    /// Runs of everything, at least 1.
    pub runs: usize,
    /// Tier of the kit's cymbals in the groove and struck all at once.
    pub quality: Quality,
    /// The instruction set to keep to; the machine's widest if none.
    pub simd: Option<InstructionSet>,
    /// A report to set this one beside.
    pub compare: Option<PathBuf>,
    /// Count instructions, too.
    pub callgrind: bool,
}

/// Measures everything.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the machine has not the instruction set, a piece cannot be built, the
/// report to compare with is none, or `valgrind` is asked for and missing.
pub fn run(request: &Request) -> Result<Report> {
    if let Some(set) = request.simd {
        if !set.is_available() {
            let available = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
            let names = available.map(InstructionSet::name).collect::<Vec<_>>().join(", ");
            return Err(bad_input!("this machine has no {}, accepted: {names}", set.name()));
        }
        level::limit(set);
    }
    let before = request.compare.as_deref().map(compare::read).transpose()?;
    // Before anything else is built and held.
    let (build_cold_s, memory_mb) = build()?;
    let (build_warm_s, _) = build()?;
    let scenes = scenes(request.quality);
    let mut progress = Progress::new("bench", (scenes.len() * request.runs) as u64);
    let mut costs = Vec::new();
    let mut blocks = Vec::new();
    for scene in scenes {
        let mut workload = Workload::new(&scene)?;
        let (cost, lasted) = measure::runs(&mut workload, request.runs, &mut progress);
        blocks.extend(scene.is_kit().then_some(lasted));
        costs.push((scene, cost));
    }
    let counts = if request.callgrind { callgrind::count(request)? } else { Vec::new() };
    let report = Report::new(report::Measured {
        request,
        costs,
        blocks: Blocks::together(blocks),
        build_cold_s,
        build_warm_s,
        memory_mb,
        simd: Kernels::detect().name(),
        counts,
    });
    Ok(match before {
        Some(before) => report.beside(before),
        None => report,
    })
}

/// Builds this program for release and has that measure, with the same arguments.
///
/// What a development build measures is not what is installed, least of all its calibration loop.
///
/// # Errors
/// If it cannot be built. Whatever else goes wrong it has said itself: this process ends as it did.
pub fn as_released() -> Result<()> {
    let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["run", "--release", "--quiet", "--package", "xtask", "--manifest-path"])
        .arg(workspace::root().join("Cargo.toml"))
        .arg("--")
        .args(std::env::args_os().skip(1))
        .status()
        .context("cannot run cargo")?;
    if status.success() { Ok(()) } else { std::process::exit(status.code().unwrap_or(1)) }
}

/// Everything that is measured: the kit's scenes, then each piece struck by itself.
fn scenes(quality: Quality) -> Vec<Scene> {
    let mut scenes = vec![Scene::Groove(quality), Scene::AllAtOnce(quality), Scene::Idle];
    for piece in PieceId::KIT {
        if piece.is_drum() {
            scenes.push(Scene::Piece(piece, Quality::Standard));
        } else {
            scenes.extend(Quality::ALL.map(|quality| Scene::Piece(piece, quality)));
        }
    }
    scenes
}

/// Builds a whole kit, on as many processors as the plugin does; how long that took, s, and what
/// the process then holds, MB.
fn build() -> Result<(f64, f64)> {
    let processors = thread::available_parallelism().map_or(1, usize::from).min(MOST_BUILDERS);
    let taken = AtomicUsize::new(0);
    let start = Instant::now();
    let kit: Vec<_> = thread::scope(|scope| {
        let work = || {
            let next = || PieceId::LONGEST_FIRST.get(taken.fetch_add(1, Ordering::Relaxed));
            let pieces = std::iter::from_fn(|| Some(Piece::new(*next()?, &options(Quality::Standard))));
            pieces.collect::<Vec<_>>()
        };
        let builders: Vec<_> = (0..processors).map(|_| scope.spawn(work)).collect();
        // One that panics has said so.
        builders.into_iter().flat_map(|builder| builder.join().unwrap_or_default()).collect()
    });
    let seconds = start.elapsed().as_secs_f64();
    let memory =
        memory_stats::memory_stats().context("this system does not tell what memory a process holds")?;
    for piece in kit {
        piece.map_err(|error| bad_input!("{error}"))?;
    }
    Ok((seconds, memory.physical_mem as f64 / 1e6))
}

/// How a piece or a kit is built for a scene.
fn options(quality: Quality) -> BuildOptions {
    BuildOptions { quality, ..BuildOptions::new(RATE) }
}
