//! Microphones hear what their place gives them.

use overhear_engine::kit::{Control, Kit, Microphone, OUTPUTS, Stereo};
use overhear_engine::piece::PieceId;
use overhear_engine::strike::Striker;
use overhear_tests::{piece, stroke};

/// A rate at which sound goes 34.3 cm in a whole number of samples.
const RATE: f64 = 48_000.0;

const FRAMES: usize = 12_000;

/// A rack tom's stroke at every output, the overheads so far (m) above its middle.
fn heard(height: f64) -> Vec<Vec<f32>> {
    let mut kit = Kit::new(RATE);
    assert!(kit.install(Box::new(piece(PieceId::RackTom, RATE))).is_none());
    let [x, y, z] = kit.layout().pieces[PieceId::RackTom.slot().expect("of the kit")].centre;
    kit.place(Microphone::Overheads, [[x, y + height, z]; 2]);
    kit.set(Control::Balance(Microphone::Overheads), 0.0);
    kit.finish_controls();
    kit.strike(PieceId::RackTom, &stroke(Striker::Stick, 4.0, 0.5, 0.3));
    let mut buffers = vec![[vec![0.0_f32; FRAMES], vec![0.0_f32; FRAMES]]; OUTPUTS + 1];
    let mut outputs: Vec<Stereo<'_>> =
        buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[..])).collect();
    let (main, microphones) = outputs.split_at_mut(1);
    kit.render_outputs(main[0].each_mut().map(|side| &mut **side), microphones);
    buffers.into_iter().skip(1).map(|[left, _]| left).collect()
}

#[test]
fn a_microphone_34_3_cm_farther_hears_a_millisecond_later_and_one_twice_as_far_half() {
    let overheads = PieceId::KIT.len();
    let [near, later, half] = [1.0, 1.343, 2.0].map(|height| heard(height).swap_remove(overheads));
    let peak = |sound: &[f32]| sound.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    let loudest = peak(&near);
    for i in 48..FRAMES {
        assert!((1.343 * later[i] - near[i - 48]).abs() < 1e-3 * loudest, "sample {i}");
    }
    assert!((peak(&half) / loudest - 0.5).abs() < 0.01, "{} of {loudest}", peak(&half));
}
