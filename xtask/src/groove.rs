//! The demonstration groove: 20 bars for a drum kit with a hi-hat, written as code.
//!
//! `assets/groove.mid` is what [`file()`] makes; a test holds the two together, and
//! `cargo xtask groove` writes it anew. A format 1 file: a tempo track, a track for the feet and
//! one for the hands, General MIDI notes on channel 10.
//!
//! The form: a pickup fill, an A of eight bars on the hi-hat with ghost notes between the backbeats, a B of
//! eight on the ride's bell with a busier kick and the hi-hat's pedal, four bars of fills that trade with time and
//! end on everything at once. The tempo leans forward a little in B and broadens at the end.
//!
//! A person is imitated by a fixed sequence of small errors: hits come up to 6 ms early or late,
//! ghost notes a touch late, hands louder on the beat than between.

mod score;
mod stroke;

use midly::num::{u4, u7, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, Smf, Timing, TrackEvent, TrackEventKind};

use score::Score;
use stroke::{BAR, PPQ, Stroke};

/// How long a note is held, ticks. Nothing depends on it: drums ring as they will.
const HELD: u32 = 60;

/// Channel 10, where General MIDI has its drums.
const CHANNEL: u8 = 9;

/// Beats a minute, from which bar on.
const TEMPO: [(u32, f64); 6] = [(0, 96.0), (9, 97.5), (13, 98.5), (17, 97.0), (19, 94.0), (20, 88.0)];

/// The bytes of `assets/groove.mid`.
pub fn file() -> Vec<u8> {
    let Score { feet, hands } = Score::written();
    let mut smf = Smf::new(Header::new(Format::Parallel, Timing::Metrical(u15::new(PPQ as u16))));
    smf.tracks.push(tempo_track());
    smf.tracks.push(track(b"Feet", &feet));
    smf.tracks.push(track(b"Hands", &hands));
    let mut bytes = Vec::new();
    // Writing to memory fails only for more tracks and longer ones than the format has.
    let written = smf.write_std(&mut bytes);
    debug_assert!(written.is_ok());
    bytes
}

/// Turns absolute ticks into the differences a track stores.
fn deltas(mut events: Vec<(u32, TrackEventKind<'static>)>) -> Vec<TrackEvent<'static>> {
    events.sort_by_key(|(tick, _)| *tick);
    let end = events.last().map_or(0, |(tick, _)| *tick);
    events.push((end, TrackEventKind::Meta(MetaMessage::EndOfTrack)));
    let mut now = 0;
    events
        .into_iter()
        .map(|(tick, kind)| {
            let delta = u28::new(tick - now);
            now = tick;
            TrackEvent { delta, kind }
        })
        .collect()
}

fn tempo_track() -> Vec<TrackEvent<'static>> {
    let mut events = vec![
        (0, TrackEventKind::Meta(MetaMessage::TrackName(b"Overhear groove"))),
        (0, TrackEventKind::Meta(MetaMessage::TimeSignature(4, 2, 24, 8))),
    ];
    for (bar, beats_a_minute) in TEMPO {
        let tempo = u24::new((60e6 / beats_a_minute).round() as u32);
        events.push((bar * BAR, TrackEventKind::Meta(MetaMessage::Tempo(tempo))));
    }
    deltas(events)
}

fn track(name: &'static [u8], strokes: &[Stroke]) -> Vec<TrackEvent<'static>> {
    let mut events = vec![(0, TrackEventKind::Meta(MetaMessage::TrackName(name)))];
    for stroke in strokes {
        let (key, vel) = (u7::new(stroke.key), u7::new(stroke.velocity));
        let midi = |message| TrackEventKind::Midi { channel: u4::new(CHANNEL), message };
        events.push((stroke.tick, midi(MidiMessage::NoteOn { key, vel })));
        events.push((stroke.tick + HELD, midi(MidiMessage::NoteOff { key, vel: u7::new(0) })));
    }
    deltas(events)
}

#[cfg(test)]
mod tests {
    use super::stroke::SIXTEENTH;
    use super::*;
    use overhear::kit_document::KitDocument;
    use overhear_cli::song::Song;

    #[test]
    fn the_file_in_assets_is_the_one_written_here() {
        let path = crate::workspace::root().join("assets/groove.mid");
        let stored = std::fs::read(path).expect("assets/groove.mid");
        assert!(stored == file(), "write it anew: cargo xtask groove -o assets/groove.mid");
    }

    #[test]
    fn it_lasts_at_least_16_bars_and_strikes_every_piece_of_a_drum_kit() {
        let song = Song::parse(&file()).unwrap();
        let seconds = song.last_note().unwrap();
        assert!((45.0..60.0).contains(&seconds), "{seconds} s");
        // A groove has no use for a timpani.
        let KitDocument { kit, notes } = KitDocument::standard();
        for (slot, piece) in kit.slots().filter(|(_, piece)| piece.name != "timpani") {
            let strikes = |key| notes.stroke(key).is_some_and(|stroke| stroke.slot == slot);
            let strokes = song.notes().filter(|note| strikes(note.key));
            assert!(strokes.count() >= 2, "{}", piece.name);
        }
        let sounds = |key| notes.stroke(key).is_some() || notes.foot(key).is_some();
        assert!(song.notes().all(|note| sounds(note.key)));
    }

    #[test]
    fn it_has_ghost_notes_accents_and_human_timing() {
        let song = Song::parse(&file()).unwrap();
        let snare = |note: &overhear_cli::song::Note| note.key == 38;
        let ghosts = song.notes().filter(snare).filter(|note| note.velocity < 45).count();
        let accents = song.notes().filter(snare).filter(|note| note.velocity > 95).count();
        assert!(ghosts > 30 && accents > 30, "{ghosts} ghosts, {accents} accents");
        let Score { feet, hands } = Score::written();
        let off_grid = feet.iter().chain(&hands).filter(|hit| hit.tick % SIXTEENTH != 0).count();
        assert!(off_grid > (feet.len() + hands.len()) / 2);
    }

    #[test]
    fn no_limb_hits_one_thing_twice_at_once() {
        let Score { feet, hands } = Score::written();
        for track in [feet, hands] {
            for pair in track.windows(2) {
                assert!(pair[1].tick >= pair[0].tick);
                let apart = pair[1].tick - pair[0].tick;
                assert!(pair[0].key != pair[1].key || apart > 20, "{pair:?}");
            }
        }
    }
}
