//! Partial files: what they change, and what stays.

use overhear_engine::kit_spec::{InstrumentSpec, Kind, KitSpec, PieceSpec};
use overhear_engine::numbers::{Numbers as _, Visitor};
use overhear_engine::strike::Striker;

use super::super::fresh;
use super::{accepted, changed};
use crate::kit_document::KitDocument;
use crate::midi_map::{Foot, Meaning, NoteTable};

fn names(document: &KitDocument) -> Vec<&str> {
    document.kit.pieces.iter().map(|piece| &*piece.name).collect()
}

fn piece<'a>(document: &'a KitDocument, name: &str) -> &'a PieceSpec {
    document.kit.find(name).unwrap().1
}

/// The name of the piece that a note strikes, where, and with what.
fn struck(document: &KitDocument, note: u8) -> Option<(&str, f64, Striker)> {
    let stroke = document.notes.stroke(note)?;
    Some((&document.kit.piece(stroke.slot)?.name, stroke.radius, stroke.striker))
}

#[test]
fn a_file_that_changes_nothing_is_the_standard_kit() {
    assert_eq!(changed(""), KitDocument::standard());
    assert_eq!(
        changed("starts_from = \"standard\"\n[pieces]\n[room]\n[pieces.snare]"),
        KitDocument::standard()
    );
}

#[test]
fn a_field_is_changed_and_the_others_stay() {
    let document = changed(
        "[pieces.snare]\ndiameter_in = 13\nbatter.thickness_mm = 0.3\n[room]\nreverberation_ms = 800",
    );
    let mut own = KitDocument::standard();
    own.kit.pieces[1].instrument = match own.kit.pieces[1].instrument {
        InstrumentSpec::Drum(mut drum) => {
            drum.diameter = 0.3302;
            drum.batter.thickness = 0.3e-3;
            InstrumentSpec::Drum(drum)
        }
        other => other,
    };
    own.kit.room.time = 0.8;
    assert_eq!(document, own);
}

#[test]
fn every_unit_is_converted() {
    let document = changed(
        "pieces.kick = { diameter_cm = 50, pitch_khz = 0.06, hoop = \"none\" }\n\
         pieces.ride = { mass_g = 2100, alloy.youngs_modulus_gpa = 100, muffler.angle_deg = 90 }\n\
         pieces.timpani.shell.volume_l = 130\n\
         pieces.rack-tom.place.centre_cm = [-15, 90, -10]\n\
         pieces.snare.batter.thickness_in = 0.01",
    );
    let drum = |name| *piece(&document, name).drum().unwrap();
    assert_eq!((drum("kick").diameter, drum("kick").pitch_hz), (0.5, 60.0));
    assert_eq!(drum("snare").batter.thickness, 0.000254);
    assert_eq!(piece(&document, "rack-tom").place.centre, [-0.15, 0.9, -0.1]);
    let shell = format!("{:?}", drum("timpani").shell);
    assert!(shell.contains("volume: 0.13,"), "{shell}");
    let ride = format!("{:?}", piece(&document, "ride").instrument);
    assert!(
        ride.contains("mass: 2.1,") && ride.contains("100000000000.0") && ride.contains("1.57079632"),
        "{ride}"
    );
}

#[test]
fn optional_parts_are_taken_away_and_put_back() {
    let document = changed("[pieces.kick]\nresonant = \"none\"\n[pieces.crash]\nbell = \"none\"");
    assert!(piece(&document, "kick").drum().unwrap().resonant.is_none());
    let document = changed(
        "[pieces.timpani]\nhoop = { material = { youngs_modulus_gpa = 200, poisson_ratio = 0.3, density_kg_m3 = 7850 }, \
         wall_mm = 2, height_mm = 40, flange_mm = 10, q = 50, drum_mass_kg = 30, stand_hz = 15, stand_q = 2 }",
    );
    assert_eq!(piece(&document, "timpani").drum().unwrap().hoop.unwrap().wall, 0.002);
    let vent = "[pieces.snare]\nshell.vent_diameter_in = 0.5\n[pieces.timpani]\nshell.vent_diameter_mm = 20";
    let document = changed(vent);
    let vent =
        |document: &KitDocument, name| piece(document, name).drum().unwrap().shell.unwrap().vent_diameter();
    assert_eq!(
        ["snare", "timpani", "kick"].map(|name| vent(&document, name)),
        [Some(0.0127), Some(0.02), None]
    );
    let document = changed(
        "[pieces.snare]\nshell.vent_diameter_in = 0.5\n[pieces.second]\nlike = \"snare\"\nshell.vent_diameter_m = \"none\"\n\
         place.centre_m = [3, 0.7, 3]",
    );
    assert_eq!(["snare", "second"].map(|name| vent(&document, name)), [Some(0.0127), None]);
}

