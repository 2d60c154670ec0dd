//! What the audio thread must not do: allocate, ask the system for anything, wait.
//!
//! Allocations are counted by the allocator of this test. System calls are caught by the kernel
//! (Linux): a child process forbids itself all of them and renders. A free lock makes no
//! call, so the test also checks that the engine's source names no lock.

use std::path::Path;

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use overhear_engine::kit::{Arrangement, Control, Kit};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec};
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::Strike;
use overhear_engine::surface::rivets::{self, RivetsSpec};
use overhear_tests::{Chance, kit_of, member, slot, standard};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

const RATE: f64 = 44_100.0;

/// Everything the audio thread works with, made beforehand.
struct Stage {
    kit: Kit,
    /// The slots with a piece, and between what pitches it can be tuned.
    slots: Vec<(Slot, [f64; 3])>,
    /// Pieces to swap in; what they replace comes back here.
    #[expect(clippy::vec_box, reason = "a kit takes boxes, and boxing allocates")]
    spares: Vec<Box<Piece>>,
    /// Other places of every piece, another room; what the kit had before comes back here.
    arrangement: Option<Box<Arrangement>>,
    snapshot: KitSnapshot,
    left: Vec<f32>,
    right: Vec<f32>,
    chance: Chance,
}

/// The standard kit, narrower and in a drier room.
fn elsewhere() -> KitSpec {
    let mut kit = standard();
    kit.pieces.iter_mut().for_each(|piece| piece.place.centre[0] *= 0.8);
    kit.room.time = 0.3;
    kit
}

/// The standard kit with as many rivets in its splash as fit.
fn riveted() -> KitSpec {
    let mut kit = standard();
    let splash = kit.pieces.iter_mut().find(|piece| piece.name == "splash").expect("a splash");
    if let InstrumentSpec::Cymbal(cymbal) = &mut splash.instrument {
        let number = rivets::MOST as u32;
        cymbal.rivets =
            Some(RivetsSpec { number, radius: 0.9, arc: None, toward: 0.0, mass: 1e-3, play: 2e-3 });
    }
    kit
}

/// Numbers that no control expects.
const ODD: [f64; 10] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, -0.0, 1e-310, 1e300, -1e300, f64::MAX];

impl Stage {
    fn new(seed: u64) -> Stage {
        Stage {
            kit: kit_of(&riveted(), RATE),
            slots: standard().slots().map(|(slot, piece)| (slot, piece.instrument.tunings())).collect(),
            spares: ["snare", "splash", "timpani"]
                .map(|name| Box::new(member(&riveted(), slot(name), RATE)))
                .into(),
            arrangement: Some(Box::new(Arrangement::new(RATE, &elsewhere()))),
            snapshot: KitSnapshot::default(),
            left: vec![0.0; 8192],
            right: vec![0.0; 8192],
            chance: Chance::new(seed),
        }
    }

    /// One thing a host may do, and the buffer after it.
    fn act(&mut self) {
        let chance = &mut self.chance;
        let (slot, [low, _, high]) = chance.of(&self.slots);
        match chance.below(1000) {
            0..500 => {
                let stroke = chance.stroke(30.0);
                self.kit.strike(slot, &stroke);
            }
            500..530 => {
                let odd = Strike {
                    speed: chance.of(&ODD),
                    radius: chance.of(&ODD),
                    angle: chance.of(&ODD),
                    ..chance.stroke(1.0)
                };
                self.kit.strike(slot, &odd);
            }
            530..980 => {
                // Of pieces without wires or a pedal, too.
                let (control, from, to) = match chance.below(7) {
                    0 => (Control::Tuning(slot), 0.8 * low, 1.2 * high),
                    1 => (Control::Muffling(slot), -0.2, 1.2),
                    2 => (Control::Level(slot), -80.0, 30.0),
                    3 => (Control::Preload(slot), -0.1, 3.0),
                    4 => (Control::Wires(slot), -1.0, 2.0),
                    5 => (Control::Pedal(slot), -0.2, 1.2),
                    _ => (Control::Master, -80.0, 30.0),
                };
                let value = if chance.below(8) == 0 { chance.of(&ODD) } else { chance.between(from, to) };
                self.kit.set(control, value);
            }
            980..990 => self.kit.snapshot(&mut self.snapshot),
            990..996 => {
                let spare = chance.below(self.spares.len().max(1));
                // All may be fading out in the kit.
                if spare < self.spares.len() {
                    let spare = self.spares.swap_remove(spare);
                    self.spares.extend(self.kit.install(spare));
                }
            }
            996 => self.kit.finish_controls(),
            997 => self.arrangement = self.arrangement.take().map(|other| self.kit.arrange(other)),
            _ => self.kit.reset(),
        }
        self.spares.extend(self.kit.retire());
        // Mostly small buffers; now and then the largest.
        let longest = self.chance.of(&[1, 1, 2, 4, 8, 16, 33, 64]);
        let frames = if self.chance.below(4000) == 0 { 8192 } else { 1 + self.chance.below(longest) };
        self.kit.render(&mut self.left[..frames], &mut self.right[..frames]);
    }

