//! A MIDI file full of controllers, pressure, program changes and tempo: what `render` makes of it is what the plugin plays.

use overhear::kit_document::KitDocument;
use overhear_cli::host::{Event, What};
use overhear_cli::message::{Meaning, Message};
use overhear_cli::player::{Blocks, Setup, Source, Take};
use overhear_cli::plugin_folders::Format;
use overhear_cli::song::Song;

use crate::score::{Sound, assert_same, peak};
use crate::vst3::messages_through_pedalboard;
use crate::{alone, bundle_path, instance, setting};

const RATE: u32 = 48_000;

/// Ticks per quarter note. At first one is 25 samples.
const QUARTER: u16 = 960;

/// Length of what is played, samples.
const FRAMES: usize = 110_000;

/// Delta times, ticks, and messages. At tick 960 the tempo goes to 60 bpm, where a tick is 50 samples.
const MESSAGES: [(u8, [u8; 3]); 30] = [
    (0, [0xB9, 4, 127]),
    (0, [0x99, 42, 100]),
    (100, [0xB9, 4, 30]),
    (20, [0x99, 46, 110]),
    (100, [0xB9, 16, 90]),
    (0, [0x99, 38, 80]),
    // Behind the note: VST3 has controllers before the notes of their sample.
    (1, [0xB9, 88, 64]),
    (10, [0x99, 38, 80]),
    (60, [0x99, 49, 120]),
    (110, [0xA9, 49, 90]),
    (100, [0xA9, 49, 0]),
    (10, [0x99, 36, 100]),
    // A note and a program change at one sample: the preset acts first.
    (60, [0x99, 38, 100]),
    (0, [0xC9, 2, 0]),
    (90, [0x99, 51, 90]),
    (0, [0x99, 44, 100]),
    (120, [0xC9, 5, 0]),
    (0, [0xC9, 3, 0]),
    (5, [0x99, 48, 100]),
    (120, [0xE9, 0, 0]),
    (0, [0xD9, 100, 0]),
    (100, [0x99, 57, 100]),
    (120, [0xA9, 57, 127]),
    (120, [0x89, 57, 64]),
    (120, [0xB9, 17, 10]),
    (0, [0x99, 43, 60]),
    (120, [0x99, 51, 120]),
    (120, [0xB9, 123, 0]),
    (120, [0x99, 36, 0]),
    (120, [0x99, 38, 127]),
];

/// The file: the messages on one track, the tempo on another.
fn file(messages: impl IntoIterator<Item = (u8, [u8; 3])>) -> Vec<u8> {
    let mut notes = Vec::new();
    for (delta, bytes) in messages {
        let length = if matches!(bytes[0] & 0xF0, 0xC0 | 0xD0) { 2 } else { 3 };
        notes.push(delta);
        notes.extend(&bytes[..length]);
    }
    // From tick 960 on a quarter note lasts a second.
    let tempo = [0x87, 0x40, 0xFF, 0x51, 3, 0x0F, 0x42, 0x40];
    let mut bytes = b"MThd\0\0\0\x06\0\x01\0\x02".to_vec();
    bytes.extend(QUARTER.to_be_bytes());
    for track in [&tempo[..], &notes] {
        bytes.extend(b"MTrk");
        bytes.extend((track.len() as u32 + 4).to_be_bytes());
        bytes.extend(track);
        bytes.extend([0, 0xFF, 0x2F, 0]);
    }
    bytes
}

/// The same worked out by hand: samples and messages.
fn by_hand(messages: &[(u8, [u8; 3])]) -> Vec<Message> {
    let mut tick = 0;
    let place = |tick: u64| if tick <= 960 { 25 * tick } else { 25 * 960 + 50 * (tick - 960) };
    let timed = messages.iter().map(|&(delta, bytes)| {
        tick += u64::from(delta);
        Message { sample: place(tick), bytes }
    });
    timed.collect()
}

/// What `render` plays of a file.
fn rendered(file: &[u8], source: &Source, blocks: Blocks) -> Sound {
    rendered_with(file, source, blocks, Vec::new())
}

