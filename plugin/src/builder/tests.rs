use std::sync::atomic::AtomicBool;

use super::*;
use crate::building::Pace;
use crate::parameters::PARAMETERS;

const RATE: f64 = 48_000.0;
const LONG: Duration = Duration::from_secs(120);

fn quick(id: PieceId, options: &BuildOptions) -> Result<Piece, SpecError> {
    Piece::new(id, options)
}

fn slow(id: PieceId, options: &BuildOptions) -> Result<Piece, SpecError> {
    thread::sleep(Duration::from_millis(300));
    quick(id, options)
}

/// A builder of the default plan.
fn builder(make: Make) -> Builder {
    Builder::with(make, Arc::new(BuildPlan::default))
}

/// A plan with another ratio for the snare if `moved`.
fn plan(moved: bool) -> BuildPlan {
    let value = |index: usize| {
        let parameter = &PARAMETERS[index];
        if moved && parameter.name == "snare_resonant_ratio" { 1.3 } else { parameter.default }
    };
    BuildPlan::of(value, Pace::RealTime)
}

/// A plan with so many workers.
fn staffed(workers: usize) -> BuildPlan {
    let value = |index: usize| {
        let parameter = &PARAMETERS[index];
        if parameter.name == "workers" { workers as f32 } else { parameter.default }
    };
    BuildPlan::of(value, Pace::RealTime)
}

fn taken(delivery: &Delivery) -> Vec<PieceId> {
    let mut ids = Vec::new();
    delivery.take(|piece| {
        ids.push(piece.id());
        None
    });
    // The order in which they are built is about time only.
    ids.sort_by_key(|id| id.slot());
    ids
}

#[test]
fn an_order_brings_every_piece_and_its_shapes() {
    let mut builder = builder(quick);
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), PieceId::KIT);
    assert!((0..PIECES).all(|slot| builder.shapes().of(slot).is_some()));
    assert!(builder.shapes().of(PIECES).is_none());
}

#[test]
fn a_builder_without_an_order_has_no_thread() {
    assert!(builder(quick).thread.is_none());
}

#[test]
fn pieces_of_an_earlier_order_are_sent_back() {
    let mut builder = builder(quick);
    let _ = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let delivery = builder.order(2.0 * RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), PieceId::KIT);
}

#[test]
fn what_nobody_has_taken_holds_up_no_later_order() {
    let mut builder = Builder::with(quick, Arc::new(|| staffed(2)));
    for _ in 0..3 {
        let _ = builder.order(RATE);
        assert_eq!(builder.wait(LONG), Outcome::Finished);
        // No kit, but workers are on their way.
        let _ = builder.order(1_000.0);
        assert!(matches!(builder.wait(LONG), Outcome::Failed(_)));
    }
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), PieceId::KIT);
}

#[test]
fn a_change_of_plan_is_not_held_up_by_pieces_that_nobody_has_taken() {
    let moved = Arc::new(AtomicBool::new(false));
    let seen = moved.clone();
    let mut builder = Builder::with(quick, Arc::new(move || plan(seen.load(Ordering::Relaxed))));
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    moved.store(true, Ordering::Relaxed);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let mut ids = taken(&delivery);
    ids.sort();
    assert_eq!(ids, PieceId::KIT, "a snare of either plan, or none");
}

#[test]
fn replaced_pieces_are_dropped_by_the_builder() {
    let mut builder = builder(quick);
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let mut replaced = 0;
    delivery.take(|piece| {
        replaced += 1;
        Some(piece)
    });
    assert_eq!(replaced, PIECES);
    let deadline = Instant::now() + LONG;
    while !builder.shared.returned.is_empty() {
        assert!(Instant::now() < deadline, "nobody collected the returned pieces");
        thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_wait_that_runs_out_says_so() {
    let mut builder = builder(slow);
    let _ = builder.order(RATE);
    assert_eq!(builder.wait(Duration::from_millis(1)), Outcome::Late);
}

#[test]
fn a_failure_names_the_piece_and_the_reason() {
    let mut builder = builder(quick);
    let _ = builder.order(1_000.0);
    let Outcome::Failed(reason) = builder.wait(LONG) else { panic!("1 kHz was accepted") };
    assert!(reason.starts_with("kick: sample rate (Hz) is 1000"), "{reason}");
    // The next order starts afresh.
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), PieceId::KIT);
}

#[test]
fn a_panic_while_building_is_a_failure() {
    let mut builder = builder(|_, _| panic!("on purpose"));
    let _ = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Failed("kick: building it panicked".to_owned()));
}

#[test]
fn builders_dropped_at_any_time_stop_after_the_piece_at_hand() {
    for delay in [0, 1, 20, 60, 120] {
        let mut builder = builder(slow);
        let delivery = builder.order(RATE);
        thread::sleep(Duration::from_millis(delay));
        drop(builder);
        // The whole kit was not waited for.
        assert!(taken(&delivery).len() < PIECES);
    }
}

#[test]
fn a_change_of_plan_builds_what_it_concerns_and_nothing_else() {
    let moved = Arc::new(AtomicBool::new(false));
    let wanted = moved.clone();
    let mut builder = Builder::with(quick, Arc::new(move || plan(wanted.load(Ordering::Acquire))));
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), PieceId::KIT);
    moved.store(true, Ordering::Release);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), [PieceId::Snare]);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&delivery), []);
    // Nobody waits: the thread looks by itself.
    moved.store(false, Ordering::Release);
    let deadline = Instant::now() + LONG;
    while taken(&delivery) != [PieceId::Snare] {
        assert!(Instant::now() < deadline, "the change was not noticed");
        thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn workers_come_when_they_are_wanted_and_go_when_not() {
    static WANTED: AtomicBool = AtomicBool::new(false);
    let wanted = || staffed(usize::from(WANTED.load(Ordering::Relaxed)));
    let mut builder = Builder::with(quick, Arc::new(wanted));
    let delivery = builder.order(RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    delivery.take_crew(|_| unreachable!("nobody was wanted"));
    let hired = |wanted: bool, former: Option<Box<dyn Crew>>| {
        WANTED.store(wanted, Ordering::Relaxed);
        assert_eq!(builder.wait(LONG), Outcome::Finished);
        let mut present = None;
        delivery.take_crew(|crew| {
            present = crew;
            former
        });
        present
    };
    let crew = hired(true, None);
    assert!(crew.is_some());
    assert!(hired(false, crew).is_none());
    // No piece was built anew for that.
    assert_eq!(taken(&delivery).len(), PIECES);
}
