//! The VST3 entry: both instruments, each behind a guard.
//!
//! A guard is an object with all interfaces of the framework's, which it owns and passes calls on to. Its own are: it
//! prepares scratch when processing is set up, completes the outputs of `process`, and tells units and the names of
//! notes.
#![allow(non_snake_case)]

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::Arc;

use nice_plug::prelude::*;
use nice_plug::wrapper::setup_logger;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::ChannelContext::{IInfoListener, IInfoListenerTrait};
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    AudioBusBuffers, AudioBusBuffers__type0, BusDirection, BusInfo, CtrlNumber, IAttributeList,
    IAudioProcessor, IAudioProcessorTrait, IComponent, IComponentHandler, IComponentTrait, IEditController,
    IEditControllerTrait, IMidiMapping, IMidiMappingTrait, INoteExpressionController,
    INoteExpressionControllerTrait, IProcessContextRequirements, IProcessContextRequirementsTrait, IUnitInfo,
    IoMode, MediaType, NoteExpressionTypeID, NoteExpressionTypeInfo, NoteExpressionValue, ParamID,
    ParamValue, ParameterInfo, ProcessData, ProcessSetup, RoutingInfo, SpeakerArrangement, String128, TChar,
};
use nice_plug::wrapper::vst3::vst3::Steinberg::{
    FIDString, FUnknown, IBStream, IPlugView, IPluginBaseTrait, IPluginFactory, IPluginFactory2,
    IPluginFactory2Trait, IPluginFactory3, IPluginFactory3Trait, IPluginFactoryTrait, PClassInfo,
    PClassInfo2, PClassInfoW, PFactoryInfo, TBool, TUID, int16, int32, kInternalError, kInvalidArgument,
    kNotInitialized, kResultOk, tresult, uint32,
};
use nice_plug::wrapper::vst3::vst3::{Class, ComWrapper};
use nice_plug::wrapper::vst3::{PluginInfo, Wrapper};

use super::scratch::{CHANNELS, Scratch};
use crate::guard::caught;
use crate::host_parameters::{self, HostParameters};
use crate::plugin::{Overhear, OverhearMulti};

/// The framework's object, and what completes a host's outputs.
struct Guard<P: Vst3Plugin> {
    framework: Wrapper<P>,
    outputs: UnsafeCell<Outputs>,
    parameters: Option<Arc<HostParameters>>,
}

/// Scratch, and the buses made of it for one call.
struct Outputs {
    scratch: Scratch,
    buses: Vec<AudioBusBuffers>,
    /// Whether processing has been set up.
    ready: bool,
}

impl<P: Vst3Plugin> Guard<P> {
    fn new() -> Guard<P> {
        let ports = P::AUDIO_IO_LAYOUTS.first().map_or(0, |layout| 1 + layout.aux_output_ports.len());
        let outputs =
            Outputs { scratch: Scratch::new(ports), buses: Vec::with_capacity(ports), ready: false };
        let framework = Wrapper::new();
        let parameters = host_parameters::take_latest();
        Guard { framework, outputs: UnsafeCell::new(outputs), parameters }
    }
}

impl<P: Vst3Plugin> Class for Guard<P> {
    type Interfaces = (
        IComponent,
        IEditController,
        IAudioProcessor,
        IMidiMapping,
        INoteExpressionController,
        IProcessContextRequirements,
        IUnitInfo,
        IInfoListener,
    );
}

/// What a host gets to hear of a call that panicked.
macro_rules! failed {
    (tresult) => {
        kInternalError
    };
    (ViewPointer) => {
        std::ptr::null_mut()
    };
    ($number:ident) => {
        $number::default()
    };
}

/// Passes the calls of an interface on, and keeps panics from the host. Whoever calls has promised the format's contract,
/// which is all that the framework asks.
macro_rules! pass_on {
    ($interface:ident { $($method:ident($($argument:ident: $type:ty),*) -> $result:ident;)* }) => {
        impl<P: Vst3Plugin> $interface for Guard<P> {
            $(pass_on!(@ $interface $method($($argument: $type),*) -> $result);)*
        }
    };
    (@ $interface:ident $method:ident($($argument:ident: $type:ty),*) -> $result:ident) => {
        unsafe fn $method(&self, $($argument: $type),*) -> $result {
            caught(concat!(stringify!($interface), "::", stringify!($method)), failed!($result), || {
                // SAFETY: see above.
                unsafe { <Wrapper<P> as $interface>::$method(&self.framework, $($argument),*) }
            })
        }
    };
}

