//! Streams of module families, written after their implementation charts, replayed: every event lands on the right
//! articulation.

use super::*;
use crate::kit_document::standard_slot;
use crate::midi::calibration::Learned;
use crate::midi::learning::{Incoming, Lesson, MidiMessage};
use crate::midi_map::Foot;

/// Sample rate, Hz.
const RATE: f64 = 48_000.0;

/// Milliseconds, and the bytes that arrive.
type Stream<'a> = &'a [(u32, [u8; 3])];

/// What a stroke came to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Found {
    /// Piece, distance from the centre, striker, and whether its wires lie on if the note says so.
    Stroke(Slot, f64, Striker, Option<bool>),
    /// What the foot does.
    Foot(Foot),
    /// A hand on a piece.
    Grip(Slot, f64),
    /// Wires thrown on or off.
    Wires(bool),
}

/// A module and who plays it.
struct Module {
    playing: Playing,
    now: u32,
}

impl Module {
    fn new(map: NoteMap) -> Module {
        let mut playing = Playing::new(Arc::default(), Arc::default());
        playing.style = Style {
            map,
            position_spread: 0.0,
            speed_spread: 0.0,
            chokes: ChokeRule::Both,
            ..Style::default()
        };
        Module { playing, now: 0 }
    }

    fn learn(&mut self, learned: &Learned) {
        self.playing.assignments.calibration().replace(learned);
    }

    /// Plays a stream as a performer does, and tells what came of every event, in order.
    fn replay(&mut self, stream: Stream<'_>) -> Vec<Found> {
        let mut found = Vec::new();
        for &(time, [status, first, second]) in stream {
            self.playing.advance(((time - self.now) * 48) as usize, RATE);
            self.now = time;
            let (channel, share) = (status & 15, velocity_from_midi(second));
            match status & 0xF0 {
                0x90 if second > 0 => self.note(first, share, channel, &mut found),
                0x80 | 0x90 => {
                    found.extend(
                        self.playing
                            .note_off(first, channel)
                            .map(|grip| Found::Grip(grip.slot, grip.strength)),
                    );
                }
                0xA0 => {
                    let grip = self.playing.pressure(first, share, channel);
                    found.extend(grip.map(|grip| Found::Grip(grip.slot, grip.strength)));
                }
                0xB0 => {
                    self.playing.control_change(first, share, channel);
                    let pedal = self.playing.pedal(first, share, channel);
                    found.extend(pedal.map(|place| Found::Foot(Foot::Position(place))));
                    found.extend(self.playing.throw(first, share, channel).map(Found::Wires));
                }
                _ => unreachable!("not in these streams"),
            }
        }
        found
    }

    fn note(&mut self, note: u8, velocity: f32, channel: u8, found: &mut Vec<Found>) {
        let Some(velocity) = self.playing.triggered(note, velocity, channel) else { return };
        match self.playing.handled(note, velocity, channel) {
            Some(Handled::Grips(grip)) => found.push(Found::Grip(grip.slot, grip.strength)),
            Some(Handled::Throws(_, on)) => found.push(Found::Wires(on)),
            None => {}
        }
        let foot = self.playing.foot(note, velocity, channel);
        found.extend(foot.map(|(_, foot, _)| Found::Foot(foot)));
        let struck = self.playing.note_on(note, velocity, channel);
        found.extend(struck.map(|played| {
            let Strike { radius, striker, .. } = played.strike;
            Found::Stroke(played.slot, radius, striker, played.wires)
        }));
    }
}

fn stroke(piece: &str, radius: f64, striker: Striker) -> Found {
    Found::Stroke(standard_slot(piece), radius, striker, None)
}

fn foot(place: f64) -> Found {
    Found::Foot(Foot::Position(place))
}

/// Compares, the places of strokes and feet to a hundredth.
#[track_caller]
fn assert_found(found: &[Found], expected: &[Found]) {
    let close = |a: f64, b: f64| (a - b).abs() < 0.01;
    let same = |pair: (&Found, &Found)| match pair {
        (Found::Stroke(a, at, with, on), Found::Stroke(b, to, other, off)) => {
            (a, with, on) == (b, other, off) && close(*at, *to)
        }
        (Found::Foot(Foot::Position(a)), Found::Foot(Foot::Position(b))) => close(*a, *b),
        (Found::Grip(a, strength), Found::Grip(b, other)) => a == b && close(*strength, *other),
        (a, b) => a == b,
    };
    let whole = found.len() == expected.len() && found.iter().zip(expected).all(same);
    assert!(whole, "\nfound    {found:?}\nexpected {expected:?}");
}

use Striker::{CrossStick, RimShot, Shoulder, Stick, YarnMallet};

