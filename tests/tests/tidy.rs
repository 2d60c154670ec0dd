//! What can be counted of the house's order: docs of modules, sizes of files, names in documents, notes to oneself, units,
//! who names a piece, which way imports go, and how often a crate is compiled.

#[path = "tidy/direction.rs"]
mod direction;
#[path = "tidy/features.rs"]
mod features;
#[path = "tidy/pieces.rs"]
mod pieces;
#[path = "tidy/structs.rs"]
mod structs;
#[path = "tidy/units.rs"]
mod units;
#[path = "tidy/vocabulary.rs"]
mod vocabulary;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// Longest source, lines.
const LONGEST: usize = 600;

/// From so many lines on a source needs a reason.
const LONG: usize = 500;

/// Sources of more than [`LONG`] lines, and why each is one.
const LONG_FOR_A_REASON: [(&str, &str); 0] = [];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
}

/// Every file below a folder of the workspace with one of the endings, as its path from the root.
fn files(folder: &str, endings: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted)) {
                let path = path.strip_prefix(root()).expect("below the root");
                found.push(path.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

/// Every source of the workspace, and its text.
fn sources() -> Vec<(String, String)> {
    let folders =
        ["engine", "player", "plugin", "standalone", "measure", "cli", "xtask", "features", "tests"];
    let sources: Vec<_> = folders.iter().flat_map(|folder| files(folder, &["rs"])).map(read).collect();
    assert!(sources.len() > 150, "{} sources", sources.len());
    sources
}

/// Every document.
fn documents() -> Vec<(String, String)> {
    let at_root = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "EXPERIMENTS.md"].map(str::to_owned);
    at_root.into_iter().chain(files("docs", &["md"])).map(read).collect()
}

fn read(path: String) -> (String, String) {
    let text = fs::read_to_string(root().join(&path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    (path, text)
}

/// Fails with all that is wrong, one a line.
#[track_caller]
fn none(wrong: Vec<String>) {
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_module_says_what_it_is() {
    // Tests of a module that have a file of their own belong to its docs; build scripts have no reader.
    let of_its_own = |path: &str| !path.ends_with("/tests.rs");
    let sources = sources().into_iter().filter(|(path, _)| of_its_own(path));
    none(sources.filter(|(_, text)| !text.starts_with("//! ")).map(|(path, _)| path).collect());
}

#[test]
fn no_source_is_longer_than_600_lines_and_those_beyond_500_have_a_reason() {
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        let lines = text.lines().count();
        let excused = LONG_FOR_A_REASON.iter().any(|(named, _)| *named == path);
        if lines > LONGEST {
            wrong.push(format!("{path} has {lines} lines: split it"));
        } else if lines > LONG && !excused {
            wrong.push(format!("{path} has {lines} lines: split it, or give a reason here"));
        } else if lines <= LONG && excused {
            wrong.push(format!("{path} has {lines} lines: it needs no reason any more"));
        }
    }
    let there = |path: &str| root().join(path).exists();
    wrong.extend(
        LONG_FOR_A_REASON.iter().filter(|(path, _)| !there(path)).map(|(path, _)| format!("{path} is gone")),
    );
    none(wrong);
}

#[test]
fn no_note_to_oneself_is_without_its_condition() {
    // Written apart, so that this file has none.
    let marks = ["TO", "FIX", "XX", "HA"].iter().zip(["DO", "ME", "X", "CK"]).map(|(a, b)| format!("{a}{b}"));
    let marks: Vec<String> = marks.collect();
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        for (number, line) in text.lines().enumerate() {
            let word = |mark: &String| line.split(|c: char| !c.is_alphanumeric()).any(|word| word == mark);
            if marks.iter().any(word) && !["when ", "until ", "once "].iter().any(|when| line.contains(when))
            {
                wrong.push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    none(wrong);
}

#[test]
fn every_crate_warns_of_public_items_without_docs() {
    let manifest = read("Cargo.toml".to_owned()).1;
    assert!(manifest.contains("[workspace.lints.rust]\nmissing_docs = \"warn\""));
    let members = manifest.lines().find_map(|line| line.strip_prefix("members = [")).expect("members");
    let members: Vec<&str> = members.split('"').skip(1).step_by(2).collect();
    assert!(members.len() >= 8, "{members:?}");
    for member in members {
        let (path, text) = read(format!("{member}/Cargo.toml"));
        assert!(text.contains("[lints]\nworkspace = true"), "{path}");
    }
}

/// What a document links to, without what is elsewhere: the target, and the part after `#`.
fn links(text: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    // Fenced blocks hold commands and pictures, not links.
    let prose = text.split("```").step_by(2);
    let links = prose.flat_map(|prose| prose.split("](").skip(1).filter_map(|rest| rest.split(')').next()));
    links.filter(|link| !link.contains("://")).map(|link| match link.split_once('#') {
        Some((path, part)) => (path, Some(part)),
        None => (link, None),
    })
}

/// The name by which a heading is linked to.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

#[test]
fn every_link_in_a_document_leads_somewhere() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (document, text) in documents() {
        let folder = root().join(&document).parent().expect("a folder").to_path_buf();
        for (path, part) in links(&text) {
            seen += 1;
            let target = if path.is_empty() { root().join(&document) } else { folder.join(path) };
            let led = match part {
                None => target.exists(),
                Some(part) => fs::read_to_string(&target)
                    .is_ok_and(|text| text.lines().any(|line| anchor(line.trim_start_matches('#')) == part)),
            };
            if !led {
                wrong.push(format!("{document}: {path}#{}", part.unwrap_or_default()));
            }
        }
    }
    assert!(seen > 80, "{seen} links");
    none(wrong);
}

#[test]
fn every_path_a_document_names_exists() {
    let tops = [
        "engine/",
        "player/",
        "plugin/",
        "standalone/",
        "measure/",
        "cli/",
        "xtask/",
        "tests/",
        "docs/",
        "assets/",
    ];
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (document, text) in documents() {
        let prose: String = text.split("```").step_by(2).collect();
        for word in prose.split('`').skip(1).step_by(2) {
            let names = tops.iter().any(|top| word.starts_with(top)) || word.starts_with(".github/");
            if names && !word.contains(|c: char| c.is_whitespace() || "*<{".contains(c)) {
                seen += 1;
                if !root().join(word).exists() {
                    wrong.push(format!("{document}: {word}"));
                }
            }
        }
    }
    assert!(seen > 150, "{seen} paths");
    none(wrong);
}

#[test]
fn every_page_of_the_manual_is_in_its_summary() {
    let summary = read("docs/SUMMARY.md".to_owned()).1;
    let listed: Vec<PathBuf> = links(&summary).map(|(path, _)| root().join("docs").join(path)).collect();
    let pages = files("docs", &["md"]).into_iter().filter(|page| page != "docs/SUMMARY.md");
    none(pages.filter(|page| !listed.contains(&root().join(page))).collect());
}

#[test]
fn every_page_of_the_report_is_there_and_what_is_not_met_is_told() {
    let limits = read("docs/limits.md".to_owned()).1;
    for (name, _) in xtask::report::pages() {
        let (path, text) = read(format!("docs/report/{name}.md"));
        assert!(text.contains(&format!("`cargo xtask report {name}` writes this page.")), "{path}");
        assert!(text.matches("\n| ").count() > 3, "{path} claims nothing");
        if text.contains("| **no** |") {
            assert!(limits.contains(&format!("(report/{name}.md)")), "docs/limits.md has no word on {path}");
        }
    }
}

#[test]
fn every_command_line_of_a_document_is_understood() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (document, text) in documents() {
        for block in text.split("```").skip(1).step_by(2) {
            for line in block.lines().map(str::trim) {
                let check: fn(Vec<OsString>) -> Result<(), String>;
                let arguments = if let Some(arguments) = line.strip_prefix("cargo xtask ") {
                    check = xtask::cli::check;
                    arguments
                } else if let Some(arguments) = line.strip_prefix("overhear ") {
                    check = overhear_cli::commands::check;
                    arguments
                } else {
                    continue;
                };
                // What stands for something of the reader's is not understood by a program.
                if arguments.contains(['{', '$', '[', '<']) || arguments.starts_with("NAME") {
                    continue;
                }
                seen += 1;
                let arguments = arguments.split(" #").next().unwrap_or(arguments);
                let arguments = arguments.split(" > ").next().unwrap_or(arguments);
                if let Err(refusal) = check(words(&format!("program {arguments}"))) {
                    wrong.push(format!("{document}: {line}: {refusal}"));
                }
            }
        }
    }
    assert!(seen > 25, "{seen} command lines");
    none(wrong);
}

/// What users install must not look for the folder it was built in.
#[test]
fn the_program_and_what_it_measures_with_know_no_checkout() {
    let mut wrong = Vec::new();
    let sources: Vec<_> =
        ["cli/src", "measure/src"].into_iter().flat_map(|folder| files(folder, &["rs"])).collect();
    assert!(sources.len() > 50, "{} sources", sources.len());
    for (path, text) in sources.into_iter().map(read) {
        for word in ["CARGO_MANIFEST_DIR", "CARGO_TARGET", "OUT_DIR", "current_exe"] {
            // Callgrind is started on the program itself, wherever that lies.
            if text.contains(word) && (path.as_str(), word) != ("cli/src/bench/callgrind.rs", "current_exe") {
                wrong.push(format!("{path}: {word}"));
            }
        }
    }
    none(wrong);
}

/// The words of a command line, those in quotes together.
fn words(line: &str) -> Vec<OsString> {
    let mut words = Vec::new();
    for (i, part) in line.split('"').enumerate() {
        if i % 2 == 1 {
            words.push(part.into());
        } else {
            words.extend(part.split_whitespace().filter(|word| !word.ends_with('=')).map(Into::into));
        }
    }
    words
}

/// The loss of memory for each closed window that docs/limits.md tells of is that of one version of baseview.
#[test]
fn the_leak_of_a_closed_window_is_documented_for_the_baseview_in_use() {
    let lock = read("Cargo.lock".to_owned()).1;
    let packages = lock.split("[[package]]").filter(|package| package.contains("\nname = \"baseview\"\n"));
    let versions: Vec<&str> = packages.filter_map(|package| package.split("version = \"").nth(1)).collect();
    let [version] = versions[..] else { panic!("{} versions of baseview", versions.len()) };
    let version = version.split('"').next().expect("a version");
    let limits = read("docs/limits.md".to_owned()).1;
    assert!(limits.contains(&format!("baseview {version}")), "does baseview {version} free its keymaps?");
}

#[test]
fn the_changelog_has_the_version() {
    let manifest = read("Cargo.toml".to_owned()).1;
    let version = manifest.lines().find_map(|line| line.strip_prefix("version = ")).expect("a version");
    let changelog = read("CHANGELOG.md".to_owned()).1;
    assert!(changelog.contains(&format!("## {}", version.trim_matches('"'))), "no heading for {version}");
}

/// Whether a licence expression can be met with a list: `OR` and `/` are choices, `AND` asks for all.
fn can_be_met(expression: &str, allowed: &[&str]) -> bool {
    let all = expression.split(" AND ").map(|part| part.trim_matches(['(', ')']));
    let mut all = all.map(|part| part.replace('/', " OR "));
    all.all(|part| part.split(" OR ").any(|licence| allowed.contains(&licence.trim())))
}

#[test]
fn every_dependency_has_a_licence_that_is_allowed_and_comes_from_crates_io() {
    let deny = read("deny.toml".to_owned()).1;
    let allowed = deny.split("allow = [").nth(1).and_then(|rest| rest.split(']').next()).expect("a list");
    let allowed: Vec<&str> = allowed.split('"').skip(1).step_by(2).collect();
    let output = std::process::Command::new(env!("CARGO"))
        // Not offline: what only other systems need has to be fetched once.
        .args(["metadata", "--format-version", "1", "--locked"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("metadata");
    let packages = metadata["packages"].as_array().expect("packages");
    assert!(packages.len() > 100 && allowed.len() > 5, "{} {allowed:?}", packages.len());
    let mut wrong = Vec::new();
    for package in packages {
        let (name, licence) = (&package["name"], package["license"].as_str().unwrap_or("none"));
        if !can_be_met(licence, &allowed) {
            wrong.push(format!("{name}: {licence}"));
        }
        if package["source"].as_str().is_some_and(|source| !source.contains("crates.io-index")) {
            wrong.push(format!("{name}: {}", package["source"]));
        }
    }
    none(wrong);
    assert!(!can_be_met("GPL-3.0", &allowed) && !can_be_met("MIT AND GPL-3.0", &allowed));
    assert!(can_be_met("(MIT OR GPL-3.0) AND Zlib", &allowed));
}
