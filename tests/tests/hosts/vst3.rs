//! The VST3 bundle in DawDreamer and pedalboard, hosts built on JUCE.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use overhear::parameters::{BYPASS_GROUP, PARAMETERS, find, host_id};
use serde_json::{Value, json};
use xtask::player::Blocks;
use xtask::workspace::Format;

use crate::score::{Happening, Score, Sound, assert_same, frames, notes, through_plugin};
use crate::{alone, bundle_path, here, instance};

/// The Python that has DawDreamer.
fn python() -> PathBuf {
    let given = std::env::var_os(xtask::suite::PYTHON_VARIABLE).map(PathBuf::from);
    let test = std::env::current_exe().expect("the test's own path");
    let prepared = test.ancestors().nth(3).expect("a target folder").join("python-hosts/bin/python");
    let python = given.unwrap_or(prepared);
    assert!(python.exists(), "no {}: run `cargo xtask test` once", python.display());
    python
}

/// A file for one job, gone when dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Scratch {
        Scratch(std::env::temp_dir().join(format!("overhear-{}-{name}", std::process::id())))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// Place of a parameter in DawDreamer's list: the host goes through the plugin's groups, in the order in which
/// they first appear, and within each through its parameters. The bypass comes last in its group.
fn listed(index: usize) -> usize {
    let first = |group: &str| PARAMETERS.iter().position(|other| other.group == group);
    let place = |of: usize| (first(PARAMETERS[of].group), of);
    let before = (0..PARAMETERS.len()).filter(|&other| place(other) < place(index)).count();
    before + usize::from(first(BYPASS_GROUP) < first(PARAMETERS[index].group))
}

/// What is done to parameters in another host, by `(index, plain value)`.
#[derive(Default)]
struct Moves<'a> {
    /// Set before it plays.
    parameters: &'a [(usize, f32)],
    /// Moved with every block.
    automation: &'a [(usize, Vec<f32>)],
    /// File of a state to load first.
    load: Option<&'a PathBuf>,
    /// File that the state is saved to in the end.
    save: Option<&'a PathBuf>,
}

/// Plays a score through the VST3 bundle.
fn through_vst3(name: &str, score: &Score, moves: &Moves, rate: f64, block: u32) -> Sound {
    let share = |index: usize, value: f32| PARAMETERS[index].normalized(value);
    let parameters =
        moves.parameters.iter().map(|&(index, value)| json!([listed(index), share(index, value)]));
    let automation = moves.automation.iter().map(|(index, values)| {
        let shares: Vec<_> = values.iter().map(|&value| share(*index, value)).collect();
        json!([listed(*index), shares])
    });
    let description = json!({
        "plugin": bundle_path(Format::Vst3),
        "rate": rate,
        "block": block,
        "frames": frames(rate),
        "notes": listed_notes(score),
        "parameters": parameters.collect::<Vec<_>>(),
        "automation": automation.collect::<Vec<_>>(),
        "load": moves.load,
        "save": moves.save,
    });
    through_python(name, "hosts/vst3.py", description)
}

/// Plays a score through a plugin of the VST3 bundle in pedalboard, which uses the main output only.
pub fn through_pedalboard(name: &str, plugin: &str, score: &Score, rate: f64, block: u32) -> Sound {
    let description = json!({
        "plugin": bundle_path(Format::Vst3),
        "name": plugin,
        "rate": rate,
        "block": block,
        "frames": frames(rate),
        "notes": listed_notes(score),
    });
    through_python(name, "hosts/pedalboard_vst3.py", description)
}

/// Notes as the scripts read them.
fn listed_notes(score: &Score) -> Vec<Value> {
    let note = |(sample, what): &(u64, Happening)| match what {
        Happening::Note(key, velocity) => json!([sample, key, velocity]),
        Happening::Parameter(..) => unreachable!("scores for other hosts hold notes only"),
    };
    score.iter().map(note).collect()
}

