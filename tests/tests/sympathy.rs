//! Pieces hear each other through the air: when, how much, and what it does.

use overhear_engine::air::SPEED_OF_SOUND;
use overhear_engine::kit::{BLOCK, Control, Kit};
use overhear_engine::layout::{Layout, distance};
use overhear_engine::piece::{Piece, PieceId};
use overhear_engine::strike::Striker;
use overhear_tests::{RATES, kit, piece, stroke};
use xtask::report::kit::landings;

const RATE: f64 = RATES[0];

fn run(kit: &mut Kit, samples: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
    kit.render(&mut left, &mut right);
    left
}

fn energy(kit: &Kit, id: PieceId) -> f64 {
    kit.piece(id).map_or(0.0, Piece::energy)
}

#[test]
fn wires_land_when_a_rack_tom_is_struck_the_more_the_harder() {
    let mut kit = kit(RATE);
    let counts = [2.0, 4.0, 6.0].map(|speed| landings(&mut kit, speed, 0.2));
    println!("landings after 2, 4, 6 m/s: {counts:?}");
    for (count, want) in counts.into_iter().zip([12.0, 152.0, 324.0]) {
        assert!((want / 10.0..want * 10.0).contains(&f64::from(count)), "{counts:?}");
    }
    assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
    // Farther out the same stroke sets less air going: what the wires answer to are the tom's round modes, and the
    // second of them has its node at .44 of the radius.
    let outside =
        [0.1, 0.35, 0.5].map(|radius| [2.0, 4.0, 6.0].map(|speed| landings(&mut kit, speed, radius)));
    println!("at .1, .35, .5 of the radius: {outside:?}");
    assert!(
        outside[0].iter().sum::<u32>() > outside[1].iter().sum::<u32>() && outside[1][2] > 0,
        "{outside:?}"
    );
}

#[test]
fn wires_do_not_land_when_the_pieces_are_deaf_or_the_wires_are_off() {
    for (control, value) in [(Control::Hearing, 0.0), (Control::Sympathy, 0.0), (Control::SnareWires, 0.0)] {
        let mut kit = kit(RATE);
        kit.set(control, value);
        kit.finish_controls();
        assert_eq!(landings(&mut kit, 6.0, 0.2), 0, "{control:?}");
    }
}

#[test]
fn between_the_drums_the_shortest_delay_is_from_rack_tom_to_snare_54_samples_at_44_1_khz() {
    let layout = Layout::default();
    let drums = PieceId::KIT.into_iter().filter(|id| id.is_drum()).filter_map(PieceId::slot);
    let ways = drums.clone().flat_map(|from| {
        let others = drums.clone().filter(move |&to| to != from);
        others.map(move |to| (layout.way(from, to), from, to))
    });
    let (way, from, to) = ways.min_by(|a, b| a.0.total_cmp(&b.0)).expect("drums");
    let mut pair = [PieceId::KIT[from], PieceId::KIT[to]];
    pair.sort();
    assert_eq!(pair, [PieceId::Snare, PieceId::RackTom]);
    // Reading between samples needs one that is newer.
    assert_eq!((way / SPEED_OF_SOUND * RATE).floor() as usize - 1, 54);
}

#[test]
fn no_run_is_longer_than_the_shortest_delay_at_any_rate_and_in_a_kit_moved_together() {
    let mut crowded = Layout::default();
    for piece in &mut crowded.pieces {
        piece.centre = [0.0, 0.7, 0.0];
    }
    for rate in [22_050.0, 44_100.0, 48_000.0, 88_200.0, 96_000.0, 192_000.0] {
        for layout in [Layout::default(), crowded] {
            let kit = Kit::with_layout(rate, &layout);
            let listeners = (0..PieceId::KIT.len()).filter(|&to| PieceId::KIT[to].is_drum());
            let shortest = listeners
                .flat_map(|to| {
                    (0..PieceId::KIT.len()).filter(move |&from| from != to).map(move |from| (from, to))
                })
                .map(|(from, to)| layout.way(from, to))
                .fold(f64::INFINITY, f64::min);
            let delay = kit.min_delay();
            assert!(delay >= 1 && (delay as f64) < shortest / SPEED_OF_SOUND * rate, "{rate}: {delay}");
        }
    }
    // Shorter than a block, where it must be.
    assert!(Kit::with_layout(22_050.0, &crowded).min_delay() < BLOCK);
}