/// A window in the host's hands.
type ViewPointer = *mut IPlugView;

pass_on!(IPluginBaseTrait {
    initialize(context: *mut FUnknown) -> tresult;
    terminate() -> tresult;
});

pass_on!(IComponentTrait {
    getControllerClassId(class: *mut TUID) -> tresult;
    setIoMode(mode: IoMode) -> tresult;
    getBusCount(media: MediaType, direction: BusDirection) -> int32;
    getBusInfo(media: MediaType, direction: BusDirection, index: int32, info: *mut BusInfo) -> tresult;
    getRoutingInfo(input: *mut RoutingInfo, output: *mut RoutingInfo) -> tresult;
    activateBus(media: MediaType, direction: BusDirection, index: int32, state: TBool) -> tresult;
    setActive(state: TBool) -> tresult;
    setState(state: *mut IBStream) -> tresult;
    getState(state: *mut IBStream) -> tresult;
});

pass_on!(IEditControllerTrait {
    setComponentState(state: *mut IBStream) -> tresult;
    setState(state: *mut IBStream) -> tresult;
    getState(state: *mut IBStream) -> tresult;
    getParameterCount() -> int32;
    getParameterInfo(index: int32, info: *mut ParameterInfo) -> tresult;
    getParamStringByValue(id: ParamID, value: ParamValue, text: *mut String128) -> tresult;
    getParamValueByString(id: ParamID, text: *mut TChar, value: *mut ParamValue) -> tresult;
    normalizedParamToPlain(id: ParamID, value: ParamValue) -> ParamValue;
    plainParamToNormalized(id: ParamID, value: ParamValue) -> ParamValue;
    getParamNormalized(id: ParamID) -> ParamValue;
    setParamNormalized(id: ParamID, value: ParamValue) -> tresult;
    setComponentHandler(handler: *mut IComponentHandler) -> tresult;
    createView(name: FIDString) -> ViewPointer;
});

impl<P: Vst3Plugin> IAudioProcessorTrait for Guard<P> {
    pass_on!(@ IAudioProcessorTrait setBusArrangements(
        inputs: *mut SpeakerArrangement, input_count: int32, outputs: *mut SpeakerArrangement, output_count: int32
    ) -> tresult);
    pass_on!(@ IAudioProcessorTrait getBusArrangement(
        direction: BusDirection, index: i32, arrangement: *mut SpeakerArrangement
    ) -> tresult);
    pass_on!(@ IAudioProcessorTrait canProcessSampleSize(size: int32) -> tresult);
    pass_on!(@ IAudioProcessorTrait getLatencySamples() -> uint32);
    pass_on!(@ IAudioProcessorTrait setProcessing(state: TBool) -> tresult);
    pass_on!(@ IAudioProcessorTrait getTailSamples() -> uint32);

    unsafe fn setupProcessing(&self, setup: *mut ProcessSetup) -> tresult {
        // SAFETY: `setup` is null or valid; processing is set up only while nothing is processed, so that nobody
        // else holds the outputs.
        caught("IAudioProcessorTrait::setupProcessing", kInternalError, || unsafe {
            if let Some(setup) = setup.as_ref() {
                (*self.outputs.get()).scratch.prepare(setup.maxSamplesPerBlock.max(0) as usize);
            }
            let result = self.framework.setupProcessing(setup);
            (*self.outputs.get()).ready |= result == kResultOk;
            result
        })
    }

    unsafe fn process(&self, data: *mut ProcessData) -> tresult {
        // SAFETY: as `complete` wants it.
        caught("IAudioProcessorTrait::process", kInternalError, || unsafe {
            let frames = data.as_ref().map_or(0, |data| data.numSamples.max(0) as usize);
            match &self.parameters {
                Some(parameters) => parameters.deadlines().timed(frames, || self.complete(data)),
                None => self.complete(data),
            }
        })
    }
}

