//! The events of a buffer, written anew where the framework could not take them as they are.
//!
//! * A program change moves parameters. The framework lets an instrument hear of one but not move its own parameters, so
//!   before all else at its sample stand the values of its preset, as if the host had sent them, and the host is told of
//!   the same values.
//! * Hosts step through switches and lists by whole numbers, while the framework has shares of the range: see
//!   [`steps`](super::steps).
//! * Notes and controllers of a call without samples wait for the first sample of the next one. The framework would lose
//!   them.
//! * Events after a buffer's end, or before one that precedes them in the list, are moved to where they may be: the framework
//!   would render up to the time of a value, beyond the host's buffer.
//! * System exclusive messages without bytes are left out: the framework panics on them where that cannot be caught.

use std::ffi::c_void;
use std::ptr;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI, CLAP_EVENT_MIDI_SYSEX, CLAP_EVENT_NOTE_CHOKE,
    CLAP_EVENT_NOTE_EXPRESSION, CLAP_EVENT_NOTE_OFF, CLAP_EVENT_NOTE_ON, CLAP_EVENT_PARAM_MOD,
    CLAP_EVENT_PARAM_VALUE, clap_event_header, clap_event_midi, clap_event_midi_sysex, clap_event_param_mod,
    clap_event_param_value, clap_input_events, clap_output_events,
};

use super::steps;
use crate::host_parameters::HostParameters;
use overhear_player::parameters::{COUNT, host_id, parameters};
use overhear_player::presets::Program;

/// Most events of a buffer that can be written anew; what is beyond is left out.
const MOST_EVENTS: usize = 65_536;

/// Most values of a buffer that are written or scaled: some program changes' worth, and steps beside them.
const MOST_VALUES: usize = 32 * COUNT;

/// Most events that wait for the next buffer.
const MOST_WAITING: usize = 1024;

/// Most events of a buffer that can be moved; what is beyond is left out, as no host that works has any.
const MOST_MOVED: usize = 16_384;

/// Size of the largest event that waits or is moved, words: all of them are plain data.
const WORDS: usize = 8;

/// Status of a program change, in the upper half of MIDI's first byte.
const PROGRAM_CHANGE: u8 = 0xC0;

/// The events of one buffer, written anew. Never grows: its addresses are given out.
pub struct Input {
    /// Of program changes, in shares of the range: the host is told of them.
    values: Vec<clap_event_param_value>,
    /// Steps as shares of the range.
    scaled: Vec<Scaled>,
    /// From calls without samples.
    waiting: Vec<[u64; WORDS]>,
    /// Copies with another time.
    moved: Vec<[u64; WORDS]>,
    order: Vec<*const clap_event_header>,
}

/// A value or a modulation as the framework wants it.
#[derive(Clone, Copy)]
#[repr(C)]
union Scaled {
    header: clap_event_header,
    value: clap_event_param_value,
    modulation: clap_event_param_mod,
}

impl Input {
    /// Room for a buffer's events.
    pub fn new() -> Input {
        Input {
            values: Vec::with_capacity(MOST_VALUES),
            scaled: Vec::with_capacity(MOST_VALUES),
            waiting: Vec::with_capacity(MOST_WAITING),
            moved: Vec::with_capacity(MOST_MOVED),
            order: Vec::with_capacity(MOST_EVENTS),
        }
    }

    /// The events of a buffer of `frames` samples as the framework can take them, valid until the next call; `None` if they
    /// are so already.
    ///
    /// # Safety
    /// `events` is a valid list.
    ///
    /// # Real-time
    /// A look at every event; no allocation.
    pub unsafe fn written_out(
        &mut self,
        events: &clap_input_events,
        parameters: &HostParameters,
        frames: u32,
    ) -> Option<clap_input_events> {
        self.values.clear();
        self.scaled.clear();
        self.moved.clear();
        self.order.clear();
        let (size, get) = (events.size?, events.get?);
        // SAFETY: as promised; the list owns what it returns for the length of the call.
        unsafe {
            let count = size(events);
            let event = |index| get(events, index);
            let mut latest = 0;
            let is_fine = |header: *const clap_event_header| {
                let in_place =
                    header.as_ref().is_some_and(|known| known.time == placed(known, &mut latest, frames));
                frames > 0 && in_place && !must_change(header, parameters)
            };
            if self.waiting.is_empty() && count as usize <= MOST_EVENTS && (0..count).map(event).all(is_fine)
            {
                return None;
            }
            if frames > 0 {
                self.order
                    .extend(self.waiting.iter().map(|words| words.as_ptr().cast::<clap_event_header>()));
            }
            let (mut called_for, mut latest) = (None, 0);
            for index in 0..count {
                let header = event(index);
                let Some(known) = header.as_ref() else { continue };
                let (sent, now) = (known.time, placed(known, &mut latest, frames));
                // Values act before whatever else happens at their sample, wherever the host cuts its buffers.
                if called_for != Some(sent) {
                    called_for = Some(sent);
                    let together = |&at: &u32| event(at).as_ref().is_some_and(|other| other.time == sent);
                    for at in (index..count).take_while(together) {
                        let Some((number, channel)) = program_of(event(at)) else { continue };
                        parameters.with_program(number, channel, |program| self.call(program, now));
                    }
                }
                let header = if sent == now { header } else { self.moved(header, now) };
                if frames == 0 && waits(header) {
                    self.wait(header);
                } else if !is_empty_message(header) {
                    self.list(header);
                }
            }
        }
        let context = ptr::from_ref(self).cast_mut().cast::<c_void>();
        Some(clap_input_events { ctx: context, size: Some(listed), get: Some(at) })
    }

