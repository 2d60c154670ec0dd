//! The kit: pieces rendered in short blocks on the kit's own clock and mixed to stereo.
//!
//! ```text
//! strike, set --> Kit --> piece --> level --> pan \
//!                     --> piece --> level --> pan  +--> master --> left, right
//!                     --> ...                     /
//! ```
//!
//! Time is cut at multiples of [`BLOCK`] samples of the kit's clock, whatever lengths are asked
//! for; control-rate work happens there only. Nothing depends on how a caller cuts time.

use crate::layout::Placement;
use crate::piece::{Piece, PieceId};
use crate::snapshot::KitSnapshot;
use crate::strike::Strike;
use crate::surface::wires::PRELOAD;

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;

/// Sound pressure of full scale before the levels, Pa.
pub const FULL_SCALE: f32 = 20.0;

/// A live control of the kit. Acts from the next sample on, smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Pitch of a drum, Hz, or of a cymbal, ratio; see [`Piece::tuning_range`].
    Tuning(PieceId),
    /// Muffling of a piece, 0 to 1.
    Muffling(PieceId),
    /// Force that presses the snare wires on, N.
    SnarePreload,
    /// Whether the snare wires lie against the head: below one half they are off.
    SnareWires,
    /// Level of a piece in the mix, dB; at or below [`SILENT_DB`] the piece is silent.
    Level(PieceId),
    /// Level of the whole mix, dB.
    Master,
}

/// Levels at or below this are silence, dB.
pub const SILENT_DB: f64 = -60.0;

/// Highest level, dB.
pub const LOUDEST_DB: f64 = 24.0;

/// Time constant of a level change, s. *By ear*: without zipper noise, without lag.
const LEVEL_TIME: f64 = 0.005;

/// A gain that follows its target exponentially, sample by sample.
#[derive(Debug, Clone, Copy)]
struct Gain {
    value: f32,
    target: f32,
    /// Share of the way left after a sample.
    keep: f32,
}

impl Gain {
    fn new(sample_rate: f64) -> Gain {
        Gain { value: 1.0, target: 1.0, keep: (-1.0 / (LEVEL_TIME * sample_rate)).exp() as f32 }
    }

    fn set_db(&mut self, db: f64) {
        let db = db.min(LOUDEST_DB);
        self.target = if db <= SILENT_DB { 0.0 } else { 10.0_f64.powf(db / 20.0) as f32 };
    }

    fn next(&mut self) -> f32 {
        if self.value != self.target {
            self.value = self.target + (self.value - self.target) * self.keep;
            // -140 dB away is there; the last step cannot be heard.
            if (self.value - self.target).abs() < 1e-7 {
                self.value = self.target;
            }
        }
        self.value
    }
}

/// A piece's place in the kit.
struct Slot {
    piece: Option<Box<Piece>>,
    tuning: f64,
    muffling: f64,
    preload: f64,
    wires: bool,
    level: Gain,
    pan: [f32; 2],
    /// Largest share in the mix since the last snapshot.
    peak: f32,
}

/// The drum kit. Owns its pieces; renders them; the only way sound leaves the engine.
pub struct Kit {
    slots: [Slot; PieceId::KIT.len()],
    master: Gain,
    clock: u64,
    dropped_strikes: u32,
    peak: [f32; 2],
}

impl Kit {
    /// An empty kit at a sample rate (Hz). Pieces arrive through [`install`](Self::install).
    pub fn new(sample_rate: f64) -> Kit {
        let slots = PieceId::KIT.map(|id| Slot {
            piece: None,
            tuning: Piece::tuning_range(id).1,
            muffling: 0.0,
            preload: PRELOAD.1,
            wires: true,
            level: Gain::new(sample_rate),
            pan: Placement::of(id).pan(),
            peak: 0.0,
        });
        Kit { slots, master: Gain::new(sample_rate), clock: 0, dropped_strikes: 0, peak: [0.0; 2] }
    }