#[test]
fn a_microphones_contour_is_changed_and_taken_away() {
    let contour = |text: &str| piece(&changed(text), "kick").close.contour();
    assert_eq!(contour("[pieces.kick]\nclose.contour = \"none\""), None);
    let deeper = contour("[pieces.kick]\nclose.contour.dip_db = -12").unwrap();
    assert_eq!((deeper.dip_db, deeper.dip_hz), (-12.0, 500.0));
    let snare =
        "[pieces.snare]\nclose.contour = { dip_hz = 400, dip_db = 0, presence_hz = 6000, presence_db = 6 }";
    assert_eq!(piece(&changed(snare), "snare").close.contour().unwrap().presence_db, 6.0);
}

#[test]
fn a_table_of_another_kind_replaces_the_former() {
    let document = changed("[pieces.snare]\nmuffler = { kind = \"ring\", sigma_1_s = 50, inner = 0.8 }");
    let muffler = format!("{:?}", piece(&document, "snare").drum().unwrap().muffler);
    assert_eq!(muffler, "Ring { sigma: 50.0, inner: 0.8 }");
}

#[test]
fn removed_pieces_leave_no_hole_and_new_ones_follow() {
    let document = changed(
        "remove = [\"snare\", \"timpani\"]\n[pieces.zap]\nlike = \"splash\"\n[pieces.bell]\nlike = \"ride\"",
    );
    let expected = ["kick", "rack-tom", "floor-tom", "crash", "ride", "splash", "hi-hat", "zap", "bell"];
    assert_eq!(names(&document), expected);
    assert_eq!(piece(&document, "zap").title, "Zap");
    // Only the standard kit without these pieces, and its notes.
    let mut kit = KitSpec::standard();
    kit.pieces.retain(|piece| !["snare", "timpani"].contains(&&*piece.name));
    assert_eq!(document.notes, NoteTable::standard(&kit));
}

#[test]
fn slots_put_pieces_where_they_say() {
    let document = changed(
        "[pieces.kick-2]\nlike = \"kick\"\nslot = 2\nplace.centre_m = [-0.7, 0.3, -0.23]\n[pieces.hi-hat]\nslot = 1",
    );
    assert_eq!(names(&document)[..4], ["hi-hat", "kick-2", "kick", "snare"]);
    // Notes go with their pieces.
    assert_eq!(struck(&document, 38).unwrap().0, "snare");
    assert_eq!(document.notes.foot(44).map(|(slot, _)| slot.index()), Some(0));
}

#[test]
fn a_likeness_is_that_of_the_changed_piece() {
    let document = changed(
        "[pieces.big]\nlike = \"crash-2\"\nmass_kg = 2\n[pieces.crash-2]\nlike = \"crash\"\ndiameter_in = 18\n\
         [pieces.crash]\ntaper = 0.7",
    );
    let big = format!("{:?}", piece(&document, "big").instrument);
    assert!(
        big.contains("taper: 0.7") && big.contains("diameter: 0.4572") && big.contains("mass: 2.0"),
        "{big}"
    );
    assert_eq!(piece(&document, "crash-2").title, "Crash 2");
}

