use super::*;

fn lesson(events: impl IntoIterator<Item = (f64, MidiMessage)>) -> Lesson {
    let mut lesson = Lesson::default();
    events.into_iter().for_each(|(time, message)| lesson.hear(Incoming { time, channel: 9, message }));
    lesson
}

fn strokes(velocities: &[u8]) -> Vec<(f64, MidiMessage)> {
    (0..)
        .zip(velocities)
        .map(|(at, &velocity)| (f64::from(at) * 0.5, MidiMessage::Note(38, velocity)))
        .collect()
}

/// A foot that presses and releases three times, by a function from its place (0 up to 1 down) to readings.
fn pedal(reading: impl Fn(f64, u32) -> u8) -> Vec<(f64, MidiMessage)> {
    let place = |step: u32| {
        let part = f64::from(step % 100) / 100.0;
        (2.0 - (4.0 * part - 2.0).abs() - 0.5).clamp(0.0, 1.0)
    };
    (0..300)
        .map(|step| {
            (f64::from(step) * 0.01, MidiMessage::Controller(PEDAL_CONTROLLER, reading(place(step), step)))
        })
        .collect()
}

#[test]
fn a_pad_is_learned_from_soft_and_hard_strokes() {
    let learned = lesson(strokes(&[14, 18, 60, 65, 55, 110, 104])).pad().unwrap();
    assert_eq!((learned.note, learned.pad.low, learned.pad.high), (38, 14, 110));
    let middle = learned.pad.velocity(60.0 / 127.0);
    assert!((0.45..0.55).contains(&middle), "{middle}");
    assert_eq!((learned.pad.retrigger, learned.crosstalk), (0, 0));
    assert_eq!(lesson(strokes(&[60, 62, 64, 61, 59])).pad(), None, "all alike");
    assert_eq!(lesson(strokes(&[10, 120])).pad(), None, "too few");
    assert_eq!(lesson([]).pad(), None);
}

#[test]
fn double_triggers_and_crosstalk_are_measured() {
    let mut events = strokes(&[20, 60, 100, 120, 30]);
    events.push((0.5 + 0.018, MidiMessage::Note(38, 22)));
    events.push((1.5 + 0.004, MidiMessage::Note(48, 12)));
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let learned = lesson(events).pad().unwrap();
    assert!((19..=20).contains(&learned.pad.retrigger), "{learned:?}");
    assert_eq!(learned.crosstalk, 12);
    assert_eq!((learned.pad.low, learned.pad.high), (20, 120));
}

#[test]
fn a_pedal_of_either_sense_is_learned_with_its_ends() {
    let straight = lesson(pedal(|place, _| (10.0 + 100.0 * place) as u8)).pedal().unwrap();
    assert_eq!((straight.up, straight.down, straight.is_inverted()), (10, 110, false));
    let inverted = lesson(pedal(|place, _| (120.0 - 100.0 * place) as u8)).pedal().unwrap();
    assert_eq!((inverted.up, inverted.down, inverted.is_inverted()), (120, 20, true));
    assert!((inverted.place(20.0 / 127.0) - 1.0).abs() < 1e-6 && inverted.place(1.0) == 0.0);
}

#[test]
fn a_noisy_pedal_rests_and_a_stuck_one_is_not_listened_to() {
    let noisy = lesson(pedal(|place, step| (20.0 + 80.0 * place) as u8 + [0, 4, 1, 5][step as usize % 4]));
    let noisy = noisy.pedal().unwrap();
    assert!((3..=6).contains(&noisy.noise), "{noisy:?}");
    assert!(noisy.up.abs_diff(22) <= 4 && noisy.down.abs_diff(102) <= 4, "{noisy:?}");
    let stuck = lesson(pedal(|_, step| 64 + (step % 3) as u8)).pedal().unwrap();
    assert!(stuck.stuck);
    assert_eq!(lesson(strokes(&[1, 2])).pedal(), None, "nothing of it has arrived");
}

#[test]
fn chicks_say_where_the_hats_are_closed_and_splashes_where_they_meet() {
    let mut events = pedal(|place, _| (120.0 - 100.0 * place) as u8);
    // A reading of 40 is 0.8 of the way down.
    let at = events.iter().find(|(_, what)| matches!(what, MidiMessage::Controller(_, 34..=40))).unwrap().0;
    events.push((at + 0.001, MidiMessage::Note(44, 90)));
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let end = events.last().unwrap().0;
    for (after, value) in [(0.1, 118), (0.15, 60), (0.2, 50), (0.25, 118)] {
        events.push((end + after, MidiMessage::Controller(PEDAL_CONTROLLER, value)));
    }
    let learned = lesson(events).pedal().unwrap();
    assert!(learned.is_inverted());
    assert!((30..=40).contains(&learned.chick), "{learned:?}");
    assert_eq!(learned.splash, 50, "{learned:?}");
}
