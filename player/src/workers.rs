//! Worker threads that render the pieces of a kit beside the audio thread.
//!
//! Hand-off: two bounded queues without locks. For every run the audio thread puts the jobs ([`RenderJob`]) that have something to
//! do on one queue. The thread that takes a job owns it, renders it, and puts it on the other. The audio thread takes jobs from the
//! first queue until it is empty, as a worker does. So a job that no worker has claimed is done in any case. Then it waits for
//! the claimed ones. Nothing is shared but the queues: the compiler proves that no job is ever in two hands, and there is no
//! unsafe code here or in the engine. What the queues do inside (crossbeam's `ArrayQueue`) is taken on trust; docs/kit.md has
//! the argument.
//!
//! Which thread renders a job does not change a bit of it, nor does the order: within a run no piece hears another.
//!
//! The wait: a worker that stalls, because the system has taken its core away, holds one job at most. While the host plays, the
//! audio thread waits for the jobs of the present run, and no longer than the [`Deadline`] of the present buffer allows. It
//! cannot render a claimed job itself, as the worker owns the piece. A job that is not back by then is lost for the run: its
//! piece is silent, which the kit counts, the next runs do not wait for it, and the piece plays on once it is back. If every
//! job comes back in time, the sound is the same to the bit. A worker that panics gives its job back all the same.
//!
//! Waking: a parked thread is woken by a system call, which the audio thread must not make. So workers are not woken; they
//! look for work: without pause for a millisecond after they had some, then with short naps, and with longer ones once
//! the kit has been idle. Until they notice, the audio thread does the work itself.
#![forbid(unsafe_code)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::queue::ArrayQueue;
use overhear_engine::kit::{RenderJob, RenderWorkers};
use overhear_engine::slot::SLOTS;

/// Most workers.
pub const MOST: usize = 3;

/// Looks at the queue before a worker naps. *Derived*: about a millisecond.
const LOOKS: u32 = 20_000;

/// A nap while the kit plays, and once nothing has come for [`IDLE`]: a tenth of a percent of a core.
const NAP: Duration = Duration::from_micros(200);
const LONG_NAP: Duration = Duration::from_millis(5);
const IDLE: Duration = Duration::from_secs(1);

/// How long the audio thread waits for a job that a worker has claimed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Patience {
    /// Until the [`Deadline`], or some milliseconds where there is none; then the piece is silent for the run.
    RealTime,
    /// Until it is done, or half a minute has passed: while a file is rendered.
    Offline,
}

impl Patience {
    /// Looks before giving up. *Derived*: one takes 10 to 60 ns.
    const fn looks(self) -> u64 {
        match self {
            Patience::RealTime => 100_000,
            Patience::Offline => 1_000_000_000,
        }
    }
}

/// Knows how long the audio thread may wait in the present buffer.
pub trait Deadline: Send + Sync {
    /// Whether the audio thread must wait no longer.
    ///
    /// # Real-time
    /// Asked in a loop by the audio thread: must not allocate, lock or call the system.
    fn is_over(&self) -> bool;
}

/// A job with its slot and its run.
struct JobSlot {
    slot: usize,
    run: u64,
    job: Box<RenderJob>,
}

/// What the threads share.
struct Shared {
    waiting: ArrayQueue<JobSlot>,
    done: ArrayQueue<JobSlot>,
    closing: AtomicBool,
    render: fn(&mut RenderJob),
}

/// Some workers. Dropping them waits until they have left: not for the audio thread.
pub struct Workers {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
    patience: Patience,
    deadline: Option<Arc<dyn Deadline>>,
    /// Counts runs.
    run: u64,
    /// Jobs of the present run that others have.
    away: usize,
}

