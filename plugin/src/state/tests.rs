use std::sync::Arc;

use overhear_engine::kit_spec::KitSpec;
use overhear_player::kit_document::KitDocument;
use overhear_player::midi::assignments::{Assignment, NOTES};
use overhear_player::midi_map::NoteTable;
use overhear_player::parameters::{COUNT, parameters};
use overhear_player::state::{KIT_FIELD, NOTES_FIELD, SCHEMA_FIELD, WINDOW_FIELD, kit, kit_text};

use nice_plug::prelude::Params;

use super::*;
use crate::host_parameters::HostParameters;

/// A state with this kit in its fields, put in order.
fn with_kit(text: &str) -> PluginState {
    let fields = [(SCHEMA_FIELD, "2"), (KIT_FIELD, text), (NOTES_FIELD, "38=49")];
    let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    let params = [("01levl".to_owned(), ParamValue::F32(-20.0))].into();
    let mut state = PluginState { version: String::new(), params, fields };
    put_in_order(&mut state);
    state
}

/// The standard kit without its crash.
fn other_kit() -> KitDocument {
    let mut kit = KitSpec::standard();
    kit.pieces.remove(4);
    let notes = NoteTable::standard(&kit);
    KitDocument { kit, notes }
}

#[test]
fn a_kit_goes_through_the_framework_and_back() {
    let document = other_kit();
    let state = with_kit(&kit_text(&document).unwrap());
    assert!(matches!(state.params["01levl"], ParamValue::F32(-20.0)));
    let host = HostParameters::default();
    host.deserialize_fields(&state.fields);
    assert_eq!(*host.document(), document);
    assert_eq!(kit(&host.serialize_fields()), Ok(document));
    // A state without a kit is of the standard one.
    host.deserialize_fields(&[(SCHEMA_FIELD.to_owned(), "2".to_owned())].into());
    assert_eq!(*host.document(), KitDocument::standard());
    assert!(!host.serialize_fields().contains_key(KIT_FIELD));
}

#[test]
fn a_state_whose_kit_cannot_be_read_changes_nothing() {
    let host = HostParameters::default();
    host.set_document(Arc::new(other_kit())).unwrap();
    host.assignments().assign(3, Assignment::Plays(38));
    let before = host.serialize_fields();
    let state = with_kit("format = 7");
    assert!(state.params.is_empty() && state.fields.is_empty());
    host.deserialize_fields(&state.fields);
    assert_eq!(host.serialize_fields(), before);
}

/// What a project stores, changed at random; the sequence is the same every time.
#[test]
fn a_hundred_thousand_mutated_states_are_put_in_order_or_refused() {
    let params = parameters().iter().map(|p| (p.id.to_owned(), ParamValue::F32(p.default))).collect();
    let fields = [(SCHEMA_FIELD, "2"), (WINDOW_FIELD, "[980,640]"), (NOTES_FIELD, "38=49 40=silent")];
    let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    let state = PluginState { version: "0.1.0".into(), params, fields };
    let bytes = serde_json::to_vec(&state).unwrap();
    let host = HostParameters::default();
    let (mut random, mut read) = (fastrand::Rng::with_seed(1), 0);
    let mut next = |below: usize| random.usize(..below);
    for _ in 0..100_000 {
        let mut mutated = bytes.clone();
        for _ in 0..=next(3) {
            let at = next(mutated.len());
            match next(5) {
                0 => mutated.truncate(at.max(1)),
                1 => mutated[at] = next(256) as u8,
                2 => mutated[at] = b"0123456789.-eE\"[]{},:ntf"[next(24)],
                3 => mutated.insert(at, b"0123456789.-eE\"[]{},:ntf"[next(24)]),
                _ => {
                    mutated.remove(at);
                    mutated.push(b' ');
                }
            }
        }
        let Ok(mut state) = serde_json::from_slice::<PluginState>(&mutated) else { continue };
        read += 1;
        put_in_order(&mut state);
        // Nothing is left of a state whose field for a kit, which this one has not, came about by chance.
        if state.fields.is_empty() {
            assert!(state.params.is_empty());
            continue;
        }
        assert_eq!(state.params.len(), COUNT + 1);
        for parameter in parameters() {
            let ParamValue::F32(value) = state.params[parameter.id] else { panic!("{}", parameter.id) };
            assert!((parameter.min..=parameter.max).contains(&value), "{}: {value}", parameter.id);
        }
        host.deserialize_fields(&state.fields);
        assert!(host.assignments().changed().len() < NOTES);
    }
    assert!(read > 5_000, "only {read} could be read at all");
}
