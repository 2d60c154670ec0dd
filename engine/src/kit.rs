//! The kit: pieces that hear each other, rendered in short blocks on the kit's own clock, and the microphones about them.
//!
//! ```text
//!                 +------------- air: after the way's time, weaker ---------+
//!                 v                                                         |
//! strike, set --> pieces (posts, on one thread or several) --> sound far away --> overheads, room --+
//!                                                  \--> sound close by --> close microphones -------+--> desk --> left, right
//! ```
//!
//! Time is cut at multiples of [`BLOCK`] samples of the kit's clock, whatever lengths are asked
//! for; control-rate work happens there only. Nothing depends on how a caller cuts time. No sound
//! reaches another piece within a run ([`Kit::min_delay`]), so that pieces are rendered apart from each other.

mod air;
mod control;
mod gain;
mod leaving;
mod line;
mod mix;
mod post;
mod room;

pub use control::{Control, Microphone};
pub use gain::{LOUDEST_DB, SILENT_DB};
pub use post::{Crew, Post};

use crate::hi_hat::SPLASHING;
use crate::hi_hat::foot::SPEED;
use crate::layout::{Layout, Pair};
use crate::piece::{Piece, PieceId};
use crate::snapshot::KitSnapshot;
use crate::strike::Strike;
use crate::surface::wires::PRELOAD;

use air::Air;
use gain::{Gain, GainRun};
use mix::{Desk, PAIRS};

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;

/// Sound pressure of full scale before the levels, Pa.
pub const FULL_SCALE: f32 = 20.0;

/// Outputs beside the main one: each piece's close microphone, in the order of [`PieceId::KIT`], the overheads, the room.
pub const OUTPUTS: usize = PieceId::KIT.len() + PAIRS;

/// The silence of the room is looked for once in so many blocks.
const SETTLE_BLOCKS: u64 = 128;

/// A gain for every piece over a run.
type GainRuns = [GainRun; PieceId::KIT.len()];

/// What a piece is to take over when it is installed.
struct Seat {
    tuning: f64,
    muffling: f64,
    preload: f64,
    wires: bool,
    pedal: f64,
}

/// Two outputs of one length: left, right; full scale is 1.
pub type Stereo<'a> = [&'a mut [f32]; 2];

/// The drum kit. Owns its pieces; renders them; the only way sound leaves the engine.
pub struct Kit {
    /// Pieces with their runs; one is missing only while a [`Crew`] has not brought it back.
    posts: [Option<Box<Post>>; PieceId::KIT.len()],
    seats: [Seat; PieceId::KIT.len()],
    crew: Option<Box<dyn Crew>>,
    air: Air,
    desk: Desk,
    /// How much the drums hear of each other: the switch, the amount.
    hearing: bool,
    sympathy: f32,
    ears: Gain,
    clock: u64,
    dropped_strikes: u32,
    missed_runs: u32,
    resets: u32,
}

impl Kit {
    /// An empty kit at a sample rate (Hz). Pieces arrive through [`install`](Self::install).
    pub fn new(sample_rate: f64) -> Kit {
        Kit::with_layout(sample_rate, &Layout::default())
    }

    /// An empty kit that stands so, at a sample rate in Hz.
    pub fn with_layout(sample_rate: f64, layout: &Layout) -> Kit {
        Kit {
            posts: std::array::from_fn(|_| Some(Box::new(Post::new(sample_rate)))),
            seats: PieceId::KIT.map(|id| Seat {
                tuning: Piece::tuning_range(id).1,
                muffling: 0.0,
                preload: PRELOAD.1,
                wires: true,
                pedal: 0.0,
            }),
            crew: None,
            air: Air::new(sample_rate, layout),
            desk: Desk::new(sample_rate, layout),
            hearing: true,
            sympathy: 1.0,
            ears: Gain::new(sample_rate),
            clock: 0,
            dropped_strikes: 0,
            missed_runs: 0,
            resets: 0,
        }
    }

