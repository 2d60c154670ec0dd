//! Pieces built on a thread of the instance's own.
//!
//! A piece takes up to a second to compute; the audio thread never waits for one. Threads and
//! what passes between them:
//!
//! ```text
//! main thread ── order(rate) ──▶ builder thread ── built, a bounded queue ──▶ audio thread
//!                                      ▲                                           │
//!                                      └── returned, a bounded queue ◀── replaced ─┘
//! ```
//!
//! Replaced pieces go back to be dropped here, as dropping frees memory. Every order has a
//! number; pieces of an older one are returned unplayed. The thread starts with the first order,
//! never when an instance is merely created. While it has pieces to build, others help it, as many as there are processors
//! up to four, and end with the job: a pool that outlived it would still run when a host unloads the plugin. All look between
//! pieces whether they are still wanted, so that dropping the builder waits for one piece each at most; pieces
//! arrive in the order of the kit, whoever builds them. From then on it looks a few times a second
//! whether the [plan](BuildPlan) has changed, and builds those pieces anew that it concerns: parameters
//! are moved on threads that must not wake another. One thread per instance, because the
//! framework's shared one does not survive instances that come and go while it works.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::queue::ArrayQueue;
use overhear_engine::error::SpecError;
use overhear_engine::kit::Crew;
use overhear_engine::piece::{BuildOptions, Piece, PieceId};
use overhear_engine::snapshot::FieldShapes;

use crate::building::{BuildPlan, Staff};
use crate::shelf;

/// Pieces of a kit.
const PIECES: usize = PieceId::KIT.len();

/// How often the thread looks for returned pieces and for a change of plan.
const LOOK_INTERVAL: Duration = Duration::from_millis(100);

/// Order that stands for none.
const NO_ORDER: u32 = 0;

/// Computes one piece.
type Make = fn(PieceId, &BuildOptions) -> Result<Piece, SpecError>;

/// A piece with what is drawn of it, or why there is none.
type Made = Result<(Box<Piece>, Arc<FieldShapes>), String>;

/// Threads that build at once, at most.
const MOST_THREADS: usize = 4;

/// Says what is wanted now; asked by any thread but the audio thread.
pub type Wanted = Arc<dyn Fn() -> BuildPlan + Send + Sync>;

/// How an order stands after waiting for it.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Every piece is in the queue or already taken from it.
    Finished,
    /// The wait ran out; pieces still to come will arrive through the queue.
    Late,
    /// A piece could not be built, for the reason given; none will follow.
    Failed(String),
}

/// The builder: the main thread's end.
pub struct Builder {
    shared: Arc<Shared>,
    make: Make,
    wanted: Wanted,
    thread: Option<JoinHandle<()>>,
}

/// The audio thread's end: pieces in, pieces back.
pub struct Delivery {
    shared: Arc<Shared>,
    /// The order whose pieces are wanted.
    order: u32,
}

/// Shapes of the pieces' displacement fields, for the editor's end.
#[derive(Clone)]
pub struct Shapes {
    shared: Arc<Shared>,
}

struct Shared {
    desk: Mutex<Desk>,
    /// Signals that the desk has changed, to either side.
    changed: Condvar,
    /// The latest order, read between pieces.
    latest: AtomicU32,
    built: ArrayQueue<Built>,
    returned: ArrayQueue<Box<Piece>>,
    /// Workers on their way to the kit, one change at a time, and those that it has dismissed.
    hired: ArrayQueue<Hired>,
    dismissed: ArrayQueue<Box<dyn Crew>>,
    shapes: Mutex<[Option<Arc<FieldShapes>>; PIECES]>,
}

/// What the main thread and the builder thread tell each other.
#[derive(Default)]
struct Desk {
    sample_rate: f64,
    order: u32,
    /// The plan of what has been built or is being built for the latest order.
    plan: Option<BuildPlan>,
    /// The latest order that came to an end.
    ended: u32,
    failure: Option<String>,
    stop: bool,
}

/// One run of the builder thread.
struct Job {
    order: u32,
    sample_rate: f64,
    /// What the pieces in use were built for, if this order has brought any.
    former: Option<BuildPlan>,
    plan: BuildPlan,
}

