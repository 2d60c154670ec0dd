//! The groove on whole kits of the library, as it is played live: none is clipped, and all are about as loud. `cargo xtask demo
//! --all-kits` plays all twelve, bounced.

use anyhow::{Context, Result};
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::library::{self, WholeKit};
use overhear_cli::player::{Blocks, EnginePlayer, Setup};
use overhear_cli::render::{Style, takes};
use overhear_cli::song::Song;
use overhear_cli::wav::Bits;
use overhear_measure::analysis::loudness_lufs;
use overhear_tests::Chance;
use rayon::prelude::*;

const RATE: u32 = 48_000;

/// Farthest that two kits may be apart in loudness, LU.
const APART: f64 = 2.0;

/// Loudness, LUFS, and peak of the groove on a kit.
fn played(song: &Song, kit: KitDocument) -> Result<(f64, f32)> {
    let style = Style {
        source: overhear_cli::player::Source::Engine,
        rate: RATE,
        kit,
        settings: Vec::new(),
        blocks: Blocks::Fixed(256),
        bits: Bits::Float32,
        tail: 4.0,
        channel: None,
    };
    let take = takes(song, &style)?.take;
    let setup: Setup = style.setup();
    let mut player = EnginePlayer::at_pace(&setup, Pace::RealTime)?;
    let (mut left, mut right) = (Vec::new(), Vec::new());
    take.play(&mut player, style.blocks, |l, r| {
        left.extend_from_slice(l);
        right.extend_from_slice(r);
        Ok(())
    })?;
    let peak = left.iter().chain(&right).fold(0.0_f32, |peak, x| peak.max(x.abs()));
    Ok((loudness_lufs([&left, &right], RATE).context("it is silent")?, peak))
}

/// The loudest kit and the quietest, as last measured, and one of the others. Each takes minutes.
fn sampled() -> Vec<WholeKit> {
    let mut others: Vec<WholeKit> = library::kits().collect();
    assert_eq!(others.len(), 12);
    let mut kits = Vec::new();
    let rank: [fn([f64; 2]) -> f64; 2] = [|[loudness, _]| loudness, |[loudness, _]| -loudness];
    for of in rank {
        let measured = |kit: &WholeKit| of(kit.measured().expect("its figures"));
        let most = (0..others.len()).max_by(|&a, &b| measured(&others[a]).total_cmp(&measured(&others[b])));
        kits.push(others.swap_remove(most.expect("a kit")));
    }
    let drawn = Chance::new(Chance::seeds(&[])[0]).below(others.len());
    kits.push(others.swap_remove(drawn));
    kits
}

#[test]
fn kits_of_the_library_are_not_clipped_and_as_loud_within_2_lu() {
    let groove = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/groove.mid");
    let song = Song::read(&groove).expect("the groove");
    let kits = sampled();
    let found: Vec<(&str, f64, f32)> = kits
        .par_iter()
        .map(|kit| {
            let document = kit.document().expect("a kit of the library");
            let (loudness, peak) = played(&song, document).expect("it plays");
            println!("{}: {loudness:.1} LUFS, peak {:.1} dBFS", kit.name, 20.0 * peak.log10());
            (kit.name, loudness, peak)
        })
        .collect();
    for (name, _, peak) in &found {
        assert!(*peak > 0.1 && *peak <= 1.0, "{name}: a peak of {peak}");
    }
    let extreme = |of: fn(f64, f64) -> f64| found.iter().map(|kit| kit.1).reduce(of).expect("a kit");
    let apart = extreme(f64::max) - extreme(f64::min);
    println!("{apart:.1} LU apart");
    assert!(apart <= APART, "{apart:.1} LU apart");
}
