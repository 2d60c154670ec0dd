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
mod arrangement;
mod control;
mod gain;
mod leaving;
mod line;
mod mix;
mod post;
mod retained;
mod room;

pub use arrangement::Arrangement;
pub use control::{Control, Microphone};
pub use gain::{LOUDEST_DB, SILENT_DB};
pub use mix::Stereo;
pub use post::{Crew, Post};

pub use crate::block::BLOCK;
pub use crate::level::FULL_SCALE;

use crate::hi_hat::SPLASHING;
use crate::hi_hat::foot::SPEED;
use crate::kit_spec::{Kind, KitSpec};
use crate::layout::{Layout, Pair};
use crate::piece::Piece;
use crate::slot::{SLOTS, Slot};
use crate::snapshot::KitSnapshot;
use crate::strike::Strike;

use air::Air;
use gain::Gain;
use mix::{Desk, PAIRS};
use retained::RetainedControls;

/// Outputs beside the main one: the close microphone of each slot, the overheads, the room.
pub const OUTPUTS: usize = SLOTS + PAIRS;

/// The silence of the room is looked for once in so many blocks.
const SETTLE_BLOCKS: u64 = 128;

/// The drum kit. Owns its pieces; renders them; the only way sound leaves the engine.
pub struct Kit {
    /// `[slot]`: pieces with their runs; one is missing only while a [`Crew`] has not brought it back.
    posts: [Option<Box<Post>>; SLOTS],
    retained: [RetainedControls; SLOTS],
    /// Slots that are to hold a piece.
    wanted: [bool; SLOTS],
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
    /// A kit of that description at a sample rate (Hz), without its pieces: they arrive through
    /// [`install`](Self::install). Its controls are where the description has them. Allocates.
    pub fn new(sample_rate: f64, spec: &KitSpec) -> Kit {
        Kit {
            posts: std::array::from_fn(|_| Some(Box::new(Post::new(sample_rate)))),
            retained: Slot::ALL.map(|slot| RetainedControls::of(spec.piece(slot))),
            wanted: Slot::ALL.map(|slot| spec.piece(slot).is_some()),
            crew: None,
            air: Air::new(sample_rate, &spec.layout(), &spec.room),
            desk: Desk::new(sample_rate, spec),
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
    /// be heard.
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

    fn mut_piece(&mut self, slot: Slot) -> Option<&mut Box<Piece>> {
        self.posts[slot.index()].as_mut()?.piece.as_mut()
    }

    /// Puts a piece in its slot and returns what stood there, to be dropped elsewhere.
    ///
    /// The piece takes over the slot's present tuning and muffling. What stood there and still sounds fades out
    /// first; it is handed back by [`retire`](Self::retire) once it has. A piece of a slot that is away with the crew is
    /// handed back.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, mut piece: Box<Piece>) -> Option<Box<Piece>> {
        let slot = piece.slot();
        let Some(post) = self.posts[slot.index()].as_mut() else { return Some(piece) };
        let retained = &self.retained[slot.index()];
        piece.set_tuning(retained.tuning);
        piece.set_muffling(retained.muffling);
        piece.set_preload(retained.preload);
        piece.throw_wires(retained.wires);
        piece.press_pedal(retained.pedal, SPEED.1);
        piece.finish_controls();
        piece.align((self.clock % BLOCK as u64) as usize);
        self.wanted[slot.index()] = true;
        self.air.place_slot(slot, &piece);
        let former = post.piece.replace(piece)?;
        post.leaving.see_off(former)
    }

    /// Takes over who is to be in which slot, where the microphones usually stand, and the room. Pieces of slots that are to
    /// be empty fade out; all others play on until others are [installed](Self::install) in their place. What is not
    /// needed any more is in the arrangement that comes back, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn arrange(&mut self, mut arrangement: Box<Arrangement>) -> Box<Arrangement> {
        self.wanted = arrangement.layout.pieces.map(|place| place.is_some());
        self.air.arrange(&mut arrangement);
        for ((post, wanted), removed) in self.posts.iter_mut().zip(self.wanted).zip(&mut arrangement.removed)
        {
            if let Some(post) = post.as_mut().filter(|_| !wanted) {
                *removed = post.piece.take().and_then(|piece| post.leaving.see_off(piece));
            }
        }
        arrangement
    }