/// Lets a script do a job and reads the sound it leaves.
fn through_python(name: &str, script: &str, mut description: Value) -> Sound {
    let (job, out) = (Scratch::new(&format!("{name}.json")), Scratch::new(&format!("{name}.f32")));
    description["out"] = json!(out.0);
    fs::write(&job.0, description.to_string()).unwrap();
    // No window is opened, and JUCE meets errors of its own at a display: without one by this name it does without.
    // Were there no name at all, it would take the first it finds.
    let output = Command::new(python())
        .arg(here(script))
        .arg(&job.0)
        .env("DISPLAY", ":65000")
        .output()
        .expect("Python");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{script} failed ({}): {said}", output.status);
    let bytes = fs::read(&out.0).expect("what the host wrote");
    let samples: Vec<f32> =
        bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect();
    let (left, right) = samples.split_at(samples.len() / 2);
    [left.to_vec(), right.to_vec()]
}

#[test]
fn vst3_gives_the_samples_of_clap() {
    let _turn = alone();
    for (rate, block) in [(44_100.0, 512), (48_000.0, 64), (96_000.0, 1000)] {
        let score = notes(rate);
        let clap = through_plugin(&mut instance(), &score, rate, Blocks::Fixed(block));
        let vst3 = through_vst3(&format!("notes-{rate}"), &score, &Moves::default(), rate, block);
        assert_same(&vst3, &clap, &format!("{rate} Hz, {block} samples"));
    }
}

#[test]
fn vst3_parameters_are_those_of_clap() {
    let _turn = alone();
    let rate = 48_000.0;
    let score = notes(rate);
    let values: Vec<_> = [("kick_tune", 61.5), ("crash_level", -12.0), ("snare_muffle", 0.5)]
        .map(|(name, value)| (find(name).unwrap().0, value))
        .to_vec();
    let mut clap = instance();
    let set: Vec<_> = values
        .iter()
        .map(|&(index, value)| {
            let parameter = &PARAMETERS[index];
            (host_id(parameter.id), f64::from(parameter.normalized(value)))
        })
        .collect();
    clap.set_parameters(&set).unwrap();
    let expected = through_plugin(&mut clap, &score, rate, Blocks::Fixed(512));
    let state = Scratch::new("parameters.state");
    let moves = Moves { parameters: &values, save: Some(&state.0), ..Moves::default() };
    assert_same(&through_vst3("parameters", &score, &moves, rate, 512), &expected, "with parameters");
    let moves = Moves { load: Some(&state.0), ..Moves::default() };
    assert_same(
        &through_vst3("state", &score, &moves, rate, 512),
        &expected,
        "with another instance's state",
    );
}

#[test]
fn vst3_automation_is_that_of_clap() {
    let _turn = alone();
    let (rate, block) = (48_000.0, 480_u32);
    let score = notes(rate);
    let blocks = frames(rate).div_ceil(u64::from(block)) as usize;
    let sweep = |name: &str, from: f32, to: f32| {
        let (index, parameter) = find(name).unwrap();
        let value = |at: usize| parameter.snap(from + (to - from) * at as f32 / blocks as f32);
        (index, (0..=blocks).map(value).collect::<Vec<_>>())
    };
    let sweeps = [
        sweep("kick_tune", 45.0, 70.0),
        sweep("snare_preload", 0.05, 1.5),
        sweep("rack_tom_muffle", 0.0, 0.8),
        sweep("ride_level", -12.0, 3.0),
    ];
    let mut moved = score.clone();
    for at in 0..blocks {
        let values = sweeps.iter().map(|(index, values)| Happening::Parameter(*index, values[at]));
        moved.extend(values.map(|what| (at as u64 * u64::from(block), what)));
    }
    // At the same sample a host's values come before its notes.
    moved.sort_by_key(|(sample, what)| (*sample, matches!(what, Happening::Note(..))));
    let expected = through_plugin(&mut instance(), &moved, rate, Blocks::Fixed(block));
    let moves = Moves { automation: &sweeps, ..Moves::default() };
    assert_same(&through_vst3("automation", &score, &moves, rate, block), &expected, "automated");
}
