//! Fade-out of a piece that another one has replaced.

use crate::block::BLOCK;
use crate::modal::RECEIVERS;
use crate::piece::Piece;

/// Length of the fade, s. *By ear*: no click, even of a kick; over before a new stroke has decayed.
const FADE_TIME: f64 = 0.05;

/// The piece that fades out, if there is one.
pub struct FadeOut {
    piece: Option<Box<Piece>>,
    /// Samples left.
    left: u32,
    /// Length of the fade, samples.
    length: u32,
}

impl FadeOut {
    /// No fade; the sample rate is in Hz.
    pub fn new(sample_rate: f64) -> FadeOut {
        FadeOut { piece: None, left: 0, length: (FADE_TIME * sample_rate).ceil() as u32 }
    }

    /// Starts the fade of a piece. Returns a piece that need not sound any longer.
    pub fn start(&mut self, piece: Box<Piece>) -> Option<Box<Piece>> {
        if piece.is_asleep() {
            return Some(piece);
        }
        self.left = self.length;
        self.piece.replace(piece)
    }

    /// Returns the piece whose fade is over.
    pub fn gone(&mut self) -> Option<Box<Piece>> {
        if self.left == 0 { self.piece.take() } else { None }
    }

    /// Whether no piece fades out.
    pub fn is_over(&self) -> bool {
        self.left == 0
    }

    /// Ends the fade.
    pub fn cut(&mut self) {
        self.left = 0;
    }

    /// Adds what still sounds at every receiver, Pa, within one block.
    pub fn render(&mut self, sound: [&mut [f32]; RECEIVERS]) {
        let Some(piece) = self.piece.as_mut().filter(|_| self.left > 0) else { return };
        let mut fading = [[0.0_f32; BLOCK]; RECEIVERS];
        let samples = sound[0].len();
        piece.render_in_air(fading.each_mut().map(|row| &mut row[..samples]), None);
        let before = self.left;
        self.left = before.saturating_sub(samples as u32);
        for (sound, fading) in sound.into_iter().zip(&fading) {
            for (i, (sound, fading)) in sound.iter_mut().zip(fading).enumerate() {
                let share = before.saturating_sub(1 + i as u32) as f32 / self.length as f32;
                // Flat at both ends: the corner of a linear fade is audible on a low drum.
                *sound += *fading * share * share * (3.0 - 2.0 * share);
            }
        }
    }
}
