use std::sync::atomic::{AtomicU64, AtomicUsize};

use overhear_engine::kit::Kit;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::{Strike, Striker};

use super::*;

const RATE: f64 = 44_100.0;

/// Samples of a run: fewer than the shortest way between two pieces takes.
const RUN: usize = 16;

/// A clock that counts how often it is asked, and is over after so many times.
struct Counting {
    asked: AtomicU64,
    allowed: u64,
}

impl Deadline for Counting {
    fn is_over(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.allowed
    }
}

/// A kit whose splash and rack tom have just been struck.
fn struck() -> Kit {
    let spec = KitSpec::standard();
    let mut kit = Kit::new(RATE, &spec);
    let options = BuildOptions { quality: Quality::Eco, ..BuildOptions::new(RATE) };
    let slots: Vec<Slot> = spec.slots().map(|(slot, _)| slot).collect();
    for slot in
        slots.into_iter().filter(|slot| ["splash", "rack-tom"].contains(&&*spec.pieces[slot.index()].name))
    {
        let piece = Piece::new(slot, &spec.build(slot).unwrap(), &options).unwrap();
        assert!(kit.install(Box::new(piece)).is_none());
        kit.strike(slot, &Strike { speed: 3.0, radius: 0.4, angle: 0.0, striker: Striker::Stick });
    }
    kit
}

fn rendered(kit: &mut Kit) -> ([f32; RUN], u32) {
    let (mut left, mut right, mut snapshot) = ([0.0; RUN], [0.0; RUN], KitSnapshot::default());
    kit.render(&mut left, &mut right);
    kit.snapshot(&mut snapshot);
    (left, snapshot.missed_runs)
}

fn on_a_worker() -> bool {
    thread::current().name().is_some_and(|name| name.starts_with("overhear worker"))
}

#[test]
fn a_worker_that_sleeps_is_waited_for_until_the_deadline_once_and_then_not_again() {
    static CLAIMED: AtomicUsize = AtomicUsize::new(0);
    static RELEASED: AtomicBool = AtomicBool::new(false);
    let sleepy = |job: &mut RenderJob| {
        if on_a_worker() {
            CLAIMED.fetch_add(1, Ordering::SeqCst);
            while !RELEASED.load(Ordering::SeqCst) {
                thread::sleep(Duration::from_millis(1));
            }
        } else if job.is_busy() {
            // The audio thread lets the worker have one of the two.
            while CLAIMED.load(Ordering::SeqCst) == 0 {
                thread::yield_now();
            }
        }
        job.render();
    };
    let clock = Arc::new(Counting { asked: AtomicU64::new(0), allowed: 1_000 });
    let workers = Workers::new(1, Patience::RealTime, sleepy).unwrap().until(clock.clone());
    let mut kit = struck();
    assert!(kit.attach(Some(Box::new(workers))).is_none());
    let asked = || clock.asked.load(Ordering::Relaxed);

    let (_, missed) = rendered(&mut kit);
    assert_eq!(
        (asked(), missed, kit.is_whole()),
        (1_000, 1, false),
        "waited until the deadline, and no longer"
    );
    let (_, missed) = rendered(&mut kit);
    assert_eq!((asked(), missed, kit.is_whole()), (1_000, 2, false), "a job that was lost is not waited for");

    RELEASED.store(true, Ordering::SeqCst);
    let mut runs = 0;
    while !kit.is_whole() {
        rendered(&mut kit);
        thread::sleep(Duration::from_millis(1));
        runs += 1;
        assert!(runs < 60_000, "the piece has not come back");
    }
}

#[test]
fn a_deadline_that_has_passed_changes_no_bit_if_every_job_is_back() {
    struct Over;
    impl Deadline for Over {
        fn is_over(&self) -> bool {
            true
        }
    }
    // Without threads the audio thread takes every job back from the queue.
    let workers = Workers::new(0, Patience::RealTime, RenderJob::render).unwrap().until(Arc::new(Over));
    let (mut kit, mut alone) = (struck(), struck());
    assert!(kit.attach(Some(Box::new(workers))).is_none());
    for _ in 0..200 {
        let ((sound, missed), (expected, _)) = (rendered(&mut kit), rendered(&mut alone));
        assert_eq!(missed, 0);
        assert!(sound.map(f32::to_bits) == expected.map(f32::to_bits));
    }
}

#[test]
fn whoever_renders_a_file_has_no_deadline() {
    static RENDERED: AtomicUsize = AtomicUsize::new(0);
    let slow = |job: &mut RenderJob| {
        if on_a_worker() {
            RENDERED.fetch_add(1, Ordering::SeqCst);
            thread::sleep(Duration::from_millis(20));
        } else if job.is_busy() {
            while RENDERED.load(Ordering::SeqCst) == 0 {
                thread::yield_now();
            }
        }
        job.render();
    };
    let clock = Arc::new(Counting { asked: AtomicU64::new(0), allowed: 1 });
    let workers = Workers::new(1, Patience::Offline, slow).unwrap().until(clock.clone());
    let mut kit = struck();
    assert!(kit.attach(Some(Box::new(workers))).is_none());
    let (_, missed) = rendered(&mut kit);
    assert_eq!((clock.asked.load(Ordering::Relaxed), missed, kit.is_whole()), (0, 0, true));
}
