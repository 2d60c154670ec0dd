//! A host that leaves outputs out, through the format's own tables.

use std::ffi::CString;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_NOTE_ON, clap_event_header, clap_event_note, clap_input_events,
    clap_output_events,
};
use clap_sys::process::CLAP_PROCESS_CONTINUE;
use overhear_engine::kit::OUTPUTS;

use super::*;
use overhear_player::kit_document::standard_slot;

mod calls;
pub(in crate::entry) mod expressions;
mod kits;
mod panics;
mod sweep;

pub(in crate::entry) const FRAMES: usize = 512;
const PORTS: usize = 1 + OUTPUTS;

unsafe extern "C" fn no_extension(_host: *const clap_host, _id: *const c_char) -> *const c_void {
    ptr::null()
}

unsafe extern "C" fn nothing(_host: *const clap_host) {}

fn host() -> clap_host {
    clap_host {
        clap_version: CLAP_VERSION,
        host_data: ptr::null_mut(),
        name: c"test".as_ptr(),
        vendor: c"".as_ptr(),
        url: c"".as_ptr(),
        version: c"1".as_ptr(),
        get_extension: Some(no_extension),
        request_restart: Some(nothing),
        request_process: Some(nothing),
        request_callback: Some(nothing),
    }
}

/// What an event of the form `T` begins with.
fn header<T>(type_: u16, time: u32) -> clap_event_header {
    clap_event_header {
        size: size_of::<T>() as u32,
        time,
        space_id: CLAP_CORE_EVENT_SPACE_ID,
        type_,
        flags: 0,
    }
}

/// An active instance.
pub(in crate::entry) struct Instance {
    plugin: *const clap_plugin,
    _host: Box<clap_host>,
}

impl Instance {
    pub(in crate::entry) fn new(id: &str) -> Instance {
        let (host, id) = (Box::new(host()), CString::new(id).unwrap());
        // SAFETY: the calls a host makes, in its order.
        unsafe {
            let plugin = create(&FACTORY, &*host, id.as_ptr());
            assert!((*plugin).init.unwrap()(plugin));
            assert!((*plugin).activate.unwrap()(plugin, 48e3, 1, FRAMES as u32));
            assert!((*plugin).start_processing.unwrap()(plugin));
            Instance { plugin, _host: host }
        }
    }

    /// One buffer with a stroke on the snare at its start, into these ports.
    fn strike(&mut self, ports: &mut [clap_audio_buffer]) -> clap_process_status {
        let note = clap_event_note {
            header: header::<clap_event_note>(CLAP_EVENT_NOTE_ON, 0),
            note_id: -1,
            port_index: 0,
            channel: 9,
            key: 38,
            velocity: 0.8,
        };
        self.play(&note.header, ports)
    }

