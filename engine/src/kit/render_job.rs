//! Render jobs: a piece with the input and output of one run.
//!
//! Within a run no sound of one piece reaches another. Jobs can therefore be rendered in any order and on any thread.
//! [`RenderWorkers`] render them.

use super::fade_out::FadeOut;
use crate::block::BLOCK;
use crate::modal::RECEIVERS;
use crate::piece::Piece;

/// A piece with its run.
pub struct RenderJob {
    pub(super) piece: Option<Box<Piece>>,
    /// The piece it has replaced.
    pub(super) fade_out: FadeOut,
    /// Resets of the kit that it has followed.
    resets: u32,
    /// Start of the run on the kit's clock, and its length in samples.
    pub(super) due: u64,
    pub(super) run: usize,
    /// Whether sound arrives from other pieces.
    pub(super) receives: bool,
    /// Pressure of that sound, Pa.
    pub(super) incident: [f32; BLOCK],
    /// Sound of the piece: at the close microphone, in the far field at a metre in each direction, and to other pieces at a metre, Pa.
    pub(super) sound: [[f32; BLOCK]; RECEIVERS],
}

impl RenderJob {
    pub(super) fn new(sample_rate: f64) -> RenderJob {
        RenderJob {
            piece: None,
            fade_out: FadeOut::new(sample_rate),
            resets: 0,
            due: 0,
            run: 0,
            receives: false,
            incident: [0.0; BLOCK],
            sound: [[0.0; BLOCK]; RECEIVERS],
        }
    }

    /// Prepares a run at `clock`.
    pub(super) fn prepare(&mut self, clock: u64, samples: usize) {
        // The run before is missing if the job came back late, or after a reset.
        if self.due.wrapping_add(self.run as u64) != clock {
            let phase = (clock % BLOCK as u64) as usize;
            self.piece.iter_mut().for_each(|piece| piece.align(phase));
            self.fade_out.cut();
        }
        (self.due, self.run, self.receives) = (clock, samples, false);
    }

    /// Puts everything to rest if the kit, by now reset `resets` times, has been since the last call.
    pub(super) fn reset(&mut self, resets: u32) {
        if std::mem::replace(&mut self.resets, resets) == resets {
            return;
        }
        self.piece.iter_mut().for_each(|piece| piece.reset());
        self.fade_out.cut();
        // The kit's new clock may come to where this run ends: it is none of its runs.
        self.give_up();
    }

    /// Renders the run.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self) {
        let RenderJob { piece, fade_out, run, receives, incident, sound, .. } = self;
        let out = sound.each_mut().map(|row| &mut row[..*run]);
        match piece {
            Some(piece) => piece.render_in_air(out, receives.then_some(&incident[..*run])),
            None => out.into_iter().for_each(|out| out.fill(0.0)),
        }
        fade_out.render(sound.each_mut().map(|row| &mut row[..*run]));
    }

    /// Whether there is no piece, and none that fades out.
    pub(super) fn is_empty(&self) -> bool {
        self.piece.is_none() && self.fade_out.is_over()
    }

    /// Whether the piece is asleep and none fades out.
    pub(super) fn is_asleep(&self) -> bool {
        self.fade_out.is_over() && self.piece.as_ref().is_none_or(|piece| piece.is_asleep())
    }

    /// Marks the run as not rendered. The piece is silent for it, and the kit counts that.
    pub fn give_up(&mut self) {
        self.due = u64::MAX;
        self.run = 0;
    }

    /// Whether the run has work that is worth handing to a worker.
    pub fn is_busy(&self) -> bool {
        self.receives || !self.is_asleep()
    }
}

/// Renders jobs, on one thread or several.
pub trait RenderWorkers: Send {
    /// Renders every job. All jobs present at the start must be present at the end. A piece whose job is missing is silent
    /// until the job is back.
    ///
    /// # Real-time
    /// Called by the audio thread: must not allocate, lock, call the system or wait for long.
    fn render(&mut self, jobs: &mut [Option<Box<RenderJob>>]);
}
