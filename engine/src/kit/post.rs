//! A piece at its post: what it needs for a run and what it leaves.
//!
//! Within a run no piece can hear another: whatever it hears was sent before. So posts can be rendered in any
//! order and on any thread; whoever does it is a [`Crew`].

use super::BLOCK;
use super::leaving::Leaving;
use crate::modal::EARS;
use crate::piece::Piece;

/// A piece with its run.
pub struct Post {
    pub(super) piece: Option<Box<Piece>>,
    /// What it has replaced.
    pub(super) leaving: Leaving,
    /// Samples of the run.
    pub(super) run: usize,
    /// Whether anything arrives.
    pub(super) hears: bool,
    /// Pressure that arrives, Pa.
    pub(super) incident: [f32; BLOCK],
    /// What it sends out: at the close microphone, far away as at a metre, and to other pieces as at a metre, Pa.
    pub(super) sound: [[f32; BLOCK]; EARS],
}

impl Post {
    pub(super) fn new(sample_rate: f64) -> Post {
        Post {
            piece: None,
            leaving: Leaving::new(sample_rate),
            run: 0,
            hears: false,
            incident: [0.0; BLOCK],
            sound: [[0.0; BLOCK]; EARS],
        }
    }

    /// Renders the run.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self) {
        let Post { piece, leaving, run, hears, incident, sound } = self;
        let out = sound.each_mut().map(|row| &mut row[..*run]);
        match piece {
            Some(piece) => piece.render_in_air(out, hears.then_some(&incident[..*run])),
            None => out.into_iter().for_each(|out| out.fill(0.0)),
        }
        leaving.render(sound.each_mut().map(|row| &mut row[..*run]));
    }

    /// Whether nothing comes out.
    pub(super) fn is_silent(&self) -> bool {
        self.sound.iter().all(|row| row[..self.run].iter().all(|&x| x == 0.0))
    }

    /// Whether there is something to do that is worth handing over.
    pub fn is_busy(&self) -> bool {
        self.piece.as_ref().is_some_and(|piece| !piece.is_asleep())
    }
}

/// Whoever renders posts.
pub trait Crew: Send {
    /// Renders every post. All that are there at the start must be back at the end; one that is not is silent for
    /// the run and for as long as it stays away.
    ///
    /// # Real-time
    /// Called by the audio thread: must not allocate, lock, call the system or wait for long.
    fn render(&mut self, posts: &mut [Option<Box<Post>>]);
}
