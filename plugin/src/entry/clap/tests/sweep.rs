//! Random events and calls, in any order.

use clap_sys::events::{
    CLAP_EVENT_MIDI, CLAP_EVENT_MIDI_SYSEX, CLAP_EVENT_NOTE_CHOKE, CLAP_EVENT_NOTE_EXPRESSION,
    CLAP_EVENT_NOTE_OFF, CLAP_EVENT_NOTE_ON, CLAP_EVENT_PARAM_MOD, CLAP_EVENT_PARAM_VALUE, clap_event_midi,
    clap_event_midi_sysex, clap_event_note_expression, clap_event_param_mod, clap_event_param_value,
};
use clap_sys::ext::state::{CLAP_EXT_STATE, clap_plugin_state};
use clap_sys::stream::{clap_istream, clap_ostream};

use super::calls::{count, get, refuse};
use super::panics::{read, write};
use super::*;
use crate::entry::sweep::{Chance, FRAMES, LAST, buffer};

/// An event of any form. Each begins with its header.
#[repr(C)]
#[derive(Clone, Copy)]
pub(super) union Sent {
    pub(super) header: clap_event_header,
    pub(super) note: clap_event_note,
    pub(super) midi: clap_event_midi,
    pub(super) sysex: clap_event_midi_sysex,
    pub(super) value: clap_event_param_value,
    pub(super) modulation: clap_event_param_mod,
    pub(super) expression: clap_event_note_expression,
}

/// Bytes of a message that lasts longer than any call.
static BYTES: [u8; 6] = [0xF0, 0x7E, 0x7F, 0x09, 0x01, 0xF7];

fn event(chance: &mut Chance, time: u32) -> Sent {
    let (channel, key, port_index) = (chance.channel(), chance.key(), chance.of(&[0, 0, 0, -1, 1]));
    let (note_id, cookie) = (chance.of(&[-1, -1, 0, 7]), ptr::null_mut());
    match chance.random.u32(..100) {
        0..45 => {
            let forms = [
                CLAP_EVENT_NOTE_ON,
                CLAP_EVENT_NOTE_ON,
                CLAP_EVENT_NOTE_ON,
                CLAP_EVENT_NOTE_OFF,
                CLAP_EVENT_NOTE_CHOKE,
            ];
            let header = header::<clap_event_note>(chance.of(&forms), time);
            Sent {
                note: clap_event_note { header, note_id, port_index, channel, key, velocity: chance.share() },
            }
        }
        45..60 => {
            let header = header::<clap_event_midi>(CLAP_EVENT_MIDI, time);
            let data = [chance.random.u8(..), chance.random.u8(..), chance.random.u8(..)];
            Sent { midi: clap_event_midi { header, port_index: 0, data } }
        }
        60..63 => {
            let header = header::<clap_event_midi_sysex>(CLAP_EVENT_MIDI_SYSEX, time);
            let (buffer, size) =
                chance.of(&[(BYTES.as_ptr(), 6), (BYTES.as_ptr(), 0), (ptr::null(), 0), (ptr::null(), 3)]);
            Sent { sysex: clap_event_midi_sysex { header, port_index: 0, buffer, size } }
        }
        63..85 => {
            let header = header::<clap_event_param_value>(CLAP_EVENT_PARAM_VALUE, time);
            let (param_id, value) = (chance.id(), chance.share() * chance.of(&[1.0, 1.0, 16.0]));
            let value =
                clap_event_param_value { header, param_id, cookie, note_id, port_index, channel, key, value };
            Sent { value }
        }
        85..90 => {
            let header = header::<clap_event_param_mod>(CLAP_EVENT_PARAM_MOD, time);
            let (param_id, amount) = (chance.id(), chance.share() - 0.5);
            let modulation =
                clap_event_param_mod { header, param_id, cookie, note_id, port_index, channel, key, amount };
            Sent { modulation }
        }
        90..97 => {
            let header = header::<clap_event_note_expression>(CLAP_EVENT_NOTE_EXPRESSION, time);
            let (expression_id, value) = (chance.random.i32(-1..9), chance.share());
            let expression = clap_event_note_expression {
                header,
                expression_id,
                note_id,
                port_index,
                channel,
                key,
                value,
            };
            Sent { expression }
        }
        _ => {
            let mut header = header::<clap_event_header>(chance.random.u16(..), time);
            header.space_id = chance.random.u16(1..);
            Sent { header }
        }
    }
}

