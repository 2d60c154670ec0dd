//! Random kits from the accepted ranges: each can be built, plays, gains no energy, falls asleep, and is read back to the bit
//! from what a project stores.
//!
//! The kits are of a fixed seed, as one in some hundreds of others may still have a fault (docs/limits.md). `OVERHEAR_SWEEP` says how many kits
//! of a fresh seed, which is printed, are drawn instead, `OVERHEAR_SEED` repeats a run, `OVERHEAR_KIT` plays one alone:
//! `OVERHEAR_SWEEP=1000 cargo test -p overhear-tests --test random_kits`.

use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear_engine::kit::{BLOCK, Kit};
use overhear_engine::kit_spec::Kind;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::strike::Strike;
use overhear_tests::random::{self, RATE};
use overhear_tests::{Chance, total_energy};

/// Kits of a run that asks for no number.
const KITS: usize = 6;

/// Their seed.
const SEED: u64 = 21;

/// How long a kit is played, s.
const PLAYED: f64 = 0.3;

/// Time in which a kit has to fall asleep after hands have been laid on all of it, s: no hand holds the hoop of a drum, and the lowest
/// modes of one with a quality of a thousand take minutes to fall by 160 dB.
const ASLEEP_WITHIN: f64 = 900.0;

/// Builds what a document describes; what is wrong, if it cannot be.
fn built(document: &KitDocument) -> Result<Kit, String> {
    let mut kit = Kit::new(RATE, &document.kit);
    for (slot, piece) in document.kit.slots() {
        let build = document.kit.build(slot).ok_or("an empty slot")?;
        let built = Piece::new(slot, &build, &BuildOptions::new(RATE))
            .map_err(|refused| format!("{} was accepted, then refused: {refused}", piece.name))?;
        drop(kit.install(Box::new(built)));
    }
    kit.finish_controls();
    Ok(kit)
}

/// Energy that a kit's pieces and strikers have over what strikers brought, J, and what they brought.
fn balance(kit: &Kit) -> [f64; 2] {
    let pieces = Slot::ALL.into_iter().filter_map(|slot| kit.piece(slot));
    pieces.fold([0.0; 2], |[there, brought], piece| {
        [there + total_energy(piece), brought + piece.brought_energy()]
    })
}

/// Renders so long and hands over every block's loudest sample.
fn render(kit: &mut Kit, seconds: f64) -> Result<f32, String> {
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let mut loudest = 0.0_f32;
    for _ in 0..(seconds * RATE / BLOCK as f64).ceil() as usize {
        kit.render(&mut left, &mut right);
        for &x in left.iter().chain(&right) {
            if !x.is_finite() {
                return Err(format!("a sample is {x}"));
            }
            loudest = loudest.max(x.abs());
        }
    }
    Ok(loudest)
}

/// Strokes on every piece, as fast as a hard blow at most.
fn strokes(document: &KitDocument, chance: &mut Chance) -> Vec<(Slot, Strike)> {
    let drawn = document.kit.slots().map(|(slot, piece)| {
        // Faster ones throw a plate of unheard-of shape back with more than they brought: docs/limits.md.
        let fastest = if piece.instrument.kind() == Kind::Drum { 12.0 } else { 6.0 };
        (slot, Strike { speed: chance.between(0.3, fastest), ..chance.stroke(fastest) })
    });
    drawn.collect()
}

