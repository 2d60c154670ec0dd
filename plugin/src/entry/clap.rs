//! The CLAP entry: both instruments, each behind a guard.
//!
//! A guard is a copy of the framework's plugin table with some functions of its own: it times, names notes, completes
//! outputs, and writes anew what the framework could not take. `plugin_data` stays the
//! framework's, so that all it gets called with means to it what it did; the guard itself is found through the
//! table's address, whose first field it is.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_void};
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use clap_sys::audio_buffer::clap_audio_buffer;
use clap_sys::entry::clap_plugin_entry;
use clap_sys::ext::audio_ports::CLAP_EXT_AUDIO_PORTS;
use clap_sys::ext::gui::CLAP_EXT_GUI;
use clap_sys::ext::note_name::{CLAP_EXT_NOTE_NAME, clap_note_name, clap_plugin_note_name};
use clap_sys::ext::params::{CLAP_EXT_PARAMS, clap_plugin_params};
use clap_sys::ext::tail::{CLAP_EXT_TAIL, clap_plugin_tail};
use clap_sys::factory::plugin_factory::{CLAP_PLUGIN_FACTORY_ID, clap_plugin_factory};
use clap_sys::host::clap_host;
use clap_sys::plugin::{clap_plugin, clap_plugin_descriptor};
use clap_sys::process::{CLAP_PROCESS_CONTINUE, CLAP_PROCESS_ERROR, clap_process, clap_process_status};
use clap_sys::version::CLAP_VERSION;
use nice_plug::prelude::*;
use nice_plug::wrapper::clap::{PluginDescriptor, Wrapper};
use nice_plug::wrapper::setup_logger;

use self::guard::{Guard, Outputs, guard};
use self::input::Input;
use self::steps::Telling;
use super::TAIL;
use super::scratch::{CHANNELS, Scratch};
use crate::guard::caught;
use crate::host_parameters;
use crate::outputs::Used;
use crate::plugin::{Overhear, OverhearMulti};

mod guard;
mod input;
mod names;
mod steps;
mod table;

/// What hosts look up by name.
#[allow(non_upper_case_globals, missing_docs)]
#[unsafe(no_mangle)]
#[used]
pub static clap_entry: clap_plugin_entry = clap_plugin_entry {
    clap_version: CLAP_VERSION,
    init: Some(init),
    deinit: Some(deinit),
    get_factory: Some(get_factory),
};

static FACTORY: clap_plugin_factory = clap_plugin_factory {
    get_plugin_count: Some(plugin_count),
    get_plugin_descriptor: Some(descriptor),
    create_plugin: Some(create),
};

static NOTE_NAMES: clap_plugin_note_name =
    clap_plugin_note_name { count: Some(note_count), get: Some(note_name) };

static TAIL_TOLD: clap_plugin_tail = clap_plugin_tail { get: Some(tail) };

/// How long it rings after the last note, samples.
unsafe extern "C" fn tail(plugin: *const clap_plugin) -> u32 {
    // SAFETY: see `guard`.
    let rate = unsafe { guard(plugin) }.sample_rate.load(Ordering::Relaxed);
    (TAIL * f64::from_bits(rate)) as u32
}

unsafe extern "C" fn init(_path: *const c_char) -> bool {
    caught("init", false, || {
        setup_logger::<Overhear>();
        true
    })
}

unsafe extern "C" fn deinit() {}

/// # Safety
/// `id` is null or a string.
unsafe extern "C" fn get_factory(id: *const c_char) -> *const c_void {
    // SAFETY: as promised.
    if !id.is_null() && unsafe { CStr::from_ptr(id) } == CLAP_PLUGIN_FACTORY_ID {
        ptr::from_ref(&FACTORY).cast()
    } else {
        ptr::null()
    }
}

/// Both instruments' descriptors, in the order hosts see.
fn descriptors() -> &'static [PluginDescriptor; 2] {
    static DESCRIPTORS: OnceLock<[PluginDescriptor; 2]> = OnceLock::new();
    DESCRIPTORS.get_or_init(|| {
        [PluginDescriptor::for_plugin::<Overhear>(), PluginDescriptor::for_plugin::<OverhearMulti>()]
    })
}

