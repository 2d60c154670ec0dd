use std::sync::atomic::{AtomicBool, AtomicUsize};

use super::*;
use crate::building::Pace;
use crate::deadline::Deadlines;
use crate::kit_document::standard_slot;
use crate::midi_map::NoteTable;
use crate::parameters::parameters;
use overhear_engine::kit::RenderWorkers;
use overhear_engine::kit_spec::InstrumentSpec;

const RATE: f64 = 48_000.0;
const LONG: Duration = Duration::from_secs(120);

fn quick(slot: Slot, build: &PieceBuild, options: &BuildOptions) -> Result<Piece, SpecError> {
    Piece::new(slot, build, options)
}

fn slow(slot: Slot, build: &PieceBuild, options: &BuildOptions) -> Result<Piece, SpecError> {
    thread::sleep(Duration::from_millis(300));
    quick(slot, build, options)
}

/// A plan of a kit with every parameter at its default.
fn plan_of(document: KitDocument) -> BuildPlan {
    BuildPlan::of(Arc::new(document), |index| parameters()[index].default, Pace::RealTime)
}

/// A builder whose workers nobody waits for.
fn with(make: Make, wanted: Wanted) -> Builder {
    Builder::with(make, wanted, Arc::new(Deadlines::default()))
}

/// A builder of the default plan.
fn builder(make: Make) -> Builder {
    with(make, Arc::new(|| plan_of(KitDocument::standard())))
}

/// The standard kit with another ratio for the snare if `moved`.
fn kit(moved: bool) -> KitDocument {
    let mut document = KitDocument::standard();
    let snare = &mut document.kit.pieces[standard_slot("snare").index()];
    if let InstrumentSpec::Drum(drum) = &mut snare.instrument
        && let Some(resonant) = drum.resonant.as_mut().filter(|_| moved)
    {
        resonant.pitch_ratio = 1.3;
    }
    document
}

/// A plan with so many workers.
fn staffed(workers: usize) -> BuildPlan {
    let value = |index: usize| {
        let parameter = &parameters()[index];
        if parameter.name == "render_threads" { workers as f32 } else { parameter.default }
    };
    BuildPlan::of(Arc::default(), value, Pace::RealTime)
}

/// Orders pieces for a performer at the standard kit.
fn ordered(builder: &mut Builder, rate: f64) -> Delivery {
    builder.order(rate, Arc::default())
}

/// The pieces that have arrived, by slot, and how many setups with them.
fn arrived(delivery: &mut Delivery) -> (Vec<usize>, usize) {
    let (mut slots, mut setups) = (Vec::new(), 0);
    delivery.take(|arrival| {
        match arrival {
            Arrival::Piece(piece) => slots.push(piece.slot().index()),
            Arrival::Setup(_) => setups += 1,
        }
        None
    });
    // The order in which they are built is about time only.
    slots.sort();
    (slots, setups)
}

fn taken(delivery: &mut Delivery) -> Vec<usize> {
    let (slots, setups) = arrived(delivery);
    assert_eq!(setups, 0, "the kit is the same");
    slots
}

/// The slots of the standard kit.
const ALL: [usize; 9] = [0, 1, 2, 3, 4, 5, 6, 7, 8];

#[test]
fn an_order_brings_every_piece_and_its_shapes() {
    let mut builder = builder(quick);
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
    for slot in Slot::ALL {
        assert_eq!(builder.shapes().of(slot).is_some(), slot.index() < ALL.len());
    }
}

#[test]
fn a_builder_without_an_order_has_no_thread() {
    assert!(builder(quick).thread.is_none());
}

