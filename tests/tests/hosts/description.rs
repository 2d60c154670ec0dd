//! What the plugin says of itself.

use overhear::parameters::{BYPASS_ID, PARAMETERS, host_id};
use xtask::host::Bundle;
use xtask::workspace::Format;

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
    assert_eq!(found.len(), PARAMETERS.len() + 1);
    assert_eq!(found[PARAMETERS.len()].id, host_id(BYPASS_ID));
    for (found, parameter) in found.iter().zip(&PARAMETERS) {
        assert_eq!(found.id, host_id(parameter.id), "{}", parameter.name);
        let default = f64::from(parameter.normalized(parameter.default));
        assert!((found.default - default).abs() < 1e-6, "{}", parameter.name);
        assert_eq!(found.value, found.default, "{}", parameter.name);
    }
}

#[test]
fn values_are_shown_in_units_and_read_back() {
    let _turn = alone();
    let mut instance = instance();
    for parameter in &PARAMETERS {
        let id = host_id(parameter.id);
        for plain in [parameter.min, parameter.default, parameter.max] {
            let value = f64::from(parameter.normalized(plain));
            let shown = instance.value_text(id, value).unwrap();
            assert!(shown.ends_with(parameter.unit), "{}: {shown}", parameter.name);
            let back = instance.text_value(id, &shown).unwrap();
            assert!((back - value).abs() < 1e-3, "{}: {shown} is read as {back}", parameter.name);
        }
    }
}