/// Plays a kit; how long it takes to fall asleep, s.
fn play(document: &KitDocument, chance: &mut Chance) -> Result<f64, String> {
    let mut kit = built(document)?;
    let [at_rest, _] = balance(&kit);
    let mut loudest = 0.0_f32;
    for (slot, strike) in strokes(document, chance) {
        kit.strike(slot, &strike);
        loudest = loudest.max(render(&mut kit, PLAYED / document.kit.pieces.len() as f64)?);
        let [there, brought] = balance(&kit);
        if there - at_rest > brought * (1.0 + 1e-4) + 1e-9 {
            let each = document.kit.slots().filter_map(|(slot, piece)| {
                let kept = kit.piece(slot)?;
                Some(format!("{} {:.3e} of {:.3e}", piece.name, total_energy(kept), kept.brought_energy()))
            });
            let each = each.collect::<Vec<_>>().join(", ");
            return Err(format!(
                "gains energy: {there} J of {brought} J after {strike:?} in {slot:?}: {each}"
            ));
        }
    }
    if loudest == 0.0 {
        return Err("it is silent".to_owned());
    }
    for slot in Slot::ALL.into_iter().take(document.kit.pieces.len()) {
        kit.choke(slot, 1.0);
        let broken = kit.piece(slot).map_or(0, Piece::quarantines);
        if broken > 0 {
            return Err(format!("{slot:?} had to be reset {broken} times"));
        }
    }
    let mut waited = 0.0;
    while !kit.is_asleep() {
        render(&mut kit, 0.05)?;
        waited += 0.05;
        if waited > ASLEEP_WITHIN {
            let awake =
                Slot::ALL.into_iter().filter(|&slot| kit.piece(slot).is_some_and(|it| !it.is_asleep()));
            return Err(format!("{:?} are awake after {waited:.0} s", awake.collect::<Vec<_>>()));
        }
    }
    Ok(waited)
}

/// Whether a kit is read back as it was written, and is written again in the same words.
fn reopen(document: &KitDocument) -> Result<usize, String> {
    let text = kit_file::write(document);
    let read = kit_file::read("the kit", &text).map_err(|error| error.to_string())?;
    // Numbers that print alike could differ; texts of equal documents that differ could not be compared.
    if read != *document || kit_file::write(&read) != text {
        return Err("it is read back as another kit".to_owned());
    }
    Ok(text.len())
}

/// The number of an environment variable.
fn asked(variable: &str) -> Option<usize> {
    let number = std::env::var(variable).ok();
    number.map(|text| text.parse().unwrap_or_else(|_| panic!("{variable} is a number")))
}

/// What is wrong with a kit, or how long its text is and how long it takes to fall asleep, s.
fn fault(document: &KitDocument, chance: &mut Chance) -> Result<(usize, f64), String> {
    let length = reopen(document)?;
    let played = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| play(document, chance)));
    Ok((length, played.unwrap_or_else(|_| Err("it panicked".to_owned()))?))
}

#[test]
fn random_kits_can_be_built_played_and_stored() {
    let sweep = asked("OVERHEAR_SWEEP");
    let seeds = if sweep.is_some() { Chance::seeds(&[]) } else { Chance::chosen(&[SEED]) };
    let seed = *seeds.last().expect("a seed");
    let kits = asked("OVERHEAR_KIT").map_or(0..sweep.unwrap_or(KITS), |kit| kit..kit + 1);
    let (mut pieces, mut largest, mut latest, mut faults) = (0, 0, (0, 0.0), Vec::new());
    for number in kits.clone() {
        // A sequence of its own for every kit, so that one can be repeated without those before it.
        let mut chance = Chance::new(seed.wrapping_mul(1_000_003).wrapping_add(number as u64));
        // Most are small; every size comes.
        let count = 1 + (SLOTS as f64 * chance.unit().powi(3)) as usize;
        let document = random::kits::kit(&mut chance, count.min(SLOTS));
        pieces += document.kit.pieces.len();
        match fault(&document, &mut chance) {
            Ok((length, slept)) => {
                largest = largest.max(length);
                if slept > latest.1 {
                    latest = (number, slept);
                }
            }
            Err(fault) => {
                println!("OVERHEAR_SEED={seed} OVERHEAR_KIT={number}: {fault}");
                if kits.len() == 1 {
                    println!("{document:#?}");
                }
                faults.push(number);
            }
        }
        if number % 100 == 99 {
            println!("{} kits, {} faults", number + 1, faults.len());
        }
    }
    println!("{} kits of {pieces} pieces, texts of up to {largest} bytes", kits.len());
    println!("kit {} was the last to fall asleep, after {:.0} s", latest.0, latest.1);
    assert!(faults.is_empty(), "OVERHEAR_SEED={seed}, kits {faults:?}");
}
