//! The VST3 bundle in DawDreamer and pedalboard, hosts built on JUCE.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use overhear::parameters::{BYPASS_GROUP, parameters};
use overhear_cli::message::Message;
use overhear_cli::player::Blocks;
use overhear_cli::plugin_folders::Format;
use serde_json::{Value, json};

use crate::score::{Happening, Score, Sound, assert_same, frames, notes, through_plugin};
use crate::{alone, as_hosts_have_it, bundle_path, here, instance, setting};

/// The Python that has DawDreamer and pedalboard.
pub fn python() -> PathBuf {
    let given = std::env::var_os(xtask::suite::PYTHON_VARIABLE).map(PathBuf::from);
    let test = std::env::current_exe().expect("the test's own path");
    let prepared = test.ancestors().nth(3).expect("a target folder").join("python-hosts/bin/python");
    let python = given.unwrap_or(prepared);
    assert!(python.exists(), "no {}: run `cargo xtask test` once", python.display());
    python
}

/// A file for one job, gone when dropped.
pub struct Scratch(pub PathBuf);

impl Scratch {
    /// One of that name.
    pub fn new(name: &str) -> Scratch {
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
    let table = parameters();
    let first = |group: &str| table.iter().position(|other| other.group == group);
    let place = |of: usize| (first(table[of].group), of);
    let before = (0..table.len()).filter(|&other| place(other) < place(index)).count();
    before + usize::from(first(BYPASS_GROUP) < first(table[index].group))
}

/// What is done to parameters in another host, by `(index, plain value)`.
#[derive(Default)]
pub struct Moves<'a> {
    /// Set before it plays.
    pub parameters: &'a [(usize, f32)],
    /// Moved with every block.
    pub automation: &'a [(usize, Vec<f32>)],
    /// File of a preset in the format's own form to load first.
    pub preset: Option<&'a PathBuf>,
    /// File of a state that this host has saved, to load first.
    pub load: Option<&'a PathBuf>,
    /// File that the state is saved to in the end.
    pub save: Option<&'a PathBuf>,
}

/// A state of the CLAP plugin as a file that every VST3 host can load (.vstpreset), for the plugin of an id: the id, then the
/// state in a chunk, then a list of the chunks.
pub fn preset_file(id: [u8; 16], clap_state: &[u8]) -> Vec<u8> {
    const HEADER: u64 = 48;
    // Both formats store the same text; CLAP's begins with its length.
    let state = &clap_state[8..];
    let class: String = id.iter().map(|byte| format!("{byte:02X}")).collect();
    let size = state.len() as u64;
    let mut file = b"VST3\x01\0\0\0".to_vec();
    file.extend_from_slice(class.as_bytes());
    file.extend_from_slice(&(HEADER + size).to_le_bytes());
    file.extend_from_slice(state);
    file.extend_from_slice(b"List\x01\0\0\0Comp");
    file.extend([HEADER, size].map(u64::to_le_bytes).as_flattened());
    file
}

/// Plays a score through the VST3 bundle.
pub fn through_vst3(name: &str, score: &Score, moves: &Moves, rate: f64, block: u32) -> Sound {
    let share = |index: usize, value: f32| parameters()[index].normalized(value);
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
        "preset": moves.preset,
        "load": moves.load,
        "save": moves.save,
    });
    through_python(name, "hosts/vst3.py", description)
}

/// Plays a score through a plugin of the VST3 bundle in pedalboard, which uses the main output only, from a preset if one
/// is given.
pub fn through_pedalboard(
    name: &str,
    plugin: &str,
    preset: Option<&PathBuf>,
    score: &Score,
    rate: f64,
    block: u32,
) -> Sound {
    let description = json!({
        "plugin": bundle_path(Format::Vst3),
        "name": plugin,
        "preset": preset,
        "rate": rate,
        "block": block,
        "frames": frames(rate),
        "notes": listed_notes(score),
    });
    through_python(name, "hosts/pedalboard_vst3.py", description)
}

/// Plays messages through the stereo instrument in pedalboard.
pub fn messages_through_pedalboard(
    name: &str,
    messages: &[Message],
    frames: usize,
    rate: f64,
    block: u32,
) -> Sound {
    let listed: Vec<_> = messages.iter().map(|message| json!([message.sample, message.bytes])).collect();
    let description = json!({
        "plugin": bundle_path(Format::Vst3),
        "name": overhear::NAME,
        "preset": null,
        "rate": rate,
        "block": block,
        "frames": frames,
        "notes": [],
        "messages": listed,
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
    let values = ["kick_tune=61.5", "crash_level=-12", "snare_muffle=0.5"].map(setting);
    let mut clap = instance();
    clap.set_parameters(&values.map(as_hosts_have_it)).unwrap();
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
    let sweep = |from: &str, to: &str| {
        let ((index, from), (_, to)) = (setting(from), setting(to));
        let value = |at: usize| parameters()[index].snap(from + (to - from) * at as f32 / blocks as f32);
        (index, (0..=blocks).map(value).collect::<Vec<_>>())
    };
    let sweeps = [
        sweep("kick_tune=45", "kick_tune=70"),
        sweep("snare_preload=0.05", "snare_preload=1.5"),
        sweep("rack_tom_muffle=0", "rack_tom_muffle=0.8"),
        sweep("ride_level=-12", "ride_level=3"),
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