struct Built {
    order: u32,
    piece: Box<Piece>,
}

/// Who is to render beside the audio thread, if anybody.
struct Hired {
    order: u32,
    crew: Option<Box<dyn Crew>>,
}

impl Builder {
    /// A builder that follows a plan. Has no thread until something is ordered.
    pub fn new(wanted: Wanted) -> Builder {
        Builder::with(
            |id, options| {
                shelf::provide();
                Piece::new(id, options)
            },
            wanted,
        )
    }

    fn with(make: Make, wanted: Wanted) -> Builder {
        let shared = Shared {
            desk: Mutex::default(),
            changed: Condvar::new(),
            latest: AtomicU32::new(NO_ORDER),
            built: ArrayQueue::new(PIECES),
            // The audio thread returns at most one piece for each it takes and those that faded out, at most one
            // of each kind; the thread empties this queue before it adds to the other: this can never be full.
            returned: ArrayQueue::new(4 * PIECES),
            hired: ArrayQueue::new(1),
            // One comes back for each that is sent, and this is emptied before another is.
            dismissed: ArrayQueue::new(2),
            shapes: Mutex::default(),
        };
        Builder { shared: Arc::new(shared), make, wanted, thread: None }
    }

    /// Orders every piece of the kit for a sample rate (Hz); gives up any earlier order.
    ///
    /// Returns the end through which the pieces arrive; earlier ends get none any more.
    pub fn order(&mut self, sample_rate: f64) -> Delivery {
        let order = {
            let mut desk = lock(&self.shared.desk);
            desk.order = desk.order.wrapping_add(1).max(NO_ORDER + 1);
            desk.sample_rate = sample_rate;
            desk.plan = None;
            desk.failure = None;
            self.shared.latest.store(desk.order, Ordering::Release);
            desk.order
        };
        self.shared.changed.notify_all();
        if self.thread.is_none() {
            let (shared, make, wanted) = (self.shared.clone(), self.make, self.wanted.clone());
            let name = "overhear-builder".to_owned();
            match thread::Builder::new().name(name).spawn(move || shared.work(make, &wanted)) {
                Ok(thread) => self.thread = Some(thread),
                Err(error) => self.shared.end(order, Some(format!("no thread: {error}"))),
            }
        }
        Delivery { shared: self.shared.clone(), order }
    }

    /// Waits until everything is built as it is wanted now, or for as long as given.
    pub fn wait(&self, timeout: Duration) -> Outcome {
        let deadline = Instant::now() + timeout;
        let plan = (self.wanted)();
        let mut desk = lock(&self.shared.desk);
        if desk.plan.is_some_and(|known| known != plan) {
            desk.ended = NO_ORDER;
            self.shared.changed.notify_all();
        }
        while desk.ended != desk.order {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Outcome::Late;
            }
            desk = wait(&self.shared.changed, desk, Some(left));
        }
        match &desk.failure {
            Some(reason) => Outcome::Failed(reason.clone()),
            None => Outcome::Finished,
        }
    }

    /// The shapes of what has been built, for whoever draws.
    pub fn shapes(&self) -> Shapes {
        Shapes { shared: self.shared.clone() }
    }
}

impl Drop for Builder {
    fn drop(&mut self) {
        lock(&self.shared.desk).stop = true;
        self.shared.latest.store(NO_ORDER, Ordering::Release);
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // The thread catches panics; were it to end in one, there is nobody left to tell.
            let _ = thread.join();
        }
    }
}

impl Delivery {
    /// Hands every piece that has arrived to `install` and sends back what that returns.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped; at most the pieces of one kit.
    pub fn take(&self, mut install: impl FnMut(Box<Piece>) -> Option<Box<Piece>>) {
        for _ in 0..PIECES {
            let Some(Built { order, piece }) = self.shared.built.pop() else { return };
            let replaced = if order == self.order { install(piece) } else { Some(piece) };
            if let Some(replaced) = replaced {
                self.give_back(replaced);
            }
        }
    }

