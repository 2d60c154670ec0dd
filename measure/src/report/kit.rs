//! The kit: delays, sympathetic resonance, determinism of the output, and sleep.

use crate::{Chance, kit, kit_of, slot, standard, stroke};
use anyhow::{Context, Result};
use overhear::kit_document::KitDocument;
use overhear_engine::air_load::SPEED_OF_SOUND;
use overhear_engine::kit::{BLOCK, Control, Kit};
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{KitSnapshot, PieceSnapshot};
use overhear_engine::strike::{Strike, Striker};

use super::page::bodies::{FIXED_DISC, PLAYED};
use super::page::sources::{EARLIER, EXACT, GOAL};
use super::page::{Claim, Page, Sheet};
use super::plot::{Axis, Curve, Plot};
use crate::hear;
use crate::reference::fixed_disc_kit;

const RATE: f64 = 44_100.0;

/// 100 dB under full scale: below that nothing is heard.
const AUDIBLE: f32 = 1e-5;

/// The page.
///
/// # Errors
/// If the plot cannot be drawn.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "kit",
        "The kit",
        PLAYED,
        "All pieces of the standard kit at their positions, 44.1 kHz. `tests/tests/sympathy.rs`, `tests/tests/equivalence.rs`,\n\
         `tests/tests/workers.rs`, `tests/tests/kit.rs` and `tests/tests/sleep.rs` hold these figures.",
    );
    let mut kit = kit(RATE);
    wires(&mut sheet, &mut kit);
    buffers(&mut sheet, &mut kit);
    sleep(&mut sheet, &mut kit);
    storm(&mut sheet, &mut kit);
    delays(&mut sheet)?;
    sympathy(&mut sheet, &mut kit);
    Ok(sheet.finish())
}

fn run(kit: &mut Kit, samples: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
    kit.render(&mut left, &mut right);
    left.extend(right);
    left
}

/// Landings of the snare's wires in the second after a hit on the rack tom of the standard kit: its speed, m/s, and how
/// far from the middle, share of the radius.
pub fn landings(kit: &mut Kit, speed: f64, radius: f64) -> u32 {
    let count = |kit: &Kit| kit.piece(slot("snare")).map_or(0, |snare| snare.wires().landings);
    let before = count(kit);
    kit.strike(slot("rack-tom"), &stroke(Striker::Stick, speed, radius, 0.0));
    run(kit, RATE as usize);
    let landings = count(kit) - before;
    kit.reset();
    landings
}

fn wires(sheet: &mut Sheet, kit: &mut Kit) {
    let mut reference = kit_of(&fixed_disc_kit(), RATE);
    let counts = [2.0, 4.0, 6.0].map(|speed| landings(&mut reference, speed, 0.2));
    let near = counts.iter().zip([12.0, 152.0, 324.0]);
    let near = near.map(|(&count, want)| (want / 10.0..want * 10.0).contains(&f64::from(count)));
    sheet.claim(Claim {
        what: "rack tom at 2, 4, 6 m/s: landings of the snare's wires in 1 s".to_owned(),
        on: FIXED_DISC,
        figure: format!("{}, {}, {}", counts[0], counts[1], counts[2]),
        reference: "12, 152, 324: order of magnitude, rising".to_owned(),
        source: EARLIER,
        met: Some(near.into_iter().all(|near| near) && counts[0] < counts[1] && counts[1] < counts[2]),
    });
    let played = [2.0, 4.0, 6.0].map(|speed| landings(kit, speed, 0.2));
    sheet.claim(Claim {
        what: "the same on the standard kit, whose wires are looser and whose tom is lower".to_owned(),
        on: PLAYED,
        figure: format!("{}, {}, {}", played[0], played[1], played[2]),
        reference: "rising".to_owned(),
        source: GOAL,
        met: Some(0 < played[0] && played.is_sorted_by(|a, b| a < b)),
    });
    for (what, control) in [
        ("pieces uncoupled", Control::SympatheticCoupling),
        ("wires thrown off", Control::Wires(slot("snare"))),
    ] {
        kit.set(control, 0.0);
        kit.finish_controls();
        let count = landings(kit, 6.0, 0.2);
        kit.set(control, 1.0);
        kit.finish_controls();
        sheet.claim(Claim {
            what: format!("the same at 6 m/s, {what}"),
            on: PLAYED,
            figure: format!("{count}"),
            reference: "none".to_owned(),
            source: EARLIER,
            met: Some(count == 0),
        });
    }
}

/// The stroke of a piece's ordinary note.
fn ordinary(slot: Slot) -> Strike {
    hear::default_strike(&KitDocument::standard(), slot)
}

