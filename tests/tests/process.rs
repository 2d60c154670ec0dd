//! The plugin's `process`, between the host's buffers and the engine, under the same traps as
//! the engine alone.
//!
//! `cargo test --package overhear-tests --features traps --test process`

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use overhear::builder::{Arrival, Builder, Delivery, Outcome};
use overhear::building::{BuildPlan, Pace};
use overhear::deadline::Deadlines;
use overhear::kit_document::KitDocument;
use overhear::midi_map::NoteTable;
use overhear::parameters::{COUNT, default_value};
use overhear::performer::{Performer, Setup};
use overhear::strokes::{Stroke, Strokes, Waiting, strokes};
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{Chance, member};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// A performer with its kit, and what a host gives it.
struct Session {
    performer: Performer,
    deadlines: Deadlines,
    strokes: Strokes,
    waiting: Waiting,
    snapshot: KitSnapshot,
    left: Vec<f32>,
    right: Vec<f32>,
    chance: Chance,
}

impl Session {
    fn new(seed: u64) -> Session {
        let mut performer = Performer::new(48_000.0, &KitDocument::standard(), Arc::default());
        performer.install_kit(48_000.0, Pace::RealTime).expect("a rate that pieces can be built for");
        let deadlines = Deadlines::default();
        let (strokes, waiting) = strokes();
        deadlines.expect(Some(48_000.0));
        Session {
            performer,
            deadlines,
            strokes,
            waiting,
            snapshot: KitSnapshot::default(),
            left: vec![0.0; 512],
            right: vec![0.0; 512],
            chance: Chance::new(seed),
        }
    }

    /// A note, a parameter or a reset, and the slice of a buffer after it.
    fn act(&mut self) {
        match self.chance.below(1000) {
            0..500 => {
                let note = self.chance.below(128) as u8;
                let velocity = self.chance.between(-0.1, 1.1) as f32;
                self.performer.note_on(note, velocity, 9);
            }
            500..600 => {
                let (number, channel) = (self.chance.below(256) as u8, self.chance.below(20) as u8);
                let value = self.chance.of(&[f32::NAN, -1.0, 0.0, 0.3, 1.0, 9.0]);
                match self.chance.below(9) {
                    6 => self.performer.scale(number, value, channel),
                    7 => self.performer.pan(number, value, channel),
                    8 => self.performer.move_hand(number, value, channel),
                    4 => self.performer.aim(Some(value)),
                    5 => self.performer.bend(number, 40.0 * value, channel),
                    0 => self.performer.note_off(number, channel),
                    1 => self.performer.choke(number, channel),
                    2 => self.performer.pressure(number, value, channel),
                    _ => self.performer.control_change(number, value, channel),
                }
            }
            600..960 => {
                // One past the end too: a host may ask for a parameter there is not.
                let index = self.chance.below(COUNT + 1);
                let value = self.chance.of(&[f32::NAN, -1e9, -30.0, 0.0, 0.5, 1.0, 60.0, 140.0, 1e9]);
                self.performer.set_parameter(index, value);
            }
            960..980 => {
                // A hand on the editor's picture.
                let pieces = self.performer.document().kit.pieces.len();
                let slot = Slot::ALL[self.chance.below(pieces)];
                let number = |chance: &mut Chance| chance.of(&[f64::NAN, -1.0, 0.0, 0.4, 1.0, 7.0]);
                let [speed, radius, angle] = std::array::from_fn(|_| number(&mut self.chance));
                let strike = Strike { speed, radius, angle, striker: Striker::Stick };
                self.strokes.play(Stroke { slot, strike });
                self.waiting.deliver(&mut self.performer);
            }
            980..998 => self.performer.snapshot(&mut self.snapshot),
            _ => self.performer.reset(),
        }
        let longest = self.chance.of(&[1, 1, 2, 4, 8, 16, 33, 64]);
        let frames = 1 + self.chance.below(longest);
        // As the entries do it, around all of a host's call.
        let (left, right) = (&mut self.left[..frames], &mut self.right[..frames]);
        self.deadlines.timed(frames, || self.performer.render(left, right));
    }
}