    /// Hands who is to render, if that has changed, to `hire` and sends back who did so far.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped.
    pub fn take_crew(&self, hire: impl FnOnce(Option<Box<dyn Crew>>) -> Option<Box<dyn Crew>>) {
        let Some(Hired { order, crew }) = self.shared.hired.pop() else { return };
        let free = if order == self.order { hire(crew) } else { crew };
        if let Some(Err(homeless)) = free.map(|crew| self.shared.dismissed.push(crew)) {
            // As for pieces.
            std::mem::forget(homeless);
        }
    }

    /// Sends a piece back to be dropped.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped.
    pub fn give_back(&self, piece: Box<Piece>) {
        if let Err(homeless) = self.shared.returned.push(piece) {
            // Cannot happen, see the queue's size; leaking is the one thing left that is
            // allowed on the audio thread.
            std::mem::forget(homeless);
        }
    }
}

impl Shapes {
    /// The shapes of a piece of the kit, by its slot, once it has been built.
    pub fn of(&self, slot: usize) -> Option<Arc<FieldShapes>> {
        lock(&self.shared.shapes).get(slot)?.clone()
    }
}

impl Shared {
    /// The builder thread.
    fn work(&self, make: Make, wanted: &Wanted) {
        while let Some(job) = self.next_job(wanted) {
            let failure = self.build(&job, make).err();
            self.end(job.order, failure);
        }
    }

    /// Waits for something to build; none once the builder is dropped.
    fn next_job(&self, wanted: &Wanted) -> Option<Job> {
        let mut desk = lock(&self.desk);
        loop {
            if desk.stop {
                return None;
            }
            let (former, plan) = (desk.plan, wanted());
            let failed = desk.failure.is_some() && former == Some(plan);
            if desk.order != NO_ORDER && former != Some(plan) && !failed {
                desk.plan = Some(plan);
                return Some(Job { order: desk.order, sample_rate: desk.sample_rate, former, plan });
            }
            // Asked to wait for a change of plan that was taken back meanwhile.
            if desk.order != desk.ended {
                desk.ended = desk.order;
                self.changed.notify_all();
            }
            let interval = (desk.order != NO_ORDER).then_some(LOOK_INTERVAL);
            desk = wait(&self.changed, desk, interval);
            self.collect();
        }
    }

    /// Builds what a job asks for until done or until its order is no longer the latest.
    fn build(&self, job: &Job, make: Make) -> Result<(), String> {
        if job.former.map_or(Staff::NOBODY, |former| former.staff()) != job.plan.staff() {
            // A kit without workers plays as well: no reason to fail.
            let crew = job.plan.staff().hire().unwrap_or_default();
            self.deliver(&self.hired, Hired { order: job.order, crew }, job.order);
        }
        let differs = |id: PieceId, options: &BuildOptions| {
            job.former.is_none_or(|former| former.options(id, job.sample_rate) != *options)
        };
        let wanted: Vec<(usize, PieceId, BuildOptions)> = PieceId::LONGEST_FIRST
            .into_iter()
            .filter_map(|id| Some((id.slot()?, id, job.plan.options(id, job.sample_rate))))
            .filter(|(_, id, options)| differs(*id, options))
            .collect();
        let (taken, given_up) = (AtomicUsize::new(0), AtomicBool::new(false));
        let next = || {
            let dropped =
                self.latest.load(Ordering::Acquire) != job.order || given_up.load(Ordering::Acquire);
            let index = taken.fetch_add(1, Ordering::Relaxed);
            wanted
                .get(index)
                .filter(|_| !dropped)
                .map(|&(_, id, ref options)| (index, made(make, id, options)))
        };
        let (send, made) = mpsc::channel();
        thread::scope(|scope| {
            let processors = thread::available_parallelism().map_or(1, usize::from);
            for _ in 1..processors.min(MOST_THREADS).min(wanted.len()) {
                let (send, next) = (send.clone(), &next);
                // One that cannot be had is done without.
                let _ = thread::Builder::new().name("overhear-helper".to_owned()).spawn_scoped(
                    scope,
                    move || {
                        while let Some(made) = next() {
                            // Received to the end, or nobody wants it.
                            let _ = send.send(made);
                        }
                    },
                );
            }
            let mut waiting: Vec<Option<Made>> = wanted.iter().map(|_| None).collect();
            let mut due = 0;
            let mut arrive = |(index, made): (usize, Made)| {
                waiting[index] = Some(made);
                while let Some(made) = waiting.get_mut(due).and_then(Option::take) {
                    self.hand_over(job.order, wanted[due].0, made)?;
                    due += 1;
                }
                Ok(())
            };
            let all = || {
                while let Some(made_here) = next() {
                    arrive(made_here)?;
                    made.try_iter().try_for_each(&mut arrive)?;
                }
                drop(send);
                made.iter().try_for_each(&mut arrive)
            };
            let outcome = all();
            given_up.store(true, Ordering::Release);
            outcome
        })
    }

