//! Requirements of the tests outside the workspace.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

use super::runner::heading;
use crate::system::{self, ARDOUR, HOST_LIBRARIES, LINKER, PYTHON, SOUND_HEADERS, WINDOW_LIBRARIES, XVFB};
use crate::workspace;

/// Packages of the tests' own Python; the environment is rebuilt when this changes.
const PYTHON_PACKAGES: [&str; 3] = ["dawdreamer>=0.8.3", "numpy", "pedalboard>=0.9.16"];

/// Sets everything up and tells where the tests' own Python is.
///
/// # Errors
/// Naming what is missing.
pub fn run(target: &Path) -> Result<PathBuf> {
    heading("set-up");
    system::ensure(&[XVFB, WINDOW_LIBRARIES, PYTHON, HOST_LIBRARIES])?;
    run_for_lints()?;
    python(&target.join("python-hosts"))
}

/// Sets up what formatting, lints and tests without hosts and windows need.
///
/// # Errors
/// Naming what is missing.
pub fn run_for_lints() -> Result<()> {
    system::ensure(&[LINKER, SOUND_HEADERS])?;
    ["fmt", "clippy"].into_iter().try_for_each(rust_component)
}

/// Sets up what the session in Ardour needs.
///
/// # Errors
/// Naming what is missing.
pub fn run_for_ardour() -> Result<()> {
    system::ensure(&[LINKER, SOUND_HEADERS, WINDOW_LIBRARIES, ARDOUR])
}

/// Makes sure that cargo has a subcommand which small installations of Rust leave out.
fn rust_component(subcommand: &str) -> Result<()> {
    let present = workspace::cargo()
        .args([subcommand, "--version"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if present {
        return Ok(());
    }
    let component = if subcommand == "fmt" { "rustfmt" } else { subcommand };
    if system::program("rustup").is_none() {
        bail!("missing: {component}, a part of Rust");
    }
    let added = Command::new("rustup")
        .args(["component", "add", component])
        .current_dir(workspace::root())
        .status()
        .context("cannot run rustup")?;
    if !added.success() {
        bail!("missing: {component}; run: rustup component add {component}");
    }
    Ok(())
}

/// Makes a Python environment of the tests' own with the VST3 host in it.
fn python(folder: &Path) -> Result<PathBuf> {
    let python = folder.join("bin/python");
    let (stamp, wanted) = (folder.join("overhear-packages"), PYTHON_PACKAGES.join("\n"));
    if python.exists() && fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(python);
    }
    eprintln!("installing {} into {}", PYTHON_PACKAGES.join(", "), folder.display());
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot renew `{}`", folder.display()))?;
    }
    let steps: [(&Path, Vec<&str>); 2] = [
        (Path::new("python3"), vec!["-m", "venv", folder.to_str().context("an odd path")?]),
        (&python, [&["-m", "pip", "install", "--quiet"], &PYTHON_PACKAGES[..]].concat()),
    ];
    for (program, arguments) in steps {
        let status = Command::new(program)
            .args(&arguments)
            .status()
            .with_context(|| format!("cannot run `{}`", program.display()))?;
        if !status.success() {
            bail!("`{} {}` failed", program.display(), arguments.join(" "));
        }
    }
    fs::write(&stamp, wanted)?;
    Ok(python)
}
