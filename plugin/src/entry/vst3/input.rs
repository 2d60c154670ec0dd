//! What a host brings with a buffer, as the framework can take it.
//!
//! The framework panics on a system exclusive message without bytes, and loses the notes and controllers of a call that has
//! no samples. The guard leaves the former out, and keeps the latter for the first sample of the next buffer.

use std::cell::UnsafeCell;

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    Event, Event_::EventTypes_, IEventList, IEventListTrait, IParamValueQueue, IParamValueQueueTrait,
    IParameterChanges, IParameterChangesTrait, ParamID, ParamValue, ProcessData,
};
use nice_plug::wrapper::vst3::vst3::Steinberg::{int32, kInvalidArgument, kResultOk, tresult};
use nice_plug::wrapper::vst3::vst3::{Class, ComPtr, ComRef, ComWrapper};

use super::controllers::{self, Controllers};
use super::edits::Edits;

/// Most events that are kept from calls without samples.
const MOST_KEPT: usize = 1024;

/// Most events of a buffer that can be listed anew.
const MOST_EVENTS: usize = 65_536;

/// The lists that stand in for the host's while it processes.
pub struct Input {
    events: ComWrapper<Events>,
    changes: ComWrapper<Changes>,
    /// The same, as the framework calls them.
    listed: Option<(ComPtr<IEventList>, ComPtr<IParameterChanges>)>,
}

impl Input {
    /// Room for a buffer's events. Allocates.
    pub fn new() -> Input {
        let list = EventList {
            kept: Vec::with_capacity(MOST_KEPT),
            places: Vec::with_capacity(MOST_EVENTS),
            host: std::ptr::null_mut(),
        };
        let events = ComWrapper::new(Events(UnsafeCell::new(list)));
        let queues = (0..controllers::COUNT).filter_map(|_| {
            let queue = ComWrapper::new(Moved(UnsafeCell::new((0, 0.0))));
            let shown = queue.to_com_ptr::<IParamValueQueue>()?;
            Some((queue, shown))
        });
        let list = ChangeList { kept: queues.collect(), count: 0, host: std::ptr::null_mut() };
        let changes = ComWrapper::new(Changes(UnsafeCell::new(list)));
        let listed = events.to_com_ptr().zip(changes.to_com_ptr());
        Input { events, changes, listed }
    }

    /// Takes in where controllers were moved, and puts the lists in the place of the host's where these cannot be passed on.
    /// A call without samples leaves its notes and controllers here.
    ///
    /// # Safety
    /// As the format says of `process`; the host's lists are put back before the call returns.
    ///
    /// # Real-time
    /// A look at every event and the last point of every parameter; no allocation.
    pub unsafe fn prepare(&mut self, data: &mut ProcessData, controllers: &Controllers, edits: &Edits) {
        let Some((events, changes)) = &self.listed else { return };
        // SAFETY: nobody asks the lists outside of the framework's `process`, which this precedes; what the host passes
        // is null or valid.
        unsafe {
            let own_events = &mut *self.events.0.get();
            let own_changes = &mut *self.changes.0.get();
            if data.numSamples > 0 {
                if own_events.take(data.inputEvents) {
                    data.inputEvents = events.as_ptr();
                }
                own_changes.host = data.inputParameterChanges;
                follow(data.inputParameterChanges, controllers, edits, |_, _| {});
                if own_changes.count > 0 {
                    data.inputParameterChanges = changes.as_ptr();
                }
            } else {
                own_events.keep(data.inputEvents);
                data.inputEvents = std::ptr::null_mut();
                follow(data.inputParameterChanges, controllers, edits, |id, value| {
                    own_changes.keep(id, value)
                });
            }
        }
    }

    /// Forgets what was kept, once it has been processed.
    pub fn finish(&mut self, samples: int32) {
        if samples > 0 {
            // SAFETY: as in `prepare`, which this follows.
            unsafe {
                (*self.events.0.get()).kept.clear();
                (*self.changes.0.get()).count = 0;
            }
        }
    }
}