    /// Passes a piece on, if it could be made and is still wanted.
    fn hand_over(&self, order: u32, slot: usize, made: Made) -> Result<(), String> {
        let (piece, shapes) = made?;
        if self.latest.load(Ordering::Acquire) == order {
            lock(&self.shapes)[slot] = Some(shapes);
            self.deliver(&self.built, Built { order, piece }, order);
        }
        Ok(())
    }

    /// Puts something into its queue once there is room, unless it is no longer wanted.
    fn deliver<T: Sent>(&self, queue: &ArrayQueue<T>, mut sent: T, order: u32) {
        while self.latest.load(Ordering::Acquire) == order {
            self.collect();
            match queue.push(sent) {
                Ok(()) => return,
                Err(refused) => sent = refused,
            }
            // The audio thread has taken nothing, perhaps because it does not run, and somebody may be waiting.
            if !make_room(queue, &sent) {
                thread::sleep(Duration::from_millis(10));
            }
        }
    }

    /// Drops what has come back.
    fn collect(&self) {
        while self.returned.pop().is_some() {}
        while self.dismissed.pop().is_some() {}
    }

    fn end(&self, order: u32, failure: Option<String>) {
        let mut desk = lock(&self.desk);
        // An order given up counts as ended by the one that replaced it.
        if desk.order == order {
            desk.ended = order;
            desk.failure = failure;
        }
        drop(desk);
        self.changed.notify_all();
    }
}

/// Makes a piece and what is drawn of it, or says why not.
fn made(make: Make, id: PieceId, options: &BuildOptions) -> Made {
    let made = catch_unwind(AssertUnwindSafe(|| {
        let piece = make(id, options)?;
        let shapes = Arc::new(piece.field_shapes());
        Ok::<_, SpecError>((Box::new(piece), shapes))
    }));
    match made {
        Ok(Ok(made)) => Ok(made),
        Ok(Err(error)) => Err(format!("{}: {error}", id.name())),
        Err(_) => Err(format!("{}: building it panicked", id.name())),
    }
}

/// Something on its way to the audio thread.
trait Sent {
    /// Whether nobody wants it any more once something newer is there.
    fn is_superseded_by(&self, newer: &Self) -> bool;
}

impl Sent for Built {
    fn is_superseded_by(&self, newer: &Built) -> bool {
        self.order != newer.order || self.piece.id() == newer.piece.id()
    }
}

impl Sent for Hired {
    fn is_superseded_by(&self, _newer: &Hired) -> bool {
        true
    }
}

/// Drops what is superseded and says whether there is room now. The rest goes back to where there was room
/// for it: nobody else adds to the queue.
fn make_room<T: Sent>(queue: &ArrayQueue<T>, newer: &T) -> bool {
    let mut room = false;
    for _ in 0..queue.capacity() {
        match queue.pop() {
            Some(sent) if !sent.is_superseded_by(newer) => room |= queue.push(sent).is_err(),
            Some(_) | None => room = true,
        }
    }
    room
}

/// Locks even after a panic elsewhere: every value behind these locks is valid at all times.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn wait<'a, T>(changed: &Condvar, guard: MutexGuard<'a, T>, timeout: Option<Duration>) -> MutexGuard<'a, T> {
    match timeout {
        Some(timeout) => changed.wait_timeout(guard, timeout).unwrap_or_else(PoisonError::into_inner).0,
        None => changed.wait(guard).unwrap_or_else(PoisonError::into_inner),
    }
}

#[cfg(test)]
mod tests;
