//! The VST3 entry: both instruments, each behind a guard.
//!
//! A guard is an object with all interfaces of the framework's, which it owns and passes calls on to. Its own are: it
//! prepares scratch when processing is set up, completes what a host brings to `process`, and tells units, the names of
//! notes, what MIDI controllers there are, and which parameters have steps. Windows have a guard of their own.
#![allow(non_snake_case)]

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

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
    kNotInitialized, kResultFalse, kResultOk, tresult, uint32,
};
use nice_plug::wrapper::vst3::vst3::{Class, ComWrapper};
use nice_plug::wrapper::vst3::{PluginInfo, Wrapper};

use self::controllers::Controllers;
use self::edits::Edits;
use self::input::Input;
use super::TAIL;
use super::scratch::{CHANNELS, Scratch};
use crate::guard::caught;
use crate::host_parameters::{self, HostParameters};
use crate::outputs::{self, Used};
use crate::plugin::{Overhear, OverhearMulti};
use overhear_player::decimation;

/// The framework's object, and what completes a host's outputs.
struct Guard<P: Vst3Plugin> {
    framework: Wrapper<P>,
    outputs: UnsafeCell<Outputs>,
    parameters: Option<Arc<HostParameters>>,
    controllers: Controllers,
    edits: Edits,
    /// Whether the host processes.
    processes: AtomicBool,
    /// The outputs beside the main one that are not switched off, as [`Used`] has them.
    active_buses: AtomicU32,
    /// Of the latest set-up, Hz: bits of a double precision number.
    sample_rate: AtomicU64,
}

/// Scratch, and the buses made of it for one call.
struct Outputs {
    scratch: Scratch,
    buses: Vec<AudioBusBuffers>,
    input: Input,
    /// Whether processing has been set up.
    ready: bool,
    /// Whether the component is active.
    active: bool,
}

