//! A host that leaves outputs out, through the format's own interfaces.

use std::ptr;

use overhear_engine::kit::OUTPUTS;

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{
    Event, Event_::EventTypes_, Event__type0, IEventList, IEventListTrait, IUnitInfoTrait, NoteOnEvent,
    ProgramListInfo, UnitInfo,
};

use super::*;
use crate::entry::clap::tests::{FRAMES, Instance, struck};
use overhear_player::kit_document::standard_slot;

mod calls;
mod expressions;
mod panics;
mod sweep;

const BUSES: usize = 1 + OUTPUTS;

/// Processing instance of the instrument with an output for every piece.
fn multi() -> Guard<OverhearMulti> {
    let guard = Guard::new();
    let mut setup = ProcessSetup {
        processMode: 0,
        symbolicSampleSize: 0,
        maxSamplesPerBlock: FRAMES as i32,
        sampleRate: 48e3,
    };
    // SAFETY: the calls a host makes, in its order.
    unsafe {
        assert_eq!(IPluginBaseTrait::initialize(&guard, ptr::null_mut()), kResultOk);
        assert_eq!(guard.setupProcessing(&mut setup), kResultOk);
        assert_eq!(guard.setActive(1), kResultOk);
        assert_eq!(guard.setProcessing(1), kResultOk);
    }
    guard
}

/// An event of a kind at a sample.
fn event(sample: u32, kind: u16, what: Event__type0) -> Event {
    Event {
        busIndex: 0,
        sampleOffset: sample as i32,
        ppqPosition: 0.0,
        flags: 0,
        r#type: kind,
        __field0: what,
    }
}

/// The stroke on the snare that the other format's tests play.
struct Stroke;

impl Class for Stroke {
    type Interfaces = (IEventList,);
}

impl IEventListTrait for Stroke {
    unsafe fn getEventCount(&self) -> int32 {
        1
    }

    unsafe fn getEvent(&self, _index: int32, event: *mut Event) -> tresult {
        let note = NoteOnEvent { channel: 9, pitch: 38, tuning: 0.0, velocity: 0.8, length: 0, noteId: -1 };
        // SAFETY: the framework gives room for an event.
        unsafe {
            *event = self::event(0, EventTypes_::kNoteOnEvent as u16, Event__type0 { noteOn: note });
        }
        kResultOk
    }

    unsafe fn addEvent(&self, _event: *mut Event) -> tresult {
        kInvalidArgument
    }
}

/// Processes one silent buffer with all outputs but those that `leave_out` takes away.
fn processed(
    guard: &Guard<OverhearMulti>,
    buses: usize,
    leave_out: impl Fn(usize, &mut AudioBusBuffers),
) -> Vec<[Vec<f32>; CHANNELS]> {
    played(guard, ptr::null_mut(), buses, leave_out)
}

/// Processes one buffer with these events and all outputs but those that `leave_out` takes away.
fn played(
    guard: &Guard<OverhearMulti>,
    events: *mut IEventList,
    buses: usize,
    leave_out: impl Fn(usize, &mut AudioBusBuffers),
) -> Vec<[Vec<f32>; CHANNELS]> {
    let mut sound = vec![[vec![f32::NAN; FRAMES], vec![f32::NAN; FRAMES]]; buses];
    let mut tables: Vec<_> =
        sound.iter_mut().map(|bus| bus.each_mut().map(|channel| channel.as_mut_ptr())).collect();
    let mut given: Vec<_> = tables
        .iter_mut()
        .map(|table| AudioBusBuffers {
            numChannels: CHANNELS as i32,
            silenceFlags: 0,
            __field0: AudioBusBuffers__type0 { channelBuffers32: table.as_mut_ptr() },
        })
        .collect();
    given.iter_mut().enumerate().for_each(|(index, bus)| leave_out(index, bus));
    let outputs = if given.is_empty() { ptr::null_mut() } else { given.as_mut_ptr() };
    let mut data = ProcessData {
        processMode: 0,
        symbolicSampleSize: 0,
        numSamples: FRAMES as i32,
        numInputs: 0,
        numOutputs: buses as i32,
        inputs: ptr::null_mut(),
        outputs,
        inputParameterChanges: ptr::null_mut(),
        outputParameterChanges: ptr::null_mut(),
        inputEvents: events,
        outputEvents: ptr::null_mut(),
        processContext: ptr::null_mut(),
    };
    // SAFETY: everything the call points to lives here.
    assert_eq!(unsafe { guard.process(&mut data) }, kResultOk);
    assert_eq!((data.outputs, data.numOutputs), (outputs, buses as i32), "the host's structure is its own");
    sound
}

/// A channel that was written holds silence, as nothing is struck.
fn written(channel: &[f32]) -> bool {
    channel.iter().all(|sample| *sample == 0.0)
}

#[test]
fn outputs_that_are_left_out_do_not_keep_the_others_from_being_written() {
    let guard = multi();
    let whole = processed(&guard, BUSES, |_, _| {});
    assert!(whole.iter().flatten().all(|channel| written(channel)));
    for buses in [1, 3, BUSES + 2] {
        let sound = processed(&guard, buses, |_, _| {});
        let declared = buses.min(BUSES);
        assert!(sound[..declared].iter().flatten().all(|channel| written(channel)), "{buses} buses");
    }
    let inactive = processed(&guard, BUSES, |index, bus| {
        if index > 0 {
            // SAFETY: the table holds two pointers.
            unsafe {
                bus.__field0.channelBuffers32.copy_from([ptr::null_mut(); CHANNELS].as_ptr(), CHANNELS)
            };
        }
    });
    assert!(inactive[0].iter().all(|channel| written(channel)));
    let without = processed(&guard, BUSES, |index, bus| {
        if index > 0 {
            bus.numChannels = 0;
            bus.__field0.channelBuffers32 = ptr::null_mut();
        }
    });
    assert!(without[0].iter().all(|channel| written(channel)));
    processed(&guard, 0, |_, _| {});
}

