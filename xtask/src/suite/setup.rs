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
    room(target)?;
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

/// What a target folder takes once everything is built, GiB: 9 were measured. And what is left free at least.
const WHOLE: f64 = 10.0;
const SPARE: f64 = 1.0;

const GIB: f64 = (1_u64 << 30) as f64;

/// Makes sure that everything can be built: a full disk fails late, and in places that do not say so.
fn room(target: &Path) -> Result<()> {
    fs::create_dir_all(target).with_context(|| format!("cannot make `{}`", target.display()))?;
    let free = fs4::available_space(target).context("cannot ask for the free space")?;
    fits(target, size(target) as f64 / GIB, free as f64 / GIB)
}

/// Whether the rest of a target folder that has `built` GiB fits into `free` GiB.
fn fits(target: &Path, built: f64, free: f64) -> Result<()> {
    let wanted = (WHOLE - built).max(SPARE);
    if free < wanted {
        bail!("missing: {wanted:.1} GiB of disk for `{}`; {free:.1} GiB are free", target.display());
    }
    Ok(())
}

/// Size of the files in a folder, bytes; what cannot be read counts as nothing.
fn size(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    let of = |entry: fs::DirEntry| match entry.metadata() {
        Ok(data) if data.is_dir() => size(&entry.path()),
        Ok(data) => data.len(),
        Err(_) => 0,
    };
    entries.flatten().map(of).sum()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_too_full_to_build_on_is_named_with_what_is_missing() {
        let target = Path::new("target");
        assert!(fits(target, 0.0, 12.0).is_ok());
        assert!(fits(target, 9.5, 1.5).is_ok());
        let error = fits(target, 4.0, 0.3).unwrap_err().to_string();
        assert_eq!(error, "missing: 6.0 GiB of disk for `target`; 0.3 GiB are free");
        assert!(fits(target, 12.0, 0.3).is_err());
    }

    #[test]
    fn a_folder_is_as_large_as_its_files() {
        let sources = workspace::root().join("xtask/src/suite");
        let own = fs::metadata(sources.join("setup.rs")).unwrap().len();
        assert!(size(&sources) > own && size(&sources.join("no such folder")) == 0);
    }
}
