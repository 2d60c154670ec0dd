//! Random events and calls, in any order.

use std::cell::RefCell;

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    DataEvent, IParamValueQueue, IParamValueQueueTrait, IParameterChanges, IParameterChangesTrait,
    NoteExpressionValueEvent, NoteOffEvent, PolyPressureEvent,
};
use nice_plug::wrapper::vst3::vst3::Steinberg::{IBStreamTrait, int64, kNotImplemented};

use super::calls::Listed;
use super::*;
use crate::entry::sweep::{Chance, FRAMES, LAST, buffer};

/// Bytes of a message that lasts longer than any call.
static BYTES: [u8; 4] = [0xF0, 0x7E, 0x01, 0xF7];

fn event(chance: &mut Chance, time: u32) -> Event {
    let (channel, pitch, value) = (chance.channel(), chance.key(), chance.share());
    let (noteId, velocity) = (chance.of(&[-1, -1, 0, 7]), value as f32);
    let (kind, form) = match chance.random.u32(..100) {
        0..55 => {
            let noteOn = NoteOnEvent { channel, pitch, tuning: 0.0, velocity, length: 0, noteId };
            (EventTypes_::kNoteOnEvent, Event__type0 { noteOn })
        }
        55..65 => {
            let noteOff = NoteOffEvent { channel, pitch, velocity, noteId, tuning: 0.0 };
            (EventTypes_::kNoteOffEvent, Event__type0 { noteOff })
        }
        65..80 => {
            let polyPressure = PolyPressureEvent { channel, pitch, pressure: velocity, noteId };
            (EventTypes_::kPolyPressureEvent, Event__type0 { polyPressure })
        }
        80..88 => {
            let (size, bytes) = chance.of(&[(4, BYTES.as_ptr()), (0, ptr::null()), (9, ptr::null())]);
            (EventTypes_::kDataEvent, Event__type0 { data: DataEvent { size, r#type: 0, bytes } })
        }
        88..97 => {
            let typeId = chance.random.u32(..8);
            let noteExpressionValue = NoteExpressionValueEvent { typeId, noteId, value };
            (EventTypes_::kNoteExpressionValueEvent, Event__type0 { noteExpressionValue })
        }
        // SAFETY: plain data, valid when it is zero.
        _ => (chance.random.u32(60_000..65_000), unsafe { std::mem::zeroed() }),
    };
    Event {
        busIndex: chance.of(&[0, 0, 0, 1, -1]),
        sampleOffset: time as i32,
        ppqPosition: 0.0,
        flags: 0,
        r#type: kind as u16,
        __field0: form,
    }
}

/// A parameter's points in a buffer.
struct Queue(ParamID, Vec<(int32, ParamValue)>);

impl Class for Queue {
    type Interfaces = (IParamValueQueue,);
}

impl IParamValueQueueTrait for Queue {
    unsafe fn getParameterId(&self) -> ParamID {
        self.0
    }

    unsafe fn getPointCount(&self) -> int32 {
        self.1.len() as int32
    }

    unsafe fn getPoint(&self, index: int32, offset: *mut int32, value: *mut ParamValue) -> tresult {
        let Some(&point) = usize::try_from(index).ok().and_then(|index| self.1.get(index)) else {
            return kInvalidArgument;
        };
        // SAFETY: whoever asks gives room.
        unsafe { (*offset, *value) = point };
        kResultOk
    }

    unsafe fn addPoint(&self, _offset: int32, _value: ParamValue, _index: *mut int32) -> tresult {
        kInvalidArgument
    }
}

/// All parameters that move in a buffer.
struct Queues(Vec<ComWrapper<Queue>>);

impl Class for Queues {
    type Interfaces = (IParameterChanges,);
}

impl IParameterChangesTrait for Queues {
    unsafe fn getParameterCount(&self) -> int32 {
        self.0.len() as int32
    }

    unsafe fn getParameterData(&self, index: int32) -> *mut IParamValueQueue {
        let queue = usize::try_from(index).ok().and_then(|index| self.0.get(index));
        queue.map_or(ptr::null_mut(), |queue| queue.as_com_ref::<IParamValueQueue>().unwrap().as_ptr())
    }

    unsafe fn addParameterData(&self, _id: *const ParamID, _index: *mut int32) -> *mut IParamValueQueue {
        ptr::null_mut()
    }
}

/// A state, and how much of it has been read.
#[derive(Default)]
struct Stream(RefCell<(Vec<u8>, usize)>);

impl Class for Stream {
    type Interfaces = (IBStream,);
}

impl IBStreamTrait for Stream {
    unsafe fn read(&self, into: *mut c_void, count: int32, done: *mut int32) -> tresult {
        let (bytes, at) = &mut *self.0.borrow_mut();
        let rest = &bytes[*at..];
        let now = &rest[..rest.len().min(count.max(0) as usize)];
        // SAFETY: there is room for what is asked for; `done` is null or valid.
        unsafe {
            ptr::copy_nonoverlapping(now.as_ptr(), into.cast(), now.len());
            if let Some(done) = done.as_mut() {
                *done = now.len() as int32;
            }
        }
        *at += now.len();
        kResultOk
    }

    unsafe fn write(&self, from: *mut c_void, count: int32, done: *mut int32) -> tresult {
        // SAFETY: whoever writes has so many bytes; `done` is null or valid.
        unsafe {
            let given = std::slice::from_raw_parts(from.cast::<u8>(), count.max(0) as usize);
            self.0.borrow_mut().0.extend_from_slice(given);
            if let Some(done) = done.as_mut() {
                *done = count;
            }
        }
        kResultOk
    }

    unsafe fn seek(&self, to: int64, mode: int32, result: *mut int64) -> tresult {
        let (bytes, at) = &mut *self.0.borrow_mut();
        let from = [0, *at as i64, bytes.len() as i64][mode.clamp(0, 2) as usize];
        *at = (from + to).clamp(0, bytes.len() as i64) as usize;
        // SAFETY: `result` is null or valid.
        if let Some(result) = unsafe { result.as_mut() } {
            *result = *at as i64;
        }
        kResultOk
    }

    unsafe fn tell(&self, result: *mut int64) -> tresult {
        // SAFETY: `result` is null or valid.
        let Some(result) = (unsafe { result.as_mut() }) else { return kNotImplemented };
        *result = self.0.borrow().1 as i64;
        kResultOk
    }
}

/// An instance whose host does as it pleases.
struct Sweep<P: Vst3Plugin> {
    guard: Guard<P>,
    buses: usize,
    chance: Chance,
    stored: Vec<u8>,
}

impl<P: Vst3Plugin> Sweep<P> {
    fn new(buses: usize) -> Sweep<P> {
        let guard = Guard::new();
        // SAFETY: the first call a host makes.
        assert_eq!(unsafe { IPluginBaseTrait::initialize(&guard, ptr::null_mut()) }, kResultOk);
        Sweep { guard, buses, chance: Chance::new(), stored: Vec::new() }
    }

    /// One buffer at the outputs that there are, some of them incomplete if the host is careless.
    fn process(
        &mut self,
        events: Vec<Event>,
        moves: Vec<ComWrapper<Queue>>,
        frames: usize,
        careless: bool,
    ) -> Vec<[Vec<f32>; CHANNELS]> {
        let buses = if careless { self.chance.random.usize(..self.buses + 2) } else { self.buses };
        let mut sound = vec![[buffer(frames), buffer(frames)]; buses];
        let mut tables: Vec<_> =
            sound.iter_mut().map(|bus| bus.each_mut().map(|channel| channel.as_mut_ptr())).collect();
        let mut given: Vec<_> = tables
            .iter_mut()
            .map(|table| AudioBusBuffers {
                numChannels: CHANNELS as i32,
                silenceFlags: 0,
                __field0: AudioBusBuffers__type0 { channelBuffers32: table.as_mut_ptr() },
            })
            .collect();
        for bus in given.iter_mut().filter(|_| careless) {
            match self.chance.random.u32(..12) {
                0 => bus.__field0.channelBuffers32 = ptr::null_mut(),
                1 => bus.numChannels = self.chance.of(&[-1, 0, 1]),
                _ => {}
            }
        }
        let events = ComWrapper::new(Listed(events)).to_com_ptr::<IEventList>().unwrap();
        let moves = ComWrapper::new(Queues(moves)).to_com_ptr::<IParameterChanges>().unwrap();
        let mut data = ProcessData {
            processMode: 0,
            symbolicSampleSize: 0,
            numSamples: frames as i32,
            numInputs: 0,
            numOutputs: given.len() as i32,
            inputs: ptr::null_mut(),
            outputs: if given.is_empty() { ptr::null_mut() } else { given.as_mut_ptr() },
            inputParameterChanges: moves.as_ptr(),
            outputParameterChanges: ptr::null_mut(),
            inputEvents: events.as_ptr(),
            outputEvents: ptr::null_mut(),
            processContext: ptr::null_mut(),
        };
        // SAFETY: everything the call points to lives here.
        unsafe { self.guard.process(&mut data) };
        self.chance.believe(sound, frames)
    }

    /// A buffer's events and moves.
    fn input(&mut self, frames: usize) -> (Vec<Event>, Vec<ComWrapper<Queue>>) {
        let events = self.chance.events();
        let (mut listed, mut moves) = (Vec::new(), Vec::new());
        let times = self.chance.times(events, frames);
        let moving = times.len() / 2;
        for &time in &times[moving..] {
            listed.push(event(&mut self.chance, time));
        }
        for points in times[..moving].chunks(3) {
            let id = self.id();
            let points = points.iter().map(|&time| (time as i32, self.chance.share())).collect();
            moves.push(ComWrapper::new(Queue(id, points)));
        }
        (listed, moves)
    }

    /// A parameter's id, or a controller's, or none's.
    fn id(&mut self) -> ParamID {
        if self.chance.random.u32(..3) > 0 {
            return self.chance.id();
        }
        let (channel, controller) =
            (self.chance.random.i16(0..16), self.chance.of(&[4, 16, 17, 18, 19, 20, 80, 88, 120, 123]));
        let mut id = 0;
        // SAFETY: there is room for an id.
        let told = unsafe { self.guard.getMidiControllerAssignment(0, channel, controller, &mut id) };
        assert_eq!(told, kResultOk);
        id
    }

    fn set_up(&mut self) {
        let sampleRate = self.chance.of(&[48e3, 48e3, 44.1e3, 8e3]);
        let maxSamplesPerBlock = self.chance.of(&[-1, 0, 1, FRAMES as i32, i32::MAX]);
        let mut setup =
            ProcessSetup { processMode: 0, symbolicSampleSize: 0, maxSamplesPerBlock, sampleRate };
        // SAFETY: calls a host makes.
        unsafe {
            self.guard.setActive(0);
            self.guard.setupProcessing(&mut setup);
            self.guard.setActive(1);
        }
    }

    /// Any call at all.
    fn act(&mut self) {
        let (id, value) = (self.id(), self.chance.share());
        // SAFETY: the calls a host makes; that their order is none is what is tried.
        unsafe {
            match self.chance.random.u32(..1_000) {
                0..930 => {
                    let frames = self.chance.frames();
                    let (events, moves) = self.input(frames);
                    self.process(events, moves, frames, true);
                }
                930..950 => {
                    let on = self.chance.random.u8(..2);
                    self.guard.setProcessing(on);
                }
                950..970 => {
                    self.guard.setParamNormalized(id, value);
                    let told = self.guard.getParamNormalized(id);
                    assert!(told.is_finite(), "{}: {id} is at {told}", self.chance.where_it_is());
                }
                970..980 => {
                    let bus = self.chance.random.i32(-1..20);
                    self.guard.activateBus(0, 1, bus, self.chance.random.u8(..2));
                }
                980..985 => {
                    let mut text = [0; 128];
                    self.guard.getParamStringByValue(id, value, &mut text);
                    let mut read = 0.0;
                    self.guard.getParamValueByString(id, text.as_mut_ptr(), &mut read);
                    self.guard.getTailSamples();
                }
                985..990 => self.store_and_load(),
                990..993 => {
                    self.guard.setActive(self.chance.random.u8(..2));
                }
                993..996 => {
                    let mut arrangements = [3; 24];
                    let count = self.chance.random.i32(0..24);
                    self.guard.setBusArrangements(ptr::null_mut(), 0, arrangements.as_mut_ptr(), count);
                }
                _ => self.set_up(),
            }
        }
    }

    /// Stores the state, or loads one: stored, damaged or of nothing but noise.
    fn store_and_load(&mut self) {
        let stream = ComWrapper::new(Stream::default());
        let shown = stream.to_com_ptr::<IBStream>().unwrap();
        // SAFETY: calls a host makes.
        unsafe {
            let result = IComponentTrait::getState(&self.guard, shown.as_ptr());
            assert_eq!(result, kResultOk, "{}", self.chance.where_it_is());
            if self.stored.is_empty() {
                self.stored = stream.0.borrow().0.clone();
            }
            let given = match self.chance.random.u32(..4) {
                0 => self.stored.clone(),
                1 => (0..100).map(|_| self.chance.random.u8(..)).collect(),
                _ => self.chance.damaged(&self.stored.clone()),
            };
            stream.0.replace((given, 0));
            IComponentTrait::setState(&self.guard, shown.as_ptr());
        }
    }

    /// All sound off, on every channel; then there is silence.
    fn quiet(&mut self) {
        let (processMode, symbolicSampleSize, maxSamplesPerBlock) = (0, 0, FRAMES as i32);
        let mut setup =
            ProcessSetup { processMode, symbolicSampleSize, maxSamplesPerBlock, sampleRate: 48e3 };
        // SAFETY: calls a host makes, in its order.
        unsafe {
            self.guard.setActive(0);
            assert_eq!(self.guard.setupProcessing(&mut setup), kResultOk);
            assert_eq!(self.guard.setActive(1), kResultOk);
            self.guard.setProcessing(1);
        }
        for _ in 0..20 {
            let (events, moves) = self.input(FRAMES);
            self.process(events, moves, FRAMES, false);
        }
        let off = (0..16).map(|channel| {
            let mut id = 0;
            // SAFETY: there is room for an id.
            let told = unsafe { self.guard.getMidiControllerAssignment(0, channel, 120, &mut id) };
            assert_eq!(told, kResultOk);
            ComWrapper::new(Queue(id, vec![(0, 1.0)]))
        });
        let off = off.collect();
        self.process(Vec::new(), off, FRAMES, false);
        let buffers = (LAST * 48e3) as usize / FRAMES;
        let silent = (0..buffers).any(|_| {
            let sound = self.process(Vec::new(), Vec::new(), FRAMES, false);
            Chance::is_silent(sound.iter().flatten().flatten())
        });
        assert!(silent, "{}: it stays loud", self.chance.where_it_is());
    }

    fn whole(mut self) {
        let parameters = self.guard.parameters.as_ref().map(Arc::downgrade).unwrap();
        while self.chance.goes_on() {
            self.act();
        }
        self.quiet();
        let where_it_is = self.chance.where_it_is();
        // SAFETY: the last calls a host makes.
        unsafe {
            self.guard.setActive(0);
            IPluginBaseTrait::terminate(&self.guard);
        }
        drop(self);
        assert_eq!(parameters.strong_count(), 0, "{where_it_is}: somebody keeps the instance");
    }
}

#[test]
fn ten_thousand_moves_of_a_controller_in_a_buffer_are_taken() {
    let mut sweep = Sweep::<Overhear>::new(1);
    sweep.set_up();
    let mut id = 0;
    // SAFETY: there is room for an id.
    unsafe { assert_eq!(sweep.guard.getMidiControllerAssignment(0, 9, 16, &mut id), kResultOk) };
    let points = (0..10_000).map(|point| (point * FRAMES as i32 / 10_000, f64::from(point % 100) / 100.0));
    let moves = vec![ComWrapper::new(Queue(id, points.collect()))];
    sweep.process(Vec::new(), moves, FRAMES, false);
    // SAFETY: the call a host makes.
    assert_eq!(unsafe { sweep.guard.getParamNormalized(id) }, 0.99);
}

#[test]
fn a_sweep_of_random_events_and_calls_neither_aborts_nor_leaks_nor_stays_loud() {
    Sweep::<Overhear>::new(1).whole();
    Sweep::<OverhearMulti>::new(BUSES).whole();
}
