//! `report`: the pages of the measuring library and the one on costs, written to a folder with an index.
//!
//! The same sources give the same pages, byte by byte, on one machine; but for the page on costs, which depends on the
//! machine.

mod cost;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use overhear_cli::{bad_input, output};
use overhear_measure::report::{self, Measure, page};
use rayon::prelude::*;

use crate::workspace;

/// Every page there is, in reading order: its name and what measures it.
pub fn pages() -> impl Iterator<Item = (&'static str, Measure)> {
    let cost: Measure = cost::page;
    report::PAGES.into_iter().chain([("cost", cost)])
}

/// What `--help` says of the pages' names.
pub fn help() -> String {
    let names: Vec<&str> = pages().map(|(name, _)| name).collect();
    format!("Pages to write, all if none is given: {}", names.join(", "))
}

/// Default folder of the pages.
pub fn folder() -> PathBuf {
    workspace::root().join("docs/report")
}

/// Measures pages, all if none is named, writes them to `folder`, and an index of those that are there.
///
/// # Errors
/// [`BadInput`](overhear_cli::error::BadInput) for a page there is none of; if a piece cannot be built or a file not be
/// written.
pub fn run(names: &[String], folder: &Path) -> Result<()> {
    let known: Vec<&str> = pages().map(|(name, _)| name).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(bad_input!("no page is called `{unknown}`, accepted: {}", known.join(", ")));
    }
    std::fs::create_dir_all(folder)?;
    let asked = pages().filter(|(name, _)| names.is_empty() || names.iter().any(|asked| asked == name));
    // Costs are measured while nothing else runs.
    let (alone, others): (Vec<_>, Vec<_>) = asked.partition(|(name, _)| *name == "cost");
    write_all(&others, folder)?;
    write_all(&alone, folder)?;
    let there = |(name, _): (&'static str, Measure)| {
        let text = std::fs::read_to_string(folder.join(format!("{name}.md"))).ok()?;
        Some((name, text))
    };
    let written: Vec<_> = pages().filter_map(there).collect();
    output::write(&folder.join("README.md"), index(&written).as_bytes())
}

/// Measures and writes pages, as many at once as there are cores.
fn write_all(pages: &[(&str, Measure)], folder: &Path) -> Result<()> {
    pages.par_iter().with_max_len(1).try_for_each(|(name, measure)| {
        let begun = Instant::now();
        let page = measure()?;
        for (file, bytes) in &page.pictures {
            output::write(&folder.join(file), bytes)?;
        }
        output::write(&folder.join(format!("{name}.md")), page.markdown.as_bytes())?;
        let [met, of] = page::tally(&page.claims);
        eprintln!("{name}: {met} of {of} met, {:.0} s", begun.elapsed().as_secs_f64());
        Ok(())
    })
}

/// The page that lists all pages, given by name and text, and every claim that is not met.
fn index(pages: &[(&str, String)]) -> String {
    let mut out = String::from(
        "# The report\n\n\
         Every claim of this project with its figure. `cargo xtask report` measures all claims and writes these pages; the same\n\
         sources give the same pages, except for the one on costs. `cargo xtask report NAME` writes one page.\n\n\
         | page | | claims met |\n|---|---|---|\n",
    );
    let rows = |text: &str, met: &str| text.lines().filter(|line| line.ends_with(met)).count();
    for (name, text) in pages {
        let (met, missed) = (rows(text, page::MET), rows(text, page::MISSED));
        let title = text.lines().next().unwrap_or_default().trim_start_matches("# ");
        let _ = writeln!(out, "| [{name}]({name}.md) | {title} | {met} of {} |", met + missed);
    }
    out.push_str("\n## Not met\n\n| page | claim | measured on | figure | target |\n|---|---|---|---|---|\n");
    for (name, text) in pages {
        for row in text.lines().filter(|line| line.ends_with(page::MISSED)) {
            let cells: Vec<&str> = row.trim_start_matches("| ").split(" | ").take(4).collect();
            let _ = writeln!(out, "| [{name}]({name}.md) | {} |", cells.join(" | "));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_measure::report::{Claim, Sheet};

    #[test]
    fn an_unknown_page_is_refused_with_those_there_are() {
        let refused = run(&["cascades".to_owned()], Path::new("nowhere")).unwrap_err().to_string();
        assert!(refused.contains("cascades") && refused.contains("accepted: modal, contact"), "{refused}");
    }

    #[test]
    fn what_is_not_met_is_on_the_index() {
        let mut sheet = Sheet::new("modal", "Modes", page::bodies::PLAYED, "About.");
        for met in [Some(true), Some(false), None] {
            let what = format!("claim {met:?}");
            let (figure, reference) = ("1".to_owned(), "2".to_owned());
            let (on, source) = (page::bodies::CAP, page::sources::GOAL);
            sheet.claim(Claim { what, on, figure, reference, source, met });
        }
        let page = sheet.finish();
        assert!(page.markdown.contains("**no**") && page.markdown.contains("info"));
        assert!(page.markdown.contains("Measured on: standard kit."));
        assert_eq!(page::tally(&page.claims), [1, 2]);
        let index = index(&[(page.name, page.markdown)]);
        assert!(
            index.contains("1 of 2") && index.contains("| claim Some(false) | reference: cap | 1 | 2 |"),
            "{index}"
        );
        assert!(!index.contains("claim Some(true)"));
    }
}