#[test]
fn nothing_allocates_while_ten_thousand_events_are_performed() {
    let mut session = Session::new(1);
    reset_violation_count();
    for event in 0..10_000 {
        assert_no_alloc(|| session.act());
        assert_eq!(violation_count(), 0, "at event {event}");
        assert!(session.left.iter().chain(&session.right).all(|x| x.is_finite()), "at event {event}");
    }
    session.performer.snapshot(&mut session.snapshot);
    let kit = &session.performer.document().kit;
    for (slot, _) in kit.slots() {
        let piece = &session.snapshot.pieces[slot.index()];
        assert!(piece.ready && piece.quarantines == 0);
    }
    assert_eq!(session.snapshot.dropped_strikes, 0);
    assert_eq!(session.deadlines.buffers(), 10_000);
}

/// The last pieces of the standard kit, the last first: other kinds in most slots, and nothing in some.
fn another_kit() -> KitDocument {
    let mut kit = KitDocument::standard().kit;
    kit.pieces.reverse();
    kit.pieces.truncate(5);
    KitDocument { notes: NoteTable::standard(&kit), kit }
}

#[test]
fn nothing_allocates_while_the_kit_becomes_another_one_and_is_played_on() {
    const RATE: f64 = 48_000.0;
    let mut session = Session::new(3);
    let kits = [another_kit(), KitDocument::standard(), another_kit()];
    let mut prepared: Vec<_> = kits
        .into_iter()
        .map(|document| {
            let pieces = document.kit.slots().map(|(slot, _)| Box::new(member(&document.kit, slot, RATE)));
            let pieces: Vec<Box<Piece>> = pieces.collect();
            (Setup::new(RATE, Arc::new(document)), pieces)
        })
        .collect();
    // What comes back is dropped elsewhere.
    let (mut gone, mut setups) = (Vec::with_capacity(100), Vec::with_capacity(3));
    reset_violation_count();
    for (setup, pieces) in prepared.drain(..) {
        (0..200).for_each(|_| assert_no_alloc(|| session.act()));
        assert_no_alloc(|| setups.push(session.performer.change_kit(setup)));
        for piece in pieces {
            assert_no_alloc(|| {
                gone.extend(session.performer.install(piece));
                session.act();
                gone.extend(session.performer.retire());
            });
        }
        (0..500).for_each(|_| assert_no_alloc(|| session.act()));
        assert_eq!(violation_count(), 0);
        assert!(session.left.iter().chain(&session.right).all(|x| x.is_finite()));
        assert!(session.performer.is_complete());
    }
    session.performer.snapshot(&mut session.snapshot);
    let heard = session.snapshot.pieces.iter().filter(|piece| piece.ready);
    assert_eq!(heard.count(), session.performer.document().kit.pieces.len());
    assert!(!gone.is_empty(), "nothing has come back");
}

/// A builder, the kit that it is asked for, and the audio thread's end of it.
struct Workshop {
    wanted: Arc<Mutex<Arc<KitDocument>>>,
    builder: Builder,
    delivery: Delivery,
}

/// Longest time in which a kit is built on a machine that does other things, too.
const BUILT_WITHIN: Duration = Duration::from_secs(300);

impl Workshop {
    /// One that has been asked for the standard kit.
    fn new() -> Workshop {
        let standard = Arc::new(KitDocument::standard());
        let wanted = Arc::new(Mutex::new(standard.clone()));
        let asked = wanted.clone();
        let plan = move || {
            let document = asked.lock().expect("nobody panics with it").clone();
            let kit = document.kit.clone();
            BuildPlan::of(document, move |index| default_value(index, &kit), Pace::RealTime)
        };
        let mut builder = Builder::new(Arc::new(plan), Arc::new(Deadlines::default()));
        let delivery = builder.order(48_000.0, standard);
        Workshop { wanted, builder, delivery }
    }

