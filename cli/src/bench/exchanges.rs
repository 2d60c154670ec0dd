//! What it costs to exchange pieces of a kit while it plays: the groove as notes, in a host's buffers.
//!
//! Pieces and what is about the whole kit are made beforehand by other threads, as the plugin has it; the thread that is timed
//! takes them over at the head of a buffer, hands back what has faded out, and renders. A piece that rings is rendered beside
//! the one that takes its place until it has faded out.

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::{Context, Result};
use cpu_time::ThreadTime;
use overhear::building::{BuildPlan, Pace};
use overhear::kit_document::KitDocument;
use overhear::parameters::default_value;
use overhear::performer::{Performer, Setup};
use overhear::{kit_edits, library};
use overhear_engine::piece::Piece;
use rayon::prelude::*;
use serde::Serialize;

use super::measure::{Buffers, QUANTILES};
use super::request::Request;
use crate::bad_input;
use crate::progress::Progress;

/// A host's buffer, samples.
const BUFFER: usize = 64;

/// A quarter of a second each: on every one a ride, on every fourth a kick, on the third of four a snare, on the first a crash.
const STEPS: usize = 16;
const STEP: f64 = 0.25;

/// How long after a step's strokes a piece is exchanged, s: while they are loudest.
const AFTER: f64 = 0.02;

/// The pieces that are exchanged in turns, each for the one of the library and back: all are struck in the groove.
const PAIRS: [(&str, &str); 4] =
    [("crash", "crash-18-thin"), ("kick", "kick-18x14"), ("ride", "ride-22-light"), ("snare", "snare-13x6")];

/// Notes of kick, snare, crash and ride.
const NOTES: [u8; 4] = [36, 38, 49, 51];
const CHANNEL: u8 = 9;

/// The groove with and without exchanges.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exchanges {
    /// Pieces that are exchanged.
    exchanged: usize,
    /// Samples of a buffer.
    buffer: usize,
    /// CPU time of taking over, each the longest of all.
    longest_takeover: Takeover,
    without: Shares,
    with: Shares,
}

/// What taking over takes of the head of a buffer, s.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
struct Takeover {
    /// Another kit.
    kit_s: f64,
    /// The piece.
    piece_s: f64,
}

/// Time of buffers.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Shares {
    buffers: usize,
    /// Those that take longer than they last.
    late: usize,
    /// The time that so many percent stay within, of the deadline.
    share_percentiles: BTreeMap<&'static str, f64>,
}

/// What one exchange brings.
struct Coming {
    setup: Setup,
    piece: Box<Piece>,
}

/// CPU time of every buffer, and of every exchange, s.
struct Timed {
    buffers: Vec<f64>,
    takeovers: Vec<Takeover>,
}

impl Exchanges {
    /// Plays the groove so many times with and without exchanges. The time of a buffer is the least of all runs, as that of a block.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if a piece cannot be built.
    pub fn measure(request: &Request) -> Result<Exchanges> {
        let documents = documents()?;
        let mut progress = Progress::new("exchanges", 2 * request.runs as u64);
        let [without, with] = [false, true].map(|exchanging| {
            let mut least: Option<Timed> = None;
            for _ in 0..request.runs {
                let run = play(&documents, exchanging, request.rate)?;
                match &mut least {
                    None => least = Some(run),
                    Some(least) => least.keep_less(&run),
                }
                progress.advance(1);
            }
            least.context("no runs")
        });
        let (without, with) = (without?, with?);
        Ok(Exchanges {
            exchanged: with.takeovers.len(),
            buffer: BUFFER,
            longest_takeover: with
                .takeovers
                .into_iter()
                .fold(Takeover::default(), |a, b| a.each(b, f64::max)),
            without: Shares::of(without.buffers, request.rate),
            with: Shares::of(with.buffers, request.rate),
        })
    }