    fn is_sound(&self) -> bool {
        self.left.iter().chain(&self.right).all(|x| x.is_finite())
    }
}

#[test]
fn nothing_allocates_while_ten_thousand_events_arrive() {
    let mut stage = Stage::new(1);
    reset_violation_count();
    for event in 0..10_000 {
        assert_no_alloc(|| stage.act());
        assert_eq!(violation_count(), 0, "at event {event}");
        assert!(stage.is_sound(), "at event {event}");
    }
    stage.kit.snapshot(&mut stage.snapshot);
    for &(slot, _) in &stage.slots {
        let piece = &stage.snapshot.pieces[slot.index()];
        assert!(piece.ready && piece.quarantines == 0, "{slot:?}");
    }
    // Nothing is lost: what fades out is handed back once it has.
    stage.kit.render(&mut stage.left, &mut stage.right);
    stage.spares.extend(std::iter::from_fn(|| stage.kit.retire()));
    assert_eq!(stage.spares.len(), 3);
}

#[test]
fn the_trap_catches_an_allocation_and_a_release() {
    reset_violation_count();
    let kept = assert_no_alloc(|| std::hint::black_box(vec![1.0_f32; 100]));
    assert_eq!(violation_count(), 1);
    assert_no_alloc(|| drop(std::hint::black_box(kept)));
    assert_eq!(violation_count(), 2);
    reset_violation_count();
}

#[test]
fn a_stroke_that_is_no_number_is_not_played() {
    let mut stage = Stage::new(2);
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let sound = Strike { speed: 3.0, radius: 0.4, angle: 0.0, striker: stage.chance.stroke(1.0).striker };
        for strike in
            [Strike { speed: odd, ..sound }, Strike { radius: odd, ..sound }, Strike { angle: odd, ..sound }]
        {
            stage.kit.strike(slot("snare"), &strike);
            stage.kit.render(&mut stage.left, &mut stage.right);
            assert!(stage.left.iter().all(|&x| x == 0.0), "{strike:?}");
        }
    }
}

#[test]
fn a_control_that_is_no_number_changes_nothing() {
    let mut stage = Stage::new(3);
    let snare = slot("snare");
    stage.kit.set(Control::Tuning(snare), 300.0);
    stage.kit.set(Control::Tuning(snare), f64::NAN);
    stage.kit.finish_controls();
    let tension = stage.kit.piece(snare).map(Piece::tensions);
    // Nor what a piece takes over that comes later.
    let later = stage.spares.remove(0);
    assert!(stage.kit.install(later).is_some_and(|before| before.slot() == snare));
    assert_eq!(stage.kit.piece(snare).map(Piece::tensions), tension);
}

#[test]
fn the_engine_names_no_lock_thread_file_or_clock() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../engine/src")];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("the engine's source") {
            let path = entry.expect("a folder's entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // Tests are no part of it; the cache locks while a piece is built, which is never on the audio thread.
            if path.ends_with("tests.rs") || path.ends_with("engine/src/cache.rs") {
                continue;
            }
            files += 1;
            let text = std::fs::read_to_string(&path).expect("a source file");
            for name in
                ["std::sync", "std::thread", "std::fs", "std::io", "std::net", "std::time"].into_iter().chain(
                    ["std::env", "std::process", "Mutex", "RwLock", "Condvar", "println!", "thread_local!"],
                )
            {
                assert!(!text.contains(name), "{name} in {}", path.display());
            }
        }
    }
    assert!(files > 20, "{files}");
}

/// In children of this test, which forbid themselves all system calls.
#[cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod system_calls {
    use std::os::unix::process::ExitStatusExt;

    use overhear_tests::system_calls::{child, child_gets_to_its_end, done, forbid};

    use super::Stage;

    #[test]
    #[ignore = "run in a child process by the test below"]
    fn child_that_renders() {
        let mut stage = Stage::new(4);
        forbid();
        for _ in 0..10_000 {
            stage.act();
        }
        done(stage.is_sound());
    }

    #[test]
    #[ignore = "run in a child process by the test below"]
    fn child_that_sleeps() {
        forbid();
        std::thread::sleep(std::time::Duration::from_nanos(1));
        done(true);
    }

    #[test]
    fn ten_thousand_events_make_no_system_call() {
        child_gets_to_its_end("system_calls::child_that_renders");
    }

    #[test]
    fn the_trap_catches_a_system_call() {
        let status = child("system_calls::child_that_sleeps");
        assert_eq!(status.signal(), Some(libc::SIGSYS), "{status}");
    }
}
