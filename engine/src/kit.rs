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

mod propagation;
mod arrangement;
mod control;
mod controls;
mod gain;
mod fade_out;
mod delay_line;
mod mixer;
mod render_job;
mod render;
mod retained;
mod room;

pub use arrangement::Arrangement;
pub use control::{Control, Microphone};
pub use gain::{LOUDEST_DB, SILENT_DB};
pub use mixer::{Routing, Stereo};
pub use render_job::{RenderJob, RenderWorkers};

pub use crate::block::BLOCK;
pub use crate::level::FULL_SCALE;

use crate::hi_hat::foot::SPEED;
use crate::kit_spec::KitSpec;
use crate::layout::Layout;
use crate::piece::Piece;
use crate::slot::{SLOTS, Slot};
use crate::snapshot::KitSnapshot;

use gain::Gain;
use mixer::{Mixer, PAIRS};
use propagation::Propagation;
use retained::RetainedControls;

/// Outputs beside the main one: the close microphone of each slot, the overheads, the room.
pub const OUTPUTS: usize = SLOTS + PAIRS;

/// The drum kit. Owns its pieces; renders them; the only way sound leaves the engine.
///
/// ```
/// use overhear_engine::build_context::BuildOptions;
/// use overhear_engine::kit::Kit;
/// use overhear_engine::kit_spec::KitSpec;
/// use overhear_engine::piece::Piece;
/// use overhear_engine::strike::{Strike, Striker};
///
/// let (spec, rate) = (KitSpec::standard(), 48_000.0);
/// let (slot, _) = spec.find("rack-tom").expect("the standard kit has one");
/// let build = spec.build(slot).expect("it is in its slot");
///
/// // Pieces are built anywhere and installed; a kit with some of its pieces plays those.
/// let mut kit = Kit::new(rate, &spec);
/// kit.install(Box::new(Piece::new(slot, &build, &BuildOptions::new(rate))?));
///
/// kit.strike(slot, &Strike { speed: 4.0, radius: 0.2, angle: 0.0, striker: Striker::Stick });
/// let (mut left, mut right) = ([0.0; 4800], [0.0; 4800]);
/// kit.render(&mut left, &mut right);
/// let peak = left.iter().chain(&right).fold(0.0_f32, |peak, x| peak.max(x.abs()));
/// assert!(peak > 0.01 && peak < 2.0, "a tenth of a second of a tom peaks at {peak}");
/// # Ok::<(), overhear_engine::error::SpecError>(())
/// ```
pub struct Kit {
    /// `[slot]`: pieces with their runs; one is missing only while a [`RenderWorkers`] has not brought it back.
    posts: [Option<Box<RenderJob>>; SLOTS],
    retained: [RetainedControls; SLOTS],
    /// Slots that are to hold a piece.
    wanted: [bool; SLOTS],
    workers: Option<Box<dyn RenderWorkers>>,
    air: Propagation,
    desk: Mixer,
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
            posts: std::array::from_fn(|_| Some(Box::new(RenderJob::new(sample_rate)))),
            retained: Slot::ALL.map(|slot| RetainedControls::of(spec.piece(slot))),
            wanted: Slot::ALL.map(|slot| spec.piece(slot).is_some()),
            workers: None,
            air: Propagation::new(sample_rate, &spec.layout(), &spec.room),
            desk: Mixer::new(sample_rate, spec),
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
    /// not depend on who does. Meant for a kit that [is whole](Self::is_whole): what a dismissed workers still has is lost.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn attach(&mut self, workers: Option<Box<dyn RenderWorkers>>) -> Option<Box<dyn RenderWorkers>> {
        std::mem::replace(&mut self.workers, workers)
    }

    /// Whether the workers have brought back every job that they took.
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

    /// Puts a piece in its slot and returns what stood there, to be dropped elsewhere.
    ///
    /// The piece takes over the slot's present tuning and muffling. What stood there and still sounds fades out
    /// first; it is handed back by [`retire`](Self::retire) once it has. A piece of a slot that is away with the workers is
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
        post.leaving.start(former)
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
                *removed = post.piece.take().and_then(|piece| post.leaving.start(piece));
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
        into.limited_samples = self.desk.limited();
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
