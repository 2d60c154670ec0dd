//! Calls that real hosts make: steps, buffers without samples, floods, processing that stops and starts.

use clap_sys::events::{CLAP_EVENT_MIDI, CLAP_EVENT_MIDI_SYSEX, CLAP_EVENT_PARAM_VALUE, clap_event_midi};
use clap_sys::events::{clap_event_midi_sysex, clap_event_param_value};
use clap_sys::ext::params::{CLAP_PARAM_IS_STEPPED, clap_param_info};
use overhear_player::parameters::{COUNT, host_id, parameters};

use super::sweep::Sent;
use super::*;
use crate::entry::sweep::{buffer, written};

fn midi(data: [u8; 3]) -> Sent {
    Sent {
        midi: clap_event_midi { header: header::<clap_event_midi>(CLAP_EVENT_MIDI, 0), port_index: 0, data },
    }
}

fn hollow(size: u32) -> Sent {
    let header = header::<clap_event_midi_sysex>(CLAP_EVENT_MIDI_SYSEX, 0);
    Sent { sysex: clap_event_midi_sysex { header, port_index: 0, buffer: ptr::null(), size } }
}

fn value(id: u32, value: f64) -> Sent {
    let header = header::<clap_event_param_value>(CLAP_EVENT_PARAM_VALUE, 0);
    let (cookie, note_id, port_index, channel, key) = (ptr::null_mut(), -1, -1, -1, -1);
    Sent {
        value: clap_event_param_value {
            header,
            param_id: id,
            cookie,
            note_id,
            port_index,
            channel,
            key,
            value,
        },
    }
}

pub(super) unsafe extern "C" fn count(list: *const clap_input_events) -> u32 {
    // SAFETY: the list's context is the vector.
    unsafe { (*(*list).ctx.cast::<Vec<Sent>>()).len() as u32 }
}

pub(super) unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above; every form begins with its header.
    unsafe { ptr::from_ref(&(&(*(*list).ctx.cast::<Vec<Sent>>()))[index as usize].header) }
}

pub(super) unsafe extern "C" fn refuse(
    _list: *const clap_output_events,
    _event: *const clap_event_header,
) -> bool {
    false
}

/// One buffer of so many samples with events; what the plugin sends goes to `output`.
pub(super) fn process(
    instance: &Instance,
    samples: usize,
    events: &Vec<Sent>,
    output: &clap_output_events,
) -> (clap_process_status, [Vec<f32>; CHANNELS]) {
    let mut sound = [buffer(samples), buffer(samples)];
    let mut table = sound.each_mut().map(|channel| channel.as_mut_ptr());
    let mut port = port(table.as_mut_ptr(), CHANNELS as u32);
    let input =
        clap_input_events { ctx: ptr::from_ref(events).cast_mut().cast(), size: Some(count), get: Some(get) };
    let call = clap_process {
        steady_time: -1,
        frames_count: samples as u32,
        transport: ptr::null(),
        audio_inputs: ptr::null(),
        audio_outputs: &mut port,
        audio_inputs_count: 0,
        audio_outputs_count: 1,
        in_events: &input,
        out_events: output,
    };
    // SAFETY: everything the call points to lives here or with the caller.
    let status = unsafe { (*instance.plugin).process.unwrap()(instance.plugin, &call) };
    (status, sound.map(|channel| written(channel, samples)))
}

/// The left side of one buffer, for a host that takes no events.
fn call(instance: &Instance, samples: usize, events: Vec<Sent>) -> (clap_process_status, Vec<f32>) {
    let output = clap_output_events { ctx: ptr::null_mut(), try_push: Some(refuse) };
    let (status, [left, _]) = process(instance, samples, &events, &output);
    (status, left)
}

fn instance() -> Instance {
    Instance::new(overhear_player::CLAP_ID)
}

const SNARE: [u8; 3] = [0x99, 38, 100];
const CRASH: [u8; 3] = [0x99, 49, 100];

#[test]
fn rates_that_nothing_can_be_played_at_are_refused() {
    let instance = instance();
    let plugin = instance.plugin;
    for rate in [500.0, 8e3, 0.0, 2e6, f64::NAN, 1234.5678, 48e3] {
        let is_accepted = (1e3..=1.536e6).contains(&rate);
        // SAFETY: the calls a host makes.
        let activated = unsafe {
            (*plugin).deactivate.unwrap()(plugin);
            (*plugin).activate.unwrap()(plugin, rate, 1, FRAMES as u32)
        };
        assert_eq!(activated, is_accepted, "{rate} Hz");
        let sound = call(&instance, FRAMES, vec![midi(SNARE)]).1;
        assert_eq!(sound.iter().any(|sample| *sample != 0.0), is_accepted, "{rate} Hz");
    }
}