#[test]
fn roland_positions_precede_notes_rides_have_three_zones_and_aftertouch_chokes() {
    // A pad that senses positions sends where it was struck before each note; the pedal's place precedes the hats' notes, and
    // trembles by a step.
    let stream: Stream = &[
        (0, [0x99, 36, 100]),
        (10, [0xB9, 16, 0]),
        (10, [0x99, 38, 90]),
        (110, [0xB9, 16, 127]),
        (110, [0x99, 38, 60]),
        (200, [0x99, 40, 110]),
        (300, [0x99, 37, 70]),
        (320, [0x99, 23, 20]),
        (400, [0xB9, 17, 64]),
        (400, [0x99, 51, 80]),
        (450, [0x99, 59, 80]),
        (500, [0x99, 53, 80]),
        (510, [0xA9, 51, 64]),
        (520, [0xA9, 51, 0]),
        (600, [0xB9, 4, 20]),
        (600, [0x99, 46, 80]),
        (640, [0xB9, 4, 21]),
        (700, [0xB9, 4, 127]),
        (700, [0x99, 22, 80]),
        (750, [0x99, 44, 90]),
    ];
    let ride = standard_slot("ride");
    assert_found(
        &Module::new(NoteMap::Roland).replay(stream),
        &[
            stroke("kick", 0.2, Striker::FeltBeater),
            stroke("snare", 0.0, Stick),
            stroke("snare", 0.95, Stick),
            stroke("snare", 0.4, RimShot),
            stroke("snare", 0.3, CrossStick),
            stroke("snare", 0.95, YarnMallet),
            stroke("ride", 0.25 + 0.72 * 64.0 / 127.0, Stick),
            stroke("ride", 0.97, Shoulder),
            stroke("ride", 0.12, Shoulder),
            Found::Grip(ride, 64.0 / 127.0),
            Found::Grip(ride, 0.0),
            foot(20.0 / 127.0),
            foot(20.0 / 127.0),
            // On the bow it is where the position controller of hats has it: nobody has moved it.
            stroke("hi-hat", 0.65, Stick),
            foot(21.0 / 127.0),
            foot(1.0),
            foot(1.0),
            stroke("hi-hat", 0.97, Shoulder),
            Found::Foot(Foot::Chick),
        ],
    );
}

#[test]
fn yamaha_notes_of_a_snare_thrown_off_and_cups_of_hats() {
    let stream: Stream = &[
        (0, [0x99, 38, 90]),
        (100, [0x99, 31, 90]),
        (200, [0x99, 34, 90]),
        (300, [0x99, 27, 90]),
        (400, [0x99, 40, 90]),
        (500, [0x99, 52, 90]),
        (600, [0x99, 53, 90]),
        (700, [0x99, 85, 90]),
        (800, [0x99, 86, 90]),
        (900, [0x99, 83, 90]),
        (1000, [0x99, 55, 90]),
        (1050, [0xA9, 55, 127]),
    ];
    let off = |radius, striker| Found::Stroke(standard_slot("snare"), radius, striker, Some(false));
    assert_found(
        &Module::new(NoteMap::Yamaha).replay(stream),
        &[
            stroke("snare", 0.25, Stick),
            off(0.25, Stick),
            off(0.4, RimShot),
            off(0.3, CrossStick),
            stroke("snare", 0.4, RimShot),
            stroke("ride", 0.97, Shoulder),
            stroke("ride", 0.12, Shoulder),
            foot(0.455),
            stroke("hi-hat", 0.12, Stick),
            foot(0.8),
            stroke("hi-hat", 0.12, Stick),
            Found::Foot(Foot::Splash),
            stroke("crash", 0.12, Shoulder),
            Found::Grip(standard_slot("crash"), 1.0),
        ],
    );
}

#[test]
fn alesis_half_open_notes_and_note_offs_that_choke() {
    let stream: Stream = &[
        (0, [0x99, 46, 90]),
        (100, [0x99, 23, 90]),
        (200, [0x99, 42, 90]),
        (300, [0x99, 21, 90]),
        (400, [0x99, 49, 90]),
        (500, [0x89, 49, 0]),
        (600, [0x99, 58, 90]),
    ];
    assert_found(
        &Module::new(NoteMap::Alesis).replay(stream),
        &[
            foot(0.455),
            stroke("hi-hat", 0.97, Shoulder),
            foot(0.48),
            stroke("hi-hat", 0.97, Shoulder),
            foot(0.8),
            stroke("hi-hat", 0.97, Shoulder),
            Found::Foot(Foot::Splash),
            stroke("crash", 0.97, Shoulder),
            Found::Grip(standard_slot("crash"), 1.0),
            stroke("floor-tom", 0.4, RimShot),
        ],
    );
}

#[test]
fn efnote_bows_edges_and_half_open_hats() {
    let stream: Stream = &[
        (0, [0x99, 42, 90]),
        (100, [0x99, 22, 90]),
        (200, [0x99, 24, 90]),
        (300, [0x99, 52, 90]),
        (400, [0x99, 57, 90]),
        (450, [0xA9, 57, 127]),
    ];
    assert_found(
        &Module::new(NoteMap::Efnote).replay(stream),
        &[
            foot(0.8),
            stroke("hi-hat", 0.65, Stick),
            foot(0.8),
            stroke("hi-hat", 0.97, Shoulder),
            foot(0.48),
            stroke("hi-hat", 0.97, Shoulder),
            stroke("crash", 0.97, Shoulder),
            stroke("crash", 0.6, Stick),
            Found::Grip(standard_slot("crash"), 1.0),
        ],
    );
}

