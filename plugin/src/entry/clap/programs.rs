//! Program changes as hosts understand them: every parameter of the preset moves at their sample.
//!
//! The framework lets an instrument hear of a program change but not move its own parameters. So what it hears is
//! written anew: before each program change stand the values of its preset, as if the host had sent them, and
//! the host is told of the same values. System exclusive messages without bytes are left out on the way.

use std::ffi::c_void;
use std::ptr;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI, CLAP_EVENT_MIDI_SYSEX, CLAP_EVENT_PARAM_VALUE,
    clap_event_header, clap_event_midi, clap_event_midi_sysex, clap_event_param_value, clap_input_events,
    clap_output_events,
};

use crate::host_parameters::HostParameters;
use overhear_player::parameters::{COUNT, host_id, parameters};
use overhear_player::presets::Program;

/// Most events of a buffer that can be written anew.
const MOST_EVENTS: usize = 16_384;

/// Most values of a buffer: some program changes' worth.
const MOST_VALUES: usize = 16 * COUNT;

/// Status of a program change, in the upper half of MIDI's first byte.
const PROGRAM_CHANGE: u8 = 0xC0;

/// The events of one buffer with the values of its program changes. Never grows: its addresses are given out.
pub struct ProgramChanges {
    values: Vec<clap_event_param_value>,
    order: Vec<*const clap_event_header>,
}

impl ProgramChanges {
    /// Room for a buffer's events.
    pub fn new() -> ProgramChanges {
        ProgramChanges { values: Vec::with_capacity(MOST_VALUES), order: Vec::with_capacity(MOST_EVENTS) }
    }

    /// The events with what their program changes ask for, valid until the next call; `None` if that is nothing, or more
    /// than there is room for.
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
    ) -> Option<clap_input_events> {
        self.values.clear();
        self.order.clear();
        let (size, get) = (events.size?, events.get?);
        // SAFETY: as promised; the list owns what it returns for the length of the call.
        unsafe {
            let count = size(events);
            let event = |index| get(events, index);
            let calls = |header| {
                let named = program_of(header);
                named.is_some_and(|(number, channel)| {
                    parameters.with_program(number, channel, |_| ()).is_some()
                })
            };
            if !(0..count).any(|index| calls(event(index)) || is_empty_message(event(index))) {
                return None;
            }
            for index in 0..count {
                let header = event(index);
                if is_empty_message(header) {
                    continue;
                }
                if let Some((number, channel)) = program_of(header) {
                    let time = (*header).time;
                    parameters
                        .with_program(number, channel, |program| self.write(program, time))
                        .unwrap_or(Some(()))?;
                }
                self.list(header)?;
            }
        }
        let context = ptr::from_ref(self).cast_mut().cast::<c_void>();
        Some(clap_input_events { ctx: context, size: Some(listed), get: Some(at) })
    }

    fn write(&mut self, program: &Program, time: u32) -> Option<()> {
        for &(index, plain) in &program.values {
            if self.values.len() == MOST_VALUES {
                return None;
            }
            let parameter = parameters().get(index)?;
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
            let written = self.values.last()?;
            self.list(&raw const written.header)?;
        }
        Some(())
    }

    fn list(&mut self, header: *const clap_event_header) -> Option<()> {
        (self.order.len() < MOST_EVENTS).then(|| self.order.push(header))
    }

    /// Tells the host what has moved, at the end of a buffer.
    ///
    /// # Safety
    /// `output` is null or a valid list.
    pub unsafe fn tell(&mut self, output: *const clap_output_events, frames: u32) {
        // SAFETY: as promised.
        let Some(push) = unsafe { output.as_ref() }.and_then(|output| output.try_push) else { return };
        for value in &mut self.values {
            // Behind whatever the framework has told.
            value.header.time = frames.saturating_sub(1);
            // SAFETY: the host copies the event. One that has no room for it asks later.
            unsafe { push(output, &raw const value.header) };
        }
        self.values.clear();
    }
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
    unsafe { (*(*list).ctx.cast::<ProgramChanges>()).order.len() as u32 }
}

unsafe extern "C" fn at(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above.
    let order = unsafe { &(*(*list).ctx.cast::<ProgramChanges>()).order };
    order.get(index as usize).copied().unwrap_or_default()
}
