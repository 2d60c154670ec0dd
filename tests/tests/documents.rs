//! Paths named in documents exist, and generated pages are up to date.

use std::path::Path;

/// The words between backquotes in a document at the root of the workspace.
fn quoted(document: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let text = std::fs::read_to_string(root.join(document)).unwrap();
    // Fenced blocks hold pictures and commands, not names.
    let prose: String = text.split("```").step_by(2).collect();
    prose.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn every_path_the_architecture_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let is_path = |word: &&String| word.contains('/') && !word.contains(' ');
    let words = quoted("ARCHITECTURE.md");
    let paths: Vec<_> = words.iter().filter(is_path).collect();
    assert!(paths.len() > 30, "{paths:?}");
    let missing: Vec<_> = paths.iter().filter(|path| !root.join(path).exists()).collect();
    assert!(missing.is_empty(), "not there: {missing:?}");
}

#[test]
fn the_pages_that_come_from_the_code_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (path, text) in xtask::manual::pages() {
        let found = std::fs::read_to_string(root.join(path)).unwrap_or_default();
        assert!(found == text, "{path} is out of date: run `cargo xtask docs`");
    }
}

/// The figures are those of the last `cargo xtask demo --all-kits`.
#[test]
fn every_kit_of_the_library_has_a_sound_and_a_picture_and_all_are_about_as_loud() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for kit in overhear::library::kits() {
        let Some([loudness, peak]) = kit.measured() else { panic!("{} was not measured", kit.name) };
        assert!(peak < 0.0, "{}: {peak} dBFS", kit.name);
        range = [range[0].min(loudness), range[1].max(loudness)];
        for (path, begins) in [
            (format!("sounds/kits/{}.mp3", kit.name), &b"\xff\xfb"[..]),
            (format!("pictures/kits/{}.png", kit.name), b"\x89PNG"),
        ] {
            let file = std::fs::read(docs.join(&path)).unwrap_or_default();
            assert!(file.len() > 20_000 && file.starts_with(begins), "docs/{path}: {} bytes", file.len());
        }
    }
    assert!(range[1] - range[0] <= 2.0, "{range:?} LUFS");
}
