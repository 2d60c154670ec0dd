//! Pieces replaced and taken away while they ring.

use std::sync::Arc;

use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::performer::{Performer, Setup};
use overhear::{kit_edits, library};
use overhear_engine::kit::{Arrangement, Control, Kit, Microphone};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use overhear_tests::{kit, member, slot, standard, stroke};

const RATE: f64 = 48_000.0;

/// Samples rendered before the swap; not a multiple of the block.
const BEFORE: usize = 4_801;

fn struck(slot: Slot) -> Kit {
    let mut kit = kit(RATE);
    // Nothing but the piece: the other drums would ring on, the room as well.
    kit.set(Control::SympatheticCoupling, 0.0);
    kit.set(Control::Mute(Microphone::Overheads), 1.0);
    kit.set(Control::Mute(Microphone::Room), 1.0);
    kit.finish_controls();
    kit.strike(slot, &stroke(Striker::Stick, 4.0, 0.4, 0.2));
    kit
}

/// Another piece of the standard kit for a slot.
fn spare(slot: Slot) -> Box<Piece> {
    Box::new(member(&standard(), slot, RATE))
}

fn sound(kit: &mut Kit, frames: usize, buffer: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    for (left, right) in left.chunks_mut(buffer).zip(right.chunks_mut(buffer)) {
        kit.render(left, right);
    }
    left
}

/// The greatest second difference: a step of the sound stands out in it, and is audible.
fn roughest(sound: &[f32]) -> f32 {
    sound.windows(3).map(|x| (x[0] - 2.0 * x[1] + x[2]).abs()).fold(0.0, f32::max)
}

#[test]
fn a_piece_that_rings_fades_out_under_the_new_one_without_a_click() {
    for name in ["kick", "floor-tom", "timpani", "ride"] {
        let slot = slot(name);
        let rang = {
            let mut kit = struck(slot);
            sound(&mut kit, BEFORE, 512);
            sound(&mut kit, 2_400, 512)
        };
        let mut kit = struck(slot);
        sound(&mut kit, BEFORE, 512);
        assert!(kit.install(spare(slot)).is_none(), "it still sounds");
        assert!(kit.retire().is_none(), "it is still fading");
        let faded = sound(&mut kit, 2_400, 512);
        // The fade may bend the sound, never as sharply as the sound bends itself by more than a few per cent.
        assert!(
            roughest(&faded) <= 1.05 * roughest(&rang),
            "{name}: {} {}",
            roughest(&faded),
            roughest(&rang)
        );
        assert_eq!(faded[0].signum(), rang[0].signum());
        assert!((faded[10] - rang[10]).abs() < 0.01 * rang.iter().fold(0.0, |a: f32, b| a.max(b.abs())));
        let after = sound(&mut kit, 512, 512);
        assert!(after.iter().all(|sample| *sample == 0.0), "{name} goes on after its fade");
        assert!(kit.retire().is_some_and(|piece| piece.slot() == slot));
        assert!(kit.retire().is_none());
    }
}

