use super::*;
use crate::kit_document::standard_slot;
use crate::parameters::{find, parameters};

const RATE: f64 = 48_000.0;

/// A performer at a kit without pieces.
fn at(document: &KitDocument) -> Performer {
    Performer::new(RATE, document, Arc::default())
}

/// A performer at the standard kit without pieces.
fn bare() -> Performer {
    at(&KitDocument::standard())
}

/// A performer at a kit as it is played.
fn ready(document: &KitDocument) -> Performer {
    let mut performer = at(document);
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    performer
}

/// The same, whose strokes are even.
fn even(document: &KitDocument) -> Performer {
    let mut performer = ready(document);
    performer.set_parameter(index("humanize_position"), 0.0);
    performer.set_parameter(index("humanize_velocity"), 0.0);
    performer
}

/// Place of a parameter of the standard kit.
fn index(name: &str) -> usize {
    find(name, &KitDocument::standard().kit).unwrap()
}

#[test]
fn only_notes_of_the_map_with_a_velocity_strike() {
    let mut performer = bare();
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
    let mut performer = bare();
    performer.set_parameter(0, 2.0004);
    assert_eq!(performer.parameter(0), Some(2.0));
    performer.set_parameter(0, f32::INFINITY);
    assert_eq!(performer.parameter(0), Some(12.0));
    performer.set_parameter(0, f32::NAN);
    assert_eq!(performer.parameter(0), Some(0.0));
    performer.set_parameter(COUNT, 1.0);
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
        Parameter(700, index("kick_tune"), 2.0),
        Note(1_001, 38, 0.3),
        Parameter(1_001, index("snare_muffle"), 0.4),
        Note(2_048, 48, 0.7),
        Note(2_049, 41, 0.8),
        Note(3_000, 51, 0.5),
        Parameter(3_300, index("ride_tune"), -2.0),
        Note(4_000, 55, 1.0),
        Parameter(5_000, index("master_level"), -6.0),
    ]
}

