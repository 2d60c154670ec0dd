//! Notes of the hi-hat: when each is loudest, whatever the foot did before.

use std::sync::{Arc, OnceLock};

use anyhow::Result;
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

use super::page::bodies::PLAYED;
use super::page::sources::GOAL;
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Plot};

/// Sample rate, Hz.
pub const RATE: f64 = 44_100.0;

/// Velocities of the cases.
pub const VELOCITIES: [u8; 4] = [30, 60, 90, 120];

/// Time within which a struck note is to be loudest, ms. *Goal* of the project.
pub const SOON_MS: f64 = 8.0;

const CHANNEL: u8 = 9;
const SLOT: Slot = Slot::ALL[0];

/// What a player does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// A note at the velocity of the case.
    Note(u8),
    /// Controller 4 at a value.
    Pedal(u8),
}
use Event::{Note, Pedal};

/// What comes before each struck note that closes the cymbals, or opens closed ones, and its number.
pub const STRUCK: [(Option<Event>, u8); 8] = [
    (None, 42),
    (Some(Note(42)), 42),
    (Some(Note(46)), 42),
    (Some(Pedal(0)), 42),
    (Some(Pedal(64)), 42),
    (Some(Pedal(127)), 42),
    (Some(Note(42)), 46),
    (Some(Note(44)), 46),
];

/// The same of strokes on cymbals that are open before: rims that do not touch, or ring already.
pub const OPEN: [(Option<Event>, u8); 3] = [(None, 46), (Some(Note(46)), 46), (Some(Note(97)), 46)];

/// The same of notes that a foot plays alone.
pub const FOOT: [(Option<Event>, u8); 6] = [
    (None, 44),
    (Some(Note(42)), 44),
    (Some(Note(44)), 44),
    (Some(Note(46)), 44),
    (None, 97),
    (Some(Note(42)), 97),
];

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

/// A hi-hat and who plays it, with even strokes: each is of the speed and at the place that it is called by.
pub struct Player {
    performer: Performer,
}

impl Player {
    /// A hi-hat at rest, pedal up.
    ///
    /// # Panics
    /// If the standard kit has no hi-hat.
    pub fn new() -> Player {
        let document = document();
        let mut performer = Performer::new(RATE, document, Arc::<Assignments>::default());
        let value = |index| performer.parameter(index).unwrap_or_default();
        let plan = BuildPlan::of(Arc::new(document.clone()), value, Pace::RealTime);
        let build = plan.build(SLOT).expect("a hi-hat");
        performer.install(Box::new(Piece::new(SLOT, &build, &plan.options(RATE)).expect("a valid hi-hat")));
        for name in ["humanize_position", "humanize_velocity"] {
            performer.set_parameter(find(name, &document.kit).expect("a parameter"), 0.0);
        }
        Player { performer }
    }

    /// Does it; a note has this velocity.
    ///
    /// # Panics
    /// If a note is silent.
    pub fn play(&mut self, event: Event, velocity: u8) {
        match event {
            Note(note) => {
                let sounds = self.performer.note_on(note, velocity_from_midi(velocity), CHANNEL);
                assert!(sounds, "note {note} is silent");
            }
            Pedal(value) => self.performer.control_change(4, f32::from(value) / 127.0, CHANNEL),
        }
    }

    /// Left side of the close microphone, full scale 1.
    pub fn render(&mut self, seconds: f64) -> Vec<f32> {
        let samples = (seconds * RATE).round() as usize;
        let [mut left, mut right, mut close, mut other] = [(); 4].map(|()| vec![0.0; samples]);
        self.performer.render_outputs([&mut left, &mut right], &mut [[&mut close, &mut other]]);
        close
    }

    /// How the rims are.
    pub fn rims(&mut self) -> RimSnapshot {
        let mut snapshot = KitSnapshot::default();
        self.performer.snapshot(&mut snapshot);
        snapshot.pieces[SLOT.index()].rims
    }
}

impl Default for Player {
    fn default() -> Player {
        Player::new()
    }
}

/// Sum of squares, in units of full scale.
pub fn energy(sound: &[f32]) -> f64 {
    sound.iter().map(|x| f64::from(x * x)).sum()
}

/// Energy of the millisecond that begins at each sample.
fn energies(sound: &[f32]) -> Vec<f64> {
    sound.windows((0.001 * RATE).round() as usize).map(energy).collect()
}

