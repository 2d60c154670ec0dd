//! Calls that real hosts make: parameters looked at, buffers without samples, messages without bytes.

use std::cell::Cell;

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    DataEvent, IParamValueQueue, IParamValueQueueTrait, IParameterChanges, IParameterChangesTrait,
};
use overhear_player::parameters::{COUNT, host_id, parameters};

use super::*;

/// The events of one buffer.
pub(super) struct Listed(pub(super) Vec<Event>);

impl Class for Listed {
    type Interfaces = (IEventList,);
}

impl IEventListTrait for Listed {
    unsafe fn getEventCount(&self) -> int32 {
        self.0.len() as int32
    }

    unsafe fn getEvent(&self, index: int32, event: *mut Event) -> tresult {
        // SAFETY: the framework gives room for an event.
        unsafe { *event = self.0[index as usize] };
        kResultOk
    }

    unsafe fn addEvent(&self, _event: *mut Event) -> tresult {
        kInvalidArgument
    }
}

/// One parameter at one value, told once.
struct Moved(ParamID, Cell<f64>);

impl Class for Moved {
    type Interfaces = (IParamValueQueue,);
}

impl IParamValueQueueTrait for Moved {
    unsafe fn getParameterId(&self) -> ParamID {
        self.0
    }

    unsafe fn getPointCount(&self) -> int32 {
        1
    }

    unsafe fn getPoint(&self, _index: int32, offset: *mut int32, value: *mut ParamValue) -> tresult {
        // SAFETY: whoever asks gives room.
        unsafe { (*offset, *value) = (0, self.1.get()) };
        kResultOk
    }

    unsafe fn addPoint(&self, _offset: int32, _value: ParamValue, _index: *mut int32) -> tresult {
        kInvalidArgument
    }
}

/// A list with that one.
struct Changes(ComWrapper<Moved>);

impl Class for Changes {
    type Interfaces = (IParameterChanges,);
}

impl IParameterChangesTrait for Changes {
    unsafe fn getParameterCount(&self) -> int32 {
        1
    }

    unsafe fn getParameterData(&self, _index: int32) -> *mut IParamValueQueue {
        self.0.as_com_ref::<IParamValueQueue>().unwrap().as_ptr()
    }

    unsafe fn addParameterData(&self, _id: *const ParamID, _index: *mut int32) -> *mut IParamValueQueue {
        ptr::null_mut()
    }
}

fn snare() -> Event {
    let note = NoteOnEvent { channel: 9, pitch: 38, tuning: 0.0, velocity: 0.8, length: 0, noteId: -1 };
    event(0, EventTypes_::kNoteOnEvent as u16, Event__type0 { noteOn: note })
}

