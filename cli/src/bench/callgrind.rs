//! Instructions executed, counted by `valgrind --tool=callgrind`: what no other work on the machine can change.
//!
//! Each scene is played once, at 44.1 kHz, by a process of its own under callgrind, which knows AVX2 at most. Only what happens
//! inside [`Workload::block`] counts.

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result};
use overhear::kit_document::KitDocument;
use overhear_engine::modal::simd::level::{self, InstructionSet};
use overhear_engine::piece::Quality;

use super::request::{RATE, Request};
use super::workload::{Scene, Workload};
use crate::progress::Progress;
use crate::{bad_input, settings};

/// The function counted, as callgrind sees its name.
const COUNTED: &str = "*bench::workload::Workload::block*";

/// Instructions per second of sound of a scene.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Count {
    /// Name of the scene or piece.
    pub name: String,
    /// Instructions for a second of sound, 1/s.
    pub instructions_per_s: f64,
}

/// The scenes counted: those of the kit, and every piece at the standard tier.
fn scenes(document: &KitDocument, quality: Quality) -> Vec<Scene> {
    let pieces = document.kit.slots().map(|(slot, _)| Scene::Piece(slot, Quality::Standard));
    Scene::of_kit(document, quality).into_iter().chain(pieces).collect()
}

/// Counts every scene.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if `valgrind` is not installed; any other if it fails.
pub fn count(request: &Request, document: &KitDocument) -> Result<Vec<Count>> {
    let scenes = scenes(document, request.quality);
    let mut progress = Progress::new("callgrind", scenes.len() as u64);
    let set = request.simd.unwrap_or(InstructionSet::Avx2).min(InstructionSet::Avx2);
    let mut counts = Vec::new();
    for (index, scene) in scenes.into_iter().enumerate() {
        let output = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(format!("--toggle-collect={COUNTED}"))
            .arg(std::env::current_exe().context("the path of this program")?)
            .args(["bench-scene", &index.to_string(), request.quality.name(), set.name()])
            .args(request.kit.iter())
            .stdout(Stdio::null())
            .output()
            .map_err(|error| {
                bad_input!("--callgrind needs valgrind ({error}); on Debian: apt install valgrind")
            })?;
        let said = String::from_utf8_lossy(&output.stderr);
        let collected = said.lines().find_map(|line| line.split_once("Collected : "));
        let instructions: f64 = collected
            .and_then(|(_, number)| number.trim().parse().ok())
            .with_context(|| format!("valgrind counted nothing: {}", said.trim()))?;
        counts.push(Count {
            name: scene.name(&document.kit),
            instructions_per_s: instructions / scene.seconds(),
        });
        progress.advance(1);
    }
    Ok(counts)
}

/// What runs under callgrind: plays the scene of that number once, of the standard kit or that of a file.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if there is none, or it cannot be built.
pub fn count_this(index: usize, quality: Quality, set: InstructionSet, kit: Option<&Path>) -> Result<()> {
    level::limit(set);
    let document = settings::kit(kit)?;
    let scenes = scenes(&document, quality);
    let scene = *scenes.get(index).ok_or_else(|| bad_input!("there is no scene {index}"))?;
    let mut workload = Workload::new(scene, &document, RATE)?;
    for _ in 0..workload.blocks() {
        workload.block();
    }
    Ok(())
}