#[test]
fn every_output_is_that_of_the_other_format() {
    let events = ComWrapper::new(Stroke).to_com_ptr::<IEventList>().unwrap();
    let vst3 = played(&multi(), events.as_ptr(), BUSES, |_, _| {});
    let clap = struck(&mut Instance::new(overhear_player::MULTI_CLAP_ID), BUSES, |_, _| {});
    for (bus, (vst3, clap)) in vst3.iter().zip(&clap).enumerate() {
        assert!(vst3 == clap, "bus {bus}");
    }
    let snare = 1 + standard_slot("snare").index();
    assert!(vst3[snare][0].iter().any(|sample| *sample != 0.0));
}

#[test]
fn units_hang_from_a_root_and_notes_have_names() {
    let text = |name: &String128| {
        let end = name.iter().position(|unit| *unit == 0).unwrap();
        String::from_utf16(&name[..end]).unwrap()
    };
    let guard = multi();
    // SAFETY: the calls a host makes.
    unsafe {
        let mut unit: UnitInfo = std::mem::zeroed();
        let units: Vec<_> = (0..guard.getUnitCount())
            .map(|index| {
                assert_eq!(guard.getUnitInfo(index, &mut unit), kResultOk);
                (unit.id, unit.parentUnitId, text(&unit.name))
            })
            .collect();
        assert_eq!((units[0].0, units[0].1), (0, -1));
        assert!(units[1..].iter().all(|(id, parent, name)| *id > 0 && *parent == 0 && !name.is_empty()));
        assert!(units.iter().any(|(_, _, name)| name == "Crash"), "{units:?}");

        let (mut list, mut name): (ProgramListInfo, String128) = std::mem::zeroed();
        assert_eq!((guard.getProgramListCount(), guard.getProgramListInfo(0, &mut list)), (1, kResultOk));
        assert_eq!(guard.getUnitInfo(0, &mut unit), kResultOk);
        assert_eq!((unit.programListId, list.programCount), (list.id, 1));
        assert_eq!(guard.getProgramName(list.id, 0, &mut name), kResultOk);
        assert_eq!(text(&name), overhear_player::MULTI_NAME);
        assert_eq!(guard.hasProgramPitchNames(list.id, 0), kResultOk);
        assert_eq!(guard.getProgramPitchName(list.id, 0, 38, &mut name), kResultOk);
        assert_eq!(text(&name), "Acoustic Snare");
        assert_ne!(guard.getProgramPitchName(list.id, 0, 39, &mut name), kResultOk, "claps are silent");
        assert_ne!(guard.getProgramPitchName(list.id, 1, 38, &mut name), kResultOk);
    }
}

#[test]
fn the_factory_makes_both_instruments_and_no_other() {
    let factory = Factory::new();
    // SAFETY: ids of 16 bytes, and room for a pointer.
    unsafe {
        assert_eq!(factory.countClasses(), 2);
        let mut object = ptr::null_mut();
        let interface = <IComponent as nice_plug::wrapper::vst3::vst3::Interface>::IID;
        for class in [factory.plugins[0].cid, factory.plugins[1].cid] {
            assert_eq!(
                factory.createInstance(class.as_ptr().cast(), interface.as_ptr().cast(), &mut object),
                kResultOk
            );
            assert!(!object.is_null());
            let unknown = object.cast::<FUnknown>();
            assert_eq!(((*(*unknown).vtbl).release)(unknown), 0);
        }
        let stranger = [0_u8; 16];
        let made = factory.createInstance(stranger.as_ptr().cast(), interface.as_ptr().cast(), &mut object);
        assert_eq!(made, kInvalidArgument);
    }
}

#[test]
fn outputs_have_the_titles_of_the_kit_s_pieces() {
    let guard = multi();
    let name = |bus: usize| {
        // SAFETY: a structure of numbers, and the call a host makes.
        let info = unsafe {
            let mut info: BusInfo = std::mem::zeroed();
            assert_eq!(guard.getBusInfo(0, 1, bus as int32, &mut info), kResultOk);
            info
        };
        let units: Vec<u16> = info.name.iter().copied().take_while(|unit| *unit != 0).collect();
        String::from_utf16(&units).unwrap()
    };
    let before: Vec<String> = (0..BUSES).map(name).collect();
    assert_eq!(before[1..4], ["Kick", "Snare", "Rack tom"]);
    let parameters = guard.parameters.clone().unwrap();
    let mut document = (*parameters.document()).clone();
    document.kit.pieces[1].title = "Gr\u{f6}\u{df}te Trommel".to_owned();
    parameters.set_document(Arc::new(document)).unwrap();
    let after: Vec<String> = (0..BUSES).map(name).collect();
    assert_eq!(after[2], "Gr\u{f6}\u{df}te Trommel");
    assert_eq!((&after[..2], &after[3..]), (&before[..2], &before[3..]));
    // SAFETY: what the host asks for is refused, not written.
    unsafe {
        assert_ne!(guard.getBusInfo(0, 1, BUSES as int32, &mut std::mem::zeroed()), kResultOk);
    }
}
