//! The functions of the framework's table of parameters that are replaced: values are told in the host's own numbers, and
//! events come [written anew](super::input).

use std::ffi::c_char;

use clap_sys::events::{clap_input_events, clap_output_events};
use clap_sys::ext::params::{
    CLAP_EXT_PARAMS, CLAP_PARAM_IS_ENUM, CLAP_PARAM_IS_STEPPED, clap_param_info, clap_plugin_params,
};
use clap_sys::id::clap_id;
use clap_sys::plugin::clap_plugin;

use super::guard::{Guard, guard};
use super::steps::{self, Telling};
use crate::guard::caught;

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
            && let Some(steps) = steps::of(into.id)
        {
            into.flags |= CLAP_PARAM_IS_STEPPED | CLAP_PARAM_IS_ENUM;
            into.max_value = f64::from(steps);
            into.default_value = steps::told(into.id, into.default_value);
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
                *into = steps::told(id, f64::from(base));
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
        text.is_some_and(|text| text(plugin, id, steps::asked(id, number), into, size))
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
            *into = steps::told(id, *into);
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