impl<P: Vst3Plugin> Guard<P> {
    fn new() -> Guard<P> {
        let ports = P::AUDIO_IO_LAYOUTS.first().map_or(0, |layout| 1 + layout.aux_output_ports.len());
        let outputs = Outputs {
            scratch: Scratch::new(ports),
            buses: Vec::with_capacity(ports),
            input: Input::new(),
            ready: false,
            active: false,
        };
        let framework = Wrapper::new();
        Guard {
            framework,
            outputs: UnsafeCell::new(outputs),
            parameters: host_parameters::take_latest(),
            controllers: Controllers::new(),
            edits: Edits::new(),
            processes: AtomicBool::new(false),
            active_buses: AtomicU32::new(Used::ALL.0),
            sample_rate: AtomicU64::new(0),
        }
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

impl<P: Vst3Plugin> IComponentTrait for Guard<P> {
    pass_on!(@ IComponentTrait getControllerClassId(class: *mut TUID) -> tresult);
    pass_on!(@ IComponentTrait setIoMode(mode: IoMode) -> tresult);
    pass_on!(@ IComponentTrait getBusCount(media: MediaType, direction: BusDirection) -> int32);

    unsafe fn getBusInfo(
        &self,
        media: MediaType,
        direction: BusDirection,
        index: int32,
        info: *mut BusInfo,
    ) -> tresult {
        // SAFETY: passed on; `info` is null or valid.
        caught("IComponentTrait::getBusInfo", kInternalError, || unsafe {
            let result = self.framework.getBusInfo(media, direction, index, info);
            let kit = self.parameters.as_ref().map(|parameters| parameters.document());
            if let (true, 0, 1, Ok(bus @ 1..), Some(kit), Some(info)) =
                (result == kResultOk, media, direction, usize::try_from(index), kit, info.as_mut())
                && let Some(title) = outputs::title(bus - 1, &kit.kit)
            {
                info.name.fill(0);
                let units = title.encode_utf16().take(info.name.len() - 1);
                info.name.iter_mut().zip(units).for_each(|(to, unit)| *to = unit);
            }
            result
        })
    }

    pass_on!(@ IComponentTrait getRoutingInfo(input: *mut RoutingInfo, output: *mut RoutingInfo) -> tresult);

    unsafe fn activateBus(
        &self,
        media: MediaType,
        direction: BusDirection,
        index: int32,
        state: TBool,
    ) -> tresult {
        if let (0, 1, Ok(bus @ 1..)) = (media, direction, usize::try_from(index)) {
            let bit = Used::NONE.with(bus - 1).0;
            match state {
                0 => self.active_buses.fetch_and(!bit, Ordering::Relaxed),
                _ => self.active_buses.fetch_or(bit, Ordering::Relaxed),
            };
        }
        // SAFETY: passed on.
        caught("IComponentTrait::activateBus", kInternalError, || unsafe {
            self.framework.activateBus(media, direction, index, state)
        })
    }

    pass_on!(@ IComponentTrait getState(state: *mut IBStream) -> tresult);

    unsafe fn setActive(&self, state: TBool) -> tresult {
        // SAFETY: passed on; a component is activated only while nothing is processed, so that nobody else holds the
        // outputs.
        caught("IComponentTrait::setActive", kInternalError, || unsafe {
            let refused =
                self.parameters.as_ref().is_some_and(|parameters| parameters.refused_rate().is_some());
            let result = if state != 0 && refused { kResultFalse } else { self.framework.setActive(state) };
            (*self.outputs.get()).active = state != 0 && result == kResultOk;
            result
        })
    }

    unsafe fn setState(&self, state: *mut IBStream) -> tresult {
        self.edits.forget();
        // SAFETY: passed on.
        caught("IComponentTrait::setState", kInternalError, || unsafe {
            IComponentTrait::setState(&self.framework, state)
        })
    }
}

mod controllers;
mod edits;
mod input;
mod parameters;

impl<P: Vst3Plugin> IAudioProcessorTrait for Guard<P> {
    pass_on!(@ IAudioProcessorTrait getBusArrangement(
        direction: BusDirection, index: i32, arrangement: *mut SpeakerArrangement
    ) -> tresult);
    pass_on!(@ IAudioProcessorTrait canProcessSampleSize(size: int32) -> tresult);
    pass_on!(@ IAudioProcessorTrait getLatencySamples() -> uint32);

    unsafe fn setBusArrangements(
        &self,
        inputs: *mut SpeakerArrangement,
        input_count: int32,
        outputs: *mut SpeakerArrangement,
        output_count: int32,
    ) -> tresult {
        // The framework wants a pointer even to no arrangements.
        let mut nothing = 0;
        let inputs = if input_count == 0 && inputs.is_null() { &raw mut nothing } else { inputs };
        // SAFETY: passed on.
        caught("IAudioProcessorTrait::setBusArrangements", kInternalError, || unsafe {
            self.framework.setBusArrangements(inputs, input_count, outputs, output_count)
        })
    }

    unsafe fn setProcessing(&self, state: TBool) -> tresult {
        self.processes.store(state != 0, Ordering::Release);
        // SAFETY: passed on.
        caught("IAudioProcessorTrait::setProcessing", kInternalError, || unsafe {
            self.framework.setProcessing(state)
        })
    }

    unsafe fn getTailSamples(&self) -> uint32 {
        (TAIL * f64::from_bits(self.sample_rate.load(Ordering::Relaxed))) as uint32
    }

    unsafe fn setupProcessing(&self, setup: *mut ProcessSetup) -> tresult {
        // SAFETY: `setup` is null or valid; processing is set up only while nothing is processed, so that nobody
        // else holds the outputs.
        caught("IAudioProcessorTrait::setupProcessing", kInternalError, || unsafe {
            if let Some(setup) = setup.as_ref() {
                let refused = decimation::factor(setup.sampleRate).is_none();
                if let Some(parameters) = &self.parameters {
                    parameters.refuse_rate(refused.then_some(setup.sampleRate as f32));
                }
                if refused {
                    (*self.outputs.get()).ready = false;
                    return kInvalidArgument;
                }
                self.sample_rate.store(setup.sampleRate.to_bits(), Ordering::Relaxed);
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
            let outputs = &mut *self.outputs.get();
            if given.numSamples < 0 {
                return kInvalidArgument;
            }
            // The framework panics when it processes before that.
            if !(outputs.ready && outputs.active) {
                return kNotInitialized;
            }
            let (events, changes) = (given.inputEvents, given.inputParameterChanges);
            outputs.input.prepare(given, &self.controllers, &self.edits);
            let result = self.complete_outputs(given, outputs);
            outputs.input.finish(given.numSamples);
            // The host's again.
            (given.inputEvents, given.inputParameterChanges) = (events, changes);
            result
        }
    }

    /// Processes what is sound with every output there.
    ///
    /// # Safety
    /// As the format says of `process`.
    unsafe fn complete_outputs(&self, given: &mut ProcessData, outputs: &mut Outputs) -> tresult {
        let Outputs { scratch, buses, .. } = outputs;
        // SAFETY: as promised.
        unsafe {
            if let Some(parameters) = &self.parameters {
                let active = Used(self.active_buses.load(Ordering::Relaxed));
                let is_used = |&bus: &usize| active.has(bus - 1) && is_given(given, bus);
                let used = (1..scratch.ports()).filter(is_used);
                parameters.use_outputs(used.fold(Used::NONE, |used, bus| used.with(bus - 1)));
            }
            // A call without samples only brings parameters.
            if given.numSamples <= 0 || is_complete(given, scratch.ports()) {
                return caught("process", kInternalError, || self.framework.process(given));
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
            let result = caught("process", kInternalError, || self.framework.process(given));
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
    // SAFETY: as promised.
    (0..buses).all(|bus| unsafe { is_given(data, bus) })
}

/// Whether the host gives a bus with its two channels.
///
/// # Safety
/// `data` and all it points to are valid.
unsafe fn is_given(data: &ProcessData, bus: usize) -> bool {
    // SAFETY: as promised; tables hold as many pointers as the bus has channels.
    unsafe {
        bus_of(data, bus).is_some_and(|bus| {
            let table = bus.__field0.channelBuffers32;
            bus.numChannels as usize == CHANNELS
                && !table.is_null()
                && (0..CHANNELS).all(|channel| !(*table.add(channel)).is_null())
        })
    }
}

impl<P: Vst3Plugin> IMidiMappingTrait for Guard<P> {
    unsafe fn getMidiControllerAssignment(
        &self,
        bus: int32,
        channel: int16,
        controller: CtrlNumber,
        id: *mut ParamID,
    ) -> tresult {
        if !controllers::acts(controller) {
            return kResultFalse;
        }
        // SAFETY: passed on.
        caught("IMidiMappingTrait::getMidiControllerAssignment", kInternalError, || unsafe {
            self.framework.getMidiControllerAssignment(bus, channel, controller, id)
        })
    }
}

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
mod view;

pass_on!(IInfoListenerTrait {
    setChannelContextInfos(list: *mut IAttributeList) -> tresult;
});

mod factory;

#[cfg(test)]
use factory::Factory;

#[cfg(test)]
mod tests;
