//! Imports go one way: no circle of files in any crate, and in the engine none from a layer to one above it.
//!
//! The engine's layers are the modules of `engine/src/lib.rs` in the order in which they stand there.

#[path = "direction/imports.rs"]
mod imports;

use std::collections::{BTreeMap, BTreeSet};

use super::{files, none, read};
use imports::{Imports, imports};

/// TEMPORARY, until the struck body's files are restructured: imports of the engine that may still close a circle or go
/// up, by file and file it imports from.
const EXCEPTIONS: [(&str, &str); 9] = [
    ("hi_hat/pair.rs", "surface.rs"),
    ("shapes.rs", "surface/patch.rs"),
    ("surface.rs", "drum/high_band.rs"),
    ("surface.rs", "hi_hat/pair.rs"),
    ("surface/air.rs", "surface.rs"),
    ("surface/paired.rs", "hi_hat/foot.rs"),
    ("surface/paired.rs", "hi_hat/pair.rs"),
    ("surface/paired.rs", "hi_hat/points.rs"),
    ("surface/wires.rs", "surface.rs"),
];

/// TEMPORARY, until these crates are cut anew: their files still import in circles.
const CIRCULAR: [&str; 2] = ["plugin", "xtask"];

/// The crates of the workspace.
fn crates() -> Vec<String> {
    let manifest = read("Cargo.toml".to_owned()).1;
    let members = manifest.split("members = [").nth(1).and_then(|rest| rest.split(']').next());
    let members: Vec<String> =
        members.expect("members").split('"').skip(1).step_by(2).map(str::to_owned).collect();
    assert!(members.len() >= 4, "{members:?}");
    members
}

/// The imports of a crate of the workspace.
fn imports_of(member: &str) -> Imports {
    let folder = format!("{member}/src");
    if !super::root().join(&folder).exists() {
        return Imports::new();
    }
    let strip = |path: &str| path.strip_prefix(&format!("{folder}/")).expect("below src").to_owned();
    let sources = files(&folder, &["rs"]).into_iter().map(|path| (strip(&path), read(path).1));
    imports(&sources.collect::<Vec<_>>())
}

/// The engine's imports without those that are excused.
fn of_engine() -> Imports {
    let mut imports = imports_of("engine");
    let excused = |from: &str, to: &str| EXCEPTIONS.contains(&(from, to));
    imports.retain(|(from, to), _| !excused(from, to));
    imports
}

/// Files that can be reached from one.
fn reached<'a>(imports: &'a Imports, from: &'a str) -> BTreeSet<&'a str> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        let targets = imports.keys().filter(|(importer, _)| importer == file).map(|(_, target)| &**target);
        open.extend(targets.filter(|target| found.insert(*target)));
    }
    found
}

/// Each circle of files, with the imports that close it, a line each.
fn circles(imports: &Imports) -> Vec<String> {
    let importers: BTreeSet<&str> = imports.keys().map(|(from, _)| &**from).collect();
    let reached: BTreeMap<&str, _> = importers.iter().map(|file| (*file, reached(imports, file))).collect();
    let meets = |a: &str, b: &str| reached.get(a).is_some_and(|files| files.contains(b));
    let mut circles = Vec::new();
    let mut told = BTreeSet::new();
    for file in importers {
        if !meets(file, file) || !told.insert(file) {
            continue;
        }
        told.extend(reached[file].iter().filter(|other| meets(other, file)));
        let inside = |other: &str| meets(file, other) && meets(other, file);
        let edges = imports.iter().filter(|((from, to), _)| inside(from) && inside(to));
        let edges = edges.map(|((from, to), path)| format!("  {from} -> {to} ({path})"));
        circles.push(format!("a circle:\n{}", edges.collect::<Vec<_>>().join("\n")));
    }
    circles
}

/// The modules that a crate's root declares, top first, but for those of tests.
fn layers(root: &str) -> Vec<String> {
    let items = syn::parse_file(root).expect("a root").items;
    let modules = items.iter().filter_map(|item| match item {
        syn::Item::Mod(module) => Some(module.ident.to_string()),
        _ => None,
    });
    modules.collect()
}

/// The imports that go from a layer to one above it, or to the root.
fn upward(imports: &Imports, layers: &[String]) -> Vec<String> {
    let layer = |file: &str| {
        let module = file.split('/').next().unwrap_or(file).trim_end_matches(".rs");
        // The root is above all.
        layers.iter().position(|layer| layer == module).map_or(0, |at| at + 1)
    };
    let up = imports.iter().filter(|((from, to), _)| layer(from) > layer(to));
    up.map(|((from, to), path)| format!("{from} -> {to} ({path}) goes up")).collect()
}

#[test]
fn no_files_of_a_crate_import_each_other_in_a_circle() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for member in crates() {
        let imports = if member == "engine" { of_engine() } else { imports_of(&member) };
        seen += imports.len();
        let circles = circles(&imports);
        if CIRCULAR.contains(&&*member) {
            wrong.extend(
                circles.is_empty().then(|| format!("{member} has no circle any more: excuse it no longer")),
            );
        } else {
            wrong.extend(circles.into_iter().map(|circle| format!("{member}/src: {circle}")));
        }
    }
    assert!(seen > 500, "{seen} imports");
    none(wrong);
}

