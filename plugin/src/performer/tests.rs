use super::*;
use crate::parameters::find;

const RATE: f64 = 48_000.0;

#[test]
fn only_notes_of_the_map_with_a_velocity_strike() {
    let mut performer = Performer::new(RATE);
    assert!(performer.note_on(38, 0.5, 9));
    for (note, velocity) in [(38, 0.0), (38, -1.0), (38, f32::NAN), (39, 1.0), (200, 1.0)] {
        assert!(!performer.note_on(note, velocity, 0), "{note} at {velocity}");
    }
    let mut snapshot = KitSnapshot::default();
    performer.snapshot(&mut snapshot);
    assert_eq!(snapshot.dropped_strikes, 1, "the snare is not built");
}

#[test]
fn parameters_snap_and_ignore_what_they_cannot_take() {
    let mut performer = Performer::new(RATE);
    performer.set_parameter(0, 60.004);
    assert_eq!(performer.parameter(0), Some(60.0));
    performer.set_parameter(0, f32::INFINITY);
    assert_eq!(performer.parameter(0), Some(90.0));
    performer.set_parameter(0, f32::NAN);
    assert_eq!(performer.parameter(0), Some(55.0));
    performer.set_parameter(PARAMETERS.len(), 1.0);
}

/// One event: sample, then a note and velocity, or a parameter and value.
enum Event {
    Note(usize, u8, f32),
    Parameter(usize, usize, f32),
}

fn score() -> Vec<Event> {
    use Event::*;
    vec![
        Note(0, 36, 1.0),
        Note(0, 49, 0.9),
        Parameter(700, 0, 62.0),
        Note(1_001, 38, 0.3),
        Parameter(1_001, 4, 0.4),
        Note(2_048, 48, 0.7),
        Note(2_049, 41, 0.8),
        Note(3_000, 51, 0.5),
        Parameter(3_300, 15, -2.0),
        Note(4_000, 55, 1.0),
        Parameter(5_000, 21, -6.0),
    ]
}

/// Renders the score in buffers of the given sizes, in turn.
fn play(sizes: &[usize]) -> (Vec<f32>, Vec<f32>) {
    const LENGTH: usize = 9_600;
    let mut performer = Performer::new(RATE);
    performer.install_kit(RATE).unwrap();
    let (mut left, mut right) = (vec![f32::NAN; LENGTH], vec![f32::NAN; LENGTH]);
    let mut score = score().into_iter().peekable();
    let (mut now, mut sizes) = (0, sizes.iter().cycle());
    while now < LENGTH {
        let end = LENGTH.min(now + sizes.next().unwrap());
        while now < end {
            let at = |event: &Event| match *event {
                Event::Note(at, ..) | Event::Parameter(at, ..) => at,
            };
            while let Some(event) = score.next_if(|event| at(event) == now) {
                match event {
                    Event::Note(_, note, velocity) => {
                        performer.note_on(note, velocity, 9);
                    }
                    Event::Parameter(_, index, value) => performer.set_parameter(index, value),
                }
            }
            let until = score.peek().map_or(end, |event| at(event).min(end));
            performer.render(&mut left[now..until], &mut right[now..until]);
            now = until;
        }
    }
    (left, right)
}

#[test]
fn values_set_before_the_first_sample_do_not_glide() {
    let start = |early: bool| {
        let mut performer = Performer::new(RATE);
        if early {
            performer.set_parameter(3, 300.0);
        }
        performer.install_kit(RATE).unwrap();
        performer.set_parameter(3, 300.0);
        performer.note_on(38, 1.0, 9);
        let mut sound = [vec![0.0; 4_800], vec![0.0; 4_800]];
        let [left, right] = &mut sound;
        performer.render(left, right);
        sound
    };
    assert!(start(true) == start(false));
}

#[test]
fn a_reset_performer_plays_like_a_new_one() {
    let hit = |performer: &mut Performer| {
        performer.note_on(36, 0.9, 9);
        performer.note_on(49, 0.6, 9);
        let mut sound = [vec![0.0; 4_800], vec![0.0; 4_800]];
        let [left, right] = &mut sound;
        performer.render(left, right);
        sound
    };
    let mut performer = Performer::new(RATE);
    performer.install_kit(RATE).unwrap();
    let first = hit(&mut performer);
    assert!(first.iter().flatten().any(|&sample| sample != 0.0));
    performer.render(&mut [0.0; 77], &mut [0.0; 77]);
    performer.reset();
    assert!(hit(&mut performer) == first);
}

#[test]
fn the_cut_into_buffers_does_not_change_a_sample() {
    let whole = play(&[9_600]);
    assert!(whole.0.iter().chain(&whole.1).all(|sample| sample.is_finite()));
    for sizes in [&[1][..], &[17], &[64], &[512], &[1, 255, 3, 1024, 31, 33]] {
        assert!(play(sizes) == whole, "buffers of {sizes:?}");
    }
}

#[test]
fn a_bend_is_the_tuning_so_many_semitones_away_until_the_next_stroke() {
    let (index, parameter) = find("rack_tom_tune").unwrap();
    let bent = parameter.snap(parameter.default * 2_f32.powf(0.25));
    let play = |act: &dyn Fn(&mut Performer)| {
        let mut performer = Performer::new(RATE);
        performer.install_kit(RATE).unwrap();
        let mut sound = vec![0.0; 4_800];
        performer.note_on(48, 0.8, 9);
        act(&mut performer);
        performer.render(&mut sound, &mut vec![0.0; 4_800]);
        sound
    };
    let semitones = 12.0 * (bent / parameter.default).log2();
    let by_bend = play(&|performer| performer.bend(48, semitones, 9));
    let by_parameter = play(&|performer| performer.set_parameter(index, bent));
    let away = by_bend.iter().zip(&by_parameter).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let peak = by_bend.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    assert!(away < 1e-3 * peak, "{away} of {peak}");
    let plain = play(&|_| {});
    assert!(by_bend != plain);
    let taken_back = play(&|performer| {
        performer.bend(48, semitones, 9);
        performer.bend(48, 0.0, 9);
    });
    assert!(taken_back == plain);
}

#[test]
fn a_jump_of_the_transport_leaves_the_foot_where_it_is() {
    let open_and_struck = |jump: bool, pedal: f32| {
        let mut performer = Performer::new(RATE);
        performer.install_kit(RATE).unwrap();
        performer.control_change(4, pedal, 9);
        performer.render(&mut vec![0.0; 24_000], &mut vec![0.0; 24_000]);
        if jump {
            performer.reset();
        }
        performer.note_on(98, 0.8, 9);
        let mut sound = vec![0.0; 24_000];
        performer.render(&mut sound, &mut vec![0.0; 24_000]);
        sound[12_000..].iter().map(|x| x * x).sum::<f32>()
    };
    let (closed, open) = (open_and_struck(true, 1.0), open_and_struck(true, 0.0));
    assert!(open > 30.0 * closed, "{open} open, {closed} closed");
    let stayed = open_and_struck(false, 1.0);
    assert!((closed / stayed).ln().abs() < 0.7, "{closed} after the jump, {stayed} without");
}