/// Renders the score in buffers of the given sizes, in turn.
fn play(sizes: &[usize]) -> (Vec<f32>, Vec<f32>) {
    const LENGTH: usize = 9_600;
    let mut performer = ready(&KitDocument::standard());
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
        let mut performer = bare();
        if early {
            performer.set_parameter(index("snare_tune"), 7.0);
        }
        performer.install_kit(RATE, Pace::RealTime).unwrap();
        performer.set_parameter(index("snare_tune"), 7.0);
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
    let mut performer = ready(&KitDocument::standard());
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
    let (tune, semitones) = (index("rack_tom_tune"), 3.0);
    let play = |act: &dyn Fn(&mut Performer)| {
        let mut performer = ready(&KitDocument::standard());
        let mut sound = vec![0.0; 4_800];
        performer.note_on(48, 0.8, 9);
        act(&mut performer);
        performer.render(&mut sound, &mut vec![0.0; 4_800]);
        sound
    };
    let by_bend = play(&|performer| performer.bend(48, semitones, 9));
    let by_parameter = play(&|performer| performer.set_parameter(tune, semitones));
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
        let mut performer = ready(&KitDocument::standard());
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

/// The samples of a stretch.
fn heard(performer: &mut Performer, samples: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
    performer.render(&mut left, &mut right);
    left.extend(right);
    left
}

/// The standard kit with a second crash and without its kick: every piece is in another slot.
fn other_kit() -> KitDocument {
    let mut kit = KitDocument::standard().kit;
    let mut crash = kit.piece(standard_slot("crash")).unwrap().clone();
    crash.name = "crash-2".to_owned();
    crash.place.centre[0] += 1.0;
    kit.pieces.push(crash);
    kit.pieces.remove(0);
    let notes = crate::midi_map::NoteTable::standard(&kit);
    KitDocument { kit, notes }
}

#[test]
fn another_kit_sounds_as_if_it_had_been_there_from_the_start() {
    let (former, other) = (KitDocument::standard(), other_kit());
    assert_eq!(other.check(), Ok(()));
    let strike = |performer: &mut Performer| {
        for note in [38, 49, 48, 55, 42] {
            assert!(performer.note_on(note, 0.8, 9));
        }
        heard(performer, 4_800)
    };
    let expected = strike(&mut ready(&other));
    let mut performer = ready(&former);
    performer.note_on(36, 0.5, 9);
    heard(&mut performer, 64);
    let put_away = performer.change_kit(Setup::new(RATE, Arc::new(other.clone())));
    assert_eq!(*put_away.document, former);
    assert_eq!(performer.document(), &other);
    for index in 0..COUNT {
        performer.set_parameter(index, default_value(index, &other.kit));
    }
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    assert!(performer.is_complete());
    // What stood there fades out, and is handed back.
    heard(&mut performer, 48_000);
    while performer.retire().is_some() {}
    performer.reset();
    assert!(strike(&mut performer) == expected);
}

#[test]
fn a_kit_without_a_piece_lets_it_fade_and_strikes_it_no_more() {
    let mut smaller = KitDocument::standard();
    let hat = standard_slot("hi-hat");
    smaller.kit.pieces.truncate(hat.index());
    smaller.notes = crate::midi_map::NoteTable::standard(&smaller.kit);
    let mut performer = ready(&KitDocument::standard());
    performer.note_on(46, 1.0, 9);
    heard(&mut performer, 480);
    let _ = performer.change_kit(Setup::new(RATE, Arc::new(smaller)));
    assert!(!performer.note_on(46, 1.0, 9));
    assert!(heard(&mut performer, 64).iter().any(|&sample| sample != 0.0), "it was cut off");
    heard(&mut performer, 48_000);
    assert!(performer.retire().is_some_and(|piece| piece.slot() == hat));
    assert!(performer.is_complete());
}

#[test]
fn what_a_piece_does_not_have_changes_no_sample() {
    let kit = KitDocument::standard().kit;
    let play = |inert: bool| {
        let mut performer = ready(&KitDocument::standard());
        for index in (0..COUNT).filter(|&index| inert && !is_live(index, &kit)) {
            performer.set_parameter(index, parameters()[index].max);
        }
        for note in [36, 38, 49, 42] {
            performer.note_on(note, 0.8, 9);
        }
        heard(&mut performer, 2_400)
    };
    assert!(play(true) == play(false));
}

#[test]
fn a_foot_stays_on_the_pedal_when_the_kit_changes() {
    let pedal = |performer: &mut Performer| {
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        snapshot.pieces[standard_slot("hi-hat").index()].rims.pedal
    };
    let mut performer = ready(&KitDocument::standard());
    performer.control_change(4, 0.9, 9);
    heard(&mut performer, 48_000);
    let down = pedal(&mut performer);
    let mut other = KitDocument::standard();
    other.notes.set(38, None);
    let _ = performer.change_kit(Setup::new(RATE, Arc::new(other)));
    heard(&mut performer, 48_000);
    assert_eq!(pedal(&mut performer), down);
}

#[test]
fn all_sound_off_and_all_notes_off_end_everything_within_ten_milliseconds() {
    let struck = |controller: Option<u8>, sizes: &[usize]| {
        let mut performer = ready(&KitDocument::standard());
        for note in [36, 38, 49, 51, 55, 46] {
            performer.note_on(note, 0.8, 9);
        }
        let mut sound = heard(&mut performer, 4_800);
        if let Some(controller) = controller {
            performer.control_change(controller, 0.0, 9);
        }
        sound.clear();
        sizes.iter().for_each(|&samples| {
            let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
            performer.render(&mut left, &mut right);
            sound.extend(left);
        });
        sound
    };
    let ringing = struck(None, &[4_800]);
    for controller in [120, 123] {
        let ended = struck(Some(controller), &[4_800]);
        assert!(ended[..400] != ringing[..400] && ended[100] != 0.0, "it fades");
        assert!(ended[480..].iter().all(|&sample| sample == 0.0), "something rings on");
        let steepest =
            |sound: &[f32]| sound.windows(2).fold(0.0_f32, |most, two| most.max((two[1] - two[0]).abs()));
        assert!(steepest(&ended) <= 1.01 * steepest(&ringing), "it clicks");
        assert!(struck(Some(controller), &[7, 400, 1, 71, 2, 4_319]) == ended);
    }
    assert!(struck(Some(7), &[4_800]) == ringing);
}

#[test]
fn a_stroke_after_all_sound_off_sounds_whole_and_alone() {
    let mut alone = even(&KitDocument::standard());
    heard(&mut alone, 64);
    alone.reset();
    alone.note_on(38, 0.8, 9);
    let expected = heard(&mut alone, 4_800);
    let mut performer = even(&KitDocument::standard());
    performer.note_on(49, 0.8, 9);
    heard(&mut performer, 4_800);
    performer.control_change(120, 0.0, 9);
    heard(&mut performer, 100);
    performer.note_on(38, 0.8, 9);
    assert!(heard(&mut performer, 4_800) == expected);
}

#[test]
fn a_foot_stays_on_the_pedal_through_all_notes_off() {
    let pedal = |performer: &mut Performer| {
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        snapshot.pieces[standard_slot("hi-hat").index()].rims.pedal
    };
    let mut performer = ready(&KitDocument::standard());
    performer.control_change(4, 0.9, 9);
    heard(&mut performer, 48_000);
    let down = pedal(&mut performer);
    performer.control_change(123, 0.0, 9);
    heard(&mut performer, 48_000);
    assert!(
        (pedal(&mut performer) - down).abs() < 0.02 * down.abs(),
        "{} from {down}",
        pedal(&mut performer)
    );
}

/// What a snare plays of a note that is held for a while, in buffers of a length, and how many strokes.
fn held(note: u8, samples: usize, buffer: usize) -> (Vec<f32>, u32) {
    let mut kit = overhear_engine::kit_spec::KitSpec::standard();
    kit.pieces.retain(|piece| piece.name == "snare");
    let notes = crate::midi_map::NoteTable::standard(&kit);
    let mut performer = ready(&KitDocument { kit, notes });
    let mut sound = Vec::new();
    let render = |performer: &mut Performer, sound: &mut Vec<f32>, samples: usize| {
        let mut left = samples;
        while left > 0 {
            let length = buffer.min(left);
            let (mut a, mut b) = (vec![0.0; length], vec![0.0; length]);
            performer.render(&mut a, &mut b);
            sound.extend(a);
            left -= length;
        }
    };
    assert!(performer.note_on(note, 0.6, 9));
    render(&mut performer, &mut sound, samples);
    performer.note_off(note, 9);
    render(&mut performer, &mut sound, 9_600);
    let mut snapshot = KitSnapshot::default();
    performer.snapshot(&mut snapshot);
    (sound, snapshot.pieces[0].strike.count)
}

#[test]
fn rolls_last_as_long_as_their_note_and_no_buffer_moves_a_stroke() {
    // Half a second, in strokes of the figures' own times.
    for (note, strokes) in [(121, 2..=2), (122, 9..=9), (123, 19..=23), (124, 44..=50)] {
        let (sound, count) = held(note, 24_000, 24_000);
        println!("note {note}: {count} strokes");
        assert!(strokes.contains(&count), "note {note}: {count} strokes");
        for buffer in [1_000, 64] {
            let (cut, other) = held(note, 24_000, buffer);
            assert!(cut == sound && other == count, "note {note} in buffers of {buffer}");
        }
    }
    let (_, count) = held(38, 24_000, 512);
    assert_eq!(count, 1);
}

#[test]
fn a_flam_s_grace_note_is_softer_and_elsewhere() {
    let mut playing = Playing::new(Arc::default(), Arc::default());
    let mut strike = |velocity: f32| playing.note_on(38, velocity, 9).unwrap().strike;
    for _ in 0..8 {
        let (grace, stroke) = (strike(0.25), strike(0.85));
        assert!(grace.speed < 0.5 * stroke.speed);
        let place =
            |strike: &Strike| (strike.radius * strike.angle.sin(), strike.radius * strike.angle.cos());
        let ((ax, ay), (bx, by)) = (place(&grace), place(&stroke));
        assert!((ax - bx).hypot(ay - by) > 0.005, "two hands at one place");
    }
}
