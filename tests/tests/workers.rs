//! Workers change no sample, and no failure of a worker stops the audio thread.

use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use overhear::workers::{Patience, Workers};
use overhear_engine::kit::{Control, Kit, Microphone, RenderJob, RenderWorkers};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{Chance, RATES, kit, kit_of, sixteen, standard, stroke};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// A stroke on a piece, or a control moved.
type Event = (Slot, Result<Strike, (Control, f64)>);

/// A groove on every piece with controls moving, many things a second, by sample.
fn score(seconds: f64, rate: f64) -> Vec<(usize, Event)> {
    let mut chance = Chance::new(rate as u64);
    let frames = (seconds * rate) as usize;
    let tunings: Vec<_> =
        standard().slots().map(|(slot, piece)| (slot, piece.instrument.tunings())).collect();
    let mut score: Vec<_> = (0..(25.0 * seconds) as usize)
        .map(|_| {
            let (slot, [low, _, high]) = chance.of(&tunings);
            let what = match chance.below(8) {
                0 => Err((Control::Tuning(slot), chance.between(low, high))),
                1 => Err((Control::Muffling(slot), chance.unit())),
                2 => Err((Control::Pan(slot), chance.between(-1.0, 1.0))),
                3 => Err((Control::Sympathy, chance.unit())),
                4 => Err((Control::MicrophoneLevel(Microphone::Room), chance.between(-20.0, 0.0))),
                _ => Ok(chance.stroke(6.0)),
            };
            (chance.below(frames), (slot, what))
        })
        .collect();
    score.sort_by_key(|&(at, _)| at);
    score
}

/// Plays it in buffers of the lengths that `buffer` gives.
fn play(rate: f64, seconds: f64, workers: usize, mut buffer: impl FnMut() -> usize) -> Vec<[u32; 2]> {
    let mut kit = kit(rate);
    if workers > 0 {
        let workers = Workers::new(workers, Patience::Offline, RenderJob::render).expect("threads");
        assert!(kit.attach(Some(Box::new(workers))).is_none());
    }
    let frames = (seconds * rate) as usize;
    let (mut left, mut right) = (vec![f32::NAN; frames], vec![f32::NAN; frames]);
    let score = score(seconds, rate);
    let (mut events, mut done, mut buffer_end) = (score.iter().peekable(), 0, 0);
    while done < frames {
        if done == buffer_end {
            buffer_end = (done + buffer()).min(frames);
        }
        while let Some((_, (slot, what))) = events.next_if(|&&(at, _)| at == done) {
            match what {
                Ok(strike) => kit.strike(*slot, strike),
                Err((control, value)) => kit.set(*control, *value),
            }
        }
        let end = events.peek().map_or(buffer_end, |&&(at, _)| at.min(buffer_end));
        kit.render(&mut left[done..end], &mut right[done..end]);
        done = end;
    }
    let mut snapshot = KitSnapshot::default();
    kit.snapshot(&mut snapshot);
    assert_eq!(snapshot.missed_runs, 0);
    left.iter().zip(&right).map(|(left, right)| [left.to_bits(), right.to_bits()]).collect()
}

fn same_bits(rate: f64, seconds: f64, workers: &[usize], buffers: &[usize]) {
    let whole = play(rate, seconds, 0, || 512);
    let loud = whole.iter().filter(|&&[left, _]| f32::from_bits(left).abs() > 1e-3).count();
    assert!(loud > whole.len() / 2, "{loud} of {}", whole.len());
    for &workers in workers {
        for &length in buffers {
            let mut chance = Chance::new(7);
            // A length of 0 is one of all.
            let buffer = || if length == 0 { 1 + chance.below(2_000) } else { length };
            assert!(
                whole == play(rate, seconds, workers, buffer),
                "{workers} workers, {length} at {rate} Hz"
            );
        }
    }
}

/// Strikes pieces of a kit at rest at once and renders so many samples in buffers of a length; one of 0 is any.
fn hit(kit: &mut Kit, struck: &[Slot], frames: usize, buffer: usize) -> [Vec<u32>; 2] {
    let mut chance = Chance::new(7);
    kit.reset();
    for slot in struck {
        kit.strike(*slot, &stroke(Striker::Stick, 5.0, 0.4, 0.2));
    }
    let (mut left, mut right) = (vec![f32::NAN; frames], vec![f32::NAN; frames]);
    let mut done = 0;
    while done < frames {
        let length = if buffer == 0 { 1 + chance.below(2_000) } else { buffer };
        let end = (done + length).min(frames);
        kit.render(&mut left[done..end], &mut right[done..end]);
        done = end;
    }
    [left, right].map(|side| side.into_iter().map(f32::to_bits).collect())
}

