//! `test`: every check of the project, on a machine that has only Rust.
//!
//! In order: what must be installed, formatting, lints, documentation, the release bundles; then every program of tests is
//! built, and at last all are run: as many at once as there are processors (see `programs.rs` beside). Among them are the tests that
//! load the bundles into hosts, under a display of their own, the README's commands, and the real-time tests once more in
//! release. Everything runs even if something before it failed; the last line counts.
//!
//! `test --quick` is what takes minutes of that, for use between changes: formatting, lints, units, and the targets that
//! [`tiers`] calls quick. `test --ardour` is the only part that `test` leaves out: a session in Ardour.
//!
//! Two profiles are compiled, no more: dev for the tests, with the engine optimized, and release
//! for the bundles. Lints and documentation share their metadata.

pub mod display;
mod programs;
mod runner;
mod setup;
pub mod tiers;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::{bundle, workspace};
use display::Display;
use programs::{Program, Row, built};
use runner::{Tally, check, tests};
use tiers::Tier;

/// Names the command under test to the tests that run it.
pub const COMMAND_VARIABLE: &str = "OVERHEAR_XTASK";

/// Names the Python with the VST3 host to the tests that run it.
pub const PYTHON_VARIABLE: &str = "OVERHEAR_PYTHON";

/// In the name of the test of those commands of the README that only measure; the others build the bundles anew.
pub const MEASURING: &str = "measuring";

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
        tally.fail("release bundles");
    } else {
        tally.passed += 1;
    }

    let mut all = workspace::cargo();
    let all = built(&mut tally, "building the tests", all.args(["test", "--workspace"]));
    let mut traps = workspace::cargo();
    traps.arg("test").args(with_traps(tiers::of(Tier::Traps)));
    let traps = built(&mut tally, "building the tests with an allocator of their own", &mut traps);
    let mut release = workspace::cargo();
    release.args(["test", "--release"]).args(with_traps(["process", "realtime"]));
    let release = built(&mut tally, "building the real-time tests in release", &mut release);
    let mut examples = workspace::cargo();
    examples.args(["test", "--workspace", "--doc", "--no-fail-fast"]);
    tests(&mut tally, "examples in the documentation", &mut examples);

    let display = Display::start()?;
    let environment: [(&str, &Path); 4] = [
        ("DISPLAY", Path::new(display.name())),
        ("LIBGL_ALWAYS_SOFTWARE", Path::new("1")),
        (PYTHON_VARIABLE, &python),
        (COMMAND_VARIABLE, &own_path()?),
    ];
    programs::run(&mut tally, rows(&all, &traps, &release), &environment);
    drop(display);
    told(&tally)
}

/// Targets that open windows on the display. They change its settings and move its pointer, each for itself.
const ON_THE_DISPLAY: [&str; 2] = ["hosts", "program"];

/// Everything that `test` runs, what takes long first.
fn rows(all: &[Program], traps: &[Program], release: &[Program]) -> Vec<Row> {
    let named = |target: &str| all.iter().find(|program| program.target == target);
    // Hosts load the bundles, which some commands build anew.
    let mut bundles: Row = ON_THE_DISPLAY.into_iter().filter_map(named).cloned().collect();
    let mut rows = Vec::new();
    if let Some(commands) = named("commands") {
        let only = ["--ignored", "--nocapture"];
        bundles.push(commands.with("commands of the README", &[&only[..], &["--skip", MEASURING]].concat()));
        rows.push(vec![
            commands.with("commands of the README that measure", &[&only[..], &[MEASURING]].concat()),
        ]);
    }
    rows.insert(0, bundles);
    rows.extend(named("cymbals").map(|cymbals| vec![cymbals.with("long tests of cymbals", &["--ignored"])]));
    rows.extend(release.iter().map(|program| vec![program.with(&format!("{}, release", program.name), &[])]));
    let has_a_row = |program: &&Program| ON_THE_DISPLAY.contains(&&*program.target);
    let others = all.iter().filter(|program| !has_a_row(program)).chain(traps);
    rows.extend(in_order(others.cloned()));
    rows
}

/// A row for each program, those with quick tests last: a long one that began last would run alone in the end.
fn in_order(programs: impl IntoIterator<Item = Program>) -> Vec<Row> {
    let is_quick = |program: &Program| tiers::of(Tier::Quick).any(|target| target == program.target);
    let (quick, others): (Vec<_>, Vec<_>) = programs.into_iter().partition(is_quick);
    others.into_iter().chain(quick).map(|program| vec![program]).collect()
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
    quick.args(["test", "--workspace", "--lib", "--bins"]);
    for target in tiers::of(Tier::Quick) {
        quick.args(["--test", target]);
    }
    let quick = built(&mut tally, "building units and quick tests", &mut quick);
    programs::run(&mut tally, in_order(quick), &[(COMMAND_VARIABLE, &own_path()?)]);
    told(&tally)
}

/// Runs the session in Ardour.
///
/// # Errors
/// If Ardour or the bundles are missing and cannot be had, or if the session fails.
pub fn run_ardour() -> Result<()> {
    let mut tally = Tally::default();
    setup::run_for_ardour()?;
    runner::heading("release bundles");
    bundle::run()?;
    let mut session = workspace::cargo();
    session.args(["test", "--package", TESTS_PACKAGE, "--test", "hosts", "ardour"]);
    session.args(["--", "--ignored", "--nocapture"]);
    tests(&mut tally, "a session in Ardour", &mut session);
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

/// Prints the times, what failed, and the last line.
///
/// # Errors
/// If anything failed.
fn told(tally: &Tally) -> Result<()> {
    tally.print_times();
    tally.print_failures();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_program_is_left_out_and_those_that_share_something_are_in_one_row() {
        let programs = |tier| tiers::of(tier).map(Program::of).collect::<Vec<_>>();
        let all = [vec![Program::of("units")], programs(Tier::Quick), programs(Tier::Whole)].concat();
        let (traps, release) = (programs(Tier::Traps), ["process", "realtime"].map(Program::of));
        let rows = rows(&all, &traps, &release);
        let names = |row: &Row| row.iter().map(|program| program.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&rows[0]), ["hosts", "program", "commands of the README"]);
        let mut found: Vec<String> = rows.iter().flat_map(names).collect();
        let extra = [
            "commands of the README",
            "commands of the README that measure",
            "long tests of cymbals",
            "process, release",
            "realtime, release",
        ];
        let mut wanted: Vec<String> = all.iter().chain(&traps).map(|program| program.name.clone()).collect();
        wanted.extend(extra.map(str::to_owned));
        found.sort();
        wanted.sort();
        assert_eq!(found, wanted);
    }
}
