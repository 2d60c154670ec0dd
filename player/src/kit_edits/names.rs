//! Names and titles that no other piece of a kit has.

use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::{SLOTS, Slot};

/// Longest name and title, characters.
const LONGEST: usize = 24;

/// Gives a piece a name and a title that no other piece has; that of a slot, whose place it takes, does not count.
pub(super) fn make_distinct(piece: &mut PieceSpec, kit: &KitSpec, instead: Option<Slot>) {
    let others = || kit.slots().filter(|(slot, _)| Some(*slot) != instead).map(|(_, other)| other);
    let name = distinct(&piece.name, "-", |name| others().any(|other| other.name == name));
    let title = distinct(&piece.title, " ", |title| others().any(|other| other.title == title));
    (piece.name, piece.title) = (name, title);
}

fn distinct(wanted: &str, between: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(wanted) {
        return wanted.to_owned();
    }
    // `crash-2` is followed by `crash-3`.
    let stem = wanted.rsplit_once(between).filter(|(_, end)| end.len() == 1 && end.parse::<u8>().is_ok());
    let stem = stem.map_or(wanted, |(stem, _)| stem);
    let numbered = |number: usize| {
        let end = format!("{between}{number}");
        let stem: String = stem.chars().take(LONGEST - end.len()).collect();
        format!("{}{end}", stem.trim_end_matches(between))
    };
    (2..=SLOTS + 1).map(numbered).find(|name| !taken(name)).unwrap_or_else(|| wanted.to_owned())
}
