//! `test`: every check of the project, on a machine that has only Rust.
//!
//! In order: what must be installed, formatting, lints, documentation, the release bundles, every
//! test of the workspace (those that load the bundles into hosts included, under a display of
//! their own), the README's commands, and the real-time tests once more in release. Everything runs even if something
//! before it failed; the last line counts.
//!
//! Two profiles are compiled, no more: dev for the tests, with the engine optimized, and release
//! for the bundles. Lints and documentation share their metadata.

pub mod display;
mod runner;
mod setup;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::{bundle, workspace};
use display::Display;
use runner::{Tally, check, tests};

/// Names the command under test to the tests that run it.
pub const COMMAND_VARIABLE: &str = "OVERHEAR_XTASK";

/// Names the Python with the VST3 host to the tests that run it.
pub const PYTHON_VARIABLE: &str = "OVERHEAR_PYTHON";

/// Runs everything.
///
/// # Errors
/// If the machine cannot be set up, or if anything failed.
pub fn run() -> Result<()> {
    let mut tally = Tally::default();
    let target = workspace::target_dir()?;
    let python = setup::run(&target)?;

    let mut fmt = workspace::cargo();
    check(&mut tally, "formatting", fmt.args(["fmt", "--all", "--check"]));
    let mut clippy = workspace::cargo();
    clippy.args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]);
    check(&mut tally, "lints", &mut clippy);
    // By themselves: their allocator and the framework's exclude each other.
    let traps = [
        "--package",
        "overhear-tests",
        "--features",
        "traps",
        "--test",
        "process",
        "--test",
        "fuzz",
        "--test",
        "realtime",
    ];
    let mut clippy = workspace::cargo();
    clippy.arg("clippy").args(traps).args(["--", "-D", "warnings"]);
    check(&mut tally, "lints of real-time tests", &mut clippy);
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
    long.args(["test", "--package", "overhear-tests", "--test", "cymbals", "--", "--ignored"]);
    tests(&mut tally, "long tests of cymbals", &mut long);
    let mut readme = workspace::cargo();
    readme
        .args(["test", "--package", "overhear-tests", "--test", "commands", "--", "--ignored", "--nocapture"])
        .env(COMMAND_VARIABLE, own_path()?);
    tests(&mut tally, "commands of the README", &mut readme);
    let mut process = workspace::cargo();
    tests(&mut tally, "real-time tests of process", process.arg("test").args(traps));
    let mut release = workspace::cargo();
    release.args(["test", "--release", "--package", "overhear-tests", "--features", "traps"]);
    release.args(["--test", "process", "--test", "realtime"]);
    tests(&mut tally, "real-time tests in release", &mut release);
    drop(display);

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
/// x
pub fn run_quick() -> Result<()> {
    run()
}