    /// A copy of an event at another time, or null if there is no room for it.
    ///
    /// # Safety
    /// `header` is valid.
    unsafe fn moved(&mut self, header: *const clap_event_header, time: u32) -> *const clap_event_header {
        // SAFETY: as promised.
        match unsafe { copied(header, time) } {
            Some(words) if self.moved.len() < MOST_MOVED => {
                self.moved.push(words);
                self.moved.last().map_or(ptr::null(), |words| words.as_ptr().cast())
            }
            _ => ptr::null(),
        }
    }

    /// Lists the values of a program, all or none.
    fn call(&mut self, program: &Program, time: u32) {
        if self.values.len() + program.values.len() > MOST_VALUES {
            return;
        }
        for &(index, plain) in &program.values {
            let Some(parameter) = parameters().get(index) else { continue };
            self.values.push(clap_event_param_value {
                header: clap_event_header {
                    size: size_of::<clap_event_param_value>() as u32,
                    time,
                    space_id: CLAP_CORE_EVENT_SPACE_ID,
                    type_: CLAP_EVENT_PARAM_VALUE,
                    flags: 0,
                },
                param_id: host_id(parameter.id),
                cookie: ptr::null_mut(),
                note_id: -1,
                port_index: -1,
                channel: -1,
                key: -1,
                value: f64::from(parameter.normalized(plain)),
            });
            if let Some(written) = self.values.last() {
                push(&mut self.order, &raw const written.header);
            }
        }
    }

    /// Lists an event, its steps as shares of the range.
    ///
    /// # Safety
    /// `header` is null or valid for the call.
    unsafe fn list(&mut self, header: *const clap_event_header) {
        // SAFETY: as promised; an event of a type is of its form.
        unsafe {
            let Some(steps) = stepped_of(header) else { return push(&mut self.order, header) };
            if self.scaled.len() == MOST_VALUES {
                return;
            }
            let scaled = if (*header).type_ == CLAP_EVENT_PARAM_VALUE {
                let mut value = *header.cast::<clap_event_param_value>();
                value.value = steps::share(value.value, steps);
                Scaled { value }
            } else {
                let mut modulation = *header.cast::<clap_event_param_mod>();
                modulation.amount /= f64::from(steps);
                Scaled { modulation }
            };
            self.scaled.push(scaled);
            if let Some(scaled) = self.scaled.last() {
                push(&mut self.order, &raw const scaled.header);
            }
        }
    }

    /// Keeps an event for the next buffer's first sample.
    ///
    /// # Safety
    /// `header` is valid, and that of an event that [`waits`].
    unsafe fn wait(&mut self, header: *const clap_event_header) {
        if self.waiting.len() == MOST_WAITING {
            return;
        }
        // SAFETY: as promised.
        let Some(words) = (unsafe { copied(header, 0) }) else { return };
        self.waiting.push(words);
    }

    /// Whether events wait for the next buffer.
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Tells the host what has moved, at the end of a buffer, and forgets what has been played.
    ///
    /// # Safety
    /// `output` is null or a valid list.
    pub unsafe fn finish(&mut self, output: *const clap_output_events, frames: u32) {
        if frames > 0 {
            self.waiting.clear();
        }
        // SAFETY: as promised.
        let told = unsafe { output.as_ref() }.and_then(|output| output.try_push);
        for value in &mut self.values {
            // Behind whatever the framework has told.
            value.header.time = frames.saturating_sub(1);
            value.value = steps::told(value.param_id, value.value);
            // SAFETY: the host copies the event. One that has no room for it asks later.
            told.map(|push| unsafe { push(output, &raw const value.header) });
        }
        self.values.clear();
    }
}