#[test]
fn no_file_of_the_engine_imports_from_a_layer_above_its_own() {
    let imports = of_engine();
    let layers = layers(&read("engine/src/lib.rs".to_owned()).1);
    assert!(imports.len() > 300 && layers.len() > 20, "{} {layers:?}", imports.len());
    none(upward(&imports, &layers));
}

#[test]
fn no_exception_outlives_its_reason() {
    let imports = imports_of("engine");
    let gone = |(from, to): &&(&str, &str)| !imports.contains_key(&((*from).to_owned(), (*to).to_owned()));
    let gone = EXCEPTIONS.iter().filter(gone);
    none(gone.map(|(from, to)| format!("{from} -> {to} is gone: excuse it no longer")).collect());
}

/// The imports of a made-up crate.
fn made_up(files: &[(&str, &str)]) -> Imports {
    imports(&files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect::<Vec<_>>())
}

/// From whom a file of a made-up crate imports.
fn from<'a>(imports: &'a Imports, file: &str) -> Vec<&'a str> {
    imports.keys().filter(|(from, _)| from == file).map(|(_, to)| &**to).collect()
}

#[test]
fn a_made_up_circle_is_found_with_its_files_and_paths() {
    let imports = made_up(&[
        ("lib.rs", "mod a; mod b; mod c; mod d;"),
        ("a.rs", "use crate::b::{self, Thing}; fn f() {}"),
        ("b.rs", "fn g() { super::c::run(); }"),
        ("c.rs", "fn run() { assert!(crate::a::f() == 3); }"),
        ("d.rs", "use crate::a; fn h() { a::f() }"),
    ]);
    assert_eq!(
        circles(&imports),
        [
            "a circle:\n  a.rs -> b.rs (crate::b)\n  b.rs -> c.rs (super::c::run)\n  c.rs -> a.rs (crate::a::f)"
        ]
    );
}

#[test]
fn a_parent_and_a_child_that_import_each_other_are_a_circle() {
    let parent = ("a.rs", "mod child; use child::Small; pub const MOST: usize = 3;");
    let imports = made_up(&[("lib.rs", "mod a;"), parent, ("a/child.rs", "use super::MOST;")]);
    assert_eq!(circles(&imports).len(), 1);
    // To declare a child is not to import it.
    let parent = ("a.rs", "pub mod child; pub const MOST: usize = 3;");
    let imports = made_up(&[("lib.rs", "mod a;"), parent, ("a/child.rs", "use super::MOST;")]);
    assert_eq!((circles(&imports).len(), from(&imports, "a/child.rs")), (0, vec!["a.rs"]));
}

#[test]
fn what_only_tests_compile_closes_no_circle() {
    let imports = made_up(&[
        ("lib.rs", "mod a; mod b; #[cfg(test)] mod probe;"),
        ("a.rs", "use crate::b::g; #[cfg(test)] mod tests;"),
        ("a/tests.rs", "use crate::b::g; use crate::probe;"),
        ("b.rs", "#[cfg(test)] mod tests { use crate::a::f; } #[cfg(test)] use crate::a; fn g() {}"),
        ("probe.rs", "use crate::a; use crate::b;"),
    ]);
    assert_eq!(imports.len(), 1, "{imports:?}");
    // What tests leave out is not theirs.
    let b = ("b.rs", "#[cfg(not(test))] use crate::a::f;");
    let imports = made_up(&[("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::g;"), b]);
    assert_eq!(circles(&imports).len(), 1);
}

#[test]
fn paths_are_followed_through_groups_names_and_modules_inside_a_file() {
    let imports = made_up(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::{b::{deep as low, other::*}, c}; fn f() -> low::Thing { c::g() }"),
        ("b.rs", "pub mod deep; pub mod other; mod inside { fn h() { super::deep::run() } }"),
        ("b/deep.rs", "/// See [`crate::a`].\npub(in crate::b) fn run() {}"),
        ("b/other.rs", "fn i() { println!(\"{}\", super::super::c::g()) }"),
        ("c.rs", "use std::fmt; use serde::a::b; fn g() { fmt::a::b() }"),
    ]);
    assert_eq!(from(&imports, "a.rs"), ["b/deep.rs", "b/other.rs", "c.rs"]);
    assert_eq!(from(&imports, "b.rs"), ["b/deep.rs"]);
    assert_eq!(from(&imports, "b/other.rs"), ["c.rs"]);
    assert_eq!((from(&imports, "b/deep.rs").len(), from(&imports, "c.rs").len()), (0, 0));
}

#[test]
fn an_import_from_above_is_found() {
    let root = "pub mod top;\nmod middle;\npub mod bottom;";
    let imports = made_up(&[
        ("lib.rs", root),
        ("top.rs", "use crate::bottom::Low;"),
        ("middle.rs", "use crate::bottom::Low; pub const SIZE: usize = 1;"),
        ("bottom.rs", "mod part; use crate::SIZE;"),
        ("bottom/part.rs", "use crate::middle::SIZE;"),
    ]);
    assert_eq!(layers(root), ["top", "middle", "bottom"]);
    let up = upward(&imports, &layers(root));
    assert_eq!(
        up,
        [
            "bottom.rs -> lib.rs (crate::SIZE) goes up",
            "bottom/part.rs -> middle.rs (crate::middle::SIZE) goes up"
        ]
    );
}
