//! Notes of the hi-hat: a note names a finished sound, whatever the foot did before.

use std::sync::{Arc, OnceLock};

use overhear::building::{BuildPlan, Pace};
use overhear::kit_document::KitDocument;
use overhear::midi::assignments::Assignments;
use overhear::midi_map::NoteTable;
use overhear::parameters::find;
use overhear::performer::{Performer, velocity_from_midi};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{KitSnapshot, RimSnapshot};

const RATE: f64 = 44_100.0;
const CHANNEL: u8 = 9;
const SLOT: Slot = Slot::ALL[0];
const VELOCITIES: [u8; 4] = [30, 60, 90, 120];

/// The standard kit without all but its hi-hat.
fn document() -> &'static KitDocument {
    static DOCUMENT: OnceLock<KitDocument> = OnceLock::new();
    DOCUMENT.get_or_init(|| {
        let mut kit = KitSpec::standard();
        kit.pieces.retain(|piece| piece.name == "hi-hat");
        let notes = NoteTable::standard(&kit);
        KitDocument { kit, notes }
    })
}

/// What a player does.
#[derive(Debug, Clone, Copy)]
enum Event {
    /// A note at the velocity of the case.
    Note(u8),
    /// Controller 4 at a value.
    Pedal(u8),
}
use Event::{Note, Pedal};

/// A hi-hat and who plays it.
struct Player {
    performer: Performer,
}

impl Player {
    fn new() -> Player {
        let document = document();
        let mut performer = Performer::new(RATE, document, Arc::<Assignments>::default());
        let value = |index| performer.parameter(index).unwrap_or_default();
        let plan = BuildPlan::of(Arc::new(document.clone()), value, Pace::RealTime);
        let build = plan.build(SLOT).expect("a hi-hat");
        performer.install(Box::new(Piece::new(SLOT, &build, &plan.options(RATE)).expect("a valid hi-hat")));
        // Even strokes: every case is of the speed and at the place that it is called by.
        for name in ["humanize_position", "humanize_velocity"] {
            performer.set_parameter(find(name, &document.kit).expect("a parameter"), 0.0);
        }
        Player { performer }
    }

    fn play(&mut self, event: Event, velocity: u8) {
        match event {
            Note(note) => {
                let sounds = self.performer.note_on(note, velocity_from_midi(velocity), CHANNEL);
                assert!(sounds, "note {note} is silent");
            }
            Pedal(value) => self.performer.control_change(4, f32::from(value) / 127.0, CHANNEL),
        }
    }

    /// Left side of the close microphone.
    fn render(&mut self, seconds: f64) -> Vec<f32> {
        let samples = (seconds * RATE).round() as usize;
        let [mut left, mut right, mut close, mut other] = [(); 4].map(|()| vec![0.0; samples]);
        self.performer.render_outputs([&mut left, &mut right], &mut [[&mut close, &mut other]]);
        close
    }

    fn rims(&mut self) -> RimSnapshot {
        let mut snapshot = KitSnapshot::default();
        self.performer.snapshot(&mut snapshot);
        snapshot.pieces[SLOT.index()].rims
    }
}

fn energy(sound: &[f32]) -> f64 {
    sound.iter().map(|x| f64::from(x * x)).sum()
}

/// The samples from one time to another, s.
fn between(sound: &[f32], from: f64, to: f64) -> &[f32] {
    &sound[(from * RATE).round() as usize..(to * RATE).round() as usize]
}

/// How much louder `a` is than `b`, both of the same length, dB.
fn louder(a: &[f32], b: &[f32]) -> f64 {
    assert_eq!(a.len(), b.len());
    10.0 * (energy(a) / energy(b)).log10()
}

/// Time at which the loudest millisecond begins, ms.
fn loudest_ms(sound: &[f32]) -> f64 {
    let energies = sound.windows((0.001 * RATE).round() as usize).map(energy).enumerate();
    let (at, _) = energies.max_by(|a, b| a.1.total_cmp(&b.1)).expect("some sound");
    1e3 * at as f64 / RATE
}

/// An eighth note at 240 a minute after what came before: the next note, for 0.3 s, and the rims 5 ms after it.
fn after(before: Option<Event>, note: u8, velocity: u8) -> (Vec<f32>, RimSnapshot) {
    let mut player = Player::new();
    before.into_iter().for_each(|event| player.play(event, velocity));
    player.render(0.125);
    player.play(Note(note), velocity);
    let mut sound = player.render(0.005);
    let rims = player.rims();
    sound.extend(player.render(0.295));
    (sound, rims)
}

/// Loudest millisecond of a sound, and how much louder it is than the loudest of the first 8, dB.
fn late(sound: &[f32]) -> (f64, f64) {
    let window = (0.001 * RATE).round() as usize;
    let loudest = |sound: &[f32]| sound.windows(window).map(energy).fold(0.0, f64::max);
    let early = loudest(between(sound, 0.0, 0.009));
    (loudest_ms(sound), 10.0 * (loudest(sound) / early).log10())
}

