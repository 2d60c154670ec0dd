//! Numbers too small to be normal cost a hundred times as much on some processors: none arises of strokes and what fades, whatever
//! mode a host leaves the processor in. A processor notes them by itself.
#![cfg(target_arch = "x86_64")]

use overhear_engine::kit::{BLOCK, Control, Kit};
use overhear_engine::modal::simd::level::InstructionSet;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use overhear_tests::{Chance, kit, standard, stroke};

const RATE: f64 = 44_100.0;

/// Bits of the control and status word: an operand was denormal, a result was too small to be normal; and all that are noted.
const DENORMAL: u32 = 1 << 1;
const UNDERFLOW: u32 = 1 << 4;
const NOTED: u32 = 0x3f;

/// Whether denormal numbers arise.
#[allow(unsafe_code)]
fn makes_denormals(work: impl FnOnce()) -> bool {
    let mut word: u32 = 0;
    // SAFETY: reads and writes the word at a valid place; only what has been noted changes, not how numbers are rounded.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word) };
    word &= !NOTED;
    // SAFETY: as above.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word) };
    work();
    // SAFETY: as above.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word) };
    word & (DENORMAL | UNDERFLOW) != 0
}

/// Plays a kit for so long (s), after what happens before each block. At most one of so many blocks may make denormal numbers; on processors
/// without multiply-adds, where products are numbers by themselves, one of thirty.
fn play(kit: &mut Kit, seconds: f64, one_of: usize, mut before: impl FnMut(&mut Kit, usize)) {
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let blocks = (seconds * RATE) as usize / BLOCK;
    let makes = |&block: &usize| {
        before(kit, block);
        makes_denormals(|| kit.render(&mut left, &mut right))
    };
    let found: Vec<usize> = (0..blocks).filter(makes).collect();
    let one_of = if InstructionSet::Avx2.is_available() { one_of } else { 30 };
    assert!(found.len() <= blocks / one_of, "{} of {blocks} blocks, first {:?}", found.len(), found.first());
}

/// None of as many blocks as there can be.
const NEVER: usize = usize::MAX;

fn strikers() -> impl Iterator<Item = (Slot, Striker)> {
    let struck = standard();
    let stick = |piece: &str| if piece == "kick" { Striker::FeltBeater } else { Striker::Stick };
    let all: Vec<_> = struck.slots().map(|(slot, piece)| (slot, stick(&piece.name))).collect();
    all.into_iter()
}

#[test]
fn a_denormal_number_is_noticed() {
    let tiny = |x: f32| assert_eq!(std::hint::black_box(x) * 1e-20 == 0.0, x == 0.0);
    assert!(!makes_denormals(|| tiny(1e-10)) && !makes_denormals(|| tiny(0.0)));
    assert!(makes_denormals(|| tiny(1e-20)));
}

#[test]
fn no_stroke_makes_denormal_numbers() {
    for speed in [0.3, 2.0, 8.0] {
        let mut kit = kit(RATE);
        strikers().for_each(|(slot, striker)| kit.strike(slot, &stroke(striker, speed, 0.4, 1.0)));
        println!("strokes of {speed} m/s");
        play(&mut kit, 1.0, NEVER, |_, _| {});
    }
}

#[test]
fn nothing_that_fades_makes_denormal_numbers() {
    let mut kit = kit(RATE);
    strikers().for_each(|(slot, striker)| kit.strike(slot, &stroke(striker, 0.5, 0.4, 1.0)));
    play(&mut kit, 20.0, NEVER, |_, _| {});
}

#[test]
fn cymbals_of_the_highest_quality_make_no_denormal_numbers() {
    let spec = standard();
    for name in ["crash", "splash", "hi-hat"] {
        let (slot, _) = spec.find(name).expect("a piece of the kit");
        let build = spec.build(slot).expect("a piece in its slot");
        let options = BuildOptions { quality: Quality::Offline, ..BuildOptions::new(RATE) };
        let mut kit = Kit::new(RATE, &spec);
        drop(kit.install(Box::new(Piece::new(slot, &build, &options).expect("a piece"))));
        kit.strike(slot, &stroke(Striker::Stick, 6.0, 0.9, 0.0));
        println!("{name}");
        play(&mut kit, 0.3, NEVER, |_, _| {});
    }
}

#[test]
fn controls_and_rolls_make_hardly_any_denormal_numbers() {
    let mut chance = Chance::new(11);
    let tunings: Vec<_> =
        standard().slots().map(|(slot, piece)| (slot, piece.instrument.tunings())).collect();
    // Energies of bodies that hardly move may be: of heads in which other pieces are heard, of plates that a hand has just stopped.
    play(&mut kit(RATE), 6.0, 100, |kit, block| {
        // As dense as can be for two seconds, and then a silence.
        if block % 10 != 0 || block > (2.0 * RATE) as usize / BLOCK {
            return;
        }
        let (slot, [low, _, high]) = chance.of(&tunings);
        match chance.below(6) {
            0 => kit.set(Control::Tuning(slot), chance.between(low, high)),
            1 => kit.set(Control::Muffling(slot), chance.unit()),
            2 => kit.set(Control::Level(slot), chance.between(-70.0, 6.0)),
            3 => kit.set(Control::Pedal(slot), chance.unit()),
            _ => kit.strike(slot, &chance.stroke(8.0)),
        }
    });
}