/// What it plays with some parameters set.
fn rendered_with(file: &[u8], source: &Source, blocks: Blocks, settings: Vec<(usize, f32)>) -> Sound {
    let song = Song::parse(file).unwrap();
    let at = |event: &overhear_cli::song::Event| Message {
        sample: song.sample(event.time, RATE),
        bytes: event.bytes,
    };
    let take = Take { messages: song.events.iter().map(at).collect(), frames: FRAMES as u64 };
    let setup = Setup { rate: RATE, kit: KitDocument::standard(), settings };
    let mut sound = [Vec::new(), Vec::new()];
    let played = source.perform(&setup, |player| {
        take.play(player, blocks, |left, right| {
            sound[0].extend_from_slice(left);
            sound[1].extend_from_slice(right);
            Ok(())
        })
    });
    played.expect("it plays");
    sound
}

/// What a host plays that sends these messages to the plugin in buffers of a length.
fn in_a_host(messages: &[Message], block: usize) -> Sound {
    let mut plugin = instance();
    plugin.set_offline().unwrap();
    let mut sound = [vec![0.0; FRAMES], vec![0.0; FRAMES]];
    let played = plugin.run(f64::from(RATE), 1..=block as u32, |processor| {
        let [left, right] = &mut sound;
        for (at, (left, right)) in left.chunks_mut(block).zip(right.chunks_mut(block)).enumerate() {
            let start = (at * block) as u64;
            let here = |message: &&Message| (start..start + left.len() as u64).contains(&message.sample);
            let event = |message: &Message| Event {
                offset: (message.sample - start) as u32,
                what: What::Midi(message.bytes),
            };
            let events: Vec<_> = messages.iter().filter(here).map(event).collect();
            processor.process(&events, left, right)?;
        }
        Ok(())
    });
    played.expect("it plays");
    sound
}

#[test]
fn a_song_with_controllers_pressure_programs_and_tempo_is_rendered_as_a_host_plays_it() {
    let _turn = alone();
    let song = file(MESSAGES);
    let engine = rendered(&song, &Source::Engine, Blocks::Fixed(512));
    assert!(peak(&engine) > 0.01);
    let clap = Source::Clap(bundle_path(Format::Clap));
    assert_same(&rendered(&song, &clap, Blocks::Random), &engine, "rendered by CLAP");
    let messages = by_hand(&MESSAGES);
    for block in [480, 2_000] {
        assert_same(&in_a_host(&messages, block), &engine, &format!("in a host, {block} samples"));
    }
}

#[test]
fn every_kind_of_message_in_a_song_is_heard() {
    let _turn = alone();
    let played = |file: &[u8]| {
        let settings = vec![setting("offline_quality=standard")];
        rendered_with(file, &Source::Engine, Blocks::Fixed(512), settings)
    };
    let whole = played(&file(MESSAGES));
    for without in [4, 16, 88] {
        // Left out, but not its time.
        let other = |(delta, bytes): (u8, [u8; 3])| {
            let is_it = bytes[0] & 0xF0 == 0xB0 && bytes[1] == without;
            (delta, if is_it { [0xB9, 1, 0] } else { bytes })
        };
        let sound = played(&file(MESSAGES.map(other)));
        assert!(sound != whole, "controller {without} changes nothing");
    }
    for kind in [0xA0, 0xC0] {
        let other = |(delta, bytes): (u8, [u8; 3])| {
            (delta, if bytes[0] & 0xF0 == kind { [0xB9, 1, 0] } else { bytes })
        };
        let sound = played(&file(MESSAGES.map(other)));
        assert!(sound != whole, "messages {kind:x} change nothing");
    }
}

/// This format has no program changes.
#[test]
fn a_song_with_controllers_and_pressure_is_rendered_as_a_vst3_host_plays_it() {
    let _turn = alone();
    let programs = |&(_, bytes): &(u8, [u8; 3])| bytes[0] & 0xF0 == 0xC0;
    let messages: Vec<_> =
        MESSAGES.map(|what| if programs(&what) { (what.0, [0xB9, 1, 0]) } else { what }).to_vec();
    let engine = rendered(&file(messages.iter().copied()), &Source::Engine, Blocks::Fixed(512));
    // This host moves controllers at the start of a buffer only. All messages are at multiples of 25 samples.
    let played = messages_through_pedalboard("song", &by_hand(&messages), FRAMES, f64::from(RATE), 25);
    assert_same(&played, &engine, "in a VST3 host");
    let strikes = |message: &Message| matches!(message.meaning(), Meaning::NoteOn { .. });
    assert!(by_hand(&messages).iter().any(strikes));
}
