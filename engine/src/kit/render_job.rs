//! A piece at its post: what it needs for a run and what it leaves.
//!
//! Within a run no piece can hear another: whatever it hears was sent before. So posts can be rendered in any
//! order and on any thread; whoever does it is a [`RenderWorkers`].

use super::fade_out::FadeOut;
use crate::block::BLOCK;
use crate::modal::RECEIVERS;
use crate::piece::Piece;

/// A piece with its run.
pub struct RenderJob {
    pub(super) piece: Option<Box<Piece>>,
    /// What it has replaced.
    pub(super) leaving: FadeOut,
    /// Resets of the kit that it knows of.
    resets: u32,
    /// When the run begins, and its samples.
    pub(super) due: u64,
    pub(super) run: usize,
    /// Whether anything arrives.
    pub(super) hears: bool,
    /// Pressure that arrives, Pa.
    pub(super) incident: [f32; BLOCK],
    /// What it sends out: at the close microphone, far away as at a metre, and to other pieces as at a metre, Pa.
    pub(super) sound: [[f32; BLOCK]; RECEIVERS],
}

impl RenderJob {
    pub(super) fn new(sample_rate: f64) -> RenderJob {
        RenderJob {
            piece: None,
            leaving: FadeOut::new(sample_rate),
            resets: 0,
            due: 0,
            run: 0,
            hears: false,
            incident: [0.0; BLOCK],
            sound: [[0.0; BLOCK]; RECEIVERS],
        }
    }

    /// Gets ready for a run of the kit's clock, which has been reset so many times.
    pub(super) fn prepare(&mut self, resets: u32, clock: u64, samples: usize) {
        self.reset(resets);
        // Not so if it has come back late, or after a reset.
        if self.due.wrapping_add(self.run as u64) != clock {
            let phase = (clock % BLOCK as u64) as usize;
            self.piece.iter_mut().for_each(|piece| piece.align(phase));
            self.leaving.cut();
        }
        (self.due, self.run, self.hears) = (clock, samples, false);
    }

    /// Puts everything to rest if the kit has been reset more often than is known here.
    pub(super) fn reset(&mut self, resets: u32) {
        if std::mem::replace(&mut self.resets, resets) == resets {
            return;
        }
        self.piece.iter_mut().for_each(|piece| piece.reset());
        self.leaving.cut();
    }

    /// Renders the run.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self) {
        let RenderJob { piece, leaving, run, hears, incident, sound, .. } = self;
        let out = sound.each_mut().map(|row| &mut row[..*run]);
        match piece {
            Some(piece) => piece.render_in_air(out, hears.then_some(&incident[..*run])),
            None => out.into_iter().for_each(|out| out.fill(0.0)),
        }
        leaving.render(sound.each_mut().map(|row| &mut row[..*run]));
    }

    /// Whether there is no piece, and none that leaves.
    pub(super) fn is_empty(&self) -> bool {
        self.piece.is_none() && self.leaving.is_over()
    }

    /// Whether nothing comes from it and nothing leaves.
    pub(super) fn is_asleep(&self) -> bool {
        self.leaving.is_over() && self.piece.as_ref().is_none_or(|piece| piece.is_asleep())
    }

    /// Says that the run could not be rendered: the piece is silent for it, and the kit counts that.
    pub fn give_up(&mut self) {
        self.due = u64::MAX;
        self.run = 0;
    }

    /// Whether there is something to do that is worth handing over.
    pub fn is_busy(&self) -> bool {
        self.hears || !self.is_asleep()
    }
}

/// Whoever renders posts.
pub trait RenderWorkers: Send {
    /// Renders every post. All that are there at the start must be back at the end; one that is not is silent for
    /// the run and for as long as it stays away.
    ///
    /// # Real-time
    /// Called by the audio thread: must not allocate, lock, call the system or wait for long.
    fn render(&mut self, posts: &mut [Option<Box<RenderJob>>]);
}
