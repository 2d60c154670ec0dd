//! What is wrong with a preset, or with what is asked of a library.

use std::path::PathBuf;

use crate::kit_file::KitFileError;

/// What is wrong.
#[derive(Debug, thiserror::Error)]
pub enum PresetError {
    /// A line of a file says something that is not understood.
    #[error("{file}, line {line}: {reason}")]
    AtLine {
        /// The file, or the name of a built-in preset.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong, and what is accepted.
        reason: String,
    },
    /// A line of the kit in a file says something that is not accepted.
    #[error(transparent)]
    Kit(#[from] KitFileError),
    /// No preset has that name.
    #[error("no preset is called `{name}`, accepted: {accepted}")]
    Unknown {
        /// The name given.
        name: String,
        /// Every name, separated by commas.
        accepted: String,
    },
    /// A name that cannot be a file's, or that a preset already has.
    #[error("a preset cannot be called `{name}`: {reason}")]
    Name {
        /// The name given.
        name: String,
        /// Why not.
        reason: &'static str,
    },
    /// A built-in preset cannot be changed.
    #[error("`{name}` is built in and stays: save it under another name")]
    BuiltIn {
        /// The name given.
        name: String,
    },
    /// The system names no folder for a user's files.
    #[error("there is no folder for presets: the system does not say where the user's files are")]
    NoFolder,
    /// A file or folder cannot be used.
    #[error("cannot {what} `{path}`: {source}", path = path.display())]
    File {
        /// What was tried: `read`, `write`, ...
        what: &'static str,
        /// On which file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