#[test]
fn switches_and_lists_are_stepped_and_moved_by_whole_numbers() {
    let instance = instance();
    // SAFETY: the calls a host makes.
    unsafe {
        let table = &*get_extension(instance.plugin, CLAP_EXT_PARAMS.as_ptr()).cast::<clap_plugin_params>();
        let mut info: clap_param_info = std::mem::zeroed();
        for (index, parameter) in parameters().iter().enumerate() {
            assert!(table.get_info.unwrap()(instance.plugin, index as u32, &mut info));
            let stepped = info.flags & CLAP_PARAM_IS_STEPPED != 0;
            assert_eq!(stepped, parameter.steps().is_some(), "{}", parameter.name);
            assert_eq!(info.max_value, f64::from(parameter.steps().unwrap_or(1)), "{}", parameter.name);
            assert_eq!(info.default_value, parameter.in_clap(parameter.default), "{}", parameter.name);
        }
        assert!(!table.get_info.unwrap()(instance.plugin, COUNT as u32 + 1, &mut info));
        let (id, mut number) = (host_id("midchn"), f64::NAN);
        for (sent, text, read) in [(10.0, c"10", 10.0), (0.0, c"all", 0.0), (16.0, c"16", 16.0)] {
            call(&instance, FRAMES, vec![value(id, sent)]);
            assert!(table.get_value.unwrap()(instance.plugin, id, &mut number));
            assert_eq!(number, read);
            let mut shown = [0; 64];
            assert!(table.value_to_text.unwrap()(instance.plugin, id, sent, shown.as_mut_ptr(), 64));
            assert_eq!(CStr::from_ptr(shown.as_ptr()), text);
            assert!(table.text_to_value.unwrap()(instance.plugin, id, text.as_ptr(), &mut number));
            assert_eq!(number, read);
        }
        assert_eq!(
            call(&instance, FRAMES, vec![value(id, 3.0), midi(SNARE)]).1,
            vec![0.0; FRAMES],
            "channel 10 is not heard"
        );
        let events = vec![value(id, 10.0)];
        let list = clap_input_events {
            ctx: ptr::from_ref(&events).cast_mut().cast(),
            size: Some(count),
            get: Some(get),
        };
        table.flush.unwrap()(instance.plugin, &list, ptr::null());
        assert!(table.get_value.unwrap()(instance.plugin, id, &mut number));
        assert_eq!(number, 10.0);
    }
}

#[test]
fn notes_without_samples_are_the_first_of_the_next_buffer() {
    let plain = call(&instance(), FRAMES, vec![midi(SNARE)]);
    assert!(plain.1.iter().any(|sample| *sample != 0.0));
    let late = instance();
    let id = host_id("master");
    assert_eq!(call(&late, 0, vec![midi(SNARE), hollow(3)]).0, CLAP_PROCESS_CONTINUE);
    assert!(call(&late, FRAMES, Vec::new()) == plain);
    assert!(call(&instance(), FRAMES, vec![value(id, 0.0)]).1.iter().all(|sample| *sample == 0.0));
}

#[test]
fn ten_thousand_controllers_and_messages_without_bytes_are_taken() {
    let plain = call(&instance(), FRAMES, vec![midi(SNARE)]);
    let mut flood: Vec<_> = (0..10_000).map(|at| midi([0xB9, 1, at as u8 & 0x7F])).collect();
    flood.extend((0..10_000).map(|at| hollow(at % 3)));
    flood.push(midi(SNARE));
    assert!(call(&instance(), FRAMES, flood) == plain);
    let beyond: Vec<_> = (0..100_000).map(|_| hollow(0)).chain([midi(SNARE)]).collect();
    assert!(call(&instance(), FRAMES, beyond) == plain);
}

#[test]
fn events_after_the_end_or_out_of_order_happen_within_the_buffer() {
    let at = |time: u32, mut event: Sent| {
        event.header.time = time;
        event
    };
    let (id, last) = (host_id("master"), FRAMES as u32 - 1);
    let played = |events: Vec<Sent>| {
        let instance = instance();
        let now = call(&instance, FRAMES, events);
        (now, call(&instance, FRAMES, Vec::new()))
    };
    let late = played(vec![at(last, midi(SNARE))]);
    assert!(late.1.1.iter().any(|sample| *sample != 0.0));
    for time in [last + 1, last + 100, u32::MAX] {
        assert!(played(vec![at(time, midi(SNARE))]) == late, "a note at {time}");
        assert!(played(vec![at(time, value(id, 0.5))]) == played(vec![at(last, value(id, 0.5))]), "{time}");
        call(&instance(), 0, vec![at(time, value(id, 0.5))]);
    }
    let ordered = played(vec![at(300, midi(SNARE)), at(300, value(id, 0.1)), at(300, midi(CRASH))]);
    assert!(played(vec![at(300, midi(SNARE)), at(10, value(id, 0.1)), at(0, midi(CRASH))]) == ordered);
}

#[test]
fn what_rings_goes_on_ringing_when_processing_stops_and_starts() {
    let through = instance();
    call(&through, FRAMES, vec![midi(CRASH)]);
    let expected = call(&through, FRAMES, Vec::new());
    assert!(expected.1.iter().any(|sample| *sample != 0.0));
    let stopped = instance();
    call(&stopped, FRAMES, vec![midi(CRASH)]);
    // SAFETY: the calls a host makes, in its order.
    unsafe {
        (*stopped.plugin).stop_processing.unwrap()(stopped.plugin);
        assert!((*stopped.plugin).start_processing.unwrap()(stopped.plugin));
    }
    assert!(call(&stopped, FRAMES, Vec::new()) == expected);
    // SAFETY: as above. A reset is a reset.
    unsafe { (*stopped.plugin).reset.unwrap()(stopped.plugin) };
    assert!(call(&stopped, FRAMES, Vec::new()).1.iter().all(|sample| *sample == 0.0));
}

#[test]
fn it_tells_how_long_it_rings() {
    let instance = instance();
    // SAFETY: the calls a host makes.
    let tail = unsafe {
        let table = &*get_extension(instance.plugin, CLAP_EXT_TAIL.as_ptr()).cast::<clap_plugin_tail>();
        table.get.unwrap()(instance.plugin)
    };
    assert_eq!(tail, 60 * 48_000);
}