    /// Puts a piece in its place and returns what stood there, to be dropped elsewhere.
    ///
    /// The piece takes over the present tuning and muffling. A piece that does not belong to the
    /// kit is handed back.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, mut piece: Box<Piece>) -> Option<Box<Piece>> {
        let Some(slot) = piece.id().slot() else {
            return Some(piece);
        };
        let slot = &mut self.slots[slot];
        piece.set_tuning(slot.tuning);
        piece.set_muffling(slot.muffling);
        piece.set_preload(slot.preload);
        piece.throw_wires(slot.wires);
        piece.finish_controls();
        piece.align((self.clock % BLOCK as u64) as usize);
        slot.piece.replace(piece)
    }

    /// Whether every piece has been installed.
    pub fn is_complete(&self) -> bool {
        self.slots.iter().all(|slot| slot.piece.is_some())
    }

    /// The piece of that name, once installed.
    pub fn piece(&self, id: PieceId) -> Option<&Piece> {
        self.slots[id.slot()?].piece.as_deref()
    }

    /// Strikes a piece at the next sample. A stroke on a piece not yet built is dropped and counted.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, id: PieceId, strike: &Strike) {
        match id.slot().and_then(|slot| self.slots[slot].piece.as_mut()) {
            Some(piece) => piece.strike(strike),
            None => self.dropped_strikes = self.dropped_strikes.saturating_add(1),
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
        match control {
            Control::Master => self.master.set_db(value),
            Control::Level(id) => {
                if let Some(slot) = id.slot() {
                    self.slots[slot].level.set_db(value);
                }
            }
            Control::SnarePreload => {
                if let Some(slot) = PieceId::Snare.slot().map(|slot| &mut self.slots[slot]) {
                    slot.preload = value;
                    slot.piece.iter_mut().for_each(|piece| piece.set_preload(value));
                }
            }
            Control::SnareWires => {
                if let Some(slot) = PieceId::Snare.slot().map(|slot| &mut self.slots[slot]) {
                    slot.wires = value >= 0.5;
                    slot.piece.iter_mut().for_each(|piece| piece.throw_wires(slot.wires));
                }
            }
            Control::Tuning(id) => {
                if let Some(slot) = id.slot().map(|slot| &mut self.slots[slot]) {
                    slot.tuning = value;
                    slot.piece.iter_mut().for_each(|piece| piece.set_tuning(value));
                }
            }
            Control::Muffling(id) => {
                if let Some(slot) = id.slot().map(|slot| &mut self.slots[slot]) {
                    slot.muffling = value;
                    slot.piece.iter_mut().for_each(|piece| piece.set_muffling(value));
                }
            }
        }
    }

    /// Lets every control arrive at once: for setting the kit up before it sounds.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn finish_controls(&mut self) {
        self.master.value = self.master.target;
        for slot in &mut self.slots {
            slot.level.value = slot.level.target;
            slot.piece.iter_mut().for_each(|piece| piece.finish_controls());
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
        let frames = left.len().min(right.len());
        let mut done = 0;
        while done < frames {
            let phase = (self.clock % BLOCK as u64) as usize;
            let run = (frames - done).min(BLOCK - phase);
            self.render_run(&mut left[done..done + run], &mut right[done..done + run]);
            self.clock += run as u64;
            done += run;
        }
    }

    /// Renders within one block.
    fn render_run(&mut self, left: &mut [f32], right: &mut [f32]) {
        left.fill(0.0);
        right.fill(0.0);
        let mut sound = [0.0_f32; BLOCK];
        let sound = &mut sound[..left.len()];
        for slot in &mut self.slots {
            // Levels move even where nothing plays yet: when a piece is ready must not matter.
            match &mut slot.piece {
                Some(piece) => piece.render(sound),
                None => sound.fill(0.0),
            }
            for ((left, right), sound) in left.iter_mut().zip(right.iter_mut()).zip(&*sound) {
                let sound = sound * (slot.level.next() / FULL_SCALE);
                slot.peak = slot.peak.max(sound.abs());
                *left += slot.pan[0] * sound;
                *right += slot.pan[1] * sound;
            }
        }
        for (left, right) in left.iter_mut().zip(right.iter_mut()) {
            let gain = self.master.next();
            *left *= gain;
            *right *= gain;
            self.peak[0] = self.peak[0].max(left.abs());
            self.peak[1] = self.peak[1].max(right.abs());
        }
    }

    /// Puts every piece to rest and the clock to zero; controls keep their values and arrive.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn reset(&mut self) {
        self.finish_controls();
        for slot in &mut self.slots {
            slot.piece.iter_mut().for_each(|piece| piece.reset());
            slot.peak = 0.0;
        }
        self.peak = [0.0; 2];
        self.clock = 0;
    }

    /// Describes the kit to whoever draws it, and starts the peaks anew.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        into.clock = self.clock;
        into.dropped_strikes = self.dropped_strikes;
        into.peak = std::mem::take(&mut self.peak);
        for (slot, into) in self.slots.iter_mut().zip(&mut into.pieces) {
            into.peak = std::mem::take(&mut slot.peak);
            match &slot.piece {
                Some(piece) => piece.snapshot(into),
                None => into.ready = false,
            }
        }
    }
}
