//! What is wrong is told in one line: the file, the line, the field, the value, what is accepted.

use overhear_engine::slot::SLOTS;

use super::super::{LARGEST, load, read, write};
use super::error;
use crate::kit_document::KitDocument;

#[test]
fn every_error_names_the_line_the_field_and_what_is_accepted() {
    for (text, expected) in [
        (
            "format = 1\n[pieces.snare]\n\ndiameter_in = 90",
            "4: pieces.snare.diameter_in is 90, accepted: 5.906 to 32.28",
        ),
        (
            "format = 1\n[pieces.snare]\nbatter.thickness_mm = nan",
            "3: pieces.snare.batter.thickness_mm is nan, accepted",
        ),
        (
            "format = 1\n[pieces.snare]\nbatter.dot = { diameter_in = 13, thickness_mm = 0.1, loss = { constant_1_s = 0, per_khz_1_s = 0 } }",
            "3: pieces.snare.batter.dot.diameter_in is 13, accepted: 0.7875 to 12.6",
        ),
        (
            "format = 1\n[pieces.snare]\nshell.vent_diameter_in = 3",
            "3: pieces.snare.shell.vent_diameter_in is 3, accepted: 0.07875 to 1.968",
        ),
        (
            "format = 1\n[pieces.rack-tom]\nshell.vent_diameter_in = 0.5\nresonant = \"none\"",
            "3: pieces.rack-tom.shell.vent_diameter_m is given, accepted: only with a resonant head",
        ),
        (
            "format = 1\npieces.kick.defaults.pan = inf",
            "2: pieces.kick.defaults.pan is inf, accepted: -1 to 1",
        ),
        (
            "format = 1\npieces.kick.defaults.pan = 1e999",
            "2: pieces.kick.defaults.pan is 1e999, accepted: -1 to 1",
        ),
        (
            "format = 1\npieces.kick.diameter_m = 99999999999999999999",
            "2: pieces.kick.diameter_m is 99999999999999999999, ",
        ),
        (
            "format = 1\n[pieces.kick]\nplace.centre_cm = [1,\n2, 9000]",
            "3: pieces.kick.place.centre_cm.z is 9000, ",
        ),
        (
            "format = 1\n[room]\nreverberation_ms = 9000",
            "3: room.reverberation_ms is 9000, accepted: 50 to 5000",
        ),
        (
            "format = 1\n[room]\noctaves = [1, 1, 1, 1, 1, 1, 1, 9, 1]",
            "3: room.octaves is 9, accepted: 0.1 to 4",
        ),
        // What the file does not say is told where its table stands.
        ("format = 1\n[pieces.snare]\nlowest_pitch_hz = 300\n", "2: pieces.snare.pitch_hz is "),
        // Wrong types.
        (
            "format = 1\npieces.snare.diameter_in = \"x\"",
            "2: pieces.snare.diameter_in is \"x\", accepted: a number",
        ),
        (
            "format = 1\npieces.snare.shell.depth_in = true",
            "2: pieces.snare.shell.depth_in is true, accepted: a number",
        ),
        ("format = 1\npieces.snare.shell = 3", "2: pieces.snare.shell is 3, accepted: a table with a kind"),
        (
            "format = 1\npieces.snare.shell = [\"cylinder\", 0.3, 60]",
            "2: pieces.snare.shell is an array, accepted: a table",
        ),
        ("format = 1\npieces.snare.batter = 1", "2: pieces.snare.batter is 1, accepted: a table"),
        (
            "format = 1\npieces.snare.batter.plies = 1.5",
            "2: pieces.snare.batter.plies is 1.5, accepted: an integer",
        ),
        (
            "format = 1\npieces.snare.evenness.seed = -1",
            "2: pieces.snare.evenness.seed is -1, accepted: an integer",
        ),
        ("format = 1\npieces.snare.high_band = 1", "2: pieces.snare.high_band is 1, accepted: true or false"),
        (
            "format = 1\npieces.snare.place.centre_m = [1, 2]",
            "2: pieces.snare.place.centre_m is an array of 2, accepted: an array",
        ),
        (
            "format = 1\npieces.snare.place.centre_m = [1, \"a\", 2]",
            "2: pieces.snare.place.centre_m.1 is \"a\", accepted: a number",
        ),
        ("format = 1\npieces.snare.title = 5", "2: pieces.snare.title is 5, accepted: a text"),
        (
            "format = 1\npieces.snare.pitch_of = \"x\"",
            "2: pieces.snare.pitch_of is `x`, accepted: batter-alone, principal",
        ),
        (
            "format = 1\npieces.snare.pitch_hz = 1979-05-27",
            "2: pieces.snare.pitch_hz is `1979-05-27`, a date",
        ),
        ("format = 1\npieces = 3", "2: pieces is not a table"),
        ("format = 1\npieces.snare = 3", "2: pieces.snare is not a table"),
        ("format = 1\nroom = []", "2: room is not a table"),
        (
            "format = 1\nmicrophones.overheads_m = [[1, 2, 3]]",
            "2: microphones.overheads_m is an array of 1, ",
        ),
        // Unknown fields, with the units of the known ones.
        (
            "format = 1\n[pieces.snare]\ndiamter_in = 13",
            "3: pieces.snare.diamter_in is not known, accepted: kind, title, ",
        ),
        (
            "format = 1\n[pieces.snare]\nbatter.foo = 13",
            "3: pieces.snare.batter.foo is not known, accepted: thickness_m (or _in, _cm, _mm), ",
        ),
        (
            "format = 1\npieces.snare.shell.foo = 13",
            "2: pieces.snare.shell.foo is not known, accepted: depth_m (or",
        ),
        (
            "format = 1\npieces.snare.wires.stiffness_n_mm = 1",
            "2: pieces.snare.wires.stiffness_n_mm is not known, ",
        ),
        ("format = 1\nfoo = 13", "2: foo is not known, accepted: format, about, starts_from, remove"),
        // Missing ones.
        ("format = 1\n\n[pieces.gong]\ndiameter_in = 20", "3: pieces.gong.kind is missing, accepted: a kind"),
        (
            "format = 1\n\n[pieces.gong]\nkind = \"cymbal\"\ndiameter_in = 20",
            "3: pieces.gong.mass_kg is missing, accepted: mass_kg (or _g)",
        ),
        (
            "format = 1\npieces.gong.kind = \"gong\"",
            "2: pieces.gong.kind is `gong`, accepted: drum, cymbal, hi-hat",
        ),
        (
            "format = 1\n[pieces.kick.shell]\nkind = \"kettle\"\nair_q = 3",
            "2: pieces.kick.shell.volume_m3 is missing, ",
        ),
        (
            "format = 1\n[pieces.kick.shell]\nkind = \"x\"",
            "3: pieces.kick.shell.kind is `x`, accepted: cylinder, kettle",
        ),
        ("format = 1\nstarts_from = \"nothing\"\n[pieces.a]\n", "3: pieces.a.kind is missing"),
        (
            "format = 1\n\npieces.kick.batter = \"none\"",
            "3: pieces.kick.batter is \"none\", accepted: only for",
        ),
        // The same field twice, in one way or another.
        (
            "format = 1\n[pieces.snare]\ndiameter_in = 13\ndiameter_m = 0.3",
            "4: pieces.snare.diameter_m is given together with pieces.snare.diameter_in",
        ),
        (
            "format = 1\n[pieces.snare]\ndiameter_in = 13\ndiameter_in = 12",
            "4: this is not valid TOML: duplicate key",
        ),
        ("format = 1\n[pieces.snare]\n[pieces.snare]", "3: this is not valid TOML: duplicate key"),
        ("format = 1\n[pieces.snare\n", "2: this is not valid TOML: "),
        ("format = 1\npieces.snare.title = \"a\nb\"", "3: this is not valid TOML: "),
        ("", "1: format is missing, accepted: format = 1"),
        ("\nformat = 2", "2: format is `2`, accepted: 1"),
        ("\nformat = \"1\"", "2: format is `\"1\"`, accepted: 1"),
        (
            "format = 1\nstarts_from = \"jazz\"",
            "2: starts_from is `\"jazz\"`, accepted: \"standard\", \"nothing\"",
        ),
        // Pieces that are not there, or have no name.
        ("format = 1\nremove = [\"kick\",\n\"gong\"]", "3: remove.1 is `gong`, accepted: kick, snare, "),
        ("format = 1\nremove = 3", "2: remove is not an array"),
        (
            "format = 1\nstarts_from = \"nothing\"\nremove = [\"kick\"]",
            "3: remove.0 is `kick`, accepted: none",
        ),
        (
            "format = 1\n[pieces.gong]\nlike = \"tam\"",
            "3: pieces.gong.like is `tam`, accepted: crash, floor-tom, ",
        ),
        ("format = 1\n[pieces.gong]\nlike = 3", "3: pieces.gong.like is not a string"),
        (
            "format = 1\n[pieces.kick]\nlike = \"snare\"",
            "3: pieces.kick.like is `snare`, accepted: an instrument of the library, to take the place of `kick`; a copy of another piece needs a new name",
        ),
        (
            "format = 1\n[pieces.a]\nlike = \"b\"\n[pieces.b]\nlike = \"a\"",
            "5: pieces.b.like is `a`, which is itself",
        ),
        ("format = 1\n[pieces.a]\nlike = \"a\"", "3: pieces.a.like is `a`, accepted: "),
        (
            "format = 1\n[pieces.\"\"]\nlike = \"kick\"",
            "2: pieces..name is ``, accepted: 1 to 24 lower-case letters",
        ),
        ("format = 1\n[pieces.\"A\\nb\"]\nlike = \"crash\"", "2: pieces.A\\nb.name is `A\\nb`, accepted: "),
        (
            "format = 1\n[pieces.a]\nlike = \"crash\"\ntitle = \"\"",
            "4: pieces.a.title is ``, accepted: 1 to 24 characters",
        ),
        (
            "format = 1\n[pieces.snare-2]\nlike = \"snare\"",
            "2: pieces.snare-2.place.centre_m is [-0.40, 0.66, -0.40], inside `snare`, accepted: [",
        ),
        ("format = 1\n[pieces.kick]\nslot = 10", "3: pieces.kick.slot is 10, accepted: 1 to 9"),
        ("format = 1\n[pieces.kick]\nslot = 0", "3: pieces.kick.slot is 0, accepted: 1 to 9"),
        (
            "format = 1\n[pieces.kick]\nslot = 2\n[pieces.snare]\nslot = 2",
            "5: pieces.snare.slot is 2, which pieces.kick has",
        ),
        ("format = 1\nstarts_from = \"nothing\"", "1: pieces are 0, accepted: 1 to 16"),
        // Notes.
        (
            "format = 1\n[pieces.kick]\nnotes = [36,\n38]\n[pieces.snare]\nnotes = [38]",
            "6: pieces.snare.notes.0 is note 38, which pieces.kick.notes.1 has too",
        ),
        ("format = 1\n[pieces.kick]\nnotes = [36, 36]", "3: pieces.kick.notes.1 is note 36, which"),
        ("format = 1\n[pieces.kick]\nnotes = [36]\n[silent]\n36 = \"x\"", "5: silent.36 is note 36, which"),
        ("format = 1\n[pieces.kick]\nnotes = [128]", "3: pieces.kick.notes.0 is 128, accepted: 0 to 127"),
        ("format = 1\n[pieces.kick]\nnotes = [-1]", "3: pieces.kick.notes.0 is -1, accepted: an integer"),
        (
            "format = 1\n[pieces.kick]\nnotes = [\n{ note = 300 }]",
            "4: pieces.kick.notes.0.note is 300, accepted: 0 to 127",
        ),
        ("format = 1\n[pieces.kick]\nnotes = 36", "3: pieces.kick.notes is not an array"),
        ("format = 1\n[pieces.kick]\nnotes = [\"C1\"]", "3: pieces.kick.notes.0 is not a note"),
        ("format = 1\n[pieces.kick]\nnotes = [{ at = 0.3 }]", "3: pieces.kick.notes.0.note is missing"),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, at = 1.5 }]",
            "3: pieces.kick.notes.0.at is 1.5, accepted: 0 to 1",
        ),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, angle_deg = 400 }]",
            "3: pieces.kick.notes.0.angle_deg is 400, accepted: -360 to 360",
        ),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, stick = \"axe\" }]",
            "3: pieces.kick.notes.0.stick is `axe`, accepted: stick, shoulder",
        ),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, foot = \"chick\" }]",
            "3: pieces.kick.notes.0.foot is given, accepted: only on a hi-hat",
        ),
        (
            "format = 1\n[pieces.hi-hat]\nnotes = [{ note = 36, foot = \"x\" }]",
            "3: pieces.hi-hat.notes.0.foot is `x`, accepted: chick, splash",
        ),
        (
            "format = 1\n[pieces.hi-hat]\nnotes = [{ note = 36, foot = 2 }]",
            "3: pieces.hi-hat.notes.0.foot is 2, accepted: 0 to 1",
        ),
        (
            "format = 1\n[pieces.hi-hat]\nnotes = [{ note = 36, foot = 0, at = 0.5 }]",
            "3: pieces.hi-hat.notes.0.foot is given with a stroke",
        ),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, foo = 1 }]",
            "3: pieces.kick.notes.0.foo is not known, accepted: pedal, foot, note",
        ),
        (
            "format = 1\n[pieces.kick]\nnotes = [{ note = 36, name = \"\" }]",
            "3: pieces.kick.notes.0.name is ``, accepted: 1 to 40",
        ),
        (
            "format = 1\n[pieces.kick]\nposition_controller = 20",
            "3: pieces.kick.position_controller is not accepted: one of 16 to 19",
        ),
        ("format = 1\n[silent]\n200 = \"x\"", "3: silent.200 is not a note, accepted: 0 to 127"),
        ("format = 1\n[silent]\n20 = 3", "3: silent.20 is 3, accepted: a text"),
        ("format = 1\n[silent]\n20 = \"\"", "3: silent.20 is ``, accepted: 1 to 40 characters"),
    ] {
        let error = error(text);
        assert!(error.starts_with(expected), "{text}\n{error}\n{expected}");
    }
}