#[test]
fn a_swap_sounds_the_same_in_every_buffer_size() {
    let swapped = |buffer| {
        let crash = slot("crash");
        let mut kit = struck(crash);
        let mut all = sound(&mut kit, BEFORE, buffer);
        kit.install(spare(crash));
        kit.strike(crash, &stroke(Striker::Shoulder, 3.0, 0.97, 0.0));
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
    assert!(kit.install(spare(slot("snare"))).is_some());
    assert!(kit.retire().is_none());
}

#[test]
fn swaps_faster_than_the_fade_hand_every_piece_back() {
    let tom = slot("floor-tom");
    let mut kit = struck(tom);
    let mut back = 0;
    for _ in 0..5 {
        sound(&mut kit, 100, 100);
        back += usize::from(kit.install(spare(tom)).is_some());
        kit.strike(tom, &stroke(Striker::Stick, 1.0, 0.3, 0.0));
    }
    kit.reset();
    while kit.retire().is_some() {
        back += 1;
    }
    assert_eq!(back, 5);
}

/// The standard kit without its last pieces, whose slots are empty then.
fn without_the_last(pieces: usize) -> KitSpec {
    let mut kit = standard();
    kit.pieces.truncate(kit.pieces.len() - pieces);
    kit
}

#[test]
fn a_slot_that_is_vacated_fades_out_without_a_click_and_is_empty() {
    let hi_hat = slot("hi-hat");
    let rang = {
        let mut kit = struck(hi_hat);
        sound(&mut kit, BEFORE, 512);
        sound(&mut kit, 2_400, 512)
    };
    let mut kit = struck(hi_hat);
    sound(&mut kit, BEFORE, 512);
    let former = kit.arrange(Box::new(Arrangement::new(RATE, &without_the_last(1))));
    let faded = sound(&mut kit, 2_400, 512);
    assert!(roughest(&faded) <= 1.05 * roughest(&rang), "{} {}", roughest(&faded), roughest(&rang));
    assert!((faded[10] - rang[10]).abs() < 0.01 * rang.iter().fold(0.0, |a: f32, b| a.max(b.abs())));
    assert!(sound(&mut kit, 512, 512).iter().all(|sample| *sample == 0.0), "it goes on after its fade");
    assert!(kit.retire().is_some_and(|piece| piece.slot() == hi_hat));
    assert!(kit.piece(hi_hat).is_none() && kit.is_complete());
    // And it is there again when it is wanted.
    drop(kit.arrange(former));
    assert!(!kit.is_complete());
    assert!(kit.install(spare(hi_hat)).is_none() && kit.is_complete());
    kit.strike(hi_hat, &stroke(Striker::Stick, 4.0, 0.4, 0.2));
    assert!(sound(&mut kit, 512, 512).iter().any(|sample| *sample != 0.0));
}

#[test]
fn what_stays_rings_on_through_a_change_of_the_kit_in_every_buffer_size() {
    let (crash, hi_hat) = (slot("crash"), slot("hi-hat"));
    let play = |buffer: usize, struck_too: bool, changes: bool| {
        let mut kit = struck(crash);
        if struck_too {
            kit.strike(hi_hat, &stroke(Striker::Stick, 4.0, 0.4, 0.2));
        }
        let mut all = sound(&mut kit, BEFORE, buffer);
        if changes {
            drop(kit.arrange(Box::new(Arrangement::new(RATE, &without_the_last(2)))));
        }
        all.extend(sound(&mut kit, 4_800, buffer));
        all
    };
    let whole = play(9_999, true, true);
    for buffer in [1, 17, 64, 333] {
        assert!(play(buffer, true, true) == whole, "{buffer}");
    }
    // Once the other has faded out, the crash is heard as if nothing had happened.
    let undisturbed = play(512, false, false);
    assert!(whole[BEFORE + 2_400..] == undisturbed[BEFORE + 2_400..]);
}

/// A groove on a kit at buffers of 64 samples; in the middle, if there is one, another kit comes: first what is about all
/// pieces, then, some buffers later, the piece that differs.
fn groove(before: &Arc<KitDocument>, after: Option<(&Arc<KitDocument>, Slot)>) -> Vec<f32> {
    const BUFFER: usize = 64;
    let mut performer = Performer::new(RATE, before, Arc::default());
    performer.install_kit(RATE, Pace::RealTime).expect("the kit can be built");
    let mut coming = after.map(|(document, slot)| {
        let build = document.kit.build(slot).expect("a piece");
        let piece = Piece::new(slot, &build, &BuildOptions::new(RATE)).expect("it can be built");
        (Setup::new(RATE, document.clone()), Box::new(piece))
    });
    let mut sound = Vec::new();
    let [mut left, mut right] = [[0.0; BUFFER]; 2];
    for buffer in 0..1_500 {
        // An eighth is 150 buffers, 0.2 s.
        if buffer % 150 == 0 {
            performer.note_on(42, 0.6, 9);
            performer.note_on([36, 49, 38, 51][buffer / 150 % 4], 0.8, 9);
        }
        if buffer == 700
            && let Some((setup, piece)) = coming.take()
        {
            drop(performer.change_kit(setup));
            drop(performer.install(piece));
        }
        performer.render(&mut left, &mut right);
        sound.extend_from_slice(&left);
    }
    sound
}

#[test]
fn a_piece_exchanged_while_a_groove_plays_makes_no_step_beyond_the_sound_s_own() {
    let before = Arc::new(KitDocument::standard());
    let undisturbed = groove(&before, None);
    let (from, to) = (700 * 64, 748 * 64);
    for (name, by) in [("crash", "crash-18-thin"), ("kick", "kick-18x14"), ("hi-hat", "hats-13")] {
        let edit = kit_edits::exchange(&before, slot(name), &library::instrument(by).unwrap()).unwrap();
        let exchanged = groove(&before, Some((&Arc::new(edit.document), slot(name))));
        assert!(exchanged[..from] == undisturbed[..from]);
        assert!(exchanged != undisturbed, "{by} sounds as what was there");
        // While it fades the sound is no rougher than it was anywhere before.
        let (own, fading) = (roughest(&undisturbed[..to]), roughest(&exchanged[from - 2..to]));
        assert!(fading <= own, "{by}: {fading} {own}");
        let here = roughest(&undisturbed[from - 2..to]);
        assert!(fading <= 1.05 * here, "{by}: {fading} where it was {here}");
    }
}
