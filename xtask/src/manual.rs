//! `docs`: the pages of the manual that are generated from the code.

use std::path::PathBuf;

use anyhow::Result;

use overhear_cli::output;

use crate::workspace;

/// The pages: where they lie in the workspace, and what they say.
pub fn pages() -> [(&'static str, String); 3] {
    [
        ("docs/library.md", overhear::library::document()),
        ("docs/midi.md", overhear::midi::document::document()),
        ("docs/parameters.md", overhear::parameters::document()),
    ]
}

/// Writes every page.
///
/// # Errors
/// If one cannot be written.
pub fn write() -> Result<()> {
    for (path, text) in pages() {
        let path: PathBuf = workspace::root().join(path);
        output::write(&path, text.as_bytes())?;
    }
    Ok(())
}
