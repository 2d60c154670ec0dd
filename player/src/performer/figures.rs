//! Strokes of flams and rolls, each at its sample.

use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::slot::Slot;

use super::Performer;
use super::sounding::parts;
use crate::midi::figures::Running;
use crate::midi::playing::Played;

impl Performer {
    /// Begins what a stroke is the beginning of, and gives the stroke itself.
    pub(super) fn begin_figure(&mut self, played: Played, note: (u8, f32, u8)) -> Played {
        let beat = played.figure.and_then(|figure| Some((figure, figure.stroke(0)?)));
        self.figures[played.slot.index()] =
            beat.map(|(figure, beat)| Running { note, figure, number: 1, due: self.samples(beat.gap) });
        beat.map_or(played, |(_, beat)| scaled(played, beat.speed))
    }

    /// Ends the rolls of a note. A flam is over with its second stroke.
    pub(super) fn end_figures(&mut self, note: u8, channel: u8) {
        if self.playing.hears(channel) {
            let ends = |figure: &Running| figure.note.0 == note && figure.figure.stroke(u32::MAX).is_some();
            self.figures
                .iter_mut()
                .filter(|figure| figure.as_ref().is_some_and(ends))
                .for_each(|figure| *figure = None);
        }
    }

    fn samples(&self, seconds: f64) -> usize {
        // Infinity is as far as samples can be counted.
        ((seconds * self.sample_rate).round() as usize).max(1)
    }

    /// Renders with the strokes of figures in between.
    pub(super) fn render_figures(&mut self, main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        let samples = main[0].len().min(main[1].len());
        let count = outputs.len().min(OUTPUTS);
        let [left, right] = main;
        let mut done = 0;
        while done < samples {
            let next = self.figures.iter().flatten().map(|figure| figure.due).min();
            let end = next.map_or(samples, |due| samples.min(done.saturating_add(due)));
            let mut others = parts(outputs, done..end);
            self.render_stretch([&mut left[done..end], &mut right[done..end]], &mut others[..count]);
            for slot in Slot::ALL {
                if let Some(figure) = &mut self.figures[slot.index()] {
                    figure.due -= end - done;
                    if figure.due == 0 {
                        self.go_on(slot);
                    }
                }
            }
            done = end;
        }
    }

    /// Plays the next stroke of a slot's figure.
    fn go_on(&mut self, slot: Slot) {
        let Some(running) = self.figures[slot.index()].take() else { return };
        let Some(beat) = running.figure.stroke(running.number) else { return };
        if beat.bounces {
            self.playing.hold_hand();
        }
        let (note, velocity, channel) = running.note;
        if let Some(played) = self.playing.note_on(note, velocity, channel) {
            self.play(&scaled(played, beat.speed));
            let (number, due) = (running.number + 1, self.samples(beat.gap));
            if running.figure.stroke(number).is_some() {
                self.figures[slot.index()] = Some(Running { number, due, ..running });
            }
        }
    }
}

/// A stroke at another speed, a ratio.
fn scaled(mut played: Played, speed: f64) -> Played {
    played.strike.speed *= speed;
    played
}
