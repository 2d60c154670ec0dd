use std::collections::BTreeMap;

use overhear_engine::kit_spec::{KitSpec, PieceSpec};

use super::*;
use crate::kit_document::KitDocument;
use crate::midi::assignments::Assignment;
use crate::parameters::COUNT;

fn ordered(json_params: &[(&str, StoredValue)]) -> BTreeMap<String, f32> {
    let params = json_params.iter().map(|(id, value)| (id.to_string(), value.clone()));
    let mut state = State { values: params.collect(), fields: BTreeMap::new() };
    state.fields.insert(SCHEMA_FIELD.to_owned(), SCHEMA.to_string());
    put_in_order(&mut state);
    let plain = |(id, value)| match value {
        StoredValue::Number(value) => (id, value),
        StoredValue::Switch(value) => (id, f32::from(value)),
        other => panic!("{id} is {other:?}"),
    };
    state.values.into_iter().map(plain).collect()
}

#[test]
fn a_state_without_parameters_is_all_defaults() {
    let values = ordered(&[]);
    assert_eq!(values.len(), COUNT + 1);
    assert_eq!(values[BYPASS_ID], 0.0);
    assert!(parameters().iter().all(|parameter| values[parameter.id] == parameter.default));
}

#[test]
fn stored_values_are_kept_and_missing_ones_reset() {
    let values = ordered(&[("01tune", StoredValue::Number(1.5))]);
    assert_eq!((values["01tune"], values["02muff"]), (1.5, 0.0));
}

#[test]
fn broken_values_are_put_right_and_unknown_ones_dropped() {
    let values = ordered(&[
        ("01tune", StoredValue::Number(1e9)),
        ("02muff", StoredValue::Number(f32::NAN)),
        ("01levl", StoredValue::Other("loud".into())),
        ("02tune", StoredValue::Number(f32::NEG_INFINITY)),
        ("nobody", StoredValue::Number(1.0)),
        (BYPASS_ID, StoredValue::Number(1.0)),
    ]);
    assert_eq!((values["01tune"], values["02muff"]), (12.0, 0.0));
    let level = parameters().iter().find(|parameter| parameter.id == "01levl").unwrap();
    assert_eq!((values["01levl"], values["02tune"]), (level.default, -12.0));
    assert!(!values.contains_key("nobody"));
    assert_eq!(values[BYPASS_ID], 0.0);
    assert_eq!(ordered(&[(BYPASS_ID, StoredValue::Switch(true))])[BYPASS_ID], 1.0);
}

/// A state with this kit in its fields, put in order.
fn with_kit(text: &str) -> State {
    let fields = [(SCHEMA_FIELD, "2"), (KIT_FIELD, text), (NOTES_FIELD, "38=49")];
    let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    let values = [("01levl".to_owned(), StoredValue::Number(-20.0))].into();
    let mut state = State { values, fields };
    put_in_order(&mut state);
    state
}

/// The standard kit without its crash, and with a larger kick that is muffled more.
fn other_kit() -> KitDocument {
    let mut kit = KitSpec::standard();
    kit.pieces.remove(4);
    kit.pieces[0].defaults.muffle = 0.5;
    let notes = crate::midi_map::NoteTable::standard(&kit);
    KitDocument { kit, notes }
}

#[test]
fn a_kit_is_stored_and_read_back_and_the_standard_one_is_left_out() {
    assert_eq!(kit_text(&KitDocument::standard()), None);
    assert_eq!(kit(&BTreeMap::new()), Ok(KitDocument::standard()));
    let document = other_kit();
    let state = with_kit(&kit_text(&document).unwrap());
    assert_eq!(kit(&state.fields), Ok(document.clone()));
    let value = |id: &str| match state.values[id] {
        StoredValue::Number(value) => value,
        ref other => panic!("{id} is {other:?}"),
    };
    assert_eq!((value("01levl"), value("01muff")), (-20.0, 0.5), "what is missing is at the kit's default");
}

#[test]
fn of_a_state_whose_kit_cannot_be_read_nothing_is_left() {
    let cut = kit_text(&other_kit()).unwrap();
    for text in ["", "format = 7", "no kit", &cut[..cut.len() / 2], "format = 1\nremove = [\"gong\"]"] {
        assert_eq!(with_kit(text), State::default(), "{text}");
    }
}

#[test]
fn assignments_are_stored_and_broken_ones_left_out() {
    let changed = BTreeMap::from([(38, Assignment::Plays(49)), (40, Assignment::Silent)]);
    assert_eq!(notes_text(&changed), "38=49 40=silent");
    assert_eq!(notes(&notes_text(&changed)), changed);
    assert_eq!(notes("38=49 x 300=38 41=loud 40=silent =  200=38"), changed);
    assert!(notes("").is_empty());
}

/// What a host keeps of a kit of sixteen of these pieces: all parameters and fields as the shell writes them, bytes.
fn stored_size(piece: &str) -> usize {
    let others = "kick snare rack-tom floor-tom crash ride splash hi-hat timpani".split(' ');
    let mut text = format!("format = 1\nremove = {:?}\n", others.collect::<Vec<_>>());
    for number in 1..=16 {
        text += &format!(
            "[pieces.a-name-of-24-letters-{number:02}]\nlike = \"{piece}\"\nplace.centre_m = [{}.123456789, 0.7, {}.987654321]\n",
            number % 4,
            number / 4,
        );
        text += &format!("notes = [{}, {}, {}, {}]\n", number, 20 + number, 40 + number, 60 + number);
    }
    let document = crate::kit_file::read("sixteen", &text).unwrap_or_else(|error| panic!("{error}"));
    let mut state = with_kit(&kit_text(&document).unwrap());
    for value in state.values.values_mut() {
        if let StoredValue::Number(value) = value {
            *value += 0.123_456_7;
        }
    }
    let values: BTreeMap<_, _> = state
        .values
        .iter()
        .map(|(id, value)| match value {
            StoredValue::Number(value) => (id, serde_json::json!({ "f32": value })),
            other => (id, serde_json::json!({ "bool": *other == StoredValue::Switch(true) })),
        })
        .collect();
    let json = serde_json::json!({ "version": "0.1.0", "params": values, "fields": state.fields });
    json.to_string().len()
}

#[test]
fn a_state_of_sixteen_pieces_is_smaller_than_64_kilobytes() {
    for piece in ["snare-14-standard", "hats-14", "crash-16", "kick-22x18"] {
        let size = stored_size(piece);
        println!("16 of {piece}: {size} bytes");
        assert!(size < 64_000, "16 of {piece}: {size} bytes");
    }
}

#[test]
fn a_project_whose_cymbals_stand_in_one_another_is_loaded_with_the_later_ones_beside() {
    let mut document = KitDocument::standard();
    let mut second = document.kit.find("crash").unwrap().1.clone();
    second.name = "crash-2".to_owned();
    document.kit.pieces.push(second);
    assert!(document.check().is_err());
    let state = with_kit(&crate::kit_file::write(&document));
    let loaded = kit(&state.fields).unwrap();
    assert_eq!(loaded.check(), Ok(()));
    assert_eq!(loaded.kit.pieces[..9], document.kit.pieces[..9]);
    let [before, after] = [&document, &loaded].map(|document| document.kit.pieces[9].clone());
    assert!(overhear_engine::layout::distance(&before.place.centre, &after.place.centre) < 0.03);
    assert_eq!(PieceSpec { place: before.place, ..after }, before);
}