    /// One buffer with an event, into these ports.
    fn play(&mut self, event: &clap_event_header, ports: &mut [clap_audio_buffer]) -> clap_process_status {
        unsafe extern "C" fn one(_list: *const clap_input_events) -> u32 {
            1
        }
        unsafe extern "C" fn get(list: *const clap_input_events, _index: u32) -> *const clap_event_header {
            // SAFETY: the list's context is the event.
            unsafe { (*list).ctx.cast_const().cast() }
        }
        unsafe extern "C" fn refuse(
            _list: *const clap_output_events,
            _event: *const clap_event_header,
        ) -> bool {
            false
        }
        let input = clap_input_events {
            ctx: ptr::from_ref(event).cast_mut().cast(),
            size: Some(one),
            get: Some(get),
        };
        let output = clap_output_events { ctx: ptr::null_mut(), try_push: Some(refuse) };
        let call = clap_process {
            steady_time: -1,
            frames_count: FRAMES as u32,
            transport: ptr::null(),
            audio_inputs: ptr::null(),
            audio_outputs: if ports.is_empty() { ptr::null_mut() } else { ports.as_mut_ptr() },
            audio_inputs_count: 0,
            audio_outputs_count: ports.len() as u32,
            in_events: &input,
            out_events: &output,
        };
        // SAFETY: everything the call points to lives here or with the caller.
        unsafe {
            (*self.plugin).reset.unwrap()(self.plugin);
            (*self.plugin).process.unwrap()(self.plugin, &call)
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the calls a host makes, in its order.
        unsafe {
            (*self.plugin).stop_processing.unwrap()(self.plugin);
            (*self.plugin).deactivate.unwrap()(self.plugin);
            (*self.plugin).destroy.unwrap()(self.plugin);
        }
    }
}

fn port(table: *mut *mut f32, channels: u32) -> clap_audio_buffer {
    clap_audio_buffer {
        data32: table,
        data64: ptr::null_mut(),
        channel_count: channels,
        latency: 0,
        constant_mask: 0,
    }
}

/// Strikes with all outputs but those that `leave_out` takes away; returns what is found in every channel.
pub(in crate::entry) fn struck(
    instance: &mut Instance,
    ports: usize,
    leave_out: impl Fn(usize, &mut clap_audio_buffer),
) -> Vec<[Vec<f32>; CHANNELS]> {
    let mut sound = vec![[vec![f32::NAN; FRAMES], vec![f32::NAN; FRAMES]]; ports];
    let mut tables: Vec<_> =
        sound.iter_mut().map(|port| port.each_mut().map(|channel| channel.as_mut_ptr())).collect();
    let mut given: Vec<_> =
        tables.iter_mut().map(|table| port(table.as_mut_ptr(), CHANNELS as u32)).collect();
    given.iter_mut().enumerate().for_each(|(index, port)| leave_out(index, port));
    assert_eq!(instance.strike(&mut given), CLAP_PROCESS_CONTINUE);
    sound
}

/// What all outputs come to.
fn sum(sound: &[[Vec<f32>; CHANNELS]]) -> [Vec<f32>; CHANNELS] {
    std::array::from_fn(|channel| {
        let at = |at: usize| sound.iter().map(|port| port[channel][at]).sum();
        (0..FRAMES).map(at).collect()
    })
}

fn is_close(one: &[Vec<f32>; CHANNELS], other: &[Vec<f32>; CHANNELS]) -> bool {
    one.iter().flatten().zip(other.iter().flatten()).all(|(one, other)| (one - other).abs() < 1e-5)
}

#[test]
fn all_outputs_together_are_the_mix_whichever_are_left_out() {
    let snare = 1 + standard_slot("snare").index();
    let mix = struck(&mut Instance::new(overhear_player::CLAP_ID), 1, |_, _| {}).remove(0);
    let mut multi = Instance::new(overhear_player::MULTI_CLAP_ID);
    let whole = struck(&mut multi, PORTS, |_, _| {});
    assert!(whole[0].iter().flatten().all(|sample| *sample == 0.0), "all is at the other outputs");
    assert!(whole[snare][0].iter().any(|sample| *sample != 0.0));
    assert!(is_close(&sum(&whole), &mix));
    let loudest =
        |port: usize| whole[port].iter().flatten().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    assert!(loudest(1) < 0.2 * loudest(snare), "the kick was not struck, it only hears the snare");

    assert!(struck(&mut multi, 1, |_, _| {})[0] == mix);
    let fewer = struck(&mut multi, 3, |_, _| {});
    assert!(fewer[1..] == whole[1..3] && is_close(&sum(&fewer), &mix));
    let no_tables = struck(&mut multi, PORTS, |index, port| {
        if index > 0 {
            port.data32 = ptr::null_mut();
        }
    });
    assert!(no_tables[0] == mix);
    let mut null_channels = struck(&mut multi, PORTS, |index, port| {
        if index == 1 || index == snare {
            // SAFETY: the table holds two pointers.
            unsafe { *port.data32.add(1) = ptr::null_mut() };
        }
    });
    // A port of which one channel is there has nothing of its own.
    for port in [1, snare] {
        assert!(null_channels[port][0].iter().all(|sample| *sample == 0.0));
        null_channels[port][1].fill(0.0);
    }
    assert!(is_close(&sum(&null_channels), &mix));
    let mono = struck(&mut multi, PORTS, |_, port| port.channel_count = 1);
    assert!(mono[0][0] == mix[0]);
    let more = struck(&mut multi, PORTS + 2, |_, _| {});
    assert!(more[..PORTS] == whole[..]);
    assert_eq!(multi.strike(&mut []), CLAP_PROCESS_CONTINUE, "no ports at all");
    assert!(struck(&mut multi, PORTS, |_, _| {}) == whole, "and after all that");
}

#[test]
fn notes_have_names() {
    let instance = Instance::new(overhear_player::CLAP_ID);
    // SAFETY: the calls a host makes.
    let found = unsafe {
        let extension = get_extension(instance.plugin, CLAP_EXT_NOTE_NAME.as_ptr());
        let names = &*extension.cast::<clap_plugin_note_name>();
        let count = names.count.unwrap()(instance.plugin);
        let mut into: clap_note_name = std::mem::zeroed();
        assert!(!names.get.unwrap()(instance.plugin, count, &mut into));
        (0..count)
            .map(|index| {
                assert!(names.get.unwrap()(instance.plugin, index, &mut into));
                (into.key, CStr::from_ptr(into.name.as_ptr()).to_str().unwrap().to_owned())
            })
            .collect::<Vec<_>>()
    };
    assert!(found.contains(&(38, "Acoustic Snare".to_owned())), "{found:?}");
    assert!(found.iter().all(|(_, name)| !name.is_empty()));
    assert!(!found.iter().any(|(key, _)| *key == 39), "claps are silent");
}