    /// Lets somebody else render the posts, and returns who did so far, to be dropped elsewhere. Output does
    /// not depend on who does. Meant for a kit that [is whole](Self::is_whole): what a dismissed crew still has is lost.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn hire(&mut self, crew: Option<Box<dyn Crew>>) -> Option<Box<dyn Crew>> {
        std::mem::replace(&mut self.crew, crew)
    }

    /// Whether nobody has a post away: the crew has brought back all it took.
    pub fn is_whole(&self) -> bool {
        self.posts.iter().all(Option::is_some)
    }

    /// Samples in which no piece hears what another does: the longest run that is rendered at once.
    pub fn min_delay(&self) -> usize {
        self.air.min_delay()
    }

    /// Where pieces and microphones stand.
    pub fn layout(&self) -> &Layout {
        self.air.layout()
    }

    /// Puts the overheads or the room pair somewhere, m, not farther than [`FARTHEST`](crate::layout::FARTHEST) from any piece;
    /// what is heard fades over in some hundredths of a second. A close microphone is where its piece was built to
    /// be heard: see [`BuildOptions::close`](crate::piece::BuildOptions::close).
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn place(&mut self, microphones: Microphone, places: Pair) {
        if places.iter().flatten().all(|x| x.is_finite()) {
            match microphones {
                Microphone::Close(_) => {}
                Microphone::Overheads => self.air.place_pair(0, places),
                Microphone::Room => self.air.place_pair(1, places),
            }
        }
    }

    fn mut_piece(&mut self, id: PieceId) -> Option<&mut Box<Piece>> {
        self.posts[id.slot()?].as_mut()?.piece.as_mut()
    }

    /// Puts a piece in its place and returns what stood there, to be dropped elsewhere.
    ///
    /// The piece takes over the present tuning and muffling. What stood there and still sounds fades out
    /// first; it is handed back by [`retire`](Self::retire) once it has. A piece that does not belong to the
    /// kit is handed back.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, mut piece: Box<Piece>) -> Option<Box<Piece>> {
        let Some((slot, post)) = piece.id().slot().and_then(|slot| Some((slot, self.posts[slot].as_mut()?)))
        else {
            return Some(piece);
        };
        let seat = &self.seats[slot];
        piece.set_tuning(seat.tuning);
        piece.set_muffling(seat.muffling);
        piece.set_preload(seat.preload);
        piece.throw_wires(seat.wires);
        piece.press_pedal(seat.pedal, SPEED.1);
        piece.finish_controls();
        piece.align((self.clock % BLOCK as u64) as usize);
        self.air.place_close(slot, piece.close());
        let former = post.piece.replace(piece)?;
        post.leaving.see_off(former)
    }

    /// Hands back a replaced piece that has faded out, to be dropped elsewhere; one a call.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn retire(&mut self) -> Option<Box<Piece>> {
        self.posts.iter_mut().flatten().find_map(|post| post.leaving.gone())
    }

    /// Whether every piece has been installed.
    pub fn is_complete(&self) -> bool {
        PieceId::KIT.iter().all(|&id| self.piece(id).is_some())
    }

    /// The piece of that name, once installed.
    pub fn piece(&self, id: PieceId) -> Option<&Piece> {
        self.posts[id.slot()?].as_ref()?.piece.as_deref()
    }

    /// Strikes a piece at the next sample. A stroke on a piece not yet built is dropped and counted.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, id: PieceId, strike: &Strike) {
        match self.mut_piece(id) {
            Some(piece) => piece.strike(strike),
            None => self.dropped_strikes = self.dropped_strikes.saturating_add(1),
        }
    }

    /// Lets a hand take hold of a cymbal, from 0 (lets go) to 1 (firmly); see [`Piece::choke`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, id: PieceId, strength: f64) {
        if let Some(piece) = self.mut_piece(id).filter(|_| !strength.is_nan()) {
            piece.choke(strength);
        }
    }

    /// Moves a control from the next sample on, to the nearest end of its range if beyond it. A NaN
    /// is ignored, and so is a piece that does not belong to the kit.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set(&mut self, control: Control, value: f64) {
        if value.is_nan() {
            return;
        }
        let on = value >= 0.5;
        match control {
            Control::Master => self.desk.set_master(value),
            Control::Level(id) => self.desk.set_level(id, value),
            Control::Pan(id) => self.desk.set_balance(Microphone::Close(id), value),
            Control::Balance(microphone) => self.desk.set_balance(microphone, value),
            Control::MicrophoneLevel(microphone) => self.desk.set_strip_level(microphone, value),
            Control::CloseLevel => self.desk.set_close(value),
            Control::Mute(microphone) => self.desk.mute(microphone, on),
            Control::Solo(microphone) => self.desk.solo(microphone, on),
            Control::SafetyClip => self.desk.set_clip(on),
            Control::Hearing => self.listen(on, self.sympathy),
            Control::Sympathy => self.listen(self.hearing, value.clamp(0.0, 1.0) as f32),
            Control::Pedal => self.press_pedal(value, SPEED.1),
            Control::SnarePreload => self.adjust(PieceId::Snare, control, value),
            Control::SnareWires => self.adjust(PieceId::Snare, control, value),
            Control::Tuning(id) | Control::Muffling(id) => self.adjust(id, control, value),
        }
    }

    /// Moves a control of a piece, and of whatever takes its place.
    fn adjust(&mut self, id: PieceId, control: Control, value: f64) {
        let Some(slot) = id.slot() else { return };
        let seat = &mut self.seats[slot];
        let piece = self.posts[slot].as_mut().and_then(|post| post.piece.as_mut());
        match control {
            Control::SnarePreload => {
                seat.preload = value;
                piece.into_iter().for_each(|piece| piece.set_preload(value));
            }
            Control::SnareWires => {
                seat.wires = value >= 0.5;
                piece.into_iter().for_each(|piece| piece.throw_wires(value >= 0.5));
            }
            Control::Muffling(_) => {
                seat.muffling = value;
                piece.into_iter().for_each(|piece| piece.set_muffling(value));
            }
            _ => {
                seat.tuning = value;
                piece.into_iter().for_each(|piece| piece.set_tuning(value));
            }
        }
    }

    fn listen(&mut self, hearing: bool, sympathy: f32) {
        (self.hearing, self.sympathy) = (hearing, sympathy);
        self.ears.set(if hearing { sympathy } else { 0.0 });
    }

    /// Lets somebody step on the hi-hat's pedal, which is then left at a place, 0 to 1, given where it was; on a
    /// piece that comes later it is there at once.
    fn step_on(&mut self, left: impl FnOnce(f64) -> f64, step: impl FnOnce(&mut Piece)) {
        let Some(slot) = PieceId::HiHat.slot() else { return };
        self.seats[slot].pedal = left(self.seats[slot].pedal);
        if let Some(piece) = self.mut_piece(PieceId::HiHat) {
            step(piece);
        }
    }

    /// Brings the hi-hat's pedal to a place, 0 (up) to 1 (down), at up to a speed (m/s); see
    /// [`Piece::press_pedal`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn press_pedal(&mut self, pedal: f64, speed: f64) {
        if !pedal.is_nan() {
            self.step_on(|_| pedal, |hat| hat.press_pedal(pedal, speed));
        }
    }

    /// Stamps on the hi-hat's pedal, at up to a speed (m/s); see [`Piece::stamp_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn stamp_pedal(&mut self, speed: f64) {
        self.step_on(|_| 1.0, |hat| hat.stamp_pedal(speed));
    }

    /// Splashes with the hi-hat's pedal, at up to a speed (m/s); see [`Piece::splash_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn splash_pedal(&mut self, speed: f64) {
        self.step_on(|pedal| pedal.min(SPLASHING), |hat| hat.splash_pedal(speed));
    }

    /// Lets every control arrive at once: for setting the kit up before it sounds.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn finish_controls(&mut self) {
        self.desk.jump();
        self.ears.jump();
        self.air.jump();
        for piece in self.posts.iter_mut().flatten().filter_map(|post| post.piece.as_mut()) {
            piece.finish_controls();
        }
    }

    /// Renders both outputs, full scale 1, overwriting them. Any length; both the same.
    ///
    /// The same strikes and controls at the same samples give the same output, however the
    /// calls cut the time.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.render_outputs([left, right], &mut []);
    }

    /// [`render`](Self::render), and in the same pass each piece by itself.
    ///
    /// `outputs` are the close microphones in the order of [`PieceId::KIT`], then the overheads, then the room, before the
    /// master: they add up to what the master gets. Pairs that are left out at the end, or shorter than the main
    /// one, are not written: an output that nobody listens to is a pair of empty slices. What is written to
    /// `main` does not depend on them.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        let [left, right] = main;
        let frames = left.len().min(right.len());
        let longest = self.min_delay();
        let mut done = 0;
        while done < frames {
            let phase = (self.clock % BLOCK as u64) as usize;
            let run = done..done + (frames - done).min(BLOCK - phase).min(longest);
            if phase == 0 && self.clock.is_multiple_of(SETTLE_BLOCKS * BLOCK as u64) {
                self.air.settle();
            }
            self.render_run([&mut left[run.clone()], &mut right[run.clone()]], outputs, run.start);
            self.clock += run.len() as u64;
            done = run.end;
        }
    }

    /// Renders within one block; outputs are written from sample `at` on.
    fn render_run(&mut self, mut main: Stereo<'_>, outputs: &mut [Stereo<'_>], at: usize) {
        let samples = main[0].len();
        main.iter_mut().for_each(|side| side.fill(0.0));
        let still = self.is_asleep() && self.desk.rests() && self.ears.rests();
        self.render_posts(samples);
        // Asleep before and asleep after: nothing but silence has been sent.
        if still && self.is_asleep() {
            for side in outputs.iter_mut().flatten() {
                side.get_mut(at..at + samples).into_iter().for_each(|side| side.fill(0.0));
            }
            return;
        }
        let Kit { posts, air, desk, clock, missed_runs, .. } = self;
        // Levels move even where nothing plays yet: when a piece is ready must not matter.
        let levels = desk.levels(samples);
        let mut outputs = outputs
            .iter_mut()
            .map(|output| output.each_mut().map(|side| side.get_mut(at..at + samples).unwrap_or_default()));
        let mut sent = [0.0; BLOCK];
        for (slot, post) in posts.iter().enumerate() {
            // One that has come back late has the sound of an earlier run.
            match post.as_ref().filter(|post| post.due == *clock) {
                Some(post) => {
                    air.send(slot, *clock, post);
                    let terms = sent.iter_mut().zip(&post.sound[1]).zip(&levels[slot]);
                    terms.take(samples).for_each(|((sum, sound), level)| *sum += level * sound);
                }
                None => {
                    air.send_silence(slot, *clock, samples);
                    *missed_runs = missed_runs.saturating_add(1);
                }
            }
            let mut sound = [0.0; BLOCK];
            let sound = &mut sound[..samples];
            air.close(slot, *clock, sound);
            sound.iter_mut().zip(&levels[slot]).for_each(|(sound, level)| *sound *= level);
            desk.add(slot, [sound, sound], &mut main, outputs.next());
        }
        for pair in 0..PAIRS {
            let mut heard = air.pair(pair, *clock, samples, &levels, desk);
            if pair + 1 == PAIRS && !desk.is_shut(pair) {
                air.tail(&sent[..samples], &mut heard);
            }
            let [left, right] = heard.each_ref().map(|side| &side[..samples]);
            desk.add(PieceId::KIT.len() + pair, [left, right], &mut main, outputs.next());
        }
        desk.finish(&mut main);
    }

    /// Lets every piece hear the others and renders it.
    fn render_posts(&mut self, samples: usize) {
        let deaf = self.ears.is_shut();
        let amount = self.ears.run(samples);
        for (slot, (id, post)) in PieceId::KIT.iter().zip(&mut self.posts).enumerate() {
            let Some(post) = post else { continue };
            post.prepare(self.resets, self.clock, samples);
            if id.is_drum() && !deaf {
                self.air.arrive(slot, self.clock, &amount, post);
            }
        }
        match &mut self.crew {
            Some(crew) => crew.render(&mut self.posts),
            None => self.posts.iter_mut().flatten().for_each(|post| post.render()),
        }
    }

    /// Whether nothing sounds and nothing is under way.
    pub fn is_asleep(&self) -> bool {
        self.air.is_silent() && self.posts.iter().flatten().all(|post| post.is_asleep())
    }

    /// Puts every piece to rest and the clock to zero; controls keep their values and arrive.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn reset(&mut self) {
        self.finish_controls();
        self.resets = self.resets.wrapping_add(1);
        // One that is away follows when it is back.
        self.posts.iter_mut().flatten().for_each(|post| post.reset(self.resets));
        self.air.reset();
        self.desk.reset();
        self.clock = 0;
    }

    /// Describes the kit to whoever draws it, and starts the peaks anew.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        into.clock = self.clock;
        into.dropped_strikes = self.dropped_strikes;
        into.missed_runs = self.missed_runs;
        into.clipped_samples = self.desk.clipped();
        into.peak = self.desk.take_peak();
        for (slot, (post, into)) in self.posts.iter().zip(&mut into.pieces).enumerate() {
            into.peak = self.desk.take_strip_peak(slot);
            match post.as_ref().and_then(|post| post.piece.as_ref()) {
                Some(piece) => piece.snapshot(into),
                None => into.ready = false,
            }
        }
    }
}