/// Time of the greatest of some [energies](energies), ms, and how much more it is than the greatest of the first [`SOON_MS`], dB.
fn greatest(energies: &[f64]) -> (f64, f64) {
    let mut top = (0, 0.0);
    for (at, &energy) in energies.iter().enumerate() {
        if energy > top.1 {
            top = (at, energy);
        }
    }
    let soon = energies.iter().take((1e-3 * SOON_MS * RATE) as usize).fold(0.0, |most: f64, &x| most.max(x));
    (1e3 * top.0 as f64 / RATE, 10.0 * (top.1 / soon).log10())
}

/// Time at which the loudest millisecond begins, ms, and how much louder it is than the loudest of the first
/// [`SOON_MS`], dB.
pub fn loudest(sound: &[f32]) -> (f64, f64) {
    greatest(&energies(sound))
}

/// The loudest millisecond of each of some strokes, and that of their mean: ms, and dB over the first [`SOON_MS`].
pub type Strokes = (Vec<(f64, f64)>, (f64, f64));

/// Velocities on either side of one that are taken with it.
const EITHER_SIDE: usize = 4;

/// How much louder a foot's chick on closed cymbals is than a closed stroke, at each of the [velocities](VELOCITIES), dB.
pub fn chicks_db() -> [f64; 4] {
    VELOCITIES.map(|velocity| {
        let [chick, closed] = [44, 42].map(|note| energy(&after(Some(Note(42)), note, velocity).0));
        10.0 * (chick / closed).log10()
    })
}

/// Strokes of a [case](after) from 4 below a velocity to 4 above: [the loudest millisecond](loudest) of each, and of their mean, ms and dB.
///
/// Which of some milliseconds of noise is loudest is chance. The mean says where the sound is.
pub fn strokes(before: Option<Event>, note: u8, velocity: u8) -> Strokes {
    let side = EITHER_SIDE as u8;
    let all: Vec<_> = (velocity - side..=velocity + side)
        .map(|velocity| energies(&after(before, note, velocity).0))
        .collect();
    let mean: Vec<f64> = (0..all[0].len()).map(|at| all.iter().map(|one| one[at]).sum()).collect();
    (all.iter().map(|one| greatest(one)).collect(), greatest(&mean))
}

/// An eighth note at 240 a minute after what came before: the next note, for 0.3 s, and the rims 5 ms after it.
pub fn after(before: Option<Event>, note: u8, velocity: u8) -> (Vec<f32>, RimSnapshot) {
    let mut player = Player::new();
    before.into_iter().for_each(|event| player.play(event, velocity));
    player.render(0.125);
    player.play(Note(note), velocity);
    let mut sound = player.render(0.005);
    let rims = player.rims();
    sound.extend(player.render(0.295));
    (sound, rims)
}

/// The case in words.
pub fn case((before, note): (Option<Event>, u8)) -> String {
    match before {
        None => format!("{note} alone"),
        Some(Note(former)) => format!("{note} after {former}"),
        Some(Pedal(value)) => format!("{note} after CC 4 at {value}"),
    }
}