unsafe extern "C" fn plugin_count(_factory: *const clap_plugin_factory) -> u32 {
    caught("get_plugin_count", 0, || descriptors().len() as u32)
}

unsafe extern "C" fn descriptor(
    _factory: *const clap_plugin_factory,
    index: u32,
) -> *const clap_plugin_descriptor {
    caught("get_plugin_descriptor", ptr::null(), || {
        descriptors().get(index as usize).map_or(ptr::null(), |found| found.clap_plugin_descriptor())
    })
}

/// # Safety
/// `id` is null or a string; `host` is as the format says.
unsafe extern "C" fn create(
    _factory: *const clap_plugin_factory,
    host: *const clap_host,
    id: *const c_char,
) -> *const clap_plugin {
    if id.is_null() {
        return ptr::null();
    }
    // SAFETY: as promised; the framework takes the host as it comes.
    caught("create_plugin", ptr::null(), || unsafe {
        let [stereo, multi] = descriptors();
        match CStr::from_ptr(id) {
            id if id == stereo.clap_id() => guarded::<Overhear>(host),
            id if id == multi.clap_id() => guarded::<OverhearMulti>(host),
            _ => ptr::null(),
        }
    })
}

/// # Safety
/// `host` is as the format says.
unsafe fn guarded<P: ClapPlugin>(host: *const clap_host) -> *const clap_plugin {
    // SAFETY: the host is as the framework expects it; the wrapper lives, and nobody borrows its table yet.
    let framework = unsafe {
        let wrapper = Arc::into_raw(Wrapper::<P>::new(host));
        *(*wrapper).clap_plugin.as_ptr()
    };
    let ports = P::AUDIO_IO_LAYOUTS.first().map_or(0, |layout| 1 + layout.aux_output_ports.len());
    let table = clap_plugin {
        destroy: Some(destroy),
        activate: Some(activate),
        start_processing: Some(start_processing),
        process: Some(timed_process),
        get_extension: Some(get_extension),
        on_main_thread: Some(names::on_main_thread),
        ..framework
    };
    let (input, scratch) = (Input::new(), Scratch::new(ports));
    let outputs = Outputs { input, scratch, ports: Vec::with_capacity(ports), active: false, fresh: true };
    let parameters = host_parameters::take_latest();
    let (values, outputs) = (OnceLock::new(), UnsafeCell::new(outputs));
    let sample_rate = AtomicU64::new(0);
    let renamed = Arc::new(AtomicBool::new(false));
    if let Some(parameters) = &parameters {
        parameters.tell_by(names::teller(host, renamed.clone()));
    }
    let guard = Guard { table, framework, host, parameters, renamed, sample_rate, values, outputs };
    Box::into_raw(Box::new(guard)).cast()
}

unsafe extern "C" fn destroy(plugin: *const clap_plugin) {
    // SAFETY: the host's last call: the box comes back, after the framework has had its turn.
    unsafe {
        // The host is not called any more.
        if let Some(parameters) = &guard(plugin).parameters {
            parameters.tell_by(None);
        }
        if let Some(destroy) = guard(plugin).framework.destroy {
            destroy(plugin);
        }
        drop(Box::<Guard>::from_raw(plugin.cast_mut().cast()));
    }
}

unsafe extern "C" fn activate(plugin: *const clap_plugin, rate: f64, least: u32, most: u32) -> bool {
    // SAFETY: `activate` never overlaps with `process`, so that nobody else holds the outputs.
    caught("activate", false, || unsafe {
        let guard = guard(plugin);
        guard.sample_rate.store(rate.to_bits(), Ordering::Relaxed);
        let outputs = &mut *guard.outputs.get();
        outputs.scratch.prepare(most as usize);
        outputs.fresh = true;
        outputs.active = guard.framework.activate.is_some_and(|activate| activate(plugin, rate, least, most));
        outputs.active
    })
}

/// Starts processing. What rings when a host stops rings on when it starts again: the format has a call of its own for a
/// reset. Only after an activation it starts from silence.
unsafe extern "C" fn start_processing(plugin: *const clap_plugin) -> bool {
    // SAFETY: as for `process`, with which it does not overlap.
    caught("start_processing", false, || unsafe {
        let guard = guard(plugin);
        let Some(start) = guard.framework.start_processing else { return false };
        let fresh = std::mem::take(&mut (*guard.outputs.get()).fresh);
        match guard.parameters.as_ref().filter(|_| !fresh) {
            Some(parameters) => parameters.resuming(|| start(plugin)),
            None => start(plugin),
        }
    })
}