/// Five pieces hit, in buffers of a size: the sound.
fn play(kit: &mut Kit, buffer: usize) -> Vec<f32> {
    kit.reset();
    for slot in ["kick", "snare", "crash", "ride", "hi-hat"].map(slot) {
        kit.strike(slot, &ordinary(slot));
    }
    let length = RATE as usize / 2;
    let mut sound = [Vec::new(), Vec::new()];
    while sound[0].len() < length {
        let frames = buffer.min(length - sound[0].len());
        let both = run(kit, frames);
        sound[0].extend_from_slice(&both[..frames]);
        sound[1].extend_from_slice(&both[frames..]);
    }
    sound.concat()
}

fn buffers(sheet: &mut Sheet, kit: &mut Kit) {
    let whole = play(kit, 8192);
    let sizes = [1, 17, 64, 512];
    let same = sizes.map(|size| play(kit, size) == whole);
    sheet.claim(Claim {
        what: "five pieces hit, buffers of 1, 17, 64, 512 and 8192 samples".to_owned(),
        on: PLAYED,
        figure: if same == [true; 4] { "the same bits".to_owned() } else { format!("the same: {same:?}") },
        reference: "the same bits".to_owned(),
        source: EXACT,
        met: Some(same == [true; 4]),
    });
}

/// Seconds from the last audible sound to sleep after a stroke and a hand on the piece.
fn falls_asleep(kit: &mut Kit, slot: Slot) -> f64 {
    kit.reset();
    kit.strike(slot, &stroke(Striker::Stick, 5.0, 0.5, 0.2));
    run(kit, 4_410);
    // Cymbals ring for a minute: a hand stops them.
    kit.choke(slot, 1.0);
    let (mut last, mut now) = (0, 0);
    while !kit.is_asleep() && now < 40 * RATE as usize {
        let sound = run(kit, BLOCK);
        now += BLOCK;
        if sound.iter().any(|x| x.abs() > AUDIBLE) {
            last = now;
        }
    }
    kit.choke(slot, 0.0);
    (now - last) as f64 / RATE
}

fn sleep(sheet: &mut Sheet, kit: &mut Kit) {
    let longest = standard().slots().map(|(slot, _)| falls_asleep(kit, slot)).fold(0.0, f64::max);
    sheet.claim(Claim {
        what: "every piece in turn: time from the last sound above -100 dBFS to sleep".to_owned(),
        on: PLAYED,
        figure: format!("{longest:.2} s at most"),
        reference: "1 s".to_owned(),
        source: GOAL,
        met: Some(longest < 1.0),
    });
}

/// Strokes on every piece, a thousand in two seconds.
fn storm(sheet: &mut Sheet, kit: &mut Kit) {
    kit.reset();
    let seen = |kit: &mut Kit| {
        let mut seen = KitSnapshot::default();
        kit.snapshot(&mut seen);
        let of = |what: fn(&PieceSnapshot) -> u32| seen.pieces.iter().map(what).sum::<u32>();
        (of(|piece| piece.strike.count), of(|piece| piece.quarantines), seen.dropped_strikes)
    };
    // Counted from construction on.
    let before = seen(kit).0;
    let slots: Vec<Slot> = standard().slots().map(|(slot, _)| slot).collect();
    let mut chance = Chance::new(5);
    let (mut peak, mut finite) = (0.0_f32, true);
    for i in 0..1000 {
        let strike = Strike { speed: chance.between(0.1, 8.0), ..chance.stroke(8.0) };
        kit.strike(slots[i % slots.len()], &strike);
        for x in run(kit, 2 * RATE as usize / 1000) {
            finite &= x.is_finite();
            peak = peak.max(x.abs());
        }
    }
    let (struck, quarantines, dropped) = seen(kit);
    let struck = struck - before;
    sheet.claim(Claim {
        what: "1,000 strokes in 2 s (the test: 5,000 in 10)".to_owned(),
        on: PLAYED,
        figure: format!("{struck} played, peak {peak:.1} of full scale, {quarantines} pieces put to rest"),
        reference: "all played, finite, below 30".to_owned(),
        source: GOAL,
        met: Some(finite && struck == 1000 && quarantines == 0 && peak < 30.0 && dropped == 0),
    });
    kit.reset();
}

