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
//! When the kit changes, a [`Setup`] goes first, then the pieces that differ. Pieces and setups that were replaced go back to be
//! dropped here, as dropping frees memory. Every order has a
//! number; pieces of an older one are returned unplayed. The thread starts with the first order,
//! never when an instance is merely created. Pieces are built on a pool of as many threads as there are processors, up
//! to four, which ends with the job: a pool that outlived it would still run when a host unloads the plugin. All look between
//! pieces whether they are still wanted, so that dropping the builder waits for one piece each at most; pieces
//! arrive in the order in which they are begun, whoever builds them. From then on it looks a few times a second
//! whether the [plan](BuildPlan) has changed, and builds those pieces anew that it concerns: parameters
//! are moved on threads that must not wake another. One thread per instance: one that instances share would have to
//! survive those that come and go while it works.

mod delivery;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::queue::ArrayQueue;
use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::PieceBuild;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::FieldShapes;
use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use tracing::error;

use crate::building::{BuildPlan, WorkerPlan};
use crate::cache;
use crate::kit_document::KitDocument;
use crate::performer::Setup;
use crate::workers::Deadline;

use delivery::{Hired, Passing, Queues, Sent, make_room};

pub use delivery::{Arrival, Delivery};

/// How often the thread looks for returned pieces and for a change of plan.
const LOOK_INTERVAL: Duration = Duration::from_millis(100);

/// Order that stands for none.
const NO_ORDER: u32 = 0;

/// Computes one piece.
type Make = fn(Slot, &PieceBuild, &BuildOptions) -> Result<Piece, SpecError>;

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

/// Shapes of the pieces' displacement fields, and which pieces are being built, for the editor's end.
#[derive(Clone)]
pub struct Shapes {
    shared: Arc<Shared>,
}

struct Shared {
    desk: Mutex<Mixer>,
    /// Signals that the desk has changed, to either side.
    changed: Condvar,
    /// The latest order, read between pieces.
    latest: AtomicU32,
    queues: Arc<Queues>,
    shapes: Mutex<[Option<Arc<FieldShapes>>; SLOTS]>,
    /// Slots whose pieces are being built, a bit each.
    pending: AtomicU32,
    /// How long the audio thread waits for workers.
    deadline: Arc<dyn Deadline>,
}

/// What the main thread and the builder thread tell each other.
#[derive(Default)]
struct Mixer {
    sample_rate: f64,
    order: u32,
    /// The kit that the performer has for which the latest order is.
    kit: Option<Arc<KitDocument>>,
    /// The plan of what has been built or is being built for the latest order.
    plan: Option<BuildPlan>,
    /// Jobs so far.
    jobs: u32,
    /// The latest order that came to an end.
    ended: u32,
    failure: Option<String>,
    stop: bool,
}

/// One run of the builder thread.
struct Job {
    order: u32,
    /// Counts up from 1.
    number: u32,
    sample_rate: f64,
    /// What the pieces in use were built for, if this order has brought any.
    former: Option<BuildPlan>,
    /// Whether the performer is at another kit than the plan's.
    changes_kit: bool,
    plan: BuildPlan,
}

impl Builder {
    /// A builder that follows a plan, whose workers are waited for as long as a deadline allows. Has no thread until
    /// something is ordered.
    pub fn new(wanted: Wanted, deadline: Arc<dyn Deadline>) -> Builder {
        Builder::with(
            |slot, build, options| {
                cache::provide();
                Piece::new(slot, build, options)
            },
            wanted,
            deadline,
        )
    }

    fn with(make: Make, wanted: Wanted, deadline: Arc<dyn Deadline>) -> Builder {
        let shared = Shared {
            desk: Mutex::default(),
            changed: Condvar::new(),
            latest: AtomicU32::new(NO_ORDER),
            queues: Arc::new(Queues::new()),
            shapes: Mutex::default(),
            pending: AtomicU32::new(0),
            deadline,
        };
        Builder { shared: Arc::new(shared), make, wanted, thread: None }
    }

