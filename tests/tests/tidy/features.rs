//! Which features of third-party crates a build takes: those of every other build, so that the crates that programs share are
//! compiled once in each profile.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use super::{none, root};

/// Features in which a crate is compiled: one list, or two if macros use it as well.
type Features = BTreeMap<String, BTreeSet<String>>;

/// What is built by itself, as cargo names it, and whether with what its tests use.
const BUILDS: [(&str, &[&str], bool); 6] = [
    ("plugin", &["--package", "overhear"], false),
    ("standalone", &["--package", "overhear-standalone"], false),
    ("cli", &["--package", "overhear-cli"], false),
    ("xtask", &["--package", "xtask"], false),
    ("tests", &["--package", "overhear-tests", "--features", "traps"], true),
    ("workspace", &["--workspace"], true),
];

/// Crates that several builds compile, and in which of them they are the same.
const SHARED: [(&str, &[&str]); 2] = [
    ("overhear-player", &["plugin", "standalone", "cli", "xtask", "tests", "workspace"]),
    ("overhear-cli", &["cli", "xtask", "tests", "workspace"]),
];

/// Every crate of a build.
fn features(arguments: &[&str], with_tests: bool) -> Features {
    let edges = if with_tests { "normal,build,dev" } else { "normal,build" };
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(root()).args(["tree", "--locked", "--prefix", "none", "--format", "{p}|{f}"]);
    let output = cargo.args(["--edges", edges]).args(arguments).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    read(&String::from_utf8_lossy(&output.stdout))
}

/// What `cargo tree` has printed.
fn read(tree: &str) -> Features {
    let mut found = Features::new();
    for (of, features) in tree.lines().filter_map(|line| line.split_once('|')) {
        let of = of.split_whitespace().take(2).collect::<Vec<_>>().join(" ");
        found.entry(of).or_default().insert(features.trim_end_matches(" (*)").to_owned());
    }
    found
}

/// Crates below `shared` that two builds take in different features.
fn different(shared: &Features, builds: &[(&str, Features)]) -> Vec<String> {
    let mut wrong = Vec::new();
    for name in shared.keys() {
        let mut those = builds.iter().filter_map(|(build, all)| Some((*build, all.get(name)?)));
        let Some((first, wanted)) = those.next() else { continue };
        for (build, found) in those {
            if wanted.is_disjoint(found) {
                wrong.push(format!("{name}: {wanted:?} for {first}, {found:?} for {build}"));
            }
        }
    }
    wrong
}

#[test]
fn what_programs_share_is_compiled_in_the_same_features_for_each() {
    let all: Vec<(&str, Features)> = BUILDS
        .iter()
        .map(|(build, arguments, with_tests)| (*build, features(arguments, *with_tests)))
        .collect();
    let mut wrong = Vec::new();
    for (shared, builds) in SHARED {
        let those: Vec<_> = all.iter().filter(|(build, _)| builds.contains(build)).cloned().collect();
        assert_eq!(those.len(), builds.len());
        let below = features(&["--package", shared], false);
        assert!(below.len() > 30, "{shared}: {} crates", below.len());
        wrong.extend(different(&below, &those));
    }
    // Ask for what is missing in `features/Cargo.toml`.
    none(wrong);
}

#[test]
fn a_crate_of_other_features_is_found() {
    let one = read(
        "engine v0.1.0 (/home)|\nserde v1.0.0|default,std\nsyn v2.0.0 (proc-macro)|full\nsyn v2.0.0|visit (*)\n",
    );
    let other = read("serde v1.0.0|default\nsyn v2.0.0|visit\nlog v0.4.0|\n");
    let builds = [("one", one.clone()), ("other", other)];
    let wrong = different(&one, &builds);
    assert!(wrong.len() == 1 && wrong[0].starts_with("serde v1.0.0"), "{wrong:?}");
}