/// Takes in the last point of every controller that moves, and passes it on; edits that arrive are done with.
///
/// # Safety
/// `changes` is null or valid.
unsafe fn follow(
    changes: *mut IParameterChanges,
    controllers: &Controllers,
    edits: &Edits,
    mut moved: impl FnMut(ParamID, ParamValue),
) {
    // SAFETY: as promised; so are its queues.
    unsafe {
        let Some(changes) = ComRef::from_raw(changes) else { return };
        for index in 0..changes.getParameterCount() {
            let Some(queue) = ComRef::from_raw(changes.getParameterData(index)) else { continue };
            let (id, last) = (queue.getParameterId(), queue.getPointCount() - 1);
            let (mut offset, mut value) = (0, 0.0);
            edits.arrived(id);
            if last >= 0
                && controllers.get(id).is_some()
                && queue.getPoint(last, &mut offset, &mut value) == kResultOk
            {
                controllers.set(id, value);
                moved(id, value);
            }
        }
    }
}

/// A list of events.
struct Events(UnsafeCell<EventList>);

struct EventList {
    /// From calls without samples: they come first.
    kept: Vec<Event>,
    /// Those of the host's events that are passed on: of expressions the framework takes one kind for another.
    places: Vec<int32>,
    host: *mut IEventList,
}

impl Class for Events {
    type Interfaces = (IEventList,);
}

/// Whether the framework can take an event.
fn is_sound(event: &Event) -> bool {
    // SAFETY: an event of this type is of this form.
    event.r#type != EventTypes_::kDataEvent as u16 || unsafe { !event.__field0.data.bytes.is_null() }
}

/// The format's numbers of the expressions `expression` and `brightness`. The framework (nice-plug 0.4.2) takes each for the
/// other.
const MISTAKEN: [u32; 2] = [4, 5];

/// Whether the framework would take an event for another.
fn is_mistaken(event: &Event) -> bool {
    // SAFETY: an event of this type is of this form.
    event.r#type == EventTypes_::kNoteExpressionValueEvent as u16
        && MISTAKEN.contains(unsafe { &event.__field0.noteExpressionValue.typeId })
}

/// Writes an event so that the framework takes it for what it is.
fn correct(event: &mut Event) {
    if is_mistaken(event) {
        // SAFETY: as above.
        let kind = unsafe { &mut event.__field0.noteExpressionValue.typeId };
        *kind = MISTAKEN[0] + MISTAKEN[1] - *kind;
    }
}

impl EventList {
    /// Takes in the host's events, and says whether they have to be listed anew.
    ///
    /// # Safety
    /// `host` is null or valid until the end of the call that brings it.
    unsafe fn take(&mut self, host: *mut IEventList) -> bool {
        self.host = host;
        self.places.clear();
        // SAFETY: as promised.
        let Some(list) = (unsafe { ComRef::from_raw(host) }) else { return !self.kept.is_empty() };
        let mut whole = self.kept.is_empty();
        // SAFETY: as promised.
        for index in 0..unsafe { list.getEventCount() } {
            // SAFETY: an event is plain data, valid when it is zero.
            let mut event = unsafe { std::mem::zeroed() };
            // SAFETY: there is room for an event.
            let told = unsafe { list.getEvent(index, &mut event) } == kResultOk;
            if told && is_sound(&event) && self.places.len() < MOST_EVENTS {
                whole &= !is_mistaken(&event);
                self.places.push(index);
            } else {
                whole = false;
            }
        }
        !whole
    }

    /// Keeps the host's events for the next buffer's first sample.
    ///
    /// # Safety
    /// `host` is null or valid.
    unsafe fn keep(&mut self, host: *mut IEventList) {
        // SAFETY: as promised.
        unsafe {
            let Some(list) = ComRef::from_raw(host) else { return };
            for index in 0..list.getEventCount() {
                let mut event: Event = std::mem::zeroed();
                let told = list.getEvent(index, &mut event) == kResultOk;
                // The bytes of a message are the host's and gone by then.
                let lasts = event.r#type != EventTypes_::kDataEvent as u16;
                if told && lasts && self.kept.len() < MOST_KEPT {
                    event.sampleOffset = 0;
                    self.kept.push(event);
                }
            }
        }
    }
}

impl IEventListTrait for Events {
    unsafe fn getEventCount(&self) -> int32 {
        // SAFETY: the lists change only outside of the framework's `process`.
        let list = unsafe { &*self.0.get() };
        (list.kept.len() + list.places.len()) as int32
    }