/// A system exclusive message of a size, without bytes.
fn hollow(size: u32) -> Event {
    let data = DataEvent { size, r#type: 0, bytes: ptr::null() };
    Event { r#type: EventTypes_::kDataEvent as u16, __field0: Event__type0 { data }, ..snare() }
}

/// Processes a buffer of so many samples on the main output, with events and a parameter's value.
fn call(
    guard: &Guard<OverhearMulti>,
    samples: usize,
    events: Vec<Event>,
    moved: Option<(ParamID, f64)>,
) -> (tresult, Vec<f32>) {
    let mut sound = [vec![0.0_f32; samples], vec![0.0; samples]];
    let mut table = sound.each_mut().map(|channel| channel.as_mut_ptr());
    let mut bus = AudioBusBuffers {
        numChannels: CHANNELS as i32,
        silenceFlags: 0,
        __field0: AudioBusBuffers__type0 { channelBuffers32: table.as_mut_ptr() },
    };
    let events = ComWrapper::new(Listed(events)).to_com_ptr::<IEventList>().unwrap();
    let changes = moved.map(|(id, value)| {
        let moved = ComWrapper::new(Moved(id, Cell::new(value)));
        ComWrapper::new(Changes(moved)).to_com_ptr::<IParameterChanges>().unwrap()
    });
    let mut data = ProcessData {
        processMode: 0,
        symbolicSampleSize: 0,
        numSamples: samples as i32,
        numInputs: 0,
        numOutputs: 1,
        inputs: ptr::null_mut(),
        outputs: &mut bus,
        inputParameterChanges: changes.as_ref().map_or(ptr::null_mut(), |changes| changes.as_ptr()),
        outputParameterChanges: ptr::null_mut(),
        inputEvents: events.as_ptr(),
        outputEvents: ptr::null_mut(),
        processContext: ptr::null_mut(),
    };
    // SAFETY: everything the call points to lives here.
    let result = unsafe { guard.process(&mut data) };
    assert_eq!(data.inputEvents, events.as_ptr(), "the host's structure is its own");
    (result, sound[0].clone())
}

fn info(guard: &Guard<OverhearMulti>, index: i32) -> ParameterInfo {
    // SAFETY: plain data, and room for it.
    unsafe {
        let mut info: ParameterInfo = std::mem::zeroed();
        assert_eq!(guard.getParameterInfo(index, &mut info), kResultOk, "{index}");
        info
    }
}

fn present(guard: &Guard<OverhearMulti>, id: ParamID) -> f64 {
    // SAFETY: the call a host makes.
    unsafe { guard.getParamNormalized(id) }
}

/// The parameter that stands for a controller.
fn controller(guard: &Guard<OverhearMulti>, channel: i16, number: i16) -> Option<ParamID> {
    let mut id = 0;
    // SAFETY: there is room for an id.
    let result = unsafe { guard.getMidiControllerAssignment(0, channel, number, &mut id) };
    (result == kResultOk).then_some(id)
}

#[test]
fn only_controllers_that_act_are_offered_and_each_is_where_it_was_moved_last() {
    let guard = multi();
    // SAFETY: the call a host makes.
    let count = unsafe { guard.getParameterCount() };
    assert_eq!(count as usize, COUNT + 1 + 10 * 16);
    // What a host would send again as it opens a project: all that differs from its default.
    let offered: Vec<_> = (COUNT as i32 + 1..count).map(|index| info(&guard, index)).collect();
    assert!(offered.iter().all(|info| info.defaultNormalizedValue == present(&guard, info.id)));
    let mapped = |channel, number| controller(&guard, channel, number);
    let known: Vec<_> = (0..16)
        .flat_map(|channel| {
            [4, 16, 17, 18, 19, 88, 120, 123, 20, 80].map(|number| mapped(channel, number).unwrap())
        })
        .collect();
    assert_eq!(offered.iter().map(|info| info.id).collect::<Vec<_>>(), known);
    assert_eq!((mapped(9, 7), mapped(9, 128), mapped(9, 129), mapped(16, 4)), (None, None, None, None));
    let pedal = mapped(9, 4).unwrap();
    call(&guard, FRAMES, Vec::new(), Some((pedal, 0.7)));
    assert_eq!((present(&guard, pedal), present(&guard, mapped(8, 4).unwrap())), (0.7, 0.0));
    // SAFETY: the call a host makes.
    unsafe { assert_eq!(guard.setParamNormalized(pedal, 0.2), kResultOk) };
    assert_eq!(present(&guard, pedal), 0.2);
}

#[test]
fn switches_and_lists_have_steps_and_nothing_else_has() {
    let guard = multi();
    for (index, parameter) in parameters().iter().enumerate() {
        let info = info(&guard, index as i32);
        assert_eq!(info.stepCount as u32, parameter.steps().unwrap_or(0), "{}", parameter.name);
        assert_eq!(info.stepCount > 0, !parameter.choices.is_empty() || parameter.name == "render_threads");
        for step in 0..=info.stepCount.max(1) {
            let share = f64::from(step) / f64::from(info.stepCount.max(1));
            let plain = parameter.min + (parameter.max - parameter.min) * share as f32;
            if info.stepCount > 0 {
                assert!((f64::from(parameter.normalized(plain)) - share).abs() < 1e-6, "{}", parameter.name);
            }
        }
    }
    assert_eq!(info(&guard, COUNT as i32).stepCount, 1, "the bypass");
}

#[test]
fn a_value_set_while_it_processes_is_read_back_and_what_arrives_counts() {
    let guard = multi();
    let id = host_id("master");
    let before = present(&guard, id);
    // SAFETY: the call a host makes.
    unsafe { assert_eq!(guard.setParamNormalized(id, 0.25), kResultOk) };
    assert_ne!(before, 0.25);
    assert_eq!(present(&guard, id), 0.25);
    call(&guard, FRAMES, Vec::new(), Some((id, 0.75)));
    assert!((present(&guard, id) - 0.75).abs() < 1e-3);
}

#[test]
fn messages_without_bytes_do_not_keep_notes_from_being_played() {
    let plain = call(&multi(), FRAMES, vec![snare()], None);
    assert!(plain.0 == kResultOk && plain.1.iter().any(|sample| *sample != 0.0));
    for size in [0, 5] {
        let events = vec![hollow(size), snare(), hollow(size)];
        assert!(call(&multi(), FRAMES, events, None) == plain, "{size} bytes");
    }
}

#[test]
fn notes_and_controllers_without_samples_are_the_first_of_the_next_buffer() {
    let plain = call(&multi(), FRAMES, vec![snare()], None);
    let guard = multi();
    assert_eq!(call(&guard, 0, vec![snare(), hollow(3)], None).0, kResultOk);
    assert!(call(&guard, FRAMES, Vec::new(), None) == plain);
    let silent = call(&multi(), FRAMES, Vec::new(), None);
    assert!(silent.1.iter().all(|sample| *sample == 0.0));

    let guard = multi();
    let position = controller(&guard, 9, 16).unwrap();
    let moved = call(&guard, FRAMES, vec![snare()], Some((position, 0.9)));
    assert!(moved != plain);
    let guard = multi();
    call(&guard, 0, Vec::new(), Some((position, 0.9)));
    assert!(call(&guard, FRAMES, vec![snare()], None) == moved);
}

#[test]
fn calls_out_of_order_are_refused() {
    let guard = Guard::<OverhearMulti>::new();
    let mut setup = ProcessSetup {
        processMode: 0,
        symbolicSampleSize: 0,
        maxSamplesPerBlock: FRAMES as i32,
        sampleRate: 48e3,
    };
    assert_eq!(call(&guard, FRAMES, vec![snare()], None).0, kNotInitialized);
    // SAFETY: the calls a host makes.
    unsafe { assert_eq!(guard.setupProcessing(&mut setup), kResultOk) };
    assert_eq!(call(&guard, FRAMES, vec![snare()], None).0, kNotInitialized, "it is not active");
    // SAFETY: as above.
    unsafe { assert_eq!(guard.setActive(1), kResultOk) };
    assert_eq!(call(&guard, FRAMES, vec![snare()], None).0, kResultOk);
    // SAFETY: as above.
    unsafe { assert_eq!(guard.setActive(0), kResultOk) };
    assert_eq!(call(&guard, FRAMES, vec![snare()], None).0, kNotInitialized);
}

#[test]
fn rates_that_nothing_can_be_played_at_are_refused() {
    let guard = Guard::<OverhearMulti>::new();
    let set_up = |rate: f64| {
        let mut setup = ProcessSetup {
            processMode: 0,
            symbolicSampleSize: 0,
            maxSamplesPerBlock: FRAMES as i32,
            sampleRate: rate,
        };
        // SAFETY: the calls a host makes.
        unsafe {
            guard.setActive(0);
            let result = guard.setupProcessing(&mut setup);
            guard.setActive(1);
            result
        }
    };
    let refused = || guard.parameters.as_ref().unwrap().refused_rate();
    for rate in [48e3, 500.0, 8e3, 0.0, 2e6, f64::NAN, 1234.5678, 48e3] {
        let is_accepted = (1e3..=1.536e6).contains(&rate);
        let (expected, played) =
            if is_accepted { (kResultOk, kResultOk) } else { (kInvalidArgument, kNotInitialized) };
        assert_eq!(set_up(rate), expected, "{rate} Hz");
        assert_eq!(refused().is_none(), is_accepted, "the window says so at {rate} Hz");
        let (result, sound) = call(&guard, FRAMES, vec![snare()], None);
        assert_eq!(result, played, "{rate} Hz");
        assert_eq!(sound.iter().any(|sample| *sample != 0.0), is_accepted, "{rate} Hz");
    }
}

#[test]
fn an_instrument_has_no_inputs_to_arrange_and_rings_for_a_minute() {
    let guard = multi();
    let mut stereo = [3; BUSES];
    // SAFETY: as many arrangements as are counted.
    unsafe {
        let arranged = guard.setBusArrangements(ptr::null_mut(), 0, stereo.as_mut_ptr(), BUSES as i32);
        assert_eq!(arranged, kResultOk);
        let before = guard.getTailSamples();
        call(&guard, FRAMES, vec![snare()], None);
        assert_eq!((before, guard.getTailSamples()), (60 * 48_000, 60 * 48_000));
    }
}

#[test]
fn outputs_that_are_switched_off_are_at_the_main_one() {
    let events = ComWrapper::new(Stroke).to_com_ptr::<IEventList>().unwrap();
    let main = call(&multi(), FRAMES, vec![snare()], None).1;
    let guard = multi();
    let apart = played(&guard, events.as_ptr(), BUSES, |_, _| {});
    assert!(apart[0].iter().flatten().all(|sample| *sample == 0.0), "all is at the other outputs");
    for (at, whole) in main.iter().enumerate() {
        let sum: f32 = apart.iter().map(|bus| bus[0][at]).sum();
        assert!((sum - whole).abs() < 1e-5, "sample {at}: {sum} for {whole}");
    }
    let guard = multi();
    for bus in 1..BUSES {
        // SAFETY: the call a host makes.
        unsafe { assert_eq!(guard.activateBus(0, 1, bus as i32, 0), kResultOk) };
    }
    assert!(played(&guard, events.as_ptr(), BUSES, |_, _| {})[0][0] == main);
}
