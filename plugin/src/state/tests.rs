use super::*;
use crate::host_parameters::HostParameters;
use crate::parameters::COUNT;

fn ordered(json_params: &[(&str, ParamValue)]) -> BTreeMap<String, f32> {
    let params = json_params.iter().map(|(id, value)| (id.to_string(), value.clone()));
    let mut state = PluginState { version: String::new(), params: params.collect(), fields: BTreeMap::new() };
    state.fields.insert(SCHEMA_FIELD.to_owned(), SCHEMA.to_string());
    put_in_order(&mut state);
    let plain = |(id, value)| match value {
        ParamValue::F32(value) => (id, value),
        ParamValue::Bool(value) => (id, f32::from(value)),
        other => panic!("{id} is {other:?}"),
    };
    state.params.into_iter().map(plain).collect()
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
    let values = ordered(&[("01tune", ParamValue::F32(1.5))]);
    assert_eq!((values["01tune"], values["02muff"]), (1.5, 0.0));
}

#[test]
fn broken_values_are_put_right_and_unknown_ones_dropped() {
    let values = ordered(&[
        ("01tune", ParamValue::F32(1e9)),
        ("02muff", ParamValue::F32(f32::NAN)),
        ("01levl", ParamValue::String("loud".into())),
        ("02tune", ParamValue::F32(f32::NEG_INFINITY)),
        ("nobody", ParamValue::F32(1.0)),
        (BYPASS_ID, ParamValue::F32(1.0)),
    ]);
    assert_eq!((values["01tune"], values["02muff"]), (12.0, 0.0));
    assert_eq!((values["01levl"], values["02tune"]), (0.0, -12.0));
    assert!(!values.contains_key("nobody"));
    assert_eq!(values[BYPASS_ID], 0.0);
    assert_eq!(ordered(&[(BYPASS_ID, ParamValue::Bool(true))])[BYPASS_ID], 1.0);
}

/// A state with this kit in its fields, put in order.
fn with_kit(text: &str) -> PluginState {
    let fields = [(SCHEMA_FIELD, "2"), (KIT_FIELD, text), (NOTES_FIELD, "38=49")];
    let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    let params = [("01levl".to_owned(), ParamValue::F32(-20.0))].into();
    let mut state = PluginState { version: String::new(), params, fields };
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
    let value = |id: &str| match state.params[id] {
        ParamValue::F32(value) => value,
        ref other => panic!("{id} is {other:?}"),
    };
    assert_eq!((value("01levl"), value("01muff")), (-20.0, 0.5), "what is missing is at the kit's default");
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
    host.set_document(std::sync::Arc::new(other_kit())).unwrap();
    host.assignments().assign(3, Assignment::Plays(38));
    let before = host.serialize_fields();
    let cut = kit_text(&other_kit()).unwrap();
    for text in ["", "format = 7", "no kit", &cut[..cut.len() / 2], "format = 1\nremove = [\"gong\"]"] {
        let state = with_kit(text);
        assert!(state.params.is_empty() && state.fields.is_empty(), "{text}");
        host.deserialize_fields(&state.fields);
        assert_eq!(host.serialize_fields(), before);
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

/// What a project stores, changed at random; the sequence is the same every time (xorshift, Marsaglia 2003).
#[test]
fn a_hundred_thousand_mutated_states_are_put_in_order_or_refused() {
    let params = parameters().iter().map(|p| (p.id.to_owned(), ParamValue::F32(p.default))).collect();
    let fields = [(SCHEMA_FIELD, "2"), (WINDOW_FIELD, "[980,640]"), (NOTES_FIELD, "38=49 40=silent")];
    let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    let state = PluginState { version: "0.1.0".into(), params, fields };
    let bytes = serde_json::to_vec(&state).unwrap();
    let host = HostParameters::default();
    let (mut seed, mut read) = (1_u64, 0);
    let mut next = |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 33) as usize % below
    };
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
