//! Switches and lists: to hosts whole numbers from 0, to the framework shares of the range.
//!
//! Automation of a stepped parameter jumps, and hosts show a switch or a list. The framework would present all parameters
//! of the table as continuous.

use std::ffi::c_void;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE, clap_event_header, clap_event_param_value,
    clap_output_events,
};
use clap_sys::id::clap_id;
use overhear_player::parameters::stepped;

/// Steps of the parameter of an id.
pub fn of(id: clap_id) -> Option<u32> {
    stepped(id)
}

/// The share of the range at which a host's number is, the nearest step.
pub fn share(number: f64, steps: u32) -> f64 {
    number.round() / f64::from(steps)
}

/// What a host is told of a share of the range.
pub fn told(id: clap_id, share: f64) -> f64 {
    of(id).map_or(share, |steps| (share * f64::from(steps)).round())
}

/// The share of the range that the framework is told of a host's number.
pub fn asked(id: clap_id, number: f64) -> f64 {
    of(id).map_or(number, |steps| share(number, steps))
}

/// What the host is told, in its own numbers.
pub struct Telling {
    host: *const clap_output_events,
}

impl Telling {
    /// For a host's list, if it gives one.
    pub fn of(host: *const clap_output_events) -> Option<Telling> {
        (!host.is_null()).then_some(Telling { host })
    }

    /// The list that the framework is given. It must not outlive `self`.
    pub fn list(&self) -> clap_output_events {
        clap_output_events { ctx: std::ptr::from_ref(self).cast_mut().cast::<c_void>(), try_push: Some(push) }
    }
}

unsafe extern "C" fn push(list: *const clap_output_events, event: *const clap_event_header) -> bool {
    // SAFETY: the context is what `list` has put there; the framework passes a valid event.
    unsafe {
        let host = (*(*list).ctx.cast::<Telling>()).host;
        let Some(push) = (*host).try_push else { return false };
        let is_value = |known: &clap_event_header| {
            (known.space_id, known.type_) == (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE)
        };
        if !event.as_ref().is_some_and(is_value) {
            return push(host, event);
        }
        let mut value = *event.cast::<clap_event_param_value>();
        value.value = told(value.param_id, value.value);
        push(host, &raw const value.header)
    }
}