impl Workers {
    /// So many workers, at most [`MOST`], who render jobs by `render`: [`RenderJob::render`], perhaps with the floating point
    /// mode of the audio thread, which they must share to get the same bits. Allocates and starts threads.
    ///
    /// # Errors
    /// If the system starts no more threads.
    pub fn new(count: usize, patience: Patience, render: fn(&mut RenderJob)) -> std::io::Result<Workers> {
        let shared = Arc::new(Shared {
            waiting: ArrayQueue::new(SLOTS),
            done: ArrayQueue::new(SLOTS),
            closing: AtomicBool::new(false),
            render,
        });
        let mut workers = Workers { shared, threads: Vec::new(), patience, deadline: None, run: 0, away: 0 };
        for number in 1..=count.min(MOST) {
            let shared = Arc::clone(&workers.shared);
            let thread = thread::Builder::new().name(format!("overhear worker {number}"));
            workers.threads.push(thread.spawn(move || work(&shared))?);
        }
        Ok(workers)
    }

    /// Workers for whom the audio thread waits no longer than a deadline allows, unless it renders a file.
    pub fn until(mut self, deadline: Arc<dyn Deadline>) -> Workers {
        self.deadline = Some(deadline);
        self
    }

    /// Takes back one job that is done, if there is one.
    fn take_back(&mut self, jobs: &mut [Option<Box<RenderJob>>]) -> bool {
        let Some(JobSlot { slot, run, job }) = self.shared.done.pop() else {
            return false;
        };
        // One of an earlier run is not waited for any more.
        self.away -= usize::from(run == self.run);
        jobs[slot] = Some(job);
        true
    }

    /// Waits for the jobs of this run that others have, as long as the deadline and the patience allow.
    fn wait(&mut self, jobs: &mut [Option<Box<RenderJob>>]) {
        let mut looks = 0;
        loop {
            while self.take_back(jobs) {}
            if self.away == 0 || looks == self.patience.looks() || self.is_late() {
                return;
            }
            looks += 1;
            std::hint::spin_loop();
        }
    }

    fn is_late(&self) -> bool {
        let awaited = self.patience == Patience::RealTime;
        awaited && self.deadline.as_ref().is_some_and(|deadline| deadline.is_over())
    }
}

impl RenderWorkers for Workers {
    fn render(&mut self, jobs: &mut [Option<Box<RenderJob>>]) {
        let busy = |job: &Option<Box<RenderJob>>| job.as_ref().is_some_and(|job| job.is_busy());
        let share = jobs.iter().filter(|&job| busy(job)).count() > 1;
        self.run = self.run.wrapping_add(1);
        self.away = 0;
        for (slot, place) in jobs.iter_mut().enumerate() {
            let shared = share && busy(place);
            match place.take() {
                Some(job) if shared => match self.shared.waiting.push(JobSlot { slot, run: self.run, job }) {
                    Ok(()) => self.away += 1,
                    // There is room for every job; if there were not, it would be done here.
                    Err(JobSlot { mut job, .. }) => {
                        (self.shared.render)(&mut job);
                        *place = Some(job);
                    }
                },
                Some(mut job) => {
                    (self.shared.render)(&mut job);
                    *place = Some(job);
                }
                None => {}
            }
        }
        while let Some(JobSlot { slot, mut job, .. }) = self.shared.waiting.pop() {
            (self.shared.render)(&mut job);
            jobs[slot] = Some(job);
            self.away -= 1;
        }
        self.wait(jobs);
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        self.shared.closing.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // A worker that has panicked is gone as well.
            let _ = thread.join();
        }
    }
}

/// What a worker does until it is told to end.
fn work(shared: &Shared) {
    let (mut looks, mut latest) = (0, Instant::now());
    while !shared.closing.load(Ordering::Relaxed) {
        if let Some(mut claimed) = shared.waiting.pop() {
            // The job goes back whatever happens: without it its piece would be gone.
            if catch_unwind(AssertUnwindSafe(|| (shared.render)(&mut claimed.job))).is_err() {
                claimed.job.give_up();
            }
            // There is room for every job.
            let _ = shared.done.push(claimed);
            (looks, latest) = (0, Instant::now());
        } else if looks < LOOKS {
            looks += 1;
            std::hint::spin_loop();
        } else {
            thread::sleep(if latest.elapsed() < IDLE { NAP } else { LONG_NAP });
        }
    }
}

#[cfg(test)]
mod tests;