    fn want(&self, document: &Arc<KitDocument>) {
        *self.wanted.lock().expect("nobody panics with it") = document.clone();
    }

    /// Takes what has arrived as the plugin does at the head of a buffer; setups and pieces that came.
    fn deliver(&mut self, performer: &mut Performer) -> [usize; 2] {
        let mut came = [0; 2];
        self.delivery.take(|arrival| match arrival {
            Arrival::Setup(setup) => {
                came[0] += 1;
                Some(Arrival::Setup(performer.change_kit(setup)))
            }
            Arrival::Piece(piece) => {
                came[1] += 1;
                performer.install(piece).map(Arrival::Piece)
            }
        });
        while let Some(piece) = performer.retire() {
            self.delivery.give_back(piece);
        }
        if performer.is_whole() {
            self.delivery.take_workers(|workers| performer.attach(workers));
        }
        came
    }
}

#[test]
fn nothing_allocates_while_kits_arrive_from_the_threads_that_build_them() {
    let mut session = Session::new(4);
    let mut workshop = Workshop::new();
    reset_violation_count();
    for document in [KitDocument::standard(), another_kit(), KitDocument::standard()].map(Arc::new) {
        workshop.want(&document);
        let (deadline, mut came) = (Instant::now() + BUILT_WITHIN, [0; 2]);
        while *session.performer.document() != *document
            || !session.performer.is_complete()
            || workshop.builder.is_building()
        {
            assert!(Instant::now() < deadline, "{came:?} have come");
            let more = assert_no_alloc(|| {
                session.act();
                workshop.deliver(&mut session.performer)
            });
            came = [came[0] + more[0], came[1] + more[1]];
            assert_eq!(violation_count(), 0, "as {more:?} came");
        }
        // Until what it replaced has faded out and been sent back.
        for _ in 0..500 {
            assert_no_alloc(|| {
                session.act();
                workshop.deliver(&mut session.performer);
            });
        }
        assert_eq!(violation_count(), 0);
        assert!(session.performer.is_complete());
        assert!(session.left.iter().chain(&session.right).all(|x| x.is_finite()));
    }
}

/// In a child of this test, which forbids itself all system calls.
#[cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod system_calls {
    use overhear_tests::system_calls::{child_gets_to_its_end, done, forbid};

    use super::{Arc, BUILT_WITHIN, Outcome, Session, Workshop, another_kit};

    #[test]
    #[ignore = "run in a child process by the test below"]
    fn child_that_performs() {
        let mut session = Session::new(2);
        forbid();
        for _ in 0..10_000 {
            session.act();
        }
        done(true);
    }

    #[test]
    fn ten_thousand_events_performed_make_no_system_call() {
        child_gets_to_its_end("system_calls::child_that_performs");
    }

    #[test]
    #[ignore = "run in a child process by the test below"]
    fn child_that_takes_another_kit() {
        let mut session = Session::new(5);
        let mut workshop = Workshop::new();
        let document = Arc::new(another_kit());
        workshop.want(&document);
        // What waits in the queues is all that this thread needs of the others.
        assert_eq!(workshop.builder.wait(BUILT_WITHIN), Outcome::Finished);
        forbid();
        let mut came = [0; 2];
        for _ in 0..1_000 {
            session.act();
            let more = workshop.deliver(&mut session.performer);
            came = [came[0] + more[0], came[1] + more[1]];
        }
        // A piece that is the same in both kits stays.
        let whole = session.performer.is_complete() && *session.performer.document() == *document;
        done(came[0] == 1 && came[1] > 0 && whole);
    }

    #[test]
    fn another_kit_is_taken_without_a_system_call() {
        child_gets_to_its_end("system_calls::child_that_takes_another_kit");
    }
}
