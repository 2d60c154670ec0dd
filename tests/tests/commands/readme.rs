//! Every command of the README, run as it stands there.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use overhear_measure::report::page;
use overhear_tests::Chance;

use super::{Folder, SONG, root};

/// Commands that take seconds.
const SHORT: &[&str] = &["kit", "render", "hear", "modes"];

/// Commands that build the bundles anew and take minutes, and the arguments that are added to them here. `demo` plays a short song:
/// with the groove it takes minutes more.
const BUILDING: &[(&str, &[&str])] = &[("demo", &["--song", "song.mid"]), ("install", &[]), ("bundle", &[])];

/// Commands that measure for minutes, and the arguments that are added to them here. `bench` runs everything once. The report is
/// written to another folder than that of the sources, and [one of its pages](sampled_page) is measured.
const MEASURING: &[(&str, &[&str])] = &[("bench", &["--runs", "1"]), ("report", &["-o", "report"])];

/// Note numbers in the song; the crash's is the value of no other byte.
const CRASH: u8 = 49;
const KICK: u8 = 36;

/// What runs this.
const THIS: &str = "test";

/// Pages that are never drawn: costs are what `bench` measures, the page of mechanisms compares for minutes and claims nothing, and the
/// comparison with recordings renders for ten minutes; `--test recordings` holds some of its claims.
const NEVER_DRAWN: [&str; 3] = ["cost", "mechanisms", "realism"];

/// The page of the report for this run, drawn from a fresh seed that is printed. The tests hold the figures of all pages to their
/// bounds.
fn sampled_page() -> &'static str {
    let pages = xtask::report::pages().map(|(name, _)| name).filter(|name| !NEVER_DRAWN.contains(name));
    let pages: Vec<&str> = pages.collect();
    Chance::new(Chance::seeds(&[])[0]).of(&pages)
}

/// What follows `cargo xtask` in every line of a block and between every pair of backquotes.
fn commands() -> Vec<String> {
    let readme = fs::read_to_string(root().join("README.md")).expect("a README");
    let after = |text: &str| Some(text.strip_prefix("cargo xtask ")?.split(" #").next()?.trim().to_owned());
    let lines = readme.lines().filter_map(after);
    let quoted = readme.lines().filter(|line| !line.starts_with("```"));
    let quoted = quoted.flat_map(|line| line.split('`').skip(1).step_by(2)).filter_map(after);
    let mut commands = Vec::new();
    for command in lines.chain(quoted) {
        if !commands.contains(&command) {
            commands.push(command);
        }
    }
    commands
}

/// The lines of a command.
fn of(name: &str) -> Vec<String> {
    let is = |line: &String| line.split_whitespace().next() == Some(name);
    let lines: Vec<_> = commands().into_iter().filter(is).collect();
    assert!(!lines.is_empty(), "the README has no `{name}`");
    lines
}

#[test]
fn the_short_commands_do_what_it_says() {
    let folder = Folder::new("readme");
    // Rendered until it has died away, at the highest tier: the crash would take a minute of each file.
    let drums = SONG.iter().map(|&byte| if byte == CRASH { KICK } else { byte });
    let drums: Vec<u8> = drums.collect();
    fs::create_dir(folder.0.join("songs")).unwrap();
    for file in ["song.mid", "songs/one.mid", "songs/two.mid"] {
        folder.file(file, &drums);
    }
    for line in SHORT.iter().flat_map(|name| of(name)) {
        folder.succeed(&line.split_whitespace().collect::<Vec<_>>());
    }
    for file in ["song.wav", "snare.wav", "sounds/two.wav", "stems/two/kick.wav"] {
        assert!(folder.0.join(file).exists(), "{file}: {:?}", folder.names());
    }
}

#[test]
fn no_command_is_left_out_here() {
    let long = BUILDING.iter().chain(MEASURING).map(|(name, _)| name);
    let known: BTreeSet<&str> = SHORT.iter().chain(long).copied().chain([THIS]).collect();
    let commands = commands();
    let named: BTreeSet<&str> = commands.iter().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(named, known);
}

/// Builds the bundles and plays. `cargo xtask test` runs it while no other test loads the bundles.
#[test]
#[ignore = "takes minutes"]
fn the_commands_for_building_do_what_it_says() {
    let folder = Folder::new("readme-building");
    folder.file("song.mid", SONG);
    for (name, more) in BUILDING {
        for line in of(name) {
            let more = more.iter().copied();
            succeeds_at_home(&folder, &line.split_whitespace().chain(more).collect::<Vec<_>>());
        }
    }
    for file in ["demo.wav", "demo.png", "demo-shots/kit-dark-1x.png"] {
        assert!(folder.0.join(file).exists(), "{file}: {:?}", folder.names());
    }
    #[cfg(target_os = "linux")]
    for file in [".clap/Overhear.clap", ".vst3/Overhear.vst3"] {
        assert!(folder.0.join(file).exists(), "{file}: {:?}", folder.names());
    }
    let program = format!("bundled/overhear-standalone{}", std::env::consts::EXE_SUFFIX);
    assert!(xtask::workspace::target_dir().unwrap().join(program).exists());
}

/// `cargo xtask test` runs it.
#[test]
#[ignore = "takes minutes"]
fn the_commands_for_measuring_do_what_it_says() {
    let (folder, sampled) = (Folder::new("readme-measuring"), sampled_page());
    for (name, more) in MEASURING {
        for line in of(name) {
            let sampled = (*name == "report").then_some(sampled);
            let more = more.iter().copied().chain(sampled);
            succeeds_at_home(&folder, &line.split_whitespace().chain(more).collect::<Vec<_>>());
        }
    }
    let claims = |folder: PathBuf| {
        let page = fs::read_to_string(folder.join(sampled).with_extension("md")).unwrap_or_default();
        let rows =
            page.lines().filter(|line| [page::MET, page::MISSED].iter().any(|end| line.ends_with(end)));
        rows.filter_map(|row| Some(row.split(" | ").next()?.to_owned())).collect::<Vec<_>>()
    };
    let measured = claims(folder.0.join("report"));
    assert!(!measured.is_empty(), "{sampled} claims nothing");
    assert_eq!(measured, claims(root().join("docs/report")), "docs/report/{sampled}.md is another page's");
}

/// Runs a command that must succeed, and says which and for how long.
#[track_caller]
fn succeeds_at_home(folder: &Folder, arguments: &[&str]) {
    let begun = Instant::now();
    let output = at_home(folder, arguments).output().expect("the command runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    eprintln!("{}: {:.0} s", arguments.join(" "), begun.elapsed().as_secs_f64());
}

/// A command that finds the user's folders in this one, and the tools where they are.
fn at_home(folder: &Folder, arguments: &[&str]) -> std::process::Command {
    let mut command = folder.command(arguments);
    if let Some(home) = std::env::var_os("HOME").map(PathBuf::from) {
        for (variable, usual) in [("CARGO_HOME", ".cargo"), ("RUSTUP_HOME", ".rustup")] {
            let set = std::env::var_os(variable).map_or_else(|| home.join(usual), PathBuf::from);
            command.env(variable, set);
        }
    }
    command.env("HOME", &folder.0);
    command
}
