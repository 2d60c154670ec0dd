//! The commands as typed: refusals, results, documentation.

#[path = "commands/kits.rs"]
mod kits;
#[path = "commands/readme.rs"]
mod readme;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use overhear_tests::names;
use serde_json::Value;

/// A folder of one test, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("overhear-commands-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn file(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.0.join(name), bytes).unwrap();
        name.to_owned()
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs a command in the folder.
    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the command runs")
    }

    /// A command that is to run in the folder.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = match std::env::var_os(xtask::suite::COMMAND_VARIABLE) {
            Some(path) => Command::new(path),
            None => {
                let mut cargo = Command::new(env!("CARGO"));
                let manifest = root().join("Cargo.toml");
                cargo.arg("run").arg("--quiet").arg("--manifest-path").arg(manifest);
                cargo.args(["--package", "xtask", "--"]);
                cargo
            }
        };
        command.args(arguments).current_dir(&self.0);
        command
    }

    /// Runs a command that must succeed and returns what it prints.
    #[track_caller]
    fn succeed(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {said}");
        String::from_utf8(output.stdout).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// One bar: kick, snare and crash at 120 bpm.
const SONG: &[u8] = b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk\0\0\0\x12\
    \0\x99\x24\x64\x30\x99\x26\x50\x30\x31\x70\x10\x24\x40\0\xFF\x2F\0";

#[test]
fn bad_input_is_one_line_with_the_value_exit_code_2_and_no_output() {
    let folder = Folder::new("bad");
    folder.file("broken.toml", b"format = 1\n[pieces.snare]\ndiameter_in = 99\n");
    let broken: &[&str] = &["broken.toml, line 3", "diameter_in", "99", "accepted"];
    folder.file("song.mid", SONG);
    folder.file("cut.mid", &SONG[..SONG.len() - 6]);
    folder.file("text.mid", b"this is no song");
    fs::create_dir(folder.0.join("empty")).unwrap();
    let before = folder.names();
    let cases: &[(&[&str], &[&str])] = &[
        (&["render", "none.mid", "-o", "out.wav"], &["none.mid"]),
        (&["render", "cut.mid", "-o", "out.wav"], &["cut.mid", "cut off"]),
        (&["render", "text.mid", "-o", "out.wav"], &["text.mid", "MThd"]),
        (&["render", "empty", "-o", "outs"], &["empty", ".mid"]),
        (&["render", "song.mid", "-o", "no/such/out.wav"], &["no/such/out.wav"]),
        (&["render", "song.mid", "-o", "/dev/null"], &["/dev/null"]),
        (&["render", "song.mid", "-o", "song.mid"], &["song.mid", "another name"]),
        (&["render", "cut.mid", "text.mid", "-o", "outs"], &["2 of 2 files failed"]),
        (&["render", "song.mid"], &["--output"]),
        (&["render", "song.mid", "-o", "out.wav", "--preset", "polka"], &["polka", "default", "jazz"]),
        (&["render", "song.mid", "-o", "out.wav", "--set", "gong_tune=1"], &["gong_tune", "kick_tune"]),
        (&["render", "song.mid", "-o", "out.wav", "--set", "kick_tune=20"], &["20", "35 to 90 Hz"]),
        (&["render", "song.mid", "-o", "out.wav", "--set", "kick_tune"], &["kick_tune", "name=value"]),
        (&["render", "song.mid", "-o", "out.wav", "--rate", "8000"], &["8000", "22050 to 1536000"]),
        (&["render", "song.mid", "-o", "out.wav", "--rate", "fast"], &["fast", "22050 to 1536000"]),
        (&["render", "song.mid", "-o", "out.wav", "--block", "0"], &["'0'", "1 to 8192"]),
        (&["render", "song.mid", "-o", "out.wav", "--bits", "12"], &["12", "16, 24, 32f"]),
        (&["render", "song.mid", "-o", "out.wav", "--tail", "-1"], &["-1"]),
        (&["render", "song.mid", "-o", "out.wav", "--clap", "song.mid"], &["song.mid", "CLAP"]),
        (&["render", "song.mid", "-o", "out.wav", "--clap", "none.clap"], &["none.clap", "CLAP"]),
        (&["render", "song.mid", "-o", "out.wav", "--clap", "empty"], &["empty", "CLAP"]),
        (&["render", "song.mid", "cut.mid", "-o", "song.mid"], &["song.mid", "folder"]),
        (&["render", "song.mid", "-o", "out.wav", "--stems", "cut.mid"], &["cut.mid"]),
        (&["hear", "gong"], &["gong", "kick", "timpani"]),
        (&["hear"], &["PIECE"]),
        (&["hear", "crash", "--open"], &["--open", "crash"]),
        (&["modes", "ride", "--open"], &["--open", "ride"]),
        (&["hear", "ride", "--no-high-band"], &["--no-high-band", "ride"]),
        (&["hear", "timpani", "--resonant-ratio", "1.2"], &["--resonant-ratio", "timpani"]),
        (&["hear", "kick", "--resonant-ratio", "9"], &["'9'", "0.5 to 2.5"]),
        (&["hear", "kick", "--muffler", "towel"], &["towel", "pillow"]),
        (&["hear", "kick", "--uneven", "1"], &["'1'", "0.05"]),
        (&["hear", "snare", "--striker", "spoon"], &["spoon", "felt-beater"]),
        (&["hear", "snare", "--speed", "0"], &["'0'", "25 m/s"]),
        (&["hear", "snare", "--speed", "26"], &["26", "25 m/s"]),
        (&["hear", "snare", "--at", "1.5"], &["1.5", "0 to 1"]),
        (&["hear", "snare", "--angle", "NaN"], &["NaN", "-360 to 360"]),
        (&["hear", "snare", "--seconds", "inf"], &["inf", "600 s"]),
        (&["hear", "snare", "--set", "kick_tune=60"], &["kick_tune", "snare_tune"]),
        (&["hear", "snare", "--quality", "best"], &["best", "eco"]),
        (&["hear", "snare", "--wav", "no/such/out.wav"], &["no/such/out.wav"]),
        (&["modes", "gong"], &["gong", "kick"]),
        (&["modes", "kick", "--set", "kick_muffle=2"], &["2", "0 to 1"]),
        (&["realism", "timpani"], &["timpani", "kick", "splash"]),
        (&["realism", "snare", "--set", "snare_tone=60"], &["snare_tone", "snare_tune"]),
        (&["realism", "--speeds", "3,0"], &["'0'", "25 m/s"]),
        (&["realism", "snare", "--speeds", "3", "--wav", "song.mid"], &["song.mid", "folder"]),
        (&["render", "song.mid", "-o", "out.wav", "--kit", "broken.toml"], broken),
        (&["render", "song.mid", "-o", "out.wav", "--kit", "none.toml"], &["none.toml"]),
        (&["render", "song.mid", "-o", "out.wav", "--kit", "empty"], &["empty"]),
        (&["render", "song.mid", "-o", "out.wav", "--place", "snare=0,0.3,-0.2"], &["snare", "kick"]),
        (&["hear", "kick", "--kit", "broken.toml"], broken),
        (&["modes", "kick", "--kit", "broken.toml"], broken),
        (&["realism", "kick", "--kit", "broken.toml"], broken),
        (&["kit", "show", "broken.toml"], broken),
        (&["kit", "show", "none.toml"], &["none.toml"]),
        (&["kit", "show", "polka"], &["polka", "default", "jazz"]),
        (&["kit", "check", "broken.toml"], broken),
        (&["kit", "check", "song.mid"], &["song.mid"]),
        (&["kit", "check"], &["FILE"]),
        (&["kit", "new", "song.mid"], &["song.mid", "new file"]),
        (&["kit", "new", "no/such/kit.toml"], &["no/such/kit.toml"]),
        (&["kit", "melt"], &["melt"]),
        (&["dance"], &["dance", "render"]),
    ];
    for (arguments, expected) in cases {
        let output = folder.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{arguments:?}: {said}");
        for word in *expected {
            assert!(said.contains(word), "{arguments:?} does not say `{word}`: {said}");
        }
        assert!(output.stdout.is_empty(), "{arguments:?} prints something");
        assert_eq!(folder.names(), before, "{arguments:?} leaves something");
    }
}

#[test]
fn a_render_is_the_same_every_time_and_for_every_block_size() {
    let folder = Folder::new("render");
    folder.file("song.mid", SONG);
    let render = |out: &str, more: &[&str]| {
        let base = ["render", "song.mid", "-o", out, "--tail", "0.5"];
        folder.succeed(&[&base, more].concat());
        fs::read(folder.0.join(out)).unwrap()
    };
    let first = render("a.wav", &[]);
    assert!(render("b.wav", &["--engine"]) == first, "a second render differs");
    for block in ["1", "17", "8192", "random"] {
        assert!(render("c.wav", &["--block", block]) == first, "--block {block} differs");
    }
    assert!(render("d.wav", &["--set", "kick_tune=70"]) != first, "--set does nothing");
    assert!(render("e.wav", &["--set", "kick_tune=45"]) == first, "a default differs");
    // 16 bits, 44.1 kHz: a header of 44 bytes and four bytes a frame. The last note comes at 112
    // ticks of 96 in a beat of half a second.
    let small = render("f.wav", &["--bits", "16", "--rate", "44100"]);
    let frames = (112.0 / 96.0 * 0.5 * 44_100.0f64).round() as usize + 22_050;
    assert_eq!(small.len(), 44 + 4 * frames);
}

#[test]
fn stems_hold_their_microphone_and_add_up_to_the_song() {
    let folder = Folder::new("stems");
    folder.file("song.mid", SONG);
    folder.succeed(&["render", "song.mid", "-o", "song.wav", "--stems", "stems", "--tail", "1"]);
    let read = |path: &str| overhear_cli::wav::read_float(&folder.0.join(path)).unwrap().1;
    let song = read("song.wav");
    let mut sum = vec![0.0f32; song[0].len()];
    for name in names().into_iter().chain(["overheads", "room"].map(str::to_owned)) {
        // Drums hear what is struck; cymbals do not.
        let heard = !["ride", "splash", "hi-hat"].contains(&&*name);
        let stem = read(&format!("stems/{name}.wav"));
        assert_eq!(stem[0].iter().any(|sample| *sample != 0.0), heard, "{name}");
        for (sum, sample) in sum.iter_mut().zip(&stem[0]) {
            *sum += sample;
        }
    }
    let off = std::iter::zip(&sum, &song[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off < 1e-5, "the stems are off by {off}");
}

#[test]
fn a_folder_of_songs_becomes_a_folder_of_sounds() {
    let folder = Folder::new("folder");
    fs::create_dir(folder.0.join("songs")).unwrap();
    for name in ["songs/one.mid", "songs/two.MID", "songs/notes.txt"] {
        folder.file(name, SONG);
    }
    let said = folder.succeed(&["render", "songs", "-o", "sounds", "--tail", "0.1", "--jobs", "2"]);
    assert_eq!(said.lines().count(), 2, "{said}");
    let mut names: Vec<_> = fs::read_dir(folder.0.join("sounds"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["one.wav", "two.wav"]);
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<_> = value.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

/// The keys that docs/commands.md lists for a command.
fn documented(heading: &str) -> Vec<String> {
    let docs = fs::read_to_string(root().join("docs/commands.md")).unwrap();
    let section = docs.split(heading).nth(1).expect(heading).split("\n## ").next().unwrap().to_owned();
    let mut keys: Vec<_> = section
        .lines()
        .filter_map(|line| Some(line.strip_prefix("| `")?.split('`').next()?.to_owned()))
        .filter(|key| !key.starts_with('-'))
        .collect();
    keys.sort_unstable();
    keys
}

#[test]
fn hear_prints_the_documented_json() {
    let folder = Folder::new("hear");
    let json = folder.succeed(&["hear", "snare", "--speed", "2", "--at", ".3", "--json"]);
    let value: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(keys(&value), documented("## hear"));
    let number = |key: &str| value[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", value[key]));
    assert_eq!((value["piece"].as_str(), value["striker"].as_str()), (Some("snare"), Some("stick")));
    assert_eq!((number("speed_m_s"), number("at"), number("sample_rate_hz")), (2.0, 0.3, 48_000.0));
    assert!((0.5..30.0).contains(&number("contact_ms")));
    assert!(number("leaving_speed_m_s") <= 2.0);
    assert!((number("striker_energy_in_j") - 0.032).abs() < 1e-4);
    assert!(number("energy_peak_j") <= number("striker_energy_in_j"));
    assert!(number("energy_end_j") < number("energy_peak_j"));
    let octaves = ["1000", "125", "16000", "2000", "250", "31.5", "4000", "500", "63", "8000"].to_vec();
    assert_eq!(keys(&value["t60_s"]), octaves);
}

#[test]
fn without_losses_nothing_decays() {
    let folder = Folder::new("lossless");
    let json = folder.succeed(&["hear", "ride", "--lossless", "--unsplit", "--seconds", "1", "--json"]);
    let value: Value = serde_json::from_str(&json).unwrap();
    let number = |key: &str| value[key].as_f64().unwrap();
    // What the stick does not take away stays.
    let about = number("energy_end_j") + number("striker_energy_out_j");
    assert!((about / number("striker_energy_in_j") - 1.0).abs() < 1e-3, "{json}");
    assert!(value["t60_s"].as_object().unwrap().values().all(Value::is_null), "{json}");
}

#[test]
fn modes_prints_the_documented_json() {
    let folder = Folder::new("modes");
    for piece in ["timpani", "crash"] {
        let json = folder.succeed(&["modes", piece, "--json"]);
        let value: Value = serde_json::from_str(&json).unwrap();
        let mode = &value["modes"][0];
        let mut found = [keys(&value), keys(mode)].concat();
        found.sort_unstable();
        assert_eq!(found, documented("## modes"));
        assert_eq!(value["tension_n_m"].as_object().unwrap().is_empty(), piece == "crash");
    }
}

#[test]
fn realism_prints_the_documented_json_and_keeps_the_sounds() {
    let folder = Folder::new("realism");
    let arguments = ["realism", "rack-tom", "--speeds", "4,2", "--json", "--wav", "sounds"];
    let value: Value = serde_json::from_str(&folder.succeed(&arguments)).unwrap();
    let piece = &value["pieces"][0];
    let row = &piece["features"][0];
    let mut found = [keys(&value), keys(piece), keys(row)].concat();
    found.sort_unstable();
    found.dedup();
    let documented: std::collections::BTreeSet<String> = documented("## realism").into_iter().collect();
    // The manual has the ends of a range in one line.
    found.retain(|key| *key != "high");
    assert_eq!(found, documented.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(value["speeds_m_s"].as_array().unwrap().len(), 2);
    assert_eq!(row["values"].as_array().unwrap().len(), 2);
    let mut sounds: Vec<_> = fs::read_dir(folder.0.join("sounds"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    sounds.sort();
    assert_eq!(sounds.len(), 12, "two speeds, three places, two recording chains: {sounds:?}");
    assert!(sounds.contains(&"rack-tom-2-at-0.3-close.wav".to_owned()));
    assert!(sounds.contains(&"rack-tom-4-at-0.4-mix.wav".to_owned()));
}

#[test]
fn the_commands_of_the_readme_and_the_manual_exist() {
    let folder = Folder::new("help");
    let help = folder.succeed(&["--help"]);
    for page in ["README.md", "docs/commands.md"] {
        let text = fs::read_to_string(root().join(page)).unwrap();
        let mut mentioned = 0;
        for rest in text.split("cargo xtask ").skip(1) {
            let name: String = rest.chars().take_while(char::is_ascii_lowercase).collect();
            if !name.is_empty() {
                mentioned += 1;
                assert!(help.contains(&format!("  {name} ")), "{page} has `cargo xtask {name}`");
            }
        }
        assert!(mentioned >= 5, "{page} names {mentioned} commands");
    }
}

#[test]
fn every_option_of_the_manual_exists() {
    let folder = Folder::new("options");
    let docs = fs::read_to_string(root().join("docs/commands.md")).unwrap();
    for command in ["render", "hear", "modes", "realism"] {
        let help = folder.succeed(&[command, "--help"]);
        let section = docs.split(&format!("\n## {command}")).nth(1).unwrap();
        let section = section.split("\n## ").next().unwrap();
        let options: Vec<_> =
            section.lines().filter_map(|line| line.strip_prefix("| `--")?.split(['`', ' ']).next()).collect();
        assert!(!options.is_empty(), "{command}");
        for option in options {
            assert!(help.contains(&format!("--{option}")), "{command} has no --{option}");
        }
        let offered = help.lines().filter_map(|line| line.split("--").nth(1)?.split(['=', ' ', '\n']).next());
        for option in offered.filter(|option| *option != "help") {
            assert!(section.contains(&format!("`--{option}")), "--{option} of {command} is undocumented");
        }
    }
}

#[test]
fn a_reader_that_has_gone_takes_nothing_with_it() {
    let folder = Folder::new("gone");
    folder.file("song.mid", SONG);
    let render = ["render", "song.mid", "-o", "out.wav"];
    for arguments in [&["render", "--help"][..], &render] {
        let mut command = folder.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut running = command.spawn().expect("the command runs");
        drop(running.stdout.take());
        let ended = running.wait_with_output().expect("the command ends");
        let said = String::from_utf8_lossy(&ended.stderr);
        assert!(ended.status.success() && !said.contains("panicked"), "{arguments:?}: {said}");
    }
    assert!(folder.names().contains(&"out.wav".to_owned()), "{:?}", folder.names());
}
