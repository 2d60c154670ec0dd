//! The kit compared with recordings: how its pieces change with the stroke. The report claims the shares of figures.

use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear_measure::realism::reference::SLOPE_WITHIN;
use overhear_measure::realism::{self, PieceReport, RecordingChain, SPEEDS};
use overhear_tests::Chance;

/// Drums of which recordings are known.
const DRUMS: [&str; 4] = ["kick", "snare", "rack-tom", "floor-tom"];

/// Pieces struck softly to hard, bounced, through each recording chain.
fn bounced(names: &[&str]) -> Vec<PieceReport> {
    let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    let subjects = realism::subjects(&names).unwrap();
    let (speeds, settings) = (SPEEDS.to_vec(), Vec::new());
    let kit = KitDocument::standard();
    let request = realism::Request { subjects, speeds, kit, settings, pace: Pace::Offline };
    realism::run(&request).unwrap().pieces
}

#[test]
fn drums_brighten_with_the_stroke_as_recorded_ones_do() {
    // One of them, drawn anew in every run.
    let drawn = Chance::new(Chance::seeds(&[])[0]).below(DRUMS.len());
    let pieces = bounced(&[DRUMS[drawn]]);
    assert_eq!(pieces.len(), RecordingChain::ALL.len());
    for piece in &pieces {
        let slope = piece.slope.as_ref().expect("known of every drum");
        println!("{} {}: {:?} octaves per 20 dB", piece.piece, piece.heard.name(), slope.value);
        let held = slope.value.is_some_and(|value| (value - slope.median).abs() <= SLOPE_WITHIN);
        assert!(held, "{} {}: {:?} for {}", piece.piece, piece.heard.name(), slope.value, slope.median);
    }
}

#[test]
fn a_crash_blooms_later_and_brighter_the_harder_it_is_struck() {
    for crash in bounced(&["crash"]) {
        let bloom = crash.bloom().expect("every stroke has a band above 3 kHz");
        println!("{}: {bloom:?} ms", crash.heard.name());
        // A medium stroke's early and late peaks are as high, and the stick is heard in the first: docs/limits.md.
        let rises = bloom[0] < bloom[bloom.len() - 1] && bloom[1] < bloom[bloom.len() - 1];
        assert!(rises, "{}: {bloom:?} ms", crash.heard.name());
        // Recorded ones gain 1.5 octaves: hammering brightens soft strokes as well, and the gap is not closed (docs/limits.md).
        let slope = crash.slope.as_ref().and_then(|slope| slope.value);
        println!("{}: {slope:?} octaves per 20 dB", crash.heard.name());
        assert!(slope.is_some_and(|slope| (0.4..2.1).contains(&slope)), "{slope:?} octaves per 20 dB");
    }
}
