//! `bench`: what the instrument costs.
//!
//! A cost is the CPU time a second of sound takes over the CPU time of a fixed loop (`calibration`), both cut into slices
//! that take turns: what else the machine does then hits both alike. Every run does exactly the same work, for the
//! engine is deterministic; what differs between runs is the machine, and the median and the spread say by how much.

pub mod calibration;
mod callgrind;
mod compare;
mod exchanges;
mod limit;
mod measure;
mod report;
mod request;
mod workload;

use std::sync::Arc;
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result};
use cpu_time::ProcessTime;
use overhear::building::{BuildPlan, Pace};
use overhear::cache::FolderCache;
use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear::parameters::default_value;
use overhear::performer::Performer;
use overhear_engine::kit_spec::{InstrumentSpec, Kind};
use overhear_engine::modal::simd::Kernels;
use overhear_engine::modal::simd::level::{self, InstructionSet};
use overhear_engine::piece::{Piece, Quality};
use overhear_engine::slot::SLOTS;

use crate::progress::Progress;
use crate::{bad_input, settings};
use exchanges::Exchanges;
use limit::Limit;
use measure::Cost;
use report::Report;
use workload::{Scene, Workload};

pub use callgrind::count_this;
pub use request::{Builds, RATE, Request};

/// Threads that build a kit at once, at most, as in the plugin.
const MOST_BUILDERS: usize = 4;

/// Runs if not given.
pub const RUNS: usize = 7;

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
    let document = settings::kit(request.kit.as_deref())?;
    let builds = Builds::measure(&document, request.rate)?;
    let scenes = scenes(&document, request.quality);
    let mut progress = Progress::new("bench", (scenes.len() * request.runs) as u64);
    let mut costs = Vec::new();
    let mut blocks = Vec::new();
    for scene in scenes {
        let mut workload = Workload::new(scene, &document, request.rate)?;
        let (cost, lasted) = measure::runs(&mut workload, request.runs, &mut progress);
        blocks.push((scene, lasted));
        costs.push((scene, cost));
    }
    let is_standard = document == KitDocument::standard();
    let exchanges = is_standard.then(|| Exchanges::measure(request)).transpose()?;
    let widest = Kernels::detect().name();
    let narrower = if request.simd.is_none() { narrower(request, &document)? } else { Vec::new() };
    let counts = if request.callgrind { callgrind::count(request, &document)? } else { Vec::new() };
    let report = Report::new(report::Measured {
        request,
        kit: &document.kit,
        costs,
        blocks,
        exchanges,
        builds,
        narrower,
        simd: widest,
        counts,
    });
    Ok(match before {
        Some(before) => report.beside(before),
        None => report,
    })
}

/// The kit as it plays with the narrower instruction sets of this machine.
fn narrower(request: &Request, document: &KitDocument) -> Result<Vec<(InstructionSet, Scene, Cost)>> {
    let widest = InstructionSet::ALL.into_iter().rfind(|set| set.is_available());
    let sets: Vec<_> = InstructionSet::ALL.into_iter().take_while(|&set| Some(set) != widest).collect();
    let played = |scene: &Scene| scene.is_kit();
    let scenes: Vec<_> = Scene::of_kit(document, request.quality).into_iter().filter(played).collect();
    let mut progress = Progress::new("narrower", (sets.len() * scenes.len() * request.runs) as u64);
    let mut costs = Vec::new();
    for set in sets {
        level::limit(set);
        for &scene in &scenes {
            let mut workload = Workload::new(scene, document, request.rate)?;
            costs.push((set, scene, measure::runs(&mut workload, request.runs, &mut progress).0));
        }
    }
    level::limit(InstructionSet::Avx512);
    Ok(costs)
}

/// Everything that is measured: the kit's scenes, then each piece struck by itself.
fn scenes(document: &KitDocument, quality: Quality) -> Vec<Scene> {
    let mut scenes = Scene::of_kit(document, quality);
    for (slot, piece) in document.kit.slots() {
        if piece.instrument.kind() == Kind::Drum {
            scenes.push(Scene::Piece(slot, Quality::Standard));
        } else {
            scenes.extend(Quality::ALL.map(|quality| Scene::Piece(slot, quality)));
        }
    }
    scenes
}

