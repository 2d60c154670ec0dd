//! Rendering of a kit, run by run: pieces, propagation, mix.

use crate::block::{BLOCK, SILENT_RUN};
use crate::kit_spec::Kind;
use crate::receiver::DIRECTIONS;
use crate::slot::SLOTS;

use super::Kit;
use super::mixer::{Bus, PAIRS, Routing, Stereo};

/// Blocks between two checks for silence of the room.
const SETTLE_BLOCKS: u64 = 128;

impl Kit {
    /// Renders both outputs, full scale 1, overwriting them. Any length; both the same.
    ///
    /// The same strikes and controls at the same samples give the same output for any length of the calls.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.render_outputs([left, right], &mut []);
    }

    /// [`render`](Self::render), and in the same pass each piece by itself.
    ///
    /// `outputs` are the close microphones of all [`SLOTS`], then the overheads, then the room, before the
    /// master: their sum is the input of the master. Pairs that are missing at the end, or shorter than the main
    /// one, are not written: an unused output is a pair of empty slices. `main` does not depend on them.
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
        let still = self.is_asleep() && self.mixer.rests() && self.coupling.rests();
        self.render_jobs(samples);
        // Asleep before and asleep after: nothing but silence has been sent.
        if still && self.is_asleep() {
            for side in outputs.iter_mut().flatten() {
                side.get_mut(at..at + samples).into_iter().for_each(|side| side.fill(0.0));
            }
            return;
        }
        let Kit { jobs, air, mixer, clock, missed_runs, .. } = self;
        // Levels move even where nothing plays yet: the time at which a piece is ready must not matter.
        let levels = mixer.levels(samples);
        let mut bus = Bus { mix, master: mixer.master(samples), routing };
        let mut outputs = outputs
            .iter_mut()
            .map(|output| output.each_mut().map(|side| side.get_mut(at..at + samples).unwrap_or_default()));
        let mut sent = [SILENT_RUN; DIRECTIONS];
        for (slot, job) in jobs.iter().enumerate() {
            if job.as_ref().is_some_and(|job| job.is_empty()) && air.is_slot_silent(slot) {
                for side in outputs.next().into_iter().flatten() {
                    side.fill(0.0);
                }
                continue;
            }
            // A job that came back late has the sound of an earlier run.
            match job.as_ref().filter(|job| job.due == *clock) {
                Some(job) => {
                    air.send(slot, *clock, job);
                    for (sent, sound) in sent.iter_mut().zip(&job.sound[1..]) {
                        let terms = sent.iter_mut().zip(sound).zip(&levels[slot]);
                        terms.take(samples).for_each(|((sum, sound), level)| *sum += level * sound);
                    }
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
            mixer.add(slot, [sound, sound], &mut bus, outputs.next());
        }
        for pair in 0..PAIRS {
            let mut sides = air.pair(pair, *clock, samples, &levels, mixer);
            if pair + 1 == PAIRS && !mixer.is_shut(pair) {
                air.tail(sent.each_ref().map(|sent| &sent[..samples]), &mut sides);
            }
            let [left, right] = sides.each_ref().map(|side| &side[..samples]);
            mixer.add(SLOTS + pair, [left, right], &mut bus, outputs.next());
        }
        mixer.finish(&mut bus);
    }

    /// Passes every piece the sound of the others and renders it.
    fn render_jobs(&mut self, samples: usize) {
        let uncoupled = self.coupling.is_shut();
        let amount = self.coupling.run(samples);
        for (slot, job) in self.jobs.iter_mut().enumerate() {
            let Some(job) = job else { continue };
            job.prepare(self.clock, samples);
            let receives = job.piece.as_ref().is_some_and(|piece| piece.kind() == Kind::Drum);
            if receives && !uncoupled {
                self.air.arrive(slot, self.clock, &amount, job);
            }
        }
        match &mut self.workers {
            Some(workers) => workers.render(&mut self.jobs),
            None => self.jobs.iter_mut().flatten().for_each(|job| job.render()),
        }
        // Before anything strikes it: a job that was away during a reset follows it now.
        self.jobs.iter_mut().flatten().for_each(|job| job.reset(self.resets));
    }
}
