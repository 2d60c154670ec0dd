//! Paths of the workspace, its target folder and the bundles in it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

pub use overhear_cli::plugin_folders::{BUNDLE_NAME, Format};

/// Package of the plugin, as cargo knows it.
pub const PLUGIN_PACKAGE: &str = "overhear";

/// Package of the program that needs no host.
pub const STANDALONE_PACKAGE: &str = "overhear-standalone";

/// Root of the workspace.
pub fn root() -> PathBuf {
    // Fixed when the command is compiled, which cargo does in the workspace itself; looking for
    // Cargo.toml files from the working folder upwards finds other people's.
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_path_buf()
}

/// Cargo, the one that runs this command where there is one.
pub fn cargo() -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root());
    cargo
}

/// Folder cargo builds into; follows `CARGO_TARGET_DIR` and cargo's configuration.
///
/// # Errors
/// If cargo cannot be asked.
pub fn target_dir() -> Result<PathBuf> {
    let output = cargo()
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .output()
        .context("cannot run cargo metadata")?;
    let metadata: serde_json::Value =
        serde_json::from_slice(&output.stdout).context("cargo metadata gave no JSON")?;
    let folder = metadata["target_directory"].as_str().context("cargo names no target folder")?;
    Ok(PathBuf::from(folder))
}

/// Path of a bundle inside a target folder.
pub fn bundle_in(target_dir: &Path, format: Format) -> PathBuf {
    target_dir.join("bundled").join(format.bundle_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_holds_the_bundler_s_names() {
        let names = std::fs::read_to_string(root().join("bundler.toml")).unwrap();
        assert!(names.contains(&format!("[{PLUGIN_PACKAGE}]")));
        assert!(names.contains(&format!("name = \"{BUNDLE_NAME}\"")));
    }
}
