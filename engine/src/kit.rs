//! The kit: pieces with sympathetic resonance, rendered in short blocks on the kit's own clock, and its microphones.
//!
//! ```text
//!                 +------------- air: delayed and attenuated -------------+
//!                 v                                                       |
//! strike, set --> pieces (jobs, on one thread or several) --> far field --> overheads, room ------+
//!                                                  \--> near field --> close microphones --------+--> mixer --> left, right
//! ```
//!
//! Time is divided at multiples of [`BLOCK`] samples of the kit's clock, for any length of the calls. Control-rate work happens
//! there only, so the output does not depend on the host's buffers. No sound reaches another piece within a run
//! ([`Kit::min_delay`]), so pieces are rendered independently.

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
pub use mixer::{Routing, Stereo, limit};
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

/// The drum kit. It owns and renders its pieces, and is the only output of the engine.
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
    /// `[slot]`: pieces with their runs. A job is missing only while [`RenderWorkers`] have it.
    jobs: [Option<Box<RenderJob>>; SLOTS],
    retained: [RetainedControls; SLOTS],
    /// Slots that should hold a piece.
    wanted: [bool; SLOTS],
    workers: Option<Box<dyn RenderWorkers>>,
    air: Propagation,
    mixer: Mixer,
    /// Sympathetic coupling of the drums: the switch and the amount.
    coupled: bool,
    sympathy: f32,
    coupling: Gain,
    clock: u64,
    dropped_strikes: u32,
    missed_runs: u32,
    resets: u32,
}

impl Kit {
    /// A kit of that description at a sample rate (Hz), without its pieces: they arrive through
    /// [`install`](Self::install). Its controls have the values of the description. Allocates.
    pub fn new(sample_rate: f64, spec: &KitSpec) -> Kit {
        Kit {
            jobs: std::array::from_fn(|_| Some(Box::new(RenderJob::new(sample_rate)))),
            retained: Slot::ALL.map(|slot| RetainedControls::of(spec.piece(slot))),
            wanted: Slot::ALL.map(|slot| spec.piece(slot).is_some()),
            workers: None,
            air: Propagation::new(sample_rate, &spec.layout(), &spec.room),
            mixer: Mixer::new(sample_rate, spec),
            coupled: true,
            sympathy: 1.0,
            coupling: Gain::new(sample_rate),
            clock: 0,
            dropped_strikes: 0,
            missed_runs: 0,
            resets: 0,
        }
    }

    /// Replaces the workers that render the jobs, and returns the former ones, to be dropped elsewhere. The output does not
    /// depend on them. Meant for a kit that [is whole](Self::is_whole): a job that the former workers still have is lost.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn attach(&mut self, workers: Option<Box<dyn RenderWorkers>>) -> Option<Box<dyn RenderWorkers>> {
        std::mem::replace(&mut self.workers, workers)
    }

    /// Whether the workers have brought back every job that they took.
    pub fn is_whole(&self) -> bool {
        self.jobs.iter().all(Option::is_some)
    }

    /// Shortest delay between two pieces, samples: the longest run that is rendered at once.
    pub fn min_delay(&self) -> usize {
        self.air.min_delay()
    }

    /// Where pieces and microphones stand.
    pub fn layout(&self) -> &Layout {
        self.air.layout()
    }

    /// Puts a piece in its slot and returns the former one, to be dropped elsewhere.
    ///
    /// The piece takes over the slot's present tuning and muffling. A former piece that still sounds fades out
    /// first; [`retire`](Self::retire) returns it afterwards. If the workers still have the slot's job, the new piece is
    /// returned.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, mut piece: Box<Piece>) -> Option<Box<Piece>> {
        let slot = piece.slot();
        let Some(job) = self.jobs[slot.index()].as_mut() else { return Some(piece) };
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
        let former = job.piece.replace(piece)?;
        job.fade_out.start(former)
    }

    /// Puts a piece in its slot, whose tuning (Hz or a ratio, as the piece's) becomes this one; otherwise as [`install`](Self::install). A piece
    /// that is built there need not be retuned.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install_tuned(&mut self, piece: Box<Piece>, tuning: f64) -> Option<Box<Piece>> {
        let slot = piece.slot().index();
        if self.jobs[slot].is_some() && tuning.is_finite() {
            self.retained[slot].tuning = tuning;
        }
        self.install(piece)
    }

    /// Takes over the slots in use, the positions of pieces and microphones, and the room. Pieces of slots that become empty
    /// fade out. All others play on until they are [replaced](Self::install). The returned arrangement holds everything that is
    /// no longer needed, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn arrange(&mut self, mut arrangement: Box<Arrangement>) -> Box<Arrangement> {
        self.wanted = arrangement.layout.pieces.map(|place| place.is_some());
        self.air.arrange(&mut arrangement);
        for ((job, wanted), removed) in self.jobs.iter_mut().zip(self.wanted).zip(&mut arrangement.removed) {
            if let Some(job) = job.as_mut().filter(|_| !wanted) {
                *removed = job.piece.take().and_then(|piece| job.fade_out.start(piece));
            }
        }
        arrangement
    }

    /// Returns a replaced piece that has faded out, to be dropped elsewhere; one a call.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn retire(&mut self) -> Option<Box<Piece>> {
        self.jobs.iter_mut().flatten().find_map(|job| job.fade_out.gone())
    }

    /// Whether every piece of the description has been installed.
    pub fn is_complete(&self) -> bool {
        Slot::ALL.into_iter().all(|slot| !self.wanted[slot.index()] || self.piece(slot).is_some())
    }

    /// The piece of a slot, once installed.
    pub fn piece(&self, slot: Slot) -> Option<&Piece> {
        self.jobs[slot.index()].as_ref()?.piece.as_deref()
    }

    /// The piece of a slot, for tests and tools.
    pub fn piece_mut(&mut self, slot: Slot) -> Option<&mut Piece> {
        self.jobs[slot.index()].as_mut()?.piece.as_deref_mut()
    }

    /// Whether nothing sounds and no sound is in the delay lines.
    pub fn is_asleep(&self) -> bool {
        self.air.is_silent() && self.jobs.iter().flatten().all(|job| job.is_asleep())
    }

    /// Puts every piece to rest and the clock to zero; controls keep their values and arrive.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn reset(&mut self) {
        self.finish_controls();
        self.resets = self.resets.wrapping_add(1);
        // A job that the workers have follows when it is back.
        self.jobs.iter_mut().flatten().for_each(|job| job.reset(self.resets));
        self.air.reset();
        self.mixer.reset();
        self.clock = 0;
    }

    /// Writes a snapshot of the kit, and restarts the peaks.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        into.clock = self.clock;
        into.dropped_strikes = self.dropped_strikes;
        into.missed_runs = self.missed_runs;
        into.clipped_samples = self.mixer.clipped();
        into.limited_samples = self.mixer.limited();
        into.peak = self.mixer.take_peak();
        for (slot, (job, into)) in self.jobs.iter().zip(&mut into.pieces).enumerate() {
            into.peak = self.mixer.take_strip_peak(slot);
            match job.as_ref().and_then(|job| job.piece.as_ref()) {
                Some(piece) => piece.snapshot(into),
                None => into.ready = false,
            }
        }
    }
}
