//! Where plugins are installed, and where hosts look for them.

use std::env;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::bad_input;

/// Name of the bundles, without extension; `bundler.toml` says the same.
pub const BUNDLE_NAME: &str = "Overhear";

/// A plugin format that is bundled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// CLever Audio Plug-in.
    Clap,
    /// Steinberg's VST3.
    Vst3,
}

impl Format {
    /// Both formats.
    pub const ALL: [Format; 2] = [Format::Clap, Format::Vst3];

    /// File name extension of the bundle.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Clap => "clap",
            Format::Vst3 => "vst3",
        }
    }

    /// Name of the folder of plugins on Windows and macOS.
    fn folder(self) -> &'static str {
        match self {
            Format::Clap => "CLAP",
            Format::Vst3 => "VST3",
        }
    }

    /// File name of the bundle.
    pub fn bundle_file(self) -> String {
        format!("{BUNDLE_NAME}.{}", self.extension())
    }
}

/// The value of an environment variable that names a folder.
fn variable(name: &str) -> Option<PathBuf> {
    env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// The user's plugin folder of a format.
///
/// # Errors
/// If the system does not say where the user's files are.
pub fn user_folder(format: Format) -> Result<PathBuf> {
    let needed = |name: &str| variable(name).with_context(|| format!("{name} is not set"));
    if cfg!(target_os = "windows") {
        return Ok(needed("COMMONPROGRAMFILES")?.join(format.folder()));
    }
    let home = needed("HOME")?;
    Ok(if cfg!(target_os = "macos") {
        home.join("Library/Audio/Plug-Ins").join(format.folder())
    } else {
        home.join(format!(".{}", format.extension()))
    })
}

/// Every folder in which hosts look for plugins of a format, the user's first; for CLAP those of `CLAP_PATH` before all.
fn folders(format: Format) -> Vec<PathBuf> {
    let listed = (format == Format::Clap).then(|| env::var_os("CLAP_PATH")).flatten();
    let mut folders: Vec<PathBuf> = listed.iter().flat_map(env::split_paths).collect();
    folders.extend(user_folder(format));
    if cfg!(target_os = "windows") {
        let local = variable("LOCALAPPDATA").map(|local| local.join("Programs/Common").join(format.folder()));
        folders.extend(local);
    } else if cfg!(target_os = "macos") {
        folders.push(PathBuf::from("/Library/Audio/Plug-Ins").join(format.folder()));
    } else {
        folders.push(PathBuf::from("/usr/lib").join(format.extension()));
    }
    folders
}

/// The installed bundle of a format.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the folders if it is in none of them.
pub fn find(format: Format) -> Result<PathBuf> {
    let folders = folders(format);
    let paths = folders.iter().map(|folder| folder.join(format.bundle_file()));
    paths.into_iter().find(|path| path.exists()).ok_or_else(|| {
        let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
        bad_input!(
            "no {} is installed in {}, accepted: the path of a bundle",
            format.bundle_file(),
            names.join(", ")
        )
    })
}