    /// Rows of a table of percentiles: names, shares, late buffers and all.
    pub fn rows(&self) -> [(String, &BTreeMap<&'static str, f64>, [usize; 2]); 2] {
        [("groove", &self.without), ("pieces exchanged", &self.with)].map(|(name, shares)| {
            let counts = [shares.late, shares.buffers];
            (format!("{}, {name}", self.buffer), &shares.share_percentiles, counts)
        })
    }

    /// How many pieces are exchanged, and the longest times that taking over a kit and a piece take, s.
    pub fn takeovers(&self) -> (usize, [f64; 2]) {
        let Takeover { kit_s, piece_s } = self.longest_takeover;
        (self.exchanged, [kit_s, piece_s])
    }
}

#[cfg(test)]
impl Exchanges {
    /// One piece exchanged, and one buffer of two late with it.
    pub(super) fn example() -> Exchanges {
        let deadline = BUFFER as f64;
        let shares = |longest: f64| Shares::of(vec![0.5 * deadline, longest * deadline], 1.0);
        let (without, with) = (shares(0.9), shares(1.1));
        Exchanges { exchanged: 1, buffer: BUFFER, longest_takeover: Takeover::default(), without, with }
    }
}

impl Timed {
    fn keep_less(&mut self, other: &Timed) {
        self.buffers.iter_mut().zip(&other.buffers).for_each(|(least, &time)| *least = least.min(time));
        let takeovers = self.takeovers.iter_mut().zip(&other.takeovers);
        takeovers.for_each(|(least, &taken)| *least = least.each(taken, f64::min));
    }
}

impl Takeover {
    /// One of two of each time.
    fn each(self, other: Takeover, choose: fn(f64, f64) -> f64) -> Takeover {
        Takeover { kit_s: choose(self.kit_s, other.kit_s), piece_s: choose(self.piece_s, other.piece_s) }
    }
}

impl Shares {
    fn of(times: Vec<f64>, rate: f64) -> Shares {
        let buffers = Buffers::timed(times, BUFFER as f64 / rate);
        let share_percentiles = QUANTILES.map(|(name, q)| (name, buffers.within(q))).into();
        Shares { buffers: buffers.count(), late: buffers.late(), share_percentiles }
    }
}

/// The standard kit, and the kit after each exchange; the last is the standard kit again.
fn documents() -> Result<Vec<Arc<KitDocument>>> {
    let standard = KitDocument::standard();
    let mut documents = vec![Arc::new(standard.clone())];
    for number in 0..STEPS {
        let (name, by) = PAIRS[number % PAIRS.len()];
        let before = documents.last().context("the kit before")?;
        let (slot, own) = standard.kit.find(name).with_context(|| format!("no {name} in the kit"))?;
        let mut after = (**before).clone();
        if (number / PAIRS.len()).is_multiple_of(2) {
            let instrument = library::instrument(by).with_context(|| format!("no {by} in the library"))?;
            after = kit_edits::exchange(before, slot, &instrument)
                .map_err(|error| bad_input!("{error}"))?
                .document;
        } else {
            after.kit.pieces[slot.index()] = own.clone();
        }
        documents.push(Arc::new(after));
    }
    Ok(documents)
}

/// Builds what the exchanges bring, on threads of their own.
fn coming(documents: &[Arc<KitDocument>], rate: f64) -> Result<Vec<Coming>> {
    let numbers: Vec<usize> = (0..STEPS).collect();
    let coming = numbers.into_par_iter().map(|number| {
        let document = &documents[number + 1];
        let (name, _) = PAIRS[number % PAIRS.len()];
        let (slot, _) = documents[0].kit.find(name).context("an exchanged piece")?;
        let plan =
            BuildPlan::of(document.clone(), |index| default_value(index, &document.kit), Pace::RealTime);
        let build = plan.build(slot).context("a piece in its slot")?;
        let piece = Piece::new(slot, &build, &plan.options(rate)).map_err(|error| bad_input!("{error}"))?;
        Ok(Coming { setup: Setup::new(rate, document.clone()), piece: Box::new(piece) })
    });
    coming.collect()
}

/// One run.
fn play(documents: &[Arc<KitDocument>], exchanging: bool, rate: f64) -> Result<Timed> {
    let mut performer = Performer::new(rate, &documents[0], Arc::default());
    performer.install_kit(rate, Pace::RealTime).map_err(|error| bad_input!("{error}"))?;
    let coming = exchanging.then(|| coming(documents, rate)).transpose()?;
    let mut coming = coming.unwrap_or_default().into_iter();
    let mut gone = (Vec::with_capacity(STEPS), Vec::with_capacity(2 * STEPS));
    let buffer_at = |time: f64| (time * rate / BUFFER as f64) as usize;
    let [mut left, mut right] = [[0.0; BUFFER]; 2];
    let mut timed = Timed { buffers: Vec::new(), takeovers: Vec::new() };
    for step in 0..STEPS {
        let (from, to) = (buffer_at(step as f64 * STEP), buffer_at((step + 1) as f64 * STEP));
        let exchange_at = from + buffer_at(AFTER);
        for buffer in from..to {
            let start = ThreadTime::now();
            if buffer == exchange_at
                && let Some(Coming { setup, piece }) = coming.next()
            {
                gone.0.push(performer.change_kit(setup));
                let kit_s = start.elapsed().as_secs_f64();
                gone.1.extend(performer.install(piece));
                timed.takeovers.push(Takeover { kit_s, piece_s: start.elapsed().as_secs_f64() - kit_s });
            }
            while let Some(piece) = performer.retire() {
                gone.1.push(piece);
            }
            if buffer == from {
                strike(&mut performer, step);
            }
            performer.render(&mut left, &mut right);
            timed.buffers.push(start.elapsed().as_secs_f64());
        }
    }
    Ok(timed)
}

/// The strokes of a step.
fn strike(performer: &mut Performer, step: usize) {
    let [kick, snare, crash, ride] = NOTES;
    performer.note_on(ride, 0.6, CHANNEL);
    match step % 4 {
        0 => drop(performer.note_on(kick, 0.8, CHANNEL)),
        2 => drop(performer.note_on(snare, 0.9, CHANNEL)),
        _ => {}
    }
    if step == 0 {
        performer.note_on(crash, 0.9, CHANNEL);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_exchange_brings_another_piece_and_the_last_the_standard_kit_again() {
        let documents = documents().unwrap();
        assert_eq!(documents.len(), STEPS + 1);
        for pair in documents.windows(2) {
            let pieces = pair[0].kit.pieces.iter().zip(&pair[1].kit.pieces);
            assert_eq!(pieces.filter(|(before, after)| before.instrument != after.instrument).count(), 1);
        }
        let instruments = |document: &KitDocument| -> Vec<_> {
            document.kit.pieces.iter().map(|piece| piece.instrument).collect()
        };
        assert_eq!(instruments(&documents[STEPS]), instruments(&documents[0]));
    }
}
