//! The program `overhear`, built for release where its figures are those of what is installed.

use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result};

use crate::workspace;

/// Package of the command-line program, as cargo knows it.
const PACKAGE: &str = "overhear-cli";

/// The program in release, built first if need be, with nothing after its name. The first time that takes minutes, which cargo shows.
pub fn released() -> Command {
    let mut cargo = Command::new(workspace::cargo().get_program());
    cargo.args(["run", "--release"]);
    let built = |folder: PathBuf| folder.join("release").join(format!("overhear{EXE_SUFFIX}")).exists();
    if workspace::target_dir().is_ok_and(built) {
        cargo.arg("--quiet");
    }
    cargo.args(["--package", PACKAGE, "--manifest-path"]);
    cargo.arg(workspace::root().join("Cargo.toml")).arg("--");
    cargo
}

/// Runs the program in release with these arguments, in the working folder.
///
/// # Errors
/// If it cannot be built. Whatever else goes wrong it has said itself: this process ends as it did.
pub fn in_release(arguments: impl IntoIterator<Item = OsString>) -> Result<()> {
    let status = released().args(arguments).status().context("cannot run cargo")?;
    if status.success() { Ok(()) } else { std::process::exit(status.code().unwrap_or(1)) }
}