#[test]
fn buffers_do_not_matter_where_delays_are_shorter_than_a_block() {
    let mut crowded = Layout::default();
    for id in [PieceId::Snare, PieceId::RackTom] {
        crowded.pieces[id.slot().expect("of the kit")].centre = [0.0, 0.7, 0.0];
    }
    let play = |buffer: usize| {
        let mut kit = Kit::with_layout(22_050.0, &crowded);
        for id in [PieceId::Snare, PieceId::RackTom] {
            assert!(kit.install(Box::new(piece(id, 22_050.0))).is_none());
        }
        assert!(kit.min_delay() < BLOCK);
        kit.strike(PieceId::RackTom, &stroke(Striker::Stick, 6.0, 0.35, 0.0));
        let mut sound = Vec::new();
        while sound.len() < 8_000 {
            let frames = buffer.min(8_000 - sound.len());
            sound.extend(run(&mut kit, frames));
        }
        assert!(energy(&kit, PieceId::Snare) > 1e-9);
        sound
    };
    let whole = play(8_000);
    for buffer in [1, 17, 31, 64] {
        assert!(play(buffer) == whole, "buffers of {buffer}");
    }
}

#[test]
fn the_first_pressure_arrives_after_the_distance_over_the_speed_of_sound_to_the_sample() {
    let mut kit = kit(RATE);
    let layout = *kit.layout();
    let at = |id: PieceId| layout.pieces[id.slot().expect("of the kit")];
    kit.strike(PieceId::RackTom, &stroke(Striker::Stick, 6.0, 0.35, 0.0));
    let way = distance(&at(PieceId::RackTom).source(), &at(PieceId::Snare).centre);
    let expected = way / SPEED_OF_SOUND * RATE;
    let mut woken = 0;
    while kit.piece(PieceId::Snare).is_some_and(Piece::is_asleep) {
        run(&mut kit, 1);
        woken += 1;
        assert!(woken < 1_000, "nothing arrives");
    }
    // It is struck at sample 0, whose sound is heard in the sample after; a stroke presses before it is loud.
    println!("{woken} samples for {expected}");
    let late = f64::from(woken) - expected;
    assert!((-1.0..6.0).contains(&late), "{woken} for {expected}");
}

#[test]
fn cymbals_are_heard_and_do_not_listen() {
    let mut kit = kit(RATE);
    kit.strike(PieceId::Crash, &stroke(Striker::Shoulder, 6.0, 0.9, 0.0));
    run(&mut kit, 8_000);
    for id in PieceId::KIT.into_iter().filter(|&id| id != PieceId::Crash) {
        assert_eq!(energy(&kit, id) > 0.0, id.is_drum(), "{id:?}");
    }
}

#[test]
fn what_drums_pick_up_is_a_small_part_of_what_was_struck_and_follows_the_amount() {
    let picked_up = |amount: f64| {
        let mut kit = kit(RATE);
        kit.set(Control::Sympathy, amount);
        kit.finish_controls();
        kit.strike(PieceId::FloorTom, &stroke(Striker::Stick, 5.0, 0.35, 0.0));
        run(&mut kit, 10_000);
        let struck = energy(&kit, PieceId::FloorTom);
        let kick = energy(&kit, PieceId::Kick);
        assert!(kick < 0.1 * struck, "{kick} of {struck}");
        kick
    };
    let [half, whole] = [0.1, 0.2].map(picked_up);
    // Energy goes as the square.
    assert!((3.0..5.0).contains(&(whole / half)), "{half} {whole}");
}

#[test]
fn drums_that_hear_each_other_only_lose_energy() {
    // All tuned alike, as near each other as the layout lets them, without what muffles them: the worst case.
    let mut crowded = Layout::default();
    for piece in &mut crowded.pieces {
        piece.centre = [0.0, 0.7, 0.0];
    }
    let mut kit = Kit::with_layout(RATE, &crowded);
    for id in PieceId::KIT.into_iter().filter(|id| id.is_drum()) {
        assert!(kit.install(Box::new(piece(id, RATE))).is_none());
        let (low, _, high) = Piece::tuning_range(id);
        kit.set(Control::Tuning(id), 145.0_f64.clamp(low, high));
    }
    kit.set(Control::SnareWires, 0.0);
    kit.finish_controls();
    kit.strike(PieceId::FloorTom, &stroke(Striker::FeltBeater, 8.0, 0.1, 0.0));
    kit.strike(PieceId::RackTom, &stroke(Striker::FeltBeater, 8.0, 0.1, 0.0));
    run(&mut kit, RATE as usize / 5);
    let total = |kit: &Kit| PieceId::KIT.iter().map(|&id| energy(kit, id)).sum::<f64>();
    let mut before = total(&kit);
    for window in 0..20 {
        run(&mut kit, RATE as usize / 10);
        let now = total(&kit);
        assert!(now < before || now == 0.0, "window {window}: {now} J after {before} J");
        before = now;
    }
}