/// An instance whose host does as it pleases.
struct Sweep {
    plugin: *const clap_plugin,
    _host: Box<clap_host>,
    chance: Chance,
    stored: Vec<u8>,
}

impl Sweep {
    fn new(id: &str, chance: Chance) -> Sweep {
        let (host, id) = (Box::new(host()), CString::new(id).unwrap());
        // SAFETY: the calls a host makes, in its order.
        let plugin = unsafe { create(&FACTORY, &*host, id.as_ptr()) };
        // SAFETY: as above.
        assert!(unsafe { (*plugin).init.unwrap()(plugin) });
        Sweep { plugin, _host: host, chance, stored: Vec::new() }
    }

    /// # Safety
    /// The plugin has such an extension, of that type.
    unsafe fn extension<'a, T>(&self, id: &CStr) -> &'a T {
        // SAFETY: as promised.
        unsafe { &*get_extension(self.plugin, id.as_ptr()).cast::<T>() }
    }

    /// One buffer at the ports that there are, some of them incomplete if the host is careless.
    fn process(&mut self, events: &Vec<Sent>, frames: usize, careless: bool) -> Vec<[Vec<f32>; CHANNELS]> {
        let ports = if careless { self.chance.random.usize(..PORTS + 2) } else { PORTS };
        let mut sound = vec![[buffer(frames), buffer(frames)]; ports];
        let mut tables: Vec<_> =
            sound.iter_mut().map(|port| port.each_mut().map(|channel| channel.as_mut_ptr())).collect();
        let mut given: Vec<_> = tables.iter_mut().map(|table| port(table.as_mut_ptr(), 2)).collect();
        for port in given.iter_mut().filter(|_| careless) {
            match self.chance.random.u32(..12) {
                0 => port.data32 = ptr::null_mut(),
                1 => port.channel_count = self.chance.of(&[0, 1]),
                _ => {}
            }
        }
        let list = clap_input_events {
            ctx: ptr::from_ref(events).cast_mut().cast(),
            size: Some(count),
            get: Some(get),
        };
        let output = clap_output_events { ctx: ptr::null_mut(), try_push: Some(refuse) };
        let call = clap_process {
            steady_time: -1,
            frames_count: frames as u32,
            transport: ptr::null(),
            audio_inputs: ptr::null(),
            audio_outputs: if given.is_empty() { ptr::null_mut() } else { given.as_mut_ptr() },
            audio_inputs_count: 0,
            audio_outputs_count: given.len() as u32,
            in_events: &list,
            out_events: &output,
        };
        // SAFETY: everything the call points to lives here or with the caller.
        unsafe { (*self.plugin).process.unwrap()(self.plugin, &call) };
        self.chance.believe(sound, frames)
    }

    fn events(&mut self, frames: usize) -> Vec<Sent> {
        let events = self.chance.events();
        let times = self.chance.times(events, frames);
        times.into_iter().map(|time| event(&mut self.chance, time)).collect()
    }

    /// Any call at all.
    fn act(&mut self) {
        let plugin = self.plugin;
        // SAFETY: the calls a host makes; that their order is none is what is tried.
        unsafe {
            match self.chance.random.u32(..1_000) {
                0..940 => {
                    let frames = self.chance.frames();
                    let events = self.events(frames);
                    self.process(&events, frames, true);
                }
                940..955 => (*plugin).reset.unwrap()(plugin),
                955..965 => (*plugin).stop_processing.unwrap()(plugin),
                965..980 => {
                    (*plugin).start_processing.unwrap()(plugin);
                }
                980..985 => self.flush(),
                985..990 => self.ask(),
                990..995 => self.store_and_load(),
                995..997 => (*plugin).deactivate.unwrap()(plugin),
                _ => self.activate(),
            }
        }
    }

    fn activate(&mut self) {
        let rate = self.chance.of(&[48e3, 48e3, 44.1e3, 8e3, 500.0]);
        let most = self.chance.of(&[0, 1, FRAMES as u32, u32::MAX]);
        // SAFETY: calls a host makes.
        unsafe {
            (*self.plugin).deactivate.unwrap()(self.plugin);
            (*self.plugin).activate.unwrap()(self.plugin, rate, 1, most);
        }
    }

