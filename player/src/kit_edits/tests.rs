use overhear_engine::kit_spec::InstrumentSpec;

use super::sizes::{Size, Units, resize};
use super::*;
use crate::library;
use crate::midi_map::Meaning;

fn standard() -> KitDocument {
    KitDocument::standard()
}

fn instrument(name: &str) -> Instrument {
    library::instrument(name).unwrap()
}

fn slot(document: &KitDocument, name: &str) -> Slot {
    document.kit.find(name).unwrap().0
}

#[test]
fn a_second_crash_gets_general_midi_s_second_note_and_free_ones_for_the_rest() {
    let edit = add(&standard(), &instrument("crash-18-thin")).unwrap();
    let (notes, new) = (&edit.document.notes, edit.about);
    assert_eq!((new, edit.origins[9]), (Slot::ALL[9], Origin::New));
    let ordinary = notes.ordinary(new).unwrap();
    assert!([52, 57].contains(&ordinary), "{ordinary}");
    let own: Vec<u8> = notes.rows().filter(|(_, row)| row.meaning.slot() == Some(new)).map(|n| n.0).collect();
    assert!(own.len() >= 4, "edge, bow, bell, choke: {own:?}");
    assert!(notes.rows().any(|(_, row)| row.meaning == Meaning::Chokes(new)));
    // The first one has kept its own.
    assert_eq!(notes.ordinary(slot(&edit.document, "crash")), Some(49));
}

#[test]
fn every_instrument_of_the_library_can_be_added_and_put_in_every_place() {
    let standard = standard();
    for instrument in library::instruments() {
        let edit = add(&standard, &instrument).unwrap_or_else(|error| panic!("{}: {error}", instrument.name));
        let ordinary = edit.document.notes.ordinary(edit.about);
        assert!(ordinary.is_some(), "{} has no note", instrument.name);
        let twice = duplicate(&edit.document, edit.about).unwrap();
        assert_ne!(twice.document.notes.ordinary(twice.about), ordinary);
        assert!(twice.document.notes.ordinary(twice.about).is_some());
    }
}

#[test]
fn what_is_added_duplicated_or_exchanged_until_the_kit_is_full_stands_in_nothing() {
    let mut starts = vec![standard()];
    starts.extend(library::kits().map(|kit| kit.document().unwrap()));
    for start in starts {
        for name in ["ride-24-light", "crash-20-thin", "hats-16-light", "kick-24x18", "splash-8"] {
            let large = instrument(name);
            // In every place, beside what is there.
            for (slot, piece) in start.kit.slots() {
                let exchanged = exchange(&start, slot, &large);
                assert!(exchanged.is_ok(), "{name} for {}: {exchanged:?}", piece.name);
            }
            let mut full = add(&start, &large).unwrap();
            while full.document.kit.pieces.len() < SLOTS {
                full =
                    duplicate(&full.document, full.about).unwrap_or_else(|error| panic!("{name}: {error}"));
            }
        }
    }
}

#[test]
fn a_kit_has_no_more_than_sixteen_pieces_and_no_fewer_than_one() {
    let mut document = standard();
    for _ in document.kit.pieces.len()..SLOTS {
        document = add(&document, &instrument("splash-8")).unwrap().document;
    }
    let error = add(&document, &instrument("splash-8")).unwrap_err().to_string();
    assert_eq!(error, "pieces would be 17, accepted: 1 to 16; remove one first");
    while document.kit.pieces.len() > 1 {
        document = remove(&document, Slot::ALL[0]).unwrap().document;
    }
    assert!(remove(&document, Slot::ALL[0]).is_err());
}

#[test]
fn a_piece_that_goes_leaves_all_others_but_the_last_in_their_slots() {
    let document = standard();
    let edit = remove(&document, slot(&document, "snare")).unwrap();
    let after = &edit.document;
    assert_eq!(slot(after, "hi-hat"), slot(&document, "snare"));
    for name in ["kick", "rack-tom", "ride", "timpani"] {
        assert_eq!(slot(after, name), slot(&document, name));
    }
    assert_eq!(after.notes.ordinary(slot(after, "hi-hat")), Some(42));
    assert_eq!(after.notes.row(38).map(|row| row.meaning), Some(Meaning::Silent));
    // It comes back to its own notes.
    let again = add(after, &instrument("snare-14-standard")).unwrap();
    assert_eq!(again.document.notes.ordinary(again.about), Some(38));
}

#[test]
fn one_of_the_same_kind_takes_over_name_place_and_notes() {
    let document = standard();
    let snare = slot(&document, "snare");
    let edit = exchange(&document, snare, &instrument("piccolo-13")).unwrap();
    let piece = edit.document.kit.piece(snare).unwrap();
    assert_eq!((&*piece.name, piece.place), ("snare", document.kit.piece(snare).unwrap().place));
    assert_eq!(edit.document.notes, document.notes);
    let ride = exchange(&document, snare, &instrument("ride-20-flat")).unwrap();
    assert_ne!(ride.document.kit.piece(snare).unwrap().name, "snare");
    assert_eq!(ride.document.notes.ordinary(slot(&document, "ride")), Some(51));
    assert!(ride.document.notes.ordinary(snare).is_some());
}