impl Builds {
    /// Builds kits; before anything else is built and held.
    fn measure(document: &KitDocument, rate: f64) -> Result<Builds> {
        let start = Instant::now();
        drop(Performer::new(rate, document, Arc::default()));
        let instance_s = start.elapsed().as_secs_f64();
        let ([build_cold_s, cold_cpu_s], kit) = build(document, rate)?;
        let memory =
            memory_stats::memory_stats().context("this system does not tell what memory a process holds")?;
        let ([build_warm_s, warm_cpu_s], _) = build(document, rate)?;
        let limit = Some(Limit::measure(&kit, rate));
        drop(kit);
        // As in the plugin; results of an earlier process are not used.
        let folder = std::env::temp_dir().join(format!("overhear-bench-{}", std::process::id()));
        overhear_engine::cache::provide(Box::new(FolderCache::new(&folder)));
        overhear_engine::cache::forget();
        build(document, rate)?;
        overhear_engine::cache::forget();
        let from_disk = build(document, rate);
        let reopened = reopen(&full(document), rate);
        // Files left in a temporary folder do no harm.
        let _ = std::fs::remove_dir_all(&folder);
        let ([build_from_disk_s, disk_cpu_s], _) = from_disk?;
        let reopen_16_s = reopened?;
        let memory_mb = memory.physical_mem as f64 / 1e6;
        let build_cpu_s = [cold_cpu_s, disk_cpu_s, warm_cpu_s];
        Ok(Builds {
            instance_s,
            build_cold_s,
            build_from_disk_s,
            build_warm_s,
            build_cpu_s,
            reopen_16_s,
            memory_mb,
            limit,
        })
    }
}

/// A kit that fills every slot: the pieces of this one, and further ones of their kinds, each of another size, in other places.
fn full(document: &KitDocument) -> KitDocument {
    const BEHIND: f64 = 3.0;
    let mut full = document.clone();
    let pieces = document.kit.pieces.len().max(1);
    for number in pieces..SLOTS {
        let (round, of) = (number / pieces, number % pieces);
        let Some(mut piece) = document.kit.pieces.get(of).cloned() else { break };
        let smaller = 1.0 - 0.01 * round as f64;
        match &mut piece.instrument {
            InstrumentSpec::Drum(drum) => drum.diameter *= smaller,
            InstrumentSpec::Cymbal(cymbal) => cymbal.mass *= smaller,
            InstrumentSpec::HiHat(hat) => hat.top.mass *= smaller,
        }
        piece.name = format!("further-{number}");
        piece.place.centre[2] -= BEHIND * round as f64;
        full.kit.pieces.push(piece);
    }
    full
}

/// Reads a kit from the text that a project has of it and builds it from the cache folder; how long that took, s.
fn reopen(document: &KitDocument, rate: f64) -> Result<f64> {
    let text = kit_file::write(document);
    // Whatever is not in the folder yet.
    build(document, rate)?;
    overhear_engine::cache::forget();
    let start = Instant::now();
    let document = kit_file::read("the project's kit", &text)?;
    build(&document, rate)?;
    Ok(start.elapsed().as_secs_f64())
}

/// Builds a whole kit, on as many processors as the plugin does; how long that took and what of all processors, s.
fn build(document: &KitDocument, rate: f64) -> Result<([f64; 2], Vec<Piece>)> {
    let processors = thread::available_parallelism().map_or(1, usize::from).min(MOST_BUILDERS);
    let builders = rayon::ThreadPoolBuilder::new().num_threads(processors).build();
    let builders = builders.context("the system starts no more threads")?;
    let (start, start_cpu) = (Instant::now(), ProcessTime::now());
    let usual = |index| default_value(index, &document.kit);
    let plan = BuildPlan::of(Arc::new(document.clone()), usual, Pace::RealTime);
    let kit = builders.install(|| plan.pieces_side_by_side(rate));
    let seconds = [start.elapsed(), start_cpu.elapsed()].map(|time| time.as_secs_f64());
    Ok((seconds, kit.map_err(|error| bad_input!("{error}"))?))
}
