//! A plugin that panics wherever a host can call it, and a host that goes on.

use clap_sys::events::{CLAP_EVENT_MIDI_SYSEX, clap_event_midi_sysex};
use clap_sys::ext::state::{CLAP_EXT_STATE, clap_plugin_state};
use clap_sys::stream::{clap_istream, clap_ostream};

use super::*;
use crate::guard::failing::while_panicking;

/// What the host gets from a call during which the entry of that name panics.
fn survived<T>(entry: &'static str, call: impl FnOnce() -> T) -> T {
    let (result, panics) = while_panicking(entry, call);
    assert!(panics > 0, "{entry} was not reached");
    result
}

/// Makes an instance, initializes it and destroys it.
fn made() -> bool {
    let host = Box::new(host());
    let id = CString::new(overhear_player::CLAP_ID).unwrap();
    // SAFETY: the calls a host makes, in its order.
    unsafe {
        let plugin = create(&FACTORY, &*host, id.as_ptr());
        if plugin.is_null() {
            return false;
        }
        let begun = (*plugin).init.unwrap()(plugin);
        (*plugin).destroy.unwrap()(plugin);
        begun
    }
}

/// # Safety
/// The plugin is initialized and has such an extension, of that type.
unsafe fn extension<'a, T>(plugin: *const clap_plugin, id: &CStr) -> &'a T {
    // SAFETY: as promised.
    unsafe { &*get_extension(plugin, id.as_ptr()).cast::<T>() }
}

#[test]
fn a_panic_of_the_library_and_its_factory_is_kept_from_the_host() {
    // SAFETY: the calls a host makes.
    unsafe {
        assert!(!survived("init", || init(ptr::null())));
        assert_eq!(survived("get_plugin_count", || plugin_count(&FACTORY)), 0);
        assert!(survived("get_plugin_descriptor", || descriptor(&FACTORY, 0)).is_null());
    }
    assert!(!survived("create_plugin", made));
    // What is missing then is a window or a page of controls, not the instance.
    for entry in ["editor", "remote_controls"] {
        assert!(survived(entry, made), "{entry}");
    }
    assert!(made());
}