#[test]
fn pieces_of_an_earlier_order_are_sent_back() {
    let mut builder = builder(quick);
    let _ = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let mut delivery = ordered(&mut builder, 2.0 * RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
}

#[test]
fn what_nobody_has_taken_holds_up_no_later_order() {
    let mut builder = with(quick, Arc::new(|| staffed(2)));
    for _ in 0..3 {
        let _ = ordered(&mut builder, RATE);
        assert_eq!(builder.wait(LONG), Outcome::Finished);
        // No kit, but workers are on their way.
        let _ = ordered(&mut builder, 1_000.0);
        assert!(matches!(builder.wait(LONG), Outcome::Failed(_)));
    }
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
}

#[test]
fn a_change_of_plan_is_not_held_up_by_pieces_that_nobody_has_taken() {
    let moved = Arc::new(AtomicBool::new(false));
    let seen = moved.clone();
    let mut builder = with(quick, Arc::new(move || plan_of(kit(seen.load(Ordering::Relaxed)))));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    moved.store(true, Ordering::Relaxed);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let (mut slots, setups) = arrived(&mut delivery);
    slots.dedup();
    assert_eq!((slots.as_slice(), setups), (&ALL[..], 1), "a snare of either kit, or none");
}

#[test]
fn who_waits_waits_for_a_change_that_the_thread_has_noticed_by_itself() {
    let moved = Arc::new(AtomicBool::new(false));
    let wanted = moved.clone();
    let mut builder = with(slow, Arc::new(move || plan_of(kit(wanted.load(Ordering::Acquire)))));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
    moved.store(true, Ordering::Release);
    let deadline = Instant::now() + LONG;
    while lock(&builder.shared.desk).jobs < 2 {
        assert!(Instant::now() < deadline, "the change was not noticed");
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(arrived(&mut delivery), (vec![standard_slot("snare").index()], 1));
}

#[test]
fn replaced_pieces_are_dropped_by_the_builder() {
    let mut builder = builder(quick);
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let mut replaced = 0;
    delivery.take(|arrival| {
        replaced += 1;
        Some(arrival)
    });
    assert_eq!(replaced, ALL.len());
    let deadline = Instant::now() + LONG;
    while !builder.shared.queues.returned.is_empty() {
        assert!(Instant::now() < deadline, "nobody collected the returned pieces");
        thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_wait_that_runs_out_says_so() {
    let mut builder = builder(slow);
    let _ = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(Duration::from_millis(1)), Outcome::Late);
    let begun = Instant::now();
    while !builder.is_building() {
        assert!(begun.elapsed() < LONG, "it does not say that it builds");
        thread::yield_now();
    }
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert!(!builder.is_building());
}

#[test]
fn a_failure_names_the_piece_and_the_reason() {
    let mut builder = builder(quick);
    let _ = ordered(&mut builder, 1_000.0);
    let Outcome::Failed(reason) = builder.wait(LONG) else { panic!("1 kHz was accepted") };
    assert!(reason.starts_with("kick: sample rate (Hz) is 1000"), "{reason}");
    // The next order starts afresh.
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
}

#[test]
fn a_panic_while_building_is_a_failure() {
    let mut builder = builder(|_, _, _| panic!("on purpose"));
    let _ = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Failed("kick: building it panicked".to_owned()));
}

#[test]
fn builders_dropped_at_any_time_stop_after_the_piece_at_hand() {
    for delay in [0, 1, 20, 60, 120] {
        let mut builder = builder(slow);
        let mut delivery = ordered(&mut builder, RATE);
        thread::sleep(Duration::from_millis(delay));
        drop(builder);
        // The whole kit was not waited for.
        assert!(taken(&mut delivery).len() < ALL.len());
    }
}

#[test]
fn a_change_of_plan_builds_what_it_concerns_and_nothing_else() {
    let moved = Arc::new(AtomicBool::new(false));
    let wanted = moved.clone();
    let mut builder = with(quick, Arc::new(move || plan_of(kit(wanted.load(Ordering::Acquire)))));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
    let snare = vec![standard_slot("snare").index()];
    moved.store(true, Ordering::Release);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(arrived(&mut delivery), (snare.clone(), 1));
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(arrived(&mut delivery), (vec![], 0));
    // Nobody waits: the thread looks by itself.
    moved.store(false, Ordering::Release);
    let deadline = Instant::now() + LONG;
    let (mut slots, mut setups) = (Vec::new(), 0);
    while (&slots, setups) != (&snare, 1) {
        assert!(Instant::now() < deadline, "the change was not noticed");
        thread::sleep(Duration::from_millis(10));
        let (more, further) = arrived(&mut delivery);
        slots.extend(more);
        setups += further;
    }
}

#[test]
fn a_change_of_quality_builds_cymbals_and_drums_anew_without_a_setup() {
    let high = Arc::new(AtomicBool::new(false));
    let wanted = high.clone();
    let plan = move || {
        let value = |index: usize| {
            let parameter = &parameters()[index];
            let eco = parameter.name == "quality" && wanted.load(Ordering::Acquire);
            if eco { 0.0 } else { parameter.default }
        };
        BuildPlan::of(Arc::default(), value, Pace::RealTime)
    };
    let mut builder = with(quick, Arc::new(plan));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
    high.store(true, Ordering::Release);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    assert_eq!(taken(&mut delivery), ALL);
}

/// The standard kit with as many pieces, copies of the splash behind those of the standard one.
fn sized(pieces: usize) -> KitDocument {
    let mut kit = KitDocument::standard().kit;
    let splash = kit.piece(standard_slot("splash")).unwrap().clone();
    kit.pieces.truncate(pieces);
    for number in kit.pieces.len()..pieces {
        kit.pieces.push(overhear_engine::kit_spec::PieceSpec {
            name: format!("splash-{number}"),
            ..splash.clone()
        });
    }
    let notes = NoteTable::standard(&kit);
    KitDocument { kit, notes }
}

#[test]
fn another_kit_is_announced_before_its_pieces_and_nothing_of_vacated_slots_arrives() {
    let pieces = Arc::new(AtomicUsize::new(9));
    let wanted = pieces.clone();
    let mut builder = with(quick, Arc::new(move || plan_of(sized(wanted.load(Ordering::Acquire)))));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    // Nobody takes anything while the kit grows to its largest and shrinks.
    for count in [16, 1, 12, 3] {
        pieces.store(count, Ordering::Release);
        assert_eq!(builder.wait(LONG), Outcome::Finished);
        for slot in Slot::ALL {
            assert_eq!(builder.shapes().of(slot).is_some(), slot.index() < count, "{slot:?} of {count}");
        }
    }
    let mut latest = None;
    let mut arrived = Vec::new();
    delivery.take(|arrival| {
        match arrival {
            Arrival::Setup(setup) => {
                arrived.retain(|slot| setup.has(*slot));
                latest = Some(Slot::ALL.map(|slot| setup.has(slot)));
            }
            Arrival::Piece(piece) => arrived.push(piece.slot()),
        }
        None
    });
    let latest = latest.expect("no setup");
    assert_eq!(latest.iter().filter(|has| **has).count(), 3);
    assert!(arrived.iter().all(|slot| latest[slot.index()]), "{arrived:?}");
    assert!((0..3).all(|slot| arrived.contains(&Slot::ALL[slot])), "{arrived:?}");
}

#[test]
fn an_order_for_a_performer_at_another_kit_brings_a_setup_first() {
    let mut builder = with(quick, Arc::new(|| plan_of(sized(2))));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    let mut first = None;
    delivery.take(|arrival| {
        first.get_or_insert(matches!(arrival, Arrival::Setup(_)));
        None
    });
    assert_eq!(first, Some(true));
}

#[test]
fn workers_come_when_they_are_wanted_and_go_when_not() {
    static WANTED: AtomicBool = AtomicBool::new(false);
    let wanted = || staffed(usize::from(WANTED.load(Ordering::Relaxed)));
    let mut builder = with(quick, Arc::new(wanted));
    let mut delivery = ordered(&mut builder, RATE);
    assert_eq!(builder.wait(LONG), Outcome::Finished);
    delivery.take_workers(|_| unreachable!("nobody was wanted"));
    let hired = |wanted: bool, former: Option<Box<dyn RenderWorkers>>| {
        WANTED.store(wanted, Ordering::Relaxed);
        assert_eq!(builder.wait(LONG), Outcome::Finished);
        let mut present = None;
        delivery.take_workers(|workers| {
            present = workers;
            former
        });
        present
    };
    let workers = hired(true, None);
    assert!(workers.is_some());
    assert!(hired(false, workers).is_none());
    // No piece was built anew for that.
    assert_eq!(taken(&mut delivery).len(), ALL.len());
}
