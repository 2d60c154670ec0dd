//! `report`: pages of measured figures, written to a folder: tables in Markdown and their plots.
//!
//! Each page is a module: it measures, and hands back a [`Page`]. The same sources give the same
//! pages, byte by byte, on one machine; but for the page on costs, which depends on the machine.
//! What pages measure is open to the tests, which hold the same figures to the same bounds.

pub mod cascade;
pub mod contact;
mod cost;
pub mod cymbal;
pub mod drums;
mod glide;
pub mod heads;
pub mod hi_hat;
pub mod kit;
pub mod modal;
pub mod page;
mod plate;
mod plot;
pub mod radiation;
mod realism;
pub mod snare;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;

use crate::bad_input;
use crate::{output, workspace};

pub use page::{Claim, Page, Sheet};

/// Measures a page.
type Measure = fn() -> Result<Page>;

/// Every page there is, in reading order: its name and what measures it.
pub const PAGES: [(&str, Measure); 14] = [
    ("modal", modal::page),
    ("contact", contact::page),
    ("heads", heads::page),
    ("glide", glide::page),
    ("drums", drums::page),
    ("snare", snare::page),
    ("plate", plate::page),
    ("cymbal", cymbal::page),
    ("cascade", cascade::page),
    ("hi-hat", hi_hat::page),
    ("radiation", radiation::page),
    ("kit", kit::page),
    ("realism", realism::page),
    ("cost", cost::page),
];

/// Where the pages belong.
pub fn folder() -> PathBuf {
    workspace::root().join("docs/report")
}

/// Measures pages, all if none is named, and writes them to `folder`; all of them with an index.
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
    let mut written = Vec::new();
    for (name, measure) in PAGES {
        if names.is_empty() || names.iter().any(|asked| asked == name) {
            let begun = Instant::now();
            let page = measure()?;
            for (file, bytes) in &page.pictures {
                output::write(&folder.join(file), bytes)?;
            }
            output::write(&folder.join(format!("{name}.md")), page.markdown.as_bytes())?;
            let [met, of] = page::tally(&page.claims);
            eprintln!("{name}: {met} of {of} met, {:.0} s", begun.elapsed().as_secs_f64());
            written.push(page);
        }
    }
    if names.is_empty() {
        output::write(&folder.join("README.md"), index(&written).as_bytes())?;
    }
    Ok(())
}

/// The page that lists all pages, and every claim that is not met.
fn index(pages: &[Page]) -> String {
    let mut out = String::from(
        "# The report\n\n\
         Every claim of this project with its figure. `cargo xtask report` measures and writes these pages anew, all but the\n\
         one on costs the same on every run; `cargo xtask report NAME` writes one.\n\n\
         | page | | claims met |\n|---|---|---|\n",
    );
    for page in pages {
        let [met, of] = page::tally(&page.claims);
        let _ = writeln!(out, "| [{0}]({0}.md) | {1} | {met} of {of} |", page.name, page.title);
    }
    out.push_str("\n## Not met\n\n| page | claim | figure | should be |\n|---|---|---|---|\n");
    for page in pages {
        for Claim { what, figure, reference, .. } in page.claims.iter().filter(|c| c.met == Some(false)) {
            let _ = writeln!(out, "| [{0}]({0}.md) | {what} | {figure} | {reference} |", page.name);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_page_is_refused_with_those_there_are() {
        let refused = run(&["cascades".to_owned()], Path::new("nowhere")).unwrap_err().to_string();
        assert!(refused.contains("cascades") && refused.contains("accepted: modal, contact"), "{refused}");
    }

    #[test]
    fn what_is_not_met_is_on_the_index() {
        let mut sheet = Sheet::new("modal", "Modes", "About.");
        for met in [Some(true), Some(false), None] {
            let what = format!("claim {met:?}");
            let (figure, reference) = ("1".to_owned(), "2".to_owned());
            sheet.claim(Claim { what, figure, reference, source: page::sources::GOAL, met });
        }
        let page = sheet.finish();
        assert!(page.markdown.contains("**no**") && page.markdown.contains("told"));
        let index = index(&[page]);
        assert!(index.contains("1 of 2") && index.contains("| claim Some(false) | 1 | 2 |"), "{index}");
        assert!(!index.contains("claim Some(true)"));
    }
}
