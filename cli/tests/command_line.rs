//! The program as a user has it: in an empty folder, with an empty environment, without a checkout in sight.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// One bar: kick, snare and crash at 120 bpm.
const SONG: &[u8] = b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk\0\0\0\x12\
    \0\x99\x24\x64\x30\x99\x26\x50\x30\x31\x70\x10\x24\x40\0\xFF\x2F\0";

/// An empty folder of one test, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("overhear-program-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// The program in the folder, with an empty environment.
    fn program(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_overhear"));
        command.args(arguments).env_clear().current_dir(&self.0);
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.program(arguments).output().expect("the program starts")
    }

    /// What a command prints that must succeed.
    #[track_caller]
    fn succeed(&self, arguments: &[&str]) -> String {
        let Output { status, stdout, stderr } = self.run(arguments);
        assert!(status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&stderr));
        String::from_utf8(stdout).unwrap()
    }

    /// The one line that a command prints which must be refused.
    #[track_caller]
    fn refused(&self, arguments: &[&str]) -> String {
        let Output { status, stdout, stderr } = self.run(arguments);
        let said = String::from_utf8(stderr).unwrap();
        assert_eq!(
            (status.code(), stdout.len(), said.lines().count()),
            (Some(2), 0, 1),
            "{arguments:?}: {said}"
        );
        said
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_song_is_rendered_and_is_not_silent() {
    let folder = Folder::new("render");
    fs::write(folder.0.join("song.mid"), SONG).unwrap();
    let said = folder.succeed(&[
        "render",
        "song.mid",
        "-o",
        "song.wav",
        "--tail",
        "0.2",
        "--preset",
        "jazz",
        "--set",
        "offline_quality=eco",
    ]);
    assert!(said.contains("song.wav: 0.78 s, 4 notes") && said.contains("dBFS"), "{said}");
    let sound = hound::WavReader::open(folder.0.join("song.wav")).unwrap();
    assert_eq!(sound.spec().channels, 2);
    let loudest =
        sound.into_samples::<f32>().map(Result::unwrap).fold(0.0_f32, |loudest, x| loudest.max(x.abs()));
    assert!((0.01..2.0).contains(&loudest), "{loudest}");
}

#[test]
fn a_stroke_is_heard_measured_and_kept() {
    let folder = Folder::new("hear");
    let text = folder.succeed(&[
        "hear",
        "snare",
        "--speed",
        "3",
        "--seconds",
        "0.3",
        "--json",
        "--wav",
        "snare.wav",
    ]);
    let heard: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((heard["piece"].as_str(), heard["speed_m_s"].as_f64()), (Some("snare"), Some(3.0)));
    assert!(heard["contact_ms"].as_f64().is_some_and(|contact| (0.5..20.0).contains(&contact)), "{heard}");
    assert_eq!(hound::WavReader::open(folder.0.join("snare.wav")).unwrap().duration(), 14_400);
}

#[test]
fn kits_are_shown_started_and_checked() {
    let folder = Folder::new("kit");
    fs::write(folder.0.join("kit.toml"), folder.succeed(&["kit", "show"])).unwrap();
    folder.succeed(&["kit", "new", "mine.toml"]);
    let said = folder.succeed(&["kit", "check", "kit.toml", "mine.toml"]);
    assert_eq!(said, "kit.toml: ok, 9 pieces\nmine.toml: ok, 9 pieces\n");
    fs::write(folder.0.join("broken.toml"), "format = 1\n[pieces.snare]\ndiameter_in = 99\n").unwrap();
    let said = folder.refused(&["kit", "check", "broken.toml"]);
    assert!(["broken.toml, line 3", "99", "accepted"].iter().all(|word| said.contains(word)), "{said}");
    assert!(folder.succeed(&["kit", "fitted"]).contains("constants were fitted"));
}

#[test]
fn modes_and_presets_are_listed() {
    let folder = Folder::new("modes");
    assert!(folder.succeed(&["modes", "rack-tom"]).contains("rack-tom: "));
    let presets = folder.succeed(&["presets"]);
    assert!(["default", "studio", "jazz"].iter().all(|name| presets.contains(name)), "{presets}");
    assert!(folder.succeed(&["presets", "show", "jazz"]).contains("format"));
}

#[test]
fn what_is_refused_is_named_with_what_is_accepted() {
    let folder = Folder::new("refused");
    fs::write(folder.0.join("song.mid"), SONG).unwrap();
    for (arguments, words) in [
        (&["hear", "gong"][..], &["gong", "kick", "snare"][..]),
        (&["hear", "snare", "--speed", "99"], &["99", "above 0 to 25 m/s"]),
        (&["render", "song.mid", "-o", "x.wav", "--rate", "10"], &["10", "22050 to 1536000 Hz"]),
        (&["render", "song.mid", "-o", "x.wav", "--clap", "none.clap"], &["none.clap"]),
        (&["frobnicate"], &["frobnicate", "render, hear, modes, kit, presets, bench"]),
    ] {
        let said = folder.refused(arguments);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1);
}

#[cfg(target_os = "linux")]
#[test]
fn an_installed_plugin_is_looked_for_where_hosts_look() {
    let folder = Folder::new("installed");
    fs::write(folder.0.join("song.mid"), SONG).unwrap();
    let mut command = folder.program(&["render", "song.mid", "-o", "x.wav", "--clap", "installed"]);
    let output = command.env("CLAP_PATH", "first:second").env("HOME", "/nowhere").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    // A machine may have one for all its users.
    if !PathBuf::from("/usr/lib/clap/Overhear.clap").exists() {
        assert_eq!(output.status.code(), Some(2));
        assert!(
            said.contains("Overhear.clap") && said.contains("first, second, /nowhere/.clap, /usr/lib/clap"),
            "{said}"
        );
    }
}

#[test]
fn help_is_printed_for_every_command() {
    let folder = Folder::new("help");
    let help = folder.succeed(&["--help"]);
    for command in ["render", "hear", "modes", "kit", "presets", "bench"] {
        assert!(help.contains(&format!("\n  {command} ")), "{help}");
        let help = folder.succeed(&[command, "--help"]);
        // What a document of the checkout says is not at hand.
        assert!(help.contains("Usage: overhear") && !help.contains("docs/"), "{help}");
    }
}

/// Other platforms do not take the place of their cache from the environment.
#[cfg(target_os = "linux")]
#[test]
fn what_a_command_has_built_the_next_one_finds() {
    let folder = Folder::new("cache");
    fs::write(folder.0.join("song.mid"), SONG).unwrap();
    let cache = folder.0.join("cache");
    let render = |out: &str| {
        let mut command = folder.program(&["render", "song.mid", "-o", out, "--tail", "0"]);
        let output = command.env("XDG_CACHE_HOME", &cache).output().expect("the program starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.0.join(out)).unwrap()
    };
    let kept = || {
        let entries = fs::read_dir(cache.join("overhear")).expect("a folder");
        let file = |entry: fs::DirEntry| (entry.file_name(), entry.metadata().unwrap().modified().unwrap());
        let mut files: Vec<_> = entries.map(|entry| file(entry.unwrap())).collect();
        files.sort();
        files
    };
    let sound = render("first.wav");
    let files = kept();
    assert!(files.len() > 9, "{} files for nine pieces", files.len());
    assert!(render("second.wav") == sound, "what is found sounds different");
    assert_eq!(kept(), files, "something was built again");
}
