//! The kit as a whole: its outputs, and its behaviour under overload.

use overhear::kit_document::KitDocument;
use overhear_cli::player::{EnginePlayer, Message, Player, Setup};
use overhear_engine::kit::{Control, Kit, Microphone, OUTPUTS, Stereo};
use overhear_engine::piece::Piece;
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::Striker;
use overhear_tests::{Chance, RATES, kit, kit_of, sixteen, slot, standard, stroke};

const RATE: f64 = RATES[0];

/// Strikes every piece once, some samples apart, and renders with as many outputs as asked; main first.
fn strike_all(kit: &mut Kit, outputs: usize, frames: usize) -> Vec<[Vec<f32>; 2]> {
    let mut sound = vec![[vec![f32::NAN; frames], vec![f32::NAN; frames]]; 1 + outputs];
    let struck = Slot::ALL.into_iter().filter(|&slot| kit.piece(slot).is_some()).collect::<Vec<_>>();
    for (i, &slot) in struck.iter().enumerate() {
        kit.strike(slot, &stroke(Striker::Stick, 4.0, 0.4, 0.3));
        let range = i * 777..if i + 1 == struck.len() { frames } else { (i + 1) * 777 };
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
            // From 2 on the ceiling bends the main output.
            let most = if sum.abs() < 1.99 { 1e-6 } else { 0.02 };
            assert!((sum - main[side][i]).abs() < most, "sample {i}: {sum} for {}", main[side][i]);
        }
    }
    for (i, pair) in microphones.iter().enumerate() {
        let loudest = pair.iter().flatten().fold(0.0_f32, |loudest, x| loudest.max(x.abs()));
        let is_empty = Slot::new(i).is_some_and(|slot| standard().piece(slot).is_none());
        assert_eq!(loudest > 1e-3, !is_empty, "output {i}: {loudest}");
        assert!(!is_empty || loudest == 0.0, "output {i}: {loudest}");
    }
}

#[test]
fn the_main_output_is_the_same_whoever_listens_to_the_pieces() {
    let mut kit = kit(RATE);
    let alone = strike_all(&mut kit, 0, 8_000);
    for outputs in [3, SLOTS, OUTPUTS] {
        kit.reset();
        assert!(strike_all(&mut kit, outputs, 8_000)[0] == alone[0], "{outputs} outputs");
    }
}

/// Renders every output, the main one first.
fn all_outputs(kit: &mut Kit, frames: usize) -> Vec<[Vec<f32>; 2]> {
    let mut sound = vec![[vec![f32::NAN; frames], vec![f32::NAN; frames]]; 1 + OUTPUTS];
    let mut pairs: Vec<Stereo<'_>> =
        sound.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[..])).collect();
    let (main, others) = pairs.split_first_mut().expect("the main output");
    kit.render_outputs(main.each_mut().map(|side| &mut **side), others);
    sound
}

#[test]
fn sixteen_pieces_struck_at_once_are_all_heard_each_at_its_own_output() {
    let mut kit = kit_of(&sixteen(), RATE);
    Slot::ALL.into_iter().for_each(|slot| kit.strike(slot, &stroke(Striker::Stick, 4.0, 0.4, 0.3)));
    let sound = all_outputs(&mut kit, 9_000);
    for (output, pair) in sound.iter().enumerate() {
        let loudest = pair.iter().flatten().fold(0.0_f32, |loudest, x| loudest.max(x.abs()));
        assert!(pair.iter().flatten().all(|x| x.is_finite()), "output {output}");
        assert!((1e-3..30.0).contains(&loudest), "output {output}: {loudest}");
    }
    let mut snapshot = KitSnapshot::default();
    kit.snapshot(&mut snapshot);
    assert!(snapshot.pieces.iter().all(|piece| piece.strike.count == 1 && piece.quarantines == 0));
    assert_eq!(snapshot.dropped_strikes, 0);
}

#[test]
fn pieces_that_are_never_struck_stay_asleep_and_silent_where_none_hears_another() {
    let mut kit = kit_of(&sixteen(), RATE);
    kit.set(Control::SympatheticCoupling, 0.0);
    kit.finish_controls();
    let struck = [Slot::ALL[0], Slot::ALL[7], Slot::ALL[15]];
    for round in 0..5 {
        struck.into_iter().for_each(|slot| kit.strike(slot, &stroke(Striker::Stick, 6.0, 0.4, 0.3)));
        let sound = all_outputs(&mut kit, 4_410);
        for (slot, output) in Slot::ALL.into_iter().zip(&sound[1..]) {
            let piece = kit.piece(slot).expect("sixteen pieces");
            let sleeps = !struck.contains(&slot);
            assert_eq!(piece.is_asleep(), sleeps, "{slot:?} after {round}");
            assert_eq!(piece.energy() == 0.0, sleeps, "{slot:?} after {round}");
            let silent = output.iter().flatten().all(|x| x.to_bits() == 0);
            assert_eq!(silent, sleeps, "{slot:?} after {round}");
        }
    }
}