impl<P: Vst3Plugin> Guard<P> {
    /// Processes with every output there.
    ///
    /// # Safety
    /// As the format says of `process`.
    unsafe fn complete(&self, data: *mut ProcessData) -> tresult {
        // SAFETY: `data` is null or valid with all it points to; `process` overlaps with neither itself nor
        // `setupProcessing`, so that nobody else holds the outputs.
        unsafe {
            let Some(given) = data.as_mut() else { return kInvalidArgument };
            let Outputs { scratch, buses, ready } = &mut *self.outputs.get();
            // The framework panics when it processes before that.
            if !*ready {
                return kNotInitialized;
            }
            // A call without samples only brings parameters.
            if given.numSamples <= 0 || is_complete(given, scratch.ports()) {
                return self.framework.process(data);
            }
            let completed = scratch.complete(given.numSamples as usize, |bus| match bus_of(given, bus) {
                Some(bus) => (bus.__field0.channelBuffers32, bus.numChannels.max(0) as usize),
                None => (std::ptr::null_mut(), 0),
            });
            let Some(pointers) = completed else { return kInvalidArgument };
            buses.clear();
            buses.extend(pointers.iter_mut().map(|table| AudioBusBuffers {
                numChannels: CHANNELS as int32,
                silenceFlags: 0,
                __field0: AudioBusBuffers__type0 { channelBuffers32: table.as_mut_ptr() },
            }));
            let (outputs, count) = (given.outputs, given.numOutputs);
            (given.outputs, given.numOutputs) = (buses.as_mut_ptr(), buses.len() as int32);
            let result = caught("process", kInternalError, || self.framework.process(data));
            // The host's again, even after a panic: it may keep the structure from call to call.
            (given.outputs, given.numOutputs) = (outputs, count);
            result
        }
    }
}

/// # Safety
/// `data` and all it points to are valid.
unsafe fn bus_of(data: &ProcessData, bus: usize) -> Option<&AudioBusBuffers> {
    if data.outputs.is_null() || bus >= data.numOutputs.max(0) as usize {
        return None;
    }
    // SAFETY: within the host's buses.
    Some(unsafe { &*data.outputs.add(bus) })
}

/// Whether the host gives every declared bus with its two channels.
///
/// # Safety
/// `data` and all it points to are valid.
unsafe fn is_complete(data: &ProcessData, buses: usize) -> bool {
    // SAFETY: as promised; tables hold as many pointers as the bus has channels.
    (0..buses).all(|bus| unsafe {
        bus_of(data, bus).is_some_and(|bus| {
            let table = bus.__field0.channelBuffers32;
            bus.numChannels as usize == CHANNELS
                && !table.is_null()
                && (0..CHANNELS).all(|channel| !(*table.add(channel)).is_null())
        })
    })
}

pass_on!(IMidiMappingTrait {
    getMidiControllerAssignment(bus: int32, channel: int16, controller: CtrlNumber, id: *mut ParamID) -> tresult;
});

pass_on!(INoteExpressionControllerTrait {
    getNoteExpressionCount(bus: int32, channel: int16) -> int32;
    getNoteExpressionInfo(bus: int32, channel: int16, index: int32, info: *mut NoteExpressionTypeInfo) -> tresult;
    getNoteExpressionStringByValue(
        bus: int32, channel: int16, id: NoteExpressionTypeID, value: NoteExpressionValue, text: *mut String128
    ) -> tresult;
    getNoteExpressionValueByString(
        bus: int32, channel: int16, id: NoteExpressionTypeID, text: *const TChar, value: *mut NoteExpressionValue
    ) -> tresult;
});

pass_on!(IProcessContextRequirementsTrait {
    getProcessContextRequirements() -> uint32;
});

mod units;

pass_on!(IInfoListenerTrait {
    setChannelContextInfos(list: *mut IAttributeList) -> tresult;
});

/// Makes both instruments.
struct Factory {
    plugins: [PluginInfo; 2],
}

impl Class for Factory {
    type Interfaces = (IPluginFactory, IPluginFactory2, IPluginFactory3);
}

impl Factory {
    fn new() -> Factory {
        Factory { plugins: [PluginInfo::for_plugin::<Overhear>(), PluginInfo::for_plugin::<OverhearMulti>()] }
    }

