//! Which integration tests are quick: those that take seconds and need neither bundles nor a display.

/// When a target is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tier {
    /// By `test --quick` and by `test`.
    Quick,
    /// By `test` alone.
    Whole,
    /// By `test` alone, built with the feature `traps`.
    Traps,
}

/// Every integration test of the workspace by its target: when it is run, and why then.
pub const TARGETS: [(&str, Tier, &str); 39] = [
    ("acoustics", Tier::Quick, "figures of modes, computed rather than played"),
    ("automation", Tier::Whole, "plays the kit under every parameter"),
    ("command_line", Tier::Quick, "the program for users, in an empty folder"),
    ("commands", Tier::Whole, "runs the program some hundred times"),
    ("contacts", Tier::Whole, "every striker on the pieces at four sample rates"),
    ("cascade", Tier::Whole, "seconds of cymbals coupled to 8 kHz"),
    ("cymbals", Tier::Whole, "seconds of coupled plates at every quality"),
    ("damping", Tier::Quick, "a few short decays"),
    ("denormals", Tier::Whole, "the whole kit, half a minute of it"),
    ("documents", Tier::Quick, "compares texts"),
    ("drums", Tier::Quick, "short strokes on every drum"),
    ("equivalence", Tier::Whole, "the whole kit at every buffer size"),
    ("fuzz", Tier::Traps, "counts allocations, with an allocator of its own"),
    ("hi_hat", Tier::Quick, "the only tests of the pair and its pedal, and short"),
    ("hi_hat_notes", Tier::Quick, "notes of one hi-hat"),
    ("hosts", Tier::Whole, "needs the release bundles, hosts and a display"),
    ("stacks", Tier::Quick, "the only tests of stacks, and short"),
    ("instruction_sets", Tier::Whole, "every piece on each instruction set"),
    ("cache", Tier::Whole, "builds kits anew with harmed caches"),
    ("kit", Tier::Quick, "a kit as a document, played for moments"),
    ("library", Tier::Whole, "builds five whole kits"),
    ("loudness", Tier::Whole, "plays the groove on three kits"),
    ("microphones", Tier::Quick, "one stroke at every microphone"),
    ("notes", Tier::Whole, "notes of every piece, many times"),
    ("passivity", Tier::Whole, "sweeps over descriptions and rates"),
    ("process", Tier::Traps, "counts allocations, with an allocator of its own"),
    ("program", Tier::Whole, "the program without a host needs a display"),
    (
        "random",
        Tier::Whole,
        "builds hundreds of random pieces, and a seed that is new may find one that fails",
    ),
    ("random_kits", Tier::Whole, "builds random kits, six of a fixed seed"),
    ("realtime", Tier::Traps, "counts allocations, with an allocator of its own"),
    ("recordings", Tier::Whole, "plays the kit softly to hard"),
    ("relations", Tier::Whole, "builds some thirty pieces"),
    ("rivets", Tier::Quick, "two cymbals, some seconds each"),
    ("sleep", Tier::Quick, "rests more than it plays"),
    ("strokes", Tier::Quick, "single strokes"),
    ("swap", Tier::Quick, "exchanges a piece while it plays"),
    ("sympathy", Tier::Quick, "two drums at a time"),
    ("tidy", Tier::Quick, "reads sources and documents"),
    ("workers", Tier::Traps, "has an allocator of its own"),
];

/// The targets of a tier.
pub fn of(tier: Tier) -> impl Iterator<Item = &'static str> {
    TARGETS.into_iter().filter(move |(_, of, _)| *of == tier).map(|(name, ..)| name)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;
    use crate::workspace;

    /// The targets in a folder of the workspace.
    fn targets(folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(workspace::root().join(folder)).expect(folder);
        let sources = entries.map(|entry| entry.unwrap().path());
        let sources = sources.filter(|path| path.extension().is_some_and(|ending| ending == "rs"));
        sources.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect()
    }

    #[test]
    fn every_target_is_in_a_tier_and_has_a_reason() {
        let folders = ["tests/tests", "cli/tests", "standalone/tests"];
        let there: BTreeSet<String> = folders.into_iter().flat_map(targets).collect();
        let listed: BTreeSet<String> = TARGETS.into_iter().map(|(name, ..)| name.to_owned()).collect();
        assert_eq!(listed, there);
        assert!(listed.len() == TARGETS.len() && TARGETS.iter().all(|(_, _, reason)| reason.len() > 10));
    }

    #[test]
    fn the_targets_with_traps_are_those_that_need_the_feature() {
        let manifest = workspace::root().join(Path::new("tests/Cargo.toml"));
        let manifest = std::fs::read_to_string(manifest).unwrap();
        let gated = manifest.split("[[test]]").skip(1);
        let gated = gated.filter(|target| target.contains("required-features = [\"traps\"]"));
        let gated: BTreeSet<&str> = gated.filter_map(|target| target.split('"').nth(1)).collect();
        assert_eq!(gated, of(Tier::Traps).collect());
    }
}
