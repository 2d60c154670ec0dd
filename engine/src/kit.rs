//! The kit: pieces rendered in short blocks on the kit's own clock and mixed to stereo.
//!
//! ```text
//! strike, set --> Kit --> piece --> level --> pan --+--> output of the piece
//!                                                   +--> master --> left, right
//!                     --> piece --> level --> pan --+--> output of the piece
//!                     --> ...
//! ```
//!
//! Time is cut at multiples of [`BLOCK`] samples of the kit's clock, whatever lengths are asked
//! for; control-rate work happens there only. Nothing depends on how a caller cuts time.

mod control;
mod gain;
mod leaving;

pub use control::Control;
pub use gain::{LOUDEST_DB, SILENT_DB};

use crate::layout::Placement;
use crate::piece::{Piece, PieceId};
use crate::snapshot::KitSnapshot;
use crate::strike::Strike;
use crate::surface::wires::PRELOAD;

use gain::{Gain, Pan};
use leaving::Leaving;

/// Longest stretch a piece renders at once, samples.
pub const BLOCK: usize = 32;

/// Sound pressure of full scale before the levels, Pa.
pub const FULL_SCALE: f32 = 20.0;

/// A piece's place in the kit.
struct Slot {
    piece: Option<Box<Piece>>,
    leaving: Leaving,
    tuning: f64,
    muffling: f64,
    preload: f64,
    wires: bool,
    level: Gain,
    pan: Pan,
    /// Largest share in the mix since the last snapshot.
    peak: f32,
}

/// Two outputs of one length: left, right.
pub type Stereo<'a> = [&'a mut [f32]; 2];

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
            leaving: Leaving::new(sample_rate),
            tuning: Piece::tuning_range(id).1,
            muffling: 0.0,
            preload: PRELOAD.1,
            wires: true,
            level: Gain::new(sample_rate),
            pan: Pan::new(sample_rate, Placement::of(id).side()),
            peak: 0.0,
        });
        Kit { slots, master: Gain::new(sample_rate), clock: 0, dropped_strikes: 0, peak: [0.0; 2] }
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
        let former = slot.piece.replace(piece)?;
        slot.leaving.see_off(former)
    }

    /// Hands back a replaced piece that has faded out, to be dropped elsewhere; one a call.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn retire(&mut self) -> Option<Box<Piece>> {
        self.slots.iter_mut().find_map(|slot| slot.leaving.gone())
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

    /// Lets a hand take hold of a cymbal, firmly at 1, or let go of it, 0; see [`Piece::choke`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, id: PieceId, strength: f64) {
        if let Some(piece) = id.slot().and_then(|slot| self.slots[slot].piece.as_mut())
            && !strength.is_nan()
        {
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
        match control {
            Control::Master => self.master.set_db(value),
            Control::Level(id) => {
                if let Some(slot) = id.slot() {
                    self.slots[slot].level.set_db(value);
                }
            }
            Control::Pan(id) => {
                if let Some(slot) = id.slot() {
                    self.slots[slot].pan.set(value);
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
        self.master.jump();
        for slot in &mut self.slots {
            slot.level.jump();
            slot.pan.jump();
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
        self.render_outputs([left, right], &mut []);
    }

    /// [`render`](Self::render), and in the same pass each piece by itself.
    ///
    /// `pieces` are in the order of [`PieceId::KIT`]: with their level and pan, before the master. Pairs
    /// that are left out at the end, or shorter than the main one, are not written: an output that
    /// nobody listens to is a pair of empty slices. What is written to `main` does not depend on them.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, main: Stereo<'_>, pieces: &mut [Stereo<'_>]) {
        let [left, right] = main;
        let frames = left.len().min(right.len());
        let mut done = 0;
        while done < frames {
            let phase = (self.clock % BLOCK as u64) as usize;
            let run = done..done + (frames - done).min(BLOCK - phase);
            self.render_run([&mut left[run.clone()], &mut right[run.clone()]], pieces, run.start);
            self.clock += run.len() as u64;
            done = run.end;
        }
    }

    /// Renders within one block; pieces are written from sample `at` on.
    fn render_run(&mut self, main: Stereo<'_>, pieces: &mut [Stereo<'_>], at: usize) {
        let [left, right] = main;
        left.fill(0.0);
        right.fill(0.0);
        let mut pieces = pieces.iter_mut();
        let mut shares = [[0.0_f32; BLOCK]; 3];
        let [sound, mut shares @ ..] = shares.each_mut().map(|row| &mut row[..left.len()]);
        for slot in &mut self.slots {
            // Levels move even where nothing plays yet: when a piece is ready must not matter.
            match &mut slot.piece {
                Some(piece) => piece.render(sound),
                None => sound.fill(0.0),
            }
            slot.leaving.render(sound);
            for (i, sound) in sound.iter().enumerate() {
                let sound = sound * (slot.level.next() / FULL_SCALE);
                slot.peak = slot.peak.max(sound.abs());
                for (share, gain) in shares.iter_mut().zip(slot.pan.next()) {
                    share[i] = gain * sound;
                }
            }
            let alone = pieces.next().into_iter().flatten();
            for (alone, share) in alone.zip(&shares) {
                if let Some(alone) = alone.get_mut(at..at + share.len()) {
                    alone.copy_from_slice(share);
                }
            }
            for (sum, share) in [&mut *left, &mut *right].into_iter().zip(&shares) {
                sum.iter_mut().zip(share.iter()).for_each(|(sum, share)| *sum += share);
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
            slot.leaving.cut();
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