/// # Real-time
/// Two looks at the clock beside what [`process`] does.
unsafe extern "C" fn timed_process(
    plugin: *const clap_plugin,
    call: *const clap_process,
) -> clap_process_status {
    // SAFETY: as for `process`.
    caught("process", CLAP_PROCESS_ERROR, || unsafe {
        let frames = call.as_ref().map_or(0, |call| call.frames_count as usize);
        match &guard(plugin).parameters {
            Some(parameters) => parameters.deadlines().timed(frames, || process(plugin, call)),
            None => process(plugin, call),
        }
    })
}

/// # Real-time
/// No allocation: tables and scratch were made when the plugin was activated.
unsafe extern "C" fn process(plugin: *const clap_plugin, call: *const clap_process) -> clap_process_status {
    // SAFETY: `process` overlaps with neither itself nor `activate`, so that nobody else holds the outputs; `call` is
    // null or valid with all it points to.
    unsafe {
        let guard = guard(plugin);
        let Some(framework) = guard.framework.process else { return CLAP_PROCESS_ERROR };
        let Some(&(mut given)) = call.as_ref() else { return CLAP_PROCESS_ERROR };
        let Outputs { input, scratch, ports, active, .. } = &mut *guard.outputs.get();
        // The framework panics when it processes before it was activated, where that cannot be caught.
        if !*active {
            return CLAP_PROCESS_ERROR;
        }
        let events = given.in_events.as_ref().zip(guard.parameters.as_deref());
        let frames = given.frames_count;
        let written = events.and_then(|(events, parameters)| input.written_out(events, parameters, frames));
        if let Some(events) = &written {
            given.in_events = events;
        }
        let output = given.out_events;
        let telling = Telling::of(output);
        let own = telling.as_ref().map(Telling::list);
        if let Some(own) = &own {
            given.out_events = own;
        }
        if let Some(parameters) = &guard.parameters {
            parameters.use_outputs(used(&given, scratch.ports()));
        }
        let status = complete(plugin, &given, framework, scratch, ports);
        if written.is_some() {
            input.finish(output, frames);
        }
        // A host may put a quiet instrument to sleep, but not one whose notes wait for a sample.
        if status != CLAP_PROCESS_ERROR && input.is_waiting() { CLAP_PROCESS_CONTINUE } else { status }
    }
}

/// What the host calls the framework's `process` with, with every output it left out.
///
/// # Safety
/// As for [`process`].
unsafe fn complete(
    plugin: *const clap_plugin,
    given: &clap_process,
    framework: unsafe extern "C" fn(*const clap_plugin, *const clap_process) -> clap_process_status,
    scratch: &mut Scratch,
    ports: &mut Vec<clap_audio_buffer>,
) -> clap_process_status {
    // SAFETY: as promised.
    unsafe {
        if is_complete(given, scratch.ports()) {
            return framework(plugin, given);
        }
        let completed = scratch.complete(given.frames_count as usize, |port| match port_of(given, port) {
            Some(port) => (port.data32, port.channel_count as usize),
            None => (ptr::null_mut(), 0),
        });
        let Some(pointers) = completed else { return CLAP_PROCESS_ERROR };
        ports.clear();
        ports.extend(pointers.iter_mut().map(|table| clap_audio_buffer {
            data32: table.as_mut_ptr(),
            data64: ptr::null_mut(),
            channel_count: CHANNELS as u32,
            latency: 0,
            constant_mask: 0,
        }));
        let whole = clap_process {
            audio_outputs: ports.as_mut_ptr(),
            audio_outputs_count: ports.len() as u32,
            ..*given
        };
        framework(plugin, &whole)
    }
}

/// # Safety
/// `call` and all it points to are valid.
unsafe fn port_of(call: &clap_process, port: usize) -> Option<&clap_audio_buffer> {
    if call.audio_outputs.is_null() || port >= call.audio_outputs_count as usize {
        return None;
    }
    // SAFETY: within the host's ports.
    Some(unsafe { &*call.audio_outputs.add(port) })
}

