//! Pieces replaced while they ring.

use overhear_engine::kit::{Control, Kit, Microphone};
use overhear_engine::piece::PieceId;
use overhear_engine::strike::Striker;
use overhear_tests::{kit, kit_piece, stroke};

const RATE: f64 = 48_000.0;

/// Samples rendered before the swap; not a multiple of the block.
const BEFORE: usize = 4_801;

fn struck(id: PieceId) -> Kit {
    let mut kit = kit(RATE);
    // Nothing but the piece: the other drums would ring on, the room as well.
    kit.set(Control::Hearing, 0.0);
    kit.set(Control::Mute(Microphone::Overheads), 1.0);
    kit.set(Control::Mute(Microphone::Room), 1.0);
    kit.finish_controls();
    kit.strike(id, &stroke(Striker::Stick, 4.0, 0.4, 0.2));
    kit
}

fn sound(kit: &mut Kit, frames: usize, buffer: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    for (left, right) in left.chunks_mut(buffer).zip(right.chunks_mut(buffer)) {
        kit.render(left, right);
    }
    left
}

/// The greatest second difference: a step of the sound stands out in it, as it does to the ear.
fn roughest(sound: &[f32]) -> f32 {
    sound.windows(3).map(|x| (x[0] - 2.0 * x[1] + x[2]).abs()).fold(0.0, f32::max)
}

#[test]
fn a_piece_that_rings_fades_out_under_the_new_one_without_a_click() {
    for id in [PieceId::Kick, PieceId::FloorTom, PieceId::Timpani, PieceId::Ride] {
        let rang = {
            let mut kit = struck(id);
            sound(&mut kit, BEFORE, 512);
            sound(&mut kit, 2_400, 512)
        };
        let mut kit = struck(id);
        sound(&mut kit, BEFORE, 512);
        assert!(kit.install(Box::new(kit_piece(id, RATE))).is_none(), "it still sounds");
        assert!(kit.retire().is_none(), "it is still fading");
        let faded = sound(&mut kit, 2_400, 512);
        // The fade may bend the sound, never as sharply as the sound bends itself by more than a few per cent.
        assert!(
            roughest(&faded) <= 1.05 * roughest(&rang),
            "{id:?}: {} {}",
            roughest(&faded),
            roughest(&rang)
        );
        assert_eq!(faded[0].signum(), rang[0].signum());
        assert!((faded[10] - rang[10]).abs() < 0.01 * rang.iter().fold(0.0, |a: f32, b| a.max(b.abs())));
        let after = sound(&mut kit, 512, 512);
        assert!(after.iter().all(|sample| *sample == 0.0), "{id:?} goes on after its fade");
        assert!(kit.retire().is_some_and(|piece| piece.id() == id));
        assert!(kit.retire().is_none());
    }
}

#[test]
fn a_swap_sounds_the_same_in_every_buffer_size() {
    let swapped = |buffer| {
        let mut kit = struck(PieceId::Crash);
        let mut all = sound(&mut kit, BEFORE, buffer);
        kit.install(Box::new(kit_piece(PieceId::Crash, RATE)));
        kit.strike(PieceId::Crash, &stroke(Striker::Shoulder, 3.0, 0.97, 0.0));
        all.extend(sound(&mut kit, 4_800, buffer));
        all
    };
    let whole = swapped(9_999);
    for buffer in [1, 17, 64, 333] {
        assert!(swapped(buffer) == whole, "{buffer}");
    }
}

#[test]
fn a_piece_at_rest_is_handed_back_at_once() {
    let mut kit = kit(RATE);
    assert!(kit.install(Box::new(kit_piece(PieceId::Snare, RATE))).is_some());
    assert!(kit.retire().is_none());
}

#[test]
fn swaps_faster_than_the_fade_hand_every_piece_back() {
    let mut kit = struck(PieceId::FloorTom);
    let mut back = 0;
    for _ in 0..5 {
        sound(&mut kit, 100, 100);
        back += usize::from(kit.install(Box::new(kit_piece(PieceId::FloorTom, RATE))).is_some());
        kit.strike(PieceId::FloorTom, &stroke(Striker::Stick, 1.0, 0.3, 0.0));
    }
    kit.reset();
    while kit.retire().is_some() {
        back += 1;
    }
    assert_eq!(back, 5);
}
