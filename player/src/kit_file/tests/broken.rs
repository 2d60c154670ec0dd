//! Broken files: whatever is done to a file, it is refused in one line, or still describes a kit that passes its check.

use super::super::{fresh, read, write};
use super::draw::{self, Draw};
use crate::kit_document::KitDocument;

/// Values that belong nowhere, or not everywhere.
const VALUES: [&str; 26] = [
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "99999999999999999999999",
    "-1",
    "0",
    "-0.0",
    "1e-300",
    "true",
    "\"none\"",
    "\"\"",
    "\"x\\ny\"",
    "[]",
    "{}",
    "[1, 2, 3]",
    "[[0, 0, 0], [0, 0, 0]]",
    "[nan, nan, nan]",
    "{ kind = \"drum\" }",
    "{ kind = \"gel\" }",
    "1979-05-27",
    "0x7fffffffffffffff",
    "\"hi-hat\"",
    "2",
    "0.5",
];

/// Names that mean something somewhere.
const KEYS: [&str; 16] = [
    "kind",
    "like",
    "slot",
    "notes",
    "place",
    "defaults",
    "diameter_in",
    "diameter_m",
    "thickness_mm",
    "shell",
    "format",
    "remove",
    "pieces",
    "title",
    "ideal",
    "position_controller",
];

/// Breaks a text in one way.
fn broken(draw: &mut Draw, text: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = draw.below(lines.len());
    let key = |line: &str| line.split_once(" = ").map(|(key, _)| key.to_owned());
    let fields: Vec<usize> = (0..lines.len()).filter(|&i| key(&lines[i]).is_some()).collect();
    if fields.is_empty() {
        return String::new();
    }
    match draw.below(12) {
        // Another value, another key, another unit.
        0..=2 => {
            let at = draw.of(&fields);
            lines[at] = format!("{} = {}", key(&lines[at]).unwrap(), draw.of(&VALUES));
        }
        3 => {
            let value = lines[at].split_once(" = ").map_or("1", |(_, value)| value).to_owned();
            lines[at] = format!("{} = {value}", draw.of(&KEYS));
        }
        4 => {
            let (from, to) = draw.of(&[
                ("_m ", "_in "),
                ("_mm ", "_m "),
                ("_in ", "_mm "),
                ("_hz ", "_khz "),
                ("_kg ", "_g "),
                ("_rad ", "_deg "),
                ("_gpa ", "_pa "),
                ("_1_s ", "_1_ms "),
            ]);
            return text.replace(from, to);
        }
        // Numbers that are far off.
        5 => {
            let factor = draw.of(&["e9", "e-9", "e300", ".5", "0000"]);
            lines[at] = format!("{}{factor}", lines[at]);
        }
        // Lines that are gone, twice there, or elsewhere.
        6 => drop(lines.remove(at)),
        7 => lines.insert(at, lines[at].clone()),
        8 => {
            let other = draw.below(lines.len());
            lines.swap(at, other);
        }
        // A text that ends early, or with bytes in it that do not belong there.
        9 => {
            let end = draw.below(text.len());
            return text.chars().take(end).collect();
        }
        10 => {
            let odd = draw.of(&['\0', '"', '[', ']', '{', '=', '\u{2028}', '\r', '\u{ff}', '.', '\'', '#']);
            let mut letters: Vec<char> = text.chars().collect();
            letters.insert(draw.below(letters.len()), odd);
            return letters.into_iter().collect();
        }
        // Pieces in each other.
        _ => {
            let centre = "place = { centre_m = [0, 0.3, -0.2], facing = [0, 0, 0] }".to_owned();
            for line in &mut lines {
                if line.starts_with("place = ") && draw.one_in(2) {
                    line.clone_from(&centre);
                }
            }
        }
    }
    lines.join("\n")
}

/// Whether a text is refused; fails if that is not done well, or what is accepted is not a kit.
fn is_refused(text: &str) -> bool {
    match read("my.toml", text) {
        Ok(document) => {
            document.check().unwrap_or_else(|error| panic!("{error}\n{text}"));
            false
        }
        Err(error) => {
            let line = error.to_string();
            assert!(line.starts_with("my.toml") && line.lines().count() == 1, "{line}\n{text}");
            assert!(!line.chars().any(char::is_control), "{line}");
            true
        }
    }
}

#[test]
fn a_thousand_broken_files_are_refused_in_one_line_or_still_are_kits() {
    let texts = [
        write(&KitDocument::standard()),
        write(&draw::document(3)),
        fresh("x").replace("\n#", "\n"),
        include_str!("../../../../assets/kits/fourteen.toml").to_owned(),
    ];
    let mut refused = 0;
    for seed in 0..1000 {
        let draw = &mut Draw::new(seed);
        let mut text = texts[draw.below(texts.len())].clone();
        for _ in 0..=draw.below(3) {
            text = broken(draw, &text);
        }
        refused += usize::from(is_refused(&text));
    }
    assert!(refused >= 500, "{refused}");
}

#[test]
fn what_is_no_kit_file_at_all_is_refused() {
    let draw = &mut Draw::new(1);
    for _ in 0..300 {
        let length = draw.below(200);
        let letters: String = (0..length).map(|_| char::from(draw.below(128) as u8)).collect();
        assert!(is_refused(&letters), "{letters}");
        assert!(is_refused(&format!("format = 1\n{letters}=")), "{letters}");
    }
}
