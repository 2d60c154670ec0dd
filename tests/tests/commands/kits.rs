//! Kit files from the command line: shown, created, checked, played and measured.

use std::fs;

use overhear_cli::bench;
use overhear_cli::error::exit_code;
use serde_json::Value;

use super::{Folder, SONG, documented, keys, root};

/// The kit of fourteen pieces, as somebody types it.
fn fourteen() -> String {
    root().join("assets/kits/fourteen.toml").display().to_string()
}

#[test]
fn a_kit_that_is_shown_passes_its_check_and_is_shown_the_same_again() {
    let folder = Folder::new("kit-show");
    for (what, pieces) in [(None, 9), (Some(fourteen()), 14), (Some("jazz".to_owned()), 9)] {
        let show: Vec<&str> = ["kit", "show"].into_iter().chain(what.as_deref()).collect();
        let text = folder.succeed(&show);
        folder.file("kit.toml", text.as_bytes());
        assert_eq!(folder.succeed(&["kit", "check", "kit.toml"]), format!("kit.toml: ok, {pieces} pieces\n"));
        assert_eq!(folder.succeed(&["kit", "show", "kit.toml"]), text, "{what:?}");
    }
}

#[test]
fn a_new_kit_file_passes_its_check_changes_nothing_and_is_not_written_over() {
    let folder = Folder::new("kit-new");
    assert_eq!(folder.succeed(&["kit", "new", "mine.toml"]), "");
    let text = fs::read_to_string(folder.0.join("mine.toml")).unwrap();
    assert!(text.contains("mine") && text.lines().any(|line| line.starts_with('#')), "{text}");
    assert_eq!(folder.succeed(&["kit", "check", "mine.toml"]), "mine.toml: ok, 9 pieces\n");
    assert_eq!(folder.succeed(&["kit", "show", "mine.toml"]), folder.succeed(&["kit", "show"]));
    assert_eq!(folder.run(&["kit", "new", "mine.toml"]).status.code(), Some(2));
    assert_eq!(fs::read_to_string(folder.0.join("mine.toml")).unwrap(), text);
}

#[test]
fn a_line_for_every_file_that_is_checked_says_whether_it_is_a_kit() {
    let folder = Folder::new("kit-check");
    folder.file("sound.toml", b"format = 1\nremove = [\"timpani\"]\n");
    folder.file("broken.toml", b"format = 1\n[pieces.kick]\ndiameter_in = \"wide\"\n");
    folder.file("worse.toml", b"format = 1\n\n[pieces.kick\n");
    let output = folder.run(&["kit", "check", "broken.toml", "sound.toml", "worse.toml", "none.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "sound.toml: ok, 8 pieces\n");
    let said = String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "{said}");
    for (line, words) in lines.iter().zip([
        &["broken.toml, line 3", "diameter_in", "wide"][..],
        &["worse.toml, line 3"],
        &["none.toml"],
    ]) {
        assert!(words.iter().all(|word| line.contains(word)), "{line}");
    }
}

#[test]
fn fitted_constants_are_listed_with_the_documented_keys() {
    let folder = Folder::new("kit-fitted");
    let list: Value = serde_json::from_str(&folder.succeed(&["kit", "fitted", "--json"])).unwrap();
    let mut wanted = documented("\n## kit");
    wanted.retain(|key| !key.starts_with("kit "));
    let (table, list) = (folder.succeed(&["kit", "fitted"]), list.as_array().unwrap());
    assert!(list.len() > 10, "{}", list.len());
    for constant in list {
        assert_eq!(keys(constant), wanted);
        assert!(constant["value"].is_number());
        for key in ["name", "fitted_to", "tried", "moves"] {
            let text = constant[key].as_str().unwrap();
            assert!(!text.is_empty() && table.contains(text), "{constant}");
        }
    }
}

#[test]
fn a_song_is_rendered_on_the_kit_of_a_file() {
    let folder = Folder::new("kit-render");
    folder.file("song.mid", SONG);
    folder.file("same.toml", b"format = 1\n");
    let (fourteen, sound) = (fourteen(), |out: &str| fs::read(folder.0.join(out)).unwrap());
    let render = |out: &str, more: &[&str]| {
        folder.succeed(&[&["render", "song.mid", "-o", out, "--tail", "0.3"], more].concat());
        sound(out)
    };
    let standard = render("standard.wav", &[]);
    assert!(render("same.wav", &["--kit", "same.toml"]) == standard, "a file that changes nothing");
    let other = render("other.wav", &["--kit", &fourteen]);
    assert!(other != standard && other.len() == standard.len());
    assert!(render("blocks.wav", &["--kit", &fourteen, "--block", "random"]) == other, "--block random");
    // Its parameters are called as its pieces are.
    render("set.wav", &["--kit", &fourteen, "--set", "china_level=-6", "--stems", "stems"]);
    for stem in ["china", "kick-2", "rack-tom-3", "room"] {
        assert!(folder.0.join(format!("stems/{stem}.wav")).exists(), "{stem}");
    }
    let refused = folder.run(&["render", "song.mid", "-o", "x.wav", "--set", "china_level=-6"]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && said.contains("china_level"), "{said}");
    let refused =
        folder.run(&["render", "song.mid", "-o", "x.wav", "--kit", &fourteen, "--set", "timpani_tune=0st"]);
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn pieces_of_a_file_are_heard_and_measured_by_their_names() {
    let folder = Folder::new("kit-hear");
    let fourteen = fourteen();
    let json = |arguments: &[&str]| -> Value {
        serde_json::from_str(&folder.succeed(&[arguments, &["--kit", &fourteen, "--json"]].concat())).unwrap()
    };
    let heard = json(&["hear", "china", "--seconds", "0.2"]);
    assert_eq!(heard["piece"], "china");
    let modes = json(&["modes", "kick-2"]);
    assert_eq!(modes["piece"], "kick-2");
    // Below the heads' own modes the air in the port swings against that in the drum.
    let lowest = modes["modes"][0]["frequency_hz"].as_f64().unwrap();
    assert!((15.0..40.0).contains(&lowest), "{lowest} Hz");
    let own =
        modes["modes"].as_array().unwrap().iter().filter(|mode| mode["body"] == "batter" && mode["m"] == 0);
    let boom = own.map(|mode| mode["frequency_hz"].as_f64().unwrap()).find(|&hz| hz > 40.0).unwrap();
    assert!((45.0..90.0).contains(&boom), "{boom} Hz");
    for command in ["hear", "modes"] {
        let refused = folder.run(&[command, "timpani", "--kit", &fourteen]);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert!(refused.status.code() == Some(2) && said.contains("china"), "{command}: {said}");
    }
}

#[test]
fn what_is_no_kit_is_not_measured() {
    let folder = Folder::new("kit-bench");
    let broken = folder.0.join(folder.file("broken.toml", b"format = 1\n[pieces.kick]\nmass_kg = 1\n"));
    for file in [broken, folder.0.join("none.toml")] {
        let request = bench::Request {
            kit: Some(file.clone()),
            runs: 1,
            quality: Default::default(),
            rate: bench::RATE,
            simd: None,
            compare: None,
            callgrind: false,
        };
        let error = bench::run(&request).map(drop).unwrap_err();
        let said = error.to_string();
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(exit_code(&error) == 2 && said.lines().count() == 1 && said.contains(name), "{said}");
    }
}
