//! Silent pieces fall asleep soon; sound that is still travelling arrives.

use overhear_engine::kit::{BLOCK, Control, Kit, Microphone};
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use overhear_tests::{RATES, alone, kit, kit_of, spec, standard, stroke};

const RATE: f64 = RATES[0];

/// 100 dB under full scale: below that nothing is heard.
const AUDIBLE: f32 = 1e-5;

/// Renders block by block until the kit sleeps; samples of the last audible sound and of falling asleep.
fn fall_asleep(kit: &mut Kit, most: f64) -> [usize; 2] {
    let (mut last, mut now) = (0, 0);
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    loop {
        kit.render(&mut left, &mut right);
        if left.iter().chain(&right).any(|x| x.abs() > AUDIBLE) {
            last = now + BLOCK;
        }
        now += BLOCK;
        if kit.is_asleep() {
            return [last, now];
        }
        assert!(
            (now as f64) < most * RATE,
            "still awake after {most} s, silent from {} s on",
            last as f64 / RATE
        );
    }
}

#[test]
fn a_kit_sleeps_within_a_second_of_the_last_audible_sound() {
    let mut kit = kit(RATE);
    for (slot, piece) in standard().slots() {
        let name = &piece.name;
        kit.strike(slot, &stroke(Striker::Stick, 5.0, 0.5, 0.2));
        let (mut left, mut right) = (vec![0.0; 4_410], vec![0.0; 4_410]);
        kit.render(&mut left, &mut right);
        // Cymbals ring for a minute: a hand stops them.
        kit.choke(slot, 1.0);
        let [last, asleep] = fall_asleep(&mut kit, 40.0).map(|samples| samples as f64 / RATE);
        println!("{name}: heard for {last:.2} s, asleep {:.2} s later", asleep - last);
        assert!(last > 0.1 && asleep - last < 1.0, "{name}: {last} s, {asleep} s");
        kit.choke(slot, 0.0);
        // It is woken by the next stroke and costs nothing until then.
        kit.render(&mut left, &mut right);
        assert!(kit.is_asleep() && left.iter().chain(&right).all(|x| x.to_bits() == 0));
    }
}

#[test]
fn what_is_under_way_when_its_source_falls_asleep_arrives() {
    let (spec, tom) = (spec("rack-tom"), Slot::ALL[0]);
    let mut kit = kit_of(&alone(&spec), RATE);
    let [x, y, z] = spec.place.centre;
    // Fifteen metres up: 44 ms of sound are on their way.
    kit.place(Microphone::Overheads, [[x, y + 15.0, z]; 2]);
    kit.set(Control::Solo(Microphone::Overheads), 1.0);
    kit.finish_controls();
    kit.strike(tom, &stroke(Striker::Stick, 4.0, 0.4, 0.0));
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let mut render = |kit: &mut Kit| {
        kit.render(&mut left, &mut right);
        left.iter().any(|&x| x != 0.0)
    };
    while !kit.piece(tom).is_some_and(Piece::is_asleep) {
        render(&mut kit);
    }
    let mut arrived = 0;
    while !kit.is_asleep() {
        arrived += if render(&mut kit) { BLOCK } else { 0 };
    }
    let way = (15.0 - 0.5) / 343.0 * RATE;
    assert!((arrived as f64 - way).abs() < 3.0 * BLOCK as f64, "{arrived} samples for {way}");
}
