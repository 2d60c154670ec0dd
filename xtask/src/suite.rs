//! `test`: every check of the project, on a machine that has only Rust.
//!
//! In order: what must be installed, formatting, lints, documentation, the release bundles, every
//! test of the workspace (those that load the bundles into hosts included, under a display of
//! their own), the README's commands, and the real-time tests once more in release. Everything runs even if something
//! before it failed; the last line counts.
//!
//! `test --quick` is what takes minutes of that, for use between changes: formatting, lints, units, and the targets that
//! [`tiers`] calls quick.
//!
//! Two profiles are compiled, no more: dev for the tests, with the engine optimized, and release
//! for the bundles. Lints and documentation share their metadata.

pub mod display;
mod runner;
mod setup;
pub mod tiers;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::{bundle, workspace};
use display::Display;
use runner::{Tally, check, tests};
use tiers::Tier;

/// Names the command under test to the tests that run it.
pub const COMMAND_VARIABLE: &str = "OVERHEAR_XTASK";

/// Names the Python with the VST3 host to the tests that run it.
pub const PYTHON_VARIABLE: &str = "OVERHEAR_PYTHON";

/// The package of the integration tests, as cargo knows it.
const TESTS_PACKAGE: &str = "overhear-tests";

/// Runs everything.
///
/// # Errors
/// If the machine cannot be set up, or if anything failed.
pub fn run() -> Result<()> {
    let mut tally = Tally::default();
    let target = workspace::target_dir()?;
    let python = setup::run(&target)?;
    lints(&mut tally);
    let mut doc = workspace::cargo();
    doc.args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
    check(&mut tally, "documentation", &mut doc);

    runner::heading("release bundles");
    if let Err(error) = bundle::run() {
        eprintln!("{error:#}");
        tally.failed += 1;
    } else {
        tally.passed += 1;
    }

    let display = Display::start()?;
    let mut all = workspace::cargo();
    all.args(["test", "--workspace", "--no-fail-fast"])
        .env("DISPLAY", display.name())
        .env("LIBGL_ALWAYS_SOFTWARE", "1")
        .env(PYTHON_VARIABLE, &python)
        .env(COMMAND_VARIABLE, own_path()?);
    tests(&mut tally, "tests", &mut all);
    let mut long = workspace::cargo();
    long.args(["test", "--package", TESTS_PACKAGE, "--test", "cymbals", "--", "--ignored"]);
    tests(&mut tally, "long tests of cymbals", &mut long);
    let mut readme = workspace::cargo();
    readme
        .args(["test", "--package", TESTS_PACKAGE, "--test", "commands", "--", "--ignored", "--nocapture"])
        .env(COMMAND_VARIABLE, own_path()?);
    tests(&mut tally, "commands of the README", &mut readme);
    let mut process = workspace::cargo();
    process.arg("test").args(with_traps(tiers::of(Tier::Traps)));
    tests(&mut tally, "tests with an allocator of their own", &mut process);
    let mut release = workspace::cargo();
    release.args(["test", "--release"]).args(with_traps(["process", "realtime"]));
    tests(&mut tally, "real-time tests in release", &mut release);
    drop(display);
    told(&tally)
}

/// Runs what takes minutes.
///
/// # Errors
/// If the machine cannot be set up, or if anything failed.
pub fn run_quick() -> Result<()> {
    let mut tally = Tally::default();
    setup::run_for_lints()?;
    lints(&mut tally);
    let mut quick = workspace::cargo();
    quick.args(["test", "--workspace", "--no-fail-fast", "--lib", "--bins"]);
    for target in tiers::of(Tier::Quick) {
        quick.args(["--test", target]);
    }
    tests(&mut tally, "units and quick tests", quick.env(COMMAND_VARIABLE, own_path()?));
    told(&tally)
}

/// Formatting and lints.
fn lints(tally: &mut Tally) {
    let mut fmt = workspace::cargo();
    check(tally, "formatting", fmt.args(["fmt", "--all", "--check"]));
    let mut clippy = workspace::cargo();
    clippy.args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]);
    check(tally, "lints", &mut clippy);
    let mut clippy = workspace::cargo();
    clippy.arg("clippy").args(with_traps(tiers::of(Tier::Traps))).args(["--", "-D", "warnings"]);
    check(tally, "lints of tests with an allocator of their own", &mut clippy);
}

/// What names integration tests with an allocator of their own. They are built by themselves: that allocator and the
/// framework's exclude each other.
fn with_traps<'a>(targets: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut arguments = vec!["--package", TESTS_PACKAGE, "--features", "traps"];
    arguments.extend(targets.into_iter().flat_map(|target| ["--test", target]));
    arguments
}

/// Prints the times and the last line.
///
/// # Errors
/// If anything failed.
fn told(tally: &Tally) -> Result<()> {
    tally.print_times();
    println!("{tally}");
    if tally.failed > 0 {
        bail!("{} failed", tally.failed);
    }
    Ok(())
}

/// This very command.
fn own_path() -> Result<PathBuf> {
    let path = std::env::current_exe()?;
    // Cargo may replace the file while it runs, which Linux then calls deleted.
    let text = path.to_string_lossy();
    Ok(Path::new(text.trim_end_matches(" (deleted)")).to_path_buf())
}