    /// Orders every piece of the kit that is wanted for a performer at a sample rate (Hz), which is at a kit so far; gives up
    /// any earlier order.
    ///
    /// Returns the end through which the pieces arrive, and a setup before them if another kit is wanted; earlier ends get
    /// none any more.
    pub fn order(&mut self, sample_rate: f64, kit: Arc<KitDocument>) -> Delivery {
        let order = {
            let mut desk = lock(&self.shared.desk);
            desk.order = desk.order.wrapping_add(1).max(NO_ORDER + 1);
            desk.sample_rate = sample_rate;
            desk.kit = Some(kit);
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
        Delivery::new(self.shared.queues.clone(), order)
    }

    /// Waits until everything is built as it is wanted now, or for as long as given.
    pub fn wait(&self, timeout: Duration) -> Outcome {
        let deadline = Instant::now() + timeout;
        let plan = (self.wanted)();
        let mut desk = lock(&self.shared.desk);
        if desk.plan.as_ref().is_some_and(|known| *known != plan) {
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

    /// Whether pieces are being built that are not on their way yet.
    pub fn is_building(&self) -> bool {
        self.shared.pending.load(Ordering::Acquire) != 0
    }

    /// Shapes of the built pieces, for the editor.
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
            // The thread catches panics; if it ended in one, there is no other thread to tell.
            let _ = thread.join();
        }
    }
}

impl Shapes {
    /// The shapes of the piece of a slot, once it has been built.
    pub fn of(&self, slot: Slot) -> Option<Arc<FieldShapes>> {
        lock(&self.shared.shapes)[slot.index()].clone()
    }

    /// Whether the piece of a slot is being built at present, be it anew.
    pub fn is_building(&self, slot: Slot) -> bool {
        self.shared.pending.load(Ordering::Acquire) & bit(slot) != 0
    }
}

impl Shared {
    /// The builder thread.
    fn work(&self, make: Make, wanted: &Wanted) {
        while let Some(job) = self.next_job(wanted) {
            let failure = self.build(&job, make).err();
            if let Some(reason) = failure.as_ref().filter(|_| job.former.is_some()) {
                // Nobody waits for what changes while the kit plays.
                error!("A part of the kit cannot be built and stays as it was: {reason}");
            }
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
            let plan = wanted();
            if desk.order != NO_ORDER && desk.plan.as_ref() != Some(&plan) {
                let former = desk.plan.replace(plan.clone());
                let present = desk.kit.replace(plan.kit().clone());
                let changes_kit = present.is_none_or(|present| !plan.is_of_kit(&present));
                desk.jobs += 1;
                // Noticed by this thread itself: who waits from now on waits for this as well.
                desk.ended = NO_ORDER;
                let (order, number, sample_rate) = (desk.order, desk.jobs, desk.sample_rate);
                return Some(Job { order, number, sample_rate, former, changes_kit, plan });
            }
            // Asked to wait for a change of plan that was taken back meanwhile.
            if desk.order != desk.ended {
                desk.ended = desk.order;
                self.changed.notify_all();
            }
            let interval = (desk.order != NO_ORDER).then_some(LOOK_INTERVAL);
            desk = wait(&self.changed, desk, interval);
            self.queues.collect();
        }
    }

    /// Builds what a job asks for until done or until its order is no longer the latest.
    fn build(&self, job: &Job, make: Make) -> Result<(), String> {
        if job.former.as_ref().map_or(WorkerPlan::NOBODY, BuildPlan::worker_plan) != job.plan.worker_plan() {
            // A kit without workers plays as well: no reason to fail.
            let workers = job.plan.worker_plan().hire_until(self.deadline.clone()).unwrap_or_default();
            self.deliver(&self.queues.hired, Hired { order: job.order, workers }, job.order);
        }
        let kit = &job.plan.kit().kit;
        for slot in Slot::ALL.into_iter().filter(|&slot| kit.piece(slot).is_none()) {
            lock(&self.shapes)[slot.index()] = None;
        }
        let wanted = job.to_build();
        // Before the setup: a performer that is at the kit already must not be taken for one that has its pieces.
        self.pending.store(wanted.iter().fold(0, |bits, (slot, _)| bits | bit(*slot)), Ordering::Release);
        if job.changes_kit {
            self.send(job, Arrival::Setup(Setup::new(job.sample_rate, job.plan.kit().clone())));
        }
        self.build_pieces(job, &wanted, make)
    }

    /// Builds pieces on several threads and sends them in their order.
    fn build_pieces(&self, job: &Job, wanted: &[(Slot, PieceBuild)], make: Make) -> Result<(), String> {
        if wanted.is_empty() {
            return Ok(());
        }
        let processors = thread::available_parallelism().map_or(1, usize::from);
        let pool = ThreadPoolBuilder::new()
            .num_threads(processors.min(MOST_THREADS).min(wanted.len()))
            .thread_name(|_| "overhear-helper".to_owned());
        let build = |pool: &ThreadPool| self.build_on(pool, job, wanted, make);
        // Scoped: the threads have ended when this returns.
        match pool.build_scoped(ThreadBuilder::run, build) {
            Ok(outcome) => outcome,
            Err(error) => Err(format!("no threads: {error}")),
        }
    }

