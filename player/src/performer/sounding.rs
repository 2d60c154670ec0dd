//! Rendering, and the end of everything that sounds.

use overhear_engine::kit::{OUTPUTS, Routing, Stereo};
use overhear_engine::slot::Slot;

use super::{Performer, flushed};

/// How long everything takes to fall silent, s. *By ear*: no click, and over before the next stroke of a roll.
const FADE: f64 = 0.01;

/// The fade of everything that sounds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Silencing {
    /// Samples of a whole fade.
    length: usize,
    /// Samples to go; nothing where no fade runs.
    rest: usize,
}

impl Silencing {
    /// No fade, at a sample rate, Hz.
    pub(super) fn new(sample_rate: f64) -> Silencing {
        Silencing { length: ((FADE * sample_rate) as usize).max(1), rest: 0 }
    }

    /// Fades samples that come next.
    fn fade(&self, samples: &mut [f32]) {
        for (sample, rest) in samples.iter_mut().zip((0..self.rest).rev()) {
            *sample *= rest as f32 / self.length as f32;
        }
    }
}

impl Performer {
    /// Renders both outputs, full scale 1, overwriting them. Any length, both the same; the cut
    /// into calls does not change the samples.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.render_outputs([left, right], &mut []);
    }

    /// [`render`](Self::render), and each slot's piece and the pairs of microphones to outputs of their own; see
    /// [`Kit::render_routed`](overhear_engine::kit::Kit::render_routed).
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, mut main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        self.start();
        let frames = main[0].len().min(main[1].len());
        let fading = self.silencing.rest.min(frames);
        if fading == 0 {
            flushed(|| self.kit.render_routed(self.routing, main, outputs));
            return;
        }
        let count = outputs.len().min(OUTPUTS);
        let mut heads: [Stereo<'_>; OUTPUTS] = std::array::from_fn(|_| Stereo::default());
        for (head, output) in heads.iter_mut().zip(&mut *outputs) {
            *head = output.each_mut().map(|side| side.get_mut(..fading).unwrap_or_default());
        }
        let head = main.each_mut().map(|side| &mut side[..fading]);
        flushed(|| self.kit.render_routed(self.routing, head, &mut heads[..count]));
        let sides = main.iter_mut().map(|side| &mut side[..fading]);
        for side in sides.chain(heads.into_iter().flatten()) {
            self.silencing.fade(side);
        }
        self.silencing.rest -= fading;
        if self.silencing.rest == 0 {
            self.end_all();
        }
        if fading < frames {
            let rest = main.map(|side| &mut side[fading..]);
            let mut tails: [Stereo<'_>; OUTPUTS] = std::array::from_fn(|_| Stereo::default());
            for (tail, output) in tails.iter_mut().zip(outputs) {
                *tail = output.each_mut().map(|side| side.get_mut(fading..).unwrap_or_default());
            }
            flushed(|| self.kit.render_routed(self.routing, rest, &mut tails[..count]));
        }
    }

    /// Says what outputs of their own are to the mix, from the next sample on: copies at first.
    pub fn route(&mut self, routing: Routing) {
        self.routing = routing;
    }

    /// Fades all that sounds within ten milliseconds and puts every piece to rest; feet and parameters stay where they are.
    pub(super) fn silence(&mut self) {
        if self.started && self.silencing.rest == 0 {
            self.silencing.rest = self.silencing.length;
        }
    }

    /// Ends a fade at once, if one runs: what is struck now must not fade.
    pub(super) fn finish_silence(&mut self) {
        if std::mem::take(&mut self.silencing.rest) > 0 {
            self.end_all();
        }
    }

    /// Puts every piece to rest.
    fn end_all(&mut self) {
        Slot::ALL.into_iter().for_each(|slot| self.bend_piece(slot, 0.0));
        self.playing.let_go();
        flushed(|| {
            Slot::ALL.into_iter().for_each(|slot| self.kit.choke(slot, 0.0));
            self.kit.reset();
        });
    }

    /// No fade runs any more: whatever it was to end has been put to rest.
    pub(super) fn forget_silence(&mut self) {
        self.silencing.rest = 0;
    }
}