#[test]
fn a_cymbal_that_is_only_said_to_be_like_another_is_put_where_there_is_room() {
    let document = changed("[pieces.crash-2]\nlike = \"crash\"\n[pieces.crash-3]\nlike = \"crash\"");
    let standard = KitSpec::standard();
    let place = |name: &str| piece(&document, name).place;
    assert_eq!(place("crash"), standard.find("crash").unwrap().1.place);
    let [second, third] = ["crash-2", "crash-3"].map(place);
    assert!(second != place("crash") && third != second && third != place("crash"));
    for moved in [second, third] {
        let way = overhear_engine::layout::distance(&moved.centre, &place("crash").centre);
        assert!(way < 0.05, "{moved:?}");
    }
    // Cymbals that overlap without meeting stay where they are.
    let ride = changed("[pieces.crash-2]\nlike = \"crash\"\nplace.centre_m = [-0.6, 1.3, 0.0]");
    assert_eq!(piece(&ride, "crash-2").place.centre, [-0.6, 1.3, 0.0]);
}

#[test]
fn a_removed_piece_is_there_to_be_like() {
    let document =
        changed("remove = [\"crash\"]\n[pieces.left]\nlike = \"crash\"\n[pieces.crash]\nlike = \"crash\"");
    assert_eq!(piece(&document, "left").instrument, piece(&document, "crash").instrument);
    assert_eq!(names(&document)[7..], ["hi-hat", "left", "crash"]);
    assert_eq!(document.notes.row(49).unwrap().meaning, Meaning::Silent);
}

#[test]
fn notes_take_the_place_and_stick_of_the_standard_notes() {
    let document = changed(
        "[pieces.crash-2]\nlike = \"crash\"\nnotes = [57, 52, 20]\n\
         [pieces.kick-2]\nlike = \"kick\"\nplace.centre_m = [-0.7, 0.3, -0.23]\nnotes = [{ note = 21, at = 0.5 }, 35]",
    );
    assert_eq!(struck(&document, 57), Some(("crash-2", 0.97, Striker::Shoulder)));
    assert_eq!(document.notes.row(57).unwrap().name, "Crash Cymbal 2");
    // A note that nothing plays in the start is played as the piece it is like.
    assert_eq!(struck(&document, 20), Some(("crash-2", 0.97, Striker::Shoulder)));
    assert_eq!(document.notes.row(20).unwrap().name, "Crash 2");
    assert_eq!(struck(&document, 21), Some(("kick-2", 0.5, Striker::FeltBeater)));
    assert_eq!(struck(&document, 35).unwrap().0, "kick-2");
    assert_eq!(struck(&document, 36).unwrap().0, "kick");
    assert_eq!(struck(&document, 49).unwrap().0, "crash");
}

#[test]
fn notes_of_a_piece_replace_those_that_it_had() {
    let document = changed(
        "[pieces.snare]\nnotes = [{ note = 70, name = \"DelayTap\", angle_deg = 90, stick = \"nylon\" }]",
    );
    assert_eq!(struck(&document, 70), Some(("snare", 0.25, Striker::Nylon)));
    let angle = document.notes.stroke(70).unwrap().angle;
    assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    for note in [37, 38, 40, 94] {
        assert_eq!(document.notes.row(note).unwrap().meaning, Meaning::Silent);
    }
    let (slot, _) = document.kit.find("snare").unwrap();
    assert_eq!(document.notes.ordinary(slot), Some(70));
    assert_eq!(document.notes.position_controller(slot), Some(16));
}

#[test]
fn the_ordinary_note_is_the_first_stroke_or_the_one_that_says_so() {
    let ordinary = |notes: &str| {
        let document = changed(&format!("[pieces.hi-hat]\nnotes = {notes}"));
        let (slot, _) = document.kit.find("hi-hat").unwrap();
        document.notes.ordinary(slot)
    };
    assert_eq!(ordinary("[44, 46, 42]"), Some(46));
    assert_eq!(ordinary("[46, { note = 42, ordinary = true }]"), Some(42));
    assert_eq!(ordinary("[{ note = 42, ordinary = false }]"), None);
    assert_eq!(ordinary("[44]"), None);
    // A piece that has lost its ordinary note to another has the first that is left.
    let document = changed("[pieces.crash-2]\nlike = \"crash\"\nnotes = [49]");
    let (slot, _) = document.kit.find("crash").unwrap();
    assert_eq!(document.notes.ordinary(slot), Some(52));
}