    fn build_on(
        &self,
        pool: &ThreadPool,
        job: &Job,
        wanted: &[(Slot, PieceBuild)],
        make: Make,
    ) -> Result<(), String> {
        let options = job.plan.options(job.sample_rate);
        let given_up = AtomicBool::new(false);
        let is_dropped =
            || self.latest.load(Ordering::Acquire) != job.order || given_up.load(Ordering::Acquire);
        let (send, receive) = mpsc::channel::<(usize, Made)>();
        pool.in_place_scope_fifo(|scope| {
            for (index, (slot, build)) in wanted.iter().enumerate() {
                let (send, options, is_dropped) = (send.clone(), &options, &is_dropped);
                scope.spawn_fifo(move |_| {
                    if !is_dropped() {
                        // Received to the end, or no longer wanted.
                        let _ = send.send((index, made(make, *slot, build, options)));
                    }
                });
            }
            drop(send);
            let mut waiting: Vec<Option<Made>> = wanted.iter().map(|_| None).collect();
            let mut due = 0;
            let outcome = receive.iter().try_for_each(|(index, made)| {
                waiting[index] = Some(made);
                while let Some(made) = waiting.get_mut(due).and_then(Option::take) {
                    self.hand_over(job, wanted[due].0, made)?;
                    due += 1;
                }
                Ok(())
            });
            given_up.store(true, Ordering::Release);
            outcome
        })
    }

    /// Passes a piece on, if it could be made and is still wanted.
    fn hand_over(&self, job: &Job, slot: Slot, made: Made) -> Result<(), String> {
        let (piece, shapes) = made?;
        if self.latest.load(Ordering::Acquire) == job.order {
            lock(&self.shapes)[slot.index()] = Some(shapes);
            self.send(job, Arrival::Piece(piece));
        }
        self.pending.fetch_and(!bit(slot), Ordering::AcqRel);
        Ok(())
    }

    /// Puts something of a job on its way to the audio thread.
    fn send(&self, job: &Job, what: Arrival) {
        self.deliver(&self.queues.sent, Sent { order: job.order, job: job.number, what }, job.order);
    }

    /// Puts something into its queue, unless it is no longer wanted.
    fn deliver<T: Passing>(&self, queue: &ArrayQueue<T>, mut sent: T, order: u32) {
        while self.latest.load(Ordering::Acquire) == order {
            self.queues.collect();
            match queue.push(sent) {
                Ok(()) => return,
                Err(refused) => sent = refused,
            }
            // The audio thread has taken nothing, perhaps because it does not run, and a caller may be waiting.
            make_room(queue, &sent);
        }
    }

    fn end(&self, order: u32, failure: Option<String>) {
        self.pending.store(0, Ordering::Release);
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

impl Job {
    /// The pieces that differ from those in use, what takes longest first.
    fn to_build(&self) -> Vec<(Slot, PieceBuild)> {
        let options = self.plan.options(self.sample_rate);
        let former = self.former.as_ref().filter(|former| former.options(self.sample_rate) == options);
        let differs = |slot: Slot, build: &PieceBuild| {
            former.is_none_or(|former| former.build(slot).as_ref() != Some(build))
        };
        let slots = self.plan.longest_first().into_iter();
        let builds = slots.filter_map(|slot| Some((slot, self.plan.build(slot)?)));
        builds.filter(|(slot, build)| differs(*slot, build)).collect()
    }
}

fn bit(slot: Slot) -> u32 {
    1 << slot.index()
}

/// Makes a piece and what is drawn of it, or says why not.
fn made(make: Make, slot: Slot, build: &PieceBuild, options: &BuildOptions) -> Made {
    let made = catch_unwind(AssertUnwindSafe(|| {
        let piece = make(slot, build, options)?;
        let shapes = Arc::new(piece.field_shapes());
        Ok::<_, SpecError>((Box::new(piece), shapes))
    }));
    match made {
        Ok(Ok(made)) => Ok(made),
        Ok(Err(error)) => Err(format!("{}: {error}", build.spec.name)),
        Err(_) => Err(format!("{}: building it panicked", build.spec.name)),
    }
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
