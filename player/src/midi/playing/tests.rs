use super::*;
use crate::kit_document::standard_slot;
use crate::midi_map::Foot;

mod streams;

/// Someone whose strokes are even.
fn playing() -> Playing {
    let mut playing = Playing::new(Arc::default(), Arc::default());
    (playing.style.position_spread, playing.style.speed_spread) = (0.0, 0.0);
    playing
}

fn radius(playing: &mut Playing, note: u8) -> f64 {
    playing.note_on(note, 0.8, 9).unwrap().strike.radius
}

#[test]
fn velocity_runs_from_the_softest_tap_to_the_dynamics() {
    assert_eq!(stick_speed(velocity_from_midi(1), 6.0, 1.0) as f32, 0.4);
    assert_eq!(stick_speed(velocity_from_midi(127), 6.0, 1.0), 6.0);
    assert_eq!(stick_speed(1.0, 10.0, 3.0), 10.0);
    assert_eq!(stick_speed(0.001, 6.0, 1.0), SOFTEST);
    assert_eq!(stick_speed(2.0, 6.0, 1.0), 6.0);
}

#[test]
fn equal_steps_of_velocity_are_equal_ratios_of_speed() {
    let speed = |velocity| stick_speed(velocity_from_midi(velocity), 6.0, 1.0);
    let ratio = speed(2) / speed(1);
    for velocity in 2..=127 {
        assert!((speed(velocity) / speed(velocity - 1) / ratio - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_curve_bends_the_middle_and_keeps_the_order() {
    let middle = |curve| stick_speed(velocity_from_midi(64), 6.0, curve);
    assert!(middle(2.0) < middle(1.0) && middle(1.0) < middle(0.5));
    for curve in [0.25, 1.0, 4.0] {
        let speeds: Vec<f64> = (1..=127).map(|v| stick_speed(velocity_from_midi(v), 6.0, curve)).collect();
        assert!(speeds.windows(2).all(|pair| pair[0] < pair[1]), "{curve}");
    }
}

#[test]
fn only_notes_of_the_map_with_a_velocity_strike() {
    let mut playing = playing();
    assert!(playing.note_on(38, 0.5, 9).is_some());
    for (note, velocity) in [(38, 0.0), (38, -1.0), (38, f32::NAN), (39, 1.0), (200, 1.0)] {
        assert_eq!(playing.note_on(note, velocity, 0), None, "{note} at {velocity}");
    }
}

#[test]
fn the_channel_filter_lets_one_through() {
    let mut playing = playing();
    playing.style.channel = Some(9);
    assert!(playing.note_on(38, 1.0, 9).is_some());
    assert!(playing.note_on(38, 1.0, 8).is_none());
    assert!(playing.pressure(49, 1.0, 8).is_none());
    playing.control_change(16, 1.0, 8);
    assert_eq!(radius(&mut playing, 38), 0.25, "another channel's controller");
}

#[test]
fn position_controllers_run_from_the_centre_to_the_rim() {
    let mut playing = playing();
    assert_eq!(radius(&mut playing, 38), 0.25);
    let places: Vec<f64> = [0.0, 0.25, 0.5, 1.0]
        .map(|value| {
            playing.control_change(16, value, 9);
            radius(&mut playing, 38)
        })
        .to_vec();
    assert!(places[0] < 0.05 && places[3] > 0.9 && places.is_sorted(), "{places:?}");
    assert_eq!(radius(&mut playing, 48), 0.30, "the toms have their own");
    assert_eq!(radius(&mut playing, 37), 0.30, "a cross-stick stays");
    playing.control_change(17, 1.0, 9);
    assert!(radius(&mut playing, 51) > 0.9);
    assert_eq!(radius(&mut playing, 53), 0.12, "the bell stays");
    playing.style.follows_position = false;
    assert_eq!(radius(&mut playing, 38), 0.25);
    playing.style.follows_position = true;
    playing.reset();
    assert_eq!(radius(&mut playing, 38), 0.25);
}

#[test]
fn fine_velocity_lies_between_two_velocities_and_is_used_once() {
    let mut playing = playing();
    // Without a curve equal steps are equal ratios.
    playing.style.curve = 1.0;
    let speed = |playing: &mut Playing, velocity| {
        playing.note_on(38, velocity_from_midi(velocity), 9).unwrap().strike.speed
    };
    let (lower, upper) = (speed(&mut playing, 64), speed(&mut playing, 65));
    playing.control_change(88, 64.0 / 127.0, 9);
    let between = speed(&mut playing, 64);
    assert!((between - (lower * upper).sqrt()).abs() < 1e-5 * between, "{lower} {between} {upper}");
    assert_eq!(speed(&mut playing, 64), lower);
    playing.control_change(88, 1.0, 3);
    assert_eq!(speed(&mut playing, 64), lower, "another channel's");
}

#[test]
fn pressure_lays_a_hand_on_a_piece_and_lets_go() {
    let mut playing = playing();
    assert_eq!(playing.pressure(49, 1.0, 9), Some(Grip { slot: standard_slot("crash"), strength: 1.0 }));
    assert_eq!(playing.pressure(49, 0.0, 9).unwrap().strength, 0.0);
    assert_eq!(playing.pressure(38, 0.5, 9), Some(Grip { slot: standard_slot("snare"), strength: 0.5 }));
    assert_eq!(playing.choke(38, 9), None, "drums are not choked");
    assert_eq!(playing.note_off(49, 9), None, "not by default");
    assert!(!playing.note_on(49, 1.0, 9).unwrap().releases, "the hand is where the pressure says");
}

#[test]
fn the_end_of_a_note_grips_until_the_next_stroke() {
    let mut playing = playing();
    playing.style.chokes = ChokeRule::NoteOff;
    assert!(playing.note_off(49, 9).is_some());
    assert_eq!(playing.pressure(49, 1.0, 9), None);
    assert!(playing.note_on(49, 1.0, 9).unwrap().releases);
    assert!(!playing.note_on(49, 1.0, 9).unwrap().releases);
    playing.style.chokes = ChokeRule::Off;
    assert_eq!(playing.note_off(49, 9), None);
    assert!(playing.choke(49, 9).is_some(), "a host's own choke counts always");
}

#[test]
fn assignments_come_before_the_map_and_are_learned() {
    let assignments = Arc::<Assignments>::default();
    let mut playing = Playing::new(Arc::default(), assignments.clone());
    assignments.assign(38, Assignment::Plays(49));
    assert_eq!(playing.note_on(38, 1.0, 9).unwrap().slot, standard_slot("crash"));
    assignments.assign(38, Assignment::Silent);
    assert_eq!(playing.note_on(38, 1.0, 9), None);
    assignments.learn(Some(36));
    assert_eq!(
        playing.note_on(3, 1.0, 9).unwrap().slot,
        standard_slot("kick"),
        "the learned note plays at once"
    );
    assert_eq!(playing.note_on(3, 1.0, 9).unwrap().slot, standard_slot("kick"));
}

#[test]
fn unevenness_is_as_large_as_asked_and_repeats() {
    let mut playing = playing();
    playing.style.position_spread = 0.05;
    playing.style.speed_spread = 1.0;
    let strikes = |playing: &mut Playing| -> Vec<Strike> {
        (0..2000).map(|_| playing.note_on(38, 1.0, 9).unwrap().strike).collect()
    };
    let first = strikes(&mut playing);
    let aimed = (0.25 * 0.3_f64.cos(), 0.25 * 0.3_f64.sin());
    let mean = |of: &dyn Fn(&Strike) -> f64| first.iter().map(of).sum::<f64>() / first.len() as f64;
    let away = mean(&|strike| {
        let (x, y) = (strike.radius * strike.angle.cos(), strike.radius * strike.angle.sin());
        (x - aimed.0).hypot(y - aimed.1)
    });
    assert!((away - 0.05).abs() < 0.003, "{away}");
    let apart = mean(&|strike| (20.0 * (strike.speed / FULL_SPEED).log10()).abs());
    assert!((apart - 1.0).abs() < 0.05, "{apart}");
    let middle = mean(&|strike| 20.0 * (strike.speed / FULL_SPEED).log10());
    assert!(middle.abs() < 0.1, "{middle}");
    playing.reset();
    assert_eq!(strikes(&mut playing), first);
}

#[test]
fn a_hand_that_strays_does_not_leave_the_head() {
    let mut playing = playing();
    playing.style.position_spread = 0.05;
    // All the way out, where the rim holds a head still.
    for _ in 0..200 {
        playing.aim(Some(1.0_f32));
        let strike = playing.note_on(48, 1.0, 9).unwrap().strike;
        assert!((0.8..=0.95).contains(&strike.radius), "{}", strike.radius);
    }
}

#[test]
fn hands_alternate_and_a_beater_keeps_its_place() {
    let mut playing = playing();
    let aimed = playing.note_on(36, 1.0, 9).unwrap().strike;
    playing.reset();
    playing.style.position_spread = 0.05;
    playing.style.speed_spread = 1.0;
    // Strokes of the foot in between take no hand's turn.
    let mut hands = [const { Vec::new() }; 2];
    for count in 0..4000 {
        hands[count % 2].push(playing.note_on(38, 1.0, 9).unwrap().strike);
        if count % 3 == 0 {
            let foot = playing.note_on(36, 1.0, 9).unwrap().strike;
            assert_eq!(
                (foot.radius, foot.angle),
                (aimed.radius, aimed.angle),
                "a beater away from its place"
            );
        }
    }
    let mean =
        |hand: &[Strike], of: &dyn Fn(&Strike) -> f64| hand.iter().map(of).sum::<f64>() / hand.len() as f64;
    let sides = hands.each_ref().map(|hand| mean(hand, &|strike| strike.radius * strike.angle.sin()));
    let apart = sides[0] - sides[1];
    assert!((apart - 0.05).abs() < 0.004, "{apart} of the radius between the hands");
    let speeds = hands.each_ref().map(|hand| mean(hand, &|strike| 20.0 * strike.speed.log10()));
    let stronger = speeds[0] - speeds[1];
    assert!((stronger - 0.6).abs() < 0.1, "{stronger} dB between the hands");
    playing.reset();
    let again = playing.note_on(38, 1.0, 9).unwrap().strike;
    assert_eq!(again, hands[0][0], "the first stroke after a reset is the right hand's");
}

#[test]
fn parameters_move_the_place_and_change_the_striker() {
    let mut playing = playing();
    let snare = standard_slot("snare").index();
    playing.style.offsets[snare] = 0.3;
    playing.style.strikers[snare] = Some(Striker::Nylon);
    let strike = playing.note_on(38, 1.0, 9).unwrap().strike;
    assert!((strike.radius - 0.55).abs() < 1e-12);
    assert_eq!(strike.striker, Striker::Nylon);
    playing.style.offsets[snare] = -1.0;
    assert_eq!(radius(&mut playing, 38), 0.0);
}

#[test]
fn two_hi_hats_have_pedals_of_their_own_and_share_the_controller() {
    let mut document = KitDocument::standard();
    let hat = standard_slot("hi-hat");
    let mut other = document.kit.piece(hat).unwrap().clone();
    other.name = "hi-hat-2".to_owned();
    other.place.centre[1] += 0.1;
    document.kit.pieces.push(other);
    let second = Slot::ALL[hat.index() + 1];
    let mut row = document.notes.row(44).unwrap().clone();
    row.meaning = crate::midi_map::Meaning::Steps(second, Foot::Chick);
    document.notes.set(20, Some(row));
    assert_eq!(document.check(), Ok(()));
    let mut playing = Playing::new(Arc::new(document), Arc::default());
    let stepped = |playing: &Playing, note| playing.foot(note, 1.0, 9).map(|(slot, foot, _)| (slot, foot));
    assert_eq!(stepped(&playing, 44), Some((hat, Foot::Chick)));
    assert_eq!(stepped(&playing, 20), Some((second, Foot::Chick)));
    assert_eq!(stepped(&playing, 42), Some((hat, Foot::Position(0.8))));
    assert_eq!(playing.pedal(4, 0.25, 9), Some(0.25));
    assert_eq!(playing.pedal_at(), Some(0.25));
    for (controlled, note, brought) in [
        (0.25, 42, 0.8),
        (0.25, 46, 0.25),
        (0.55, 46, 0.55),
        (0.55, 42, 0.8),
        (0.9, 42, 0.9),
        (0.9, 46, 0.455),
        (0.9, 100, 0.48),
    ] {
        playing.pedal(4, controlled as f32, 9);
        let Some((slot, Foot::Position(pedal))) = stepped(&playing, note) else {
            panic!("note {note} leaves the pedal");
        };
        assert_eq!(slot, hat, "note {note}");
        assert!((pedal - brought).abs() < 1e-6, "note {note} at {controlled}: {pedal}, not {brought}");
    }
    assert_eq!(stepped(&playing, 98), None, "a stroke that names no opening leaves the pedal");
}

#[test]
fn notes_follow_the_kit() {
    let mut document = KitDocument::standard();
    let (crash, ride) = (standard_slot("crash"), standard_slot("ride"));
    let row = document.notes.row(51).cloned();
    document.notes.set(49, row);
    document.notes.set(38, None);
    let mut playing = playing();
    assert_eq!(playing.note_on(49, 1.0, 9).unwrap().slot, crash);
    let former = playing.change_kit(Arc::new(document));
    assert_eq!(*former, KitDocument::standard());
    assert_eq!(playing.note_on(49, 1.0, 9).unwrap().slot, ride);
    assert_eq!(playing.note_on(38, 1.0, 9), None);
}
