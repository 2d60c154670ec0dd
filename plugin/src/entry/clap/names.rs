//! Names of outputs, which are those of the kit's pieces, and how a host hears of others.
//!
//! The framework has one table of names for all instances. The guard tells each its own; when the kit changes, on whatever
//! thread, it asks the host for a call on the main thread, where it says that outputs and notes have other names.

use std::ffi::{CStr, c_char};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap_sys::ext::audio_ports::{
    CLAP_AUDIO_PORTS_RESCAN_NAMES, CLAP_EXT_AUDIO_PORTS, clap_audio_port_info, clap_host_audio_ports,
    clap_plugin_audio_ports,
};
use clap_sys::ext::note_name::{CLAP_EXT_NOTE_NAME, clap_host_note_name};
use clap_sys::host::clap_host;
use clap_sys::plugin::clap_plugin;

use super::guard::guard;
use crate::guard::caught;
use crate::host_parameters::Teller;
use crate::outputs;

/// The framework's table with the names of the kit.
pub static PORTS: clap_plugin_audio_ports = clap_plugin_audio_ports { count: Some(count), get: Some(get) };

/// The framework's own table.
///
/// # Safety
/// The plugin is one of the guard's.
unsafe fn framework<'a>(plugin: *const clap_plugin) -> Option<&'a clap_plugin_audio_ports> {
    // SAFETY: as promised.
    unsafe {
        let get = guard(plugin).framework.get_extension?;
        get(plugin, CLAP_EXT_AUDIO_PORTS.as_ptr()).cast::<clap_plugin_audio_ports>().as_ref()
    }
}

unsafe extern "C" fn count(plugin: *const clap_plugin, is_input: bool) -> u32 {
    // SAFETY: see `guard`.
    caught("audio_ports.count", 0, || unsafe {
        framework(plugin).and_then(|table| table.count).map_or(0, |count| count(plugin, is_input))
    })
}

unsafe extern "C" fn get(
    plugin: *const clap_plugin,
    index: u32,
    is_input: bool,
    into: *mut clap_audio_port_info,
) -> bool {
    // SAFETY: see `guard`; `into` is null or valid.
    caught("audio_ports.get", false, || unsafe {
        let get = framework(plugin).and_then(|table| table.get);
        if into.is_null() || !get.is_some_and(|get| get(plugin, index, is_input, into)) {
            return false;
        }
        let kit = guard(plugin).parameters.as_ref().map(|parameters| parameters.document());
        // The main output is no piece's.
        let place = (index as usize).checked_sub(1).filter(|_| !is_input);
        if let Some(title) = kit.zip(place).and_then(|(kit, place)| outputs::title(place, &kit.kit)) {
            write(&title, &mut (*into).name);
        }
        true
    })
}

/// Writes a text and its end, as many whole characters as there is room for.
pub fn write(text: &str, into: &mut [c_char]) {
    into.fill(0);
    let end = text.floor_char_boundary(into.len().saturating_sub(1));
    for (to, from) in into.iter_mut().zip(text[..end].bytes()) {
        *to = from as c_char;
    }
}

/// A host that may be asked for a call on the main thread from any thread.
struct Asked(*const clap_host);

// SAFETY: the format lets `request_callback` be called on any thread, and the host outlives the plugin, whose `destroy` takes
// the teller away.
unsafe impl Send for Asked {}

/// What tells a host of another kit.
pub fn teller(host: *const clap_host, renamed: Arc<AtomicBool>) -> Option<Teller> {
    let asked = Asked(host);
    Some(Box::new(move || {
        let Asked(host) = &asked;
        renamed.store(true, Ordering::Release);
        // SAFETY: see above.
        unsafe {
            if let Some(request) = host.as_ref().and_then(|host| host.request_callback) {
                request(*host);
            }
        }
    }))
}

pub unsafe extern "C" fn on_main_thread(plugin: *const clap_plugin) {
    // SAFETY: see `guard`; the host calls on its main thread.
    caught("on_main_thread", (), || unsafe {
        let guard = guard(plugin);
        if guard.renamed.swap(false, Ordering::AcqRel) {
            tell(guard.host);
        }
        if let Some(framework) = guard.framework.on_main_thread {
            framework(plugin);
        }
    });
}

/// Tells a host that outputs and notes have other names.
///
/// # Safety
/// `host` is null or as the format says; on the main thread.
unsafe fn tell(host: *const clap_host) {
    // SAFETY: as promised; an extension that is there is a table of its kind.
    unsafe {
        if let Some(ports) = extension::<clap_host_audio_ports>(host, CLAP_EXT_AUDIO_PORTS) {
            let knows = |supported: unsafe extern "C" fn(*const clap_host, u32) -> bool| {
                supported(host, CLAP_AUDIO_PORTS_RESCAN_NAMES)
            };
            if let Some(rescan) = ports.rescan.filter(|_| ports.is_rescan_flag_supported.is_some_and(knows)) {
                rescan(host, CLAP_AUDIO_PORTS_RESCAN_NAMES);
            }
        }
        if let Some(changed) =
            extension::<clap_host_note_name>(host, CLAP_EXT_NOTE_NAME).and_then(|names| names.changed)
        {
            changed(host);
        }
    }
}

/// A table of the host's.
///
/// # Safety
/// `host` is null or as the format says, and the table of that name is a `T`.
unsafe fn extension<'a, T>(host: *const clap_host, name: &CStr) -> Option<&'a T> {
    // SAFETY: as promised.
    unsafe {
        let ask = host.as_ref()?.get_extension?;
        ask(host, name.as_ptr()).cast::<T>().as_ref()
    }
}