fn hits_are_the_same_on_0_1_and_3_workers_in_any_buffers(spec: &KitSpec, struck: &[Slot], frames: usize) {
    let mut kit = kit_of(spec, RATES[0]);
    let whole = hit(&mut kit, struck, frames, frames);
    assert!(whole[0].iter().any(|&x| f32::from_bits(x).abs() > 0.05));
    for count in [0, 1, 3] {
        let workers = (count > 0).then(|| -> Box<dyn RenderWorkers> {
            Box::new(Workers::new(count, Patience::Offline, RenderJob::render).expect("threads"))
        });
        drop(kit.attach(workers));
        for buffer in [1, 17, 64, 512, 8192, 0] {
            let again = hit(&mut kit, struck, frames, buffer);
            assert!(whole == again, "{count} workers, buffers of {buffer}");
        }
    }
}

#[test]
fn a_hit_on_five_pieces_is_the_same_on_0_1_and_3_workers_in_any_buffers() {
    hits_are_the_same_on_0_1_and_3_workers_in_any_buffers(&standard(), &Slot::ALL[..5], 11_025);
}

#[test]
fn a_hit_on_sixteen_pieces_is_the_same_on_0_1_and_3_workers_in_any_buffers() {
    hits_are_the_same_on_0_1_and_3_workers_in_any_buffers(&sixteen(), &Slot::ALL, 6_000);
}

#[test]
fn workers_and_buffers_change_no_sample() {
    same_bits(RATES[0], 1.5, &[1, 3], &[0]);
    same_bits(RATES[1], 0.7, &[1, 3], &[64, 8192]);
}

#[test]
#[ignore = "a quarter of an hour: 0, 1, 3 workers, six kinds of buffers, three rates, ten seconds each"]
fn workers_and_buffers_change_no_sample_of_ten_seconds() {
    for rate in &RATES[..3] {
        same_bits(*rate, 10.0, &[0, 1, 3], &[1, 17, 64, 512, 8192, 0]);
    }
}

/// Longest that a test waits for the system to let workers work, were this machine doing nothing else.
const LONG: Duration = Duration::from_secs(60);

/// Strikes everything with workers of that kind and plays until `done`, then until every job is back.
fn play_with(patience: Patience, render: fn(&mut RenderJob), done: impl Fn() -> bool) -> (KitSnapshot, f32) {
    const RATE: f64 = RATES[0];
    let mut kit = kit(RATE);
    kit.attach(Some(Box::new(Workers::new(2, patience, render).expect("threads"))));
    let (mut left, mut right) = (vec![0.0; 4_410], vec![0.0; 4_410]);
    let (begun, mut loudest, mut snapshot) = (Instant::now(), 0.0_f32, KitSnapshot::default());
    // How much of the work a worker gets is for the system to say.
    while !done() {
        assert!(begun.elapsed() < LONG, "the workers had nothing to do");
        for (slot, _) in standard().slots() {
            kit.strike(slot, &stroke(Striker::Stick, 4.0, 0.35, 0.0));
        }
        kit.render(&mut left, &mut right);
        assert!(left.iter().chain(&right).all(|x| x.is_finite()));
        loudest = left[64..].iter().fold(loudest, |peak, x| peak.max(x.abs()));
    }
    loop {
        kit.render(&mut left[..64], &mut right[..64]);
        kit.snapshot(&mut snapshot);
        if standard().slots().all(|(slot, _)| snapshot.pieces[slot.index()].ready) {
            return (snapshot, loudest);
        }
        assert!(begun.elapsed() < LONG, "a piece has not come back");
        thread::sleep(Duration::from_millis(10));
    }
}

fn on_a_worker() -> bool {
    thread::current().name().is_some_and(|name| name.starts_with("overhear worker"))
}

#[test]
fn a_worker_that_stalls_holds_nobody_up_and_is_counted() {
    static CALLS: AtomicU32 = AtomicU32::new(0);
    let stall = |job: &mut RenderJob| {
        if on_a_worker() && CALLS.fetch_add(1, Ordering::Relaxed) == 20 {
            thread::sleep(Duration::from_secs(1));
        }
        job.render();
    };
    let (snapshot, loudest) = play_with(Patience::RealTime, stall, || CALLS.load(Ordering::Relaxed) > 20);
    assert!(snapshot.missed_runs > 0 && loudest > 0.01, "{} runs", snapshot.missed_runs);
    assert!(snapshot.pieces.iter().all(|piece| piece.quarantines == 0));
}