    unsafe fn getEvent(&self, index: int32, into: *mut Event) -> tresult {
        // SAFETY: as above; `into` is null or valid, and the host's list is valid within `process`.
        unsafe {
            let list = &*self.0.get();
            let Some(room) = into.as_mut() else { return kInvalidArgument };
            let Ok(index) = usize::try_from(index) else { return kInvalidArgument };
            if let Some(kept) = list.kept.get(index) {
                *room = *kept;
                correct(room);
                return kResultOk;
            }
            match (list.places.get(index - list.kept.len()), ComRef::from_raw(list.host)) {
                (Some(&place), Some(host)) => {
                    let told = host.getEvent(place, into);
                    correct(room);
                    told
                }
                _ => kInvalidArgument,
            }
        }
    }

    unsafe fn addEvent(&self, _event: *mut Event) -> tresult {
        kInvalidArgument
    }
}

/// A controller that has moved: one point at the first sample.
struct Moved(UnsafeCell<(ParamID, ParamValue)>);

impl Class for Moved {
    type Interfaces = (IParamValueQueue,);
}

impl IParamValueQueueTrait for Moved {
    unsafe fn getParameterId(&self) -> ParamID {
        // SAFETY: it changes only outside of the framework's `process`.
        unsafe { (*self.0.get()).0 }
    }

    unsafe fn getPointCount(&self) -> int32 {
        1
    }

    unsafe fn getPoint(&self, index: int32, offset: *mut int32, value: *mut ParamValue) -> tresult {
        // SAFETY: as above; both are null or valid.
        match (index, unsafe { offset.as_mut() }, unsafe { value.as_mut() }) {
            (0, Some(offset), Some(value)) => {
                // SAFETY: as above.
                (*offset, *value) = (0, unsafe { (*self.0.get()).1 });
                kResultOk
            }
            _ => kInvalidArgument,
        }
    }

    unsafe fn addPoint(&self, _offset: int32, _value: ParamValue, _index: *mut int32) -> tresult {
        kInvalidArgument
    }
}

/// A list of changes.
struct Changes(UnsafeCell<ChangeList>);

struct ChangeList {
    /// Controllers from calls without samples, as many as are counted: they come first.
    kept: Vec<(ComWrapper<Moved>, ComPtr<IParamValueQueue>)>,
    count: usize,
    host: *mut IParameterChanges,
}

impl ChangeList {
    /// Keeps where a controller was moved last.
    fn keep(&mut self, id: ParamID, value: ParamValue) {
        // SAFETY: the queues are asked only within the framework's `process`.
        let is_its = |(queue, _): &(ComWrapper<Moved>, _)| unsafe { (*queue.0.get()).0 == id };
        let place = self.kept.iter().take(self.count).position(is_its).unwrap_or(self.count);
        if let Some((queue, _)) = self.kept.get(place) {
            // SAFETY: as above.
            unsafe { *queue.0.get() = (id, value) };
            self.count = self.count.max(place + 1);
        }
    }
}

impl Class for Changes {
    type Interfaces = (IParameterChanges,);
}

impl IParameterChangesTrait for Changes {
    unsafe fn getParameterCount(&self) -> int32 {
        // SAFETY: the list changes only outside of the framework's `process`; the host's is null or valid within.
        unsafe {
            let list = &*self.0.get();
            list.count as int32 + ComRef::from_raw(list.host).map_or(0, |host| host.getParameterCount())
        }
    }

    unsafe fn getParameterData(&self, index: int32) -> *mut IParamValueQueue {
        // SAFETY: as above.
        unsafe {
            let list = &*self.0.get();
            let own = usize::try_from(index).ok().filter(|&index| index < list.count);
            if let Some((_, queue)) = own.and_then(|index| list.kept.get(index)) {
                return queue.as_ptr();
            }
            let host = ComRef::from_raw(list.host);
            host.map_or(std::ptr::null_mut(), |host| host.getParameterData(index - list.count as int32))
        }
    }

    unsafe fn addParameterData(&self, _id: *const ParamID, _index: *mut int32) -> *mut IParamValueQueue {
        std::ptr::null_mut()
    }
}