#[test]
fn a_pan_all_the_way_leaves_the_other_side_silent_and_gets_there_without_a_step() {
    let mut kit = kit(RATE);
    // Nothing but the kick.
    kit.set(Control::SympatheticCoupling, 0.0);
    kit.set(Control::Mute(Microphone::Overheads), 1.0);
    kit.set(Control::Mute(Microphone::Room), 1.0);
    kit.finish_controls();
    let kick = slot("kick");
    kit.strike(kick, &stroke(Striker::FeltBeater, 3.0, 0.2, 0.0));
    let (mut left, mut right) = (vec![0.0; 9_000], vec![0.0; 9_000]);
    kit.render(&mut left[..2_000], &mut right[..2_000]);
    kit.set(Control::Pan(kick), 1.0);
    kit.render(&mut left[2_000..], &mut right[2_000..]);
    let steps = |sound: &[f32]| sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steps(&left[1_990..2_100]) <= steps(&left[1_800..1_990]) + 1e-3);
    assert!(left[8_000..].iter().all(|&x| x.abs() < 1e-6));
    assert!(right[8_000..].iter().any(|&x| x.abs() > 1e-3));
}

/// 5,000 strokes in 10 s: on every piece by turns and at random, with rolls of a stroke every 3 ms.
fn storm(chance: &mut Chance) -> Vec<(usize, Slot, bool)> {
    let rate = RATE as usize;
    let slots: Vec<Slot> = standard().slots().map(|(slot, _)| slot).collect();
    let mut strokes = Vec::new();
    for i in 0..3_000 {
        let slot = if i % 2 == 0 { slots[i / 2 % slots.len()] } else { chance.of(&slots) };
        strokes.push((chance.below(10 * rate), slot, false));
    }
    for roll in 0..20 {
        let (slot, from) = (slots[roll % slots.len()], chance.below(9 * rate));
        strokes.extend((0..100).map(|i| (from + i * 3 * rate / 1000, slot, true)));
    }
    strokes.sort_by_key(|&(at, _, _)| at);
    strokes
}

#[test]
fn five_thousand_strokes_in_ten_seconds_stay_finite_and_bounded_and_none_is_lost_silently() {
    let (mut kit, mut chance) = (kit(RATE), Chance::new(5));
    let strokes = storm(&mut chance);
    assert_eq!(strokes.len(), 5_000);
    let (mut left, mut right) = (vec![0.0; 4_096], vec![0.0; 4_096]);
    let (mut now, mut peak) = (0, 0.0_f32);
    let begun = std::time::Instant::now();
    let mut advance = |kit: &mut Kit, until: usize| -> f32 {
        while now < until {
            let frames = (until - now).min(left.len());
            let (left, right) = (&mut left[..frames], &mut right[..frames]);
            kit.render(left, right);
            for x in left.iter().chain(right.iter()) {
                assert!(x.is_finite(), "at sample {now}");
                peak = peak.max(x.abs());
            }
            now += frames;
        }
        peak
    };
    for (at, slot, rolls) in strokes {
        advance(&mut kit, at);
        let mut stroke = chance.stroke(8.0);
        if rolls {
            (stroke.striker, stroke.radius) = (Striker::Stick, 0.4);
        }
        kit.strike(slot, &stroke);
    }
    let peak = advance(&mut kit, 10 * RATE as usize);
    let share = begun.elapsed().as_secs_f64() / 10.0;
    let mut snapshot = KitSnapshot::default();
    kit.snapshot(&mut snapshot);
    let struck: u32 = snapshot.pieces.iter().map(|piece| piece.strike.count).sum();
    let hurried: u32 = snapshot.pieces.iter().map(|piece| piece.hurried_strikers).sum();
    println!("peak {peak:.1}, {hurried} strikers made room for others, {:.0} % of real time", 100.0 * share);
    // Every stroke was played, and every striker removed for the next one was counted.
    assert_eq!((struck, snapshot.dropped_strikes, snapshot.missed_runs), (5_000, 0, 0));
    assert!(hurried > 100, "{hurried}");
    for (slot, piece) in snapshot.pieces.iter().enumerate() {
        assert_eq!(piece.quarantines, 0, "slot {slot}");
    }
    // No more than what so many strokes bring: each stays well below full scale, hundreds sound at a time.
    assert!(peak < 30.0, "{peak}");
    // It dies away as it must.
    Slot::ALL.into_iter().for_each(|slot| kit.choke(slot, 1.0));
    let energy =
        |kit: &Kit| Slot::ALL.into_iter().filter_map(|slot| kit.piece(slot)).map(Piece::energy).sum::<f64>();
    let before = energy(&kit);
    advance(&mut kit, 15 * RATE as usize);
    assert!(energy(&kit) < 1e-3 * before, "{} of {before} J", energy(&kit));
}

#[test]
fn the_workers_that_a_parameter_hires_change_no_sample() {
    let play = |workers: &str| {
        let kit = KitDocument::standard();
        let asked = [workers.to_owned(), "offline_quality=as played".to_owned()];
        let settings = overhear_cli::settings::parse(&asked, &kit.kit).expect("settings");
        let setup = Setup { rate: 48_000, settings, kit };
        let mut player = EnginePlayer::new(&setup).expect("a rate");
        let (mut left, mut right) = (vec![0.0; 12_000], vec![0.0; 12_000]);
        let hits = [36, 38, 49, 51].map(|key| Message::note(100, 9, key, 110));
        player.render(&hits, &mut left, &mut right).expect("an engine that plays");
        left.into_iter().chain(right).map(f32::to_bits).collect::<Vec<_>>()
    };
    let alone = play("render_threads=0");
    assert!(alone.iter().any(|&x| f32::from_bits(x).abs() > 0.01));
    assert!(alone == play("render_threads=2"));
}
