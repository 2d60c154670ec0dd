use super::*;

/// A file of one format, time base and tracks.
fn file(format: u8, division: [u8; 2], tracks: &[&[u8]]) -> Vec<u8> {
    let mut bytes = b"MThd\0\0\0\x06\0".to_vec();
    bytes.push(format);
    bytes.extend((tracks.len() as u16).to_be_bytes());
    bytes.extend(division);
    for track in tracks {
        bytes.extend(b"MTrk");
        bytes.extend((track.len() as u32).to_be_bytes());
        bytes.extend(*track);
    }
    bytes
}

const END: [u8; 4] = [0, 0xFF, 0x2F, 0];

fn samples(bytes: &[u8], rate: u32) -> Vec<(u64, u8)> {
    let song = Song::parse(bytes).unwrap();
    song.notes().map(|note| (song.sample(note.time, rate), note.key)).collect()
}

#[test]
fn running_status_and_note_offs_by_velocity_are_understood() {
    let track = [&[0, 0x99, 36, 100, 48, 36, 0, 48, 38, 90][..], &END].concat();
    let song = Song::parse(&file(0, [0, 96], &[&track])).unwrap();
    let notes: Vec<_> = song.notes().collect();
    assert_eq!((notes.len(), song.events.len()), (2, 3));
    assert_eq!((notes[0].channel, notes[0].velocity), (9, 100));
    assert_eq!(song.sample(notes[1].time, 48_000), 24_000);
}

#[test]
fn every_channel_message_is_kept_with_its_time() {
    let messages = [
        &[0, 0xB9, 4, 127][..],
        &[1, 0xC9, 3],
        &[1, 0xA9, 49, 64],
        &[1, 0x89, 49, 2],
        &[1, 0xD9, 5],
        &[1, 0xE9, 1, 0x41],
        &END,
    ];
    let song = Song::parse(&file(0, [0, 96], &[&messages.concat()])).unwrap();
    let found: Vec<_> = song.events.iter().map(|event| event.bytes).collect();
    let expected =
        [[0xB9, 4, 127], [0xC9, 3, 0], [0xA9, 49, 64], [0x89, 49, 2], [0xD9, 5, 0], [0xE9, 1, 0x41]];
    assert_eq!(found, expected);
    let step = song.events[1].time;
    assert!(song.events.iter().zip(0..).all(|(event, at)| event.time == at * step) && step > 0);
}

#[test]
fn a_tempo_in_the_first_track_moves_notes_in_the_others() {
    // 120 bpm for a beat, then 60 bpm.
    let tempo = [&[96, 0xFF, 0x51, 3, 0x0F, 0x42, 0x40][..], &END].concat();
    let notes = [&[96, 0x99, 38, 1, 96, 38, 2][..], &END].concat();
    assert_eq!(samples(&file(1, [0, 96], &[&tempo, &notes]), 48_000), [(24_000, 38), (72_000, 38)],);
}

#[test]
fn patterns_of_format_2_follow_each_other() {
    let pattern = [&[0, 0x99, 36, 1][..], &[96, 0xFF, 0x2F, 0]].concat();
    assert_eq!(samples(&file(2, [0, 96], &[&pattern, &pattern]), 1000), [(0, 36), (500, 36)]);
}

#[test]
fn smpte_frames_last_what_they_last() {
    let note = |ticks| [&[ticks, 0x99, 36, 1][..], &END].concat();
    // 25 frames of 40 ticks: a tick is a millisecond.
    assert_eq!(samples(&file(0, [0xE7, 40], &[&note(100)]), 48_000), [(4800, 36)]);
    // 29.97: 30 frames last 1.001 s.
    assert_eq!(samples(&file(0, [0xE3, 1], &[&note(30)]), 48_000), [(48_048, 36)]);
}

#[test]
fn times_round_once_to_the_nearest_sample_halves_up() {
    let song = Song { events: Vec::new(), unit: 4 };
    let at = |time| song.sample(time, 2);
    assert_eq!([at(0), at(1), at(2), at(3), at(4), at(5)], [0, 1, 1, 2, 2, 3]);
}

#[test]
fn a_thousand_odd_ticks_do_not_drift() {
    // 7 ticks of 480 at 140 bpm, 1000 times.
    let tempo: u128 = 428_571;
    let mut track = vec![0, 0xFF, 0x51, 3];
    track.extend(&(tempo as u32).to_be_bytes()[1..]);
    for _ in 0..1000 {
        track.extend([7, 0x99, 38, 64]);
    }
    track.extend(END);
    let found = samples(&file(0, [0x01, 0xE0], &[&track]), 44_100);
    for (index, (sample, _)) in found.iter().enumerate() {
        let exact = (index as f64 + 1.0) * 7.0 * tempo as f64 / 480e6 * 44_100.0;
        assert!((*sample as f64 - exact).abs() <= 0.5 + 1e-6, "note {index}");
    }
}

#[test]
fn broken_files_are_refused_with_the_reason() {
    let track = [&[0, 0x99, 36, 100][..], &END].concat();
    let whole = file(1, [0, 96], &[&track, &track]);
    let reason = |bytes: &[u8]| Song::parse(bytes).unwrap_err();
    assert_eq!(reason(b""), "it is empty");
    assert_eq!(reason(b"ID3 not a song at all"), "it does not begin with `MThd`");
    assert_eq!(reason(&whole[..whole.len() - 3]), "track 2 is cut off: 8 bytes announced, 5 there");
    assert_eq!(reason(&whole[..30]), "2 tracks announced, 1 there");
    assert_eq!(reason(&file(0, [0, 0], &[&track])), "its time base is 0 ticks");
    assert!(reason(&file(0, [0, 96], &[])).contains("no track"));
    assert!(!reason(&whole[..9]).is_empty());
    // A data byte where a status must be: running status without one before.
    assert!(reason(&file(0, [0, 96], &[&[0, 36, 100, 0]])).contains("track 1 breaks off at byte 0"));
    assert!(reason(&file(0, [0, 96], &[&[0, 0x99, 36]])).contains("track 1 breaks off"));
}

#[test]
fn what_surrounds_the_tracks_is_no_obstacle() {
    let track = [&[0, 0x99, 36, 100][..], &END].concat();
    let plain = file(0, [0, 96], &[&track]);
    let mut padded = plain.clone();
    padded.extend([0, 0, 0]);
    let mut foreign = plain.clone();
    foreign.extend(b"XFIH\0\0\0\x02ab");
    let mut wrapped = b"RIFF\0\0\0\0RMIDLIST\x03\0\0\0abc\0data".to_vec();
    wrapped.extend((plain.len() as u32).to_le_bytes());
    wrapped.extend(&plain);
    for bytes in [&padded, &foreign, &wrapped] {
        assert_eq!(samples(bytes, 48_000), [(0, 36)]);
    }
}

#[test]
fn any_cut_or_flipped_byte_is_survived() {
    let track = [&[0, 0xFF, 0x51, 3, 7, 0xA1, 0x20, 0, 0x99, 36, 100, 48, 38, 90][..], &END].concat();
    let whole = file(1, [0, 96], &[&track, &track]);
    for length in 0..whole.len() {
        assert!(Song::parse(&whole[..length]).is_err(), "cut to {length}");
    }
    for index in 0..whole.len() {
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[index] ^= 1 << bit;
            // Whether it is accepted does not matter, as long as nothing panics.
            let _ = Song::parse(&bytes);
        }
    }
}