#[test]
fn a_worker_that_panics_gives_its_piece_back() {
    static CALLS: AtomicU32 = AtomicU32::new(0);
    let panic = |job: &mut RenderJob| {
        if on_a_worker() && CALLS.fetch_add(1, Ordering::Relaxed) == 20 {
            panic!("as the test wants it");
        }
        job.render();
    };
    // Patient, so that no other run is missed however busy the machine is.
    let (snapshot, loudest) = play_with(Patience::Offline, panic, || CALLS.load(Ordering::Relaxed) > 20);
    assert!(snapshot.missed_runs == 1 && loudest > 0.01, "{} runs", snapshot.missed_runs);
}

/// Renders all jobs but keeps one that it is told to keep, for so many runs.
struct Keeping {
    kept: Option<(usize, Box<RenderJob>)>,
    runs: u32,
}

impl RenderWorkers for Keeping {
    fn render(&mut self, jobs: &mut [Option<Box<RenderJob>>]) {
        jobs.iter_mut().flatten().for_each(|job| job.render());
        if self.runs > 0 {
            self.runs -= 1;
            let slot = jobs.iter().position(|job| job.as_ref().is_some_and(|job| job.is_busy()));
            self.kept = self.kept.take().or_else(|| slot.map(|slot| (slot, jobs[slot].take().unwrap())));
        } else if let Some((slot, job)) = self.kept.take() {
            jobs[slot] = Some(job);
        }
    }
}

#[test]
fn a_piece_that_was_away_during_a_reset_plays_on_with_its_kit() {
    let tom = standard().slots().find(|(_, piece)| piece.name == "rack-tom").unwrap().0;
    let render = |kit: &mut Kit, samples: usize| {
        let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
        kit.render(&mut left, &mut right);
        left
    };
    // The clock comes to where the run that is away ended, before or after that or there, not at the start of a block.
    for after in [8, 16, 24] {
        let mut kits = [2, 0].map(|runs| {
            let mut kit = kit(48_000.0);
            assert!(kit.attach(Some(Box::new(Keeping { kept: None, runs }))).is_none());
            kit.strike(tom, &stroke(Striker::Stick, 3.0, 0.3, 0.2));
            render(&mut kit, 16);
            assert_eq!(kit.is_whole(), runs == 0);
            kit.reset();
            render(&mut kit, after - 1);
            render(&mut kit, 1);
            assert!(kit.is_whole());
            kit.strike(tom, &stroke(Striker::Stick, 3.0, 0.3, 0.2));
            kit
        });
        let [away, there] = kits.each_mut().map(|kit| render(kit, 4_800));
        assert!(away == there, "{after} samples after the reset");
    }
}

/// A kit with workers under many strokes.
struct Stage {
    kit: Kit,
    left: Vec<f32>,
    right: Vec<f32>,
    chance: Chance,
    /// How many pieces the kit has.
    pieces: usize,
}

impl Stage {
    fn new(seed: u64) -> Stage {
        let mut kit = kit(RATES[0]);
        kit.attach(Some(Box::new(Workers::new(2, Patience::RealTime, RenderJob::render).expect("threads"))));
        Stage {
            kit,
            left: vec![0.0; 512],
            right: vec![0.0; 512],
            chance: Chance::new(seed),
            pieces: standard().pieces.len(),
        }
    }

    fn act(&mut self) {
        let slot = Slot::ALL[self.chance.below(self.pieces)];
        let strike = self.chance.stroke(8.0);
        self.kit.strike(slot, &strike);
        let frames = 1 + self.chance.below(200);
        self.kit.render(&mut self.left[..frames], &mut self.right[..frames]);
    }
}

#[test]
fn nothing_allocates_on_the_audio_thread_while_workers_work() {
    let mut stage = Stage::new(1);
    reset_violation_count();
    for _ in 0..300 {
        assert_no_alloc(|| stage.act());
    }
    assert_eq!(violation_count(), 0);
}

/// In a child of this test, whose audio thread forbids itself all system calls.
#[cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod system_calls {
    use overhear_tests::system_calls::{child_gets_to_its_end, done, forbid};

    use super::Stage;

    #[test]
    #[ignore = "run in a child process by the test below"]
    fn child_that_renders() {
        let mut stage = Stage::new(2);
        forbid();
        for _ in 0..300 {
            stage.act();
        }
        done(true);
    }

    #[test]
    fn the_audio_thread_makes_no_system_call_while_workers_work() {
        child_gets_to_its_end("system_calls::child_that_renders");
    }
}
