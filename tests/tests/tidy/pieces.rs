//! Only the files of the standard kit name its pieces; other code finds them by slot and kind.

use super::{none, sources};
use overhear_engine::kit_spec::KitSpec;

/// Where the standard kit is described, and what is played on it.
const DEFINITIONS: [&str; 4] = [
    "engine/src/kit_spec/standard.rs",
    "engine/src/fitted.rs",
    "player/src/midi_map/standard.rs",
    "player/src/state/former.rs",
];

/// Words of kit files that a piece of the standard kit happens to be named by as well.
const OTHER_MEANINGS: [(&str, &str, &str); 2] = [
    ("player/src/kit_file/pieces.rs", "hi-hat", "a kind"),
    ("player/src/kit_file/notes/entry.rs", "splash", "what a foot does"),
];

/// A source without its tests and without comments.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let end = text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len());
    text[..end].lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"))
}

/// Whether a source is compiled for tests only.
fn is_of_tests(path: &str) -> bool {
    path.ends_with("tests.rs") || path.contains("/tests/") || path == "engine/src/reference.rs"
}

/// Places of a source's code, by line, where one of the words stands as a text of its own.
fn named<'a>(text: &str, words: &'a [String]) -> Vec<(usize, &'a str)> {
    let literal = |line: &str, word: &str| line.contains(&format!("\"{word}\""));
    let lines = code(text).flat_map(|(number, line)| {
        words.iter().filter(move |word| literal(line, word)).map(move |word| (number + 1, word.as_str()))
    });
    lines.collect()
}

/// Names of the standard kit's pieces.
fn names() -> Vec<String> {
    KitSpec::standard().pieces.into_iter().map(|piece| piece.name).collect()
}

#[test]
fn no_code_below_the_standard_kit_names_one_of_its_pieces() {
    let (names, mut wrong, mut seen) = (names(), Vec::new(), 0);
    for (path, text) in sources() {
        let of_instrument =
            ["engine/src/", "player/src/", "plugin/src/"].iter().any(|folder| path.starts_with(folder));
        if !of_instrument || is_of_tests(&path) || DEFINITIONS.contains(&&*path) {
            continue;
        }
        seen += 1;
        for (line, name) in named(&text, &names) {
            if !OTHER_MEANINGS.iter().any(|(file, word, _)| *file == path && *word == name) {
                wrong.push(format!("{path}:{line} names `{name}`"));
            }
        }
    }
    assert!(seen > 100, "{seen} sources");
    none(wrong);
}

#[test]
fn what_has_another_meaning_is_still_there() {
    for (file, word, _) in OTHER_MEANINGS {
        let text = sources().into_iter().find(|(path, _)| path == file).expect("a source").1;
        assert!(!named(&text, &[word.to_owned()]).is_empty(), "{file} has no `{word}` any more");
    }
}

#[test]
fn the_list_of_pieces_that_was_built_in_is_gone() {
    // Written apart, so that this file has none.
    let former = ["Piece", "Id"].concat();
    let is_word =
        |line: &str| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == former);
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        let lines = text.lines().enumerate().filter(|(_, line)| is_word(line));
        wrong.extend(lines.map(|(number, line)| format!("{path}:{}: {}", number + 1, line.trim())));
    }
    none(wrong);
}

#[test]
fn a_piece_that_is_named_in_code_is_found() {
    let source = "/// The \"ride\".\nfn f() -> &str {\n    \"ride\"\n}\n\n#[cfg(test)]\nmod tests {\n    const A: &str = \"kick\";\n}\n";
    assert_eq!(named(source, &names()), [(3, "ride")]);
}
