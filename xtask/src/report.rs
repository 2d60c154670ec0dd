//! `report`: pages of measured figures, written to a folder: tables in Markdown and their plots.
//!
//! Each page is a module: it measures, and hands back a [`Page`]. The same sources give the same
//! pages, byte by byte, on one machine.

pub mod cascade;
mod plot;

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::bad_input;
use crate::{output, workspace};

/// A page as it is written.
#[derive(Debug, Clone)]
pub struct Page {
    /// The page itself: `name.md`.
    pub markdown: String,
    /// Its pictures: file name and PNG bytes.
    pub pictures: Vec<(String, Vec<u8>)>,
}

/// Measures a page.
type Measure = fn() -> Result<Page>;

/// Every page there is: its name and what measures it.
pub const PAGES: [(&str, Measure); 1] = [("cascade", cascade::page)];

/// Where the pages belong.
pub fn folder() -> PathBuf {
    workspace::root().join("docs/report")
}

/// Measures pages, all if none is named, and writes them to `folder`.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) for a page there is none of; if a piece cannot be built or a file not be
/// written.
pub fn run(names: &[String], folder: &Path) -> Result<()> {
    let known = PAGES.map(|(name, _)| name);
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(bad_input!("no page is called `{unknown}`, accepted: {}", known.join(", ")));
    }
    std::fs::create_dir_all(folder)?;
    for (name, measure) in PAGES {
        if names.is_empty() || names.iter().any(|asked| asked == name) {
            let page = measure()?;
            for (file, bytes) in &page.pictures {
                output::write(&folder.join(file), bytes)?;
            }
            output::write(&folder.join(format!("{name}.md")), page.markdown.as_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_page_is_refused_with_those_there_are() {
        let refused = run(&["cascades".to_owned()], Path::new("nowhere")).unwrap_err().to_string();
        assert!(refused.contains("cascades") && refused.contains("accepted: cascade"), "{refused}");
    }
}
