//! Cymbals with rivets in a kit: the same samples for any buffers, under hands, tuned and muffled, beside drums that wake them;
//! silence after.

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::kit::{BLOCK, Control, Kit};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec};
use overhear_engine::piece::Piece;
use overhear_engine::strike::Striker;
use overhear_engine::surface::rivets::{Rivets, RivetsSpec};
use overhear_tests::{Chance, RATES, kit_of, member, render, slot, spec, standard, stroke, total_energy};

const RATE: f64 = RATES[0];

const SIX: RivetsSpec =
    RivetsSpec { number: 6, radius: 0.9, arc: None, toward: 0.2, mass: 1.5e-3, play: 2.5e-3 };

fn cymbal(instrument: &mut InstrumentSpec) -> &mut CymbalSpec {
    match instrument {
        InstrumentSpec::Cymbal(cymbal) => cymbal,
        other => panic!("{other:?} is no cymbal"),
    }
}

/// The standard kit with rivets in ride and splash.
fn riveted() -> KitSpec {
    let mut kit = standard();
    for (name, rivets) in
        [("ride", SIX), ("splash", RivetsSpec { number: 3, arc: Some(0.4), mass: 1e-3, ..SIX })]
    {
        let piece = kit.pieces.iter_mut().find(|piece| piece.name == name).expect("a cymbal");
        cymbal(&mut piece.instrument).rivets = Some(rivets);
    }
    kit
}

/// That piece of the riveted kit.
fn piece(name: &str) -> Piece {
    member(&riveted(), slot(name), RATE)
}

fn rivets(piece: &mut Piece) -> &Rivets {
    piece.surface_mut().attachment().expect("rivets")
}

/// Two seconds of strokes, hands, tunings and mufflings in buffers of any lengths.
fn played(kit: &mut Kit, mut buffer: impl FnMut() -> usize) -> Vec<[u32; 2]> {
    kit.reset();
    let [ride, splash, tom] = ["ride", "splash", "rack-tom"].map(slot);
    let mut sound = Vec::new();
    for step in 0..10_usize {
        match step {
            0 => kit.strike(ride, &stroke(Striker::Stick, 4.0, 0.7, 0.4)),
            1 => kit.strike(splash, &stroke(Striker::Shoulder, 5.0, 0.9, 1.0)),
            2 => kit.set(Control::Tuning(ride), 1.2),
            3 => kit.strike(tom, &stroke(Striker::Stick, 6.0, 0.3, 0.0)),
            4 => kit.set(Control::Muffling(splash), 0.5),
            5 => kit.choke(ride, 0.7),
            6 => kit.strike(ride, &stroke(Striker::Stick, 1.0, 0.2, 2.0)),
            7 => kit.choke(ride, 0.0),
            8 => kit.set(Control::Tuning(ride), 1.0),
            _ => kit.set(Control::Muffling(splash), 0.0),
        }
        let mut left = 8_821;
        while left > 0 {
            let frames = buffer().min(left);
            let [mut one, mut other] = [vec![0.0; frames], vec![0.0; frames]];
            kit.render(&mut one, &mut other);
            sound.extend(one.iter().zip(&other).map(|(a, b)| [a.to_bits(), b.to_bits()]));
            left -= frames;
        }
    }
    // All controls are where they were.
    kit.finish_controls();
    sound
}

#[test]
fn the_hosts_buffer_changes_no_sample() {
    let mut kit = kit_of(&riveted(), RATE);
    let whole = played(&mut kit, || 8_821);
    for length in [1, 31, 512] {
        assert!(whole == played(&mut kit, || length), "buffers of {length}");
    }
    let mut chance = Chance::new(3);
    assert!(whole == played(&mut kit, || 1 + chance.below(99)), "random buffers");
    for name in ["ride", "splash"] {
        assert_eq!(kit.piece(slot(name)).map(Piece::quarantines), Some(0));
    }
}

#[test]
fn a_riveted_piece_reset_plays_as_a_new_one() {
    let roll = |piece: &mut Piece| -> Vec<f32> {
        let mut chance = Chance::new(8);
        let stroke = |_| {
            piece.strike(&chance.stroke(6.0));
            render(piece, 0.01, RATE)
        };
        (0..12).flat_map(stroke).collect()
    };
    let (mut new, mut used) = (piece("splash"), piece("splash"));
    used.strike(&stroke(Striker::Stick, 5.0, 0.8, 0.0));
    // In the middle of a block.
    for frames in [0.3, 0.000_4] {
        render(&mut used, frames, RATE);
    }
    used.reset();
    assert_eq!(total_energy(&used), 0.0);
    assert!(roll(&mut new) == roll(&mut used));
}

#[test]
fn a_hand_silences_cymbal_and_rivets_and_a_piece_that_is_left_alone_falls_asleep() {
    for (name, choked) in [("ride", true), ("splash", false)] {
        let mut piece = piece(name);
        piece.strike(&stroke(Striker::Stick, 4.0, 0.7, 0.4));
        render(&mut piece, 0.3, RATE);
        assert!(rivets(&mut piece).landings() > 50, "{name}");
        piece.choke(if choked { 1.0 } else { 0.0 });
        let mut seconds = 0;
        while !piece.is_asleep() {
            render(&mut piece, 1.0, RATE);
            seconds += 1;
            assert!(seconds < 60, "{name} is still awake");
        }
        println!("{name}: asleep after {seconds} s");
        assert!(!choked || seconds < 4, "{name}: {seconds} s under a hand");
        assert_eq!(piece.energy(), 0.0);
        assert!(render(&mut piece, 0.1, RATE).iter().all(|&x| x == 0.0));
        // The next stroke throws them again.
        piece.choke(0.0);
        piece.strike(&stroke(Striker::Stick, 4.0, 0.7, 0.4));
        render(&mut piece, 0.3, RATE);
        assert!(rivets(&mut piece).landings() > 50, "{name}");
    }
}

#[test]
fn rivets_that_are_all_but_weightless_hardly_change_the_sound() {
    // The least that a kit file accepts, three tenths of a gram, on two kilograms and a half.
    let mut light = spec("ride");
    cymbal(&mut light.instrument).rivets = Some(RivetsSpec { number: 1, mass: 3e-4, ..SIX });
    let [mut plain, mut riveted] = [spec("ride"), light]
        .map(|spec| overhear_tests::build(&spec, &overhear_engine::piece::BuildOptions::new(RATE)));
    let levels = [&mut plain, &mut riveted].map(|piece| {
        piece.strike(&stroke(Striker::Stick, 2.0, 0.5, 0.4));
        let sound = render(piece, 0.5, RATE);
        sound.chunks(BLOCK * 64).map(|part| part.iter().map(|&x| f64::from(x).powi(2)).sum()).collect()
    });
    let [plain, riveted]: [Vec<f64>; 2] = levels;
    let apart = plain.iter().zip(&riveted).map(|(a, b)| (10.0 * (a / b).log10()).abs());
    let apart = apart.fold(0.0, f64::max);
    println!("{apart:.2} dB apart at most");
    assert!(apart < 1.5, "{apart} dB");
}