/// Whether the host gives every declared port with its two channels.
///
/// # Safety
/// `call` and all it points to are valid.
unsafe fn is_complete(call: &clap_process, ports: usize) -> bool {
    // SAFETY: as promised.
    (0..ports).all(|port| unsafe { is_given(call, port) })
}

/// Whether the host gives a port with its two channels.
///
/// # Safety
/// `call` and all it points to are valid.
unsafe fn is_given(call: &clap_process, port: usize) -> bool {
    // SAFETY: as promised; tables hold as many pointers as the port has channels.
    unsafe {
        port_of(call, port).is_some_and(|port| {
            port.channel_count as usize == CHANNELS
                && !port.data32.is_null()
                && (0..CHANNELS).all(|channel| !(*port.data32.add(channel)).is_null())
        })
    }
}

/// The outputs beside the main one that the host gives whole.
///
/// # Safety
/// `call` and all it points to are valid.
unsafe fn used(call: &clap_process, ports: usize) -> Used {
    // SAFETY: as promised.
    let given = (1..ports).filter(|&port| unsafe { is_given(call, port) });
    given.fold(Used::NONE, |used, port| used.with(port - 1))
}

unsafe extern "C" fn get_extension(plugin: *const clap_plugin, id: *const c_char) -> *const c_void {
    // SAFETY: `id` is null or a string.
    caught("get_extension", ptr::null(), || unsafe {
        if !id.is_null() && CStr::from_ptr(id) == CLAP_EXT_NOTE_NAME {
            return ptr::from_ref(&NOTE_NAMES).cast();
        }
        let guard = guard(plugin);
        // The framework panics when it opens a window in a host that knows nothing of windows, where that cannot be caught.
        if !id.is_null() && CStr::from_ptr(id) == CLAP_EXT_GUI && !has_windows(guard.host) {
            return ptr::null();
        }
        if !id.is_null() && CStr::from_ptr(id) == CLAP_EXT_TAIL {
            return ptr::from_ref(&TAIL_TOLD).cast();
        }
        let found = guard.framework.get_extension.map_or(ptr::null(), |get| get(plugin, id));
        if !found.is_null() && CStr::from_ptr(id) == CLAP_EXT_AUDIO_PORTS {
            return ptr::from_ref(&names::PORTS).cast();
        }
        if found.is_null() || id.is_null() || CStr::from_ptr(id) != CLAP_EXT_PARAMS {
            return found;
        }
        let framework = &*found.cast::<clap_plugin_params>();
        ptr::from_ref(guard.values.get_or_init(|| table::table(framework))).cast()
    })
}

/// Whether a host has the extension for windows.
///
/// # Safety
/// `host` is null or as the format says, and the plugin has been initialized.
unsafe fn has_windows(host: *const clap_host) -> bool {
    // SAFETY: as promised.
    unsafe {
        let ask = host.as_ref().and_then(|host| host.get_extension);
        ask.is_some_and(|ask| !ask(host, CLAP_EXT_GUI.as_ptr()).is_null())
    }
}

/// Notes with names, as the parameters and the user have them now.
fn note_names(guard: &Guard) -> Vec<(u8, String)> {
    let named = || guard.parameters.as_ref().map(|parameters| parameters.note_names()).unwrap_or_default();
    caught("note_names", Vec::new(), named)
}

unsafe extern "C" fn note_count(plugin: *const clap_plugin) -> u32 {
    // SAFETY: see `guard`.
    note_names(unsafe { guard(plugin) }).len() as u32
}

unsafe extern "C" fn note_name(plugin: *const clap_plugin, index: u32, into: *mut clap_note_name) -> bool {
    // SAFETY: see `guard`; `into` is null or valid.
    let (named, into) = unsafe { (note_names(guard(plugin)), into.as_mut()) };
    let (Some((note, name)), Some(into)) = (named.get(index as usize), into) else { return false };
    names::write(name, &mut into.name);
    (into.port, into.key, into.channel) = (-1, i16::from(*note), -1);
    true
}

#[cfg(test)]
pub(super) mod tests;