/// When an event may happen in a buffer of `frames` samples: not after its end, and not before what precedes it in the list.
fn placed(header: &clap_event_header, latest: &mut u32, frames: u32) -> u32 {
    *latest = header.time.min(frames.saturating_sub(1)).max(*latest);
    *latest
}

/// An event of plain data at another time, if it is not too large.
///
/// # Safety
/// `header` is valid.
unsafe fn copied(header: *const clap_event_header, time: u32) -> Option<[u64; WORDS]> {
    let mut words = [0_u64; WORDS];
    // SAFETY: as promised; what is copied fits, and begins with a header.
    unsafe {
        let size = (*header).size as usize;
        if !(size_of::<clap_event_header>()..=size_of_val(&words)).contains(&size) {
            return None;
        }
        ptr::copy_nonoverlapping(header.cast::<u8>(), words.as_mut_ptr().cast::<u8>(), size);
        (*words.as_mut_ptr().cast::<clap_event_header>()).time = time;
    }
    Some(words)
}

fn push(order: &mut Vec<*const clap_event_header>, header: *const clap_event_header) {
    if order.len() < MOST_EVENTS && !header.is_null() {
        order.push(header);
    }
}

/// Whether the framework cannot take an event as it is.
///
/// # Safety
/// `header` is null or valid.
unsafe fn must_change(header: *const clap_event_header, parameters: &HostParameters) -> bool {
    // SAFETY: as promised.
    unsafe {
        let calls = || {
            let named = program_of(header);
            named.is_some_and(|(number, channel)| parameters.with_program(number, channel, |_| ()).is_some())
        };
        is_empty_message(header) || stepped_of(header).is_some() || calls()
    }
}

/// Whether an event of a call without samples waits for the next one: notes and short messages do. Parameters move at once.
///
/// # Safety
/// `header` is null or valid.
unsafe fn waits(header: *const clap_event_header) -> bool {
    // SAFETY: as promised.
    let Some(known) = (unsafe { header.as_ref() }) else { return false };
    known.space_id == CLAP_CORE_EVENT_SPACE_ID
        && known.size as usize <= size_of::<[u64; WORDS]>()
        && matches!(
            known.type_,
            CLAP_EVENT_NOTE_ON
                | CLAP_EVENT_NOTE_OFF
                | CLAP_EVENT_NOTE_CHOKE
                | CLAP_EVENT_NOTE_EXPRESSION
                | CLAP_EVENT_MIDI
        )
}

/// Whether an event is a system exclusive message without bytes, on which the framework panics where that cannot be caught.
///
/// # Safety
/// `header` is null or valid.
unsafe fn is_empty_message(header: *const clap_event_header) -> bool {
    // SAFETY: as promised; an event of this type is of this form.
    unsafe {
        header.as_ref().is_some_and(|known| {
            known.space_id == CLAP_CORE_EVENT_SPACE_ID
                && known.type_ == CLAP_EVENT_MIDI_SYSEX
                && (*header.cast::<clap_event_midi_sysex>()).buffer.is_null()
        })
    }
}

/// Steps of the stepped parameter that an event moves.
///
/// # Safety
/// `header` is null or valid.
unsafe fn stepped_of(header: *const clap_event_header) -> Option<u32> {
    // SAFETY: as promised; an event of a type is of its form.
    unsafe {
        let known = header.as_ref().filter(|known| known.space_id == CLAP_CORE_EVENT_SPACE_ID)?;
        let id = match known.type_ {
            CLAP_EVENT_PARAM_VALUE => (*header.cast::<clap_event_param_value>()).param_id,
            CLAP_EVENT_PARAM_MOD => (*header.cast::<clap_event_param_mod>()).param_id,
            _ => return None,
        };
        steps::of(id)
    }
}

/// Number and channel of a program change.
///
/// # Safety
/// `header` is null or valid.
unsafe fn program_of(header: *const clap_event_header) -> Option<(u8, u8)> {
    // SAFETY: as promised; an event of this type is of this form.
    unsafe {
        let known = header.as_ref()?;
        if known.space_id != CLAP_CORE_EVENT_SPACE_ID || known.type_ != CLAP_EVENT_MIDI {
            return None;
        }
        let [status, number, _] = (*header.cast::<clap_event_midi>()).data;
        (status & 0xF0 == PROGRAM_CHANGE).then_some((number & 0x7F, status & 0x0F))
    }
}

unsafe extern "C" fn listed(list: *const clap_input_events) -> u32 {
    // SAFETY: the context is what `written_out` has put there.
    unsafe { (*(*list).ctx.cast::<Input>()).order.len() as u32 }
}

unsafe extern "C" fn at(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above.
    let order = unsafe { &(*(*list).ctx.cast::<Input>()).order };
    order.get(index as usize).copied().unwrap_or_default()
}