#[test]
fn feet_and_pedals() {
    let document = changed(
        "[pieces.hi-hat]\nposition_controller = \"none\"\nnotes = [42, { note = 46, pedal = \"none\" }, 44, \
         { note = 20, foot = \"splash\" }, { note = 21, foot = 0.5 }, { note = 22, pedal = 1 }, { note = 97, at = 0.5 }]\n\
         [pieces.kick]\nposition_controller = 17",
    );
    let foot = |note| document.notes.foot(note).map(|(_, foot)| foot);
    assert_eq!(foot(42), Some(Foot::Position(0.8)));
    assert_eq!(foot(46), None);
    assert_eq!(foot(44), Some(Foot::Chick));
    assert_eq!(foot(20), Some(Foot::Splash));
    assert_eq!(foot(21), Some(Foot::Position(0.5)));
    assert_eq!(foot(22), Some(Foot::Position(1.0)));
    assert_eq!(struck(&document, 97).map(|(_, at, _)| at), Some(0.5));
    let controller = |name| document.notes.position_controller(document.kit.find(name).unwrap().0);
    assert_eq!((controller("hi-hat"), controller("kick"), controller("snare")), (None, Some(17), Some(16)));
}

#[test]
fn silent_notes_silence() {
    let document = changed("[silent]\n38 = \"Off\"\n5 = \"Five\"");
    assert_eq!(document.notes.row(38).unwrap().meaning, Meaning::Silent);
    assert_eq!(document.notes.row(5).unwrap().name, "Five");
    let (slot, _) = document.kit.find("snare").unwrap();
    assert_eq!(document.notes.ordinary(slot), Some(37));
}

#[test]
fn a_new_file_is_the_standard_kit_until_its_comments_are_taken_away() {
    let text = fresh("My kit\n[x]");
    assert_eq!(accepted(&text), KitDocument::standard());
    let uncommented: Vec<String> = text
        .lines()
        .map(|line| match line.strip_prefix('#') {
            Some(rest) if !rest.is_empty() && !rest.starts_with(' ') => rest.to_owned(),
            _ => line.to_owned(),
        })
        .collect();
    // Whose table a key is in is told by the header above it: `remove` stands before all.
    let document = accepted(&uncommented.join("\n"));
    assert!(document.kit.find("timpani").is_none() && document.kit.find("crash-2").is_some());
}

#[test]
fn fourteen_pieces_play_from_a_partial_file() {
    let document = accepted(include_str!("../../../../assets/kits/fourteen.toml"));
    assert_eq!(document.kit.pieces.len(), 14);
    let of = |kind| document.kit.pieces.iter().filter(|piece| piece.instrument.kind() == kind).count();
    assert_eq!((of(Kind::Drum), of(Kind::Cymbal), of(Kind::HiHat)), (8, 5, 1));
    for (slot, piece) in document.kit.slots() {
        assert!(document.notes.ordinary(slot).is_some(), "{}", piece.name);
    }
}

/// The names of all numbers that are visited.
#[derive(Default)]
struct Names(Vec<String>);

impl Visitor for Names {
    fn number(&mut self, name: &str, _value: &mut f64, _accepted: std::ops::RangeInclusive<f64>) {
        self.0.push(name.split('.').next().unwrap().to_owned());
    }

    fn enter(&mut self, part: &str) {
        self.0.push(part.to_owned());
    }

    fn leave(&mut self) {}
}

#[test]
fn the_manual_has_every_field_and_its_examples_are_read() {
    let manual = include_str!("../../../../docs/kit-files.md");
    let mut names = Names::default();
    for mut piece in KitSpec::standard().pieces {
        if let InstrumentSpec::Drum(drum) = &mut piece.instrument {
            drum.shell = drum.shell.map(|shell| shell.vented(Some(0.0127)));
        }
        piece.visit(&mut names);
    }
    for name in names.0 {
        let written = [format!("`{name}`"), format!("`{name}."), format!("`place.{name}`")];
        let here = written.iter().any(|written| manual.contains(written));
        assert!(here, "{name}");
    }
    let blocks: Vec<&str> =
        manual.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 3);
    for block in &blocks {
        accepted(block);
    }
    assert_eq!(blocks[2], include_str!("../../../../assets/kits/fourteen.toml"));
}
