//! Ringing that is taken from both cymbals at once, and is heard for a moment more.
//!
//! Model: what both shells would have sounded by themselves, faded along a straight line. It belongs to no mode: a stroke in
//! that moment meets cymbals at rest, and loses nothing to the fade.

use crate::modal::simd::MAX_RUN;
use crate::modal::{Pressure, RECEIVERS};
use crate::surface::attachment::Site;
use crate::surface::body::SoundingBody;

/// Time in which what is heard of it fades, s. *Converged*: steps between samples are a third of those of the ringing at most.
const FADE: f64 = 2.5e-4;

/// What is still heard of ringing that was taken.
pub(crate) struct Fading {
    /// Pressure at each receiver, Pa, `[sample]`.
    rows: [Vec<f32>; RECEIVERS],
    /// Samples of it that were heard.
    at: usize,
}

impl Fading {
    /// Nothing to be heard, a sample lasting `dt` s. Allocates.
    pub(crate) fn new(dt: f64) -> Fading {
        let samples = (FADE / dt).round().max(1.0) as usize;
        Fading { rows: std::array::from_fn(|_| vec![0.0; samples]), at: samples }
    }

    /// Takes all ringing of the upper cymbal, and of the lower one. Strikers move along.
    ///
    /// # Real-time
    /// Linear in the number of modes, at the cost of the samples of the fade.
    pub(crate) fn take(&mut self, site: &mut Site<'_>, lower: &mut SoundingBody) {
        let samples = self.rows[0].len();
        for row in &mut self.rows {
            row.rotate_left(self.at % samples);
            row[samples - self.at..].fill(0.0);
        }
        self.at = 0;
        site.contacts.carry_by(site.body, |body| {
            for SoundingBody { modal, receiver } in [body.sound_mut(), lower] {
                for from in (0..samples).step_by(MAX_RUN) {
                    let run = MAX_RUN.min(samples - from);
                    let mut heard = [[0.0; MAX_RUN]; RECEIVERS];
                    modal.ring(0, receiver, heard.each_mut().map(|row| &mut row[..run]));
                    for (row, heard) in self.rows.iter_mut().zip(&heard) {
                        for (n, (sum, heard)) in row[from..].iter_mut().zip(&heard[..run]).enumerate() {
                            *sum += heard * (samples - from - n) as f32 / (samples + 1) as f32;
                        }
                    }
                }
            }
            body.reset();
        });
        lower.modal.reset();
    }

    /// What is heard of it in the next sample, Pa.
    pub(crate) fn next(&mut self) -> Pressure {
        if self.is_over() {
            return Pressure::default();
        }
        self.at += 1;
        self.rows.each_ref().map(|row| row[self.at - 1])
    }

    /// Adds what is heard of it to the next samples, Pa.
    pub(crate) fn add_to(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        for sample in 0..out[0].len() {
            if self.is_over() {
                return;
            }
            out.iter_mut().zip(self.next()).for_each(|(out, heard)| out[sample] += heard);
        }
    }

    /// Whether nothing is heard of it any more.
    pub(crate) fn is_over(&self) -> bool {
        self.at == self.rows[0].len()
    }

    /// Is heard no more.
    pub(crate) fn reset(&mut self) {
        self.at = self.rows[0].len();
    }
}