#[test]
fn parts_that_do_not_fit_are_refused_at_their_fields() {
    let rivets = "{ number = 3, radius = 0.8, toward_rad = 0, mass_kg = 0.001, play_m = 0.002 }";
    let mesh = "{ flow_resistance_pa_s_m = 4, open = 0.4 }";
    for (line, expected) in [
        (
            format!("hi-hat.top.rivets = {rivets}"),
            "hi-hat.top.rivets is given, accepted: none, rivets are in cymbals on stands",
        ),
        (
            format!("ride.rivets = {}", rivets.replace('3', "13")),
            "ride.rivets.number is 13, accepted: 1 to 12",
        ),
        (
            format!("ride.rivets = {}", rivets.replace("0.8", "1.2")),
            "ride.rivets.radius is 1.2, accepted: 0.3 to 0.98",
        ),
        (
            format!("rack-tom.batter.mesh = {mesh}"),
            "rack-tom.resonant is given, accepted: none under a mesh, through which the air between the heads escapes",
        ),
        (
            format!("timpani.batter.mesh = {}", mesh.replace("0.4", "1")),
            "timpani.batter.mesh.open is 1, accepted: 0.05 to 0.9",
        ),
    ] {
        let refused = error(&format!("format = 1\npieces.{line}"));
        assert!(refused.ends_with(expected), "{line}\n{refused}\n{expected}");
    }
}

