//! What the editor may know: snapshots of the kit through a triple buffer.
//!
//! The audio thread copies a snapshot about 85 times a second and never waits; the editor takes
//! the latest and never holds it up.

use std::hash::Hasher;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use fnv::FnvHasher;
use overhear_engine::snapshot::KitSnapshot;
use rtrb::{Consumer, Producer, RingBuffer};
use triple_buffer::{Input, Output, TripleBuffer};

use crate::sound::Sound;
use overhear_player::performer::Performer;

/// Snapshots a second: a little above what screens show, so that no frame lacks a new one.
const SNAPSHOT_RATE: f64 = 85.0;

/// Snapshots that are kept for diagrams of the past, at most: those of a second, as frames are far apart where the
/// processor draws.
const KEPT: usize = 96;

/// A piece's peak above which it can be heard, full scale 1.
pub const AUDIBLE: f32 = 1e-5;

/// Less energy than this is at rest in every diagram, J.
pub const STILL: f32 = 1e-9;

/// The audio thread's end.
pub struct Publisher {
    snapshots: Input<KitSnapshot>,
    latest: KitSnapshot,
    sound: Sound,
    past: Producer<KitSnapshot>,
    /// Whether the latest is among the past.
    kept: bool,
    news: Arc<AtomicU64>,
    /// Samples from one snapshot to the next.
    interval: usize,
    /// Samples since the latest.
    elapsed: usize,
}

/// The editor's end; windows that come and go share it, and take turns where they have to: the audio thread is no part
/// of that.
#[derive(Clone)]
pub struct Viewer {
    snapshots: Arc<Mutex<Output<KitSnapshot>>>,
    sound: Sound,
    past: Arc<Mutex<Consumer<KitSnapshot>>>,
    news: Arc<AtomicU64>,
}

/// Both ends.
pub fn monitor() -> (Publisher, Viewer) {
    let (input, output) = TripleBuffer::default().split();
    let latest = KitSnapshot::default();
    let sound = Sound::default();
    let news = Arc::new(AtomicU64::new(news(&latest)));
    let (past, kept) = RingBuffer::new(KEPT);
    let viewer = Viewer {
        snapshots: Arc::new(Mutex::new(output)),
        sound: sound.clone(),
        past: Arc::new(Mutex::new(kept)),
        news: news.clone(),
    };
    (Publisher { snapshots: input, latest, sound, past, kept: false, news, interval: 1, elapsed: 0 }, viewer)
}

impl Publisher {
    /// Adopts a sample rate (Hz).
    pub fn set_sample_rate(&mut self, sample_rate: f64) {
        self.sound.set_rate(sample_rate as f32);
        self.interval = ((sample_rate / SNAPSHOT_RATE) as usize).max(1);
    }

    /// Passes on what both outputs play.
    ///
    /// # Real-time
    /// A store for each sample; no allocation, no lock.
    pub fn heard(&self, left: &[f32], right: &[f32]) {
        self.sound.write(left, right);
    }

    /// Notes that samples were rendered, and publishes a snapshot when one is due.
    ///
    /// Peaks of a snapshot that nobody looked at carry over into the next, so that a slow screen
    /// misses no hit.
    ///
    /// # Real-time
    /// A copy; no allocation, no lock.
    pub fn rendered(&mut self, samples: usize, performer: &mut Performer) {
        self.elapsed = self.elapsed.saturating_add(samples);
        if self.elapsed < self.interval {
            return;
        }
        self.elapsed = 0;
        let former = self.latest;
        self.latest = KitSnapshot::default();
        performer.snapshot(&mut self.latest);
        if !self.snapshots.consumed() {
            carry_peaks(&former, &mut self.latest);
        }
        self.news.store(news(&self.latest), Ordering::Relaxed);
        self.keep(&former);
        self.snapshots.write(self.latest);
    }

    /// Keeps the latest for the diagrams while something moves, and the one at rest on either side: an idle kit leaves all
    /// places to the next stroke, however rarely a window at rest looks.
    fn keep(&mut self, former: &KitSnapshot) {
        let begins = moves(&self.latest) && !self.kept;
        let keeps = moves(&self.latest) || moves(former);
        // When all places are taken nobody looks, or has not for a second: what is new then is lost to the diagrams.
        if begins {
            let _ = self.past.push(*former);
        }
        if keeps {
            let _ = self.past.push(self.latest);
        }
        self.kept = keeps;
    }
}

/// Whether anything vibrates, heard or muted.
fn moves(snapshot: &KitSnapshot) -> bool {
    snapshot.pieces.iter().any(|piece| piece.energy > STILL || piece.peak > AUDIBLE)
}

impl Viewer {
    /// What is heard.
    pub fn sound(&self) -> &Sound {
        &self.sound
    }

    /// A number that changes whenever a picture at rest would: without a look at the snapshots, whose peaks count as
    /// seen once somebody looked.
    pub fn news(&self) -> u64 {
        self.news.load(Ordering::Relaxed)
    }

    /// Every snapshot since the last call while something moved, the oldest first, as far as they are kept.
    pub fn since(&self) -> Vec<KitSnapshot> {
        let mut past = self.past.lock().unwrap_or_else(PoisonError::into_inner);
        // Those that come meanwhile are for the next call.
        (0..past.slots()).filter_map(|_| past.pop().ok()).collect()
    }

    /// The latest snapshot.
    pub fn latest(&self) -> KitSnapshot {
        *self.snapshots.lock().unwrap_or_else(PoisonError::into_inner).read()
    }
}

