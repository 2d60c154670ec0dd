//! Worker threads that render the pieces of a kit beside the audio thread.
//!
//! Hand-off: two bounded queues without locks. For every run the audio thread puts the [`Post`]s that have something to do
//! on one; whoever takes a post owns it, renders it, and puts it on the other. The audio thread takes from the first queue
//! like everybody else until it is empty, so that work which no worker has claimed is done in any case, and
//! then waits for what has been claimed. Nothing is shared but the queues: the compiler proves that no post is
//! ever in two hands, and there is no unsafe code here or in the engine. What the queues do inside
//! (crossbeam's `ArrayQueue`) is taken on trust; docs/kit.md has the argument.
//!
//! Which thread renders a post does not change a bit of it, nor does the order: within a run no piece hears
//! another.
//!
//! A worker that stalls, because the system has taken its core away, holds one post at most. After a bounded
//! wait that piece is silent for the run, which the kit counts, and plays on when it is back. A worker that panics gives its
//! post back all the same.
//!
//! Waking: a parked thread is woken by a system call, which the audio thread must not make. So workers are not woken; they
//! look for work: without pause for a millisecond after they had some, then with short naps, and with longer ones once
//! the kit has been idle. Until they notice, the audio thread does the work itself.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::queue::ArrayQueue;
use overhear_engine::kit::{Crew, Post};
use overhear_engine::slot::SLOTS;

/// Most workers.
pub const MOST: usize = 3;

/// Looks at the queue before a worker naps. *Derived*: about a millisecond.
const LOOKS: u32 = 20_000;

/// A nap while the kit plays, and once nothing has come for [`IDLE`]: a tenth of a percent of a core.
const NAP: Duration = Duration::from_micros(200);
const LONG_NAP: Duration = Duration::from_millis(5);
const IDLE: Duration = Duration::from_secs(1);

/// How long the audio thread waits for a post that a worker has claimed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Patience {
    /// Some milliseconds, then the piece is silent for the run: while somebody listens.
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

/// A post on its way, and where it belongs.
struct Errand {
    slot: usize,
    post: Box<Post>,
}

/// What the threads share.
struct Hall {
    waiting: ArrayQueue<Errand>,
    done: ArrayQueue<Errand>,
    closing: AtomicBool,
    render: fn(&mut Post),
}

/// Some workers. Dropping them waits until they have left: not for the audio thread.
pub struct Workers {
    hall: Arc<Hall>,
    threads: Vec<JoinHandle<()>>,
    patience: Patience,
    /// Posts that others have.
    away: usize,
}

impl Workers {
    /// So many workers, at most [`MOST`], who render posts by `render`: [`Post::render`], perhaps with the floating point
    /// mode of the audio thread, which they must share to get the same bits. Allocates and starts threads.
    ///
    /// # Errors
    /// If the system starts no more threads.
    pub fn new(count: usize, patience: Patience, render: fn(&mut Post)) -> std::io::Result<Workers> {
        let hall = Arc::new(Hall {
            waiting: ArrayQueue::new(SLOTS),
            done: ArrayQueue::new(SLOTS),
            closing: AtomicBool::new(false),
            render,
        });
        let mut workers = Workers { hall, threads: Vec::new(), patience, away: 0 };
        for number in 1..=count.min(MOST) {
            let hall = Arc::clone(&workers.hall);
            let thread = thread::Builder::new().name(format!("overhear worker {number}"));
            workers.threads.push(thread.spawn(move || work(&hall))?);
        }
        Ok(workers)
    }

    /// Takes back one post that is done, if there is one.
    fn take_back(&mut self, posts: &mut [Option<Box<Post>>]) -> bool {
        let Some(Errand { slot, post }) = self.hall.done.pop() else {
            return false;
        };
        self.away -= 1;
        posts[slot] = Some(post);
        true
    }
}

impl Crew for Workers {
    fn render(&mut self, posts: &mut [Option<Box<Post>>]) {
        let busy = |post: &Option<Box<Post>>| post.as_ref().is_some_and(|post| post.is_busy());
        let share = posts.iter().filter(|&post| busy(post)).count() > 1;
        for (slot, place) in posts.iter_mut().enumerate() {
            let shared = share && busy(place);
            match place.take() {
                Some(post) if shared => match self.hall.waiting.push(Errand { slot, post }) {
                    Ok(()) => self.away += 1,
                    // There is room for every post; if there were not, it would be done here.
                    Err(Errand { mut post, .. }) => {
                        (self.hall.render)(&mut post);
                        *place = Some(post);
                    }
                },
                Some(mut post) => {
                    (self.hall.render)(&mut post);
                    *place = Some(post);
                }
                None => {}
            }
        }
        while let Some(Errand { slot, mut post }) = self.hall.waiting.pop() {
            (self.hall.render)(&mut post);
            posts[slot] = Some(post);
            self.away -= 1;
        }
        let mut looks = 0;
        while self.away > 0 && looks < self.patience.looks() {
            if !self.take_back(posts) {
                looks += 1;
                std::hint::spin_loop();
            }
        }
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        self.hall.closing.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // A worker that has panicked is gone as well.
            let _ = thread.join();
        }
    }
}

/// What a worker does until the hall closes.
fn work(hall: &Hall) {
    let (mut looks, mut latest) = (0, Instant::now());
    while !hall.closing.load(Ordering::Relaxed) {
        if let Some(mut errand) = hall.waiting.pop() {
            // The post goes back whatever happens: without it its piece would be gone.
            if catch_unwind(AssertUnwindSafe(|| (hall.render)(&mut errand.post))).is_err() {
                errand.post.give_up();
            }
            // There is room for every post.
            let _ = hall.done.push(errand);
            (looks, latest) = (0, Instant::now());
        } else if looks < LOOKS {
            looks += 1;
            std::hint::spin_loop();
        } else {
            thread::sleep(if latest.elapsed() < IDLE { NAP } else { LONG_NAP });
        }
    }
}