#[test]
fn seventeen_pieces_are_one_too_many() {
    let pieces: String = (0..8).map(|i| format!("[pieces.crash-{i}]\nlike = \"crash\"\n")).collect();
    let expected = format!("16: pieces are 17, accepted: 1 to {SLOTS}");
    assert_eq!(error(&format!("format = 1\n{pieces}")), expected);
    assert!(
        error(
            "format = 1\n\nremove = [\"kick\", \"snare\", \"rack-tom\", \"floor-tom\", \"crash\", \"ride\", \
         \"splash\", \"timpani\", \"hi-hat\"]"
        )
        .starts_with("3: pieces are 0")
    );
}

#[test]
fn deep_and_large_files_are_refused_at_once() {
    let nested = format!("format = 1\na = {}1{}", "[".repeat(5000), "]".repeat(5000));
    assert!(error(&nested).starts_with("2: "));
    // The parser does not say where this is.
    let dotted =
        read("my.toml", &format!("format = 1\na{} = 1", ".a".repeat(100_000))).map(|_| ()).unwrap_err();
    assert_eq!(dotted.to_string(), "my.toml: this is not valid TOML: recursion limit");
    assert!(error(&format!("format = 1\na{} = 1", ".a".repeat(20))).contains("is nested too deep"));
    assert!(
        error(&format!("format = 1\nb = {}1{}", "[".repeat(20), "]".repeat(20)))
            .contains("is nested too deep")
    );
    let many: String = (0..20_000).map(|i| format!("[pieces.p{i}]\nlike = \"p{}\"\n", i + 1)).collect();
    assert!(error(&format!("format = 1\n{many}")).contains("pieces are 20009, accepted: 1 to 16"));
    let large = format!("format = 1\n#{}", "x".repeat(LARGEST));
    let refused = read("my.toml", &large).map(|_| ()).unwrap_err().to_string();
    assert_eq!(refused, "my.toml: is too large, accepted: up to 1048576 bytes");
}

