//! The kit as a whole: its outputs.

use overhear_engine::kit::{Control, Kit, Microphone, OUTPUTS, Stereo};
use overhear_engine::piece::PieceId;
use overhear_engine::strike::Striker;
use overhear_tests::{RATES, kit, stroke};

const RATE: f64 = RATES[0];

/// Strikes every piece once, some samples apart, and renders with as many outputs as asked; main first.
fn strike_all(kit: &mut Kit, outputs: usize, frames: usize) -> Vec<[Vec<f32>; 2]> {
    let mut sound = vec![[vec![f32::NAN; frames], vec![f32::NAN; frames]]; 1 + outputs];
    for (i, id) in PieceId::KIT.into_iter().enumerate() {
        kit.strike(id, &stroke(Striker::Stick, 4.0, 0.4, 0.3));
        let range = i * 777..if i + 1 == PieceId::KIT.len() { frames } else { (i + 1) * 777 };
        let mut pairs: Vec<Stereo<'_>> =
            sound.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[range.clone()])).collect();
        let (main, pieces) = pairs.split_first_mut().expect("the main output");
        kit.render_outputs(main.each_mut().map(|side| &mut **side), pieces);
    }
    sound
}

#[test]
fn the_outputs_of_the_microphones_add_up_to_the_main_one() {
    let sound = strike_all(&mut kit(RATE), OUTPUTS, 9_000);
    let (main, microphones) = sound.split_first().expect("the main output");
    for side in 0..2 {
        for i in 0..9_000 {
            let sum: f32 = microphones.iter().map(|pair| pair[side][i]).sum();
            assert!((sum - main[side][i]).abs() < 1e-6, "sample {i}: {sum} for {}", main[side][i]);
        }
    }
    for (i, pair) in microphones.iter().enumerate() {
        assert!(pair.iter().flatten().any(|x| x.abs() > 1e-3), "output {i} is silent");
    }
}

#[test]
fn the_main_output_is_the_same_whoever_listens_to_the_pieces() {
    let mut kit = kit(RATE);
    let alone = strike_all(&mut kit, 0, 8_000);
    for outputs in [3, OUTPUTS] {
        kit.reset();
        assert!(strike_all(&mut kit, outputs, 8_000)[0] == alone[0], "{outputs} outputs");
    }
}

#[test]
fn a_pan_all_the_way_leaves_the_other_side_silent_and_gets_there_without_a_step() {
    let mut kit = kit(RATE);
    // Nothing but the kick.
    kit.set(Control::Hearing, 0.0);
    kit.set(Control::Mute(Microphone::Overheads), 1.0);
    kit.set(Control::Mute(Microphone::Room), 1.0);
    kit.finish_controls();
    kit.strike(PieceId::Kick, &stroke(Striker::FeltBeater, 3.0, 0.2, 0.0));
    let (mut left, mut right) = (vec![0.0; 9_000], vec![0.0; 9_000]);
    kit.render(&mut left[..2_000], &mut right[..2_000]);
    kit.set(Control::Pan(PieceId::Kick), 1.0);
    kit.render(&mut left[2_000..], &mut right[2_000..]);
    let steps = |sound: &[f32]| sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steps(&left[1_990..2_100]) <= steps(&left[1_800..1_990]) + 1e-3);
    assert!(left[8_000..].iter().all(|&x| x.abs() < 1e-6));
    assert!(right[8_000..].iter().any(|&x| x.abs() > 1e-3));
}