/// The page.
///
/// # Errors
/// If a plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "hi-hat-notes",
        "Notes of the hi-hat",
        PLAYED,
        "When each note of the hi-hat is loudest: the beginning of the millisecond with the most energy at the close\n\
         microphone, ms after the note, 125 ms after what came before, at four velocities, without humanizing. The first table is of single\n\
         strokes. Which of some milliseconds of noise is loudest is chance: the second table is of the mean of nine strokes, from four velocities below to four above;\n\
         the third counts single ones of these. Recorded in public sets (overheads, from 30 dB under the peak on): Salamander, 65 % of 40\n\
         closed strokes are loudest within 8 ms, half within 2.6, 67 % of 18 open and 50 to 70 % of 71 half-open ones; The Open Source Drumkit, 73 % of 37\n\
         closed, 67 % of 39 half-closed, 37 % of 38 half-open ones, half of these within 22 ms. A foot alone takes its time: of 34 recorded in both, 9 % within 8 ms,\n\
         half within 11 to 20. `tests/tests/hi_hat_notes.rs` holds these figures.",
    );
    let cases: Vec<_> = STRUCK.into_iter().chain(OPEN).chain(FOOT).collect();
    let played: Vec<_> =
        cases.iter().map(|case| VELOCITIES.map(|velocity| strokes(case.0, case.1, velocity))).collect();
    let (struck, others) = played.split_at(STRUCK.len());
    let open = &others[..OPEN.len()];
    let own =
        |of: &[[Strokes; 4]]| of.iter().flatten().map(|(each, _)| each[EITHER_SIDE]).collect::<Vec<_>>();
    let mean = |of: &[[Strokes; 4]]| of.iter().flatten().map(|(_, mean)| *mean).collect();
    let every = |of: &[[Strokes; 4]]| of.iter().flatten().flat_map(|(each, _)| each).copied().collect();
    let groups = [
        ("notes that close the cymbals, or open closed ones, at the four velocities", own(struck)),
        ("means of nine of these", mean(struck)),
        ("single ones of these", every(struck)),
        ("means of nine strokes on open cymbals", mean(open)),
    ];
    for (what, figures) in groups {
        let soon = figures.iter().filter(|(ms, _)| *ms < SOON_MS).count();
        let over = figures.iter().fold(0.0, |most: f64, (_, over)| most.max(*over));
        let late = match soon == figures.len() {
            true => String::new(),
            false => format!("; the others by up to {over:.1} dB over the first {SOON_MS}"),
        };
        sheet.claim(Claim {
            what: format!("{what} that are loudest within {SOON_MS} ms"),
            on: PLAYED,
            figure: format!("{soon} of {}{late}", figures.len()),
            reference: "all".to_owned(),
            source: GOAL,
            met: Some(soon == figures.len()),
        });
    }
    let beside = chicks_db();
    sheet.claim(Claim {
        what: "chicks over closed strokes of the same velocity, energy of 0.3 s, dB".to_owned(),
        on: PLAYED,
        figure: beside.map(|db| format!("{db:.1}")).join(", "),
        reference: "softest -1 to 5, median -3 to -4, loudest -3 to -7".to_owned(),
        source: "GMRockKit, The Open Source Drumkit",
        met: None,
    });
    let head = &["note", "velocity 30", "60", "90", "120"];
    let is_struck = |index: usize| index < STRUCK.len() + OPEN.len();
    let told = |index: usize, (ms, over): (f64, f64)| match ms >= SOON_MS && is_struck(index) {
        true => format!("{ms:.1} (+{over:.1} dB)"),
        false => format!("{ms:.1}"),
    };
    let rows = |what: &str, cell: &dyn Fn(usize, &Strokes) -> String| {
        let row = |(index, played): (usize, &[Strokes; 4])| {
            let mut row = vec![format!("{}{what}", case(cases[index]))];
            row.extend(played.iter().map(|played| cell(index, played)));
            row
        };
        played.iter().enumerate().map(row).collect::<Vec<_>>()
    };
    sheet.table(head, rows("", &|index, (each, _)| told(index, each[EITHER_SIDE])));
    sheet.table(head, rows(", mean of nine", &|index, (_, mean)| told(index, *mean)));
    sheet.table(
        head,
        rows(&format!(", of nine within {SOON_MS} ms"), &|_, (each, _)| {
            each.iter().filter(|(ms, _)| *ms < SOON_MS).count().to_string()
        }),
    );
    let sounds: Vec<_> = cases.iter().map(|&case| (case, after(case.0, case.1, VELOCITIES[2]).0)).collect();
    let panel = |index: usize| {
        let (of, sound) = &sounds[index];
        let most = sound.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        (case(*of), vec![(String::new(), envelope(&sound[..(0.04 * RATE) as usize], most))])
    };
    for (name, title, cases) in [
        ("closed", "The first 40 ms of closed notes at velocity 90", [1, 2, 3, 5]),
        ("opened", "The first 40 ms of open notes and of the foot at velocity 90", [6, 9, 12, 15]),
    ] {
        let plot = Plot {
            across: Axis::linear("ms after the note", 0.0..40.0),
            up: Axis::linear("pressure over its greatest", -1.05..1.05),
            panels: cases.into_iter().map(panel).collect(),
        };
        sheet.plot(name, title, &plot)?;
    }
    Ok(sheet.finish())
}

/// An upright line from the lowest to the highest value of every stretch of a sound, over the greatest of all, by ms. A line through all samples
/// of noise would be grey, and its corners would stick out of the picture.
fn envelope(sound: &[f32], greatest: f32) -> Vec<(f64, f64)> {
    /// Stretches of a picture.
    const STRETCHES: usize = 250;
    let length = sound.len().div_ceil(STRETCHES);
    let stretches = sound.chunks(length).enumerate();
    let uprights = stretches.flat_map(|(index, stretch)| {
        let at = 1e3 * (index * length) as f64 / RATE;
        let (low, high) =
            stretch.iter().fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        let [foot, top] = [low, high].map(|x| (at, f64::from(x / greatest)));
        [foot, top, (f64::NAN, f64::NAN)]
    });
    uprights.collect()
}