#[test]
fn files_that_are_none_are_refused() {
    let folder = std::env::temp_dir().join(format!("kit-file-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, content).unwrap();
        load(&path)
    };
    let own = write(&KitDocument::standard());
    assert_eq!(file("own.toml", own.as_bytes()), Ok(KitDocument::standard()));
    let refused = |name: &str, content: &[u8]| file(name, content).map(|_| ()).unwrap_err().to_string();
    assert!(
        refused("a.toml", b"format = 1\n\xff\n")
            .ends_with("a.toml, line 2: this is not text, accepted: TOML in UTF-8")
    );
    assert!(refused("b.toml", &vec![b'#'; LARGEST + 1]).contains("b.toml: is too large"));
    assert_eq!(refused("c\nd.toml", b"").lines().count(), 1);
    let missing = load(&folder.join("missing.toml")).map(|_| ()).unwrap_err().to_string();
    assert!(missing.contains("missing.toml: cannot be read: "), "{missing}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_level_of_the_whole_kit_that_is_too_much_for_a_piece_is_told_at_its_line() {
    let piece = "[pieces.snare]\ndefaults.level_db = 8";
    assert_eq!(
        error(&format!("format = 1\n\nlevel_db = 6\n{piece}")),
        "3: level_db is 6, which puts `snare` at 14 dB, accepted with it: -68 to 4"
    );
    assert!(error("format = 1\nlevel_db = 21").starts_with("2: level_db is 21, accepted: -40 to 20"));
    // What is wrong without it is told where it stands.
    let wrong = "[pieces.snare]\ndefaults.level_db = 13";
    assert!(
        error(&format!("format = 1\nlevel_db = 1\n{wrong}")).starts_with("4: pieces.snare.defaults.level_db")
    );
}

#[test]
fn what_no_such_instrument_can_be_is_refused_with_the_nearest_that_can_be_built() {
    for (piece, field, value) in [
        // Heads that would tear, and slack ones.
        ("snare", "pitch_hz", 900.0),
        ("snare", "pitch_hz", 5.0),
        ("snare", "highest_pitch_hz", 2_000.0),
        ("rack-tom", "highest_pitch_hz", 500.0),
        ("kick", "pitch_hz", 1.0),
        ("floor-tom", "resonant.pitch_ratio", 9.0),
        // Foils, and what nobody could lift.
        ("crash", "mass_g", 60.0),
        ("crash", "mass_g", 9_000.0),
        ("hi-hat", "top.mass_g", 50.0),
        ("hi-hat", "bottom.mass_g", 50.0),
    ] {
        let text = |value: &str| format!("format = 1\n[pieces.{piece}]\n{field} = {value}");
        let refused = error(&text(&value.to_string()));
        let start = format!("3: pieces.{piece}.{field} is {value}, accepted: ");
        let range = refused.strip_prefix(&start).unwrap_or_else(|| panic!("{refused}"));
        let [least, most] = range.split_once(" to ").map(|(least, most)| [least, most]).expect(&refused);
        let nearest = if value < least.parse().unwrap() { least } else { most };
        assert!(read("my.toml", &text(nearest)).is_ok(), "{refused}, but {nearest} is refused too");
    }
}

/// What a refusal names: the field that is refused and those that have to follow it, each with a value that is accepted.
fn named(refused: &str) -> Vec<(String, f64)> {
    let (path, _) = refused.split_once(": ").unwrap().1.split_once(" is ").expect(refused);
    let accepted = refused.split_once("accepted: ").expect(refused).1;
    let (piece, field) = path.split_at(path.match_indices('.').nth(1).unwrap().0);
    let field = &field[1..];
    let values = format!("{field} {accepted}");
    let named = values.split(", with ").map(|one| {
        let (field, value) = one.split_once(' ').unwrap();
        let value = value.trim_start_matches("up to ").trim_end_matches(" or more");
        (format!("{piece}.{field}"), value.parse().unwrap_or_else(|_| panic!("{refused}")))
    });
    named.collect()
}

#[test]
fn heads_that_would_tear_or_not_be_held_are_refused_with_pitches_that_all_heads_accept() {
    let pitches = |piece: &str, [lowest, pitch, highest]: [f64; 3]| {
        let path = format!("pieces.{piece}");
        vec![
            (format!("{path}.lowest_pitch_hz"), lowest),
            (format!("{path}.pitch_hz"), pitch),
            (format!("{path}.highest_pitch_hz"), highest),
        ]
    };
    let with = |mut all: Vec<(String, f64)>, field: &str, value: f64| {
        all.push((field.to_owned(), value));
        all
    };
    let thick = |pitches| with(pitches, "pieces.rack-tom.batter.thickness_m", 2e-3);
    for (mut fields, expected) in [
        (pitches("rack-tom", [310.0, 310.0, 1_100.0]), "resonant head would be strained by"),
        // The other head is the tighter one.
        (
            with(pitches("rack-tom", [310.0, 310.0, 1_100.0]), "pieces.rack-tom.resonant.pitch_ratio", 0.8),
            "batter head would be strained by",
        ),
        // The pitch, and even the lowest, are beyond it as well.
        (pitches("rack-tom", [400.0, 1_400.0, 1_500.0]), ", with pitch_hz up to"),
        (pitches("rack-tom", [1_000.0, 1_000.0, 1_100.0]), ", with lowest_pitch_hz up to"),
        (pitches("kick", [400.0, 500.0, 900.0]), "head would be strained by"),
        (pitches("timpani", [400.0, 500.0, 1_500.0]), "batter head would be strained by"),
        // Films that are plates.
        (thick(pitches("rack-tom", [30.0, 100.0, 120.0])), "batter head would be held by its stiffness"),
        (thick(pitches("rack-tom", [15.0, 16.0, 17.0])), ", with pitch_hz "),
        // No pitch at all suits both heads.
        (
            with(
                with(
                    thick(pitches("rack-tom", [60.0, 100.0, 200.0])),
                    "pieces.rack-tom.batter.material.youngs_modulus_pa",
                    1e12,
                ),
                "pieces.rack-tom.resonant.material.youngs_modulus_pa",
                1e8,
            ),
            "rack-tom.batter.thickness_m is 0.002, ",
        ),
    ] {
        let text = |fields: &[(String, f64)]| {
            let lines = fields.iter().map(|(field, value)| format!("{field} = {value:?}\n"));
            format!("format = 1\n{}", lines.collect::<String>())
        };
        let refused = error(&text(&fields));
        assert!(refused.contains(expected), "{refused}\n{expected}");
        for (field, value) in named(&refused) {
            let of_field = fields.iter_mut().find(|(name, _)| *name == field).expect(&field);
            of_field.1 = value;
        }
        let again = read("my.toml", &text(&fields)).map(|_| ());
        assert_eq!(again, Ok(()), "{refused}");
    }
}

#[test]
fn what_is_put_inside_another_piece_is_refused_with_the_nearest_place_that_is_free() {
    let text = |piece: &str, centre: &str| {
        format!("format = 1\n[pieces.{piece}]\nlike = \"crash\"\nplace.centre_m = {centre}")
    };
    for (inside, centre) in [
        ("crash", "[-0.64, 1.2, 0.0]"),
        ("crash", "[-0.62, 1.2, 0.0]"),
        ("ride", "[0.68, 1.06, -0.04]"),
        // Inside a drum.
        ("floor-tom", "[0.47, 0.50, -0.34]"),
        ("kick", "[0.0, 0.30, 0.0]"),
        ("hi-hat", "[-0.72, 0.861, -0.30]"),
    ] {
        let refused = error(&text("crash-2", centre));
        assert!(refused.starts_with("4: pieces.crash-2.place.centre_m is ["), "{refused}");
        let (_, accepted) = refused.split_once(&format!("inside `{inside}`, accepted: ")).expect(&refused);
        let free = &accepted[..=accepted.find(']').expect(&refused)];
        assert!(read("my.toml", &text("crash-2", free)).is_ok(), "{refused}");
    }
    // Crashes over a ride and over one another, as drummers hang them.
    for centre in ["[0.5, 1.2, -0.04]", "[-0.64, 1.26, 0.0]", "[-0.5, 1.2, 0.35]"] {
        assert!(read("my.toml", &text("crash-2", centre)).is_ok(), "{centre}");
    }
}
