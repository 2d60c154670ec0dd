//! Complete files.

use overhear_engine::kit_spec::PieceSpec;
use proptest::prelude::*;
use serde_json::json;

use super::super::{pieces, read, write};
use super::{accepted, draw};
use crate::kit_document::KitDocument;

/// The bits of every number too: `==` takes 0 and -0 for the same.
fn same(a: &KitDocument, b: &KitDocument) -> bool {
    a == b && format!("{a:?}") == format!("{b:?}")
}

#[test]
fn the_standard_kit_is_read_as_it_was_written() {
    let standard = KitDocument::standard();
    let text = write(&standard);
    assert!(same(&accepted(&text), &standard));
    assert_eq!(write(&accepted(&text)), text);
}

#[test]
fn a_complete_file_is_one_for_people() {
    let text = write(&KitDocument::standard());
    for line in [
        "starts_from = \"nothing\"",
        "[pieces.kick]",
        "kind = \"drum\"",
        "title = \"Rack tom\"",
        "slot = 9",
        "thickness_mm = 0.36",
        "  { note = 36, name = \"Bass Drum 1\", at = 0.2, angle_rad = 0, stick = \"felt-beater\", ordinary = true },",
        "  { note = 44, name = \"Pedal Hi-Hat\", foot = \"chick\" },",
        "39 = \"Hand Clap\"",
    ] {
        assert!(text.lines().any(|own| own == line), "{line}\n{text}");
    }
    assert!(text.contains("diameter_in = 22") && text.contains("mass_g = 20"), "{text}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_document_is_read_as_it_was_written(seed: u64) {
        let document = draw::document(seed);
        let text = write(&document);
        match read("my.toml", &text) {
            Ok(back) => prop_assert!(same(&back, &document), "{text}"),
            Err(error) => prop_assert!(false, "{error}\n{text}"),
        }
    }
}

#[test]
fn drawn_pieces_stand_in_no_other() {
    // A kettle that reaches farther than the 4 m between pieces.
    draw::document(15978775328931834477);
}

#[test]
fn a_negative_nought_stays_negative() {
    let mut document = KitDocument::standard();
    document.kit.pieces[0].defaults.pan = -0.0;
    let back = accepted(&write(&document));
    assert!(back.kit.pieces[0].defaults.pan.is_sign_negative());
}

/// A field that a piece gains must not be taken for one of its instrument's.
#[test]
fn what_every_piece_has_is_what_is_read_apart() {
    let mut piece: PieceSpec = KitDocument::standard().kit.pieces.remove(1);
    piece.ideal.lossless = true;
    let keys: Vec<String> = json!(piece).as_object().unwrap().keys().cloned().collect();
    let own = keys.iter().filter(|key| !["name", "instrument"].contains(&key.as_str()));
    assert!(
        own.clone().all(|key| pieces::COMMON.contains(&key.as_str())) && own.count() == pieces::COMMON.len()
    );
}
