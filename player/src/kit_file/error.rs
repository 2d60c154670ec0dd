//! What is wrong with a kit file.

use super::format::LARGEST;

/// What is wrong with a kit file, in one line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum KitFileError {
    /// A line says something that is not accepted.
    #[error("{file}, line {line}: {reason}")]
    AtLine {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// The field, what it is, and what is accepted.
        reason: String,
    },
    /// The file as a whole cannot be read.
    #[error("{file}: {reason}")]
    File {
        /// The file.
        file: String,
        /// Why not.
        reason: String,
    },
}

impl KitFileError {
    /// An error at a byte of a text, if that is known.
    pub(super) fn at(file: &str, text: &[u8], at: Option<usize>, reason: &str) -> KitFileError {
        let Some(at) = at else { return KitFileError::whole(file, reason) };
        let before = &text[..at.min(text.len())];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        KitFileError::AtLine { file: one_line(file), line, reason: one_line(reason) }
    }

    /// A file that is too large to be one.
    pub(super) fn too_large(file: &str) -> KitFileError {
        KitFileError::whole(file, &format!("is too large, accepted: up to {LARGEST} bytes"))
    }

    /// An error of a file as a whole.
    pub(super) fn whole(file: &str, reason: &str) -> KitFileError {
        KitFileError::File { file: one_line(file), reason: one_line(reason) }
    }
}

/// What is wrong at a place of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// Byte of the text at which it stands, if that is known.
    pub(super) at: Option<usize>,
    /// The field, what it is, and what is accepted.
    pub(super) reason: String,
}

impl Fault {
    /// A fault at a byte of the text.
    pub(super) fn new(at: usize, reason: impl Into<String>) -> Fault {
        Fault { at: Some(at), reason: reason.into() }
    }
}

/// A text without line breaks and other control characters, which are written as escapes.
fn one_line(text: &str) -> String {
    let breaks = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if breaks(c) { line.extend(c.escape_default()) } else { line.push(c) }
    }
    line
}

/// A text in quotes, cut where it is long.
pub(super) fn quoted(text: &str) -> String {
    format!("`{}`", shortened(text))
}

/// A text, cut where it is long.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
