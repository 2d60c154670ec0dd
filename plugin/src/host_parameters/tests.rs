use super::*;
use overhear_engine::kit_spec::KitSpec;
use overhear_player::parameters::{COUNT, find, is_live};

#[test]
fn the_host_sees_the_table_in_its_order() {
    let host = HostParameters::default();
    let map = host.param_map();
    assert_eq!(map.len(), COUNT + 1);
    assert_eq!(map[COUNT].0, BYPASS_ID);
    for ((id, _, group), parameter) in map.iter().zip(parameters()) {
        assert_eq!((id.as_str(), group.as_str()), (parameter.id, parameter.group));
    }
}

#[test]
fn what_a_host_sends_is_what_the_table_says() {
    let (host, kit) = (HostParameters::default(), KitSpec::standard());
    for (index, (parameter, value)) in parameters().iter().zip(host.values()).enumerate() {
        assert_eq!(value.default_plain_value(), parameter.default);
        for plain in [parameter.min, parameter.default, parameter.centre, parameter.max] {
            // A switch has no middle.
            let plain = parameter.snap(plain);
            let normalized = value.preview_normalized(plain);
            assert_eq!(normalized, parameter.normalized(plain), "{}", parameter.name);
            assert_eq!(value.preview_plain(normalized), plain, "{}", parameter.name);
            let text = value.normalized_value_to_string(normalized, true);
            let back = value.string_to_normalized_value(&text);
            // A drum's pitch is shown to a hundredth of a hertz, and within what it can be tuned to.
            if is_live(index, &kit) && !text.ends_with("Hz") {
                assert_eq!(back, Some(normalized), "{text}");
            } else {
                let again = back.map(|back| value.normalized_value_to_string(back, true));
                assert_eq!(again, Some(text));
            }
        }
        let middle = value.preview_plain(0.5);
        assert!((middle - parameter.centre).abs() <= parameter.step, "{}", parameter.name);
    }
}

#[test]
fn the_window_is_stored_and_restored_within_reason() {
    let parameters = HostParameters::default();
    parameters.set_window((1200, 800));
    let fields = parameters.serialize_fields();
    let restored = HostParameters::default();
    restored.deserialize_fields(&fields);
    assert_eq!(restored.window(), (1200, 800));
    restored.deserialize_fields(&BTreeMap::new());
    assert_eq!(restored.window(), (1200, 800), "there was no state");

    for (broken, kept) in
        [("[1,1]", SMALLEST_WINDOW), ("\"large\"", SMALLEST_WINDOW), ("[9e9,1]", SMALLEST_WINDOW)]
    {
        let fields = [(state::SCHEMA_FIELD, "2"), (state::WINDOW_FIELD, broken)];
        let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
        restored.deserialize_fields(&fields);
        assert_eq!(restored.window(), kept, "{broken}");
    }
}

#[test]
fn values_are_shown_as_the_present_kit_has_them() {
    let host = HostParameters::default();
    let shown = |name: &str| {
        let index = find(name, &KitSpec::standard()).unwrap();
        let value = &host.values()[index];
        value.normalized_value_to_string(value.unmodulated_normalized_value(), true)
    };
    let own = KitSpec::standard().pieces[0].instrument.tunings()[1];
    assert_eq!((shown("kick_tune"), shown("slot_10_level")), (format!("{own:.2} Hz"), "-".to_owned()));
    assert_eq!(shown("ride_tune"), "0.00 st");
    let mut kit = KitSpec::standard();
    kit.pieces.swap(0, 5);
    let notes = overhear_player::midi_map::NoteTable::standard(&kit);
    host.set_document(Arc::new(KitDocument { kit, notes })).unwrap();
    assert_eq!((shown("kick_tune"), shown("ride_tune")), ("0.00 st".to_owned(), format!("{own:.2} Hz")));
}

#[test]
fn a_kit_that_is_not_sound_is_not_taken() {
    let host = HostParameters::default();
    let mut broken = KitDocument::standard();
    broken.kit.pieces[0].defaults.muffle = 2.0;
    let error = host.set_document(Arc::new(broken)).unwrap_err().to_string();
    assert_eq!(error, "pieces.kick.defaults.muffle is 2, accepted: 0 to 1");
    assert_eq!(*host.document(), KitDocument::standard());
}