#[test]
fn edrumin_inverted_pedal_is_learned_and_the_strainer_thrown_by_notes_and_controllers() {
    let mut module = Module::new(NoteMap::Edrumin);
    // Its pedal was plugged in so that it reads 118 when it is up and 6 when it is down.
    let mut lesson = Lesson::default();
    let way = [118, 118, 118, 100, 60, 20, 6, 6, 30, 80, 118, 117, 118, 70, 6, 6, 118];
    for (at, value) in (0..).zip(way) {
        lesson.hear(Incoming {
            time: f64::from(at) * 0.05,
            channel: 9,
            message: MidiMessage::Controller(4, value),
        });
    }
    let pedal = lesson.pedal().unwrap();
    assert!(pedal.is_inverted() && !pedal.stuck, "{pedal:?}");
    module.learn(&Learned { pedal: Some(pedal), ..Learned::default() });
    let stream: Stream = &[
        (0, [0xB9, 4, 118]),
        (0, [0x99, 26, 90]),
        (100, [0xB9, 4, 5]),
        (100, [0x99, 22, 90]),
        (200, [0x99, 84, 127]),
        (210, [0x99, 38, 90]),
        (300, [0xB9, 80, 127]),
        (310, [0x99, 38, 90]),
    ];
    let snare = |on| Found::Stroke(standard_slot("snare"), 0.25, Stick, Some(on));
    assert_found(
        &module.replay(stream),
        &[
            foot(0.0),
            foot(0.0),
            stroke("hi-hat", 0.97, Shoulder),
            foot(1.0),
            foot(1.0),
            stroke("hi-hat", 0.97, Shoulder),
            Found::Wires(false),
            snare(false),
            Found::Wires(true),
            snare(true),
        ],
    );
}

#[test]
fn megadrum_openings_choke_notes_and_a_noisy_pedal_double_triggers_and_crosstalk() {
    let mut module = Module::new(NoteMap::Megadrum);
    let noisy = crate::midi::calibration::Pedal { noise: 3, ..Default::default() };
    let snare = crate::midi::calibration::Pad { retrigger: 20, ..Default::default() };
    module.learn(&Learned { pads: [(38, snare)].into(), pedal: Some(noisy), crosstalk: 15 });
    let openings: Stream = &[
        (0, [0x99, 23, 90]),
        (50, [0x99, 24, 90]),
        (100, [0x99, 25, 90]),
        (150, [0x99, 26, 90]),
        (200, [0x99, 27, 90]),
        (250, [0x99, 28, 90]),
        (300, [0x99, 29, 90]),
    ];
    let expected: Vec<Found> = [1.0, 0.65, 0.48, 0.4, 0.3, 0.15, 0.0]
        .into_iter()
        .flat_map(|place| [foot(place), stroke("hi-hat", 0.97, Shoulder)])
        .collect();
    assert_found(&module.replay(openings), &expected);
    let stream: Stream = &[
        (400, [0x99, 60, 127]),
        (500, [0xB9, 4, 60]),
        (505, [0xB9, 4, 62]),
        (510, [0xB9, 4, 58]),
        (515, [0xB9, 4, 64]),
        (600, [0x99, 38, 110]),
        (603, [0x99, 48, 9]),
        (612, [0x99, 38, 40]),
        (640, [0x99, 38, 40]),
    ];
    assert_found(
        &module.replay(stream),
        &[
            Found::Grip(standard_slot("crash"), 1.0),
            foot(60.0 / 127.0),
            foot(64.0 / 127.0),
            stroke("snare", 0.25, Stick),
            stroke("snare", 0.25, Stick),
        ],
    );
}

#[test]
fn a_stuck_pedal_is_not_listened_to_so_that_notes_open_and_close_the_hats() {
    let mut module = Module::new(NoteMap::Roland);
    let mut lesson = Lesson::default();
    for at in 0..50 {
        let message = MidiMessage::Controller(4, 64 + at % 2);
        lesson.hear(Incoming { time: f64::from(at) * 0.02, channel: 9, message });
    }
    module.learn(&Learned { pedal: lesson.pedal(), ..Learned::default() });
    let stream: Stream =
        &[(0, [0xB9, 4, 64]), (0, [0x99, 26, 90]), (100, [0xB9, 4, 65]), (100, [0x99, 22, 90])];
    assert_found(
        &module.replay(stream),
        &[foot(0.455), stroke("hi-hat", 0.97, Shoulder), foot(0.8), stroke("hi-hat", 0.97, Shoulder)],
    );
}