#[test]
fn a_struck_note_is_closed_or_open_in_5_ms_and_loud_within_8_whatever_the_pedal_did_before() {
    let closed = [None, Some(Note(42)), Some(Note(46)), Some(Pedal(0)), Some(Pedal(64)), Some(Pedal(127))];
    let cases = closed.map(|before| (before, 42)).into_iter().chain([(Some(Note(42)), 46)]);
    println!(
        "beginning of the loudest ms after the note, ms, at velocities {VELOCITIES:?}, and dB over the first 8 ms"
    );
    let mut late_ones = 0;
    for (before, note) in cases {
        let figures = VELOCITIES.map(|velocity| {
            let (sound, rims) = after(before, note, velocity);
            (late(&sound), rims.clamped)
        });
        println!("{note} after {before:?}: {:.2?}", figures.map(|(late, _)| late));
        for (velocity, ((ms, over), clamped)) in VELOCITIES.into_iter().zip(figures) {
            let case = format!("{note} after {before:?} at {velocity}");
            let expected = if note == 42 { 24.0..101.0 } else { 0.0..1e-6 };
            assert!(expected.contains(&clamped), "{case}: clamped with {clamped} N after 5 ms");
            // Rims that clatter, hats that rang and are closed, and open ones struck hard are about as loud for tens of
            // milliseconds; which of them is loudest is then chance.
            // The thud of a soft stroke may be loudest at once.
            assert!(ms < 40.0 && over < 2.5, "{case}: loudest after {ms} ms, by {over} dB");
            late_ones += u32::from(ms >= 8.0);
        }
    }
    println!("{late_ones} of 28 are loudest after 8 ms");
    assert!(late_ones <= 12, "{late_ones} are loudest after 8 ms");
}

#[test]
fn a_foot_by_itself_takes_its_time() {
    for (before, note) in [(None, 44), (Some(Note(46)), 44), (None, 97)] {
        let figures = VELOCITIES.map(|velocity| loudest_ms(&after(before, note, velocity).0));
        println!("{note} after {before:?}: {figures:.2?} ms");
        let possible = 5.0..130.0;
        assert!(figures.iter().all(|ms| possible.contains(ms)), "{note} after {before:?}: {figures:?} ms");
    }
}

#[test]
fn bark_of_an_open_hi_hat_that_a_note_closes() {
    for velocity in VELOCITIES {
        let falls = [42, 44].map(|note| {
            let [open, closed] = [None, Some(note)].map(|note| {
                let mut player = Player::new();
                player.play(Note(46), velocity);
                player.render(0.25);
                note.into_iter().for_each(|note| player.play(Note(note), velocity));
                player.render(0.3)
            });
            [(0.0, 0.06), (0.25, 0.3)]
                .map(|(from, to)| louder(between(&closed, from, to), between(&open, from, to)))
        });
        println!(
            "{velocity}: 42 and 44, against an open hi-hat, in the first 60 ms and after 250: {falls:.1?} dB"
        );
        for [bark, left] in falls {
            // Open ones sizzle on.
            assert!(bark > 2.0 && bark < 35.0, "velocity {velocity}: {bark} dB at first");
            assert!(left < -10.0, "velocity {velocity}: {left} dB are left");
        }
    }
}

#[test]
fn every_stroke_of_a_fast_pattern_is_heard_at_its_time() {
    let sixteenth = 60.0 / 220.0 / 4.0;
    let pattern = [42, 42, 46, 44, 42, 46, 42, 46, 44, 46, 46, 42, 42, 44, 42, 46];
    for velocity in VELOCITIES {
        let mut player = Player::new();
        let sounds: Vec<_> = pattern
            .into_iter()
            .cycle()
            .take(2 * pattern.len())
            .map(|note| {
                player.play(Note(note), velocity);
                (note, player.render(sixteenth))
            })
            .collect();
        let mut least = f64::INFINITY;
        for pair in sounds.windows(2) {
            let [(former, before), (note, now)] = pair else { unreachable!() };
            let attack = between(now, 0.0, 0.008);
            let over = louder(attack, &before[before.len() - attack.len()..]);
            match (former, note) {
                (42 | 46, 42) | (42, 46) => {
                    least = least.min(over);
                    // After the hardest strokes an open hi-hat rings as loud as the closed stroke that ends it begins.
                    assert!(
                        over > -1.0,
                        "velocity {velocity}: {note} after {former} is {over} dB over what rings"
                    );
                }
                (_, 44) => {
                    let ms = loudest_ms(now);
                    assert!(
                        ms > 3.0 && ms < 55.0,
                        "velocity {velocity}: 44 after {former} sounds after {ms} ms"
                    );
                }
                _ => {}
            }
        }
        println!("{velocity}: at least {least:.1} dB over what rings");
        assert!(least < 15.0, "velocity {velocity}: {least} dB, nothing rings");
    }
}