#[test]
fn sizes_are_refused_with_the_range_and_the_nearest_that_works() {
    let document = standard();
    let (tom, crash) = (slot(&document, "rack-tom"), slot(&document, "crash"));
    let of = |slot, size, value| resize(&document, slot, size, value, Units::Inches);
    let edit = of(tom, Size::Diameter, 14.0 * 0.0254).unwrap();
    let (before, after) = (document.kit.piece(tom).unwrap(), edit.document.kit.piece(tom).unwrap());
    let pitch = |piece: &PieceSpec| piece.drum().unwrap().pitch_hz;
    assert!((pitch(after) / pitch(before) - 12.0 / 14.0).abs() < 1e-9, "the heads keep their tension");
    for (slot, size, value, says) in [
        (tom, Size::Diameter, 2.0, "accepted: 5.91 in to"),
        (tom, Size::Pitch, 480.0, "strained"),
        (crash, Size::Weight, 0.05, "Weight is 50 g, accepted:"),
        (tom, Size::Right, -0.4, "inside `snare`"),
    ] {
        // The tom is put where the snare stands.
        let refused = match size {
            Size::Right => {
                let there = document.kit.find("snare").unwrap().1.place;
                let under = change(&document, tom, |piece| {
                    piece.place.centre = [0.0, there.centre[1], there.centre[2]];
                    piece.place.facing = there.facing;
                });
                resize(&under.unwrap().document, slot, size, value, Units::Inches).unwrap_err()
            }
            _ => of(slot, size, value).unwrap_err(),
        };
        assert!(refused.words.contains(says), "{}", refused.words);
        let nearest = refused.nearest.unwrap();
        assert!(size == Size::Right || of(slot, size, nearest).is_ok(), "{nearest}: {}", refused.words);
    }
}

#[test]
fn sizes_are_read_as_they_are_shown() {
    for (text, units, metres) in [
        ("13", Units::Inches, 0.3302),
        ("13 in", Units::Millimetres, 0.3302),
        ("330 mm", Units::Inches, 0.33),
        ("33 cm", Units::Inches, 0.33),
        ("330,2", Units::Millimetres, 0.3302),
    ] {
        assert!((Size::Diameter.parse(text, units).unwrap() - metres).abs() < 1e-12, "{text}");
    }
    assert_eq!(Size::Diameter.parse("wide", Units::Inches), None);
    assert_eq!(Size::Diameter.text(0.3302, Units::Inches), "13 in");
    assert_eq!(Size::Weight.text(1.1, Units::Inches), "1100 g");
}

#[test]
fn vents_are_put_in_sized_and_go_with_the_head_that_closes_the_shell() {
    let document = standard();
    let tom = slot(&document, "rack-tom");
    let vent = |document: &KitDocument| Size::Vent.of(document.kit.piece(tom).unwrap());
    assert_eq!(vent(&document), None);
    let switch = |document, on| change(document, tom, |piece| features::Feature::Vent.switch(piece, on));
    let put_in = switch(&document, true).unwrap().document;
    assert_eq!(vent(&put_in), Some(0.0127));
    assert_eq!(vent(&switch(&put_in, false).unwrap().document), None);
    let of = |text: &str| {
        let value = Size::Vent.parse(text, Units::Inches).unwrap();
        resize(&put_in, tom, Size::Vent, value, Units::Inches)
    };
    assert!((vent(&of("0.375").unwrap().document).unwrap() - 0.009525).abs() < 1e-12);
    let refused = of("3").unwrap_err();
    assert!(refused.words.contains("Vent is 3 in, accepted: 0.08 in to 1.97 in"), "{}", refused.words);
    assert_eq!(refused.nearest, Some(0.05));
    // Without its other head the shell is open.
    let piece = put_in.kit.piece(tom).unwrap();
    let resonant = crate::kit_file::parts::of(piece).into_iter().find(|part| part.label == "Resonant head");
    let opened = resonant.unwrap().fitted(piece, None).unwrap();
    assert_eq!((features::Feature::Vent.of(&opened), Size::Vent.of(&opened)), (None, None));
}

#[test]
fn rivets_are_put_in_and_sized() {
    let document = standard();
    let ride = slot(&document, "ride");
    let put_in =
        change(&document, ride, |piece| features::Feature::Rivets.switch(piece, true)).unwrap().document;
    let rivets = |document: &KitDocument| match document.kit.piece(ride).unwrap().instrument {
        InstrumentSpec::Cymbal(cymbal) => cymbal.rivets.unwrap(),
        _ => unreachable!("a ride is a cymbal"),
    };
    let of = |size: Size, text: &str| {
        resize(&put_in, ride, size, size.parse(text, Units::Inches).unwrap(), Units::Inches)
    };
    assert_eq!(rivets(&of(Size::Rivets, "3").unwrap().document).number, 3);
    assert_eq!(rivets(&of(Size::RivetWeight, "2 g").unwrap().document).mass, 2e-3);
    assert_eq!(rivets(&of(Size::RivetPlay, "1.5").unwrap().document).play, 1.5e-3);
    assert_eq!(rivets(&of(Size::RivetPlace, "85 %").unwrap().document).radius, 0.85);
    let arc = rivets(&of(Size::RivetArc, "30 °").unwrap().document).arc.unwrap();
    assert!((arc - std::f64::consts::PI / 6.0).abs() < 1e-12);
    assert_eq!(rivets(&of(Size::RivetArc, "360").unwrap().document).arc, None);
    for (size, text, says, nearest) in [
        (Size::Rivets, "20", "Rivets is 20, accepted: 1 to 12", "12"),
        (Size::Rivets, "0", "Rivets is 0, accepted: 1 to 12", "1"),
        (Size::RivetWeight, "9", "Rivet weight is 9 g, accepted: 0.3 g to 5 g", "5 g"),
        (Size::RivetArc, "357", "accepted: 1 ° to 355 °", "355 °"),
        (Size::RivetPlace, "99", "accepted: 30 % to 98 %", "98 %"),
    ] {
        let refused = of(size, text).unwrap_err();
        assert!(refused.words.contains(says), "{}", refused.words);
        assert_eq!(size.text(refused.nearest.unwrap(), Units::Inches), nearest, "{}", refused.words);
    }
}