fn delays(sheet: &mut Sheet) -> Result<()> {
    let (spec, layout) = (standard(), standard().layout());
    let way = |from: Slot, to: Slot| layout.path_length(from, to).filter(|_| from != to);
    let drums: Vec<Slot> = spec.drums().map(|(slot, _)| slot).collect();
    let pairs = drums.iter().flat_map(|&from| drums.iter().map(move |&to| (from, to)));
    let ways = pairs.filter_map(|(from, to)| Some((way(from, to)?, [from, to])));
    let (shortest, ends) = ways.min_by(|a, b| a.0.total_cmp(&b.0)).context("the kit has not two drums")?;
    let [from, to] = ends.map(|slot| name(&spec, slot));
    // Interpolation needs one newer sample.
    let samples = (shortest / SPEED_OF_SOUND * RATE).floor() as usize - 1;
    sheet.claim(Claim {
        what: "shortest delay between drums".to_owned(),
        on: PLAYED,
        figure: format!("{samples} samples, {from} and {to}"),
        reference: "54, rack tom and snare".to_owned(),
        source: EXACT,
        met: Some(samples == 54),
    });
    sheet.heading("Delays");
    sheet.text("Delay from each piece (row) to each drum (column), ms.");
    let mut head = vec![""];
    head.extend(drums.iter().map(|&to| name(&spec, to)));
    let delay = |way: f64| format!("{:.2}", 1e3 * way / SPEED_OF_SOUND);
    let rows = spec.slots().map(|(from, piece)| {
        let cells = drums.iter().map(|&to| way(from, to).map_or_else(String::new, delay));
        std::iter::once(piece.name.clone()).chain(cells).collect()
    });
    sheet.table(&head, rows);
    sheet.plot(
        "map",
        "The kit from above, the drummer below: ways of sound from each piece to the drums that hear it",
        &Plot {
            across: Axis::linear("m to the drummer's right", -1.0..1.7),
            up: Axis::linear("m toward the audience", -1.0..0.3),
            panels: vec![ways_from(&spec, "from drums", true), ways_from(&spec, "from cymbals", false)],
        },
    )
}

/// Name of the piece of a slot.
fn name(spec: &KitSpec, slot: Slot) -> &str {
    spec.piece(slot).map_or("", |piece| &piece.name)
}

/// Ways of sound, seen from above, from every drum or every cymbal to each drum that hears it.
fn ways_from(spec: &KitSpec, title: &str, from_drums: bool) -> (String, Vec<Curve>) {
    let plan = |piece: &PieceSpec| {
        let [x, _, z] = piece.place.centre;
        (x, z)
    };
    let drums = || spec.pieces.iter().filter(|piece| piece.drum().is_some());
    let line = |from: &PieceSpec| -> Curve {
        let others = drums().filter(|to| to.name != from.name);
        (from.name.clone(), others.flat_map(|to| [plan(from), plan(to), PEN_UP]).collect())
    };
    let shown = spec.pieces.iter().filter(|piece| piece.drum().is_some() == from_drums);
    (title.to_owned(), shown.map(line).collect())
}

/// Between one way and the next.
const PEN_UP: (f64, f64) = (f64::NAN, f64::NAN);

fn sympathy(sheet: &mut Sheet, kit: &mut Kit) {
    sheet.heading("Sympathetic resonance");
    sheet.text(
        "Each piece is struck as by its ordinary note, at 5 m/s. The table shows the greatest energy of each drum in the next second, in dB\n\
         relative to the stroke.",
    );
    let spec = standard();
    let drums: Vec<Slot> = spec.drums().map(|(slot, _)| slot).collect();
    let mut head = vec!["struck"];
    head.extend(drums.iter().map(|&slot| name(&spec, slot)));
    let mut largest = f64::NEG_INFINITY;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for (struck, piece) in spec.slots() {
        let heard = heard_by(kit, struck, &drums);
        let others = drums.iter().zip(&heard).filter(|(slot, _)| **slot != struck);
        largest = others.map(|(_, db)| *db).fold(largest, f64::max);
        let cell = |(slot, db): (&Slot, &f64)| {
            if *slot == struck { String::new() } else { format!("{db:.0}") }
        };
        let cells = drums.iter().zip(&heard).map(cell);
        rows.push(std::iter::once(piece.name.clone()).chain(cells).collect());
    }
    sheet.table(&head, rows);
    sheet.claim(Claim {
        what: "largest energy of a drum after a stroke on another piece".to_owned(),
        on: PLAYED,
        figure: format!("{largest:.0} dB"),
        reference: "less than -10 dB: energy is only lost on the way".to_owned(),
        source: GOAL,
        met: Some(largest < -10.0),
    });
}

/// Greatest energy of each drum in the second after a stroke, dB of the stroke's.
fn heard_by(kit: &mut Kit, struck: Slot, drums: &[Slot]) -> Vec<f64> {
    kit.reset();
    kit.strike(struck, &Strike { speed: 5.0, ..ordinary(struck) });
    let brought = kit.piece(struck).map_or(f64::NAN, Piece::brought_energy);
    let mut most = vec![0.0_f64; drums.len()];
    for _ in 0..RATE as usize / 441 {
        run(kit, 441);
        for (most, &slot) in most.iter_mut().zip(drums) {
            *most = most.max(kit.piece(slot).map_or(0.0, Piece::energy));
        }
    }
    most.into_iter().map(|energy| 10.0 * (energy / brought).max(1e-30).log10()).collect()
}
