//! Switches and lists: to hosts whole numbers from 0, to the framework shares of the range.
//!
//! Automation of a stepped parameter jumps, and hosts show a switch or a list. The framework would present all parameters
//! of the table as continuous.

use std::ffi::{c_char, c_void};

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE, clap_event_header, clap_event_param_value,
    clap_input_events, clap_output_events,
};
use clap_sys::ext::params::{
    CLAP_EXT_PARAMS, CLAP_PARAM_IS_ENUM, CLAP_PARAM_IS_STEPPED, clap_param_info, clap_plugin_params,
};
use clap_sys::id::clap_id;
use clap_sys::plugin::clap_plugin;
use overhear_player::parameters::stepped;

use super::{Guard, guard};
use crate::guard::caught;

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

/// What the framework is told of a host's number.
fn asked(id: clap_id, number: f64) -> f64 {
    of(id).map_or(number, |steps| share(number, steps))
}

/// The framework's table with the functions that have to do with values replaced.
pub fn table(framework: &clap_plugin_params) -> clap_plugin_params {
    clap_plugin_params {
        get_info: Some(info),
        get_value: Some(value),
        value_to_text: Some(text),
        text_to_value: Some(number),
        flush: Some(flush),
        ..*framework
    }
}

/// The framework's own table.
///
/// # Safety
/// The plugin is one of the guard's.
unsafe fn framework<'a>(plugin: *const clap_plugin) -> Option<&'a clap_plugin_params> {
    // SAFETY: as promised.
    unsafe {
        let get = guard(plugin).framework.get_extension?;
        get(plugin, CLAP_EXT_PARAMS.as_ptr()).cast::<clap_plugin_params>().as_ref()
    }
}

unsafe extern "C" fn info(plugin: *const clap_plugin, index: u32, into: *mut clap_param_info) -> bool {
    // SAFETY: see `guard`; `into` is null or valid.
    caught("get_info", false, || unsafe {
        let Some(table) = framework(plugin) else { return false };
        // The framework looks one behind the last.
        let count = table.count.map_or(0, |count| count(plugin));
        if index >= count || !table.get_info.is_some_and(|get| get(plugin, index, into)) {
            return false;
        }
        if let Some(into) = into.as_mut()
            && let Some(steps) = of(into.id)
        {
            into.flags |= CLAP_PARAM_IS_STEPPED | CLAP_PARAM_IS_ENUM;
            into.max_value = f64::from(steps);
            into.default_value = told(into.id, into.default_value);
        }
        true
    })
}

/// A parameter's value without modulation, which the framework would add and hosts do not expect.
unsafe extern "C" fn value(plugin: *const clap_plugin, id: clap_id, into: *mut f64) -> bool {
    // SAFETY: see `guard`; `into` is null or valid.
    caught("get_value", false, || unsafe {
        let base = guard(plugin).parameters.as_ref().and_then(|parameters| parameters.unmodulated(id));
        match (base, into.as_mut()) {
            (Some(base), Some(into)) => {
                *into = told(id, f64::from(base));
                true
            }
            _ => {
                let value = framework(plugin).and_then(|table| table.get_value);
                value.is_some_and(|value| value(plugin, id, into))
            }
        }
    })
}

unsafe extern "C" fn text(
    plugin: *const clap_plugin,
    id: clap_id,
    number: f64,
    into: *mut c_char,
    size: u32,
) -> bool {
    // SAFETY: see `guard`; the framework checks the rest.
    caught("value_to_text", false, || unsafe {
        let text = framework(plugin).and_then(|table| table.value_to_text);
        text.is_some_and(|text| text(plugin, id, asked(id, number), into, size))
    })
}

unsafe extern "C" fn number(
    plugin: *const clap_plugin,
    id: clap_id,
    text: *const c_char,
    into: *mut f64,
) -> bool {
    // SAFETY: see `guard`; the framework checks the rest.
    caught("text_to_value", false, || unsafe {
        let read = framework(plugin).and_then(|table| table.text_to_value);
        let found = read.is_some_and(|read| read(plugin, id, text, into));
        if let Some(into) = into.as_mut().filter(|_| found) {
            *into = told(id, *into);
        }
        found
    })
}

/// What a host sends and is told while it does not process. It never does both at once.
unsafe extern "C" fn flush(
    plugin: *const clap_plugin,
    events: *const clap_input_events,
    output: *const clap_output_events,
) {
    // SAFETY: see `guard`; the lists are null or valid, and `flush` overlaps with neither `process` nor `activate`, so that
    // nobody else holds the events.
    caught("flush", (), || unsafe {
        let guard: &Guard = guard(plugin);
        let Some(flush) = framework(plugin).and_then(|table| table.flush) else { return };
        let input = &mut (*guard.outputs.get()).input;
        let written = events.as_ref().zip(guard.parameters.as_deref());
        let written = written.and_then(|(events, parameters)| input.written_out(events, parameters, 0));
        let own = Telling::of(output);
        let own = own.as_ref().map(Telling::list);
        flush(
            plugin,
            written.as_ref().map_or(events, |events| events),
            own.as_ref().map_or(output, |output| output),
        );
        if written.is_some() {
            input.finish(output, 0);
        }
    });
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