    /// Writes what is known of the plugin of an index.
    ///
    /// # Safety
    /// `into` is null or valid.
    unsafe fn describe<T>(&self, index: int32, into: *mut T, describe: fn(&PluginInfo) -> T) -> tresult {
        caught("IPluginFactory", kInternalError, || {
            let plugin = usize::try_from(index).ok().and_then(|index| self.plugins.get(index));
            // SAFETY: as promised.
            match (plugin, unsafe { into.as_mut() }) {
                (Some(plugin), Some(into)) => {
                    *into = describe(plugin);
                    kResultOk
                }
                _ => kInvalidArgument,
            }
        })
    }
}

impl IPluginFactoryTrait for Factory {
    unsafe fn getFactoryInfo(&self, info: *mut PFactoryInfo) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(0, info, PluginInfo::create_factory_info) }
    }

    unsafe fn countClasses(&self) -> int32 {
        self.plugins.len() as int32
    }

    unsafe fn getClassInfo(&self, index: int32, info: *mut PClassInfo) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info) }
    }

    unsafe fn createInstance(
        &self,
        class: FIDString,
        interface: FIDString,
        into: *mut *mut c_void,
    ) -> tresult {
        if class.is_null() || interface.is_null() || into.is_null() {
            return kInvalidArgument;
        }
        // SAFETY: both ids are 16 bytes, and `into` is valid, by the format's contract.
        caught("IPluginFactory::createInstance", kInternalError, || unsafe {
            match &*class.cast::<[u8; 16]>() {
                class if class == self.plugins[0].cid => made(Guard::<Overhear>::new(), interface, into),
                class if class == self.plugins[1].cid => made(Guard::<OverhearMulti>::new(), interface, into),
                _ => kInvalidArgument,
            }
        })
    }
}

/// Hands an object out as the interface asked for.
///
/// # Safety
/// `interface` is 16 bytes, `into` valid.
unsafe fn made<P: Vst3Plugin>(guard: Guard<P>, interface: FIDString, into: *mut *mut c_void) -> tresult {
    let object = ComWrapper::new(guard);
    let Some(unknown) = object.as_com_ref::<FUnknown>() else { return kInvalidArgument };
    let unknown = unknown.as_ptr();
    // SAFETY: `unknown` lives as long as `object`; asking it for an interface takes a reference of the host's.
    unsafe { ((*(*unknown).vtbl).queryInterface)(unknown, interface.cast(), into) }
}

impl IPluginFactory2Trait for Factory {
    unsafe fn getClassInfo2(&self, index: int32, info: *mut PClassInfo2) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info_2) }
    }
}

impl IPluginFactory3Trait for Factory {
    unsafe fn getClassInfoUnicode(&self, index: int32, info: *mut PClassInfoW) -> tresult {
        // SAFETY: `info` is null or valid.
        unsafe { self.describe(index, info, PluginInfo::create_class_info_unicode) }
    }

    unsafe fn setHostContext(&self, _context: *mut FUnknown) -> tresult {
        kResultOk
    }
}

#[unsafe(no_mangle)]
extern "system" fn GetPluginFactory() -> *mut c_void {
    caught("GetPluginFactory", std::ptr::null_mut(), || {
        let factory = ComWrapper::new(Factory::new()).to_com_ptr::<IPluginFactory>();
        factory.map_or(std::ptr::null_mut(), |factory| factory.into_raw().cast())
    })
}

/// What every system's entry does.
fn loaded() -> bool {
    caught("module entry", false, || {
        setup_logger::<Overhear>();
        true
    })
}

#[cfg(all(target_family = "unix", not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleEntry(_library: *mut c_void) -> bool {
    loaded()
}

#[cfg(all(target_family = "unix", not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleExit() -> bool {
    true
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleEntry(_bundle: *mut c_void) -> bool {
    loaded()
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleExit() -> bool {
    true
}

#[cfg(target_os = "windows")]
#[unsafe(no_mangle)]
extern "system" fn InitDll() -> bool {
    loaded()
}

#[cfg(target_os = "windows")]
#[unsafe(no_mangle)]
extern "system" fn ExitDll() -> bool {
    true
}

#[cfg(test)]
mod tests;
