//! What passes between the builder's thread and the audio thread: bounded queues in both directions.

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use overhear_engine::kit::RenderWorkers;
use overhear_engine::piece::Piece;
use overhear_engine::slot::{SLOTS, Slot};

use crate::performer::Setup;

/// What can be on its way at once: a piece for each slot, and a setup.
const MOST_SENT: usize = SLOTS + 1;

/// Job that stands for none.
const NO_JOB: u32 = 0;

/// The audio thread's end: setups and pieces in, setups and pieces back.
pub struct Delivery {
    queues: Arc<Queues>,
    /// The order whose pieces are wanted.
    order: u32,
    /// The job of the setup taken last, and of the piece taken last for each slot.
    setup: u32,
    pieces: [u32; SLOTS],
}

/// What arrives through a [`Delivery`].
pub enum Arrival {
    /// Another kit, to be taken over before its pieces.
    Setup(Setup),
    /// A piece.
    Piece(Box<Piece>),
}

/// Something on its way to the audio thread.
pub(super) struct Sent {
    pub(super) order: u32,
    pub(super) job: u32,
    pub(super) what: Arrival,
}

/// Who is to render beside the audio thread, if anybody.
pub(super) struct Hired {
    pub(super) order: u32,
    pub(super) workers: Option<Box<dyn RenderWorkers>>,
}

/// The queues of one builder.
pub(super) struct Queues {
    pub(super) sent: ArrayQueue<Sent>,
    pub(super) returned: ArrayQueue<Box<Piece>>,
    /// Setups that have been replaced.
    put_away: ArrayQueue<Setup>,
    /// Workers on their way to the kit, one change at a time, and those that it has dismissed.
    pub(super) hired: ArrayQueue<Hired>,
    dismissed: ArrayQueue<Box<dyn RenderWorkers>>,
}

impl Queues {
    pub(super) fn new() -> Queues {
        Queues {
            sent: ArrayQueue::new(MOST_SENT),
            // The audio thread returns at most one piece for each it takes and those that faded out, at most one
            // of each slot; the thread empties this queue before it adds to the other: this can never be full.
            returned: ArrayQueue::new(4 * SLOTS),
            // One comes back for each that is sent, and this is emptied before another is.
            put_away: ArrayQueue::new(4),
            hired: ArrayQueue::new(1),
            // As for setups.
            dismissed: ArrayQueue::new(2),
        }
    }

    /// Drops what has come back.
    pub(super) fn collect(&self) {
        while self.returned.pop().is_some() {}
        while self.put_away.pop().is_some() {}
        while self.dismissed.pop().is_some() {}
    }
}

impl Delivery {
    /// The end for an order, at which nothing has arrived.
    pub(super) fn new(queues: Arc<Queues>, order: u32) -> Delivery {
        Delivery { queues, order, setup: NO_JOB, pieces: [NO_JOB; SLOTS] }
    }

    /// Hands everything that has arrived to `install` and sends back what that returns.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped; at most the pieces of one kit and a setup.
    pub fn take(&mut self, mut install: impl FnMut(Arrival) -> Option<Arrival>) {
        for _ in 0..MOST_SENT {
            let Some(sent) = self.queues.sent.pop() else { return };
            let replaced = if self.is_due(&sent) { install(sent.what) } else { Some(sent.what) };
            match replaced {
                Some(Arrival::Piece(piece)) => self.give_back(piece),
                Some(Arrival::Setup(setup)) => {
                    if let Err(homeless) = self.queues.put_away.push(setup) {
                        // As for pieces.
                        std::mem::forget(homeless);
                    }
                }
                None => {}
            }
        }
    }

    /// Whether something that arrives is of this order and newer than what is there.
    ///
    /// The queue is put in order while it is read, so that an older piece may come behind a newer one, or behind the setup that
    /// leaves its slot empty.
    fn is_due(&mut self, sent: &Sent) -> bool {
        if sent.order != self.order {
            return false;
        }
        let latest = match &sent.what {
            Arrival::Setup(_) => &mut self.setup,
            Arrival::Piece(piece) => &mut self.pieces[piece.slot().index()],
        };
        if sent.job < *latest {
            return false;
        }
        *latest = sent.job;
        if let Arrival::Setup(setup) = &sent.what {
            for slot in Slot::ALL.into_iter().filter(|&slot| !setup.has(slot)) {
                let latest = &mut self.pieces[slot.index()];
                *latest = sent.job.max(*latest);
            }
        }
        true
    }

    /// Hands who is to render, if that has changed, to `attach` and sends back who did so far.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped.
    pub fn take_workers(
        &self,
        attach: impl FnOnce(Option<Box<dyn RenderWorkers>>) -> Option<Box<dyn RenderWorkers>>,
    ) {
        let Some(Hired { order, workers }) = self.queues.hired.pop() else { return };
        let free = if order == self.order { attach(workers) } else { workers };
        if let Some(Err(homeless)) = free.map(|workers| self.queues.dismissed.push(workers)) {
            // As for pieces.
            std::mem::forget(homeless);
        }
    }

    /// Sends a piece back to be dropped.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped.
    pub fn give_back(&self, piece: Box<Piece>) {
        if let Err(homeless) = self.queues.returned.push(piece) {
            // Cannot happen, see the queue's size; leaking is the one thing left that is
            // allowed on the audio thread.
            std::mem::forget(homeless);
        }
    }
}

/// Something in a queue to the audio thread.
pub(super) trait Passing {
    /// Whether it is obsolete once something newer is there.
    fn is_superseded_by(&self, newer: &Self) -> bool;
}

impl Passing for Sent {
    fn is_superseded_by(&self, newer: &Sent) -> bool {
        let alike = match (&self.what, &newer.what) {
            (Arrival::Setup(_), Arrival::Setup(_)) => true,
            (Arrival::Piece(piece), Arrival::Piece(newer)) => piece.slot() == newer.slot(),
            _ => false,
        };
        self.order != newer.order || alike
    }
}

impl Passing for Hired {
    fn is_superseded_by(&self, _newer: &Hired) -> bool {
        true
    }
}

/// Drops what is superseded, by what is to be added or by what was added later. Then there is room: of an order there is one
/// piece for each slot and one setup. Nobody else adds to the queue.
pub(super) fn make_room<T: Passing>(queue: &ArrayQueue<T>, newer: &T) {
    let waiting: Vec<T> = std::iter::from_fn(|| queue.pop()).collect();
    let mut kept: Vec<T> = Vec::new();
    for sent in waiting.into_iter().rev() {
        let later = std::iter::once(newer).chain(&kept);
        if !later.into_iter().any(|later| sent.is_superseded_by(later)) {
            kept.push(sent);
        }
    }
    for sent in kept.into_iter().rev() {
        // There was room for it before.
        let _ = queue.push(sent);
    }
}