    /// Hands back a replaced piece that has faded out, to be dropped elsewhere; one a call.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn retire(&mut self) -> Option<Box<Piece>> {
        self.posts.iter_mut().flatten().find_map(|post| post.leaving.gone())
    }

    /// Whether every piece of the description has been installed.
    pub fn is_complete(&self) -> bool {
        Slot::ALL.into_iter().all(|slot| !self.wanted[slot.index()] || self.piece(slot).is_some())
    }

    /// The piece of a slot, once installed.
    pub fn piece(&self, slot: Slot) -> Option<&Piece> {
        self.posts[slot.index()].as_ref()?.piece.as_deref()
    }

    /// The piece of a slot, to be looked at closely by tests and tools.
    pub fn piece_mut(&mut self, slot: Slot) -> Option<&mut Piece> {
        self.posts[slot.index()].as_mut()?.piece.as_deref_mut()
    }

    /// Strikes a piece at the next sample. A stroke on a piece not yet built is dropped and counted.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, slot: Slot, strike: &Strike) {
        match self.mut_piece(slot) {
            Some(piece) => piece.strike(strike),
            None => self.dropped_strikes = self.dropped_strikes.saturating_add(1),
        }
    }

    /// Lets a hand take hold of a cymbal, from 0 (lets go) to 1 (firmly); see [`Piece::choke`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, slot: Slot, strength: f64) {
        if let Some(piece) = self.mut_piece(slot).filter(|_| !strength.is_nan()) {
            piece.choke(strength);
        }
    }

    /// Moves a control from the next sample on, to the nearest end of its range if beyond it. A NaN
    /// is ignored, and so is a control that the slot's piece does not have.
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
            Control::Level(slot) => self.desk.set_level(slot, value),
            Control::Pan(slot) => self.desk.set_balance(Microphone::Close(slot), value),
            Control::Balance(microphone) => self.desk.set_balance(microphone, value),
            Control::MicrophoneLevel(microphone) => self.desk.set_strip_level(microphone, value),
            Control::CloseLevel => self.desk.set_close(value),
            Control::Mute(microphone) => self.desk.mute(microphone, on),
            Control::Solo(microphone) => self.desk.solo(microphone, on),
            Control::SafetyClip => self.desk.set_clip(on),
            Control::Hearing => self.listen(on, self.sympathy),
            Control::Sympathy => self.listen(self.hearing, value.clamp(0.0, 1.0) as f32),
            Control::Pedal(slot) => self.press_pedal(slot, value, SPEED.1),
            Control::Preload(slot)
            | Control::Wires(slot)
            | Control::Tuning(slot)
            | Control::Muffling(slot) => self.adjust(slot, control, value),
        }
    }

    /// Moves a control of a piece, and of whatever takes its place.
    fn adjust(&mut self, slot: Slot, control: Control, value: f64) {
        let retained = &mut self.retained[slot.index()];
        let piece = self.posts[slot.index()].as_mut().and_then(|post| post.piece.as_mut());
        match control {
            Control::Preload(_) => {
                retained.preload = value;
                piece.into_iter().for_each(|piece| piece.set_preload(value));
            }
            Control::Wires(_) => {
                retained.wires = value >= 0.5;
                piece.into_iter().for_each(|piece| piece.throw_wires(value >= 0.5));
            }
            Control::Muffling(_) => {
                retained.muffling = value;
                piece.into_iter().for_each(|piece| piece.set_muffling(value));
            }
            _ => {
                retained.tuning = value;
                piece.into_iter().for_each(|piece| piece.set_tuning(value));
            }
        }
    }

    fn listen(&mut self, hearing: bool, sympathy: f32) {
        (self.hearing, self.sympathy) = (hearing, sympathy);
        self.ears.set(if hearing { sympathy } else { 0.0 });
    }

    /// Lets somebody step on a slot's pedal, which is then left at a place, 0 to 1, given where it was; on a
    /// piece that comes later it is there at once.
    fn step_on(&mut self, slot: Slot, left: impl FnOnce(f64) -> f64, step: impl FnOnce(&mut Piece)) {
        let retained = &mut self.retained[slot.index()];
        retained.pedal = left(retained.pedal);
        if let Some(piece) = self.mut_piece(slot) {
            step(piece);
        }
    }

    /// Brings a hi-hat's pedal to a place, 0 (up) to 1 (down), at up to a speed (m/s); see
    /// [`Piece::press_pedal`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn press_pedal(&mut self, slot: Slot, pedal: f64, speed: f64) {
        if !pedal.is_nan() {
            self.step_on(slot, |_| pedal, |hat| hat.press_pedal(pedal, speed));
        }
    }

    /// Stamps on a hi-hat's pedal, at up to a speed (m/s); see [`Piece::stamp_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn stamp_pedal(&mut self, slot: Slot, speed: f64) {
        self.step_on(slot, |_| 1.0, |hat| hat.stamp_pedal(speed));
    }

    /// Splashes with a hi-hat's pedal, at up to a speed (m/s); see [`Piece::splash_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn splash_pedal(&mut self, slot: Slot, speed: f64) {
        self.step_on(slot, |pedal| pedal.min(SPLASHING), |hat| hat.splash_pedal(speed));
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
    /// `outputs` are the close microphones of all [`SLOTS`], then the overheads, then the room, before the
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
            if post.as_ref().is_some_and(|post| post.is_empty()) && air.is_slot_silent(slot) {
                for side in outputs.next().into_iter().flatten() {
                    side.fill(0.0);
                }
                continue;
            }
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
            desk.add(SLOTS + pair, [left, right], &mut main, outputs.next());
        }
        desk.finish(&mut main);
    }

    /// Lets every piece hear the others and renders it.
    fn render_posts(&mut self, samples: usize) {
        let deaf = self.ears.is_shut();
        let amount = self.ears.run(samples);
        for (slot, post) in self.posts.iter_mut().enumerate() {
            let Some(post) = post else { continue };
            post.prepare(self.resets, self.clock, samples);
            let listens = post.piece.as_ref().is_some_and(|piece| piece.kind() == Kind::Drum);
            if listens && !deaf {
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