#[test]
fn a_panic_of_an_instance_is_kept_from_the_host() {
    let mut instance = Instance::new(overhear_player::CLAP_ID);
    let plugin = instance.plugin;
    // SAFETY: the calls a host makes, in its order.
    unsafe {
        assert!(!survived("activate", || (*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32)));
        assert!((*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
        assert!(survived("get_extension", || get_extension(plugin, CLAP_EXT_PARAMS.as_ptr())).is_null());

        let parameters: &clap_plugin_params = extension(plugin, CLAP_EXT_PARAMS);
        let (id, mut number) = (overhear_player::parameters::host_id("master"), f64::NAN);
        assert!(!survived("get_value", || parameters.get_value.unwrap()(plugin, id, &mut number)));
        let mut text = [1 as c_char; 64];
        let shown = parameters.value_to_text.unwrap();
        survived("value_to_text", || shown(plugin, id, 0.5, text.as_mut_ptr(), text.len() as u32));
        let typed = parameters.text_to_value.unwrap();
        assert!(!survived("text_to_value", || typed(plugin, id, c"-6".as_ptr(), &mut number)));

        let names: &clap_plugin_note_name = extension(plugin, CLAP_EXT_NOTE_NAME);
        assert_eq!(survived("note_names", || names.count.unwrap()(plugin)), 0);
        assert!(names.count.unwrap()(plugin) > 20);
    }
    survived("Plugin::reset", || instance.strike(&mut []));
    assert_eq!(survived("process", || instance.strike(&mut [])), CLAP_PROCESS_ERROR);
    assert_eq!(survived("Plugin::process", || instance.strike(&mut [])), CLAP_PROCESS_ERROR);
    let loud = |sound: Vec<[Vec<f32>; CHANNELS]>| sound[0][0].iter().any(|&sample| sample != 0.0);
    assert!(loud(struck(&mut instance, 1, |_, _| {})), "it plays on");
    // An engine that broke is silent until it is activated anew.
    assert!(!loud(survived("the engine", || struck(&mut instance, 1, |_, _| {}))));
    assert!(!loud(struck(&mut instance, 1, |_, _| {})));
    // SAFETY: as above.
    unsafe {
        (*plugin).stop_processing.unwrap()(plugin);
        (*plugin).deactivate.unwrap()(plugin);
        survived("Plugin::activate", || (*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
        (*plugin).deactivate.unwrap()(plugin);
        assert!((*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
        assert!((*plugin).start_processing.unwrap()(plugin));
    }
    assert!(loud(struck(&mut instance, 1, |_, _| {})));
}

pub(super) unsafe extern "C" fn write(stream: *const clap_ostream, bytes: *const c_void, size: u64) -> i64 {
    // SAFETY: the context is the vector of `saved`.
    unsafe {
        let given = std::slice::from_raw_parts(bytes.cast::<u8>(), size as usize);
        (*(*stream).ctx.cast::<Vec<u8>>()).extend(given);
    }
    size as i64
}

pub(super) unsafe extern "C" fn read(stream: *const clap_istream, into: *mut c_void, size: u64) -> i64 {
    // SAFETY: the context is the slice of `loaded`.
    unsafe {
        let rest = &mut *(*stream).ctx.cast::<&[u8]>();
        let (now, later) = rest.split_at(rest.len().min(size as usize));
        ptr::copy_nonoverlapping(now.as_ptr(), into.cast(), now.len());
        *rest = later;
        now.len() as i64
    }
}

#[test]
fn a_panic_over_a_state_is_kept_from_the_host() {
    let instance = Instance::new(overhear_player::CLAP_ID);
    let plugin = instance.plugin;
    // SAFETY: the calls a host makes; streams live as long as the calls.
    unsafe {
        let state: &clap_plugin_state = extension(plugin, CLAP_EXT_STATE);
        let saved = || {
            let mut bytes = Vec::<u8>::new();
            let stream = clap_ostream { ctx: (&raw mut bytes).cast(), write: Some(write) };
            state.save.unwrap()(plugin, &stream);
            bytes
        };
        let loaded = |mut bytes: &[u8]| {
            let stream = clap_istream { ctx: (&raw mut bytes).cast(), read: Some(read) };
            state.load.unwrap()(plugin, &stream)
        };
        let whole = saved();
        survived("serialize_fields", saved);
        for entry in ["filter_state", "deserialize_fields"] {
            survived(entry, || loaded(&whole));
        }
        assert!(loaded(&whole) && saved() == whole);
    }
}

#[test]
fn where_the_framework_would_panic_it_is_not_asked() {
    let (host, id) = (Box::new(host()), CString::new(overhear_player::CLAP_ID).unwrap());
    // SAFETY: the calls a host makes, but for the missing activation.
    unsafe {
        let plugin = create(&FACTORY, &*host, id.as_ptr());
        assert!((*plugin).init.unwrap()(plugin));
        let mut early = Instance { plugin, _host: host };
        assert_eq!(early.strike(&mut []), CLAP_PROCESS_ERROR);
        // This host knows nothing of windows.
        assert!(get_extension(plugin, CLAP_EXT_GUI.as_ptr()).is_null());
        assert!((*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
        assert!((*plugin).start_processing.unwrap()(plugin));
        let empty = clap_event_midi_sysex {
            header: clap_event_header {
                size: size_of::<clap_event_midi_sysex>() as u32,
                time: 0,
                space_id: CLAP_CORE_EVENT_SPACE_ID,
                type_: CLAP_EVENT_MIDI_SYSEX,
                flags: 0,
            },
            port_index: 0,
            buffer: ptr::null(),
            size: 0,
        };
        assert_eq!(early.play(&empty.header, &mut []), CLAP_PROCESS_CONTINUE);
    }
}
