//! `bundle` and `install`: release bundles, and a copy of them where hosts look.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use overhear_cli::bad_input;
use overhear_cli::plugin_folders::user_folder;

use crate::system::{self, LINKER, SOUND_HEADERS};
use crate::workspace::{self, Format, PLUGIN_PACKAGE, STANDALONE_PACKAGE};

/// Which processors a bundle is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Processors {
    /// Those of this machine.
    Own,
    /// Both kinds that macOS runs on, in one file.
    Universal,
}

/// Cargo's names of the two kinds of processors that macOS runs on.
const MACOS: [&str; 2] = ["x86_64-apple-darwin", "aarch64-apple-darwin"];

impl Processors {
    /// What cargo is to build for, one build each; nothing for the machine itself.
    fn targets(self) -> Result<&'static [&'static str]> {
        match self {
            Processors::Own => Ok(&[]),
            Processors::Universal if cfg!(target_os = "macos") => Ok(&MACOS),
            Processors::Universal => Err(bad_input!("--universal is for macOS only")),
        }
    }
}

/// Builds the plugin in release for this machine and bundles it; tells where each format's bundle lies.
///
/// # Errors
/// If something to build with is missing or the build fails.
pub fn run() -> Result<Vec<(Format, PathBuf)>> {
    run_for(Processors::Own)
}

/// The same for chosen processors.
///
/// # Errors
/// As [`run`], and [`BadInput`](overhear_cli::error::BadInput) for a universal bundle elsewhere than on macOS.
pub fn run_for(processors: Processors) -> Result<Vec<(Format, PathBuf)>> {
    let targets = processors.targets()?;
    system::ensure(&[LINKER])?;
    let target = workspace::target_dir()?;
    // Files of an earlier build must not be taken for the result of this one.
    for format in Format::ALL {
        remove(&workspace::bundle_in(&target, format))?;
    }
    let packages = [PLUGIN_PACKAGE.to_owned()];
    let arguments = ["--release".to_owned()];
    // The bundler looks for its files in the working folder.
    in_folder(&workspace::root(), || {
        if targets.is_empty() {
            nice_plug_xtask::build(&packages, &arguments)?;
        }
        for target in targets {
            nice_plug_xtask::build(&packages, &[&arguments[..], &[format!("--target={target}")]].concat())?;
        }
        nice_plug_xtask::bundle(&target, PLUGIN_PACKAGE, &arguments, processors == Processors::Universal)
    })
    .context("bundling")?;
    Format::ALL
        .into_iter()
        .map(|format| {
            let path = workspace::bundle_in(&target, format);
            if !path.exists() {
                bail!("the build made no `{}`", path.display());
            }
            Ok((format, path))
        })
        .collect()
}

/// Builds the program that needs no host, in release, beside the bundles; tells where it lies.
///
/// # Errors
/// As [`run_for`].
pub fn standalone(processors: Processors) -> Result<PathBuf> {
    let targets = processors.targets()?;
    system::ensure(&[LINKER, SOUND_HEADERS])?;
    let target = workspace::target_dir()?;
    let mut cargo = workspace::cargo();
    cargo.args(["build", "--release", "--package", STANDALONE_PACKAGE]);
    for target in targets {
        cargo.args(["--target", target]);
    }
    if !cargo.status().context("cannot run cargo")?.success() {
        bail!("`{STANDALONE_PACKAGE}` does not build");
    }
    let program = format!("{STANDALONE_PACKAGE}{}", env::consts::EXE_SUFFIX);
    let folder = target.join("bundled");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
    let path = folder.join(&program);
    remove(&path)?;
    if targets.is_empty() {
        fs::copy(target.join("release").join(&program), &path)
            .with_context(|| format!("cannot write `{}`", path.display()))?;
        return Ok(path);
    }
    let built = targets.iter().map(|name| target.join(name).join("release").join(&program));
    let joined = Command::new("lipo").arg("-create").arg("-output").arg(&path).args(built).status();
    if !joined.context("cannot run lipo")?.success() {
        bail!("`lipo` makes no `{}`", path.display());
    }
    Ok(path)
}

/// Bundles and copies the bundles to the user's plugin folders; tells where they went.
///
/// # Errors
/// As [`run`], and if a folder cannot be written.
pub fn install() -> Result<Vec<PathBuf>> {
    let bundles = run()?;
    bundles
        .into_iter()
        .map(|(format, bundle)| {
            let folder = user_folder(format)?;
            fs::create_dir_all(&folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
            let target = folder.join(format.bundle_file());
            // Beside the target first: a running host keeps the library it has mapped, and an
            // interrupted copy leaves the old one.
            let fresh = folder.join(format!(".{}.part", format.bundle_file()));
            remove(&fresh)?;
            copy(&bundle, &fresh)
                .and_then(|()| remove(&target))
                .and_then(|()| Ok(fs::rename(&fresh, &target)?))
                .with_context(|| format!("cannot install to `{}`", target.display()))?;
            Ok(target)
        })
        .collect()
}

/// Runs something in another working folder and comes back.
fn in_folder<T>(folder: &Path, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let back = env::current_dir().context("the working folder is gone")?;
    env::set_current_dir(folder).with_context(|| format!("cannot enter `{}`", folder.display()))?;
    let result = work();
    env::set_current_dir(back).context("the working folder is gone")?;
    result
}

fn remove(path: &Path) -> Result<()> {
    let removed = match fs::symlink_metadata(path) {
        Err(_) => return Ok(()),
        Ok(metadata) if metadata.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
    };
    removed.with_context(|| format!("cannot remove `{}`", path.display()))
}

/// Copies a file, or a folder with all in it.
fn copy(from: &Path, to: &Path) -> Result<()> {
    if !from.is_dir() {
        fs::copy(from, to)?;
        return Ok(());
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}