/// Whether anything can be heard, and how often what rarely happens has happened, as one number (FNV-1a).
fn news(snapshot: &KitSnapshot) -> u64 {
    /// Steps of a pedal that are worth a picture: tenths of a millimetre.
    const PEDAL_STEPS: f32 = 1e4;
    /// Samples after which what sounds is worth a picture by itself, as a power of two: a third of a second.
    const BEAT: u32 = 14;
    let loud = snapshot.pieces.iter().any(|piece| piece.peak > AUDIBLE);
    let limited = snapshot.limited_samples as u32;
    // A window rests while a host has stopped the audio in mid ring.
    let beat = if loud { (snapshot.clock >> BEAT) as u32 } else { 0 };
    let whole = [u32::from(loud), u32::from(snapshot.clock > 0), snapshot.missed_runs, limited, beat];
    let pieces = snapshot.pieces.iter().flat_map(|piece| {
        let pedal = (piece.rims.pedal * PEDAL_STEPS) as u32;
        [u32::from(piece.ready), piece.strike.count, piece.quarantines, pedal]
    });
    let mut digest = FnvHasher::default();
    whole.into_iter().chain(pieces).for_each(|word| digest.write_u32(word));
    digest.finish()
}

/// Raises the peaks of a snapshot to those of the one before.
fn carry_peaks(from: &KitSnapshot, into: &mut KitSnapshot) {
    for (peak, former) in into.peak.iter_mut().zip(from.peak) {
        *peak = peak.max(former);
    }
    for (piece, former) in into.pieces.iter_mut().zip(&from.pieces) {
        piece.peak = piece.peak.max(former.peak);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::piece::{BuildOptions, Piece, Quality};
    use overhear_engine::strike::{Strike, Striker};
    use overhear_player::kit_document::{KitDocument, standard_slot};

    #[test]
    fn snapshots_appear_at_their_rate_whatever_the_buffers() {
        let mut performer = Performer::new(48_000.0, &KitDocument::standard(), Arc::default());
        let (mut publisher, viewer) = monitor();
        publisher.set_sample_rate(48_000.0);
        let mut sound = [[0.0; 64]; 2];
        let mut seen = 0;
        let mut clock = 0;
        for _ in 0..750 {
            let [left, right] = &mut sound;
            performer.render(left, right);
            publisher.rendered(64, &mut performer);
            let now = viewer.latest().clock;
            seen += usize::from(now != clock);
            clock = now;
        }
        assert!((80..=90).contains(&seen), "{seen} in a second");
        assert!(viewer.since().is_empty(), "at rest there is no past to draw");
    }

    #[test]
    fn after_any_rest_a_stroke_is_kept_from_its_beginning() {
        let mut performer = Performer::new(48_000.0, &KitDocument::standard(), Arc::default());
        let options = BuildOptions { quality: Quality::Eco, ..BuildOptions::new(48_000.0) };
        let splash = standard_slot("splash");
        let build = KitDocument::standard().kit.build(splash).unwrap();
        performer.install(Box::new(Piece::new(splash, &build, &options).unwrap()));
        let (mut publisher, viewer) = monitor();
        publisher.set_sample_rate(48_000.0);
        let mut sound = [[0.0; 64]; 2];
        let mut play = |performer: &mut Performer, buffers: usize| {
            for _ in 0..buffers {
                let [left, right] = &mut sound;
                performer.render(left, right);
                publisher.rendered(64, performer);
            }
        };
        // Longer than all places last.
        play(&mut performer, 2 * 750);
        assert!(viewer.since().is_empty());
        performer.strike(splash, &hit());
        play(&mut performer, 375);
        let past = viewer.since();
        assert!((40..=45).contains(&past.len()), "{} in half a second", past.len());
        let clocks: Vec<_> = past.iter().map(|snapshot| snapshot.clock).collect();
        assert!(clocks.windows(2).all(|pair| (1..=640).contains(&(pair[1] - pair[0]))), "{clocks:?}");
        let counts: Vec<_> =
            past.iter().map(|snapshot| snapshot.pieces[splash.index()].strike.count).collect();
        assert_eq!(counts[..2], [0, 1], "the last at rest, then the stroke");
    }

    fn hit() -> Strike {
        Strike { speed: 3.0, radius: 0.5, angle: 0.0, striker: Striker::Stick }
    }

    #[test]
    fn a_stroke_is_news_and_silence_is_not() {
        let rest = KitSnapshot { clock: 32, ..KitSnapshot::default() };
        let later = KitSnapshot { clock: 64, ..rest };
        assert_eq!(news(&rest), news(&later));
        let changed = |change: fn(&mut KitSnapshot)| {
            let mut other = rest;
            change(&mut other);
            news(&other)
        };
        for other in [
            changed(|kit| kit.pieces[4].strike.count = 1),
            changed(|kit| kit.pieces[0].peak = 0.1),
            changed(|kit| kit.pieces[8].ready = true),
            changed(|kit| kit.pieces[8].rims.pedal = 0.01),
            changed(|kit| kit.clock = 0),
        ] {
            assert_ne!(other, news(&rest));
        }
    }

    #[test]
    fn peaks_nobody_saw_carry_over() {
        let mut former = KitSnapshot { peak: [0.5, 0.1], ..KitSnapshot::default() };
        former.pieces[2].peak = 0.7;
        let mut next = KitSnapshot { peak: [0.2, 0.3], ..KitSnapshot::default() };
        carry_peaks(&former, &mut next);
        assert_eq!((next.peak, next.pieces[2].peak), ([0.5, 0.3], 0.7));
    }
}
