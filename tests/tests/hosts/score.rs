//! A short score that uses everything, and ways to play it.

use std::sync::Arc;

use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::performer::{Performer, velocity_from_midi};
use overhear_cli::host::{Event, Instance, What};
use overhear_cli::player::Blocks;

use crate::{as_hosts_have_it, setting};

/// Something that happens at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Happening {
    /// A note of a MIDI velocity.
    Note(u8, u8),
    /// A parameter, by its place in the table, takes a plain value.
    Parameter(usize, f32),
}

/// Happenings by sample; at one sample parameters come before notes, as hosts have it.
pub type Score = Vec<(u64, Happening)>;

/// Left and right samples.
pub type Sound = [Vec<f32>; 2];

/// Length of the score, s.
pub const SECONDS: f64 = 1.2;

/// Length of the score, samples.
pub fn frames(rate: f64) -> u64 {
    (SECONDS * rate) as u64
}

/// All pieces of the drum set at awkward samples, alone and together.
pub fn notes(rate: f64) -> Score {
    let at = |seconds: f64| (seconds * rate) as u64;
    let mut score: Score = [
        (0.0, 36, 110),
        (0.0, 49, 100),
        (0.0101, 38, 20),
        (0.05, 51, 70),
        (0.1003, 38, 127),
        (0.1003, 36, 90),
        (0.2, 48, 101),
        (0.25, 53, 64),
        (0.3007, 43, 99),
        (0.35, 55, 80),
        (0.3501, 38, 1),
        (0.4, 42, 100),
        (0.5, 51, 88),
        (0.5, 57, 115),
        (0.5999, 41, 77),
        (0.8, 37, 90),
        (1.0, 36, 127),
    ]
    .map(|(seconds, key, velocity)| (at(seconds), Happening::Note(key, velocity)))
    .to_vec();
    // Notes on the very ends of common buffers.
    score.extend([511, 512, 8191, 8192].map(|sample| (sample, Happening::Note(38, 60))));
    score.sort_by_key(|(sample, _)| *sample);
    score
}

/// The notes, and knobs that turn while they ring.
pub fn automated(rate: f64) -> Score {
    let mut score = notes(rate);
    for (seconds, text) in [
        (0.02, "kick_tune=62"),
        (0.0205, "kick_tune=64.5"),
        (0.1003, "snare_muffle=0.4"),
        (0.21, "rack_tom_tune=155"),
        (0.3, "ride_tune=-1.5"),
        (0.3001, "crash_level=-9"),
        (0.45, "master_level=-3"),
        (0.55, "dynamics=8"),
        (0.7, "floor_tom_muffle=1"),
    ] {
        let (index, value) = setting(text);
        score.push(((seconds * rate) as u64, Happening::Parameter(index, value)));
    }
    score.sort_by_key(|(sample, what)| (*sample, matches!(what, Happening::Note(..))));
    score
}

/// An event for the embedded host.
fn event(happening: Happening, offset: u64) -> Event {
    let what = match happening {
        Happening::Note(key, velocity) => {
            What::NoteOn { channel: 9, key, velocity: velocity_from_midi(velocity) }
        }
        Happening::Parameter(index, value) => {
            let (id, value) = as_hosts_have_it((index, value));
            What::Parameter { id, value }
        }
    };
    Event { offset: offset as u32, what }
}

/// Plays a score through an instance of the plugin.
pub fn through_plugin(instance: &mut Instance, score: &Score, rate: f64, blocks: Blocks) -> Sound {
    let longest = match blocks {
        Blocks::Fixed(frames) => frames,
        Blocks::Random => 8192,
    };
    let total = frames(rate) as usize;
    let mut sound = [vec![f32::NAN; total], vec![f32::NAN; total]];
    let played = instance.run(rate, 1..=longest, |processor| {
        let [left, right] = &mut sound;
        let (mut start, mut score) = (0, score.iter().peekable());
        for length in blocks.lengths() {
            let end = total.min(start + length);
            if start == end {
                break;
            }
            let mut events = Vec::new();
            while let Some((sample, what)) = score.next_if(|(sample, _)| (*sample as usize) < end) {
                events.push(event(*what, sample - start as u64));
            }
            processor.process(&events, &mut left[start..end], &mut right[start..end])?;
            start = end;
        }
        Ok(())
    });
    played.expect("the plugin plays");
    sound
}

/// Plays a score on the standard kit with the engine, as one long buffer cut at the happenings only.
pub fn through_engine(score: &Score, rate: f64) -> Sound {
    on_a_kit(&KitDocument::standard(), score, rate)
}

/// The same on any kit.
pub fn on_a_kit(document: &KitDocument, score: &Score, rate: f64) -> Sound {
    let mut performer = Performer::new(rate, document, Arc::default());
    performer.install_kit(rate, Pace::RealTime).expect("a kit");
    let total = frames(rate) as usize;
    let mut sound = [vec![f32::NAN; total], vec![f32::NAN; total]];
    let [left, right] = &mut sound;
    let mut now = 0;
    for &(sample, what) in score {
        let at = total.min(sample as usize);
        performer.render(&mut left[now..at], &mut right[now..at]);
        now = at;
        match what {
            Happening::Note(key, velocity) => {
                performer.note_on(key, velocity_from_midi(velocity), 9);
            }
            Happening::Parameter(index, value) => performer.set_parameter(index, value),
        }
    }
    performer.render(&mut left[now..], &mut right[now..]);
    sound
}

/// Greatest magnitude.
pub fn peak(sound: &Sound) -> f32 {
    sound.iter().flatten().fold(0.0, |peak, sample| peak.max(sample.abs()))
}

/// Whether two sounds are the same, bit by bit; if not, says where they part.
#[track_caller]
pub fn assert_same(found: &Sound, expected: &Sound, what: &str) {
    for (channel, (found, expected)) in std::iter::zip(found, expected).enumerate() {
        assert_eq!(found.len(), expected.len(), "{what}");
        let bits = |sample: &f32| sample.to_bits();
        let parting = std::iter::zip(found, expected).position(|(a, b)| bits(a) != bits(b));
        if let Some(sample) = parting {
            let (found, expected) = (found[sample], expected[sample]);
            panic!("{what}: channel {channel} parts at sample {sample}: {found} for {expected}");
        }
    }
}
