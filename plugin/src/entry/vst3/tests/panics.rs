//! A plugin that panics wherever a host can call it, and a host that goes on.

use super::*;
use crate::entry::vst3::factory::{GetPluginFactory, loaded};
use crate::guard::failing::while_panicking;

/// What the host gets from a call during which the entry of that name panics.
fn survived<T>(entry: &'static str, call: impl FnOnce() -> T) -> T {
    let (result, panics) = while_panicking(entry, call);
    assert!(panics > 0, "{entry} was not reached");
    result
}

#[test]
fn a_panic_of_the_module_and_its_factory_is_kept_from_the_host() {
    assert!(survived("GetPluginFactory", || GetPluginFactory()).is_null());
    assert!(!survived("module entry", loaded));
    let factory = Factory::new();
    // SAFETY: the calls a host makes, with room for what it asks for.
    unsafe {
        let mut info: PClassInfo = std::mem::zeroed();
        assert_eq!(survived("IPluginFactory", || factory.getClassInfo(0, &mut info)), kInternalError);
        let mut object = ptr::null_mut();
        let interface = <IComponent as nice_plug::wrapper::vst3::vst3::Interface>::IID;
        let class = factory.plugins[0].cid;
        let mut create =
            || factory.createInstance(class.as_ptr().cast(), interface.as_ptr().cast(), &mut object);
        assert_eq!(survived("IPluginFactory::createInstance", &mut create), kInternalError);
        // Without its window it is an instance all the same.
        assert_eq!(survived("editor", &mut create), kResultOk);
        let unknown = object.cast::<FUnknown>();
        assert_eq!(((*(*unknown).vtbl).release)(unknown), 0);
    }
}

#[test]
fn a_panic_of_an_instance_is_kept_from_the_host() {
    let guard = multi();
    // SAFETY: the calls a host makes, with room for what it asks for.
    unsafe {
        let (audio, output) = (0, 1);
        assert_eq!(survived("IComponentTrait::getBusCount", || guard.getBusCount(audio, output)), 0);
        assert_eq!(survived("IComponentTrait::setActive", || guard.setActive(1)), kInternalError);
        let id = overhear_player::parameters::host_id("master");
        assert_eq!(
            survived("IEditControllerTrait::getParamNormalized", || guard.getParamNormalized(id)),
            0.0
        );
        let mut text: String128 = [0; 128];
        survived("value_to_text", || guard.getParamStringByValue(id, 0.5, &mut text));
        let mut typed = [u16::from(b'-') as TChar, u16::from(b'6') as TChar, 0];
        let mut value = 0.0;
        let told =
            survived("text_to_value", || guard.getParamValueByString(id, typed.as_mut_ptr(), &mut value));
        assert_ne!(told, kResultOk);
        let view = survived("IEditControllerTrait::createView", || guard.createView(c"editor".as_ptr()));
        assert!(view.is_null());
        assert_eq!(survived("IUnitInfoTrait::getUnitCount", || guard.getUnitCount()), 1);
        let name = survived("IUnitInfoTrait::getProgramPitchName", || {
            guard.getProgramPitchName(1, 0, 38, &mut text)
        });
        assert_eq!(name, kInvalidArgument);
    }
    for entry in ["IAudioProcessorTrait::process", "Plugin::process"] {
        let mut data = silent();
        // SAFETY: a call without outputs, which is completed.
        assert_ne!(survived(entry, || unsafe { guard.process(&mut data) }), kResultOk, "{entry}");
    }
    let sound = survived("the engine", || processed(&guard, BUSES, |_, _| {}));
    assert!(sound.iter().flatten().all(|channel| written(channel)), "a broken engine is silent");
    processed(&guard, BUSES, |_, _| {});
}

#[test]
fn where_the_framework_would_panic_it_is_not_asked() {
    let guard = Guard::<OverhearMulti>::new();
    // SAFETY: processing was never set up.
    unsafe {
        assert_eq!(IPluginBaseTrait::initialize(&guard, ptr::null_mut()), kResultOk);
        assert_eq!(guard.process(&mut silent()), kNotInitialized);
    }
}

/// A buffer without outputs, events and parameters.
fn silent() -> ProcessData {
    ProcessData {
        processMode: 0,
        symbolicSampleSize: 0,
        numSamples: FRAMES as i32,
        numInputs: 0,
        numOutputs: 0,
        inputs: ptr::null_mut(),
        outputs: ptr::null_mut(),
        inputParameterChanges: ptr::null_mut(),
        outputParameterChanges: ptr::null_mut(),
        inputEvents: ptr::null_mut(),
        outputEvents: ptr::null_mut(),
        processContext: ptr::null_mut(),
    }
}
