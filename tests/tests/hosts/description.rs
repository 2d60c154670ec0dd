//! The plugin's description of itself.

use overhear::parameters::{
    BYPASS_ID, COUNT, SlotParameter, default_value, host_id, is_live, parameters, slot_parameter, text,
};
use overhear_cli::host::Bundle;
use overhear_cli::plugin_folders::Format;
use overhear_engine::kit_spec::{Kind, KitSpec};

use crate::{alone, bundle_path, instance};

#[test]
fn it_is_a_drum_instrument_with_one_stereo_output() {
    let _turn = alone();
    let bundle = Bundle::load(&bundle_path(Format::Clap)).unwrap();
    let plugin = &bundle.plugins()[0];
    assert_eq!((plugin.name.as_str(), plugin.id.to_str()), (overhear::NAME, Ok(overhear::CLAP_ID)));
    for feature in ["instrument", "drum", "stereo"] {
        assert!(plugin.features.iter().any(|known| known == feature), "{:?}", plugin.features);
    }
    let mut instance = bundle.instantiate().unwrap();
    let outputs = instance.audio_outputs().unwrap();
    assert_eq!(outputs.iter().map(|port| port.channels).collect::<Vec<_>>(), [2]);
    assert_eq!(instance.note_inputs().unwrap().len(), 1);
    assert_eq!(instance.latency(), 0);
}

#[test]
fn its_parameters_are_the_table_in_its_order() {
    let _turn = alone();
    let found = instance().parameters().unwrap();
    assert_eq!(found.len(), COUNT + 1);
    assert_eq!(found[COUNT].id, host_id(BYPASS_ID));
    for (found, parameter) in found.iter().zip(parameters()) {
        assert_eq!(found.id, host_id(parameter.id), "{}", parameter.name);
        let default = parameter.in_clap(parameter.default);
        assert!((found.default - default).abs() < 1e-6, "{}", parameter.name);
        assert_eq!(found.value, found.default, "{}", parameter.name);
    }
}

#[test]
fn values_are_shown_in_units_and_read_back() {
    let _turn = alone();
    let (mut instance, kit) = (instance(), KitSpec::standard());
    for (index, parameter) in parameters().iter().enumerate() {
        let id = host_id(parameter.id);
        for plain in [parameter.min, parameter.default, parameter.max] {
            let value = parameter.in_clap(plain);
            let shown = instance.value_text(id, value).unwrap();
            assert_eq!(shown, text(index, plain, &kit), "{}", parameter.name);
            let back = instance.text_value(id, &shown).unwrap();
            // A drum reaches less than an octave either way.
            if is_live(index, &kit) && (plain == parameter.default || !tunes_a_drum(index, &kit)) {
                assert!((back - value).abs() < 1e-3, "{}: {shown} is read as {back}", parameter.name);
            } else {
                assert_eq!(instance.value_text(id, back).unwrap(), shown, "{}", parameter.name);
            }
        }
    }
}

fn tunes_a_drum(index: usize, kit: &KitSpec) -> bool {
    let Some((slot, SlotParameter::Tune)) = slot_parameter(index) else { return false };
    kit.piece(slot).is_some_and(|piece| piece.instrument.kind() == Kind::Drum)
}

#[test]
fn parameters_of_the_first_slots_are_those_of_the_standard_kit_s_pieces() {
    let _turn = alone();
    let (found, kit) = (instance().parameters().unwrap(), KitSpec::standard());
    for (index, found) in found[..COUNT].iter().enumerate() {
        let Some((slot, what)) = slot_parameter(index) else { continue };
        let title =
            kit.piece(slot).map_or_else(|| format!("Slot {}", slot.index() + 1), |piece| piece.title.clone());
        assert_eq!(found.name, format!("{title} {}", what.label()));
        let default = parameters()[index].in_clap(default_value(index, &kit));
        assert!(kit.piece(slot).is_none() || (found.default - default).abs() < 1e-6, "{}", found.name);
    }
}
