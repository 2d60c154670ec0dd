//! One run after another: pieces rendered, sound sent on its way, microphones mixed.

use crate::block::BLOCK;
use crate::kit_spec::Kind;
use crate::slot::SLOTS;

use super::Kit;
use super::mixer::{Bus, PAIRS, Routing, Stereo};

/// The silence of the room is looked for once in so many blocks.
const SETTLE_BLOCKS: u64 = 128;

impl Kit {
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
    /// `outputs` are the close microphones of all [`SLOTS`], then the overheads, then the room, before the
    /// master: they add up to what the master gets. Pairs that are left out at the end, or shorter than the main
    /// one, are not written: an output that nobody listens to is a pair of empty slices. What is written to
    /// `main` does not depend on them.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        self.render_routed(Routing::Copies, main, outputs);
    }

    /// [`render_outputs`](Self::render_outputs), by a routing: what has an output of its own may leave `main` for it.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_routed(&mut self, routing: Routing, main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        let [left, right] = main;
        let frames = left.len().min(right.len());
        let longest = self.min_delay();
        let mut done = 0;
        while done < frames {
            let phase = (self.clock % BLOCK as u64) as usize;
            let run = done..done + (frames - done).min(BLOCK - phase).min(longest);
            if phase == 0 && self.clock.is_multiple_of(SETTLE_BLOCKS * BLOCK as u64) {
                self.air.settle();
            }
            let mix = [&mut left[run.clone()], &mut right[run.clone()]];
            self.render_run(routing, mix, outputs, run.start);
            self.clock += run.len() as u64;
            done = run.end;
        }
    }

    /// Renders within one block; outputs are written from sample `at` on.
    fn render_run(&mut self, routing: Routing, mut mix: Stereo<'_>, outputs: &mut [Stereo<'_>], at: usize) {
        let samples = mix[0].len();
        mix.iter_mut().for_each(|side| side.fill(0.0));
        let still = self.is_asleep() && self.desk.rests() && self.ears.rests();
        self.render_posts(samples);
        // Asleep before and asleep after: nothing but silence has been sent.
        if still && self.is_asleep() {
            for side in outputs.iter_mut().flatten() {
                side.get_mut(at..at + samples).into_iter().for_each(|side| side.fill(0.0));
            }
            return;
        }
        let Kit { posts, air, desk, clock, missed_runs, .. } = self;
        // Levels move even where nothing plays yet: when a piece is ready must not matter.
        let levels = desk.levels(samples);
        let mut bus = Bus { mix, master: desk.master(samples), routing };
        let mut outputs = outputs
            .iter_mut()
            .map(|output| output.each_mut().map(|side| side.get_mut(at..at + samples).unwrap_or_default()));
        let mut sent = [0.0; BLOCK];
        for (slot, post) in posts.iter().enumerate() {
            if post.as_ref().is_some_and(|post| post.is_empty()) && air.is_slot_silent(slot) {
                for side in outputs.next().into_iter().flatten() {
                    side.fill(0.0);
                }
                continue;
            }
            // One that has come back late has the sound of an earlier run.
            match post.as_ref().filter(|post| post.due == *clock) {
                Some(post) => {
                    air.send(slot, *clock, post);
                    let terms = sent.iter_mut().zip(&post.sound[1]).zip(&levels[slot]);
                    terms.take(samples).for_each(|((sum, sound), level)| *sum += level * sound);
                }
                None => {
                    air.send_silence(slot, *clock, samples);
                    *missed_runs = missed_runs.saturating_add(1);
                }
            }
            let mut sound = [0.0; BLOCK];
            let sound = &mut sound[..samples];
            air.close(slot, *clock, sound);
            sound.iter_mut().zip(&levels[slot]).for_each(|(sound, level)| *sound *= level);
            desk.add(slot, [sound, sound], &mut bus, outputs.next());
        }
        for pair in 0..PAIRS {
            let mut heard = air.pair(pair, *clock, samples, &levels, desk);
            if pair + 1 == PAIRS && !desk.is_shut(pair) {
                air.tail(&sent[..samples], &mut heard);
            }
            let [left, right] = heard.each_ref().map(|side| &side[..samples]);
            desk.add(SLOTS + pair, [left, right], &mut bus, outputs.next());
        }
        desk.finish(&mut bus);
    }

    /// Lets every piece hear the others and renders it.
    fn render_posts(&mut self, samples: usize) {
        let uncoupled = self.ears.is_shut();
        let amount = self.ears.run(samples);
        for (slot, post) in self.posts.iter_mut().enumerate() {
            let Some(post) = post else { continue };
            post.prepare(self.resets, self.clock, samples);
            let listens = post.piece.as_ref().is_some_and(|piece| piece.kind() == Kind::Drum);
            if listens && !uncoupled {
                self.air.arrive(slot, self.clock, &amount, post);
            }
        }
        match &mut self.workers {
            Some(workers) => workers.render(&mut self.posts),
            None => self.posts.iter_mut().flatten().for_each(|post| post.render()),
        }
    }
}