    fn flush(&mut self) {
        let events = self.events(0);
        let list = clap_input_events {
            ctx: ptr::from_ref(&events).cast_mut().cast(),
            size: Some(count),
            get: Some(get),
        };
        let output = clap_output_events { ctx: ptr::null_mut(), try_push: Some(refuse) };
        // SAFETY: a call a host makes.
        unsafe {
            let parameters: &clap_plugin_params = self.extension(CLAP_EXT_PARAMS);
            parameters.flush.unwrap()(self.plugin, &list, &output);
        }
    }

    /// Questions to the tables.
    fn ask(&mut self) {
        let (id, value, mut number) = (self.chance.id(), self.chance.share(), 0.0);
        let mut text = [0; 64];
        // SAFETY: calls a host makes.
        unsafe {
            let parameters: &clap_plugin_params = self.extension(CLAP_EXT_PARAMS);
            parameters.get_value.unwrap()(self.plugin, id, &mut number);
            assert!(number.is_finite(), "{}: {id} is at {number}", self.chance.where_it_is());
            parameters.value_to_text.unwrap()(self.plugin, id, value, text.as_mut_ptr(), text.len() as u32);
            parameters.text_to_value.unwrap()(self.plugin, id, text.as_ptr(), &mut number);
            let names: &clap_plugin_note_name = self.extension(CLAP_EXT_NOTE_NAME);
            names.count.unwrap()(self.plugin);
            tail(self.plugin);
        }
    }

    /// Stores the state, or loads one: stored, damaged or of nothing but noise.
    fn store_and_load(&mut self) {
        // SAFETY: calls a host makes; streams live as long as the calls.
        unsafe {
            let state: &clap_plugin_state = self.extension(CLAP_EXT_STATE);
            let mut bytes = Vec::<u8>::new();
            let stream = clap_ostream { ctx: (&raw mut bytes).cast(), write: Some(write) };
            assert!(state.save.unwrap()(self.plugin, &stream), "{}", self.chance.where_it_is());
            if self.stored.is_empty() {
                self.stored = bytes;
            }
            let given = match self.chance.random.u32(..4) {
                0 => self.stored.clone(),
                1 => (0..100).map(|_| self.chance.random.u8(..)).collect(),
                _ => self.chance.damaged(&self.stored.clone()),
            };
            let mut rest = &given[..];
            let stream = clap_istream { ctx: (&raw mut rest).cast(), read: Some(read) };
            state.load.unwrap()(self.plugin, &stream);
        }
    }

    /// All sound off, on every channel; then there is silence.
    fn quiet(&mut self) {
        let off = |channel: u8| Sent {
            midi: clap_event_midi {
                header: header::<clap_event_midi>(CLAP_EVENT_MIDI, 0),
                port_index: 0,
                data: [0xB0 | channel, 120, 0],
            },
        };
        // SAFETY: calls a host makes, in its order.
        unsafe {
            (*self.plugin).deactivate.unwrap()(self.plugin);
            assert!((*self.plugin).activate.unwrap()(self.plugin, 48e3, 1, FRAMES as u32));
            assert!((*self.plugin).start_processing.unwrap()(self.plugin));
        }
        for _ in 0..20 {
            let events = self.events(FRAMES);
            self.process(&events, FRAMES, false);
        }
        self.process(&(0..16).map(off).collect(), FRAMES, false);
        let buffers = (LAST * 48e3) as usize / FRAMES;
        let silent = (0..buffers)
            .any(|_| Chance::is_silent(self.process(&Vec::new(), FRAMES, false).iter().flatten().flatten()));
        assert!(silent, "{}: it stays loud", self.chance.where_it_is());
    }
}

#[test]
fn a_sweep_of_random_events_and_calls_neither_aborts_nor_leaks_nor_stays_loud() {
    for id in [overhear_player::CLAP_ID, overhear_player::MULTI_CLAP_ID] {
        let mut sweep = Sweep::new(id, Chance::new());
        // SAFETY: the plugin lives.
        let parameters = unsafe { guard(sweep.plugin) }.parameters.as_ref().map(Arc::downgrade).unwrap();
        while sweep.chance.goes_on() {
            sweep.act();
        }
        sweep.quiet();
        // SAFETY: the last calls a host makes.
        unsafe {
            (*sweep.plugin).deactivate.unwrap()(sweep.plugin);
            (*sweep.plugin).destroy.unwrap()(sweep.plugin);
        }
        assert_eq!(
            parameters.strong_count(),
            0,
            "{}: somebody keeps the instance",
            sweep.chance.where_it_is()
        );
    }
}
